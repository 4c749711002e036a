/* emit.c -- the prepared polygons, in the order of order.c.
 *
 * Place in the data flow: order.c, weld.c -> rings and corners, which still name the scene's vertices and normals -> number.c -> records: planes
 * from positions that now lie in the order in which they are asked for, triangulations -> normals.c.
 * Chunks of polygons are counted, which gives each chunk its place in every array, and then filled side by side.
 * Invariants: every prepared ring has three corners or more; a polygon's rings and corners follow those of the one before.
 */
#include "base/fetch.h"
#include "base/pages.h"
#include "base/parallel.h"
#include "scene/prepare.h"

#include <string.h>

#define AHEAD 16 /* polygons */
#define BLOCK 64 /* polygons whose records stay in the cache until they are done */

/* Where a chunk stands in the arrays that it fills. */
typedef struct place {
    size_t ring, corner, triangle;
} place;

static size_t chunk_end(const gnoi_preparing *w, size_t chunk)
{
    return (chunk + 1) * GNOI_CHUNK < w->item_count ? (chunk + 1) * GNOI_CHUNK : w->item_count;
}

static place start_of(const gnoi_chunk *chunk)
{
    place at = {chunk->ring, chunk->corner, chunk->triangle};
    return at;
}

/* 1 for a polygon of the scene, 0 for a triangle of one that was split; *number is that of either. */
static int is_polygon(const gnoi_preparing *w, size_t i, size_t *number)
{
    size_t item = w->order[i], polygons = w->scene->polygon_count;
    *number = item < polygons ? item : item - polygons;
    return item < polygons;
}

static size_t source_of(const gnoi_preparing *w, size_t i)
{
    size_t number;
    return is_polygon(w, i, &number) ? number : w->splits.source[number];
}

/* ---- counting ------------------------------------------------------------------------------------------------------ */

static void count_rings(const gnoi_preparing *w, size_t i, size_t *rings, size_t *corners)
{
    const gno_scene *s = w->scene;
    size_t p;
    *rings = 1;
    *corners = 3;
    if (!is_polygon(w, i, &p) || (w->kinds[p] & GNOI_IS_TRIANGLE))
        return;
    *rings = *corners = 0;
    for (unsigned ring = s->polygon_start[p]; ring < s->polygon_start[p + 1]; ring++) {
        size_t count = s->ring_start[ring + 1] - s->ring_start[ring];
        *rings += count >= 3;
        *corners += count >= 3 ? count : 0;
    }
}

/* Triangles kept for a polygon: smooth and mapped ones of more than three corners are interpolated over a triangulation. */
static size_t kept_triangles(const gnoi_preparing *w, size_t i, size_t rings, size_t corners)
{
    size_t source;
    int mapped;
    if (corners <= 3)
        return 0;
    source = source_of(w, i);
    mapped = w->mapped && gnoi_is_mapped(&w->scene->materials[w->scene->polygon_material[source]]);
    return mapped || (w->kinds[source] & GNOI_IS_SMOOTH) ? gnoi_triangle_count(corners, rings) : 0;
}

static gno_status count_chunk(void *user, int worker, size_t chunk)
{
    const gnoi_preparing *w = user;
    gnoi_chunk sum = {0};
    (void)worker;
    for (size_t i = chunk * GNOI_CHUNK, end = chunk_end(w, chunk); i < end; i++) {
        size_t rings, corners;
        count_rings(w, i, &rings, &corners);
        sum.ring += rings;
        sum.corner += corners;
        sum.triangle += kept_triangles(w, i, rings, corners);
    }
    w->chunks[chunk] = sum;
    return GNO_OK;
}

/* Counts become what is before each chunk. */
static void sum_chunks(const gnoi_preparing *w)
{
    gnoi_chunk sum = {0};
    for (size_t k = 0; k <= w->chunk_count; k++) {
        gnoi_chunk count = w->chunks[k];
        w->chunks[k] = sum;
        sum.ring += count.ring;
        sum.corner += count.corner;
        sum.triangle += count.triangle;
    }
}

/* ---- corners -------------------------------------------------------------------------------------------------------- */

/* Copies scene corners [from,to) to prepared corner `at` and on. Returns whether one of them is to have a normal and has none. */
static int emit_corners(const gnoi_preparing *w, size_t from, size_t to, size_t at, unsigned kind)
{
    const gno_scene *s = w->scene;
    const gnoi_prepared *out = w->out;
    int open = 0;
    for (size_t i = from; i < to; i++)
        out->corner_vertex[at + i - from] = w->same[s->corner_vertex[i]];
    if (out->corner_normal)
        for (size_t i = from; i < to; i++) {
            uint32_t normal = kind & GNOI_USES_NORMALS ? (uint32_t)s->corner_normal[i] : GNOI_NONE;
            out->corner_normal[at + i - from] = normal;
            open |= normal == GNOI_NONE;
        }
    if (out->corner_texcoord)
        for (size_t i = from; i < to; i++)
            out->corner_texcoord[at + i - from] = (uint32_t)s->corner_texcoord[i];
    return open && (kind & GNOI_IS_SMOOTH);
}

static int emit_rings(const gnoi_preparing *w, size_t p, place *at)
{
    const gno_scene *s = w->scene;
    int open = 0;
    for (unsigned ring = s->polygon_start[p], last = s->polygon_start[p + 1]; ring < last; ring++) {
        unsigned from = s->ring_start[ring], to = s->ring_start[ring + 1];
        if (to - from < 3)
            continue;
        w->out->ring_corner[at->ring++] = (uint32_t)at->corner;
        open |= emit_corners(w, from, to, at->corner, w->kinds[p]);
        at->corner += to - from;
    }
    return open;
}

/* The first corner of a polygon of one ring. */
static size_t corner_of(const gnoi_preparing *w, size_t p)
{
    uint32_t block = w->blocks[p / GNOI_BLOCK];
    return block != GNOI_NONE ? block + 3 * (p % GNOI_BLOCK) : w->scene->ring_start[w->scene->polygon_start[p]];
}

/* emit_corners for GNOI_FOLLOWS. */
static void emit_following(const gnoi_preparing *w, size_t from, size_t at)
{
    const uint32_t *vertex = (const uint32_t *)w->scene->corner_vertex + from;
    uint32_t *to = w->out->corner_vertex + at, *normal = w->out->corner_normal + at;
    for (int k = 0; k < 3; k++) {
        normal[k] = vertex[k];
        to[k] = w->same[vertex[k]];
    }
}

static int emit_triangle(const gnoi_preparing *w, size_t p, place *at)
{
    const size_t from = corner_of(w, p);
    int open = 0;
    if ((w->kinds[p] & GNOI_FOLLOWS) && !w->out->corner_texcoord)
        emit_following(w, from, at->corner);
    else
        open = emit_corners(w, from, from + 3, at->corner, w->kinds[p]);
    w->out->ring_corner[at->ring++] = (uint32_t)at->corner;
    at->corner += 3;
    return open;
}

static int emit_split(const gnoi_preparing *w, size_t triangle, place *at)
{
    unsigned kind = w->kinds[w->splits.source[triangle]];
    int open = 0;
    w->out->ring_corner[at->ring++] = (uint32_t)at->corner;
    for (int k = 0; k < 3; k++) {
        size_t corner = w->splits.corner[triangle][k];
        open |= emit_corners(w, corner, corner + 1, at->corner++, kind);
    }
    return open;
}

/* Polygons lie anywhere in the scene's arrays: what is needed a little later is fetched in good time. */
static void fetch(const gnoi_preparing *w, size_t i)
{
    size_t number;
    if (i < w->item_count && is_polygon(w, i, &number)) {
        size_t corner = corner_of(w, number);
        FETCH(&w->scene->corner_vertex[corner]);
        if (!(w->kinds[number] & GNOI_FOLLOWS))
            FETCH(&w->scene->corner_normal[corner]);
    }
}

static gno_status corner_chunk(void *user, int worker, size_t chunk)
{
    const gnoi_preparing *w = user;
    place at = start_of(&w->chunks[chunk]);
    size_t number;
    int open = 0;
    (void)worker;
    for (size_t i = chunk * GNOI_CHUNK, end = chunk_end(w, chunk); i < end; i++) {
        fetch(w, i + AHEAD);
        if (!is_polygon(w, i, &number))
            open |= emit_split(w, number, &at);
        else if (w->kinds[number] & GNOI_IS_TRIANGLE)
            open |= emit_triangle(w, number, &at);
        else
            open |= emit_rings(w, number, &at);
    }
    w->chunks[chunk].open = open;
    return GNO_OK;
}

/* 1 when a material asks for texture coordinates and there are any. */
static int has_texcoords(const gno_scene *scene)
{
    size_t i = 0;
    while (i < scene->material_count && !gnoi_is_mapped(&scene->materials[i]))
        i++;
    return scene->texcoord_count > 0 && i < scene->material_count;
}

static gno_status allocate(const gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    gnoi_prepared *out = w->out;
    const gnoi_chunk *all = &w->chunks[w->chunk_count];
    if (all->ring >= GNOI_NONE || all->corner >= GNOI_NONE || all->triangle >= GNOI_NONE)
        return gnoi_fail(context, GNO_ERROR_LIMIT, "prepare: more than %u corners once split into triangles", GNOI_NONE);
    out->poly_count = out->poly_capacity = w->item_count;
    out->ring_count = all->ring;
    out->ring_capacity = all->ring + 1;
    out->corner_count = out->corner_capacity = out->corner_vertex_capacity = all->corner;
    out->triangle_count = out->triangle_capacity = all->triangle;
    out->ring_corner = gnoi_malloc(context, out->ring_capacity, sizeof *out->ring_corner);
    out->corner_vertex = gnoi_malloc(context, all->corner, sizeof *out->corner_vertex);
    out->corner_normal = w->measures.smooth ? gnoi_malloc(context, all->corner, sizeof *out->corner_normal) : NULL;
    out->corner_texcoord = w->mapped ? gnoi_malloc(context, all->corner, sizeof *out->corner_texcoord) : NULL;
    out->triangles = all->triangle > 0 ? gnoi_malloc(context, all->triangle, sizeof *out->triangles) : NULL;
    if (!out->ring_corner || !out->corner_vertex || (w->measures.smooth && !out->corner_normal) ||
        (w->mapped && !out->corner_texcoord) || (all->triangle > 0 && !out->triangles))
        return GNO_ERROR_MEMORY;
    out->ring_corner[all->ring] = (uint32_t)all->corner;
    return GNO_OK;
}

gno_status gnoi_emit_corners(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    gno_status status;
    w->mapped = has_texcoords(w->scene);
    w->chunk_count = (w->item_count + GNOI_CHUNK - 1) / GNOI_CHUNK;
    w->chunks = gnoi_calloc(context, w->chunk_count + 1, sizeof *w->chunks);
    if (!w->chunks)
        return GNO_ERROR_MEMORY;
    status = gnoi_parallel(context, w->threads, w->chunk_count, "prepare", count_chunk, w);
    if (status != GNO_OK)
        return status;
    sum_chunks(w);
    status = allocate(w);
    return status ? status : gnoi_parallel(context, w->threads, w->chunk_count, "prepare", corner_chunk, w);
}

/* ---- records -------------------------------------------------------------------------------------------------------- */

/* A record with what polygons of an object and a material have in common. */
typedef struct common {
    uint32_t material, object; /* GNOI_NONE: none yet */
    gnoi_poly record;
    int opaque, closes; /* of all polygons so far: what gnoi_chunk and chunk_opaque tell */
} common;

static void set_common(const gno_scene *scene, common *c)
{
    const gno_material *material = &scene->materials[c->material];
    const gnoi_object *object = &scene->objects[c->object];
    const double *t = material->transmission;
    unsigned shading = object->shading >= 0 ? (unsigned)object->shading : (unsigned)material->shading;
    memset(&c->record, 0, sizeof c->record); /* its padding too: the same scene gives the same bytes */
    c->record.triangle = GNOI_NONE;
    c->record.ring_count = 1;
    c->record.corner_count = 3;
    c->record.shading = shading & 15u;
    c->record.two_sided = material->two_sided != 0;
    c->record.opaque = t[0] == 0 && t[1] == 0 && t[2] == 0 && !gnoi_has_holes(scene, material);
    c->record.material = (uint16_t)c->material;
    c->record.priority = (int16_t)object->priority;
    c->opaque &= c->record.opaque;
    c->closes &= c->record.opaque && c->record.two_sided;
}

/* Starts the record of polygon i as one of a triangle. Objects and materials lie by the number of the source, anywhere: where there is but
 * one none is looked up. */
static void start_record(const gnoi_preparing *w, size_t i, const place *at, common *c)
{
    const gno_scene *scene = w->scene;
    const size_t source = source_of(w, i);
    const uint32_t material = scene->material_count > 1 ? (uint32_t)scene->polygon_material[source] : 0;
    const uint32_t object = scene->object_count > 1 ? (uint32_t)scene->polygon_object[source] : 0;
    gnoi_poly *poly = &w->out->polys[i];
    if (material != c->material || object != c->object) {
        c->material = material;
        c->object = object;
        set_common(scene, c);
    }
    *poly = c->record;
    poly->source = (uint32_t)source;
    poly->ring = (uint32_t)at->ring;
    poly->corner = (uint32_t)at->corner;
}

/* By the function by which the polygon was judged. */
static void set_plane(const gnoi_preparing *w, size_t i, gnoi_poly *poly)
{
    const gnoi_prepared *out = w->out;
    const double(*positions)[3] = (const double(*)[3])out->positions;
    const uint32_t *vertex = out->corner_vertex + poly->corner;
    size_t number;
    if (!is_polygon(w, i, &number) || (w->kinds[number] & GNOI_IS_TRIANGLE))
        gnoi_set_triangle(positions, vertex, poly);
    else
        gnoi_measure_ring(positions, vertex, out->ring_corner[poly->ring + 1] - poly->corner, poly);
}

static gno_status emit_polygon(const gnoi_preparing *w, size_t i, place *at, common *c)
{
    gnoi_prepared *out = w->out;
    gnoi_poly *poly = &out->polys[i];
    size_t rings, corners, triangles;
    count_rings(w, i, &rings, &corners);
    triangles = kept_triangles(w, i, rings, corners);
    start_record(w, i, at, c);
    poly->ring_count = (uint32_t)rings & 0xffffffu;
    c->closes &= rings == 1;
    poly->corner_count = (uint32_t)corners;
    poly->triangle = triangles > 0 ? (uint32_t)at->triangle : GNOI_NONE;
    set_plane(w, i, poly);
    at->ring += rings;
    at->corner += corners;
    at->triangle += triangles;
    return triangles == 0 ? GNO_OK
                          : gnoi_triangulate(w->scene->context, (const double(*)[3])out->positions, out->corner_vertex,
                                             out->ring_corner + poly->ring, poly->ring_count, poly->n, out->triangles + poly->triangle);
}

static gno_status emit_polygons(const gnoi_preparing *w, size_t first, size_t end, place *at, common *c)
{
    gno_status status = GNO_OK;
    for (size_t i = first; i < end && !status; i++) {
        status = emit_polygon(w, i, at, c);
        if (gnoi_stopped_at(w->scene->context, i))
            status = GNO_ERROR_CANCELLED;
    }
    return status;
}

/* The same for triangles alone. */
static void emit_triangles(const gnoi_preparing *w, size_t first, size_t end, place *at, common *c, gnoi_triangle_sums *sums)
{
    for (size_t i = first; i < end; i++, at->ring++, at->corner += 3)
        start_record(w, i, at, c);
    gnoi_set_triangles(w->out, first, end - first, sums);
}

static int is_seam(const gnoi_prepared *out, const gnoi_poly *poly, uint32_t own)
{
    int seam = 0;
    for (uint32_t k = poly->corner; k < poly->corner + poly->corner_count; k++)
        seam |= out->corner_vertex[k] < own;
    return seam;
}

/* Leaves the chunk's seams where its polygons are numbered in prepared.seams, GNOI_NONE behind them. */
static void list_seams(gnoi_prepared *out, size_t chunk, size_t first, size_t end)
{
    const uint32_t own = out->chunk_vertex[chunk], from = out->chunk_corner[chunk];
    const uint32_t *vertex = out->corner_vertex + from;
    size_t seam = first;
    for (size_t i = first; i < end && from == GNOI_NONE; i++)
        if (is_seam(out, &out->polys[i], own))
            out->seams[seam++] = (uint32_t)i;
    for (size_t i = first; i < end && from != GNOI_NONE; i++, vertex += 3) {
        out->seams[seam] = (uint32_t)i;
        seam += (vertex[0] < own) | (vertex[1] < own) | (vertex[2] < own);
    }
    if (seam < end)
        out->seams[seam] = GNOI_NONE;
}

static gno_status polygon_chunk(void *user, int worker, size_t chunk)
{
    const gnoi_preparing *w = user;
    gnoi_prepared *out = w->out;
    gnoi_chunk *own = &w->chunks[chunk];
    place at = start_of(own);
    common c;
    size_t first = chunk * GNOI_CHUNK, end = chunk_end(w, chunk);
    gno_status status = GNO_OK;
    (void)worker;
    c.material = c.object = GNOI_NONE;
    c.opaque = c.closes = 1;
    gnoi_pages_ready(out->polys + first, (end - first) * sizeof *out->polys);
    own->summed = out->chunk_corner[chunk] != GNOI_NONE;
    for (size_t i = first, stop; i < end && !status; i = stop) {
        stop = end - i < BLOCK ? end : i + BLOCK;
        if (own->summed)
            emit_triangles(w, i, stop, &at, &c, &own->sums);
        else
            status = emit_polygons(w, i, stop, &at, &c);
    }
    if (status == GNO_OK)
        list_seams(out, chunk, first, end);
    own->closes = c.closes;
    out->chunk_opaque[chunk] = (unsigned char)c.opaque;
    return status;
}

/* Brings the chunks' seams together. */
static void gather_seams(const gnoi_preparing *w)
{
    gnoi_prepared *out = w->out;
    uint32_t *fitting;
    out->seam_count = 0;
    for (size_t k = 0; k < w->chunk_count; k++)
        for (size_t i = k * GNOI_CHUNK, end = chunk_end(w, k); i < end && out->seams[i] != GNOI_NONE; i++)
            out->seams[out->seam_count++] = out->seams[i];
    if (out->seam_count == 0) {
        gnoi_free(w->scene->context, out->seams, w->item_count, sizeof *out->seams);
        out->seams = NULL;
        return;
    }
    fitting = gnoi_realloc(w->scene->context, out->seams, w->item_count, out->seam_count, sizeof *fitting);
    out->seams = fitting ? fitting : out->seams; /* a larger block serves as well */
    out->seam_capacity = fitting ? out->seam_count : w->item_count;
}

gno_status gnoi_emit_polygons(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    gnoi_prepared *out = w->out;
    gno_status status;
    out->polys = gnoi_malloc(context, out->poly_capacity, sizeof *out->polys);
    out->seams = gnoi_malloc(context, w->item_count, sizeof *out->seams);
    out->seam_capacity = w->item_count;
    if (!out->polys || !out->seams)
        return GNO_ERROR_MEMORY;
    status = gnoi_parallel(context, w->threads, w->chunk_count, "prepare", polygon_chunk, w);
    if (status == GNO_OK)
        gather_seams(w);
    return status;
}
