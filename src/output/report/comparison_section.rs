//! A comparison of techniques in the report: the paper's Table 1 beside ours.

use super::html::{Cell, escaped, table};
use crate::experiment::{paper_row, paper_shares};
use crate::solve::Technique;
use serde::Deserialize;
use std::fmt::Write;

/// What the report reads of a comparison's JSON.
#[derive(Debug, Deserialize)]
pub struct Comparison {
    embree: String,
    threads: u64,
    repeats: u64,
    summary: Vec<Summary>,
    rows: Vec<Row>,
}

#[derive(Debug, Deserialize)]
struct Summary {
    technique: String,
    speedup: f64,
    speedup_first: f64,
    speedup_later: f64,
    worst: f64,
    best: f64,
    /// Absent where no ray is cast.
    fewer_rays: Option<f64>,
}

#[derive(Debug, Deserialize)]
struct Row {
    scene: String,
    pass: u32,
    technique: String,
    seconds: Seconds,
    counts: Counts,
    max_occlusion_percent: f64,
    detected_occlusion_percent: f64,
    full_visibility_percent: f64,
    visibility_cost_removed_percent: f64,
    speedup: f64,
}

#[derive(Debug, Deserialize)]
struct Seconds {
    median: f64,
    lower_quartile: f64,
    upper_quartile: f64,
}

#[derive(Debug, Deserialize)]
struct Counts {
    exchanges: u64,
    rays: u64,
    native_rays: u64,
    shafts: u64,
}

/// The section of one comparison.
pub fn comparison_section(name: &str, comparison: &Comparison) -> String {
    let mut out = format!(
        "<section><h2>{}</h2>\n<p>Techniques side by side, {} repeats, {} threads, Embree {}. Every pass starts from what <i>normal</i> left before it, \
         so that the rows compare the same work. The paper's times are those of its machine and its ray tracer: compare ratios.</p>\n",
        escaped(name),
        comparison.repeats,
        comparison.threads,
        escaped(&comparison.embree)
    );
    let rows: Vec<Vec<Cell>> = comparison.summary.iter().map(summary_row).collect();
    out.push_str(&table(
        "Ratios to normal, geometric means over the rows",
        &[
            "technique",
            "all passes",
            "first passes",
            "later passes",
            "worst row",
            "best row",
            "fewer rays",
        ],
        &rows,
    ));
    let rows: Vec<Vec<Cell>> = comparison.rows.iter().map(table_row).collect();
    out.push_str(&table(
        "Table 1 of the paper beside this run",
        &[
            "scene",
            "pass",
            "technique",
            "seconds",
            "quartiles",
            "speed-up",
            "exchanges",
            "rays",
            "native rays",
            "shafts",
            "blocked %",
            "of it detected %",
            "visible %",
            "visibility cost removed %",
            "paper: seconds",
            "paper: blocked %",
            "paper: detected %",
            "paper: visible %",
        ],
        &rows,
    ));
    let losing: Vec<String> = (comparison.rows.iter())
        .filter(|row| row.speedup < 1.0 && row.technique != "unoccluded")
        .map(|row| {
            format!(
                "{} pass {} {}: {:.2}",
                row.scene, row.pass, row.technique, row.speedup
            )
        })
        .collect();
    if !losing.is_empty() {
        let _ = writeln!(
            out,
            "<p>Rows slower than <i>normal</i>: {}.</p>",
            escaped(&losing.join("; "))
        );
    }
    out.push_str("</section>\n");
    out
}

fn summary_row(summary: &Summary) -> Vec<Cell> {
    // A comparison of first passes alone has no mean of later ones.
    let mean = |x: f64| Cell::maybe((x > 0.0).then_some(x));
    vec![
        Cell::text(&summary.technique),
        mean(summary.speedup),
        mean(summary.speedup_first),
        mean(summary.speedup_later),
        Cell::quantity(summary.worst),
        Cell::quantity(summary.best),
        // Earlier versions divided by one where no ray was cast.
        Cell::maybe(
            summary
                .fewer_rays
                .filter(|_| summary.technique != "unoccluded"),
        ),
    ]
}

fn table_row(row: &Row) -> Vec<Cell> {
    let scene = row.scene.strip_prefix("builtin:").unwrap_or(&row.scene);
    let technique = [
        Technique::Normal,
        Technique::Visibility,
        Technique::Occlusion,
    ]
    .into_iter()
    .find(|t| t.name() == row.technique);
    let paper = technique.and_then(|t| paper_row(scene, row.pass, t));
    let shares = technique.and_then(|_| paper_shares(scene, row.pass));
    vec![
        Cell::text(scene),
        Cell::count(u64::from(row.pass)),
        Cell::text(&row.technique),
        Cell::quantity(row.seconds.median),
        Cell::text(&format!(
            "{:.3} to {:.3}",
            row.seconds.lower_quartile, row.seconds.upper_quartile
        )),
        Cell::quantity(row.speedup),
        Cell::count(row.counts.exchanges),
        Cell::count(row.counts.rays),
        Cell::count(row.counts.native_rays),
        Cell::count(row.counts.shafts),
        Cell::quantity(row.max_occlusion_percent),
        Cell::quantity(row.detected_occlusion_percent),
        Cell::quantity(row.full_visibility_percent),
        Cell::quantity(row.visibility_cost_removed_percent),
        Cell::maybe(paper.as_ref().map(|p| p.seconds)),
        Cell::maybe(shares.as_ref().map(|s| s.max_occlusion_percent)),
        Cell::maybe(shares.as_ref().map(|s| s.detected_occlusion_percent)),
        Cell::maybe(shares.as_ref().map(|s| s.full_visibility_percent)),
    ]
}
