//! What a solve leaves behind: the leaf patches with their radiosity and irradiance.

use crate::math::FacetId;
use crate::scene::Facet;

/// Where a patch lies in its facet: the facet's triangle is split 1 to 4 at its edge midpoints, and
/// two bits a level choose the child. Child 0, 1, 2 holds corner 0, 1, 2 of its parent and keeps its
/// position in the corner order; child 3 is the middle one, with corners opposite those of its parent:
/// corner i of child 3 is the midpoint of the parent's edge opposite to corner i.
///
/// A leading 1 bit marks the length, so the root is 1 and at most 31 levels fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PatchPath(pub u64);

impl PatchPath {
    /// The whole facet.
    pub const ROOT: Self = Self(1);
    /// The deepest level that fits.
    pub const MAX_LEVEL: u32 = 31;

    /// The child `which` in 0..4.
    pub fn child(self, which: u32) -> Self {
        debug_assert!(which < 4 && self.level() < Self::MAX_LEVEL);
        Self((self.0 << 2) | u64::from(which))
    }

    /// Number of splits above this patch.
    pub fn level(self) -> u32 {
        (63 - self.0.leading_zeros()) / 2
    }

    /// The choices from the facet down to this patch.
    pub fn steps(self) -> impl Iterator<Item = u32> {
        (0..self.level())
            .rev()
            .map(move |level| (self.0 >> (2 * level)) as u32 & 3)
    }

    /// The corners of the patch, given those of its facet, by exact halving: generic over f32 and
    /// f64 vectors.
    pub fn corners<V>(self, corners: [V; 3]) -> [V; 3]
    where
        V: Copy + std::ops::Add<Output = V> + Halve,
    {
        self.steps().fold(corners, split_triangle)
    }
}

/// Division by two, for the midpoint of two points.
pub trait Halve {
    /// Half of `self`.
    fn halve(self) -> Self;
}

impl Halve for glam::Vec3 {
    fn halve(self) -> Self {
        self * 0.5
    }
}

impl Halve for glam::DVec3 {
    fn halve(self) -> Self {
        self * 0.5
    }
}

/// Child `which` of a triangle split at its edge midpoints, numbered as [`PatchPath`] says.
pub fn split_triangle<V>(corners: [V; 3], which: u32) -> [V; 3]
where
    V: Copy + std::ops::Add<Output = V> + Halve,
{
    let [a, b, c] = corners;
    let (ab, bc, ca) = ((a + b).halve(), (b + c).halve(), (c + a).halve());
    match which {
        0 => [a, ab, ca],
        1 => [ab, b, bc],
        2 => [ca, bc, c],
        _ => [bc, ca, ab],
    }
}

/// A leaf patch and its light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolvedPatch {
    /// Where it lies in its facet.
    pub path: PatchPath,
    /// Radiosity of red, green and blue in W/m2, emission included.
    pub radiosity: [f32; 3],
    /// Irradiance in W/m2.
    pub irradiance: [f32; 3],
}

/// The leaf patches of every facet.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// The facets, in the hierarchy's order.
    pub facets: Vec<Facet>,
    /// Leaf patches grouped by facet, each facet's in depth-first order of the split (ascending
    /// along the walk 0, 1, 2, 3).
    pub patches: Vec<SolvedPatch>,
    /// `patches[first_patch[f] .. first_patch[f + 1]]` are those of facet `f`; one longer than `facets`.
    pub first_patch: Vec<u32>,
}

impl Solution {
    /// The leaf patches of a facet, in depth-first order.
    pub fn facet_patches(&self, facet: FacetId) -> &[SolvedPatch] {
        let i = facet.index();
        &self.patches[self.first_patch[i] as usize..self.first_patch[i + 1] as usize]
    }
}
