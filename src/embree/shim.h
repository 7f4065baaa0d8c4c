/* Hides how queries differ between Embree 3 and 4.
 *
 * Rust binds this header, which declares the same functions for both versions.
 * Embree 3 takes a context with every query, Embree 4 an argument structure
 * with an optional context. Their helpers are inline, so Rust cannot call them.
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

/* What args->context points to in a callback. Embree's own context comes first,
 * so a pointer to it is a pointer to the whole. */
struct cyltrace_context {
  cyltrace_embree_context embree;
  void *query;
  /* Whether `query` is that of a packet. The number of lanes does not show it:
   * Embree may split a packet, down to single rays. */
  bool is_packet;
};

/* The closest hit of one ray. Callbacks reach `query` through their context. */
void cyltrace_intersect1(RTCScene scene, struct RTCRayHit *rayhit, void *query);

/* Whether one ray hits anything: ray->tfar is minus infinity afterwards. */
void cyltrace_occluded1(RTCScene scene, struct RTCRay *ray, void *query);

/* The closest hits of a packet of `width` (4, 8 or 16) rays, which `rayhits`
 * points to as RTCRayHit4, 8 or 16, with as many masks in `valid`. `coherent`
 * declares the rays coherent to Embree. */
void cyltrace_intersect_packet(unsigned int width, const int *valid, RTCScene scene,
                               void *rayhits, void *query, bool coherent);

/* Which rays of a packet hit anything: their tfar is minus infinity afterwards.
 * `rays` points to RTCRay4, 8 or 16. */
void cyltrace_occluded_packet(unsigned int width, const int *valid, RTCScene scene,
                              void *rays, void *query, bool coherent);

/* Embree builds scenes with denormal numbers flushed to zero, callbacks
 * included. The first function sets the mode that Rust and C code expect, the
 * second that mode with denormal results and operands replaced by zero, both for
 * this thread. Both return the former mode, which the third function restores. */
uint64_t cyltrace_enter_default_float_mode(void);
uint64_t cyltrace_enter_flushing_float_mode(void);
void cyltrace_restore_float_mode(uint64_t former);

#endif
