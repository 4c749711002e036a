/* visible_split.c -- see visible_split.h. */
#include "shadow/visible_split.h"

#include "clip/clip.h"

#include <string.h>

/* Casters beyond which their union is taken before sheet after sheet is split. */
#define FEW_CASTERS 4

/* Of a sheet split by kept pieces, what is left over and thinner than this share of its size lies along the border of what is kept:
 * rounding. */
#define SLIVER 1e-9

/* ---- sheets --------------------------------------------------------------------------------------------------------------- */

static int add_sheet(gnoi_splitter *w, gnoi_split_sheets *s, const gno_shape *from, size_t first, size_t count, uint32_t of)
{
    gnoi_split_sheet *fresh;
    if (count == 0)
        return 1;
    if (!gnoi_reserve(w->context, (void **)&s->items, &s->capacity, s->count + 1, sizeof *s->items))
        return 0;
    fresh = &s->items[s->count++];
    fresh->reach = of;
    fresh->first = s->shape.polygon_count;
    fresh->count = count;
    return gnoi_shape_append(&s->shape, from, first, count);
}

static void clear_sheets(gnoi_split_sheets *s)
{
    s->count = 0;
    gnoi_shape_clear(&s->shape);
}

/* The reach of a sheet that one more light reaches. GNOI_NONE when memory fails. */
static uint32_t add_reach_of(gnoi_splitter *w, uint32_t before, unsigned light, const double passed[3])
{
    gnoi_reach *fresh;
    if (!gnoi_reserve(w->context, (void **)&w->reaches, &w->reach_capacity, w->reach_count + 1, sizeof *w->reaches))
        return GNOI_NONE;
    fresh = &w->reaches[w->reach_count];
    fresh->before = before;
    fresh->light = light;
    memcpy(fresh->passed, passed, sizeof fresh->passed);
    return (uint32_t)w->reach_count++;
}

/* How far apart two centres see the border of a receiver that is not quite planar: the corners' distances from the plane times the
 * slants of the rays. */
static double border_shift(const gnoi_canvas *a, const gnoi_canvas *b)
{
    double bend = gnoi_canvas_bend(a);
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
static int add_thick(gnoi_splitter *w, const gno_shape *from, size_t first, size_t count, uint32_t of, double thickness)
{
    gno_shape thick;
    if (!(thickness > 0))
        return add_sheet(w, &w->next, from, first, count, of);
    gnoi_shape_clear(&w->thick);
    for (size_t k = first; k < first + count; k++)
        if (!is_sliver(from, k, thickness) && !gnoi_shape_append(&w->thick, from, k, 1))
            return 0;
    thick = gnoi_shape_view(&w->thick);
    return add_sheet(w, &w->next, &thick, 0, thick.polygon_count, of);
}

/* Adds polygons first.. of `from`, reached by the light. */
static int add_reached(gnoi_splitter *w, const gno_shape *from, size_t first, size_t count, uint32_t before, unsigned light,
                       const double passed[3], double thickness)
{
    uint32_t of = count > 0 ? add_reach_of(w, before, light, passed) : 0;
    return of != GNOI_NONE && add_thick(w, from, first, count, of, thickness);
}

static int same(const double a[3], const double b[3]) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

/* Adds the parts that a light reaches, those with the same share together where they follow one another. */
static int add_parts(gnoi_splitter *w, const gnoi_parts *parts, uint32_t before, unsigned light, double thickness)
{
    gno_shape view = gnoi_shape_view(&parts->shape);
    size_t n = view.polygon_count;
    for (size_t i = 0, end; i < n; i = end) {
        for (end = i + 1; end < n && same(parts->passed + 3 * i, parts->passed + 3 * end);)
            end++;
        if (!add_reached(w, &view, i, end - i, before, light, parts->passed + 3 * i, thickness))
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
static gno_status split_by_kept(gnoi_splitter *w, unsigned light, const gnoi_canvas *eye, double thickness)
{
    gnoi_parter *p = &w->parter;
    gno_status status = load_kept(w->lit[light], eye, &p->parts);
    gno_shape lit = gnoi_shape_view(&p->parts.shape), now = gnoi_shape_view(&w->now.shape), one, result;
    for (size_t i = 0; i < w->now.count && !status; i++) {
        const gnoi_split_sheet *s = &w->now.items[i];
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
            status = gnoi_clip(p->clipper, GNO_CLIP_INTERSECTION, &one, &group, &result);
            if (!status && !add_reached(w, &result, 0, result.polygon_count, s->reach, light, p->parts.passed + 3 * k, thickness))
                status = GNO_ERROR_MEMORY;
        }
        if (!status)
            status = gnoi_clip(p->clipper, GNO_CLIP_DIFFERENCE, &one, &lit, &result);
        if (!status && !add_thick(w, &result, 0, result.polygon_count, s->reach, thickness))
            status = GNO_ERROR_MEMORY;
    }
    return status;
}

static gno_status split_by_cover(gnoi_splitter *w, unsigned light, const gnoi_canvas *canvas, double thickness)
{
    gnoi_parter *p = &w->parter;
    gno_status status = GNO_OK;
    gno_shape now = gnoi_shape_view(&w->now.shape), one, dark;
    if (p->cover.casters.polygon_count > FEW_CASTERS && w->now.count > 1)
        status = gnoi_parter_unite(p);
    for (size_t i = 0; i < w->now.count && !status; i++) {
        const gnoi_split_sheet *s = &w->now.items[i];
        gnoi_shape_clear(&w->single);
        if (!gnoi_shape_append(&w->single, &now, s->first, s->count))
            return GNO_ERROR_MEMORY;
        one = gnoi_shape_view(&w->single);
        status = gnoi_parter_reach(p, canvas, &one);
        if (!status && !add_parts(w, &p->parts, s->reach, light, thickness))
            status = GNO_ERROR_MEMORY;
        if (!status)
            status = gnoi_parter_shadow(p, &one, 0, &w->dark);
        dark = gnoi_shape_view(&w->dark);
        if (!status && !add_thick(w, &dark, 0, dark.polygon_count, s->reach, thickness))
            status = GNO_ERROR_MEMORY;
    }
    return status;
}

/* The light reaches every sheet as it is. */
static gno_status reach_all(gnoi_splitter *w, unsigned light)
{
    static const double full[3] = {1, 1, 1};
    for (size_t i = 0; i < w->now.count; i++) {
        uint32_t of = add_reach_of(w, w->now.items[i].reach, light, full);
        if (of == GNOI_NONE)
            return GNO_ERROR_MEMORY;
        w->now.items[i].reach = of;
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
gno_status gnoi_split_by_light(gnoi_splitter *w, unsigned light, const gnoi_canvas *eye, int convex, int *cut)
{
    const gnoi_centre *centre = &w->lights[light];
    const gno_pieces *kept = w->lit ? w->lit[light] : NULL;
    gno_shape region = gnoi_shape_view(&w->region);
    gnoi_canvas canvas;
    gnoi_cover_state found;
    gno_status status;
    double shift;
    gnoi_split_sheets swap;
    clear_sheets(&w->next);
    if (kept) {
        status = split_by_kept(w, light, eye, border_shift(eye, eye) + SLIVER * size_of(&region));
    } else {
        if (centre->stands[eye->index].side != w->eye->stands[eye->index].side || centre->stands[eye->index].hidden)
            return GNO_OK;
        canvas = gnoi_canvas_make(centre, eye->index);
        shift = border_shift(eye, &canvas);
        w->parter.cover.slack = shift;
        found = gnoi_cover_ask(&w->parter.cover, &canvas, &region, convex);
        w->parter.cover.slack = 0;
        if (found == GNOI_COVER_NO_MEMORY)
            return GNO_ERROR_MEMORY;
        if (found != GNOI_COVER_PART)
            return found == GNOI_COVER_NONE ? reach_all(w, light) : GNO_OK;
        status = split_by_cover(w, light, &canvas, shift);
    }
    *cut = 1;
    swap = w->now;
    w->now = w->next;
    w->next = swap;
    return status;
}

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

int gnoi_split_add_lights(const gnoi_splitter *w, uint32_t of, gnoi_piece_list *list)
{
    size_t first = list->light_count;
    for (uint32_t s = of; s != GNOI_NONE; s = w->reaches[s].before)
        if (!gnoi_piece_list_add_light(list, w->reaches[s].light, w->reaches[s].passed))
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

/* The number of the sheet of a reach; there is one. */
static uint32_t sheet_of_reach(const gnoi_split_sheets *s, uint32_t reach)
{
    uint32_t i = 0;
    while (s->items[i].reach != reach)
        i++;
    return i;
}

/* Adds what a light reaches of every sheet, where that is neither all nor nothing, to `list`, and leaves the sheets as they are. */
gno_status gnoi_split_beside(gnoi_splitter *w, unsigned light, const gnoi_receiver_view *r, int convex, gnoi_piece_list *list)
{
    size_t reaches_before = w->reach_count;
    int cut = 0;
    gno_status status = gnoi_split_by_light(w, light, &r->canvas, convex, &cut);
    gno_shape shape = gnoi_shape_view(&w->now.shape);
    gnoi_split_sheets swap;
    if (status || !cut)
        return status;
    for (size_t i = 0; i < w->now.count; i++) {
        const gnoi_split_sheet *s = &w->now.items[i];
        const gnoi_reach *of = s->reach != GNOI_NONE && s->reach >= reaches_before ? &w->reaches[s->reach] : NULL;
        for (size_t k = s->first; k < s->first + s->count && of; k++) {
            size_t before = list->count;
            if (!gnoi_piece_list_add(list, &r->canvas, &shape, k, r->scale))
                return GNO_ERROR_MEMORY;
            if (list->count == before)
                continue;
            if (!gnoi_piece_list_add_light(list, light, of->passed))
                return GNO_ERROR_MEMORY;
            list->pieces[before].sheet = sheet_of_reach(&w->next, of->before);
        }
    }
    swap = w->now;
    w->now = w->next;
    w->next = swap;
    return GNO_OK;
}


/* ---- life ----------------------------------------------------------------------------------------------------------------- */

int gnoi_split_begin(gnoi_splitter *w)
{
    gno_shape region = gnoi_shape_view(&w->region);
    w->reach_count = 0;
    clear_sheets(&w->now);
    return add_sheet(w, &w->now, &region, 0, region.polygon_count, GNOI_NONE);
}

gno_status gnoi_splitter_make(const gno_scene *scene, gnoi_splitter *w)
{
    w->context = w->region.context = w->single.context = w->dark.context = w->thick.context = scene->context;
    w->now.shape.context = w->next.shape.context = scene->context;
    return gnoi_parter_make(scene, &w->parter);
}

void gnoi_splitter_free(gnoi_splitter *w)
{
    gnoi_parter_free(&w->parter);
    if (!w->context)
        return;
    gnoi_shape_free(&w->region);
    gnoi_shape_free(&w->single);
    gnoi_shape_free(&w->dark);
    gnoi_shape_free(&w->thick);
    gnoi_shape_free(&w->now.shape);
    gnoi_shape_free(&w->next.shape);
    gnoi_free(w->context, w->now.items, w->now.capacity, sizeof *w->now.items);
    gnoi_free(w->context, w->next.items, w->next.capacity, sizeof *w->next.items);
    gnoi_free(w->context, w->reaches, w->reach_capacity, sizeof *w->reaches);
}
