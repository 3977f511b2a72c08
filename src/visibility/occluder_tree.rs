//! All occluders in a flat hierarchy, and the query for one that blocks a whole pair (paper,
//! sections 3.2 and 5.2).
//!
//! An occluder that blocks every segment of a pair blocks the one that joins the centres, so that
//! segment alone finds the candidates, among rectangles as among solids.

use super::bounds::ElementBounds;
use super::faults::Faults;
use super::occlusion::OccluderFaces;
use super::probe_segment::{ProbeSegment, SegmentWalk};
use super::screen::Screen;
use super::solid_tree::{SolidAnswer, SolidTree};
use super::tolerance::Tolerance;
use super::wide_tree::{WideLeaf, WideTree};
use crate::math::Aabb;
use crate::occluder::{SlabRectangle, Solid};
use glam::Vec3;
use pulp::{Arch, Simd, WithSimd};

/// The occluders of a scene, ready to be queried.
#[derive(Clone, Debug)]
pub struct OccluderTree {
    tree: WideTree,
    leaves: Vec<RectangleOctet>,
    faces: Vec<OccluderFaces>,
    /// Parallel to `faces`.
    screens: Vec<Screen>,
    solids: SolidTree,
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
    /// Index of a rectangle, or of a solid after them, that blocks the whole pair: a proof.
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
    /// The hierarchy over `occluders`, whose indices it keeps; those of `solids` come after.
    pub fn build(occluders: &[SlabRectangle], solids: &[Solid], tolerance: Tolerance) -> Self {
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
            screens: occluders
                .iter()
                .map(|o| Screen::new(o, &tolerance))
                .collect(),
            solids: SolidTree::build(solids, &tolerance),
            tolerance,
            faults: Faults::NONE,
            arch: Arch::new(),
        }
    }

    /// True where searches for the parts of a pair are to forget one: a planted fault.
    pub fn forgets_a_part(&self) -> bool {
        self.faults.forgets_a_part()
    }

    /// The same tree with faults planted.
    #[cfg(any(test, feature = "plant-faults"))]
    #[must_use]
    pub fn with_faults(mut self, faults: Faults) -> Self {
        self.faults = faults;
        self
    }

    /// Number of rectangles.
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
            + self.faces.len() * (size_of::<OccluderFaces>() + size_of::<Screen>())
            + self.solids.bytes()
    }

    /// Looks for one rectangle that blocks every segment between `a` and `b`; tries a solid only if it is `last`.
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

    /// Looks for one solid that blocks every segment between `a` and `b`: worth it where [`Self::query`] found none but
    /// `centre_blocked`, since whatever passes a covered face of a solid passes what covers it, a rectangle nearly always.
    pub fn query_solids(
        &self,
        a: &ElementBounds,
        b: &ElementBounds,
        last: &mut Option<u32>,
        scratch: &mut OcclusionScratch,
    ) -> OcclusionAnswer {
        if self.solids.is_empty() {
            return OcclusionAnswer::default();
        }
        let found = self.arch.dispatch(SolidKernel {
            tree: self,
            a,
            b,
            scratch,
        });
        let occluder = found.solid.map(|index| index + self.faces.len() as u32);
        *last = occluder.or(*last);
        OcclusionAnswer {
            occluder,
            centre_blocked: occluder.is_some(),
            nodes: found.nodes,
            tests: found.tests,
        }
    }

    /// A rectangle that the segment crosses, and its index; no promise hangs on it.
    pub(super) fn screen_across(
        &self,
        from: Vec3,
        to: Vec3,
        stack: &mut Vec<u32>,
    ) -> Option<(u32, Screen)> {
        self.arch.dispatch(AcrossKernel {
            tree: self,
            segment: ProbeSegment::new(from, to),
            stack,
        })
    }

    /// Tries one occluder only: nearly free where the caller has a likely one.
    pub fn occluded_by(&self, occluder: u32, a: &ElementBounds, b: &ElementBounds) -> bool {
        self.arch.dispatch(SingleKernel {
            tree: self,
            occluder,
            a,
            b,
        })
    }

    /// Tries one rectangle or solid; false where there is none of that index.
    #[inline(always)]
    fn is_occluded_by(&self, occluder: u32, a: &ElementBounds, b: &ElementBounds) -> bool {
        match self.faces.get(occluder as usize) {
            Some(faces) => faces.occludes_with(a, b, &self.tolerance, self.faults),
            None => self
                .solids
                .occludes(occluder as usize - self.faces.len(), a, b),
        }
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
        if let Some(id) = *last {
            answer.tests += 1;
            if self.is_occluded_by(id, a, b) {
                answer.occluder = *last;
                answer.centre_blocked = true;
                return answer;
            }
        }
        let segment = ProbeSegment::new(a.centre(), b.centre());
        let mut walk = SegmentWalk::new(&segment, &self.tree, &mut scratch.stack);
        while let Some(leaf) = walk.next_leaf() {
            answer.nodes += 1;
            let octet = &self.leaves[leaf];
            let crossed = octet.crossed_by(&segment);
            if crossed == 0 {
                continue;
            }
            answer.centre_blocked = true;
            // Two more segments that an occluder has to cross: most candidates fail one.
            let (first, second) = (a.corner_count() - 1, b.corner_count() - 1);
            let probe = ProbeSegment::new(a.corner(0), b.corner(second));
            let mut candidates = crossed & octet.crossed_by(&probe);
            if candidates == 0 {
                continue;
            }
            let probe = ProbeSegment::new(a.corner(first), b.corner(0));
            candidates &= octet.crossed_by(&probe);
            while candidates != 0 {
                let id = octet.ids[candidates.trailing_zeros() as usize];
                candidates &= candidates - 1;
                if *last == Some(id) {
                    continue;
                }
                answer.tests += 1;
                if self.faces[id as usize].occludes_with(a, b, &self.tolerance, self.faults) {
                    answer.occluder = Some(id);
                    answer.nodes += walk.nodes;
                    *last = Some(id);
                    return answer;
                }
            }
        }
        answer.nodes += walk.nodes;
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

/// [`OccluderTree::screen_across`] for one instruction set.
struct AcrossKernel<'a> {
    tree: &'a OccluderTree,
    segment: ProbeSegment,
    stack: &'a mut Vec<u32>,
}

impl WithSimd for AcrossKernel<'_> {
    type Output = Option<(u32, Screen)>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let tree = self.tree;
        let mut walk = SegmentWalk::new(&self.segment, &tree.tree, self.stack);
        while let Some(leaf) = walk.next_leaf() {
            let octet = &tree.leaves[leaf];
            let crossed = octet.crossed_by(&self.segment);
            if crossed != 0 {
                let id = octet.ids[crossed.trailing_zeros() as usize];
                return Some((id, tree.screens[id as usize]));
            }
        }
        None
    }
}

/// [`OccluderTree::query_solids`] for one instruction set.
struct SolidKernel<'a> {
    tree: &'a OccluderTree,
    a: &'a ElementBounds,
    b: &'a ElementBounds,
    scratch: &'a mut OcclusionScratch,
}

impl WithSimd for SolidKernel<'_> {
    type Output = SolidAnswer;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> SolidAnswer {
        let segment = ProbeSegment::new(self.a.centre(), self.b.centre());
        let stack = &mut self.scratch.stack;
        self.tree.solids.query(self.a, self.b, &segment, stack)
    }
}

/// [`OccluderTree::occluded_by`] for one instruction set.
struct SingleKernel<'a> {
    tree: &'a OccluderTree,
    occluder: u32,
    a: &'a ElementBounds,
    b: &'a ElementBounds,
}

impl WithSimd for SingleKernel<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        self.tree.is_occluded_by(self.occluder, self.a, self.b)
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

    /// Bit per lane: `segment` crosses the rectangle.
    #[inline(always)]
    fn crossed_by(&self, segment: &ProbeSegment) -> u32 {
        let (o, d) = (segment.origin, segment.along);
        let mut bits = [0_u32; 8];
        for l in 0..8 {
            let x = o.x - self.centre[0][l];
            let y = o.y - self.centre[1][l];
            let z = o.z - self.centre[2][l];
            let (n, us, vs) = (&self.normal, &self.u, &self.v);
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
