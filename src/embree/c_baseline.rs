//! The bare C loop of `ffi/c_baseline.c`, so that benches can hold the wrapper against it. Only
//! with the feature `c-baseline`; the engine never uses it.

use super::packet::{RayPacket8, RayPacket16};
use super::ray::Ray;
use super::scene::CommittedScene;
use embree4_sys::{RTCRay, RTCScene};
use std::ffi::c_int;

// SAFETY: these are the declarations of `ffi/c_baseline.h`; the layouts are asserted in `shim`.
unsafe extern "C" {
    fn c_baseline_occluded1(s: RTCScene, rays: *const SingleRay, n: usize, coherent: c_int) -> u64;
    fn c_baseline_occluded8(s: RTCScene, rays: *const RayPacket8, n: usize, coherent: c_int)
    -> u64;
    fn c_baseline_occluded16(
        s: RTCScene,
        rays: *const RayPacket16,
        n: usize,
        coherent: c_int,
    ) -> u64;
}

/// One ray as Embree's `RTCRay`.
#[repr(transparent)]
#[derive(Clone, Copy, Debug)]
pub struct SingleRay(RTCRay);

impl From<Ray> for SingleRay {
    fn from(ray: Ray) -> Self {
        Self(ray.into())
    }
}

/// Queries of a scene by C loops; each returns how many of the rays are blocked.
#[derive(Clone, Copy, Debug)]
pub struct CBaseline<'a>(pub &'a CommittedScene);

impl CBaseline<'_> {
    /// Rays asked one at a time.
    pub fn occluded1(self, rays: &[SingleRay], coherent: bool) -> u64 {
        // SAFETY: the scene is committed; the array is as long as said.
        unsafe { c_baseline_occluded1(self.0.handle(), rays.as_ptr(), rays.len(), coherent.into()) }
    }

    /// Rays asked by full packets of 8.
    pub fn occluded8(self, rays: &[RayPacket8], coherent: bool) -> u64 {
        // SAFETY: as above.
        unsafe { c_baseline_occluded8(self.0.handle(), rays.as_ptr(), rays.len(), coherent.into()) }
    }

    /// Rays asked by full packets of 16.
    pub fn occluded16(self, rays: &[RayPacket16], coherent: bool) -> u64 {
        // SAFETY: as above.
        unsafe {
            c_baseline_occluded16(self.0.handle(), rays.as_ptr(), rays.len(), coherent.into())
        }
    }
}
