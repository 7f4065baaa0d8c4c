/* What the callbacks of c_rival.c share with Rust. Rust binds this header. */
#ifndef CYLTRACE_C_RIVAL_H
#define CYLTRACE_C_RIVAL_H

#include "../embree/shim.h"

/* A cylinder in one cache line, as the tracer's own record is. `caps` has bit 0
 * for the disk at p0 and bit 1 for that at p1. */
struct cyltrace_c_cylinder {
  _Alignas(64) double p0[3];
  double p1[3];
  double radius;
  uint32_t primitive;
  uint32_t caps;
};

/* What the data pointer of a geometry points to: as many boxes as cylinders. */
struct cyltrace_c_geometry {
  const struct cyltrace_c_cylinder *cylinders;
  const struct RTCBounds *boxes;
};

/* A query on its way: the f64 ray, how its t becomes Embree's, and the first
 * hit so far. */
struct cyltrace_c_query {
  /* Points are base + origin + (t - shift) * direction. */
  double origin[3];
  double direction[3];
  double base[3];
  double shift;
  double t_min;
  /* The greatest t that counts: t_max, and that of the hit once there is one. */
  double bound;
  /* Embree's t is (t - shift - nearest - start) * rate. */
  double nearest;
  double start;
  double rate;
  /* The hit; `primitive` is UINT32_MAX while there is none. */
  double t_local;
  uint32_t primitive;
  uint32_t part;
  uint32_t crossing;
};

void cyltrace_c_bounds(const struct RTCBoundsFunctionArguments *args);

/* Callbacks that take the f64 ray of a query from the context. */
void cyltrace_c_intersect(const struct RTCIntersectFunctionNArguments *args);
void cyltrace_c_occluded(const struct RTCOccludedFunctionNArguments *args);

/* Callbacks that take Embree's own f32 ray: below Embree's instances there is
 * no other. */
void cyltrace_c_intersect_narrow(const struct RTCIntersectFunctionNArguments *args);
void cyltrace_c_occluded_narrow(const struct RTCOccludedFunctionNArguments *args);

#endif
