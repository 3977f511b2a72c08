//! Occluders as a mesh to lay over the scene (paper, Figs. 3 and 4), and their numbers.

use super::{OutputError, write_atomically};
use crate::occluder::{OccluderConfig, OccluderSet};
use crate::scene::Scene;
use serde::Serialize;
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Turns of the hue from one occluder to the next, the golden ratio: neighbours in the list never
/// look alike.
const HUE_STEP: f64 = 0.618_033_988_749_894_9;

/// Writes the occluders as an OBJ in the file's units: one object with one face an occluder, named
/// by its place in the list and the node that covers it, with colours at the vertices (which most
/// viewers show). The faces lie half-way between the two faces of the slab and wind
/// counter-clockwise about its normal. Then the solids, one object each with the faces that are covered.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_occluders(
    path: &Path,
    scene: &Scene,
    set: &OccluderSet,
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    write_atomically(path, interrupted, |out| {
        write_objects(out, scene, set).map_err(|e| OutputError::io("write", path, e))
    })
}

fn write_objects(out: &mut impl Write, scene: &Scene, set: &OccluderSet) -> io::Result<()> {
    writeln!(
        out,
        "# occluders of {}",
        scene.name.replace(['\n', '\r'], " ")
    )?;
    for (index, occluder) in set.occluders.iter().enumerate() {
        let slab = &occluder.slab;
        let thickness = 2.0 * f64::from(slab.half_thickness) / scene.normalisation.scale;
        let [red, green, blue] = hue((index as f64 * HUE_STEP).fract());
        writeln!(out, "# thickness {thickness:e}")?;
        writeln!(out, "o occluder_{index}_node_{}", occluder.node.0)?;
        for corner in slab.corners {
            let p = scene.normalisation.to_file(corner.as_dvec3());
            writeln!(
                out,
                "v {} {} {} {red:.3} {green:.3} {blue:.3}",
                p.x, p.y, p.z
            )?;
        }
        let first = 4 * index + 1;
        writeln!(out, "f {} {} {} {}", first, first + 1, first + 2, first + 3)?;
    }
    for (index, solid) in set.solids.iter().enumerate() {
        let [red, green, blue] = hue((index as f64 * HUE_STEP).fract());
        writeln!(out, "o solid_{index}")?;
        for axis in 0..3 {
            for (side, covered) in [-1.0, 1.0].into_iter().zip(solid.covered[axis]) {
                if !covered {
                    continue;
                }
                for corner in solid.face(axis, side) {
                    let p = scene.normalisation.to_file(corner);
                    writeln!(
                        out,
                        "v {} {} {} {red:.3} {green:.3} {blue:.3}",
                        p.x, p.y, p.z
                    )?;
                }
                writeln!(out, "f -4 -3 -2 -1")?;
            }
        }
    }
    Ok(())
}

/// A full, light colour of the circle; `turn` in [0, 1).
fn hue(turn: f64) -> [f64; 3] {
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|at| {
        let away = (turn - at).abs();
        let away = away.min(1.0 - away);
        0.3 + 0.7 * (2.0 - 6.0 * away).clamp(0.0, 1.0)
    })
}

/// Counts and areas of an extraction, for `--json`. Areas are in the square of the file's units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OccluderSummary {
    /// Version of this layout: 1.
    pub format: u32,
    /// The OBJ file, or `builtin:NAME`.
    pub scene: String,
    /// Triangles of the scene.
    pub polygons: usize,
    /// How occluders were looked for.
    pub configuration: OccluderConfig,
    /// Occluders found.
    pub occluders: usize,
    /// Boxes that hide what lies behind two faces or more.
    pub solids: usize,
    /// Flat clusters that were big enough, off the scene's bounding box, each sheet once.
    pub flat_clusters: usize,
    /// Flat clusters that gave an occluder.
    pub productive_clusters: usize,
    /// Area that the flat clusters cover of their planes.
    pub flat_area: f64,
    /// Area of the union of the rectangles, cluster by cluster.
    pub covered_area: f64,
    /// `covered_area / flat_area`, 0 where nothing is flat.
    pub covered_share: f64,
    /// Area of the largest occluder, 0 without one.
    pub largest: f64,
    /// Greatest thickness of an occluder, in the file's units.
    pub thickest: f64,
}

impl OccluderSummary {
    /// The numbers of `set`, which was extracted from `scene` with `configuration`.
    pub fn new(scene: &Scene, set: &OccluderSet, configuration: OccluderConfig) -> Self {
        let area = |normalised: f64| scene.normalisation.area_to_file(normalised);
        let greatest = |of: fn(&crate::occluder::SlabRectangle) -> f32| {
            let all = set.occluders.iter().map(|o| of(&o.slab));
            f64::from(all.fold(0.0, f32::max))
        };
        Self {
            format: 1,
            scene: scene.name.clone(),
            polygons: scene.polygons.len(),
            configuration,
            occluders: set.occluders.len(),
            solids: set.solids.len(),
            flat_clusters: set.statistics.flat_clusters,
            productive_clusters: set.statistics.productive_clusters,
            flat_area: area(set.statistics.flat_area),
            covered_area: area(set.statistics.covered_area),
            covered_share: set.statistics.covered_share(),
            largest: area(greatest(|slab| slab.area())),
            thickest: 2.0 * greatest(|slab| slab.half_thickness) / scene.normalisation.scale,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::NodeId;
    use crate::occluder::{Occluder, SlabRectangle};
    use crate::scene::Normalisation;
    use glam::{DVec3, Vec3};

    fn scene() -> Scene {
        Scene {
            name: "room.obj".into(),
            positions: Vec::new(),
            source_positions: Vec::new(),
            polygons: Vec::new(),
            surfaces: Vec::new(),
            normalisation: Normalisation {
                centre: DVec3::new(1000.0, 0.0, 0.0),
                scale: 0.25,
                turn: glam::DMat3::IDENTITY,
            },
            source_faces: 0,
            dropped_faces: Vec::new(),
            contacts: crate::scene::Contacts::default(),
            warnings: Vec::new(),
        }
    }

    fn two() -> OccluderSet {
        let slab = SlabRectangle::new(
            Vec3::ZERO,
            Vec3::X * 0.25,
            Vec3::Y * 0.125,
            Vec3::Z,
            0.0009765625,
        );
        OccluderSet {
            occluders: vec![
                Occluder {
                    slab,
                    node: NodeId(7)
                };
                2
            ],
            ..OccluderSet::default()
        }
    }

    #[test]
    fn the_mesh_reads_back_in_the_files_units() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("occluders.obj");
        write_occluders(&path, &scene(), &two(), &AtomicBool::new(false)).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let lines = |word: &str| -> Vec<Vec<f64>> {
            text.lines()
                .filter_map(|l| l.strip_prefix(word))
                .map(|l| l.split_whitespace().map(|n| n.parse().unwrap()).collect())
                .collect()
        };
        let (vertices, faces) = (lines("v "), lines("f "));
        assert_eq!(vertices.len(), 8);
        assert_eq!(vertices[0][..3], [999.0, -0.5, 0.0]);
        assert_eq!(vertices[2][..3], [1001.0, 0.5, 0.0]);
        assert_eq!(faces, [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]]);
        assert_eq!(text.matches("\no occluder_").count(), 2);
    }

    #[test]
    fn the_summary_is_in_the_files_units() {
        let summary = OccluderSummary::new(&scene(), &two(), OccluderConfig::default());
        assert_eq!(summary.occluders, 2);
        assert_eq!(summary.largest, 2.0);
        assert_eq!(summary.thickest, 0.0078125);
        assert_eq!(summary.covered_share, 0.0);
    }
}
