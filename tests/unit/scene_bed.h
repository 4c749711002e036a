/* scene_bed.h -- an empty scene whose allocations are counted, and a small mesh. For inclusion after cmocka.h. */
#ifndef SCENE_BED_H
#define SCENE_BED_H

#include "fail_alloc.h"
#include "scene/scene.h"

/* A unit square and a triangle over five vertices, in two rings. */
static const double square_positions[15] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0};
static const int square_corners[7] = {0, 1, 2, 3, 1, 4, 2};
static const unsigned square_rings[3] = {0, 4, 7};

static inline gno_mesh_def square_mesh(void)
{
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.name = "wall";
    mesh.vertex_count = 5;
    mesh.positions = square_positions;
    mesh.polygon_count = 2;
    mesh.ring_count = 2;
    mesh.ring_start = square_rings;
    mesh.corner_count = 7;
    mesh.corner_vertex = square_corners;
    return mesh;
}

typedef struct bed {
    fail_alloc alloc;
    gno_context *context;
    gno_scene *scene;
} bed;

static inline int set_up(void **state)
{
    bed *b = calloc(1, sizeof *b);
    gno_context_def def;
    if (!b) {
        return 1;
    }
    def = fail_alloc_def(&b->alloc);
    *state = b;
    return gno_context_create(&def, &b->context) != GNO_OK || gno_scene_create(b->context, &b->scene) != GNO_OK;
}

static inline int tear_down(void **state)
{
    bed *b = *state;
    int bad;
    gno_scene_destroy(b->scene);
    gno_context_destroy(b->context);
    bad = b->alloc.held != 0 || b->alloc.wrong_size;
    free(b);
    return bad;
}

#endif
