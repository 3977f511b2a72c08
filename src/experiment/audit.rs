//! The audit of a solve's guarantees (design, section 8): its claims are replayed in exact arithmetic,
//! then attacked with rays.
//!
//! 64 random rays would miss a claim that is wrong on a hundred-thousandth of its segments; so once
//! per occluder that was claimed its rectangle is shown to lie in continuous surface (or its solid to be
//! closed), per occlusion
//! claim all vertex pairs are checked against both faces of the slab, and per visibility claim of a
//! sample every polygon of the scene against the hull of the pair.

use super::audit_report::{AuditReport, Flaw};
use super::claimed_occluder::ClaimedOccluder;
use super::continuous_surface::SurfaceProof;
use super::parts_cover::PartsCover;
use super::ray_attack::{AttackOutcome, RayAttack};
use super::shaft_replay::replay_visibility;
use crate::math::{PolygonId, hash_u64};
use crate::solve::{
    Claim, Element, ElementName, Guarantees, HiddenBy, Observer, PreparedScene, ProvedPair,
    SolveConfig, SolveError, solve,
};
use crate::visibility::ElementBounds;
use crate::visibility::exact::SegmentStanding;
use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

/// What to audit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct AuditConfig {
    /// Claims of the solve that are kept: a uniform sample, or all with `usize::MAX`.
    pub claims: usize,
    /// Rays cast against each.
    pub rays_per_claim: u32,
    /// Visibility claims of the sample whose shafts are tested against every polygon.
    pub brute_force: usize,
}

impl Default for AuditConfig {
    fn default() -> Self {
        Self {
            claims: 100_000,
            rays_per_claim: 64,
            // About a second where a thousand polygons stand in the pair's box.
            brute_force: 200,
        }
    }
}

/// Why there is no report.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AuditError {
    /// The solve ended without a result.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The observer asked to stop.
    #[error("the audit was interrupted")]
    Interrupted,
}

/// Claims between two questions whether to stop.
const BATCH: usize = 4096;

/// Solves the scene and audits the claims of the solve. The same report at any number of threads.
///
/// # Errors
/// Those of the solve, or an interruption by the observer.
pub fn audit(
    prepared: &PreparedScene,
    solve_config: &SolveConfig,
    config: &AuditConfig,
    observer: &dyn Observer,
) -> Result<AuditReport, AuditError> {
    let solve_config = SolveConfig {
        keep_claims: config.claims,
        ..solve_config.clone()
    };
    let solved = solve(prepared, &solve_config, observer)?;
    let mut report = AuditReport {
        claims_made: solved
            .passes
            .iter()
            .map(|p| p.occluded_claims + p.visible_claims)
            .sum(),
        claims_audited: solved.claims.len() as u64,
        ..AuditReport::default()
    };
    if let Some(guarantees) = &prepared.guarantees {
        let auditor = Auditor::new(prepared, guarantees, config, solve_config.seed);
        auditor.occluders(&solved.claims, &mut report);
        auditor.claims(&solved.claims, &mut report, observer)?;
    }
    report.rays = report.rays_uniform + report.rays_aimed;
    Ok(report)
}

struct Auditor<'a> {
    prepared: &'a PreparedScene,
    guarantees: &'a Guarantees,
    attack: RayAttack<'a>,
    cover: PartsCover<'a>,
    brute_force: usize,
    seed: u64,
}

impl<'a> Auditor<'a> {
    fn new(
        prepared: &'a PreparedScene,
        guarantees: &'a Guarantees,
        config: &AuditConfig,
        seed: u64,
    ) -> Self {
        Self {
            prepared,
            guarantees,
            attack: RayAttack::new(prepared, &guarantees.scene, config.rays_per_claim),
            cover: PartsCover::new(&prepared.scene, &prepared.hierarchy),
            brute_force: config.brute_force,
            seed,
        }
    }

    fn occluder(&self, index: u32) -> ClaimedOccluder<'a> {
        ClaimedOccluder::of(&self.guarantees.occluder_set, index)
    }

    /// What hides the pair of a claim; nothing where it is claimed to be visible.
    fn hidden_by(&self, claim: &Claim) -> Option<ClaimedOccluder<'a>> {
        Some(match claim.occluder? {
            HiddenBy::Occluder(index) => self.occluder(index),
            HiddenBy::Surface(polygon) => {
                let [a, b] = self.bounds(claim);
                let found = self.guarantees.surface_query().surface(&a, &b, polygon);
                ClaimedOccluder::Surface(found.unwrap_or_default())
            }
        })
    }

    fn bounds(&self, claim: &Claim) -> [ElementBounds; 2] {
        let ends = claim.elements(&self.prepared.scene, &self.prepared.hierarchy);
        ends.map(|end| end.shaft_bounds())
    }

    /// Once per occluder: does its rectangle lie in continuous surface, or is it closed on all sides?
    fn occluders(&self, claims: &[ProvedPair], report: &mut AuditReport) {
        let mut claimed: Vec<u32> = claims
            .iter()
            .flat_map(|pair| std::iter::once(&pair.claim).chain(&pair.parts))
            .filter_map(|claim| match claim.occluder? {
                HiddenBy::Occluder(index) => Some(index),
                HiddenBy::Surface(_) => None,
            })
            .collect();
        claimed.sort_unstable();
        claimed.dedup();
        report.occluders_claimed = claimed.len() as u64;
        let weld = f64::from(self.guarantees.scene.tolerance().weld);
        let proofs: Vec<Result<SurfaceProof, DVec3>> = claimed
            .par_iter()
            .map(|&index| {
                let (scene, hierarchy) = (&self.prepared.scene, &self.prepared.hierarchy);
                self.occluder(index).prove(scene, hierarchy, weld)
            })
            .collect();
        for (&occluder, proof) in claimed.iter().zip(proofs) {
            match proof {
                Ok(proof) => {
                    report.occluders_proved += 1;
                    let by_boundary = proof == SurfaceProof::Chain;
                    report.occluders_proved_by_boundary += u64::from(by_boundary);
                }
                Err(at) => report.add(Flaw::OccluderOpen {
                    occluder,
                    node: self.occluder(occluder).node().map(|node| node.0),
                    at: self.in_file(at),
                }),
            }
        }
    }

    fn claims(
        &self,
        claims: &[ProvedPair],
        report: &mut AuditReport,
        observer: &dyn Observer,
    ) -> Result<(), AuditError> {
        // The first visibility claims of a uniform sample in random order are one themselves.
        let brute_forced = claims
            .iter()
            .enumerate()
            .filter(|(_, pair)| pair.claim.occluder.is_none())
            .nth(self.brute_force)
            .map_or(claims.len(), |(index, _)| index);
        for (batch, claims) in claims.chunks(BATCH).enumerate() {
            if observer.interrupted() {
                return Err(AuditError::Interrupted);
            }
            let parts: Vec<AuditReport> = claims
                .par_iter()
                .enumerate()
                .map(|(i, pair)| self.claim(pair, batch * BATCH + i < brute_forced))
                .collect();
            for part in parts {
                report.merge(part);
            }
        }
        Ok(())
    }

    fn claim(&self, pair: &ProvedPair, brute_force: bool) -> AuditReport {
        let mut report = AuditReport::default();
        let claim = &pair.claim;
        let elements = claim.elements(&self.prepared.scene, &self.prepared.hierarchy);
        let occluders = self.occluders_of(pair);
        if occluders.is_empty() {
            report.visibility_claims += 1;
            if brute_force {
                self.replay_shaft(claim, &elements, &mut report);
            }
        } else {
            report.occlusion_claims += 1;
            report.claims_by_parts += u64::from(!pair.parts.is_empty());
            let by_surface = |claim: &Claim| matches!(claim.occluder, Some(HiddenBy::Surface(_)));
            report.claims_by_surfaces += u64::from(pair.proofs().iter().any(by_surface));
            let flaws = report.contradictions_standing;
            self.replay_hidden(pair, &occluders, &mut report);
            report.occlusion_proofs += u64::from(report.contradictions_standing == flaws);
        }
        let outcome = self.attack.attack(
            [&elements[0], &elements[1]],
            &occluders,
            !pair.parts.is_empty(),
            self.key(claim),
        );
        self.add_rays(&mut report, claim, &outcome);
        report
    }

    /// What hides the pair, or its parts one by one: nothing where it is claimed to be visible.
    fn occluders_of(&self, pair: &ProvedPair) -> Vec<ClaimedOccluder<'a>> {
        let claims = pair.proofs().iter();
        claims.filter_map(|claim| self.hidden_by(claim)).collect()
    }

    /// Does the occluder cut every segment of the pair, or each part's that of the part, and do the parts cover the pair?
    fn replay_hidden(
        &self,
        pair: &ProvedPair,
        occluders: &[ClaimedOccluder],
        report: &mut AuditReport,
    ) {
        let tolerance = self.guarantees.scene.tolerance();
        for (claim, occluder) in pair.proofs().iter().zip(occluders) {
            let [a, b] = self.bounds(claim);
            if let Err(flaw) = occluder.replay(&a, &b, tolerance) {
                report.add(Flaw::OcclusionProof {
                    claim: claim.into(),
                    reason: flaw.to_string(),
                });
            }
        }
        if !pair.parts.is_empty()
            && let Some([from, to]) = self.cover.find_gap(pair)
        {
            report.add(Flaw::PartNotHidden {
                claim: (&pair.claim).into(),
                part: [from.name().into(), to.name().into()],
            });
        }
    }

    /// Is every polygon of the scene out of the pair's way?
    fn replay_shaft(&self, claim: &Claim, elements: &[Element; 2], report: &mut AuditReport) {
        let [a, b] = elements.each_ref().map(|e| e.shaft_bounds());
        let replay = replay_visibility(&self.guarantees.scene, &a, &b);
        report.visibility_proofs += 1;
        report.polygons_proved += replay.proved;
        report.polygons_undecided += replay.undecided;
        if let Some((polygon, segment)) = replay.blocked {
            report.add(Flaw::PolygonInShaft {
                claim: claim.into(),
                polygon: polygon.0,
                source_face: self.source_face(polygon),
                segment: segment.map(|p| self.in_file(p)),
            });
        }
    }

    fn add_rays(&self, report: &mut AuditReport, claim: &Claim, outcome: &AttackOutcome) {
        report.rays_uniform += outcome.uniform;
        report.rays_aimed += outcome.aimed;
        report.contradictions_by_embree += outcome.contradicted;
        if let Some(refutation) = outcome.refutation {
            report.add(Flaw::Segment {
                claim: claim.into(),
                segment: refutation.segment.map(|p| self.in_file(p.as_dvec3())),
                blocked_by: match refutation.standing {
                    SegmentStanding::Blocked(polygon) => Some(polygon.0),
                    _ => None,
                },
            });
            report.contradictions_standing += outcome.standing - 1;
        }
    }

    fn key(&self, claim: &Claim) -> u64 {
        let end = |name: ElementName| hash_u64(u64::from(name.node.0) ^ hash_u64(name.path.0));
        let pair = hash_u64(end(claim.source)).wrapping_add(end(claim.receiver));
        hash_u64(pair ^ hash_u64(self.seed ^ u64::from(claim.pass)))
    }

    fn source_face(&self, polygon: PolygonId) -> u32 {
        self.prepared.scene.polygons[polygon.index()].source_face
    }

    fn in_file(&self, point: DVec3) -> [f64; 3] {
        let map = &self.prepared.scene.normalisation;
        map.to_file(point).to_array()
    }
}
