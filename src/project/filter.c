/* filter.c -- see filter.h. */
#include "project/filter.h"
#include "project/filter_cut.h"
#include "project/filter_lanes.h"
#include <string.h>

#define MOST_BEND 0.03     /* share by which w may change from a look's middle to its border */
#define MOST_STEEP 0.2     /* and from a pixel's, or it is cut */
#define FEW_CELLS 100       /* so many elements are weighed without a look at coarser cells */
#define MANY_CELLS 12000   /* and these rather than being cut */
#define MOST_COLUMNS 60.0  /* of a look */
#define MOST_ROWS 60.0
#define MOST_PARTS 64
#define LEAST_TURN 1e-4    /* of a look's area to the square of its length, in elements: thinner ones drown in rounding */
#define LEAST_LENGTH 1e-8
#define MOST_THICKENED 64.0 /* length up to which they are made so thick; a fraction of an element even then */
#define FAR_ELEMENTS 1e9   /* of int's range */
#define BLOCK_TOLERANCE 0.004 /* aim for the error of a pixel's mean from cells of a coarse level, none of them large or drawn out */
#define BLOCK_SIDE 24      /* of such cells at most */

/* ---- answers -------------------------------------------------------------------------------------------------------------- */

/* The cell of a level at place i of n; -1 where there is none. */
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

typedef struct weighed {
    float value[4], weight;
} weighed;

/* Solid bytes, all of them within the picture: `count` rows, each with as many cells for every lane, for counts that change from
 * lane to lane cost more than what they spare. */
static void add_bytes(const gnoi_look *look, const gnoi_filter_lane_row *rows, int count, int row, int lane, weighed *sum)
{
    const float *decode = look->image->decode;
    unsigned char(*line)[4] = look->image->bytes + (size_t)row * (size_t)look->image->width;
    float red = sum->value[0], green = sum->value[1], blue = sum->value[2], weight = sum->weight;
    for (int r = 0; r < count; r++, line += look->image->width) {
        unsigned char(*v)[4] = line + look->column + (int)rows[r].first[lane];
        for (int c = 0; c < rows[r].most; c++) {
            float area = rows[r].area[c][lane];
            red += area * decode[v[c][0]];
            green += area * decode[v[c][1]];
            blue += area * decode[v[c][2]];
            weight += area;
        }
    }
    sum->value[0] = red;
    sum->value[1] = green;
    sum->value[2] = blue;
    sum->weight = weight;
}

static void add_values(const gnoi_look *look, int column, int row, const gnoi_filter_lane_row *cells, int lane, weighed *sum)
{
    const gnoi_image_level *level = &look->image->level[look->level];
    int j = wrapped(row, level->height, (gno_wrap)look->wrap);
    for (int c = 0; c < cells->columns[lane]; c++) {
        float area = cells->area[c][lane], value[4] = {1, 1, 1, 1};
        int i = wrapped(column + c, level->width, (gno_wrap)look->wrap);
        if (i >= 0 && j >= 0)
            gnoi_image_value(look->image, look->level, i, j, value);
        for (int k = 0; k < 4; k++)
            sum->value[k] += area * value[k];
        sum->weight += area;
    }
}

static void answer(const gnoi_look *look, const weighed *sum)
{
    float k = look->share / sum->weight;
    for (int i = 0; i < 3; i++)
        look->mean[i] += k * sum->value[i];
    look->mean[3] += look->solid ? look->share : k * sum->value[3];
}

#define ROWS 8 /* at once */

static void answer_together(const gnoi_look *const look[GNOI_FILTER_LANES], int count)
{
    gnoi_filter_lanes lanes;
    gnoi_filter_lane_row cells[ROWS];
    weighed sum[GNOI_FILTER_LANES];
    int rows = 0;
    for (int i = 0; i < GNOI_FILTER_LANES; i++) {
        const gnoi_look *l = look[i < count ? i : 0];
        lanes.s[i] = l->s, lanes.t[i] = l->t;
        lanes.sx[i] = l->sx, lanes.sy[i] = l->sy;
        lanes.tx[i] = l->tx, lanes.ty[i] = l->ty;
        lanes.wx[i] = l->wx, lanes.wy[i] = l->wy;
    }
    memset(sum, 0, sizeof sum);
    gnoi_filter_lanes_start(&lanes);
    for (int i = 0; i < count; i++)
        rows = lanes.rows[i] > rows ? lanes.rows[i] : rows;
    for (int r0 = 0; r0 < rows; r0 += ROWS) {
        int n = rows - r0 < ROWS ? rows - r0 : ROWS, most = 0;
        for (int r = 0; r < n; r++) {
            gnoi_filter_lanes_row(&lanes, r0 + r, &cells[r]);
            most = cells[r].most > most ? cells[r].most : most;
        }
        for (int i = 0; i < count; i++) {
            const gnoi_look *l = look[i];
            int first = l->row + (int)lanes.first_row[i] + r0, m = lanes.rows[i] - r0 < n ? lanes.rows[i] - r0 : n;
            if (l->solid && first >= 0 && first + m <= l->image->height && l->column + (int)lanes.low_x[i] - 1 >= 0 &&
                l->column + (int)lanes.high_x[i] + 1 + most <= l->image->width) {
                add_bytes(l, cells, m, first, i, &sum[i]);
                continue;
            }
            for (int r = 0; r < m; r++)
                add_values(l, l->column + (int)cells[r].first[i], first + r, &cells[r], i, &sum[i]);
        }
    }
    for (int i = 0; i < count; i++)
        answer(look[i], &sum[i]);
}

/* Looks of about one size go together, or many lanes would wait for few. */
#define SIZES 9

static int size_of(float extent)
{
    return extent < 4 ? (int)extent : extent < 6 ? 4 : extent < 9 ? 5 : extent < 14 ? 6 : extent < 24 ? 7 : 8;
}

void gnoi_looks_answer(gnoi_looks *looks)
{
    const gnoi_look *order[GNOI_LOOKS];
    unsigned char size[GNOI_LOOKS];
    int end[2 * SIZES * SIZES] = {0}, count = 0;
    for (int i = 0; i < looks->count; i++) {
        const gnoi_look *l = &looks->look[i];
        int uneven = fabsf(l->wx) + fabsf(l->wy) > GNOI_EVEN_BEND;
        size[i] = (unsigned char)((uneven * SIZES + size_of(fabsf(l->tx) + fabsf(l->ty))) * SIZES + size_of(fabsf(l->sx) + fabsf(l->sy)));
        end[size[i]]++;
    }
    for (int k = 0; k < 2 * SIZES * SIZES; k++) {
        int n = end[k];
        end[k] = count;
        count += n;
    }
    for (int i = 0; i < looks->count; i++)
        order[end[size[i]]++] = &looks->look[i];
    for (int i = 0; i < looks->count; i += GNOI_FILTER_LANES)
        answer_together(order + i, looks->count - i < GNOI_FILTER_LANES ? looks->count - i : GNOI_FILTER_LANES);
    looks->count = 0;
}

/* ---- questions ------------------------------------------------------------------------------------------------------------- */

/* A square of the picture on the pattern: its middle's place, in elements, and what its sides change place and w by, as in gnoi_look. */
typedef struct view {
    double s, t, w, sx, sy, tx, ty, wx, wy;
} view;

static inline view view_at(const gnoi_image *image, const gnoi_pattern *p, double x, double y)
{
    double w = gnoi_plane_at(&p->w, x, y), k = 1 / w, s = gnoi_plane_at(&p->s, x, y) * k, t = gnoi_plane_at(&p->t, x, y) * k;
    double across = k * image->width, up = k * image->height;
    view v;
    v.s = s * image->width;
    v.t = t * image->height;
    v.w = w;
    v.sx = (p->s.fx - s * p->w.fx) * across;
    v.sy = (p->s.fy - s * p->w.fy) * across;
    v.tx = (p->t.fx - t * p->w.fx) * up;
    v.ty = (p->t.fy - t * p->w.fy) * up;
    v.wx = p->w.fx * k;
    v.wy = p->w.fy * k;
    return v;
}

/* Linear enlargement: the pixel's image on the pattern grows by one element each way, so that a pixel small against the elements
 * sees the square of one element around it, which weights its neighbours bilinearly. Returns 0 where it is too large for that. */
static int enlarge(view *v)
{
    int turned = fabs(v->sx) + fabs(v->ty) < fabs(v->sy) + fabs(v->tx);
    if (!(fabs(v->sx) + fabs(v->sy) + fabs(v->tx) + fabs(v->ty) <= 16))
        return 0;
    v->sx += turned ? 0 : copysign(1, v->sx);
    v->sy += turned ? copysign(1, v->sy) : 0;
    v->tx += turned ? copysign(1, v->tx) : 0;
    v->ty += turned ? 0 : copysign(1, v->ty);
    v->wx = v->wy = 0;
    return 1;
}

static inline double cells_of(const view *v) { return (fabs(v->sx) + fabs(v->sy) + 1) * (fabs(v->tx) + fabs(v->ty) + 1); }

static inline double turn_of(const view *v) { return fabs(v->sx * v->ty - v->sy * v->tx); }

static inline double square_length(const view *v)
{
    double wide = fabs(v->sx) + fabs(v->sy), high = fabs(v->tx) + fabs(v->ty);
    return wide * wide + high * high;
}

/* Off the line between two elements, for what runs along it. */
static double aside(double place, double extent)
{
    double element = floor(place), part = place - element;
    return element + (part < extent ? extent : part > 1 - extent ? 1 - extent : part);
}

/* Patterns drawn out to lines, as texture coordinates that do not differ make them, get the least thickness. */
static void thicken(view *v)
{
    double need = 2 * LEAST_TURN * square_length(v), a = v->sx * v->sx + v->tx * v->tx, b = v->sy * v->sy + v->ty * v->ty, k;
    int flat_s = v->sx == 0 && v->sy == 0, flat_t = v->tx == 0 && v->ty == 0;
    if (turn_of(v) > 0.5 * need || !(need < 2 * LEAST_TURN * MOST_THICKENED * MOST_THICKENED) || !(need > 0))
        return;
    k = copysign(need / (a > b ? a : b), v->sx * v->ty - v->sy * v->tx);
    if (a > b) {
        v->sy -= k * v->tx;
        v->ty += k * v->sx;
    } else {
        v->sx += k * v->ty;
        v->tx -= k * v->sy;
    }
    if (flat_s)
        v->s = aside(v->s, fabs(v->sx) + fabs(v->sy));
    if (flat_t)
        v->t = aside(v->t, fabs(v->tx) + fabs(v->ty));
}

static inline int is_sound(const view *v)
{
    double length = square_length(v);
    return turn_of(v) > LEAST_TURN * length && length > LEAST_LENGTH * LEAST_LENGTH &&
           fabs(v->wx) + fabs(v->wy) < 2.1 * MOST_BEND && fabs(v->s) < FAR_ELEMENTS && fabs(v->t) < FAR_ELEMENTS;
}

/* Of what lies within int's range. */
static inline int floor_of(double v)
{
    int whole = (int)v;
    return whole - (v < whole);
}

/* A place along one axis, less far than FAR_ELEMENTS, brought into the first pattern, or pair of patterns. */
static inline double home(double v, int elements, gno_wrap wrap)
{
    double period = wrap == GNO_WRAP_MIRROR ? 2.0 * elements : elements;
    if ((v >= 0 && v < elements) || wrap == GNO_WRAP_CLAMP || wrap == GNO_WRAP_NONE)
        return v;
    return v - period * floor_of(v / period);
}

static inline void add_look(gnoi_looks *looks, const gnoi_image *image, gno_wrap wrap, const view *v, int level, double share, float mean[4])
{
    gnoi_look *l = &looks->look[looks->count++];
    double k = 1.0 / (1 << level), s = k * home(v->s, image->width, wrap), t = k * home(v->t, image->height, wrap);
    l->image = image;
    l->mean = mean;
    l->share = (float)share;
    l->column = floor_of(s + 0.5);
    l->row = floor_of(t + 0.5);
    l->s = (float)(s - l->column), l->t = (float)(t - l->row);
    l->sx = (float)(k * v->sx), l->sy = (float)(k * v->sy);
    l->tx = (float)(k * v->tx), l->ty = (float)(k * v->ty);
    l->wx = (float)v->wx, l->wy = (float)v->wy;
    l->level = (unsigned char)level;
    l->wrap = (unsigned char)wrap;
    l->solid = level == 0 && image->bytes && !image->has_alpha;
}

/* ---- coarser cells ---------------------------------------------------------------------------------------------------------- */

/* Whether cells first .. first + count - 1 along an axis are all of the same width: within the picture, or in any if it is so many of them. */
static int is_on_grid(gno_wrap wrap, int first, int count, int elements, int level)
{
    int repeats = wrap == GNO_WRAP_REPEAT || wrap == GNO_WRAP_MIRROR;
    return (first >= 0 && first + count <= elements >> level) || (repeats && (elements & ((1 << level) - 1)) == 0);
}

/* 1 when cells of `level` > 0 may stand for their elements: few enough, on one grid, each so small a share of the pixel, or so even, that
 * what its mean does to the part of it that is seen is below the tolerance. */
static int is_fine(const gnoi_image *image, gno_wrap wrap, const view *v, int level)
{
    const gnoi_image_level *l = &image->level[level];
    double k = 1.0 / (1 << level), s = k * home(v->s, image->width, wrap), t = k * home(v->t, image->height, wrap);
    double wide = 0.5 * k * (fabs(v->sx) + fabs(v->sy)), high = 0.5 * k * (fabs(v->tx) + fabs(v->ty));
    int i0 = (int)floor(s - wide), j0 = (int)floor(t - high), columns, rows;
    float spread = 0;
    if (2 * wide + 2 > BLOCK_SIDE || 2 * high + 2 > BLOCK_SIDE)
        return 0;
    columns = (int)floor(s + wide) - i0 + 1;
    rows = (int)floor(t + high) - j0 + 1;
    if (!is_on_grid(wrap, i0, columns, image->width, level) || !is_on_grid(wrap, j0, rows, image->height, level))
        return 0;
    for (int j = 0; j < rows; j++) {
        size_t row = (size_t)wrapped(j0 + j, l->height, wrap) * (size_t)l->width;
        for (int i = 0; i < columns; i++) {
            float own = l->spread[row + (size_t)wrapped(i0 + i, l->width, wrap)];
            spread = own > spread ? own : spread;
        }
        if (spread > 0 && 1.0 / (columns * rows) > gnoi_filter_most_area(BLOCK_TOLERANCE, spread))
            return 0;
    }
    return 1;
}

/* The level whose cells to weigh; -1 where there are too many. */
static int level_for(const gnoi_image *image, gno_wrap wrap, const view *v)
{
    double wide = fabs(v->sx) + fabs(v->sy), high = fabs(v->tx) + fabs(v->ty), widest = wide > high ? wide : high;
    int level = 0;
    if (cells_of(v) <= FEW_CELLS)
        return 0;
    if (!(widest < FAR_ELEMENTS && fabs(v->s) < FAR_ELEMENTS && fabs(v->t) < FAR_ELEMENTS))
        return -1;
    while (level + 1 < image->level_count && widest > (double)(3 << level))
        level++;
    for (; level > 0; level--)
        if (is_fine(image, wrap, v, level))
            return level;
    return cells_of(v) <= MANY_CELLS ? 0 : -1;
}

/* ---- parts ------------------------------------------------------------------------------------------------------------------ */

/* How many parts side by side and one above the other make sound looks. Returns 0 where that is too many. */
static int find_parts(const view *v, int level, int *across, int *down)
{
    double k = 1.0 / (1 << level), steep = 0.5 * (fabs(v->wx) + fabs(v->wy)), bend = (1 - steep) * MOST_BEND, nx, ny;
    if (!(steep < MOST_STEEP))
        return 0;
    nx = ceil(fabs(v->wx) / bend);
    ny = ceil(fabs(v->wy) / bend);
    nx = nx < 1 || steep < MOST_BEND ? 1 : nx;
    ny = ny < 1 || steep < MOST_BEND ? 1 : ny;
    while (nx * ny <= MOST_PARTS && (k * (fabs(v->sx) / nx + fabs(v->sy) / ny) > MOST_COLUMNS || k * (fabs(v->tx) / nx + fabs(v->ty) / ny) > MOST_ROWS)) {
        if ((fabs(v->sx) + fabs(v->tx)) * ny > (fabs(v->sy) + fabs(v->ty)) * nx)
            nx++;
        else
            ny++;
    }
    *across = (int)nx;
    *down = (int)ny;
    return nx * ny <= MOST_PARTS;
}

static view part_at(const gnoi_image *image, const gnoi_pattern *p, double x, double y, double across, double down)
{
    view v = view_at(image, p, x, y);
    v.sx /= across, v.tx /= across, v.wx /= across;
    v.sy /= down, v.ty /= down, v.wy /= down;
    return v;
}

/* The looks of a pixel in parts; 0 where one of them would not be sound. */
static int add_parts(gnoi_looks *looks, const gnoi_image *image, gno_wrap wrap, const gnoi_pattern *p, double x, double y, int level,
                     int across, int down, float mean[4])
{
    int start = looks->count;
    for (int i = 0; i < across * down; i++) {
        view v = part_at(image, p, x - 0.5 + (i % across + 0.5) / across, y - 0.5 + (i / across + 0.5) / down, across, down);
        thicken(&v);
        if (!is_sound(&v)) {
            looks->count = start;
            return 0;
        }
        add_look(looks, image, wrap, &v, level, 1.0 / (across * down), mean);
    }
    return 1;
}

/* ---- a pixel ---------------------------------------------------------------------------------------------------------------- */

static gnoi_screen_plane relative(gnoi_screen_plane f, double factor, double x, double y)
{
    f.f0 = factor * gnoi_plane_at(&f, x, y);
    f.fx *= factor;
    f.fy *= factor;
    return f;
}

static gnoi_screen_plane around(double f0, double fx, double fy)
{
    gnoi_screen_plane f;
    f.fx = fx;
    f.fy = fy;
    f.f0 = f0;
    return f;
}

static void cut(const gnoi_image *image, gno_wrap wrap, const view *enlarged, const gnoi_pattern *p, double x, double y, double xs,
                double ys, float mean[4])
{
    gnoi_screen_plane s = relative(p->s, image->width, x, y), t = relative(p->t, image->height, x, y), w = relative(p->w, 1, x, y);
    if (enlarged) {
        s = around(enlarged->s, enlarged->sx, enlarged->sy);
        t = around(enlarged->t, enlarged->tx, enlarged->ty);
        w = around(1, 0, 0);
    }
    if (gnoi_filter_cut(image, wrap, &s, &t, &w, mean))
        return;
    s = around(image->width * gnoi_plane_at(&p->s, xs, ys), 0, 0);
    t = around(image->height * gnoi_plane_at(&p->t, xs, ys), 0, 0);
    w = around(gnoi_plane_at(&p->w, xs, ys), 0, 0);
    gnoi_filter_cut(image, wrap, &s, &t, &w, mean);
}

/* Whatever the pixel is like. */
static void ask(gnoi_looks *looks, const gnoi_image *image, const gno_texture *how, const gnoi_pattern *p, double x, double y, double xs,
                double ys, float mean[4])
{
    view v = view_at(image, p, x, y);
    int enlarged = how->filter == GNO_FILTER_LINEAR && v.w > 0 && enlarge(&v), level, across, down;
    thicken(&v);
    if (v.w > 0 && (level = level_for(image, how->wrap, &v)) >= 0 && find_parts(&v, level, &across, &down)) {
        mean[0] = mean[1] = mean[2] = mean[3] = 0;
        if (across * down > 1 && add_parts(looks, image, how->wrap, p, x, y, level, across, down, mean))
            return;
        if (across * down == 1 && is_sound(&v)) {
            add_look(looks, image, how->wrap, &v, level, 1, mean);
            return;
        }
    }
    cut(image, how->wrap, enlarged ? &v : NULL, p, x, y, xs, ys, mean);
}

void gnoi_looks_ask(gnoi_looks *looks, const gnoi_image *image, const gno_texture *how, const gnoi_pattern *p, double x, double y,
                    double xs, double ys, float mean[4])
{
    view v = view_at(image, p, x, y);
    if (looks->count + MOST_PARTS > GNOI_LOOKS)
        gnoi_looks_answer(looks);
    if (v.w > 0 && how->filter == GNO_FILTER_BOX && cells_of(&v) <= FEW_CELLS && is_sound(&v)) {
        mean[0] = mean[1] = mean[2] = mean[3] = 0;
        add_look(looks, image, how->wrap, &v, 0, 1, mean);
    } else {
        ask(looks, image, how, p, x, y, xs, ys, mean);
    }
}

void gnoi_filter_pixel(const gnoi_image *image, const gno_texture *how, const gnoi_pattern *p, double x, double y, double xs, double ys,
                       float mean[4])
{
    gnoi_looks looks;
    looks.count = 0;
    gnoi_looks_ask(&looks, image, how, p, x, y, xs, ys, mean);
    gnoi_looks_answer(&looks);
}
