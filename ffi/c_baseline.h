/* A bare C loop over Embree, the yardstick of the Rust wrapper: nothing but rtcOccluded* calls.
 * Compiled with the feature `c-baseline` only. */
#ifndef CERTILUX_C_BASELINE_H
#define CERTILUX_C_BASELINE_H

#include <embree4/rtcore.h>
#include <stddef.h>
#include <stdint.h>

/* Each queries `count` full packets from copies, because queries consume tfar, and returns how many
 * rays are blocked. */
uint64_t c_baseline_occluded1(RTCScene scene, const struct RTCRay *rays, size_t count,
                              int coherent);
uint64_t c_baseline_occluded8(RTCScene scene, const struct RTCRay8 *rays, size_t count,
                              int coherent);
uint64_t c_baseline_occluded16(RTCScene scene, const struct RTCRay16 *rays, size_t count,
                               int coherent);

#endif
