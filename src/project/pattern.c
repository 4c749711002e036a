/* pattern.c -- see pattern.h. */
#include "project/pattern.h"
#include <math.h>

#define PI 3.14159265358979323846

/* A linear form of mesh space as one of scene space: a.(M p) + b. */
static void to_scene(const double m[12], vec3 a, double b, vec3 *axis, double *offset)
{
    *axis = v3(a.x * m[0] + a.y * m[4] + a.z * m[8], a.x * m[1] + a.y * m[5] + a.z * m[9], a.x * m[2] + a.y * m[6] + a.z * m[10]);
    *offset = a.x * m[3] + a.y * m[7] + a.z * m[11] + b;
}

/* pattern = ((S,T) - corners[0]) / (corners[1] - corners[0]) / scale. */
static void set_gain(gnoi_place *place, const gno_texture *texture)
{
    double c[2][2] = {{0, 0}, {1, 1}};
    int given = 0;
    if (place->map == GNO_MAP_CYLINDRICAL || place->map == GNO_MAP_SPHERICAL)
        c[1][0] = 360;
    if (place->map == GNO_MAP_SPHERICAL) {
        c[0][1] = 180;
        c[1][1] = 0;
    }
    for (int i = 0; i < 4; i++)
        given |= texture->corners[i / 2][i % 2] != 0;
    for (int k = 0; k < 2; k++) {
        double from = given ? texture->corners[0][k] : c[0][k], to = given ? texture->corners[1][k] : c[1][k];
        place->gain[k] = 1 / ((to - from) * texture->scale[k]);
        place->shift[k] = -from * place->gain[k];
    }
}

gnoi_place gnoi_place_make(const gno_texture *texture, const double to_local[12])
{
    gnoi_place place;
    vec3 u = v3_from(texture->u), v = v3_from(texture->v), o = v3_from(texture->origin), f[3];
    place.map = texture->map;
    set_gain(&place, texture);
    if (texture->map == GNO_MAP_PLANAR || texture->map == GNO_MAP_UV) {
        vec3 n = v3_cross(u, v);
        double k = 1 / v3_dot(n, n);
        f[0] = v3_scale(v3_cross(v, n), k); /* f0.u = 1, f0.v = 0 */
        f[1] = v3_scale(v3_cross(n, u), k);
        f[2] = v3_scale(n, k);
    } else {
        double height = v3_length(v);
        vec3 axis = v3_scale(v, 1 / height), across = v3_unit(v3_mad(u, axis, -v3_dot(u, axis)));
        f[0] = across;
        f[1] = v3_cross(axis, across);
        f[2] = texture->map == GNO_MAP_CYLINDRICAL ? v3_scale(axis, 1 / height) : axis;
    }
    for (int i = 0; i < 3; i++)
        to_scene(to_local, f[i], -v3_dot(f[i], o), &place.axis[i], &place.offset[i]);
    return place;
}

gnoi_place gnoi_place_plain(const gno_texture *texture, const double to_local[12], const double n[3])
{
    gno_texture plain = *texture;
    /* The normal in mesh space, but for a factor: the rows of cofactors are the way back to scene space, transposed. */
    vec3 rows[3];
    double along[3];
    int axis = 2;
    for (int i = 0; i < 3; i++)
        rows[i] = v3(to_local[4 * i], to_local[4 * i + 1], to_local[4 * i + 2]);
    for (int i = 0; i < 3; i++)
        along[i] = fabs(v3_dot(v3_cross(rows[(i + 1) % 3], rows[(i + 2) % 3]), v3_from(n)));
    for (int i = 0; i < 2; i++)
        if (along[i] > along[axis] * (1 + 1e-9))
            axis = i;
    plain.map = GNO_MAP_PLANAR;
    for (int i = 0; i < 3; i++) {
        plain.origin[i] = 0;
        plain.u[i] = i == (axis == 0 ? 1 : 0);
        plain.v[i] = i == (axis == 2 ? 1 : 2);
    }
    return gnoi_place_make(&plain, to_local);
}

static gnoi_screen_plane combine(double a, gnoi_screen_plane p, double b, gnoi_screen_plane q)
{
    gnoi_screen_plane r;
    r.fx = a * p.fx + b * q.fx;
    r.fy = a * p.fy + b * q.fy;
    r.f0 = a * p.f0 + b * q.f0;
    return r;
}

/* The form axis.P + offset, times the plane's nearness (perspective) or as it is (orthographic), over the picture. */
static gnoi_screen_plane form_on_plane(const gnoi_view *view, const gnoi_screen_plane *nearness, vec3 axis, double offset)
{
    gnoi_screen_plane across, one = {0, 0, 1};
    double ahead = v3_dot(axis, view->forward), at_eye = v3_dot(axis, view->eye) + offset;
    across.fx = v3_dot(axis, view->right) * view->unit;
    across.fy = -v3_dot(axis, view->up) * view->unit;
    across.f0 = -0.5 * view->width * across.fx - 0.5 * view->height * across.fy;
    if (view->orthographic)
        return combine(1, combine(1, across, at_eye, one), -ahead, *nearness);
    return combine(1, combine(1, across, ahead, one), at_eye, *nearness);
}

gnoi_pattern gnoi_pattern_planar(const gnoi_place *place, const gnoi_view *view, const gnoi_screen_plane *nearness)
{
    gnoi_pattern p;
    gnoi_screen_plane one = {0, 0, 1};
    p.w = view->orthographic ? one : *nearness;
    p.s = combine(place->gain[0], form_on_plane(view, nearness, place->axis[0], place->offset[0]), place->shift[0], p.w);
    p.t = combine(place->gain[1], form_on_plane(view, nearness, place->axis[1], place->offset[1]), place->shift[1], p.w);
    return p;
}

gnoi_pattern gnoi_pattern_uv(const gnoi_place *place, const gnoi_screen_plane weight[3], const double *const coordinate[3])
{
    gnoi_pattern p;
    p.w = combine(1, weight[0], 1, combine(1, weight[1], 1, weight[2]));
    p.s = combine(coordinate[0][0], weight[0], 1, combine(coordinate[1][0], weight[1], coordinate[2][0], weight[2]));
    p.t = combine(coordinate[0][1], weight[0], 1, combine(coordinate[1][1], weight[1], coordinate[2][1], weight[2]));
    p.s = combine(place->gain[0], p.s, place->shift[0], p.w);
    p.t = combine(place->gain[1], p.t, place->shift[1], p.w);
    return p;
}

/* S and T of a point, S within half a turn of `near`. */
static void round_coordinates(const gnoi_place *place, vec3 p, double near, double st[2])
{
    double x = v3_dot(place->axis[0], p) + place->offset[0], y = v3_dot(place->axis[1], p) + place->offset[1];
    double z = v3_dot(place->axis[2], p) + place->offset[2];
    double turn = x != 0 || y != 0 ? atan2(y, x) * (180 / PI) : near;
    st[0] = turn + 360 * floor((near - turn) / 360 + 0.5);
    st[1] = place->map == GNO_MAP_CYLINDRICAL ? z : atan2(sqrt(x * x + y * y), z) * (180 / PI);
}

gnoi_pattern gnoi_pattern_corners(const gnoi_place *place, vec3 middle, const vec3 corner[4], double reach, double x, double y)
{
    double st[4][2], at_middle[2];
    gnoi_pattern p = {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}};
    round_coordinates(place, middle, 180, at_middle);
    for (int i = 0; i < 4; i++)
        round_coordinates(place, corner[i], at_middle[0], st[i]);
    for (int k = 0; k < 2; k++) {
        gnoi_screen_plane *f = k == 0 ? &p.s : &p.t;
        double gain = place->gain[k], mean = 0.25 * (st[0][k] + st[1][k] + st[2][k] + st[3][k]);
        f->fx = gain * (st[1][k] + st[2][k] - st[0][k] - st[3][k]) / (4 * reach);
        f->fy = gain * (st[2][k] + st[3][k] - st[0][k] - st[1][k]) / (4 * reach);
        f->f0 = gain * mean + place->shift[k] - f->fx * x - f->fy * y;
    }
    return p;
}

gnoi_pattern gnoi_pattern_round(const gnoi_place *place, const gnoi_view *view, const gnoi_screen_plane *nearness, double x, double y)
{
    /* Corners that the plane does not reach before the eye are drawn towards the middle. */
    double z = gnoi_plane_at(nearness, x, y), reach = 0.5, slope = fabs(nearness->fx) + fabs(nearness->fy);
    vec3 corner[4];
    if (!view->orthographic && slope * reach > 0.9 * z)
        reach = 0.9 * z / slope;
    for (int i = 0; i < 4; i++) {
        double cx = x + (i == 1 || i == 2 ? reach : -reach), cy = y + (i >= 2 ? reach : -reach);
        corner[i] = gnoi_view_point(view, cx, cy, gnoi_plane_at(nearness, cx, cy));
    }
    return gnoi_pattern_corners(place, gnoi_view_point(view, x, y, z), corner, reach, x, y);
}
