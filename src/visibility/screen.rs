//! One slab rectangle against the sample segments of an exchange, eight at a time.

// Lanes of several arrays run in step: an index says so, and is what vectorises.
#![allow(clippy::needless_range_loop)]

use super::sampling::SampleOctet;
use super::tolerance::Tolerance;
use crate::occluder::SlabRectangle;
use glam::{DVec3, Vec3};

/// What heights over a plane, and places in it, may be wrong by. Coordinates are below 1, so differences of them are below 2
/// with a rounding of 2^-24 of that; their products with a unit vector, rounded itself, sum to less than 4 with 6 roundings
/// of 2^-24 at most: 1.5e-6.
const ERROR: f32 = 2.0e-6;

/// A slab rectangle as segments meet it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Screen {
    centre: Vec3,
    normal: Vec3,
    /// Unit vectors in the middle plane, along the longer and the shorter sides.
    axes: [Vec3; 2],
    /// How far from the centre along each a segment may cross.
    within: [f32; 2],
    /// How far from the middle plane both ends have to be.
    depth: f32,
    /// Half the slab, and what heights may be wrong by.
    half_thickness: f32,
}

impl Screen {
    /// Prepares `slab`.
    pub(super) fn new(slab: &SlabRectangle, tolerance: &Tolerance) -> Self {
        let corners = slab.corners.map(Vec3::as_dvec3);
        let centre = slab.corners.iter().map(|c| *c * 0.25).sum::<Vec3>();
        let sides = [corners[1] - corners[0], corners[3] - corners[0]];
        let longer = usize::from(sides[1].length_squared() > sides[0].length_squared());
        // Corners are rounded: the direction of the longer side is known far better than that of a short one.
        let normal = slab.normal.as_dvec3();
        let along = sides[longer].reject_from(normal).normalize_or_zero();
        let across = normal.cross(along).normalize_or_zero();
        // All corners lie at least so far out, and so do the edges between them.
        let reach = |axis: DVec3| {
            let outward = |corner: &DVec3| (*corner - centre.as_dvec3()).dot(axis).abs();
            corners.iter().map(outward).fold(f64::INFINITY, f64::min) as f32
        };
        let inset = tolerance.weld + 2.0 * tolerance.nesting + 4.0 * ERROR;
        Self {
            centre,
            normal: slab.normal,
            axes: [along.as_vec3(), across.as_vec3()],
            within: [reach(along) - inset, reach(across) - inset],
            depth: slab.half_thickness + tolerance.tau + 2.0 * tolerance.nesting + 2.0 * ERROR,
            half_thickness: slab.half_thickness + 2.0 * ERROR,
        }
    }

    /// Bit per lane: the segment, cut back as it is, passes through both faces of the slab well inside its border, with both
    /// ends more than tau beyond them. So the rectangle's surface surely blocks it.
    ///
    /// Error: the segment crosses the middle plane at t = -h / dh, where `h` and `dh` are within [`ERROR`] of what they
    /// should be and `t` lies in [0, 1]; so `t`, and the place of either face, is within `spread` = (half the slab + 2
    /// errors) / |dh|, whose own rounding the second error covers. Places in the plane err by [`ERROR`] three times, and by
    /// what they change over the spread.
    #[inline(always)]
    pub(super) fn blocks(&self, octet: &SampleOctet) -> u8 {
        let (p, q) = (&octet.segments.from, &octet.segments.to);
        let (c, n, [u, v]) = (self.centre, self.normal, self.axes);
        let mut bits = [0_u32; 8];
        for l in 0..8 {
            let (x, y, z) = (p[0][l] - c.x, p[1][l] - c.y, p[2][l] - c.z);
            let (dx, dy, dz) = (q[0][l] - p[0][l], q[1][l] - p[1][l], q[2][l] - p[2][l]);
            let height = n.x * x + n.y * y + n.z * z;
            let rise = n.x * dx + n.y * dy + n.z * dz;
            let end = height + rise;
            let inverse = 1.0 / rise;
            let t = -height * inverse;
            let spread = self.half_thickness * inverse.abs();
            let du = u.x * dx + u.y * dy + u.z * dz;
            let dv = v.x * dx + v.y * dy + v.z * dz;
            let along = (u.x * x + u.y * y + u.z * z + t * du).abs() + spread * du.abs();
            let across = (v.x * x + v.y * y + v.z * z + t * dv).abs() + spread * dv.abs();
            // A rise of nothing leaves both ends on one side.
            let inside = (height.abs() > self.depth)
                & (end.abs() > self.depth)
                & (height * end < 0.0)
                & (t - spread > octet.near[l])
                & (t + spread < octet.far[l])
                & (along < self.within[0])
                & (across < self.within[1]);
            bits[l] = if inside { 1 << l } else { 0 };
        }
        bits.iter().fold(0, |mask, bit| mask | bit) as u8
    }
}
