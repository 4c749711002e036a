/* oracle.c -- see oracle.h. Written to be obviously right: no tree, no spans, no clipping, no shared code.
 *
 * Conventions: a "face" is a scene polygon with area; its plane is n.x + d = 0 with n after the winding of its outer
 * ring; its corners are kept twice, in space and in the two coordinates of the plane's largest projection.
 */
#include "support/oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

/* Two planes nearer than this share of the scene's size are one plane: the contract's coplanarity. */
#define COPLANAR 1e-6
/* Area over squared perimeter below which a polygon counts as having none. */
#define NO_AREA 1e-12
/* How far towards a lamp a caster may stand, as a share of the way: a polygon that holds the lamp blocks nothing. */
#define BEFORE_LAMP (1 - 1e-9)
/* Cosine below which a lamp stands in a face's own plane, where N.L is 0 and not the rounding around it. */
#define GRAZING 1e-12

typedef struct face {
    size_t polygon;
    gno_polygon p;
    gno_material m;
    double n[3], d;
    int u, v;                /* the coordinates kept in the projection */
    double low[2], high[2];  /* of the projected outer ring */
    double (*flat)[2];       /* every corner, projected */
    double centroid[3];
    double (*normals)[3];    /* unit, per corner of the outer ring; NULL where not smooth */
} face;

/* A point or directional light; area lights are many of them. */
typedef struct lamp {
    gno_light l;
    double position[3], direction[3], intensity[3];
    double cone; /* cosine of half the angle, -2 where there is no cone */
} lamp;

struct oracle {
    face *faces;
    size_t face_count;
    lamp *lamps;
    size_t lamp_count;
    gno_camera camera;
    gno_image_def image;
    double f[3], r[3], q[3];
    double ambient[3];
    double tolerance;      /* length below which planes are one */
    double nearest_depth;  /* least depth of a corner along f: where an orthographic viewer's distances start */
};

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

static double unit(double a[3])
{
    double l = sqrt(dot(a, a));
    for (int k = 0; k < 3 && l > 0; k++) a[k] /= l;
    return l;
}

static const double *corner(const face *a, unsigned i) { return a->p.positions + 3 * (size_t)a->p.corner_vertex[i]; }

/* ---- preparing ------------------------------------------------------------------------------------------------ */

/* Newell's normal of the outer ring, twice the area long. */
static void newell(const face *a, double n[3])
{
    const double *o = corner(a, a->p.ring_start[0]);
    n[0] = n[1] = n[2] = 0;
    for (unsigned i = a->p.ring_start[0]; i + 1 < a->p.ring_start[1]; i++) {
        double e[3], g[3], c[3];
        subtract(corner(a, i), o, e);
        subtract(corner(a, i + 1), o, g);
        cross(e, g, c);
        for (int k = 0; k < 3; k++) n[k] += c[k];
    }
}

/* Centroid of the area inside the outer ring, by signed triangles from its first corner. */
static void find_centroid(face *a)
{
    const double *o = corner(a, a->p.ring_start[0]);
    double area = 0, sum[3] = {0, 0, 0};
    for (unsigned i = a->p.ring_start[0]; i + 1 < a->p.ring_start[1]; i++) {
        double e[3], g[3], c[3];
        subtract(corner(a, i), o, e);
        subtract(corner(a, i + 1), o, g);
        cross(e, g, c);
        double s = dot(c, a->n);
        area += s;
        for (int k = 0; k < 3; k++) sum[k] += s * (e[k] + g[k]) / 3;
    }
    for (int k = 0; k < 3; k++) a->centroid[k] = o[k] + sum[k] / area;
}

/* Returns 0 when memory fails, -1 for a polygon without area. */
static int prepare_face(face *a)
{
    double perimeter = 0;
    unsigned first = a->p.ring_start[0], last = a->p.ring_start[1], end = a->p.ring_start[a->p.ring_count];
    for (unsigned i = first; i < last; i++) {
        double e[3];
        subtract(corner(a, i), corner(a, i + 1 < last ? i + 1 : first), e);
        perimeter += sqrt(dot(e, e));
    }
    newell(a, a->n);
    if (last - first < 3 || unit(a->n) < 2 * NO_AREA * perimeter * perimeter || perimeter <= 0) return -1;
    a->d = -dot(a->n, corner(a, first));
    int drop = fabs(a->n[0]) > fabs(a->n[1]) ? 0 : 1;
    if (fabs(a->n[2]) > fabs(a->n[drop])) drop = 2;
    a->u = (drop + 1) % 3;
    a->v = (drop + 2) % 3;
    a->flat = malloc((end - first) * sizeof *a->flat);
    if (!a->flat) return 0;
    a->low[0] = a->low[1] = INFINITY;
    a->high[0] = a->high[1] = -INFINITY;
    for (unsigned i = first; i < end; i++) {
        double *t = a->flat[i - first];
        t[0] = corner(a, i)[a->u];
        t[1] = corner(a, i)[a->v];
        for (int k = 0; k < 2; k++) {
            a->low[k] = fmin(a->low[k], t[k]);
            a->high[k] = fmax(a->high[k], t[k]);
        }
    }
    find_centroid(a);
    return 1;
}

/* Vertex normals of a smooth face: the given ones, else the sum of the plane normals, area long, around the vertex. */
static int smooth_normals(oracle *o, face *a)
{
    unsigned first = a->p.ring_start[0], last = a->p.ring_start[1];
    if (a->p.shading != GNO_SHADING_GOURAUD && a->p.shading != GNO_SHADING_PHONG) return 1;
    a->normals = calloc(last - first, sizeof *a->normals);
    if (!a->normals) return 0;
    for (unsigned i = first; i < last; i++) {
        double *n = a->normals[i - first];
        int given = a->p.corner_normal ? a->p.corner_normal[i] : -1;
        if (given >= 0) memcpy(n, a->p.normals + 3 * (size_t)given, sizeof *a->normals);
        for (size_t j = 0; j < o->face_count && given < 0; j++) {
            const face *b = &o->faces[j];
            double s[3];
            int meets = 0;
            for (unsigned k = b->p.ring_start[0]; k < b->p.ring_start[1]; k++)
                if (b->p.corner_vertex[k] == a->p.corner_vertex[i]) meets = 1;
            if (!meets || b->p.object != a->p.object) continue;
            newell(b, s);
            for (int k = 0; k < 3; k++) n[k] += s[k];
        }
        unit(n);
    }
    return 1;
}

static int add_lamps(oracle *o, const gno_light *l)
{
    int each = l->type == GNO_LIGHT_AREA ? l->samples : 1;
    lamp *grown = realloc(o->lamps, (o->lamp_count + (size_t)each * (size_t)each) * sizeof *grown);
    if (!grown) return 0;
    o->lamps = grown;
    for (int i = 0; i < each; i++)
        for (int j = 0; j < each; j++) {
            lamp *t = &o->lamps[o->lamp_count++];
            double u = (i + 0.5) / each, v = (j + 0.5) / each;
            t->l = *l;
            for (int k = 0; k < 3; k++) {
                t->position[k] = l->position[k] + (l->type == GNO_LIGHT_AREA ? u * l->edge1[k] + v * l->edge2[k] : 0);
                t->direction[k] = l->direction[k];
                t->intensity[k] = l->intensity[k] / (each * each);
            }
            unit(t->direction);
            t->cone = l->type == GNO_LIGHT_SPOT ? cos(l->angle * PI / 360) : -2;
        }
    return 1;
}

static void measure(oracle *o)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, scale = 0;
    o->nearest_depth = INFINITY;
    for (size_t i = 0; i < o->face_count; i++) {
        const face *a = &o->faces[i];
        for (unsigned c = a->p.ring_start[0]; c < a->p.ring_start[a->p.ring_count]; c++) {
            double to[3];
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], corner(a, c)[k]);
                high[k] = fmax(high[k], corner(a, c)[k]);
            }
            subtract(corner(a, c), o->camera.eye, to);
            o->nearest_depth = fmin(o->nearest_depth, dot(to, o->f));
        }
    }
    for (int k = 0; k < 3 && o->face_count; k++) scale = fmax(scale, fmax(fmax(fabs(low[k]), fabs(high[k])), high[k] - low[k]));
    o->tolerance = COPLANAR * scale;
}

/* A detail is at least one above what it lies on, which may be a detail itself. */
static int raise_detail(gno_scene *scene, face *a, size_t most)
{
    int least = 0, own = a->p.priority;
    gno_polygon p = a->p;
    for (size_t i = 0; i < most && p.detail_of >= 0; i++) {
        if (gno_scene_polygon(scene, (size_t)p.detail_of, &p) != GNO_OK) return 0;
        least++;
        if (p.priority + least > own) own = p.priority + least;
    }
    a->p.priority = own;
    return 1;
}

oracle *oracle_create(gno_scene *scene)
{
    gno_scene_counts counts = gno_scene_count(scene);
    oracle *o = calloc(1, sizeof *o);
    if (!o) return NULL;
    o->faces = calloc(counts.polygons + 1, sizeof *o->faces);
    if (!o->faces) goto fail;
    o->camera = gno_scene_camera(scene);
    o->image = gno_scene_image(scene);
    gno_scene_ambient(scene, o->ambient);
    subtract(o->camera.target, o->camera.eye, o->f);
    unit(o->f);
    cross(o->f, o->camera.up, o->r);
    unit(o->r);
    cross(o->r, o->f, o->q);
    for (size_t i = 0; i < counts.polygons; i++) {
        face *a = &o->faces[o->face_count];
        memset(a, 0, sizeof *a);
        a->polygon = i;
        if (gno_scene_polygon(scene, i, &a->p) != GNO_OK || gno_scene_material(scene, a->p.material, &a->m) != GNO_OK) goto fail;
        int made = prepare_face(a);
        if (made == 0) goto fail;
        if (made > 0) o->face_count++;
    }
    for (size_t i = 0; i < o->face_count; i++)
        if (!raise_detail(scene, &o->faces[i], counts.polygons)) goto fail;
    for (size_t i = 0; i < o->face_count; i++)
        if (!smooth_normals(o, &o->faces[i])) goto fail;
    for (size_t i = 0; i < counts.lights; i++) {
        gno_light l;
        if (gno_scene_light(scene, (int)i, &l, NULL) != GNO_OK || !add_lamps(o, &l)) goto fail;
    }
    measure(o);
    return o;
fail:
    oracle_destroy(o);
    return NULL;
}

void oracle_destroy(oracle *o)
{
    if (!o) return;
    for (size_t i = 0; i < o->face_count; i++) {
        free(o->faces[i].flat);
        free(o->faces[i].normals);
    }
    free(o->faces);
    free(o->lamps);
    free(o);
}

size_t oracle_polygons(const oracle *o) { return o->face_count; }
size_t oracle_lights(const oracle *o) { return o->lamp_count; }

static unsigned long mix(unsigned long hash, unsigned long value) { return ((hash ^ value) * 1099511UL + (hash >> 7)) & 0xffffffffUL; }

/* ---- rays ------------------------------------------------------------------------------------------------------ */

/* Is the point of the face's plane inside: does a line from it cross the borders of all its rings an odd number of times? */
static int inside(const face *a, const double point[3])
{
    double x = point[a->u], y = point[a->v];
    int odd = 0;
    if (x < a->low[0] || x > a->high[0] || y < a->low[1] || y > a->high[1]) return 0;
    for (size_t ring = 0; ring < a->p.ring_count; ring++) {
        unsigned first = a->p.ring_start[ring] - a->p.ring_start[0], last = a->p.ring_start[ring + 1] - a->p.ring_start[0];
        for (unsigned i = first; i < last; i++) {
            const double *s = a->flat[i], *t = a->flat[i + 1 < last ? i + 1 : first];
            if ((s[1] > y) == (t[1] > y)) continue;
            if (s[1] > t[1]) { /* always from below, so that both faces of an edge compute the same crossing */
                const double *swap = s;
                s = t;
                t = swap;
            }
            if (x < s[0] + (y - s[1]) / (t[1] - s[1]) * (t[0] - s[0])) odd = !odd;
        }
    }
    return odd;
}

/* Where the ray meets the face: the parameter, or -1. */
static double meet(const face *a, const double origin[3], const double direction[3], double longest, double point[3])
{
    double down = dot(a->n, direction);
    if (down == 0) return -1;
    double t = -(dot(a->n, origin) + a->d) / down;
    if (!(t > 0) || t > longest) return -1;
    for (int k = 0; k < 3; k++) point[k] = origin[k] + t * direction[k];
    return inside(a, point) ? t : -1;
}

#define LAYERS 64 /* faces seen through each other along one ray; what lies behind so many is left out */

static int among(const face *a, const face *const *seen, int count)
{
    for (int i = 0; i < count; i++)
        if (seen[i] == a) return 1;
    return 0;
}

/* The visible face along the ray once `count` faces are taken away: the nearest, and among those on its plane the highest
 * priority, then the lowest index. */
static const face *visible(const oracle *o, const double origin[3], const double direction[3], const face *const *seen, int count,
                           double point[3])
{
    const face *best = NULL;
    double at[3], nearest = INFINITY;
    for (size_t i = 0; i < o->face_count; i++) {
        const face *a = &o->faces[i];
        if ((!a->m.two_sided && dot(a->n, direction) >= 0) || among(a, seen, count)) continue;
        double t = meet(a, origin, direction, nearest, at);
        if (t < 0 || t >= nearest) continue;
        nearest = t;
        best = a;
    }
    if (!best) return NULL;
    const face *plane = best;
    for (size_t i = 0; i < o->face_count; i++) {
        const face *a = &o->faces[i];
        if (a == best || a->p.priority < best->p.priority || (a->p.priority == best->p.priority && a->polygon > best->polygon)) continue;
        if ((!a->m.two_sided && dot(a->n, direction) >= 0) || among(a, seen, count)) continue;
        if (meet(a, origin, direction, INFINITY, at) < 0 || fabs(dot(plane->n, at) + plane->d) > o->tolerance) continue;
        best = a;
    }
    meet(best, origin, direction, INFINITY, point);
    return best;
}

/* Does the face lie on the other's plane, corner by corner? Of two on one plane neither casts a shadow on the other; rounding
 * may let only the smaller lie on the larger one's. A face that only touches a plane does, up to the line of contact. */
static int lies_on(const oracle *o, const face *a, const face *plane)
{
    for (unsigned i = a->p.ring_start[0]; i < a->p.ring_start[1]; i++)
        if (fabs(dot(plane->n, corner(a, i)) + plane->d) > o->tolerance) return 0;
    return 1;
}

/* What passes from the lamp to a point of the receiver: the product over everything between of what each lets through, its
 * transmission or what its shadow leaves at its distance; returns a hash of who is between. */
static unsigned long passes(const oracle *o, const lamp *l, const face *receiver, const double point[3], double light[3])
{
    double to[3], at[3], length;
    unsigned long state = 1;
    int far = l->l.type == GNO_LIGHT_DIRECTIONAL;
    for (int k = 0; k < 3; k++) to[k] = far ? -l->direction[k] : l->position[k] - point[k];
    light[0] = light[1] = light[2] = 1;
    length = sqrt(dot(to, to));
    for (size_t i = 0; i < o->face_count; i++) {
        const face *a = &o->faces[i];
        double share;
        if (a == receiver || a->p.detail_of >= 0 || (share = meet(a, point, to, far ? INFINITY : BEFORE_LAMP, at)) < 0 || lies_on(o, a, receiver) ||
            lies_on(o, receiver, a)) continue;
        for (int k = 0; k < 3; k++) {
            double t = a->m.transmission[k], d = share * length;
            light[k] *= l->l.softness > 0 ? 1 - (1 - t) / (1 + d / l->l.softness) : t;
        }
        state = mix(state, i);
    }
    return state;
}

/* ---- light ------------------------------------------------------------------------------------------------------ */

/* Unit direction from a point to the viewer, and the viewer's distance as the falloff takes it. */
static double to_viewer(const oracle *o, const double point[3], double s[3])
{
    double ray[3];
    subtract(point, o->camera.eye, ray);
    if (o->camera.type == GNO_CAMERA_ORTHOGRAPHIC) {
        for (int k = 0; k < 3; k++) s[k] = -o->f[k];
        return dot(ray, o->f) - o->nearest_depth;
    }
    for (int k = 0; k < 3; k++) s[k] = -ray[k];
    return unit(s);
}

/* f Il (kd max(0, N.L) + ks max(0, R.S)^n) of one lamp, without its v; n is unit and on the viewer's side. */
static void brightness(const oracle *o, const lamp *l, const gno_material *m, const double point[3], const double n[3], double out[3])
{
    double to[3], s[3], distance, f = 1;
    double viewer = to_viewer(o, point, s);
    int far = l->l.type == GNO_LIGHT_DIRECTIONAL;
    for (int k = 0; k < 3; k++) to[k] = far ? -l->direction[k] : l->position[k] - point[k];
    distance = unit(to);
    if (l->l.falloff == GNO_FALLOFF_LINEAR && l->l.distance_from_viewer) f = 1 / (viewer + l->l.falloff_k);
    if (l->l.falloff == GNO_FALLOFF_LINEAR && !l->l.distance_from_viewer && !far) f = 1 / (distance + l->l.falloff_k);
    if (l->l.falloff == GNO_FALLOFF_INVERSE_SQUARE && !far) f = 1 / (distance * distance);
    double nl = dot(n, to), rs = 2 * nl * dot(n, s) - dot(to, s);
    double gloss = rs > 0 ? pow(rs, m->shininess) : 0;
    for (int k = 0; k < 3; k++) out[k] = nl > 0 ? f * l->intensity[k] * (m->diffuse[k] * nl + m->specular[k] * gloss) : 0;
}

/* Shares of a smooth face's corners at a point of it: the triangle of its fan that holds the point. */
static void shares(const face *a, const double point[3], unsigned who[3], double share[3])
{
    unsigned first = a->p.ring_start[0], count = a->p.ring_start[1] - first;
    double best = -INFINITY;
    for (unsigned i = 1; i + 1 < count; i++) {
        unsigned c[3] = {0, i, i + 1};
        double s[3], sum = 0, least;
        for (int k = 0; k < 3; k++) {
            double e[3], g[3], x[3];
            subtract(corner(a, first + c[(k + 1) % 3]), point, e);
            subtract(corner(a, first + c[(k + 2) % 3]), point, g);
            cross(e, g, x);
            s[k] = dot(x, a->n);
            sum += s[k];
        }
        if (!(sum > 0)) continue;
        least = fmin(s[0], fmin(s[1], s[2])) / sum;
        if (least <= best) continue;
        best = least;
        for (int k = 0; k < 3; k++) {
            who[k] = c[k];
            share[k] = s[k] / sum;
        }
    }
}

/* Turns a unit normal to the side of the viewer-facing plane normal. */
static void face_viewer(double n[3], const double plane[3])
{
    double side = dot(n, plane) < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) n[k] *= side;
}

/* The light of one lamp that the point sends to the viewer, v left out, by the face's way of shading. */
static void shade(const oracle *o, const lamp *l, const face *a, const double point[3], const double plane[3], double out[3])
{
    unsigned who[3] = {0, 0, 0};
    double share[3] = {1, 0, 0}, n[3] = {0, 0, 0};
    if (a->normals) shares(a, point, who, share);
    switch (a->p.shading) {
    case GNO_SHADING_CONSTANT:
        brightness(o, l, &a->m, a->centroid, plane, out);
        return;
    case GNO_SHADING_GOURAUD:
        out[0] = out[1] = out[2] = 0;
        for (int c = 0; c < 3; c++) {
            double part[3];
            memcpy(n, a->normals[who[c]], sizeof n);
            face_viewer(n, plane);
            brightness(o, l, &a->m, corner(a, a->p.ring_start[0] + who[c]), n, part);
            for (int k = 0; k < 3; k++) out[k] += share[c] * part[k];
        }
        return;
    case GNO_SHADING_PHONG:
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++) n[k] += share[c] * a->normals[who[c]][k];
        unit(n);
        face_viewer(n, plane);
        brightness(o, l, &a->m, point, n, out);
        return;
    default:
        brightness(o, l, &a->m, point, plane, out);
        return;
    }
}

/* Adds all lamps' light on a face's point, times what the faces before it let through, to the sample's colour, and their
 * shadow states to its hash. Its brightness is that of `lit`, a point of the same plane. */
static void light_point(const oracle *o, const face *a, const double point[3], const double lit[3], const double direction[3],
                        const double through[3], oracle_sample *s)
{
    double plane[3];
    double side = dot(a->n, direction) > 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) plane[k] = side * a->n[k];
    for (size_t i = 0; i < o->lamp_count; i++) {
        const lamp *l = &o->lamps[i];
        unsigned long casters = 0;
        double to[3], light[3] = {0, 0, 0}, colour[3];
        int far = l->l.type == GNO_LIGHT_DIRECTIONAL;
        for (int k = 0; k < 3; k++) to[k] = far ? -l->direction[k] : l->position[k] - point[k];
        unit(to);
        /* light from behind the plane is the polygon's own shadow */
        if (dot(plane, to) > GRAZING && -dot(to, l->direction) >= l->cone) casters = passes(o, l, a, point, light);
        shade(o, l, a, lit, plane, colour);
        if (l->l.softness > 0) s->state = mix(s->state, casters);
        for (int k = 0; k < 3; k++) {
            s->rgb[k] += through[k] * light[k] * colour[k];
            if (!(l->l.softness > 0)) s->state = mix(s->state, (unsigned long)(light[k] * 1e6 + 0.5));
        }
    }
}

void oracle_reach(const oracle *o, long polygon, const double point[3], size_t light, double passed[3])
{
    const lamp *l = &o->lamps[light];
    double to[3];
    int far = l->l.type == GNO_LIGHT_DIRECTIONAL;
    passed[0] = passed[1] = passed[2] = 0;
    for (int k = 0; k < 3; k++) to[k] = far ? -l->direction[k] : l->position[k] - point[k];
    unit(to);
    for (size_t i = 0; i < o->face_count; i++) {
        const face *a = &o->faces[i];
        if ((long)a->polygon == polygon && fabs(dot(a->n, to)) > GRAZING && -dot(to, l->direction) >= l->cone) passes(o, l, a, point, passed);
    }
}

static void ray_through(const oracle *o, double x, double y, double origin[3], double direction[3])
{
    double aspect = (double)o->image.width / o->image.height;
    int flat = o->camera.type == GNO_CAMERA_ORTHOGRAPHIC;
    double half = flat ? o->camera.height / 2 : tan(o->camera.fov * PI / 360);
    double sx = (2 * x / o->image.width - 1) * half * aspect, sy = (1 - 2 * y / o->image.height) * half;
    for (int k = 0; k < 3; k++) {
        double off = sx * o->r[k] + sy * o->q[k];
        origin[k] = o->camera.eye[k] + (flat ? off : 0);
        direction[k] = o->f[k] + (flat ? 0 : off);
    }
}

/* Counts the ray for the surface, or, once all are counted, moves `lit` to the middle of where it was seen. */
static void use_surface(const oracle *o, const face *a, double x, double y, oracle_surfaces *surfaces, double lit[3])
{
    int i = 0;
    while (i < surfaces->count && surfaces->each[i].polygon != (long)a->polygon) i++;
    if (i == ORACLE_SURFACES) return;
    oracle_surface *s = &surfaces->each[i];
    if (!surfaces->counted) {
        if (i == surfaces->count) memset(&surfaces->each[surfaces->count++], 0, sizeof *s);
        s->polygon = (long)a->polygon;
        s->rays++;
        s->x += x;
        s->y += y;
    } else if (i < surfaces->count) {
        double origin[3], direction[3];
        ray_through(o, s->x / s->rays, s->y / s->rays, origin, direction);
        double t = -(dot(a->n, origin) + a->d) / dot(a->n, direction);
        for (int k = 0; k < 3; k++) lit[k] = origin[k] + t * direction[k];
    }
}

oracle_sample oracle_look_again(const oracle *o, double x, double y, oracle_surfaces *surfaces)
{
    oracle_sample s;
    double origin[3], direction[3];
    ray_through(o, x, y, origin, direction);
    memset(&s, 0, sizeof s);
    const face *seen[LAYERS];
    double through[3] = {1, 1, 1};
    for (int i = 0; i < LAYERS && (through[0] > 0 || through[1] > 0 || through[2] > 0); i++) {
        double point[3], lit[3];
        const face *a = seen[i] = visible(o, origin, direction, seen, i, point);
        if (i == 0) s.polygon = a ? (long)a->polygon : -1;
        if (i == 0 && a) memcpy(s.point, point, sizeof s.point);
        s.state = mix(s.state, a ? (unsigned long)a->polygon : 0xffffUL);
        for (int k = 0; k < 3; k++) s.rgb[k] += through[k] * (a ? o->ambient[k] * a->m.ambient[k] : o->image.background[k]);
        if (!a) break;
        memcpy(lit, point, sizeof lit);
        if (surfaces) use_surface(o, a, x, y, surfaces, lit);
        light_point(o, a, point, lit, direction, through, &s);
        for (int k = 0; k < 3; k++) through[k] *= a->m.transmission[k];
    }
    return s;
}

oracle_sample oracle_look(const oracle *o, double x, double y) { return oracle_look_again(o, x, y, NULL); }

gno_image_def oracle_image(const oracle *o) { return o->image; }
