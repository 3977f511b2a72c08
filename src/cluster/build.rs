//! Building the scene hierarchy: one line a stage.

use super::adjacency::link_neighbours;
use super::balance::balance;
use super::face_clustering::cluster_faces;
use super::flatten::flatten;
use super::forest::Forest;
use super::hierarchy::Hierarchy;
use super::shape::cluster_shapes;
use super::surface_measure::{CostScale, SurfaceMeasure};
use super::volume_clustering::{Piece, cluster_volumes};
use super::welded_edges::WELD;
use crate::math::Aabb;
use crate::scene::{Facet, Scene};

/// How to cluster.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClusterConfig {
    /// Width of the cracks that count as closed, over the diagonal of the scene.
    pub weld: f64,
    /// Half-angle in radians beyond which neighbours are joined by volume clusters and no longer by
    /// face clusters; pi makes every connected surface one face cluster. About: the spread of
    /// normals that contraction knows is an upper bound.
    pub widest: f64,
}

impl Default for ClusterConfig {
    fn default() -> Self {
        Self {
            weld: WELD,
            widest: std::f64::consts::PI,
        }
    }
}

/// Builds the hierarchy of `facets` (sides of polygons of `scene`, sorted by polygon and side, each
/// at most once). Without facets it has no nodes, not even a root. Depth is of the order of the
/// logarithm of the number of facets (see `balance`), work of facets times depth.
pub fn build_hierarchy(scene: &Scene, facets: &[Facet], config: &ClusterConfig) -> Hierarchy {
    let Some(bounds) = facet_bounds(scene, facets) else {
        return Hierarchy {
            nodes: Vec::new(),
            shapes: Vec::new(),
            facets: Vec::new(),
            leaf_of_facet: Vec::new(),
        };
    };
    let diagonal = bounds.min.as_dvec3().distance(bounds.max.as_dvec3());
    let links = link_neighbours(scene, facets, config.weld * diagonal);
    let measures = measure_facets(scene, facets, bounds);
    let area = measures.iter().map(SurfaceMeasure::area).sum();
    let mut forest = Forest::new(facets.len());
    cluster_faces(
        measures,
        &links,
        CostScale::new(diagonal, config.weld * diagonal, area),
        config.widest,
        &mut forest,
    );
    drop(links);
    let leaf_bounds = |leaf: u32| Aabb::from_points(scene.corners(facets[leaf as usize].polygon));
    let mut forest = balance(forest, leaf_bounds);
    let first_volume = forest.len() as u32;
    let mut pieces = surface_pieces(&forest, leaf_bounds);
    let root = cluster_volumes(&mut pieces, u8::MAX, &mut forest);
    let flat = flatten(scene, facets, &forest, root, first_volume);
    drop(forest);
    let shapes = cluster_shapes(scene, &flat.facets, &flat.nodes);
    let hierarchy = Hierarchy {
        nodes: flat.nodes,
        shapes,
        facets: flat.facets,
        leaf_of_facet: flat.leaf_of_facet,
    };
    debug_assert_eq!(hierarchy.validate(scene), Ok(()));
    hierarchy
}

fn facet_bounds(scene: &Scene, facets: &[Facet]) -> Option<Aabb> {
    let bounds = Aabb::from_points(facets.iter().flat_map(|f| scene.corners(f.polygon)));
    (!bounds.is_empty()).then_some(bounds)
}

/// Measures about the centre of the scene, where f64 loses least to cancellation.
fn measure_facets(scene: &Scene, facets: &[Facet], bounds: Aabb) -> Vec<SurfaceMeasure> {
    let centre = 0.5 * (bounds.min.as_dvec3() + bounds.max.as_dvec3());
    facets
        .iter()
        .map(|&f| {
            SurfaceMeasure::of_triangle(scene.facet_corners(f).map(|v| v.as_dvec3() - centre))
        })
        .collect()
}

/// The trees of the forest with their boxes.
fn surface_pieces(forest: &Forest, leaf_bounds: impl Fn(u32) -> Aabb) -> Vec<Piece> {
    let counts = forest.fold(|_| 1_u32, |a, b| a + b);
    let bounds = forest.fold(leaf_bounds, Aabb::union);
    let piece = |root: u32| Piece {
        root,
        bounds: bounds[root as usize],
        facets: counts[root as usize],
    };
    forest.roots().into_iter().map(piece).collect()
}
