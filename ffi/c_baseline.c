/* See c_baseline.h. */
#include "c_baseline.h"

#include <embree4/rtcore.h>
#include <math.h>
#include <stdalign.h>
#include <stdlib.h>
#include <string.h>

struct c_baseline {
  RTCDevice device;
  RTCScene scene;
};

static int build(struct c_baseline *to, const char *device, const float *positions,
                 size_t vertices, const uint32_t *triangles, size_t count) {
  to->device = rtcNewDevice(device);
  if (!to->device) return 0;
  to->scene = rtcNewScene(to->device);
  rtcSetSceneFlags(to->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(to->scene, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(to->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  float *points = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                          4 * sizeof(float), vertices);
  uint32_t *corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              3 * sizeof(uint32_t), count);
  if (points && corners) {
    for (size_t i = 0; i < vertices; ++i) memcpy(points + 4 * i, positions + 3 * i, 12);
    memcpy(corners, triangles, 12 * count);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(to->scene, geometry);
  }
  rtcReleaseGeometry(geometry);
  rtcCommitScene(to->scene);
  return rtcGetDeviceError(to->device) == RTC_ERROR_NONE;
}

struct c_baseline *c_baseline_new(const char *device, const float *positions, size_t vertices,
                                  const uint32_t *triangles, size_t count) {
  struct c_baseline *scene = calloc(1, sizeof *scene);
  if (scene && !build(scene, device, positions, vertices, triangles, count)) {
    c_baseline_free(scene);
    return NULL;
  }
  return scene;
}

void c_baseline_free(struct c_baseline *scene) {
  if (!scene) return;
  if (scene->scene) rtcReleaseScene(scene->scene);
  if (scene->device) rtcReleaseDevice(scene->device);
  free(scene);
}

static struct RTCOccludedArguments arguments(int coherent) {
  struct RTCOccludedArguments result;
  rtcInitOccludedArguments(&result);
  result.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  return result;
}

uint64_t c_baseline_occluded1(const struct c_baseline *scene, const void *rays, size_t count,
                              int coherent) {
  struct RTCOccludedArguments with = arguments(coherent);
  uint64_t blocked = 0;
  for (size_t i = 0; i < count; ++i) {
    struct RTCRay ray = ((const struct RTCRay *)rays)[i];
    rtcOccluded1(scene->scene, &ray, &with);
    blocked += ray.tfar == -INFINITY;
  }
  return blocked;
}

uint64_t c_baseline_occluded8(const struct c_baseline *scene, const void *rays, size_t count,
                              int coherent) {
  static const alignas(32) int valid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
  struct RTCOccludedArguments with = arguments(coherent);
  uint64_t blocked = 0;
  for (size_t i = 0; i < count; ++i) {
    struct RTCRay8 packet = ((const struct RTCRay8 *)rays)[i];
    rtcOccluded8(valid, scene->scene, &packet, &with);
    for (int lane = 0; lane < 8; ++lane) blocked += packet.tfar[lane] == -INFINITY;
  }
  return blocked;
}

uint64_t c_baseline_occluded16(const struct c_baseline *scene, const void *rays, size_t count,
                               int coherent) {
  static const alignas(64) int valid[16] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                            -1, -1, -1, -1, -1, -1, -1, -1};
  struct RTCOccludedArguments with = arguments(coherent);
  uint64_t blocked = 0;
  for (size_t i = 0; i < count; ++i) {
    struct RTCRay16 packet = ((const struct RTCRay16 *)rays)[i];
    rtcOccluded16(valid, scene->scene, &packet, &with);
    for (int lane = 0; lane < 16; ++lane) blocked += packet.tfar[lane] == -INFINITY;
  }
  return blocked;
}
