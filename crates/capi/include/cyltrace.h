/*
 * cyltrace: analytic cylinders traced through Embree, and a check of
 * intersectors against proven bounds.
 *
 * The library:
 *
 *     cargo rustc --release --lib --crate-type cdylib
 *     cc -I include program.c -L target/release -lcyltrace
 *
 * Errors. A function that can fail answers CYLTRACE_ERROR or NULL and leaves a
 * message for cyltrace_last_error. A null pointer is refused with such a message
 * wherever nothing else is said; so is an array that is not aligned, a count of elements
 * that exceeds the address space, a setting beyond its limit, and a panic within the library, which does not
 * cross this interface. (A panic in a callback of Embree's ends the process.)
 *
 * Threads. All functions may be called from any number of threads at once,
 * also with the same scene; but a scene is freed once, by one thread, after all
 * calls with it have ended, and an outcome belongs to one thread at a time. A
 * thread that traces needs 64 kB of stack, and as much again for each level of
 * nested placements.
 */
#ifndef CYLTRACE_H
#define CYLTRACE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What functions answer. */
#define CYLTRACE_OK 0         /* done; for cyltrace_check: it holds */
#define CYLTRACE_VIOLATIONS 1 /* cyltrace_check: it does not hold */
#define CYLTRACE_ERROR 2      /* it could not run: see cyltrace_last_error */

/*
 * The message of the last call on this thread that failed, in UTF-8; NULL if
 * none has. It is the library's own and lives until the next call that fails on
 * this thread.
 */
const char *cyltrace_last_error(void);

/* --- Scenes ------------------------------------------------------------- */

/* A scene that was loaded. */
struct cyltrace_scene;

/*
 * Loads a scene file (docs/scene-file.md) and the tables that it names; NULL on
 * failure. What is traced is built when the first ray is.
 */
struct cyltrace_scene *cyltrace_scene_load(const char *path);

/* Frees a scene. NULL is ignored. */
void cyltrace_scene_free(struct cyltrace_scene *scene);

/* --- Rays and hits ------------------------------------------------------ */

/*
 * The points origin + t * direction with t_min <= t <= t_max. The direction has
 * any length whose largest component is between 2^-500 and 2^500 in size, and t
 * counts in that length; t_min may be negative, both limits may be infinite. A ray
 * with another direction, with an origin that is not finite or has a component above
 * 2^200 in size, or with an empty range is a miss; so is one that starts farther
 * than 2^100 times the size of the scene from the scene's middle.
 */
struct cyltrace_ray {
    double origin[3];
    double direction[3];
    double t_min;
    double t_max;
};

/* Most placements inside each other. */
#define CYLTRACE_GREATEST_DEPTH 64

/* cyltrace_hit.tells */
#define CYLTRACE_TELLS_NORMAL 1u /* normal */
#define CYLTRACE_TELLS_PLACE 2u  /* primitive, part, instance_count, instance */

/* cyltrace_hit.part */
#define CYLTRACE_SIDE 0u  /* the curved wall; all of a sphere or a disk */
#define CYLTRACE_CAP0 1u  /* the disk at p0, its rim included; a rounded cone's sphere */
#define CYLTRACE_CAP1 2u  /* the disk at p1, its rim included; a rounded cone's sphere */
#define CYLTRACE_X_MIN 3u /* the face of a cuboid where its own x is least */
#define CYLTRACE_X_MAX 4u /* where x is greatest */
#define CYLTRACE_Y_MIN 5u /* where y is least */
#define CYLTRACE_Y_MAX 6u /* where y is greatest */
#define CYLTRACE_Z_MIN 7u /* where z is least */
#define CYLTRACE_Z_MAX 8u /* where z is greatest */

/* cyltrace_hit.solid */
#define CYLTRACE_SOLID_CYLINDER 0u
#define CYLTRACE_SOLID_CONE 1u
#define CYLTRACE_SOLID_ROUNDED_CONE 2u
#define CYLTRACE_SOLID_SPHERE 3u
#define CYLTRACE_SOLID_CUBOID 4u
#define CYLTRACE_SOLID_DISK 5u
#define CYLTRACE_SOLID_UNION 6u /* of these three, the part is that of the solid met */
#define CYLTRACE_SOLID_INTERSECTION 7u
#define CYLTRACE_SOLID_DIFFERENCE 8u

/* cyltrace_hit.crossing */
#define CYLTRACE_ENTER 0u /* against the outward normal */
#define CYLTRACE_LEAVE 1u /* along it */

/*
 * A hit, or a miss: then is_hit is 0 and nothing else counts.
 *
 * cyltrace_closest fills in every field. A callback of cyltrace_check sets is_hit and
 * t, and says with `tells` what else it has set; that is then checked too.
 */
struct cyltrace_hit {
    double t;                /* the ray's parameter */
    double point[3];         /* in the world, put onto the surface */
    double normal[3];        /* outward unit normal, in the world */
    double error;            /* the point is at most this far from the surface */
    double u;                /* angle around the axis over 2 pi, in [0, 1) */
    double v;                /* 0 at p0, 1 at p1 */
    uint32_t is_hit;         /* 1 or 0 */
    uint32_t tells;          /* CYLTRACE_TELLS_... */
    uint32_t prototype;      /* 0 is the scene itself, then in the file's order */
    uint32_t primitive;      /* the solid's number in the prototype */
    uint32_t part;           /* CYLTRACE_SIDE, ... */
    uint32_t crossing;       /* CYLTRACE_ENTER, ... */
    uint32_t material;       /* 0 is the default one, then in the file's order */
    uint32_t instance_count; /* how many of `instance` count */
    uint32_t instance[CYLTRACE_GREATEST_DEPTH]; /* placements, outermost first */
    uint32_t solid;          /* CYLTRACE_SOLID_..., filled in by the library */
};

/*
 * The first hit of each of `count` rays: that of the least t; of several, that
 * of the least path of instances, then of the least primitive. Runs on the
 * calling thread. Arrays may be NULL when count is 0.
 */
int cyltrace_closest(const struct cyltrace_scene *scene,
                     const struct cyltrace_ray *rays, size_t count,
                     struct cyltrace_hit *hits);

/* The fields of a hit that cyltrace_closest_with works out, added up */
#define CYLTRACE_FIELD_POINT 1u  /* point */
#define CYLTRACE_FIELD_NORMAL 2u /* normal */
#define CYLTRACE_FIELD_UV 4u     /* u and v */
#define CYLTRACE_FIELD_ERROR 8u  /* error */
#define CYLTRACE_FIELD_PATH 16u  /* instance_count and instance */
#define CYLTRACE_FIELD_ALL 31u   /* all of them, as cyltrace_closest does */

/*
 * As cyltrace_closest, but works out only the fields that are in `fields`, which is
 * faster. They have the same bits as cyltrace_closest returns. The others are NaN,
 * and instance_count and instance are 0; `tells` has only what is there. All fields
 * that have no flag are always there. Refuses a flag that does not exist.
 */
int cyltrace_closest_with(const struct cyltrace_scene *scene,
                          const struct cyltrace_ray *rays, size_t count,
                          uint32_t fields, struct cyltrace_hit *hits);

/* Whether each of `count` rays hits anything: 1 or 0. */
int cyltrace_occluded(const struct cyltrace_scene *scene,
                      const struct cyltrace_ray *rays, size_t count,
                      uint8_t *occluded);

/* --- The check of an intersector ---------------------------------------- */

/*
 * An intersector to be checked: writes the first hit of each of `count` rays
 * with the scene. All hits are misses when it is called; `count` may be 1.
 *
 * It is called from several threads at once unless threads is 1 in the settings;
 * then it is called from one thread, which is not the caller's. It must return:
 * no exception and no longjmp may leave it. `user` is what cyltrace_check was
 * given, and is not looked at.
 */
typedef void (*cyltrace_closest_function)(void *user,
                                          const struct cyltrace_ray *rays,
                                          size_t count,
                                          struct cyltrace_hit *hits);

/* cyltrace_check_settings.classes, added up */
#define CYLTRACE_CAMERA 1u  /* from the scene's camera through its picture */
#define CYLTRACE_SPHERE 2u  /* from around the scene to points of its solids */
#define CYLTRACE_INSIDE 4u  /* from inside solids */
#define CYLTRACE_GRAZING 8u /* aimed at silhouettes and rims */
#define CYLTRACE_AXIAL 16u  /* parallel to an axis, or nearly so */

/* How much is checked. Zero or NULL in a field stands for its default. */
struct cyltrace_check_settings {
    uint64_t rays;            /* of each class, up to 10^9; 100 000 */
    uint64_t seed;            /* chooses the rays; 0 */
    uint64_t max_memory;      /* bytes that meshes may take; 4 GiB */
    uint64_t most_listed;     /* violations that are listed, up to 10^6; 20 */
    const uint32_t *segments; /* sides of the prisms, 3 to 4096; 16 and 64 */
    size_t segment_count;     /* how many numbers of sides, up to 64 */
    uint32_t classes;         /* CYLTRACE_CAMERA, ...; all */
    uint32_t threads;         /* up to 1024; as many as the machine has */
};

/* What a check found. */
struct cyltrace_check_outcome {
    uint64_t rays;             /* counted once for each row of the table */
    uint64_t violations;       /* wrong answers, all of them */
    uint64_t unwitnessed_rows; /* rows with less than half of the rays judged */
    char *text;                /* the table and violations, for people */
    char *json;                /* the same for programs, see below */
};

/*
 * Checks an intersector: its answers are held against what rays meet of prisms
 * that are proven to lie inside and outside of the cylinders. So there is no
 * tolerance: an answer that breaks the bounds is wrong.
 *
 * CYLTRACE_OK if every answer holds, CYLTRACE_VIOLATIONS if one does not or too
 * few could be judged, CYLTRACE_ERROR if the check could not run, also where the
 * intersector told a part or instance_count that cannot be. `settings` may be
 * NULL: all defaults. `outcome` is written in every case, its texts NULL after
 * an error; what it held before is not freed.
 *
 * The JSON has `holds`, `rays`, `violations`, `classes` (a list of objects with
 * `name`, `witness`, `segments`, `rays`, `violations`, `band_percent` and more),
 * `convergence` and `listed` (violations, each with its ray and what is wrong;
 * an infinite number is null). Keys are added, never renamed.
 */
int cyltrace_check(const struct cyltrace_scene *scene,
                   const struct cyltrace_check_settings *settings,
                   cyltrace_closest_function closest, void *user,
                   struct cyltrace_check_outcome *outcome);

/* Frees the texts of an outcome and sets them to NULL. NULL is ignored. */
void cyltrace_check_outcome_free(struct cyltrace_check_outcome *outcome);

#ifdef __cplusplus
}
#endif

#endif /* CYLTRACE_H */
