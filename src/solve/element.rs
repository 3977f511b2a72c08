//! Elements as the solver meets them: a node of the hierarchy or a patch, with the geometry that
//! the oracle, the form factor and the visibility tests need.

use super::element_name::ElementName;
use super::solution::{PatchPath, split_triangle};
use crate::cluster::{Hierarchy, NodeKind};
use crate::math::{Aabb, FacetId, NodeId};
use crate::scene::Scene;
use crate::visibility::ElementBounds;
use glam::Vec3;

/// What kind of surface an element is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A volume cluster: bounds only.
    Volume,
    /// A face cluster.
    Cluster,
    /// A facet or a patch: corners counter-clockwise seen from its side.
    Triangle([Vec3; 3]),
}

/// An element: polygon, patch, face cluster or volume cluster.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    /// The node, or for a patch the leaf of its facet.
    pub node: NodeId,
    /// Where in the facet; the root for every node.
    pub path: PatchPath,
    /// Kind and corners.
    pub shape: Shape,
    /// Box around it.
    pub bounds: Aabb,
    /// Area-weighted centroid.
    pub centroid: Vec3,
    /// Axis of the cone of normals, unit length; of a triangle its normal.
    pub normal: Vec3,
    /// Sine of the cone's half-angle; 1 beyond a right angle.
    pub cone_sin: f32,
    /// Cosine of the cone's half-angle; negative beyond a right angle.
    pub cone_cos: f32,
    /// Signed distance of the fitted plane along its normal (of a triangle `normal . corner`).
    pub plane_offset: f32,
    /// Normal of the fitted plane.
    pub plane_normal: Vec3,
    /// Greatest distance from the fitted plane.
    pub deviation: f32,
    /// Area.
    pub area: f32,
    /// Radius about the centroid of a sphere around the element.
    pub radius: f32,
    /// Facets covered.
    pub first_facet: u32,
    /// Number of facets covered; 1 for facets and patches.
    pub facet_count: u32,
}

impl Element {
    /// The element with this name.
    pub fn named(scene: &Scene, hierarchy: &Hierarchy, name: ElementName) -> Self {
        let root = Self::of_node(scene, hierarchy, name.node);
        name.path.steps().fold(root, |element, which| {
            let Shape::Triangle(corners) = element.shape else {
                unreachable!("only facets are split into patches");
            };
            element.triangle_child(corners, which)
        })
    }

    /// What it is called.
    pub fn name(&self) -> ElementName {
        ElementName {
            node: self.node,
            path: self.path,
        }
    }

    /// The convex set that stands for this element in shafts: its corners, or its box.
    pub fn shaft_bounds(&self) -> ElementBounds {
        match &self.shape {
            Shape::Triangle(corners) => ElementBounds::from_triangle(*corners, self.bounds),
            _ => ElementBounds::from_box(self.bounds),
        }
    }

    /// The element of a node.
    pub fn of_node(scene: &Scene, hierarchy: &Hierarchy, id: NodeId) -> Self {
        let node = hierarchy.node(id);
        let shape = hierarchy.shape(id);
        if node.kind == NodeKind::Facet {
            let corners = scene.facet_corners(hierarchy.facets[node.first_facet as usize]);
            let [a, b, c] = corners.map(Vec3::as_dvec3);
            let cross = (b - a).cross(c - a);
            let normal = cross.normalize_or_zero().as_vec3();
            return Self::of_triangle(
                id,
                PatchPath::ROOT,
                corners,
                normal,
                (0.5 * cross.length()) as f32,
                node.first_facet,
            );
        }
        let far = (node.bounds.max - shape.centroid).max(shape.centroid - node.bounds.min);
        let (cone_sin, cone_cos) = if shape.cone.half_angle >= std::f32::consts::FRAC_PI_2 {
            (1.0, shape.cone.half_angle.cos())
        } else {
            shape.cone.half_angle.sin_cos()
        };
        Self {
            node: id,
            path: PatchPath::ROOT,
            shape: match node.kind {
                NodeKind::Volume => Shape::Volume,
                _ => Shape::Cluster,
            },
            bounds: node.bounds,
            centroid: shape.centroid,
            normal: shape.cone.axis,
            cone_sin,
            cone_cos,
            plane_offset: shape.plane.offset,
            plane_normal: shape.plane.normal,
            deviation: shape.deviation,
            area: shape.area,
            radius: far.length(),
            first_facet: node.first_facet,
            facet_count: node.facet_count,
        }
    }

    fn of_triangle(
        node: NodeId,
        path: PatchPath,
        corners: [Vec3; 3],
        normal: Vec3,
        area: f32,
        facet: u32,
    ) -> Self {
        let [a, b, c] = corners;
        let centroid = (a + b + c) * (1.0 / 3.0);
        let radius2 = (a - centroid)
            .length_squared()
            .max((b - centroid).length_squared())
            .max((c - centroid).length_squared());
        Self {
            node,
            path,
            shape: Shape::Triangle(corners),
            bounds: Aabb::of_triangle(corners),
            centroid,
            normal,
            cone_sin: 0.0,
            cone_cos: 1.0,
            plane_offset: normal.dot(a),
            plane_normal: normal,
            deviation: 0.0,
            area,
            radius: radius2.sqrt(),
            first_facet: facet,
            facet_count: 1,
        }
    }

    /// Child `which` of a triangle, split at its edge midpoints: all that does not follow from its own corners is
    /// the parent's, halved.
    pub fn triangle_child(&self, corners: [Vec3; 3], which: u32) -> Self {
        let corners = split_triangle(corners, which);
        let [a, b, c] = corners;
        Self {
            path: self.path.child(which),
            shape: Shape::Triangle(corners),
            bounds: Aabb::of_triangle(corners),
            centroid: (a + b + c) * (1.0 / 3.0),
            area: self.area * 0.25,
            radius: self.radius * 0.5,
            ..*self
        }
    }

    /// The next smaller parts of an element, which cover it: the four triangles of a patch, the children of a cluster.
    /// `elements` holds those of the nodes.
    pub fn parts(&self, hierarchy: &Hierarchy, elements: &[Self]) -> Vec<Self> {
        match self.shape {
            Shape::Triangle(corners) => (0..4)
                .map(|which| self.triangle_child(corners, which))
                .collect(),
            _ => {
                let children = hierarchy.children(self.node);
                let nodes = children.into_iter().flatten();
                nodes.map(|id| elements[id.index()]).collect()
            }
        }
    }

    /// The facet of a triangle element.
    pub fn facet(&self) -> FacetId {
        debug_assert!(matches!(self.shape, Shape::Triangle(_)));
        FacetId(self.first_facet)
    }

    /// The facets covered.
    pub fn facet_range(&self) -> std::ops::Range<usize> {
        self.first_facet as usize..(self.first_facet + self.facet_count) as usize
    }

    /// True for facets and patches.
    pub fn is_triangle(&self) -> bool {
        matches!(self.shape, Shape::Triangle(_))
    }

    /// True when the two share a facet: one holds the other, since the hierarchy is a tree.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.first_facet < other.first_facet + other.facet_count
            && other.first_facet < self.first_facet + self.facet_count
    }

    /// True when no point of this element has a normal with any part of `other` in front of it, up
    /// to `tolerance` of depth: proof that nothing is exchanged (paper, section 5.3: the cone of
    /// normals faces away).
    ///
    /// For every normal n of the cone and a in A, b in B: n.(b - a) <= n.D + |n|.h, with D between
    /// the box centres and h the sum of the half-extents; and n lies within the cone about the axis.
    pub fn faces_away(&self, other: &Self, tolerance: f32) -> bool {
        match self.shape {
            Shape::Volume => false,
            // Most often the centroid alone shows that it does not.
            Shape::Triangle(_) => {
                self.height(other.centroid) <= tolerance && self.plane_range(other)[1] <= tolerance
            }
            Shape::Cluster => {
                // One normal of the cone, one point of each: most often enough to see that it does not.
                let ahead = self.normal.dot(other.centroid - self.centroid);
                if self.cone_cos <= 0.0 || ahead > tolerance {
                    return false;
                }
                // Through the plane: n = cos p + sin q; the first term is the plane's support.
                let reach = (other.centroid - self.centroid).length() + other.radius + self.radius;
                let by_plane =
                    self.plane_range(other)[1] + self.deviation + 2.0 * self.cone_sin * reach;
                if by_plane <= tolerance {
                    return true;
                }
                let d = other.bounds.centre() - self.bounds.centre();
                let h = other.bounds.half_extent() + self.bounds.half_extent();
                let along = self.normal.dot(d);
                let across = (d.length_squared() - along * along).max(0.0).sqrt();
                let swing = if along > 0.0 && across * self.cone_cos <= along * self.cone_sin {
                    d.length()
                } else {
                    along * self.cone_cos + across * self.cone_sin
                };
                swing + self.normal.abs().dot(h) + self.cone_sin * h.length() <= tolerance
            }
        }
    }

    /// True when every point of this element has all of `other` on the front of its plane, up to
    /// `tolerance`: then one irradiance or flux vector stands for the whole cluster (Willmott et al. 1999).
    pub fn faces_fully(&self, other: &Self, tolerance: f32) -> bool {
        match self.shape {
            Shape::Volume => false,
            Shape::Triangle(_) => self.plane_range(other)[0] >= -tolerance,
            Shape::Cluster => {
                let ahead = self.normal.dot(other.centroid - self.centroid);
                if self.cone_cos <= 0.0 || ahead < -tolerance {
                    return false;
                }
                let reach = (other.centroid - self.centroid).length() + other.radius + self.radius;
                let by_plane =
                    self.plane_range(other)[0] - self.deviation - 2.0 * self.cone_sin * reach;
                if by_plane >= -tolerance {
                    return true;
                }
                let d = other.bounds.centre() - self.bounds.centre();
                let h = other.bounds.half_extent() + self.bounds.half_extent();
                let along = self.normal.dot(d);
                let across = (d.length_squared() - along * along).max(0.0).sqrt();
                along * self.cone_cos
                    - across * self.cone_sin
                    - self.normal.abs().dot(h)
                    - self.cone_sin * h.length()
                    >= -tolerance
            }
        }
    }

    /// An upper bound of the cosine at which any segment from this element to `other`, `gap` away, leaves it.
    pub fn greatest_cosine(&self, other: &Self, gap: f32) -> f32 {
        let bend = match self.shape {
            Shape::Volume => return 1.0,
            Shape::Triangle(_) => 0.0,
            Shape::Cluster if self.cone_cos <= 0.0 => return 1.0,
            // As in `faces_away`.
            Shape::Cluster => {
                let reach = (other.centroid - self.centroid).length() + other.radius + self.radius;
                self.deviation + 2.0 * self.cone_sin * reach
            }
        };
        let height = self.plane_range(other)[1] + bend;
        if height < gap {
            (height / gap).max(0.0)
        } else {
            1.0
        }
    }

    /// True when every segment from a point of this triangle to one of `other` leaves its plane at a cosine above
    /// `least`, by a safe margin. False for clusters.
    pub fn faces_beyond(&self, other: &Self, least: f32) -> bool {
        let apart = (other.centroid - self.centroid).length() + other.radius + self.radius;
        self.is_triangle() && self.plane_range(other)[0] > 2.0 * least * apart
    }

    /// Signed distance of a point to the plane.
    fn height(&self, point: Vec3) -> f32 {
        self.plane_normal.dot(point) - self.plane_offset
    }

    /// Least and greatest signed distance of another element to this one's plane: of a triangle by its corners
    /// (a slanting one's box reaches far through its own plane), of a cluster by its box.
    fn plane_range(&self, other: &Self) -> [f32; 2] {
        let n = self.plane_normal;
        if let Shape::Triangle(corners) = other.shape {
            let [a, b, c] = corners.map(|p| self.height(p));
            let (least, most) = if a < b { (a, b) } else { (b, a) };
            return [
                if c < least { c } else { least },
                if c > most { c } else { most },
            ];
        }
        let (plus, minus) = (n.max(Vec3::ZERO), n.min(Vec3::ZERO));
        let (lo, hi) = (other.bounds.min, other.bounds.max);
        [
            plus.dot(lo) + minus.dot(hi) - self.plane_offset,
            plus.dot(hi) + minus.dot(lo) - self.plane_offset,
        ]
    }
}
