/* view.h -- the eye as a projection centre: scene space to picture coordinates and back.
 *
 * Place in the data flow: camera and picture size -> gnoi_view -> projected vertices, planes of nearness, scene points.
 * Picture coordinates: x right, y down, in pixels from the picture's top left corner. "Nearness" z grows towards the
 * viewer and is linear over the picture on every plane: 1/w for a perspective view (w the depth along the view
 * direction), -depth for an orthographic one (Blinn, "Hyperbolic interpolation", 1992).
 */
#ifndef GNOI_PROJECT_VIEW_H
#define GNOI_PROJECT_VIEW_H

#include "base/vec.h"
#include <gnomon/gnomon.h>

/* A linear form over scene space: a.P + b. */
typedef struct gnoi_form {
    vec3 a;
    double b;
} gnoi_form;

static inline double gnoi_form_at(const gnoi_form *f, vec3 p) { return v3_dot(f->a, p) + f->b; }

typedef struct gnoi_view {
    int orthographic;
    int width, height;
    vec3 eye, forward, right, up; /* orthonormal */
    double s;                     /* pixels per unit at depth 1 (perspective) or anywhere (orthographic) */
    double unit;                  /* 1 / s */
    gnoi_form x, y, w;            /* homogeneous picture coordinates; w is the constant 1 for an orthographic view */
    gnoi_form depth;              /* along the view direction from the eye */
    double near_depth;            /* what lies nearer is cut away */
} gnoi_view;

/* A linear function over the picture: fx x + fy y + f0. */
typedef struct gnoi_screen_plane {
    double fx, fy, f0;
} gnoi_screen_plane;

static inline double gnoi_plane_at(const gnoi_screen_plane *p, double x, double y) { return p->fx * x + p->fy * y + p->f0; }

/* scale: the scene's size, the unit of near_depth. The camera must have been validated. */
gnoi_view gnoi_view_make(const gno_camera *camera, const gno_image_def *image, double scale);

/* Signed distance of the eye from the plane n.P + d = 0 (perspective), or minus the cosine between n and the view direction
 * (orthographic): its sign tells which side the viewer is on, positive on n's side. */
static inline double gnoi_view_side(const gnoi_view *view, const double n[3], double d)
{
    if (view->orthographic)
        return -v3_dot(v3_from(n), view->forward);
    return v3_dot(v3_from(n), view->eye) + d;
}

/* Nearness of the plane over the picture; `side` is gnoi_view_side's, not zero. */
static inline gnoi_screen_plane gnoi_view_nearness(const gnoi_view *view, const double n[3], double d, double side)
{
    gnoi_screen_plane p;
    vec3 nn = v3_from(n);
    double k = 1 / (view->s * side), centre;
    p.fx = -v3_dot(nn, view->right) * k;
    p.fy = v3_dot(nn, view->up) * k;
    if (view->orthographic)
        centre = -(v3_dot(nn, view->eye) + d) / side;
    else
        centre = -v3_dot(nn, view->forward) / side;
    p.f0 = centre - 0.5 * view->width * p.fx - 0.5 * view->height * p.fy;
    return p;
}

/* From the eye to the scene point seen at picture point (x,y) with nearness z (z > 0 for a perspective view). orthographic: the view's, a
 * constant in loops that are to become vector code. */
static inline vec3 gnoi_view_offset(const gnoi_view *view, int orthographic, double x, double y, double z)
{
    double u = (x - 0.5 * view->width) * view->unit, v = (y - 0.5 * view->height) * view->unit;
    vec3 across = v3_sub(v3_scale(view->right, u), v3_scale(view->up, v));
    return orthographic ? v3_mad(across, view->forward, -z) : v3_scale(v3_add(across, view->forward), 1 / z);
}

/* That scene point. */
static inline vec3 gnoi_view_point(const gnoi_view *view, double x, double y, double z)
{
    return v3_add(view->eye, gnoi_view_offset(view, view->orthographic, x, y, z));
}

#endif
