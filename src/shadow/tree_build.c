/* tree_build.c -- which polygons go into a light's trees, and their boxes.
 *
 * Place in the data flow: prepared polygons -> their sides; vertices on the light's plane (located.h) -> boxes -> gnoi_tree_pack.
 */
#include "base/fetch.h"
#include "base/pages.h"
#include "shadow/tree.h"
#include <string.h>

#define AHEAD 64 /* polygons: on another page, where the machine does not fetch them unasked */

/* ---- boxes ------------------------------------------------------------------------------------------------------ */

gnoi_boxes gnoi_boxes_make(gno_context *context)
{
    gnoi_boxes b = {context, 0, 0, 0, NULL, NULL, {FLT_MAX, -FLT_MAX, FLT_MAX, -FLT_MAX, 0, 0}};
    return b;
}

int gnoi_boxes_reserve(gnoi_boxes *b, size_t more)
{
    return gnoi_reserve(b->context, (void **)&b->number, &b->number_capacity, b->count + more, sizeof *b->number) &&
           gnoi_reserve(b->context, (void **)&b->box, &b->box_capacity, b->count + more, sizeof *b->box);
}

void gnoi_boxes_free(gnoi_boxes *b)
{
    gnoi_free(b->context, b->box, b->box_capacity, sizeof *b->box);
    gnoi_free(b->context, b->number, b->number_capacity, sizeof *b->number);
}

void gnoi_poly_rectangle(const gnoi_prepared *prep, const gnoi_poly *poly, vec3 e1, vec3 points[4])
{
    uint32_t first = poly->corner, end = prep->ring_corner[poly->ring + 1];
    vec3 origin = v3_from(prep->positions[prep->corner_vertex[first]]), e2 = v3_cross(v3_from(poly->n), e1);
    double lo[2] = {0, 0}, hi[2] = {0, 0};
    for (uint32_t i = first; i < end; i++) {
        vec3 q = v3_sub(v3_from(prep->positions[prep->corner_vertex[i]]), origin);
        double s = v3_dot(q, e1), t = v3_dot(q, e2);
        lo[0] = s < lo[0] ? s : lo[0];
        hi[0] = s > hi[0] ? s : hi[0];
        lo[1] = t < lo[1] ? t : lo[1];
        hi[1] = t > hi[1] ? t : hi[1];
    }
    points[0] = v3_mad(v3_mad(origin, e1, lo[0]), e2, lo[1]);
    points[1] = v3_mad(v3_mad(origin, e1, hi[0]), e2, lo[1]);
    points[2] = v3_mad(v3_mad(origin, e1, hi[0]), e2, hi[1]);
    points[3] = v3_mad(v3_mad(origin, e1, lo[0]), e2, hi[1]);
}

int gnoi_poly_hull(const gno_scene *scene, const gnoi_poly *poly, vec3 points[GNOI_FRAME_POINTS])
{
    const gnoi_prepared *prep = &scene->prepared;
    uint32_t first = poly->corner, end = prep->ring_corner[poly->ring + 1];
    vec3 n = v3_from(poly->n);
    if (end - first <= GNOI_FRAME_POINTS) {
        for (uint32_t i = first; i < end; i++)
            points[i - first] = v3_from(prep->positions[prep->corner_vertex[i]]);
        return (int)(end - first);
    }
    gnoi_poly_rectangle(prep, poly, v3_unit(v3_cross(n, fabs(n.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0))), points);
    return 4;
}

/* The vertices of a polygon's outer ring, or a cap's; those of triangles are found without fetching their records. */
static const uint32_t *outer_of(const gnoi_prepared *prep, size_t i, uint32_t *count)
{
    const gnoi_poly *poly = &prep->polys[i];
    if (i < prep->poly_count && prep->chunk_corner[i / GNOI_CHUNK] != GNOI_NONE)
        return gnoi_corners_of(prep, i, count);
    *count = prep->ring_corner[poly->ring + 1] - poly->corner;
    return prep->corner_vertex + poly->corner;
}

/* Appends the boxes of prepared polygon or cap i. */
static int add_boxes(const gno_scene *scene, const gnoi_frame *frame, const gnoi_located *located, size_t i, gnoi_boxes *b)
{
    uint32_t count;
    const uint32_t *vertex = outer_of(&scene->prepared, i, &count);
    size_t n = 1;
    if (b->count + 6 > b->box_capacity && !gnoi_boxes_reserve(b, 6))
        return 0;
    if (!gnoi_located_box(frame, located, vertex, count, &b->box[b->count])) {
        vec3 points[GNOI_FRAME_POINTS];
        n = (size_t)gnoi_frame_boxes(frame, points, gnoi_poly_hull(scene, &scene->prepared.polys[i], points), b->box + b->count);
    }
    gnoi_boxes_take(b, n, (uint32_t)i);
    return 1;
}

/* The boxes of those polygons whose side is `which`, of which there are `count`. 0 without memory, or when stopped. */
static int collect(const gno_scene *scene, const gnoi_frame *frame, const gnoi_located *located, const unsigned char *sides,
                   gnoi_caster_side which, size_t count, gnoi_boxes *b)
{
    if (!gnoi_boxes_reserve(b, count + 6))
        return 0;
    gnoi_pages_ready(b->box, count * sizeof *b->box);
    for (size_t i = 0; count > 0; i++) {
        if (sides[i] != which)
            continue;
        if (!add_boxes(scene, frame, located, i, b) || gnoi_stopped_at(scene->context, count))
            return 0;
        count--;
    }
    return 1;
}

static gno_status build(const gno_scene *scene, const gnoi_located *located, const unsigned char *sides, gnoi_caster_side which,
                        size_t count, int leaves, gnoi_tree *tree)
{
    gnoi_boxes boxes = gnoi_boxes_make(scene->context);
    gno_status status = GNO_ERROR_MEMORY;
    if (located && collect(scene, &tree->frame, located, sides, which, count, &boxes))
        status = gnoi_tree_pack(scene->context, &boxes, leaves ? scene : NULL, tree);
    gnoi_boxes_free(&boxes);
    return status;
}

/* ---- sides ------------------------------------------------------------------------------------------------------ */

static int casts(const gno_scene *scene, const gnoi_poly *poly)
{
    const double *t = scene->materials[poly->material].transmission;
    return !poly->detail && (poly->opaque || !(t[0] >= 1 && t[1] >= 1 && t[2] >= 1));
}

static gnoi_caster_side side_of(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, const gnoi_poly *poly)
{
    uint32_t solid;
    double side;
    if (!casts(scene, poly))
        return GNOI_CASTS_NOT;
    if (!halved)
        return GNOI_CASTS;
    solid = gnoi_solid_of(&scene->prepared, poly);
    if (!halved[solid])
        return GNOI_CASTS;
    side = gnoi_lamp_side(lamp, poly->n, poly->d);
    return (scene->prepared.solids[solid].outwards ? side > 0 : side < 0) ? GNOI_CASTS_NEAR : GNOI_CASTS_FAR;
}

static void mark(const gnoi_prepared *prep, const gnoi_poly *poly, unsigned char *near_by)
{
    for (uint32_t k = 0; k < poly->corner_count; k++)
        near_by[prep->corner_vertex[poly->corner + k]] = 1;
}

/* Fills sides, near_by and how many there are of each side; 0 when stopped. Caps are sides of halved solids or nothing. */
static int tell_sides(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, unsigned char *sides,
                      unsigned char *near_by, size_t counts[GNOI_CASTS_NEAR + 1])
{
    const gnoi_prepared *prep = &scene->prepared;
    for (size_t i = 0; i < prep->poly_count + prep->cap_count; i++) {
        gnoi_caster_side side = side_of(scene, lamp, halved, &prep->polys[i]);
        if (i + AHEAD < prep->poly_count)
            FETCH(&prep->polys[i + AHEAD]);
        if (i >= prep->poly_count && side == GNOI_CASTS)
            side = GNOI_CASTS_NOT;
        if (side == GNOI_CASTS_NEAR)
            mark(prep, &prep->polys[i], near_by);
        sides[i] = (unsigned char)side;
        counts[side]++;
        if (gnoi_stopped_at(scene->context, i))
            return 0;
    }
    return 1;
}

/* ---- trees ------------------------------------------------------------------------------------------------------ */

gno_status gnoi_tree_build_part(const gno_scene *scene, const gnoi_lamp *lamp, gnoi_tree_part part, gnoi_tree *tree)
{
    gno_context *context = scene->context;
    const gnoi_prepared *prep = &scene->prepared;
    unsigned char *sides = gnoi_malloc(context, prep->poly_count, 1);
    gnoi_located *located;
    gno_status status = GNO_ERROR_MEMORY;
    size_t count = 0;
    memset(tree, 0, sizeof *tree);
    tree->frame = gnoi_frame_make(lamp, prep->lower, prep->upper);
    for (size_t i = 0; sides && i < prep->poly_count; i++) {
        sides[i] = part == GNOI_TREE_SEEN || casts(scene, &prep->polys[i]) ? GNOI_CASTS : GNOI_CASTS_NOT;
        count += sides[i] == GNOI_CASTS;
    }
    located = gnoi_locate_vertices(scene, &tree->frame);
    if (sides)
        status = build(scene, located, sides, GNOI_CASTS, count, 1, tree);
    gnoi_free(context, located, prep->vertex_count, sizeof *located);
    gnoi_free(context, sides, prep->poly_count, 1);
    if (status)
        gnoi_tree_free(context, tree);
    return status;
}

gno_status gnoi_tree_build_casters(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved,
                                   const gnoi_located *located, unsigned char *sides, unsigned char *near_by, gnoi_tree *single,
                                   gnoi_tree *far)
{
    size_t counts[GNOI_CASTS_NEAR + 1] = {0};
    gno_status status;
    if (!tell_sides(scene, lamp, halved, sides, near_by, counts))
        return GNO_ERROR_MEMORY;
    status = build(scene, located, sides, GNOI_CASTS, counts[GNOI_CASTS], 1, single);
    return status ? status : build(scene, located, sides, GNOI_CASTS_FAR, counts[GNOI_CASTS_FAR], 0, far);
}
