/* filter.c -- see filter.h. */
#include "project/filter.h"
#include "project/filter_cut.h"
#include "project/filter_lanes.h"
#include <math.h>
#include <string.h>

#define MOST_STEEP 0.2     /* share by which w may change from a pixel's middle to its border, or it is cut */
#define MANY_CELLS 12000   /* elements that are weighed rather than being cut */
#define MOST_ROWS 60.0
#define MOST_PARTS 64
#define MOST_THICKENED 64.0 /* length up to which thin looks are thickened; a fraction of an element even then */
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

/* Solid bytes: `columns` of each of `count` rows that are `width` texels apart. Every lane has as many, for counts that change from lane to
 * lane cost more than what they spare. */
static inline void add_block(const unsigned char (*texel)[4], size_t width, const float *decode, const gnoi_filter_lane_row *rows, int count,
                             int columns, int lane, float sum[4])
{
    float red = sum[0], green = sum[1], blue = sum[2];
    for (int r = 0; r < count; r++, texel += width) {
        const float *area = &rows[r].area[0][lane];
        for (int c = 0; c < columns; c++) {
            red += area[c * GNOI_FILTER_LANES] * decode[texel[c][0]];
            green += area[c * GNOI_FILTER_LANES] * decode[texel[c][1]];
            blue += area[c * GNOI_FILTER_LANES] * decode[texel[c][2]];
        }
    }
    sum[0] = red;
    sum[1] = green;
    sum[2] = blue;
}

/* The columns are within the picture, the rows too or in the next repetition. */
static void add_bytes(const gnoi_image *image, const gnoi_filter_lane_row *rows, int count, int columns, int column, int row, int lane, float sum[4])
{
    const unsigned char(*texel)[4] = (const unsigned char(*)[4])image->bytes + column;
    size_t width = (size_t)image->width;
    if (columns <= GNOI_LANE_FEW_COLUMNS && row >= 0 && row + count <= image->height) {
        add_block(texel + (size_t)row * width + (int)rows[0].first[lane], width, image->decode, rows, count, columns, lane, sum);
        return;
    }
    row += row < 0 ? image->height : 0;
    for (int r = 0; r < count; r++, row = row + 1 == image->height ? 0 : row + 1)
        add_block(texel + (size_t)row * width + (int)rows[r].first[lane], width, image->decode, &rows[r], 1, rows[r].most, lane, sum);
}

static void add_values(const gnoi_look *look, int l, int column, int row, const gnoi_filter_lane_row *cells, int lane, float sum[4])
{
    const gnoi_image_level *level = &look->image->level[l];
    int j = wrapped(row, level->height, look->how->wrap);
    for (int c = 0; c < cells->columns[lane]; c++) {
        float area = cells->area[c][lane], value[4] = {1, 1, 1, 1};
        int i = wrapped(column + c, level->width, look->how->wrap);
        if (i >= 0 && j >= 0)
            gnoi_image_value(look->image, l, i, j, value);
        for (int k = 0; k < 4; k++)
            sum[k] += area * value[k];
    }
}

static int level_of(const gnoi_looks *looks, int look)
{
    return look < GNOI_ASKED ? 0 : looks->part[look - GNOI_ASKED].level;
}

/* A pixel's own look is its mean; those of its parts add up to it. */
static void answer(const gnoi_looks *looks, int which, const float sum[4], float weight)
{
    const gnoi_look *look = &looks->look[which];
    int is_part = which >= GNOI_ASKED, is_solid = look->image->is_solid && level_of(looks, which) == 0;
    float share = is_part ? looks->part[which - GNOI_ASKED].share : 1, k = share / weight;
    for (int i = 0; i < 3; i++)
        look->mean[i] = (is_part ? look->mean[i] : 0) + k * sum[i];
    look->mean[3] = (is_part ? look->mean[3] : 0) + (is_solid ? share : k * sum[3]);
}

/* The value of the one cell that a look lies in. */
static void answer_in_cell(const gnoi_looks *looks, int which)
{
    const gnoi_look *look = &looks->look[which];
    const gnoi_look_lanes *l = &looks->lanes;
    int level = level_of(looks, which);
    gno_wrap wrap = look->how->wrap;
    int i = wrapped(l->column[which] - (l->s[which] < 0), look->image->level[level].width, wrap);
    int j = wrapped(l->row[which] - (l->t[which] < 0), look->image->level[level].height, wrap);
    float value[4] = {1, 1, 1, 1};
    if (i >= 0 && j >= 0)
        gnoi_image_value(look->image, level, i, j, value);
    answer(looks, which, value, 1);
}

#define ROWS 8 /* at once */

static void load(const gnoi_look_lanes *from, const unsigned short *which, int count, gnoi_filter_lanes *to)
{
    for (int i = 0; i < GNOI_FILTER_LANES; i++) {
        int l = which[i < count ? i : 0];
        to->s[i] = from->s[l], to->t[i] = from->t[l];
        to->sx[i] = from->sx[l], to->sy[i] = from->sy[l];
        to->tx[i] = from->tx[l], to->ty[i] = from->ty[l];
        to->wx[i] = from->wx[l], to->wy[i] = from->wy[l];
    }
}

/* Whether `count` rows are rows of the picture, one after the other, the first one after the last. */
static int rows_follow(const gnoi_look *look, int row, int count)
{
    int height = look->image->height;
    return (row >= 0 && row + count <= height) || (look->how->wrap == GNO_WRAP_REPEAT && row >= -height && row < height && count <= height);
}

static void answer_together(const gnoi_looks *looks, const unsigned short *which, int count)
{
    gnoi_filter_lanes lanes;
    gnoi_filter_lane_row cells[ROWS];
    float sum[GNOI_FILTER_LANES][4];
    int rows = 0;
    for (int i = 0; i < count; i++)
        sum[i][0] = sum[i][1] = sum[i][2] = sum[i][3] = 0;
    load(&looks->lanes, which, count, &lanes);
    gnoi_filter_lanes_start(&lanes);
    for (int i = 0; i < count; i++)
        rows = lanes.rows[i] > rows ? lanes.rows[i] : rows;
    for (int r0 = 0; r0 < rows; r0 += ROWS) {
        int n = rows - r0 < ROWS ? rows - r0 : ROWS, most = 0;
        gnoi_filter_lanes_rows(&lanes, r0, n, cells);
        for (int r = 0; r < n; r++)
            most = cells[r].most > most ? cells[r].most : most;
        for (int i = 0; i < count; i++) {
            const gnoi_look *l = &looks->look[which[i]];
            int column = looks->lanes.column[which[i]], first = looks->lanes.row[which[i]] + (int)lanes.first_row[i] + r0;
            int m = lanes.rows[i] - r0 < n ? lanes.rows[i] - r0 : n, level = level_of(looks, which[i]);
            if (m <= 0)
                continue;
            if (level == 0 && l->image->is_solid && rows_follow(l, first, m) && column + (int)lanes.low_x[i] - 1 >= 0 &&
                column + (int)lanes.high_x[i] + 1 + most <= l->image->width) {
                add_bytes(l->image, cells, m, lanes.most, column, first, i, sum[i]);
                continue;
            }
            for (int r = 0; r < m; r++)
                add_values(l, level, column + (int)cells[r].first[i], first + r, &cells[r], i, sum[i]);
        }
    }
    for (int i = 0; i < count; i++)
        answer(looks, which[i], sum[i], lanes.weight[i]);
}

/* Returns the last kind there is, or `last`. */
static int count_kinds(const int *kind, int first, int end, int last, int *counts)
{
    for (int i = first; i < end; i++) {
        counts[kind[i] + 1]++;
        last = kind[i] > last ? kind[i] : last;
    }
    return last;
}

static void sort_by_kind(const int *kind, int first, int end, int *place, unsigned short *order)
{
    for (int i = first; i < end; i++)
        order[place[kind[i] + 1]++] = (unsigned short)i;
}

/* Looks of one kind go together: the first `count` pixels' and then those from number GNOI_ASKED on. */
static void answer_looks(const gnoi_looks *looks, int count)
{
    unsigned short order[GNOI_LOOKS];
    int place[GNOI_LOOK_KINDS + 1] = {0}, total = 0, first, last, i; /* pixels that have no look of their own come first, with kind -1 */
    const int *kind = looks->lanes.kind;
    last = count_kinds(kind, 0, count, GNOI_LOOK_IN_CELL, place);
    last = count_kinds(kind, GNOI_ASKED, looks->end, last, place);
    first = place[0];
    for (int k = 0; k <= last + 1; k++) {
        int n = place[k];
        place[k] = total;
        total += n;
    }
    sort_by_kind(kind, 0, count, place, order);
    sort_by_kind(kind, GNOI_ASKED, looks->end, place, order);
    for (i = first; i < place[GNOI_LOOK_IN_CELL + 1]; i++)
        answer_in_cell(looks, order[i]);
    for (; i < total; i += GNOI_FILTER_LANES)
        answer_together(looks, order + i, total - i < GNOI_FILTER_LANES ? total - i : GNOI_FILTER_LANES);
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
    double need = 2 * GNOI_LEAST_TURN * square_length(v), a = v->sx * v->sx + v->tx * v->tx, b = v->sy * v->sy + v->ty * v->ty, k;
    int flat_s = v->sx == 0 && v->sy == 0, flat_t = v->tx == 0 && v->ty == 0;
    if (turn_of(v) > 0.5 * need || !(need < 2 * GNOI_LEAST_TURN * MOST_THICKENED * MOST_THICKENED) || !(need > 0))
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
    return turn_of(v) > GNOI_LEAST_TURN * length && length > GNOI_LEAST_LENGTH * GNOI_LEAST_LENGTH &&
           fabs(v->wx) + fabs(v->wy) < 2.1 * GNOI_MOST_BEND && fabs(v->s) < GNOI_FAR_ELEMENTS && fabs(v->t) < GNOI_FAR_ELEMENTS;
}

/* Of what lies within int's range. */
static inline int floor_of(double v)
{
    int whole = (int)v;
    return whole - (v < whole);
}

/* A place along one axis, less far than GNOI_FAR_ELEMENTS, brought into the first pattern, or pair of patterns. */
static inline double home(double v, int elements, gno_wrap wrap)
{
    double period = wrap == GNO_WRAP_MIRROR ? 2.0 * elements : elements;
    if ((v >= 0 && v < elements) || wrap == GNO_WRAP_CLAMP || wrap == GNO_WRAP_NONE)
        return v;
    return v - period * floor_of(v / period);
}

static void add_look(gnoi_looks *looks, const gnoi_look *of, const view *v, int level, double share)
{
    int i = looks->end++;
    gnoi_look_lanes *to = &looks->lanes;
    double k = 1.0 / (1 << level), s = k * home(v->s, of->image->width, of->how->wrap), t = k * home(v->t, of->image->height, of->how->wrap);
    looks->look[i] = *of;
    looks->part[i - GNOI_ASKED].share = (float)share;
    looks->part[i - GNOI_ASKED].level = level;
    to->column[i] = floor_of(s + 0.5);
    to->row[i] = floor_of(t + 0.5);
    to->s[i] = (float)(s - to->column[i]), to->t[i] = (float)(t - to->row[i]);
    to->sx[i] = (float)(k * v->sx), to->sy[i] = (float)(k * v->sy);
    to->tx[i] = (float)(k * v->tx), to->ty[i] = (float)(k * v->ty);
    to->wx[i] = (float)v->wx, to->wy[i] = (float)v->wy;
    to->kind[i] = gnoi_look_kind(to->s[i], to->t[i], fabsf(to->sx[i]) + fabsf(to->sy[i]), fabsf(to->tx[i]) + fabsf(to->ty[i]), fabsf(to->wx[i]) + fabsf(to->wy[i]));
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
    int i0 = floor_of(s - wide), j0 = floor_of(t - high), columns, rows;
    double share = 1 / (k * k * turn_of(v)); /* of a cell in the pixel: those under the box around a thin one say nothing */
    size_t middle;
    float variance = 0;
    if (2 * wide + 2 > BLOCK_SIDE || 2 * high + 2 > BLOCK_SIDE)
        return 0;
    columns = floor_of(s + wide) - i0 + 1;
    rows = floor_of(t + high) - j0 + 1;
    if (!is_on_grid(wrap, i0, columns, image->width, level) || !is_on_grid(wrap, j0, rows, image->height, level))
        return 0;
    middle = (size_t)wrapped(j0 + rows / 2, l->height, wrap) * (size_t)l->width + (size_t)wrapped(i0 + columns / 2, l->width, wrap);
    if (!gnoi_filter_is_small(share, BLOCK_TOLERANCE, l->variance[middle])) /* mostly that is enough of an answer */
        return 0;
    for (int j = 0; j < rows; j++) {
        size_t row = (size_t)wrapped(j0 + j, l->height, wrap) * (size_t)l->width;
        for (int i = 0; i < columns; i++) {
            float own = l->variance[row + (size_t)wrapped(i0 + i, l->width, wrap)];
            variance = own > variance ? own : variance;
        }
        if (!gnoi_filter_is_small(share, BLOCK_TOLERANCE, variance))
            return 0;
    }
    return 1;
}

/* The level whose cells to weigh; -1 where there are too many. */
static int level_for(const gnoi_image *image, gno_wrap wrap, const view *v)
{
    double wide = fabs(v->sx) + fabs(v->sy), high = fabs(v->tx) + fabs(v->ty), widest = wide > high ? wide : high;
    int level = 0;
    if (cells_of(v) <= GNOI_FEW_CELLS)
        return 0;
    if (!(widest < GNOI_FAR_ELEMENTS && fabs(v->s) < GNOI_FAR_ELEMENTS && fabs(v->t) < GNOI_FAR_ELEMENTS))
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
    double k = 1.0 / (1 << level), steep = 0.5 * (fabs(v->wx) + fabs(v->wy)), bend = (1 - steep) * GNOI_MOST_BEND, nx, ny;
    if (!(steep < MOST_STEEP))
        return 0;
    nx = ceil(fabs(v->wx) / bend);
    ny = ceil(fabs(v->wy) / bend);
    nx = nx < 1 || steep < GNOI_MOST_BEND ? 1 : nx;
    ny = ny < 1 || steep < GNOI_MOST_BEND ? 1 : ny;
    while (nx * ny <= MOST_PARTS && (k * (fabs(v->sx) / nx + fabs(v->sy) / ny) > GNOI_MOST_COLUMNS || k * (fabs(v->tx) / nx + fabs(v->ty) / ny) > MOST_ROWS)) {
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
static int add_parts(gnoi_looks *looks, const gnoi_look *of, const gnoi_pattern *p, int level, int across, int down)
{
    int start = looks->end;
    for (int i = 0; i < across * down; i++) {
        view v = part_at(of->image, p, (i % across + 0.5) / across - 0.5, (i / across + 0.5) / down - 0.5, across, down);
        thicken(&v);
        if (!is_sound(&v)) {
            looks->end = start;
            return 0;
        }
        add_look(looks, of, &v, level, 1.0 / (across * down));
    }
    return 1;
}

/* ---- a pixel ---------------------------------------------------------------------------------------------------------------- */

static gnoi_screen_plane around(double f0, double fx, double fy)
{
    gnoi_screen_plane f;
    f.fx = fx;
    f.fy = fy;
    f.f0 = f0;
    return f;
}

static gnoi_screen_plane scaled(const gnoi_screen_plane *f, double factor)
{
    return around(factor * f->f0, factor * f->fx, factor * f->fy);
}

static void cut(const gnoi_look *of, double xs, double ys, const view *enlarged, const gnoi_pattern *p)
{
    const gnoi_image *image = of->image;
    gnoi_screen_plane s = scaled(&p->s, image->width), t = scaled(&p->t, image->height), w = p->w;
    if (enlarged) {
        s = around(enlarged->s, enlarged->sx, enlarged->sy);
        t = around(enlarged->t, enlarged->tx, enlarged->ty);
        w = around(1, 0, 0);
    }
    if (gnoi_filter_cut(image, of->how->wrap, &s, &t, &w, of->mean))
        return;
    s = around(image->width * gnoi_plane_at(&p->s, xs, ys), 0, 0);
    t = around(image->height * gnoi_plane_at(&p->t, xs, ys), 0, 0);
    w = around(gnoi_plane_at(&p->w, xs, ys), 0, 0);
    gnoi_filter_cut(image, of->how->wrap, &s, &t, &w, of->mean);
}

/* Whatever the pixel is like. */
static void look_closer(gnoi_looks *looks, const gnoi_look *of, double xs, double ys, const gnoi_pattern *p)
{
    const gno_texture *how = of->how;
    view v = view_at(of->image, p, 0, 0);
    int enlarged = how->filter == GNO_FILTER_LINEAR && v.w > 0 && enlarge(&v), level, across, down;
    thicken(&v);
    if (v.w > 0 && (level = level_for(of->image, how->wrap, &v)) >= 0 && find_parts(&v, level, &across, &down)) {
        if (across * down > 1 && add_parts(looks, of, p, level, across, down))
            return;
        if (across * down == 1 && is_sound(&v)) {
            add_look(looks, of, &v, level, 1);
            return;
        }
    }
    cut(of, xs, ys, enlarged ? &v : NULL, p);
}

static inline double period_of(const gno_texture *how)
{
    if (how->filter != GNO_FILTER_BOX)
        return -1;
    return how->wrap == GNO_WRAP_REPEAT ? 1 : how->wrap == GNO_WRAP_MIRROR ? 2 : 0;
}

/* The pixels whose views wait. */
static void take(gnoi_looks *looks)
{
    const gnoi_views *v = &looks->views;
    int first = looks->count > 0 ? (looks->count - 1) / GNOI_VIEWS * GNOI_VIEWS : 0, count = looks->count - first;
    gnoi_views_take(&looks->views, count, &looks->lanes, first);
    for (int i = 0; i < count; i++) {
        const gnoi_look *l = &looks->look[first + i];
        if (looks->lanes.kind[first + i] < 0) {
            l->mean[0] = l->mean[1] = l->mean[2] = l->mean[3] = 0;
            gnoi_pattern p;
            p.s = around(v->s[i], v->sx[i], v->sy[i]);
            p.t = around(v->t[i], v->tx[i], v->ty[i]);
            p.w = around(v->w[i], v->wx[i], v->wy[i]);
            if (looks->end + MOST_PARTS > GNOI_LOOKS) {
                answer_looks(looks, 0);
                looks->end = GNOI_ASKED;
            }
            look_closer(looks, l, looks->xs[i], looks->ys[i], &p);
        }
    }
}

/* As many as there is room for among the views. */
static int ask_some(gnoi_looks *looks, const gnoi_image *image, const gno_texture *how, const gnoi_pattern *p, double x, double y, int count,
                    const double *xs, const double *ys, float (*mean)[4])
{
    int place = looks->count % GNOI_VIEWS, some = count < GNOI_VIEWS - place ? count : GNOI_VIEWS - place;
    gnoi_view_extent extent = {image->width, image->height, period_of(how)};
    gnoi_look *l = &looks->look[looks->count];
    gnoi_views_set(&looks->views, place, some, p, x, y, &extent);
    for (int i = 0; i < some; i++) {
        l[i].image = image;
        l[i].how = how;
        l[i].mean = mean[i];
        looks->xs[place + i] = xs[i] - (x + i);
        looks->ys[place + i] = ys[i] - y;
    }
    looks->count += some;
    if (looks->count % GNOI_VIEWS == 0)
        take(looks);
    return some;
}

void gnoi_looks_ask(gnoi_looks *looks, const gnoi_image *image, const gno_texture *how, const gnoi_pattern *p, double x, double y, int count,
                    const double *xs, const double *ys, float (*mean)[4])
{
    for (int i = 0; i < count;) {
        if (looks->count == GNOI_ASKED)
            gnoi_looks_answer(looks);
        if (looks->count == 0)
            looks->end = GNOI_ASKED;
        i += ask_some(looks, image, how, p, x + i, y, count - i, xs + i, ys + i, mean + i);
    }
}

void gnoi_looks_answer(gnoi_looks *looks)
{
    if (looks->count == 0)
        return;
    if (looks->count % GNOI_VIEWS != 0)
        take(looks);
    answer_looks(looks, looks->count);
    looks->count = 0;
}

void gnoi_filter_pixel(const gnoi_image *image, const gno_texture *how, const gnoi_pattern *p, double x, double y, double xs, double ys,
                       float mean[4])
{
    gnoi_looks looks;
    looks.count = 0;
    gnoi_looks_ask(&looks, image, how, p, x, y, 1, &xs, &ys, (float(*)[4])mean);
    gnoi_looks_answer(&looks);
}
