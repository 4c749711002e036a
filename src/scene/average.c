/* average.c -- averaged vertex normals.
 *
 * Place in the data flow: see average.h. Everything happens vertex by vertex, side by side: vertices with a corner that has no normal are
 * marked; the smooth polygons around them listed; then each such vertex sums the planes in its list, object by object, those beyond the
 * crease angle from the corner's own polygon left out. Vertices at one place are one (weld.c), for files repeat them along seams.
 * Pieces of vertices number the normals that they make from zero; their corners carry LOCAL until it is known what comes before.
 * Invariants: every normal is a unit vector; lists have one order whatever the number of threads, so sums are always the same bits.
 * Source: Gouraud 1971 for averages; textbook equations 8.1.9 and 8.1.10 for weights by area; Thuermer and Wuethrich 1998
 * for weights by angle.
 */
#include "scene/average.h"
#include "base/parallel.h"
#include "base/tolerance.h"
#include "scene/chunks.h"
#include "scene/sides.h"

#include <string.h>

#define PIECE 2048 /* vertices */
#define LOCAL 0x80000000u

/* A smooth polygon's corner at a marked vertex. */
typedef struct use {
    uint32_t poly, corner;
} use;

typedef struct averaging {
    gnoi_preparing *w;
    gnoi_prepared *out;
    unsigned char *marked; /* of vertices */
    uint32_t low;          /* the first marked vertex */
    size_t span;           /* vertices from there to the last */
    unsigned char *near;   /* of chunks: some corner is at a vertex of these */
    uint32_t *start;       /* of these vertices, and two more: their uses */
    use *uses;
    double *area;          /* of polygons with a marked vertex, doubled */
    size_t piece_count;
    gnoi_normals *pieces;  /* of these vertices: their normals */
    uint32_t *base;        /* of pieces: the number of their first normal */
} averaging;

static const gnoi_object *object_of(const averaging *a, const gnoi_poly *poly)
{
    return &a->w->scene->objects[a->w->scene->polygon_object[poly->source]];
}

static vec3 position_at(const averaging *a, size_t corner) { return v3_from(a->out->positions[a->out->corner_vertex[corner]]); }

/* ---- lists of the polygons around a vertex --------------------------------------------------------------------------- */

static void mark_run(void *user, size_t first, size_t end)
{
    const averaging *a = user;
    const gnoi_prepared *out = a->out;
    if (!a->w->chunks[first / GNOI_CHUNK].open)
        return;
    for (size_t i = first; i < end; i++)
        for (uint32_t k = out->polys[i].corner; gnoi_is_smooth(&out->polys[i]) && k < out->polys[i].corner + out->polys[i].corner_count; k++)
            if (out->corner_normal[k] == GNOI_NONE)
                a->marked[out->corner_vertex[k]] = 1;
}

/* There is a marked vertex. */
static void set_span(averaging *a)
{
    const unsigned char *first = memchr(a->marked, 1, a->out->vertex_count);
    size_t last = a->out->vertex_count - 1;
    while (!a->marked[last])
        last--;
    a->low = (uint32_t)(first - a->marked);
    a->span = last - a->low + 1;
    a->piece_count = (a->span + PIECE - 1) / PIECE;
}

/* Few may be marked of very many: chunks without a corner among them are passed over without looking at their polygons. */
static gno_status look_chunk(void *user, int worker, size_t chunk)
{
    const averaging *a = user;
    const uint32_t low = a->low, most = (uint32_t)(a->span - 1);
    uint32_t inside = 0;
    (void)worker;
    for (size_t i = a->w->chunks[chunk].corner; i < a->w->chunks[chunk + 1].corner; i++)
        inside |= a->out->corner_vertex[i] - low <= most;
    a->near[chunk] = (unsigned char)inside;
    return GNO_OK;
}

/* Twice the area inside the outer ring. */
static double doubled_area(const averaging *a, const gnoi_poly *poly)
{
    size_t end = a->out->ring_corner[poly->ring + 1];
    vec3 first = position_at(a, poly->corner), normal = v3(0, 0, 0), before = v3(0, 0, 0);
    for (size_t corner = (size_t)poly->corner + 1; corner < end; corner++) {
        vec3 p = v3_sub(position_at(a, corner), first);
        normal = v3_add(normal, v3_cross(before, p));
        before = p;
    }
    return v3_length(normal);
}

static void count_run(void *user, size_t first, size_t end)
{
    const averaging *a = user;
    const gnoi_prepared *out = a->out;
    for (size_t i = first; a->near[first / GNOI_CHUNK] && i < end; i++) {
        const gnoi_poly *poly = &out->polys[i];
        int any = 0;
        for (uint32_t k = poly->corner; gnoi_is_smooth(poly) && k < poly->corner + poly->corner_count; k++)
            if (a->marked[out->corner_vertex[k]]) {
                a->start[out->corner_vertex[k] - a->low + 2]++;
                any = 1;
            }
        if (any)
            a->area[i] = doubled_area(a, poly);
    }
}

static void list_run(void *user, size_t first, size_t end)
{
    const averaging *a = user;
    const gnoi_prepared *out = a->out;
    for (size_t i = first; a->near[first / GNOI_CHUNK] && i < end; i++)
        for (uint32_t k = out->polys[i].corner; gnoi_is_smooth(&out->polys[i]) && k < out->polys[i].corner + out->polys[i].corner_count; k++)
            if (a->marked[out->corner_vertex[k]]) {
                use *u = &a->uses[a->start[out->corner_vertex[k] - a->low + 1]++];
                u->poly = (uint32_t)i;
                u->corner = k;
            }
}

static gno_status list_uses(averaging *a)
{
    gno_context *context = a->w->scene->context;
    gno_status status = gnoi_parallel(context, a->w->threads, a->w->chunk_count, "prepare", look_chunk, a);
    if (status == GNO_OK)
        status = gnoi_over_polygons(context, a->out, a->w->threads, count_run, a);
    if (status != GNO_OK)
        return status;
    for (size_t v = 2; v < a->span + 2; v++)
        a->start[v] += a->start[v - 1];
    a->uses = gnoi_malloc(context, a->start[a->span + 1], sizeof *a->uses);
    return a->uses ? gnoi_over_polygons(context, a->out, a->w->threads, list_run, a) : GNO_ERROR_MEMORY;
}

/* ---- weights -------------------------------------------------------------------------------------------------------- */

/* The ring of a polygon that a corner is in. */
static void ring_of(const averaging *a, const gnoi_poly *poly, size_t corner, size_t *from, size_t *to)
{
    uint32_t ring = poly->ring;
    while (a->out->ring_corner[ring + 1] <= corner)
        ring++;
    *from = a->out->ring_corner[ring];
    *to = a->out->ring_corner[ring + 1];
}

/* The next corner around the ring, by `step` 1 or -1, at another vertex; `corner` itself where there is none. */
static size_t neighbour(const averaging *a, size_t from, size_t to, size_t corner, int step)
{
    size_t other = corner;
    do {
        if (step > 0)
            other = other + 1 < to ? other + 1 : from;
        else
            other = other > from ? other - 1 : to - 1;
    } while (other != corner && a->out->corner_vertex[other] == a->out->corner_vertex[corner]);
    return other;
}

/* The polygon's angle at a corner; beyond 180 degrees at a reflex corner of the outer ring. */
static double angle_at(const averaging *a, const gnoi_poly *poly, size_t from, size_t to, size_t corner)
{
    vec3 at = position_at(a, corner);
    vec3 after = v3_sub(position_at(a, neighbour(a, from, to, corner, 1)), at);
    vec3 before = v3_sub(position_at(a, neighbour(a, from, to, corner, -1)), at);
    vec3 cross = v3_cross(after, before);
    double angle = atan2(v3_length(cross), v3_dot(after, before));
    int reflex = from == poly->corner && v3_dot(cross, v3_from(poly->n)) < 0;
    return reflex ? 2 * acos(-1.0) - angle : angle;
}

/* A corner that repeats the point before it weighs nothing. */
static double weight_of(const averaging *a, use u, gno_weighting weighting)
{
    const gnoi_poly *poly = &a->out->polys[u.poly];
    size_t from, to;
    ring_of(a, poly, u.corner, &from, &to);
    if (a->out->corner_vertex[u.corner > from ? u.corner - 1 : to - 1] == a->out->corner_vertex[u.corner])
        return 0;
    if (weighting == GNO_WEIGHTING_ANGLE)
        return angle_at(a, poly, from, to, u.corner);
    return weighting == GNO_WEIGHTING_AREA ? a->area[u.poly] : 1;
}

/* ---- one vertex ------------------------------------------------------------------------------------------------------ */

/* The uses of one object at a vertex, in their order. */
static gno_status gather(const averaging *a, const use *uses, size_t count, const gnoi_object *object, gnoi_around *around)
{
    void *array = around->entries;
    if (!gnoi_reserve(a->w->scene->context, &array, &around->capacity, count, sizeof *around->entries))
        return GNO_ERROR_MEMORY;
    around->entries = array;
    around->count = 0;
    for (size_t i = 0; i < count; i++) {
        const gnoi_poly *poly = &a->out->polys[uses[i].poly];
        gnoi_around_entry *e = &around->entries[around->count];
        if (object_of(a, poly) != object)
            continue;
        e->normal = &a->out->corner_normal[uses[i].corner];
        e->n = v3_from(poly->n);
        e->weight = weight_of(a, uses[i], object->weighting);
        around->count++;
    }
    return GNO_OK;
}

/* Objects are taken in the order of their first open corner; what they leave open is another's. */
static gno_status settle_vertex(const averaging *a, uint32_t vertex, gnoi_around *around, gnoi_normals *normals)
{
    const uint32_t *start = &a->start[vertex - a->low];
    const use *uses = a->uses + start[0];
    const size_t count = start[1] - start[0];
    gno_status status = GNO_OK;
    for (size_t i = 0; i < count && !status; i++) {
        const gnoi_object *object;
        if (a->out->corner_normal[uses[i].corner] != GNOI_NONE)
            continue;
        object = object_of(a, &a->out->polys[uses[i].poly]);
        status = gather(a, uses, count, object, around);
        if (status == GNO_OK)
            status = gnoi_settle_sides(a->w->scene->context, around, object->crease, LOCAL, normals);
    }
    return status;
}

static gno_status settle_piece(void *user, int worker, size_t piece)
{
    const averaging *a = user;
    gno_context *context = a->w->scene->context;
    size_t end = (piece + 1) * PIECE < a->span ? (piece + 1) * PIECE : a->span;
    gnoi_normals normals = {0};
    gnoi_around around = {0};
    gno_status status = GNO_OK;
    (void)worker;
    for (size_t v = piece * PIECE; v < end && !status; v++) {
        if (a->marked[a->low + v])
            status = settle_vertex(a, a->low + (uint32_t)v, &around, &normals);
        if (gnoi_stopped_at(context, v))
            status = GNO_ERROR_CANCELLED;
    }
    gnoi_free(context, around.entries, around.capacity, sizeof *around.entries);
    a->pieces[piece] = normals;
    return status;
}

/* ---- the whole ---------------------------------------------------------------------------------------------------------- */

static gno_status place_piece(void *user, int worker, size_t piece)
{
    const averaging *a = user;
    size_t first = piece * PIECE, end = first + PIECE < a->span ? first + PIECE : a->span;
    const gnoi_normals *normals = &a->pieces[piece];
    (void)worker;
    if (normals->count > 0)
        memcpy(a->out->normals[a->base[piece]], normals->n, normals->count * sizeof *normals->n);
    for (size_t i = a->start[first]; i < a->start[end]; i++) {
        uint32_t *normal = &a->out->corner_normal[a->uses[i].corner];
        if (*normal & LOCAL)
            *normal = a->base[piece] + (*normal & ~LOCAL);
    }
    return GNO_OK;
}

/* Appends the pieces' normals. */
static gno_status place_normals(averaging *a)
{
    gno_context *context = a->w->scene->context;
    gnoi_prepared *out = a->out;
    size_t sum = out->normal_count;
    float(*grown)[3];
    for (size_t k = 0; k < a->piece_count; k++) {
        a->base[k] = (uint32_t)sum;
        sum += a->pieces[k].count;
    }
    if (sum >= LOCAL)
        return gnoi_fail(context, GNO_ERROR_LIMIT, "prepare: more than %u normals", LOCAL);
    grown = gnoi_realloc(context, out->normals, out->normal_capacity, sum, sizeof *grown);
    if (!grown)
        return GNO_ERROR_MEMORY;
    out->normals = grown;
    out->normal_count = out->normal_capacity = sum;
    return gnoi_parallel(context, a->w->threads, a->piece_count, "prepare", place_piece, a);
}

static gno_status average(averaging *a)
{
    gno_context *context = a->w->scene->context;
    gno_status status = GNO_ERROR_MEMORY;
    a->start = gnoi_calloc(context, a->span + 2, sizeof *a->start);
    a->area = gnoi_malloc(context, a->out->poly_count, sizeof *a->area);
    a->pieces = gnoi_calloc(context, a->piece_count, sizeof *a->pieces);
    a->base = gnoi_malloc(context, a->piece_count, sizeof *a->base);
    if (a->start && a->area && a->pieces && a->base)
        status = list_uses(a);
    if (status == GNO_OK)
        status = gnoi_parallel(context, a->w->threads, a->piece_count, "prepare", settle_piece, a);
    if (status == GNO_OK)
        status = place_normals(a);
    for (size_t k = 0; a->pieces && k < a->piece_count; k++)
        gnoi_free(context, a->pieces[k].n, a->pieces[k].capacity, sizeof *a->pieces[k].n);
    gnoi_free(context, a->uses, a->uses ? a->start[a->span + 1] : 0, sizeof *a->uses);
    gnoi_free(context, a->base, a->piece_count, sizeof *a->base);
    gnoi_free(context, a->pieces, a->piece_count, sizeof *a->pieces);
    gnoi_free(context, a->area, a->out->poly_count, sizeof *a->area);
    gnoi_free(context, a->start, a->span + 2, sizeof *a->start);
    return status;
}

gno_status gnoi_average_normals(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    gno_status status = GNO_ERROR_MEMORY;
    averaging a;
    memset(&a, 0, sizeof a);
    a.w = w;
    a.out = w->out;
    a.marked = gnoi_calloc(context, w->out->vertex_count, 1);
    a.near = gnoi_malloc(context, w->chunk_count, 1);
    if (a.marked && a.near)
        status = gnoi_over_polygons(context, a.out, w->threads, mark_run, &a);
    if (status == GNO_OK) {
        set_span(&a);
        status = average(&a);
    }
    gnoi_free(context, a.near, w->chunk_count, 1);
    gnoi_free(context, a.marked, w->out->vertex_count, 1);
    return status;
}
