/* lanes.h -- triangles in the picture, GNOI_LANES side by side: bounds, edges and planes by vector code.
 *
 * Place in the data flow: projected vertices (bins.h) + prepared polygons -> bounds, edges, nearness planes and tolerances
 * -> where lines cross the triangles -> visible lists (lines.h). The meshes in which a picture's triangles are no larger than its
 * pixels take most of their time here.
 * Invariants: each number is that of the scalar code for polygons of more corners (edge.h, view.h), bit by bit, so that a triangle and
 * its neighbour of four corners meet exactly; lanes from `count` on hold zeros.
 */
#ifndef GNOI_SCAN_LANES_H
#define GNOI_SCAN_LANES_H

#include "scan/bins.h"
#include "scan/lines.h"

#define GNOI_LANES 16

/* Lines crossed at once at most, and by how many they are taken. */
#define GNOI_LANE_LINES 32
#define GNOI_LANE_STEP 8

typedef struct gnoi_lanes {
    unsigned count;
    double x[3][GNOI_LANES], y[3][GNOI_LANES]; /* corners in the picture */
    float z[3][GNOI_LANES], reach[3][GNOI_LANES];
    double n[3][GNOI_LANES], d[GNOI_LANES];    /* planes in the scene */
    double tolerance[GNOI_LANES];
    double x0[GNOI_LANES], x1[GNOI_LANES], y0[GNOI_LANES], y1[GNOI_LANES]; /* bounds in the picture */
    float z0[GNOI_LANES], z1[GNOI_LANES];
    double top_x[GNOI_LANES], top_y[GNOI_LANES], middle_x[GNOI_LANES], middle_y[GNOI_LANES], bottom_y[GNOI_LANES]; /* corners by height */
    double slope[GNOI_LANES], upper[GNOI_LANES], lower[GNOI_LANES]; /* dx/dy of the edges: top to bottom, top to middle, middle to bottom */
    double side[GNOI_LANES], fx[GNOI_LANES], fy[GNOI_LANES], f0[GNOI_LANES]; /* as gnoi_view_side, gnoi_view_nearness */
    float low[GNOI_LANES], high[GNOI_LANES]; /* bounds of the plane's nearness over a part of the picture */
    int32_t from[GNOI_LANE_LINES], to[GNOI_LANE_LINES]; /* of gnoi_lanes_cross */
} gnoi_lanes;

/* Picture coordinate v as a position on lines that begin at x, clamped to a pixel left of it and `most` units. Truncation instead of
 * floor: what is added makes the number positive. */
static inline int32_t gnoi_lane_position(double v, double x, double most)
{
    double t = (v - x) * GNOI_X_ONE;
    t = t < -(double)GNOI_X_ONE ? -(double)GNOI_X_ONE : t;
    t = t > most ? most : t;
    return (int32_t)(t + (GNOI_X_ONE + 0.5)) - GNOI_X_ONE;
}

/* Loads the corners of `count` polygons; one that is no triangle leaves zeros in its lane. */
void gnoi_lanes_load(gnoi_lanes *lanes, const gnoi_prepared *prep, const gnoi_bins *bins, const uint32_t *polys, unsigned count);

/* Their bounds; their edges. */
void gnoi_lanes_bound(gnoi_lanes *lanes);
void gnoi_lanes_set_edges(gnoi_lanes *lanes);

/* Puts a polygon's plane and tolerance into a lane. */
void gnoi_lanes_set_plane(gnoi_lanes *lanes, unsigned lane, const gnoi_poly *poly, double tolerance);

/* The tolerance of a lane's triangle: gnoi_plane_tolerance, but for rounding. */
double gnoi_lanes_tolerance(const gnoi_lanes *lanes, unsigned lane, const gnoi_bins *bins);

/* Side, nearness, and its bounds over `rect`, from the planes. Lanes that the viewer sees edge on get what they get: side is 0. */
void gnoi_lanes_see(gnoi_lanes *lanes, const gnoi_view *view, const gnoi_rect *rect);

/* Where `count` lines (at most GNOI_LANE_LINES) cross a lane's triangle, from lanes->from[i] to lanes->to[i] as
 * gnoi_lane_position(.., x, most); from >= to where a line does not. y holds whole GNOI_LANE_STEPs, of which what is beyond `count` counts for nothing. */
void gnoi_lanes_cross(gnoi_lanes *lanes, unsigned lane, const double *y, unsigned count, double x, double most);

#endif
