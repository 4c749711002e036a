/* lanes.c -- see lanes.h. Every loop runs over whole lanes without branches, so that compilers make vector code of it. */
#include "scan/lanes.h"
#include "base/tolerance.h"
#include "base/vector.h"

#define INLINE static inline __attribute__((always_inline))

void gnoi_lanes_load(gnoi_lanes *lanes, const gnoi_prepared *prep, const gnoi_bins *bins, const uint32_t *polys, unsigned count)
{
    static const gnoi_vertex nowhere;
    lanes->count = count;
    for (unsigned i = 0; i < GNOI_LANES; i++) {
        uint32_t corners = 0;
        const uint32_t *vertex = i < count ? gnoi_corners_of(prep, polys[i], &corners) : NULL;
        for (unsigned k = 0; k < 3; k++) {
            const gnoi_vertex *v = corners == 3 ? &bins->vertices[vertex[k]] : &nowhere;
            lanes->x[k][i] = v->x;
            lanes->y[k][i] = v->y;
            lanes->z[k][i] = v->z;
            lanes->reach[k][i] = v->reach;
        }
    }
}

INLINE double least(double a, double b) { return a < b ? a : b; }
INLINE double most_of(double a, double b) { return a > b ? a : b; }
INLINE float leastf(float a, float b) { return a < b ? a : b; }
INLINE float mostf(float a, float b) { return a > b ? a : b; }

VECTOR_CLONES static void bound(gnoi_lanes *restrict l)
{
    for (int i = 0; i < GNOI_LANES; i++) {
        l->x0[i] = least(least(l->x[0][i], l->x[1][i]), l->x[2][i]);
        l->x1[i] = most_of(most_of(l->x[0][i], l->x[1][i]), l->x[2][i]);
        l->y0[i] = least(least(l->y[0][i], l->y[1][i]), l->y[2][i]);
        l->y1[i] = most_of(most_of(l->y[0][i], l->y[1][i]), l->y[2][i]);
    }
    for (int i = 0; i < GNOI_LANES; i++) {
        l->z0[i] = leastf(leastf(l->z[0][i], l->z[1][i]), l->z[2][i]);
        l->z1[i] = mostf(mostf(l->z[0][i], l->z[1][i]), l->z[2][i]);
    }
}

void gnoi_lanes_bound(gnoi_lanes *lanes) { bound(lanes); }

typedef struct corner {
    double x, y;
} corner;

INLINE corner higher(corner a, corner b)
{
    corner c = {b.y < a.y ? b.x : a.x, b.y < a.y ? b.y : a.y};
    return c;
}

INLINE corner deeper(corner a, corner b)
{
    corner c = {b.y < a.y ? a.x : b.x, b.y < a.y ? a.y : b.y};
    return c;
}

/* An edge runs from its upper end, so that both polygons at it are crossed at the very same places. */
VECTOR_CLONES static void set_edges(gnoi_lanes *restrict l)
{
    for (int i = 0; i < GNOI_LANES; i++) {
        corner a = {l->x[0][i], l->y[0][i]}, b = {l->x[1][i], l->y[1][i]}, c = {l->x[2][i], l->y[2][i]};
        corner p = higher(a, b), q = deeper(a, b), top = higher(p, c), r = deeper(p, c), middle = higher(q, r), bottom = deeper(q, r);
        l->top_x[i] = top.x;
        l->top_y[i] = top.y;
        l->middle_x[i] = middle.x;
        l->middle_y[i] = middle.y;
        l->bottom_y[i] = bottom.y;
        l->slope[i] = (bottom.x - top.x) / (bottom.y - top.y);
        l->upper[i] = (middle.x - top.x) / (middle.y - top.y);
        l->lower[i] = (bottom.x - middle.x) / (bottom.y - middle.y);
    }
}

void gnoi_lanes_set_edges(gnoi_lanes *lanes) { set_edges(lanes); }

void gnoi_lanes_set_plane(gnoi_lanes *lanes, unsigned lane, const gnoi_poly *poly, double tolerance)
{
    for (int k = 0; k < 3; k++)
        lanes->n[k][lane] = poly->n[k];
    lanes->d[lane] = poly->d;
    lanes->tolerance[lane] = tolerance;
}

double gnoi_lanes_tolerance(const gnoi_lanes *lanes, unsigned lane, const gnoi_bins *bins)
{
    double reach = (double)mostf(mostf(lanes->reach[0][lane], lanes->reach[1][lane]), lanes->reach[2][lane]);
    return GNOI_COPLANAR * reach + GNOI_COORDINATE_NOISE * (reach + bins->middle);
}

INLINE void see(gnoi_lanes *restrict l, const gnoi_view view, const gnoi_rect r)
{
    for (int i = 0; i < GNOI_LANES; i++) {
        double n[3] = {l->n[0][i], l->n[1][i], l->n[2][i]}, side = gnoi_view_side(&view, n, l->d[i]);
        gnoi_screen_plane p = gnoi_view_nearness(&view, n, l->d[i], side);
        double zx0 = p.fx * r.x0, zx1 = p.fx * r.x1, zy0 = p.fy * r.y0, zy1 = p.fy * r.y1;
        l->side[i] = side;
        l->fx[i] = p.fx;
        l->fy[i] = p.fy;
        l->f0[i] = p.f0;
        l->low[i] = (float)(least(zx0, zx1) + least(zy0, zy1) + p.f0);
        l->high[i] = (float)(most_of(zx0, zx1) + most_of(zy0, zy1) + p.f0);
    }
}

VECTOR_CLONES static void see_from_point(gnoi_lanes *restrict l, const gnoi_view *view, const gnoi_rect *rect)
{
    gnoi_view v = *view;
    v.orthographic = 0;
    see(l, v, *rect);
}

VECTOR_CLONES static void see_from_far(gnoi_lanes *restrict l, const gnoi_view *view, const gnoi_rect *rect)
{
    gnoi_view v = *view;
    v.orthographic = 1;
    see(l, v, *rect);
}

void gnoi_lanes_see(gnoi_lanes *lanes, const gnoi_view *view, const gnoi_rect *rect)
{
    if (view->orthographic)
        see_from_far(lanes, view, rect);
    else
        see_from_point(lanes, view, rect);
}

/* One triangle, for a loop over lines. */
typedef struct shape {
    double top_x, top_y, middle_x, middle_y, bottom_y, slope, upper, lower;
} shape;

/* Picture coordinate v as gnoi_lane_position has it, before rounding; `none` where the line is outside of the triangle. */
INLINE double place_on_line(double v, double x, double most, int inside, double none)
{
    double t = (v - x) * GNOI_X_ONE;
    t = t < -(double)GNOI_X_ONE ? -(double)GNOI_X_ONE : t;
    t = t > most ? most : t;
    return inside ? t : none;
}

INLINE int32_t rounded(double t) { return (int32_t)(t + (GNOI_X_ONE + 0.5)) - GNOI_X_ONE; }

/* GNOI_LANE_STEP lines: loops of fixed length, so that no part of them is left to code for the rest; two of them, so that each choice stands alone. */
INLINE void cross_some(int32_t *restrict from, int32_t *restrict to, const double *restrict y, shape s, double x, double most)
{
    double left[GNOI_LANE_STEP], right[GNOI_LANE_STEP];
    for (unsigned i = 0; i < GNOI_LANE_STEP; i++) {
        int above = y[i] < s.middle_y;
        double a = s.top_x + (y[i] - s.top_y) * s.slope;
        double b = (above ? s.top_x : s.middle_x) + (y[i] - (above ? s.top_y : s.middle_y)) * (above ? s.upper : s.lower);
        left[i] = least(a, b);
        right[i] = most_of(a, b);
    }
    for (unsigned i = 0; i < GNOI_LANE_STEP; i++) {
        int inside = (y[i] >= s.top_y) & (y[i] < s.bottom_y);
        from[i] = rounded(place_on_line(left[i], x, most, inside, most));
        to[i] = rounded(place_on_line(right[i], x, most, inside, -(double)GNOI_X_ONE));
    }
}

VECTOR_CLONES static void cross(gnoi_lanes *restrict l, unsigned lane, const double *restrict y, unsigned count, double x, double most)
{
    const shape s = {l->top_x[lane], l->top_y[lane], l->middle_x[lane], l->middle_y[lane], l->bottom_y[lane], l->slope[lane],
                     l->upper[lane], l->lower[lane]};
    for (unsigned i = 0; i < count; i += GNOI_LANE_STEP)
        cross_some(l->from + i, l->to + i, y + i, s, x, most);
}

void gnoi_lanes_cross(gnoi_lanes *lanes, unsigned lane, const double *y, unsigned count, double x, double most)
{
    cross(lanes, lane, y, count, x, most);
}
