/* matrix_search.c -- columns of the shadow matrix, a packet of eight receivers at a time.
 *
 *   64 packets -> box around their receivers -> nodes of 64 casters that may stand before it (far)
 *      -> 8 packets -> those before them (near)
 *         -> packet of receivers -> packets of casters -> boxes, eight by eight -> pairs -> sieve.h, eight at a time
 *            -> surely / surely not / overlap.h, one by one
 *
 * Receivers that lie together share the walk down the tree, each level of it with as many as the level holds.
 */
#include "shadow/matrix.h"
#include "base/sort.h"
#include "base/vector.h"
#include "shadow/lamp.h"
#include "shadow/sieve.h"

#include <string.h>

/* ---- search ------------------------------------------------------------------------------------------------------- */

gno_status gnoi_search_make(const gno_scene *scene, const gnoi_lamp *lamp, int threads, gnoi_search *search)
{
    const gnoi_prepared *prep = &scene->prepared;
    gno_status status;
    memset(search, 0, sizeof *search);
    search->from.scene = scene;
    search->from.lamp = *lamp;
    search->from.outside = gnoi_calloc(scene->context, prep->solid_count, 1);
    if (!search->from.outside)
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < prep->solid_count; i++)
        if (prep->solids[i].closed)
            search->from.outside[i] = (unsigned char)gnoi_lamp_outside(scene, i, lamp);
    status = gnoi_packets_build(&search->from, threads, &search->packets);
    if (!status && !search->packets.all_convex)
        status = gnoi_facets_build(scene, &search->facets);
    if (status)
        gnoi_search_free(search);
    return status;
}

void gnoi_search_free(gnoi_search *search)
{
    gno_context *context = search->from.scene->context;
    gnoi_packets_free(context, &search->packets);
    gnoi_facets_free(context, &search->facets);
    gnoi_free(context, search->from.outside, search->from.scene->prepared.solid_count, 1);
    search->from.outside = NULL;
}

void gnoi_findings_free(gnoi_findings *f)
{
    gnoi_free(f->context, f->columns, f->column_capacity, sizeof *f->columns);
    gnoi_free(f->context, f->casters, f->caster_capacity, sizeof *f->casters);
    f->columns = NULL;
    f->casters = NULL;
    f->column_count = f->column_capacity = f->caster_count = f->caster_capacity = 0;
}

void gnoi_search_scratch_free(gno_context *context, gnoi_search_scratch *s)
{
    gnoi_free(context, s->far.items, s->far.capacity, sizeof *s->far.items);
    gnoi_free(context, s->near.items, s->near.capacity, sizeof *s->near.items);
    gnoi_free(context, s->found, s->found_capacity, sizeof *s->found);
    memset(s, 0, sizeof *s);
}

/* ---- one packet of receivers --------------------------------------------------------------------------------------- */

/* One receiver, and what is found of it. */
typedef struct target {
    uint32_t poly;
    gno_shade shade;
    gnoi_shaded shaded;
} target;

/* The pairs of a packet's polygons with themselves. */
#define ITSELF 0x8040201008040201u

/* Receivers that are searched for together. */
typedef struct group {
    const gnoi_search *search;
    size_t index; /* of their packet; SIZE_MAX: of none */
    vec3 origin;
    gnoi_eight box; /* of those that are searched for */
    gnoi_sieve sieve;
    target target[GNOI_PACKET];
} group;

static void begin_target(group *g, unsigned k, uint32_t index)
{
    const gnoi_search *s = g->search;
    target *t = &g->target[k];
    t->poly = index;
    t->shade = GNO_SHADE_NONE;
    gnoi_shaded_set(&t->shaded, s->from.scene, &s->from.lamp, &s->facets, &s->from.scene->prepared.polys[index]);
    gnoi_sieve_add(&g->sieve, k, &t->shaded, g->origin);
}

static int add_found(gno_context *context, gnoi_search_scratch *scratch, uint32_t caster, unsigned lane)
{
    if (scratch->found_count == scratch->found_capacity &&
        !gnoi_reserve(context, (void **)&scratch->found, &scratch->found_capacity, scratch->found_count + 1, sizeof *scratch->found))
        return 0;
    scratch->found[scratch->found_count++] = caster | lane << GNOI_LANE;
    return 1;
}

/* One pair that is not ruled out. Returns 0 when memory fails. */
static int try_pair(group *g, unsigned lane, const gnoi_packet *packet, unsigned k, int sure, gnoi_search_scratch *scratch)
{
    const gno_scene *scene = g->search->from.scene;
    target *t = &g->target[lane];
    if (packet->poly[k] == t->poly)
        return 1;
    if (!sure) {
        const gnoi_poly *caster = &scene->prepared.polys[packet->poly[k]];
        gnoi_overlap how = gnoi_overlap_test(&t->shaded, caster);
        if (how == GNOI_OVERLAP_NONE)
            return 1;
        if (how == GNOI_OVERLAP_ALL && caster->opaque)
            t->shade = GNO_SHADE_COVERED;
    }
    if (t->shade == GNO_SHADE_NONE)
        t->shade = GNO_SHADE_PART;
    return add_found(scene->context, scratch, packet->source[k], lane);
}

/* Pairs of the group and one packet of casters. Returns 0 when memory fails. */
static int try_pairs(group *g, const gnoi_packet *packet, const gnoi_sieve_place *place, uint64_t pairs, unsigned count, gnoi_search_scratch *scratch)
{
    gnoi_verdicts v = gnoi_sieve_test(&g->sieve, packet, place, pairs, 0xffu >> (GNOI_EIGHT - count));
    for (; v.maybe; v.maybe &= v.maybe - 1) {
        unsigned n = gnoi_lowest_bit(v.maybe), pair = (unsigned)(pairs >> 8 * n) & 0xff;
        if (!try_pair(g, pair & 7, packet, pair >> 3, v.sure >> n & 1, scratch))
            return 0;
    }
    return 1;
}

/* All of the group before one packet of casters: pairs whose boxes meet, eight by eight. */
static int search_packet(group *g, size_t index, gnoi_search_scratch *scratch)
{
    const gnoi_packets *packets = &g->search->packets;
    const gnoi_packet *packet = &packets->packets[index];
    gnoi_sieve_place place;
    uint64_t pairs = 0, meeting = gnoi_sieve_meet(&packets->nodes[index], &g->box);
    unsigned count = 0;
    if (index == g->index)
        meeting &= ~ITSELF;
    for (unsigned others = ~(unsigned)packet->casts & 0xff; others; others &= others - 1)
        meeting &= ~((uint64_t)0xff << 8 * gnoi_lowest_bit(others));
    if (meeting)
        gnoi_sieve_place_set(&place, packet, &g->search->from.lamp, g->origin, g->sieve.extent);
    for (; meeting; meeting &= meeting - 1) {
        pairs |= (uint64_t)gnoi_lowest_bit_long(meeting) << 8 * count;
        if (++count < GNOI_EIGHT)
            continue;
        if (!try_pairs(g, packet, &place, pairs, count, scratch))
            return 0;
        pairs = count = 0;
    }
    return count == 0 || try_pairs(g, packet, &place, pairs, count, scratch);
}

/* near: nodes of level 1. Returns 0 when memory fails or the call shall stop. */
static int search_near(group *g, const gnoi_node_list *near, gnoi_search_scratch *scratch)
{
    const gnoi_packets *packets = &g->search->packets;
    const gnoi_eight *level = packets->nodes + packets->level_first[1];
    gnoi_lbox all = gnoi_eight_union(&g->box);
    scratch->found_count = 0;
    for (size_t i = 0; i < near->count; i++) {
        if (gnoi_stopped_at(g->search->from.scene->context, i))
            return 0;
        for (unsigned mask = gnoi_eight_meet(&level[near->items[i]], &all); mask; mask &= mask - 1)
            if (!search_packet(g, (size_t)near->items[i] * GNOI_EIGHT + gnoi_lowest_bit(mask), scratch))
                return 0;
    }
    return 1;
}

/* The columns of the receivers in `lanes`: of each its casters, itself where it is in its own shadow. shade, source: by lane. */
static int end_targets(const gnoi_search_scratch *scratch, unsigned lanes, unsigned own, const gno_shade *shade, const uint32_t *source, gnoi_findings *f)
{
    size_t count[GNOI_PACKET] = {0}, at[GNOI_PACKET], end = f->caster_count;
    for (size_t i = 0; i < scratch->found_count; i++)
        count[scratch->found[i] >> GNOI_LANE]++;
    if (!gnoi_reserve(f->context, (void **)&f->columns, &f->column_capacity, f->column_count + GNOI_PACKET, sizeof *f->columns) ||
        !gnoi_reserve(f->context, (void **)&f->casters, &f->caster_capacity, f->caster_count + scratch->found_count + GNOI_PACKET, sizeof *f->casters))
        return 0;
    for (; lanes; lanes &= lanes - 1) {
        unsigned k = gnoi_lowest_bit(lanes);
        gnoi_found_column *c = &f->columns[f->column_count++];
        at[k] = end;
        end += count[k];
        if (own >> k & 1)
            f->casters[end++] = source[k];
        c->source = source[k];
        c->count = (uint32_t)(end - at[k]);
        c->shade = shade[k];
    }
    for (size_t i = 0; i < scratch->found_count; i++)
        f->casters[at[scratch->found[i] >> GNOI_LANE]++] = scratch->found[i] & ((1u << GNOI_LANE) - 1);
    f->caster_count = end;
    return 1;
}

static void set_box(gnoi_eight *boxes, const gnoi_eight *from, unsigned k)
{
    boxes->u0[k] = from->u0[k];
    boxes->u1[k] = from->u1[k];
    boxes->v0[k] = from->v0[k];
    boxes->v1[k] = from->v1[k];
    boxes->z0[k] = from->z0[k];
    boxes->z1[k] = from->z1[k];
}

/* The boxes of the polygons of a packet that are searched for. */
static void searched_boxes(const gnoi_packets *packets, size_t index, gnoi_eight *boxes)
{
    gnoi_eight_clear(boxes);
    for (unsigned k = 0; k < GNOI_PACKET; k++)
        if (packets->packets[index].search >> k & 1)
            set_box(boxes, &packets->nodes[index], k);
}

/* near: nodes of level 1 that may stand before the packet. */
static int search_receivers(const gnoi_search *search, size_t index, const gnoi_node_list *near, gnoi_search_scratch *scratch, gnoi_findings *f)
{
    const gnoi_packet *packet = &search->packets.packets[index];
    gno_shade shade[GNOI_PACKET];
    group g;
    g.search = search;
    g.index = index;
    g.origin = v3_from(packet->origin);
    gnoi_sieve_clear(&g.sieve);
    scratch->found_count = 0;
    searched_boxes(&search->packets, index, &g.box);
    for (unsigned k = 0; k < GNOI_PACKET; k++)
        if (packet->search >> k & 1)
            begin_target(&g, k, packet->poly[k]);
    if (packet->search && !search_near(&g, near, scratch))
        return 0;
    for (unsigned k = 0; k < GNOI_PACKET; k++)
        shade[k] = packet->search >> k & 1 ? g.target[k].shade : GNO_SHADE_OWN;
    return end_targets(scratch, packet->search | packet->own, packet->own, shade, packet->source, f);
}

/* ---- a piece ------------------------------------------------------------------------------------------------------ */

/* The box around what is searched for of packets [first, end); 0 when it is nothing. */
static int searched_box(const gnoi_packets *packets, size_t first, size_t end, gnoi_lbox *box)
{
    gnoi_eight boxes, all;
    unsigned some = 0;
    gnoi_eight_clear(&all);
    for (size_t i = first; i < end; i++) {
        gnoi_lbox one;
        searched_boxes(packets, i, &boxes);
        one = gnoi_eight_union(&boxes);
        gnoi_eight_grow(&all, (i - first) % GNOI_EIGHT, &one);
        some |= packets->packets[i].search;
    }
    *box = gnoi_eight_union(&all);
    return some != 0;
}

/* The far nodes that hold something before the box. */
static int find_near(gno_context *context, const gnoi_packets *packets, const gnoi_lbox *box, gnoi_search_scratch *scratch)
{
    const gnoi_eight *level = packets->nodes + packets->level_first[1];
    gnoi_node_list *near = &scratch->near;
    near->count = 0;
    if (!gnoi_reserve(context, (void **)&near->items, &near->capacity, scratch->far.count, sizeof *near->items))
        return 0;
    for (size_t i = 0; i < scratch->far.count; i++)
        if (gnoi_eight_meet(&level[scratch->far.items[i]], box))
            near->items[near->count++] = scratch->far.items[i];
    return 1;
}

int gnoi_search_piece(const gnoi_search *search, size_t piece, gnoi_search_scratch *scratch, gnoi_findings *f)
{
    const gnoi_packets *packets = &search->packets;
    size_t first = piece * GNOI_PIECE, end = first + GNOI_PIECE < packets->packet_count ? first + GNOI_PIECE : packets->packet_count;
    gnoi_lbox box;
    scratch->far.count = 0;
    if (searched_box(packets, first, end, &box) && !gnoi_packets_find(f->context, packets, &box, 1, &scratch->far))
        return 0;
    for (size_t from = first; from < end; from += GNOI_EIGHT) {
        size_t to = from + GNOI_EIGHT < end ? from + GNOI_EIGHT : end;
        if (searched_box(packets, from, to, &box) && !find_near(f->context, packets, &box, scratch))
            return 0;
        for (size_t i = from; i < to; i++)
            if (!search_receivers(search, i, &scratch->near, scratch, f) || gnoi_stopped(f->context))
                return 0;
    }
    return 1;
}

/* ---- one column --------------------------------------------------------------------------------------------------- */

int gnoi_search_poly(const gnoi_search *search, uint32_t index, gnoi_search_scratch *scratch, gnoi_findings *f)
{
    const gno_scene *scene = search->from.scene;
    const gnoi_poly *poly = &scene->prepared.polys[index];
    int own = gnoi_judge_own_shadow(&search->from, poly), exact, n;
    vec3 points[GNOI_PACKET_CORNERS];
    gnoi_lbox boxes[6];
    n = gnoi_poly_points(scene, poly, points, &exact);
    n = gnoi_frame_boxes(&search->packets.frame, points, n, boxes);
    n = n > 0 ? n : gnoi_frame_everywhere(boxes);
    for (int i = 0; i < n; i++) {
        gno_shade shade = GNO_SHADE_OWN;
        group g;
        scratch->near.count = scratch->found_count = 0;
        if (own & GNOI_SEARCH) {
            g.search = search;
            g.index = SIZE_MAX;
            g.origin = points[0];
            gnoi_sieve_clear(&g.sieve);
            gnoi_eight_clear(&g.box);
            gnoi_eight_set(&g.box, 0, &boxes[i]);
            begin_target(&g, 0, index);
            if (!gnoi_packets_find(f->context, &search->packets, &boxes[i], 1, &scratch->near) || !search_near(&g, &scratch->near, scratch))
                return 0;
            shade = g.target[0].shade;
        }
        if (!end_targets(scratch, 1, own & GNOI_OWN ? 1 : 0, &shade, &poly->source, f))
            return 0;
    }
    return 1;
}

/* ---- putting columns together ---------------------------------------------------------------------------------------- */

#define SHORT_COLUMN 64
#define LONG_COLUMN 512

/* Every number goes to where as many are smaller; repeats go to one place. Numbers are below 2^31. */
VECTOR_CLONES static void rank_column(const uint32_t *casters, size_t count, uint32_t *ranked)
{
    int32_t number[SHORT_COLUMN];
    for (size_t i = 0; i < count; i++) {
        number[i] = (int32_t)casters[i];
        ranked[i] = GNOI_NONE;
    }
    for (size_t i = count; i % GNOI_EIGHT; i++)
        number[i] = INT32_MAX;
    for (size_t i = 0; i < count; i += GNOI_EIGHT) {
        int32_t rank[GNOI_EIGHT] = {0};
        for (size_t j = 0; j < count; j++)
            for (size_t k = 0; k < GNOI_EIGHT; k++)
                rank[k] += number[j] < number[i + k];
        for (size_t k = 0; k < GNOI_EIGHT && i + k < count; k++)
            ranked[rank[k]] = casters[i + k];
    }
}

/* Numbers so close that a bit for each takes no more room than they do: sets the bits, and lists them without repeats. Returns how many, 0
 * when they are too far apart or there is no memory. */
static size_t sort_close_column(gno_context *context, uint32_t *casters, size_t count)
{
    uint32_t low = casters[0], high = casters[0];
    size_t words, n = 0;
    uint32_t *bits;
    for (size_t i = 1; i < count; i++) {
        low = casters[i] < low ? casters[i] : low;
        high = casters[i] > high ? casters[i] : high;
    }
    words = (size_t)(high - low) / 32 + 1;
    bits = words <= count ? gnoi_calloc(context, words, sizeof *bits) : NULL;
    if (!bits)
        return 0;
    for (size_t i = 0; i < count; i++)
        bits[(casters[i] - low) / 32] |= 1u << (casters[i] - low) % 32;
    for (size_t w = 0; w < words; w++)
        for (uint32_t left = bits[w]; left; left &= left - 1)
            casters[n++] = low + (uint32_t)w * 32 + gnoi_lowest_bit(left);
    gnoi_free(context, bits, words, sizeof *bits);
    return n;
}

/* By digits; returns 0 when there is no memory for it. */
static int sort_long_column(gno_context *context, uint32_t *casters, size_t count)
{
    gnoi_keyed *pairs = gnoi_malloc(context, 2 * count, sizeof *pairs);
    if (!pairs)
        return 0;
    for (size_t i = 0; i < count; i++)
        pairs[i].key = pairs[i].value = casters[i];
    gnoi_sort(pairs, pairs + count, count);
    for (size_t i = 0; i < count; i++)
        casters[i] = pairs[i].key;
    gnoi_free(context, pairs, 2 * count, sizeof *pairs);
    return 1;
}

/* By insertion over shrinking gaps: Shell, "A high-speed sorting procedure", 1959, with Ciura's gaps of 2001. */
static void sort_column(uint32_t *casters, size_t count)
{
    static const size_t gaps[] = {1035711, 460316, 204585, 90927, 40412, 17961, 7983, 3548, 1577, 701, 301, 132, 57, 23, 10, 4, 1};
    for (size_t g = 0; g < sizeof gaps / sizeof gaps[0]; g++)
        for (size_t gap = gaps[g], i = gap; i < count; i++) {
            uint32_t c = casters[i];
            size_t j = i;
            for (; j >= gap && casters[j - gap] > c; j -= gap)
                casters[j] = casters[j - gap];
            casters[j] = c;
        }
}

size_t gnoi_sort_casters(gno_context *context, uint32_t *casters, size_t count)
{
    uint32_t ranked[SHORT_COLUMN];
    const uint32_t *from = casters;
    size_t n = 0;
    if (count <= 1)
        return count;
    if (count >= LONG_COLUMN) {
        n = sort_close_column(context, casters, count);
        if (n > 0)
            return n;
    }
    if (count <= SHORT_COLUMN) {
        rank_column(casters, count, ranked);
        from = ranked;
    } else if (count < LONG_COLUMN || !sort_long_column(context, casters, count)) {
        sort_column(casters, count);
    }
    for (size_t i = 0; i < count; i++)
        if (from[i] != GNOI_NONE && (n == 0 || from[i] != casters[n - 1]))
            casters[n++] = from[i];
    return n;
}

gno_shade gnoi_shade_join(gno_shade a, gno_shade b, int same)
{
    if (a == b)
        return a;
    if (same && (a == GNO_SHADE_COVERED || b == GNO_SHADE_COVERED))
        return GNO_SHADE_COVERED;
    if (same && a == GNO_SHADE_OWN)
        return b == GNO_SHADE_NONE ? a : b;
    return same && b == GNO_SHADE_OWN ? a : GNO_SHADE_PART;
}
