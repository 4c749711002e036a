/* coverage.c -- see coverage.h. */
#include "scan/coverage.h"
#include <math.h>
#include <string.h>

void gnoi_coverage_start(gnoi_coverage *c, int x0, int y0, int width, int height)
{
    c->x0 = x0;
    c->y0 = y0;
    c->width = width;
    c->height = height;
    c->first_row = height;
    c->last_row = -1;
}

static void touch_row(gnoi_coverage *c, int row)
{
    if (c->first_row > c->last_row) {
        memset(&c->rows[row], 0, sizeof c->rows[row]);
        c->first_row = c->last_row = row;
    }
    for (; c->first_row > row; c->first_row--)
        memset(&c->rows[c->first_row - 1], 0, sizeof c->rows[0]);
    for (; c->last_row < row; c->last_row++)
        memset(&c->rows[c->last_row + 1], 0, sizeof c->rows[0]);
}

/* A part of an edge within one row: from (xa,va) to (xb,vb), v from the row's top in [0,1], va <= vb. */
typedef struct part {
    double xa, va, xb, vb;
} part;

/* The part lies in one pixel. With u from the pixel's left side, both linear in v: area is the integral of 1 - u over v, the
 * moments those of (1 - u^2) / 2 and of (1 - u) v; Simpson's rule is exact for them. */
static void add_in_pixel(gnoi_coverage_row *row, int pixel, part p, double sign)
{
    double ua = p.xa - pixel, ub = p.xb - pixel, um = 0.5 * (ua + ub), vm = 0.5 * (p.va + p.vb), h = sign * (p.vb - p.va);
    row->area[pixel] += h * (1 - um);
    row->mx[pixel] += h * (0.5 - (ua * ua + ua * ub + ub * ub) / 6);
    row->my[pixel] += h * ((1 - ua) * p.va + 4 * (1 - um) * vm + (1 - ub) * p.vb) / 6;
    row->step[pixel + 1] += h;
    row->step_y[pixel + 1] += h * vm;
}

static void add_left(gnoi_coverage_row *row, double va, double vb, double sign)
{
    double h = sign * (vb - va);
    row->step[0] += h;
    row->step_y[0] += h * 0.5 * (va + vb);
}

/* Walks the part from left to right over the tile's pixels. */
static void add_in_row(gnoi_coverage_row *row, int width, part p, double sign)
{
    double left = p.xa < p.xb ? p.xa : p.xb, right = p.xa < p.xb ? p.xb : p.xa, slope, x, v, v_end;
    int downwards = p.xa < p.xb, pixel;
    if (left >= width)
        return;
    if (right <= 0) {
        add_left(row, p.va, p.vb, sign);
        return;
    }
    pixel = left > 0 ? (int)left : 0;
    if (left >= 0 && right <= pixel + 1) {
        add_in_pixel(row, pixel, p, sign);
        return;
    }
    slope = (p.vb - p.va) / (p.xb - p.xa);
    x = left;
    v = downwards ? p.va : p.vb;
    v_end = downwards ? p.vb : p.va;
    if (left < 0) {
        double at = p.va + (0 - p.xa) * slope;
        at = at < p.va ? p.va : at > p.vb ? p.vb : at;
        add_left(row, downwards ? v : at, downwards ? at : v, sign);
        x = 0;
        v = at;
    }
    for (; pixel < width && x < right; pixel++) {
        double next = right < pixel + 1 ? right : pixel + 1, at = right <= pixel + 1 ? v_end : p.va + (next - p.xa) * slope;
        part q;
        at = at < p.va ? p.va : at > p.vb ? p.vb : at;
        q.xa = downwards ? x : next;
        q.va = downwards ? v : at;
        q.xb = downwards ? next : x;
        q.vb = downwards ? at : v;
        add_in_pixel(row, pixel, q, sign);
        x = next;
        v = at;
    }
}

void gnoi_coverage_edge(gnoi_coverage *c, double ax, double ay, double bx, double by, double sign)
{
    double x0, y0, x1, y1, slope, y;
    int first, last;
    if (ay == by)
        return;
    sign = ay < by ? -sign : sign;
    x0 = (ay < by ? ax : bx) - c->x0;
    y0 = (ay < by ? ay : by) - c->y0;
    x1 = (ay < by ? bx : ax) - c->x0;
    y1 = (ay < by ? by : ay) - c->y0;
    if (!(y1 > 0) || !(y0 < c->height) || (x0 >= c->width && x1 >= c->width))
        return;
    slope = (x1 - x0) / (y1 - y0);
    first = y0 > 0 ? (int)y0 : 0;
    last = y1 < c->height ? (int)ceil(y1) - 1 : c->height - 1;
    touch_row(c, first);
    touch_row(c, last);
    y = y0 > 0 ? y0 : 0;
    for (int row = first; row <= last; row++) {
        double end = y1 < row + 1 ? y1 : row + 1;
        part p;
        p.xa = y == y0 ? x0 : x0 + (y - y0) * slope;
        p.xb = end == y1 ? x1 : x0 + (end - y0) * slope;
        p.va = y - row;
        p.vb = end - row;
        add_in_row(&c->rows[row], c->width, p, sign);
        y = end;
    }
}

void gnoi_coverage_finish(gnoi_coverage *c)
{
    for (int r = c->first_row; r <= c->last_row; r++) {
        gnoi_coverage_row *row = &c->rows[r];
        double step = 0, step_y = 0;
        for (int x = 0; x < c->width; x++) {
            step += row->step[x];
            step_y += row->step_y[x];
            row->area[x] += step;
            row->mx[x] += 0.5 * step - 0.5 * row->area[x];
            row->my[x] += step_y - 0.5 * row->area[x];
        }
    }
}

double gnoi_ring_area2(const double *xy, size_t count)
{
    double sum = 0;
    for (size_t i = 0, j = count - 1; i < count; j = i++)
        sum += (xy[2 * j] - xy[0]) * (xy[2 * i + 1] - xy[1]) - (xy[2 * i] - xy[0]) * (xy[2 * j + 1] - xy[1]);
    return sum;
}
