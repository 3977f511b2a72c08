//! Writes `stats.json`: the numbers of one solve, in one fixed order of keys.

use super::solved_mesh::triangle_area;
use super::{ContentBlock, OutputError, OutputsBlock, write_atomically};
use crate::math::PolygonId;
use crate::scene::Scene;
use crate::solve::{PassStatistics, PowerLedger};
use glam::DVec3;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// What `stats.json` holds. Everything but the seconds is the same, byte for byte, for the same
/// input, seed and configuration.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct StatsFile {
    /// Version of this layout: [`StatsFile::FORMAT`].
    pub format: u32,
    /// Version of this program.
    pub certilux: String,
    /// Version of the Embree library that ran.
    pub embree: String,
    /// The command line.
    pub command: Vec<String>,
    /// Seed of every sample.
    pub seed: u64,
    /// Worker threads.
    pub threads: usize,
    /// How visibility was decided.
    pub technique: String,
    /// The threshold on power carried, as a fraction of the emitted power.
    pub epsilon: f64,
    /// Rays of a sampled exchange.
    pub rays_per_exchange: u32,
    /// The preset that gave what no flag did.
    pub quality: String,
    /// The unshot fraction at which the solve was to stop; absent where passes were counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub converge: Option<f64>,
    /// Every setting that affects the light, by the name of its flag.
    pub settings: BTreeMap<String, String>,
    /// Hashes of the scene, the settings and the solution.
    pub content: ContentBlock,
    /// Files beside `solution.ply`, and what each was made with.
    pub outputs: OutputsBlock,
    /// The input.
    pub scene: SceneBlock,
    /// What was built over it.
    pub hierarchy: HierarchyBlock,
    /// One entry a pass.
    pub passes: Vec<PassStatistics>,
    /// Wall time of each stage.
    pub seconds: SecondsBlock,
    /// Where the light went.
    pub power: PowerLedger,
    /// By how much row normalisation scaled what arrived in each pass; absent where it was off.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub row_scales: Option<Vec<f64>>,
}

/// The input as it was taken in.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SceneBlock {
    /// The OBJ file, or `builtin:NAME`.
    pub path: String,
    /// Number of `f` statements, dropped ones included.
    pub faces: u32,
    /// Triangles that they became.
    pub polygons: usize,
    /// Area of one side of every polygon, in the square of the file's units.
    pub area: f64,
    /// Least and greatest corner, in the file's units.
    pub bounds: [[f64; 3]; 2],
    /// Angle in degrees between the file's axes and those of the scene's walls, which boxes run along (`--axes`).
    pub degrees_askew: f64,
    /// 1 where everything is grey, else 3.
    pub channels: usize,
    /// Faces left out at loading, ascending.
    pub dropped_faces: Vec<u32>,
    /// What was odd about the input.
    pub warnings: Vec<String>,
}

/// Sizes of the structures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct HierarchyBlock {
    /// Nodes that join connected facets, facets themselves not counted.
    pub face_clusters: usize,
    /// Nodes above them.
    pub volume_clusters: usize,
    /// Certified rectangles.
    pub occluders: usize,
    /// Leaf patches at the end of the solve.
    pub leaves: usize,
    /// Bytes held by the hierarchy.
    pub bytes: usize,
}

/// Wall time of each stage in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SecondsBlock {
    /// Reading and validating.
    pub load: f64,
    /// Face and volume clustering.
    pub cluster: f64,
    /// Extracting occluders.
    pub occluders: f64,
    /// Building Embree's scene.
    pub embree: f64,
    /// All passes.
    pub solve: f64,
    /// Writing results, up to this file.
    pub output: f64,
    /// Of `cluster`: which sides of polygons light reaches.
    pub cluster_sides: f64,
    /// Of `occluders`: rectangles on flat clusters (paper, section 3.2).
    pub occluders_rectangles: f64,
    /// Of `occluders`: solids behind rectangles.
    pub occluders_solids: f64,
    /// Of `occluders`: boxes of air.
    pub occluders_empty_boxes: f64,
}

impl StatsFile {
    /// The layout described here.
    pub const FORMAT: u32 = 1;

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// As [`write_atomically`], and [`OutputError::NotFinite`] with the key of a number that JSON
    /// cannot hold.
    pub fn write(&self, path: &Path, interrupted: &AtomicBool) -> Result<(), OutputError> {
        write_json(path, self, interrupted)
    }
}

/// Writes any value as JSON with all numbers finite, whole or not at all. No field may be an
/// `Option` that is written when absent: a null is taken for a number that is not finite.
///
/// # Errors
/// As [`StatsFile::write`].
pub fn write_json(
    path: &Path,
    value: &impl Serialize,
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    let encoding = |e: serde_json::Error| OutputError::Encoding {
        path: path.to_path_buf(),
        reason: e.to_string(),
    };
    // The encoder writes NaN and infinities as null.
    let tree = serde_json::to_value(value).map_err(encoding)?;
    if let Some(key) = first_null(&tree) {
        return Err(OutputError::NotFinite {
            path: path.to_path_buf(),
            key,
        });
    }
    let mut text = serde_json::to_vec_pretty(value).map_err(encoding)?;
    text.push(b'\n');
    write_bytes(path, &text, interrupted)
}

/// Writes a text, whole or not at all.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_text(path: &Path, text: &str, interrupted: &AtomicBool) -> Result<(), OutputError> {
    write_bytes(path, text.as_bytes(), interrupted)
}

fn write_bytes(path: &Path, bytes: &[u8], interrupted: &AtomicBool) -> Result<(), OutputError> {
    write_atomically(path, interrupted, |w| {
        w.write_all(bytes)
            .map_err(|e| OutputError::io("write", path, e))
    })
}

/// Path of the first null, such as `passes.0.unshot`.
fn first_null(value: &serde_json::Value) -> Option<String> {
    use serde_json::Value;
    let below = |key: &str, value: &Value| {
        first_null(value).map(|rest| {
            if rest.is_empty() {
                key.to_owned()
            } else {
                format!("{key}.{rest}")
            }
        })
    };
    match value {
        Value::Null => Some(String::new()),
        Value::Array(entries) => {
            (entries.iter().enumerate()).find_map(|(i, entry)| below(&i.to_string(), entry))
        }
        Value::Object(entries) => entries.iter().find_map(|(key, entry)| below(key, entry)),
        _ => None,
    }
}

impl SceneBlock {
    /// Describes a scene.
    pub fn new(scene: &Scene) -> Self {
        let (mut area, mut least, mut greatest) = (0.0, DVec3::INFINITY, DVec3::NEG_INFINITY);
        for p in 0..scene.polygons.len() {
            let corners = scene.source_corners(PolygonId::new(p));
            area += triangle_area(corners);
            for corner in corners {
                least = least.min(corner);
                greatest = greatest.max(corner);
            }
        }
        Self {
            path: scene.name.clone(),
            faces: scene.source_faces,
            polygons: scene.polygons.len(),
            area,
            bounds: [least.to_array(), greatest.to_array()],
            degrees_askew: scene.normalisation.degrees_askew(),
            channels: scene.channels(),
            dropped_faces: scene.dropped_faces.clone(),
            warnings: scene.warnings.iter().map(|w| w.0.clone()).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixture;
    use super::*;
    use std::fs;

    static GO: AtomicBool = AtomicBool::new(false);

    fn stats() -> StatsFile {
        let room = fixture::room(
            DVec3::new(-1.0, 0.0, 2.0),
            DVec3::new(1.0, 1.0, 5.0),
            fixture::grey(0.5, 1.0),
        );
        StatsFile {
            format: StatsFile::FORMAT,
            certilux: env!("CARGO_PKG_VERSION").to_owned(),
            embree: "4.3.3".to_owned(),
            command: vec![
                "certilux".to_owned(),
                "solve".to_owned(),
                "a \"b\".obj".to_owned(),
            ],
            seed: u64::MAX,
            threads: 2,
            technique: "normal".to_owned(),
            epsilon: 1e-7,
            rays_per_exchange: 8,
            quality: "normal".to_owned(),
            converge: Some(1e-3),
            settings: BTreeMap::new(),
            content: ContentBlock::default(),
            outputs: OutputsBlock::new(),
            scene: SceneBlock::new(&room),
            hierarchy: HierarchyBlock::default(),
            passes: vec![PassStatistics::default(); 2],
            seconds: SecondsBlock::default(),
            power: PowerLedger::default(),
            row_scales: None,
        }
    }

    /// The keys of the published layout, in its order.
    #[test]
    fn every_key_of_the_contract_stands_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("stats.json");
        stats().write(&path, &GO).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        let mut rest = text.as_str();
        for key in "format certilux embree command seed threads technique epsilon \
            rays_per_exchange scene path faces polygons area bounds degrees_askew channels dropped_faces warnings \
            hierarchy face_clusters volume_clusters occluders leaves bytes \
            passes pass seconds exchanges exchanges_blocked exchanges_sampled_clear rays \
            rays_blocked native_rays native_rays_blocked shafts occluded_claims visible_claims \
            exchanges_visible unshot \
            seconds load cluster occluders embree solve output \
            cluster_sides occluders_rectangles occluders_solids occluders_empty_boxes \
            power emitted absorbed escaped escaped_stderr unshot imbalance"
            .split_whitespace()
        {
            let quoted = format!("\"{key}\":");
            let place = rest.find(&quoted).unwrap_or_else(|| panic!("{key} is missing"));
            rest = &rest[place + quoted.len()..];
        }
        let tree: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(tree["seed"], u64::MAX);
        assert_eq!(tree["scene"]["bounds"][1][2], 5.0);
        assert_eq!(tree["scene"]["polygons"], 12);
        assert_eq!(tree["passes"].as_array().unwrap().len(), 2);
    }

    #[test]
    fn the_area_is_that_of_one_side() {
        let area = stats().scene.area;
        assert!((area - 2.0 * (2.0 + 3.0 + 6.0)).abs() < 1e-12, "{area}");
    }

    #[test]
    fn the_same_numbers_give_the_same_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a"), folder.path().join("b"));
        stats().write(&a, &GO).unwrap();
        stats().write(&b, &GO).unwrap();
        assert_eq!(fs::read(a).unwrap(), fs::read(b).unwrap());
    }

    #[test]
    fn a_number_that_is_not_finite_is_refused_by_key() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("stats.json");
        for bad in [f64::NAN, f64::INFINITY] {
            let mut stats = stats();
            stats.passes[1].unshot = bad;
            let error = stats.write(&path, &GO).unwrap_err();
            assert!(error.to_string().contains("passes.1.unshot"), "{error}");
            assert!(!path.exists());
        }
    }
}
