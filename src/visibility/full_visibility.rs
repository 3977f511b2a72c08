//! Full visibility of a pair: nothing in the scene meets the shaft (paper, section 5.1).
//!
//! No polygon is excused by identity: those of a planar element drop out because the element lies in
//! their plane ([`super::crossing`]), and those of a curved one stay, because self-occlusion is real.
//! How the shaft is walked stands in [`super::shaft_walk`].

use super::bounds::ElementBounds;
use super::faults::Faults;
use super::scene_tree::SceneTree;
use super::shaft_walk::{VisibilityScratch, Walk};
use super::survivors::SurvivorList;
use super::visibility_question::{Question, VisibilityAnswer, WalkLimits};
use pulp::Arch;

/// Full-visibility queries against one scene.
#[derive(Clone, Debug)]
pub struct VisibilityQuery<'a> {
    scene: &'a SceneTree,
    faults: Faults,
    arch: Arch,
}

impl<'a> VisibilityQuery<'a> {
    /// Queries against `scene`.
    pub fn new(scene: &'a SceneTree) -> Self {
        Self {
            scene,
            faults: Faults::NONE,
            arch: Arch::new(),
        }
    }

    /// The same queries with faults planted.
    #[cfg(any(test, feature = "plant-faults"))]
    #[must_use]
    pub fn with_faults(mut self, faults: Faults) -> Self {
        self.faults = faults;
        self
    }

    /// Tests whether every segment between `a` and `b` is free of the polygons in `incoming`, which
    /// has to be the list of the whole scene or of a pair whose elements contain these two.
    ///
    /// `outgoing` is replaced by what may still block: complete for this pair and every pair below
    /// it, obstacles first. It is empty exactly if the verdict is [`Verdict::Visible`](super::Verdict::Visible).
    pub fn run(
        &self,
        a: &ElementBounds,
        b: &ElementBounds,
        incoming: &SurvivorList,
        outgoing: &mut SurvivorList,
        limits: WalkLimits,
        scratch: &mut VisibilityScratch,
    ) -> VisibilityAnswer {
        let ask = Question {
            scene: self.scene,
            faults: self.faults,
            a,
            b,
            incoming,
            limits,
        };
        self.arch.dispatch(Walk::new(ask, outgoing, scratch))
    }
}
