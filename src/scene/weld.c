/* weld.c -- tells vertices apart by exact position.
 *
 * Place in the data flow: see weld.h. Files repeat a vertex along seams of texture and of normals; edges and averages must see one
 * point there.
 *   positions -> a hash of each -> vertices by the hash's upper bits, in their order -> a small table for each of these buckets
 * Invariants: all vertices of one place are in one bucket, by rising number, so the first one found there is the first of all; a table
 * is never more than half full, so that every search ends; positions are looked at only where hashes agree.
 * Source: partitioned hash join (Shatdal, Kant and Naughton 1994); the mixing constants are those of MurmurHash3's finalizer.
 */
#include "scene/weld.h"
#include "base/parallel.h"
#include "base/sort.h"

#include <string.h>

#define PIECE 16384        /* vertices */
#define BUCKET 256         /* vertices in a bucket, about */
#define MOST_BUCKET_BITS 11
#define SMALL_TABLE 2048   /* slots that need no memory from the context */

typedef struct welding {
    gno_context *context;
    size_t count, pieces, buckets;
    unsigned shift; /* of a hash: its bucket */
    const double (*positions)[3];
    uint32_t *same;   /* hashes at first */
    gnoi_keyed *list; /* hash and vertex, by bucket */
    uint32_t *place;  /* of each piece and bucket: how many; then where the next one goes */
    uint32_t *start;  /* of each bucket, and one more */
} welding;

static uint32_t hash_position(const double p[3])
{
    uint64_t hash = 0x9e3779b97f4a7c15u, bits;
    for (int i = 0; i < 3; i++) {
        double x = p[i] + 0.0; /* the negative zero becomes the positive one */
        memcpy(&bits, &x, sizeof bits);
        hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
        hash ^= hash >> 32;
    }
    return (uint32_t)(hash * 0xc4ceb9fe1a85ec53u >> 32);
}

static size_t piece_end(const welding *w, size_t piece) { return (piece + 1) * PIECE < w->count ? (piece + 1) * PIECE : w->count; }

static gno_status hash_piece(void *user, int worker, size_t piece)
{
    const welding *w = user;
    uint32_t *place = w->place + piece * w->buckets;
    (void)worker;
    memset(place, 0, w->buckets * sizeof *place);
    for (size_t v = piece * PIECE, end = piece_end(w, piece); v < end; v++) {
        w->same[v] = hash_position(w->positions[v]);
        place[w->same[v] >> w->shift]++;
    }
    return GNO_OK;
}

static void set_places(const welding *w)
{
    uint32_t sum = 0;
    for (size_t b = 0; b < w->buckets; b++) {
        w->start[b] = sum;
        for (size_t k = 0; k < w->pieces; k++) {
            uint32_t n = w->place[k * w->buckets + b];
            w->place[k * w->buckets + b] = sum;
            sum += n;
        }
    }
    w->start[w->buckets] = sum;
}

static gno_status scatter_piece(void *user, int worker, size_t piece)
{
    const welding *w = user;
    uint32_t *place = w->place + piece * w->buckets;
    (void)worker;
    for (size_t v = piece * PIECE, end = piece_end(w, piece); v < end; v++) {
        gnoi_keyed *entry = &w->list[place[w->same[v] >> w->shift]++];
        entry->key = w->same[v];
        entry->value = (uint32_t)v;
    }
    return GNO_OK;
}

/* table: `mask` + 1 slots, all 0; a slot holds one more than a number in the list. */
static void weld_list(const welding *w, const gnoi_keyed *list, uint32_t count, uint32_t *table, uint32_t mask)
{
    for (uint32_t i = 0; i < count; i++) {
        const double *p = w->positions[list[i].value];
        uint32_t slot = list[i].key & mask;
        while (table[slot]) {
            const gnoi_keyed *other = &list[table[slot] - 1];
            const double *q = w->positions[other->value];
            if (other->key == list[i].key && p[0] == q[0] && p[1] == q[1] && p[2] == q[2])
                break;
            slot = (slot + 1) & mask;
        }
        if (!table[slot])
            table[slot] = i + 1;
        w->same[list[i].value] = list[table[slot] - 1].value;
    }
}

static gno_status weld_bucket(void *user, int worker, size_t bucket)
{
    const welding *w = user;
    const uint32_t count = w->start[bucket + 1] - w->start[bucket];
    uint32_t small[SMALL_TABLE], *table = small;
    size_t slots = 16;
    (void)worker;
    while (slots < 2 * (size_t)count)
        slots *= 2;
    if (slots > SMALL_TABLE)
        table = gnoi_malloc(w->context, slots, sizeof *table);
    if (!table)
        return GNO_ERROR_MEMORY;
    memset(table, 0, slots * sizeof *table);
    weld_list(w, w->list + w->start[bucket], count, table, (uint32_t)(slots - 1));
    if (table != small)
        gnoi_free(w->context, table, slots, sizeof *table);
    return GNO_OK;
}

static gno_status weld(welding *w, int threads)
{
    gno_status status;
    if (!w->list || !w->place || !w->start)
        return gnoi_fail(w->context, GNO_ERROR_MEMORY, "prepare: out of memory");
    status = gnoi_parallel(w->context, threads, w->pieces, "prepare", hash_piece, w);
    if (status)
        return status;
    set_places(w);
    status = gnoi_parallel(w->context, threads, w->pieces, "prepare", scatter_piece, w);
    return status ? status : gnoi_parallel(w->context, threads, w->buckets, "prepare", weld_bucket, w);
}

gno_status gnoi_weld(gno_context *context, int threads, size_t count, const double (*positions)[3], uint32_t *same)
{
    welding w = {context, count, (count + PIECE - 1) / PIECE, 2, 31, positions, same, NULL, NULL, NULL};
    gno_status status;
    while (w.buckets < count / BUCKET && 32 - w.shift < MOST_BUCKET_BITS) {
        w.buckets *= 2;
        w.shift--;
    }
    w.list = gnoi_malloc(context, count, sizeof *w.list);
    w.place = gnoi_malloc(context, w.pieces * w.buckets, sizeof *w.place);
    w.start = gnoi_malloc(context, w.buckets + 1, sizeof *w.start);
    status = weld(&w, threads);
    gnoi_free(context, w.list, count, sizeof *w.list);
    gnoi_free(context, w.place, w.pieces * w.buckets, sizeof *w.place);
    gnoi_free(context, w.start, w.buckets + 1, sizeof *w.start);
    return status;
}
