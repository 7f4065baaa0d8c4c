/* Queries of Embree 3 and 4 behind one signature; see shim.h. */

#include "shim.h"

#if CYLTRACE_EMBREE_MAJOR >= 4

/* The context and the arguments that a query takes. */
#define PREPARE(Arguments, of_packet, is_coherent)                                      \
  struct cyltrace_context context;                                                     \
  struct RTC##Arguments arguments;                                                     \
  rtcInitRayQueryContext(&context.embree);                                             \
  rtcInit##Arguments(&arguments);                                                      \
  if (is_coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;                      \
  arguments.context = &context.embree;                                                 \
  context.query = query;                                                               \
  context.is_packet = of_packet
#define TRACE1(function, ray) function(scene, ray, &arguments)
#define TRACE(function, rays) function(valid, scene, rays, &arguments)

#else

/* The context that a query takes. */
#define PREPARE(Arguments, of_packet, is_coherent)                                      \
  struct cyltrace_context context;                                                     \
  rtcInitIntersectContext(&context.embree);                                            \
  if (is_coherent) context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;         \
  context.query = query;                                                               \
  context.is_packet = of_packet
#define TRACE1(function, ray) function(scene, &context.embree, ray)
#define TRACE(function, rays) function(valid, scene, &context.embree, rays)

#endif

void cyltrace_intersect1(RTCScene scene, struct RTCRayHit *rayhit, void *query) {
  PREPARE(IntersectArguments, false, false);
  TRACE1(rtcIntersect1, rayhit);
}

void cyltrace_occluded1(RTCScene scene, struct RTCRay *ray, void *query) {
  PREPARE(OccludedArguments, false, false);
  TRACE1(rtcOccluded1, ray);
}

void cyltrace_intersect_packet(unsigned int width, const int *valid, RTCScene scene,
                               void *rayhits, void *query, bool coherent) {
  PREPARE(IntersectArguments, true, coherent);
  switch (width) {
  case 4: TRACE(rtcIntersect4, rayhits); break;
  case 8: TRACE(rtcIntersect8, rayhits); break;
  case 16: TRACE(rtcIntersect16, rayhits); break;
  }
}

void cyltrace_occluded_packet(unsigned int width, const int *valid, RTCScene scene,
                              void *rays, void *query, bool coherent) {
  PREPARE(OccludedArguments, true, coherent);
  switch (width) {
  case 4: TRACE(rtcOccluded4, rays); break;
  case 8: TRACE(rtcOccluded8, rays); break;
  case 16: TRACE(rtcOccluded16, rays); break;
  }
}

#if defined(__x86_64__) || defined(_M_X64)

#include <immintrin.h>

/* Round to nearest, all exceptions masked, no flushing to zero. */
#define DEFAULT_MXCSR 0x1f80u
/* FTZ for results, DAZ for operands. */
#define FLUSHING_MXCSR (DEFAULT_MXCSR | 0x8000u | 0x0040u)

static uint64_t enter_float_mode(unsigned int mode) {
  const uint64_t former = _mm_getcsr();
  _mm_setcsr(mode);
  return former;
}

uint64_t cyltrace_enter_default_float_mode(void) { return enter_float_mode(DEFAULT_MXCSR); }

uint64_t cyltrace_enter_flushing_float_mode(void) { return enter_float_mode(FLUSHING_MXCSR); }

void cyltrace_restore_float_mode(uint64_t former) { _mm_setcsr((unsigned int)former); }

#elif defined(__aarch64__) && defined(__GNUC__)

/* FZ, for results and operands. */
#define FLUSHING_FPCR ((uint64_t)1 << 24)

static uint64_t enter_float_mode(uint64_t mode) {
  uint64_t former;
  __asm__ volatile("mrs %0, fpcr" : "=r"(former));
  __asm__ volatile("msr fpcr, %0" : : "r"(mode));
  return former;
}

uint64_t cyltrace_enter_default_float_mode(void) { return enter_float_mode(0); }

uint64_t cyltrace_enter_flushing_float_mode(void) { return enter_float_mode(FLUSHING_FPCR); }

void cyltrace_restore_float_mode(uint64_t former) {
  __asm__ volatile("msr fpcr, %0" : : "r"(former));
}

#else
#error "unsupported processor: its floating-point mode is unknown"
#endif
