/* interval.c -- where a sample line meets the shadow polygons of a column, and the dark outside of a spot's cone: see column.h. */
#include "shadow/holes.h"
#include "shadow/pair.h"

/* Share of the nearness at a line's other end below which a plane is taken to be at its horizon. */
#define HORIZON_SHARE 1e-9

/* ---- spot cones --------------------------------------------------------------------------------------------------- */

static int in_cone(const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *r, double x, double y)
{
    double z = gnoi_plane_at(&r->nearness, x, y);
    vec3 v;
    if (!view->orthographic && !(z > 0))
        return 0;
    v = v3_sub(gnoi_view_point(view, x, y, z), lamp->position);
    return v3_dot(v, lamp->axis) >= lamp->cos_half_angle * v3_length(v);
}

int gnoi_interval_add(gnoi_columns *columns, double x0, double x1, const double *transmission)
{
    gno_shadow_interval *s;
    if (columns->interval_count == columns->interval_capacity &&
        !gnoi_reserve(columns->context, (void **)&columns->intervals, &columns->interval_capacity, columns->interval_count + 1,
                      sizeof *columns->intervals))
        return 0;
    s = &columns->intervals[columns->interval_count++];
    s->x0 = x0;
    s->x1 = x1;
    for (int k = 0; k < 3; k++)
        s->transmission[k] = transmission ? transmission[k] : 0;
    return 1;
}

/* Roots in (xa,xb) of the quadratic through the cone's boundary: with V = (P - light) scaled to be linear in x,
 * (V.axis)^2 = cos^2 V.V. */
static int cone_roots(const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *r, double y, double xa, double xb,
                      double roots[2])
{
    double za = gnoi_plane_at(&r->nearness, xa, y), zb = gnoi_plane_at(&r->nearness, xb, y), c2, a, b, c, disc, q, t[2];
    vec3 va, vb, dv;
    int n = 0;
    if (!view->orthographic && (!(za > 0) || !(zb > 0)))
        return 0;
    va = v3_sub(gnoi_view_point(view, xa, y, za), lamp->position);
    vb = v3_sub(gnoi_view_point(view, xb, y, zb), lamp->position);
    if (!view->orthographic) {
        va = v3_scale(va, za);
        vb = v3_scale(vb, zb);
    }
    dv = v3_sub(vb, va);
    c2 = lamp->cos_half_angle * lamp->cos_half_angle;
    a = v3_dot(dv, lamp->axis) * v3_dot(dv, lamp->axis) - c2 * v3_dot(dv, dv);
    b = v3_dot(va, lamp->axis) * v3_dot(dv, lamp->axis) - c2 * v3_dot(va, dv);
    c = v3_dot(va, lamp->axis) * v3_dot(va, lamp->axis) - c2 * v3_dot(va, va);
    disc = b * b - a * c;
    if (!(disc > 0))
        return 0;
    q = -(b + (b < 0 ? -sqrt(disc) : sqrt(disc)));
    t[0] = a != 0 ? q / a : -1;
    t[1] = q != 0 ? c / q : -1;
    if (t[0] > t[1]) {
        double swap = t[0];
        t[0] = t[1];
        t[1] = swap;
    }
    for (int i = 0; i < 2; i++)
        if (t[i] > 0 && t[i] < 1)
            roots[n++] = xa + t[i] * (xb - xa);
    return n;
}

/* Narrows [*xa,*xb] to where the receiver's plane is before the eye, short of its horizon; 0 when that is nowhere. */
static int clip_at_horizon(const gnoi_receiver *r, double y, double *xa, double *xb)
{
    double za = gnoi_plane_at(&r->nearness, *xa, y), zb = gnoi_plane_at(&r->nearness, *xb, y);
    double least = HORIZON_SHARE * (fabs(za) > fabs(zb) ? fabs(za) : fabs(zb)), at;
    if (!(za > least) && !(zb > least))
        return 0;
    at = *xa + (za - least) / (za - zb) * (*xb - *xa);
    if (!(za > least))
        *xa = at;
    else if (!(zb > least))
        *xb = at;
    return 1;
}

static int add_cone_intervals(const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *r, double y, double xa, double xb,
                              gnoi_columns *columns)
{
    double ends[4];
    int n;
    if (!view->orthographic && !clip_at_horizon(r, y, &xa, &xb))
        return 1;
    n = cone_roots(view, lamp, r, y, xa, xb, ends + 1);
    ends[0] = xa;
    ends[n + 1] = xb;
    for (int i = 0; i <= n; i++)
        if (!in_cone(view, lamp, r, 0.5 * (ends[i] + ends[i + 1]), y) && !gnoi_interval_add(columns, ends[i], ends[i + 1], NULL))
            return 0;
    return 1;
}

/* One receiver under one lamp. */
typedef struct gnoi_shade {
    const gno_scene *scene;
    const gnoi_view *view;
    const gnoi_lamp *lamp;
    const gnoi_receiver *receiver;
} gnoi_shade;

/* The shadow of a caster with holes on [x0,x1), pixel by pixel; neighbours with the same light are one. */
static int holed_interval(const gnoi_shade *shade, const gnoi_caster *c, double y, double x0, double x1, gnoi_columns *columns)
{
    double from = x0, light[3] = {0, 0, 0};
    for (double x = x0; x < x1;) {
        double end = floor(x) + 1, now[3];
        end = end < x1 ? end : x1;
        gnoi_holes_through(shade->scene, shade->view, shade->lamp, shade->receiver, c->poly, 0.5 * (x + end), y, now);
        if (x > x0 && (now[0] != light[0] || now[1] != light[1] || now[2] != light[2])) {
            if (!gnoi_interval_add(columns, from, x, light))
                return 0;
            from = x;
        }
        for (int k = 0; k < 3; k++)
            light[k] = now[k];
        x = end;
    }
    return !(from < x1) || gnoi_interval_add(columns, from, x1, light);
}

/* Where line y crosses the caster between xa and xb, in pairs (even-odd filling). */
static int caster_intervals(const gnoi_shade *shade, const gnoi_caster *c, double y, double xa, double xb, gnoi_columns *columns)
{
    const gno_material *m = &shade->scene->materials[c->material];
    double *x = columns->crossings;
    uint32_t n = gnoi_edges_cross(columns->edges + c->edge, c->edge_count, y, x);
    if (gnoi_has_holes(shade->scene, m)) {
        for (uint32_t i = 0; i + 1 < n; i += 2)
            if (x[i] < x[i + 1] && !holed_interval(shade, c, y, x[i] > xa ? x[i] : xa, x[i + 1] < xb ? x[i + 1] : xb, columns))
                return 0;
        return 1;
    }
    for (uint32_t i = 0; i + 1 < n; i += 2)
        if (x[i] < x[i + 1] && x[i] < xb && x[i + 1] > xa && !gnoi_interval_add(columns, x[i], x[i + 1], m->transmission))
            return 0;
    return 1;
}

/* Names the polygon behind the intervals from `first` on. */
static int note_source(gnoi_columns *columns, size_t first, uint32_t poly)
{
    if (!gnoi_reserve(columns->context, (void **)&columns->sources, &columns->source_capacity, columns->interval_count,
                      sizeof *columns->sources))
        return 0;
    for (size_t i = first; i < columns->interval_count; i++)
        columns->sources[i] = poly;
    return 1;
}

/* Distance from the receiver's point p to the caster's plane along the ray to the lamp; 0 where rounding puts it behind. */
static double caster_distance(const gnoi_lamp *lamp, const gnoi_poly *caster, vec3 p)
{
    vec3 to = lamp->directional ? lamp->to_light : v3_sub(lamp->position, p), n = v3_from(caster->n);
    double along = v3_dot(n, to), t = along != 0 ? -(v3_dot(n, p) + caster->d) / along : 0;
    return t > 0 ? t * v3_length(to) : 0;
}

void gnoi_caster_light(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *receiver, uint32_t caster,
                       double x, double y, double light[3])
{
    const gnoi_poly *poly = &scene->prepared.polys[caster];
    const gno_material *m = &scene->materials[poly->material];
    double z = gnoi_plane_at(&receiver->nearness, x, y), t[3] = {m->transmission[0], m->transmission[1], m->transmission[2]};
    double d = caster_distance(lamp, poly, gnoi_view_point(view, x, y, z));
    if (gnoi_has_holes(scene, m))
        gnoi_holes_through(scene, view, lamp, receiver, caster, x, y, t);
    for (int k = 0; k < 3; k++)
        light[k] = 1 - (1 - t[k]) / (1 + d / lamp->softness);
}

/* `sources` is a constant at each call, so that the usual lamp does not ask for each caster. */
static inline int collect(const gnoi_shade *shade, const gnoi_column *column, double y, double xa, double xb, int sources,
                          gnoi_columns *columns)
{
    const gnoi_receiver *receiver = shade->receiver;
    float fy = (float)y, fa = (float)xa, fb = (float)xb;
    gnoi_row_list list = gnoi_row_list_of(columns, receiver, column->rows, column->caster, column->caster_count, gnoi_region_row(receiver, y));
    size_t before;
    for (uint32_t i = 0; i < list.count; i++) {
        const gnoi_caster *c = &columns->casters[gnoi_row_list_item(&list, i)];
        if (fy < c->y0 || fy > c->y1 || c->x0 > fb || c->x1 < fa)
            continue;
        if (c->edge_count > columns->crossing_capacity &&
            !gnoi_reserve(columns->context, (void **)&columns->crossings, &columns->crossing_capacity, c->edge_count,
                          sizeof *columns->crossings))
            return 0;
        before = columns->interval_count;
        if (!caster_intervals(shade, c, y, xa, xb, columns) || (sources && !note_source(columns, before, c->poly)))
            return 0;
    }
    return 1;
}

int gnoi_column_intervals(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_casters *casters,
                          const gnoi_receiver *receiver, gnoi_column *column, double y, double xa, double xb, gnoi_columns *columns)
{
    gnoi_shade shade = {scene, view, lamp, receiver};
    size_t before;
    columns->interval_count = 0;
    if (lamp->softness > 0) { /* nothing is halved, there is no sheet */
        if (!collect(&shade, column, y, xa, xb, 1, columns))
            return 0;
        before = columns->interval_count;
        return (!lamp->spot || add_cone_intervals(view, lamp, receiver, y, xa, xb, columns)) && note_source(columns, before, GNOI_NONE);
    }
    if (column->caster_count > 0 && !collect(&shade, column, y, xa, xb, 0, columns))
        return 0;
    if (column->sheet && !gnoi_sheet_intervals(scene, view, lamp, casters, receiver, column, y, xa, xb, columns))
        return 0;
    return !lamp->spot || add_cone_intervals(view, lamp, receiver, y, xa, xb, columns);
}
