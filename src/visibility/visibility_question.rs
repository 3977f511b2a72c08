//! What a walk through a shaft is asked, how far it may go, and what it answers (paper, section 5.1).

use super::bounds::ElementBounds;
use super::faults::Faults;
use super::scene_tree::SceneTree;
use super::survivors::SurvivorList;
use super::verdict::Verdict;
use crate::math::PolygonId;

/// When a walk gives up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WalkLimits {
    /// Stop at this many leaves that hold a polygon in the way (at least 1). More than 1 makes the
    /// list that is handed down sharper, for [`BlockerList`](super::BlockerList).
    pub blocking_leaves: u32,
    /// Stop after this many nodes and leaves.
    pub nodes: u32,
}

impl Default for WalkLimits {
    /// Stop at the first obstacle, however long that takes.
    fn default() -> Self {
        Self {
            blocking_leaves: 1,
            nodes: u32::MAX,
        }
    }
}

/// The outcome of a walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VisibilityAnswer {
    /// [`Verdict::Visible`] or [`Verdict::Unknown`].
    pub verdict: Verdict,
    /// A polygon that may block, where the walk came down to one.
    pub obstacle: Option<PolygonId>,
    /// True if the walk saw everything: the survivors are exactly the polygons in the way, leaf by
    /// leaf, and no node among them.
    pub complete: bool,
    /// Nodes, leaves and list octets tested.
    pub nodes: u32,
    /// Polygons that went through the slow test.
    pub polygons: u32,
}

/// What a walk is asked.
#[derive(Clone, Copy)]
pub(super) struct Question<'a> {
    pub(super) scene: &'a SceneTree,
    pub(super) faults: Faults,
    pub(super) a: &'a ElementBounds,
    pub(super) b: &'a ElementBounds,
    /// What may block the pair.
    pub(super) incoming: &'a SurvivorList,
    pub(super) limits: WalkLimits,
}
