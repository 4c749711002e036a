/* region.c -- see region.h. */
#include "shadow/region.h"

/* A candidate is ruled out by an edge of the region when it stays outside of it by this share of the edge's length, far more than the
 * rounding of single precision. What comes nearer is tested exactly: a sliver left lit would be a leak. */
#define PROBE_SLACK -1e-6

/* Corners of the region on the receiver's plane; 0 when the plane's horizon passes through the region. */
static int region_corners(const gnoi_view *view, const gnoi_receiver *r, vec3 corners[4])
{
    double x[4], y[4], z[4], zmax = 0;
    for (int i = 0; i < 4; i++) {
        x[i] = i == 1 || i == 2 ? r->x1 : r->x0;
        y[i] = i >= 2 ? r->y1 : r->y0;
        z[i] = gnoi_plane_at(&r->nearness, x[i], y[i]);
        zmax = fabs(z[i]) > zmax ? fabs(z[i]) : zmax;
    }
    for (int i = 0; i < 4; i++) {
        if (!view->orthographic && !(z[i] > 1e-6 * zmax))
            return 0;
        corners[i] = gnoi_view_point(view, x[i], y[i], z[i]);
    }
    return 1;
}

static float min_f(float a, float b) { return a < b ? a : b; }
static float max_f(float a, float b) { return a > b ? a : b; }

/* Both boxes hold the receiver's region, so their common part does. */
static void box_intersect(gnoi_lbox *a, const gnoi_lbox *b)
{
    a->u0 = max_f(a->u0, b->u0);
    a->u1 = min_f(a->u1, b->u1);
    a->v0 = max_f(a->v0, b->v0);
    a->v1 = min_f(a->v1, b->v1);
    a->z0 = max_f(a->z0, b->z0);
    a->z1 = min_f(a->z1, b->z1);
}

static int on_hull(const gnoi_frame *frame, const vec3 *hull, int count, gnoi_region *region)
{
    region->count = count;
    if (!gnoi_frame_locate(frame, hull, count, region->corner))
        return 0;
    gnoi_frame_box(frame, region->corner, count, &region->box);
    return 1;
}

/* On a plane seen nearly edge on the picture region reaches far beyond the polygon. */
static int on_corners(const gnoi_frame *frame, const vec3 corners[4], const vec3 *hull, int count, gnoi_region *region)
{
    gnoi_lbox boxes[6];
    region->count = 4;
    if (!gnoi_frame_locate(frame, corners, 4, region->corner))
        return 0;
    gnoi_frame_box(frame, region->corner, 4, &region->box);
    if (gnoi_frame_boxes(frame, hull, count, boxes) == 1 &&
        gnoi_frame_face(frame, (double)boxes[0].u0) == gnoi_frame_face(frame, (double)region->box.u0))
        box_intersect(&region->box, &boxes[0]);
    return 1;
}

int gnoi_region_make(const gno_scene *scene, const gnoi_view *view, const gnoi_frame *frame, const gnoi_receiver *r, gnoi_region *region,
                     gnoi_lbox boxes[6], int *box_count)
{
    vec3 hull[GNOI_FRAME_POINTS], corners[4];
    int count = gnoi_poly_hull(scene, r->poly, hull), seen = !r->whole && region_corners(view, r, corners);
    *box_count = 0;
    if ((seen && on_corners(frame, corners, hull, count, region)) || ((r->whole || count == 3) && on_hull(frame, hull, count, region)))
        return 1;
    *box_count = seen && frame->faces == 6 ? gnoi_frame_boxes(frame, corners, 4, boxes) : gnoi_frame_boxes(frame, hull, count, boxes);
    return 0;
}

/* The convex region's edges on the light's plane. */
static void set_edges(gnoi_probe *probe, const gnoi_lpoint *p, int count)
{
    double area = 0;
    for (int i = 1; i + 1 < count; i++)
        area += (p[i].u - p[0].u) * (p[i + 1].v - p[0].v) - (p[i].v - p[0].v) * (p[i + 1].u - p[0].u);
    for (int i = 0; i < count; i++) {
        const gnoi_lpoint *a = &p[i], *b = &p[i + 1 < count ? i + 1 : 0];
        double s = area < 0 ? -1 : 1, du = (b->u - a->u) * s, dv = (b->v - a->v) * s;
        probe->a[i] = -dv;
        probe->b[i] = du;
        probe->c[i] = dv * a->u - du * a->v;
        probe->slack[i] = PROBE_SLACK * (du * du + dv * dv);
    }
    probe->edge_count = count;
}

/* The receiver's plane as nearness to the light over (u,v): from three of the points, when they span it. */
static int set_plane(gnoi_probe *probe, const gnoi_pair *p, const gnoi_lpoint *l, int count)
{
    double lift = 0.5 * p->tolerance / p->lamp_height, best = 0;
    int k = 1;
    const gnoi_lpoint *a = &l[0], *b, *c;
    for (int i = 1; i + 1 < count; i++) {
        double area = fabs((l[i].u - a->u) * (l[i + 1].v - a->v) - (l[i].v - a->v) * (l[i + 1].u - a->u));
        if (area > best) {
            best = area;
            k = i;
        }
    }
    if (!(best > 0))
        return 0;
    b = &l[k];
    c = &l[k + 1];
    best = (b->u - a->u) * (c->v - a->v) - (b->v - a->v) * (c->u - a->u);
    probe->qa = ((b->q - a->q) * (c->v - a->v) - (b->v - a->v) * (c->q - a->q)) / best;
    probe->qb = ((b->u - a->u) * (c->q - a->q) - (b->q - a->q) * (c->u - a->u)) / best;
    probe->qc = a->q - probe->qa * a->u - probe->qb * a->v;
    /* Height t over the plane lifts nearness by t q / H (point lamp) or t / cosine. */
    probe->lift = p->lamp->directional ? lift : lift * a->q;
    probe->qc += probe->lift;
    return 1;
}

int gnoi_region_probe(const gnoi_pair *p, const gnoi_region *region, gnoi_probe *probe)
{
    probe->edge_count = 0;
    if (!p->receiver->whole || p->triangle)
        set_edges(probe, region->corner, region->count);
    return set_plane(probe, p, region->corner, region->count);
}

vec3 gnoi_region_centre(const gnoi_pair *p, const gnoi_frame *frame, const gnoi_region *region)
{
    const gnoi_lbox *box = &region->box;
    vec3 from, along;
    if (p->receiver->whole) {
        vec3 sum = v3(0, 0, 0);
        for (uint32_t i = 0; i < 3; i++)
            sum = v3_add(sum, gnoi_corner_position(p->scene, p->receiver->poly->corner + i));
        return v3_scale(sum, 1.0 / 3);
    }
    gnoi_frame_ray(frame, 0.5 * ((double)box->u0 + (double)box->u1), 0.5 * ((double)box->v0 + (double)box->v1), &from, &along);
    return v3_mad(from, along, -gnoi_form_at(&p->h, from) / v3_dot(p->h.a, along));
}
