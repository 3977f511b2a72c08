/* A bare C loop over Embree, the yardstick of the Rust wrapper: nothing but rtcOccluded* calls.
 * Compiled with the feature `c-baseline` only. */
#ifndef CERTILUX_C_BASELINE_H
#define CERTILUX_C_BASELINE_H

#include <stddef.h>
#include <stdint.h>

struct c_baseline;

/* A device (configured as said) and scene set up as the engine's: robust, high quality, vertices
 * 16 bytes apart. NULL on any error. */
struct c_baseline *c_baseline_new(const char *device, const float *positions, size_t vertices,
                                  const uint32_t *triangles, size_t count);
void c_baseline_free(struct c_baseline *scene);

/* Queries each packet of `rays` (RTCRay, RTCRay8, RTCRay16) from a copy, because queries consume
 * tfar; returns how many rays are blocked. */
uint64_t c_baseline_occluded1(const struct c_baseline *scene, const void *rays, size_t count,
                              int coherent);
uint64_t c_baseline_occluded8(const struct c_baseline *scene, const void *rays, size_t count,
                              int coherent);
uint64_t c_baseline_occluded16(const struct c_baseline *scene, const void *rays, size_t count,
                               int coherent);

#endif
