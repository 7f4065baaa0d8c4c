/*
 * cyltrace: exact ray tracing of cylinders and other analytic solids through Embree, and a
 * check of intersectors against proven bounds.
 *
 * `sh scripts/capi.sh PREFIX` builds the library and installs it with this header and a
 * pkg-config file. A program is compiled with
 *
 *     cc program.c $(pkg-config --cflags --libs cyltrace)
 *
 * Errors. A function that fails returns CYLTRACE_ERROR or NULL and leaves a message for
 * cyltrace_last_error. Unless stated otherwise, these are errors: a null pointer, an array
 * that is not aligned, a count of elements beyond the address space, and a setting beyond
 * its limit. A panic in the library becomes an error too and never crosses this interface.
 * (A panic in a callback of Embree ends the process.)
 *
 * Threads. Any number of threads may call any function at once, also with the same scene.
 * One thread frees a scene, after all calls with it have ended, and one thread at a time
 * uses an outcome. A thread that traces needs 64 kB of stack, and 64 kB more for each level
 * of nested placements.
 */
#ifndef CYLTRACE_H
#define CYLTRACE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- Version ------------------------------------------------------------ */

/*
 * The version of this header: major * 10000 + minor * 100 + patch. A program works with the
 * library of its version and with those of a later patch or minor version; before 1.0.0, a
 * later minor version may be incompatible. cyltrace_scene_load refuses all others.
 */
#define CYLTRACE_VERSION 100 /* 0.1.0 */

/* The version of the library, which is another one if it was replaced. */
uint32_t cyltrace_version(void);

/* --- Results of functions ----------------------------------------------- */

#define CYLTRACE_OK 0         /* success; cyltrace_check: no violations */
#define CYLTRACE_VIOLATIONS 1 /* cyltrace_check: violations, or too few hits judged */
#define CYLTRACE_ERROR 2      /* failure: see cyltrace_last_error */

/*
 * The message of the last call on this thread that failed, in UTF-8; NULL if none has
 * failed. It belongs to the library and lives until the next call that fails on this
 * thread.
 */
const char *cyltrace_last_error(void);

/* --- Scenes ------------------------------------------------------------- */

/* A scene that was loaded. */
struct cyltrace_scene;

/* The version and the sizes of structures that a program was compiled with. */
struct cyltrace_layout {
    uint32_t size;           /* of this structure */
    uint32_t version;        /* CYLTRACE_VERSION */
    uint32_t ray;            /* sizeof(struct cyltrace_ray) */
    uint32_t hit;            /* sizeof(struct cyltrace_hit) */
    uint32_t check_settings; /* sizeof(struct cyltrace_check_settings) */
    uint32_t check_outcome;  /* sizeof(struct cyltrace_check_outcome) */
};

/*
 * As cyltrace_scene_load below, for a program with the layout `program`, which is an error
 * if it is not the library's. Only other languages need to call this.
 */
struct cyltrace_scene *cyltrace_scene_load_checked(const char *path,
                                                   const struct cyltrace_layout *program);

/* Frees a scene. NULL is ignored. */
void cyltrace_scene_free(struct cyltrace_scene *scene);

/* --- Rays and hits ------------------------------------------------------ */

/*
 * The points origin + t * direction with t_min <= t <= t_max. The direction need not be a
 * unit vector: its largest component is between 2^-500 and 2^500 in size, and t is measured
 * in its length. t_min may be negative; both limits may be infinite. These rays are misses:
 * one with another direction, one whose origin is not finite or has a component above 2^200
 * in size, one with an empty range, and one that starts farther than 2^100 times the size of
 * the scene from the middle of the scene.
 */
struct cyltrace_ray {
    double origin[3];
    double direction[3];
    double t_min;
    double t_max;
};

/* Most placements inside each other. */
#define CYLTRACE_GREATEST_DEPTH 64

/* cyltrace_hit.valid_fields */
#define CYLTRACE_VALID_NORMAL 1u /* normal */
#define CYLTRACE_VALID_PLACE 2u  /* primitive, part, instance_count, instance */

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
#define CYLTRACE_SOLID_UNION 6u /* of these three, the part is that of the solid hit */
#define CYLTRACE_SOLID_INTERSECTION 7u
#define CYLTRACE_SOLID_DIFFERENCE 8u

/* cyltrace_hit.crossing */
#define CYLTRACE_ENTER 0u /* against the outward normal */
#define CYLTRACE_LEAVE 1u /* along it */

/*
 * A hit, or a miss: then is_hit is 0 and the other fields have no meaning.
 *
 * cyltrace_closest sets every field. A callback of cyltrace_check sets is_hit, t and
 * valid_fields; the fields named there are checked too.
 */
struct cyltrace_hit {
    double t;                /* the ray's parameter */
    double point[3];         /* in the world, moved onto the surface */
    double normal[3];        /* outward unit normal, in the world */
    double error;            /* the point is at most this far from the surface */
    double u;                /* angle around the axis over 2 pi, in [0, 1) */
    double v;                /* 0 at p0, 1 at p1 */
    uint32_t is_hit;         /* 1 or 0 */
    uint32_t valid_fields;   /* CYLTRACE_VALID_..., added up */
    uint32_t prototype;      /* 0 is the scene itself, then in the file's order */
    uint32_t primitive;      /* the solid's number in the prototype */
    uint32_t part;           /* CYLTRACE_SIDE, ... */
    uint32_t crossing;       /* CYLTRACE_ENTER, ... */
    uint32_t material;       /* 0 is the default one, then in the file's order */
    uint32_t instance_count; /* how many elements of `instance` are valid */
    uint32_t instance[CYLTRACE_GREATEST_DEPTH]; /* placements, outermost first */
    uint32_t solid;          /* CYLTRACE_SOLID_..., set by the library alone */
};

/*
 * The first hit of each of `count` rays, which is the one with the least t; if several have
 * it, the one with the least path of instances, then the least primitive. Runs on the calling
 * thread. Arrays may be NULL if count is 0.
 *
 * Arrays of 16 rays and more are traced in packets of 16 where the rays are coherent, which
 * is about twice as fast. So let neighbors in the array be neighbors in the picture: tiles of
 * 4 by 4 pixels are better than rows. The hits have the same bits either way. A call takes at
 * most 2 MB of memory besides the arrays.
 */
int cyltrace_closest(const struct cyltrace_scene *scene,
                     const struct cyltrace_ray *rays, size_t count,
                     struct cyltrace_hit *hits);

/* The fields of a hit that cyltrace_closest_with computes on request, added up */
#define CYLTRACE_FIELD_POINT 1u  /* point */
#define CYLTRACE_FIELD_NORMAL 2u /* normal */
#define CYLTRACE_FIELD_UV 4u     /* u and v */
#define CYLTRACE_FIELD_ERROR 8u  /* error */
#define CYLTRACE_FIELD_PATH 16u  /* instance_count and instance */
#define CYLTRACE_FIELD_ALL 31u   /* all of them, as cyltrace_closest does */

/*
 * As cyltrace_closest, but computes only the fields in `fields`, which is faster. They have
 * the same bits. Fields that were not requested are NaN, and instance_count and instance are
 * 0; valid_fields names only what was requested. Fields without a flag are always set. A flag
 * that does not exist is an error.
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
 * An intersector to be checked: writes the first hit of each of `count` rays with the scene.
 * All hits are misses when it is called; `count` may be 1.
 *
 * Several threads call it at once, unless `threads` is 1 in the settings: then one thread
 * calls it, which is not the caller's. No exception and no longjmp may leave it. `user` is
 * the pointer given to cyltrace_check.
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

/* What is checked. A field that is 0 or NULL has its default, which is stated last. */
struct cyltrace_check_settings {
    uint64_t rays;            /* per class, up to 10^9; 100 000 */
    uint64_t seed;            /* chooses the rays; 0 */
    uint64_t max_memory;      /* bytes for meshes; 4 GiB */
    uint64_t most_listed;     /* violations that are listed, up to 10^6; 20 */
    const uint32_t *segments; /* sides of the bounding meshes, 3 to 4096; 16 and 64 */
    size_t segment_count;     /* how many numbers of sides, up to 64 */
    uint32_t classes;         /* CYLTRACE_CAMERA, ...; all */
    uint32_t threads;         /* up to 1024; one for each of the machine's */
};

/* What a check found. */
struct cyltrace_check_outcome {
    uint64_t rays;             /* counted once for each row of the table */
    uint64_t violations;       /* wrong results, listed or not */
    uint64_t unwitnessed_rows; /* rows with fewer than half of their rays judged */
    char *text;                /* the table and violations, for people */
    char *json;                /* the same for programs, see below */
};

/*
 * Checks an intersector: compares its hits with the hits of meshes that are proven to lie
 * inside and outside of the solids. There is no tolerance: a hit that breaks the bounds is
 * wrong.
 *
 * Returns CYLTRACE_OK if every hit is within the bounds, CYLTRACE_VIOLATIONS if one is not or
 * too few could be judged, and CYLTRACE_ERROR if the check could not run, or if the
 * intersector returned an impossible part or instance_count. `settings` may be NULL: all
 * defaults. `outcome` is written in every case, with texts that are NULL after an error;
 * texts that it had before are not freed.
 *
 * The JSON has `holds`, `rays`, `violations`, `classes` (a list of objects with `name`,
 * `witness`, `segments`, `rays`, `violations`, `band_percent` and more), `convergence` and
 * `listed` (violations, each with its ray and what is wrong; an infinite number is null).
 * Keys are added, never renamed.
 */
int cyltrace_check(const struct cyltrace_scene *scene,
                   const struct cyltrace_check_settings *settings,
                   cyltrace_closest_function closest, void *user,
                   struct cyltrace_check_outcome *outcome);

/* Frees the texts of an outcome and sets them to NULL. NULL is ignored. */
void cyltrace_check_outcome_free(struct cyltrace_check_outcome *outcome);

/* --- Loading ------------------------------------------------------------ */

/*
 * Loads a scene file (docs/scene-file.md) and the tables that it names; NULL on failure, also
 * if this header is not the library's. The first ray builds what is traced.
 */
static inline struct cyltrace_scene *cyltrace_scene_load(const char *path) {
    struct cyltrace_layout program;
    program.size = (uint32_t)sizeof(struct cyltrace_layout);
    program.version = CYLTRACE_VERSION;
    program.ray = (uint32_t)sizeof(struct cyltrace_ray);
    program.hit = (uint32_t)sizeof(struct cyltrace_hit);
    program.check_settings = (uint32_t)sizeof(struct cyltrace_check_settings);
    program.check_outcome = (uint32_t)sizeof(struct cyltrace_check_outcome);
    return cyltrace_scene_load_checked(path, &program);
}

#ifdef __cplusplus
}
#endif

#endif /* CYLTRACE_H */
