/* filter_view.h -- how pixels lie on their patterns, many pixels side by side.
 *
 * Place: under filter.c. Plain arithmetic on arrays, one array a component, which every machine does alike.
 * Most pixels are plain: a box of few elements, with w that hardly changes. Those become looks here; the others are told apart.
 */
#ifndef GNOI_PROJECT_FILTER_VIEW_H
#define GNOI_PROJECT_FILTER_VIEW_H

#include "project/filter_lanes.h"
#include "project/pattern.h"
#include <stdint.h>

#define GNOI_VIEWS 64   /* pixels at once: few enough for the nearest cache */
#define GNOI_ASKED 256  /* pixels of one answer */
#define GNOI_LOOKS 448  /* and looks of those that are not plain */

#define GNOI_MOST_BEND 0.03       /* share by which w may change from a look's middle to its border */
#define GNOI_MOST_COLUMNS 60.0    /* of a look: room for those at its ends is left */
#define GNOI_FEW_CELLS 200        /* so many elements are weighed without a look at coarser cells */
#define GNOI_LEAST_TURN 1e-4      /* of a look's area to the square of its length, in elements: thinner ones drown in rounding */
#define GNOI_LEAST_LENGTH 1e-8
#define GNOI_FAR_ELEMENTS 1e9     /* of int's range */

/* Neighbouring pixels of one pattern; arrays have room for a whole run at the last place. */
#define GNOI_VIEW_RUN 8

typedef double gnoi_view_values[GNOI_VIEWS + GNOI_VIEW_RUN];

/* Numerators and divisor of the pattern at the pixels' middles, what one width and one height of a pixel changes them by, and the
 * picture's extents in elements. */
typedef struct gnoi_views {
    gnoi_view_values s, sx, sy, t, tx, ty, w, wx, wy, width, height;
    gnoi_view_values period; /* patterns after which everything repeats itself; 0: none; -1 for pixels that are not plain in any case */
} gnoi_views;

typedef float gnoi_look_values[GNOI_LOOKS];

/* Pixels, or parts of them, on the pattern, in cells of one level of the picture. */
typedef struct gnoi_look_lanes {
    int column[GNOI_LOOKS], row[GNOI_LOOKS]; /* of the cell from which the place is counted: so counted the border next to it is near zero, and sharp */
    gnoi_look_values s, t;                   /* place of the middle */
    gnoi_look_values sx, sy, tx, ty;         /* what one width and one height of it changes that by */
    gnoi_look_values wx, wy;                 /* and w, relative to the middle's */
    int kind[GNOI_LOOKS];                    /* gnoi_look_kind; -1: not plain */
} gnoi_look_lanes;

#define GNOI_LOOK_SIZES 13
#define GNOI_LOOK_KINDS (2 * GNOI_LOOK_SIZES * GNOI_LOOK_SIZES)
#define GNOI_LOOK_IN_CELL 0 /* the kind of those that lie within one cell */

/* A picture's extents in elements, and its period as in gnoi_views. */
typedef struct gnoi_view_extent {
    double width, height, period;
} gnoi_view_extent;

/* Pixels from place `first` on: the first one's middle is (x,y), the others follow to its right; up to GNOI_VIEW_RUN places are written. */
void gnoi_views_set(gnoi_views *views, int first, int count, const gnoi_pattern *pattern, double x, double y, const gnoi_view_extent *extent);

/* Finds the looks of `count` pixels, from place `first` on. Both are written up to the next multiple of 16. */
void gnoi_views_take(gnoi_views *views, int count, gnoi_look_lanes *looks, int first);

/* Cells under a stretch of an axis. */
static inline float gnoi_look_cells(float middle, float extent)
{
    return gnoi_floor(middle + 0.5f * extent) - gnoi_floor(middle - 0.5f * extent) + 1.0f;
}

/* One each for up to 8 cells; two an octave from there. */
static inline int gnoi_look_size(float cells)
{
    union { float f; int32_t i; } large;
    large.f = gnoi_greater(gnoi_lesser(cells, 63.0f), 8.0f);
    return (int)gnoi_lesser(cells, 8.0f) - 1 + (large.i >> 22) - (0x41000000 >> 22);
}

/* Looks of about one size go together, or many lanes would wait for few. Extents are along S and along T, `bend` is |wx| + |wy|. */
static inline int gnoi_look_kind(float s, float t, float wide, float high, float bend)
{
    float columns = gnoi_look_cells(s, wide + wide * bend), rows = gnoi_look_cells(t, high + high * bend);
    int uneven = (int)(float)(bend > GNOI_EVEN_BEND) * (int)(float)(columns * rows > 1.0f);
    return (uneven * GNOI_LOOK_SIZES + gnoi_look_size(rows)) * GNOI_LOOK_SIZES + gnoi_look_size(columns);
}

#endif
