//! What holds in every scene, however odd: all techniques give the same light, and no claim is refuted.

use crate::mesh::{MTL, Mesh};
use certilux::embree::DeviceConfig;
use certilux::experiment::{AuditConfig, audit};
use certilux::math::FacetId;
use certilux::occluder::OccluderConfig;
use certilux::scene::{Axes, LoadConfig, Side, SidesMode, load_text};
use certilux::solve::{PreparedScene, Silent, SolveConfig, Solved, Stop, Stride, Technique, solve};
use std::collections::BTreeMap;

/// Greatest difference of a face's irradiance after pass 1 between techniques, over the greater of the face's own and
/// the area-weighted mean of the scene, each in its greatest channel.
pub const AGREEMENT: f64 = 1.0e-5;

/// The same in the root mean square, over the mean, where a few rays of `blockers` graze borders: an eighth of one large
/// exchange.
const GRAZED: f64 = 1.0e-3;

/// The scene of a mesh with the materials of [`MTL`], ready for every technique.
pub fn prepare(mesh: &Mesh) -> PreparedScene {
    prepare_text(&mesh.obj(), "m.mtl", MTL)
}

/// The same from text.
pub fn prepare_text(obj: &str, library: &str, mtl: &str) -> PreparedScene {
    prepare_along(Axes::Scene, obj, library, mtl)
}

/// The same with boxes along the given axes.
pub fn prepare_along(axes: Axes, obj: &str, library: &str, mtl: &str) -> PreparedScene {
    let files = [(library, mtl.as_bytes())];
    let mut load = LoadConfig::default();
    load.axes = axes;
    let scene =
        load_text("extreme", obj.as_bytes(), &files, &load).unwrap_or_else(|e| panic!("{e}"));
    PreparedScene::new(scene, SidesMode::Auto, 1, &DeviceConfig::default())
        .expect("Embree opens")
        .with_guarantees(Technique::Blockers, &OccluderConfig::default())
}

/// Settings that solve a small scene in a fraction of a second.
pub fn coarse() -> SolveConfig {
    let mut config = SolveConfig::default();
    config.epsilon = 1.0e-4;
    config.gradient = 0.05;
    config.min_area = 1.0e-4;
    config
}

/// A side of a source face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaceLight {
    /// Its area, normalised.
    pub area: f64,
    /// Area times irradiance.
    pub irradiance: [f64; 3],
    /// Area times radiosity, emission included.
    pub radiosity: [f64; 3],
}

/// The light by source face and side.
pub type Faces = BTreeMap<(u32, Side), FaceLight>;

/// What a solve says of the faces.
pub fn faces(prepared: &PreparedScene, solved: &Solved) -> Faces {
    let mut found = Faces::new();
    for (f, facet) in solved.solution.facets.iter().enumerate() {
        let polygon = prepared.scene.polygons[facet.polygon.index()];
        let area = prepared.scene.polygon_area(facet.polygon);
        let face = found.entry((polygon.source_face, facet.side)).or_default();
        face.area += area;
        for patch in solved.solution.facet_patches(FacetId::new(f)) {
            let share = area * 0.25f64.powi(patch.path.level() as i32);
            for c in 0..3 {
                face.irradiance[c] += share * f64::from(patch.irradiance[c]);
                face.radiosity[c] += share * f64::from(patch.radiosity[c]);
            }
        }
    }
    found
}

/// Solves with `config` but for the technique.
pub fn solve_by(prepared: &PreparedScene, technique: Technique, config: &SolveConfig) -> Solved {
    let mut config = config.clone();
    config.technique = technique;
    let solved = solve(prepared, &config, &Silent).expect("solves");
    let power = solved.power;
    assert!(
        power.absorbed >= 0.0 && power.escaped >= 0.0 && power.imbalance.is_finite(),
        "{power:?}"
    );
    solved
}

/// Claims made by the techniques that were compared, and by the audited solve.
#[derive(Clone, Copy, Debug, Default)]
pub struct Claims {
    pub occluded: u64,
    pub visible: u64,
    pub audited: u64,
}

/// Asserts that pass 1 of every technique gives each face the irradiance that `normal` gives it, and that an audit
/// finds no contradiction.
pub fn hold(what: &str, prepared: &PreparedScene, config: &SolveConfig) -> Claims {
    hold_within(AGREEMENT, what, prepared, config)
}

/// The same for a scene in which rays graze surfaces over a part of its area.
pub fn hold_within(
    agreement: f64,
    what: &str,
    prepared: &PreparedScene,
    config: &SolveConfig,
) -> Claims {
    let mut config = config.clone();
    config.stop = Stop::Passes(1);
    let normal = faces(prepared, &solve_by(prepared, Technique::Normal, &config));
    let greatest = |sum: [f64; 3], area: f64| sum.iter().copied().fold(0.0, f64::max) / area;
    let mean = (0..3)
        .map(|c| normal.values().map(|f| f.irradiance[c]).sum::<f64>())
        .fold(0.0, f64::max)
        / normal.values().map(|f| f.area).sum::<f64>();
    let mut claims = Claims::default();
    for (technique, stride) in [
        (Technique::Visibility, PAPER),
        (Technique::Occlusion, PAPER),
        (Technique::Occlusion, Stride::Auto),
        (Technique::Blockers, Stride::Auto),
    ] {
        config.stride = stride;
        // Blockers are checked below, ray by ray.
        config.check_claims = technique == Technique::Blockers;
        let solved = solve_by(prepared, technique, &config);
        assert!(solved.check.holds(), "{what}: {:?}", solved.check);
        claims.occluded += solved.passes[0].occluded_claims;
        claims.visible += solved.passes[0].visible_claims;
        let other = faces(prepared, &solved);
        assert_eq!(normal.len(), other.len());
        let (mut worst, mut squares, mut area) = ((0.0, None), 0.0, 0.0);
        for ((face, a), b) in normal.iter().zip(other.values()) {
            let difference: [f64; 3] =
                std::array::from_fn(|c| (a.irradiance[c] - b.irradiance[c]).abs());
            let own = greatest(a.irradiance, a.area).max(mean);
            let difference = greatest(difference, a.area);
            squares += a.area * difference.powi(2);
            area += a.area;
            if difference > worst.0 * own {
                worst = (difference / own, Some(face));
            }
        }
        // A ray that grazes a border may be blocked natively and not in Embree, or the other way round, which the check has
        // settled in exact arithmetic. Each such is worth one ray of one exchange: blockers are held to it in the mean of
        // the squares, where there are any.
        let (difference, allowed) = match technique {
            Technique::Blockers if solved.check.native_disagreements > 0 => {
                ((squares / area).sqrt() / mean, GRAZED)
            }
            _ => (worst.0, agreement),
        };
        assert!(
            difference <= allowed,
            "{what}: {} ({stride:?}) differs by {:.2e} at {:?}",
            technique.name(),
            difference,
            worst.1
        );
    }
    config.technique = Technique::Occlusion;
    config.stride = PAPER;
    config.check_claims = false;
    let report = audit(prepared, &config, &short_audit(), &Silent).expect("audits");
    assert!(!report.is_refuted(), "{what}: {:?}", report.flaws.first());
    claims.audited += report.claims_audited;
    println!("{what}: {} faces, {claims:?}", normal.len());
    claims
}

/// Enough to find what is wrong on a thousandth of a claim's segments, in tenths of a second.
fn short_audit() -> AuditConfig {
    let mut config = AuditConfig::default();
    config.claims = 400;
    config.rays_per_claim = 32;
    config.brute_force = 20;
    config
}

/// The paper's stride, at which most is claimed.
const PAPER: Stride = Stride::Every(SolveConfig::PAPER_STRIDE);
