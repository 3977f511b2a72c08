//! A solved folder in the report: its picture, where the energy and the time went, what the guarantees saved.

use super::charts::{Part, stacked_bar};
use super::html::{Cell, count, escaped, quantity, table};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Deserialize;
use std::fmt::Write;

/// What the report reads of `stats.json`.
#[derive(Debug, Deserialize)]
pub struct Stats {
    certilux: String,
    embree: String,
    #[serde(default)]
    command: Vec<String>,
    seed: u64,
    threads: u64,
    technique: String,
    epsilon: f64,
    rays_per_exchange: u64,
    #[serde(default)]
    settings: std::collections::BTreeMap<String, String>,
    scene: Scene,
    hierarchy: Hierarchy,
    passes: Vec<Pass>,
    seconds: Seconds,
    power: Power,
}

#[derive(Debug, Deserialize)]
struct Scene {
    path: String,
    faces: u64,
    polygons: u64,
    area: f64,
    #[serde(default)]
    dropped_faces: Vec<u64>,
    #[serde(default)]
    warnings: Vec<String>,
}

#[derive(Debug, Deserialize)]
struct Hierarchy {
    face_clusters: u64,
    volume_clusters: u64,
    occluders: u64,
    leaves: u64,
    bytes: u64,
}

#[derive(Debug, Deserialize)]
struct Pass {
    pass: u64,
    seconds: f64,
    exchanges: u64,
    exchanges_blocked: u64,
    exchanges_sampled_clear: u64,
    rays: u64,
    native_rays: u64,
    shafts: u64,
    occluded_claims: u64,
    visible_claims: u64,
    exchanges_visible: u64,
    unshot: f64,
}

#[derive(Debug, Deserialize)]
struct Seconds {
    load: f64,
    cluster: f64,
    occluders: f64,
    embree: f64,
    solve: f64,
    output: f64,
}

#[derive(Debug, Deserialize)]
struct Power {
    emitted: f64,
    absorbed: f64,
    escaped: f64,
    escaped_stderr: f64,
    unshot: f64,
    imbalance: f64,
    /// Absent in folders of earlier versions, which left it unshot.
    #[serde(default)]
    extrapolated: f64,
    /// Absent in folders of earlier versions.
    #[serde(default)]
    swallowed: f64,
}

/// The section of one solved folder; `picture` is a PNG.
pub fn solve_section(name: &str, stats: &Stats, picture: Option<&[u8]>) -> String {
    let mut out = format!("<section><h2>{}</h2>\n", escaped(name));
    if let Some(png) = picture {
        let _ = writeln!(
            out,
            "<img class=\"view\" alt=\"View of the solution\" src=\"data:image/png;base64,{}\">",
            STANDARD.encode(png)
        );
    }
    let scene = &stats.scene;
    let hierarchy = &stats.hierarchy;
    let _ = writeln!(
        out,
        "<p>{} with {} polygons of {} faces, {} m² if its unit is the metre; {} face clusters under {} volume clusters, {} occluders; \
         the solution has {} patches. Memory of the hierarchy and its light: {} MB.</p>",
        escaped(&scene.path),
        count(scene.polygons),
        count(scene.faces),
        quantity(scene.area),
        count(hierarchy.face_clusters),
        count(hierarchy.volume_clusters),
        count(hierarchy.occluders),
        count(hierarchy.leaves),
        quantity(hierarchy.bytes as f64 / 1.0e6),
    );
    out.push_str(&energy(&stats.power));
    out.push_str(&time(stats));
    out.push_str(&guarantees(stats));
    out.push_str(&passes(&stats.passes));
    out.push_str(&warnings(stats));
    out.push_str(&settings(stats));
    out.push_str("</section>\n");
    out
}

fn energy(power: &Power) -> String {
    let part = |label, value| Part { label, value };
    let mut out = stacked_bar(
        "Where the energy went",
        "W",
        &[
            part("absorbed by faces", power.absorbed - power.swallowed),
            part("swallowed by backs and touching faces", power.swallowed),
            part("escaped from the scene", power.escaped),
            part("left out: not shot", power.unshot),
        ],
    );
    let _ = writeln!(
        out,
        "<p>Emitted: <b>{} W</b>. What is neither absorbed, escaped (measured by rays, ± {} W) nor unshot: <b>{:+.2} %</b> of it.</p>",
        quantity(power.emitted),
        quantity(power.escaped_stderr),
        100.0 * power.imbalance
    );
    if power.extrapolated > 0.0 {
        let _ = writeln!(
            out,
            "<p>Of what arrives on surfaces, <b>{} W</b> are those of the passes that were not made: the last pass, continued as a geometric series.</p>",
            quantity(power.extrapolated)
        );
    }
    out
}

fn time(stats: &Stats) -> String {
    let seconds = &stats.seconds;
    let labels: Vec<String> = stats
        .passes
        .iter()
        .map(|p| format!("pass {}", p.pass))
        .collect();
    let mut out = stacked_bar(
        "Where the time went",
        "s",
        &[
            ("loading", seconds.load),
            ("clustering", seconds.cluster),
            ("occluders", seconds.occluders),
            ("Embree's hierarchy", seconds.embree),
            ("solving", seconds.solve),
            ("output", seconds.output),
        ]
        .map(|(label, value)| Part { label, value }),
    );
    let parts: Vec<Part<'_>> = (stats.passes.iter().zip(&labels))
        .map(|(pass, label)| Part {
            label,
            value: pass.seconds,
        })
        .collect();
    out.push_str(&stacked_bar("Time of the passes", "s", &parts));
    out
}

fn guarantees(stats: &Stats) -> String {
    let sum = |of: fn(&Pass) -> u64| stats.passes.iter().map(of).sum::<u64>();
    let exchanges = sum(|p| p.exchanges);
    let visible = sum(|p| p.exchanges_visible);
    let (blocked, clear) = (
        sum(|p| p.exchanges_blocked),
        sum(|p| p.exchanges_sampled_clear),
    );
    let partly = exchanges.saturating_sub(visible + blocked + clear);
    let parts = [
        ("proved visible, no ray", visible),
        ("sampled, all rays clear", clear),
        ("sampled, partly blocked", partly),
        ("sampled, all rays blocked", blocked),
    ]
    .map(|(label, value)| Part {
        label,
        value: value as f64,
    });
    let mut out = stacked_bar("What the exchanges needed", "exchanges", &parts);
    out.push_str(&rays_saved(stats));
    let _ = writeln!(
        out,
        "<p>Asked were {} shafts. With them, and with boxes of air that need no asking, {} pairs were proved fully visible; {} fully occluded.</p>",
        count(sum(|p| p.shafts)),
        count(sum(|p| p.visible_claims)),
        count(sum(|p| p.occluded_claims)),
    );
    out
}

/// What each guarantee spared Embree, as far as the counts of one solve tell, and how they tell it.
fn rays_saved(stats: &Stats) -> String {
    let sum = |of: fn(&Pass) -> u64| stats.passes.iter().map(of).sum::<u64>();
    let an_exchange = stats.rays_per_exchange;
    let visible = sum(|p| p.exchanges_visible).saturating_mul(an_exchange);
    let occluded = sum(|p| p.occluded_claims).saturating_mul(an_exchange);
    let (native, cast) = (sum(|p| p.native_rays), sum(|p| p.rays));
    let parts = [
        ("saved by full visibility", visible),
        ("saved by full occlusion, at the very least", occluded),
        ("tested natively against blockers", native),
        ("cast through Embree", cast),
    ]
    .map(|(label, value)| Part {
        label,
        value: value as f64,
    });
    let mut out = stacked_bar("Rays saved by each guarantee", "rays", &parts);
    let _ = writeln!(
        out,
        "<p>Full visibility: {} exchanges were proved clear and cast none of their {an_exchange} rays. Full occlusion: {} pairs were \
         proved blocked and ended there; what lies below them was never visited nor counted, so each stands for one exchange only, \
         and what was saved is more (<code>certilux compare</code> measures it, against a solve without proofs). Blockers: {} samples \
         were tested against the few polygons left in their shafts. The rays cast include probes for evidence.</p>",
        count(sum(|p| p.exchanges_visible)),
        count(sum(|p| p.occluded_claims)),
        count(native),
    );
    out
}

fn passes(passes: &[Pass]) -> String {
    let rows: Vec<Vec<Cell>> = passes
        .iter()
        .map(|p| {
            vec![
                Cell::count(p.pass),
                Cell::quantity(p.seconds),
                Cell::count(p.exchanges),
                Cell::count(p.exchanges_blocked),
                Cell::count(p.exchanges_visible),
                Cell::count(p.rays),
                Cell::count(p.native_rays),
                Cell::count(p.shafts),
                Cell::count(p.occluded_claims),
                Cell::count(p.visible_claims),
                Cell::quantity(p.unshot),
            ]
        })
        .collect();
    table(
        "Passes",
        &[
            "pass",
            "seconds",
            "exchanges",
            "all blocked",
            "proved visible",
            "rays",
            "native rays",
            "shafts",
            "occluded claims",
            "visible claims",
            "unshot W",
        ],
        &rows,
    )
}

fn warnings(stats: &Stats) -> String {
    let mut warnings: Vec<String> = stats.scene.warnings.clone();
    if !stats.scene.dropped_faces.is_empty() {
        warnings.push(format!(
            "{} faces were dropped at loading",
            stats.scene.dropped_faces.len()
        ));
    }
    if warnings.is_empty() {
        return String::new();
    }
    let items: String = warnings
        .iter()
        .map(|w| format!("<li>{}</li>", escaped(w)))
        .collect();
    format!("<h3>Warnings</h3><ul class=\"warnings\">{items}</ul>\n")
}

fn settings(stats: &Stats) -> String {
    let mut rows: Vec<Vec<Cell>> = [
        ("certilux", stats.certilux.clone()),
        ("Embree", stats.embree.clone()),
        ("technique", stats.technique.clone()),
        ("epsilon", format!("{:e}", stats.epsilon)),
        ("rays an exchange", stats.rays_per_exchange.to_string()),
        ("seed", stats.seed.to_string()),
        ("threads", stats.threads.to_string()),
    ]
    .map(|(name, value)| vec![Cell::text(name), Cell::text(&value)])
    .into();
    let already = ["technique", "epsilon", "rays", "seed"];
    rows.extend(
        (stats.settings.iter())
            .filter(|(name, _)| !already.contains(&name.as_str()))
            .map(|(name, value)| vec![Cell::text(name), Cell::text(value)]),
    );
    format!(
        "<details><summary>To reproduce it</summary><pre>{}</pre>{}</details>\n",
        escaped(&stats.command.join(" ")),
        table("Settings and versions", &["setting", "value"], &rows)
    )
}
