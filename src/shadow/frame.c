/* frame.c -- see frame.h. */
#include "shadow/frame.h"
#include <float.h>

/* A point light's single plane serves while the scene stays within this slope from its axis. */
#define CONE_SLOPE 2.5
#define SLACK 2e-6
/* A cut turns n points into at most 3n/2: 8, 12, 18, 27, 40. */
#define CUT_POINTS 40

static vec3 perpendicular_to(vec3 a)
{
    vec3 e = fabs(a.x) <= fabs(a.y) && fabs(a.x) <= fabs(a.z) ? v3(1, 0, 0) : fabs(a.y) <= fabs(a.z) ? v3(0, 1, 0) : v3(0, 0, 1);
    return v3_unit(v3_cross(a, e));
}

static void set_axes(gnoi_frame *frame, vec3 depth)
{
    frame->axis[2] = depth;
    frame->axis[0] = perpendicular_to(depth);
    frame->axis[1] = v3_cross(depth, frame->axis[0]);
}

static int within_cone(const gnoi_frame *frame, const double lower[3], const double upper[3])
{
    for (int i = 0; i < 8; i++) {
        vec3 p = v3(i & 1 ? upper[0] : lower[0], i & 2 ? upper[1] : lower[1], i & 4 ? upper[2] : lower[2]);
        vec3 q = v3_sub(p, frame->origin);
        double z = v3_dot(q, frame->axis[2]);
        if (!(z > 0) || fabs(v3_dot(q, frame->axis[0])) > CONE_SLOPE * z || fabs(v3_dot(q, frame->axis[1])) > CONE_SLOPE * z)
            return 0;
    }
    return 1;
}

gnoi_frame gnoi_frame_make(const gnoi_lamp *lamp, const double lower[3], const double upper[3])
{
    gnoi_frame frame;
    vec3 centre = v3_scale(v3_add(v3_from(lower), v3_from(upper)), 0.5);
    double size = v3_length(v3_sub(v3_from(upper), v3_from(lower)));
    frame.parallel = lamp->directional;
    frame.faces = 1;
    frame.origin = lamp->directional ? centre : lamp->position;
    if (lamp->directional) {
        set_axes(&frame, v3_scale(lamp->to_light, -1));
        frame.slack = SLACK * size;
        frame.slack_depth = SLACK * size;
        return frame;
    }
    set_axes(&frame, v3_unit(v3_sub(centre, frame.origin)));
    frame.slack = SLACK * CONE_SLOPE;
    frame.slack_depth = SLACK * (size + v3_length(v3_sub(centre, frame.origin)));
    if (within_cone(&frame, lower, upper))
        return frame;
    frame.faces = 6;
    frame.slack = SLACK * GNOI_FACE_STEP;
    return frame;
}

static void box_clear(gnoi_lbox *box)
{
    box->u0 = box->v0 = box->z0 = FLT_MAX;
    box->u1 = box->v1 = box->z1 = -FLT_MAX;
}

static void box_add(gnoi_lbox *box, double u, double v, double z)
{
    float fu = (float)u, fv = (float)v, fz = (float)z;
    box->u0 = fu < box->u0 ? fu : box->u0;
    box->u1 = fu > box->u1 ? fu : box->u1;
    box->v0 = fv < box->v0 ? fv : box->v0;
    box->v1 = fv > box->v1 ? fv : box->v1;
    box->z0 = fz < box->z0 ? fz : box->z0;
    box->z1 = fz > box->z1 ? fz : box->z1;
}

/* (u axis, v axis, depth) of a cube face: faces 0..5 look along +x, -x, +y, -y, +z, -z. */
static vec3 to_face(vec3 q, int face)
{
    double s = face & 1 ? -1 : 1;
    switch (face >> 1) {
    case 0: return v3(q.y, q.z, s * q.x);
    case 1: return v3(q.z, q.x, s * q.y);
    default: return v3(q.x, q.y, s * q.z);
    }
}

static vec3 from_face(vec3 q, int face)
{
    double s = face & 1 ? -1 : 1;
    switch (face >> 1) {
    case 0: return v3(s * q.z, q.x, q.y);
    case 1: return v3(q.y, s * q.z, q.x);
    default: return v3(q.x, q.y, s * q.z);
    }
}

/* The value that is >= 0 inside one side plane of the face's pyramid. */
static double pyramid_side(vec3 q, int side)
{
    switch (side) {
    case 0: return q.z - q.x;
    case 1: return q.z + q.x;
    case 2: return q.z - q.y;
    default: return q.z + q.y;
    }
}

static int clip_pyramid_side(const vec3 *in, int count, int side, vec3 *out)
{
    int n = 0;
    for (int i = 0; i < count; i++) {
        vec3 a = in[i], b = in[i + 1 < count ? i + 1 : 0];
        double sa = pyramid_side(a, side), sb = pyramid_side(b, side);
        if (sa >= 0)
            out[n++] = a;
        if ((sa > 0 && sb < 0) || (sa < 0 && sb > 0))
            out[n++] = v3_mad(a, v3_sub(b, a), sa / (sa - sb));
    }
    return n;
}

static int dominant_face(vec3 q)
{
    double x = fabs(q.x), y = fabs(q.y), z = fabs(q.z);
    if (x >= y && x >= z)
        return q.x < 0;
    if (y >= z)
        return 2 + (q.y < 0);
    return 4 + (q.z < 0);
}

int gnoi_frame_face(const gnoi_frame *frame, double u) { return frame->faces == 1 ? 0 : (int)floor(u / GNOI_FACE_STEP + 0.5); }

void gnoi_frame_ray(const gnoi_frame *frame, double u, double v, vec3 *from, vec3 *along)
{
    vec3 across = v3_mad(v3_scale(frame->axis[0], u), frame->axis[1], v);
    int face = gnoi_frame_face(frame, u);
    *from = frame->parallel ? v3_add(frame->origin, across) : frame->origin;
    *along = frame->faces == 6  ? from_face(v3(u - GNOI_FACE_STEP * face, v, 1), face)
             : frame->parallel ? frame->axis[2]
                               : v3_add(frame->axis[2], across);
}

int gnoi_frame_locate_on(const gnoi_frame *frame, int face, const vec3 *points, int count, gnoi_lpoint *located)
{
    if (frame->faces == 1)
        return gnoi_frame_locate(frame, points, count, located);
    for (int i = 0; i < count; i++) {
        vec3 q = to_face(v3_sub(points[i], frame->origin), face);
        if (!(q.z > 0))
            return 0;
        located[i].q = 1 / q.z;
        located[i].u = q.x * located[i].q + GNOI_FACE_STEP * face;
        located[i].v = q.y * located[i].q;
    }
    return 1;
}

static int locate_on_cube(const gnoi_frame *frame, const vec3 *points, int count, gnoi_lpoint *located)
{
    int face = dominant_face(v3_sub(points[0], frame->origin));
    for (int i = 0; i < count; i++) {
        vec3 q = to_face(v3_sub(points[i], frame->origin), face);
        if (!(q.z > 0) || fabs(q.x) > q.z || fabs(q.y) > q.z)
            return 0;
        located[i].q = 1 / q.z;
        located[i].u = q.x * located[i].q + GNOI_FACE_STEP * face;
        located[i].v = q.y * located[i].q;
    }
    return 1;
}

int gnoi_frame_locate(const gnoi_frame *frame, const vec3 *points, int count, gnoi_lpoint *located)
{
    if (frame->faces == 6)
        return locate_on_cube(frame, points, count, located);
    for (int i = 0; i < count; i++) {
        vec3 q = v3_sub(points[i], frame->origin);
        double x = v3_dot(q, frame->axis[0]), y = v3_dot(q, frame->axis[1]), z = v3_dot(q, frame->axis[2]);
        double k = frame->parallel ? 1 : 1 / z;
        if (!frame->parallel && !(z > 0))
            return 0;
        located[i].u = x * k;
        located[i].v = y * k;
        located[i].q = frame->parallel ? -z : k;
    }
    return 1;
}

static int face_box(const gnoi_frame *frame, const vec3 *relative, int count, int face, gnoi_lbox *box)
{
    vec3 ring[2][CUT_POINTS];
    int n = count;
    for (int i = 0; i < count; i++)
        ring[0][i] = to_face(relative[i], face);
    for (int side = 0; side < 4 && n > 0; side++)
        n = clip_pyramid_side(ring[side & 1], n, side, ring[~side & 1]);
    if (n == 0)
        return 0;
    box_clear(box);
    for (int i = 0; i < n; i++) {
        vec3 q = ring[0][i];
        if (q.z > 0)
            box_add(box, q.x / q.z + GNOI_FACE_STEP * face, q.y / q.z, q.z);
        else
            box_add(box, GNOI_FACE_STEP * face, 0, 0);
    }
    gnoi_box_grow(box, frame);
    return 1;
}

void gnoi_frame_box(const gnoi_frame *frame, const gnoi_lpoint *located, int count, gnoi_lbox *box)
{
    box_clear(box);
    for (int i = 0; i < count; i++)
        box_add(box, located[i].u, located[i].v, frame->parallel ? -located[i].q : 1 / located[i].q);
    gnoi_box_grow(box, frame);
}

int gnoi_frame_boxes(const gnoi_frame *frame, const vec3 *points, int count, gnoi_lbox boxes[6])
{
    vec3 relative[GNOI_FRAME_POINTS];
    gnoi_lpoint located[GNOI_FRAME_POINTS];
    int n = 0;
    if (gnoi_frame_locate(frame, points, count, located)) {
        gnoi_frame_box(frame, located, count, &boxes[0]);
        return 1;
    }
    for (int i = 0; i < count && frame->faces == 6; i++)
        relative[i] = v3_sub(points[i], frame->origin);
    for (int face = 0; face < frame->faces && frame->faces == 6; face++)
        n += face_box(frame, relative, count, face, &boxes[n]);
    return n;
}

int gnoi_frame_everywhere(gnoi_lbox *box)
{
    box->u0 = box->v0 = box->z0 = -FLT_MAX;
    box->u1 = box->v1 = box->z1 = FLT_MAX;
    return 1;
}
