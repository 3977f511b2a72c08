//! Triangles, built into Embree's hierarchy once and then queried from any thread.

use super::device::Device;
use super::error::EmbreeError;
use super::packet::{RayPacket8, RayPacket16};
use super::ray::Ray;
use embree4_sys as sys;
use glam::Vec3;
use std::{ptr, slice};

/// A built scene, which can only be queried. Triangle `i` of the input is polygon `i` of the hits.
///
/// Built robustly (rays through a shared edge or vertex do not slip through) and for speed of
/// queries. With the device's default of one build thread, equal input gives equal answers.
///
/// Rays exclude nothing: whoever asks trims `tnear` and `tfar` to leave and reach a surface. Rays
/// with a NaN have no defined answer, but do no harm.
#[derive(Debug)]
pub struct CommittedScene {
    handle: sys::RTCScene,
    // Dropped after the scene, whose `drop` runs first.
    _device: Device,
}

// SAFETY: a committed scene is never changed again, Embree documents queries of it as safe from
// any number of threads at once, and its reference count is atomic.
unsafe impl Send for CommittedScene {}
// SAFETY: as above.
unsafe impl Sync for CommittedScene {}

impl CommittedScene {
    /// Builds the hierarchy over `triangles`, counter-clockwise indices into `positions`.
    pub fn build(
        device: &Device,
        positions: &[Vec3],
        triangles: &[[u32; 3]],
    ) -> Result<Self, EmbreeError> {
        Self::build_with(device, positions, triangles, sys::RTCSceneFlags::ROBUST)
    }

    pub(super) fn build_with(
        device: &Device,
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        flags: sys::RTCSceneFlags,
    ) -> Result<Self, EmbreeError> {
        check_input(positions, triangles)?;
        // SAFETY: the device is live; the scene is owned, and released on every path, from here on.
        let handle = unsafe { sys::rtcNewScene(device.handle()) };
        let scene = Self {
            handle: non_null(device, handle, "create a scene")?,
            _device: device.clone(),
        };
        // SAFETY: the scene is live and not yet committed.
        unsafe {
            sys::rtcSetSceneFlags(handle, flags);
            sys::rtcSetSceneBuildQuality(handle, sys::RTCBuildQuality::HIGH);
        }
        device.check("set the scene's flags")?;
        // Embree refuses empty buffers; a scene without geometry is well defined and never hit.
        if !triangles.is_empty() {
            attach_triangles(device, handle, positions, triangles)?;
        }
        // SAFETY: the scene is live, and nobody else knows it yet.
        unsafe { sys::rtcCommitScene(handle) };
        device.check("build the scene's hierarchy")?;
        Ok(scene)
    }

    pub(super) fn handle(&self) -> sys::RTCScene {
        self.handle
    }

    /// Which of the lanes named by `active` are blocked; consumes `tfar` of those lanes.
    ///
    /// For rays that run side by side, as those of an exchange do: some 20 % faster for them than
    /// [`Self::occluded8_incoherent`], and more than twice as slow for others (`bench/runs/`).
    #[inline]
    pub fn occluded8(&self, rays: &mut RayPacket8, active: u8) -> u8 {
        self.occluded8_with(rays, active, sys::RTCRayQueryFlags::COHERENT)
    }

    /// As [`Self::occluded8`], for rays that have nothing to do with each other, or are few.
    #[inline]
    pub fn occluded8_incoherent(&self, rays: &mut RayPacket8, active: u8) -> u8 {
        self.occluded8_with(rays, active, sys::RTCRayQueryFlags::INCOHERENT)
    }

    #[inline]
    fn occluded8_with(
        &self,
        rays: &mut RayPacket8,
        active: u8,
        flags: sys::RTCRayQueryFlags,
    ) -> u8 {
        let valid = RayPacket8::valid(active);
        let mut arguments = arguments(flags);
        // SAFETY: the scene is committed; the packet has RTCRay8's layout and alignment (asserted
        // in `shim`); `valid` has 8 entries aligned to 64 bytes; Embree only reads the arguments.
        unsafe {
            sys::rtcOccluded8(
                valid.0.as_ptr(),
                self.handle,
                ptr::from_mut(rays).cast(),
                &mut arguments,
            );
        }
        rays.blocked() & active
    }

    /// Which of the lanes named by `active` are blocked, for rays that run side by side; consumes
    /// `tfar` of those lanes. Not faster than two packets of 8 (`bench/runs/`).
    #[inline]
    pub fn occluded16(&self, rays: &mut RayPacket16, active: u16) -> u16 {
        let mut arguments = arguments(sys::RTCRayQueryFlags::COHERENT);
        RayPacket16::with_valid(active, |valid| {
            // SAFETY: as in `occluded8_with`, with RTCRay16 and 16 entries.
            unsafe {
                sys::rtcOccluded16(
                    valid.0.as_ptr(),
                    self.handle,
                    ptr::from_mut(rays).cast(),
                    &mut arguments,
                );
            }
        });
        rays.blocked() & active
    }

    /// True when something blocks the ray.
    #[inline]
    pub fn occluded1(&self, ray: &Ray) -> bool {
        let mut query = sys::RTCRay::from(*ray);
        // SAFETY: the scene is committed, RTCRay's layout is asserted in `shim`, null arguments are
        // the defaults.
        unsafe { sys::rtcOccluded1(self.handle, &mut query, ptr::null_mut()) };
        query.tfar == f32::NEG_INFINITY
    }

    /// For each ray, whether something blocks it, the rays having nothing to do with each other;
    /// for places where clarity counts more than the last nanosecond.
    pub fn occluded_many(&self, rays: &[Ray]) -> Vec<bool> {
        let mut blocked = Vec::with_capacity(rays.len());
        let mut packet = RayPacket8::EMPTY;
        for rays in rays.chunks(RayPacket8::WIDTH) {
            for (lane, ray) in rays.iter().enumerate() {
                packet.set(lane, ray.origin, ray.direction, ray.tnear, ray.tfar);
            }
            let bits = self.occluded8_incoherent(&mut packet, RayPacket8::first(rays.len()));
            blocked.extend((0..rays.len()).map(|lane| bits >> lane & 1 == 1));
        }
        blocked
    }
}

impl Drop for CommittedScene {
    fn drop(&mut self) {
        // SAFETY: `self` owns one reference and gives it back once; no query runs, for that would
        // borrow `self`.
        unsafe { sys::rtcReleaseScene(self.handle) };
    }
}

/// What `rtcInitOccludedArguments` sets (inline in C's header), with the given flags.
#[inline]
fn arguments(flags: sys::RTCRayQueryFlags) -> sys::RTCOccludedArguments {
    sys::RTCOccludedArguments {
        flags,
        feature_mask: sys::RTCFeatureFlags::RTC_FEATURE_FLAG_ALL,
        context: ptr::null_mut(),
        filter: None,
        occluded: None,
    }
}

/// Embree trusts indices, so they are checked here, whatever the caller promises.
fn check_input(positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), EmbreeError> {
    // The greatest id is Embree's "invalid".
    for (what, count) in [
        ("vertices", positions.len()),
        ("triangles", triangles.len()),
    ] {
        if count >= u32::MAX as usize {
            return Err(EmbreeError::TooMany { what, count });
        }
    }
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&index) = corners.iter().find(|&&i| i as usize >= positions.len()) {
            return Err(EmbreeError::IndexOutOfRange {
                triangle,
                index,
                vertices: positions.len(),
            });
        }
    }
    Ok(())
}

fn attach_triangles(
    device: &Device,
    scene: sys::RTCScene,
    positions: &[Vec3],
    triangles: &[[u32; 3]],
) -> Result<(), EmbreeError> {
    // SAFETY: the device is live.
    let geometry = unsafe { sys::rtcNewGeometry(device.handle(), sys::RTCGeometryType::TRIANGLE) };
    let mut geometry = Geometry(non_null(device, geometry, "create a geometry")?);

    // Embree reads vertices 16 bytes at a time; a stride of 16 keeps every read inside the buffer.
    let vertices = geometry.new_buffer::<[f32; 4]>(
        device,
        sys::RTCBufferType::VERTEX,
        sys::RTCFormat::FLOAT3,
        positions.len(),
        "allocate the vertex buffer",
    )?;
    for (to, from) in vertices.iter_mut().zip(positions) {
        *to = [from.x, from.y, from.z, 0.0];
    }
    let indices = geometry.new_buffer::<[u32; 3]>(
        device,
        sys::RTCBufferType::INDEX,
        sys::RTCFormat::UINT3,
        triangles.len(),
        "allocate the index buffer",
    )?;
    indices.copy_from_slice(triangles);

    // SAFETY: geometry and scene are live and not yet committed; the scene takes a reference of
    // its own to the geometry.
    unsafe {
        sys::rtcSetGeometryBuildQuality(geometry.0, sys::RTCBuildQuality::HIGH);
        sys::rtcCommitGeometry(geometry.0);
        sys::rtcAttachGeometry(scene, geometry.0);
    }
    device.check("attach the triangles")
}

fn non_null<T>(
    device: &Device,
    handle: *mut T,
    operation: &'static str,
) -> Result<*mut T, EmbreeError> {
    device.check(operation)?;
    if handle.is_null() {
        return Err(EmbreeError::NothingReturned { operation });
    }
    Ok(handle)
}

/// Owns one reference to a geometry.
struct Geometry(sys::RTCGeometry);

impl Geometry {
    /// A buffer that Embree owns, zeroed, of `count` items.
    fn new_buffer<T: bytemuck::Pod>(
        &mut self,
        device: &Device,
        buffer: sys::RTCBufferType,
        format: sys::RTCFormat,
        count: usize,
        operation: &'static str,
    ) -> Result<&mut [T], EmbreeError> {
        // SAFETY: the geometry is live and not yet committed.
        let data = unsafe {
            sys::rtcSetNewGeometryBuffer(self.0, buffer, 0, format, size_of::<T>(), count)
        };
        let data = non_null(device, data.cast::<T>(), operation)?;
        // SAFETY: Embree allocated at least `count` items of this size, aligned to 16 bytes, and
        // keeps them while the geometry lives, which `self` owns; borrowing `self` mutably makes the
        // slice the only view. Zeroing makes the memory initialised, and every bit
        // pattern is a valid `T`.
        unsafe {
            ptr::write_bytes(data, 0, count);
            Ok(slice::from_raw_parts_mut(data, count))
        }
    }
}

impl Drop for Geometry {
    fn drop(&mut self) {
        // SAFETY: `self` owns one reference and gives it back once.
        unsafe { sys::rtcReleaseGeometry(self.0) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::embree::DeviceConfig;

    #[test]
    fn scenes_outlive_their_device() {
        let device = Device::open(&DeviceConfig::default()).unwrap();
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let scene = CommittedScene::build(&device, &corners, &[[0, 1, 2]]).unwrap();
        drop(device);
        let above = Vec3::new(0.2, 0.2, 1.0);
        assert!(scene.occluded1(&Ray::half_line(above, Vec3::NEG_Z, 0.0)));
        assert!(!scene.occluded1(&Ray::half_line(above, Vec3::Z, 0.0)));
    }
}
