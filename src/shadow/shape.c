/* shape.c -- see shape.h. */
#include "shadow/shape.h"

#include <math.h>
#include <string.h>

void gnoi_shape_clear(gnoi_shape *shape) { shape->polygon_count = shape->ring_count = shape->point_count = 0; }

void gnoi_shape_free(gnoi_shape *shape)
{
    gnoi_free(shape->context, shape->polygon_start, shape->polygon_capacity, sizeof *shape->polygon_start);
    gnoi_free(shape->context, shape->ring_start, shape->ring_capacity, sizeof *shape->ring_start);
    gnoi_free(shape->context, shape->points, shape->point_capacity, sizeof *shape->points);
    memset(shape, 0, sizeof *shape);
}

double *gnoi_shape_ring(gnoi_shape *shape, size_t count)
{
    if (!gnoi_reserve(shape->context, (void **)&shape->points, &shape->point_capacity, 2 * (shape->point_count + count + 1),
                      sizeof *shape->points))
        return NULL;
    return shape->points + 2 * shape->point_count;
}

int gnoi_shape_end_ring(gnoi_shape *shape, size_t count)
{
    if (!gnoi_reserve(shape->context, (void **)&shape->ring_start, &shape->ring_capacity, shape->ring_count + 2, sizeof *shape->ring_start))
        return 0;
    shape->ring_start[shape->ring_count++] = shape->point_count;
    shape->point_count += count;
    shape->ring_start[shape->ring_count] = shape->point_count;
    return 1;
}

int gnoi_shape_end_polygon(gnoi_shape *shape, size_t first_ring)
{
    if (!gnoi_reserve(shape->context, (void **)&shape->polygon_start, &shape->polygon_capacity, shape->polygon_count + 2,
                      sizeof *shape->polygon_start))
        return 0;
    shape->polygon_start[shape->polygon_count++] = first_ring;
    shape->polygon_start[shape->polygon_count] = shape->ring_count;
    return 1;
}

void gnoi_shape_cut(gnoi_shape *shape, size_t polygons, size_t rings, size_t points)
{
    shape->polygon_count = polygons;
    shape->ring_count = rings;
    shape->point_count = points;
    if (rings > 0)
        shape->ring_start[rings] = points;
    if (polygons > 0)
        shape->polygon_start[polygons] = rings;
}

int gnoi_shape_append(gnoi_shape *shape, const gno_shape *from, size_t first, size_t count)
{
    for (size_t p = first; p < first + count; p++) {
        size_t first_ring = shape->ring_count;
        size_t r0 = from->polygon_start ? from->polygon_start[p] : p, r1 = from->polygon_start ? from->polygon_start[p + 1] : p + 1;
        for (size_t r = r0; r < r1; r++) {
            size_t n = from->ring_start[r + 1] - from->ring_start[r];
            double *to = gnoi_shape_ring(shape, n);
            if (!to)
                return 0;
            memcpy(to, from->points + 2 * from->ring_start[r], 2 * n * sizeof *to);
            if (!gnoi_shape_end_ring(shape, n))
                return 0;
        }
        if (!gnoi_shape_end_polygon(shape, first_ring))
            return 0;
    }
    return 1;
}

gno_shape gnoi_shape_view(const gnoi_shape *shape)
{
    gno_shape view;
    memset(&view, 0, sizeof view);
    view.polygon_count = shape->polygon_count;
    view.polygon_start = shape->polygon_start;
    view.ring_count = shape->ring_count;
    view.ring_start = shape->ring_start;
    view.points = shape->points;
    return view;
}

gnoi_moment gnoi_shape_moment(const gno_shape *shape, size_t polygon)
{
    size_t r0 = shape->polygon_start ? shape->polygon_start[polygon] : polygon;
    size_t r1 = shape->polygon_start ? shape->polygon_start[polygon + 1] : polygon + 1;
    gnoi_moment all = {0, 0, 0};
    for (size_t r = r0; r < r1; r++) {
        const double *p = shape->points + 2 * shape->ring_start[r];
        size_t n = shape->ring_start[r + 1] - shape->ring_start[r];
        gnoi_moment m = {0, 0, 0};
        double sign;
        for (size_t i = 1; i + 1 < n; i++) {
            double ax = p[2 * i] - p[0], ay = p[2 * i + 1] - p[1], bx = p[2 * i + 2] - p[0], by = p[2 * i + 3] - p[1];
            double area = 0.5 * (ax * by - ay * bx);
            m.area += area;
            m.x += area * (ax + bx) / 3;
            m.y += area * (ay + by) / 3;
        }
        if (n > 0) {
            m.x += m.area * p[0];
            m.y += m.area * p[1];
        }
        sign = (m.area < 0) != (r > r0) ? -1 : 1; /* the first ring adds, the others take away, whatever their winding */
        all.area += sign * m.area;
        all.x += sign * m.x;
        all.y += sign * m.y;
    }
    return all;
}

void gnoi_shape_box(const gno_shape *shape, size_t polygon, double box[4])
{
    size_t ring = shape->polygon_start ? shape->polygon_start[polygon] : polygon;
    box[0] = box[1] = HUGE_VAL;
    box[2] = box[3] = -HUGE_VAL;
    for (size_t i = shape->ring_start[ring]; i < shape->ring_start[ring + 1]; i++) {
        double x = shape->points[2 * i], y = shape->points[2 * i + 1];
        box[0] = x < box[0] ? x : box[0];
        box[1] = y < box[1] ? y : box[1];
        box[2] = x > box[2] ? x : box[2];
        box[3] = y > box[3] ? y : box[3];
    }
}
