/* lit.c -- gno_lit_pieces: the lit parts of every polygon under one light, their areas, and the certificate.
 *
 * Place in the data flow: scene -> prepared -> gnoi_centre of the light -> for each polygon: receiver.h, cover.h, parts.h -> lists of
 * pieces in chunks of polygons -> rows, summary, gno_pieces. Polygons are worked through in their order in space, by any thread; what
 * a polygon gives does not depend on the thread.
 */
#include "base/parallel.h"
#include "shadow/flux.h"
#include "shadow/lamp.h"
#include "shadow/piece_set.h"
#include "shadow/receiver.h"

#include <string.h>

#define CHUNK 32

/* What one prepared polygon gave; areas are true areas unless told otherwise. */
typedef struct outcome {
    double area, lit, dimmed;
    double moment[3];       /* lit area times centroid */
    double residual;        /* of lit + shadowed - area, over area */
    double flux, twice;     /* of its lit parts; of those that lie on other lit ones */
    uint32_t piece, piece_count;     /* in its chunk's list */
    uint32_t partner, partner_count; /* in its chunk's list of partners */
    uint32_t casters;
    unsigned char state;    /* a gnoi_cover_state */
    unsigned char behind;   /* a one-sided polygon lit from behind: takes its share of the light, yet is not lit */
} outcome;

typedef struct job {
    gno_scene *scene;
    gnoi_centre centre;
    unsigned light;
    int certify, keep;   /* keep: pieces are wanted, by the caller or the certificate */
    int worker_count;
    gnoi_parter *workers;
    size_t chunk_count;
    gnoi_piece_list *pieces; /* a list for each chunk */
    gnoi_list *partners;     /* likewise */
    outcome *outcomes;
} job;

static const double undiminished[3] = {1, 1, 1};

/* ---- one polygon -------------------------------------------------------------------------------------------------------- */

static gno_status add_piece(const job *j, const gnoi_receiver_view *r, const gno_shape *shape, size_t polygon, const double passed[3],
                            gnoi_piece_list *list)
{
    size_t before = list->count;
    if (!gnoi_piece_list_add(list, &r->canvas, shape, polygon, r->scale))
        return GNO_ERROR_MEMORY;
    return list->count == before || gnoi_piece_list_add_light(list, j->light, passed) ? GNO_OK : GNO_ERROR_MEMORY;
}

static void add_moment(outcome *o, const gnoi_receiver_view *r, const gnoi_moment *m)
{
    double area = m->area * r->scale;
    vec3 c = gnoi_canvas_point(&r->canvas, m->x / m->area, m->y / m->area);
    o->lit += area;
    o->moment[0] += area * c.x;
    o->moment[1] += area * c.y;
    o->moment[2] += area * c.z;
}

/* Rings of an outline as it is may cross one another and themselves: the clipper makes polygons of them. */
static gno_status flux_of_outline(gnoi_parter *p, const gnoi_receiver_view *r, double *flux)
{
    gno_shape simple = r->outline;
    gno_status status = GNO_OK;
    if (!r->convex) {
        status = gnoi_parter_clip(p, GNO_CLIP_UNION, &r->outline, NULL, &p->work[0]);
        simple = gnoi_shape_view(&p->work[0]);
    }
    if (!status && !gnoi_flux_of(&r->canvas, &simple, 0, simple.polygon_count, &p->cover, flux))
        status = GNO_ERROR_MEMORY;
    return status;
}

static gno_status all_lit(const job *j, gnoi_parter *p, const gnoi_receiver_view *r, outcome *o, gnoi_piece_list *list)
{
    vec3 centroid = gnoi_canvas_point(&r->canvas, r->seen.x / r->seen.area, r->seen.y / r->seen.area);
    gno_status status = GNO_OK;
    add_moment(o, r, &r->seen);
    if (j->certify && j->centre.lamp.directional)
        o->flux = r->seen.area * r->canvas.height;
    else if (j->certify)
        status = flux_of_outline(p, r, &o->flux);
    if (status || !j->keep)
        return status;
    return gnoi_piece_list_add_whole(list, &r->canvas, o->area, centroid) && gnoi_piece_list_add_light(list, j->light, undiminished)
               ? GNO_OK
               : GNO_ERROR_MEMORY;
}

static gno_status partly_lit(const job *j, gnoi_parter *p, const gnoi_receiver_view *r, outcome *o, gnoi_piece_list *list)
{
    gno_status status = gnoi_parter_reach(p, &r->canvas, &r->outline);
    gno_shape parts = gnoi_shape_view(&p->parts.shape);
    double lit = 0, shadow = 0, flux;
    for (size_t i = 0; i < parts.polygon_count && !status; i++) {
        const double *passed = p->parts.passed + 3 * i;
        gnoi_moment m = gnoi_shape_moment(&parts, i);
        if (!(m.area > 0))
            continue;
        if (gnoi_undiminished(passed)) {
            add_moment(o, r, &m);
            lit += m.area;
            if (j->certify && !gnoi_flux_of(&r->canvas, &parts, i, 1, &p->cover, &flux))
                return GNO_ERROR_MEMORY;
            o->flux += j->certify ? flux : 0;
        } else if (passed[0] > 0 || passed[1] > 0 || passed[2] > 0)
            o->dimmed += m.area * r->scale;
        else
            continue;
        if (j->keep)
            status = add_piece(j, r, &parts, i, passed, list);
    }
    if (j->certify && !status) {
        gno_shape dark;
        status = gnoi_parter_shadow(p, &r->outline, 1, &p->other.shape);
        dark = gnoi_shape_view(&p->other.shape);
        shadow = gno_shape_area(&dark);
        o->residual = r->seen.area > 0 ? (lit + shadow - r->seen.area) / r->seen.area : 0;
    }
    return status;
}

static gno_status keep_partners(const gnoi_parter *p, gnoi_list *to, outcome *o)
{
    const gnoi_list *from = &p->cover.partners;
    o->partner = (uint32_t)to->count;
    o->partner_count = (uint32_t)from->count;
    if (from->count == 0)
        return GNO_OK;
    if (!gnoi_reserve(p->context, (void **)&to->items, &to->capacity, to->count + from->count, sizeof *to->items))
        return GNO_ERROR_MEMORY;
    memcpy(to->items + to->count, from->items, from->count * sizeof *from->items);
    to->count += from->count;
    return GNO_OK;
}

static gno_status light_polygon(const job *j, gnoi_parter *p, uint32_t index, outcome *o)
{
    gnoi_piece_list *pieces = &j->pieces[index / CHUNK];
    const gnoi_stand *s = &j->centre.stands[index];
    gnoi_receiver_view r;
    gnoi_cover_state state;
    gno_status status;
    o->state = GNOI_COVER_ALL;
    o->piece = (uint32_t)pieces->count;
    o->behind = (unsigned char)(s->side < 0 && !j->scene->prepared.polys[index].two_sided);
    if (s->side == 0 || s->hidden)
        return gnoi_true_area(p, &j->centre, index, &o->area);
    status = gnoi_receiver_make(p, &j->centre, index, &r);
    o->area = r.true_area;
    if (status || r.outline.polygon_count == 0 || !(r.seen.area > 0))
        return status;
    state = gnoi_cover_ask(&p->cover, &r.canvas, &r.outline, r.convex);
    o->state = (unsigned char)state;
    if (state == GNOI_COVER_NO_MEMORY)
        return GNO_ERROR_MEMORY;
    if (state == GNOI_COVER_PART) {
        o->casters = (uint32_t)(p->cover.casters.polygon_count + p->cover.veils.polygon_count);
        status = partly_lit(j, p, &r, o, pieces);
    } else if (state == GNOI_COVER_NONE)
        status = all_lit(j, p, &r, o, pieces);
    o->piece_count = (uint32_t)(pieces->count - o->piece);
    return status || !j->certify || o->piece_count == 0 ? status : keep_partners(p, &j->partners[index / CHUNK], o);
}

static gno_status light_chunk(void *user, int worker, size_t piece)
{
    job *j = user;
    size_t first = piece * CHUNK, end = first + CHUNK;
    gno_status status = GNO_OK;
    end = end < j->scene->prepared.poly_count ? end : j->scene->prepared.poly_count;
    j->pieces[piece].context = j->scene->context;
    for (size_t i = first; i < end && !status; i++)
        status = light_polygon(j, &j->workers[worker], (uint32_t)i, &j->outcomes[i]);
    return status;
}

/* ---- the certificate -------------------------------------------------------------------------------------------------------- */

/* Appends the undiminished pieces of polygon `index`, seen from the centre on another polygon's plane. */
static int add_pieces_on(const job *j, uint32_t index, const gnoi_canvas *canvas, gnoi_shape *out)
{
    const gnoi_piece_list *list = &j->pieces[index / CHUNK];
    const outcome *o = &j->outcomes[index];
    for (uint32_t k = o->piece; k < o->piece + o->piece_count; k++) {
        const gnoi_piece *piece = &list->pieces[k];
        size_t first_ring = out->ring_count;
        if (!gnoi_undiminished(list->passed + 3 * piece->light))
            continue;
        for (size_t r = piece->ring; r < piece->ring + piece->ring_count; r++) {
            size_t n = list->ring_start[r + 1] - list->ring_start[r];
            double *to = gnoi_shape_ring(out, n);
            if (!to)
                return 0;
            for (size_t i = 0; i < n; i++) {
                gnoi_hpoint a = gnoi_canvas_project(canvas, v3_from(list->points + 3 * (list->ring_start[r] + i)));
                to[2 * i] = a.x / a.w;
                to[2 * i + 1] = a.y / a.w;
            }
            if (!gnoi_shape_end_ring(out, n))
                return 0;
        }
        if (!gnoi_shape_end_polygon(out, first_ring))
            return 0;
    }
    return 1;
}

/* The flux of what of this polygon lies on lit parts of polygons before it in rank. */
static gno_status count_twice(const job *j, gnoi_parter *p, uint32_t index, outcome *o)
{
    const gnoi_list *partners = &j->partners[index / CHUNK];
    gnoi_canvas canvas = gnoi_canvas_make(&j->centre, index);
    gno_shape own, others;
    gno_status status;
    gnoi_shape_clear(&p->outline);
    gnoi_shape_clear(&p->work[0]);
    if (!add_pieces_on(j, index, &canvas, &p->outline))
        return GNO_ERROR_MEMORY;
    for (uint32_t k = o->partner; k < o->partner + o->partner_count; k++)
        if (!add_pieces_on(j, partners->items[k], &canvas, &p->work[0]))
            return GNO_ERROR_MEMORY;
    own = gnoi_shape_view(&p->outline);
    others = gnoi_shape_view(&p->work[0]);
    if (own.polygon_count == 0 || others.polygon_count == 0)
        return GNO_OK;
    status = gnoi_parter_clip(p, GNO_CLIP_INTERSECTION, &own, &others, &p->work[1]);
    own = gnoi_shape_view(&p->work[1]);
    if (!status && !gnoi_flux_of(&canvas, &own, 0, own.polygon_count, &p->cover, &o->twice))
        status = GNO_ERROR_MEMORY;
    return status;
}

static gno_status certify_chunk(void *user, int worker, size_t piece)
{
    job *j = user;
    size_t first = piece * CHUNK, end = first + CHUNK;
    gno_status status = GNO_OK;
    end = end < j->scene->prepared.poly_count ? end : j->scene->prepared.poly_count;
    for (size_t i = first; i < end && !status; i++)
        if (j->outcomes[i].partner_count > 0 && j->outcomes[i].piece_count > 0)
            status = count_twice(j, &j->workers[worker], (uint32_t)i, &j->outcomes[i]);
    return status;
}

static gno_status certify(job *j, int threads, gno_lit_summary *sum)
{
    const gnoi_prepared *prep = &j->scene->prepared;
    gno_status status = gnoi_parallel(j->scene->context, threads, j->chunk_count, "certificate", certify_chunk, j);
    if (!status)
        status = gnoi_flux_union(&j->centre, &j->workers[0], &sum->flux_union);
    if (status == GNO_ERROR_LIMIT)
        gnoi_fail(j->scene->context, status, "certificate: the union of all casters: %s", gno_status_text(status));
    for (size_t i = 0; i < prep->poly_count && !status; i++) {
        const outcome *o = &j->outcomes[i];
        if (j->centre.stands[i].hides) {
            sum->flux_lit += o->flux - o->twice;
            sum->flux_twice += o->twice;
        }
        if (fabs(o->residual) > sum->area_residual) {
            sum->area_residual = fabs(o->residual);
            sum->area_worst = prep->polys[i].source;
        }
    }
    sum->flux_residual = sum->flux_union > 0 ? fabs(sum->flux_lit - sum->flux_union) / sum->flux_union : fabs(sum->flux_lit);
    return status;
}

/* ---- results ----------------------------------------------------------------------------------------------------------------- */

static void clear_rows(gno_lit_row *rows, size_t count)
{
    memset(rows, 0, count * sizeof *rows);
}

static void fill_rows(const job *j, gno_lit_row *rows)
{
    const gnoi_prepared *prep = &j->scene->prepared;
    clear_rows(rows, j->scene->polygon_count);
    for (size_t i = 0; i < prep->poly_count; i++) {
        const outcome *o = &j->outcomes[i];
        gno_lit_row *row = &rows[prep->polys[i].source];
        row->side = row->side ? row->side : j->centre.stands[i].side;
        row->area += o->area;
        if (o->behind)
            continue;
        row->lit_area += o->lit;
        row->dimmed_area += o->dimmed;
        for (int k = 0; k < 3; k++)
            row->centroid[k] += o->moment[k];
    }
    for (size_t i = 0; i < j->scene->polygon_count; i++) {
        gno_lit_row *row = &rows[i];
        row->lit_area = row->lit_area < row->area ? row->lit_area : row->area;
        row->fraction = row->area > 0 ? row->lit_area / row->area : 0;
        for (int k = 0; k < 3; k++)
            row->centroid[k] = row->lit_area > 0 ? row->centroid[k] / row->lit_area : 0;
    }
}

static void fill_summary(const job *j, gno_lit_summary *sum)
{
    const gnoi_prepared *prep = &j->scene->prepared;
    sum->polygons = prep->poly_count;
    for (size_t i = 0; i < prep->poly_count; i++) {
        const outcome *o = &j->outcomes[i];
        sum->area += o->area;
        sum->lit_area += o->behind ? 0 : o->lit;
        sum->dimmed_area += o->behind ? 0 : o->dimmed;
        sum->unlit += o->state == GNOI_COVER_ALL;
        sum->full += o->state == GNOI_COVER_NONE;
        sum->clipped += o->state == GNOI_COVER_PART;
        sum->casters += o->casters;
    }
}

/* Pieces on the backs of one-sided polygons served the certificate alone. */
static void drop_backs(job *j)
{
    for (size_t i = 0; i < j->chunk_count; i++) {
        gnoi_piece_list *list = &j->pieces[i];
        size_t n = 0;
        for (size_t k = i * CHUNK; k < (i + 1) * CHUNK && k < j->scene->prepared.poly_count; k++) {
            const outcome *o = &j->outcomes[k];
            for (uint32_t m = o->piece; m < o->piece + o->piece_count && !o->behind; m++)
                list->pieces[n++] = list->pieces[m];
        }
        list->count = n;
    }
}

/* ---- the run ----------------------------------------------------------------------------------------------------------------- */

static gno_status job_make(job *j, int threads)
{
    gno_context *context = j->scene->context;
    gno_status status = GNO_OK;
    j->worker_count = gnoi_thread_count(threads);
    j->chunk_count = (j->scene->prepared.poly_count + CHUNK - 1) / CHUNK;
    if ((size_t)j->worker_count > j->chunk_count)
        j->worker_count = j->chunk_count > 0 ? (int)j->chunk_count : 1;
    j->workers = gnoi_calloc(context, (size_t)j->worker_count, sizeof *j->workers);
    j->pieces = gnoi_calloc(context, j->chunk_count, sizeof *j->pieces);
    j->partners = gnoi_calloc(context, j->chunk_count, sizeof *j->partners);
    j->outcomes = gnoi_calloc(context, j->scene->prepared.poly_count, sizeof *j->outcomes);
    if (!j->workers || !j->pieces || !j->partners || !j->outcomes)
        return GNO_ERROR_MEMORY;
    for (int i = 0; i < j->worker_count && !status; i++)
        status = gnoi_parter_make(j->scene, &j->workers[i]);
    return status;
}

static void job_free(job *j)
{
    gno_context *context = j->scene->context;
    for (int i = 0; j->workers && i < j->worker_count; i++)
        gnoi_parter_free(&j->workers[i]);
    for (size_t i = 0; j->pieces && i < j->chunk_count; i++)
        if (j->pieces[i].context)
            gnoi_piece_list_free(&j->pieces[i]);
    for (size_t i = 0; j->partners && i < j->chunk_count; i++)
        gnoi_free(context, j->partners[i].items, j->partners[i].capacity, sizeof *j->partners[i].items);
    gnoi_free(context, j->workers, (size_t)j->worker_count, sizeof *j->workers);
    gnoi_free(context, j->pieces, j->chunk_count, sizeof *j->pieces);
    gnoi_free(context, j->partners, j->chunk_count, sizeof *j->partners);
    gnoi_free(context, j->outcomes, j->scene->prepared.poly_count, sizeof *j->outcomes);
    gnoi_centre_free(&j->centre);
}

static gno_status find_lamp(const gno_scene *scene, size_t light, gnoi_lamp *lamp)
{
    size_t count = gnoi_lamps_count(scene);
    gno_light point;
    gno_status status = gno_expanded_light(scene, light, &point, NULL);
    if (status)
        return status;
    if (count > GNO_MAX_LIGHTS)
        return gnoi_fail(scene->context, GNO_ERROR_LIMIT, "%lu points of light in all; the limit is %d", (unsigned long)count, GNO_MAX_LIGHTS);
    gnoi_lamps_of(&point, lamp);
    return GNO_OK;
}

gno_lit_def gno_lit_def_default(void)
{
    gno_lit_def def;
    def.threads = 0;
    def.certify = 1;
    return def;
}

static gno_status run(job *j, const gno_lit_def *def, gno_pieces **pieces, gno_lit_row *rows, gno_lit_summary *sum)
{
    gnoi_lamp lamp;
    double t0 = gnoi_now(), t1;
    gno_status status = gnoi_scene_prepare(j->scene, def->threads);
    if (!status)
        status = find_lamp(j->scene, j->light, &lamp);
    t1 = gnoi_now();
    sum->prepare_seconds = t1 - t0;
    if (!status)
        status = gnoi_centre_make(j->scene, &lamp, NULL, 1, &j->centre);
    if (!status)
        status = job_make(j, def->threads);
    t0 = gnoi_now();
    sum->tree_seconds = t0 - t1;
    if (!status)
        status = gnoi_parallel(j->scene->context, def->threads, j->chunk_count, "lit pieces", light_chunk, j);
    t1 = gnoi_now();
    sum->piece_seconds = t1 - t0;
    if (!status && j->certify)
        status = certify(j, def->threads, sum);
    t0 = gnoi_now();
    sum->certificate_seconds = t0 - t1;
    if (!status && rows)
        fill_rows(j, rows);
    if (!status)
        fill_summary(j, sum);
    if (!status && pieces) {
        drop_backs(j);
        status = gnoi_pieces_join(j->scene->context, j->pieces, j->chunk_count, j->scene->polygon_count, pieces);
    }
    sum->piece_seconds += gnoi_now() - t0;
    return status;
}

gno_status gno_lit_pieces(gno_scene *scene, size_t light, const gno_lit_def *def, gno_pieces **pieces, gno_lit_row *rows,
                          gno_lit_summary *summary)
{
    gno_lit_def used = def ? *def : gno_lit_def_default();
    gno_lit_summary sum;
    gno_status status;
    job j;
    if (pieces)
        *pieces = NULL;
    if (!scene)
        return GNO_ERROR_ARGUMENT;
    if (used.threads < 0 || used.threads > GNO_MAX_THREADS)
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "threads: %d is not from 0 to %d", used.threads, GNO_MAX_THREADS);
    gnoi_begin(scene->context, "lit pieces");
    memset(&j, 0, sizeof j);
    memset(&sum, 0, sizeof sum);
    j.scene = scene;
    j.light = (unsigned)light;
    j.certify = used.certify != 0;
    j.keep = j.certify || pieces;
    status = light > GNO_MAX_LIGHTS ? gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "light %lu: there is none", (unsigned long)light)
                                    : run(&j, &used, pieces, rows, &sum);
    job_free(&j);
    if (!status && gnoi_lamp_is_first(scene, light) && !gnoi_shadows_have_edges(scene))
        gnoi_warn(scene->context, "shadows that weaken with distance or fall through the holes of textures are taken as whole ones");
    if (summary && !status)
        *summary = sum;
    return status == GNO_ERROR_MEMORY ? gnoi_fail(scene->context, status, "out of memory for the lit pieces") : status;
}

/* ---- expanded lights ---------------------------------------------------------------------------------------------------------- */
