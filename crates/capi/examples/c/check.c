/*
 * Checks a renderer's own intersector: here the textbook one, in float, for the
 * two cylinders of scene.toml beside this file.
 *
 *     check SCENE [FACTOR]
 *
 * FACTOR multiplies the radii, to show the report of a wrong renderer. Exits with 0
 * if the check passes, 1 if it finds violations, 2 if it could not run. Float
 * fails: its t is off by more than the bounds allow. Compiled with -DREAL=double
 * the same code passes.
 */
#include "cyltrace.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#ifndef REAL
#define REAL float
#endif
typedef REAL real;

struct cylinder {
    real p0[3], p1[3], radius;
};

static const struct cylinder CYLINDERS[2] = {
    {{0, 0, 0}, {0, 0, 2}, (real)0.5},
    {{-2, 1, (real)0.5}, {(real)1.5, -1, 1}, (real)0.25},
};

static real dot(const real *a, const real *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The interval of t in which a line is inside the solid; 0 if in none. */
static int inside(const struct cylinder *c, real factor, const real *origin,
                  const real *direction, real *enter, real *leave) {
    real axis[3], from[3], across_from[3], across[3];
    for (int i = 0; i < 3; i++) {
        axis[i] = c->p1[i] - c->p0[i];
        from[i] = origin[i] - c->p0[i];
    }
    const real length = (real)sqrt(dot(axis, axis));
    for (int i = 0; i < 3; i++) axis[i] /= length;
    const real height = dot(from, axis), rate = dot(direction, axis);
    for (int i = 0; i < 3; i++) {
        across_from[i] = from[i] - height * axis[i];
        across[i] = direction[i] - rate * axis[i];
    }

    /* The wall: a t^2 + 2 b t + c = 0. */
    const real radius = c->radius * factor;
    const real qa = dot(across, across), qb = dot(across, across_from);
    const real qc = dot(across_from, across_from) - radius * radius;
    *enter = -(real)INFINITY;
    *leave = (real)INFINITY;
    if (qa > 0) {
        const real discriminant = qb * qb - qa * qc;
        if (discriminant < 0) return 0;
        *enter = (-qb - (real)sqrt(discriminant)) / qa;
        *leave = (-qb + (real)sqrt(discriminant)) / qa;
    } else if (qc > 0) {
        return 0;
    }

    /* The disks. */
    if (rate != 0) {
        const real at0 = -height / rate, at1 = (length - height) / rate;
        const real first = at0 < at1 ? at0 : at1, last = at0 < at1 ? at1 : at0;
        if (first > *enter) *enter = first;
        if (last < *leave) *leave = last;
    } else if (height < 0 || height > length) {
        return 0;
    }
    return *enter <= *leave;
}

/* The intersector: it returns only t. `user` is the factor on radii. */
static void closest(void *user, const struct cyltrace_ray *rays, size_t count,
                    struct cyltrace_hit *hits) {
    const real factor = (real) * (const double *)user;
    for (size_t number = 0; number < count; number++) {
        const struct cyltrace_ray *ray = &rays[number];
        struct cyltrace_hit *hit = &hits[number];
        real origin[3], direction[3];
        for (int i = 0; i < 3; i++) {
            origin[i] = (real)ray->origin[i];
            direction[i] = (real)ray->direction[i];
        }
        for (int c = 0; c < 2; c++) {
            real enter, leave;
            if (!inside(&CYLINDERS[c], factor, origin, direction, &enter, &leave))
                continue;
            const double t = enter >= ray->t_min ? enter : leave;
            if (t < ray->t_min || t > ray->t_max) continue;
            if (!hit->is_hit || t < hit->t) {
                hit->is_hit = 1;
                hit->t = t;
            }
        }
    }
}

int main(int count, char **arguments) {
    if (count < 2) {
        fprintf(stderr, "usage: %s SCENE [FACTOR]\n", arguments[0]);
        return CYLTRACE_ERROR;
    }
    double factor = count > 2 ? atof(arguments[2]) : 1.0;
    struct cyltrace_scene *scene = cyltrace_scene_load(arguments[1]);
    if (!scene) {
        fprintf(stderr, "%s\n", cyltrace_last_error());
        return CYLTRACE_ERROR;
    }

    struct cyltrace_check_settings settings = {0};
    settings.rays = 20000;
    struct cyltrace_check_outcome outcome;
    int code = cyltrace_check(scene, &settings, closest, &factor, &outcome);
    if (code == CYLTRACE_ERROR)
        fprintf(stderr, "%s\n", cyltrace_last_error());
    else
        printf("%s%s\n", outcome.text, code == CYLTRACE_OK ? "it passes" : "it fails");
    cyltrace_check_outcome_free(&outcome);
    cyltrace_scene_free(scene);
    return code;
}
