/* pieces.c -- segments cut where they bend, the pieces sorted around their lower ends.
 *
 * Place: fourth pass (clipper.h). In: segments, splits, vertices. Out: `sorted`, the pieces by lower vertex and then by slope, from
 * downwards to upwards. Two pieces from one vertex in one direction are the same piece twice: the farther end of the longer one
 * would lie beyond the other's, on which it then bends (meet.c).
 */
#include "clip/clipper.h"

#define SHORT_LIST 24

/* ---- bends along a segment ---------------------------------------------------------------------------------------- */

/* Vertex numbers rise along the segment, except where it falls: then they do from column to column only. */
static void turn_columns(const gno_clipper *c, uint32_t *chain, size_t count)
{
    for (size_t i = 0, j; i < count; i = j) {
        for (j = i + 1; j < count && c->vertices[chain[j]].x == c->vertices[chain[i]].x; j++)
            ;
        for (size_t low = i, high = j; low + 1 < high; low++) {
            uint32_t swap = chain[--high];
            chain[high] = chain[low];
            chain[low] = swap;
        }
    }
}

static void sort_chain(gno_clipper *c, uint32_t *chain, size_t count)
{
    if (count <= SHORT_LIST) {
        for (size_t i = 1; i < count; i++) {
            uint32_t v = chain[i];
            size_t j = i;
            for (; j > 0 && chain[j - 1] > v; j--)
                chain[j] = chain[j - 1];
            chain[j] = v;
        }
        return;
    }
    for (size_t i = 0; i < count; i++)
        c->keys[i].key = c->keys[i].value = chain[i];
    gnoi_sort(c->keys, c->key_scratch, count);
    for (size_t i = 0; i < count; i++)
        chain[i] = c->keys[i].value;
}

/* Lists the bends of every segment: those of segment i are chain[bucket[i]] .. chain[bucket[i+1]-1]. */
static int list_bends(gno_clipper *c)
{
    size_t n = c->segment_count;
    if (!GNOI_CLIP_RESERVE(c, bucket, bucket_capacity, n + 2) || !GNOI_CLIP_RESERVE(c, chain, chain_capacity, c->split_count) ||
        !GNOI_CLIP_RESERVE(c, keys, key_capacity, c->split_count) ||
        !GNOI_CLIP_RESERVE(c, key_scratch, key_scratch_capacity, c->split_count))
        return 0;
    for (size_t i = 0; i < n + 2; i++)
        c->bucket[i] = 0;
    for (size_t i = 0; i < c->split_count; i++)
        c->bucket[c->splits[i].segment + 2]++;
    for (size_t i = 2; i < n + 2; i++)
        c->bucket[i] += c->bucket[i - 1];
    for (size_t i = 0; i < c->split_count; i++) {
        if (gnoi_clip_stopped_at(c, i))
            return 0;
        c->chain[c->bucket[c->splits[i].segment + 1]++] = c->vertex_of[c->splits[i].point];
    }
    return 1;
}

static void add_piece(gno_clipper *c, const gnoi_segment *s, uint32_t from, uint32_t to)
{
    gnoi_piece *p = &c->pieces[c->piece_count];
    if (from == to)
        return;
    p->a = from < to ? from : to;
    p->b = from < to ? to : from;
    p->polygon = s->polygon;
    p->sign = from < to ? s->sign : -s->sign;
    c->piece_count++;
}

static int cut_segments(gno_clipper *c)
{
    c->piece_count = 0;
    for (size_t i = 0; i < c->segment_count; i++) {
        const gnoi_segment *s = &c->segments[i];
        size_t count = c->bucket[i + 1] - c->bucket[i];
        if (gnoi_clip_stopped(c, 1 + count))
            return 0;
        uint32_t *chain = count > 0 ? c->chain + c->bucket[i] : NULL, last = c->vertex_of[s->pa]; /* no chain at all: NULL */
        if (count > 1) {
            sort_chain(c, chain, count);
            if (s->b.y < s->a.y)
                turn_columns(c, chain, count);
        }
        for (size_t k = 0; k < count; k++) {
            add_piece(c, s, last, chain[k]);
            last = chain[k];
        }
        add_piece(c, s, last, c->vertex_of[s->pb]);
    }
    return 1;
}

/* ---- around a vertex -------------------------------------------------------------------------------------------------- */

/* Both start in one vertex. Pieces at one place by polygon and direction, so that the order is the caller's alone. */
static int piece_before(const gno_clipper *c, const gnoi_piece *p, const gnoi_piece *q)
{
    if (p->b != q->b) {
        gnoi_site o = c->vertices[p->a], s = c->vertices[p->b], t = c->vertices[q->b];
        int turn = gnoi_wide_turn(s.x - o.x, s.y - o.y, t.x - o.x, t.y - o.y);
        return turn != 0 ? turn > 0 : p->b < q->b;
    }
    return p->polygon != q->polygon ? p->polygon < q->polygon : p->sign < q->sign;
}

static void sift(const gno_clipper *c, gnoi_piece *heap, size_t at, size_t count)
{
    gnoi_piece moved = heap[at];
    for (size_t child; (child = 2 * at + 1) < count; at = child) {
        if (child + 1 < count && piece_before(c, &heap[child], &heap[child + 1]))
            child++;
        if (!piece_before(c, &moved, &heap[child]))
            break;
        heap[at] = heap[child];
    }
    heap[at] = moved;
}

static void sort_around(const gno_clipper *c, gnoi_piece *p, size_t count)
{
    if (count <= SHORT_LIST) {
        for (size_t i = 1; i < count; i++) {
            gnoi_piece moved = p[i];
            size_t j = i;
            for (; j > 0 && piece_before(c, &moved, &p[j - 1]); j--)
                p[j] = p[j - 1];
            p[j] = moved;
        }
        return;
    }
    for (size_t i = count / 2; i-- > 0;)
        sift(c, p, i, count);
    for (size_t end = count; end-- > 1;) {
        gnoi_piece largest = p[0];
        p[0] = p[end];
        p[end] = largest;
        sift(c, p, 0, end);
    }
}

static int sort_pieces(gno_clipper *c)
{
    size_t n = c->vertex_count;
    if (!GNOI_CLIP_RESERVE(c, bucket, bucket_capacity, n + 2) || !GNOI_CLIP_RESERVE(c, sorted, sorted_capacity, c->piece_count))
        return 0;
    for (size_t i = 0; i < n + 2; i++)
        c->bucket[i] = 0;
    for (size_t i = 0; i < c->piece_count; i++)
        c->bucket[c->pieces[i].a + 2]++;
    for (size_t i = 2; i < n + 2; i++)
        c->bucket[i] += c->bucket[i - 1];
    for (size_t i = 0; i < c->piece_count; i++) {
        if (gnoi_clip_stopped_at(c, i))
            return 0;
        c->sorted[c->bucket[c->pieces[i].a + 1]++] = c->pieces[i];
    }
    for (size_t i = 0; i < n; i++) {
        size_t count = c->bucket[i + 1] - c->bucket[i];
        if (count > 1)
            sort_around(c, c->sorted + c->bucket[i], count);
        if (gnoi_clip_stopped(c, 1 + count))
            return 0;
    }
    return 1;
}

gno_status gnoi_clip_pieces(gno_clipper *c)
{
    if (c->segment_count + c->split_count >= GNOI_CLIP_MOST)
        return gnoi_clip_too_many(c, "pieces of edges");
    if (!list_bends(c) || !GNOI_CLIP_RESERVE(c, pieces, piece_capacity, c->segment_count + c->split_count))
        return GNO_ERROR_MEMORY;
    return cut_segments(c) && sort_pieces(c) ? GNO_OK : GNO_ERROR_MEMORY;
}
