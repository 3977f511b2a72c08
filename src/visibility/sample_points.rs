//! Eight points of an element: where sample segments begin and end.

// Lanes of several arrays run in step: an index says so, and is what vectorises.
#![allow(clippy::needless_range_loop)]

use glam::Vec3;

/// Eight points of an element, coordinate by coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointOctet {
    /// Normalised positions.
    pub position: [[f32; 8]; 3],
    /// Unit normals of their facets, on the facets' sides.
    pub normal: [[f32; 8]; 3],
    /// Bit per point where something touches the surface and swallows light that the element's mean counts on.
    pub swallowed: u8,
    /// Bit per point where something touches the surface and the element's mean light comes from elsewhere on it.
    pub absent: u8,
}

impl PointOctet {
    /// Eight points of one triangle with the given unit normal, uniform where `(u, v)` is uniform in the unit
    /// square, which is folded along its diagonal.
    #[inline(always)]
    pub fn of_triangle(corners: [Vec3; 3], normal: Vec3, u: &[f32; 8], v: &[f32; 8]) -> Self {
        let [along, across] = folded(u, v);
        Self::at(corners, normal, &along, &across)
    }

    /// Eight points `a + (b - a) along + (c - a) across` of a plane with the given unit normal.
    #[inline(always)]
    pub fn at([a, b, c]: [Vec3; 3], normal: Vec3, along: &[f32; 8], across: &[f32; 8]) -> Self {
        let mut position = [[0.0; 8]; 3];
        for axis in 0..3 {
            let (e, f) = (b[axis] - a[axis], c[axis] - a[axis]);
            for l in 0..8 {
                position[axis][l] = a[axis] + e * along[l] + f * across[l];
            }
        }
        Self {
            position,
            normal: normal.to_array().map(|n| [n; 8]),
            swallowed: 0,
            absent: 0,
        }
    }

    /// The position of point `l`.
    pub fn position(&self, l: usize) -> Vec3 {
        Vec3::from_array(self.position.map(|axis| axis[l]))
    }

    /// Replaces lane `l` by another point, of a plane with the given unit normal.
    #[inline(always)]
    pub fn set(&mut self, l: usize, position: Vec3, normal: Vec3) {
        for axis in 0..3 {
            self.position[axis][l] = position[axis];
            self.normal[axis][l] = normal[axis];
        }
    }
}

/// Points of the unit square, folded along its diagonal.
#[inline(always)]
fn folded(u: &[f32; 8], v: &[f32; 8]) -> [[f32; 8]; 2] {
    let (mut along, mut across) = (*u, *v);
    for l in 0..8 {
        let fold = u[l] + v[l] > 1.0;
        along[l] = if fold { 1.0 - u[l] } else { u[l] };
        across[l] = if fold { 1.0 - v[l] } else { v[l] };
    }
    [along, across]
}

/// Which of a triangle's four children hold eight uniform points of it, numbered as patches are: those at the corners
/// first, then the middle one.
pub fn children_of_triangle(u: &[f32; 8], v: &[f32; 8]) -> [u8; 8] {
    let [along, across] = folded(u, v);
    // Without branches, which no processor could foresee.
    std::array::from_fn(|l| {
        let (second, third) = (u8::from(along[l] > 0.5), u8::from(across[l] > 0.5));
        let beyond_first = u8::from(along[l] + across[l] >= 0.5);
        second + 2 * third + 3 * (beyond_first - second - third)
    })
}

/// An element that can be sampled: a receiver uniformly by area, a source by its light.
pub trait Surface {
    /// The points at the first `lanes` of eight `(u, v)` in [0,1)^2; uniform in gives that out. What the other
    /// lanes hold is finite and means nothing.
    fn points(&self, u: &[f32; 8], v: &[f32; 8], lanes: u32) -> PointOctet;

    /// The part of the element that holds each of these points, below [`super::PARTS`]: all in one where parts do not
    /// matter.
    fn parts(&self, _u: &[f32; 8], _v: &[f32; 8]) -> [u8; 8] {
        [0; 8]
    }
}
