/* scene_terrain.c -- `terrain` of an object. Place: scene_shape.c -> here -> gno_scene_add_terrain. */
#include "io/scene_yaml.h"

#include <math.h>
#include <string.h>

enum { CORNERS, SIZE, CENTER, HEIGHT, ROUGHNESS, LEVELS, LEAST_LEVELS, SEED, DETAIL, VIEWER, FIELDS };

#define AT(member) .offset = offsetof(terrain_entry, terrain) + offsetof(gno_terrain, member)

typedef struct terrain_entry {
    gno_terrain terrain;
    double center[3];
    double square[12]; /* the corners that size and center give */
    int seed;
} terrain_entry;

static const gnoi_field fields[FIELDS] = {
    [CORNERS] = {.key = "corners", .kind = GNOI_FIELD_NODE},
    [SIZE] = {.key = "size", .kind = GNOI_FIELD_NODE},
    [CENTER] = {.key = "center", .kind = GNOI_FIELD_POINT, .offset = offsetof(terrain_entry, center)},
    [HEIGHT] = {.key = "height", .kind = GNOI_FIELD_FROM_0, AT(height)},
    [ROUGHNESS] = {.key = "roughness", .kind = GNOI_FIELD_BETWEEN, AT(roughness), .low = 1e-6, .high = 1},
    [LEVELS] = {.key = "levels", .kind = GNOI_FIELD_INTEGER, AT(levels), .high = 14},
    [LEAST_LEVELS] = {.key = "least_levels", .kind = GNOI_FIELD_INTEGER, AT(least_levels), .high = 14},
    [SEED] = {.key = "seed", .kind = GNOI_FIELD_INTEGER, .offset = offsetof(terrain_entry, seed), .high = 2147483647},
    [DETAIL] = {.key = "detail", .kind = GNOI_FIELD_FROM_0, AT(detail)},
    [VIEWER] = {.key = "viewer", .kind = GNOI_FIELD_POINT, AT(viewer)},
};

/* One number or two: a rectangle about the centre, level with the x and y axes. */
static gno_status read_size(const gnoi_yaml *yaml, const gnoi_yaml_node *node, terrain_entry *entry)
{
    static const gnoi_field above_0 = {.key = "size", .kind = GNOI_FIELD_ABOVE_0};
    static const double around[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    const gnoi_yaml_node *numbers[2] = {node, node};
    double size[2] = {1, 1};
    if (node && node->kind == GNOI_YAML_SEQUENCE) {
        if (node->count != 2) {
            return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "must be one number or 2, has %lu", (unsigned long)node->count);
        }
        numbers[0] = node->first;
        numbers[1] = node->first->next;
    }
    for (int k = 0; k < 2 && node; k++) {
        gno_status status = gnoi_read_field(yaml, numbers[k], &above_0, &size[k]);
        if (status != GNO_OK) return status;
    }
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 2; k++) entry->square[3 * i + k] = entry->center[k] + around[i][k] * size[k];
        entry->square[3 * i + 2] = entry->center[2];
    }
    entry->terrain.corners = entry->square;
    entry->terrain.corner_count = 4;
    return GNO_OK;
}

static gno_status read_corners(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double *corners)
{
    gno_status status = GNO_OK;
    for (const gnoi_yaml_node *point = node->first; point && status == GNO_OK; point = point->next, corners += 3) {
        status = gnoi_read_point(yaml, point, corners);
    }
    return status;
}

/* A tenth of the longest extent: hills, not needles, whatever the unit. */
static double usual_height(const gno_terrain *t)
{
    double longest = 0;
    for (size_t i = 1; i < t->corner_count; i++) {
        for (size_t k = 0; k < 3; k++) longest = fmax(longest, fabs(t->corners[3 * i + k] - t->corners[k]));
    }
    return 0.1 * longest;
}

static gno_status check_keys(const gnoi_yaml *yaml, const gnoi_yaml_node *node, const gnoi_yaml_node *const *seen)
{
    if (!seen[CORNERS] && !seen[SIZE]) return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "needs size or corners");
    for (int i = SIZE; i <= CENTER; i++) {
        if (seen[CORNERS] && seen[i]) return gnoi_yaml_fail(yaml, seen[i], GNO_ERROR_INPUT, "has no meaning beside corners");
    }
    if (seen[VIEWER] && !seen[DETAIL]) return gnoi_yaml_fail(yaml, seen[VIEWER], GNO_ERROR_INPUT, "has no meaning without detail");
    if (!seen[CORNERS]) return GNO_OK;
    gno_status status = gnoi_need_list(yaml, seen[CORNERS]);
    if (status == GNO_OK && seen[CORNERS]->count < 3) {
        return gnoi_yaml_fail(yaml, seen[CORNERS], GNO_ERROR_INPUT, "must have at least 3 points, has %lu",
                              (unsigned long)seen[CORNERS]->count);
    }
    return status;
}

gno_status gnoi_add_terrain(gnoi_scene_reader *reader, const gnoi_yaml_node *node, const gno_mesh_def *look)
{
    const gnoi_yaml *yaml = reader->yaml;
    const gnoi_yaml_node *seen[FIELDS];
    terrain_entry entry;
    double *corners = NULL;
    size_t size = 0;
    memset(&entry, 0, sizeof entry);
    entry.terrain = gno_terrain_default();
    memcpy(entry.terrain.viewer, gno_scene_camera(reader->scene).eye, sizeof entry.terrain.viewer);
    gno_status status = gnoi_read_fields(yaml, node, fields, FIELDS, &entry, seen);
    if (status == GNO_OK) status = check_keys(yaml, node, seen);
    if (status == GNO_OK && seen[CORNERS]) {
        size = 3 * (size_t)seen[CORNERS]->count * sizeof *corners;
        corners = gno_context_realloc(reader->context, NULL, 0, size);
        if (!corners) return gno_context_fail(reader->context, GNO_ERROR_MEMORY, "out of memory while reading a scene file");
        entry.terrain.corners = corners;
        entry.terrain.corner_count = seen[CORNERS]->count;
        status = read_corners(yaml, seen[CORNERS], corners);
    } else if (status == GNO_OK) {
        status = read_size(yaml, seen[SIZE], &entry);
    }
    if (status == GNO_OK) {
        entry.terrain.seed = (unsigned)entry.seed;
        if (!seen[HEIGHT]) entry.terrain.height = usual_height(&entry.terrain);
        status = gnoi_wrap(yaml, node, gno_scene_add_terrain(reader->scene, &entry.terrain, look, NULL));
    }
    if (corners) gno_context_realloc(reader->context, corners, size, 0);
    return status;
}
