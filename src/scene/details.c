/* details.c -- polygons that lie on others: windows, doors, lettering.
 *
 * Place in the data flow: emit.c -> here -> solid.c. A mesh is marked as lying on a polygon by the caller (detail_of), or polygons
 * that lie on larger ones are found (find_details). Either way a detail gets the plane of the polygon that bears it, so that depth is the same
 * to the last bit, and a priority above its own; nothing else decides who is in front. It stays a receiver of shadows and casts none.
 * Finding takes no pairs: every polygon that may bear others stands in the cells of a grid as coarse as itself, at most eight of them;
 * one that may lie on another is looked up by its middle in the grids of its own coarseness and above.
 * Invariants: the bearer is not a detail of what it bears; the smallest of several that hold a polygon bears it; the result depends on
 * the scene alone.
 */
#include "base/sort.h"
#include "base/tolerance.h"
#include "scene/prepare.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Grids from the scene's size down, each half as coarse as the one before. */
#define LEVELS 24
/* A bearer is larger than what lies on it by this factor at least. */
#define LARGER 1.000001
/* Cosine between normals from which two polygons may lie in one plane; their corners decide. */
#define FACING 0.9
/* Pairs of edges beyond which two polygons are not compared. */
#define MOST_PAIRS 4000000
/* In the place of a prepared polygon's number: a source polygon has more than one. */
#define SEVERAL 0xfffffffeu

/* ---- what the caller marks ------------------------------------------------------------------------------------------- */

static vec3 source_corner(const gno_scene *scene, unsigned corner) { return v3_from(scene->positions[scene->corner_vertex[corner]]); }

/* Newell's normal of the outer ring, twice the area long. */
static vec3 source_normal(const gno_scene *scene, size_t polygon)
{
    unsigned ring = scene->polygon_start[polygon], from = scene->ring_start[ring], to = scene->ring_start[ring + 1];
    vec3 sum = v3(0, 0, 0), first;
    if (to - from < 3)
        return sum;
    first = source_corner(scene, from);
    for (unsigned i = from + 1; i + 1 < to; i++)
        sum = v3_add(sum, v3_cross(v3_sub(source_corner(scene, i), first), v3_sub(source_corner(scene, i + 1), first)));
    return sum;
}

/* Greatest distance of a polygon's corners from `origin`, along n (unit) or, with n zero, whatever their direction. */
static double reach(const gno_scene *scene, size_t polygon, vec3 origin, const vec3 *n)
{
    unsigned from = scene->ring_start[scene->polygon_start[polygon]], to = scene->ring_start[scene->polygon_start[polygon + 1]];
    double most = 0;
    for (unsigned i = from; i < to; i++) {
        vec3 q = v3_sub(source_corner(scene, i), origin);
        double d = n ? fabs(v3_dot(*n, q)) : v3_length(q);
        most = d > most ? d : most;
    }
    return most;
}

gno_status gnoi_check_detail(gno_scene *scene, const char *label, size_t first, size_t count, int parent)
{
    vec3 origin, n;
    double limit, far_away;
    if (parent < 0 || (size_t)parent >= scene->polygon_count)
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "%s: detail_of %d of %zu polygons", label, parent, scene->polygon_count);
    n = v3_unit(source_normal(scene, (size_t)parent));
    if (v3_dot(n, n) == 0)
        return GNO_OK; /* a bearer without area bears nothing */
    origin = source_corner(scene, scene->ring_start[scene->polygon_start[parent]]);
    far_away = reach(scene, (size_t)parent, v3(0, 0, 0), NULL);
    limit = GNOI_PLANAR * reach(scene, (size_t)parent, origin, NULL) + GNOI_COPLANAR * far_away;
    for (size_t p = first; p < first + count; p++) {
        double off = reach(scene, p, origin, &n);
        if (off > limit)
            return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT,
                             "%s lies up to %g off the plane of the polygon that it is a detail of; at most %g is allowed", label, off, limit);
    }
    return GNO_OK;
}

gno_status gno_scene_set_detail_of(gno_scene *scene, size_t object, int polygon)
{
    char label[64];
    const gnoi_object *o;
    gno_status status = GNO_OK;
    size_t at;
    if (!scene)
        return GNO_ERROR_ARGUMENT;
    if (object >= scene->object_count)
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_scene_set_detail_of: object %zu of %zu", object, scene->object_count);
    o = &scene->objects[object];
    snprintf(label, sizeof label, "object %lu", (unsigned long)object);
    if (polygon >= 0)
        status = gnoi_check_detail(scene, label, o->first_polygon, o->polygon_count, polygon);
    for (int parent = polygon; status == GNO_OK && parent >= 0; parent = scene->objects[at].detail_of) {
        at = (size_t)scene->polygon_object[parent];
        if (at == object)
            return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_scene_set_detail_of: object %zu would be a detail of itself", object);
    }
    if (status == GNO_OK) {
        scene->objects[object].detail_of = polygon < 0 ? -1 : polygon;
        gnoi_scene_changed(scene);
    }
    return status;
}

gno_status gno_scene_find_details(gno_scene *scene, int find)
{
    if (!scene)
        return GNO_ERROR_ARGUMENT;
    for (size_t i = 0; i < scene->object_count; i++)
        scene->objects[i].find_details = find != 0;
    gnoi_scene_changed(scene);
    return GNO_OK;
}

/* ---- what a detail takes from its bearer ------------------------------------------------------------------------------- */

static void lay_on(gnoi_poly *poly, const gnoi_poly *bearer)
{
    double same = v3_dot(v3_from(poly->n), v3_from(bearer->n)) < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++)
        poly->n[k] = same * bearer->n[k];
    poly->d = same * bearer->d;
    poly->detail = 1;
    if (poly->priority <= bearer->priority && bearer->priority < INT16_MAX)
        poly->priority = (int16_t)(bearer->priority + 1);
}

/* What is laid: prepared polygons by their source. */
typedef struct laying {
    gno_scene *scene;
    uint32_t *only;      /* of source polygons: the one prepared polygon; GNOI_NONE: it has no area; SEVERAL: it was split */
    unsigned char *laid; /* of objects */
    uint32_t *way;       /* objects between one and the first that is not a detail or laid already */
} laying;

static void find_only(const laying *l)
{
    const gnoi_prepared *prep = &l->scene->prepared;
    memset(l->only, 0xff, l->scene->polygon_count * sizeof *l->only); /* GNOI_NONE */
    for (uint32_t i = 0; i < prep->poly_count; i++) {
        uint32_t *only = &l->only[prep->polys[i].source];
        *only = *only == GNOI_NONE ? i : SEVERAL;
    }
}

/* Lays the polygons of an object on their bearer. */
static void lay_object(const laying *l, size_t object)
{
    const gnoi_object *o = &l->scene->objects[object];
    gnoi_poly *polys = l->scene->prepared.polys;
    uint32_t bearer = l->only[o->detail_of];
    for (size_t p = o->first_polygon; p < o->first_polygon + o->polygon_count && bearer < SEVERAL; p++)
        if (l->only[p] < SEVERAL)
            lay_on(&polys[l->only[p]], &polys[bearer]);
}

/* Bearers before what they bear. */
static void lay_marked(const laying *l)
{
    const gno_scene *scene = l->scene;
    for (size_t i = 0; i < scene->object_count; i++) {
        size_t n = 0, at = i;
        while (!l->laid[at] && scene->objects[at].detail_of >= 0) {
            l->laid[at] = 1;
            l->way[n++] = (uint32_t)at;
            at = (size_t)scene->polygon_object[scene->objects[at].detail_of];
        }
        while (n > 0)
            lay_object(l, l->way[--n]);
    }
}

static gno_status prepare_marked(gno_scene *scene)
{
    gno_context *context = scene->context;
    laying l = {scene, NULL, NULL, NULL};
    gno_status status = GNO_ERROR_MEMORY;
    l.only = gnoi_malloc(context, scene->polygon_count, sizeof *l.only);
    l.laid = gnoi_calloc(context, scene->object_count, 1);
    l.way = gnoi_malloc(context, scene->object_count, sizeof *l.way);
    if (l.only && l.laid && l.way) {
        find_only(&l);
        lay_marked(&l);
        status = GNO_OK;
    }
    gnoi_free(context, l.way, scene->object_count, sizeof *l.way);
    gnoi_free(context, l.laid, scene->object_count, 1);
    gnoi_free(context, l.only, scene->polygon_count, sizeof *l.only);
    return status;
}

/* ---- does one polygon lie inside another? ------------------------------------------------------------------------------ */

static vec3 corner_at(const gno_scene *scene, uint32_t corner) { return v3_from(scene->prepared.positions[scene->prepared.corner_vertex[corner]]); }

typedef struct point2 {
    double x, y;
} point2;

/* Polygons are compared in the coordinates of the bearer's plane that it fills the most. */
typedef struct flat {
    const gno_scene *scene;
    int u, v;
    double tolerance;
} flat;

static point2 flat_corner(const flat *f, uint32_t corner)
{
    const double *p = f->scene->prepared.positions[f->scene->prepared.corner_vertex[corner]];
    point2 r;
    r.x = p[f->u];
    r.y = p[f->v];
    return r;
}

/* Distance of p from the edge a b. */
static double edge_distance(point2 p, point2 a, point2 b)
{
    double ex = b.x - a.x, ey = b.y - a.y, px = p.x - a.x, py = p.y - a.y, l = ex * ex + ey * ey, t = l > 0 ? (px * ex + py * ey) / l : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return hypot(px - t * ex, py - t * ey);
}

/* 1 when p is inside the polygon by more than the tolerance, 0 on its border, -1 outside (even-odd). */
static int where(const flat *f, const gnoi_poly *poly, point2 p)
{
    const uint32_t *ring_corner = f->scene->prepared.ring_corner;
    int inside = 0;
    for (uint32_t r = poly->ring; r < poly->ring + poly->ring_count; r++)
        for (uint32_t i = ring_corner[r]; i < ring_corner[r + 1]; i++) {
            point2 a = flat_corner(f, i), b = flat_corner(f, i + 1 < ring_corner[r + 1] ? i + 1 : ring_corner[r]);
            if (edge_distance(p, a, b) <= f->tolerance)
                return 0;
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
                inside ^= 1;
        }
    return inside ? 1 : -1;
}

/* On which side of the line a b a point is, 0 within the tolerance of it. */
static int side_of(const flat *f, point2 a, point2 b, point2 p)
{
    double ex = b.x - a.x, ey = b.y - a.y, s = ex * (p.y - a.y) - ey * (p.x - a.x), t = f->tolerance * hypot(ex, ey);
    return s > t ? 1 : s < -t ? -1 : 0;
}

/* 1 when the edge a b crosses an edge of the polygon from one side to the other. */
static int crosses(const flat *f, const gnoi_poly *poly, point2 a, point2 b)
{
    const uint32_t *ring_corner = f->scene->prepared.ring_corner;
    for (uint32_t r = poly->ring; r < poly->ring + poly->ring_count; r++)
        for (uint32_t i = ring_corner[r]; i < ring_corner[r + 1]; i++) {
            point2 c = flat_corner(f, i), d = flat_corner(f, i + 1 < ring_corner[r + 1] ? i + 1 : ring_corner[r]);
            if (side_of(f, a, b, c) * side_of(f, a, b, d) < 0 && side_of(f, c, d, a) * side_of(f, c, d, b) < 0)
                return 1;
        }
    return 0;
}

/* Every corner and the middle of every edge of `poly` inside the bearer or on its border, no edges crossing, and no border of
 * the bearer (a notch, a hole) within `poly`. */
static int holds(const flat *f, const gnoi_poly *bearer, const gnoi_poly *poly)
{
    const uint32_t *ring_corner = f->scene->prepared.ring_corner;
    uint32_t first = ring_corner[poly->ring], end = ring_corner[poly->ring + 1];
    for (uint32_t i = first; i < end; i++) {
        point2 a = flat_corner(f, i), b = flat_corner(f, i + 1 < end ? i + 1 : first), middle;
        middle.x = 0.5 * (a.x + b.x);
        middle.y = 0.5 * (a.y + b.y);
        if (where(f, bearer, a) < 0 || where(f, bearer, middle) < 0 || crosses(f, bearer, a, b))
            return 0;
    }
    for (uint32_t i = bearer->corner; i < bearer->corner + bearer->corner_count; i++)
        if (where(f, poly, flat_corner(f, i)) > 0)
            return 0;
    return 1;
}

static int bears(const gno_scene *scene, const gnoi_poly *bearer, const gnoi_poly *poly)
{
    flat f = {scene, 1, 2, 0};
    vec3 n = v3_from(bearer->n);
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    if (v3_dot(n, v3_from(poly->n)) < FACING || (double)bearer->corner_count * poly->corner_count > MOST_PAIRS)
        return 0;
    f.tolerance = gnoi_plane_tolerance(&scene->prepared, (const double(*)[3])scene->prepared.positions, bearer);
    for (uint32_t i = poly->corner; i < poly->corner + poly->corner_count; i++)
        if (fabs(v3_dot(n, corner_at(scene, i)) + bearer->d) > f.tolerance)
            return 0;
    if (z >= x && z >= y) {
        f.u = 0;
        f.v = 1;
    } else if (y >= x) {
        f.u = 2;
        f.v = 0;
    }
    return holds(&f, bearer, poly);
}

/* ---- finding ------------------------------------------------------------------------------------------------------------ */

typedef struct box {
    double lower[3], upper[3];
} box;

typedef struct finder {
    gno_scene *scene;
    size_t count;           /* polygons looked at */
    gnoi_keyed *order;      /* those, by falling area; and scratch */
    double *area;           /* of order[i] */
    unsigned char *level;   /* of order[i] */
    uint32_t mask;          /* of the hash table */
    uint32_t *start, *list; /* by cell: places in the order, ascending */
} finder;

static box box_of(const gno_scene *scene, const gnoi_poly *poly)
{
    box b = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    for (uint32_t i = poly->corner; i < poly->corner + poly->corner_count; i++) {
        const double *p = scene->prepared.positions[scene->prepared.corner_vertex[i]];
        for (int k = 0; k < 3; k++) {
            b.lower[k] = p[k] < b.lower[k] ? p[k] : b.lower[k];
            b.upper[k] = p[k] > b.upper[k] ? p[k] : b.upper[k];
        }
    }
    return b;
}

/* The outer ring's area less the holes'. */
static double area_of(const gno_scene *scene, const gnoi_poly *poly)
{
    const uint32_t *ring_corner = scene->prepared.ring_corner;
    double area = 0;
    for (uint32_t r = poly->ring; r < poly->ring + poly->ring_count; r++) {
        vec3 first = corner_at(scene, ring_corner[r]), sum = v3(0, 0, 0);
        for (uint32_t i = ring_corner[r] + 1; i + 1 < ring_corner[r + 1]; i++)
            sum = v3_add(sum, v3_cross(v3_sub(corner_at(scene, i), first), v3_sub(corner_at(scene, i + 1), first)));
        area += (r == poly->ring ? 0.5 : -0.5) * fabs(v3_dot(sum, v3_from(poly->n)));
    }
    return area;
}

static double scene_size(const gnoi_prepared *prep)
{
    double size = 0;
    for (int k = 0; k < 3; k++)
        size = prep->upper[k] - prep->lower[k] > size ? prep->upper[k] - prep->lower[k] : size;
    return size;
}

/* The finest grid whose cells are as large as the box. */
static unsigned char level_of(const gno_scene *scene, const box *b)
{
    double size = scene_size(&scene->prepared), extent = 0;
    unsigned char level = 0;
    for (int k = 0; k < 3; k++)
        extent = b->upper[k] - b->lower[k] > extent ? b->upper[k] - b->lower[k] : extent;
    for (size *= 0.5; level < LEVELS - 1 && extent < size; size *= 0.5)
        level++;
    return level;
}

static int64_t cell_of(const gno_scene *scene, int level, int k, double x)
{
    return (int64_t)floor(ldexp((x - scene->prepared.lower[k]) / scene_size(&scene->prepared), level));
}

static uint32_t hash_cell(int level, const int64_t cell[3])
{
    uint64_t h = (uint64_t)level;
    for (int k = 0; k < 3; k++) {
        h = (h ^ (uint64_t)cell[k]) * 0x9e3779b97f4a7c15u;
        h ^= h >> 29;
    }
    return (uint32_t)(h >> 16);
}

/* Counts the cells of the polygon at a place of the order, or enters it there. */
static void enter(finder *f, size_t place, int fill)
{
    const gnoi_poly *poly = &f->scene->prepared.polys[f->order[place].value];
    box b = box_of(f->scene, poly);
    double slack = gnoi_plane_tolerance(&f->scene->prepared, (const double(*)[3])f->scene->prepared.positions, poly);
    int64_t low[3], high[3], c[3];
    for (int k = 0; k < 3; k++) {
        low[k] = cell_of(f->scene, f->level[place], k, b.lower[k] - slack);
        high[k] = cell_of(f->scene, f->level[place], k, b.upper[k] + slack);
    }
    for (c[0] = low[0]; c[0] <= high[0]; c[0]++)
        for (c[1] = low[1]; c[1] <= high[1]; c[1]++)
            for (c[2] = low[2]; c[2] <= high[2]; c[2]++) {
                uint32_t h = hash_cell(f->level[place], c) & f->mask;
                if (fill)
                    f->list[f->start[h + 1]++] = (uint32_t)place;
                else
                    f->start[h + 2]++;
            }
}

/* The polygons that may take part, largest first. */
static int list_polys(finder *f)
{
    gno_scene *scene = f->scene;
    const gnoi_prepared *prep = &scene->prepared;
    for (size_t i = 0; i < prep->poly_count; i++) {
        union { float f; uint32_t i; } area;
        const gnoi_object *o = &scene->objects[scene->polygon_object[prep->polys[i].source]];
        if (!o->find_details)
            continue;
        area.f = (float)area_of(scene, &prep->polys[i]);
        f->order[f->count].key = area.f > 0 ? ~area.i : UINT32_MAX;
        f->order[f->count++].value = (uint32_t)i;
    }
    gnoi_sort(f->order, f->order + prep->poly_count, f->count);
    for (size_t i = 0; i < f->count; i++) {
        box b = box_of(scene, &prep->polys[f->order[i].value]);
        f->area[i] = area_of(scene, &prep->polys[f->order[i].value]);
        f->level[i] = level_of(scene, &b);
    }
    return scene_size(prep) > 0;
}

static gno_status fill_table(finder *f)
{
    gno_context *context = f->scene->context;
    for (size_t i = 0; i < f->count; i++)
        enter(f, i, 0);
    for (size_t h = 2; h < (size_t)f->mask + 3; h++)
        f->start[h] += f->start[h - 1];
    f->list = gnoi_malloc(context, f->start[f->mask + 2], sizeof *f->list);
    if (!f->list)
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < f->count; i++)
        enter(f, i, 1);
    return GNO_OK;
}

/* The smallest polygon that bears the one at a place of the order, or NULL. */
static const gnoi_poly *find_bearer(const finder *f, size_t place)
{
    const gnoi_poly *polys = f->scene->prepared.polys, *poly = &polys[f->order[place].value];
    box b = box_of(f->scene, poly);
    size_t best = SIZE_MAX;
    for (int level = f->level[place]; level >= 0; level--) {
        int64_t c[3];
        uint32_t h;
        for (int k = 0; k < 3; k++)
            c[k] = cell_of(f->scene, level, k, 0.5 * (b.lower[k] + b.upper[k]));
        h = hash_cell(level, c) & f->mask;
        for (uint32_t i = f->start[h]; i < f->start[h + 1] && f->area[f->list[i]] > LARGER * f->area[place]; i++) {
            size_t other = f->list[i];
            if ((best == SIZE_MAX || other > best) && f->level[other] == level && bears(f->scene, &polys[f->order[other].value], poly))
                best = other;
        }
    }
    return best == SIZE_MAX ? NULL : &polys[f->order[best].value];
}

static gno_status find_all(finder *f)
{
    gnoi_prepared *prep = &f->scene->prepared;
    gno_status status;
    if (!list_polys(f))
        return GNO_OK;
    status = fill_table(f);
    for (size_t i = 0; i < f->count && status == GNO_OK && !gnoi_stopped_at(f->scene->context, i); i++) {
        gnoi_poly *poly = &prep->polys[f->order[i].value];
        const gnoi_poly *bearer = poly->detail ? NULL : find_bearer(f, i);
        if (!bearer)
            continue;
        lay_on(poly, bearer);
        prep->problems.details++;
    }
    return status;
}

static gno_status find_details(gno_scene *scene)
{
    gno_context *context = scene->context;
    size_t polys = scene->prepared.poly_count;
    gno_status status = GNO_ERROR_MEMORY;
    finder f;
    memset(&f, 0, sizeof f);
    f.scene = scene;
    for (f.mask = 15; f.mask < 2 * polys; f.mask = 2 * f.mask + 1)
        ;
    f.order = gnoi_malloc(context, 2 * polys, sizeof *f.order);
    f.area = gnoi_malloc(context, polys, sizeof *f.area);
    f.level = gnoi_malloc(context, polys, 1);
    f.start = gnoi_calloc(context, (size_t)f.mask + 3, sizeof *f.start);
    if (f.order && f.area && f.level && f.start)
        status = find_all(&f);
    gnoi_free(context, f.list, f.list ? f.start[f.mask + 2] : 0, sizeof *f.list);
    gnoi_free(context, f.start, (size_t)f.mask + 3, sizeof *f.start);
    gnoi_free(context, f.level, polys, 1);
    gnoi_free(context, f.area, polys, sizeof *f.area);
    gnoi_free(context, f.order, 2 * polys, sizeof *f.order);
    return status;
}

gno_status gnoi_prepare_details(gno_scene *scene)
{
    gno_status status = GNO_OK;
    int marked = 0, find = 0;
    for (size_t i = 0; i < scene->object_count; i++) {
        marked |= scene->objects[i].detail_of >= 0;
        find |= scene->objects[i].find_details;
    }
    if (marked)
        status = prepare_marked(scene);
    if (status == GNO_OK && find)
        status = find_details(scene);
    return status;
}
