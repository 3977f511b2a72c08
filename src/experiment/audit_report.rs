//! What an audit found: counts, and the first contradictions that stand.

use crate::solve::{Claim, ElementName, HiddenBy};
use serde::Serialize;

/// Contradictions that are kept for the report; more are counted only.
const KEPT_FLAWS: usize = 100;

/// What the audit found.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AuditReport {
    /// Claims that the solve made.
    pub claims_made: u64,
    /// Claims audited.
    pub claims_audited: u64,
    /// Those of full occlusion.
    pub occlusion_claims: u64,
    /// Those of them that rest on parts of the pair, each with an occluder of its own.
    pub claims_by_parts: u64,
    /// Those of them that rest, whole or in part, on surfaces that are no occluders of the set.
    pub claims_by_surfaces: u64,
    /// Those of full visibility.
    pub visibility_claims: u64,
    /// Occluders that these claims rest on.
    pub occluders_claimed: u64,
    /// Those shown to lie in continuous surface.
    pub occluders_proved: u64,
    /// Those of them whose surface is not flat to the weld distance, proved by their boundary.
    pub occluders_proved_by_boundary: u64,
    /// Occlusion claims whose proof holds in exact arithmetic.
    pub occlusion_proofs: u64,
    /// Visibility claims tested against every polygon.
    pub visibility_proofs: u64,
    /// Polygons shown to be out of the way of those.
    pub polygons_proved: u64,
    /// Polygons that reach into a shaft by too little to block any segment surely.
    pub polygons_undecided: u64,
    /// Rays cast.
    pub rays: u64,
    /// Those uniform over both elements.
    pub rays_uniform: u64,
    /// Those aimed at borders.
    pub rays_aimed: u64,
    /// Rays on which Embree contradicts the claim.
    pub contradictions_by_embree: u64,
    /// Contradictions that stand in exact arithmetic, and proofs that do not hold.
    pub contradictions_standing: u64,
    /// The first of them.
    pub flaws: Vec<Flaw>,
}

/// One contradiction that stands.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Flaw {
    /// The rectangle of a claimed occluder does not lie in continuous surface, or a claimed solid is not closed.
    OccluderOpen {
        /// Index of the occluder.
        occluder: u32,
        /// Its node of the hierarchy; none of a solid.
        #[serde(skip_serializing_if = "Option::is_none")]
        node: Option<u32>,
        /// A point of its plane, or of its surface, that nothing covers, in the file's units.
        at: [f64; 3],
    },
    /// The occluder does not cut every segment of the pair.
    OcclusionProof {
        /// The claim.
        claim: ClaimRecord,
        /// What is wrong.
        reason: String,
    },
    /// A pair is claimed to be hidden part by part, and a part neither is nor faces away.
    PartNotHidden {
        /// The claim.
        claim: ClaimRecord,
        /// The part's ends.
        part: [ElementRecord; 2],
    },
    /// A polygon stands in a shaft that was claimed empty.
    PolygonInShaft {
        /// The claim.
        claim: ClaimRecord,
        /// The polygon.
        polygon: u32,
        /// Face of the file that it came from.
        source_face: u32,
        /// A segment that it blocks, in the file's units.
        segment: [[f64; 3]; 2],
    },
    /// A ray refutes the claim.
    Segment {
        /// The claim.
        claim: ClaimRecord,
        /// Its ends, in the file's units.
        segment: [[f64; 3]; 2],
        /// The polygon that surely blocks it; none where it is surely clear.
        #[serde(skip_serializing_if = "Option::is_none")]
        blocked_by: Option<u32>,
    },
}

/// A claim in words that a report can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ClaimRecord {
    /// The pass that made it.
    pub pass: u32,
    /// One element.
    pub source: ElementRecord,
    /// The other.
    pub receiver: ElementRecord,
    /// The occluder, or one of several. Without it and `surface` full visibility is claimed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub occluder: Option<u32>,
    /// A polygon of the surface, or of one of several, that hides the pair.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface: Option<u32>,
}

/// An element: a node, and the path of splits to a patch (1 for a whole node).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ElementRecord {
    /// Node of the hierarchy.
    pub node: u32,
    /// Path to the patch.
    pub path: u64,
}

impl From<ElementName> for ElementRecord {
    fn from(name: ElementName) -> Self {
        Self {
            node: name.node.0,
            path: name.path.0,
        }
    }
}

impl From<&Claim> for ClaimRecord {
    fn from(claim: &Claim) -> Self {
        let (occluder, surface) = match claim.occluder {
            Some(HiddenBy::Occluder(index)) => (Some(index), None),
            Some(HiddenBy::Surface(polygon)) => (None, Some(polygon.0)),
            None => (None, None),
        };
        Self {
            pass: claim.pass,
            source: claim.source.into(),
            receiver: claim.receiver.into(),
            occluder,
            surface,
        }
    }
}

impl AuditReport {
    /// True when a contradiction stands.
    pub fn is_refuted(&self) -> bool {
        self.contradictions_standing > 0
    }

    /// Counts a flaw, and keeps it if it is one of the first.
    pub(super) fn add(&mut self, flaw: Flaw) {
        self.contradictions_standing += 1;
        if self.flaws.len() < KEPT_FLAWS {
            self.flaws.push(flaw);
        }
    }

    /// Takes over what was found of one claim.
    pub(super) fn merge(&mut self, part: Self) {
        self.occlusion_claims += part.occlusion_claims;
        self.claims_by_parts += part.claims_by_parts;
        self.claims_by_surfaces += part.claims_by_surfaces;
        self.visibility_claims += part.visibility_claims;
        self.occlusion_proofs += part.occlusion_proofs;
        self.visibility_proofs += part.visibility_proofs;
        self.polygons_proved += part.polygons_proved;
        self.polygons_undecided += part.polygons_undecided;
        self.rays_uniform += part.rays_uniform;
        self.rays_aimed += part.rays_aimed;
        self.contradictions_by_embree += part.contradictions_by_embree;
        self.contradictions_standing += part.contradictions_standing;
        let room = KEPT_FLAWS - self.flaws.len();
        self.flaws.extend(part.flaws.into_iter().take(room));
    }
}
