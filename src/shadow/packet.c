/* packet.c -- see packet.h.
 *
 *   chunks of polygons -> boxes -> bins (size class, face), counted -> places in one row of entries -> runs of it split (packet_split.c)
 *   -> packets, their corners -> levels above
 *
 * All but the last step runs in pieces on any number of threads; places come from counts alone.
 */
#include "shadow/packet.h"
#include "base/parallel.h"

#include <float.h>
#include <string.h>

#define CHUNK 4096          /* polygons */
#define RUN_PACKETS (GNOI_RUN / GNOI_PACKET)
#define SIZE_CLASSES 6
#define CLASS_FACTOR (1.0f / 16) /* each class holds boxes this many times smaller than the one before */
#define MOST_BINS (SIZE_CLASSES * 6)

typedef gnoi_packet_entry entry;

typedef struct chunk {
    size_t count, capacity;
    entry *entries;
    float u0, u1, v0, v1;
    size_t place[MOST_BINS]; /* first a count, then where the chunk's share of the bin begins */
} chunk;

typedef struct job {
    const gno_scene *scene;
    gnoi_packets *packets;
    size_t chunk_count;
    chunk *chunks;
    size_t place_count;
    entry *places; /* all entries by bin; those of no polygon have GNOI_NONE */
    float whole;   /* side of the square that holds all boxes */
} job;

static size_t min_size(size_t a, size_t b) { return a < b ? a : b; }

/* ---- points of a polygon ------------------------------------------------------------------------------------------- */

/* Whether the ring turns one way at each of its (at most four) corners. */
static int is_convex(const vec3 *p, int count, vec3 n)
{
    for (int i = 0; i < count && count > 3; i++) {
        vec3 a = p[i], b = p[(i + 1) % count], c = p[(i + 2) % count];
        if (!(v3_dot(v3_cross(v3_sub(b, a), v3_sub(c, b)), n) > 0))
            return 0;
    }
    return 1;
}

/* The rectangle around the corners along the first edge that is no point. */
static void bounding_rectangle(const gnoi_prepared *prep, const gnoi_poly *poly, vec3 points[4])
{
    uint32_t first = poly->corner, end = prep->ring_corner[poly->ring + 1];
    vec3 n = v3_from(poly->n), origin = v3_from(prep->positions[prep->corner_vertex[first]]), e1, e2;
    double lo[2] = {0, 0}, hi[2] = {0, 0};
    e1 = v3_unit(v3_cross(n, fabs(n.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0)));
    for (uint32_t i = first + 1; i < end; i++) {
        vec3 edge = v3_sub(v3_from(prep->positions[prep->corner_vertex[i]]), origin);
        vec3 flat = v3_mad(edge, n, -v3_dot(edge, n));
        if (v3_dot(flat, flat) > 0) {
            e1 = v3_unit(flat);
            break;
        }
    }
    e2 = v3_cross(n, e1);
    for (uint32_t i = first; i < end; i++) {
        vec3 q = v3_sub(v3_from(prep->positions[prep->corner_vertex[i]]), origin);
        double s = v3_dot(q, e1), t = v3_dot(q, e2);
        lo[0] = s < lo[0] ? s : lo[0];
        hi[0] = s > hi[0] ? s : hi[0];
        lo[1] = t < lo[1] ? t : lo[1];
        hi[1] = t > hi[1] ? t : hi[1];
    }
    points[0] = v3_mad(v3_mad(origin, e1, lo[0]), e2, lo[1]);
    points[1] = v3_mad(v3_mad(origin, e1, hi[0]), e2, lo[1]);
    points[2] = v3_mad(v3_mad(origin, e1, hi[0]), e2, hi[1]);
    points[3] = v3_mad(v3_mad(origin, e1, lo[0]), e2, hi[1]);
}

int gnoi_poly_points(const gno_scene *scene, const gnoi_poly *poly, vec3 points[GNOI_PACKET_CORNERS], int *exact)
{
    const gnoi_prepared *prep = &scene->prepared;
    *exact = 0;
    if (poly->corner_count <= GNOI_PACKET_CORNERS && poly->ring_count == 1) {
        int count = (int)poly->corner_count;
        for (int i = 0; i < count; i++)
            points[i] = v3_from(prep->positions[prep->corner_vertex[poly->corner + (uint32_t)i]]);
        *exact = is_convex(points, count, v3_from(poly->n));
        if (*exact)
            return count;
    }
    bounding_rectangle(prep, poly, points);
    return 4;
}

/* ---- boxes and bins ---------------------------------------------------------------------------------------------- */

static void chunk_bounds(chunk *c, const gnoi_lbox *box)
{
    c->u0 = box->u0 < c->u0 ? box->u0 : c->u0;
    c->u1 = box->u1 > c->u1 ? box->u1 : c->u1;
    c->v0 = box->v0 < c->v0 ? box->v0 : c->v0;
    c->v1 = box->v1 > c->v1 ? box->v1 : c->v1;
}

static gno_status find_boxes(void *user, int worker, size_t piece)
{
    job *j = user;
    chunk *c = &j->chunks[piece];
    const gnoi_prepared *prep = &j->scene->prepared;
    size_t first = piece * CHUNK, end = min_size(first + CHUNK, prep->poly_count);
    (void)worker;
    c->u0 = c->v0 = FLT_MAX;
    c->u1 = c->v1 = -FLT_MAX;
    c->entries = gnoi_malloc(j->scene->context, end - first, sizeof *c->entries);
    if (!c->entries)
        return GNO_ERROR_MEMORY;
    c->capacity = end - first;
    for (size_t i = first; i < end; i++) {
        vec3 points[GNOI_PACKET_CORNERS];
        gnoi_lbox boxes[6];
        int exact, n = gnoi_poly_points(j->scene, &prep->polys[i], points, &exact);
        n = gnoi_frame_boxes(&j->packets->frame, points, n, boxes);
        n = n > 0 ? n : gnoi_frame_everywhere(boxes);
        if (!gnoi_reserve(j->scene->context, (void **)&c->entries, &c->capacity, c->count + (size_t)n, sizeof *c->entries))
            return GNO_ERROR_MEMORY;
        for (int k = 0; k < n; k++) {
            c->entries[c->count].box = boxes[k];
            c->entries[c->count++].poly = (uint32_t)i;
            if (boxes[k].u1 < FLT_MAX)
                chunk_bounds(c, &boxes[k]);
        }
    }
    return GNO_OK;
}

static uint32_t bin_of(const gnoi_lbox *box, float whole, int faces)
{
    float du = box->u1 - box->u0, dv = box->v1 - box->v0, size = du > dv ? du : dv, limit = whole * CLASS_FACTOR;
    uint32_t level = 0, face = 0;
    for (; level < SIZE_CLASSES - 1 && size < limit; limit *= CLASS_FACTOR)
        level++;
    if (faces > 1 && box->u1 < FLT_MAX)
        face = (uint32_t)((0.5f * (box->u0 + box->u1)) / (float)GNOI_FACE_STEP + 0.5f);
    return level * (uint32_t)faces + (face < (uint32_t)faces ? face : 0);
}

static gno_status count_bins(void *user, int worker, size_t piece)
{
    job *j = user;
    chunk *c = &j->chunks[piece];
    (void)worker;
    for (size_t i = 0; i < c->count; i++) {
        c->entries[i].bin = bin_of(&c->entries[i].box, j->whole, j->packets->frame.faces);
        c->place[c->entries[i].bin]++;
    }
    return GNO_OK;
}

static void find_whole(job *j)
{
    float u0 = FLT_MAX, u1 = -FLT_MAX, v0 = FLT_MAX, v1 = -FLT_MAX;
    for (size_t i = 0; i < j->chunk_count; i++) {
        const chunk *c = &j->chunks[i];
        u0 = c->u0 < u0 ? c->u0 : u0;
        u1 = c->u1 > u1 ? c->u1 : u1;
        v0 = c->v0 < v0 ? c->v0 : v0;
        v1 = c->v1 > v1 ? c->v1 : v1;
    }
    j->whole = u1 - u0 > v1 - v0 ? u1 - u0 : v1 - v0;
    if (j->packets->frame.faces > 1)
        j->whole = 2;
}

/* Entries of a bin begin where their packets, nodes and nodes of nodes begin. */
static size_t alignment(size_t count)
{
    size_t a = GNOI_PACKET;
    while (a < count && a < GNOI_RUN)
        a *= GNOI_PACKET;
    return a;
}

static size_t round_up(size_t n, size_t to) { return (n + to - 1) / to * to; }

/* Turns counts into places. */
static void give_places(job *j)
{
    size_t place = 0, bins = (size_t)SIZE_CLASSES * (size_t)j->packets->frame.faces;
    for (size_t b = 0; b < bins; b++) {
        size_t total = 0;
        for (size_t i = 0; i < j->chunk_count; i++)
            total += j->chunks[i].place[b];
        place = round_up(place, alignment(total));
        for (size_t i = 0; i < j->chunk_count; i++) {
            size_t n = j->chunks[i].place[b];
            j->chunks[i].place[b] = place;
            place += n;
        }
    }
    j->place_count = round_up(place, GNOI_PACKET);
}

static gno_status clear_places(void *user, int worker, size_t piece)
{
    job *j = user;
    size_t end = min_size((piece + 1) * GNOI_RUN, j->place_count);
    (void)worker;
    for (size_t i = piece * GNOI_RUN; i < end; i++) {
        static const entry empty = {{FLT_MAX, -FLT_MAX, FLT_MAX, -FLT_MAX, FLT_MAX, -FLT_MAX}, GNOI_NONE, 0};
        j->places[i] = empty;
    }
    return GNO_OK;
}

static gno_status fill_places(void *user, int worker, size_t piece)
{
    job *j = user;
    chunk *c = &j->chunks[piece];
    (void)worker;
    for (size_t i = 0; i < c->count; i++)
        j->places[c->place[c->entries[i].bin]++] = c->entries[i];
    gnoi_free(j->scene->context, c->entries, c->capacity, sizeof *c->entries);
    c->entries = NULL;
    return GNO_OK;
}

/* The runs of whole entries of one bin in a piece of the row. */
static void split_runs(entry *places, size_t count, int parallel)
{
    for (size_t from = 0, to; from < count; from = to) {
        to = from + 1;
        if (places[from].poly == GNOI_NONE)
            continue;
        while (to < count && places[to].poly != GNOI_NONE && places[to].bin == places[from].bin)
            to++;
        gnoi_packet_split(places + from, to - from, parallel);
    }
}

/* ---- packets ------------------------------------------------------------------------------------------------------ */

static int casts(const gno_scene *scene, const gnoi_poly *poly)
{
    const double *t = scene->materials[poly->material].transmission;
    return !poly->detail && (poly->opaque || !(t[0] >= 1 && t[1] >= 1 && t[2] >= 1));
}

static void fill_corners(const gno_scene *scene, gnoi_packet *packet)
{
    float extent = 0;
    vec3 points[GNOI_PACKET_CORNERS], origin = v3(0, 0, 0);
    packet->casts = packet->exact = 0;
    for (int k = 0; k < GNOI_PACKET; k++) {
        const gnoi_poly *poly;
        int count = 0, exact = 0;
        if (packet->poly[k] != GNOI_NONE) {
            poly = &scene->prepared.polys[packet->poly[k]];
            count = gnoi_poly_points(scene, poly, points, &exact);
            packet->casts |= (unsigned char)(casts(scene, poly) << k);
            packet->exact |= (unsigned char)(exact << k);
            if (k == 0)
                origin = points[0];
        }
        for (int i = 0; i < GNOI_PACKET_CORNERS; i++) {
            vec3 q = count > 0 ? v3_sub(points[i < count ? i : count - 1], origin) : v3(0, 0, 0);
            float x = (float)q.x, y = (float)q.y, z = (float)q.z, far = fmaxf(fabsf(x), fmaxf(fabsf(y), fabsf(z)));
            packet->x[i][k] = x;
            packet->y[i][k] = y;
            packet->z[i][k] = z;
            extent = far > extent ? far : extent;
        }
    }
    packet->extent = extent;
    packet->origin[0] = origin.x;
    packet->origin[1] = origin.y;
    packet->origin[2] = origin.z;
}

static gno_status fill_packets(void *user, int worker, size_t piece)
{
    job *j = user;
    size_t end = min_size((piece + 1) * RUN_PACKETS, j->packets->packet_count);
    (void)worker;
    split_runs(j->places + piece * GNOI_RUN, min_size(GNOI_RUN, j->place_count - piece * GNOI_RUN),
               j->packets->frame.parallel);
    for (size_t i = piece * RUN_PACKETS; i < end; i++) {
        const entry *e = &j->places[i * GNOI_PACKET];
        for (size_t k = 0; k < GNOI_PACKET; k++) {
            gnoi_eight_set(&j->packets->nodes[i], k, &e[k].box);
            j->packets->packets[i].poly[k] = e[k].poly;
        }
        fill_corners(j->scene, &j->packets->packets[i]);
    }
    return GNO_OK;
}

static void plan_levels(gnoi_packets *packets)
{
    size_t n = packets->packet_count;
    packets->levels = 0;
    packets->node_count = 0;
    while (n > 0) {
        packets->level_first[packets->levels++] = packets->node_count;
        packets->node_count += n;
        if (n == 1)
            break;
        n = (n + GNOI_PACKET - 1) / GNOI_PACKET;
    }
}

static void fill_levels(gnoi_packets *packets)
{
    for (int level = 1; level < packets->levels; level++) {
        size_t below = packets->level_first[level - 1], first = packets->level_first[level];
        size_t end = level + 1 < packets->levels ? packets->level_first[level + 1] : packets->node_count;
        for (size_t i = first; i < end; i++)
            gnoi_eight_clear(&packets->nodes[i]);
        for (size_t i = below; i < first; i++) {
            gnoi_lbox box = gnoi_eight_union(&packets->nodes[i]);
            gnoi_eight_set(&packets->nodes[first + (i - below) / GNOI_PACKET], (i - below) % GNOI_PACKET, &box);
        }
    }
}

/* ---- building ----------------------------------------------------------------------------------------------------- */

static void free_chunks(job *j)
{
    for (size_t i = 0; j->chunks && i < j->chunk_count; i++)
        gnoi_free(j->scene->context, j->chunks[i].entries, j->chunks[i].capacity, sizeof *j->chunks[i].entries);
    gnoi_free(j->scene->context, j->chunks, j->chunk_count, sizeof *j->chunks);
    gnoi_free(j->scene->context, j->places, j->place_count, sizeof *j->places);
}

static gno_status place_polygons(job *j, int threads)
{
    gno_context *context = j->scene->context;
    gnoi_packets *packets = j->packets;
    static const char stage[] = "shadow boxes";
    gno_status status = gnoi_parallel(context, threads, j->chunk_count, stage, find_boxes, j);
    size_t runs;
    if (status)
        return status;
    find_whole(j);
    status = gnoi_parallel(context, threads, j->chunk_count, stage, count_bins, j);
    if (status)
        return status;
    give_places(j);
    j->places = gnoi_malloc(context, j->place_count, sizeof *j->places);
    if (!j->places)
        return GNO_ERROR_MEMORY;
    runs = (j->place_count + GNOI_RUN - 1) / GNOI_RUN;
    status = gnoi_parallel(context, threads, runs, stage, clear_places, j);
    if (!status)
        status = gnoi_parallel(context, threads, j->chunk_count, stage, fill_places, j);
    if (status)
        return status;
    /* Only now, when the chunks' entries are gone. */
    packets->packet_count = j->place_count / GNOI_PACKET;
    plan_levels(packets);
    packets->packets = gnoi_malloc(context, packets->packet_count, sizeof *packets->packets);
    packets->nodes = gnoi_malloc(context, packets->node_count, sizeof *packets->nodes);
    if (!packets->packets || !packets->nodes)
        return GNO_ERROR_MEMORY;
    status = gnoi_parallel(context, threads, runs, stage, fill_packets, j);
    if (!status)
        fill_levels(packets);
    return status;
}

gno_status gnoi_packets_build(const gno_scene *scene, const gnoi_lamp *lamp, int threads, gnoi_packets *packets)
{
    gno_status status = GNO_ERROR_MEMORY;
    job j;
    memset(&j, 0, sizeof j);
    memset(packets, 0, sizeof *packets);
    packets->frame = gnoi_frame_make(lamp, scene->prepared.lower, scene->prepared.upper);
    j.scene = scene;
    j.packets = packets;
    j.chunk_count = (scene->prepared.poly_count + CHUNK - 1) / CHUNK;
    j.chunks = gnoi_calloc(scene->context, j.chunk_count, sizeof *j.chunks);
    if (j.chunks)
        status = place_polygons(&j, threads);
    free_chunks(&j);
    if (status)
        gnoi_packets_free(scene->context, packets);
    return status;
}

void gnoi_packets_free(gno_context *context, gnoi_packets *packets)
{
    gnoi_free(context, packets->packets, packets->packet_count, sizeof *packets->packets);
    gnoi_free(context, packets->nodes, packets->node_count, sizeof *packets->nodes);
    packets->packets = NULL;
    packets->nodes = NULL;
    packets->packet_count = packets->node_count = 0;
    packets->levels = 0;
}

/* ---- searching ---------------------------------------------------------------------------------------------------- */

int gnoi_packets_find(gno_context *context, const gnoi_packets *packets, const gnoi_lbox *box, gnoi_packet_list *found)
{
    struct { int level; uint32_t node; } stack[GNOI_PACKET * GNOI_PACKET_LEVELS];
    int top = 0;
    if (packets->levels == 0)
        return 1;
    stack[top].level = packets->levels - 1;
    stack[top++].node = 0;
    while (top > 0) {
        int level = stack[--top].level;
        uint32_t node = stack[top].node;
        unsigned mask = gnoi_eight_meet(&packets->nodes[packets->level_first[level] + node], box);
        if (level > 0) {
            for (; mask; mask &= mask - 1) {
                stack[top].level = level - 1;
                stack[top++].node = node * GNOI_PACKET + gnoi_lowest_bit(mask);
            }
        } else if (mask) {
            if (found->count == found->capacity &&
                !gnoi_reserve(context, (void **)&found->items, &found->capacity, found->count + 1, sizeof *found->items))
                return 0;
            found->items[found->count++] = node;
        }
    }
    return 1;
}
