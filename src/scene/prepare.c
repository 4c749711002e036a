/* prepare.c -- makes the prepared polygons of a scene.
 *
 * Place in the data flow: gno_scene -> measure.c -> here -> normals.c -> gnoi_prepared, read by all passes.
 * A scene of good polygons (the usual one) keeps the measured records and copies offsets and corners as they are; otherwise
 * one pass over the records drops polygons without area and puts triangles in the place of those that are not planar.
 * Invariants: prepared polygons are in the order of their sources; every prepared ring has at least three corners;
 * the result does not depend on the number of threads.
 */
#include "scene/prepare.h"
#include "base/parallel.h"

#include <string.h>

#define CHUNK 1024 /* polygons a piece when triangulating */

/* Scratch for one polygon that is split, and where the pass over the records stands. */
typedef struct emitter {
    gno_scene *scene;
    gnoi_prepared *out;
    size_t vertex_capacity, normal_capacity, texcoord_capacity, ring_capacity, triangle_capacity;
    uint32_t *vertex, *normal, *texcoord, *ring;
    uint32_t (*triangles)[3];
} emitter;

/* ---- memory ---------------------------------------------------------------------------------------------------- */

void gnoi_prepared_free(gno_context *context, gnoi_prepared *prepared)
{
    gnoi_free(context, prepared->polys, prepared->poly_capacity, sizeof *prepared->polys);
    gnoi_free(context, prepared->ring_corner, prepared->ring_capacity, sizeof *prepared->ring_corner);
    gnoi_free(context, prepared->corner_vertex, prepared->corner_capacity, sizeof *prepared->corner_vertex);
    gnoi_free(context, prepared->corner_normal, prepared->corner_capacity, sizeof *prepared->corner_normal);
    gnoi_free(context, prepared->corner_texcoord, prepared->corner_capacity, sizeof *prepared->corner_texcoord);
    gnoi_free(context, prepared->solids, prepared->solid_count, sizeof *prepared->solids);
    gnoi_free(context, prepared->vertex_solid, prepared->vertex_capacity, sizeof *prepared->vertex_solid);
    gnoi_free(context, prepared->positions, prepared->vertex_capacity, sizeof *prepared->positions);
    gnoi_free(context, prepared->normals, prepared->normal_capacity, sizeof *prepared->normals);
    gnoi_free(context, prepared->triangles, prepared->triangle_capacity, sizeof *prepared->triangles);
    memset(prepared, 0, sizeof *prepared);
}

static gno_status out_of_memory(gno_scene *scene)
{
    return gnoi_fail(scene->context, GNO_ERROR_MEMORY, "prepare: out of memory");
}

/* 1 when a material asks for texture coordinates and there are any. */
static int has_texcoords(const gno_scene *scene)
{
    size_t i = 0;
    while (i < scene->material_count && !gnoi_is_mapped(&scene->materials[i])) {
        i++;
    }
    return scene->texcoord_count > 0 && i < scene->material_count;
}

static gno_status allocate(gno_scene *scene, size_t rings, size_t corners, int smooth)
{
    gnoi_prepared *out = &scene->prepared;
    int mapped = has_texcoords(scene);
    if (rings >= GNOI_NONE || corners >= GNOI_NONE) {
        return gnoi_fail(scene->context, GNO_ERROR_LIMIT, "prepare: more than %u corners once split into triangles", GNOI_NONE);
    }
    out->ring_corner = gnoi_malloc(scene->context, rings + 1, sizeof *out->ring_corner);
    out->ring_capacity = out->ring_corner ? rings + 1 : 0;
    out->corner_vertex = gnoi_malloc(scene->context, corners, sizeof *out->corner_vertex);
    out->corner_normal = smooth ? gnoi_malloc(scene->context, corners, sizeof *out->corner_normal) : NULL;
    out->corner_texcoord = mapped ? gnoi_malloc(scene->context, corners, sizeof *out->corner_texcoord) : NULL;
    out->corner_capacity = corners; /* of all; freeing passes over those that are NULL */
    if (!out->ring_corner || !out->corner_vertex || (smooth && !out->corner_normal) || (mapped && !out->corner_texcoord)) {
        return out_of_memory(scene);
    }
    return GNO_OK;
}

/* ---- all polygons good: copies --------------------------------------------------------------------------------- */

static gno_status copy_all(gno_scene *scene, int smooth)
{
    gnoi_prepared *out = &scene->prepared;
    gno_status status = allocate(scene, scene->ring_count, scene->corner_count, smooth);
    if (status != GNO_OK) {
        return status;
    }
    memcpy(out->ring_corner, scene->ring_start, (scene->ring_count + 1) * sizeof *out->ring_corner);
    if (scene->corner_count > 0) {
        memcpy(out->corner_vertex, scene->corner_vertex, scene->corner_count * sizeof *out->corner_vertex);
    }
    if (smooth) {
        memcpy(out->corner_normal, scene->corner_normal, scene->corner_count * sizeof *out->corner_normal);
    }
    if (out->corner_texcoord) {
        memcpy(out->corner_texcoord, scene->corner_texcoord, scene->corner_count * sizeof *out->corner_texcoord);
    }
    out->poly_count = scene->polygon_count;
    out->ring_count = scene->ring_count;
    out->corner_count = scene->corner_count;
    return GNO_OK;
}

/* ---- otherwise: one pass over the records ------------------------------------------------------------------------ */

static void free_scratch(emitter *e)
{
    gno_context *context = e->scene->context;
    gnoi_free(context, e->vertex, e->vertex_capacity, sizeof *e->vertex);
    gnoi_free(context, e->normal, e->normal_capacity, sizeof *e->normal);
    gnoi_free(context, e->texcoord, e->texcoord_capacity, sizeof *e->texcoord);
    gnoi_free(context, e->ring, e->ring_capacity, sizeof *e->ring);
    gnoi_free(context, e->triangles, e->triangle_capacity, sizeof *e->triangles);
}

static int reserve_scratch(emitter *e, const gnoi_poly *poly)
{
    gno_context *context = e->scene->context;
    void *vertex = e->vertex, *normal = e->normal, *texcoord = e->texcoord, *ring = e->ring, *triangles = e->triangles;
    int good = gnoi_reserve(context, &vertex, &e->vertex_capacity, poly->corner_count, sizeof *e->vertex) &&
               gnoi_reserve(context, &normal, &e->normal_capacity, poly->corner_count, sizeof *e->normal) &&
               gnoi_reserve(context, &texcoord, &e->texcoord_capacity, poly->corner_count, sizeof *e->texcoord) &&
               gnoi_reserve(context, &ring, &e->ring_capacity, (size_t)poly->ring_count + 1, sizeof *e->ring) &&
               gnoi_reserve(context, &triangles, &e->triangle_capacity, gnoi_triangles_of(poly), sizeof *e->triangles);
    e->vertex = vertex;
    e->normal = normal;
    e->texcoord = texcoord;
    e->ring = ring;
    e->triangles = triangles;
    return good;
}

static void emit_corner(gnoi_prepared *out, uint32_t vertex, uint32_t normal, uint32_t texcoord)
{
    out->corner_vertex[out->corner_count] = vertex;
    if (out->corner_normal) {
        out->corner_normal[out->corner_count] = normal;
    }
    if (out->corner_texcoord) {
        out->corner_texcoord[out->corner_count] = texcoord;
    }
    out->corner_count++;
}

/* Begins a polygon at the present ends of the ring and corner arrays. */
static void place(const gnoi_prepared *out, gnoi_poly *poly)
{
    poly->ring = (uint32_t)out->ring_count;
    poly->corner = (uint32_t)out->corner_count;
}

static void emit_kept(emitter *e, gnoi_poly poly)
{
    const gno_scene *s = e->scene;
    gnoi_prepared *out = e->out;
    size_t ring, corner;
    place(out, &poly);
    for (ring = s->polygon_start[poly.source]; ring < s->polygon_start[poly.source + 1]; ring++) {
        size_t from = s->ring_start[ring], to = s->ring_start[ring + 1];
        if (to - from < 3) {
            continue;
        }
        out->ring_corner[out->ring_count++] = (uint32_t)out->corner_count;
        for (corner = from; corner < to; corner++) {
            emit_corner(out, (uint32_t)s->corner_vertex[corner], (uint32_t)s->corner_normal[corner],
                        (uint32_t)s->corner_texcoord[corner]);
        }
    }
    out->polys[out->poly_count++] = poly;
}

/* The rings of three corners or more, as arrays that gnoi_triangulate takes. */
static void gather(emitter *e, const gnoi_poly *poly)
{
    const gno_scene *s = e->scene;
    uint32_t rings = 0, corners = 0;
    size_t ring, corner;
    for (ring = s->polygon_start[poly->source]; ring < s->polygon_start[poly->source + 1]; ring++) {
        size_t from = s->ring_start[ring], to = s->ring_start[ring + 1];
        if (to - from < 3) {
            continue;
        }
        e->ring[rings++] = corners;
        for (corner = from; corner < to; corner++) {
            e->vertex[corners] = (uint32_t)s->corner_vertex[corner];
            e->normal[corners] = (uint32_t)s->corner_normal[corner];
            e->texcoord[corners++] = (uint32_t)s->corner_texcoord[corner];
        }
    }
    e->ring[rings] = corners;
}

static gno_status emit_split(emitter *e, gnoi_poly poly)
{
    const double(*positions)[3] = (const double(*)[3])e->scene->positions;
    gnoi_prepared *out = e->out;
    size_t count = gnoi_triangles_of(&poly), i;
    if (!reserve_scratch(e, &poly)) {
        return GNO_ERROR_MEMORY;
    }
    gather(e, &poly);
    if (gnoi_triangulate(e->scene->context, positions, e->vertex, e->ring, poly.ring_count, poly.n, e->triangles) != GNO_OK) {
        return GNO_ERROR_MEMORY;
    }
    poly.ring_count = 1;
    poly.corner_count = 3;
    for (i = 0; i < count; i++) {
        const uint32_t *t = e->triangles[i];
        uint32_t vertex[3];
        int k;
        for (k = 0; k < 3; k++) {
            vertex[k] = e->vertex[t[k]];
        }
        if (gnoi_measure_triangle(positions, vertex, &poly)) {
            place(out, &poly);
            out->ring_corner[out->ring_count++] = (uint32_t)out->corner_count;
            for (k = 0; k < 3; k++) {
                emit_corner(out, vertex[k], e->normal[t[k]], e->texcoord[t[k]]);
            }
            out->polys[out->poly_count++] = poly;
        }
    }
    return GNO_OK;
}

/* Room for the worst case. Polygons without area count as one, which keeps the pass over the records (which lie at the
 * end of the array that it fills from the beginning) from overtaking itself. */
static gno_status make_room(gno_scene *scene, const unsigned char *kinds, int smooth)
{
    gnoi_prepared *out = &scene->prepared;
    size_t polys = 0, rings = 0, corners = 0, p;
    gnoi_poly *grown;
    for (p = 0; p < scene->polygon_count; p++) {
        if (kinds[p] == GNOI_SPLIT) {
            size_t triangles = gnoi_triangles_of(&out->polys[p]);
            polys += triangles;
            rings += triangles;
            corners += 3 * triangles;
        } else {
            polys++;
            rings += kinds[p] == GNOI_KEPT ? out->polys[p].ring_count : 0;
            corners += kinds[p] == GNOI_KEPT ? out->polys[p].corner_count : 0;
        }
    }
    if (polys > out->poly_capacity) {
        grown = gnoi_realloc(scene->context, out->polys, out->poly_capacity, polys, sizeof *out->polys);
        if (!grown) {
            return out_of_memory(scene);
        }
        out->polys = grown;
        out->poly_capacity = polys;
    }
    return allocate(scene, rings, corners, smooth);
}

static gno_status emit_all(gno_scene *scene, const unsigned char *kinds, int smooth)
{
    gnoi_prepared *out = &scene->prepared;
    gno_status status = make_room(scene, kinds, smooth);
    size_t p, offset;
    emitter e;
    if (status != GNO_OK) {
        return status;
    }
    memset(&e, 0, sizeof e);
    e.scene = scene;
    e.out = out;
    offset = out->poly_capacity - scene->polygon_count;
    memmove(out->polys + offset, out->polys, scene->polygon_count * sizeof *out->polys);
    for (p = 0; p < scene->polygon_count && status == GNO_OK; p++) {
        gnoi_poly poly = out->polys[offset + p]; /* a copy, for its place may be written next */
        if (kinds[p] == GNOI_KEPT) {
            emit_kept(&e, poly);
        } else if (kinds[p] == GNOI_SPLIT) {
            status = emit_split(&e, poly);
        }
        if (gnoi_stopped_at(scene->context, p)) {
            status = GNO_ERROR_CANCELLED;
        }
    }
    out->ring_corner[out->ring_count] = (uint32_t)out->corner_count;
    free_scratch(&e);
    return status == GNO_OK ? GNO_OK : out_of_memory(scene);
}

/* ---- triangulations of smooth and mapped polygons --------------------------------------------------------------------------- */

static gno_status triangulate_chunk(void *user, int worker, size_t piece)
{
    const gno_scene *scene = user;
    const gnoi_prepared *out = &scene->prepared;
    const double(*positions)[3] = (const double(*)[3])scene->positions;
    size_t i = piece * CHUNK, end = i + CHUNK;
    gno_status status = GNO_OK;
    (void)worker;
    end = end < out->poly_count ? end : out->poly_count;
    for (; i < end && status == GNO_OK; i++) {
        const gnoi_poly *poly = &out->polys[i];
        if (poly->triangle != GNOI_NONE) {
            status = gnoi_triangulate(scene->context, positions, out->corner_vertex, out->ring_corner + poly->ring,
                                      poly->ring_count, poly->n, out->triangles + poly->triangle);
        }
        if (gnoi_stopped_at(scene->context, i)) {
            status = GNO_ERROR_CANCELLED;
        }
    }
    return status;
}

static gno_status triangulate_some(gno_scene *scene, int threads)
{
    gnoi_prepared *out = &scene->prepared;
    size_t count = 0, i;
    for (i = 0; i < out->poly_count; i++) {
        gnoi_poly *poly = &out->polys[i];
        int mapped = out->corner_texcoord && gnoi_is_mapped(&scene->materials[poly->material]);
        if ((gnoi_is_smooth(poly) || mapped) && poly->corner_count > 3) {
            poly->triangle = (uint32_t)count;
            count += gnoi_triangles_of(poly);
            if (count >= GNOI_NONE) {
                return gnoi_fail(scene->context, GNO_ERROR_LIMIT, "prepare: more than %u triangles", GNOI_NONE);
            }
        }
    }
    if (count == 0) {
        return GNO_OK;
    }
    out->triangles = gnoi_malloc(scene->context, count, sizeof *out->triangles);
    if (!out->triangles) {
        return out_of_memory(scene);
    }
    out->triangle_count = out->triangle_capacity = count;
    return gnoi_parallel(scene->context, threads, (out->poly_count + CHUNK - 1) / CHUNK, "prepare", triangulate_chunk, scene);
}

/* ---- the whole --------------------------------------------------------------------------------------------------- */

static gno_status fill_prepared(gno_scene *scene, int threads, unsigned char *kinds)
{
    gnoi_prepared *out = &scene->prepared;
    gnoi_measures measures;
    gno_status status = gnoi_measure_scene(scene, threads, out->polys, kinds, &measures);
    if (status == GNO_OK) {
        int good = measures.empty == 0 && measures.split == 0 && measures.dropped == 0;
        status = good ? copy_all(scene, measures.smooth) : emit_all(scene, kinds, measures.smooth);
    }
    if (status == GNO_OK && (measures.smooth || out->corner_texcoord)) {
        status = triangulate_some(scene, threads);
    }
    if (status == GNO_OK && measures.smooth) {
        status = gnoi_prepare_normals(scene);
    }
    out->problems.degenerate = measures.empty;
    out->problems.non_planar = measures.split;
    if (status == GNO_OK && gnoi_prepare_details(scene) != GNO_OK) {
        status = out_of_memory(scene);
    }
    if (status == GNO_OK && gnoi_order_polygons(scene) != GNO_OK) {
        status = out_of_memory(scene);
    }
    return status;
}

static void warn(gno_scene *scene)
{
    const gno_scene_problems *problems = &scene->prepared.problems;
    if (problems->degenerate > 0) {
        gnoi_warn(scene->context, "%zu of %zu polygons have no area and are skipped", problems->degenerate, scene->polygon_count);
    }
    if (problems->non_planar > 0) {
        gnoi_warn(scene->context, "%zu of %zu polygons are not planar and are split into triangles", problems->non_planar,
                  scene->polygon_count);
    }
}

gno_status gnoi_scene_prepare(gno_scene *scene, int threads)
{
    gnoi_prepared *out = &scene->prepared;
    unsigned char *kinds;
    gno_status status;
    if (out->valid) {
        return GNO_OK;
    }
    gnoi_prepared_free(scene->context, out);
    kinds = gnoi_malloc(scene->context, scene->polygon_count, 1);
    out->polys = gnoi_malloc(scene->context, scene->polygon_count, sizeof *out->polys);
    out->poly_capacity = scene->polygon_count;
    status = kinds && out->polys ? fill_prepared(scene, threads, kinds) : out_of_memory(scene);
    gnoi_free(scene->context, kinds, scene->polygon_count, 1);
    if (status != GNO_OK) {
        gnoi_prepared_free(scene->context, out);
        return status;
    }
    out->valid = 1;
    warn(scene);
    return GNO_OK;
}

gno_status gno_scene_prepare(gno_scene *scene, int threads, gno_scene_problems *problems)
{
    gno_status status;
    if (!scene) {
        return GNO_ERROR_ARGUMENT;
    }
    if (threads < 0 || threads > GNO_MAX_THREADS) {
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_scene_prepare: %d threads is not in [0, %d]", threads,
                         GNO_MAX_THREADS);
    }
    gnoi_begin(scene->context, "prepare");
    status = gnoi_scene_prepare(scene, threads);
    if (problems && status == GNO_OK) {
        *problems = scene->prepared.problems;
    }
    return status;
}
