/* See certilux_embree.h. */
#include "certilux_embree.h"

/* The two ends of one enum constant: the Rust side sees an unsigned id, all bits set. */
_Static_assert((uint32_t)CERTILUX_INVALID_ID == UINT32_MAX, "an invalid id is all ones");
/* The Rust side passes its own arrays of these. */
_Static_assert(sizeof(struct certilux_ray) == 32, "rays are eight packed floats");
_Static_assert(sizeof(struct certilux_hit) == 28, "hits are seven packed words");
/* The Rust side declares its packets with these alignments. */
_Static_assert(_Alignof(struct RTCRay8) == 32, "a packet of 8 is aligned to 32 bytes");
_Static_assert(_Alignof(struct RTCRay16) == 64, "a packet of 16 is aligned to 64 bytes");

int certilux_take_error(RTCDevice device, const char **message) {
  const int code = (int)rtcGetDeviceError(device);
#if RTC_VERSION >= 40303
  *message = code == RTC_ERROR_NONE ? NULL : rtcGetDeviceLastErrorMessage(device);
#else
  *message = NULL;
#endif
  return code;
}

static void load_ray(struct RTCRay *to, const struct certilux_ray *from) {
  to->org_x = from->origin[0];
  to->org_y = from->origin[1];
  to->org_z = from->origin[2];
  to->tnear = from->tnear;
  to->dir_x = from->direction[0];
  to->dir_y = from->direction[1];
  to->dir_z = from->direction[2];
  to->time = 0.0f;
  to->tfar = from->tfar;
  to->mask = UINT32_MAX;
  to->id = 0;
  to->flags = 0;
}

static void store_hit(struct certilux_hit *to, float t, const struct RTCHit *from) {
  to->t = t;
  to->u = from->u;
  to->v = from->v;
  to->normal[0] = from->Ng_x;
  to->normal[1] = from->Ng_y;
  to->normal[2] = from->Ng_z;
  to->primitive = from->primID;
}

void certilux_closest_hits(RTCScene scene, const struct certilux_ray *rays,
                           struct certilux_hit *hits, size_t count) {
  struct RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  for (size_t i = 0; i < count; ++i) {
    struct RTCRayHit query;
    load_ray(&query.ray, &rays[i]);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.primID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.hit.u = query.hit.v = 0.0f;
    query.hit.Ng_x = query.hit.Ng_y = query.hit.Ng_z = 0.0f;
    rtcIntersect1(scene, &query, &arguments);
    store_hit(&hits[i], query.ray.tfar, &query.hit);
  }
}

struct collection {
  struct RTCRayQueryContext base; /* first: Embree hands back a pointer to it */
  struct certilux_hit *hits;
  size_t capacity;
  size_t count;
};

/* Notes the hit and refuses it, so that traversal goes on. Single rays only: N is 1, where RTCRayN
 * and RTCHitN are RTCRay and RTCHit (their accessors exist in C++ only). */
static void note_and_refuse(const struct RTCFilterFunctionNArguments *arguments) {
  if (arguments->valid[0] != -1) return;
  struct collection *found = (struct collection *)arguments->context;
  if (found->count < found->capacity) {
    const struct RTCRay *ray = (const struct RTCRay *)arguments->ray;
    store_hit(&found->hits[found->count], ray->tfar, (const struct RTCHit *)arguments->hit);
  }
  ++found->count;
  arguments->valid[0] = 0;
}

size_t certilux_all_hits(RTCScene scene, const struct certilux_ray *ray,
                         struct certilux_hit *hits, size_t capacity) {
  struct collection found;
  rtcInitRayQueryContext(&found.base);
  found.hits = hits;
  found.capacity = capacity;
  found.count = 0;

  struct RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  arguments.filter = note_and_refuse;
  arguments.context = &found.base;

  struct RTCRayHit query;
  load_ray(&query.ray, ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.primID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &query, &arguments);
  return found.count;
}
