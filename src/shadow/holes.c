/* holes.c -- see holes.h. */
#include "shadow/holes.h"
#include "project/filter.h"
#include <math.h>

static gnoi_screen_plane plane(double fx, double fy, double f0)
{
    gnoi_screen_plane p = {fx, fy, f0};
    return p;
}

static gnoi_screen_plane mix(double a, gnoi_screen_plane p, double b, gnoi_screen_plane q)
{
    return plane(a * p.fx + b * q.fx, a * p.fy + b * q.fy, a * p.f0 + b * q.f0);
}

static double part(vec3 v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

/* The point of the caster's plane on the ray from the receiver to the lamp, homogeneous and linear over the picture: with P the
 * receiver's point, h(P) and H the heights of it and of the lamp L over that plane, Q = (P H - L h(P)) / (H - h(P)); a lamp at
 * infinity has the direction for L, the cosine for H, and the divisor H alone. */
typedef struct meeting {
    gnoi_screen_plane x, y, z, w;
} meeting;

static meeting meet(const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *r, const gnoi_poly *caster)
{
    double u0 = -0.5 * view->width * view->unit, v0 = -0.5 * view->height * view->unit, height;
    vec3 l = lamp->directional ? lamp->to_light : lamp->position, n = v3_from(caster->n);
    gnoi_screen_plane p[3], one = view->orthographic ? plane(0, 0, 1) : r->nearness, h = mix(caster->d, one, 0, one);
    meeting m;
    gnoi_screen_plane *q[3] = {&m.x, &m.y, &m.z};
    for (int k = 0; k < 3; k++) {
        double right = part(view->right, k), up = part(view->up, k), forward = part(view->forward, k), eye = part(view->eye, k);
        gnoi_screen_plane across = plane(right * view->unit, -up * view->unit, right * u0 - up * v0);
        p[k] = view->orthographic ? mix(1, mix(1, across, eye, one), -forward, r->nearness)
                                  : mix(1, mix(1, across, forward, plane(0, 0, 1)), eye, one);
        h = mix(1, h, caster->n[k], p[k]);
    }
    height = v3_dot(n, l) + (lamp->directional ? 0 : caster->d);
    for (int k = 0; k < 3; k++)
        *q[k] = mix(height, p[k], -part(l, k), h);
    m.w = lamp->directional ? mix(height, one, 0, one) : mix(height, one, -1, h);
    return m;
}

/* ---- the caster's pattern ------------------------------------------------------------------------------------------------- */

/* How deep inside a triangle q lies, relative to its size, and the triangle's texture coordinates as affine functions of the
 * point, a.P + b. */
static double lay(const gno_scene *scene, const gnoi_poly *poly, const uint32_t corner[3], vec3 q, vec3 a[2], double b[2])
{
    vec3 p[3], n = v3_from(poly->n), grad[3];
    double area, least = HUGE_VAL;
    for (int i = 0; i < 3; i++)
        p[i] = gnoi_corner_at(scene, corner[i]);
    area = v3_dot(n, v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0])));
    if (!(fabs(area) > 0))
        return -HUGE_VAL;
    a[0] = a[1] = v3(0, 0, 0);
    b[0] = b[1] = 0;
    for (int i = 0; i < 3; i++) {
        vec3 from = p[(i + 1) % 3];
        const double *uv = scene->texcoords[scene->prepared.corner_texcoord[corner[i]]];
        double share;
        grad[i] = v3_scale(v3_cross(n, v3_sub(p[(i + 2) % 3], from)), 1 / area);
        share = v3_dot(grad[i], v3_sub(q, from));
        least = share < least ? share : least;
        for (int k = 0; k < 2; k++) {
            a[k] = v3_mad(a[k], grad[i], uv[k]);
            b[k] -= uv[k] * v3_dot(grad[i], from);
        }
    }
    return least;
}

static int has_coordinates(const gno_scene *scene, const gnoi_poly *poly)
{
    const uint32_t *texcoord = scene->prepared.corner_texcoord;
    for (uint32_t i = 0; texcoord && i < poly->corner_count; i++)
        if (texcoord[poly->corner + i] == GNOI_NONE)
            return 0;
    return texcoord != NULL;
}

/* The pattern's functions of the point around q: those of the triangle that holds it, or the nearest to it. */
static void lay_on_corners(const gno_scene *scene, const gnoi_poly *poly, vec3 q, vec3 a[2], double b[2])
{
    uint32_t plain[3] = {poly->corner, poly->corner + 1, poly->corner + 2};
    uint32_t count = poly->triangle == GNOI_NONE ? 1 : poly->corner_count + 2u * (poly->ring_count - 1u) - 2u;
    double best = -HUGE_VAL;
    a[0] = a[1] = v3(0, 0, 0);
    b[0] = b[1] = 0;
    for (uint32_t t = 0; t < count && best < 0; t++) {
        const uint32_t *corner = poly->triangle == GNOI_NONE ? plain : scene->prepared.triangles[poly->triangle + t];
        vec3 ta[2];
        double tb[2] = {0, 0}, depth = lay(scene, poly, corner, q, ta, tb);
        if (depth <= best)
            continue;
        best = depth;
        for (int k = 0; k < 2; k++) {
            a[k] = ta[k];
            b[k] = tb[k];
        }
    }
}

static gnoi_screen_plane form_of(const meeting *m, vec3 a, double b)
{
    return mix(1, mix(a.x, m->x, a.y, m->y), 1, mix(a.z, m->z, b, m->w));
}

static vec3 point_at(const meeting *m, double x, double y)
{
    double w = gnoi_plane_at(&m->w, x, y);
    return v3(gnoi_plane_at(&m->x, x, y) / w, gnoi_plane_at(&m->y, x, y) / w, gnoi_plane_at(&m->z, x, y) / w);
}

/* The pattern over the picture around (x,y), as if the caster were painted on the receiver. */
static gnoi_pattern pattern_through(const gno_scene *scene, const gnoi_poly *poly, const gno_texture *texture, const meeting *m, double x,
                                    double y)
{
    const double *to_local = scene->objects[scene->polygon_object[poly->source]].to_local;
    int on_corners = texture->map == GNO_MAP_UV && has_coordinates(scene, poly);
    gnoi_place place = texture->map == GNO_MAP_UV && !on_corners ? gnoi_place_plain(texture, to_local, poly->n)
                                                                 : gnoi_place_make(texture, to_local);
    gnoi_pattern p;
    p.w = m->w;
    if (!on_corners && place.map != GNO_MAP_PLANAR) {
        vec3 corner[4];
        for (int i = 0; i < 4; i++)
            corner[i] = point_at(m, x + (i == 1 || i == 2 ? 0.5 : -0.5), y + (i >= 2 ? 0.5 : -0.5));
        return gnoi_pattern_corners(&place, point_at(m, x, y), corner, 0.5, x, y);
    }
    if (on_corners)
        lay_on_corners(scene, poly, point_at(m, x, y), place.axis, place.offset);
    p.s = mix(place.gain[0], form_of(m, place.axis[0], place.offset[0]), place.shift[0], m->w);
    p.t = mix(place.gain[1], form_of(m, place.axis[1], place.offset[1]), place.shift[1], m->w);
    return p;
}

static gnoi_screen_plane turned(gnoi_screen_plane p)
{
    return plane(-p.fx, -p.fy, -p.f0);
}

void gnoi_holes_through(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *receiver, uint32_t caster,
                        double x, double y, double through[3])
{
    const gnoi_poly *poly = &scene->prepared.polys[caster];
    const gno_material *material = &scene->materials[poly->material];
    meeting m = meet(view, lamp, receiver, poly);
    double px = floor(x) + 0.5, py = floor(y) + 0.5;
    gnoi_pattern p;
    float mean[4];
    if (gnoi_plane_at(&m.w, x, y) < 0) {
        m.x = turned(m.x);
        m.y = turned(m.y);
        m.z = turned(m.z);
        m.w = turned(m.w);
    }
    p = pattern_through(scene, poly, &material->texture, &m, x, y);
    gnoi_filter_pixel(&scene->images[material->texture.image], &material->texture, &p, px, py, x, y, mean);
    for (int k = 0; k < 3; k++)
        through[k] = 1 - (double)mean[3] * (1 - material->transmission[k]);
}
