/* See c_baseline.h. */
#include "c_baseline.h"

#include <math.h>
#include <stdalign.h>

static struct RTCOccludedArguments arguments(int coherent) {
  struct RTCOccludedArguments result;
  rtcInitOccludedArguments(&result);
  result.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  return result;
}

uint64_t c_baseline_occluded1(RTCScene scene, const struct RTCRay *rays, size_t count,
                              int coherent) {
  struct RTCOccludedArguments with = arguments(coherent);
  uint64_t blocked = 0;
  for (size_t i = 0; i < count; ++i) {
    struct RTCRay ray = rays[i];
    rtcOccluded1(scene, &ray, &with);
    blocked += ray.tfar == -INFINITY;
  }
  return blocked;
}

uint64_t c_baseline_occluded8(RTCScene scene, const struct RTCRay8 *rays, size_t count,
                              int coherent) {
  static const alignas(32) int valid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
  struct RTCOccludedArguments with = arguments(coherent);
  uint64_t blocked = 0;
  for (size_t i = 0; i < count; ++i) {
    struct RTCRay8 packet = rays[i];
    rtcOccluded8(valid, scene, &packet, &with);
    for (int lane = 0; lane < 8; ++lane) blocked += packet.tfar[lane] == -INFINITY;
  }
  return blocked;
}

uint64_t c_baseline_occluded16(RTCScene scene, const struct RTCRay16 *rays, size_t count,
                               int coherent) {
  static const alignas(64) int valid[16] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                            -1, -1, -1, -1, -1, -1, -1, -1};
  struct RTCOccludedArguments with = arguments(coherent);
  uint64_t blocked = 0;
  for (size_t i = 0; i < count; ++i) {
    struct RTCRay16 packet = rays[i];
    rtcOccluded16(valid, scene, &packet, &with);
    for (int lane = 0; lane < 16; ++lane) blocked += packet.tfar[lane] == -INFINITY;
  }
  return blocked;
}
