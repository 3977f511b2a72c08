//! The first reading of an OBJ file: every statement is checked, every defect is noted with its
//! line, and what is sound is written out again as plain text that `tobj` can parse without
//! surprises (absolute indices, no groups, no materials, no lines or points, ASCII only).

use super::corner_indices::{CornerIndices, List};
use super::error::{DefectLog, MAX_ELEMENTS, Reason};
use super::foreign_file::foreign_kind;
use super::statement::{Statement, decode, for_each_statement, number};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A name that the file mentions, with the line of its first mention.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mention {
    pub name: String,
    pub line: usize,
}

/// What the scan of an OBJ file yields besides defects.
#[derive(Debug, Default)]
pub(super) struct ObjScan {
    /// `v`, `vt` and `f` statements only; a face refers to texture coordinates in all of its
    /// corners or in none.
    pub clean: String,
    /// 1-based line of each `f` statement, in file order.
    pub face_lines: Vec<usize>,
    /// Whether each face has texture coordinates.
    pub face_textured: Vec<bool>,
    /// Index into `materials` of each face; `None` before the first `usemtl`.
    pub face_material: Vec<Option<u32>>,
    /// Names after `usemtl`, each once, in order of first use.
    pub materials: Vec<Mention>,
    /// Names after `mtllib`.
    pub libraries: Vec<Mention>,
    /// Keywords that no OBJ file should have, or that we cannot draw, with their first lines.
    pub ignored: BTreeMap<String, usize>,
}

/// Statements that carry no surface or do not matter to one, and are passed over in silence.
const SILENT: [&[u8]; 16] = [
    b"g",
    b"o",
    b"s",
    b"mg",
    b"l",
    b"p",
    b"vp",
    b"lod",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"usemap",
    b"maplib",
    b"shadow_obj",
    b"trace_obj",
    b"call",
];

/// Scans `bytes`; defects go to `defects`.
pub(super) fn scan_obj(bytes: &[u8], defects: &mut DefectLog) -> ObjScan {
    if let Some(what) = foreign_kind(bytes) {
        defects.add(None, Reason::NotObj(what));
        return ObjScan::default();
    }
    let mut scanner = Scanner {
        scan: ObjScan::default(),
        indices: CornerIndices::default(),
        current_material: None,
        material_index: BTreeMap::new(),
        corners: Vec::new(),
        known_statements: 0,
        statements: 0,
    };
    for_each_statement(bytes, |statement| scanner.take(statement, defects));
    scanner.finish(defects)
}

struct Scanner {
    scan: ObjScan,
    indices: CornerIndices,
    current_material: Option<u32>,
    material_index: BTreeMap<String, u32>,
    /// Corners of the face at hand: 1-based vertex and texture coordinate, where given.
    corners: Vec<(i64, Option<i64>)>,
    known_statements: usize,
    statements: usize,
}

impl Scanner {
    fn take(&mut self, statement: &Statement, defects: &mut DefectLog) {
        self.statements += 1;
        self.known_statements += 1;
        match statement.keyword {
            b"v" => self.vertex(statement, defects),
            b"vt" => self.texture_coordinate(statement, defects),
            b"vn" => self.normal(statement, defects),
            b"f" => self.face(statement, defects),
            b"usemtl" => self.use_material(statement, defects),
            b"mtllib" => match statement.name() {
                name if name.is_empty() => {
                    defects.add(Some(statement.line), Reason::MissingName("mtllib".into()));
                }
                name => self.scan.libraries.push(Mention {
                    name,
                    line: statement.line,
                }),
            },
            keyword if SILENT.contains(&keyword) => {}
            _ => {
                self.known_statements -= 1;
                self.scan
                    .ignored
                    .entry(statement.keyword_text())
                    .or_insert(statement.line);
            }
        }
    }

    /// `v x y z`, `v x y z w` or `v x y z r g b` (a vertex colour, ignored).
    fn vertex(&mut self, statement: &Statement, defects: &mut DefectLog) {
        self.indices.add(List::Vertex);
        let expected = "3 coordinates (and a weight or a colour)";
        let Some(values) = numbers(statement, &[3, 4, 6, 7], expected, defects) else {
            return;
        };
        let weighted = values.count == 4;
        if weighted && values.value[3] == 0.0 {
            defects.add(Some(statement.line), Reason::ZeroWeight);
            return;
        }
        let [x, y, z, w, ..] = values.value;
        if weighted && let Some(c) = [x, y, z].into_iter().find(|c| !(c / w).is_finite()) {
            let text = format!("{c}/{w}");
            defects.add(Some(statement.line), Reason::NotFinite(text));
            return;
        }
        self.copy("v", statement, if weighted { 4 } else { 3 });
    }

    /// `vt u`, `vt u v` or `vt u v w`.
    fn texture_coordinate(&mut self, statement: &Statement, defects: &mut DefectLog) {
        self.indices.add(List::TextureCoordinate);
        let Some(values) = numbers(statement, &[1, 2, 3], "1 to 3 coordinates", defects) else {
            return;
        };
        self.copy("vt", statement, values.count.min(2));
        if values.count == 1 {
            self.scan.clean.pop();
            self.scan.clean.push_str(" 0\n");
        }
    }

    /// `vn x y z`: checked and counted, but the facing comes from the winding.
    fn normal(&mut self, statement: &Statement, defects: &mut DefectLog) {
        self.indices.add(List::Normal);
        numbers(statement, &[3], "3 coordinates", defects);
    }

    /// Copies the first `count` values as they were written, so that nothing is rounded.
    fn copy(&mut self, keyword: &str, statement: &Statement, count: usize) {
        let clean = &mut self.scan.clean;
        clean.push_str(keyword);
        for word in statement.values().take(count) {
            clean.push(' ');
            clean.push_str(&decode(word));
        }
        clean.push('\n');
    }

    fn face(&mut self, statement: &Statement, defects: &mut DefectLog) {
        self.scan.face_lines.push(statement.line);
        self.scan.face_material.push(self.current_material);
        self.corners.clear();
        let mut sound = true;
        let mut count = 0;
        for word in statement.values() {
            count += 1;
            match self.indices.corner(word, statement.line, defects) {
                Some(corner) => self.corners.push(corner),
                None => sound = false,
            }
        }
        if count < 3 {
            let reason = Reason::Arity {
                keyword: "f".into(),
                expected: "at least 3 corners",
                found: count,
            };
            defects.add(Some(statement.line), reason);
            sound = false;
        }
        let textured = sound && self.corners.iter().all(|c| c.1.is_some());
        self.scan.face_textured.push(textured);
        if !sound {
            return;
        }
        let clean = &mut self.scan.clean;
        clean.push('f');
        for &(vertex, texture) in &self.corners {
            // Writing to a string cannot fail.
            let _ = match texture.filter(|_| textured) {
                Some(texture) => write!(clean, " {vertex}/{texture}"),
                None => write!(clean, " {vertex}"),
            };
        }
        clean.push('\n');
    }

    fn use_material(&mut self, statement: &Statement, defects: &mut DefectLog) {
        let name = statement.name();
        if name.is_empty() {
            defects.add(Some(statement.line), Reason::MissingName("usemtl".into()));
            return;
        }
        let materials = &mut self.scan.materials;
        let index = *self
            .material_index
            .entry(name.clone())
            .or_insert_with(|| materials.len() as u32);
        if index as usize == materials.len() {
            materials.push(Mention {
                name,
                line: statement.line,
            });
        }
        self.current_material = Some(index);
    }

    fn finish(mut self, defects: &mut DefectLog) -> ObjScan {
        self.indices.finish(defects);
        let faces = self.scan.face_lines.len();
        if self.statements == 0 {
            defects.add(None, Reason::Empty);
        } else if self.known_statements == 0 {
            defects.add(
                None,
                Reason::NotObj("none of its lines is an OBJ statement"),
            );
        } else if faces == 0 {
            defects.add(None, Reason::NoFaces);
        }
        for (kind, count) in [
            ("vertices", self.indices.count(List::Vertex)),
            (
                "texture coordinates",
                self.indices.count(List::TextureCoordinate),
            ),
            ("faces", faces),
        ] {
            if count > MAX_ELEMENTS {
                defects.add(None, Reason::TooMany { kind, count });
            }
        }
        defects.sort_by_line();
        self.scan
    }
}

/// The values of a statement, 7 at most: `v x y z w r g b`.
struct Values {
    value: [f64; 7],
    count: usize,
}

/// All values as numbers; `None`, with every defect noted, if one is bad or their count is not
/// among `allowed`.
fn numbers(
    statement: &Statement,
    allowed: &[usize],
    expected: &'static str,
    defects: &mut DefectLog,
) -> Option<Values> {
    let mut values = Values {
        value: [0.0; 7],
        count: 0,
    };
    let mut sound = true;
    for word in statement.values() {
        match number(word) {
            Ok(value) => {
                if let Some(slot) = values.value.get_mut(values.count) {
                    *slot = value;
                }
            }
            Err(reason) => {
                defects.add(Some(statement.line), reason);
                sound = false;
            }
        }
        values.count += 1;
    }
    if !allowed.contains(&values.count) {
        let reason = Reason::Arity {
            keyword: statement.keyword_text(),
            expected,
            found: values.count,
        };
        defects.add(Some(statement.line), reason);
        sound = false;
    }
    sound.then_some(values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::error::Defect;

    fn scan(text: &[u8]) -> (ObjScan, Vec<(Option<usize>, Reason)>) {
        let mut defects = Vec::new();
        let scan = scan_obj(text, &mut DefectLog::new("t.obj", &mut defects));
        let split = |d: Defect| (d.line, d.reason);
        (scan, defects.into_iter().map(split).collect())
    }

    #[test]
    fn clean_text_has_absolute_indices_and_exact_numbers() {
        let (scan, defects) = scan(
            b"mtllib a.mtl\ng wall\nv 0.10000000000000001 0 0\nv 1 0 0 2\nv 0 1 0 .1 .2 .3\nvt 0\nvt .5 .5 0\n\
              vn 0 0 1\nusemtl red\nf -3/1/1 2/2 -1/-1/-1\nl 1 2 3\nf 1//1 2 3/2\nf 1/1 2/1 3/4\nvt 1 1\nvt 1 0\n",
        );
        assert_eq!(defects, []);
        assert_eq!(
            scan.clean,
            "v 0.10000000000000001 0 0\nv 1 0 0 2\nv 0 1 0\nvt 0 0\nvt .5 .5\n\
             f 1/1 2/2 3/2\nf 1 2 3\nf 1/1 2/1 3/4\nvt 1 1\nvt 1 0\n"
        );
        assert_eq!(scan.face_lines, [10, 12, 13]);
        assert_eq!(scan.face_textured, [true, false, true]);
        assert_eq!(scan.face_material, [Some(0); 3]);
    }

    #[test]
    fn materials_are_numbered_by_first_use() {
        let (scan, _) = scan(
            b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3",
        );
        assert_eq!(scan.face_material, [None, Some(0), Some(1), Some(0)]);
        let names: Vec<_> = scan.materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["b", "a"]);
    }

    #[test]
    fn every_defect_of_a_line_is_found() {
        let (_, defects) = scan(b"v nan x 0\nf 1 -2 0 x\nf 1 2");
        let lines: Vec<_> = defects.iter().map(|d| d.0).collect();
        // `f 1 2` refers to a vertex that never comes; that is known at the end only.
        assert_eq!(lines, [1, 1, 2, 2, 2, 3, 3].map(Some), "{defects:?}");
    }
}
