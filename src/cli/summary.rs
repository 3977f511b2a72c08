//! The few lines a person reads at the end of a solve.

use super::session::print_line;
use crate::output::StatsFile;
use std::path::PathBuf;

/// Angle in degrees from which on walls are said to be off the file's axes.
const LEAST_ASKEW: f64 = 0.005;
/// Share of the emitted power, in per cent, from which it is worth a line that nothing receives it.
const LEAST_SWALLOWED: f64 = 0.01;

/// Prints what was done, how sure it is, and which files hold it.
pub fn print_summary(stats: &StatsFile, files: &[PathBuf]) {
    let power = &stats.power;
    let share = |x: f64| {
        if power.emitted > 0.0 {
            100.0 * x / power.emitted
        } else {
            0.0
        }
    };
    let exchanges: u64 = stats.passes.iter().map(|p| p.exchanges).sum();
    let rays: u64 = stats.passes.iter().map(|p| p.rays).sum();
    print_line(format_args!(
        "{}: {} polygons, {} leaf patches, {} channel(s), Embree {}",
        stats.scene.path,
        stats.scene.polygons,
        stats.hierarchy.leaves,
        stats.scene.channels,
        stats.embree
    ));
    if stats.scene.degrees_askew > LEAST_ASKEW {
        print_line(format_args!(
            "its walls stand {:.2} degrees off the file's axes; boxes run along the walls",
            stats.scene.degrees_askew
        ));
    }
    print_line(format_args!(
        "{} pass(es), {exchanges} exchanges, {rays} rays, technique {}, {} thread(s)",
        stats.passes.len(),
        stats.technique,
        stats.threads
    ));
    print_line(format_args!(
        "power: {:.4} W emitted = {:.2} % absorbed + {:.2} % escaped (+- {:.2}) + {:.3} % unshot; imbalance {:+.3} %",
        power.emitted,
        share(power.absorbed),
        share(power.escaped),
        share(power.escaped_stderr),
        share(power.unshot),
        100.0 * power.imbalance
    ));
    if power.extrapolated > 0.0 {
        print_line(format_args!(
            "of what is absorbed, {:.3} % of the emitted power is that of passes not made: the last one, continued as a geometric series",
            share(power.extrapolated)
        ));
    }
    if share(power.swallowed) >= LEAST_SWALLOWED {
        print_line(format_args!(
            "of what is absorbed, {:.2} % of the emitted power ends on backs that have no side, or between surfaces that touch",
            share(power.swallowed)
        ));
    }
    if let Some(scales) = &stats.row_scales {
        let least = scales.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = scales.iter().copied().fold(0.0, f64::max);
        print_line(format_args!(
            "row normalisation: what arrived in a pass was scaled by {least:.6} to {greatest:.6}"
        ));
    }
    let s = &stats.seconds;
    print_line(format_args!(
        "seconds: load {:.2}, Embree {:.2}, hierarchy {:.2}, occluders {:.2}, solve {:.2}, output {:.2}",
        s.load, s.embree, s.cluster, s.occluders, s.solve, s.output
    ));
    for file in files {
        print_line(format_args!("wrote {}", file.display()));
    }
}
