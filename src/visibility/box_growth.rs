//! Grows an empty box as far as it goes: each face in turn a step outwards, up to what stands in its way.

use super::bounds::ElementBounds;
use super::crossing::harmless_depth;
use super::scene_tree::SceneTree;
use super::shaft::Shaft;
use super::stored_polygon::StoredPolygon;
use super::tolerance::Tolerance;
use super::wide_tree::ChildRef;
use crate::math::{Aabb, PolygonId};
use glam::{DVec3, Vec3};

/// First step, in lengths of the scene; each round of all faces doubles it, so that boxes grow evenly.
const FIRST_STEP: f32 = 1.0 / 16.0;

/// Attempts at one step: each ends at an obstacle that the one before met.
const ATTEMPTS: u32 = 12;

/// Grows boxes in one scene.
#[derive(Clone, Debug)]
pub(super) struct BoxGrower<'a> {
    scene: &'a SceneTree,
    /// Corners of each polygon.
    corners: std::sync::Arc<[[Vec3; 3]]>,
    bounds: Aabb,
    tau: f32,
    /// Nodes to be opened.
    stack: Vec<ChildRef>,
}

/// One of the six ways out of a box.
#[derive(Clone, Copy)]
struct Face {
    axis: usize,
    up: bool,
}

impl Face {
    const ALL: [Self; 6] = [
        Self { axis: 0, up: false },
        Self { axis: 0, up: true },
        Self { axis: 1, up: false },
        Self { axis: 1, up: true },
        Self { axis: 2, up: false },
        Self { axis: 2, up: true },
    ];

    /// Height along the face's outward direction.
    fn height(self, of: Aabb) -> f32 {
        match self.up {
            true => of.max[self.axis],
            false => -of.min[self.axis],
        }
    }

    /// `of` with this face at another height.
    fn moved(self, mut of: Aabb, height: f32) -> Aabb {
        match self.up {
            true => of.max[self.axis] = height,
            false => of.min[self.axis] = -height,
        }
        of
    }
}

impl<'a> BoxGrower<'a> {
    pub(super) fn new(scene: &'a SceneTree) -> Self {
        let mut corners = vec![[Vec3::ZERO; 3]; scene.polygons().count()];
        for (id, polygon) in scene.polygons() {
            corners[id.index()] = polygon;
        }
        Self {
            scene,
            stack: Vec::new(),
            corners: corners.into(),
            bounds: scene.bounds(),
            tau: scene.tolerance().tau,
        }
    }

    /// The box grown from `seed`; `None` if that is not empty, or flat.
    pub(super) fn grow(&mut self, seed: Aabb) -> Option<Aabb> {
        if (seed.max - seed.min).min_element() < self.least() || self.obstacle(seed).is_some() {
            return None;
        }
        let mut grown = seed;
        let mut faces = Face::ALL.to_vec();
        let mut step = (self.bounds.max - self.bounds.min) * FIRST_STEP;
        while !faces.is_empty() {
            faces.retain(|&face| self.push(&mut grown, face, step[face.axis]));
            step *= 2.0;
        }
        // Walls that are flat only up to rounding stick out of their own plane by less than this.
        let loose = Aabb {
            min: grown.min - 0.5 * self.tau,
            max: grown.max + 0.5 * self.tau,
        };
        Some(match self.obstacle(loose) {
            None => loose,
            Some(_) => grown,
        })
    }

    /// Lengths below this are not worth a step, nor safe from the predicates' margins.
    fn least(&self) -> f32 {
        16.0 * self.tau
    }

    /// A polygon that keeps a box from being proved empty.
    ///
    /// None may cut a segment between two points of the box, each of which may stick out by
    /// [`Tolerance::nesting`](super::Tolerance): so each polygon, pulled in as for any other claim, misses the box grown
    /// by that and by the rounding of f32 ([`Shaft::new`]), or has the box on one side of its plane, up to a depth
    /// within tau.
    fn obstacle(&mut self, bounds: Aabb) -> Option<PolygonId> {
        let scene = self.scene;
        let element = ElementBounds::from_box(bounds);
        // Without slanted planes: the box and its margins.
        let grown = Shaft::new(&element, &element, &scene.tolerance);
        self.stack.clear();
        self.stack.extend(scene.root().map(|(root, _)| root));
        while let Some(reference) = self.stack.pop() {
            let index = reference.index();
            if !reference.is_leaf() {
                let node = &scene.tree.nodes[index];
                let met = grown.meets_boxes(&node.boxes);
                let children = (0..8).filter(|lane| met & (1 << lane) != 0);
                self.stack.extend(children.map(|lane| node.children[lane]));
                continue;
            }
            let met = grown.meets_triangles(&scene.octets[index], scene.used_lanes(index));
            let mut lanes = (0..8).filter(|lane| met & (1 << lane) != 0);
            let found = lanes.find(|lane| {
                let polygon = &scene.polygons[8 * index + lane];
                reaches_into(polygon, &grown, bounds, &scene.tolerance)
            });
            if let Some(lane) = found {
                return Some(scene.polygons[8 * index + lane].id);
            }
        }
        None
    }

    /// Moves a face outwards by `step` or less; false once it can go no further.
    fn push(&mut self, grown: &mut Aabb, face: Face, step: f32) -> bool {
        let now = face.height(*grown);
        let end = face.height(self.bounds);
        let mut target = (now + step).min(end);
        let mut is_limit = target == end;
        for _ in 0..ATTEMPTS {
            if target <= now + self.least() {
                return false;
            }
            let bigger = face.moved(*grown, target);
            let limit = match self.obstacle(bigger) {
                None => {
                    *grown = bigger;
                    return !is_limit;
                }
                Some(id) => self.reach(id, *grown, face),
            };
            is_limit = limit.is_some();
            target = match limit {
                // What slants may not be touched.
                Some(limit) if limit >= target => target - 8.0 * self.tau,
                Some(limit) => limit,
                None => 0.5 * (now + target),
            };
        }
        false
    }

    /// Where a face that moves outwards first meets a polygon; `None` if never.
    fn reach(&self, id: PolygonId, grown: Aabb, face: Face) -> Option<f32> {
        let mut piece: Vec<DVec3> = self.corners[id.index()]
            .iter()
            .map(|p| p.as_dvec3())
            .collect();
        let pad = 4.0 * f64::from(self.tau);
        for axis in [(face.axis + 1) % 3, (face.axis + 2) % 3] {
            let low = f64::from(grown.min[axis]) + pad;
            let high = f64::from(grown.max[axis]) - pad;
            piece = clipped(&piece, |p| p[axis] - high);
            piece = clipped(&piece, |p| low - p[axis]);
        }
        let sign = if face.up { 1.0 } else { -1.0 };
        piece
            .iter()
            .map(|p| sign * p[face.axis])
            .min_by(f64::total_cmp)
            .map(|height| height as f32)
    }
}

/// False only if `polygon` surely blocks no segment within `bounds`, which `grown` holds with its margins. Its height over the
/// centre is right to 2e-9 (see [`StoredPolygon::new`]), which the room for seven roundings in `nesting` (2e-7) covers.
fn reaches_into(
    polygon: &StoredPolygon,
    grown: &Shaft,
    bounds: Aabb,
    tolerance: &Tolerance,
) -> bool {
    if let Some(known) = polygon.may_block_by_shape() {
        return known;
    }
    let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let centre = 0.5 * (low + high);
    let normal = polygon.normal;
    let height = normal.dot(centre - polygon.corners[0].as_dvec3());
    let depth = normal.abs().dot(0.5 * (high - low)) - height.abs();
    if depth <= harmless_depth(tolerance) {
        return false;
    }
    let (low, high) = grown.bounds();
    let half = (high.as_dvec3() - centre).max(centre - low.as_dvec3());
    let corners = polygon.pulled_in(tolerance).map(|p| p - centre);
    // The axes that part a box and a triangle, besides their own normals (Akenine-Moeller 2001).
    let parted = (0..3).any(|i| {
        let edge = corners[(i + 1) % 3] - corners[i];
        DVec3::AXES.iter().any(|axis| {
            let across = axis.cross(edge);
            let reach = across.abs().dot(half) + ROUNDING;
            let along = corners.map(|p| across.dot(p));
            along.iter().all(|&x| x > reach) || along.iter().all(|&x| x < -reach)
        })
    });
    !parted
}

/// Corners lie at most 2 from the centre in each coordinate (normalised) and are right to 1e-15, so are the edges twice over;
/// a sum of two products of them errs by less than 1e-14. The box is grown by more than 1e-7 besides.
const ROUNDING: f64 = 1.0e-14;

/// The part of a convex polygon where `height` is not above zero.
fn clipped(piece: &[DVec3], height: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(piece.len() + 1);
    for (i, &p) in piece.iter().enumerate() {
        let q = piece[(i + 1) % piece.len()];
        let (over_p, over_q) = (height(p), height(q));
        if over_p <= 0.0 {
            kept.push(p);
        }
        if over_p.min(over_q) < 0.0 && over_p.max(over_q) > 0.0 {
            kept.push(p + (q - p) * (over_p / (over_p - over_q)));
        }
    }
    kept
}
