//! The scene's polygons in an eight-wide hierarchy, for shafts and for native segments.
//!
//! What the shaft meets is not the polygon but the polygon *pulled in* by most of the weld distance:
//! a segment is surely blocked only where it crosses more than `weld` inside the border, so a
//! polygon that merely shares an edge with the shaft (every neighbour of an element does) drops out,
//! and no identity of polygons is needed to say so.

use super::plane_octet::PlaneOctet;
use super::shaft::TriangleOctet;
use super::stored_polygon::StoredPolygon;
use super::tolerance::Tolerance;
use super::wide_tree::{BoxOctet, ChildRef, WideLeaf, WideTree};
use crate::math::{Aabb, PolygonId};
use crate::scene::Scene;
use glam::Vec3;

/// The polygons of a scene, ready to be queried.
#[derive(Clone, Debug)]
pub struct SceneTree {
    pub(super) tree: WideTree,
    /// Pulled-in polygons of each leaf.
    pub(super) octets: Vec<TriangleOctet>,
    /// The polygons as they are, leaf by leaf: those of leaf `i` start at `8 i`.
    pub(super) polygons: Vec<StoredPolygon>,
    /// Their planes, leaf by leaf.
    pub(super) planes: Vec<PlaneOctet>,
    pub(super) tolerance: Tolerance,
    bounds: Aabb,
}

impl SceneTree {
    /// The hierarchy over all polygons of `scene`.
    pub fn build(scene: &Scene) -> Self {
        let tolerance = Tolerance::of_scene(scene.bounds());
        let corners: Vec<[Vec3; 3]> = (0..scene.polygons.len())
            .map(|i| scene.corners(PolygonId::new(i)))
            .collect();
        Self::over_triangles(&corners, tolerance)
    }

    /// The hierarchy over loose triangles, whose indices become their ids.
    pub fn over_triangles(triangles: &[[Vec3; 3]], tolerance: Tolerance) -> Self {
        let stored: Vec<StoredPolygon> = triangles
            .iter()
            .zip(0_u32..)
            .map(|(&t, id)| StoredPolygon::new(t, PolygonId(id), &tolerance))
            .collect();
        let pulled: Vec<[Vec3; 3]> = stored
            .iter()
            .map(|p| p.pulled_in(&tolerance).map(|p| p.as_vec3()))
            .collect();
        let boxes: Vec<Aabb> = pulled.iter().map(|&t| Aabb::from_points(t)).collect();
        let tree = WideTree::build(&boxes);
        let octets = tree
            .leaves
            .iter()
            .map(|leaf| octet_of(leaf, &pulled))
            .collect();
        let polygons: Vec<StoredPolygon> = tree
            .leaves
            .iter()
            .flat_map(|leaf| leaf.primitives)
            .map(|id| match id {
                WideLeaf::NONE => StoredPolygon::NONE,
                _ => stored[id as usize],
            })
            .collect();
        Self {
            tree,
            octets,
            planes: polygons.chunks(8).map(PlaneOctet::new).collect(),
            polygons,
            tolerance,
            bounds: boxes.iter().fold(Aabb::EMPTY, |b, &x| b.union(x)),
        }
    }

    /// The tolerances of the scene.
    pub fn tolerance(&self) -> &Tolerance {
        &self.tolerance
    }

    /// The box of everything.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Every polygon with its corners, in the order of the leaves.
    pub fn polygons(&self) -> impl Iterator<Item = (PolygonId, [Vec3; 3])> + '_ {
        let used = |p: &&StoredPolygon| p.id != StoredPolygon::NONE.id;
        self.polygons.iter().filter(used).map(|p| (p.id, p.corners))
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.tree.bytes()
            + self.octets.len() * size_of::<TriangleOctet>()
            + self.polygons.len() * size_of::<StoredPolygon>()
            + self.planes.len() * size_of::<PlaneOctet>()
    }

    /// The box and reference of the root, where there is any polygon.
    pub(super) fn root(&self) -> Option<(ChildRef, Aabb)> {
        (!self.tree.nodes.is_empty()).then_some((ChildRef::node(0), self.bounds))
    }

    /// Bit per lane of a leaf that holds a polygon.
    pub(super) fn used_lanes(&self, leaf: usize) -> u32 {
        (1 << self.tree.leaves[leaf].len()) - 1
    }

    /// The box of a pulled-in polygon.
    pub(super) fn polygon_box(&self, leaf: usize, lane: usize) -> Aabb {
        let octet = &self.octets[leaf].corners;
        Aabb::from_points(
            octet
                .iter()
                .map(|c| Vec3::new(c[0][lane], c[1][lane], c[2][lane])),
        )
    }
}

fn octet_of(leaf: &WideLeaf, pulled: &[[Vec3; 3]]) -> TriangleOctet {
    // Unused lanes lie where every shaft has them outside.
    let far = BoxOctet::EMPTY.min[0][0];
    let mut octet = TriangleOctet {
        corners: [[[far; 8]; 3]; 3],
    };
    for (lane, &id) in leaf.primitives[..leaf.len()].iter().enumerate() {
        for (corner, &p) in octet.corners.iter_mut().zip(&pulled[id as usize]) {
            for axis in 0..3 {
                corner[axis][lane] = p[axis];
            }
        }
    }
    octet
}
