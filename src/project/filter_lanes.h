/* filter_lanes.h -- exact areas of quadrilaterals in the cells of a unit grid, many quadrilaterals side by side.
 *
 * Place: under filter.c. Plain arithmetic without branches on arrays of lanes, which every machine does alike.
 * A row of cells cuts the four edges into stretches. The area of the row's part of a quadrilateral left of a line x = L is the sum over
 * the stretches of their height times the mean of max(L - x, 0), and differences of these are the cells' areas (Green's theorem, as in
 * signed-area accumulation of glyph outlines, Levien 2016).
 */
#ifndef GNOI_PROJECT_FILTER_LANES_H
#define GNOI_PROJECT_FILTER_LANES_H

#include <stdalign.h>

#define GNOI_FILTER_LANES 16
#define GNOI_LANE_COLUMNS 64
#define GNOI_LANE_FEW_COLUMNS 8 /* where `most` is no more, all rows of a lane have the same columns */
#define GNOI_EVEN_BEND 2e-3f /* |wx| + |wy| below which areas are taken as in proportion */

#define GNOI_LANE_ALIGNMENT 64 /* one vector of lanes is one cache line */

typedef float gnoi_filter_lane_values[GNOI_FILTER_LANES];

/* Without branches. */
static inline float gnoi_lesser(float a, float b) { return a < b ? a : b; }
static inline float gnoi_greater(float a, float b) { return a > b ? a : b; }

static inline float gnoi_floor(float v)
{
    float whole = (float)(int)v;
    return whole - (float)(v < whole);
}

typedef struct gnoi_filter_lanes {
    alignas(GNOI_LANE_ALIGNMENT) gnoi_filter_lane_values s;
    gnoi_filter_lane_values t, sx, sy, tx, ty, wx, wy; /* given: as in gnoi_look (filter.h) */
    int rows[GNOI_FILTER_LANES];                          /* of cells under the quadrilateral, the first of them next */
    gnoi_filter_lane_values first_row;
    gnoi_filter_lane_values x[4], y[4], end_y[4], turn[4]; /* edges from their upper end; 1 or -1: that is the first one */
    gnoi_filter_lane_values slope[4], half_rise[4], turned_rise[4], rightward[4]; /* dx/dy, |dy/dx| / 2, that times turn, whether the lower end is the right one */
    gnoi_filter_lane_values low_x, high_x, first_column;
    int columns[GNOI_FILTER_LANES];         /* under it in any row */
    gnoi_filter_lane_values gain_x, gain_y; /* areas in the picture change with the place by this share of the middle's; given if uneven */
    gnoi_filter_lane_values weight;         /* sum of all areas so far */
    int most;                               /* columns of the lane with most */
    int uneven;                             /* some lane's areas change with the place by more than is negligible */
} gnoi_filter_lanes;

/* Cells of one row, from column `first` on. Areas are those in the picture, up to a factor of the lane, which may be negative; up to column
 * `most` they are there in all lanes, 0 in those that have fewer. */
typedef struct gnoi_filter_lane_row {
    alignas(GNOI_LANE_ALIGNMENT) gnoi_filter_lane_values area[GNOI_LANE_COLUMNS];
    gnoi_filter_lane_values first;
    int columns[GNOI_FILTER_LANES], most;
} gnoi_filter_lane_row;

/* Finds corners and rows. All values are finite, sx ty differs from sy tx, |wx| + |wy| < 1. */
void gnoi_filter_lanes_start(gnoi_filter_lanes *lanes);

/* Rows first .. first + count - 1 of every lane; lanes with fewer rows get none, and a row too wide is cut short. */
void gnoi_filter_lanes_rows(gnoi_filter_lanes *lanes, int first, int count, gnoi_filter_lane_row *out);

#endif
