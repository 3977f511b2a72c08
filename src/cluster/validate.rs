//! What makes a hierarchy valid, checked against the scene that it was built from.

use super::hierarchy::{Hierarchy, HierarchyDefect, Node, NodeKind};
use super::shape::doubled_area_vector;
use crate::math::{Aabb, NodeId, Plane};
use crate::scene::{Facet, Scene};
use glam::Vec3;

/// Relative difference allowed between a node's area and the sum of its children's: each of the
/// three is rounded to f32.
const AREA_TOLERANCE: f32 = 4.0e-7;

/// What a node must be, in words.
type Check = Result<(), &'static str>;

impl Hierarchy {
    /// Checks every promise of the hierarchy's types; the first that is broken is the error.
    ///
    /// Work is of the order of facets times depth.
    pub fn validate(&self, scene: &Scene) -> Result<(), HierarchyDefect> {
        let defect = |node: usize, reason| HierarchyDefect {
            node: node as u32,
            reason,
        };
        self.check_whole(scene)
            .map_err(|reason| defect(0, reason))?;
        for index in 0..self.nodes.len() {
            let id = NodeId::new(index);
            self.check_structure(id)
                .and_then(|()| self.check_contents(id, scene))
                .map_err(|reason| defect(index, reason))?;
        }
        Ok(())
    }

    /// Array lengths, the root's range, and that no facet occurs twice.
    fn check_whole(&self, scene: &Scene) -> Check {
        let expected = (2 * self.facets.len()).saturating_sub(1);
        ensure(
            self.nodes.len() == expected,
            "node count is not 2 facets - 1",
        )?;
        ensure(
            self.shapes.len() == expected,
            "shapes are not parallel to nodes",
        )?;
        ensure(
            self.leaf_of_facet.len() == self.facets.len(),
            "leaves are not parallel to facets",
        )?;
        if let Some(root) = self.nodes.first() {
            ensure(
                root.first_facet == 0 && root.facet_count as usize == self.facets.len(),
                "the root does not cover all facets",
            )?;
        }
        let mut sorted: Vec<Facet> = self.facets.clone();
        sorted.sort_unstable_by_key(|f| (f.polygon, f.side));
        ensure(
            sorted.windows(2).all(|w| w[0] != w[1]),
            "a facet occurs twice",
        )?;
        ensure(
            sorted
                .last()
                .is_none_or(|f| f.polygon.index() < scene.polygons.len()),
            "a facet has no polygon",
        )
    }

    /// Places, ranges and kinds of a node and its children.
    fn check_structure(&self, id: NodeId) -> Check {
        let node = self.node(id);
        let Some(children) = self.children(id) else {
            ensure(node.facet_count == 1, "a leaf covers other than one facet")?;
            ensure(node.first_child == 0, "a leaf has children")?;
            let facet = node.first_facet as usize;
            return ensure(
                self.leaf_of_facet.get(facet) == Some(&id),
                "a facet does not know its leaf",
            );
        };
        ensure(children[0] > id, "a child stands before its parent")?;
        ensure(
            children[1].index() < self.nodes.len(),
            "a child does not exist",
        )?;
        let [left, right] = children.map(|child| self.node(child));
        ensure(
            left.first_facet == node.first_facet
                && right.first_facet == left.first_facet + left.facet_count
                && node.facet_count == left.facet_count + right.facet_count,
            "the children's facets are not the node's",
        )?;
        ensure(
            [left, right].iter().all(|child| rank(child) <= rank(node)),
            "a volume cluster stands below a face cluster",
        )?;
        ensure(
            node.bounds == left.bounds.union(right.bounds),
            "the box is not that of the children",
        )?;
        let [parent, left, right] = [id, children[0], children[1]].map(|n| self.shape(n).area);
        ensure(
            (parent - (left + right)).abs() <= AREA_TOLERANCE * parent,
            "the children's areas do not add up",
        )
    }

    /// Box, plane, deviation and cone of a node against every facet below it.
    fn check_contents(&self, id: NodeId, scene: &Scene) -> Check {
        let (node, shape) = (self.node(id), self.shape(id));
        let normal_length = f64::from(shape.plane.normal.length());
        ensure(
            (normal_length - 1.0).abs() < 1.0e-6,
            "the plane's normal is not a unit vector",
        )?;
        ensure(
            (shape.cone.axis.length() - 1.0).abs() < 1.0e-6,
            "the cone's axis is not a unit vector",
        )?;
        ensure(
            shape.area.is_finite() && shape.area >= 0.0 && shape.centroid.is_finite(),
            "area or centroid is not finite",
        )?;
        ensure(
            shape.area_vector.length() <= shape.area * (1.0 + AREA_TOLERANCE),
            "the area vector is longer than the area",
        )?;
        let mut tight = Aabb::EMPTY;
        for &facet in &self.facets[self.facet_range(id)] {
            let corners = scene.facet_corners(facet);
            tight = corners.into_iter().fold(tight, Aabb::with_point);
            ensure(
                corners.iter().all(|&v| node.bounds.contains(v)),
                "a vertex lies outside the box",
            )?;
            ensure(
                corners
                    .iter()
                    .all(|&v| distance(shape.plane, v) <= f64::from(shape.deviation)),
                "a vertex lies farther from the plane than the deviation",
            )?;
            if let Some(normal) = doubled_area_vector(&corners).try_normalize() {
                ensure(
                    shape.cone.contains(normal.as_vec3()),
                    "a normal lies outside the cone",
                )?;
            }
        }
        ensure(tight == node.bounds, "the box is wider than its facets")
    }
}

fn ensure(holds: bool, reason: &'static str) -> Check {
    if holds { Ok(()) } else { Err(reason) }
}

/// Kinds from the leaves up.
fn rank(node: &Node) -> u8 {
    match node.kind {
        NodeKind::Facet => 0,
        NodeKind::FaceCluster => 1,
        NodeKind::Volume => 2,
    }
}

/// Distance of a point to a plane, in f64.
fn distance(plane: Plane, point: Vec3) -> f64 {
    let normal = plane.normal.as_dvec3();
    (normal.dot(point.as_dvec3()) - f64::from(plane.offset)).abs() / normal.length()
}
