/* relief.c -- see relief.h.
 *
 * Heights of a picture are bilinear between the middles of its cells, and their derivatives are differences one cell apart; the cells
 * are those of the two levels between which a pixel's size lies, so that far bumps flatten out to their mean. Steps of both
 * along S and T are steps of the point, Q_x and Q_y, found from how point and pattern change over the picture.
 */
#include "shade/relief.h"
#include "base/vector.h"
#include "project/filter.h"
#include <math.h>
#include <string.h>

#define INLINE static inline __attribute__((always_inline))

#define MOST_DRAWN_OUT 4.0 /* a pixel is taken as long as this many times its width at the most, or its bumps would fade too soon */

/* Steps of the scene point for one pattern along S and along T. */
typedef struct frame {
    double s, t;           /* place on the pattern */
    vec3 qx, qy;
    double length, width;  /* of the pixel, in patterns */
} frame;

/* 0 where the pattern does not change over the picture. Orthographic or not is a constant at each call. */
INLINE int frame_at(const gnoi_view *view, int orthographic, const gnoi_screen_plane *nearness, const gnoi_pattern *p, double x, double y, frame *f)
{
    double w = gnoi_plane_at(&p->w, x, y), z = gnoi_plane_at(nearness, x, y), k = 1 / w, sx, sy, tx, ty, det, a, b;
    vec3 dx = v3_scale(view->right, view->unit), dy = v3_scale(view->up, -view->unit);
    f->s = gnoi_plane_at(&p->s, x, y) * k;
    f->t = gnoi_plane_at(&p->t, x, y) * k;
    sx = (p->s.fx - f->s * p->w.fx) * k, sy = (p->s.fy - f->s * p->w.fy) * k;
    tx = (p->t.fx - f->t * p->w.fx) * k, ty = (p->t.fy - f->t * p->w.fy) * k;
    det = sx * ty - sy * tx;
    a = sx * sx + tx * tx;
    b = sy * sy + ty * ty;
    a = a > b ? a : b;
    if (orthographic) {
        dx = v3_mad(dx, view->forward, -nearness->fx);
        dy = v3_mad(dy, view->forward, -nearness->fy);
        k = 1 / det;
    } else {
        double u = (x - 0.5 * view->width) * view->unit, v = (y - 0.5 * view->height) * view->unit;
        vec3 ray = v3_scale(v3_add(v3_sub(v3_scale(view->right, u), v3_scale(view->up, v)), view->forward), 1 / z);
        dx = v3_mad(dx, ray, -nearness->fx);
        dy = v3_mad(dy, ray, -nearness->fy);
        k = 1 / (z * det);
    }
    f->length = sqrt(a);
    f->width = fabs(det) / f->length;
    f->qx = v3_scale(v3_sub(v3_scale(dx, ty), v3_scale(dy, tx)), k);
    f->qy = v3_scale(v3_sub(v3_scale(dy, sx), v3_scale(dx, sy)), k);
    return (w > 0) & ((z > 0) | orthographic) & (fabs(det) > 1e-12 * a);
}

static int find_frame(const gnoi_sight *sight, const gnoi_pattern *p, double x, double y, frame *f)
{
    return frame_at(sight->view, sight->view->orthographic, sight->nearness, p, x, y, f);
}

/* Frames side by side. */
typedef struct frames {
    double s[GNOI_RELIEF_RUN], t[GNOI_RELIEF_RUN], length[GNOI_RELIEF_RUN], width[GNOI_RELIEF_RUN];
    double qx[3][GNOI_RELIEF_RUN], qy[3][GNOI_RELIEF_RUN];
    double good[GNOI_RELIEF_RUN]; /* 1 or 0 */
} frames;

INLINE void frames_at(const gnoi_view *restrict v, int orthographic, const gnoi_screen_plane *restrict n, const gnoi_pattern *restrict p,
                      const double *restrict x, const double *restrict y, frames *restrict q)
{
    const gnoi_view view = *v;
    const gnoi_screen_plane nearness = *n;
    const gnoi_pattern pattern = *p;
    for (int i = 0; i < GNOI_RELIEF_RUN; i++) {
        frame f;
        q->good[i] = frame_at(&view, orthographic, &nearness, &pattern, x[i], y[i], &f) ? 1.0 : 0.0;
        q->s[i] = f.s, q->t[i] = f.t;
        q->length[i] = f.length, q->width[i] = f.width;
        q->qx[0][i] = f.qx.x, q->qx[1][i] = f.qx.y, q->qx[2][i] = f.qx.z;
        q->qy[0][i] = f.qy.x, q->qy[1][i] = f.qy.y, q->qy[2][i] = f.qy.z;
    }
}

VECTOR_CLONES static void find_near_frames(const gnoi_view *restrict view, const gnoi_screen_plane *restrict nearness,
                                           const gnoi_pattern *restrict p, const double *restrict x, const double *restrict y, frames *restrict q)
{
    frames_at(view, 0, nearness, p, x, y, q);
}

VECTOR_CLONES static void find_far_frames(const gnoi_view *restrict view, const gnoi_screen_plane *restrict nearness,
                                          const gnoi_pattern *restrict p, const double *restrict x, const double *restrict y, frames *restrict q)
{
    frames_at(view, 1, nearness, p, x, y, q);
}

/* ---- heights of a picture ------------------------------------------------------------------------------------------------- */

static int wrapped(int i, int n, gno_wrap wrap)
{
    int copy;
    if (i >= 0 && i < n)
        return i;
    if (wrap == GNO_WRAP_CLAMP || wrap == GNO_WRAP_NONE)
        return i < 0 ? 0 : n - 1;
    copy = i >= 0 ? i / n : -1 - (-1 - i) / n;
    i -= copy * n;
    return wrap == GNO_WRAP_MIRROR && copy % 2 != 0 ? n - 1 - i : i;
}

/* A place along one axis brought into the first pattern, or, mirrored, pair of them. */
static double home(double v, gno_wrap wrap)
{
    if (wrap == GNO_WRAP_CLAMP || wrap == GNO_WRAP_NONE)
        return v < -1 ? -1 : v > 2 ? 2 : v;
    if (wrap == GNO_WRAP_MIRROR)
        return v - 2 * floor(0.5 * v);
    return v >= 0 && v < 1 ? v : v - floor(v);
}

/* Of what lies within int's range. */
static int floor_of(double v)
{
    int whole = (int)v;
    return whole - (v < whole);
}

/* Three rows of three heights, `stride` apart; the picture's own where it has them, or else `room`. */
INLINE const float *nine_heights(const gnoi_image_level *l, gno_wrap wrap, int column, int row, float room[9], size_t *stride)
{
    *stride = (size_t)l->width;
    if (column >= 0 && column + 2 < l->width && row >= 0 && row + 2 < l->height)
        return l->height_of + (size_t)row * *stride + (size_t)column;
    for (int j = 0; j < 3; j++) {
        const float *from = l->height_of + (size_t)wrapped(row + j, l->height, wrap) * *stride;
        for (int i = 0; i < 3; i++)
            room[3 * j + i] = from[wrapped(column + i, l->width, wrap)];
    }
    *stride = 3;
    return room;
}

INLINE float bend_of(float part, float h0, float h1, float h2) { return (1 - part) * (h1 - h0) + part * (h2 - h1); }

/* Derivatives of the bilinear heights of one level, by S and by T, each by a difference one cell wide: at a and b between the middles of the
 * first two of three columns and rows of heights. */
INLINE void slope_between(float a, float b, float h[3][3], double wide, double high, double slope[2])
{
    float ha = a >= 0.5f ? a - 0.5f : a + 0.5f, hb = b >= 0.5f ? b - 0.5f : b + 0.5f; /* the second one's weight, of the two that are interpolated */
    float by_s[2], by_t[2];
    for (int k = 0; k < 2; k++) {
        float r0 = b >= 0.5f ? h[k + 1][0] : h[k][0], r1 = b >= 0.5f ? h[k + 1][1] : h[k][1], r2 = b >= 0.5f ? h[k + 1][2] : h[k][2];
        float c0 = a >= 0.5f ? h[0][k + 1] : h[0][k], c1 = a >= 0.5f ? h[1][k + 1] : h[1][k], c2 = a >= 0.5f ? h[2][k + 1] : h[2][k];
        by_s[k] = bend_of(a, r0, r1, r2);
        by_t[k] = bend_of(b, c0, c1, c2);
    }
    slope[0] = (double)((1 - hb) * by_s[0] + hb * by_s[1]) * wide;
    slope[1] = (double)((1 - ha) * by_t[0] + ha * by_t[1]) * high;
}

static void slope_at(const gnoi_image *image, const gno_texture *how, int level, double s, double t, double slope[2])
{
    const gnoi_image_level *l = &image->level[level];
    double x = s * l->width - 1, y = t * l->height - 1;
    int column = floor_of(x), row = floor_of(y);
    float room[9], near[3][3];
    size_t stride;
    const float *h = nine_heights(l, how->wrap, column, row, room, &stride);
    for (int j = 0; j < 3; j++, h += stride)
        for (int k = 0; k < 3; k++)
            near[j][k] = h[k];
    slope_between((float)(x - column), (float)(y - row), near, l->width, l->height, slope);
}

/* The two levels whose cells are next to a pixel's size: `level` and, unless that is the last, the one above it, the latter by a share of
 * `part`; and the place in the first pattern. */
typedef struct mix {
    double s, t, part;
    int level;
} mix;

static inline mix mix_of(const gnoi_image *image, gno_wrap wrap, double s, double t, double length, double width)
{
    double least = length < MOST_DRAWN_OUT * width ? length : MOST_DRAWN_OUT * width;
    double cells = least * (image->width > image->height ? image->width : image->height);
    mix m;
    m.level = 0;
    while (cells > 2 && m.level + 1 < image->level_count) {
        cells *= 0.5;
        m.level++;
    }
    m.part = cells > 1 ? cells - 1 : 0;
    m.part = m.part < 1 ? m.part : 1;
    m.part = m.level + 1 < image->level_count ? m.part : 0;
    m.s = home(s, wrap);
    m.t = home(t, wrap);
    return m;
}

INLINE double mixed(double fine, double coarse, double part)
{
    double between = fine + part * (coarse - fine);
    return part < 1 ? between : coarse;
}

/* The slope seen by a pixel. */
static void slope_of(const gnoi_image *image, const gno_texture *how, const frame *f, double slope[2])
{
    mix m = mix_of(image, how->wrap, f->s, f->t, f->length, f->width);
    double coarse[2];
    slope_at(image, how, m.level, m.s, m.t, slope);
    if (!(m.part > 0))
        return;
    slope_at(image, how, m.level + 1, m.s, m.t, coarse);
    for (int k = 0; k < 2; k++)
        slope[k] = mixed(slope[k], coarse[k], m.part);
}

/* ---- the same side by side ------------------------------------------------------------------------------------------------- */

/* Samples between the cells of a level each: where between the middles of the first two of three columns and rows, and their heights. */
typedef struct spots {
    double wide[GNOI_RELIEF_RUN], high[GNOI_RELIEF_RUN]; /* cells of the level */
    float a[GNOI_RELIEF_RUN], b[GNOI_RELIEF_RUN];
    float height[3][3][GNOI_RELIEF_RUN];
} spots;

typedef double run_slopes[2][GNOI_RELIEF_RUN];

static inline void set_spot(spots *q, int i, const gnoi_image_level *l, gno_wrap wrap, double s, double t)
{
    double x = s * l->width - 1, y = t * l->height - 1;
    int column = floor_of(x), row = floor_of(y);
    float room[9];
    size_t stride;
    const float *h = nine_heights(l, wrap, column, row, room, &stride);
    q->wide[i] = l->width;
    q->high[i] = l->height;
    q->a[i] = (float)(x - column);
    q->b[i] = (float)(y - row);
    for (int j = 0; j < 3; j++, h += stride)
        for (int k = 0; k < 3; k++)
            q->height[j][k][i] = h[k];
}

VECTOR_CLONES static void find_slopes(const spots *restrict q, run_slopes *restrict slope)
{
    for (int i = 0; i < GNOI_RELIEF_RUN; i++) {
        float h[3][3];
        double own[2];
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                h[j][k] = q->height[j][k][i];
        slope_between(q->a[i], q->b[i], h, q->wide[i], q->high[i], own);
        (*slope)[0][i] = own[0];
        (*slope)[1][i] = own[1];
    }
}

/* The slopes seen by `count` pixels; numbers of no meaning beyond. */
static void slopes_of(const gnoi_image *image, gno_wrap wrap, const frames *f, int count, run_slopes *slope)
{
    double part[GNOI_RELIEF_RUN] = {0};
    spots fine, coarse;
    int is_mixed = 0;
    if (count < GNOI_RELIEF_RUN) {
        memset(&fine, 0, sizeof fine);
        memset(&coarse, 0, sizeof coarse);
    }
    for (int i = 0; i < count; i++) {
        mix m = mix_of(image, wrap, f->s[i], f->t[i], f->length[i], f->width[i]);
        part[i] = m.part;
        is_mixed |= m.part > 0;
        set_spot(&fine, i, &image->level[m.level], wrap, m.s, m.t);
        set_spot(&coarse, i, &image->level[m.level + (m.part > 0)], wrap, m.s, m.t);
    }
    find_slopes(&fine, slope);
    if (is_mixed) {
        run_slopes by_coarse;
        find_slopes(&coarse, &by_coarse);
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < GNOI_RELIEF_RUN; i++)
                (*slope)[k][i] = part[i] > 0 ? mixed((*slope)[k][i], by_coarse[k][i], part[i]) : (*slope)[k][i];
    }
}

INLINE vec3 raise_by(double amount, vec3 qx, vec3 qy, double by_s, double by_t, vec3 n)
{
    vec3 across = v3_cross(qx, qy);
    double size = sqrt(sqrt(v3_dot(qx, qx) * v3_dot(qy, qy))), k = amount * size / v3_dot(across, across);
    n = v3_mad(n, v3_cross(qy, across), -k * by_s);
    return v3_mad(n, v3_cross(across, qx), -k * by_t);
}

static vec3 raise(const gnoi_image *image, const gno_bump *bump, const frame *f, vec3 n)
{
    double slope[2];
    slope_of(image, &bump->texture, f, slope);
    return raise_by(bump->amount, f->qx, f->qy, slope[0], slope[1], n);
}

VECTOR_CLONES static void raise_all(double amount, const frames *restrict f, const double (*restrict slope)[GNOI_RELIEF_RUN],
                                    double (*restrict n)[GNOI_RELIEF_RUN])
{
    for (int i = 0; i < GNOI_RELIEF_RUN; i++) {
        vec3 qx = v3(f->qx[0][i], f->qx[1][i], f->qx[2][i]), qy = v3(f->qy[0][i], f->qy[1][i], f->qy[2][i]);
        vec3 m = raise_by(amount, qx, qy, slope[0][i], slope[1][i], v3(n[0][i], n[1][i], n[2][i]));
        n[0][i] = m.x;
        n[1][i] = m.y;
        n[2][i] = m.z;
    }
}

int gnoi_relief_run(const gnoi_sight *sight, const gno_bump *bump, const gnoi_pattern *pattern, int count, const double *x, const double *y,
                    double (*n)[GNOI_RELIEF_RUN])
{
    const gnoi_image *image = &sight->scene->images[bump->texture.image];
    frames q;
    run_slopes slope;
    int good = 1;
    if (sight->view->orthographic)
        find_far_frames(sight->view, sight->nearness, pattern, x, y, &q);
    else
        find_near_frames(sight->view, sight->nearness, pattern, x, y, &q);
    for (int i = 0; i < count; i++)
        good &= q.good[i] > 0;
    if (good) {
        slopes_of(image, bump->texture.wrap, &q, count, &slope);
        raise_all(bump->amount, &q, (const double(*)[GNOI_RELIEF_RUN])slope, n);
    }
    return good;
}

/* ---- normals of a picture --------------------------------------------------------------------------------------------------- */

static vec3 aside(vec3 q, vec3 n)
{
    return v3_unit(v3_mad(q, n, -v3_dot(q, n)));
}

static vec3 lean(const gnoi_sight *sight, const gno_bump *bump, const gnoi_pattern *pattern, const frame *f, double x, double y, double xs,
                 double ys, vec3 n)
{
    gno_texture how = bump->texture;
    float v[4];
    vec3 m;
    how.filter = GNO_FILTER_LINEAR;
    gnoi_filter_pixel(&sight->scene->images[how.image], &how, pattern, x, y, xs, ys, v);
    m = v3_scale(n, 2 * (double)v[2] - 1);
    m = v3_mad(m, aside(f->qx, n), bump->amount * (2 * (double)v[0] - 1));
    return v3_mad(m, aside(f->qy, n), bump->amount * (2 * (double)v[1] - 1));
}

/* ---- procedural heights ------------------------------------------------------------------------------------------------------- */

/* In mesh space, whose normals are scene normals times the transposed way back. */
static vec3 raise_pattern(const gnoi_sight *sight, const gno_bump *bump, double x, double y, vec3 n)
{
    const double *m = sight->scene->objects[sight->scene->polygon_object[sight->poly->source]].to_local;
    gno_footprint footprint = gnoi_sight_footprint(sight, x, y);
    vec3 rows[3], local;
    double normal[3], bumped[3], sign;
    for (int i = 0; i < 3; i++)
        rows[i] = v3(m[4 * i], m[4 * i + 1], m[4 * i + 2]);
    sign = v3_dot(rows[0], v3_cross(rows[1], rows[2])) < 0 ? -1 : 1;
    local = v3_unit(v3(sign * v3_dot(v3_cross(rows[1], rows[2]), n), sign * v3_dot(v3_cross(rows[2], rows[0]), n),
                       sign * v3_dot(v3_cross(rows[0], rows[1]), n)));
    normal[0] = local.x, normal[1] = local.y, normal[2] = local.z;
    gno_bump_procedural(&bump->texture.procedural, bump->amount, &footprint, normal, bumped);
    return v3_add(v3_scale(rows[0], bumped[0]), v3_add(v3_scale(rows[1], bumped[1]), v3_scale(rows[2], bumped[2])));
}

vec3 gnoi_relief_normal(const gnoi_sight *sight, const gno_bump *bump, gnoi_mapping *mapping, double x, double y, double xs, double ys, vec3 n)
{
    const gnoi_pattern *pattern;
    vec3 bumped;
    frame f;
    if (bump->texture.kind == GNO_TEXTURE_PROCEDURAL) {
        bumped = raise_pattern(sight, bump, xs, ys, n);
        return v3_dot(bumped, bumped) > 0 ? bumped : n;
    }
    if (bump->texture.kind != GNO_TEXTURE_IMAGE)
        return n;
    pattern = gnoi_mapping_seek(mapping, sight, &bump->texture, xs, ys);
    if (!find_frame(sight, pattern, xs, ys, &f))
        return n;
    if (bump->kind == GNO_BUMP_NORMAL)
        return lean(sight, bump, pattern, &f, x, y, xs, ys, n);
    return raise(&sight->scene->images[bump->texture.image], bump, &f, n);
}
