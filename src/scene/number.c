/* number.c -- prepared vertices and normals, numbered in the order in which corners use them first.
 *
 * Place in the data flow: emit.c (corners name the scene's vertices and normals), weld.c -> here -> emit.c, normals.c.
 * The order of first use keeps together in memory what neighbouring polygons need, and gives chunks of polygons vertices of their own:
 * those first used in a chunk have numbers from chunk_vertex of it to that of the next, so that passes over chunks may write to them
 * at the same time as long as polygons that share vertices with an earlier chunk (prepared.seams) are left for later.
 * Vertices at one place become one, so that edges that meet do so by number too. Numbering goes corner by corner; that of vertices and
 * that of normals are independent and run side by side.
 */
#include "base/parallel.h"
#include "scene/prepare.h"
#include "scene/weld.h"

#include <string.h>

#define PIECE 16384 /* vertices */

typedef struct numbering {
    gnoi_preparing *w;
    uint32_t *same;           /* of scene vertices: the first one at the place */
    uint32_t *vertex_source;  /* of prepared vertices: the scene vertex first used */
    uint32_t *normal_number;  /* of scene normals, or GNOI_NONE, GNOI_ZERO_NORMAL */
} numbering;

static gno_status number_vertices(numbering *n)
{
    gnoi_preparing *w = n->w;
    gnoi_prepared *out = w->out;
    uint32_t *number = w->vertex_number, count = 0;
    memset(number, 0xff, w->scene->vertex_count * sizeof *number); /* GNOI_NONE */
    for (size_t k = 0; k < w->chunk_count; k++) {
        out->chunk_vertex[k] = count;
        for (size_t i = w->chunks[k].corner; i < w->chunks[k + 1].corner; i++) {
            uint32_t old = out->corner_vertex[i];
            if (number[old] == GNOI_NONE) {
                uint32_t first = n->same[old];
                if (number[first] == GNOI_NONE) {
                    n->vertex_source[count] = old;
                    number[first] = count++;
                }
                number[old] = number[first];
            }
            out->corner_vertex[i] = number[old];
        }
        if (gnoi_stopped(w->scene->context))
            return GNO_ERROR_CANCELLED;
    }
    out->chunk_vertex[w->chunk_count] = count;
    out->vertex_count = count;
    return GNO_OK;
}

static uint32_t first_use(const gno_scene *scene, uint32_t normal, uint32_t *count)
{
    const double *n = scene->normals[normal];
    return n[0] != 0 || n[1] != 0 || n[2] != 0 ? (*count)++ : GNOI_ZERO_NORMAL;
}

static gno_status number_normals(numbering *n)
{
    gnoi_preparing *w = n->w;
    gnoi_prepared *out = w->out;
    uint32_t *number = n->normal_number, count = 0;
    int zero = 0;
    memset(number, 0xff, w->scene->normal_count * sizeof *number); /* GNOI_NONE */
    for (size_t k = 0; k < w->chunk_count; k++) {
        for (size_t i = w->chunks[k].corner; i < w->chunks[k + 1].corner; i++) {
            uint32_t old = out->corner_normal[i];
            if (old == GNOI_NONE)
                continue;
            if (number[old] == GNOI_NONE) {
                w->normal_source[count] = old;
                number[old] = first_use(w->scene, old, &count);
            }
            out->corner_normal[i] = number[old];
            zero |= number[old] == GNOI_ZERO_NORMAL;
        }
        if (gnoi_stopped(w->scene->context))
            return GNO_ERROR_CANCELLED;
    }
    out->normal_count = count;
    w->zero_normals = zero;
    return GNO_OK;
}

static gno_status number_piece(void *user, int worker, size_t piece)
{
    (void)worker;
    return piece == 0 ? number_vertices(user) : number_normals(user);
}

static gno_status copy_piece(void *user, int worker, size_t piece)
{
    const numbering *n = user;
    const gnoi_preparing *w = n->w;
    const gno_scene *scene = w->scene;
    size_t end = (piece + 1) * PIECE;
    (void)worker;
    for (size_t v = piece * PIECE; v < end && v < w->out->vertex_count; v++)
        memcpy(w->out->positions[v], scene->positions[n->vertex_source[v]], sizeof w->out->positions[v]);
    return GNO_OK;
}

static gno_status number_corners(numbering *n)
{
    gnoi_preparing *w = n->w;
    gnoi_prepared *out = w->out;
    gno_context *context = w->scene->context;
    gno_status status;
    int normals = out->corner_normal && w->scene->normal_count > 0;
    if (!n->same || !n->vertex_source || !n->normal_number || !w->vertex_number || !w->normal_source || !out->chunk_vertex)
        return GNO_ERROR_MEMORY;
    status = gnoi_weld(context, w->threads, w->scene->vertex_count, (const double(*)[3])w->scene->positions, n->same);
    if (status == GNO_OK)
        status = gnoi_parallel(context, w->threads, normals ? 2 : 1, "prepare", number_piece, n);
    if (status != GNO_OK)
        return status;
    for (size_t v = 0; v < w->scene->vertex_count; v++)
        w->vertex_number[v] = w->vertex_number[n->same[v]]; /* also of those that no corner uses */
    out->positions = gnoi_malloc(context, out->vertex_count, sizeof *out->positions);
    out->vertex_capacity = out->vertex_count;
    if (!out->positions)
        return GNO_ERROR_MEMORY;
    return gnoi_parallel(context, w->threads, (out->vertex_count + PIECE - 1) / PIECE, "prepare", copy_piece, n);
}

gno_status gnoi_number_corners(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    const size_t vertices = w->scene->vertex_count, normals = w->out->corner_normal ? w->scene->normal_count : 0;
    numbering n = {w, NULL, NULL, NULL};
    gno_status status;
    n.same = gnoi_malloc(context, vertices, sizeof *n.same);
    n.vertex_source = gnoi_malloc(context, vertices, sizeof *n.vertex_source);
    n.normal_number = gnoi_malloc(context, normals, sizeof *n.normal_number);
    w->vertex_number = gnoi_malloc(context, vertices, sizeof *w->vertex_number);
    w->normal_source = gnoi_malloc(context, normals, sizeof *w->normal_source);
    w->normal_source_count = normals;
    w->out->chunk_vertex = gnoi_malloc(context, w->chunk_count + 1, sizeof *w->out->chunk_vertex);
    w->out->chunk_count = w->chunk_count;
    status = number_corners(&n);
    gnoi_free(context, n.same, vertices, sizeof *n.same);
    gnoi_free(context, n.vertex_source, vertices, sizeof *n.vertex_source);
    gnoi_free(context, n.normal_number, normals, sizeof *n.normal_number);
    return status;
}
