/* order.c -- prepared polygons in the order in which they lie in space.
 *
 * Place in the data flow: last step of gnoi_scene_prepare. Files list polygons and vertices in any order; every later pass
 * visits neighbours together and would miss the cache on each of them.
 * Vertices at one place become one, so that edges that meet do so by number too.
 * Polygons are sorted by the Morton number of their first corner (Morton 1966); rings, corners, vertices and normals are then
 * numbered in the order of first use. Nothing but numbers changes: `source` still names the polygon as the caller knows it.
 * Invariant: prepared.positions and prepared.normals hold just what the corners name.
 */
#include "base/sort.h"
#include "scene/prepare.h"

#include <string.h>

#define MORTON_BITS 10
#define FEW_POLYGONS 1024 /* below, everything fits the cache as it is; only the copies are made */

static uint32_t spread(uint32_t x)
{
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

/* Cells are cubes of the longest extent: a flat scene cut as finely in height would come in layers. */
static uint32_t place_of(const gnoi_prepared *prep, double extent, const double p[3])
{
    uint32_t key = 0;
    for (int k = 0; k < 3; k++) {
        double t = extent > 0 ? (p[k] - prep->lower[k]) / extent : 0;
        key |= spread((uint32_t)(t * ((1 << MORTON_BITS) - 1))) << k;
    }
    return key;
}

/* 0 when stopped. */
static int sort_polys(const gno_scene *scene, gnoi_keyed *keys, gnoi_keyed *scratch)
{
    const gnoi_prepared *prep = &scene->prepared;
    double extent = 0;
    for (int k = 0; k < 3; k++)
        extent = prep->upper[k] - prep->lower[k] > extent ? prep->upper[k] - prep->lower[k] : extent;
    for (size_t i = 0; i < prep->poly_count; i++) {
        keys[i].key = 0;
        keys[i].value = (uint32_t)i;
        if (prep->poly_count >= FEW_POLYGONS)
            keys[i].key = place_of(prep, extent, scene->positions[prep->corner_vertex[prep->polys[i].corner]]);
        if (gnoi_stopped_at(scene->context, i))
            return 0;
    }
    if (prep->poly_count >= FEW_POLYGONS)
        gnoi_sort(keys, scratch, prep->poly_count);
    return !gnoi_stopped(scene->context);
}

/* Numbers given in the order of first use. */
typedef struct numbering {
    uint32_t *of; /* GNOI_NONE: not used yet */
    uint32_t count;
} numbering;

static uint32_t number(numbering *n, uint32_t old, int *is_new)
{
    *is_new = n->of[old] == GNOI_NONE;
    if (*is_new)
        n->of[old] = n->count++;
    return n->of[old];
}

typedef struct ordering {
    const gno_scene *scene;
    const gnoi_prepared *from;
    gnoi_prepared to;
    numbering vertices, normals;
    uint32_t *table, table_mask; /* prepared vertices by hash of position */
} ordering;

static uint32_t hash_position(const double p[3])
{
    uint64_t h = 0;
    for (int k = 0; k < 3; k++) {
        double v = p[k] + 0.0; /* -0 becomes 0 */
        uint64_t bits;
        memcpy(&bits, &v, sizeof bits);
        h = (h ^ bits) * 0x9e3779b97f4a7c15u;
        h ^= h >> 29;
    }
    return (uint32_t)(h >> 16);
}

/* The number of a scene vertex: that of the first one at its place. */
static uint32_t vertex_number(ordering *o, uint32_t old)
{
    const double *p = o->scene->positions[old];
    uint32_t slot;
    if (o->vertices.of[old] != GNOI_NONE)
        return o->vertices.of[old];
    for (slot = hash_position(p) & o->table_mask; o->table[slot] != GNOI_NONE; slot = (slot + 1) & o->table_mask) {
        const double *q = o->to.positions[o->table[slot]];
        if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2])
            return o->vertices.of[old] = o->table[slot];
    }
    memcpy(o->to.positions[o->vertices.count], p, sizeof o->to.positions[0]);
    o->table[slot] = o->vertices.count;
    return o->vertices.of[old] = o->vertices.count++;
}

static void copy_corner(ordering *o, uint32_t from, uint32_t to)
{
    int is_new;
    uint32_t old, v;
    o->to.corner_vertex[to] = vertex_number(o, o->from->corner_vertex[from]);
    if (o->from->corner_texcoord)
        o->to.corner_texcoord[to] = o->from->corner_texcoord[from];
    if (!o->from->corner_normal)
        return;
    old = o->from->corner_normal[from];
    o->to.corner_normal[to] = GNOI_NONE;
    if (old == GNOI_NONE)
        return;
    v = o->to.corner_normal[to] = number(&o->normals, old, &is_new);
    if (is_new)
        memcpy(o->to.normals[v], o->from->normals[old], sizeof o->to.normals[v]);
}

static void copy_poly(ordering *o, const gnoi_poly *poly, size_t index)
{
    gnoi_prepared *to = &o->to;
    gnoi_poly *copy = &to->polys[index];
    uint32_t shift = (uint32_t)to->corner_count - poly->corner; /* modulo 2^32 */
    *copy = *poly;
    copy->ring = (uint32_t)to->ring_count;
    copy->corner = (uint32_t)to->corner_count;
    for (uint32_t r = poly->ring; r < poly->ring + poly->ring_count; r++)
        to->ring_corner[to->ring_count++] = o->from->ring_corner[r] + shift;
    for (uint32_t i = 0; i < poly->corner_count; i++)
        copy_corner(o, poly->corner + i, copy->corner + i);
    to->corner_count += poly->corner_count;
    if (poly->triangle == GNOI_NONE)
        return;
    copy->triangle = (uint32_t)to->triangle_count;
    for (size_t t = 0; t < gnoi_triangles_of(poly); t++)
        for (int k = 0; k < 3; k++)
            to->triangles[to->triangle_count + t][k] = o->from->triangles[poly->triangle + t][k] + shift;
    to->triangle_count += gnoi_triangles_of(poly);
}

static int reserve(ordering *o)
{
    gno_context *context = o->scene->context;
    const gnoi_prepared *from = o->from;
    gnoi_prepared *to = &o->to;
    to->poly_count = to->poly_capacity = from->poly_count;
    to->ring_capacity = from->ring_count + 1;
    to->corner_capacity = from->corner_count;
    to->normal_capacity = from->normal_count;
    to->triangle_capacity = from->triangle_count;
    to->vertex_capacity = o->scene->vertex_count;
    to->polys = gnoi_malloc(context, to->poly_capacity, sizeof *to->polys);
    to->ring_corner = gnoi_malloc(context, to->ring_capacity, sizeof *to->ring_corner);
    to->corner_vertex = gnoi_malloc(context, to->corner_capacity, sizeof *to->corner_vertex);
    to->positions = gnoi_malloc(context, to->vertex_capacity, sizeof *to->positions);
    o->vertices.of = gnoi_malloc(context, o->scene->vertex_count, sizeof *o->vertices.of);
    o->normals.of = gnoi_malloc(context, from->normal_count, sizeof *o->normals.of);
    for (o->table_mask = 15; o->table_mask < 2 * o->scene->vertex_count; o->table_mask = 2 * o->table_mask + 1)
        ;
    o->table = gnoi_malloc(context, (size_t)o->table_mask + 1, sizeof *o->table);
    if (from->corner_normal)
        to->corner_normal = gnoi_malloc(context, to->corner_capacity, sizeof *to->corner_normal);
    if (from->corner_texcoord)
        to->corner_texcoord = gnoi_malloc(context, to->corner_capacity, sizeof *to->corner_texcoord);
    if (from->normals)
        to->normals = gnoi_malloc(context, to->normal_capacity, sizeof *to->normals);
    if (from->triangles)
        to->triangles = gnoi_malloc(context, to->triangle_capacity, sizeof *to->triangles);
    return to->polys && to->ring_corner && to->corner_vertex && to->positions && o->vertices.of && o->normals.of && o->table &&
           (!from->corner_normal || to->corner_normal) && (!from->corner_texcoord || to->corner_texcoord) &&
           (!from->normals || to->normals) && (!from->triangles || to->triangles);
}

gno_status gnoi_order_polygons(gno_scene *scene)
{
    gno_context *context = scene->context;
    gnoi_prepared *prep = &scene->prepared;
    size_t count = prep->poly_count, normal_count = prep->normal_count;
    gnoi_keyed *keys = gnoi_malloc(context, 2 * count, sizeof *keys);
    ordering o;
    int good;
    memset(&o, 0, sizeof o);
    o.scene = scene;
    o.from = prep;
    good = keys && reserve(&o) && sort_polys(scene, keys, keys + count);
    if (good) {
        memset(o.vertices.of, 0xff, scene->vertex_count * sizeof *o.vertices.of); /* GNOI_NONE */
        memset(o.table, 0xff, ((size_t)o.table_mask + 1) * sizeof *o.table);
        memset(o.normals.of, 0xff, normal_count * sizeof *o.normals.of);
        for (size_t i = 0; i < count && good; i++) {
            copy_poly(&o, &prep->polys[keys[i].value], i);
            good = !gnoi_stopped_at(context, i);
        }
        o.to.ring_corner[o.to.ring_count] = (uint32_t)o.to.corner_count;
        o.to.vertex_count = o.vertices.count;
        o.to.normal_count = o.normals.count;
        memcpy(o.to.lower, prep->lower, sizeof o.to.lower);
        memcpy(o.to.upper, prep->upper, sizeof o.to.upper);
        o.to.scale = prep->scale;
        o.to.problems = prep->problems;
    }
    gnoi_free(context, keys, 2 * count, sizeof *keys);
    gnoi_free(context, o.table, (size_t)o.table_mask + 1, sizeof *o.table);
    if (good) {
        gnoi_prepared_free(context, prep);
        *prep = o.to;
        good = gnoi_find_solids(scene, o.vertices.of) == GNO_OK;
    } else {
        gnoi_prepared_free(context, &o.to);
    }
    gnoi_free(context, o.vertices.of, scene->vertex_count, sizeof *o.vertices.of);
    gnoi_free(context, o.normals.of, normal_count, sizeof *o.normals.of);
    return good ? GNO_OK : GNO_ERROR_MEMORY;
}
