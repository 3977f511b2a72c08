//! Materials as the faces use them: names resolved against the libraries, ranges checked.

use super::assets::Assets;
use super::config::LoadConfig;
use super::error::{Defect, DefectLog, MAX_EMISSION, Reason};
use super::model::SceneWarning;
use super::mtl_scan::{Ignored, RawMaterial, scan_mtl};
use super::obj_scan::ObjScan;
use std::collections::BTreeMap;
use std::io;

/// Reflectance of faces without a material, or whose material says nothing: what Mitsuba and pbrt
/// take for a diffuse surface without parameters.
pub(super) const DEFAULT_REFLECTANCE: f64 = 0.5;

/// The materials of an OBJ file.
pub(super) struct Materials {
    /// In the order of `ObjScan::materials`; the last one serves faces before any `usemtl`.
    pub list: Vec<RawMaterial>,
    /// Libraries that could not be read.
    pub missing_libraries: Vec<String>,
    /// Whether the file names any.
    pub names_library: bool,
}

/// Reads the libraries that the file names and finds each of its materials in them. Defects of
/// libraries go to `defects`, what can be lived without to `warnings`.
pub(super) fn resolve_materials(
    scan: &ObjScan,
    obj_file: &str,
    assets: Assets,
    defects: &mut Vec<Defect>,
    warnings: &mut Vec<SceneWarning>,
) -> Materials {
    let mut by_name: BTreeMap<String, RawMaterial> = BTreeMap::new();
    let mut missing_libraries = Vec::new();
    let mut read = Vec::new();
    for library in &scan.libraries {
        for (name, result) in read_libraries(&library.name, assets) {
            match result {
                Ok((file, bytes)) => {
                    if read.contains(&file) {
                        continue;
                    }
                    let materials = scan_mtl(&bytes, &file, &mut DefectLog::new(&file, defects));
                    for material in materials {
                        let again = by_name.insert(material.name.clone(), material);
                        if let Some(first) = again {
                            warnings.push(SceneWarning(format!(
                                "material `{}` is defined more than once; the last definition counts (the first is at {}:{})",
                                first.name, first.file, first.line
                            )));
                        }
                    }
                    read.push(file);
                }
                Err(e) if !missing_libraries.contains(&name) => {
                    warnings.push(SceneWarning(format!(
                        "{obj_file}:{}: material library `{name}` could not be read ({}); its materials become grey, Kd {DEFAULT_REFLECTANCE}",
                        library.line,
                        describe(&e)
                    )));
                    missing_libraries.push(name);
                }
                Err(_) => {}
            }
        }
    }
    let mut list: Vec<_> = scan
        .materials
        .iter()
        .map(|mention| {
            find(&by_name, &mention.name).unwrap_or_else(|| {
                // Without its library that goes without saying.
                if missing_libraries.is_empty() {
                    warnings.push(SceneWarning(format!(
                        "{obj_file}:{}: material `{}` is not defined; grey, Kd {DEFAULT_REFLECTANCE}, is taken",
                        mention.line, mention.name
                    )));
                }
                default_material(&mention.name, obj_file, mention.line)
            })
        })
        .collect();
    list.push(default_material("(none)", obj_file, 1));
    Materials {
        list,
        missing_libraries,
        names_library: !scan.libraries.is_empty(),
    }
}

/// The name of a file, and what reading it gave.
type Reading = (String, io::Result<(String, Vec<u8>)>);

/// The libraries of one `mtllib` statement: one name with spaces, or several names.
fn read_libraries(names: &str, assets: Assets) -> Vec<Reading> {
    let whole = assets.read(names);
    let several = names.split_ascii_whitespace().count() > 1;
    if several
        && whole
            .as_ref()
            .is_err_and(|e| e.kind() == io::ErrorKind::NotFound)
    {
        let each: Vec<_> = names
            .split_ascii_whitespace()
            .map(|name| (name.to_owned(), assets.read(name)))
            .collect();
        if each.iter().any(|(_, result)| result.is_ok()) {
            return each;
        }
    }
    vec![(names.to_owned(), whole)]
}

/// The material called `name`; a `#` after a space may be part of the name or start a comment.
fn find(by_name: &BTreeMap<String, RawMaterial>, name: &str) -> Option<RawMaterial> {
    let without_comment = |name: &str| name.split(" #").next().unwrap_or(name).trim().to_owned();
    by_name
        .get(name)
        .or_else(|| by_name.get(&without_comment(name)))
        .or_else(|| {
            by_name
                .values()
                .find(|m| m.name.contains(" #") && without_comment(&m.name) == name)
        })
        .cloned()
}

fn default_material(name: &str, file: &str, line: usize) -> RawMaterial {
    RawMaterial {
        name: name.to_owned(),
        file: file.to_owned(),
        line,
        kd_line: line,
        ke_line: line,
        kd: Some([DEFAULT_REFLECTANCE; 3]),
        ..RawMaterial::default()
    }
}

/// Notes what is wrong in itself with the materials that faces use (`used`, by index), and warns of
/// what is left out of account, one warning a kind.
pub(super) fn check_materials(
    materials: &[RawMaterial],
    used: &[bool],
    config: &LoadConfig,
    defects: &mut Vec<Defect>,
    warnings: &mut Vec<SceneWarning>,
) {
    let mut ignored: BTreeMap<&Ignored, (usize, &RawMaterial, usize)> = BTreeMap::new();
    for (material, _) in materials.iter().zip(used).filter(|(_, used)| **used) {
        for (keyword, value, line) in [
            ("Kd", material.kd, material.kd_line),
            ("Ke", material.ke, material.ke_line),
        ] {
            if let Some(value) = value.filter(|v| v.iter().any(|&c| c < 0.0)) {
                let reason = Reason::Negative {
                    material: material.name.clone(),
                    keyword,
                    value,
                };
                DefectLog::new(&material.file, defects).add(Some(line), reason);
            }
        }
        if let Some(value) = material
            .ke
            .filter(|ke| ke.iter().any(|&c| c > MAX_EMISSION))
        {
            let reason = Reason::EmissionTooHigh {
                material: material.name.clone(),
                value,
            };
            DefectLog::new(&material.file, defects).add(Some(material.ke_line), reason);
        }
        // With a texture the colour is known only once the image is.
        if material.map_kd.is_none()
            && !config.clamp_reflectance
            && let Some(value) = material.kd.filter(|kd| kd.iter().any(|&c| c >= 1.0))
        {
            let reason = Reason::ReflectanceTooHigh {
                material: material.name.clone(),
                value,
                texture: None,
            };
            DefectLog::new(&material.file, defects).add(Some(material.kd_line), reason);
        }
        if material.kd.is_none() && material.map_kd.is_none() {
            warnings.push(SceneWarning(format!(
                "{}:{}: material `{}` has no Kd; {DEFAULT_REFLECTANCE} is taken",
                material.file, material.line, material.name
            )));
        }
        for (kind, &line) in &material.ignored {
            ignored.entry(kind).or_insert((0, material, line)).0 += 1;
        }
    }
    for (kind, (count, first, line)) in ignored {
        warnings.push(SceneWarning(format!(
            "{} ({count} material{}, the first is `{}`, {}:{line})",
            ignored_text(kind),
            if count == 1 { "" } else { "s" },
            first.name,
            first.file
        )));
    }
}

fn ignored_text(kind: &Ignored) -> String {
    match kind {
        Ignored::Transparency => {
            "transparency (d, Tr, map_d) is ignored: surfaces are opaque".into()
        }
        Ignored::Specular => {
            "specular reflection (Ks, map_Ks, refl) is ignored: surfaces are diffuse".into()
        }
        Ignored::Transmission => "transmission (Tf) is ignored: surfaces are opaque".into(),
        Ignored::Relief => {
            "relief (bump, norm, disp, decal) is ignored: surfaces stay as modelled".into()
        }
        Ignored::Metallic => "metallic reflection (Pm) is ignored: surfaces are diffuse".into(),
        Ignored::Coating => {
            "sheen and clear coat (Ps, Pc) are ignored: surfaces are diffuse".into()
        }
        Ignored::TextureOption(option) => format!("texture option {option} is ignored"),
        Ignored::Unknown(keyword) => format!("unknown material property `{keyword}` is ignored"),
    }
}

/// An I/O error in words that do not depend on the operating system where they need not.
pub(super) fn describe(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "no such file".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        io::ErrorKind::IsADirectory => "it is a directory".into(),
        _ => error.to_string(),
    }
}
