//! certilux: batch radiosity with guaranteed occlusion and guaranteed visibility.
//!
//! The method is Leblanc and Poulin, "Guaranteed Occlusion and Visibility in Cluster Hierarchical
//! Radiosity" (2000). The modules stand in the order of the data flow: a module imports only
//! modules listed above it.

pub mod math;

pub mod embree;

pub mod scene;

pub mod cluster;

pub mod occluder;

pub mod visibility;

pub mod solve;

pub mod reference;

pub mod experiment;

pub mod output;

pub mod job;

pub mod cli;
