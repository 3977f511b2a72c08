//! `growth.csv` and `growth.md`.

use crate::fit::exponent;
use crate::stages::{Measurement, RoomSettings, Stage};
use std::fmt::Write;
use std::path::Path;

pub fn gibibytes(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 30)
}

/// Writes both files over all sizes measured so far; at least one.
pub fn write(folder: &Path, settings: &RoomSettings, all: &[Measurement]) -> std::io::Result<()> {
    std::fs::write(folder.join("growth.csv"), csv(all))?;
    std::fs::write(folder.join("growth.md"), markdown(settings, all))
}

fn csv(all: &[Measurement]) -> String {
    let mut text = String::from(
        "polygons,rooms,epsilon,stage,seconds,peak_bytes,exchanges,rays,native_rays,shafts,occluders,leaves,imbalance\n",
    );
    for m in all {
        for stage in &m.stages {
            let _ = writeln!(
                text,
                "{},{},{:e},{},{},{},{},{},{},{},{},{},{}",
                m.polygons,
                m.rooms,
                m.epsilon,
                stage.name,
                stage.seconds,
                stage.peak_bytes,
                m.exchanges,
                m.rays,
                m.native_rays,
                m.shafts,
                m.occluders,
                m.leaves,
                m.imbalance
            );
        }
    }
    text
}

/// A row: a name, a cell a size, and the exponent of what the cells show.
fn row(
    text: &mut String,
    name: &str,
    all: &[Measurement],
    value: impl Fn(&Measurement) -> f64,
    cell: impl Fn(f64) -> String,
) {
    let points: Vec<(f64, f64)> = all.iter().map(|m| (m.polygons as f64, value(m))).collect();
    let cells: Vec<String> = points.iter().map(|p| cell(p.1)).collect();
    let fitted = exponent(&points).map_or_else(|| "-".to_owned(), |e| format!("{e:.2}"));
    let _ = writeln!(text, "| {name} | {} | {fitted} |", cells.join(" | "));
}

fn header(text: &mut String, first: &str, all: &[Measurement]) {
    let sizes: Vec<String> = all.iter().map(|m| m.polygons.to_string()).collect();
    let _ = writeln!(
        text,
        "\n| {first} | {} | exponent |\n|---|{}---|",
        sizes.join(" | "),
        "---|".repeat(sizes.len())
    );
}

fn markdown(settings: &RoomSettings, all: &[Measurement]) -> String {
    let mut text = format!(
        "# Growth: arrays of rooms, `{}`, one pass\n\nOf a single room: epsilon {:e}, smallest patch {:e}, gradient {}; epsilon, smallest patch and smallest occluder (1e-4) of an array are these over the number of rooms. Exponents are fitted over polygons, in log-log.\n",
        settings.technique.name(),
        settings.epsilon,
        settings.min_area,
        settings.gradient
    );
    let stage = |m: &Measurement, name: &str| -> Stage {
        // Every size runs the same stages.
        m.stages
            .iter()
            .find(|s| s.name == name)
            .expect("a stage of every size")
            .clone()
    };
    type OfStage = fn(&Stage) -> f64;
    type Cell = fn(f64) -> String;
    let seconds: (OfStage, Cell) = (|s| s.seconds, |x| format!("{x:.3}"));
    let memory: (OfStage, Cell) = (
        |s| s.peak_bytes as f64,
        |x| format!("{:.1}", x / f64::from(1 << 20)),
    );
    let stages = |text: &mut String, what: &str, (value, cell): (OfStage, Cell)| {
        header(text, what, all);
        for Stage { name, .. } in &all[0].stages {
            row(text, name, all, |m| value(&stage(m, name)), cell);
        }
    };
    stages(&mut text, "seconds", seconds);
    row(&mut text, "all", all, Measurement::seconds, seconds.1);
    stages(&mut text, "greatest memory, MiB", memory);
    header(&mut text, "counts", all);
    let count = |x: f64| format!("{x}");
    row(&mut text, "rooms", all, |m| m.rooms as f64, count);
    row(&mut text, "exchanges", all, |m| m.exchanges as f64, count);
    row(&mut text, "Embree rays", all, |m| m.rays as f64, count);
    row(
        &mut text,
        "native rays",
        all,
        |m| m.native_rays as f64,
        count,
    );
    row(&mut text, "shafts", all, |m| m.shafts as f64, count);
    row(&mut text, "occluders", all, |m| m.occluders as f64, count);
    row(&mut text, "leaf patches", all, |m| m.leaves as f64, count);
    row(
        &mut text,
        "imbalance",
        all,
        |m| m.imbalance,
        |x| format!("{x:+.4}"),
    );
    text
}
