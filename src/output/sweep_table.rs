//! `sweep.csv` and `sweep.json`: a row a setting, and the reader that a sweep goes on from.

use super::{OutputError, write_json};
use crate::experiment::{
    SweepOutcome, SweepRow, SweepSettings, SweepTiming, stride_name, sweep_fronts,
};
use crate::solve::Normalise;
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// What has to be the same for rows to stand in one table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepKey {
    /// Version of this layout: [`SweepKey::FORMAT`].
    pub format: u32,
    /// Version of this program.
    pub certilux: String,
    /// Version of the Embree library that ran.
    pub embree: String,
    /// Hash of the scene's content, in hexadecimal.
    pub scene_hash: String,
    /// Which sides were given to the scene.
    pub sides: String,
    /// Seed of the sample points.
    pub seed: u64,
    /// Whether passes are scaled to conserve power.
    pub normalise: Normalise,
    /// Worker threads.
    pub threads: usize,
    /// Faces of the reference that are compared.
    pub reference_faces: usize,
    /// Area-weighted mean of the reference's reflected radiosity, in W/m2.
    pub reference_mean: f64,
}

impl SweepKey {
    /// Version of the layout.
    pub const FORMAT: u32 = 1;

    /// In what `found` differs from this, for a message.
    fn difference(&self, found: &Self) -> String {
        let [here, there] = [self, found].map(|key| serde_json::json!(key));
        let names = here
            .as_object()
            .into_iter()
            .flat_map(|object| object.keys());
        let different: Vec<String> = names
            .filter(|&name| here[name] != there[name])
            .map(|name| format!("{name} is {} there and {} here", there[name], here[name]))
            .collect();
        different.join("; ")
    }
}

/// What `sweep.json` says beside its rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepMeta {
    /// What the rows have in common.
    pub key: SweepKey,
    /// The command line.
    pub command: Vec<String>,
    /// The OBJ file, or `builtin:NAME`.
    pub scene: String,
    /// Its triangles.
    pub polygons: usize,
    /// The reference, as it was named.
    pub reference: String,
    /// Wall time of sides, clusters and Embree, which all rows share and none includes.
    pub prepare_seconds: f64,
    /// Solves asked of each row.
    pub repeats: usize,
}

/// Settings with a name of their own: presets, the defaults among them.
pub type NamedSettings = [(&'static str, SweepSettings)];

/// The name of the defaults among [`NamedSettings`].
pub const DEFAULTS: &str = "normal";

fn name_of<'a>(settings: &SweepSettings, names: &'a NamedSettings) -> &'a str {
    let found = names.iter().find(|(_, named)| named == settings);
    found.map_or("", |(name, _)| name)
}

/// The table as CSV, one line a row that has been solved; times are medians. `names` are told apart in
/// the column `quality`.
pub fn sweep_csv(scene: &str, rows: &[SweepRow], names: &NamedSettings) -> String {
    let mut text = String::from(
        "scene,technique,epsilon,rays_per_exchange,stride,occluders_per_cluster,occluder_size,flatness,gradient,\
         min_area,converge,quality,repeats,seconds,processor_seconds,passes,exchanges,exchanges_blocked,\
         exchanges_visible,rays,rays_blocked,native_rays,shafts,occluders,leaves,relative_rms,bias,reference_noise,\
         imbalance,unshot,front_seconds,front_rays\n",
    );
    let scene = match scene.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", scene.replace('"', "\"\"")),
        false => scene.to_owned(),
    };
    for (row, [seconds_front, rays_front]) in rows.iter().zip(sweep_fronts(rows)) {
        let (Some(outcome), Some(seconds), Some(processor)) =
            (row.outcome, row.seconds(), row.processor_seconds())
        else {
            continue;
        };
        let (s, o) = (&row.settings, &outcome);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{scene},{},{:e},{},{},{},{:e},{},{:e},{:e},{:e},{},{},{:.6},{:.6},{},{},{},{},{},{},{},{},{},{},{:.8},{:.8},{:.8},{:.8},{:.8},{},{}",
            s.technique.name(),
            s.epsilon,
            s.rays,
            stride_name(s.stride),
            s.occluders,
            s.occluder_size,
            s.flatness,
            s.gradient,
            s.min_area,
            s.converge,
            name_of(s, names),
            row.timings.len(),
            seconds.median,
            processor.median,
            o.passes,
            o.exchanges,
            o.exchanges_blocked,
            o.exchanges_visible,
            o.rays,
            o.rays_blocked,
            o.native_rays,
            o.shafts,
            o.occluder_count,
            o.leaves,
            o.relative_rms,
            o.bias,
            o.reference_noise,
            o.imbalance,
            o.unshot,
            u8::from(seconds_front),
            u8::from(rays_front),
        );
    }
    text
}

#[derive(Serialize)]
struct File<'a> {
    #[serde(flatten)]
    meta: &'a SweepMeta,
    rows: Vec<Record<'a>>,
}

#[derive(Serialize)]
struct Record<'a> {
    settings: &'a SweepSettings,
    quality: &'a str,
    seconds: f64,
    processor_seconds: f64,
    front_seconds: bool,
    front_rays: bool,
    outcome: SweepOutcome,
    timings: &'a [SweepTiming],
}

/// Writes the rows that have been solved, with every timing.
///
/// # Errors
/// As [`write_json`].
pub fn write_sweep(
    path: &Path,
    meta: &SweepMeta,
    rows: &[SweepRow],
    names: &NamedSettings,
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    let records = rows.iter().zip(sweep_fronts(rows));
    let file = File {
        meta,
        rows: records
            .filter_map(|(row, [front_seconds, front_rays])| {
                Some(Record {
                    settings: &row.settings,
                    quality: name_of(&row.settings, names),
                    seconds: row.seconds()?.median,
                    processor_seconds: row.processor_seconds()?.median,
                    front_seconds,
                    front_rays,
                    outcome: row.outcome?,
                    timings: &row.timings,
                })
            })
            .collect(),
    };
    write_json(path, &file, interrupted)
}

/// Reads what an earlier sweep left.
///
/// # Errors
/// [`OutputError::Io`] where it cannot be read; [`OutputError::NotASweep`] where it is none, or one of other
/// rows than `key` says.
pub fn read_sweep(path: &Path, key: &SweepKey) -> Result<Vec<SweepRow>, OutputError> {
    #[derive(Deserialize)]
    struct Kept {
        key: SweepKey,
        rows: Vec<KeptRow>,
    }
    #[derive(Deserialize)]
    struct KeptRow {
        settings: SweepSettings,
        outcome: SweepOutcome,
        timings: Vec<SweepTiming>,
    }
    let wrong = |reason: String| OutputError::NotASweep {
        path: path.to_path_buf(),
        reason,
    };
    let bytes = fs::read(path).map_err(|e| OutputError::io("read", path, e))?;
    let kept: Kept = serde_json::from_slice(&bytes).map_err(|e| wrong(e.to_string()))?;
    if kept.key != *key {
        return Err(wrong(format!(
            "its rows are of another sweep: {}",
            key.difference(&kept.key)
        )));
    }
    let mut rows: Vec<SweepRow> = Vec::with_capacity(kept.rows.len());
    for row in kept.rows {
        let finite = |t: &SweepTiming| t.seconds >= 0.0 && t.processor_seconds >= 0.0;
        if row.timings.is_empty() || !row.timings.iter().all(finite) {
            return Err(wrong("a row has no timing".to_owned()));
        }
        if rows.iter().any(|before| before.settings == row.settings) {
            return Err(wrong("a row stands twice".to_owned()));
        }
        rows.push(SweepRow {
            settings: row.settings,
            timings: row.timings,
            outcome: Some(row.outcome),
        });
    }
    Ok(rows)
}
