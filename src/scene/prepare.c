/* prepare.c -- makes the prepared polygons of a scene: the steps of prepare.h one after the other.
 *
 * Place in the data flow: gno_scene -> here -> gnoi_prepared, read by all passes.
 * Invariant: what comes out does not depend on the number of threads.
 */
#include "scene/prepare.h"
#include "scene/weld.h"

#include <string.h>

void gnoi_prepared_free(gno_context *context, gnoi_prepared *prepared)
{
    gnoi_free(context, prepared->polys, prepared->poly_capacity, sizeof *prepared->polys);
    gnoi_free(context, prepared->ring_corner, prepared->ring_capacity, sizeof *prepared->ring_corner);
    gnoi_free(context, prepared->corner_vertex, prepared->corner_vertex_capacity, sizeof *prepared->corner_vertex);
    gnoi_free(context, prepared->corner_normal, prepared->corner_capacity, sizeof *prepared->corner_normal);
    gnoi_free(context, prepared->corner_texcoord, prepared->corner_capacity, sizeof *prepared->corner_texcoord);
    gnoi_free(context, prepared->solids, prepared->solid_count, sizeof *prepared->solids);
    gnoi_free(context, prepared->vertex_solid, prepared->vertex_capacity, sizeof *prepared->vertex_solid);
    gnoi_free(context, prepared->positions, prepared->vertex_capacity, sizeof *prepared->positions);
    gnoi_free(context, prepared->chunk_vertex, prepared->chunk_count + 1, sizeof *prepared->chunk_vertex);
    gnoi_free(context, prepared->chunk_corner, prepared->chunk_count + 1, sizeof *prepared->chunk_corner);
    gnoi_free(context, prepared->chunk_opaque, prepared->chunk_count + 1, 1);
    gnoi_free(context, prepared->seams, prepared->seam_capacity, sizeof *prepared->seams);
    gnoi_free(context, prepared->joints, prepared->joint_capacity, sizeof *prepared->joints);
    gnoi_free(context, prepared->normals, prepared->normal_capacity, sizeof *prepared->normals);
    gnoi_free(context, prepared->triangles, prepared->triangle_capacity, sizeof *prepared->triangles);
    memset(prepared, 0, sizeof *prepared);
}

static void free_work(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    gnoi_free(context, w->kinds, w->scene->polygon_count, 1);
    gnoi_free(context, w->blocks, gnoi_block_count(w->scene), sizeof *w->blocks);
    gnoi_splits_free(context, &w->splits);
    gnoi_free(context, w->order, w->item_count, sizeof *w->order);
    gnoi_free(context, w->chunks, w->chunk_count + 1, sizeof *w->chunks);
    gnoi_free(context, w->same, w->scene->vertex_count, sizeof *w->same);
    gnoi_free(context, w->vertex_number, w->scene->vertex_count, sizeof *w->vertex_number);
    gnoi_free(context, w->normal_source, w->normal_source_count, sizeof *w->normal_source);
}

static gno_status weld(gnoi_preparing *w)
{
    gno_scene *scene = w->scene;
    w->same = gnoi_malloc(scene->context, scene->vertex_count, sizeof *w->same);
    if (!w->same)
        return GNO_ERROR_MEMORY;
    return gnoi_weld(scene->context, w->threads, scene->vertex_count, (const double(*)[3])scene->positions, w->same);
}

static gno_status gather_polygons(gnoi_preparing *w)
{
    gno_status status = gnoi_measure_scene(w->scene, w->threads, w->kinds, w->blocks, &w->measures);
    w->out->problems.degenerate = w->measures.empty;
    w->out->problems.non_planar = w->measures.split;
    if (status == GNO_OK)
        status = gnoi_split_bent(w);
    if (status == GNO_OK)
        status = gnoi_order_items(w);
    if (status == GNO_OK)
        status = weld(w);
    if (status == GNO_OK)
        status = gnoi_emit_corners(w);
    if (status == GNO_OK)
        status = gnoi_number_corners(w);
    return status == GNO_OK ? gnoi_emit_polygons(w) : status;
}

static gno_status prepare(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    gno_status status = GNO_ERROR_MEMORY;
    w->kinds = gnoi_malloc(context, w->scene->polygon_count, 1);
    w->blocks = gnoi_malloc(context, gnoi_block_count(w->scene), sizeof *w->blocks);
    if (w->kinds && w->blocks)
        status = gather_polygons(w);
    if (status == GNO_OK && w->measures.smooth)
        status = gnoi_prepare_normals(w);
    if (status == GNO_OK)
        status = gnoi_prepare_details(w->scene);
    return status == GNO_OK ? gnoi_find_solids(w) : status;
}

static void warn(gno_scene *scene)
{
    const gno_scene_problems *problems = &scene->prepared.problems;
    if (problems->degenerate > 0)
        gnoi_warn(scene->context, "%zu of %zu polygons have no area and are skipped", problems->degenerate, scene->polygon_count);
    if (problems->non_planar > 0)
        gnoi_warn(scene->context, "%zu of %zu polygons are not planar and are split into triangles", problems->non_planar,
                  scene->polygon_count);
}

gno_status gnoi_scene_prepare(gno_scene *scene, int threads)
{
    gnoi_preparing w;
    gno_status status;
    if (scene->prepared.valid)
        return GNO_OK;
    gnoi_prepared_free(scene->context, &scene->prepared);
    memset(&w, 0, sizeof w);
    w.scene = scene;
    w.out = &scene->prepared;
    w.threads = threads;
    status = prepare(&w);
    free_work(&w);
    if (status != GNO_OK) {
        gnoi_prepared_free(scene->context, &scene->prepared);
        return status == GNO_ERROR_LIMIT ? status : gnoi_fail(scene->context, status, "prepare: %s", gno_status_text(status));
    }
    scene->prepared.valid = 1;
    warn(scene);
    return GNO_OK;
}

gno_status gno_scene_prepare(gno_scene *scene, int threads, gno_scene_problems *problems)
{
    gno_status status;
    if (!scene)
        return GNO_ERROR_ARGUMENT;
    if (threads < 0 || threads > GNO_MAX_THREADS)
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_scene_prepare: %d threads is not in [0, %d]", threads, GNO_MAX_THREADS);
    gnoi_begin(scene->context, "prepare");
    status = gnoi_scene_prepare(scene, threads);
    if (problems && status == GNO_OK)
        *problems = scene->prepared.problems;
    return status;
}
