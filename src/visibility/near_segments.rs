//! Which triangles of a list no segment of eight comes near: told in f32, at half the price of the decision itself.

// Lanes of several arrays run in step: an index says so, and is what vectorises.
#![allow(clippy::needless_range_loop)]

use glam::DVec3;

/// Eight segments, coordinate by coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct SegmentOctet {
    /// Starts: x, y and z of each lane.
    pub from: [[f32; 8]; 3],
    /// Ends.
    pub to: [[f32; 8]; 3],
}

/// A triangle in f32.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    normal: [f32; 3],
    offset: f32,
    edges: [([f32; 3], [f32; 3]); 3],
}

impl Outline {
    /// Of the plane `normal . p = offset` and the edges' lines, each a direction and its moment.
    pub(super) fn new(normal: DVec3, offset: f64, edges: &[(DVec3, DVec3); 3]) -> Self {
        let single = |v: DVec3| v.as_vec3().to_array();
        Self {
            normal: single(normal),
            offset: offset as f32,
            edges: edges.map(|(e, m)| (single(e), single(m))),
        }
    }
}

/// What heights in f32 may be wrong by. Coordinates are below 1, so `n . p` has terms that sum to less than 2: a rounding
/// of the normal, of each product and of each sum, and of the offset, of 2^-24 each, make 6e-7 together.
const HEIGHT_ERROR: f32 = 2.0e-6;
/// Likewise for products of Plücker coordinates: six terms below 4, with roundings of both factors (the segment's moment
/// is wrong by three), of the products and of the sums, make 1.4e-5 together.
const SIDE_ERROR: f32 = 2.0e-5;

/// Eight segments in f32, with their Plücker coordinates.
pub(super) struct NearSegments<'a> {
    segments: &'a SegmentOctet,
    along: [[f32; 8]; 3],
    moment: [[f32; 8]; 3],
}

impl<'a> NearSegments<'a> {
    #[inline(always)]
    pub(super) fn new(segments: &'a SegmentOctet) -> Self {
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
    pub(super) fn may_meet(&self, outline: &Outline) -> bool {
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
