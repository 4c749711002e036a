/* tile_glint.c -- highlights that change within a pixel: see tile.h.
 *
 * A sample is lit once, in the middle of what it stands for. The mean of (R.S)^n over that part differs from the value in its middle by
 * half the second derivative times the part's variance: where the interpolated normal turns by an angle of variance v, R turns twice as
 * far and (R.S)^n bends by up to n, the error is up to 2 n v. Where that may be seen the sample is lit in several points: by the rules of Gauss
 * (2 x 2 points) and, for what is narrower still, of Chebyshev (4 x 4 points of one weight).
 * Source: Abramowitz and Stegun, Handbook of Mathematical Functions, 25.4.28 and 25.4.29.
 */
#include "engine/tile.h"
#include "project/clip3.h"
#include <math.h>

/* From this error on, relative to the highlight, two points a side are too few. */
#define NARROW 0.7
/* Areas count as the same that differ by less than this share. */
#define SAME_AREA 0.2

/* The normal's turn for a step by g, whose components are slopes of n's, squared. */
static double turn_squared(vec3 n, vec3 g, double length_squared)
{
    double along = v3_dot(n, g);
    return (v3_dot(g, g) * length_squared - along * along) / (length_squared * length_squared);
}

/* Whether a lamp that reaches sample i of the batch has its highlight near. */
static int is_near_highlight(const gnoi_tile *tile, int i, float edge)
{
    const gnoi_frame_job *job = tile->job;
    const gnoi_batch *b = &tile->batch;
    vec3 p = v3((double)b->px[i], (double)b->py[i], (double)b->pz[i]), n = v3_unit(v3((double)b->nx[i], (double)b->ny[i], (double)b->nz[i]));
    vec3 s = job->view.orthographic ? v3_scale(job->view.forward, -1) : v3_scale(v3_unit(p), -1);
    vec3 r = v3_mad(v3_scale(s, -1), n, 2 * v3_dot(n, s)); /* the viewer's direction mirrored: R.S is the same with L and S exchanged */
    for (int j = 0; j < job->lamp_count; j++) {
        const gnoi_lamp *lamp = &job->lamps[j];
        if (!(b->weight[(size_t)j * GNOI_BATCH + (size_t)i] > 0))
            continue;
        vec3 l = lamp->directional ? lamp->to_light : v3_unit(v3_sub(v3_sub(lamp->position, job->view.eye), p));
        if (v3_dot(r, l) > (double)edge)
            return 1;
    }
    return 0;
}

/* ---- what the part looks like -------------------------------------------------------------------------------------- */

/* The box that has the part's variance: half its sides. */
typedef struct box {
    double a[2], b[2];
} box;

static void upright_box(double half_x, double half_y, box *half)
{
    half->a[0] = half_x;
    half->b[1] = half_y;
    half->a[1] = half->b[0] = 0;
}

/* From the part's middle and area alone: the widest box within the pixel about that middle, scaled to that area. */
static void guess_box(double off_x, double off_y, double area, box *half)
{
    double x = 0.5 - fabs(off_x) + 1e-6, y = 0.5 - fabs(off_y) + 1e-6, scale = sqrt(area / (4 * x * y));
    upright_box(x * scale < 0.5 ? x * scale : 0.5, y * scale < 0.5 ? y * scale : 0.5, half);
}

/* Cuts a triangle of the picture by the pixel whose top left corner is (left,top); returns the number of points, which are relative to
 * the pixel's centre. */
static size_t cut_triangle(const gnoi_vertex *const v[3], double left, double top, gnoi_hpoint ring[16])
{
    gnoi_hpoint other[16], *from = ring, *to = other;
    size_t count = 3;
    for (int i = 0; i < 3; i++) {
        ring[i].x = v[i]->x - left - 0.5;
        ring[i].y = v[i]->y - top - 0.5;
        ring[i].w = 1;
    }
    for (int side = 0; side < 4; side++) {
        gnoi_hpoint *swap = from;
        for (size_t i = 0; i < count; i++)
            from[i].side = 0.5 + (side & 1 ? -1 : 1) * (side & 2 ? from[i].y : from[i].x);
        count = gnoi_clip_ring(from, count, to);
        from = to;
        to = swap;
    }
    return count;
}

/* Area and second moments (xx, xy, yy) about the middle of a convex ring. */
static double moments(const gnoi_hpoint *ring, size_t count, double second[3])
{
    double area = 0, sum_x = 0, sum_y = 0, xx = 0, xy = 0, yy = 0;
    for (size_t i = 1; i + 1 < count; i++) {
        double ax = ring[i].x - ring[0].x, ay = ring[i].y - ring[0].y, bx = ring[i + 1].x - ring[0].x, by = ring[i + 1].y - ring[0].y;
        double t = 0.5 * (ax * by - ay * bx);
        area += t;
        sum_x += t * (ax + bx) / 3;
        sum_y += t * (ay + by) / 3;
        xx += t * (ax * ax + ax * bx + bx * bx) / 6;
        xy += t * (ax * ay + bx * by + 0.5 * (ax * by + bx * ay)) / 6;
        yy += t * (ay * ay + ay * by + by * by) / 6;
    }
    second[0] = second[1] = second[2] = 0;
    if (area == 0)
        return 0;
    second[0] = xx / area - sum_x * sum_x / (area * area);
    second[1] = xy / area - sum_x * sum_y / (area * area);
    second[2] = yy / area - sum_y * sum_y / (area * area);
    return fabs(area);
}

/* The box along the principal axes of second moments, each of which is a third of half a side squared. */
static void principal_box(const double second[3], box *half)
{
    double apart = sqrt((second[0] - second[2]) * (second[0] - second[2]) + 4 * second[1] * second[1]);
    double large = 0.5 * (second[0] + second[2] + apart), small = 0.5 * (second[0] + second[2] - apart);
    double x = second[1], y = large - second[0], length;
    if (second[0] > second[2]) {
        x = large - second[2];
        y = second[1];
    }
    length = sqrt(x * x + y * y);
    large = sqrt(3 * (large > 0 ? large : 0));
    small = sqrt(3 * (small > 0 ? small : 0));
    if (!(length > 0)) {
        upright_box(large, small, half);
        return;
    }
    half->a[0] = large * x / length;
    half->a[1] = large * y / length;
    half->b[0] = -small * y / length;
    half->b[1] = small * x / length;
}

/* From the slot's triangle and the pixel, where the part is about as large as what they have in common; else as guess_box. */
static void find_box(const gnoi_tile *tile, const gnoi_slot *slot, int row, int column, double x, double y, double area, box *half)
{
    const gnoi_prepared *prep = &tile->job->scene->prepared;
    const gnoi_vertex *v[3];
    gnoi_hpoint ring[16];
    double left = tile->x0 + column, top = tile->y0 + row - 1, second[3];
    for (int i = 0; i < 3; i++)
        v[i] = &tile->job->bins.vertices[prep->corner_vertex[slot->interp.corner[i]]];
    if (slot->interp.triangle_count == 1 && fabs(v[0]->x) < HUGE_VAL && fabs(v[1]->x) < HUGE_VAL && fabs(v[2]->x) < HUGE_VAL) {
        double common = moments(ring, cut_triangle(v, left, top, ring), second);
        if (fabs(common - area) < SAME_AREA * area) {
            principal_box(second, half);
            return;
        }
    }
    guess_box(x - left - 0.5, y - top - 0.5, area, half);
}

/* ---- points ---------------------------------------------------------------------------------------------------------- */

static vec3 blend(vec3 a, vec3 b, const double by[2]) { return v3_add(v3_scale(a, by[0]), v3_scale(b, by[1])); }

/* The variance of the normal's angle over the part. */
static double variance_of(const gnoi_slot *slot, double x, double y, const box *half)
{
    const gnoi_screen_plane *f = slot->interp.normal;
    vec3 n = v3(gnoi_plane_at(&f[0], x, y), gnoi_plane_at(&f[1], x, y), gnoi_plane_at(&f[2], x, y));
    vec3 gx = v3(f[0].fx, f[1].fx, f[2].fx), gy = v3(f[0].fy, f[1].fy, f[2].fy);
    double length_squared = v3_dot(n, n);
    return (turn_squared(n, blend(gx, gy, half->a), length_squared) + turn_squared(n, blend(gx, gy, half->b), length_squared)) / 3;
}

static int place(double x, double y, const box *half, const double *rule, int n, double (*at)[2])
{
    int count = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++, count++) {
            at[count][0] = x + half->a[0] * rule[i] + half->b[0] * rule[j];
            at[count][1] = y + half->a[1] * rule[i] + half->b[1] * rule[j];
        }
    return count;
}

int gnoi_tile_glint(const gnoi_tile *tile, const gnoi_slot *slot, int i, int row, int column, double x, double y, double (*at)[2])
{
    static const double gauss[2] = {-0.57735026918962576, 0.57735026918962576};
    static const double chebyshev[4] = {-0.79465447229176613, -0.18759247408507990, 0.18759247408507990, 0.79465447229176613};
    const gnoi_tone *tone = &tile->job->tones[slot->receiver.poly->material];
    float share = tile->batch.coverage[i] * tile->pixel_share[column];
    double variance;
    box half;
    if (!is_near_highlight(tile, i, tone->glint_edge))
        return 1;
    find_box(tile, slot, row, column, x, y, (double)share, &half);
    variance = variance_of(slot, x, y, &half);
    if (!(variance * (double)(share * tone->glint) > (double)GNOI_GLINT_ERROR))
        return 1;
    if (2 * variance * (double)tone->shininess > NARROW)
        return place(x, y, &half, chebyshev, 4, at);
    return place(x, y, &half, gauss, 2, at);
}
