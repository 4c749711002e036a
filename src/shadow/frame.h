/* frame.h -- the plane (or planes) onto which a light projects the scene, for bounding tests.
 *
 * Place in the data flow: lights -> gnoi_lamp + gnoi_frame -> boxes of polygons on the light's plane -> tree, columns.
 * A directional light projects in parallel onto one plane; a point light gnomonically, onto one plane when the whole
 * scene lies well within one cone before it, onto the six faces of a cube otherwise. Straight stays straight, so the
 * box of a polygon's projected corners bounds the polygon. Faces stand side by side in u, GNOI_FACE_STEP apart.
 * Invariant: a box contains the exact projection (corners are rounded outwards).
 */
#ifndef GNOI_SHADOW_FRAME_H
#define GNOI_SHADOW_FRAME_H

#include "base/vec.h"
#include <gnomon/gnomon.h>

/* One light as the passes see it: a point or a direction; area lights are many of these. */
typedef struct gnoi_lamp {
    int directional;
    int spot;
    vec3 position;  /* point, spot */
    vec3 to_light;  /* directional: unit vector towards the light */
    vec3 axis;      /* spot: unit, the way light travels */
    double cos_half_angle; /* spot */
    double intensity[3];
    gno_falloff falloff;
    double falloff_k;
    int distance_from_viewer;
    double softness; /* length with which shadows weaken, 0: they do not */
} gnoi_lamp;

/* Positive on the lit side of the plane n.P + d = 0: the lamp's height over it (directional: the cosine). */
static inline double gnoi_lamp_side(const gnoi_lamp *lamp, const double n[3], double d)
{
    vec3 nn = v3_from(n);
    return lamp->directional ? v3_dot(nn, lamp->to_light) : v3_dot(nn, lamp->position) + d;
}

/* A box on the light's plane: [u0,u1] x [v0,v1], and depths z0..z1 from the light. */
typedef struct gnoi_lbox {
    float u0, u1, v0, v1, z0, z1;
} gnoi_lbox;

static inline float gnoi_box_side(const gnoi_lbox *b)
{
    float du = b->u1 - b->u0, dv = b->v1 - b->v0;
    return du > dv ? du : dv;
}

/* Face k of a six-face frame covers u = k GNOI_FACE_STEP - 1 .. k GNOI_FACE_STEP + 1. */
#define GNOI_FACE_STEP 4.0

typedef struct gnoi_frame {
    int parallel;
    int faces; /* 1 or 6 */
    vec3 origin;         /* the light's position, or the scene's centre for a parallel frame */
    vec3 axis[3];        /* u, v, depth of a one-face frame; orthonormal */
    double slack, slack_depth; /* by how much boxes grow on each side against rounding, in units of u and of depth */
} gnoi_frame;

/* By the slack against rounding. */
static inline void gnoi_box_grow(gnoi_lbox *box, const gnoi_frame *frame)
{
    float s = (float)frame->slack, t = (float)frame->slack_depth;
    box->u0 -= s;
    box->v0 -= s;
    box->u1 += s;
    box->v1 += s;
    box->z0 -= t;
    box->z1 += t;
}

/* lower, upper: bounds of the scene. */
gnoi_frame gnoi_frame_make(const gnoi_lamp *lamp, const double lower[3], const double upper[3]);

/* A point on the light's plane: u, v, and nearness to the light, which is linear in u and v on every plane of the scene
 * (1/depth, or -depth for a parallel frame). */
typedef struct gnoi_lpoint {
    double u, v, q;
} gnoi_lpoint;

/* Projects points that all lie before one face; returns 0 when they do not (a point behind a one-face frame's light, or points
 * on several faces). */
int gnoi_frame_locate(const gnoi_frame *frame, const vec3 *points, int count, gnoi_lpoint *located);

/* Projects points onto one face's plane, also from outside of the face; 0 when one is not before it. */
int gnoi_frame_locate_on(const gnoi_frame *frame, int face, const vec3 *points, int count, gnoi_lpoint *located);

/* The ray of light that (u,v) stands for: a point on it and the way it goes. */
void gnoi_frame_ray(const gnoi_frame *frame, double u, double v, vec3 *from, vec3 *along);

/* The face that u lies on. */
int gnoi_frame_face(const gnoi_frame *frame, double u);

/* The box of points already located. */
void gnoi_frame_box(const gnoi_frame *frame, const gnoi_lpoint *located, int count, gnoi_lbox *box);

/* Boxes of the ring of `count` points (at most GNOI_FRAME_POINTS), one for each face it reaches. Returns their number. */
#define GNOI_FRAME_POINTS 8
int gnoi_frame_boxes(const gnoi_frame *frame, const vec3 *points, int count, gnoi_lbox boxes[6]);

/* One box that meets all others, for what rounding leaves no box at all. Returns 1. */
int gnoi_frame_everywhere(gnoi_lbox *box);

#endif
