/* without_holes.c -- a polygon with holes as polygons without, for formats that know none: see lit_files.h.
 *
 * Method: a polygon with holes is cut in two by a line through the middle of its middle hole, across its longer side; each half has
 * fewer holes; again until none is left. The work is a stack of polygons.
 */
#include "io/lit_files.h"

#include <math.h>
#include <string.h>

typedef struct stack {
    gno_context *context;
    size_t polygons, rings, points; /* in use */
    size_t polygon_room, ring_room, point_room;
    size_t *polygon_ring; /* first ring of each polygon; ends at `rings` */
    size_t *ring_point;   /* first point of each ring; ends at `points` */
    double *point;
} stack;

static int grow(gno_context *context, void **array, size_t *room, size_t need, size_t size)
{
    size_t wanted = *room * 2 > need ? *room * 2 : need;
    void *fresh;
    if (need <= *room) {
        return 1;
    }
    fresh = gno_context_realloc(context, *array, *room * size, wanted * size);
    if (fresh == NULL) {
        return 0;
    }
    *array = fresh;
    *room = wanted;
    return 1;
}

static int push(stack *s, const gno_shape *shape, size_t polygon)
{
    const size_t r0 = shape->polygon_start[polygon], r1 = shape->polygon_start[polygon + 1];
    const size_t p0 = shape->ring_start[r0], p1 = shape->ring_start[r1];
    if (!grow(s->context, (void **)&s->polygon_ring, &s->polygon_room, s->polygons + 1, sizeof *s->polygon_ring) ||
        !grow(s->context, (void **)&s->ring_point, &s->ring_room, s->rings + (r1 - r0) + 1, sizeof *s->ring_point) ||
        !grow(s->context, (void **)&s->point, &s->point_room, 2 * (s->points + (p1 - p0)), sizeof *s->point)) {
        return 0;
    }
    s->polygon_ring[s->polygons++] = s->rings;
    for (size_t r = r0; r < r1; r++) {
        s->ring_point[s->rings++] = s->points + (shape->ring_start[r] - p0);
    }
    memcpy(s->point + 2 * s->points, shape->points + 2 * p0, 2 * (p1 - p0) * sizeof *s->point);
    s->points += p1 - p0;
    s->ring_point[s->rings] = s->points;
    return 1;
}

static void box_of(const stack *s, size_t ring, double box[4])
{
    box[0] = box[1] = HUGE_VAL;
    box[2] = box[3] = -HUGE_VAL;
    for (size_t i = s->ring_point[ring]; i < s->ring_point[ring + 1]; i++) {
        for (size_t k = 0; k < 2; k++) {
            const double x = s->point[2 * i + k];
            box[k] = x < box[k] ? x : box[k];
            box[k + 2] = x > box[k + 2] ? x : box[k + 2];
        }
    }
}

/* The hole whose middle is nearest to the box's middle; where to cut, and along which axis. */
static double choose_cut(const stack *s, size_t outer, const double box[4], int *axis)
{
    double best = HUGE_VAL, at = 0, hole[4];
    *axis = box[2] - box[0] < box[3] - box[1];
    for (size_t r = outer + 1; r < s->rings; r++) {
        double middle, away;
        box_of(s, r, hole);
        middle = 0.5 * (hole[*axis] + hole[*axis + 2]);
        away = fabs(middle - 0.5 * (box[*axis] + box[*axis + 2]));
        if (away < best) {
            best = away;
            at = middle;
        }
    }
    return at;
}

/* Cuts the topmost polygon, which has holes, and puts the parts in its place. */
static gno_status cut_top(stack *s, gno_clipper *clipper)
{
    static const size_t one_polygon[2] = {0, 1}, one_ring[2] = {0, 4};
    const size_t outer = s->polygon_ring[s->polygons - 1], first = s->ring_point[outer];
    const size_t rings = s->rings - outer, polygon_start[2] = {0, rings};
    double box[4], at, grown, half[8];
    gno_shape subject, clip, result[1];
    gno_status status = GNO_OK;
    int axis;
    stack copy = {s->context, 0, 0, 0, 0, 0, 0, NULL, NULL, NULL};
    box_of(s, outer, box);
    at = choose_cut(s, outer, box, &axis);
    grown = 0.25 * fmax(box[2] - box[0], box[3] - box[1]);
    subject.polygon_count = 1;
    subject.polygon_start = polygon_start;
    subject.ring_count = rings;
    subject.ring_start = s->ring_point + outer;
    subject.points = s->point;
    /* The polygon moves out, since its parts take its place. */
    if (!push(&copy, &subject, 0)) {
        status = GNO_ERROR_MEMORY;
    }
    s->polygons--;
    s->rings = outer;
    s->points = first;
    subject.ring_start = copy.ring_point;
    subject.points = copy.point;
    clip.polygon_count = clip.ring_count = 1;
    clip.polygon_start = one_polygon;
    clip.ring_start = one_ring;
    clip.points = half;
    for (int side = 0; side < 2 && status == GNO_OK; side++) {
        double to[4] = {box[0] - grown, box[1] - grown, box[2] + grown, box[3] + grown};
        to[side == 0 ? axis + 2 : axis] = at;
        for (int i = 0; i < 4; i++) {
            half[2 * i] = to[i == 1 || i == 2 ? 2 : 0];
            half[2 * i + 1] = to[i >= 2 ? 3 : 1];
        }
        status = gno_clip(clipper, GNO_CLIP_INTERSECTION, &subject, &clip, result);
        for (size_t k = 0; k < result->polygon_count && status == GNO_OK; k++) {
            status = push(s, result, k) ? GNO_OK : GNO_ERROR_MEMORY;
        }
    }
    gno_context_realloc(s->context, copy.polygon_ring, copy.polygon_room * sizeof *copy.polygon_ring, 0);
    gno_context_realloc(s->context, copy.ring_point, copy.ring_room * sizeof *copy.ring_point, 0);
    gno_context_realloc(s->context, copy.point, copy.point_room * sizeof *copy.point, 0);
    return status;
}

gno_status gnoi_without_holes(gno_context *context, gno_clipper *clipper, const gno_shape *polygon,
                              void (*put)(void *user, const double *points, size_t count), void *user)
{
    stack s = {context, 0, 0, 0, 0, 0, 0, NULL, NULL, NULL};
    gno_status status = push(&s, polygon, 0) ? GNO_OK : GNO_ERROR_MEMORY;
    while (s.polygons > 0 && status == GNO_OK) {
        const size_t outer = s.polygon_ring[s.polygons - 1], first = s.ring_point[outer];
        if (s.rings - outer > 1) {
            status = cut_top(&s, clipper);
            continue;
        }
        put(user, s.point + 2 * first, s.points - first);
        s.polygons--;
        s.rings = outer;
        s.points = first;
    }
    gno_context_realloc(context, s.polygon_ring, s.polygon_room * sizeof *s.polygon_ring, 0);
    gno_context_realloc(context, s.ring_point, s.ring_room * sizeof *s.ring_point, 0);
    gno_context_realloc(context, s.point, s.point_room * sizeof *s.point, 0);
    return status;
}
