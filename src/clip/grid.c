/* grid.c -- the caller's shapes on an integer grid.
 *
 * Place: first pass of a call (clipper.h). Out: points and segments. The cell is a power of two, so that input that lies on it is
 * kept exactly and every grid point is a double; its size follows from the bounds of both shapes, not from the caller.
 * Invariants: no segment has length 0; the segments of a polygon are consecutive, and segment i starts, as its ring runs, in point i.
 */
#include "clip/clipper.h"

#include <math.h>

#define LARGEST 1e300         /* of a coordinate: leaves room for differences */
#define SMALLEST_EXPONENT -960 /* of the cell: its reciprocal is a double */
#define MANTISSA 52

typedef struct bounds {
    double low[2], high[2];
} bounds;

static size_t shape_ring(const gno_shape *shape, size_t polygon)
{
    return shape->polygon_start ? shape->polygon_start[polygon] : polygon;
}

static gno_status check_offsets(gno_clipper *c, const gno_shape *s, const char *name)
{
    if ((s->ring_count > 0 && (!s->ring_start || !s->points)) || (!s->polygon_start && s->polygon_count != s->ring_count))
        return gnoi_clip_refuse(c, GNO_ERROR_ARGUMENT, "%s: arrays are missing", name);
    for (size_t r = 0; r < s->ring_count; r++)
        if (s->ring_start[r] > s->ring_start[r + 1])
            return gnoi_clip_refuse(c, GNO_ERROR_ARGUMENT, "%s: ring_start[%zu] is less than the one before", name, r + 1);
    for (size_t p = 0; s->polygon_start && p < s->polygon_count; p++)
        if (s->polygon_start[p] > s->polygon_start[p + 1] || s->polygon_start[p + 1] > s->ring_count)
            return gnoi_clip_refuse(c, GNO_ERROR_ARGUMENT, "%s: polygon_start[%zu] is out of order", name, p + 1);
    return GNO_OK;
}

static gno_status add_bounds(gno_clipper *c, const gno_shape *s, const char *name, bounds *box)
{
    size_t end = s->ring_count > 0 ? s->ring_start[s->ring_count] : 0;
    for (size_t i = s->ring_count > 0 ? s->ring_start[0] : 0; i < end; i++) {
        if (gnoi_clip_stopped_at(c, i))
            return GNO_ERROR_MEMORY;
        for (int k = 0; k < 2; k++) {
            double v = s->points[2 * i + (size_t)k];
            if (!(fabs(v) <= LARGEST))
                return gnoi_clip_refuse(c, GNO_ERROR_ARGUMENT, "%s: coordinate of point %zu is not finite or beyond 1e300", name, i);
            box->low[k] = v < box->low[k] ? v : box->low[k];
            box->high[k] = v > box->high[k] ? v : box->high[k];
        }
    }
    return GNO_OK;
}

/* Exponent e of the least power of two above v > 0; SMALLEST_EXPONENT for 0. */
static int exponent_above(double v)
{
    int e = SMALLEST_EXPONENT;
    if (v > 0)
        (void)frexp(v, &e);
    return e;
}

static void choose_grid(gno_clipper *c, const bounds *box)
{
    double side = fmax(box->high[0] - box->low[0], box->high[1] - box->low[1]);
    double reach = fmax(fmax(fabs(box->low[0]), fabs(box->high[0])), fmax(fabs(box->low[1]), fabs(box->high[1])));
    int exponent = exponent_above(side) - c->bits, coarse = exponent_above(reach) - MANTISSA;
    exponent = exponent > coarse ? exponent : coarse;
    exponent = exponent > SMALLEST_EXPONENT ? exponent : SMALLEST_EXPONENT;
    c->cell = ldexp(1, exponent);
    for (int k = 0; k < 2; k++)
        c->origin[k] = llrint(box->low[k] / c->cell);
}

static gnoi_site to_grid(const gno_clipper *c, double per_cell, const double *p)
{
    gnoi_site s;
    s.x = llrint(p[0] * per_cell) - c->origin[0];
    s.y = llrint(p[1] * per_cell) - c->origin[1];
    return s;
}

/* Adds a ring's points without repetitions; 0: stop. */
static int add_ring_points(gno_clipper *c, const gno_shape *s, size_t ring)
{
    double per_cell = 1 / c->cell;
    size_t first = c->point_count;
    for (size_t i = s->ring_start[ring]; i < s->ring_start[ring + 1]; i++) {
        gnoi_site p = to_grid(c, per_cell, &s->points[2 * i]);
        if (gnoi_clip_stopped_at(c, i))
            return 0;
        if (c->point_count == first || !gnoi_site_equal(p, c->points[c->point_count - 1]))
            c->points[c->point_count++] = p;
    }
    while (c->point_count > first && gnoi_site_equal(c->points[first], c->points[c->point_count - 1]))
        c->point_count--;
    return 1;
}

static int add_ring_segments(gno_clipper *c, size_t first, uint32_t polygon)
{
    size_t end = c->point_count;
    for (size_t i = first; i < end; i++) {
        size_t j = i + 1 < end ? i + 1 : first;
        gnoi_segment *g = &c->segments[c->segment_count++];
        int up = gnoi_site_less(c->points[i], c->points[j]);
        if (gnoi_clip_stopped_at(c, i))
            return 0;
        g->a = c->points[up ? i : j];
        g->b = c->points[up ? j : i];
        g->pa = (uint32_t)(up ? i : j);
        g->pb = (uint32_t)(up ? j : i);
        g->polygon = polygon;
        g->sign = up ? 1 : -1;
    }
    return 1;
}

/* +1 or -1 for one convex ring: it turns one way only, never back on itself, and goes to and fro once. */
static int convex_winding(gno_clipper *c, const gnoi_site *p, size_t count)
{
    int way = 0, changes = 0;
    for (size_t i = 0; i < count; i++) {
        gnoi_site a = p[i], b = p[i + 1 < count ? i + 1 : i + 1 - count], d = p[i + 2 < count ? i + 2 : i + 2 - count];
        int turn = gnoi_site_turn(a, b, d), changed = gnoi_site_less(a, b) != gnoi_site_less(b, d);
        if (turn * way < 0 || (turn == 0 && changed) || gnoi_clip_stopped_at(c, i))
            return GNOI_POLYGON_PARITY;
        way = turn != 0 ? turn : way;
        changes += changed;
    }
    return changes == 2 ? way : GNOI_POLYGON_PARITY;
}

static int add_polygon(gno_clipper *c, const gno_shape *s, size_t polygon, int operand)
{
    gnoi_polygon *added = &c->polygons[c->polygon_count];
    size_t start = c->point_count, rings = 0;
    added->first = (uint32_t)c->segment_count;
    for (size_t r = shape_ring(s, polygon); r < shape_ring(s, polygon + 1); r++) {
        size_t first = c->point_count;
        if (!add_ring_points(c, s, r) || !add_ring_segments(c, first, (uint32_t)c->polygon_count))
            return 0;
        rings += c->point_count > first;
    }
    added->end = (uint32_t)c->segment_count;
    if (added->first == added->end)
        return 1;
    added->operand = (int8_t)operand;
    added->winding = (int8_t)(rings == 1 ? convex_winding(c, c->points + start, c->point_count - start) : GNOI_POLYGON_PARITY);
    c->operand_polygons[operand]++;
    c->polygon_count++;
    return !gnoi_clip_stopped(c, c->point_count - start);
}

/* Segments that a shape may have: at most its points, each polygon's counted, since polygons may share rings. */
static gno_status count_points(gno_clipper *c, const gno_shape *s, size_t *points, size_t *polygons)
{
    for (size_t p = 0; p < s->polygon_count; p++)
        for (size_t r = shape_ring(s, p); r < shape_ring(s, p + 1); r++) {
            *points += s->ring_start[r + 1] - s->ring_start[r];
            if (*points >= GNOI_CLIP_MOST)
                return gnoi_clip_too_many(c, "points");
        }
    *polygons += s->polygon_count;
    return *polygons < GNOI_CLIP_MOST ? GNO_OK : gnoi_clip_too_many(c, "polygons");
}

gno_status gnoi_clip_import(gno_clipper *c, const gno_shape *subject, const gno_shape *clip)
{
    const gno_shape *shapes[2] = {subject, clip};
    const char *names[2] = {"subject", "clip"};
    bounds box = {{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
    size_t points = 0, polygons = 0;
    gno_status status = GNO_OK;
    for (int k = 0; k < 2 && shapes[k]; k++) {
        if ((status = check_offsets(c, shapes[k], names[k])) != GNO_OK ||
            (status = add_bounds(c, shapes[k], names[k], &box)) != GNO_OK ||
            (status = count_points(c, shapes[k], &points, &polygons)) != GNO_OK)
            return status;
    }
    c->point_count = c->segment_count = c->polygon_count = 0;
    c->operand_polygons[0] = c->operand_polygons[1] = 0;
    if (!GNOI_CLIP_RESERVE(c, points, point_capacity, points + 1) ||
        !GNOI_CLIP_RESERVE(c, segments, segment_capacity, points + 1) ||
        !GNOI_CLIP_RESERVE(c, polygons, polygon_capacity, polygons + 1))
        return GNO_ERROR_MEMORY;
    if (points == 0)
        return GNO_OK;
    choose_grid(c, &box);
    for (int k = 0; k < 2 && shapes[k]; k++)
        for (size_t p = 0; p < shapes[k]->polygon_count; p++)
            if (!add_polygon(c, shapes[k], p, k))
                return GNO_ERROR_MEMORY;
    return GNO_OK;
}
