//! Loading a scene: scan, resolve, parse, normalise, cut, colour; each stage on input that the
//! ones before have found sound.

use super::assets::Assets;
use super::config::{Axes, LoadConfig};
use super::contact_search::find_contacts;
use super::contacts::Contacts;
use super::error::{Defect, DefectLog, LoadError, MAX_ELEMENTS, MIN_EMISSION, Reason};
use super::file_box::FileBox;
use super::material::{Materials, check_materials, describe, resolve_materials};
use super::model::{Normalisation, Polygon, Scene, SceneWarning};
use super::mtl_scan::RawMaterial;
use super::normalise::normalisation_of;
use super::obj_parse::{RawMesh, parse_obj};
use super::obj_scan::{ObjScan, scan_obj};
use super::orientation::own_axes;
use super::overlap::{Overlaps, find_overlaps_by};
use super::polygon_tree::PolygonTree;
use super::polygons::{Pieces, Tally, cut_faces};
use super::side_graph::{SideIndex, facet_at};
use super::surface::{Canvas, assign_surfaces};
use glam::{DMat3, DVec3, Vec3};
use std::io;
use std::path::Path;

/// Loads the OBJ file at `path`; material libraries and textures are looked for beside it.
///
/// # Errors
/// Every defect found, each with its file, line and reason.
pub fn load_file(path: &Path, config: &LoadConfig) -> Result<Scene, LoadError> {
    let name = path.display().to_string();
    let refuse = |reason| LoadError::one(&name, None, reason);
    let unreadable = |e: io::Error| {
        refuse(match e.kind() {
            io::ErrorKind::NotFound if path.is_symlink() => Reason::DanglingLink,
            io::ErrorKind::NotFound => Reason::Missing,
            _ => Reason::Unreadable(describe(&e)),
        })
    };
    if path.as_os_str().is_empty() {
        return Err(refuse(Reason::Nameless));
    }
    let found = std::fs::metadata(path).map_err(unreadable)?;
    if found.is_dir() {
        return Err(refuse(Reason::Directory));
    }
    if !found.is_file() {
        return Err(refuse(Reason::NotAFile));
    }
    let bytes = std::fs::read(path).map_err(unreadable)?;
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    load(&name, bytes, Assets::Folder(folder), config)
}

/// Loads a scene from memory: `files` are the material libraries and textures that `obj` may name,
/// as pairs of name and content.
///
/// # Errors
/// Every defect found, each with its file, line and reason; `name` stands for the OBJ file.
pub fn load_text(
    name: &str,
    obj: &[u8],
    files: &[(&str, &[u8])],
    config: &LoadConfig,
) -> Result<Scene, LoadError> {
    load(name, obj.to_vec(), Assets::Memory(files), config)
}

fn load(
    name: &str,
    bytes: Vec<u8>,
    assets: Assets,
    config: &LoadConfig,
) -> Result<Scene, LoadError> {
    let mut defects = Vec::new();
    let mut warnings = Vec::new();

    let mut scan = scan_obj(&bytes, &mut DefectLog::new(name, &mut defects));
    drop(bytes);
    warn_of_ignored(&scan, name, &mut warnings);
    let materials = resolve_materials(&scan, name, assets, &mut defects, &mut warnings);
    let used = used_materials(&scan);
    check_materials(&materials.list, &used, config, &mut defects, &mut warnings);
    if !scan.face_lines.is_empty() {
        check_emitter(&materials, &used, name, &mut defects);
    }
    refuse_if_any(&mut defects)?;

    let refuse = |line: Option<usize>, reason| LoadError::one(name, line, reason);
    let mesh = parse_obj(std::mem::take(&mut scan.clean)).map_err(|r| refuse(None, r))?;
    let file = FileBox::around(&mesh.positions).map_err(|r| {
        refuse(
            None,
            if is_point(&mesh) {
                Reason::NoArea(mesh.face_count())
            } else {
                r
            },
        )
    })?;
    let turn = match config.axes {
        Axes::Scene => own_axes(&mesh, file),
        Axes::File => DMat3::IDENTITY,
    };
    let normalisation = normalisation_of(&mesh.positions, file, turn);
    let positions: Vec<Vec3> = mesh
        .positions
        .iter()
        .map(|&p| normalisation.to_normalised(p))
        .collect();
    let pieces = cut_faces(&mesh, &normalisation, &positions);
    if pieces.kept.len() > MAX_ELEMENTS {
        let count = pieces.kept.len();
        return Err(refuse(
            None,
            Reason::TooMany {
                kind: "polygons",
                count,
            },
        ));
    }
    check_pieces(&pieces, &mesh, &scan, &normalisation, name, &mut defects);
    refuse_if_any(&mut defects)?;
    warn_of_dropped(&pieces, &scan, name, &mut warnings);

    let last = materials.list.len() as u32 - 1;
    let material_of: Vec<u32> = pieces
        .kept
        .iter()
        .map(|piece| scan.face_material[piece.face as usize].unwrap_or(last))
        .collect();
    let canvas = Canvas {
        pieces: &pieces.kept,
        mesh: &mesh,
        textured: &scan.face_textured,
        material_of: &material_of,
        materials: &materials.list,
    };
    let surfaces = assign_surfaces(&canvas, assets, config, &mut defects, &mut warnings);
    let brightest = (surfaces.list.iter())
        .flat_map(|s| s.emission)
        .fold(0.0, f64::max);
    if brightest > 0.0 && brightest < MIN_EMISSION {
        DefectLog::new(name, &mut defects).add(None, Reason::EmissionTooLow(brightest));
    }
    if brightest == 0.0 {
        let Materials {
            missing_libraries,
            names_library,
            ..
        } = materials;
        let lost = |face: &&u32| {
            let material = scan.face_material[**face as usize].unwrap_or(last);
            emits(&materials.list[material as usize])
        };
        let reason = match pieces.dropped_faces.iter().filter(lost).count() {
            0 => Reason::NoEmitter {
                missing_libraries,
                names_library,
            },
            count => Reason::EmittersDropped(count),
        };
        DefectLog::new(name, &mut defects).add(None, reason);
    }
    refuse_if_any(&mut defects)?;

    let polygons = pieces
        .kept
        .iter()
        .zip(&surfaces.of_piece)
        .map(|(piece, &surface)| Polygon {
            vertices: piece.corners.map(|c| mesh.corners[c as usize]),
            source_face: piece.face,
            surface,
        })
        .collect();
    let mut scene = Scene {
        name: name.to_owned(),
        positions,
        polygons,
        surfaces: surfaces.list,
        normalisation,
        source_faces: mesh.face_count() as u32,
        source_positions: mesh.positions,
        dropped_faces: pieces.dropped_faces,
        contacts: Contacts::default(),
        warnings,
    };
    let tree = PolygonTree::new(&scene);
    let overlaps = find_overlaps_by(&tree, &scene);
    let sides = 0..2 * scene.polygons.len() as SideIndex;
    let covered = sides.filter(|&side| overlaps.is_covered(facet_at(side)));
    scene.contacts = find_contacts(&tree, &scene, &overlaps).with_covered(covered.collect());
    warn_of_overlaps(&mut scene, &overlaps);
    Ok(scene)
}

fn warn_of_overlaps(scene: &mut Scene, overlaps: &Overlaps) {
    let mut warn = |count: usize, what: String| {
        if count > 0 {
            let text = format!("{}: {count} polygons {what}", scene.name);
            scene.warnings.push(SceneWarning(text));
        }
    };
    warn(
        overlaps.covered_fronts,
        "lie wholly on others in one plane, facing the same way; they receive no light of their own"
            .into(),
    );
    warn(
        overlaps.covered_lamps,
        "of those emit but lie on others that emit too; the first in the file shines for them, by its own Ke".into(),
    );
    warn(
        overlaps.partly_covered_fronts,
        format!(
            "lie partly on others in one plane, facing the same way; they receive no light of their own on {:.2e} of the area",
            overlaps.partly_covered_share
        ),
    );
    warn(
        overlaps.unchecked,
        "lie in a crowd too dense to be searched for overlaps".into(),
    );
}

fn refuse_if_any(defects: &mut Vec<Defect>) -> Result<(), LoadError> {
    if defects.is_empty() {
        Ok(())
    } else {
        Err(LoadError {
            defects: std::mem::take(defects),
        })
    }
}

fn warn_of_ignored(scan: &ObjScan, name: &str, warnings: &mut Vec<SceneWarning>) {
    for (keyword, line) in &scan.ignored {
        warnings.push(SceneWarning(format!(
            "{name}:{line}: statement `{keyword}` is not supported and is ignored"
        )));
    }
    let without = scan.face_material.iter().filter(|m| m.is_none()).count();
    if without > 0 {
        warnings.push(SceneWarning(format!(
            "{name}: {without} faces stand before any `usemtl`; they become grey, Kd {}",
            super::material::DEFAULT_REFLECTANCE
        )));
    }
}

/// Which materials some face uses; the last entry is for faces without one.
fn used_materials(scan: &ObjScan) -> Vec<bool> {
    let last = scan.materials.len();
    let mut used = vec![false; last + 1];
    for material in &scan.face_material {
        used[material.map_or(last, |m| m as usize)] = true;
    }
    used
}

fn emits(material: &RawMaterial) -> bool {
    material.map_ke.is_some() || material.ke.is_some_and(|ke| ke.iter().any(|&c| c > 0.0))
}

fn check_emitter(materials: &Materials, used: &[bool], name: &str, defects: &mut Vec<Defect>) {
    let mut in_use = materials.list.iter().zip(used).filter(|(_, used)| **used);
    // Where a `Ke` was refused, its own defect says what is wrong.
    let refused = |m: &RawMaterial| m.ke.is_none() && m.ke_line != m.line;
    if !in_use.any(|(material, _)| emits(material) || refused(material)) {
        let reason = Reason::NoEmitter {
            missing_libraries: materials.missing_libraries.clone(),
            names_library: materials.names_library,
        };
        DefectLog::new(name, defects).add(None, reason);
    }
}

fn is_point(mesh: &RawMesh) -> bool {
    mesh.positions.iter().all(|p| *p == mesh.positions[0])
}

/// Refuses a scene of which nothing, or less than half, is left.
fn check_pieces(
    pieces: &Pieces,
    mesh: &RawMesh,
    scan: &ObjScan,
    normalisation: &Normalisation,
    name: &str,
    defects: &mut Vec<Defect>,
) {
    let mut log = DefectLog::new(name, defects);
    let total = mesh.face_count();
    if pieces.collapsed.count * 2 > total {
        let mean = mesh.positions.iter().sum::<DVec3>() / mesh.positions.len() as f64;
        let farthest = mesh
            .positions
            .iter()
            .max_by(|a, b| {
                a.distance_squared(mean)
                    .total_cmp(&b.distance_squared(mean))
            })
            .copied()
            .unwrap_or_default();
        let reason = Reason::Collapsed {
            span: 1.0 / normalisation.scale,
            faces: pieces.collapsed.count,
            total,
            farthest: farthest.to_array(),
        };
        let line = scan.face_lines[pieces.collapsed.first as usize];
        log.add(Some(line), reason);
    } else if pieces.kept.is_empty() {
        log.add(None, Reason::NoArea(total));
    }
}

fn warn_of_dropped(pieces: &Pieces, scan: &ObjScan, name: &str, warnings: &mut Vec<SceneWarning>) {
    let mut warn = |tally: Tally, what: &str| {
        if tally.count > 0 {
            let line = scan.face_lines[tally.first as usize];
            let faces = match tally.count {
                1 => "1 face".to_owned(),
                count => format!("{count} faces (this is the first)"),
            };
            warnings.push(SceneWarning(format!("{name}:{line}: {faces} {what}")));
        }
    };
    warn(
        pieces.without_area,
        "without area (or that crosses itself so that its parts cancel), dropped",
    );
    warn(
        pieces.collapsed,
        "too small beside the scene for single precision, dropped",
    );
    warn(
        pieces.duplicates,
        "repeating an earlier face in place and facing, dropped",
    );
    warn(
        pieces.crossing,
        "whose outline crosses itself; its triangles cover another area than the outline",
    );
}
