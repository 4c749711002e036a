/* piece_set.c -- see piece_set.h. */
#include "shadow/piece_set.h"

#include <string.h>

/* ---- collecting ----------------------------------------------------------------------------------------------------- */

void gnoi_piece_list_free(gnoi_piece_list *list)
{
    gnoi_free(list->context, list->pieces, list->capacity, sizeof *list->pieces);
    gnoi_free(list->context, list->ring_start, list->ring_capacity, sizeof *list->ring_start);
    gnoi_free(list->context, list->points, list->point_capacity, sizeof *list->points);
    gnoi_free(list->context, list->lights, list->light_capacity, sizeof *list->lights);
    gnoi_free(list->context, list->passed, list->passed_capacity, sizeof *list->passed);
    memset(list, 0, sizeof *list);
}

static gnoi_piece *new_piece(gnoi_piece_list *list, const gnoi_canvas *canvas)
{
    gnoi_piece *piece;
    if (!gnoi_reserve(list->context, (void **)&list->pieces, &list->capacity, list->count + 1, sizeof *list->pieces))
        return NULL;
    piece = &list->pieces[list->count];
    piece->polygon = canvas->centre->scene->prepared.polys[canvas->index].source;
    piece->prepared = canvas->index;
    piece->side = canvas->centre->stands[canvas->index].side;
    piece->ring = list->ring_count;
    piece->ring_count = 0;
    piece->light = list->light_count;
    piece->light_count = 0;
    piece->sheet = 0;
    return piece;
}

/* Room for a ring of n points; the caller fills in what is returned. */
static double *new_ring(gnoi_piece_list *list, gnoi_piece *piece, size_t n)
{
    double *to;
    if (!gnoi_reserve(list->context, (void **)&list->points, &list->point_capacity, 3 * (list->point_count + n), sizeof *list->points) ||
        !gnoi_reserve(list->context, (void **)&list->ring_start, &list->ring_capacity, list->ring_count + 2, sizeof *list->ring_start))
        return NULL;
    to = list->points + 3 * list->point_count;
    list->ring_start[list->ring_count++] = list->point_count;
    list->point_count += n;
    list->ring_start[list->ring_count] = list->point_count;
    piece->ring_count++;
    return to;
}

static void put(double *to, vec3 p)
{
    to[0] = p.x;
    to[1] = p.y;
    to[2] = p.z;
}

int gnoi_piece_list_add(gnoi_piece_list *list, const gnoi_canvas *canvas, const gno_shape *shape, size_t polygon, double scale)
{
    gnoi_piece *piece = new_piece(list, canvas);
    gnoi_moment m = gnoi_shape_moment(shape, polygon);
    if (!piece)
        return 0;
    if (!(m.area > 0))
        return 1;
    for (size_t r = shape->polygon_start[polygon]; r < shape->polygon_start[polygon + 1]; r++) {
        size_t n = shape->ring_start[r + 1] - shape->ring_start[r];
        const double *p = shape->points + 2 * shape->ring_start[r];
        double *to = new_ring(list, piece, n);
        if (!to)
            return 0;
        for (size_t i = 0; i < n; i++)
            put(to + 3 * i, gnoi_canvas_point(canvas, p[2 * i], p[2 * i + 1]));
    }
    piece->area = m.area * scale;
    put(piece->centroid, gnoi_canvas_point(canvas, m.x / m.area, m.y / m.area));
    list->count++;
    return 1;
}

int gnoi_piece_list_add_light(gnoi_piece_list *list, unsigned light, const double passed[3])
{
    if (!gnoi_reserve(list->context, (void **)&list->lights, &list->light_capacity, list->light_count + 1, sizeof *list->lights) ||
        !gnoi_reserve(list->context, (void **)&list->passed, &list->passed_capacity, 3 * (list->light_count + 1), sizeof *list->passed))
        return 0;
    list->lights[list->light_count] = light;
    memcpy(list->passed + 3 * list->light_count++, passed, 3 * sizeof *passed);
    list->pieces[list->count - 1].light_count++;
    return 1;
}

/* Twice the ring's area about n, counter-clockwise positive. */
static double turn_of(const gno_scene *scene, uint32_t first, uint32_t end, vec3 n)
{
    vec3 origin = gnoi_corner_at(scene, first), sum = v3(0, 0, 0);
    for (uint32_t i = first + 1; i + 1 < end; i++)
        sum = v3_add(sum, v3_cross(v3_sub(gnoi_corner_at(scene, i), origin), v3_sub(gnoi_corner_at(scene, i + 1), origin)));
    return v3_dot(sum, n);
}

int gnoi_piece_list_add_whole(gnoi_piece_list *list, const gnoi_canvas *canvas, double area, vec3 centroid)
{
    const gno_scene *scene = canvas->centre->scene;
    const gnoi_poly *poly = &scene->prepared.polys[canvas->index];
    gnoi_piece *piece = new_piece(list, canvas);
    if (!piece)
        return 0;
    for (uint32_t k = 0; k < poly->ring_count; k++) {
        uint32_t first = scene->prepared.ring_corner[poly->ring + k], end = scene->prepared.ring_corner[poly->ring + k + 1], n = end - first;
        int backwards = (turn_of(scene, first, end, canvas->n) < 0) != (k > 0);
        double *to = new_ring(list, piece, n);
        if (!to)
            return 0;
        for (uint32_t i = 0; i < n; i++)
            put(to + 3 * i, gnoi_corner_at(scene, backwards ? end - 1 - i : first + i));
    }
    piece->area = area;
    put(piece->centroid, centroid);
    list->count++;
    return 1;
}

/* ---- joining -------------------------------------------------------------------------------------------------------- */

static int reserve_joined(gnoi_piece_list *to, const gnoi_piece_list *lists, size_t count)
{
    size_t pieces = 0, rings = 0, points = 0, lights = 0;
    for (size_t i = 0; i < count; i++) {
        pieces += lists[i].count;
        for (size_t k = 0; k < lists[i].count; k++) { /* a list may hold what belongs to no piece any more */
            const gnoi_piece *p = &lists[i].pieces[k];
            rings += p->ring_count;
            points += lists[i].ring_start[p->ring + p->ring_count] - lists[i].ring_start[p->ring];
            lights += p->light_count;
        }
    }
    to->capacity = pieces;
    to->pieces = gnoi_malloc(to->context, pieces, sizeof *to->pieces);
    to->ring_capacity = rings + 1;
    to->ring_start = gnoi_malloc(to->context, rings + 1, sizeof *to->ring_start);
    to->point_capacity = 3 * points;
    to->points = gnoi_malloc(to->context, 3 * points, sizeof *to->points);
    to->light_capacity = lights;
    to->lights = gnoi_malloc(to->context, lights, sizeof *to->lights);
    to->passed_capacity = 3 * lights;
    to->passed = gnoi_malloc(to->context, 3 * lights, sizeof *to->passed);
    return to->pieces && to->ring_start && to->points && to->lights && to->passed;
}

static void copy_piece(gnoi_piece_list *to, const gnoi_piece_list *from, const gnoi_piece *piece)
{
    gnoi_piece *fresh = &to->pieces[to->count++];
    *fresh = *piece;
    fresh->ring = to->ring_count;
    fresh->light = to->light_count;
    for (size_t r = piece->ring; r < piece->ring + piece->ring_count; r++) {
        size_t n = from->ring_start[r + 1] - from->ring_start[r];
        memcpy(to->points + 3 * to->point_count, from->points + 3 * from->ring_start[r], 3 * n * sizeof *to->points);
        to->ring_start[to->ring_count++] = to->point_count;
        to->point_count += n;
    }
    to->ring_start[to->ring_count] = to->point_count;
    if (piece->light_count > 0) {
        memcpy(to->lights + to->light_count, from->lights + piece->light, piece->light_count * sizeof *to->lights);
        memcpy(to->passed + 3 * to->light_count, from->passed + 3 * piece->light, 3 * piece->light_count * sizeof *to->passed);
    }
    to->light_count += piece->light_count;
}

/* Every piece in every list, as (list, piece), put in the order of polygons by counting. */
typedef struct place {
    uint32_t list, piece;
} place;

static int copy_in_order(gno_pieces *set, const gnoi_piece_list *lists, size_t count)
{
    gno_context *context = set->list.context;
    size_t total = set->list.capacity, *next = set->first;
    place *order = gnoi_malloc(context, total, sizeof *order);
    if (!order)
        return 0;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < lists[i].count; k++)
            next[lists[i].pieces[k].polygon + 1]++;
    for (size_t p = 0; p < set->polygon_count; p++)
        next[p + 1] += next[p];
    for (size_t i = count; i-- > 0;)
        for (size_t k = lists[i].count; k-- > 0;) {
            place *at = &order[--next[lists[i].pieces[k].polygon + 1]];
            at->list = (uint32_t)i;
            at->piece = (uint32_t)k;
        }
    /* Filled from the back, entry p+1 is now where polygon p begins; entry 0 is 0. */
    memmove(next, next + 1, set->polygon_count * sizeof *next);
    next[set->polygon_count] = total;
    for (size_t i = 0; i < total; i++)
        copy_piece(&set->list, &lists[order[i].list], &lists[order[i].list].pieces[order[i].piece]);
    gnoi_free(context, order, total, sizeof *order);
    return 1;
}

gno_status gnoi_pieces_join(gno_context *context, const gnoi_piece_list *lists, size_t count, size_t polygons, gno_pieces **pieces)
{
    gno_pieces *set = gnoi_calloc(context, 1, sizeof *set);
    if (!set)
        return GNO_ERROR_MEMORY;
    set->list.context = context;
    set->polygon_count = polygons;
    set->first = gnoi_calloc(context, polygons + 1, sizeof *set->first);
    if (!set->first || !reserve_joined(&set->list, lists, count) || !copy_in_order(set, lists, count)) {
        gno_pieces_destroy(set);
        return GNO_ERROR_MEMORY;
    }
    *pieces = set;
    return GNO_OK;
}

/* ---- public ---------------------------------------------------------------------------------------------------------- */

void gno_pieces_destroy(gno_pieces *pieces)
{
    gno_context *context;
    if (!pieces)
        return;
    context = pieces->list.context;
    gnoi_free(context, pieces->first, pieces->polygon_count + 1, sizeof *pieces->first);
    gnoi_piece_list_free(&pieces->list);
    gno_pieces_destroy(pieces->beside);
    gnoi_free(context, pieces, 1, sizeof *pieces);
}

size_t gno_pieces_count(const gno_pieces *pieces) { return pieces ? pieces->list.count : 0; }

gno_status gno_pieces_get(const gno_pieces *pieces, size_t index, gno_piece *piece)
{
    const gnoi_piece *p;
    if (!pieces || !piece || index >= pieces->list.count)
        return pieces ? gnoi_fail(pieces->list.context, GNO_ERROR_ARGUMENT, "piece %lu: there are %lu", (unsigned long)index,
                                  (unsigned long)pieces->list.count)
                      : GNO_ERROR_ARGUMENT;
    p = &pieces->list.pieces[index];
    piece->polygon = p->polygon;
    piece->side = p->side;
    piece->ring_count = p->ring_count;
    piece->ring_start = pieces->list.ring_start + p->ring;
    piece->points = pieces->list.points;
    piece->area = p->area;
    memcpy(piece->centroid, p->centroid, sizeof piece->centroid);
    piece->light_count = p->light_count;
    piece->lights = pieces->list.lights + p->light;
    piece->passed = pieces->list.passed + 3 * p->light;
    return GNO_OK;
}

gno_status gno_pieces_of(const gno_pieces *pieces, size_t polygon, size_t *first, size_t *count)
{
    if (!pieces || !first || !count || polygon >= pieces->polygon_count)
        return pieces ? gnoi_fail(pieces->list.context, GNO_ERROR_ARGUMENT, "polygon %lu: the pieces are of %lu", (unsigned long)polygon,
                                  (unsigned long)pieces->polygon_count)
                      : GNO_ERROR_ARGUMENT;
    *first = pieces->first[polygon];
    *count = pieces->first[polygon + 1] - pieces->first[polygon];
    return GNO_OK;
}
