//! Writes a comparison of techniques: CSV for programs, Markdown for people, with the paper's figures
//! beside ours.

use crate::experiment::{ComparisonRow, ComparisonSummary, paper_row, paper_shares};
use crate::solve::Technique;
use std::fmt::Write;

/// Name of a scene as the paper's table knows it.
fn paper_name(scene: &str) -> &str {
    scene.strip_prefix("builtin:").unwrap_or(scene)
}

/// The table as CSV, one line a row.
pub fn comparison_csv(rows: &[ComparisonRow]) -> String {
    let mut text = String::from(
        "scene,pass,technique,seconds,exchanges,exchanges_blocked,rays,rays_blocked,native_rays,shafts,\
         max_occlusion_percent,detected_occlusion_percent,full_visibility_percent,\
         visibility_cost_removed_percent,speedup\n",
    );
    for row in rows {
        let c = &row.counts;
        let quoted = row.scene.contains([',', '"', '\n']);
        let scene = match quoted {
            true => format!("\"{}\"", row.scene.replace('"', "\"\"")),
            false => row.scene.clone(),
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{scene},{},{},{:.6},{},{},{},{},{},{},{:.3},{:.3},{:.3},{:.3},{:.4}",
            row.pass,
            row.technique.name(),
            row.seconds.median,
            c.exchanges,
            c.exchanges_blocked,
            c.rays,
            c.rays_blocked,
            c.native_rays,
            c.shafts,
            row.max_occlusion_percent,
            row.detected_occlusion_percent,
            row.full_visibility_percent,
            row.visibility_cost_removed_percent,
            row.speedup
        );
    }
    text
}

/// The table and its summary as Markdown. Counts are in millions; the paper's figures stand in round brackets, quartiles
/// in square ones.
pub fn comparison_markdown(
    rows: &[ComparisonRow],
    summaries: &[ComparisonSummary],
    about: &str,
) -> String {
    let mut text = format!(
        "{about}\n\n\
         Counts in millions; in round brackets what the paper printed. `seconds` are medians, with the quartiles in square \
         brackets; the paper's are left out. `speed-up` is the median time of `normal` over the \
         row's; `cost removed` the time saved over the time that `unoccluded` saves. Every technique's pass k starts \
         from the state of `normal` after pass k - 1. `unoccluded` sets every visibility to 1 and is there to show \
         what visibility costs.\n\n\
         | scene | pass | technique | seconds | exchanges | blocked | rays | native rays | shafts | full occlusion % | \
         detected % | full visibility % | cost removed % | speed-up |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n"
    );
    for row in rows {
        let scene = paper_name(&row.scene);
        let paper = paper_row(scene, row.pass, row.technique);
        let shares = paper_shares(scene, row.pass);
        let normal = paper_row(scene, row.pass, Technique::Normal);
        let beside = |value: Option<f64>, digits: usize| {
            value.map_or(String::new(), |v| format!(" ({v:.digits$})"))
        };
        let million = |count: u64| format!("{:.3}", count as f64 / 1.0e6);
        let c = &row.counts;
        let is_normal = row.technique == Technique::Normal;
        let proves = row.technique.proves_visibility();
        let _ = writeln!(
            text,
            "| {scene} | {} | {} | {:.3} [{:.3}, {:.3}] | {}{} | {}{} | {}{} | {} | {}{} | {} | {} | {} | {} | {:.2}{} |",
            row.pass,
            row.technique.name(),
            row.seconds.median,
            row.seconds.lower_quartile,
            row.seconds.upper_quartile,
            million(c.exchanges),
            beside(paper.map(|p| p.exchanges), 2),
            million(c.exchanges_blocked),
            beside(paper.map(|p| p.exchanges_blocked), 2),
            million(c.rays),
            beside(paper.map(|p| p.rays), 1),
            million(c.native_rays),
            million(c.shafts),
            beside(paper.filter(|_| proves).map(|p| p.shafts), 2),
            match is_normal {
                true => format!(
                    "{:.0}{}",
                    row.max_occlusion_percent,
                    beside(shares.map(|s| s.max_occlusion_percent), 0)
                ),
                false => String::new(),
            },
            match row.technique.proves_occlusion() {
                true => format!(
                    "{:.0}{}",
                    row.detected_occlusion_percent,
                    beside(
                        shares
                            .filter(|_| paper.is_some())
                            .map(|s| s.detected_occlusion_percent),
                        0
                    )
                ),
                false => String::new(),
            },
            match proves {
                true => format!(
                    "{:.0}{}",
                    row.full_visibility_percent,
                    beside(
                        shares
                            .filter(|_| paper.is_some())
                            .map(|s| s.full_visibility_percent),
                        0
                    )
                ),
                false => String::new(),
            },
            match is_normal {
                true => String::new(),
                false => format!("{:.0}", row.visibility_cost_removed_percent),
            },
            row.speedup,
            beside(
                normal
                    .zip(paper)
                    .filter(|_| !is_normal)
                    .map(|(n, p)| n.seconds / p.seconds),
                2
            ),
        );
    }
    text.push_str(
        "\n| technique | rows | speed-up, geometric mean | first passes | later passes | worst row | best row | fewer rays, times |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    // A table of first passes alone has no mean of later ones.
    let mean = |x: f64| match x > 0.0 {
        true => format!("{x:.2}"),
        false => "-".to_owned(),
    };
    for s in summaries {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {:.2} | {:.2} | {} |",
            s.technique.name(),
            s.rows,
            mean(s.speedup),
            mean(s.speedup_first),
            mean(s.speedup_later),
            s.worst,
            s.best,
            s.fewer_rays.map_or("-".to_owned(), |x| format!("{x:.1}"))
        );
    }
    text
}
