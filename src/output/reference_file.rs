//! `REF.json`: radiosity a face and side, with standard errors. Written by `certilux reference`, read by
//! `certilux error`, which takes the files of other programs too.

use super::{HashText, OutputError, write_atomically};
use crate::reference::{FaceRadiosity, Reference};
use crate::scene::Side;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// How a reference was made.
#[derive(Clone, Debug, Serialize)]
pub struct ReferenceMeta {
    /// Version of this layout: [`ReferenceMeta::FORMAT`].
    pub format: u32,
    /// Version of this program.
    pub certilux: String,
    /// Version of the Embree library that ran.
    pub embree: String,
    /// The command line.
    pub command: Vec<String>,
    /// The OBJ file, or `builtin:NAME`.
    pub scene: String,
    /// Hash of its content ([`super::scene_hash`]).
    pub scene_hash: HashText,
    /// Which sides were given to the scene.
    pub sides: String,
    /// Seed of every path.
    pub seed: u64,
    /// Worker threads.
    pub threads: usize,
    /// The asked standard error.
    pub error: f64,
    /// The asked limit of time, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_seconds: Option<f64>,
    /// The asked number of faces, if a sample.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub faces: Option<u32>,
    /// Whether every face was given the paths that the asked error takes, before time was up.
    pub reached: bool,
    /// Rounds run: with equal input and seed, equal rounds give equal faces.
    pub rounds: u32,
    /// Paths that the answer is made of.
    pub paths: u64,
    /// Rays cast.
    pub rays: u64,
    /// Wall time of the measurement.
    pub seconds: f64,
    /// Area-weighted mean of the standard errors, mean of the channels, in W/m2.
    pub mean_stderr: f64,
    /// The same over the area-weighted mean radiosity; 0 where all is black.
    pub mean_stderr_relative: f64,
    /// The error that a perfect solution would show, as `certilux error` has it: relative RMS of reflected
    /// radiosity; 0 where nothing is reflected.
    pub noise: f64,
    /// The same in the metric of the bias.
    pub bias_noise: f64,
}

impl ReferenceMeta {
    /// Version of the layout.
    pub const FORMAT: u32 = 1;
}

/// What a reference was asked to be of: those parts of [`ReferenceMeta`] by which one is known again.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct ReferenceRequest {
    /// Hash of the scene's content.
    pub scene_hash: HashText,
    /// Which sides were given to the scene.
    pub sides: String,
    /// The asked standard error.
    pub error: f64,
    /// The asked limit of time, if any.
    #[serde(default)]
    pub max_seconds: Option<f64>,
}

impl ReferenceRequest {
    /// What the reference in a file was asked to be of; nothing where the file does not say.
    pub fn of_file(path: &Path) -> Option<Self> {
        #[derive(Deserialize)]
        struct File {
            meta: ReferenceRequest,
        }
        let bytes = fs::read(path).ok()?;
        serde_json::from_slice::<File>(&bytes)
            .ok()
            .map(|file| file.meta)
    }
}

/// A reference as it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadReference {
    /// Its records, in the file's order: at least one, none of a face and side twice.
    pub faces: Vec<ReferenceFace>,
    /// Hash of the scene that it was measured of; nothing where the file does not say.
    pub scene_hash: Option<HashText>,
}

/// Area-weighted means of radiosity and of its standard error, mean of the channels, in W/m2.
pub fn mean_radiosity(faces: &[FaceRadiosity]) -> [f64; 2] {
    let mut sums = [0.0; 3];
    for face in faces {
        sums[0] += face.area;
        sums[1] += face.area * mean(face.radiosity);
        sums[2] += face.area * mean(face.standard_error);
    }
    if sums[0] > 0.0 {
        [sums[1] / sums[0], sums[2] / sums[0]]
    } else {
        [0.0; 2]
    }
}

/// One record of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferenceFace {
    /// 0-based index of the `f` statement, in file order.
    pub face_index: u32,
    /// 0 front, 1 back; front where it is not said.
    #[serde(default)]
    pub side: u8,
    /// Area in the square of the file's units.
    pub area: f64,
    /// Mean radiosity in W/m2, emission included.
    #[serde(rename = "B_rgb")]
    pub radiosity: [f64; 3],
    /// Its standard error.
    #[serde(rename = "stderr_rgb")]
    pub standard_error: [f64; 3],
    /// Diffuse reflectance.
    #[serde(rename = "Kd_rgb", default, skip_serializing_if = "Option::is_none")]
    pub reflectance: Option<[f64; 3]>,
    /// Emitted radiance in W/m2/sr.
    #[serde(rename = "Ke_rgb", default, skip_serializing_if = "Option::is_none")]
    pub emission: Option<[f64; 3]>,
}

impl From<&FaceRadiosity> for ReferenceFace {
    fn from(face: &FaceRadiosity) -> Self {
        Self {
            face_index: face.face,
            side: u8::from(face.side == Side::Back),
            area: face.area,
            radiosity: face.radiosity,
            standard_error: face.standard_error,
            reflectance: Some(face.reflectance),
            emission: Some(face.emission),
        }
    }
}

/// Writes a reference, one record a line.
///
/// # Errors
/// As [`write_atomically`]; [`OutputError::NotFinite`] where a number is none.
pub fn write_reference(
    path: &Path,
    meta: &ReferenceMeta,
    reference: &Reference,
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    let encoding = |e: serde_json::Error| OutputError::Encoding {
        path: path.to_path_buf(),
        reason: e.to_string(),
    };
    let mut text = format!(
        "{{\"meta\": {},\n\"faces\": [",
        serde_json::to_string_pretty(meta).map_err(encoding)?
    );
    for (i, face) in reference.faces.iter().enumerate() {
        let record = ReferenceFace::from(face);
        if let Some(problem) = problem(&record) {
            return Err(OutputError::NotFinite {
                path: path.to_path_buf(),
                key: format!("faces.{i}: {problem}"),
            });
        }
        text.push_str(if i == 0 { "\n" } else { ",\n" });
        text.push_str(&serde_json::to_string(&record).map_err(encoding)?);
    }
    text.push_str("\n]}\n");
    write_atomically(path, interrupted, |w| {
        w.write_all(text.as_bytes())
            .map_err(|e| OutputError::io("write", path, e))
    })
}

/// Reads a reference; `meta` may hold anything or be absent.
///
/// # Errors
/// [`OutputError::Io`] where it cannot be read, [`OutputError::NotAReference`] with the reason where it is
/// none: no JSON, no faces, a record twice, a number out of range.
pub fn read_reference(path: &Path) -> Result<ReadReference, OutputError> {
    #[derive(Deserialize)]
    struct File {
        #[serde(default)]
        meta: serde_json::Value,
        faces: Vec<ReferenceFace>,
    }
    let wrong = |reason: String| OutputError::NotAReference {
        path: path.to_path_buf(),
        reason,
    };
    let bytes = fs::read(path).map_err(|e| OutputError::io("read", path, e))?;
    let file: File = serde_json::from_slice(&bytes).map_err(|e| wrong(e.to_string()))?;
    if file.faces.is_empty() {
        return Err(wrong("it has no faces".to_owned()));
    }
    let mut seen = BTreeSet::new();
    for (i, face) in file.faces.iter().enumerate() {
        let problem = problem(face).or_else(|| {
            (!seen.insert((face.face_index, face.side)))
                .then(|| "its face and side stood there before".to_owned())
        });
        if let Some(problem) = problem {
            return Err(wrong(format!(
                "record {i} (face_index {}): {problem}",
                face.face_index
            )));
        }
    }
    Ok(ReadReference {
        faces: file.faces,
        scene_hash: file.meta["scene_hash"].as_str().map(str::to_owned),
    })
}

/// What is wrong with a record.
fn problem(face: &ReferenceFace) -> Option<String> {
    if !(face.area > 0.0 && face.area.is_finite()) {
        return Some("its area is not a positive finite number".to_owned());
    }
    if face.side > 1 {
        return Some("its side is neither 0 nor 1".to_owned());
    }
    let lists = [
        ("B_rgb", Some(face.radiosity)),
        ("stderr_rgb", Some(face.standard_error)),
        ("Kd_rgb", face.reflectance),
        ("Ke_rgb", face.emission),
    ];
    for (key, list) in lists {
        for x in list.into_iter().flatten() {
            if !(x >= 0.0 && x.is_finite()) {
                return Some(format!("{key} holds {x}, which is negative or not finite"));
            }
        }
    }
    None
}

/// Mean of the channels.
pub(super) fn mean(colour: [f64; 3]) -> f64 {
    colour.iter().sum::<f64>() / 3.0
}
