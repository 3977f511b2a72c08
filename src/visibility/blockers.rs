//! Sample segments against a short list of polygons, natively and eight at a time: technique
//! `blockers` (design, section 7, point 4).
//!
//! When an exchange is reached with a short list of survivors, only those polygons can block its
//! segments. They are exact triangles, never a flat stand-in. The decision is robust in the sense of
//! [`super::Tolerance`]: a surely blocked segment is blocked, a surely clear one is not, and nothing
//! is excluded by identity.

use super::scene_tree::SceneTree;
use super::stored_polygon::{PlaneKnown, StoredPolygon};
use super::survivors::SurvivorList;
use super::wide_tree::ChildRef;
use glam::{DVec3, Vec3};
use pulp::{Arch, Simd, WithSimd};

/// Eight segments, coordinate by coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct SegmentOctet {
    /// Starts: x, y and z of each lane.
    pub from: [[f32; 8]; 3],
    /// Ends.
    pub to: [[f32; 8]; 3],
}

/// A triangle as segments meet it, in f64.
#[derive(Clone, Copy, Debug)]
struct Blocker {
    normal: DVec3,
    offset: f64,
    /// Direction of each edge, counter-clockwise about the normal, and a point of it times that:
    /// the edge's line in Plücker coordinates.
    edges: [(DVec3, DVec3); 3],
}

/// The same in f32, to tell at half the price what no segment comes near.
#[derive(Clone, Copy, Debug)]
struct Outline {
    normal: [f32; 3],
    offset: f32,
    edges: [([f32; 3], [f32; 3]); 3],
}

impl Outline {
    fn new(blocker: &Blocker) -> Self {
        let single = |v: DVec3| v.as_vec3().to_array();
        Self {
            normal: single(blocker.normal),
            offset: blocker.offset as f32,
            edges: blocker.edges.map(|(e, m)| (single(e), single(m))),
        }
    }
}

/// What heights in f32 may be wrong by. Coordinates are below 1, so `n . p` has terms that sum to less than 2: a rounding
/// of the normal, of each product and of each sum, and of the offset, of 2^-24 each, make 6e-7 together.
const HEIGHT_ERROR: f32 = 2.0e-6;
/// Likewise for products of Plücker coordinates: six terms below 4, with roundings of both factors (the segment's moment
/// is wrong by three), of the products and of the sums, make 1.4e-5 together.
const SIDE_ERROR: f32 = 2.0e-5;

/// The polygons that may block the segments of one exchange. Filled and reused by a task, so that
/// nothing is allocated once it has grown.
#[derive(Clone, Debug)]
pub struct BlockerList {
    blockers: Vec<Blocker>,
    /// Parallel to `blockers`.
    outlines: Vec<Outline>,
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
        self.outlines.push(Outline::new(&blocker));
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

/// Eight segments in f32, with their Plücker coordinates.
struct NearSegments<'a> {
    segments: &'a SegmentOctet,
    along: [[f32; 8]; 3],
    moment: [[f32; 8]; 3],
}

impl<'a> NearSegments<'a> {
    #[inline(always)]
    fn new(segments: &'a SegmentOctet) -> Self {
        let (p, q) = (&segments.from, &segments.to);
        let mut along = [[0.0_f32; 8]; 3];
        let mut moment = [[0.0_f32; 8]; 3];
        for (axis, (i, j)) in [(1, 2), (2, 0), (0, 1)].into_iter().enumerate() {
            for l in 0..8 {
                along[axis][l] = q[axis][l] - p[axis][l];
                moment[axis][l] = p[i][l] * q[j][l] - p[j][l] * q[i][l];
            }
        }
        Self {
            segments,
            along,
            moment,
        }
    }

    /// False only if every segment surely misses the polygon.
    #[inline(always)]
    fn may_meet(&self, outline: &Outline) -> bool {
        let (p, q) = (&self.segments.from, &self.segments.to);
        let (n, offset) = (outline.normal, outline.offset);
        let (mut up, mut down) = ([0_u32; 8], [0_u32; 8]);
        for l in 0..8 {
            let hp = n[0] * p[0][l] + n[1] * p[1][l] + n[2] * p[2][l] - offset;
            let hq = n[0] * q[0][l] + n[1] * q[1][l] + n[2] * q[2][l] - offset;
            up[l] = u32::from((hp < HEIGHT_ERROR) & (hq > -HEIGHT_ERROR));
            down[l] = u32::from((hp > -HEIGHT_ERROR) & (hq < HEIGHT_ERROR));
        }
        let mut crossed = 0;
        for l in 0..8 {
            crossed |= up[l] | down[l];
        }
        if crossed == 0 {
            return false;
        }
        let (s, t) = (&self.along, &self.moment);
        for (e, m) in &outline.edges {
            for l in 0..8 {
                let g = e[0] * t[0][l]
                    + e[1] * t[1][l]
                    + e[2] * t[2][l]
                    + m[0] * s[0][l]
                    + m[1] * s[1][l]
                    + m[2] * s[2][l];
                up[l] &= u32::from(g > -SIDE_ERROR);
                down[l] &= u32::from(g < SIDE_ERROR);
            }
        }
        let mut met = 0;
        for l in 0..8 {
            met |= up[l] | down[l];
        }
        met != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Aabb;
    use crate::visibility::Tolerance;
    use crate::visibility::exact::{surely_blocked, surely_clear_of};
    use crate::visibility::nasty_pairs::Draw;

    fn octet(segments: &[(Vec3, Vec3); 8]) -> SegmentOctet {
        SegmentOctet {
            from: std::array::from_fn(|axis| segments.map(|s| s.0[axis])),
            to: std::array::from_fn(|axis| segments.map(|s| s.1[axis])),
        }
    }

    /// A segment through or near a border of a random triangle, its ends near the plane at times.
    fn segment(draw: &mut Draw, triangle: [Vec3; 3]) -> (Vec3, Vec3) {
        let [a, b, c] = triangle;
        let normal = (b - a).cross(c - a).normalize_or(Vec3::Z);
        let (s, t) = (draw.unit(), draw.unit());
        let inside = a + (b - a) * s + (c - a) * (t * (1.0 - s));
        let on_edge = a + (b - a) * s;
        let near = if draw.below(2) == 0 { inside } else { on_edge };
        let off = draw.point() * draw.scale(1.0e-7, 1.0e-2);
        let way = (normal * draw.scale(0.01, 1.0) + draw.point()).normalize();
        let (before, behind) = (draw.scale(3.0e-7, 0.4), draw.scale(3.0e-7, 0.4));
        (near + off - way * before, near + off + way * behind)
    }

    #[test]
    fn what_the_filter_drops_the_exact_lines_miss() {
        let (mut dropped, mut kept) = (0, 0);
        for seed in 0..20_000 {
            let mut draw = Draw::new(seed);
            let (centre, size) = (draw.point() * 0.5, draw.scale(1.0e-4, 0.5));
            let triangle = [0; 3].map(|_| centre + draw.point() * size);
            let tolerance = Tolerance::of_scene(Aabb::from_points(triangle));
            let tree = SceneTree::over_triangles(&[triangle], tolerance);
            let mut list = BlockerList::new(&tree);
            if !list.fill(&tree, &SurvivorList::whole_scene(&tree), 1) || list.is_empty() {
                continue;
            }
            // Eight times the same segment, so that it alone decides.
            let (p, q) = segment(&mut draw, triangle);
            if NearSegments::new(&octet(&[(p, q); 8])).may_meet(&list.outlines[0]) {
                kept += 1;
                continue;
            }
            dropped += 1;
            // In f64, with no margin: on one side of the plane, or outside an edge.
            let (blocker, p, q) = (&list.blockers[0], p.as_dvec3(), q.as_dvec3());
            let height = |x: DVec3| blocker.normal.dot(x) - blocker.offset;
            let (along, moment) = (q - p, p.cross(q));
            let upwards = height(q) > height(p);
            let outside = blocker.edges.iter().any(|(e, m)| {
                let g = e.dot(moment) + m.dot(along);
                if upwards { g < 0.0 } else { g > 0.0 }
            });
            assert!(
                height(p) * height(q) > 0.0 || outside,
                "seed {seed}: the filter drops a segment that crosses"
            );
        }
        assert!(
            dropped > 1_000 && kept > 1_000,
            "{dropped} dropped, {kept} kept"
        );
    }

    #[test]
    fn agrees_with_exact_arithmetic_on_every_sure_segment() {
        let tolerance = Tolerance::of_scene(Aabb {
            min: Vec3::splat(-0.5),
            max: Vec3::splat(0.5),
        });
        let (mut blocked, mut clear, mut between) = (0, 0, 0);
        for seed in 0..300 {
            let mut draw = Draw::new(seed);
            let triangles: Vec<[Vec3; 3]> = (0..12)
                .map(|_| {
                    let (centre, size) = (draw.point() * 0.5, draw.scale(1.0e-3, 0.5));
                    [0; 3].map(|_| centre + draw.point() * size)
                })
                .collect();
            let tree = SceneTree::over_triangles(&triangles, tolerance);
            let mut list = BlockerList::new(&tree);
            let whole = SurvivorList::whole_scene(&tree);
            assert!(!list.fill(&tree, &whole, 11));
            if !list.fill(&tree, &whole, 12) {
                continue;
            }
            assert_eq!(list.len(), 12);
            for _ in 0..6 {
                let segments: [(Vec3, Vec3); 8] = std::array::from_fn(|_| {
                    let target = triangles[draw.below(12) as usize];
                    segment(&mut draw, target)
                });
                let mask = list.blocked8(&octet(&segments));
                for (lane, &(p, q)) in segments.iter().enumerate() {
                    let said = mask & (1 << lane) != 0;
                    let (p, q) = (p.as_dvec3(), q.as_dvec3());
                    if triangles
                        .iter()
                        .any(|&t| surely_blocked(p, q, t, &tolerance))
                    {
                        assert!(said, "seed {seed}: a surely blocked segment passes");
                        blocked += 1;
                    } else if triangles
                        .iter()
                        .all(|&t| surely_clear_of(p, q, t, &tolerance))
                    {
                        assert!(!said, "seed {seed}: a surely clear segment is blocked");
                        clear += 1;
                    } else {
                        between += 1;
                    }
                }
            }
        }
        println!("{blocked} blocked, {clear} clear, {between} in between");
        assert!(blocked > 1_000 && clear > 1_000 && between > 100);
    }
}
