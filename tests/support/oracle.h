/* oracle.h -- the slow, obvious twin of the engine: one ray a sample, every polygon tried, every caster tried.
 *
 * It sees a scene only through the public getters and shares no code with the engine. What it computes is
 * docs' model: for a point of the picture the nearest polygon along its ray, for each light the product of the
 * transmissions of all polygons between, and the lighting formula in double precision.
 *
 * Bounds of its honesty: polygons must be planar; interpolated shading is meant for triangles (convex polygons are
 * taken as fans); where a smooth polygon has no normals, those of its object's polygons are averaged by area.
 */
#ifndef TESTS_SUPPORT_ORACLE_H
#define TESTS_SUPPORT_ORACLE_H

#include <gnomon/gnomon.h>

typedef struct oracle oracle;

/* What one ray finds. */
typedef struct oracle_sample {
    long polygon;        /* number in the scene, -1: background */
    unsigned long state; /* hash of what every light sends through to the point */
    double point[3];
    double rgb[3];
} oracle_sample;

/* What the rays of one pixel find. */
typedef struct oracle_pixel {
    double rgb[3];            /* mean */
    double centred[3];        /* the mean when each surface in each state has the colour of the middle of its share */
    double lower[3], upper[3]; /* range over the samples */
    long polygon;             /* of the first sample */
    unsigned long state;
    int uniform;              /* all samples agree in polygon and state */
} oracle_pixel;

/* The scene must live and stay unchanged as long as the oracle. NULL when memory fails. */
oracle *oracle_create(gno_scene *scene);
void oracle_destroy(oracle *o);

/* Looks through the picture point (x,y), in pixels from the top left corner. */
oracle_sample oracle_look(const oracle *o, double x, double y);

#define ORACLE_SURFACES 24 /* of one pixel; others are lit where they are hit */

/* Where a polygon is seen in a pixel, in front or through others: sums over the rays. */
typedef struct oracle_surface {
    long polygon;
    int rays;
    double x, y;
} oracle_surface;

typedef struct oracle_surfaces {
    int count, counted;
    oracle_surface each[ORACLE_SURFACES];
} oracle_surfaces;

/* The same look. While `counted` is 0 the surfaces along the ray are counted; then each is lit in the middle of where it was seen, wherever
 * that lies on its plane, though what arrives there is still what arrives at the ray's end. NULL: each where it is hit. */
oracle_sample oracle_look_again(const oracle *o, double x, double y, oracle_surfaces *surfaces);

gno_image_def oracle_image(const oracle *o);

/* The pixel (px,py) by n x n samples, one at a random place of each cell of a grid; the same seed gives the same places. */
oracle_pixel oracle_look_pixel(const oracle *o, int px, int py, int n, unsigned seed);

/* The pixel's mean when each surface has the brightness of the middle of where it is seen in the pixel, in whatever state, even if something
 * else is seen there. */
void oracle_light_once(const oracle *o, int px, int py, int n, unsigned seed, double rgb[3]);

/* All pixels, row by row; pixels has width x height elements. */
void oracle_picture(const oracle *o, int n, unsigned seed, oracle_pixel *pixels);

/* What of an expanded light arrives at a point of the polygon, on the side that faces the light; nothing outside a spot's cone, nor
 * on a polygon that is edge-on or has no area. Softness of shadows is part of it. */
void oracle_reach(const oracle *o, long polygon, const double point[3], size_t light, double passed[3]);

/* Polygons with area, and lights after area lights are split: their product is the cost of a sample. */
size_t oracle_polygons(const oracle *o);
size_t oracle_lights(const oracle *o);

#endif
