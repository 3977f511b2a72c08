//! A sweep in the report: its plots and its table.

use super::html::{Cell, escaped, table};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::fmt::Write;

/// A plot of a sweep.
pub struct Plot {
    /// File name.
    pub name: String,
    /// SVG.
    pub svg: Vec<u8>,
}

/// The section of one sweep: `csv` is its `sweep.csv`.
pub fn sweep_section(name: &str, csv: &str, plots: &[Plot]) -> String {
    let mut out = format!(
        "<section><h2>{}</h2>\n<p>Speed against accuracy; the front is marked in the plots.</p>\n",
        escaped(name)
    );
    for plot in plots {
        // As an image, so that nothing inside it can run or clash with another's names.
        let _ = writeln!(
            out,
            "<img class=\"plot\" alt=\"{}\" src=\"data:image/svg+xml;base64,{}\">",
            escaped(&plot.name),
            STANDARD.encode(&plot.svg)
        );
    }
    let mut lines = csv.lines();
    let heads: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    // What is the same in every row is said once: the table must fit a page.
    let same = |column: usize| match rows.split_first() {
        Some((first, rest)) if !rest.is_empty() => {
            let value = first.get(column).copied();
            value.filter(|_| rest.iter().all(|row| row.get(column).copied() == value))
        }
        _ => None,
    };
    let (fixed, varied): (Vec<usize>, Vec<usize>) =
        (0..heads.len()).partition(|&c| same(c).is_some());
    if !fixed.is_empty() {
        let items: Vec<String> = (fixed.iter())
            .map(|&c| {
                format!(
                    "{} {}",
                    escaped(heads[c]),
                    escaped(same(c).unwrap_or_default())
                )
            })
            .collect();
        let _ = writeln!(out, "<p>The same in every row: {}.</p>", items.join(", "));
    }
    // With spaces, at which heads can wrap.
    let heads: Vec<String> = varied.iter().map(|&c| heads[c].replace('_', " ")).collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    let cells: Vec<Vec<Cell>> = (rows.iter())
        .map(|row| {
            varied
                .iter()
                .map(|&c| cell(row.get(c).copied().unwrap_or_default()))
                .collect()
        })
        .collect();
    out.push_str(&table("Points of the sweep", &heads, &cells));
    out.push_str("</section>\n");
    out
}

fn cell(text: &str) -> Cell {
    if let Ok(value) = text.parse::<u64>() {
        return Cell::count(value);
    }
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Cell::quantity(value),
        _ => Cell::text(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_the_same_in_every_row_is_said_once() {
        let csv = "scene,rays,error\n<a>,8,0.5\n<a>,16,0.25\n";
        let section = sweep_section("s", csv, &[]);
        assert!(section.contains("The same in every row: scene &lt;a&gt;."));
        assert_eq!(section.matches("&lt;a&gt;").count(), 1);
        assert_eq!(
            section.matches("<th").count() - section.matches("<thead").count(),
            2
        );
        assert!(section.contains("data-n=\"16\">16<") && section.contains("data-n=\"0.25\""));
        // One row has nothing to be the same as; a row cut short is no reason to fail.
        let short = sweep_section("s", "scene,rays\na\n", &[]);
        assert!(short.contains("<td>a</td>") && !short.contains("The same"));
    }
}
