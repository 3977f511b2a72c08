//! Names of elements, small enough to be kept by the million.

use super::solution::PatchPath;
use crate::math::NodeId;

/// Names an element: the node, and where in its facet a patch lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ElementName {
    /// The node.
    pub node: NodeId,
    /// The root for nodes, the split for patches.
    pub path: PatchPath,
}
