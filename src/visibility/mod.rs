//! Guaranteed occluded, guaranteed visible, or unknown (paper, section 5).

mod account;
mod blockers;
mod bounds;
mod box_growth;
mod crossing;
mod cutting_surface;
mod empty_boxes;
pub mod exact;
mod faults;
mod full_visibility;
mod light_search;
mod native_first;
mod near_segments;
mod occluder_tree;
mod occlusion;
mod part_visibility;
mod plane_octet;
mod probe_segment;
mod sample_points;
mod sampling;
mod scene_tree;
mod screen;
mod shadow_cache;
mod shaft;
mod shaft_planes;
mod shaft_walk;
mod slab_planes;
mod solid_occlusion;
mod solid_tree;
mod stored_polygon;
mod surface_edges;
mod surface_pair;
mod survivors;
mod tolerance;
mod trimmed;
mod verdict;
mod visibility_question;
mod wide_corners;
mod wide_tree;
mod wide_tree_builder;

pub use account::Account;
pub use blockers::BlockerList;
pub use bounds::{BoundsShape, ElementBounds};
pub use cutting_surface::{CuttingSurface, SurfaceAnswer, SurfaceQuery, SurfaceScratch};
pub use empty_boxes::{AirBetween, EmptyBoxes, NearbyBoxes};
pub use faults::Faults;
pub use full_visibility::VisibilityQuery;
pub use light_search::{SampledLight, look_for_light};
pub use native_first::NativeFirst;
pub use near_segments::SegmentOctet;
pub use occluder_tree::{OccluderTree, OcclusionAnswer, OcclusionScratch};
pub use occlusion::OccluderFaces;
pub use part_visibility::{PARTS, PartVisibility};
pub use sample_points::{PointOctet, Surface, children_of_triangle};
pub use sampling::{AllClear, SampleOctet, SampledVisibility, SegmentTest, sample_visibility};
pub use scene_tree::SceneTree;
pub use shadow_cache::ShadowCache;
pub use shaft_walk::VisibilityScratch;
pub use surface_edges::SurfaceEdges;
pub use survivors::SurvivorList;
pub use tolerance::Tolerance;
pub use trimmed::LEAST_COSINE;
pub use verdict::Verdict;
pub use visibility_question::{VisibilityAnswer, WalkLimits};
pub use wide_tree::WideTreeDefect;

#[cfg(test)]
mod blockers_tests;
#[cfg(test)]
mod empty_box_proofs;
#[cfg(test)]
mod flush_proofs;
#[cfg(test)]
mod nasty_pairs;
#[cfg(test)]
mod nasty_scenes;
#[cfg(test)]
mod occlusion_proofs;
#[cfg(test)]
mod proof_stage;
#[cfg(test)]
mod screen_proofs;
#[cfg(test)]
mod shadow_cache_tests;
#[cfg(test)]
mod solid_proofs;
#[cfg(test)]
mod surface_proofs;
#[cfg(test)]
mod survivor_proofs;
#[cfg(test)]
mod visibility_proofs;
