//! Bindings of `ffi/`, and the proof, made by the compiler, that every layout and value taken from
//! `embree4-sys` (Embree 4.2's header) agrees with the installed headers.

use super::packet::{RayPacket8, RayPacket16};
use super::ray::Ray;
use embree4_sys as sys;
use std::mem::{align_of, offset_of, size_of};

/// Names as C has them, made by `build.rs`.
#[allow(non_camel_case_types, missing_docs)]
mod bindings {
    use embree4_sys::{RTCDevice, RTCScene};
    include!(concat!(env!("OUT_DIR"), "/shim.rs"));
}

pub(super) use bindings::*;

/// Asserts size, alignment and the offset of every field against the constants `$prefix_...`.
macro_rules! assert_ray_layout {
    ($type:ty, $size:ident, $align:ident, $($field:ident = $offset:ident),+) => {
        const _: () = {
            assert!(size_of::<$type>() == bindings::$size as usize);
            assert!(align_of::<$type>() == bindings::$align as usize);
            $(assert!(offset_of!($type, $field) == bindings::$offset as usize);)+
        };
    };
}

macro_rules! assert_packet_of_8 {
    ($type:ty) => {
        assert_ray_layout!(
            $type,
            CERTILUX_RAY8_SIZE,
            CERTILUX_RAY8_ALIGN,
            org_x = CERTILUX_RAY8_ORG_X,
            org_y = CERTILUX_RAY8_ORG_Y,
            org_z = CERTILUX_RAY8_ORG_Z,
            tnear = CERTILUX_RAY8_TNEAR,
            dir_x = CERTILUX_RAY8_DIR_X,
            dir_y = CERTILUX_RAY8_DIR_Y,
            dir_z = CERTILUX_RAY8_DIR_Z,
            time = CERTILUX_RAY8_TIME,
            tfar = CERTILUX_RAY8_TFAR,
            mask = CERTILUX_RAY8_MASK,
            id = CERTILUX_RAY8_ID,
            flags = CERTILUX_RAY8_FLAGS
        );
    };
}

macro_rules! assert_packet_of_16 {
    ($type:ty) => {
        assert_ray_layout!(
            $type,
            CERTILUX_RAY16_SIZE,
            CERTILUX_RAY16_ALIGN,
            org_x = CERTILUX_RAY16_ORG_X,
            org_y = CERTILUX_RAY16_ORG_Y,
            org_z = CERTILUX_RAY16_ORG_Z,
            tnear = CERTILUX_RAY16_TNEAR,
            dir_x = CERTILUX_RAY16_DIR_X,
            dir_y = CERTILUX_RAY16_DIR_Y,
            dir_z = CERTILUX_RAY16_DIR_Z,
            time = CERTILUX_RAY16_TIME,
            tfar = CERTILUX_RAY16_TFAR,
            mask = CERTILUX_RAY16_MASK,
            id = CERTILUX_RAY16_ID,
            flags = CERTILUX_RAY16_FLAGS
        );
    };
}

assert_ray_layout!(
    sys::RTCRay,
    CERTILUX_RAY1_SIZE,
    CERTILUX_RAY1_ALIGN,
    org_x = CERTILUX_RAY1_ORG_X,
    org_y = CERTILUX_RAY1_ORG_Y,
    org_z = CERTILUX_RAY1_ORG_Z,
    tnear = CERTILUX_RAY1_TNEAR,
    dir_x = CERTILUX_RAY1_DIR_X,
    dir_y = CERTILUX_RAY1_DIR_Y,
    dir_z = CERTILUX_RAY1_DIR_Z,
    time = CERTILUX_RAY1_TIME,
    tfar = CERTILUX_RAY1_TFAR,
    mask = CERTILUX_RAY1_MASK,
    id = CERTILUX_RAY1_ID,
    flags = CERTILUX_RAY1_FLAGS
);
assert_packet_of_8!(sys::RTCRay8);
assert_packet_of_8!(RayPacket8);
assert_packet_of_16!(sys::RTCRay16);
assert_packet_of_16!(RayPacket16);

assert_ray_layout!(
    sys::RTCOccludedArguments,
    CERTILUX_OCCLUDED_ARGS_SIZE,
    CERTILUX_OCCLUDED_ARGS_ALIGN,
    flags = CERTILUX_OCCLUDED_ARGS_FLAGS,
    feature_mask = CERTILUX_OCCLUDED_ARGS_FEATURE_MASK,
    context = CERTILUX_OCCLUDED_ARGS_CONTEXT,
    filter = CERTILUX_OCCLUDED_ARGS_FILTER,
    occluded = CERTILUX_OCCLUDED_ARGS_OCCLUDED
);

/// Our own rays cross as they are.
const _: () = {
    assert!(size_of::<Ray>() == size_of::<certilux_ray>());
    assert!(align_of::<Ray>() == align_of::<certilux_ray>());
    assert!(offset_of!(Ray, origin) == offset_of!(certilux_ray, origin));
    assert!(offset_of!(Ray, tnear) == offset_of!(certilux_ray, tnear));
    assert!(offset_of!(Ray, direction) == offset_of!(certilux_ray, direction));
    assert!(offset_of!(Ray, tfar) == offset_of!(certilux_ray, tfar));
};

/// Values that the engine passes in.
const _: () = {
    assert!(sys::RTCGeometryType::TRIANGLE as u32 == CERTILUX_GEOMETRY_TYPE_TRIANGLE);
    assert!(sys::RTCBufferType::INDEX as u32 == CERTILUX_BUFFER_TYPE_INDEX);
    assert!(sys::RTCBufferType::VERTEX as u32 == CERTILUX_BUFFER_TYPE_VERTEX);
    assert!(sys::RTCFormat::UINT3 as u32 == CERTILUX_FORMAT_UINT3);
    assert!(sys::RTCFormat::FLOAT3 as u32 == CERTILUX_FORMAT_FLOAT3);
    assert!(sys::RTCBuildQuality::HIGH as u32 == CERTILUX_BUILD_QUALITY_HIGH);
    assert!(sys::RTCSceneFlags::ROBUST.0 == CERTILUX_SCENE_FLAG_ROBUST);
    assert!(
        sys::RTCSceneFlags::FILTER_FUNCTION_IN_ARGUMENTS.0
            == CERTILUX_SCENE_FLAG_FILTER_IN_ARGUMENTS
    );
    assert!(sys::RTCDeviceProperty::VERSION as u32 == CERTILUX_DEVICE_PROPERTY_VERSION);
    assert!(sys::RTCRayQueryFlags::INCOHERENT.0 == CERTILUX_RAY_QUERY_INCOHERENT);
    assert!(sys::RTCFeatureFlags::RTC_FEATURE_FLAG_ALL.0 == CERTILUX_FEATURE_FLAG_ALL);
    assert!(sys::RTCRayQueryFlags::COHERENT.0 == CERTILUX_RAY_QUERY_COHERENT);
};
