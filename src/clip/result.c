/* result.c -- the rings as a shape in the caller's coordinates. Place: last pass (clipper.h). Every grid point is a double. */
#include "clip/clipper.h"

#include <math.h>

/* The place of each ring: its polygon's outer ring comes first. Fills result_polygon_start; `bucket` gets the ring at each place. */
static void order_rings(gno_clipper *c)
{
    size_t *start = c->result_polygon_start;
    for (size_t p = 0; p <= c->result_polygons; p++)
        start[p] = 0;
    for (size_t r = 0; r < c->ring_count; r++)
        start[c->rings[r].polygon + 1]++;
    for (size_t p = 0; p < c->result_polygons; p++)
        start[p + 1] += start[p];
    for (size_t r = 0; r < c->ring_count; r++)
        if (c->rings[r].outer)
            c->bucket[start[c->rings[r].polygon]++] = (uint32_t)r;
    for (size_t r = 0; r < c->ring_count; r++)
        if (!c->rings[r].outer)
            c->bucket[start[c->rings[r].polygon]++] = (uint32_t)r;
    for (size_t p = c->result_polygons; p > 0; p--)
        start[p] = start[p - 1];
    start[0] = 0;
}

gno_status gnoi_clip_result(gno_clipper *c, gno_shape *result)
{
    double *to;
    if (!GNOI_CLIP_RESERVE(c, bucket, bucket_capacity, c->ring_count) ||
        !GNOI_CLIP_RESERVE(c, result_polygon_start, result_polygon_capacity, c->result_polygons + 1) ||
        !GNOI_CLIP_RESERVE(c, result_ring_start, result_ring_capacity, c->ring_count + 1) ||
        !gnoi_reserve(c->context, (void **)&c->result_points, &c->result_point_capacity, c->ring_vertex_count, 2 * sizeof(double)))
        return GNO_ERROR_MEMORY;
    order_rings(c);
    to = c->result_points;
    c->result_ring_start[0] = 0;
    for (size_t r = 0; r < c->ring_count; r++) {
        const gnoi_ring *ring = &c->rings[c->bucket[r]];
        if (gnoi_clip_stopped(c, ring->end - ring->first))
            return GNO_ERROR_MEMORY;
        for (size_t i = ring->first; i < ring->end; i++) {
            gnoi_site p = c->vertices[c->ring_vertex[i]];
            *to++ = (double)(p.x + c->origin[0]) * c->cell;
            *to++ = (double)(p.y + c->origin[1]) * c->cell;
        }
        c->result_ring_start[r + 1] = c->result_ring_start[r] + (ring->end - ring->first);
    }
    result->polygon_count = c->result_polygons;
    result->polygon_start = c->result_polygon_start;
    result->ring_count = c->ring_count;
    result->ring_start = c->result_ring_start;
    result->points = c->result_points;
    return GNO_OK;
}

static double ring_area(const double *p, size_t count)
{
    double sum = 0;
    for (size_t i = 2; i < count; i++)
        sum += (p[2 * i - 2] - p[0]) * (p[2 * i + 1] - p[1]) - (p[2 * i] - p[0]) * (p[2 * i - 1] - p[1]);
    return fabs(0.5 * sum);
}

double gno_shape_area(const gno_shape *shape)
{
    double area = 0;
    for (size_t p = 0; shape && p < shape->polygon_count; p++) {
        size_t first = shape->polygon_start ? shape->polygon_start[p] : p;
        size_t end = shape->polygon_start ? shape->polygon_start[p + 1] : p + 1;
        for (size_t r = first; r < end; r++) {
            double ring = ring_area(shape->points + 2 * shape->ring_start[r], shape->ring_start[r + 1] - shape->ring_start[r]);
            area += r == first ? ring : -ring;
        }
    }
    return area;
}
