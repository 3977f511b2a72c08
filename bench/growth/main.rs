//! How time and memory of every stage grow with the scene: arrays of rooms, with epsilon proportional to 1 / rooms, so
//! that each room is the same work.
//!
//! `growth --out DIR --polygons 1000,10000,100000,1000000` writes `growth.csv` and `growth.md` into DIR. Each size runs in a
//! process of its own.

mod fit;
mod memory;
mod report;
mod rooms;
mod stages;

use certilux::solve::Technique;
use stages::{Measurement, RoomSettings};
use std::path::PathBuf;
use std::process::{Command, ExitCode, Stdio};

struct Arguments {
    out: PathBuf,
    polygons: Vec<usize>,
    settings: RoomSettings,
    /// The one size that a child measures.
    only: Option<usize>,
}

const USAGE: &str = "growth --out DIR [--polygons 1000,10000] [--technique NAME] [--epsilon X] [--min-area X] [--gradient X], \
                     the last three of a single room";

fn parse() -> Result<Arguments, String> {
    let mut found = Arguments {
        out: PathBuf::new(),
        polygons: vec![1_000, 10_000],
        settings: RoomSettings::default(),
        only: None,
    };
    let number = |text: &str| {
        text.parse()
            .map_err(|_| format!("{text:?} is no number of polygons"))
    };
    let share = |text: &str| match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
        _ => Err(format!("{text:?} is no positive number")),
    };
    let mut words = std::env::args().skip(1);
    while let Some(flag) = words.next() {
        let value = words.next().ok_or_else(|| USAGE.to_owned())?;
        match flag.as_str() {
            "--out" => found.out = value.into(),
            "--polygons" => {
                found.polygons = value.split(',').map(number).collect::<Result<_, _>>()?;
            }
            "--only" => found.only = Some(number(&value)?),
            "--technique" => {
                let all = [
                    Technique::Normal,
                    Technique::Visibility,
                    Technique::Occlusion,
                    Technique::Blockers,
                ];
                let known = all.into_iter().find(|t| t.name() == value);
                found.settings.technique = known.ok_or_else(|| USAGE.to_owned())?;
            }
            "--epsilon" => found.settings.epsilon = share(&value)?,
            "--min-area" => found.settings.min_area = share(&value)?,
            "--gradient" => found.settings.gradient = share(&value)?,
            _ => return Err(USAGE.to_owned()),
        }
    }
    let enough = found.only.is_some() || !found.out.as_os_str().is_empty();
    enough.then_some(found).ok_or_else(|| USAGE.to_owned())
}

/// Measures one size in a process that does nothing else.
fn measure_apart(polygons: usize, settings: &RoomSettings) -> Result<Measurement, String> {
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let output = Command::new(program)
        .args(["--technique", settings.technique.name()])
        .args(["--epsilon", &settings.epsilon.to_string()])
        .args(["--min-area", &settings.min_area.to_string()])
        .args(["--gradient", &settings.gradient.to_string()])
        .args(["--only", &polygons.to_string()])
        .stderr(Stdio::inherit())
        .output()
        .map_err(|e| e.to_string())?;
    if !output.status.success() {
        return Err(format!("{polygons} polygons: {}", output.status));
    }
    serde_json::from_slice(&output.stdout).map_err(|e| format!("{polygons} polygons: {e}"))
}

fn run() -> Result<(), String> {
    let arguments = parse()?;
    if let Some(polygons) = arguments.only {
        let measured = stages::measure(polygons, &arguments.settings)?;
        println!(
            "{}",
            serde_json::to_string(&measured).map_err(|e| e.to_string())?
        );
        return Ok(());
    }
    std::fs::create_dir_all(&arguments.out)
        .map_err(|e| format!("{}: {e}", arguments.out.display()))?;
    let mut all = Vec::new();
    for &polygons in &arguments.polygons {
        let measured = measure_apart(polygons, &arguments.settings)?;
        eprintln!(
            "{} polygons, {} rooms: {:.1} s, {:.2} GiB at most",
            measured.polygons,
            measured.rooms,
            measured.seconds(),
            report::gibibytes(measured.peak())
        );
        all.push(measured);
        // After every size: the next may be too large for the machine.
        report::write(&arguments.out, &arguments.settings, &all).map_err(|e| e.to_string())?;
    }
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("growth: {message}");
            ExitCode::FAILURE
        }
    }
}
