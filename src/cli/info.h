/* info.h -- what gnomon info found. Place: info.c fills it, info_text.c and info_json.c print it. */
#ifndef GNOMON_CLI_INFO_H
#define GNOMON_CLI_INFO_H

#include "cli/cli.h"

#include <gnomon/gnomon_problems.h>

typedef struct found_list {
    gno_problem *items; /* in the order of kinds */
    size_t count, room;
    gno_context *context; /* holds them, so that they count for --memory */
    int full;             /* memory was short */
} found_list;

typedef struct summary {
    const char *path;
    const gno_scene *scene;
    gno_scene_counts counts;
    gno_scene_problems problems;
    size_t problem_counts[GNO_PROBLEM_KINDS];
    found_list list;
    int has_bounds;
    double lower[3], upper[3];
    size_t holes;
    size_t *material_polygons; /* how many polygons have each material */
    char **warnings;           /* what the reader remarked, in order */
    size_t warning_count, warning_room;
} summary;

/* To standard output. */
void info_text(const summary *found);
void info_json(const summary *found);

/* The words of the scene file. */
const char *light_type_name(gno_light_type type);
const char *falloff_name(gno_falloff falloff);
const char *shading_name(gno_shading shading);
const char *camera_type_name(gno_camera_type type);

#endif
