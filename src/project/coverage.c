/* coverage.c -- see coverage.h. */
#include "project/coverage.h"

/* The areas right of a stretch of edge from x0 to x1 > x0 (over more than one column) within one row, per height `d`. */
static void add_wide(double *row, double x0, double x1, double d)
{
    int first = (int)x0, end = (int)x1;
    double s, left, right, sum;
    end += (double)end < x1;
    s = 1 / (x1 - x0);
    left = first + 1 - x0;
    left = 0.5 * s * left * left; /* of the first column */
    right = x1 - end + 1;
    right = 0.5 * s * right * right; /* what is missing in the last one */
    row[first] += d * left;
    if (end == first + 2) {
        row[first + 1] += d * (1 - left - right);
    } else {
        sum = s * (first + 1.5 - x0);
        row[first + 1] += d * (sum - left);
        for (int i = first + 2; i < end - 1; i++)
            row[i] += d * s;
        row[end - 1] += d * (1 - (sum + (end - first - 3) * s) - right);
    }
    row[end] += d * right;
}

static void add_stretch(double *row, double xa, double xb, double d)
{
    double low = xa < xb ? xa : xb, high = xa < xb ? xb : xa;
    int first = (int)low;
    if (high <= first + 1) {
        double middle = 0.5 * (low + high) - first;
        row[first] += d * (1 - middle);
        row[first + 1] += d * middle;
    } else {
        add_wide(row, low, high, d);
    }
}

static void add_edge(gnoi_coverage *c, double x0, double y0, double x1, double y1)
{
    double turn = 1, slope, x = x0;
    if (y0 == y1)
        return;
    if (y0 > y1) {
        double sx = x0, sy = y0;
        x0 = x1, y0 = y1;
        x1 = sx, y1 = sy;
        turn = -1;
    }
    slope = (x1 - x0) / (y1 - y0);
    x = x0;
    for (int row = (int)y0; row < c->rows && (double)row < y1; row++) {
        int is_last = y1 <= row + 1;
        double from = y0 > row ? y0 : row, to = is_last ? y1 : row + 1, next = is_last ? x1 : x0 + (to - y0) * slope;
        add_stretch(c->area[row], x, next, turn * (to - from));
        x = next;
    }
}

void gnoi_coverage_quad(gnoi_coverage *c, const double x[4], const double y[4], int columns, int rows)
{
    c->columns = columns;
    c->rows = rows;
    for (int r = 0; r < rows; r++)
        for (int i = 0; i < columns + 2; i++)
            c->area[r][i] = 0;
    for (int i = 0; i < 4; i++)
        add_edge(c, x[i], y[i], x[(i + 1) & 3], y[(i + 1) & 3]);
    for (int r = 0; r < rows; r++) {
        double sum = 0;
        for (int i = 0; i < columns; i++) {
            sum += c->area[r][i];
            c->area[r][i] = sum;
        }
    }
}
