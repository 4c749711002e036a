/* packet.c -- see packet.h.
 *
 *   chunks of polygons -> boxes -> bins (size class, face), counted -> places in one row of entries -> runs of it split (packet_split.c)
 *   -> packets, their corners -> levels above
 *
 * All but the last step runs in pieces on any number of threads; places come from counts alone.
 */
#include "shadow/packet.h"
#include "base/parallel.h"
#include "base/tolerance.h"

#include <float.h>
#include <string.h>

#define CHUNK 4096          /* polygons */
#define RUN_PACKETS (GNOI_RUN / GNOI_PACKET)
#define LINE (64 / sizeof(float)) /* numbers in a line of the cache */
#define SIZE_CLASSES 6
#define MAIN_CLASS 2    /* the one that holds as many as can be */
#define CLASS_OCTAVES 4 /* each class holds boxes 16 times smaller than the one before */
#define OCTAVES 256     /* binary exponents of single precision */
#define MOST_BINS (SIZE_CLASSES * 6)

typedef gnoi_packet_entry entry;

typedef struct chunk {
    size_t count, capacity;
    entry *entries;
    int all_convex;
    uint16_t octave[OCTAVES]; /* boxes of each size */
    size_t place[MOST_BINS]; /* first a count, then where the chunk's share of the bin begins */
} chunk;

typedef struct job {
    const gno_scene *scene;
    const gnoi_packet_source *source;
    gnoi_packets *packets;
    size_t chunk_count;
    chunk *chunks;
    size_t place_count, run_count;
    entry **runs; /* all entries by bin, GNOI_RUN of them each; those of no polygon have GNOI_NONE. Freed one by one as they become packets */
    int top;       /* octave of the largest boxes of the main class */
} job;

static size_t min_size(size_t a, size_t b) { return a < b ? a : b; }

/* ---- own shadow --------------------------------------------------------------------------------------------------- */

int gnoi_judge_own_shadow(const gnoi_packet_source *source, const gnoi_poly *poly)
{
    const gnoi_prepared *prep = &source->scene->prepared;
    double side = gnoi_lamp_side(&source->lamp, poly->n, poly->d), far = 1;
    uint32_t solid = gnoi_solid_of(prep, poly);
    if (!source->lamp.directional)
        far = v3_length(v3_sub(source->lamp.position, v3_from(prep->positions[prep->corner_vertex[poly->corner]])));
    if (fabs(side) <= GNOI_PARALLEL * far)
        return GNOI_OWN;
    if (source->outside[solid])
        return (side > 0) == (prep->solids[solid].outwards != 0) ? GNOI_SEARCH : GNOI_OWN;
    return side > 0 ? GNOI_SEARCH : poly->two_sided ? GNOI_OWN | GNOI_SEARCH : GNOI_OWN;
}

/* ---- boxes and bins ---------------------------------------------------------------------------------------------- */

/* The binary exponent of the longer side. */
static int octave_of(const gnoi_lbox *box)
{
    float du = box->u1 - box->u0, dv = box->v1 - box->v0, size = du > dv ? du : dv;
    uint32_t bits;
    memcpy(&bits, &size, sizeof bits);
    return (int)(bits >> 23 & (OCTAVES - 1));
}

static gno_status find_boxes(void *user, int worker, size_t piece)
{
    job *j = user;
    chunk *c = &j->chunks[piece];
    const gnoi_prepared *prep = &j->scene->prepared;
    size_t first = piece * CHUNK, end = min_size(first + CHUNK, prep->poly_count);
    (void)worker;
    c->all_convex = 1;
    c->entries = gnoi_malloc(j->scene->context, end - first, sizeof *c->entries);
    if (!c->entries)
        return GNO_ERROR_MEMORY;
    c->capacity = end - first;
    for (size_t i = first; i < end; i++) {
        vec3 points[GNOI_PACKET_CORNERS];
        gnoi_lbox boxes[6];
        int exact, n = gnoi_poly_points(j->scene, &prep->polys[i], points, &exact);
        unsigned char own = (unsigned char)gnoi_judge_own_shadow(j->source, &prep->polys[i]);
        c->all_convex &= exact;
        n = gnoi_frame_boxes(&j->packets->frame, points, n, boxes);
        n = n > 0 ? n : gnoi_frame_everywhere(boxes);
        if (!gnoi_reserve(j->scene->context, (void **)&c->entries, &c->capacity, c->count + (size_t)n, sizeof *c->entries))
            return GNO_ERROR_MEMORY;
        for (int k = 0; k < n; k++) {
            c->entries[c->count].box = boxes[k];
            c->entries[c->count].own = own;
            c->entries[c->count].exact = (unsigned char)exact;
            c->entries[c->count++].poly = (uint32_t)i;
            c->octave[octave_of(&boxes[k])]++;
        }
    }
    return GNO_OK;
}

static uint32_t bin_of(const gnoi_lbox *box, int top, int faces)
{
    int below = top - octave_of(box), level = below < 0 ? MAIN_CLASS - 1 - (-below - 1) / CLASS_OCTAVES : MAIN_CLASS + below / CLASS_OCTAVES;
    uint32_t face = 0;
    level = level < 0 ? 0 : level < SIZE_CLASSES ? level : SIZE_CLASSES - 1;
    if (faces > 1 && box->u1 < FLT_MAX)
        face = (uint32_t)((0.5f * (box->u0 + box->u1)) / (float)GNOI_FACE_STEP + 0.5f);
    return (uint32_t)level * (uint32_t)faces + (face < (uint32_t)faces ? face : 0);
}

static gno_status count_bins(void *user, int worker, size_t piece)
{
    job *j = user;
    chunk *c = &j->chunks[piece];
    (void)worker;
    for (size_t i = 0; i < c->count; i++) {
        c->entries[i].bin = (uint16_t)bin_of(&c->entries[i].box, j->top, j->packets->frame.faces);
        c->place[c->entries[i].bin]++;
    }
    return GNO_OK;
}

/* Sets the classes so that no boundary parts boxes of about one size, the many of a scene. */
static void find_top(job *j)
{
    size_t octave[OCTAVES] = {0}, most = 0, held = 0;
    j->packets->all_convex = 1;
    for (size_t i = 0; i < j->chunk_count; i++) {
        j->packets->all_convex &= j->chunks[i].all_convex;
        for (int o = 0; o < OCTAVES; o++)
            octave[o] += j->chunks[i].octave[o];
    }
    for (int o = 0; o < OCTAVES; o++) {
        held += octave[o] - (o >= CLASS_OCTAVES ? octave[o - CLASS_OCTAVES] : 0);
        if (held > most) {
            most = held;
            j->top = o;
        }
    }
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

static size_t run_length(const job *j, size_t run) { return min_size(GNOI_RUN, j->place_count - run * GNOI_RUN); }

static gno_status clear_run(void *user, int worker, size_t piece)
{
    job *j = user;
    size_t count = run_length(j, piece);
    (void)worker;
    j->runs[piece] = gnoi_malloc(j->scene->context, count, sizeof *j->runs[piece]);
    if (!j->runs[piece])
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        static const entry empty = {{FLT_MAX, -FLT_MAX, FLT_MAX, -FLT_MAX, FLT_MAX, -FLT_MAX}, GNOI_NONE, 0, 0, 0};
        j->runs[piece][i] = empty;
    }
    return GNO_OK;
}

static void free_run(job *j, size_t run)
{
    gnoi_free(j->scene->context, j->runs[run], run_length(j, run), sizeof *j->runs[run]);
    j->runs[run] = NULL;
}

static gno_status fill_places(void *user, int worker, size_t piece)
{
    job *j = user;
    chunk *c = &j->chunks[piece];
    (void)worker;
    for (size_t i = 0; i < c->count; i++) {
        size_t place = c->place[c->entries[i].bin]++;
        j->runs[place / GNOI_RUN][place % GNOI_RUN] = c->entries[i];
    }
    gnoi_free(j->scene->context, c->entries, c->capacity, sizeof *c->entries);
    c->entries = NULL;
    return GNO_OK;
}

/* The runs of whole entries of one bin in a piece of the row: order[i] is the number of the entry at place i of the piece. */
static void split_runs(const entry *places, size_t count, int parallel, uint16_t order[GNOI_RUN])
{
    for (size_t from = 0, to; from < count; from = to) {
        to = from + 1;
        order[from] = (uint16_t)from;
        if (places[from].poly == GNOI_NONE)
            continue;
        while (to < count && places[to].poly != GNOI_NONE && places[to].bin == places[from].bin)
            to++;
        gnoi_packet_split(places + from, to - from, parallel, order + from);
        for (size_t i = from; i < to; i++)
            order[i] = (uint16_t)(order[i] + from);
    }
}

/* ---- packets ------------------------------------------------------------------------------------------------------ */

static int casts(const gno_scene *scene, const gnoi_poly *poly)
{
    const double *t = scene->materials[poly->material].transmission;
    return !poly->detail && (poly->opaque || !(t[0] >= 1 && t[1] >= 1 && t[2] >= 1));
}

typedef struct points {
    int count;
    vec3 at[GNOI_PACKET_CORNERS];
} points;

/* The corners of one polygon, in column k of the block. */
static void put_corners(const points *from, unsigned k, vec3 origin, gnoi_packet *packet, float *corner)
{
    for (uint32_t i = 0; i < packet->corner_count; i++, corner += 3 * GNOI_PACKET) {
        vec3 q = v3_sub(from->at[(int)i < from->count ? (int)i : from->count - 1], origin);
        float x = (float)q.x, y = (float)q.y, z = (float)q.z, far = fabsf(x) > fabsf(y) ? fabsf(x) : fabsf(y);
        far = fabsf(z) > far ? fabsf(z) : far;
        corner[k] = x;
        corner[GNOI_PACKET + k] = y;
        corner[2 * GNOI_PACKET + k] = z;
        packet->extent = far > packet->extent ? far : packet->extent;
    }
}

/* The corners' block is taken from `corner` on. Returns where the next one begins. */
static float *fill_packet(const job *j, const entry *const e[GNOI_PACKET], gnoi_packet *packet, float *corner)
{
    const gno_scene *scene = j->scene;
    points from[GNOI_PACKET];
    memset(packet, 0, sizeof *packet);
    packet->corner_count = 3;
    packet->corner = corner;
    for (unsigned k = 0; k < GNOI_PACKET; k++) {
        const gnoi_poly *poly;
        packet->poly[k] = packet->source[k] = GNOI_NONE;
        from[k].count = 0;
        if (e[k]->poly == GNOI_NONE)
            continue;
        poly = &scene->prepared.polys[e[k]->poly];
        from[k].count = gnoi_poly_points_again(scene, poly, e[k]->exact, from[k].at);
        packet->poly[k] = e[k]->poly;
        packet->source[k] = poly->source;
        packet->casts |= (unsigned char)(casts(scene, poly) << k);
        packet->exact |= (unsigned char)(e[k]->exact << k);
        packet->own |= (unsigned char)(((e[k]->own & GNOI_OWN) != 0) << k);
        packet->search |= (unsigned char)(((e[k]->own & GNOI_SEARCH) != 0) << k);
        if ((uint32_t)from[k].count > packet->corner_count)
            packet->corner_count = (uint32_t)from[k].count;
    }
    memset(corner, 0, 3 * GNOI_PACKET * packet->corner_count * sizeof *corner);
    for (unsigned k = 0; k < GNOI_PACKET && from[0].count > 0; k++)
        if (from[k].count > 0)
            put_corners(&from[k], k, from[0].at[0], packet, corner);
    if (from[0].count > 0) {
        packet->origin[0] = from[0].at[0].x;
        packet->origin[1] = from[0].at[0].y;
        packet->origin[2] = from[0].at[0].z;
    }
    return corner + 3 * GNOI_PACKET * packet->corner_count;
}

/* Room for the corners of a run's packets, as many as the longest of their polygons have. */
static size_t count_corners(const job *j, const entry *places, const uint16_t *order, size_t packet_count)
{
    size_t count = 0;
    for (size_t i = 0; i < packet_count; i++) {
        uint32_t most = 3;
        for (size_t k = 0; k < GNOI_PACKET; k++) {
            const entry *e = &places[order[i * GNOI_PACKET + k]];
            uint32_t n = e->poly == GNOI_NONE ? 0 : e->exact ? j->scene->prepared.polys[e->poly].corner_count : 4;
            most = n > most ? n : most;
        }
        count += most;
    }
    return 3 * GNOI_PACKET * count;
}

static gno_status fill_packets(void *user, int worker, size_t piece)
{
    job *j = user;
    gnoi_packets *packets = j->packets;
    gnoi_packet_block *block = &packets->blocks[piece];
    size_t first = piece * RUN_PACKETS, end = min_size(first + RUN_PACKETS, packets->packet_count);
    const entry *places = j->runs[piece];
    uint16_t order[GNOI_RUN];
    float *corner;
    (void)worker;
    split_runs(places, run_length(j, piece), packets->frame.parallel, order);
    block->count = count_corners(j, places, order, end - first) + LINE;
    block->corners = gnoi_malloc(j->scene->context, block->count, sizeof *block->corners);
    if (!block->corners)
        return GNO_ERROR_MEMORY;
    corner = block->corners + (LINE - (uintptr_t)block->corners / sizeof *corner % LINE) % LINE;
    for (size_t i = first; i < end; i++) {
        const entry *e[GNOI_PACKET];
        for (size_t k = 0; k < GNOI_PACKET; k++) {
            e[k] = &places[order[(i - first) * GNOI_PACKET + k]];
            gnoi_eight_set(&packets->nodes[i], k, &e[k]->box);
        }
        corner = fill_packet(j, e, &packets->packets[i], corner);
    }
    free_run(j, piece);
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
        if (n == 1 && packets->levels > 1)
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
    for (size_t i = 0; j->runs && i < j->run_count; i++)
        free_run(j, i);
    gnoi_free(j->scene->context, j->runs, j->run_count, sizeof *j->runs);
}

static gno_status place_polygons(job *j, int threads)
{
    gno_context *context = j->scene->context;
    gnoi_packets *packets = j->packets;
    static const char stage[] = "shadow boxes";
    gno_status status = gnoi_parallel(context, threads, j->chunk_count, stage, find_boxes, j);
    if (status)
        return status;
    find_top(j);
    status = gnoi_parallel(context, threads, j->chunk_count, stage, count_bins, j);
    if (status)
        return status;
    give_places(j);
    j->run_count = (j->place_count + GNOI_RUN - 1) / GNOI_RUN;
    j->runs = gnoi_calloc(context, j->run_count, sizeof *j->runs);
    if (!j->runs)
        return GNO_ERROR_MEMORY;
    status = gnoi_parallel(context, threads, j->run_count, stage, clear_run, j);
    if (!status)
        status = gnoi_parallel(context, threads, j->chunk_count, stage, fill_places, j);
    if (status)
        return status;
    /* Only now, when the chunks' entries are gone. */
    packets->packet_count = j->place_count / GNOI_PACKET;
    plan_levels(packets);
    packets->packets = gnoi_malloc(context, packets->packet_count, sizeof *packets->packets);
    packets->block_count = j->run_count;
    packets->blocks = gnoi_calloc(context, j->run_count, sizeof *packets->blocks);
    packets->nodes = gnoi_malloc(context, packets->node_count, sizeof *packets->nodes);
    if (!packets->packets || !packets->nodes || !packets->blocks)
        return GNO_ERROR_MEMORY;
    status = gnoi_parallel(context, threads, j->run_count, stage, fill_packets, j);
    if (!status)
        fill_levels(packets);
    return status;
}

gno_status gnoi_packets_build(const gnoi_packet_source *source, int threads, gnoi_packets *packets)
{
    const gno_scene *scene = source->scene;
    gno_status status = GNO_ERROR_MEMORY;
    job j;
    memset(&j, 0, sizeof j);
    memset(packets, 0, sizeof *packets);
    packets->frame = gnoi_frame_make(&source->lamp, scene->prepared.lower, scene->prepared.upper);
    j.scene = scene;
    j.source = source;
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
    for (size_t i = 0; packets->blocks && i < packets->block_count; i++)
        gnoi_free(context, packets->blocks[i].corners, packets->blocks[i].count, sizeof *packets->blocks[i].corners);
    gnoi_free(context, packets->blocks, packets->block_count, sizeof *packets->blocks);
    gnoi_free(context, packets->packets, packets->packet_count, sizeof *packets->packets);
    gnoi_free(context, packets->nodes, packets->node_count, sizeof *packets->nodes);
    packets->blocks = NULL;
    packets->packets = NULL;
    packets->nodes = NULL;
    packets->block_count = packets->packet_count = packets->node_count = 0;
    packets->levels = 0;
}

size_t gnoi_packets_bytes(const gnoi_packets *packets)
{
    size_t bytes = packets->packet_count * sizeof *packets->packets + packets->node_count * sizeof *packets->nodes;
    for (size_t i = 0; i < packets->block_count; i++)
        bytes += sizeof *packets->blocks + packets->blocks[i].count * sizeof *packets->blocks[i].corners;
    return bytes;
}

/* ---- searching ---------------------------------------------------------------------------------------------------- */

int gnoi_packets_find(gno_context *context, const gnoi_packets *packets, const gnoi_lbox *box, int level, gnoi_node_list *found)
{
    struct { int level; uint32_t node; } stack[GNOI_PACKET * GNOI_PACKET_LEVELS];
    int top = 0;
    if (packets->levels == 0)
        return 1;
    stack[top].level = packets->levels - 1;
    stack[top++].node = 0;
    while (top > 0) {
        int at = stack[--top].level;
        uint32_t node = stack[top].node;
        if (at == level) {
            if (!gnoi_reserve(context, (void **)&found->items, &found->capacity, found->count + 1, sizeof *found->items))
                return 0;
            found->items[found->count++] = node;
        } else {
            unsigned mask = gnoi_eight_meet(&packets->nodes[packets->level_first[at] + node], box);
            for (; mask; mask &= mask - 1) {
                stack[top].level = at - 1;
                stack[top++].node = node * GNOI_PACKET + gnoi_lowest_bit(mask);
            }
        }
    }
    return 1;
}
