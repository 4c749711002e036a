/* contour.c -- see contour.h. */
#include "shadow/contour.h"
#include <string.h>

static int collect_edges(const gno_scene *scene, const gnoi_casters *c, gnoi_boxes *boxes)
{
    const gnoi_frame *frame = &c->rim.frame;
    for (size_t i = 0; i < c->contour.count; i++) {
        const uint32_t ends[2] = {c->contour.edges[i].from, c->contour.edges[i].to};
        size_t n = 1;
        if (!gnoi_boxes_reserve(boxes, 6))
            return 0;
        if (!gnoi_located_box(frame, c->located, ends, 2, &boxes->box[boxes->count])) {
            vec3 points[2] = {v3_from(scene->prepared.positions[ends[0]]), v3_from(scene->prepared.positions[ends[1]])};
            n = (size_t)gnoi_frame_boxes(frame, points, 2, boxes->box + boxes->count);
        }
        gnoi_boxes_take(boxes, n, (uint32_t)i);
    }
    return 1;
}

static gno_status build_rim(const gno_scene *scene, gnoi_casters *c)
{
    gnoi_boxes boxes = gnoi_boxes_make(scene->context);
    gno_status status = GNO_ERROR_MEMORY;
    c->rim.frame = c->far.frame;
    if (collect_edges(scene, c, &boxes))
        status = gnoi_tree_pack(scene->context, &boxes, NULL, &c->rim);
    gnoi_boxes_free(&boxes);
    return status;
}

/* The far sides' boundary, turned so that they are to the left of it on the light's plane: those of solids wound inwards are not. The
 * edges of a closed solid cancel, so all do that lead to a vertex with far sides alone around it: no near side, no polygon without area. */
static int find_contour(const gno_scene *scene, const unsigned char *sides, const unsigned char *near_by, size_t count, gnoi_casters *c)
{
    const gnoi_prepared *prep = &scene->prepared;
    if (!gnoi_boundary_find(scene->context, prep, sides, count, near_by, &c->contour))
        return 0;
    for (size_t i = 0; i < c->contour.count; i++) {
        gnoi_boundary_edge *e = &c->contour.edges[i];
        uint32_t from = e->from;
        if (prep->solids[gnoi_solid_of(prep, &prep->polys[e->poly])].outwards)
            continue;
        e->from = e->to;
        e->to = from;
    }
    return 1;
}

static void free_located(gno_context *context, gnoi_casters *c)
{
    gnoi_free(context, c->located, c->located_count, sizeof *c->located);
    c->located = NULL;
}

gno_status gnoi_casters_build(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, int keep, gnoi_casters *c)
{
    const gnoi_prepared *prep = &scene->prepared;
    const size_t count = prep->poly_count + prep->cap_count;
    unsigned char *sides = gnoi_malloc(scene->context, count, 1), *near_by = gnoi_calloc(scene->context, prep->vertex_count, 1);
    gno_status status = GNO_ERROR_MEMORY;
    memset(c, 0, sizeof *c);
    for (size_t i = 0; near_by && i < prep->joint_count; i++)
        near_by[prep->joints[i]] = 1;
    c->single.frame = c->far.frame = gnoi_frame_make(lamp, prep->lower, prep->upper);
    c->located = gnoi_locate_vertices(scene, &c->far.frame);
    c->located_count = prep->vertex_count;
    if (sides && near_by && c->located)
        status = gnoi_tree_build_casters(scene, lamp, halved, c->located, sides, near_by, &c->single, &c->far);
    if (!status && c->far.entry_count)
        status = find_contour(scene, sides, near_by, count, c) ? build_rim(scene, c) : GNO_ERROR_MEMORY;
    gnoi_free(scene->context, sides, count, 1);
    gnoi_free(scene->context, near_by, prep->vertex_count, 1);
    if (!keep)
        free_located(scene->context, c);
    if (status)
        gnoi_casters_free(scene->context, c);
    return status;
}

void gnoi_casters_free(gno_context *context, gnoi_casters *c)
{
    gnoi_tree_free(context, &c->single);
    gnoi_tree_free(context, &c->far);
    gnoi_tree_free(context, &c->rim);
    gnoi_boundary_free(context, &c->contour);
    free_located(context, c);
}
