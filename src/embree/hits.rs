//! Nearest hits, in batches through the C shim (see `ffi/`).

use super::ray::Ray;
use super::scene::CommittedScene;
use super::shim;
use crate::math::PolygonId;
use glam::Vec3;

/// Rays a call of the shim: large enough to hide the call, small enough for the stack.
const BATCH: usize = 64;

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The triangle, by its place in the input.
    pub polygon: PolygonId,
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
    /// Barycentric weight of the second vertex: the point is `(1 - u - v) a + u b + v c`.
    pub u: f32,
    /// Barycentric weight of the third vertex.
    pub v: f32,
    /// `(b - a) x (c - a)` of the triangle as wound, not of unit length, not turned to the ray.
    pub geometric_normal: Vec3,
}

pub(super) const NO_HIT: shim::certilux_hit = shim::certilux_hit {
    t: 0.0,
    u: 0.0,
    v: 0.0,
    normal: [0.0; 3],
    primitive: shim::CERTILUX_INVALID_ID,
};

pub(super) fn to_hit(raw: &shim::certilux_hit) -> Option<Hit> {
    (raw.primitive != shim::CERTILUX_INVALID_ID).then(|| Hit {
        polygon: PolygonId(raw.primitive),
        t: raw.t,
        u: raw.u,
        v: raw.v,
        geometric_normal: Vec3::from_array(raw.normal),
    })
}

impl CommittedScene {
    /// The nearest hit of each ray, in the order of the rays; `hits` is emptied first, and keeps
    /// its memory from call to call.
    pub fn closest_hits(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        hits.clear();
        hits.reserve(rays.len());
        let mut found = [NO_HIT; BATCH];
        for rays in rays.chunks(BATCH) {
            // SAFETY: the scene is committed; `Ray` has `certilux_ray`'s layout (asserted in
            // `shim`); both arrays hold at least `rays.len()` items.
            unsafe {
                shim::certilux_closest_hits(
                    self.handle(),
                    rays.as_ptr().cast(),
                    found.as_mut_ptr(),
                    rays.len(),
                );
            }
            hits.extend(found[..rays.len()].iter().map(to_hit));
        }
    }
}
