/* split.c -- the triangles of polygons that are not planar.
 *
 * Place in the data flow: measure.c -> here -> order.c, which orders these triangles among the polygons that are kept.
 * A polygon's triangles have places in one array before any is made, so that pieces of the work share nothing.
 * Invariants: triangles come by rising source; every triangle names scene corners of its source, in the turn of its outer ring.
 */
#include "base/parallel.h"
#include "scene/prepare.h"

#include <string.h>

#define PIECE 256 /* polygons */

/* A polygon to be split, and its first triangle. */
typedef struct bent {
    uint32_t source, first;
} bent;

typedef struct splitting {
    const gno_scene *scene;
    gnoi_splits *splits;
    bent *bents; /* count + 1 */
    size_t count;
} splitting;

/* One polygon as gnoi_triangulate takes it. */
typedef struct gathered {
    size_t corners, rings;
    uint32_t *corner, *vertex, *ring;
    uint32_t (*triangles)[3];
} gathered;

static int is_ring(const gno_scene *s, unsigned ring) { return s->ring_start[ring + 1] - s->ring_start[ring] >= 3; }

/* Corners and rings of those rings that have three corners or more. */
static void count_rings(const gno_scene *s, size_t source, size_t *corners, size_t *rings)
{
    *corners = *rings = 0;
    for (unsigned ring = s->polygon_start[source]; ring < s->polygon_start[source + 1]; ring++)
        if (is_ring(s, ring)) {
            *corners += s->ring_start[ring + 1] - s->ring_start[ring];
            ++*rings;
        }
}

static int gather(const gno_scene *s, size_t source, gathered *g)
{
    uint32_t corners = 0, rings = 0;
    count_rings(s, source, &g->corners, &g->rings);
    g->corner = gnoi_malloc(s->context, g->corners, sizeof *g->corner);
    g->vertex = gnoi_malloc(s->context, g->corners, sizeof *g->vertex);
    g->ring = gnoi_malloc(s->context, g->rings + 1, sizeof *g->ring);
    g->triangles = gnoi_malloc(s->context, gnoi_triangle_count(g->corners, g->rings), sizeof *g->triangles);
    if (!g->corner || !g->vertex || !g->ring || !g->triangles)
        return 0;
    for (unsigned ring = s->polygon_start[source]; ring < s->polygon_start[source + 1]; ring++) {
        if (!is_ring(s, ring))
            continue;
        g->ring[rings++] = corners;
        for (unsigned corner = s->ring_start[ring]; corner < s->ring_start[ring + 1]; corner++) {
            g->vertex[corners] = (uint32_t)s->corner_vertex[corner];
            g->corner[corners++] = corner;
        }
    }
    g->ring[rings] = corners;
    return 1;
}

static void gathered_free(gno_context *context, gathered *g)
{
    gnoi_free(context, g->corner, g->corners, sizeof *g->corner);
    gnoi_free(context, g->vertex, g->corners, sizeof *g->vertex);
    gnoi_free(context, g->ring, g->rings + 1, sizeof *g->ring);
    gnoi_free(context, g->triangles, gnoi_triangle_count(g->corners, g->rings), sizeof *g->triangles);
}

static gno_status split(const splitting *w, const bent *b)
{
    const gno_scene *s = w->scene;
    const double(*positions)[3] = (const double(*)[3])s->positions;
    gnoi_splits *out = w->splits;
    gno_status status = GNO_ERROR_MEMORY;
    gnoi_poly plane;
    gathered g = {0};
    if (gather(s, b->source, &g) && gnoi_measure_ring(positions, g.vertex, g.ring[1], &plane))
        status = gnoi_triangulate(s->context, positions, g.vertex, g.ring, (uint32_t)g.rings, plane.n, g.triangles);
    for (size_t t = b->first; t < b[1].first && !status; t++) {
        const uint32_t *local = g.triangles[t - b->first];
        uint32_t vertex[3];
        for (int k = 0; k < 3; k++) {
            out->corner[t][k] = g.corner[local[k]];
            vertex[k] = g.vertex[local[k]];
        }
        out->source[t] = b->source;
        out->has_area[t] = (unsigned char)gnoi_measure_triangle(positions, vertex, &plane);
    }
    gathered_free(s->context, &g);
    return status;
}

static gno_status split_piece(void *user, int worker, size_t piece)
{
    const splitting *w = user;
    size_t end = (piece + 1) * PIECE < w->count ? (piece + 1) * PIECE : w->count;
    gno_status status = GNO_OK;
    (void)worker;
    for (size_t i = piece * PIECE; i < end && !status; i++)
        status = gnoi_stopped(w->scene->context) ? GNO_ERROR_CANCELLED : split(w, &w->bents[i]);
    return status;
}

/* Lists the bent polygons; 0 when their triangles are too many to be counted in 32 bits beside the polygons. */
static int list_bent(const gnoi_preparing *w, splitting *s)
{
    size_t triangles = 0, corners, rings;
    for (size_t p = 0; p < w->scene->polygon_count; p++)
        if (gnoi_kind_of(w, p) == GNOI_SPLIT) {
            s->bents[s->count].source = (uint32_t)p;
            s->bents[s->count++].first = (uint32_t)triangles;
            count_rings(w->scene, p, &corners, &rings);
            triangles += gnoi_triangle_count(corners, rings);
            if (triangles >= GNOI_NONE - w->scene->polygon_count)
                return 0;
        }
    s->bents[s->count].first = (uint32_t)triangles;
    s->splits->count = triangles;
    return 1;
}

static gno_status split_all(gnoi_preparing *w, splitting *s)
{
    gno_context *context = w->scene->context;
    gnoi_splits *out = s->splits;
    if (!s->bents)
        return GNO_ERROR_MEMORY;
    if (!list_bent(w, s))
        return gnoi_fail(context, GNO_ERROR_LIMIT, "prepare: more than %u polygons once split into triangles", GNOI_NONE);
    out->corner = gnoi_malloc(context, out->count, sizeof *out->corner);
    out->source = gnoi_malloc(context, out->count, sizeof *out->source);
    out->has_area = gnoi_malloc(context, out->count, 1);
    if (!out->corner || !out->source || !out->has_area)
        return GNO_ERROR_MEMORY;
    return gnoi_parallel(context, w->threads, (s->count + PIECE - 1) / PIECE, "prepare", split_piece, s);
}

gno_status gnoi_split_bent(gnoi_preparing *w)
{
    splitting s = {w->scene, &w->splits, NULL, 0};
    gno_status status = GNO_OK;
    if (w->measures.split > 0) {
        s.bents = gnoi_malloc(w->scene->context, w->measures.split + 1, sizeof *s.bents);
        status = split_all(w, &s);
        gnoi_free(w->scene->context, s.bents, w->measures.split + 1, sizeof *s.bents);
    }
    return status;
}

void gnoi_splits_free(gno_context *context, gnoi_splits *splits)
{
    gnoi_free(context, splits->corner, splits->count, sizeof *splits->corner);
    gnoi_free(context, splits->source, splits->count, sizeof *splits->source);
    gnoi_free(context, splits->has_area, splits->count, 1);
    memset(splits, 0, sizeof *splits);
}
