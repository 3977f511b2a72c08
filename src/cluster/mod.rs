//! The scene hierarchy: face clusters (paper, section 3.1) under volume clusters (section 4).

mod adjacency;
mod balance;
mod build;
mod cut;
mod face_clustering;
mod flatten;
mod forest;
mod hierarchy;
mod point_tree;
mod shape;
mod surface_measure;
mod t_junction;
mod validate;
mod volume_clustering;
mod weld;
mod welded_edges;

pub use adjacency::link_neighbours;
pub use build::{ClusterConfig, build_hierarchy};
pub use hierarchy::{ClusterShape, Hierarchy, HierarchyDefect, Node, NodeKind};
pub use welded_edges::Link;
