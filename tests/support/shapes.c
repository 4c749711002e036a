/* shapes.c -- see shapes.h. */
#include "support/shapes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

const char *const shapes_name[SHAPES_FAMILIES] = {"stars", "convex", "combs", "spirals", "nested", "hilbert", "self", "grid", "slivers",
                                                  "lattice", "tangle", "fan", "on_edge", "zigzag", "boxes"};

/* ---- buffers --------------------------------------------------------------------------------------------------- */

static void *grown(void *block, size_t *room, size_t need, size_t size)
{
    if (need <= *room)
        return block;
    *room = 2 * need + 16;
    block = realloc(block, *room * size);
    if (!block) {
        fprintf(stderr, "shapes: out of memory\n");
        exit(1);
    }
    return block;
}

static void seal(shape_buffer *b)
{
    b->polygon_start = grown(b->polygon_start, &b->polygon_room, b->polygons + 1, sizeof *b->polygon_start);
    b->ring_start = grown(b->ring_start, &b->ring_room, b->rings + 1, sizeof *b->ring_start);
    b->polygon_start[b->polygons] = b->rings;
    b->ring_start[b->rings] = b->count;
}

void shape_clear(shape_buffer *b)
{
    b->polygons = b->rings = b->count = 0;
    seal(b);
}

void shape_free(shape_buffer *b)
{
    free(b->polygon_start);
    free(b->ring_start);
    free(b->points);
}

void shape_begin_polygon(shape_buffer *b)
{
    b->polygons++;
    seal(b);
}

void shape_begin_ring(shape_buffer *b)
{
    b->rings++;
    seal(b);
}

void shape_point(shape_buffer *b, double x, double y)
{
    b->points = grown(b->points, &b->point_room, 2 * (b->count + 1), sizeof *b->points);
    b->points[2 * b->count] = x;
    b->points[2 * b->count + 1] = y;
    b->count++;
    b->ring_start[b->rings] = b->count;
}

gno_shape shape_view(const shape_buffer *b)
{
    gno_shape s;
    s.polygon_count = b->polygons;
    s.polygon_start = b->polygon_start;
    s.ring_count = b->rings;
    s.ring_start = b->ring_start;
    s.points = b->points;
    return s;
}

/* ---- random numbers ---------------------------------------------------------------------------------------------- */

static uint64_t next_random(shape_random *r)
{
    r->state ^= r->state >> 12;
    r->state ^= r->state << 25;
    r->state ^= r->state >> 27;
    return r->state * UINT64_C(2685821657736338717);
}

double shape_uniform(shape_random *r, double low, double high)
{
    return low + (high - low) * (double)(next_random(r) >> 11) * (1.0 / 9007199254740992.0);
}

int shape_integer(shape_random *r, int low, int high)
{
    return low + (int)(next_random(r) >> 33) % (high - low + 1);
}

/* ---- families ------------------------------------------------------------------------------------------------------ */

static void begin(shape_buffer *b)
{
    shape_begin_polygon(b);
    shape_begin_ring(b);
}

static void star(shape_random *r, shape_buffer *b, double cx, double cy, double least, double most, int n)
{
    double turn = shape_uniform(r, 0, 1);
    for (int i = 0; i < n; i++) {
        double angle = 2 * PI * (i + turn) / n, radius = shape_uniform(r, least, most);
        shape_point(b, cx + radius * cos(angle), cy + radius * sin(angle));
    }
}

static void make_stars(shape_random *r, int size, shape_buffer *b)
{
    double cx = shape_uniform(r, -2, 2), cy = shape_uniform(r, -2, 2);
    begin(b);
    star(r, b, cx, cy, 0.3, 10, shape_integer(r, 3, 40 * size));
}

static void make_convex(shape_random *r, int size, shape_buffer *b)
{
    for (int k = shape_integer(r, 1, 6 * size); k > 0; k--) {
        double radius = shape_uniform(r, 0.1, 4), cx = shape_uniform(r, -5, 5), cy = shape_uniform(r, -5, 5);
        begin(b);
        star(r, b, cx, cy, radius, radius, shape_integer(r, 3, 8));
    }
}

/* Teeth along x (or y), on coordinates that often agree between two combs. */
static void make_comb(shape_random *r, int size, shape_buffer *b)
{
    int teeth = shape_integer(r, 2, 10 * size), upright = shape_integer(r, 0, 1);
    double slant = shape_integer(r, 0, 2) == 0 ? shape_uniform(r, -0.3, 0.3) : 0;
    begin(b);
    for (int i = 0; i < 2 * teeth; i++) {
        double along = i * 0.5, across = i % 2 ? 10 : 1;
        for (int k = 0; k < 2; k++, across = 11 - across)
            shape_point(b, upright ? along : across + slant * along, upright ? across + slant * along : along);
    }
    shape_point(b, upright ? teeth : 0, upright ? 0 : teeth);
    shape_point(b, 0, 0);
}

static void make_spiral(shape_random *r, int size, shape_buffer *b)
{
    int n = shape_integer(r, 10, 60 * size);
    double turns = shape_uniform(r, 0.5, 4), start = shape_uniform(r, 0, 2 * PI), cx = shape_uniform(r, -1, 1), cy = shape_uniform(r, -1, 1);
    begin(b);
    for (int i = 0; i < 2 * n; i++) {
        int k = i < n ? i : 2 * n - 1 - i;
        double angle = start + 2 * PI * turns * k / n, radius = 1 + 9.0 * k / n + (i < n ? 0 : 2.0 / turns);
        shape_point(b, cx + radius * cos(angle), cy + radius * sin(angle));
    }
}

static void box(shape_buffer *b, double x0, double y0, double x1, double y1)
{
    shape_begin_ring(b);
    shape_point(b, x0, y0);
    shape_point(b, x1, y0);
    shape_point(b, x1, y1);
    shape_point(b, x0, y1);
}

/* Rings in rings, some touching the next one in points or along sides. */
static void make_nested(shape_random *r, int size, shape_buffer *b)
{
    int rings = shape_integer(r, 1, 5 * size);
    double x0 = shape_integer(r, 0, 3), y0 = shape_integer(r, 0, 3), x1 = 24 + x0, y1 = 24 + y0;
    shape_begin_polygon(b);
    for (int i = 0; i < rings && x1 - x0 > 1 && y1 - y0 > 1; i++) {
        if (shape_integer(r, 0, 2) == 0) {
            shape_begin_ring(b);
            shape_point(b, (x0 + x1) / 2, y0);
            shape_point(b, x1, (y0 + y1) / 2);
            shape_point(b, (x0 + x1) / 2, y1);
            shape_point(b, x0, (y0 + y1) / 2);
            x0 += (x1 - x0) / 4;
            x1 -= (x1 - x0) / 3;
            y0 += (y1 - y0) / 4;
            y1 -= (y1 - y0) / 3;
        } else {
            box(b, x0, y0, x1, y1);
        }
        x0 += shape_integer(r, 0, 2);
        y0 += shape_integer(r, 0, 2);
        x1 -= shape_integer(r, 0, 2);
        y1 -= shape_integer(r, 0, 2);
    }
}

static void hilbert_turn(int n, int d, int *x, int *y)
{
    *x = *y = 0;
    for (int s = 1, t = d; s < n; s *= 2, t /= 4) {
        int rx = 1 & (t / 2), ry = 1 & (t ^ rx);
        if (ry == 0) {
            int swap;
            if (rx == 1) {
                *x = s - 1 - *x;
                *y = s - 1 - *y;
            }
            swap = *x;
            *x = *y;
            *y = swap;
        }
        *x += s * rx;
        *y += s * ry;
    }
}

/* The squares along a Hilbert curve, closed by a way back around it; neighbouring parts of the curve touch or not. */
static void make_hilbert(shape_random *r, int size, shape_buffer *b)
{
    int n = 1 << shape_integer(r, 1, 3 + (size > 1)), whole = shape_integer(r, 0, 2) > 0;
    double dx = whole ? shape_integer(r, 0, 2) : shape_uniform(r, -1, 1), dy = whole ? shape_integer(r, 0, 2) : shape_uniform(r, -1, 1);
    double turn = shape_integer(r, 0, 2) == 0 ? shape_uniform(r, 0, 6) : 0, co = cos(turn), si = sin(turn);
    begin(b);
    for (int i = 0; i < n * n; i++) {
        int x, y;
        hilbert_turn(n, i, &x, &y);
        shape_point(b, co * (x + dx) - si * (y + dy), si * (x + dx) + co * (y + dy));
    }
    shape_point(b, co * (n + dx) - si * (-1 + dy), si * (n + dx) + co * (-1 + dy));
    shape_point(b, co * (-1 + dx) - si * (-1 + dy), si * (-1 + dx) + co * (-1 + dy));
}

static void copy_moved(const shape_buffer *from, shape_buffer *to, double dx, double dy, double scale)
{
    for (size_t p = 0; p < from->polygons; p++) {
        shape_begin_polygon(to);
        for (size_t k = from->polygon_start[p]; k < from->polygon_start[p + 1]; k++) {
            shape_begin_ring(to);
            for (size_t i = from->ring_start[k]; i < from->ring_start[k + 1]; i++)
                shape_point(to, from->points[2 * i] * scale + dx, from->points[2 * i + 1] * scale + dy);
        }
    }
}

/* A shape and itself: the same, moved by less than a rounding error, by a step of its lattice, or scaled about a corner. */
static void make_self(shape_random *r, int size, shape_buffer *a, shape_buffer *b)
{
    double tiny = shape_uniform(r, -1e-13, 1e-13), dx = shape_integer(r, -1, 1), dy = shape_integer(r, -1, 1);
    switch (shape_integer(r, 0, 4)) {
    case 0: make_stars(r, size, a); break;
    case 1: make_comb(r, size, a); break;
    case 2: make_spiral(r, size, a); break;
    case 3: make_nested(r, size, a); break;
    default: make_convex(r, size, a);
    }
    switch (shape_integer(r, 0, 3)) {
    case 0: copy_moved(a, b, 0, 0, 1); break;
    case 1: copy_moved(a, b, tiny, tiny / 3, 1); break;
    case 2: copy_moved(a, b, dx, dy, 1); break;
    default: copy_moved(a, b, 0, 0, 0.5);
    }
}

/* Squares and triangles of a lattice, turned as a whole, many edges shared. */
static void make_grid(shape_random *r, int size, double turn, shape_buffer *b)
{
    double co = cos(turn), si = sin(turn);
    int n = shape_integer(r, 2, 5 * size);
    for (int x = 0; x < n; x++)
        for (int y = 0; y < n; y++) {
            static const int corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
            int kind = shape_integer(r, 0, 3), skip = shape_integer(r, 0, 3), wide = shape_integer(r, 1, 2);
            if (kind == 0)
                continue;
            begin(b);
            for (int k = 0; k < 4; k++) {
                double px = x + corner[k][0] * wide, py = y + corner[k][1];
                if (kind == 1 && k == skip)
                    continue;
                shape_point(b, co * px - si * py, si * px + co * py);
            }
        }
}

static void make_slivers(shape_random *r, int size, shape_buffer *b)
{
    double slope = shape_uniform(r, -1, 1);
    for (int k = shape_integer(r, 1, 5 * size); k > 0; k--) {
        double thin = pow(10, shape_uniform(r, -15, -1)), x0 = shape_uniform(r, 0, 2), x1 = shape_uniform(r, 8, 10);
        double size_h = pow(10, shape_uniform(r, -14, 0)), h = size_h * shape_uniform(r, -1, 1);
        double middle = shape_uniform(r, x0, x1), off = thin * shape_uniform(r, -1, 1);
        begin(b);
        shape_point(b, x0, slope * x0 + h);
        shape_point(b, x1, slope * x1 + h);
        shape_point(b, middle, slope * 5 + h + off);
        if (shape_integer(r, 0, 1))
            shape_point(b, x0, slope * x0 + h + thin);
    }
}

/* Rings of few points on a small lattice: crossings, spikes, overlaps and repetitions everywhere. */
static void make_lattice(shape_random *r, int size, shape_buffer *b)
{
    int side = shape_integer(r, 2, 8);
    for (int k = shape_integer(r, 1, 3 * size); k > 0; k--) {
        shape_begin_polygon(b);
        for (int ring = shape_integer(r, 1, 2); ring > 0; ring--) {
            shape_begin_ring(b);
            for (int i = shape_integer(r, 1, 7); i > 0; i--) {
                int x = shape_integer(r, 0, side);
                shape_point(b, x, shape_integer(r, 0, side));
            }
        }
    }
}

static void make_tangle(shape_random *r, int size, shape_buffer *b)
{
    for (int k = shape_integer(r, 1, 2 * size); k > 0; k--) {
        begin(b);
        for (int i = shape_integer(r, 4, 16); i > 0; i--) {
            double x = shape_uniform(r, -5, 5);
            shape_point(b, x, shape_uniform(r, -5, 5));
        }
    }
}

/* Triangles around one point: many edges through a vertex. */
static void make_fan(shape_random *r, int size, shape_buffer *b)
{
    int n = shape_integer(r, 3, 20 * size);
    for (int i = 0; i < n; i++) {
        double a0 = 2 * PI * i / n, a1 = 2 * PI * (i + shape_integer(r, 1, 2)) / n;
        if (shape_integer(r, 0, 2) == 0)
            continue;
        begin(b);
        shape_point(b, 0, 0);
        shape_point(b, 5 * cos(a0), 5 * sin(a0));
        shape_point(b, 5 * cos(a1), 5 * sin(a1));
    }
}

/* Vertices of the clip on edges of the subject, as near as doubles can be. */
static void make_on_edge(shape_random *r, int size, shape_buffer *a, shape_buffer *b)
{
    make_stars(r, size, a);
    begin(b);
    for (int k = shape_integer(r, 3, 8); k > 0; k--) {
        size_t i = (size_t)shape_integer(r, 0, (int)a->count - 1), j = (i + 1) % a->count;
        double t = shape_integer(r, 0, 4) * 0.25;
        shape_point(b, a->points[2 * i] + t * (a->points[2 * j] - a->points[2 * i]),
                    a->points[2 * i + 1] + t * (a->points[2 * j + 1] - a->points[2 * i + 1]));
    }
}

/* Many nearly parallel edges between two rows of points. */
static void make_zigzag(shape_random *r, int size, shape_buffer *b)
{
    int n = shape_integer(r, 3, 30 * size);
    double width = pow(10, shape_uniform(r, -12, 1));
    begin(b);
    for (int i = 0; i < n; i++) {
        double x = (i % 2 ? 10 : 0) + shape_uniform(r, 0, 1);
        shape_point(b, x, width * shape_uniform(r, -1, 1));
    }
}

static void make_boxes(shape_random *r, int size, shape_buffer *b)
{
    for (int k = shape_integer(r, 1, 10 * size); k > 0; k--) {
        int x = shape_integer(r, 0, 12), y = shape_integer(r, 0, 12), width = shape_integer(r, 1, 6), height = shape_integer(r, 1, 6);
        shape_begin_polygon(b);
        box(b, x, y, x + width, y + height);
    }
}

static void make_one(int family, shape_random *r, int size, shape_buffer *b)
{
    switch (family) {
    case SHAPES_STARS: make_stars(r, size, b); break;
    case SHAPES_CONVEX: make_convex(r, size, b); break;
    case SHAPES_COMBS: make_comb(r, size, b); break;
    case SHAPES_SPIRALS: make_spiral(r, size, b); break;
    case SHAPES_NESTED: make_nested(r, size, b); break;
    case SHAPES_HILBERT: make_hilbert(r, size, b); break;
    case SHAPES_SLIVERS: make_slivers(r, size, b); break;
    case SHAPES_LATTICE: make_lattice(r, size, b); break;
    case SHAPES_TANGLE: make_tangle(r, size, b); break;
    case SHAPES_FAN: make_fan(r, size, b); break;
    case SHAPES_ZIGZAG: make_zigzag(r, size, b); break;
    default: make_boxes(r, size, b);
    }
}

void shapes_make(int family, uint64_t seed, int size, shape_buffer *subject, shape_buffer *clip)
{
    shape_random r;
    r.state = seed * UINT64_C(0x9e3779b97f4a7c15) + UINT64_C(0x2545f4914f6cdd1d) + (uint64_t)family;
    for (int i = 0; i < 8; i++)
        next_random(&r);
    shape_clear(subject);
    shape_clear(clip);
    if (family == SHAPES_SELF) {
        make_self(&r, size, subject, clip);
    } else if (family == SHAPES_ON_EDGE) {
        make_on_edge(&r, size, subject, clip);
    } else if (family == SHAPES_GRID) {
        double turn = shape_integer(&r, 0, 2) ? shape_uniform(&r, 0, 6) : 0;
        make_grid(&r, size, turn, subject);
        make_grid(&r, size, turn, clip);
    } else {
        make_one(family, &r, size, subject);
        make_one(family, &r, size, clip);
    }
}

/* ---- a town's shadows -------------------------------------------------------------------------------------------- */

double shapes_shadows(size_t count, uint64_t seed, shape_buffer *to)
{
    double side = 20 * ceil(sqrt((double)count));
    shape_random r;
    r.state = seed * UINT64_C(0x9e3779b97f4a7c15) + 1;
    shape_clear(to);
    for (size_t i = 0; i < count; i++) {
        double x = shape_uniform(&r, 0, side), y = shape_uniform(&r, 0, side), turn = shape_uniform(&r, 0, PI / 2);
        double a = shape_uniform(&r, 4, 8), b = shape_uniform(&r, 4, 8), height = shape_uniform(&r, 3, 20);
        double corner[4][2], sx = 0.8 * height, sy = 0.35 * height;
        int low = 0;
        for (int k = 0; k < 4; k++) {
            double u = k == 0 || k == 3 ? -a : a, v = k < 2 ? -b : b;
            corner[k][0] = x + u * cos(turn) - v * sin(turn);
            corner[k][1] = y + u * sin(turn) + v * cos(turn);
        }
        for (int k = 1; k < 4; k++) /* the corner farthest right of the shadow's way */
            if (corner[k][0] * sy - corner[k][1] * sx > corner[low][0] * sy - corner[low][1] * sx)
                low = k;
        begin(to);
        for (int k = 0; k < 4; k++) {
            const double *c = corner[(low + k) % 4];
            if (k == 0)
                shape_point(to, c[0], c[1]);
            if (k <= 2)
                shape_point(to, c[0] + sx, c[1] + sy);
            if (k >= 2)
                shape_point(to, c[0], c[1]);
        }
    }
    return side;
}
