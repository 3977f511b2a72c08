//! The claims of a solve, for the audit: which pairs were proved, and by what.

use super::element::Element;
use super::element_name::ElementName;
use crate::cluster::Hierarchy;
use crate::math::PolygonId;
use crate::scene::Scene;

/// A proved pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Claim {
    /// In which pass it was made.
    pub pass: u32,
    /// One element.
    pub source: ElementName,
    /// The other.
    pub receiver: ElementName,
    /// What hides them from each other, or one of several that do; `None` claims that they see each other fully.
    pub occluder: Option<HiddenBy>,
}

/// What hides a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HiddenBy {
    /// An occluder: its index in the set.
    Occluder(u32),
    /// A surface that cuts all segments: one of its polygons.
    Surface(PolygonId),
}

/// A claim, and what it rests on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProvedPair {
    /// The claim.
    pub claim: Claim,
    /// Where no occluder hides the pair alone, its parts that have one; the others face away from each other. Else empty.
    pub parts: Box<[Claim]>,
}

impl ProvedPair {
    /// The claims that were proved each by one thing: the claim itself, or its parts.
    pub fn proofs(&self) -> &[Claim] {
        match self.parts.is_empty() {
            true => std::slice::from_ref(&self.claim),
            false => &self.parts,
        }
    }
}

impl Claim {
    /// The two elements as the solver met them.
    pub fn elements(&self, scene: &Scene, hierarchy: &Hierarchy) -> [Element; 2] {
        [self.source, self.receiver].map(|name| Element::named(scene, hierarchy, name))
    }
}

/// A uniform sample of claims: those with the least priorities, which are hashes. The same
/// whatever the order in which claims come and samples are merged.
#[derive(Clone, Debug, Default)]
pub struct ClaimSample {
    most: usize,
    kept: Vec<(u64, ProvedPair)>,
    offered: u64,
}

impl ClaimSample {
    /// A sample of at most `most` claims: 0 keeps none, `usize::MAX` all.
    pub fn new(most: usize) -> Self {
        Self {
            most,
            kept: Vec::new(),
            offered: 0,
        }
    }

    /// True when claims are kept at all.
    pub fn is_wanted(&self) -> bool {
        self.most > 0
    }

    /// Offers a claim that rests on `parts`, if any; `priority` is a hash of its pair and pass.
    pub fn offer(&mut self, priority: u64, claim: Claim, parts: &[Claim]) {
        self.offered += 1;
        let parts = parts.into();
        self.kept.push((priority, ProvedPair { claim, parts }));
        if self.kept.len() >= self.most.saturating_mul(2) {
            self.shrink();
        }
    }

    /// Adds what another sample kept.
    pub fn merge(&mut self, other: Self) {
        self.offered += other.offered;
        self.kept.extend(other.kept);
        self.shrink();
    }

    /// How many claims were made.
    pub fn offered(&self) -> u64 {
        self.offered
    }

    /// The claims, in the order of their priorities.
    pub fn into_claims(mut self) -> Vec<ProvedPair> {
        self.kept.sort_unstable_by_key(|(priority, pair)| {
            (
                *priority,
                pair.claim.source.node.0,
                pair.claim.receiver.node.0,
            )
        });
        self.kept.truncate(self.most);
        self.kept.into_iter().map(|(_, pair)| pair).collect()
    }

    fn shrink(&mut self) {
        if self.kept.len() > self.most {
            self.kept
                .select_nth_unstable_by_key(self.most, |(priority, _)| *priority);
            self.kept.truncate(self.most);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::solution::PatchPath;
    use super::*;
    use crate::math::{NodeId, hash_u64};

    fn claim(i: u32) -> Claim {
        let name = |node| ElementName {
            node: NodeId(node),
            path: PatchPath::ROOT,
        };
        Claim {
            pass: 1,
            source: name(i),
            receiver: name(i + 1),
            occluder: None,
        }
    }

    #[test]
    fn the_sample_does_not_depend_on_how_it_was_gathered() {
        let whole = |order: &mut dyn Iterator<Item = u32>| {
            let mut sample = ClaimSample::new(10);
            for i in order {
                sample.offer(hash_u64(u64::from(i)), claim(i), &[]);
            }
            sample
        };
        let forwards = whole(&mut (0..1000)).into_claims();
        let backwards = whole(&mut (0..1000).rev()).into_claims();
        let mut merged = whole(&mut (0..300));
        merged.merge(whole(&mut (300..1000)));
        assert_eq!(merged.offered(), 1000);
        assert_eq!(forwards.len(), 10);
        assert_eq!(forwards, backwards);
        assert_eq!(forwards, merged.into_claims());
    }
}
