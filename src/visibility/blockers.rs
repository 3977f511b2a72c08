//! Sample segments against a short list of polygons, natively and eight at a time: technique
//! `blockers` (design, section 7, point 4).
//!
//! When an exchange is reached with a short list of survivors, only those polygons can block its
//! segments. They are exact triangles, never a flat stand-in. The decision is robust in the sense of
//! [`super::Tolerance`]: a surely blocked segment is blocked, a surely clear one is not, and nothing
//! is excluded by identity.

use super::near_segments::{NearSegments, Outline, SegmentOctet};
use super::scene_tree::SceneTree;
use super::stored_polygon::{PlaneKnown, StoredPolygon};
use super::survivors::SurvivorList;
use super::wide_tree::ChildRef;
use glam::{DVec3, Vec3};
use pulp::{Arch, Simd, WithSimd};

/// A triangle as segments meet it, in f64.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blocker {
    pub(super) normal: DVec3,
    pub(super) offset: f64,
    /// Direction of each edge, counter-clockwise about the normal, and a point of it times that:
    /// the edge's line in Plücker coordinates.
    pub(super) edges: [(DVec3, DVec3); 3],
}

/// The polygons that may block the segments of one exchange. Filled and reused by a task, so that
/// nothing is allocated once it has grown.
#[derive(Clone, Debug)]
pub struct BlockerList {
    pub(super) blockers: Vec<Blocker>,
    /// Parallel to `blockers`.
    pub(super) outlines: Vec<Outline>,
    /// Just below `tau`: a surely blocked segment has deeper ends, and one that crosses deeper than this comes within a
    /// hundred-millionth of the weld distance of the polygon even when cut back. Embree's rays are cut back by as much.
    depth: f64,
    pending: Vec<(ChildRef, u32)>,
    arch: Arch,
}

impl BlockerList {
    /// An empty list for this scene.
    pub fn new(scene: &SceneTree) -> Self {
        Self {
            blockers: Vec::new(),
            outlines: Vec::new(),
            depth: 0.999_999_99 * f64::from(scene.tolerance.tau),
            pending: Vec::new(),
            arch: Arch::new(),
        }
    }

    /// Replaces the content by the polygons of `survivors`, nodes opened. False if there are more
    /// than `most`, or one so thin that its plane is noise: then ask Embree. Hairlines are left out:
    /// they surely block nothing.
    pub fn fill(&mut self, scene: &SceneTree, survivors: &SurvivorList, most: usize) -> bool {
        self.blockers.clear();
        self.outlines.clear();
        self.pending.clear();
        for entry in survivors.entries() {
            self.pending.push((entry.reference(), entry.lanes));
        }
        while let Some((reference, lanes)) = self.pending.pop() {
            if !reference.is_leaf() {
                let node = &scene.tree.nodes[reference.index()];
                for &child in node.children.iter().filter(|&&c| c != ChildRef::NONE) {
                    let lanes = if child.is_leaf() {
                        scene.used_lanes(child.index())
                    } else {
                        0
                    };
                    self.pending.push((child, lanes));
                }
                // Every node holds a polygon at least.
                if self.pending.len() + self.blockers.len() > most {
                    return false;
                }
                continue;
            }
            for lane in (0..8).filter(|lane| lanes & (1 << lane) != 0) {
                let polygon = &scene.polygons[8 * reference.index() + lane];
                if self.blockers.len() == most || !self.push(polygon) {
                    return false;
                }
            }
        }
        true
    }

    fn push(&mut self, polygon: &StoredPolygon) -> bool {
        match polygon.known {
            PlaneKnown::Broad | PlaneKnown::Narrow => {}
            PlaneKnown::Noise => return false,
            PlaneKnown::Hairline => return true,
        }
        let (v, normal) = (polygon.corners.map(Vec3::as_dvec3), polygon.normal);
        let blocker = Blocker {
            normal,
            offset: normal.dot(v[0]),
            edges: std::array::from_fn(|i| {
                let edge = v[(i + 1) % 3] - v[i];
                (edge, v[i].cross(edge))
            }),
        };
        self.outlines
            .push(Outline::new(normal, blocker.offset, &blocker.edges));
        self.blockers.push(blocker);
        true
    }

    /// Number of polygons.
    pub fn len(&self) -> usize {
        self.blockers.len()
    }

    /// True when nothing can block.
    pub fn is_empty(&self) -> bool {
        self.blockers.is_empty()
    }

    /// Bit per lane: some polygon of the list blocks the segment.
    ///
    /// Error: in f64, coordinates below 1, heights are right to 1e-15, less than a hundred-millionth of the depth, which is
    /// what the depth falls short of `tau`; the crossing point to 1e-15 / depth, far less than the weld distance.
    pub fn blocked8(&self, segments: &SegmentOctet) -> u8 {
        self.arch.dispatch(BlockedKernel {
            list: self,
            segments,
        })
    }
}

struct BlockedKernel<'a> {
    list: &'a BlockerList,
    segments: &'a SegmentOctet,
}

impl WithSimd for BlockedKernel<'_> {
    type Output = u8;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> u8 {
        let near = NearSegments::new(self.segments);
        let mut first = 0;
        while first < self.list.outlines.len() && !near.may_meet(&self.list.outlines[first]) {
            first += 1;
        }
        if first == self.list.outlines.len() {
            return 0;
        }
        let mut p = [[0.0_f64; 8]; 3];
        let mut q = [[0.0_f64; 8]; 3];
        for axis in 0..3 {
            for l in 0..8 {
                p[axis][l] = f64::from(self.segments.from[axis][l]);
                q[axis][l] = f64::from(self.segments.to[axis][l]);
            }
        }
        // The segments' lines in Plücker coordinates.
        let mut along = [[0.0_f64; 8]; 3];
        let mut moment = [[0.0_f64; 8]; 3];
        for (axis, (i, j)) in [(1, 2), (2, 0), (0, 1)].into_iter().enumerate() {
            for l in 0..8 {
                along[axis][l] = q[axis][l] - p[axis][l];
                moment[axis][l] = p[i][l] * q[j][l] - p[j][l] * q[i][l];
            }
        }
        let depth = self.list.depth;
        let mut blocked = [0_u64; 8];
        for (index, blocker) in self.list.blockers.iter().enumerate().skip(first) {
            if index > first && !near.may_meet(&self.list.outlines[index]) {
                continue;
            }
            let n = blocker.normal;
            let mut hp = [0.0_f64; 8];
            let mut hq = [0.0_f64; 8];
            for l in 0..8 {
                hp[l] = n.x * p[0][l] + n.y * p[1][l] + n.z * p[2][l] - blocker.offset;
                hq[l] = n.x * q[0][l] + n.y * q[1][l] + n.z * q[2][l] - blocker.offset;
            }
            // Most polygons of a list have all segments on one side, or are crossed one way only.
            let (mut up, mut down) = ([0_u64; 8], [0_u64; 8]);
            let mut crossed = 0;
            for l in 0..8 {
                up[l] = u64::from((hp[l] < -depth) & (hq[l] > depth));
                down[l] = u64::from((hp[l] > depth) & (hq[l] < -depth));
            }
            for l in 0..8 {
                crossed |= up[l] | down[l];
            }
            if crossed == 0 {
                continue;
            }
            for (e, m) in &blocker.edges {
                for l in 0..8 {
                    let g = e.x * moment[0][l]
                        + e.y * moment[1][l]
                        + e.z * moment[2][l]
                        + m.x * along[0][l]
                        + m.y * along[1][l]
                        + m.z * along[2][l];
                    up[l] &= u64::from(g >= 0.0);
                    down[l] &= u64::from(g <= 0.0);
                }
            }
            let mut open = 0;
            for l in 0..8 {
                blocked[l] |= up[l] | down[l];
                open |= blocked[l] ^ 1;
            }
            if open == 0 {
                break;
            }
        }
        let mut mask = 0;
        for (l, &lane) in blocked.iter().enumerate() {
            mask |= (lane as u8) << l;
        }
        mask
    }
}
