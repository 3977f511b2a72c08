//! All occluders in a flat hierarchy, and the query for one that blocks a whole pair (paper,
//! sections 3.2 and 5.2).
//!
//! An occluder that blocks every segment of a pair blocks the one that joins the centres, so that
//! segment alone finds the candidates.

use super::bounds::ElementBounds;
use super::faults::Faults;
use super::occlusion::OccluderFaces;
use super::tolerance::Tolerance;
use super::wide_tree::{ChildRef, WideLeaf, WideNode, WideTree};
use crate::math::Aabb;
use crate::occluder::SlabRectangle;
use glam::Vec3;
use pulp::{Arch, Simd, WithSimd};

/// The occluders of a scene, ready to be queried.
#[derive(Clone, Debug)]
pub struct OccluderTree {
    tree: WideTree,
    leaves: Vec<RectangleOctet>,
    faces: Vec<OccluderFaces>,
    tolerance: Tolerance,
    faults: Faults,
    arch: Arch,
}

/// Eight rectangles for the centre segment; no promise hangs on their rounding.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct RectangleOctet {
    centre: [[f32; 8]; 3],
    normal: [[f32; 8]; 3],
    /// Half-axes over their squared lengths: the rectangle is where both products are within 1.
    u: [[f32; 8]; 3],
    v: [[f32; 8]; 3],
    ids: [u32; 8],
}

/// What a caller lends to queries, so that none allocates. One a task.
#[derive(Clone, Debug, Default)]
pub struct OcclusionScratch {
    stack: Vec<u32>,
}

/// The outcome of [`OccluderTree::query`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OcclusionAnswer {
    /// Index of an occluder that blocks the whole pair: a proof.
    pub occluder: Option<u32>,
    /// True if some occluder crosses the segment between the centres. False means that no occluder
    /// can block the pair: evidence, not proof.
    pub centre_blocked: bool,
    /// Nodes and leaves of the hierarchy that were tested.
    pub nodes: u32,
    /// Full tests of an occluder against the pair.
    pub tests: u32,
}

impl OccluderTree {
    /// The hierarchy over `occluders`, whose indices it keeps.
    pub fn build(occluders: &[SlabRectangle], tolerance: Tolerance) -> Self {
        let boxes: Vec<Aabb> = occluders.iter().map(box_of).collect();
        let tree = WideTree::build(&boxes);
        let leaves = tree
            .leaves
            .iter()
            .map(|leaf| RectangleOctet::new(leaf, occluders))
            .collect();
        Self {
            tree,
            leaves,
            faces: occluders.iter().map(OccluderFaces::new).collect(),
            tolerance,
            faults: Faults::NONE,
            arch: Arch::new(),
        }
    }

    /// The same tree with faults planted.
    #[cfg(any(test, feature = "plant-faults"))]
    #[must_use]
    pub fn with_faults(mut self, faults: Faults) -> Self {
        self.faults = faults;
        self
    }

    /// Number of occluders.
    pub fn len(&self) -> usize {
        self.faces.len()
    }

    /// True when there is no occluder, and a query cannot succeed.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.tree.bytes()
            + self.leaves.len() * size_of::<RectangleOctet>()
            + self.faces.len() * size_of::<OccluderFaces>()
    }

    /// Looks for one occluder that blocks every segment between `a` and `b`.
    ///
    /// `last` is the caller's cache: the last occluder that succeeded, tried first and replaced on
    /// success. An index out of range is ignored.
    pub fn query(
        &self,
        a: &ElementBounds,
        b: &ElementBounds,
        last: &mut Option<u32>,
        scratch: &mut OcclusionScratch,
    ) -> OcclusionAnswer {
        if self.faces.is_empty() {
            return OcclusionAnswer::default();
        }
        self.arch.dispatch(QueryKernel {
            tree: self,
            a,
            b,
            last,
            scratch,
        })
    }

    /// Tries one occluder only: nearly free where the caller has a likely one.
    pub fn occluded_by(&self, occluder: u32, a: &ElementBounds, b: &ElementBounds) -> bool {
        self.faces.get(occluder as usize).is_some_and(|faces| {
            self.arch.dispatch(SingleKernel {
                tree: self,
                faces,
                a,
                b,
            })
        })
    }

    #[inline(always)]
    fn query_kernel(
        &self,
        a: &ElementBounds,
        b: &ElementBounds,
        last: &mut Option<u32>,
        scratch: &mut OcclusionScratch,
    ) -> OcclusionAnswer {
        let mut answer = OcclusionAnswer::default();
        if let Some(faces) = last.and_then(|id| self.faces.get(id as usize)) {
            answer.tests += 1;
            if faces.occludes_with(a, b, &self.tolerance, self.faults) {
                answer.occluder = *last;
                answer.centre_blocked = true;
                return answer;
            }
        }
        let segment = ProbeSegment::new(a.centre(), b.centre());
        let inverse = segment.inverse();
        scratch.stack.clear();
        scratch.stack.push(0);
        while let Some(index) = scratch.stack.pop() {
            let node = &self.tree.nodes[index as usize];
            answer.nodes += 1;
            let mut hits = segment.meets_boxes(inverse, node);
            while hits != 0 {
                let lane = hits.trailing_zeros() as usize;
                hits &= hits - 1;
                let child = node.children[lane];
                if child == ChildRef::NONE {
                    continue;
                }
                if !child.is_leaf() {
                    scratch.stack.push(child.index() as u32);
                    continue;
                }
                answer.nodes += 1;
                let octet = &self.leaves[child.index()];
                let crossed = segment.crosses_rectangles(octet);
                if crossed == 0 {
                    continue;
                }
                answer.centre_blocked = true;
                // Two more segments that an occluder has to cross: most candidates fail one.
                let (first, second) = (a.corner_count() - 1, b.corner_count() - 1);
                let probe = ProbeSegment::new(a.corner(0), b.corner(second));
                let mut candidates = crossed & probe.crosses_rectangles(octet);
                if candidates == 0 {
                    continue;
                }
                let probe = ProbeSegment::new(a.corner(first), b.corner(0));
                candidates &= probe.crosses_rectangles(octet);
                while candidates != 0 {
                    let id = octet.ids[candidates.trailing_zeros() as usize];
                    candidates &= candidates - 1;
                    if *last == Some(id) {
                        continue;
                    }
                    answer.tests += 1;
                    if self.faces[id as usize].occludes_with(a, b, &self.tolerance, self.faults) {
                        answer.occluder = Some(id);
                        *last = Some(id);
                        return answer;
                    }
                }
            }
        }
        answer
    }
}

/// [`OccluderTree::query`] for one instruction set. A type, not a closure: the call of a closure is
/// not inlined into the function that has the instruction set, and would stay without it.
struct QueryKernel<'a> {
    tree: &'a OccluderTree,
    a: &'a ElementBounds,
    b: &'a ElementBounds,
    last: &'a mut Option<u32>,
    scratch: &'a mut OcclusionScratch,
}

impl WithSimd for QueryKernel<'_> {
    type Output = OcclusionAnswer;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> OcclusionAnswer {
        self.tree
            .query_kernel(self.a, self.b, self.last, self.scratch)
    }
}

/// [`OccluderTree::occluded_by`] for one instruction set.
struct SingleKernel<'a> {
    tree: &'a OccluderTree,
    faces: &'a OccluderFaces,
    a: &'a ElementBounds,
    b: &'a ElementBounds,
}

impl WithSimd for SingleKernel<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        self.faces
            .occludes_with(self.a, self.b, &self.tree.tolerance, self.tree.faults)
    }
}

/// The box of a slab, grown so that the centre segment's own rounding cannot miss it.
fn box_of(slab: &SlabRectangle) -> Aabb {
    let tight = Aabb::from_points(slab.corners);
    let margin = Vec3::splat(slab.half_thickness + 1.0e-6 * (1.0 + tight.diagonal()));
    Aabb {
        min: tight.min - margin,
        max: tight.max + margin,
    }
}

impl RectangleOctet {
    fn new(leaf: &WideLeaf, occluders: &[SlabRectangle]) -> Self {
        // A zero normal makes the crossing parameter NaN or infinite, which no segment reaches.
        let mut octet = Self {
            centre: [[0.0; 8]; 3],
            normal: [[0.0; 8]; 3],
            u: [[0.0; 8]; 3],
            v: [[0.0; 8]; 3],
            ids: leaf.primitives,
        };
        for (lane, &id) in leaf.primitives[..leaf.len()].iter().enumerate() {
            let slab = &occluders[id as usize];
            let [a, b, c, d] = slab.corners;
            let (u, v) = ((b - a) * 0.5, (d - a) * 0.5);
            let fields = [
                (&mut octet.centre, (a + c) * 0.5),
                (&mut octet.normal, slab.normal),
                (&mut octet.u, u / u.length_squared().max(f32::MIN_POSITIVE)),
                (&mut octet.v, v / v.length_squared().max(f32::MIN_POSITIVE)),
            ];
            for (field, value) in fields {
                for axis in 0..3 {
                    field[axis][lane] = value[axis];
                }
            }
        }
        octet
    }
}

/// A segment between two points of a pair.
struct ProbeSegment {
    origin: Vec3,
    along: Vec3,
}

impl ProbeSegment {
    #[inline(always)]
    fn new(from: Vec3, to: Vec3) -> Self {
        Self {
            origin: from,
            along: to - from,
        }
    }

    /// One over the components of its direction; large but finite where one vanishes, so that no
    /// product is NaN.
    #[inline(always)]
    fn inverse(&self) -> Vec3 {
        let inverse = |d: f32| {
            if d.abs() > 1.0e-12 {
                1.0 / d
            } else {
                1.0e12_f32.copysign(d)
            }
        };
        Vec3::new(
            inverse(self.along.x),
            inverse(self.along.y),
            inverse(self.along.z),
        )
    }

    /// Bit per lane: the segment meets the box.
    #[inline(always)]
    fn meets_boxes(&self, inverse: Vec3, node: &WideNode) -> u32 {
        let mut enter = [0.0_f32; 8];
        let mut leave = [1.0_f32; 8];
        for axis in 0..3 {
            let (o, inverse) = (self.origin[axis], inverse[axis]);
            let (near, far) = if inverse >= 0.0 {
                (&node.boxes.min[axis], &node.boxes.max[axis])
            } else {
                (&node.boxes.max[axis], &node.boxes.min[axis])
            };
            for l in 0..8 {
                let (t0, t1) = ((near[l] - o) * inverse, (far[l] - o) * inverse);
                enter[l] = if t0 > enter[l] { t0 } else { enter[l] };
                leave[l] = if t1 < leave[l] { t1 } else { leave[l] };
            }
        }
        let mut bits = [0_u32; 8];
        for l in 0..8 {
            bits[l] = if enter[l] <= leave[l] { 1 << l } else { 0 };
        }
        bits.iter().fold(0, |mask, bit| mask | bit)
    }

    /// Bit per lane: the segment crosses the rectangle.
    #[inline(always)]
    fn crosses_rectangles(&self, octet: &RectangleOctet) -> u32 {
        let (o, d) = (self.origin, self.along);
        let mut bits = [0_u32; 8];
        for l in 0..8 {
            let x = o.x - octet.centre[0][l];
            let y = o.y - octet.centre[1][l];
            let z = o.z - octet.centre[2][l];
            let (n, us, vs) = (&octet.normal, &octet.u, &octet.v);
            let height = n[0][l] * x + n[1][l] * y + n[2][l] * z;
            let t = -height / (n[0][l] * d.x + n[1][l] * d.y + n[2][l] * d.z);
            let (x, y, z) = (x + t * d.x, y + t * d.y, z + t * d.z);
            let u = us[0][l] * x + us[1][l] * y + us[2][l] * z;
            let v = vs[0][l] * x + vs[1][l] * y + vs[2][l] * z;
            let inside = (t > 0.0) & (t < 1.0) & (u.abs() <= 1.0) & (v.abs() <= 1.0);
            bits[l] = if inside { 1 << l } else { 0 };
        }
        bits.iter().fold(0, |mask, bit| mask | bit)
    }
}
