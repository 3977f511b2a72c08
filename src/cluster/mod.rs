//! The scene hierarchy: face clusters (paper, section 3.1) under volume clusters (section 4).

mod hierarchy;

pub use hierarchy::{ClusterShape, Hierarchy, HierarchyDefect, Node, NodeKind};
