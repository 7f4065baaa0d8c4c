/* The one place that knows how a query differs between Embree 3 and 4.
 *
 * Rust binds this header. It sees the same functions whatever is installed:
 * Embree 3 wants a context with every query, Embree 4 an argument structure
 * that may hold one, and their helpers are inline, so not callable from Rust.
 * CYLTRACE_EMBREE_MAJOR comes from build.rs. */
#ifndef CYLTRACE_SHIM_H
#define CYLTRACE_SHIM_H

#if CYLTRACE_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
typedef struct RTCRayQueryContext cyltrace_embree_context;
#else
#include <embree3/rtcore.h>
typedef struct RTCIntersectContext cyltrace_embree_context;
#endif

#include <stdbool.h>
#include <stdint.h>

/* What callbacks find behind args->context. Embree's own context comes first,
 * so a pointer to it is a pointer to the whole. */
struct cyltrace_context {
  cyltrace_embree_context embree;
  void *query;
  /* Whether `query` is that of a packet. The number of lanes does not tell:
   * Embree may take a packet apart, down to single rays. */
  bool is_packet;
};

/* The closest hit of one ray. Callbacks reach `query` through their context. */
void cyltrace_intersect1(RTCScene scene, struct RTCRayHit *rayhit, void *query);

/* Whether one ray hits anything: ray->tfar is minus infinity afterwards. */
void cyltrace_occluded1(RTCScene scene, struct RTCRay *ray, void *query);

/* The closest hits of a packet of `width` (4, 8 or 16) rays, which `rayhits`
 * points to as RTCRayHit4, 8 or 16, and `valid` as that many masks. `coherent`
 * tells Embree that the rays are alike. */
void cyltrace_intersect_packet(unsigned int width, const int *valid, RTCScene scene,
                               void *rayhits, void *query, bool coherent);

/* Which rays of a packet hit anything: their tfar is minus infinity afterwards.
 * `rays` points to RTCRay4, 8 or 16. */
void cyltrace_occluded_packet(unsigned int width, const int *valid, RTCScene scene,
                              void *rays, void *query, bool coherent);

/* Embree builds scenes with denormal numbers flushed to zero, callbacks
 * included. The first gives this thread the mode that Rust and C code expect,
 * the second that mode with denormal results and operands taken for zero; both
 * return the former mode, which the third restores. */
uint64_t cyltrace_enter_default_float_mode(void);
uint64_t cyltrace_enter_flushing_float_mode(void);
void cyltrace_restore_float_mode(uint64_t former);

#endif
