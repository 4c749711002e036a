/* bins.h -- prepared polygons onto the picture, and which tiles each may touch.
 *
 * Place in the data flow: prepared polygons + view -> picture vertices, polygon numbers by tile -> tiles (engine).
 * Polygons that reach behind the near plane or far out of the picture are cut in homogeneous coordinates (clip3.h).
 * Invariants: a tile's list holds, in ascending order, every polygon that any sample line of the tile, or of the half
 * row above and below it, may cross, each with a key that puts the nearest first; it depends on nothing but the scene and the view.
 */
#ifndef GNOI_SCAN_BINS_H
#define GNOI_SCAN_BINS_H

#include "base/sort.h"
#include "project/clip3.h"
#include "project/view.h"
#include "scene/scene.h"

#define GNOI_TILE_W 24
#define GNOI_TILE_H 32

typedef struct gnoi_vertex {
    double x, y; /* picture coordinates; x is HUGE_VAL where the vertex cannot be used without cutting */
    float z;     /* nearness */
    float reach; /* greatest distance along an axis from the middle of the scene's box: tolerances grow with it */
} gnoi_vertex;

/* Added to the key of what is not opaque, so that it comes after all that is. */
#define GNOI_KEY_SEE_THROUGH (1u << 22)

/* Rounding of single precision bounds, relative. */
#define GNOI_FLOAT_SLACK 1e-6f

typedef struct gnoi_bins {
    int tiles_x, tiles_y;
    gnoi_vertex *vertices;  /* one for each prepared vertex */
    size_t vertex_count;
    uint32_t *start;        /* tiles+1 offsets into items */
    gnoi_keyed *items;      /* value: the polygon; key: ascending from the nearest, by the leading bits of its nearness */
    size_t item_count;
    double middle;          /* greatest coordinate of the middle of the scene's box */
    float nearest_depth;    /* orthographic: depth of the nearest vertex before the eye */
} gnoi_bins;

/* lines: sample lines per pixel row at the finest; polygons between two lines are left out. */
gno_status gnoi_bins_build(const gno_scene *scene, const gnoi_view *view, int lines, int threads, gnoi_bins *bins);
void gnoi_bins_free(gno_context *context, gnoi_bins *bins);

/* A part of the picture. */
typedef struct gnoi_rect {
    double x0, y0, x1, y1;
} gnoi_rect;

/* Tile (x, y), with half a row above and below. */
gnoi_rect gnoi_tile_rect(const gnoi_view *view, int x, int y);

/* The key of what is no nearer than `nearness`; the greatest nearness that has a key. */
uint32_t gnoi_nearness_key(float nearness, int opaque);
float gnoi_key_nearness(uint32_t key);

/* Whether a polygon that reaches so far is judged, tile by tile, by what of it is there: a ground near the viewer must not come first in
 * the tiles of what stands on it far away. */
static inline int gnoi_is_large(double width, double height) { return !(width <= GNOI_TILE_W && height <= GNOI_TILE_H); }

/* What is before all of the polygon's plane over `rect`, by the tolerance; infinite for a plane seen edge on. */
float gnoi_nearest_over(const gno_scene *scene, const gnoi_view *view, const gnoi_poly *poly, const gnoi_rect *rect);

/* Rings of one polygon in the picture, cut where need be. */
typedef struct gnoi_outline {
    gno_context *context;
    size_t count, capacity; /* of points */
    gnoi_hpoint *points;    /* x, y in the picture; w unused */
    size_t ring_count, ring_capacity;
    uint32_t *ring_end;
    double x0, y0, x1, y1;  /* bounds */
    float z0, z1;           /* least and greatest nearness of the corners */
    int cut;                /* something was cut away */
    size_t scratch_capacity;
    gnoi_hpoint *scratch;
} gnoi_outline;

/* Picture coordinates within which polygons need no cutting, both ways from the picture's corner. */
double gnoi_outline_reach(const gnoi_view *view);

/* Sets the outline of a polygon; count is 0 when nothing of it can be seen. Returns 0 when memory fails. */
int gnoi_outline_set(gnoi_outline *outline, const gno_scene *scene, const gnoi_view *view, const gnoi_vertex *vertices,
                     const gnoi_poly *poly);
void gnoi_outline_free(gnoi_outline *outline);

#endif
