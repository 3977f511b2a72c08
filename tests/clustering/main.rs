//! The hierarchy: adjacency, face clusters, volume clusters, as laid out and as promised.

mod cuts;
mod meshes;
mod neighbours;
mod trees;
