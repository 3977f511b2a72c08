//! The first reading of an MTL file: checked statements, textures with their options, and the
//! colours, which `tobj` then parses from clean text.

use super::error::{DefectLog, Reason};
use super::statement::{Statement, decode, for_each_statement, number};
use super::texture_map::TextureMap;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A material as the file gives it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct RawMaterial {
    pub name: String,
    /// The library, as messages name it.
    pub file: String,
    /// 1-based line of `newmtl`.
    pub line: usize,
    /// Line of `Kd`, or of `newmtl`.
    pub kd_line: usize,
    /// Line of `Ke`, or of `newmtl`.
    pub ke_line: usize,
    /// `Kd`, not yet checked for range.
    pub kd: Option<[f64; 3]>,
    /// `Ke`, not yet checked for range.
    pub ke: Option<[f64; 3]>,
    pub map_kd: Option<TextureMap>,
    pub map_ke: Option<TextureMap>,
    /// What a diffuse opaque material does not have, by kind, with the line: [`Ignored`].
    pub ignored: BTreeMap<Ignored, usize>,
}

/// Properties of a material that are left out of account.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Ignored {
    /// `d`, `Tr` or `map_d`: the surface stays opaque.
    Transparency,
    /// `Ks`, `map_Ks`, `Ns`: the surface stays diffuse.
    Specular,
    /// `Tf`, refraction.
    Transmission,
    /// `bump`, `norm`, `disp`: the surface stays as it is modelled.
    Relief,
    /// `Pm`, `map_Pm`, of the physically based extension.
    Metallic,
    /// `Ps`, `Pc`, of the same extension: the surface has one layer.
    Coating,
    /// An option of a texture statement.
    TextureOption(String),
    /// Anything else.
    Unknown(String),
}

/// Statements without a part in a diffuse surface, whatever their value.
const SILENT: [&[u8]; 17] = [
    b"Ka",
    b"Ns",
    b"Ni",
    b"illum",
    b"sharpness",
    b"map_Ka",
    b"map_Ns",
    b"Pr",
    b"Pcr",
    b"aniso",
    b"anisor",
    b"map_Ni",
    b"map_Pr",
    b"map_Pcr",
    b"map_aniso",
    b"map_anisor",
    b"map_aat",
];

/// Scans `bytes` and returns its materials in file order; `file` is what messages call it.
pub(super) fn scan_mtl(bytes: &[u8], file: &str, defects: &mut DefectLog) -> Vec<RawMaterial> {
    let mut scanner = Scanner {
        materials: Vec::new(),
        clean: String::new(),
    };
    if bytes.contains(&0) {
        defects.add(
            None,
            Reason::Parser("a material library must be text, this has binary content".into()),
        );
        return Vec::new();
    }
    for_each_statement(bytes, |statement| scanner.take(statement, file, defects));
    scanner.finish(defects)
}

struct Scanner {
    materials: Vec<RawMaterial>,
    /// `newmtl`, `Kd` and `Ke` only; materials are named by their number.
    clean: String,
}

impl Scanner {
    fn take(&mut self, statement: &Statement, file: &str, defects: &mut DefectLog) {
        let line = statement.line;
        if statement.keyword == b"newmtl" {
            let name = statement.name();
            if name.is_empty() {
                defects.add(Some(line), Reason::MissingName("newmtl".into()));
            }
            // Writing to a string cannot fail.
            let _ = writeln!(self.clean, "newmtl {}", self.materials.len());
            self.materials.push(RawMaterial {
                name,
                file: file.to_owned(),
                line,
                kd_line: line,
                ke_line: line,
                ..RawMaterial::default()
            });
            return;
        }
        let Some(material) = self.materials.last_mut() else {
            if [b"Kd".as_slice(), b"Ke", b"map_Kd", b"map_Ke"].contains(&statement.keyword) {
                let keyword = statement.keyword_text();
                defects.add(Some(line), Reason::NoMaterialYet(keyword));
            }
            return;
        };
        let mut ignore = |kind: Ignored| {
            material.ignored.entry(kind).or_insert(line);
        };
        match statement.keyword {
            b"Kd" => {
                material.kd_line = line;
                if let Some(colour) = colour(statement, defects) {
                    write_colour(&mut self.clean, "Kd", colour);
                }
            }
            b"Ke" => {
                material.ke_line = line;
                if let Some(colour) = colour(statement, defects) {
                    write_colour(&mut self.clean, "Ke", colour);
                }
            }
            b"map_Kd" | b"map_Ke" => match TextureMap::parse(statement) {
                Ok((map, ignored_options)) => {
                    for option in ignored_options {
                        ignore(Ignored::TextureOption(option));
                    }
                    if statement.keyword == b"map_Kd" {
                        material.map_kd = Some(map);
                    } else {
                        material.map_ke = Some(map);
                    }
                }
                Err(reason) => defects.add(Some(line), reason),
            },
            b"Ks" => {
                if matches(statement, defects, |v| v != 0.0) {
                    ignore(Ignored::Specular);
                }
            }
            b"Tf" => {
                if matches(statement, defects, |v| v != 1.0) {
                    ignore(Ignored::Transmission);
                }
            }
            b"d" => {
                // `d -halo 0.5` has an option before its number.
                if matches(statement, defects, |v| v != 1.0) {
                    ignore(Ignored::Transparency);
                }
            }
            b"Tr" => {
                if matches(statement, defects, |v| v != 0.0) {
                    ignore(Ignored::Transparency);
                }
            }
            b"Ps" | b"Pc" => {
                if matches(statement, defects, |v| v != 0.0) {
                    ignore(Ignored::Coating);
                }
            }
            b"Pm" => {
                if matches(statement, defects, |v| v != 0.0) {
                    ignore(Ignored::Metallic);
                }
            }
            b"map_d" | b"map_Tr" | b"map_opacity" => ignore(Ignored::Transparency),
            b"map_Ks" | b"refl" | b"map_refl" => ignore(Ignored::Specular),
            b"bump" | b"map_bump" | b"map_Bump" | b"norm" | b"map_norm" | b"disp" | b"map_disp"
            | b"decal" => ignore(Ignored::Relief),
            b"map_Pm" => ignore(Ignored::Metallic),
            b"map_Ps" | b"map_Pc" => ignore(Ignored::Coating),
            keyword if SILENT.contains(&keyword) => {
                matches(statement, defects, |_| false);
            }
            _ => ignore(Ignored::Unknown(statement.keyword_text())),
        }
    }

    fn finish(mut self, defects: &mut DefectLog) -> Vec<RawMaterial> {
        match tobj::load_mtl_buf(&mut self.clean.as_bytes()) {
            Ok((parsed, _)) => {
                for (material, parsed) in self.materials.iter_mut().zip(parsed) {
                    material.kd = parsed.diffuse;
                    material.ke = parsed.emissive;
                }
            }
            Err(e) => defects.add(None, Reason::Parser(e.to_string())),
        }
        self.materials
    }
}

fn write_colour(clean: &mut String, keyword: &str, [r, g, b]: [f64; 3]) {
    // Writing to a string cannot fail; `{}` prints the shortest text that reads back the same.
    let _ = writeln!(clean, "{keyword} {r} {g} {b}");
}

/// A colour of one number (grey) or three.
fn colour(statement: &Statement, defects: &mut DefectLog) -> Option<[f64; 3]> {
    let words: Vec<_> = statement.values().collect();
    let line = Some(statement.line);
    if let Some(kind) = words.first().filter(|w| w[0].is_ascii_alphabetic())
        && [b"spectral".as_slice(), b"xyz"].contains(kind)
    {
        let text = format!("{} {}", statement.keyword_text(), decode(kind));
        defects.add(line, Reason::UnsupportedColour(text));
        return None;
    }
    let mut values = Vec::with_capacity(3);
    for word in &words {
        match number(word) {
            Ok(value) => values.push(value),
            Err(reason) => defects.add(line, reason),
        }
    }
    match (words.len(), values.as_slice()) {
        (1, &[grey]) => Some([grey; 3]),
        (3, &[r, g, b]) => Some([r, g, b]),
        (1 | 3, _) => None,
        (found, _) => {
            let reason = Reason::Arity {
                keyword: statement.keyword_text(),
                expected: "1 or 3 numbers",
                found,
            };
            defects.add(line, reason);
            None
        }
    }
}

/// Whether a number of the statement satisfies `notable`. Words that look like numbers are checked
/// though nothing depends on them; others (options, file names) are passed over.
fn matches(statement: &Statement, defects: &mut DefectLog, notable: impl Fn(f64) -> bool) -> bool {
    let mut any = false;
    for word in statement.values() {
        match number(word) {
            Ok(value) => any |= notable(value),
            Err(reason @ Reason::NotFinite(_)) => defects.add(Some(statement.line), reason),
            Err(_) => {}
        }
    }
    any
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(text: &[u8]) -> (Vec<RawMaterial>, Vec<(Option<usize>, Reason)>) {
        let mut defects = Vec::new();
        let materials = scan_mtl(text, "t.mtl", &mut DefectLog::new("t.mtl", &mut defects));
        (
            materials,
            defects.into_iter().map(|d| (d.line, d.reason)).collect(),
        )
    }

    #[test]
    fn colours_of_one_and_three_numbers() {
        let (materials, defects) = scan(
            b"newmtl wall one\r\n\tKd 0.5\r\nKe 1 2 3 # bright\r\nnewmtl lamp\r\nKe 1e1 0 0\r\n",
        );
        assert_eq!(defects, []);
        assert_eq!(materials[0].name, "wall one");
        assert_eq!(materials[0].kd, Some([0.5; 3]));
        assert_eq!(materials[0].ke, Some([1.0, 2.0, 3.0]));
        assert_eq!(materials[1].kd, None);
        assert_eq!(materials[1].ke, Some([10.0, 0.0, 0.0]));
    }

    #[test]
    fn default_values_of_ignored_properties_are_not_worth_a_word() {
        let (materials, defects) = scan(
            b"newmtl a\nNs 10\nNi 1.5\nd 1\nTr 0\nTf 1 1 1\nillum 2\nKs 0 0 0\nKa 1 1 1\nPm 0\nPs 0\nPc 0\nPr 0.3\naniso 0.5\n",
        );
        assert_eq!(defects, []);
        assert!(materials[0].ignored.is_empty(), "{materials:?}");
        let (materials, _) =
            scan(b"newmtl a\nd 0.5\nTr 0.5\nKs 0 0 0.1\nbump -bm 1 b.png\nglow 3\nPc 0.1\n");
        let kinds: Vec<_> = materials[0].ignored.clone().into_iter().collect();
        assert_eq!(
            kinds,
            [
                (Ignored::Transparency, 2),
                (Ignored::Specular, 4),
                (Ignored::Relief, 5),
                (Ignored::Coating, 7),
                (Ignored::Unknown("glow".into()), 6)
            ]
        );
    }

    #[test]
    fn one_bad_number_does_not_hide_the_others() {
        let (materials, defects) = scan(
            b"Kd 1 1 1\nnewmtl a\nKd 0.1 x 0.3\nKe 1 2\nNs nan\nnewmtl\nKd spectral a.rfl\nKd .2 .3 .4\n",
        );
        assert_eq!(
            defects,
            [
                (Some(1), Reason::NoMaterialYet("Kd".into())),
                (Some(3), Reason::NotANumber("x".into())),
                (
                    Some(4),
                    Reason::Arity {
                        keyword: "Ke".into(),
                        expected: "1 or 3 numbers",
                        found: 2
                    }
                ),
                (Some(5), Reason::NotFinite("nan".into())),
                (Some(6), Reason::MissingName("newmtl".into())),
                (Some(7), Reason::UnsupportedColour("Kd spectral".into())),
            ]
        );
        assert_eq!(materials[1].kd, Some([0.2, 0.3, 0.4]));
    }
}
