//! Full occlusion of a pair by a surface of any shape: polygons that hang together and leave no way past them (beyond
//! the paper, whose section 7 asks for occluders other than flat ones).
//!
//! Take polygons, each turned one way or the other: a chain. Of an edge that two of them share and run along in opposite
//! directions nothing is left in the chain's border. The number of times that a curve crosses the chain in one sense,
//! less the times in the other, changes only where the curve passes its border or an end of it touches the chain. Now the
//! segments between two convex elements hang together (they are the pairs of points of two convex sets). So **if no
//! polygon of the chain touches an element, if no segment meets what is left of its border, and if one segment crosses it
//! more often in one sense than in the other, then every segment does**, and none is clear: bent sheets, the near side
//! of a round body, walls that meet at a corner, none of which holds a rectangle that would do.
//!
//! Only edges that are the same to the bit count as shared, so that there are no cracks to argue about. What is left of
//! the border has to stay away from all segments by the weld distance ([`SurfacePair::passes_beside`]). Or it lies at a
//! plane of the shaft, as the foot of a wall does where both elements stand on the floor: there the surface is taken to
//! stick out by less than the weld distance, all along the border in one direction, and what passes the overhang is not
//! surely clear.

use super::bounds::ElementBounds;
use super::crossing::blocks_centre_segment;
use super::faults::Faults;
use super::probe_segment::{ProbeSegment, SegmentWalk};
use super::scene_tree::SceneTree;
use super::stored_polygon::StoredPolygon;
use super::surface_edges::{PolygonEdge, SurfaceEdges};
use super::surface_pair::{SurfacePair, inner_point};
use crate::math::PolygonId;
use glam::DVec3;
use robust::{Coord3D, orient3d};

/// Polygons of a surface that are looked at before it is given up: what cuts the shaft of a single exchange is seldom
/// more than a dozen.
const MOST_POLYGONS: usize = 64;
/// Polygons across one segment of the pair from which a surface is sought.
const MOST_SEEDS: usize = 4;

/// What a caller lends to queries, so that they allocate seldom. One a task.
#[derive(Clone, Debug, Default)]
pub struct SurfaceScratch {
    stack: Vec<u32>,
    seeds: Vec<PolygonId>,
    /// What earlier surfaces of a query held.
    given_up: Vec<PolygonId>,
    surface: Growing,
}

/// A surface while it grows.
#[derive(Clone, Debug, Default)]
struct Growing {
    /// Few enough for a search from one end.
    members: Vec<Member>,
    /// Edges to be looked at.
    pending: Vec<PolygonEdge>,
    /// Edges at which it sticks out by `step`.
    flush: Vec<PolygonEdge>,
    step: Option<DVec3>,
}

/// A polygon of the surface.
#[derive(Clone, Copy, Debug)]
struct Member {
    polygon: PolygonId,
    /// True where it runs against its own order of corners.
    turned: bool,
    /// Edges that it shares with another member.
    shared: [bool; 3],
}

/// The outcome of [`SurfaceQuery::run`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SurfaceAnswer {
    /// A polygon of a surface that cuts every segment of the pair.
    pub surface: Option<PolygonId>,
    /// Some polygon crosses a segment of the pair.
    pub probe_blocked: bool,
}

/// A surface that cuts every segment of a pair: the chain of the proof, every triangle turned as it runs there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CuttingSurface {
    /// Polygons of the scene.
    pub polygons: Vec<[DVec3; 3]>,
    /// What it is taken to stick out by at its border, less than the weld distance.
    pub overhangs: Vec<[DVec3; 3]>,
}

/// Queries for cutting surfaces against one scene.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceQuery<'a> {
    scene: &'a SceneTree,
    edges: &'a SurfaceEdges,
    faults: Faults,
}

impl<'a> SurfaceQuery<'a> {
    /// Queries against `scene`, whose polygons have `edges`.
    pub fn new(scene: &'a SceneTree, edges: &'a SurfaceEdges) -> Self {
        Self {
            scene,
            edges,
            faults: Faults::NONE,
        }
    }

    /// The same queries with faults planted.
    #[cfg(any(test, feature = "plant-faults"))]
    #[must_use]
    pub fn with_faults(mut self, faults: Faults) -> Self {
        self.faults = faults;
        self
    }

    /// Looks for a surface that cuts every segment between `a` and `b`, both grown by
    /// [`Tolerance::nesting`](super::Tolerance::nesting).
    pub fn run(
        &self,
        a: &ElementBounds,
        b: &ElementBounds,
        scratch: &mut SurfaceScratch,
    ) -> SurfaceAnswer {
        self.find_seeds(ProbeSegment::new(inner_point(a), inner_point(b)), scratch);
        let mut answer = SurfaceAnswer {
            surface: None,
            probe_blocked: !scratch.seeds.is_empty(),
        };
        if scratch.seeds.is_empty() {
            return answer;
        }
        let pair = SurfacePair::new(a, b, self.scene.tolerance());
        scratch.given_up.clear();
        for &seed in &scratch.seeds {
            // What hangs together with a surface that cannot be closed cannot either.
            if scratch.given_up.contains(&seed) {
                continue;
            }
            if self.cuts(seed, &pair, &mut scratch.surface) {
                answer.surface = Some(seed);
                break;
            }
            if scratch.surface.members.len() == MOST_POLYGONS {
                break;
            }
            let held = scratch.surface.members.iter().map(|m| m.polygon);
            scratch.given_up.extend(held);
        }
        answer
    }

    /// The surface that [`Self::run`] finds from a polygon, if it cuts every segment of the pair.
    pub fn surface(
        &self,
        a: &ElementBounds,
        b: &ElementBounds,
        seed: PolygonId,
    ) -> Option<CuttingSurface> {
        let pair = SurfacePair::new(a, b, self.scene.tolerance());
        let mut surface = Growing::default();
        self.cuts(seed, &pair, &mut surface)
            .then(|| CuttingSurface {
                polygons: self.polygons_of(&surface).collect(),
                overhangs: self.overhangs_of(&surface).collect(),
            })
    }

    /// Polygons that surely cross the segment.
    fn find_seeds(&self, segment: ProbeSegment, scratch: &mut SurfaceScratch) {
        scratch.seeds.clear();
        let p = segment.origin.as_dvec3();
        let q = (segment.origin + segment.along).as_dvec3();
        let mut walk = SegmentWalk::new(&segment, &self.scene.tree, &mut scratch.stack);
        while let Some(leaf) = walk.next_leaf() {
            let polygons = &self.scene.polygons[8 * leaf..8 * leaf + 8];
            for polygon in polygons.iter().filter(|p| p.id != StoredPolygon::NONE.id) {
                if blocks_centre_segment(polygon, p, q, self.scene.tolerance()) {
                    scratch.seeds.push(polygon.id);
                    if scratch.seeds.len() == MOST_SEEDS {
                        return;
                    }
                }
            }
        }
    }

    /// Whether the surface that hangs together with a polygon cuts every segment of the pair.
    fn cuts(&self, seed: PolygonId, pair: &SurfacePair, surface: &mut Growing) -> bool {
        surface.clear();
        self.is_apart(seed, pair)
            && self.grows_to_the_end(seed, pair, surface)
            && self.is_crossed(pair, surface)
    }

    /// Follows the surface from a polygon over all edges that some segment of the pair may meet: true if it has no border
    /// there and comes near neither element.
    fn grows_to_the_end(&self, seed: PolygonId, pair: &SurfacePair, surface: &mut Growing) -> bool {
        surface.join(seed, self.turned_to(seed, pair), self.edges);
        while let Some(edge) = surface.pending.pop() {
            let Some(&member) = surface.member(edge.polygon) else {
                return false;
            };
            let ends = self.ends(edge);
            if member.shared[edge.corner] || pair.passes_beside(ends) {
                continue;
            }
            if let Some((other, turned)) = self.continuation(edge, member, pair, surface) {
                surface.join(other.polygon, turned, self.edges);
                surface.share(edge);
                surface.share(other);
                if surface.members.len() >= MOST_POLYGONS {
                    return false;
                }
            } else if let Some(step) = pair.step_out(ends, surface.step) {
                surface.step = Some(step);
                surface.flush.push(edge);
            } else if !self.faults.forgets_borders() {
                return false;
            }
        }
        true
    }

    /// The same edge of a polygon with which the surface goes on, and whether that polygon is turned: one that belongs to
    /// it and runs the other way, else one whose own side agrees, else any.
    fn continuation(
        &self,
        edge: PolygonEdge,
        member: Member,
        pair: &SurfacePair,
        surface: &Growing,
    ) -> Option<(PolygonEdge, bool)> {
        let ascends = edge.ascends != member.turned;
        let mut found = None;
        for other in self.edges.others(edge) {
            let turned = other.ascends == ascends;
            if let Some(neighbour) = surface.member(other.polygon) {
                if neighbour.turned == turned && !neighbour.shared[other.corner] {
                    return Some((other, turned));
                }
            } else if self.is_apart(other.polygon, pair) {
                let agrees = self.turned_to(other.polygon, pair) == turned;
                if agrees || found.is_none() {
                    found = Some((other, turned));
                }
            }
        }
        found
    }

    /// True only if neither element comes within tau of the polygon.
    fn is_apart(&self, polygon: PolygonId, pair: &SurfacePair) -> bool {
        let corners = self.edges.corners(polygon);
        pair.is_apart_from(&StoredPolygon::new(
            corners,
            polygon,
            self.scene.tolerance(),
        ))
    }

    /// Whether a polygon's own normal points away from the first element.
    fn turned_to(&self, polygon: PolygonId, pair: &SurfacePair) -> bool {
        let [u, v, w] = self.edges.corners(polygon).map(|c| c.as_dvec3());
        (v - u).cross(w - u).dot(pair.probe()[0] - u) < 0.0
    }

    fn ends(&self, edge: PolygonEdge) -> [DVec3; 2] {
        let corners = self.edges.corners(edge.polygon);
        [corners[edge.corner], corners[(edge.corner + 1) % 3]].map(|c| c.as_dvec3())
    }

    /// The polygons of a surface as they run in it.
    fn polygons_of(&self, surface: &Growing) -> impl Iterator<Item = [DVec3; 3]> {
        surface.members.iter().map(|member| {
            let [u, v, w] = self.edges.corners(member.polygon).map(|c| c.as_dvec3());
            match member.turned {
                true => [u, w, v],
                false => [u, v, w],
            }
        })
    }

    /// The strips by which a surface sticks out, which run along its border against it.
    fn overhangs_of(&self, surface: &Growing) -> impl Iterator<Item = [DVec3; 3]> {
        let step = surface.step.unwrap_or_default();
        surface.flush.iter().flat_map(move |&edge| {
            let [u, v] = self.ends(edge);
            let [u, v] = match surface.member(edge.polygon).is_some_and(|m| m.turned) {
                true => [v, u],
                false => [u, v],
            };
            [[v, u, u + step], [v, u + step, v + step]]
        })
    }

    /// True only if the pair's probe crosses the surface more often in one sense than in the other.
    fn is_crossed(&self, pair: &SurfacePair, surface: &Growing) -> bool {
        let [p, q] = pair.probe();
        let mut crossings = 0;
        for triangle in self.polygons_of(surface).chain(self.overhangs_of(surface)) {
            match crossing(triangle, p, q).filter(|_| !pair.lies_in_plane_of(triangle)) {
                Some(sense) => crossings += sense,
                None => return false,
            }
        }
        crossings != 0
    }
}

impl Growing {
    fn clear(&mut self) {
        self.members.clear();
        self.pending.clear();
        self.flush.clear();
        self.step = None;
    }

    /// Takes a polygon in, if it is not there already.
    fn join(&mut self, polygon: PolygonId, turned: bool, edges: &SurfaceEdges) {
        if self.member(polygon).is_some() {
            return;
        }
        self.pending
            .extend((0..3).map(|corner| edges.edge(polygon, corner)));
        self.members.push(Member {
            polygon,
            turned,
            shared: [false; 3],
        });
    }

    fn member(&self, polygon: PolygonId) -> Option<&Member> {
        self.members.iter().find(|m| m.polygon == polygon)
    }

    fn share(&mut self, edge: PolygonEdge) {
        let mut members = self.members.iter_mut();
        if let Some(member) = members.find(|m| m.polygon == edge.polygon) {
            member.shared[edge.corner] = true;
        }
    }
}

/// 1 or -1 where the segment from `p` to `q`, whose ends are off the triangle, crosses it, by its sense, 0 where it does
/// not, `None` where it touches its border or runs along its plane: exactly.
fn crossing([u, v, w]: [DVec3; 3], p: DVec3, q: DVec3) -> Option<i32> {
    let side = |a: DVec3, b: DVec3, c: DVec3, d: DVec3| {
        let coord = |v: DVec3| Coord3D {
            x: v.x,
            y: v.y,
            z: v.z,
        };
        let determinant = orient3d(coord(a), coord(b), coord(c), coord(d));
        i32::from(determinant > 0.0) - i32::from(determinant < 0.0)
    };
    let (over_p, over_q) = (side(u, v, w, p), side(u, v, w, q));
    if over_p * over_q != -1 {
        // An end in the plane is off the triangle, and so is all of the segment that leaves it.
        return (over_p != 0 || over_q != 0).then_some(0);
    }
    let around = [side(u, v, p, q), side(v, w, p, q), side(w, u, p, q)];
    match (around.contains(&1), around.contains(&-1)) {
        (true, true) => Some(0),
        _ if around.contains(&0) => None,
        _ => Some(over_p),
    }
}
