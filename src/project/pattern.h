/* pattern.h -- where a point of the picture lies on a texture's pattern.
 *
 * Place in the data flow: texture + polygon + view -> gnoi_pattern over a pixel -> filter.h.
 * With texture coordinates and in planar projection the place is a fraction of two functions that are linear over the picture, for
 * the plane's nearness z is linear (view.h) and so is z times any affine function of the point: S = s/w, T = t/w. Straight
 * lines of the pattern are straight in the picture, and no approximation is made. Cylinders and spheres are taken linearly within a
 * pixel, through its four corners (Catmull; Blinn and Newell 1976).
 * The pattern is the unit square, T upwards.
 */
#ifndef GNOI_PROJECT_PATTERN_H
#define GNOI_PROJECT_PATTERN_H

#include "project/view.h"

/* S = s/w, T = t/w over the picture; w > 0 before the eye. */
typedef struct gnoi_pattern {
    gnoi_screen_plane s, t, w;
} gnoi_pattern;

/* A texture's map in scene space: what is affine in the point before the map's own angles are taken. */
typedef struct gnoi_place {
    gno_texture_map map;
    vec3 axis[3];      /* planar: S and T are axis[0].P + offset[0] and axis[1].P + offset[1]; else coordinates along u, v x u and v */
    double offset[3];
    double gain[2], shift[2]; /* pattern = gain * (S,T) + shift */
} gnoi_place;

/* The place of a texture on an object whose points go to mesh space by `to_local` (rows of a 3x4 matrix). */
gnoi_place gnoi_place_make(const gno_texture *texture, const double to_local[12]);

/* The same for a polygon without texture coordinates: planar along the two axes of mesh space farthest from the normal n. */
gnoi_place gnoi_place_plain(const gno_texture *texture, const double to_local[12], const double n[3]);

/* Planar: the pattern on a plane of given nearness. */
gnoi_pattern gnoi_pattern_planar(const gnoi_place *place, const gnoi_view *view, const gnoi_screen_plane *nearness);

/* The pattern on a triangle: weight[i] are proportional to its corners' shares, coordinate[i] their texture coordinates. */
gnoi_pattern gnoi_pattern_uv(const gnoi_place *place, const gnoi_screen_plane weight[3], const double *const coordinate[3]);

/* Cylindrical, spherical: linear through four points, those seen `reach` left and above, right and above, right and below, left and
 * below picture point (x,y), where `middle` is seen. */
gnoi_pattern gnoi_pattern_corners(const gnoi_place *place, vec3 middle, const vec3 corner[4], double reach, double x, double y);

/* The same: linear through the corners of the pixel-sized square around picture point (x,y). */
gnoi_pattern gnoi_pattern_round(const gnoi_place *place, const gnoi_view *view, const gnoi_screen_plane *nearness, double x, double y);

#endif
