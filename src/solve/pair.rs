//! A pair in the walk: its two ends, and what is known of it.

use super::claims::Claim;
use super::config::SolveConfig;
use super::element::Element;
use super::knowledge::Knowledge;
use crate::math::hash_u64;
use crate::visibility::Verdict;

/// A source in the walk: the element, and where its unshot radiosity stands.
#[derive(Clone, Copy)]
pub(super) struct Source<'e> {
    pub(super) element: &'e Element,
    /// Owner of the facet; of use to triangles only.
    pub(super) owner: u32,
    /// Patch of the owner that holds the radiosity: itself, or the frozen leaf that it is a part of.
    pub(super) slot: u32,
    /// How many times its own light it shoots, in pairs that were played for.
    pub(super) weight: f64,
}

/// A receiver in the walk: the element, and a cluster's place in its owner's depth-first order.
#[derive(Clone, Copy)]
pub(super) struct Receiver<'e> {
    pub(super) element: &'e Element,
    pub(super) local: u32,
}

/// A receiver to be sampled.
#[derive(Clone, Copy)]
pub(super) struct Target<'a> {
    pub(super) element: &'a Element,
    /// First facets of all parts of a cluster but the first: the parts whose visibility is told apart.
    pub(super) parts: &'a [u32],
}

impl<'a> Target<'a> {
    /// A receiver whose parts do not matter.
    pub(super) fn whole(element: &'a Element) -> Self {
        Self {
            element,
            parts: &[],
        }
    }
}

/// What is known of a pair, and the claim that it rests on.
#[derive(Clone, Copy)]
pub(super) struct Known {
    pub(super) knowledge: Knowledge,
    pub(super) claim: Option<Claim>,
}

impl Known {
    pub(super) const NOTHING: Self = Self {
        knowledge: Knowledge::NOTHING,
        claim: None,
    };

    /// Goes on to pairs one split further down.
    pub(super) fn descend(&mut self) {
        self.knowledge.level += 1;
    }

    /// Nothing passes between occluded elements; only a check goes on, to cast their rays.
    pub(super) fn ends_the_pair(self, config: &SolveConfig) -> bool {
        self.knowledge.verdict == Verdict::Occluded && !config.check_claims
    }
}

/// The name of an exchange's samples: (receiver, source, pass, seed).
pub(super) fn exchange_key(pass_key: u64, source: &Element, receiver: &Element) -> u64 {
    let end = |e: &Element| hash_u64(u64::from(e.node.0) ^ e.path.0.rotate_left(32));
    hash_u64(end(receiver).wrapping_add(hash_u64(end(source) ^ pass_key)))
}
