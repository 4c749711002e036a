/* coverage.h -- exact areas of a convex quadrilateral in the cells of a unit grid.
 *
 * Place: under filter.c, for quadrilaterals of few cells. Each edge leaves, in every row it crosses, the area between itself and the
 * row's end; sums along the row are the cells' areas (as in signed-area accumulation of glyph outlines, Levien 2016).
 */
#ifndef GNOI_PROJECT_COVERAGE_H
#define GNOI_PROJECT_COVERAGE_H

#define GNOI_COVERAGE_CELLS 24

/* area[row][column], signed by the quadrilateral's turn. Columns and rows beyond those used stay untouched. */
typedef struct gnoi_coverage {
    int columns, rows;
    double area[GNOI_COVERAGE_CELLS][GNOI_COVERAGE_CELLS + 2];
} gnoi_coverage;

/* x and y of the four corners lie in [0, columns] and [0, rows], which are at most GNOI_COVERAGE_CELLS. */
void gnoi_coverage_quad(gnoi_coverage *coverage, const double x[4], const double y[4], int columns, int rows);

#endif
