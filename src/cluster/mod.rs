//! The scene hierarchy: face clusters (paper, section 3.1) under volume clusters (section 4).

mod adjacency;
mod balance;
mod build;
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

pub use adjacency::{Link, link_neighbours};
pub use build::{ClusterConfig, build_hierarchy};
pub use hierarchy::{ClusterShape, Hierarchy, HierarchyDefect, Node, NodeKind};
