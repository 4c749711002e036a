/* filter_cells.c -- see filter_cells.h. */
#include "project/filter_cells.h"
#include "project/coverage.h"

#define BLOCK_TOLERANCE 0.004 /* aim for the error of a pixel's mean; no cell of a block is large or drawn out */
#define START_CELLS 3         /* so many elements side by side are weighed without a look at coarser cells */
#define MOST_BEND 0.01        /* share by which w may change from a pixel's middle to its border */
#define EVEN_BEND 1e-3        /* and below which it counts as constant */
#define FAR_ELEMENTS 1e9      /* of int's range */

typedef struct filter {
    const gnoi_image *image;
    const gno_texture *how;
    const gnoi_screen_plane *s, *t, *w;
    int top; /* the picture's last level */
} filter;

/* The pixel's corners on the pattern, in elements. */
typedef struct quad {
    double s[4], t[4], low_s, high_s, low_t, high_t;
} quad;

static double least(const double v[4])
{
    double a = v[0] < v[1] ? v[0] : v[1], b = v[2] < v[3] ? v[2] : v[3];
    return a < b ? a : b;
}

static double most(const double v[4])
{
    double a = v[0] > v[1] ? v[0] : v[1], b = v[2] > v[3] ? v[2] : v[3];
    return a > b ? a : b;
}

static int floor_of(double v)
{
    int i = (int)v;
    return i - (v < i);
}

/* Moves coordinates by whole periods of the pattern, the least of them into its first, and tells their range. */
static void set_range(double v[4], int elements, gno_wrap wrap, double *low, double *high)
{
    double period = wrap == GNO_WRAP_MIRROR ? 2.0 * elements : elements, turns;
    *low = least(v);
    *high = most(v);
    if ((*low >= 0 && *low < elements) || wrap == GNO_WRAP_CLAMP || wrap == GNO_WRAP_NONE)
        return;
    turns = *low / period;
    turns = fabs(turns) < FAR_ELEMENTS ? floor_of(turns) : floor(turns);
    for (int i = 0; i < 4; i++)
        v[i] -= period * turns;
    *low = least(v);
    *high = most(v);
}

/* 0 where a corner lies beyond the horizon or w changes too much. */
static int find_quad(const filter *f, quad *q)
{
    static const double across[4] = {-0.5, 0.5, 0.5, -0.5}, down[4] = {-0.5, -0.5, 0.5, 0.5};
    double bend = 0.5 * (fabs(f->w->fx) + fabs(f->w->fy)), k[4];
    if (!(bend < MOST_BEND * f->w->f0))
        return 0;
    for (int c = 0; c < 4; c++)
        k[c] = 1 / (f->w->fx * across[c] + f->w->fy * down[c] + f->w->f0);
    for (int c = 0; c < 4; c++)
        q->s[c] = (f->s->fx * across[c] + f->s->fy * down[c] + f->s->f0) * k[c];
    for (int c = 0; c < 4; c++)
        q->t[c] = (f->t->fx * across[c] + f->t->fy * down[c] + f->t->f0) * k[c];
    set_range(q->s, f->image->width, f->how->wrap, &q->low_s, &q->high_s);
    set_range(q->t, f->image->height, f->how->wrap, &q->low_t, &q->high_t);
    return fabs(q->low_s) + fabs(q->high_s) + fabs(q->low_t) + fabs(q->high_t) < FAR_ELEMENTS;
}

/* The element, or cell of a level, at place i; -1 where there is none. */
static int wrapped(int i, int n, gno_wrap wrap)
{
    int copy;
    if (i >= 0 && i < n)
        return i;
    if (wrap == GNO_WRAP_CLAMP)
        return i < 0 ? 0 : n - 1;
    if (wrap == GNO_WRAP_NONE)
        return -1;
    copy = i >= 0 ? i / n : -1 - (-1 - i) / n;
    i -= copy * n;
    return wrap == GNO_WRAP_MIRROR && copy % 2 != 0 ? n - 1 - i : i;
}

/* A block of cells of one level. */
typedef struct block {
    int level, i0, j0, columns, rows;
    int column[GNOI_COVERAGE_CELLS], row[GNOI_COVERAGE_CELLS]; /* wrapped */
} block;

/* Whether cells i0 .. i0 + count - 1 along an axis are all of the same width: within the picture, or in any if it is so many of them. */
static int is_on_grid(const filter *f, int i0, int count, int elements, int level)
{
    int repeats = f->how->wrap == GNO_WRAP_REPEAT || f->how->wrap == GNO_WRAP_MIRROR;
    return (i0 >= 0 && i0 + count <= elements >> level) || (repeats && (elements & ((1 << level) - 1)) == 0);
}

/* The cells of `level` under the quad; 0 where they are too many, or where the level's cells do not lie on one grid: beside the
 * picture, and where its last cells are narrower than the others. */
static int find_block(const filter *f, const quad *q, int level, block *b)
{
    double k = 1.0 / (1 << level);
    int w = f->image->level[level].width, h = f->image->level[level].height;
    b->level = level;
    b->i0 = floor_of(q->low_s * k);
    b->j0 = floor_of(q->low_t * k);
    b->columns = floor_of(q->high_s * k) - b->i0 + 1;
    b->rows = floor_of(q->high_t * k) - b->j0 + 1;
    if (b->columns > GNOI_COVERAGE_CELLS || b->rows > GNOI_COVERAGE_CELLS)
        return 0;
    if (level > 0 && (!is_on_grid(f, b->i0, b->columns, f->image->width, level) || !is_on_grid(f, b->j0, b->rows, f->image->height, level)))
        return 0;
    for (int i = 0; i < b->columns; i++)
        if ((b->column[i] = wrapped(b->i0 + i, w, f->how->wrap)) < 0)
            return 0;
    for (int j = 0; j < b->rows; j++)
        if ((b->row[j] = wrapped(b->j0 + j, h, f->how->wrap)) < 0)
            return 0;
    return 1;
}

/* 1 when the block's cells may stand for their elements: is_enough for cells of the block's mean share of the pixel. */
static int is_fine(const filter *f, const block *b)
{
    const gnoi_image_level *l = &f->image->level[b->level];
    double share = 1.0 / (b->columns * b->rows);
    float spread = 0;
    for (int j = 0; j < b->rows && b->level > 0; j++)
        for (int i = 0; i < b->columns; i++) {
            float own = l->spread[(size_t)b->row[j] * (size_t)l->width + (size_t)b->column[i]];
            spread = own > spread ? own : spread;
        }
    return !(spread > 0) || share <= gnoi_filter_most_area(BLOCK_TOLERANCE, spread);
}

/* The middle of what the range from low to high has of cell i. */
static double middle_of(int i, double low, double high)
{
    return 0.5 * ((i > low ? i : low) + (i + 1 < high ? i + 1 : high));
}

/* How much larger a cell is in the picture than others, linearly over the block: (w / w0)^3 at what the quad has of it. */
typedef struct density {
    double column[GNOI_COVERAGE_CELLS], row[GNOI_COVERAGE_CELLS];
} density;

static void set_density(const filter *f, const block *b, const double x[4], const double y[4], density *d)
{
    double sx = x[1] + x[2] - x[0] - x[3], sy = x[2] + x[3] - x[0] - x[1], tx = y[1] + y[2] - y[0] - y[3], ty = y[2] + y[3] - y[0] - y[1];
    double k = 6 / ((sx * ty - sy * tx) * f->w->f0), gx = k * (f->w->fx * ty - f->w->fy * tx), gy = k * (f->w->fy * sx - f->w->fx * sy);
    double low_x = least(x), high_x = most(x), low_y = least(y), high_y = most(y);
    for (int i = 0; i < b->columns; i++)
        d->column[i] = gx * (middle_of(i, low_x, high_x) - 0.25 * (x[0] + x[1] + x[2] + x[3]));
    for (int j = 0; j < b->rows; j++)
        d->row[j] = 1 + gy * (middle_of(j, low_y, high_y) - 0.25 * (y[0] + y[1] + y[2] + y[3]));
}

/* The sum of the block's values, weighted; total: the sum of the weights. */
static void sum_values(const filter *f, const block *b, const gnoi_coverage *c, float sum[4], float *total)
{
    for (int j = 0; j < b->rows; j++)
        for (int i = 0; i < b->columns; i++) {
            float value[4], weight = (float)c->area[j][i];
            if (weight < 1e-12f)
                continue;
            gnoi_image_value(f->image, b->level, b->column[i], b->row[j], value);
            for (int n = 0; n < 4; n++)
                sum[n] += weight * value[n];
            *total += weight;
        }
}

/* The same for solid bytes. */
static void sum_bytes(const filter *f, const block *b, const gnoi_coverage *c, float sum[4], float *total)
{
    const float *decode = f->image->decode;
    float red = 0, green = 0, blue = 0, whole = 0;
    for (int j = 0; j < b->rows; j++) {
        unsigned char(*row)[4] = f->image->bytes + (size_t)b->row[j] * (size_t)f->image->width;
        for (int i = 0; i < b->columns; i++) {
            const unsigned char *v = row[b->column[i]];
            float weight = (float)c->area[j][i];
            red += weight * decode[v[0]];
            green += weight * decode[v[1]];
            blue += weight * decode[v[2]];
            whole += weight;
        }
    }
    sum[0] = red;
    sum[1] = green;
    sum[2] = blue;
    sum[3] = *total = whole;
}

/* Weighs the block's cells by their areas under the quad; 0 where it has none. */
static int weigh_block(const filter *f, const quad *q, const block *b, int even, float mean[4])
{
    gnoi_coverage c;
    density d;
    double x[4], y[4], k = 1.0 / (1 << b->level);
    float sum[4] = {0, 0, 0, 0}, total = 0;
    for (int i = 0; i < 4; i++) {
        x[i] = q->s[i] * k - b->i0;
        y[i] = q->t[i] * k - b->j0;
    }
    if (!(fabs((x[2] - x[0]) * (y[3] - y[1]) - (y[2] - y[0]) * (x[3] - x[1])) > 1e-9))
        return 0;
    gnoi_coverage_quad(&c, x, y, b->columns, b->rows);
    if (!even)
        set_density(f, b, x, y, &d);
    for (int j = 0; j < b->rows; j++)
        for (int i = 0; i < b->columns; i++)
            c.area[j][i] = fabs(c.area[j][i]) * (even ? 1 : d.row[j] + d.column[i]);
    if (b->level == 0 && f->image->bytes && !f->image->has_alpha)
        sum_bytes(f, b, &c, sum, &total);
    else
        sum_values(f, b, &c, sum, &total);
    for (int n = 0; n < 4; n++)
        mean[n] = sum[n] / total;
    return total > 0;
}

int gnoi_filter_cells(const gnoi_image *image, const gno_texture *how, const gnoi_screen_plane *s, const gnoi_screen_plane *t,
                      const gnoi_screen_plane *w, float mean[4])
{
    filter f = {image, how, s, t, w, image->level_count - 1};
    double widest;
    int level = 0;
    quad q;
    block b;
    if (!find_quad(&f, &q))
        return 0;
    widest = q.high_s - q.low_s > q.high_t - q.low_t ? q.high_s - q.low_s : q.high_t - q.low_t;
    while (level < f.top && widest > (double)(START_CELLS << level))
        level++;
    while (!(find_block(&f, &q, level, &b) && is_fine(&f, &b)))
        if (level-- == 0)
            return 0;
    if (b.columns == 1 && b.rows == 1) {
        gnoi_image_value(image, b.level, b.column[0], b.row[0], mean);
        return 1;
    }
    return weigh_block(&f, &q, &b, fabs(w->fx) + fabs(w->fy) < EVEN_BEND * w->f0, mean);
}
