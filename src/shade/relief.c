/* relief.c -- see relief.h.
 *
 * Heights of a picture are bilinear between the middles of its cells, and their derivatives are differences one cell apart; the cells
 * are those of the two levels between which a pixel's size lies, so that far bumps flatten out to their mean. Steps of both
 * along S and T are steps of the point, Q_x and Q_y, found from how point and pattern change over the picture.
 */
#include "shade/relief.h"
#include "project/filter.h"
#include <math.h>

#define MOST_DRAWN_OUT 4.0 /* a pixel is taken as long as this many times its width at the most, or its bumps would fade too soon */

/* Steps of the scene point for one pattern along S and along T. */
typedef struct frame {
    double s, t;           /* place on the pattern */
    vec3 qx, qy;
    double length, width;  /* of the pixel, in patterns */
} frame;

/* 0 where the pattern does not change over the picture. */
static int find_frame(const gnoi_sight *sight, const gnoi_pattern *p, double x, double y, frame *f)
{
    const gnoi_view *view = sight->view;
    double w = gnoi_plane_at(&p->w, x, y), z = gnoi_plane_at(sight->nearness, x, y), sx, sy, tx, ty, det, a, b;
    vec3 dx = v3_scale(view->right, view->unit), dy = v3_scale(view->up, -view->unit), point = gnoi_view_point(view, x, y, z);
    f->s = gnoi_plane_at(&p->s, x, y) / w;
    f->t = gnoi_plane_at(&p->t, x, y) / w;
    sx = (p->s.fx - f->s * p->w.fx) / w, sy = (p->s.fy - f->s * p->w.fy) / w;
    tx = (p->t.fx - f->t * p->w.fx) / w, ty = (p->t.fy - f->t * p->w.fy) / w;
    if (view->orthographic) {
        dx = v3_mad(dx, view->forward, -sight->nearness->fx);
        dy = v3_mad(dy, view->forward, -sight->nearness->fy);
    } else {
        vec3 ray = v3_sub(point, view->eye);
        dx = v3_scale(v3_mad(dx, ray, -sight->nearness->fx), 1 / z);
        dy = v3_scale(v3_mad(dy, ray, -sight->nearness->fy), 1 / z);
    }
    det = sx * ty - sy * tx;
    a = sqrt(sx * sx + tx * tx);
    b = sqrt(sy * sy + ty * ty);
    f->length = a > b ? a : b;
    if (!(w > 0) || !(z > 0 || view->orthographic) || !(fabs(det) > 1e-12 * f->length * f->length))
        return 0;
    f->width = fabs(det) / f->length;
    f->qx = v3_scale(v3_sub(v3_scale(dx, ty), v3_scale(dy, tx)), 1 / det);
    f->qy = v3_scale(v3_sub(v3_scale(dy, sx), v3_scale(dx, sy)), 1 / det);
    return 1;
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

/* A place along one axis brought into the first two patterns. */
static double home(double v, gno_wrap wrap)
{
    if (wrap == GNO_WRAP_CLAMP || wrap == GNO_WRAP_NONE)
        return v < -1 ? -1 : v > 2 ? 2 : v;
    return v - 2 * floor(0.5 * v);
}

/* Derivatives of the bilinear heights of one level, by S and by T, each by a difference one cell wide. */
static void slope_at(const gnoi_image *image, const gno_texture *how, int level, double s, double t, double slope[2])
{
    const gnoi_image_level *l = &image->level[level];
    double x = s * l->width - 1, y = t * l->height - 1, fx = floor(x), fy = floor(y), a = x - fx, b = y - fy;
    double ha = a < 0.5 ? a + 0.5 : a - 0.5, hb = b < 0.5 ? b + 0.5 : b - 0.5; /* of the middle row and column of interpolation */
    int ia = a < 0.5 ? 0 : 1, ib = b < 0.5 ? 0 : 1;
    int i0 = (int)fx, j0 = (int)fy, inside = i0 >= 0 && i0 + 2 < l->width && j0 >= 0 && j0 + 2 < l->height, column[3], row_of[3];
    float v[3][3];
    for (int i = 0; i < 3; i++) {
        column[i] = inside ? i0 + i : wrapped(i0 + i, l->width, how->wrap);
        row_of[i] = inside ? j0 + i : wrapped(j0 + i, l->height, how->wrap);
    }
    for (int j = 0; j < 3; j++) {
        const float *row = l->height_of + (size_t)row_of[j] * (size_t)l->width;
        for (int i = 0; i < 3; i++)
            v[j][i] = row[column[i]];
    }
    slope[0] = slope[1] = 0;
    for (int k = 0; k < 2; k++) {
        double along_t = k ? hb : 1 - hb, along_s = k ? ha : 1 - ha;
        const float *row = v[ib + k];
        slope[0] += along_t * ((1 - a) * (double)(row[1] - row[0]) + a * (double)(row[2] - row[1])) * l->width;
        slope[1] += along_s * ((1 - b) * (double)(v[1][ia + k] - v[0][ia + k]) + b * (double)(v[2][ia + k] - v[1][ia + k])) * l->height;
    }
}

/* The slope seen by a pixel of the given size, between the two levels whose cells are next to it. */
static void slope_of(const gnoi_image *image, const gno_texture *how, const frame *f, double slope[2])
{
    double length = f->length < MOST_DRAWN_OUT * f->width ? f->length : MOST_DRAWN_OUT * f->width;
    double cells = length * (image->width > image->height ? image->width : image->height), s = home(f->s, how->wrap), t = home(f->t, how->wrap);
    double part, coarse[2] = {0, 0};
    int level = 0;
    while (cells > 2 && level + 1 < image->level_count) {
        cells *= 0.5;
        level++;
    }
    part = cells > 1 ? cells - 1 : 0;
    part = part < 1 ? part : 1;
    if (part < 1 || level + 1 == image->level_count)
        slope_at(image, how, level, s, t, slope);
    if (part > 0 && level + 1 < image->level_count)
        slope_at(image, how, level + 1, s, t, coarse);
    for (int k = 0; k < 2 && part > 0; k++)
        slope[k] = part < 1 ? slope[k] + part * (coarse[k] - slope[k]) : coarse[k];
}

static vec3 raise(const gnoi_image *image, const gno_bump *bump, const frame *f, vec3 n)
{
    double slope[2], size, k;
    vec3 across = v3_cross(f->qx, f->qy);
    slope_of(image, &bump->texture, f, slope);
    size = sqrt(v3_length(f->qx) * v3_length(f->qy));
    k = bump->amount * size / v3_dot(across, across);
    n = v3_mad(n, v3_cross(f->qy, across), -k * slope[0]);
    return v3_mad(n, v3_cross(across, f->qx), -k * slope[1]);
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
