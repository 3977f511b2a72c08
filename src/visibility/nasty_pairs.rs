//! Pairs of elements around an occluder, made to be hard: what the proofs below are tried on.

use super::{BoundsShape, ElementBounds, Tolerance};
use crate::math::{Aabb, hash_u64};
use crate::occluder::SlabRectangle;
use glam::{DVec3, Quat, Vec3};

/// A stream of random numbers that depends on its seed alone.
pub(super) struct Draw(u64);

impl Draw {
    pub(super) fn new(seed: u64) -> Self {
        Self(hash_u64(seed))
    }

    /// Uniform in [0, 1).
    pub(super) fn unit(&mut self) -> f32 {
        self.0 = hash_u64(self.0);
        (self.0 >> 40) as f32 / 16_777_216.0
    }

    pub(super) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// Uniform in the logarithm.
    pub(super) fn scale(&mut self, low: f32, high: f32) -> f32 {
        (self.between(low.ln(), high.ln())).exp()
    }

    pub(super) fn below(&mut self, count: u32) -> u32 {
        ((self.unit() * count as f32) as u32).min(count - 1)
    }

    pub(super) fn point(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) - 0.5
    }

    pub(super) fn rotation(&mut self) -> Quat {
        if self.below(3) == 0 {
            return Quat::IDENTITY;
        }
        let p = self.point() * 4.0;
        Quat::from_xyzw(p.x, p.y, p.z, self.between(-2.0, 2.0)).normalize()
    }

    /// An element of about `size` around `centre`.
    pub(super) fn element(&mut self, centre: Vec3, size: f32) -> ElementBounds {
        let spread = |draw: &mut Self| draw.point() * 2.0 * size;
        match self.below(4) {
            0 => {
                let mut half = (self.point() + 0.5) * size;
                if self.below(3) == 0 {
                    half[self.below(3) as usize] = 0.0;
                }
                ElementBounds::from_box(Aabb {
                    min: centre - half,
                    max: centre + half,
                })
            }
            1 => {
                let corners = [0; 3].map(|_| centre + spread(self));
                ElementBounds::from_polygon(&corners)
            }
            2 => {
                let (u, v) = (spread(self), spread(self));
                ElementBounds::from_polygon(&[
                    centre - u - v,
                    centre + u - v,
                    centre + u + v,
                    centre - u + v,
                ])
            }
            _ => {
                let (u, v) = (spread(self), spread(self));
                let normal = u.cross(v).normalize_or(Vec3::Z);
                ElementBounds::from_slab(
                    [centre - u, centre + v, centre + u, centre - v],
                    normal * self.scale(1.0e-7, 1.0e-2),
                )
            }
        }
    }
}

/// The element moved by `step`.
pub(super) fn moved(bounds: &ElementBounds, step: Vec3) -> ElementBounds {
    if bounds.shape() == BoundsShape::Box {
        let aabb = bounds.aabb();
        return ElementBounds::from_box(Aabb {
            min: aabb.min + step,
            max: aabb.max + step,
        });
    }
    // The slab's thickness is not kept apart: as a list of corners it is the same set.
    let corners: Vec<Vec3> = bounds.corners().map(|c| c + step).collect();
    if bounds.shape() == BoundsShape::Slab {
        let thickness = (corners[4] - corners[0]) * 0.5;
        let face = std::array::from_fn(|i| corners[i] + thickness);
        return ElementBounds::from_slab(face, thickness);
    }
    ElementBounds::from_polygon(&corners)
}

/// An occluder and two elements, the shaft between them grazing an edge of the occluder.
pub(super) struct GrazingCase {
    pub slab: SlabRectangle,
    pub a: ElementBounds,
    pub b: ElementBounds,
    pub tolerance: Tolerance,
}

impl GrazingCase {
    pub(super) fn draw(draw: &mut Draw) -> Self {
        let turn = draw.rotation();
        let (u, v, n) = (turn * Vec3::X, turn * Vec3::Y, turn * Vec3::Z);
        let centre = draw.point() * 0.3;
        let (hu, hv) = (draw.scale(1.0e-3, 0.4), draw.scale(1.0e-3, 0.4));
        let half_thickness = [1.0e-6, 2.0e-6, 1.0e-4, 0.01][draw.below(4) as usize];
        let slab = SlabRectangle::new(centre, u * hu, v * hv, n, half_thickness);
        // Sizes from a tenth of the rectangle down to nothing.
        let size = |d: &mut Draw| hu.min(hv) * d.scale(1.0e-5, 0.3);
        let (size_a, size_b) = (size(draw), size(draw));
        let a = draw.element(Vec3::ZERO, size_a);
        let b = draw.element(Vec3::ZERO, size_b);
        let crossing = centre + u * hu * draw.between(-0.8, 0.8) + v * hv * draw.between(-0.8, 0.8);
        let tilt = (n + draw.point() * draw.scale(0.01, 4.0)).normalize();
        let lift = |bounds: &ElementBounds, side: f32, draw: &mut Draw| {
            let lowest = bounds
                .corners()
                .map(|c| side * n.dot(c))
                .fold(f32::INFINITY, f32::min);
            let gap = draw.scale(1.0e-7, 0.4);
            let height = half_thickness + 1.0e-6 + gap - lowest;
            moved(
                bounds,
                crossing + tilt * (side * height / n.dot(tilt).max(0.1)),
            )
        };
        let (mut a, mut b) = (lift(&a, -1.0, draw), lift(&b, 1.0, draw));
        // Shift both along u so that the outermost crossing is where we want it.
        if draw.below(4) != 0 {
            let outermost = outermost_crossing(&a, &b, centre, u, n);
            let offset = match draw.below(4) {
                0 => 0.0,
                1 => draw.scale(1.0e-8, 1.0e-3),
                _ => -draw.scale(1.0e-8, 1.0e-2),
            };
            let shift = u * ((f64::from(hu + offset) - outermost) as f32);
            if shift.is_finite() && shift.length() < 1.0 {
                (a, b) = (moved(&a, shift), moved(&b, shift));
            }
        }
        if draw.below(2) == 0 {
            std::mem::swap(&mut a, &mut b);
        }
        let everything = Aabb::from_points(slab.corners)
            .union(a.aabb())
            .union(b.aabb());
        Self {
            slab,
            a,
            b,
            tolerance: Tolerance::of_scene(everything),
        }
    }
}

/// How far along `axis` from `origin` the segments between corners cross the plane.
fn outermost_crossing(
    a: &ElementBounds,
    b: &ElementBounds,
    origin: Vec3,
    axis: Vec3,
    normal: Vec3,
) -> f64 {
    let (o, axis, normal) = (origin.as_dvec3(), axis.as_dvec3(), normal.as_dvec3());
    let mut most = f64::NEG_INFINITY;
    for p in a.corners().map(|c| c.as_dvec3() - o) {
        for q in b.corners().map(|c| c.as_dvec3() - o) {
            let (hp, hq) = (normal.dot(p), normal.dot(q));
            let x: DVec3 = p + (q - p) * (hp / (hp - hq));
            most = most.max(axis.dot(x));
        }
    }
    most
}
