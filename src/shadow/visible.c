/* visible.c -- gno_visible_pieces: what the camera sees of every polygon, split by the lights that reach it.
 *
 * Place in the data flow: scene -> prepared -> gnoi_centre of the eye, and of every light that no kept pieces stand for -> for
 * each polygon: visible parts, then light after light each part into what it reaches and the rest -> gno_pieces.
 * An eye is a light here: the same code finds what both see. Parts that the same lights reach are a sheet; a light turns every
 * sheet into at most two, and more only behind transparent casters. Of lights that shall not split, the points of an area light for
 * one, what they reach of each sheet is kept beside, light by light: their number then adds up where it would multiply.
 */
#include "base/parallel.h"
#include "scene/validate.h"
#include "shadow/lamp.h"
#include "shadow/piece_set.h"
#include "shadow/receiver.h"

#include <string.h>

#define CHUNK 32

/* Casters beyond which their union is taken before sheet after sheet is split. */
#define FEW_CASTERS 4

/* Of a sheet split by kept pieces, what is left over and thinner than this share of its size lies along the border of what is kept:
 * rounding. */
#define SLIVER 1e-9

/* Which lights reach: the last one, and the state without it. */
typedef struct state {
    uint32_t before; /* GNOI_NONE: none */
    unsigned light;
    double passed[3];
} state;

typedef struct sheet {
    uint32_t state;
    size_t first, count; /* polygons of the worker's shape */
} sheet;

/* Sheets of one receiver. */
typedef struct sheets {
    size_t count, capacity;
    sheet *items;
    gnoi_shape shape;
} sheets;

typedef struct worker {
    gnoi_parter parter;
    gnoi_shape region; /* the visible parts */
    gnoi_shape single; /* one sheet, offsets from 0 */
    gnoi_shape dark, thick;
    sheets now, next;
    size_t state_count, state_capacity;
    state *states;
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

/* ---- sheets --------------------------------------------------------------------------------------------------------------- */

static int add_sheet(gno_context *context, sheets *s, const gno_shape *from, size_t first, size_t count, uint32_t of)
{
    sheet *fresh;
    if (count == 0)
        return 1;
    if (!gnoi_reserve(context, (void **)&s->items, &s->capacity, s->count + 1, sizeof *s->items))
        return 0;
    fresh = &s->items[s->count++];
    fresh->state = of;
    fresh->first = s->shape.polygon_count;
    fresh->count = count;
    return gnoi_shape_append(&s->shape, from, first, count);
}

static void clear_sheets(sheets *s)
{
    s->count = 0;
    gnoi_shape_clear(&s->shape);
}

/* The state of a sheet that one more light reaches. GNOI_NONE when memory fails. */
static uint32_t add_state(gno_context *context, worker *w, uint32_t before, unsigned light, const double passed[3])
{
    state *fresh;
    if (!gnoi_reserve(context, (void **)&w->states, &w->state_capacity, w->state_count + 1, sizeof *w->states))
        return GNOI_NONE;
    fresh = &w->states[w->state_count];
    fresh->before = before;
    fresh->light = light;
    memcpy(fresh->passed, passed, sizeof fresh->passed);
    return (uint32_t)w->state_count++;
}

/* How far apart two centres see the border of a receiver that is not quite planar: the corners' distances from the plane times the
 * slants of the rays. */
static double border_shift(const gnoi_canvas *a, const gnoi_canvas *b)
{
    const gno_scene *scene = a->centre->scene;
    const gnoi_poly *poly = &scene->prepared.polys[a->index];
    double bend = 0;
    for (uint32_t i = 0; i < poly->corner_count; i++)
        bend = fmax(bend, fabs(v3_dot(a->n, v3_sub(gnoi_corner_at(scene, poly->corner + i), a->origin))));
    if (bend <= a->centre->noise)
        return 0;
    return 2 * bend * (hypot(a->along_u, a->along_v) + hypot(b->along_u, b->along_v) + 1);
}

/* 1 for a polygon thinner all along than `thickness`. */
static int is_sliver(const gno_shape *shape, size_t polygon, double thickness)
{
    double around = 0;
    for (size_t r = shape->polygon_start[polygon]; r < shape->polygon_start[polygon + 1]; r++)
        for (size_t first = shape->ring_start[r], end = shape->ring_start[r + 1], i = first; i < end; i++) {
            const double *a = shape->points + 2 * i, *b = shape->points + 2 * (i + 1 < end ? i + 1 : first);
            around += hypot(b[0] - a[0], b[1] - a[1]);
        }
    return 2 * gnoi_shape_moment(shape, polygon).area < thickness * around;
}

/* Adds polygons to the next sheets without slivers along a border that was seen from elsewhere; thickness 0: all of them. */
static int add_thick(gno_context *context, worker *w, const gno_shape *from, size_t first, size_t count, uint32_t of, double thickness)
{
    gno_shape thick;
    if (!(thickness > 0))
        return add_sheet(context, &w->next, from, first, count, of);
    gnoi_shape_clear(&w->thick);
    for (size_t k = first; k < first + count; k++)
        if (!is_sliver(from, k, thickness) && !gnoi_shape_append(&w->thick, from, k, 1))
            return 0;
    thick = gnoi_shape_view(&w->thick);
    return add_sheet(context, &w->next, &thick, 0, thick.polygon_count, of);
}

/* Adds polygons first.. of `from`, reached by the light. */
static int add_reached(const job *j, worker *w, const gno_shape *from, size_t first, size_t count, uint32_t before, unsigned light,
                       const double passed[3], double thickness)
{
    uint32_t of = count > 0 ? add_state(j->scene->context, w, before, light, passed) : 0;
    return of != GNOI_NONE && add_thick(j->scene->context, w, from, first, count, of, thickness);
}

static int same(const double a[3], const double b[3]) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

/* Adds the parts that a light reaches, those with the same share together where they follow one another. */
static int add_parts(const job *j, worker *w, const gnoi_parts *parts, uint32_t before, unsigned light, double thickness)
{
    gno_shape view = gnoi_shape_view(&parts->shape);
    size_t n = view.polygon_count;
    for (size_t i = 0, end; i < n; i = end) {
        for (end = i + 1; end < n && same(parts->passed + 3 * i, parts->passed + 3 * end);)
            end++;
        if (!add_reached(j, w, &view, i, end - i, before, light, parts->passed + 3 * i, thickness))
            return 0;
    }
    return 1;
}

/* ---- one light ------------------------------------------------------------------------------------------------------------- */

/* The kept lit pieces of the receiver, on the canvas' plane, into p->parts. */
static gno_status load_kept(const gno_pieces *kept, const gnoi_canvas *canvas, gnoi_parts *parts)
{
    size_t source = canvas->centre->scene->prepared.polys[canvas->index].source;
    gnoi_parts_clear(parts);
    for (size_t i = kept->first[source]; i < kept->first[source + 1]; i++) {
        const gnoi_piece *piece = &kept->list.pieces[i];
        size_t first_ring = parts->shape.ring_count, k = parts->shape.polygon_count;
        if (piece->prepared != canvas->index || piece->side != canvas->centre->stands[canvas->index].side)
            continue;
        if (!gnoi_reserve(parts->shape.context, (void **)&parts->passed, &parts->passed_capacity, 3 * (k + 1), sizeof *parts->passed))
            return GNO_ERROR_MEMORY;
        memcpy(parts->passed + 3 * k, kept->list.passed + 3 * piece->light, 3 * sizeof *parts->passed);
        for (size_t r = piece->ring; r < piece->ring + piece->ring_count; r++) {
            size_t n = kept->list.ring_start[r + 1] - kept->list.ring_start[r];
            double *to = gnoi_shape_ring(&parts->shape, n);
            if (!to)
                return GNO_ERROR_MEMORY;
            for (size_t m = 0; m < n; m++) {
                vec3 q = v3_sub(v3_from(kept->list.points + 3 * (kept->list.ring_start[r] + m)), canvas->origin);
                to[2 * m] = v3_dot(canvas->u, q);
                to[2 * m + 1] = v3_dot(canvas->v, q);
            }
            if (!gnoi_shape_end_ring(&parts->shape, n))
                return GNO_ERROR_MEMORY;
        }
        if (!gnoi_shape_end_polygon(&parts->shape, first_ring))
            return GNO_ERROR_MEMORY;
    }
    return GNO_OK;
}

/* Splits every sheet by kept pieces: what each share reaches, and what none does. */
static gno_status split_by_kept(const job *j, worker *w, unsigned light, const gnoi_canvas *eye, double thickness)
{
    gnoi_parter *p = &w->parter;
    gno_status status = load_kept(j->def.lit[light], eye, &p->parts);
    gno_shape lit = gnoi_shape_view(&p->parts.shape), now = gnoi_shape_view(&w->now.shape), one, result;
    for (size_t i = 0; i < w->now.count && !status; i++) {
        const sheet *s = &w->now.items[i];
        gnoi_shape_clear(&w->single);
        if (!gnoi_shape_append(&w->single, &now, s->first, s->count))
            return GNO_ERROR_MEMORY;
        one = gnoi_shape_view(&w->single);
        for (size_t k = 0, end; k < lit.polygon_count && !status; k = end) {
            gno_shape group;
            for (end = k + 1; end < lit.polygon_count && same(p->parts.passed + 3 * k, p->parts.passed + 3 * end);)
                end++;
            gnoi_shape_clear(&w->dark);
            if (!gnoi_shape_append(&w->dark, &lit, k, end - k))
                return GNO_ERROR_MEMORY;
            group = gnoi_shape_view(&w->dark);
            status = gno_clip(p->clipper, GNO_CLIP_INTERSECTION, &one, &group, &result);
            if (!status && !add_reached(j, w, &result, 0, result.polygon_count, s->state, light, p->parts.passed + 3 * k, thickness))
                status = GNO_ERROR_MEMORY;
        }
        if (!status)
            status = gno_clip(p->clipper, GNO_CLIP_DIFFERENCE, &one, &lit, &result);
        if (!status && !add_thick(j->scene->context, w, &result, 0, result.polygon_count, s->state, thickness))
            status = GNO_ERROR_MEMORY;
    }
    return status;
}

static gno_status split_by_cover(const job *j, worker *w, unsigned light, const gnoi_canvas *canvas, double thickness)
{
    gnoi_parter *p = &w->parter;
    gno_status status = GNO_OK;
    gno_shape now = gnoi_shape_view(&w->now.shape), one, dark;
    if (p->cover.casters.polygon_count > FEW_CASTERS && w->now.count > 1)
        status = gnoi_parter_unite(p);
    for (size_t i = 0; i < w->now.count && !status; i++) {
        const sheet *s = &w->now.items[i];
        gnoi_shape_clear(&w->single);
        if (!gnoi_shape_append(&w->single, &now, s->first, s->count))
            return GNO_ERROR_MEMORY;
        one = gnoi_shape_view(&w->single);
        status = gnoi_parter_reach(p, canvas, &one);
        if (!status && !add_parts(j, w, &p->parts, s->state, light, thickness))
            status = GNO_ERROR_MEMORY;
        if (!status)
            status = gnoi_parter_shadow(p, &one, 0, &w->dark);
        dark = gnoi_shape_view(&w->dark);
        if (!status && !add_thick(j->scene->context, w, &dark, 0, dark.polygon_count, s->state, thickness))
            status = GNO_ERROR_MEMORY;
    }
    return status;
}

/* The light reaches every sheet as it is. */
static gno_status reach_all(const job *j, worker *w, unsigned light)
{
    static const double full[3] = {1, 1, 1};
    for (size_t i = 0; i < w->now.count; i++) {
        uint32_t of = add_state(j->scene->context, w, w->now.items[i].state, light, full);
        if (of == GNOI_NONE)
            return GNO_ERROR_MEMORY;
        w->now.items[i].state = of;
    }
    return GNO_OK;
}

static double size_of(const gno_shape *shape)
{
    double size = 0, box[4];
    for (size_t k = 0; k < shape->polygon_count; k++) {
        gnoi_shape_box(shape, k, box);
        size = fmax(size, fmax(box[2] - box[0], box[3] - box[1]));
    }
    return size;
}

/* *cut is set when sheets are no longer what the eye sees undivided. */
static gno_status split_by_light(const job *j, worker *w, unsigned light, const gnoi_canvas *eye, int convex, int *cut)
{
    const gnoi_centre *centre = &j->lights[light];
    const gno_pieces *kept = j->def.lit ? j->def.lit[light] : NULL;
    gno_shape region = gnoi_shape_view(&w->region);
    gnoi_canvas canvas;
    gnoi_cover_state found;
    gno_status status;
    double shift;
    sheets swap;
    clear_sheets(&w->next);
    if (kept) {
        status = split_by_kept(j, w, light, eye, border_shift(eye, eye) + SLIVER * size_of(&region));
    } else {
        if (centre->stands[eye->index].side != j->eye.stands[eye->index].side || centre->stands[eye->index].hidden)
            return GNO_OK;
        canvas = gnoi_canvas_make(centre, eye->index);
        shift = border_shift(eye, &canvas);
        w->parter.cover.slack = shift;
        found = gnoi_cover_ask(&w->parter.cover, &canvas, &region, convex);
        w->parter.cover.slack = 0;
        if (found == GNOI_COVER_NO_MEMORY)
            return GNO_ERROR_MEMORY;
        if (found != GNOI_COVER_PART)
            return found == GNOI_COVER_NONE ? reach_all(j, w, light) : GNO_OK;
        status = split_by_cover(j, w, light, &canvas, shift);
    }
    *cut = 1;
    swap = w->now;
    w->now = w->next;
    w->next = swap;
    return status;
}

/* ---- one polygon ------------------------------------------------------------------------------------------------------------- */

static void reverse_lights(gnoi_piece_list *list, size_t first)
{
    size_t n = list->light_count - first;
    for (size_t i = 0; i < n / 2; i++) {
        size_t a = first + i, b = first + n - 1 - i;
        unsigned light = list->lights[a];
        list->lights[a] = list->lights[b];
        list->lights[b] = light;
        for (int k = 0; k < 3; k++) {
            double passed = list->passed[3 * a + (size_t)k];
            list->passed[3 * a + (size_t)k] = list->passed[3 * b + (size_t)k];
            list->passed[3 * b + (size_t)k] = passed;
        }
    }
}

static int add_lights(const worker *w, uint32_t of, gnoi_piece_list *list)
{
    size_t first = list->light_count;
    for (uint32_t s = of; s != GNOI_NONE; s = w->states[s].before)
        if (!gnoi_piece_list_add_light(list, w->states[s].light, w->states[s].passed))
            return 0;
    /* The chain runs from the last light to the first, those that do not split before those that do. */
    reverse_lights(list, first);
    for (size_t i = first + 1; i < list->light_count; i++) {
        unsigned light = list->lights[i];
        double passed[3];
        size_t k = i;
        memcpy(passed, list->passed + 3 * i, sizeof passed);
        for (; k > first && list->lights[k - 1] > light; k--) {
            list->lights[k] = list->lights[k - 1];
            memcpy(list->passed + 3 * k, list->passed + 3 * (k - 1), sizeof passed);
        }
        list->lights[k] = light;
        memcpy(list->passed + 3 * k, passed, sizeof passed);
    }
    return 1;
}

static gno_status emit(const worker *w, const gnoi_receiver_view *r, int whole, gnoi_piece_list *list)
{
    gno_shape shape = gnoi_shape_view(&w->now.shape);
    if (whole && w->now.count == 1) {
        vec3 c = gnoi_canvas_point(&r->canvas, r->seen.x / r->seen.area, r->seen.y / r->seen.area);
        return gnoi_piece_list_add_whole(list, &r->canvas, r->true_area, c) && add_lights(w, w->now.items[0].state, list) ? GNO_OK : GNO_ERROR_MEMORY;
    }
    for (size_t i = 0; i < w->now.count; i++) {
        const sheet *s = &w->now.items[i];
        for (size_t k = s->first; k < s->first + s->count; k++) {
            size_t before = list->count;
            if (!gnoi_piece_list_add(list, &r->canvas, &shape, k, r->scale) || (list->count > before && !add_lights(w, s->state, list)))
                return GNO_ERROR_MEMORY;
            if (list->count > before)
                list->pieces[before].sheet = (uint32_t)i;
        }
    }
    return GNO_OK;
}

/* The number of the sheet in a state; there is one. */
static uint32_t sheet_in(const sheets *s, uint32_t state_number)
{
    uint32_t i = 0;
    while (s->items[i].state != state_number)
        i++;
    return i;
}

/* Adds what a light reaches of every sheet, where that is neither all nor nothing, to `list`, and leaves the sheets as they are. */
static gno_status keep_beside(const job *j, worker *w, unsigned light, const gnoi_receiver_view *r, int convex, gnoi_piece_list *list)
{
    size_t states_before = w->state_count;
    int cut = 0;
    gno_status status = split_by_light(j, w, light, &r->canvas, convex, &cut);
    gno_shape shape = gnoi_shape_view(&w->now.shape);
    sheets swap;
    if (status || !cut)
        return status;
    for (size_t i = 0; i < w->now.count; i++) {
        const sheet *s = &w->now.items[i];
        const state *of = s->state != GNOI_NONE && s->state >= states_before ? &w->states[s->state] : NULL;
        for (size_t k = s->first; k < s->first + s->count && of; k++) {
            size_t before = list->count;
            if (!gnoi_piece_list_add(list, &r->canvas, &shape, k, r->scale))
                return GNO_ERROR_MEMORY;
            if (list->count == before)
                continue;
            if (!gnoi_piece_list_add_light(list, light, of->passed))
                return GNO_ERROR_MEMORY;
            list->pieces[before].sheet = sheet_in(&w->next, of->before);
        }
    }
    swap = w->now;
    w->now = w->next;
    w->next = swap;
    return GNO_OK;
}

/* Puts what the eye sees of the receiver into w->region; *whole: all of it. */
static gno_status see_region(const job *j, worker *w, uint32_t index, gnoi_receiver_view *r, int *whole)
{
    gnoi_parter *p = &w->parter;
    gnoi_cover_state found;
    gno_shape parts;
    gno_status status = gnoi_receiver_make(p, &j->eye, index, r);
    gnoi_shape_clear(&w->region);
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
        return gnoi_shape_append(&w->region, &r->outline, 0, 1) ? GNO_OK : GNO_ERROR_MEMORY;
    }
    /* What the frame cut may touch itself along the frame: the clipper makes it valid. */
    w->casters += p->cover.casters.polygon_count;
    status = gnoi_parter_reach(p, &r->canvas, &r->outline);
    parts = gnoi_shape_view(&p->parts.shape);
    return status || gnoi_shape_append(&w->region, &parts, 0, parts.polygon_count) ? status : GNO_ERROR_MEMORY;
}

/* Splits the sheets by the lights that split, and keeps what the others reach beside. */
static gno_status see_lights(const job *j, worker *w, const gnoi_receiver_view *r, int convex, int *cut, gnoi_piece_list *beside)
{
    gno_status status = GNO_OK;
    for (size_t i = 0; i < j->lamp_count && !status; i++)
        if (!j->aside[i])
            status = split_by_light(j, w, (unsigned)i, &r->canvas, convex, cut);
    for (size_t i = 0; i < j->lamp_count && !status; i++)
        if (j->aside[i])
            status = keep_beside(j, w, (unsigned)i, r, convex, beside);
    return status;
}

static gno_status see_polygon(const job *j, worker *w, uint32_t index, gnoi_piece_list *list, gnoi_piece_list *beside)
{
    const gnoi_stand *s = &j->eye.stands[index];
    gnoi_receiver_view r;
    gno_shape region;
    gno_status status;
    int whole, cut = 0, convex;
    if (s->side == 0 || s->absent)
        return GNO_OK;
    if (s->hidden) {
        w->hidden++;
        return GNO_OK;
    }
    status = see_region(j, w, index, &r, &whole);
    region = gnoi_shape_view(&w->region);
    if (status || region.polygon_count == 0)
        return status;
    convex = whole && r.convex;
    w->state_count = 0;
    clear_sheets(&w->now);
    if (!add_sheet(j->scene->context, &w->now, &region, 0, region.polygon_count, GNOI_NONE))
        return GNO_ERROR_MEMORY;
    if (j->def.split)
        status = see_lights(j, w, &r, convex, &cut, beside);
    return status ? status : emit(w, &r, whole && !cut, list);
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

static gno_status worker_make(const gno_scene *scene, worker *w)
{
    w->region.context = w->single.context = w->dark.context = w->thick.context = w->now.shape.context = w->next.shape.context = scene->context;
    return gnoi_parter_make(scene, &w->parter);
}

static void worker_free(gno_context *context, worker *w)
{
    gnoi_parter_free(&w->parter);
    if (!w->region.context)
        return;
    gnoi_shape_free(&w->region);
    gnoi_shape_free(&w->single);
    gnoi_shape_free(&w->dark);
    gnoi_shape_free(&w->thick);
    gnoi_shape_free(&w->now.shape);
    gnoi_shape_free(&w->next.shape);
    gnoi_free(context, w->now.items, w->now.capacity, sizeof *w->now.items);
    gnoi_free(context, w->next.items, w->next.capacity, sizeof *w->next.items);
    gnoi_free(context, w->states, w->state_capacity, sizeof *w->states);
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
        status = worker_make(j->scene, &j->workers[i]);
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
        worker_free(context, &j->workers[i]);
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
