/* Prints what a C compiler makes of cyltrace.h, a name and a number a line. */
#include "cyltrace.h"

#include <stdio.h>

#define SIZE(type) printf(#type " %lu\n", (unsigned long)sizeof(struct type))
#define FIELD(type, field) \
    printf(#type "." #field " %lu\n", (unsigned long)offsetof(struct type, field))
#define CONSTANT(name) printf(#name " %lu\n", (unsigned long)(name))

int main(void) {
    SIZE(cyltrace_ray);
    FIELD(cyltrace_ray, origin);
    FIELD(cyltrace_ray, direction);
    FIELD(cyltrace_ray, t_min);
    FIELD(cyltrace_ray, t_max);

    SIZE(cyltrace_hit);
    FIELD(cyltrace_hit, t);
    FIELD(cyltrace_hit, point);
    FIELD(cyltrace_hit, normal);
    FIELD(cyltrace_hit, error);
    FIELD(cyltrace_hit, u);
    FIELD(cyltrace_hit, v);
    FIELD(cyltrace_hit, is_hit);
    FIELD(cyltrace_hit, tells);
    FIELD(cyltrace_hit, prototype);
    FIELD(cyltrace_hit, primitive);
    FIELD(cyltrace_hit, part);
    FIELD(cyltrace_hit, crossing);
    FIELD(cyltrace_hit, material);
    FIELD(cyltrace_hit, instance_count);
    FIELD(cyltrace_hit, instance);
    FIELD(cyltrace_hit, solid);

    SIZE(cyltrace_check_settings);
    FIELD(cyltrace_check_settings, rays);
    FIELD(cyltrace_check_settings, seed);
    FIELD(cyltrace_check_settings, max_memory);
    FIELD(cyltrace_check_settings, most_listed);
    FIELD(cyltrace_check_settings, segments);
    FIELD(cyltrace_check_settings, segment_count);
    FIELD(cyltrace_check_settings, classes);
    FIELD(cyltrace_check_settings, threads);

    SIZE(cyltrace_check_outcome);
    FIELD(cyltrace_check_outcome, rays);
    FIELD(cyltrace_check_outcome, violations);
    FIELD(cyltrace_check_outcome, unwitnessed_rows);
    FIELD(cyltrace_check_outcome, text);
    FIELD(cyltrace_check_outcome, json);

    CONSTANT(CYLTRACE_OK);
    CONSTANT(CYLTRACE_VIOLATIONS);
    CONSTANT(CYLTRACE_ERROR);
    CONSTANT(CYLTRACE_GREATEST_DEPTH);
    CONSTANT(CYLTRACE_TELLS_NORMAL);
    CONSTANT(CYLTRACE_TELLS_PLACE);
    CONSTANT(CYLTRACE_FIELD_POINT);
    CONSTANT(CYLTRACE_FIELD_NORMAL);
    CONSTANT(CYLTRACE_FIELD_UV);
    CONSTANT(CYLTRACE_FIELD_ERROR);
    CONSTANT(CYLTRACE_FIELD_PATH);
    CONSTANT(CYLTRACE_FIELD_ALL);
    CONSTANT(CYLTRACE_SIDE);
    CONSTANT(CYLTRACE_CAP0);
    CONSTANT(CYLTRACE_CAP1);
    CONSTANT(CYLTRACE_X_MIN);
    CONSTANT(CYLTRACE_X_MAX);
    CONSTANT(CYLTRACE_Y_MIN);
    CONSTANT(CYLTRACE_Y_MAX);
    CONSTANT(CYLTRACE_Z_MIN);
    CONSTANT(CYLTRACE_Z_MAX);
    CONSTANT(CYLTRACE_SOLID_CYLINDER);
    CONSTANT(CYLTRACE_SOLID_CONE);
    CONSTANT(CYLTRACE_SOLID_ROUNDED_CONE);
    CONSTANT(CYLTRACE_SOLID_SPHERE);
    CONSTANT(CYLTRACE_SOLID_CUBOID);
    CONSTANT(CYLTRACE_SOLID_DISK);
    CONSTANT(CYLTRACE_SOLID_UNION);
    CONSTANT(CYLTRACE_SOLID_INTERSECTION);
    CONSTANT(CYLTRACE_SOLID_DIFFERENCE);
    CONSTANT(CYLTRACE_ENTER);
    CONSTANT(CYLTRACE_LEAVE);
    CONSTANT(CYLTRACE_CAMERA);
    CONSTANT(CYLTRACE_SPHERE);
    CONSTANT(CYLTRACE_INSIDE);
    CONSTANT(CYLTRACE_GRAZING);
    CONSTANT(CYLTRACE_AXIAL);
    return 0;
}
