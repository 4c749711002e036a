/* visible.c -- gno_visible_pieces: what the camera sees of every polygon, split by the lights that reach it.
 *
 * Place in the data flow: scene -> prepared -> gnoi_centre of the eye, and of every light that no kept pieces stand for -> for
 * each polygon: visible parts (here), then light after light what it reaches and the rest (visible_split.c) -> gno_pieces.
 * An eye is a light here: the same code finds what both see.
 */
#include "base/parallel.h"
#include "scene/validate.h"
#include "shadow/lamp.h"
#include "shadow/visible_split.h"

#include <string.h>

#define CHUNK 32

typedef struct worker {
    gnoi_splitter split;
    size_t hidden, whole, clipped, polygons, casters;
} worker;

typedef struct job {
    gno_scene *scene;
    gno_visible_def def;
    gnoi_view view;
    gnoi_centre eye;
    size_t lamp_count;
    gnoi_lamp *lamps;
    gnoi_centre *lights; /* one for each lamp; empty where kept pieces serve */
    int worker_count;
    worker *workers;
    unsigned char *aside; /* for each lamp: it does not split */
    size_t chunk_count;
    gnoi_piece_list *chunks, *beside; /* beside: NULL when every lamp splits */
} job;

/* ---- one polygon ------------------------------------------------------------------------------------------------------------- */

static gno_status emit(const gnoi_splitter *w, const gnoi_receiver_view *r, int whole, gnoi_piece_list *list)
{
    gno_shape shape = gnoi_shape_view(&w->now.shape);
    if (whole && w->now.count == 1) {
        vec3 c = gnoi_canvas_point(&r->canvas, r->seen.x / r->seen.area, r->seen.y / r->seen.area);
        return gnoi_piece_list_add_whole(list, &r->canvas, r->true_area, c) && gnoi_split_add_lights(w, w->now.items[0].reach, list) ? GNO_OK : GNO_ERROR_MEMORY;
    }
    for (size_t i = 0; i < w->now.count; i++) {
        const gnoi_split_sheet *s = &w->now.items[i];
        for (size_t k = s->first; k < s->first + s->count; k++) {
            size_t before = list->count;
            if (!gnoi_piece_list_add(list, &r->canvas, &shape, k, r->scale) || (list->count > before && !gnoi_split_add_lights(w, s->reach, list)))
                return GNO_ERROR_MEMORY;
            if (list->count > before)
                list->pieces[before].sheet = (uint32_t)i;
        }
    }
    return GNO_OK;
}

/* Puts what the eye sees of the receiver into w->split.region; *whole: all of it. */
static gno_status see_region(const job *j, worker *w, uint32_t index, gnoi_receiver_view *r, int *whole)
{
    gnoi_parter *p = &w->split.parter;
    gnoi_cover_state found;
    gno_shape parts;
    gno_status status = gnoi_receiver_make(p, &j->eye, index, r);
    gnoi_shape_clear(&w->split.region);
    *whole = 0;
    if (status || r->outline.polygon_count == 0 || !(r->seen.area > 0))
        return status;
    w->polygons++;
    found = gnoi_cover_ask(&p->cover, &r->canvas, &r->outline, r->convex);
    if (found == GNOI_COVER_NO_MEMORY)
        return GNO_ERROR_MEMORY;
    w->hidden += found == GNOI_COVER_ALL;
    w->whole += found == GNOI_COVER_NONE;
    w->clipped += found == GNOI_COVER_PART;
    if (found == GNOI_COVER_ALL)
        return GNO_OK;
    if (found == GNOI_COVER_NONE && r->whole) {
        *whole = 1;
        return gnoi_shape_append(&w->split.region, &r->outline, 0, 1) ? GNO_OK : GNO_ERROR_MEMORY;
    }
    /* What the frame cut may touch itself along the frame: the clipper makes it valid. */
    w->casters += p->cover.casters.polygon_count;
    status = gnoi_parter_reach(p, &r->canvas, &r->outline);
    parts = gnoi_shape_view(&p->parts.shape);
    return status || gnoi_shape_append(&w->split.region, &parts, 0, parts.polygon_count) ? status : GNO_ERROR_MEMORY;
}

/* Splits the sheets by the lights that split, and keeps what the others reach beside. */
static gno_status see_lights(const job *j, gnoi_splitter *w, const gnoi_receiver_view *r, int convex, int *cut, gnoi_piece_list *beside)
{
    gno_status status = GNO_OK;
    for (size_t i = 0; i < j->lamp_count && !status; i++)
        if (!j->aside[i])
            status = gnoi_split_by_light(w, (unsigned)i, &r->canvas, convex, cut);
    for (size_t i = 0; i < j->lamp_count && !status; i++)
        if (j->aside[i])
            status = gnoi_split_beside(w, (unsigned)i, r, convex, beside);
    return status;
}

static gno_status see_polygon(const job *j, worker *w, uint32_t index, gnoi_piece_list *list, gnoi_piece_list *beside)
{
    const gnoi_stand *s = &j->eye.stands[index];
    gnoi_receiver_view r;
    gno_status status;
    int whole, cut = 0, convex;
    if (s->side == 0 || s->absent)
        return GNO_OK;
    if (s->hidden) {
        w->hidden++;
        return GNO_OK;
    }
    status = see_region(j, w, index, &r, &whole);
    if (status || w->split.region.polygon_count == 0)
        return status;
    convex = whole && r.convex;
    if (!gnoi_split_begin(&w->split))
        return GNO_ERROR_MEMORY;
    if (j->def.split)
        status = see_lights(j, &w->split, &r, convex, &cut, beside);
    return status ? status : emit(&w->split, &r, whole && !cut, list);
}

static gno_status see_chunk(void *user, int worker_number, size_t piece)
{
    job *j = user;
    size_t first = piece * CHUNK, end = first + CHUNK;
    gno_status status = GNO_OK;
    end = end < j->scene->prepared.poly_count ? end : j->scene->prepared.poly_count;
    j->chunks[piece].context = j->scene->context;
    if (j->beside)
        j->beside[piece].context = j->scene->context;
    for (size_t i = first; i < end && !status; i++)
        status = see_polygon(j, &j->workers[worker_number], (uint32_t)i, &j->chunks[piece], j->beside ? &j->beside[piece] : NULL);
    return status;
}

/* ---- the run ----------------------------------------------------------------------------------------------------------------- */

static gno_status make_light(void *user, int worker_number, size_t piece)
{
    job *j = user;
    (void)worker_number;
    return j->def.lit && j->def.lit[piece] ? GNO_OK : gnoi_centre_make(j->scene, &j->lamps[piece], NULL, 1, &j->lights[piece]);
}

/* Marks the lamps that do not split; 0 when memory fails. */
static int mark_aside(job *j)
{
    const gno_scene *scene = j->scene;
    size_t n = 0, kept = 0;
    j->aside = gnoi_calloc(scene->context, j->lamp_count, 1);
    for (size_t i = 0; i < scene->light_count && j->aside; i++) {
        size_t points = gnoi_light_points(&scene->lights[i].light);
        for (size_t k = 0; k < points; k++, n++) {
            j->aside[n] = j->def.split == GNOI_SPLIT_BESIDE || (j->def.split == 2 && points > 1);
            kept += j->aside[n];
        }
    }
    if (kept > 0)
        j->beside = gnoi_calloc(scene->context, j->chunk_count, sizeof *j->beside);
    return j->aside && (j->beside || kept == 0);
}

static gno_status worker_make(job *j, worker *w)
{
    w->split.lit = (const gno_pieces *const *)j->def.lit;
    w->split.eye = &j->eye;
    w->split.lights = j->lights;
    return gnoi_splitter_make(j->scene, &w->split);
}

static gno_status job_make(job *j)
{
    gno_context *context = j->scene->context;
    gnoi_lamp eye;
    gno_status status;
    j->view = gnoi_view_make(&j->scene->camera, &j->scene->image, j->scene->prepared.scale);
    eye = gnoi_lamp_of_view(&j->view);
    status = gnoi_centre_make(j->scene, &eye, &j->view, j->def.see_through, &j->eye);
    j->worker_count = gnoi_thread_count(j->def.threads);
    j->chunk_count = (j->scene->prepared.poly_count + CHUNK - 1) / CHUNK;
    if ((size_t)j->worker_count > j->chunk_count)
        j->worker_count = j->chunk_count > 0 ? (int)j->chunk_count : 1;
    j->workers = gnoi_calloc(context, (size_t)j->worker_count, sizeof *j->workers);
    j->chunks = gnoi_calloc(context, j->chunk_count, sizeof *j->chunks);
    j->lamps = gnoi_calloc(context, j->lamp_count, sizeof *j->lamps);
    j->lights = gnoi_calloc(context, j->lamp_count, sizeof *j->lights);
    if (status || !j->workers || !j->chunks || !j->lamps || !j->lights || !mark_aside(j))
        return status ? status : GNO_ERROR_MEMORY;
    for (int i = 0; i < j->worker_count && !status; i++)
        status = worker_make(j, &j->workers[i]);
    if (!status && j->lamp_count > 0 && j->def.split) {
        gnoi_lamps_fill(j->scene, j->lamps);
        status = gnoi_parallel(context, j->def.threads, j->lamp_count, "caster trees", make_light, j);
    }
    return status;
}

static void job_free(job *j)
{
    gno_context *context = j->scene->context;
    for (int i = 0; j->workers && i < j->worker_count; i++)
        gnoi_splitter_free(&j->workers[i].split);
    for (size_t i = 0; j->chunks && i < j->chunk_count; i++)
        if (j->chunks[i].context)
            gnoi_piece_list_free(&j->chunks[i]);
    for (size_t i = 0; j->beside && i < j->chunk_count; i++)
        if (j->beside[i].context)
            gnoi_piece_list_free(&j->beside[i]);
    for (size_t i = 0; j->lights && i < j->lamp_count; i++)
        gnoi_centre_free(&j->lights[i]);
    gnoi_centre_free(&j->eye);
    gnoi_free(context, j->workers, (size_t)j->worker_count, sizeof *j->workers);
    gnoi_free(context, j->chunks, j->chunk_count, sizeof *j->chunks);
    gnoi_free(context, j->beside, j->chunk_count, sizeof *j->beside);
    gnoi_free(context, j->aside, j->lamp_count, 1);
    gnoi_free(context, j->lamps, j->lamp_count, sizeof *j->lamps);
    gnoi_free(context, j->lights, j->lamp_count, sizeof *j->lights);
}

gno_visible_def gno_visible_def_default(void)
{
    gno_visible_def def;
    memset(&def, 0, sizeof def);
    def.split = 1;
    def.see_through = 1;
    return def;
}

/* 1 when each of the pieces is of expanded light `light` alone: what gno_lit_pieces makes. */
static int is_lit_by(const gno_pieces *pieces, size_t light)
{
    for (size_t i = 0; i < pieces->list.count; i++) {
        const gnoi_piece *piece = &pieces->list.pieces[i];
        if (piece->light_count != 1 || pieces->list.lights[piece->light] != light)
            return 0;
    }
    return 1;
}

static gno_status check(const gno_scene *scene, const gno_visible_def *def, size_t lamps)
{
    if (def->threads < 0 || def->threads > GNO_MAX_THREADS)
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "threads: %d is not from 0 to %d", def->threads, GNO_MAX_THREADS);
    if (lamps > GNO_MAX_LIGHTS)
        return gnoi_fail(scene->context, GNO_ERROR_LIMIT, "%lu points of light in all; the limit is %d", (unsigned long)lamps, GNO_MAX_LIGHTS);
    for (size_t i = 0; def->lit && i < lamps; i++) {
        if (def->lit[i] && def->lit[i]->polygon_count != scene->polygon_count)
            return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "lit[%lu]: pieces of %lu polygons, the scene has %lu", (unsigned long)i,
                             (unsigned long)def->lit[i]->polygon_count, (unsigned long)scene->polygon_count);
        if (def->lit[i] && !is_lit_by(def->lit[i], i))
            return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "lit[%lu]: not the lit pieces of light %lu", (unsigned long)i, (unsigned long)i);
    }
    return GNO_OK;
}

static gno_status run(job *j, gno_pieces **pieces, gno_visible_summary *sum)
{
    double t0 = gnoi_now(), t1;
    gno_status status = gnoi_scene_prepare(j->scene, j->def.threads);
    t1 = gnoi_now();
    sum->prepare_seconds = t1 - t0;
    if (!status)
        status = job_make(j);
    t0 = gnoi_now();
    sum->tree_seconds = t0 - t1;
    if (!status)
        status = gnoi_parallel(j->scene->context, j->def.threads, j->chunk_count, "visible pieces", see_chunk, j);
    for (int i = 0; j->workers && i < j->worker_count; i++) {
        sum->polygons += j->workers[i].polygons;
        sum->hidden += j->workers[i].hidden;
        sum->whole += j->workers[i].whole;
        sum->clipped += j->workers[i].clipped;
        sum->casters += j->workers[i].casters;
    }
    if (!status)
        status = gnoi_pieces_join(j->scene->context, j->chunks, j->chunk_count, j->scene->polygon_count, pieces);
    if (!status && j->beside) {
        status = gnoi_pieces_join(j->scene->context, j->beside, j->chunk_count, j->scene->polygon_count, &(*pieces)->beside);
        if (status) {
            gno_pieces_destroy(*pieces);
            *pieces = NULL;
        }
    }
    sum->piece_seconds = gnoi_now() - t0;
    return status;
}

gno_status gno_visible_pieces(gno_scene *scene, const gno_visible_def *def, gno_pieces **pieces, gno_visible_summary *summary)
{
    gno_visible_summary sum;
    gno_status status;
    job j;
    if (pieces)
        *pieces = NULL;
    if (!scene || !pieces)
        return scene ? gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "visible pieces: no place for them given") : GNO_ERROR_ARGUMENT;
    gnoi_begin(scene->context, "visible pieces");
    memset(&j, 0, sizeof j);
    memset(&sum, 0, sizeof sum);
    j.scene = scene;
    j.def = def ? *def : gno_visible_def_default();
    j.lamp_count = gnoi_lamps_count(scene);
    status = check(scene, &j.def, j.lamp_count);
    if (!status) {
        status = run(&j, pieces, &sum);
        job_free(&j);
    }
    if (summary && !status)
        *summary = sum;
    return status == GNO_ERROR_MEMORY ? gnoi_fail(scene->context, status, "out of memory for the visible pieces") : status;
}
