/* Queries of Embree 3 and 4 behind one signature; see shim.h. */

#include "shim.h"

#if CYLTRACE_EMBREE_MAJOR >= 4

void cyltrace_intersect1(RTCScene scene, struct RTCRayHit *rayhit, void *query) {
  struct cyltrace_context context;
  struct RTCIntersectArguments arguments;
  rtcInitRayQueryContext(&context.embree);
  context.query = query;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context.embree;
  rtcIntersect1(scene, rayhit, &arguments);
}

void cyltrace_occluded1(RTCScene scene, struct RTCRay *ray, void *query) {
  struct cyltrace_context context;
  struct RTCOccludedArguments arguments;
  rtcInitRayQueryContext(&context.embree);
  context.query = query;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context.embree;
  rtcOccluded1(scene, ray, &arguments);
}

#else

void cyltrace_intersect1(RTCScene scene, struct RTCRayHit *rayhit, void *query) {
  struct cyltrace_context context;
  rtcInitIntersectContext(&context.embree);
  context.query = query;
  rtcIntersect1(scene, &context.embree, rayhit);
}

void cyltrace_occluded1(RTCScene scene, struct RTCRay *ray, void *query) {
  struct cyltrace_context context;
  rtcInitIntersectContext(&context.embree);
  context.query = query;
  rtcOccluded1(scene, &context.embree, ray);
}

#endif

#if defined(__x86_64__) || defined(_M_X64)

#include <immintrin.h>

/* Round to nearest, all exceptions masked, no flushing to zero. */
#define DEFAULT_MXCSR 0x1f80u
/* FTZ, which is of results, and DAZ, which is of operands. */
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

/* FZ, which is of results and operands. */
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
#error "the floating-point mode of this processor is not known here"
#endif
