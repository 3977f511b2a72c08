//! `certilux audit`: are the guarantees of a solve true?

use super::args::AuditCommand;
use super::error::CliError;
use super::file_head::FileHead;
use super::file_plan::FilePlan;
use super::logs;
use super::progress::Progress;
use super::scene_source::{load_scene, prepare};
use super::session::{Session, print_line};
use super::solve_command::with_threads;
use crate::experiment::{AuditConfig, AuditReport, Detection, DetectionConfig, audit, detection};
use crate::output::write_json;
use crate::solve::{SolveConfig, Stop};
use serde::Serialize;
use std::sync::Arc;
use std::time::Instant;

/// Solves, audits, reports.
pub fn run(session: &Session, command: &AuditCommand) -> Result<(), CliError> {
    let config = command.solve.config()?;
    if !config.technique.proves_visibility() {
        logs::warn(format_args!(
            "--technique {} proves nothing, so there is nothing to audit",
            config.technique.name()
        ));
    }
    FilePlan::default()
        .scene("SCENE", &command.scene.scene)
        .writes("--json", &command.json)
        .check()?;
    with_threads(command.scene.reading.threads, || {
        audit_and_report(session, command, &config)
    })
}

/// The report as a file.
#[derive(Serialize)]
struct AuditFile<'a> {
    #[serde(flatten)]
    head: FileHead<'a>,
    scene: &'a str,
    polygons: usize,
    technique: &'static str,
    seed: u64,
    #[serde(flatten)]
    report: &'a AuditReport,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    detection: Vec<DetectionRow>,
    seconds: f64,
}

/// A pass of [`Detection`] with its percentages.
#[derive(Serialize)]
struct DetectionRow {
    #[serde(flatten)]
    counts: Detection,
    max_occlusion_percent: f64,
    detected_occlusion_percent: f64,
    detected_percent_of_surely_blocked: f64,
    full_visibility_percent: f64,
}

impl From<Detection> for DetectionRow {
    fn from(counts: Detection) -> Self {
        Self {
            counts,
            max_occlusion_percent: counts.max_occlusion_percent(),
            detected_occlusion_percent: counts.detected_percent(),
            detected_percent_of_surely_blocked: counts.detected_percent_of_surely_blocked(),
            full_visibility_percent: counts.visible_percent(),
        }
    }
}

fn audit_and_report(
    session: &Session,
    command: &AuditCommand,
    config: &SolveConfig,
) -> Result<(), CliError> {
    let start = Instant::now();
    let scene = load_scene(&command.scene)?;
    let progress = Progress::new(session.quiet, Arc::clone(&session.interrupted), config);
    let prepared = prepare(scene, &command.scene.reading, config.seed)?
        .with_guarantees(config.technique, &command.solve.occluders.config());
    let audit_config = AuditConfig {
        claims: command.claims,
        rays_per_claim: command.rays_per_claim,
        brute_force: command.brute_force,
    };
    let report = audit(&prepared, config, &audit_config, &progress)?;
    progress.finish();
    let detection: Vec<DetectionRow> = match command.detection {
        true => detection(&prepared, config, &detection_config(config))?
            .into_iter()
            .map(DetectionRow::from)
            .collect(),
        false => Vec::new(),
    };
    let seconds = start.elapsed().as_secs_f64();
    // The findings are the result, not progress: --quiet leaves them.
    print_findings(&prepared.scene.name, &report, &audit_config, seconds);
    print_detection(&detection);
    if let Some(path) = &command.json {
        let file = AuditFile {
            head: FileHead::new(session, prepared.embree_version),
            scene: &prepared.scene.name,
            polygons: prepared.scene.polygons.len(),
            technique: config.technique.name(),
            seed: config.seed,
            report: &report,
            detection,
            seconds,
        };
        write_json(path, &file, &session.interrupted)?;
    }
    match report.flaws.first() {
        None => Ok(()),
        Some(first) => Err(CliError::CheckFailed(format!(
            "{} contradictions stand; the first: {first:?}",
            report.contradictions_standing
        ))),
    }
}

fn print_findings(scene: &str, report: &AuditReport, config: &AuditConfig, seconds: f64) {
    print_line(format_args!(
        "{scene}: {} of {} claims audited ({} of occlusion, {} of visibility) in {seconds:.1} s",
        report.claims_audited,
        report.claims_made,
        report.occlusion_claims,
        report.visibility_claims
    ));
    print_line(format_args!(
        "proofs replayed: {} of {} occluders lie in continuous surface, {} of {} occlusion claims hold, {} of {} visibility claims tested against every polygon ({} undecided)",
        report.occluders_proved,
        report.occluders_claimed,
        report.occlusion_proofs,
        report.occlusion_claims,
        report.visibility_proofs,
        report.visibility_claims,
        report.polygons_undecided
    ));
    print_line(format_args!(
        "rays: {} ({} uniform, {} aimed); contradictions by Embree: {}; contradictions that stand: {}",
        report.rays,
        report.rays_uniform,
        report.rays_aimed,
        report.contradictions_by_embree,
        report.contradictions_standing
    ));
    let asked = report.claims_audited * u64::from(config.rays_per_claim);
    if report.rays < asked {
        print_line(format_args!(
            "{} of the {asked} rays asked for were not cast: their segments run along the surface of an element, within the tolerance",
            asked - report.rays
        ));
    }
}

/// As many passes as the solve is told to make.
fn detection_config(config: &SolveConfig) -> DetectionConfig {
    let default = DetectionConfig::default();
    DetectionConfig {
        passes: match config.stop {
            Stop::Passes(passes) => passes,
            Stop::Converged(_) => default.passes,
        },
        ..default
    }
}

fn print_detection(rows: &[DetectionRow]) {
    if rows.is_empty() {
        return;
    }
    print_line(format_args!(
        "pass  exchanges  blocked %  detected %  of surely blocked %  visible %"
    ));
    for row in rows {
        print_line(format_args!(
            "{:>4}  {:>9}  {:>9.1}  {:>10.1}  {:>19.1}  {:>9.1}",
            row.counts.pass,
            row.counts.exchanges,
            row.max_occlusion_percent,
            row.detected_occlusion_percent,
            row.detected_percent_of_surely_blocked,
            row.full_visibility_percent
        ));
    }
}
