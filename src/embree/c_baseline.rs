//! The bare C loop of `ffi/c_baseline.c`, so that benches can hold the wrapper against it. Only
//! with the feature `c-baseline`; the engine never uses it.

use super::device::DeviceConfig;
use super::packet::{RayPacket8, RayPacket16};
use glam::Vec3;
use std::ffi::{CString, c_char, c_int};
use std::ptr::NonNull;

#[repr(C)]
struct Opaque {
    _private: [u8; 0],
}

// SAFETY: these are the declarations of `ffi/c_baseline.h`.
unsafe extern "C" {
    fn c_baseline_new(
        device: *const c_char,
        positions: *const f32,
        vertices: usize,
        triangles: *const u32,
        count: usize,
    ) -> *mut Opaque;
    fn c_baseline_free(scene: *mut Opaque);
    fn c_baseline_occluded1(
        s: *const Opaque,
        rays: *const SingleRay,
        n: usize,
        coherent: c_int,
    ) -> u64;
    fn c_baseline_occluded8(
        s: *const Opaque,
        rays: *const RayPacket8,
        n: usize,
        coherent: c_int,
    ) -> u64;
    fn c_baseline_occluded16(
        s: *const Opaque,
        rays: *const RayPacket16,
        n: usize,
        coherent: c_int,
    ) -> u64;
}

/// One ray as Embree's `RTCRay`, made from the first lane of a packet.
#[repr(transparent)]
#[derive(Clone, Copy, Debug)]
pub struct SingleRay(embree4_sys::RTCRay);

impl SingleRay {
    /// Lane `lane` of `packet`.
    pub fn from_lane(packet: &RayPacket8, lane: usize) -> Self {
        Self(embree4_sys::RTCRay {
            org_x: packet.org_x[lane],
            org_y: packet.org_y[lane],
            org_z: packet.org_z[lane],
            tnear: packet.tnear[lane],
            dir_x: packet.dir_x[lane],
            dir_y: packet.dir_y[lane],
            dir_z: packet.dir_z[lane],
            time: 0.0,
            tfar: packet.tfar[lane],
            mask: u32::MAX,
            id: 0,
            flags: 0,
        })
    }
}

/// A scene built and queried by C alone.
#[derive(Debug)]
pub struct CBaseline(NonNull<Opaque>);

impl std::fmt::Debug for Opaque {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("c_baseline")
    }
}

impl CBaseline {
    /// Builds the scene; `None` where Embree refuses. Indices must be in range.
    ///
    /// # Panics
    /// If an index is out of range, since C would read whatever is there.
    pub fn build(
        config: &DeviceConfig,
        positions: &[Vec3],
        triangles: &[[u32; 3]],
    ) -> Option<Self> {
        let device = CString::new(config.to_embree().ok()?).ok()?;
        assert!(
            triangles
                .as_flattened()
                .iter()
                .all(|&i| (i as usize) < positions.len())
        );
        // SAFETY: the string ends with NUL, both arrays are as long as said, and C copies them.
        let scene = unsafe {
            c_baseline_new(
                device.as_ptr(),
                positions.as_ptr().cast(),
                positions.len(),
                triangles.as_ptr().cast(),
                triangles.len(),
            )
        };
        NonNull::new(scene).map(Self)
    }

    /// How many of the rays are blocked, asked one at a time.
    pub fn occluded1(&self, rays: &[SingleRay], coherent: bool) -> u64 {
        // SAFETY: the scene is live; the array holds RTCRay (layout asserted in `shim`).
        unsafe { c_baseline_occluded1(self.0.as_ptr(), rays.as_ptr(), rays.len(), coherent.into()) }
    }

    /// How many of the rays are blocked, asked by full packets of 8.
    pub fn occluded8(&self, rays: &[RayPacket8], coherent: bool) -> u64 {
        // SAFETY: the scene is live; the array holds RTCRay8 (layout asserted in `shim`).
        unsafe { c_baseline_occluded8(self.0.as_ptr(), rays.as_ptr(), rays.len(), coherent.into()) }
    }

    /// How many of the rays are blocked, asked by full packets of 16.
    pub fn occluded16(&self, rays: &[RayPacket16], coherent: bool) -> u64 {
        // SAFETY: the scene is live; the array holds RTCRay16 (layout asserted in `shim`).
        unsafe {
            c_baseline_occluded16(self.0.as_ptr(), rays.as_ptr(), rays.len(), coherent.into())
        }
    }
}

impl Drop for CBaseline {
    fn drop(&mut self) {
        // SAFETY: made by `c_baseline_new`, freed once.
        unsafe { c_baseline_free(self.0.as_ptr()) };
    }
}
