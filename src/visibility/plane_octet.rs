//! The planes of eight polygons in f32: which of them have both elements of a pair on one side, and so block nothing.
//!
//! The walls of a room all do, and so does whatever lies in the plane of an element: this drops most of the polygons
//! that a shaft meets before the slow test ([`super::crossing`]) has to.

// Lanes of several arrays run in step: an index says so, and is what vectorises.
#![allow(clippy::needless_range_loop)]

use super::bounds::ElementBounds;
use super::crossing::harmless_depth;
use super::stored_polygon::{PlaneKnown, StoredPolygon};
use super::tolerance::Tolerance;

/// Eight planes in structure-of-arrays form.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct PlaneOctet {
    /// Unit normals; zero where nothing can be blocked.
    normal: [[f32; 8]; 3],
    /// A corner of each polygon.
    origin: [[f32; 8]; 3],
    /// Lanes whose plane is noise: those may block whatever the sides.
    unknown: u32,
}

impl PlaneOctet {
    /// The planes of up to eight polygons.
    pub(super) fn new(polygons: &[StoredPolygon]) -> Self {
        let mut octet = Self {
            normal: [[0.0; 8]; 3],
            origin: [[0.0; 8]; 3],
            unknown: 0,
        };
        for (lane, polygon) in polygons.iter().take(8).enumerate() {
            match polygon.known {
                PlaneKnown::Broad | PlaneKnown::Narrow => {}
                PlaneKnown::Noise => {
                    octet.unknown |= 1 << lane;
                    continue;
                }
                PlaneKnown::Hairline => continue,
            }
            let normal = polygon.normal.as_vec3();
            for axis in 0..3 {
                octet.normal[axis][lane] = normal[axis];
                octet.origin[axis][lane] = polygon.corners[0][axis];
            }
        }
        octet
    }

    /// How deep beside a plane a corner may be found here and is surely within the depth that
    /// [`super::crossing::may_block`] calls harmless.
    ///
    /// Error of a height: the normal, the differences and the products are rounded once each and the sums twice, relative
    /// to `sum |n_i d_i| <= |d|`, which is below `2 sqrt(3) reach`; `5.2 u` of that with the higher orders.
    pub(super) fn depth(tolerance: &Tolerance) -> f32 {
        let error = 5.2 * 3.4642 * tolerance.reach / 16_777_216.0;
        (harmless_depth(tolerance) as f32 - error) * 0.9999
    }

    /// Bit per lane: the plane may part the elements, with parts of them deeper than `depth` on opposite sides. Where it
    /// does not, the polygon blocks nothing.
    #[inline(always)]
    pub(super) fn part(&self, a: &ElementBounds, b: &ElementBounds, depth: f32) -> u32 {
        let (least_a, greatest_a) = self.range(a);
        let (least_b, greatest_b) = self.range(b);
        let mut bits = [0_u32; 8];
        for l in 0..8 {
            let parts = (least_a[l] < -depth) & (greatest_b[l] > depth)
                | (greatest_a[l] > depth) & (least_b[l] < -depth);
            bits[l] = if parts { 1 << l } else { 0 };
        }
        bits.iter().fold(self.unknown, |mask, bit| mask | bit)
    }

    /// Least and greatest height of an element over each plane.
    #[inline(always)]
    fn range(&self, element: &ElementBounds) -> ([f32; 8], [f32; 8]) {
        let (mut least, mut greatest) = ([f32::MAX; 8], [-f32::MAX; 8]);
        let (n, o) = (&self.normal, &self.origin);
        for i in 0..element.corner_count() {
            let (x, y, z) = (element.x[i], element.y[i], element.z[i]);
            for l in 0..8 {
                let height =
                    n[0][l] * (x - o[0][l]) + n[1][l] * (y - o[1][l]) + n[2][l] * (z - o[2][l]);
                least[l] = if height < least[l] { height } else { least[l] };
                greatest[l] = if height > greatest[l] {
                    height
                } else {
                    greatest[l]
                };
            }
        }
        (least, greatest)
    }
}

#[cfg(test)]
mod tests {
    use super::super::crossing::may_block;
    use super::super::nasty_pairs::Draw;
    use super::super::wide_corners::WideCorners;
    use super::*;
    use crate::math::{Aabb, PolygonId};
    use glam::Vec3;

    /// Elements that touch, cross or nearly touch the planes of eight triangles: what the planes drop, the slow test in f64
    /// would have dropped, and they drop most of it.
    #[test]
    fn what_the_planes_drop_blocks_nothing() {
        let tolerance = Tolerance::of_scene(Aabb {
            min: Vec3::splat(-0.5),
            max: Vec3::splat(0.5),
        });
        let depth = PlaneOctet::depth(&tolerance);
        assert!(depth > 0.0);
        let (mut dropped, mut harmless) = (0, 0);
        for seed in 0..4_000 {
            let mut draw = Draw::new(seed);
            let polygons: Vec<StoredPolygon> = (0..8)
                .map(|id| {
                    let (centre, size) = (draw.point() * 0.4, draw.scale(1.0e-3, 0.3));
                    let corners = [0; 3].map(|_| {
                        (centre + draw.point() * size).clamp(Vec3::splat(-0.5), Vec3::splat(0.5))
                    });
                    StoredPolygon::new(corners, PolygonId(id), &tolerance)
                })
                .collect();
            // Corners on, or off by around tau, one of the planes.
            let target = polygons[draw.below(8) as usize];
            let [p, q, r] = target.corners;
            let element = |draw: &mut Draw| {
                let side = if draw.below(2) == 0 { 1.0 } else { -1.0 };
                let corners = [0; 3].map(|_| {
                    let (s, t) = (draw.unit(), draw.unit());
                    let off = target.normal.as_vec3() * (side * draw.scale(1.0e-8, 0.3));
                    (p + (q - p) * s + (r - p) * t + off).clamp(Vec3::splat(-0.5), Vec3::splat(0.5))
                });
                ElementBounds::from_polygon(&corners)
            };
            let (a, b) = (element(&mut draw), element(&mut draw));
            let parted = PlaneOctet::new(&polygons).part(&a, &b, depth);
            for (lane, polygon) in polygons.iter().enumerate() {
                let (wide_a, wide_b) = (WideCorners::new(&a), WideCorners::new(&b));
                let blocks = may_block(polygon, &wide_a, &wide_b, &tolerance);
                let drops = parted & (1 << lane) == 0;
                assert!(!(drops && blocks), "seed {seed}, lane {lane}");
                dropped += u32::from(drops);
                harmless += u32::from(!blocks);
            }
        }
        println!("{dropped} dropped of {harmless}");
        assert!(2 * dropped > harmless && dropped < 4_000 * 8);
    }

    #[test]
    fn noise_is_never_dropped_and_hairlines_always_are() {
        let tolerance = Tolerance::of_scene(Aabb {
            min: Vec3::splat(-0.5),
            max: Vec3::splat(0.5),
        });
        let sliver = |width: f32| {
            let corners = [Vec3::ZERO, Vec3::X * 0.1, Vec3::new(0.05, width, 0.0)];
            StoredPolygon::new(corners, PolygonId(0), &tolerance)
        };
        let (noise, hairline) = (sliver(5.0e-7), sliver(1.0e-9));
        assert_eq!(noise.known, PlaneKnown::Noise);
        assert_eq!(hairline.known, PlaneKnown::Hairline);
        let element = |z: f32| {
            ElementBounds::from_polygon(&[
                Vec3::new(0.0, 0.0, z),
                Vec3::new(0.1, 0.0, z),
                Vec3::new(0.0, 0.1, z),
            ])
        };
        let parted = PlaneOctet::new(&[noise, hairline]).part(
            &element(0.1),
            &element(0.2),
            PlaneOctet::depth(&tolerance),
        );
        assert_eq!(parted, 1);
    }
}
