/* contour.c -- see contour.h. */
#include "shadow/contour.h"
#include <string.h>

static int collect_edges(const gno_scene *scene, const gnoi_casters *c, gnoi_boxes *boxes)
{
    for (size_t i = 0; i < c->contour.count; i++) {
        vec3 ends[2] = {v3_from(scene->prepared.positions[c->contour.edges[i].from]), v3_from(scene->prepared.positions[c->contour.edges[i].to])};
        gnoi_lbox box[6];
        int n = gnoi_frame_boxes(&c->rim.frame, ends, 2, box);
        if (!gnoi_boxes_reserve(boxes, 6))
            return 0;
        for (int k = 0; k < n; k++) {
            boxes->box[boxes->count] = box[k];
            boxes->number[boxes->count++] = (uint32_t)i;
        }
    }
    return 1;
}

static gno_status build_rim(const gno_scene *scene, gnoi_casters *c)
{
    gnoi_boxes boxes = {0};
    gno_status status = GNO_ERROR_MEMORY;
    boxes.context = scene->context;
    c->rim.frame = c->far.frame;
    if (collect_edges(scene, c, &boxes))
        status = gnoi_tree_pack(scene->context, &boxes, NULL, &c->rim);
    gnoi_boxes_free(&boxes);
    return status;
}

/* The far sides' boundary, turned so that they are to the left of it on the light's plane: those of solids wound inwards are not. */
static int find_contour(const gno_scene *scene, const unsigned char *is_far, size_t count, gnoi_casters *c)
{
    const gnoi_prepared *prep = &scene->prepared;
    if (!gnoi_boundary_find(scene->context, prep, is_far, count, &c->contour))
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

static gno_status build_contour(const gno_scene *scene, gnoi_casters *c)
{
    const size_t count = scene->prepared.poly_count + scene->prepared.cap_count;
    unsigned char *is_far = gnoi_calloc(scene->context, count, 1);
    int good;
    for (size_t i = 0; is_far && i < c->far.entry_count; i++)
        is_far[c->far.caster[i]] = 1;
    good = is_far && find_contour(scene, is_far, count, c);
    gnoi_free(scene->context, is_far, count, 1);
    return good ? build_rim(scene, c) : GNO_ERROR_MEMORY;
}

gno_status gnoi_casters_build(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, gnoi_casters *c)
{
    gno_status status;
    memset(c, 0, sizeof *c);
    status = gnoi_tree_build_casters(scene, lamp, halved, &c->single, &c->far);
    if (!status && c->far.entry_count)
        status = build_contour(scene, c);
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
}
