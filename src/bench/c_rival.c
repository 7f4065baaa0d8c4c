/* The tracer's callback written in C: what `bench traversal` holds the Rust one
 * against.
 *
 * It does the same work for a candidate: finds the query in the context, solves
 * in f64, compares, keeps the hit, and tells Embree. The solver is that of
 * src/solid/triple_product.rs and src/solid/slab.rs, for the first meeting only,
 * and gives the same bits; the derivation is there. With a = p1 - p0,
 * x = o - p0, n = a x d and m = a x x,
 *
 *   t = (-(m.n) -+ |a| sqrt(radius^2 |n|^2 - (x.n)^2)) / |n|^2
 *
 * where the products of n are exact if the sine between ray and axis is below
 * 1/4, and a root whose terms cancel is the constant term over the other sum. */

#include "c_rival.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* As the constants of src/solid/triple_product.rs. */
#define PARALLEL_BELOW 0x1p-700
#define LEAST_SQUARED_SINE 0x1p-4
#define LEAST_CONSTANT_TERM 0x1p-20

#define UNIT_ROUNDOFF 0x1p-53

enum part { SIDE, CAP0, CAP1 };
enum crossing { ENTER, LEAVE };

struct vector {
  double x, y, z;
};

struct line {
  struct vector origin, direction;
  double shift, t_min, t_max;
};

struct meeting {
  double t, t_local;
  enum part part;
  enum crossing crossing;
};

static inline struct vector vector_of(const double v[3]) {
  return (struct vector){v[0], v[1], v[2]};
}

static inline struct vector minus(struct vector a, struct vector b) {
  return (struct vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline double dot(struct vector a, struct vector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vector cross(struct vector a, struct vector b) {
  return (struct vector){a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}

/* The sum high + low, as src/math/double_double.rs has it. */
struct wide {
  double high, low;
};

static struct wide wide_sum(double a, double b) {
  const double high = a + b;
  const double b_seen = high - a;
  return (struct wide){high, (a - (high - b_seen)) + (b - b_seen)};
}

static struct wide split(double x) {
  const double scaled = 134217729.0 * x;
  const double high = scaled - (scaled - x);
  return (struct wide){high, x - high};
}

static struct wide wide_product(double a, double b) {
  const double high = a * b;
  const struct wide sa = split(a), sb = split(b);
  const double low =
      sa.low * sb.low - (((high - sa.high * sb.high) - sa.low * sb.high) - sa.high * sb.low);
  return (struct wide){high, low};
}

static struct wide wide_plus(struct wide a, struct wide b) {
  const struct wide sum = wide_sum(a.high, b.high);
  return wide_sum(sum.high, sum.low + (a.low + b.low));
}

static struct wide wide_minus(struct wide a, struct wide b) {
  return wide_plus(a, (struct wide){-b.high, -b.low});
}

static struct wide wide_times(struct wide a, struct wide b) {
  const struct wide product = wide_product(a.high, b.high);
  const double mixed = a.high * b.low + a.low * b.high;
  return wide_sum(product.high, product.low + mixed);
}

struct wide_vector {
  struct wide x, y, z;
};

static struct wide_vector wide_cross(struct vector a, struct vector b) {
  return (struct wide_vector){
      wide_minus(wide_product(a.y, b.z), wide_product(a.z, b.y)),
      wide_minus(wide_product(a.z, b.x), wide_product(a.x, b.z)),
      wide_minus(wide_product(a.x, b.y), wide_product(a.y, b.x)),
  };
}

static struct wide wide_square(struct wide_vector v) {
  return wide_plus(wide_plus(wide_times(v.x, v.x), wide_times(v.y, v.y)), wide_times(v.z, v.z));
}

__attribute__((cold, noinline)) static struct vector exact_cross(struct vector a, struct vector b) {
  const struct wide_vector exact = wide_cross(a, b);
  return (struct vector){exact.x.high, exact.y.high, exact.z.high};
}

__attribute__((cold, noinline)) static double exact_constant_term(struct vector a, struct vector x,
                                                                  double radius) {
  const struct wide_vector axis = {
      wide_product(a.x, 1.0), wide_product(a.y, 1.0), wide_product(a.z, 1.0)};
  const struct wide mm = wide_square(wide_cross(a, x));
  return wide_minus(mm, wide_times(wide_product(radius, radius), wide_square(axis))).high;
}

static inline double constant_term(struct vector a, struct vector x, struct vector m,
                                   double radius) {
  const double least = radius * radius * dot(a, a);
  const double c = dot(m, m) - least;
  return fabs(c) < LEAST_CONSTANT_TERM * least ? exact_constant_term(a, x, radius) : c;
}

/* An end of a chord. */
struct end {
  double t;
  enum part part;
  bool on_rim;
};

static inline bool exists(enum part part, uint32_t caps) {
  return part == SIDE || (caps & (part == CAP0 ? 1u : 2u)) != 0;
}

/* The end as a meeting, if the surface is there and it is in range. */
static inline bool meets(struct end end, enum crossing crossing, uint32_t caps,
                         const struct line *line, struct meeting *meeting) {
  const bool is_there = exists(end.part, caps);
  if (!is_there && !end.on_rim) return false;
  const double t = end.t + line->shift;
  if (!(line->t_min <= t && t <= line->t_max)) return false;
  *meeting = (struct meeting){t, end.t, is_there ? end.part : SIDE, crossing};
  return true;
}

/* The first meeting of a chord of which both ends are known, and which may run
 * within a part. */
static bool meets_known(struct end enter, struct end leave, const enum part *lies_on, uint32_t caps,
                        const struct line *line, struct meeting *meeting) {
  const double local = line->t_min - line->shift;
  if (lies_on && exists(*lies_on, caps) && enter.t < local && local <= leave.t &&
      line->t_min <= line->t_max) {
    *meeting = (struct meeting){line->t_min, local, *lies_on, ENTER};
    return true;
  }
  return meets(enter, ENTER, caps, line, meeting) || meets(leave, LEAVE, caps, line, meeting);
}

/* A line along the axis. */
__attribute__((cold, noinline)) static bool along(double constant, double height, double position,
                                                  double slope, uint32_t caps,
                                                  const struct line *line,
                                                  struct meeting *meeting) {
  if (!(constant <= 0.0) || slope == 0.0) return false;
  const bool on_wall = constant == 0.0;
  const enum part wall = SIDE;
  const struct end cap0 = {-position / slope, CAP0, on_wall};
  const struct end cap1 = {(height - position) / slope, CAP1, on_wall};
  const bool is_upward = slope > 0.0;
  return meets_known(is_upward ? cap0 : cap1, is_upward ? cap1 : cap0, on_wall ? &wall : NULL, caps,
                     line, meeting);
}

/* The first point of the line on the surface of the cylinder. */
static inline bool first(const struct cyltrace_c_cylinder *cylinder, struct vector x,
                         const struct line *line, struct meeting *meeting) {
  const struct vector d = line->direction;
  const struct vector a = minus(vector_of(cylinder->p1), vector_of(cylinder->p0));
  const double radius = cylinder->radius;
  const double aa = dot(a, a);
  struct vector n = cross(a, d);
  double nn = dot(n, n);
  if (nn < LEAST_SQUARED_SINE * (aa * dot(d, d))) {
    n = exact_cross(a, d);
    nn = dot(n, n);
  }
  const double w = dot(x, n);
  const double discriminant = radius * radius * nn - w * w;
  const double height = aa, position = dot(x, a), slope = dot(d, a);
  if (nn < PARALLEL_BELOW)
    return along(constant_term(a, x, cross(a, x), radius), height, position, slope, cylinder->caps,
                 line, meeting);
  if (!(discriminant >= 0.0)) return false;

  const struct vector m = cross(a, x);
  const double mn = dot(m, n);
  const double s = sqrt(aa) * sqrt(discriminant);
  const double first_sum = -mn - s, second_sum = s - mn;
#define ROOT(sum, other)                                                       \
  (fabs(sum) < 0.5 * fabs(mn) ? constant_term(a, x, m, radius) / (other) : (sum) / nn)

  const double t0 = ROOT(first_sum, second_sum);
  if (slope == 0.0) {
    if (!(0.0 <= position && position <= height)) return false;
    const enum part part = position == 0.0 ? CAP0 : position == height ? CAP1 : SIDE;
    const struct end enter = {t0, part, part != SIDE};
    const struct end leave = {ROOT(second_sum, first_sum), part, part != SIDE};
    return meets_known(enter, leave, part != SIDE ? &part : NULL, cylinder->caps, line, meeting);
  }
  const double sign = copysign(1.0, slope), half = -0.5 * height;
  const double near = (sign - 1.0) * half, far = (-1.0 - sign) * half;
  const enum part near_part = sign > 0.0 ? CAP0 : CAP1, far_part = sign > 0.0 ? CAP1 : CAP0;
#define BEYOND_NEAR(t) (near + sign * (position + (t) * slope))

  struct end enter;
  const double entry = BEYOND_NEAR(t0);
  if (entry > 0.0) {
    if (!(entry <= height)) return false;
    enter = (struct end){t0, entry < height ? SIDE : far_part, entry == height};
  } else {
    if (!(BEYOND_NEAR(ROOT(second_sum, first_sum)) >= 0.0)) return false;
    enter = (struct end){(near - position) / slope, near_part, entry == 0.0};
  }
  if (meets(enter, ENTER, cylinder->caps, line, meeting)) return true;

  const double t1 = ROOT(second_sum, first_sum);
  const double exit = BEYOND_NEAR(t1);
  struct end leave;
  if (exit < height)
    leave = (struct end){t1, exit == 0.0 ? near_part : SIDE, exit == 0.0};
  else
    leave = (struct end){(far - position) / slope, far_part, exit == height};
  if (leave.t < enter.t) leave.t = enter.t;
  return meets(leave, LEAVE, cylinder->caps, line, meeting);
#undef ROOT
#undef BEYOND_NEAR
}

static inline const struct cyltrace_c_cylinder *cylinder_of(const void *geometry, unsigned int number) {
  return &((const struct cyltrace_c_geometry *)geometry)->cylinders[number];
}

void cyltrace_c_bounds(const struct RTCBoundsFunctionArguments *args) {
  *args->bounds_o = ((const struct cyltrace_c_geometry *)args->geometryUserPtr)->boxes[args->primID];
}

static inline struct cyltrace_c_query *query_of(void *context) {
  return ((struct cyltrace_context *)context)->query;
}

static inline bool meets_query(const struct cyltrace_c_cylinder *cylinder,
                               const struct cyltrace_c_query *query, struct meeting *meeting) {
  const struct line line = {vector_of(query->origin), vector_of(query->direction), query->shift,
                            query->t_min, query->bound};
  const struct vector from_base = minus(vector_of(cylinder->p0), vector_of(query->base));
  return first(cylinder, minus(line.origin, from_base), &line, meeting);
}

/* Embree's t for the query's bound; never too small. */
static inline float t_far(const struct cyltrace_c_query *query) {
  const double t = query->bound;
  const double difference = (t - query->shift) - query->nearest;
  const double slack =
      4.0 * UNIT_ROUNDOFF * (fabs(t) + fabs(query->shift) + fabs(query->nearest));
  const double end = isfinite(difference) ? difference + slack : difference;
  const double length = (end - query->start) * query->rate + 0x1p-30;
  const float nearest = (float)length;
  return (double)nearest < length ? nextafterf(nearest, INFINITY) : nearest;
}

/* Accepts a hit at Embree's parameter `t`. */
static inline void accept(const struct RTCIntersectFunctionNArguments *args, float t) {
  struct RTCRayHit *rayhit = (struct RTCRayHit *)args->rayhit;
  struct RTCHit *hit = &rayhit->hit;
  if (t < rayhit->ray.tfar) rayhit->ray.tfar = t;
  hit->Ng_x = hit->Ng_y = hit->Ng_z = hit->u = hit->v = 0.0f;
  hit->primID = args->primID;
  hit->geomID = args->geomID;
  for (size_t level = 0; level < sizeof hit->instID / sizeof hit->instID[0]; ++level)
    hit->instID[level] = args->context->instID[level];
}

void cyltrace_c_intersect(const struct RTCIntersectFunctionNArguments *args) {
  const struct cyltrace_c_cylinder *cylinder = cylinder_of(args->geometryUserPtr, args->primID);
  struct cyltrace_c_query *query = query_of(args->context);
  const double before = query->bound;
  struct meeting meeting;
  if (meets_query(cylinder, query, &meeting) &&
      (meeting.t < query->bound || cylinder->primitive < query->primitive)) {
    query->bound = meeting.t;
    query->t_local = meeting.t_local;
    query->primitive = cylinder->primitive;
    query->part = meeting.part;
    query->crossing = meeting.crossing;
  }
  const bool is_shorter = query->bound < before;
  args->valid[0] = is_shorter ? -1 : 0;
  if (is_shorter) accept(args, t_far(query));
}

void cyltrace_c_occluded(const struct RTCOccludedFunctionNArguments *args) {
  const struct cyltrace_c_cylinder *cylinder = cylinder_of(args->geometryUserPtr, args->primID);
  struct meeting meeting;
  const bool hit = meets_query(cylinder, query_of(args->context), &meeting);
  args->valid[0] = hit ? -1 : 0;
  if (hit) ((struct RTCRay *)args->ray)->tfar = -INFINITY;
}

static inline bool meets_ray(const struct cyltrace_c_cylinder *cylinder, const struct RTCRay *ray,
                             struct meeting *meeting) {
  const struct line line = {{ray->org_x, ray->org_y, ray->org_z},
                            {ray->dir_x, ray->dir_y, ray->dir_z},
                            0.0,
                            ray->tnear,
                            ray->tfar};
  return first(cylinder, minus(line.origin, vector_of(cylinder->p0)), &line, meeting);
}

void cyltrace_c_intersect_narrow(const struct RTCIntersectFunctionNArguments *args) {
  const struct cyltrace_c_cylinder *cylinder = cylinder_of(args->geometryUserPtr, args->primID);
  const struct RTCRayHit *rayhit = (const struct RTCRayHit *)args->rayhit;
  struct meeting meeting;
  const bool hit = meets_ray(cylinder, &rayhit->ray, &meeting);
  args->valid[0] = hit ? -1 : 0;
  if (hit) accept(args, (float)meeting.t);
}

void cyltrace_c_occluded_narrow(const struct RTCOccludedFunctionNArguments *args) {
  const struct cyltrace_c_cylinder *cylinder = cylinder_of(args->geometryUserPtr, args->primID);
  struct RTCRay *ray = (struct RTCRay *)args->ray;
  struct meeting meeting;
  const bool hit = meets_ray(cylinder, ray, &meeting);
  args->valid[0] = hit ? -1 : 0;
  if (hit) ray->tfar = -INFINITY;
}
