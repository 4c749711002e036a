/* hidden.c -- see hidden.h. */
#include "shadow/hidden.h"

#include <math.h>

/* Limits beyond which the clipper is the better way. */
#define FRAGMENTS 16
#define CORNERS 16
#define SHADOWS 32

/* Fragments smaller than this share of the region are rounding. */
#define NOTHING 1e-13

typedef struct fragment {
    int count;
    gnoi_point2 p[CORNERS];
} fragment;

static double area_of(const gnoi_point2 *p, int count)
{
    double area = 0;
    for (int i = 1; i + 1 < count; i++)
        area += 0.5 * ((p[i].x - p[0].x) * (p[i + 1].y - p[0].y) - (p[i].y - p[0].y) * (p[i + 1].x - p[0].x));
    return area;
}

/* Cuts f by the line through a and b: what lies on the right goes to *right, the rest stays. 0 when corners run out. */
static int cut(fragment *f, gnoi_point2 a, gnoi_point2 b, fragment *right)
{
    double side[CORNERS], ex = b.x - a.x, ey = b.y - a.y;
    fragment left;
    left.count = right->count = 0;
    for (int i = 0; i < f->count; i++)
        side[i] = ex * (f->p[i].y - a.y) - ey * (f->p[i].x - a.x);
    for (int i = 0; i < f->count; i++) {
        int k = i + 1 < f->count ? i + 1 : 0;
        if (left.count + 2 > CORNERS || right->count + 2 > CORNERS)
            return 0;
        if (side[i] >= 0)
            left.p[left.count++] = f->p[i];
        if (side[i] <= 0)
            right->p[right->count++] = f->p[i];
        if ((side[i] > 0 && side[k] < 0) || (side[i] < 0 && side[k] > 0)) {
            double t = side[i] / (side[i] - side[k]);
            gnoi_point2 q;
            q.x = f->p[i].x + t * (f->p[k].x - f->p[i].x);
            q.y = f->p[i].y + t * (f->p[k].y - f->p[i].y);
            left.p[left.count++] = q;
            right->p[right->count++] = q;
        }
    }
    *f = left;
    return 1;
}

/* 1 when all of f lies on the right of an edge of the ring, wound by `turn`. */
static int apart(const fragment *f, const gnoi_point2 *ring, int count, int turn)
{
    for (int i = 0; i < count; i++) {
        gnoi_point2 a = ring[i], b = ring[i + 1 < count ? i + 1 : 0];
        int out = 0;
        while (out < f->count && turn * ((b.x - a.x) * (f->p[out].y - a.y) - (b.y - a.y) * (f->p[out].x - a.x)) <= 0)
            out++;
        if (out == f->count)
            return 1;
    }
    return 0;
}

/* Takes a convex ring out of the fragments. 0 when there is no room. */
static int take_out(fragment *all, int *count, const gnoi_point2 *ring, int ring_count, double nothing)
{
    fragment left[FRAGMENTS], right;
    int n = 0, turn = area_of(ring, ring_count) < 0 ? -1 : 1;
    for (int i = 0; i < *count; i++) {
        fragment f = all[i];
        int meets = !apart(&f, ring, ring_count, turn);
        if (!meets) {
            if (n == FRAGMENTS)
                return 0;
            left[n++] = f;
        }
        for (int k = 0; k < ring_count && meets && f.count > 2; k++) {
            gnoi_point2 a = ring[k], b = ring[k + 1 < ring_count ? k + 1 : 0];
            if (!cut(&f, turn > 0 ? a : b, turn > 0 ? b : a, &right))
                return 0;
            if (right.count > 2 && fabs(area_of(right.p, right.count)) > nothing) {
                if (n == FRAGMENTS)
                    return 0;
                left[n++] = right;
            }
        }
    }
    for (int i = 0; i < n; i++)
        all[i] = left[i];
    *count = n;
    return 1;
}

int gnoi_wholly_hidden(const gnoi_point2 *region, int count, const gnoi_shape *shadows, const unsigned char *convex)
{
    fragment all[FRAGMENTS];
    gnoi_point2 ring[CORNERS];
    double nothing = NOTHING * fabs(area_of(region, count));
    int n = 1;
    if (count > CORNERS || shadows->polygon_count > SHADOWS)
        return 0;
    all[0].count = count;
    for (int i = 0; i < count; i++)
        all[0].p[i] = region[i];
    for (size_t k = 0; k < shadows->polygon_count && n > 0; k++) {
        size_t first = shadows->ring_start[shadows->polygon_start[k]], corners = shadows->ring_start[shadows->polygon_start[k] + 1] - first;
        if (!convex[k] || corners > CORNERS)
            continue;
        for (size_t i = 0; i < corners; i++) {
            ring[i].x = shadows->points[2 * (first + i)];
            ring[i].y = shadows->points[2 * (first + i) + 1];
        }
        if (!take_out(all, &n, ring, (int)corners, nothing))
            return 0;
    }
    return n == 0;
}
