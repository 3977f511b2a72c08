/* What embree4-sys cannot be trusted with, compiled against the *installed* Embree headers.
 *
 * embree4-sys carries Embree 4.2's header, whose RTCHit is shorter than that of 4.3 and later, so
 * whatever returns a hit goes through here; its RTCError is a Rust enum without every code, so
 * errors cross as int. The layout constants let the Rust side assert, while it is compiled, that
 * everything it does take from embree4-sys agrees with the installed headers. */
#ifndef CERTILUX_EMBREE_H
#define CERTILUX_EMBREE_H

#include <embree4/rtcore.h>
#include <stddef.h>
#include <stdint.h>

#if RTC_VERSION < 40300
#error "certilux needs the headers of Embree 4.3 or later"
#endif

/* A ray as the Rust side keeps it: points origin + t * direction, tnear <= t <= tfar. */
struct certilux_ray {
  float origin[3];
  float tnear;
  float direction[3];
  float tfar;
};

/* A hit; primitive is RTC_INVALID_GEOMETRY_ID where the ray hits nothing. */
struct certilux_hit {
  float t;
  float u;
  float v;
  float normal[3];
  uint32_t primitive;
};

/* Reads and clears the calling thread's error of the device (of device creation where it is
 * NULL). message points into Embree and lives until the next error; it may be NULL. */
int certilux_take_error(RTCDevice device, const char **message);

/* The nearest hit of each of count rays. */
void certilux_closest_hits(RTCScene scene, const struct certilux_ray *rays,
                           struct certilux_hit *hits, size_t count);

/* Every hit of one ray, in no order, a primitive perhaps more than once; the scene must have
 * RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS. Writes at most capacity hits and returns how many
 * there are. */
size_t certilux_all_hits(RTCScene scene, const struct certilux_ray *ray,
                         struct certilux_hit *hits, size_t capacity);

#define CERTILUX_RAY_LAYOUT(NAME, TYPE)                                                            \
  CERTILUX_##NAME##_SIZE = sizeof(struct TYPE), CERTILUX_##NAME##_ALIGN = _Alignof(struct TYPE),   \
  CERTILUX_##NAME##_ORG_X = offsetof(struct TYPE, org_x),                                          \
  CERTILUX_##NAME##_ORG_Y = offsetof(struct TYPE, org_y),                                          \
  CERTILUX_##NAME##_ORG_Z = offsetof(struct TYPE, org_z),                                          \
  CERTILUX_##NAME##_TNEAR = offsetof(struct TYPE, tnear),                                          \
  CERTILUX_##NAME##_DIR_X = offsetof(struct TYPE, dir_x),                                          \
  CERTILUX_##NAME##_DIR_Y = offsetof(struct TYPE, dir_y),                                          \
  CERTILUX_##NAME##_DIR_Z = offsetof(struct TYPE, dir_z),                                          \
  CERTILUX_##NAME##_TIME = offsetof(struct TYPE, time),                                            \
  CERTILUX_##NAME##_TFAR = offsetof(struct TYPE, tfar),                                            \
  CERTILUX_##NAME##_MASK = offsetof(struct TYPE, mask),                                            \
  CERTILUX_##NAME##_ID = offsetof(struct TYPE, id),                                                \
  CERTILUX_##NAME##_FLAGS = offsetof(struct TYPE, flags)

enum {
  CERTILUX_RAY_LAYOUT(RAY1, RTCRay),
  CERTILUX_RAY_LAYOUT(RAY8, RTCRay8),
  CERTILUX_RAY_LAYOUT(RAY16, RTCRay16),

  CERTILUX_OCCLUDED_ARGS_SIZE = sizeof(struct RTCOccludedArguments),
  CERTILUX_OCCLUDED_ARGS_ALIGN = _Alignof(struct RTCOccludedArguments),
  CERTILUX_OCCLUDED_ARGS_FLAGS = offsetof(struct RTCOccludedArguments, flags),
  CERTILUX_OCCLUDED_ARGS_FEATURE_MASK = offsetof(struct RTCOccludedArguments, feature_mask),
  CERTILUX_OCCLUDED_ARGS_CONTEXT = offsetof(struct RTCOccludedArguments, context),
  CERTILUX_OCCLUDED_ARGS_FILTER = offsetof(struct RTCOccludedArguments, filter),
  CERTILUX_OCCLUDED_ARGS_OCCLUDED = offsetof(struct RTCOccludedArguments, occluded),

  CERTILUX_GEOMETRY_TYPE_TRIANGLE = RTC_GEOMETRY_TYPE_TRIANGLE,
  CERTILUX_BUFFER_TYPE_INDEX = RTC_BUFFER_TYPE_INDEX,
  CERTILUX_BUFFER_TYPE_VERTEX = RTC_BUFFER_TYPE_VERTEX,
  CERTILUX_FORMAT_UINT3 = RTC_FORMAT_UINT3,
  CERTILUX_FORMAT_FLOAT3 = RTC_FORMAT_FLOAT3,
  CERTILUX_BUILD_QUALITY_HIGH = RTC_BUILD_QUALITY_HIGH,
  CERTILUX_SCENE_FLAG_ROBUST = RTC_SCENE_FLAG_ROBUST,
  CERTILUX_SCENE_FLAG_FILTER_IN_ARGUMENTS = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS,
  CERTILUX_DEVICE_PROPERTY_VERSION = RTC_DEVICE_PROPERTY_VERSION,
  CERTILUX_FEATURE_FLAG_ALL = RTC_FEATURE_FLAG_ALL,
  CERTILUX_RAY_QUERY_INCOHERENT = RTC_RAY_QUERY_FLAG_INCOHERENT,
  CERTILUX_RAY_QUERY_COHERENT = RTC_RAY_QUERY_FLAG_COHERENT,

  CERTILUX_ERROR_NONE = RTC_ERROR_NONE,
  CERTILUX_ERROR_UNKNOWN = RTC_ERROR_UNKNOWN,
  CERTILUX_ERROR_INVALID_ARGUMENT = RTC_ERROR_INVALID_ARGUMENT,
  CERTILUX_ERROR_INVALID_OPERATION = RTC_ERROR_INVALID_OPERATION,
  CERTILUX_ERROR_OUT_OF_MEMORY = RTC_ERROR_OUT_OF_MEMORY,
  CERTILUX_ERROR_UNSUPPORTED_CPU = RTC_ERROR_UNSUPPORTED_CPU,
  CERTILUX_ERROR_CANCELLED = RTC_ERROR_CANCELLED,

  CERTILUX_INVALID_ID = RTC_INVALID_GEOMETRY_ID
};

#endif
