//! The audit on random scenes made to be nasty: torn, folded, doubled, abutting and overlapping walls,
//! slivers, curved things, contacts, at any size and place.

mod pieces;
mod scene;

use certilux::embree::DeviceConfig;
use certilux::experiment::{AuditConfig, AuditReport, audit};
use certilux::occluder::OccluderConfig;
use certilux::scene::{Axes, LoadConfig, SidesMode, load_text};
use certilux::solve::{PreparedScene, Silent, SolveConfig, Stop, Stride, Technique};
use scene::{MTL, nasty_scene};

fn audit_of(seed: u64) -> AuditReport {
    let obj = nasty_scene(seed);
    let files = [("m.mtl", MTL.as_bytes())];
    let mut load = LoadConfig::default();
    // Pairs of scenes in turn along their own axes and as they are written.
    load.axes = match seed / 2 % 2 {
        0 => Axes::File,
        _ => Axes::Scene,
    };
    let scene = load_text("nasty", obj.as_bytes(), &files, &load)
        .unwrap_or_else(|e| panic!("seed {seed}: {e}"));
    let mut solve = SolveConfig::default();
    solve.technique = Technique::Occlusion;
    solve.epsilon = 1.0e-4;
    solve.stop = Stop::Passes(2);
    solve.stride = match seed % 3 {
        0 => Stride::Auto,
        1 => Stride::Every(SolveConfig::PAPER_STRIDE),
        _ => Stride::Every(1),
    };
    solve.seed = seed;
    // Every other scene with an extraction that takes what it can get.
    let mut occluders = OccluderConfig::default();
    if seed % 2 == 1 {
        occluders.per_cluster = 12;
        occluders.min_area = 1.0e-5;
        occluders.flatness_degrees = 10.0;
        occluders.cone_degrees = 180.0;
        occluders.flush = true;
    }
    let prepared = PreparedScene::new(scene, SidesMode::Auto, seed, &DeviceConfig::default())
        .expect("Embree opens")
        .with_guarantees(solve.technique, &occluders);
    let mut config = AuditConfig::default();
    config.claims = 4_000;
    config.rays_per_claim = 64;
    config.brute_force = 40;
    audit(&prepared, &solve, &config, &Silent).expect("audits")
}

/// Audits the seeds; a line each, and the sums at the end.
fn audit_seeds(seeds: std::ops::Range<u64>) {
    let mut sum = AuditReport::default();
    let mut bad = Vec::new();
    for seed in seeds.clone() {
        let report = audit_of(seed);
        println!(
            "seed {seed}: {} of {} claims ({} occluded, {} visible), {}/{} occluders proved, {} rays, {} contradictions by Embree, {} stand",
            report.claims_audited,
            report.claims_made,
            report.occlusion_claims,
            report.visibility_claims,
            report.occluders_proved,
            report.occluders_claimed,
            report.rays,
            report.contradictions_by_embree,
            report.contradictions_standing
        );
        if report.is_refuted() {
            println!("  {:?}", report.flaws[0]);
            bad.push(seed);
        }
        sum.claims_audited += report.claims_audited;
        sum.occlusion_claims += report.occlusion_claims;
        sum.visibility_claims += report.visibility_claims;
        sum.occluders_claimed += report.occluders_claimed;
        sum.occluders_proved += report.occluders_proved;
        sum.occluders_proved_by_boundary += report.occluders_proved_by_boundary;
        sum.visibility_proofs += report.visibility_proofs;
        sum.polygons_undecided += report.polygons_undecided;
        sum.rays += report.rays;
        sum.contradictions_by_embree += report.contradictions_by_embree;
        sum.contradictions_standing += report.contradictions_standing;
    }
    println!("{seeds:?}: {sum:?}");
    assert!(sum.occlusion_claims > 0 && sum.visibility_claims > 0 && sum.rays > 0);
    assert!(bad.is_empty(), "contradictions stand in seeds {bad:?}");
}

#[test]
fn claims_hold_in_a_few_nasty_scenes() {
    audit_seeds(0..4);
}

/// A sheet far from the origin, folded by as much as its digits allow, whose cracks can be closed either way.
#[test]
fn occluders_hold_whichever_side_of_a_crack_is_moved() {
    audit_seeds(361..362);
}

#[test]
#[ignore = "takes many minutes"]
fn claims_hold_in_many_nasty_scenes() {
    let count = std::env::var("CERTILUX_NASTY_SCENES").ok();
    let count = count.and_then(|n| n.parse().ok()).unwrap_or(400);
    audit_seeds(4..4 + count);
}
