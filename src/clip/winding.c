/* winding.c -- which side of each piece is its polygon's inside, for polygons that may cross themselves.
 *
 * Place: fifth pass (clipper.h). A union counts how many polygons cover a place, and for that every polygon has to count once at most.
 * A convex ring does so by its winding number. Any other polygon is swept alone, by the even-odd rule, and its
 * pieces are given signs that make it count once. An operand of one polygon needs no counting: its parity will do.
 */
#include "clip/clipper.h"

static int needs_sweep(const gno_clipper *c, const gnoi_polygon *p)
{
    return p->winding == GNOI_POLYGON_PARITY && c->operand_polygons[p->operand] > 1;
}

/* Numbers of the sorted pieces, polygon by polygon; those of polygon i end at bucket[i]. */
static int list_pieces(gno_clipper *c)
{
    size_t n = c->polygon_count;
    if (!GNOI_CLIP_RESERVE(c, bucket, bucket_capacity, n + 1) || !GNOI_CLIP_RESERVE(c, chain, chain_capacity, c->piece_count) ||
        !GNOI_CLIP_RESERVE(c, edges, edge_capacity, c->piece_count) ||
        !GNOI_CLIP_RESERVE(c, keys, key_capacity, 2 * c->piece_count) ||
        !GNOI_CLIP_RESERVE(c, key_scratch, key_scratch_capacity, 2 * c->piece_count))
        return 0;
    for (size_t i = 0; i <= n; i++)
        c->bucket[i] = 0;
    for (size_t i = 0; i < c->piece_count; i++)
        c->bucket[c->sorted[i].polygon + 1]++;
    for (size_t i = 1; i <= n; i++)
        c->bucket[i] += c->bucket[i - 1];
    for (size_t i = 0; i < c->piece_count; i++)
        c->chain[c->bucket[c->sorted[i].polygon]++] = (uint32_t)i;
    return 1;
}

/* One polygon's pieces as edges; pairs at one place cancel. An edge's `next` is its piece. */
static void make_edges(gno_clipper *c, const uint32_t *list, size_t count)
{
    c->edge_count = 0;
    for (size_t i = 0; i < count; i++) {
        gnoi_piece *p = &c->sorted[list[i]];
        gnoi_edge *last = c->edge_count > 0 ? &c->edges[c->edge_count - 1] : NULL;
        p->sign = 0;
        if (last && last->a == p->a && last->b == p->b) {
            c->edge_count--;
        } else {
            gnoi_edge *e = &c->edges[c->edge_count++];
            e->a = p->a;
            e->b = p->b;
            e->next = list[i];
        }
    }
}

/* The vertices of the edges in order, each once, as keys; values are an edge that ends there, or NONE. */
static size_t list_vertices(gno_clipper *c)
{
    size_t n = 0, unique = 0;
    for (size_t i = 0; i < c->edge_count; i++) {
        c->keys[n].key = c->edges[i].a;
        c->keys[n++].value = GNOI_CLIP_NONE;
        c->keys[n].key = c->edges[i].b;
        c->keys[n++].value = (uint32_t)i;
    }
    gnoi_sort(c->keys, c->key_scratch, n);
    for (size_t i = 0; i < n; i++) {
        if (unique == 0 || c->keys[unique - 1].key != c->keys[i].key)
            c->keys[unique++] = c->keys[i];
        else if (c->keys[i].value != GNOI_CLIP_NONE)
            c->keys[unique - 1].value = c->keys[i].value;
    }
    return unique;
}

/* Signs of the edges that start in one vertex, by turns from what lies below them. */
static void give_signs(gno_clipper *c, size_t first, size_t end, uint32_t below)
{
    int32_t inside = below != GNOI_CLIP_NONE ? c->edges[below].above.of[0] : 0;
    for (size_t i = first; i < end; i++) {
        gnoi_edge *e = &c->edges[i];
        c->sorted[e->next].sign = inside ? -1 : 1;
        inside = e->above.of[0] = !inside;
    }
}

static int sweep_polygon(gno_clipper *c)
{
    size_t vertices = list_vertices(c), first = 0;
    if (!gnoi_status_clear(c))
        return 0;
    for (size_t i = 0; i < vertices; i++) {
        gnoi_status met;
        size_t end = first;
        while (end < c->edge_count && c->edges[end].a == c->keys[i].key)
            end++;
        if (!gnoi_status_meet(c, c->keys[i].key, c->keys[i].value, &met) || gnoi_clip_stopped_at(c, i))
            return 0;
        give_signs(c, first, end, met.below);
        if (!gnoi_status_replace(c, &met, (uint32_t)first, end - first))
            return 0;
        first = end;
    }
    return 1;
}

gno_status gnoi_clip_winding(gno_clipper *c)
{
    size_t sweeps = 0;
    for (size_t i = 0; i < c->polygon_count; i++)
        sweeps += needs_sweep(c, &c->polygons[i]) != 0;
    if (sweeps == 0)
        return GNO_OK;
    if (!list_pieces(c))
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < c->polygon_count; i++) {
        size_t first = i > 0 ? c->bucket[i - 1] : 0;
        if (!needs_sweep(c, &c->polygons[i]))
            continue;
        make_edges(c, c->chain + first, c->bucket[i] - first);
        if (!sweep_polygon(c) || gnoi_clip_stopped(c, c->edge_count))
            return GNO_ERROR_MEMORY;
    }
    return GNO_OK;
}
