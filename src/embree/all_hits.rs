//! Every hit along a ray, for audits.

use super::device::Device;
use super::error::EmbreeError;
use super::hits::{Hit, NO_HIT, to_hit};
use super::ray::Ray;
use super::scene::CommittedScene;
use super::shim;
use crate::math::PolygonId;
use embree4_sys::RTCSceneFlags;
use glam::Vec3;

/// Hits that the first call has room for: more than most rays of a room have.
const EXPECTED_HITS: usize = 32;

/// One of the hits of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The triangle, by its place in the input.
    pub polygon: PolygonId,
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
}

impl From<Hit> for RayHit {
    fn from(hit: Hit) -> Self {
        Self {
            polygon: hit.polygon,
            t: hit.t,
        }
    }
}

/// A scene that can list every hit of a ray. Embree takes slower code paths for all queries of
/// such a scene, so it is a type of its own, apart from the scene that is timed.
#[derive(Debug)]
pub struct AllHitsScene {
    scene: CommittedScene,
}

impl AllHitsScene {
    /// Builds the hierarchy over `triangles`, as [`CommittedScene::build`] does.
    pub fn build(
        device: &Device,
        positions: &[Vec3],
        triangles: &[[u32; 3]],
    ) -> Result<Self, EmbreeError> {
        let flags = RTCSceneFlags::ROBUST | RTCSceneFlags::FILTER_FUNCTION_IN_ARGUMENTS;
        CommittedScene::build_with(device, positions, triangles, flags).map(|scene| Self { scene })
    }

    /// Calls `visit` for every triangle that the ray hits, once each, by growing `t` and, where
    /// that is equal, by growing id.
    pub fn for_each_hit(&self, ray: &Ray, visit: impl FnMut(RayHit)) {
        let mut found = vec![NO_HIT; EXPECTED_HITS];
        loop {
            // SAFETY: the scene is committed with the flag that the shim asks for; `Ray` has
            // `certilux_ray`'s layout (asserted in `shim`); `found` has room for what is promised.
            let count = unsafe {
                shim::certilux_all_hits(
                    self.scene.handle(),
                    std::ptr::from_ref(ray).cast(),
                    found.as_mut_ptr(),
                    found.len(),
                )
            };
            if count <= found.len() {
                found.truncate(count);
                break;
            }
            found.resize(count, NO_HIT);
        }
        let mut hits: Vec<RayHit> = found.iter().filter_map(to_hit).map(RayHit::from).collect();
        // The high-quality hierarchy may hold a triangle in several leaves.
        hits.sort_by(|a, b| a.polygon.cmp(&b.polygon).then(a.t.total_cmp(&b.t)));
        hits.dedup_by_key(|hit| hit.polygon);
        hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.polygon.cmp(&b.polygon)));
        hits.into_iter().for_each(visit);
    }
}
