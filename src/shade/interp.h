/* interp.h -- normals and vertex intensities interpolated over a polygon, perspective-correctly.
 *
 * Place in the data flow: prepared polygon + view -> linear functions over the picture -> normals (phong) or weights
 * (gouraud) at a sample. With homogeneous picture coordinates V_i = (X,Y,W) of a triangle's corners the weights at picture
 * point p = (x,y,1) are proportional to p.(V_1 x V_2), p.(V_2 x V_0), p.(V_0 x V_1): linear in x and y, no division
 * (Olano and Greer, "Triangle scan conversion using 2D homogeneous coordinates", 1997).
 * Polygons of more than three corners use their fixed triangulation, so that turning the object changes nothing.
 */
#ifndef GNOI_SHADE_INTERP_H
#define GNOI_SHADE_INTERP_H

#include "project/view.h"
#include "scene/scene.h"

typedef struct gnoi_interp {
    int ready;
    uint32_t triangle_count, triangle; /* the one set now */
    uint32_t corner[3];                /* its corners in the prepared corner arrays */
    gnoi_screen_plane weight[3];       /* proportional to the corners' weights, >= 0 inside */
    double scale;                      /* of the first weight at the first corner, where the interpolated normal is as long */
    gnoi_screen_plane normal[3];       /* x, y, z of the interpolated normal, any length */
    float turn;                        /* the angle by which it turns from a pixel to the next, squared: a bound, at the first corner */
} gnoi_interp;

/* An interpolated normal n on the viewer's side of the plane, where its own normal g is; near unit length. */
static inline vec3 gnoi_interp_facing(vec3 n, vec3 g)
{
    return v3_scale(n, (v3_dot(n, g) < 0 ? -1.0 : 1.0) / (fabs(n.x) + fabs(n.y) + fabs(n.z) + 1e-300));
}

static inline gnoi_screen_plane gnoi_interp_plane(vec3 v)
{
    const gnoi_screen_plane p = {v.x, v.y, v.z};
    return p;
}

/* The weights of a triangle with corners v in homogeneous picture coordinates; returns the scale of gnoi_interp. */
static inline double gnoi_interp_weigh(const vec3 v[3], gnoi_screen_plane weight[3])
{
    const vec3 c0 = v3_cross(v[1], v[2]), c1 = v3_cross(v[2], v[0]), c2 = v3_cross(v[0], v[1]);
    const double scale = v3_dot(c0, v[0]) / v[0].z, sign = scale * v[0].z < 0 ? -1 : 1;
    weight[0] = gnoi_interp_plane(v3_scale(c0, sign));
    weight[1] = gnoi_interp_plane(v3_scale(c1, sign));
    weight[2] = gnoi_interp_plane(v3_scale(c2, sign));
    return scale;
}

/* Makes `interp` valid for picture point (x,y) of `poly`: picks the triangle that holds it, or the nearest. */
void gnoi_interp_seek(gnoi_interp *interp, const gno_scene *scene, const gnoi_view *view, const gnoi_poly *poly, double x, double y);

/* How deep inside the triangle that is set now picture point (x,y) lies: the smallest of the three weights relative to their sum, >= 0
 * inside. */
double gnoi_interp_depth(const gnoi_interp *interp, double x, double y);

#endif
