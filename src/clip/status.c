/* status.c -- the edges over the sweep line, from below: see clipper.h.
 *
 * Edges meet in vertices alone, so at a vertex the order of those that pass is never in doubt, and the ones that end there follow
 * one another. They stand in blocks of few, the blocks in an array; an edge knows its block. So the edges that end in a vertex are
 * found without a search, and what comes and goes moves few others.
 */
#include "clip/clipper.h"

#include <string.h>

/* ---- blocks -------------------------------------------------------------------------------------------------------- */

static void renumber(gno_clipper *c, size_t from)
{
    for (size_t i = from; i < c->row_count; i++)
        c->blocks[c->row[i]].place = (uint32_t)i;
}

/* An empty block at place `at` of the row; its number, or NONE when memory fails. */
static uint32_t add_block(gno_clipper *c, size_t at)
{
    uint32_t block = c->free_block;
    if (!GNOI_CLIP_RESERVE(c, row, row_capacity, c->row_count + 1))
        return GNOI_CLIP_NONE;
    if (block != GNOI_CLIP_NONE) {
        c->free_block = c->blocks[block].place;
    } else {
        if (!GNOI_CLIP_RESERVE(c, blocks, block_capacity, c->block_count + 1))
            return GNOI_CLIP_NONE;
        block = (uint32_t)c->block_count++;
    }
    c->blocks[block].count = 0;
    memmove(c->row + at + 1, c->row + at, (c->row_count - at) * sizeof *c->row);
    c->row[at] = block;
    c->row_count++;
    renumber(c, at);
    return block;
}

static void drop_block(gno_clipper *c, uint32_t block)
{
    size_t at = c->blocks[block].place;
    memmove(c->row + at, c->row + at + 1, (c->row_count - at - 1) * sizeof *c->row);
    c->row_count--;
    renumber(c, at);
    c->blocks[block].place = c->free_block;
    c->free_block = block;
}

int gnoi_status_clear(gno_clipper *c)
{
    c->row_count = c->block_count = 0;
    c->free_block = GNOI_CLIP_NONE;
    return add_block(c, 0) != GNOI_CLIP_NONE;
}

static void put(gno_clipper *c, uint32_t block, uint32_t index, uint32_t edge)
{
    c->blocks[block].edge[index] = edge;
    c->edges[edge].block = block;
}

/* Inserts before the place, which moves behind the new edge. */
static int insert(gno_clipper *c, gnoi_place *at, uint32_t edge)
{
    gnoi_block *b = &c->blocks[at->block];
    if (b->count == GNOI_CLIP_BLOCK) {
        uint32_t half = GNOI_CLIP_BLOCK / 2, upper = add_block(c, b->place + 1u);
        if (upper == GNOI_CLIP_NONE)
            return 0;
        b = &c->blocks[at->block];
        for (uint32_t i = half; i < GNOI_CLIP_BLOCK; i++)
            put(c, upper, i - half, b->edge[i]);
        c->blocks[upper].count = GNOI_CLIP_BLOCK - half;
        b->count = half;
        if (at->index > half) {
            at->block = upper;
            at->index -= half;
            b = &c->blocks[upper];
        }
    }
    for (uint32_t i = b->count; i > at->index; i--)
        b->edge[i] = b->edge[i - 1];
    b->count++;
    put(c, at->block, at->index++, edge);
    return 1;
}

/* The place of an edge itself rather than that behind the last one of the block before; 0 at the end of all. */
static int settle(const gno_clipper *c, gnoi_place *at)
{
    while (at->index == c->blocks[at->block].count) {
        size_t next = c->blocks[at->block].place + (size_t)1;
        if (next == c->row_count)
            return 0;
        at->block = c->row[next];
        at->index = 0;
    }
    return 1;
}

/* Takes out the edge at the place, where then the next one stands. */
static void take_out(gno_clipper *c, gnoi_place *at)
{
    gnoi_block *b = &c->blocks[at->block];
    b->count--;
    for (uint32_t i = at->index; i < b->count; i++)
        b->edge[i] = b->edge[i + 1];
    if (b->count == 0 && c->row_count > 1) {
        size_t place = b->place;
        drop_block(c, at->block);
        at->block = c->row[place > 0 ? place - 1 : 0];
        at->index = place > 0 ? c->blocks[at->block].count : 0;
    }
}

/* ---- at a vertex ------------------------------------------------------------------------------------------------------ */

static int is_below(const gno_clipper *c, uint32_t edge, gnoi_site p)
{
    const gnoi_edge *e = &c->edges[edge];
    return gnoi_site_turn(c->vertices[e->a], c->vertices[e->b], p) > 0;
}

/* Where an edge that starts in p has to stand. */
static gnoi_place search(const gno_clipper *c, gnoi_site p)
{
    size_t low = 0, high = c->row_count; /* the last block whose first edge lies below, or the first block */
    gnoi_place at;
    uint32_t end;
    while (low + 1 < high) {
        size_t middle = low + (high - low) / 2;
        if (is_below(c, c->blocks[c->row[middle]].edge[0], p))
            low = middle;
        else
            high = middle;
    }
    at.block = c->row[low];
    at.index = 0;
    end = c->blocks[at.block].count;
    while (at.index < end) {
        uint32_t middle = at.index + (end - at.index) / 2;
        if (is_below(c, c->blocks[at.block].edge[middle], p))
            at.index = middle + 1;
        else
            end = middle;
    }
    return at;
}

static gnoi_place place_of(const gno_clipper *c, uint32_t edge)
{
    gnoi_place at = {c->edges[edge].block, 0};
    const gnoi_block *b = &c->blocks[at.block];
    while (b->edge[at.index] != edge)
        at.index++;
    return at;
}

/* The edge before a place, or NONE. */
static uint32_t before(const gno_clipper *c, gnoi_place *at)
{
    if (at->index == 0) {
        size_t place = c->blocks[at->block].place;
        if (place == 0)
            return GNOI_CLIP_NONE;
        at->block = c->row[place - 1];
        at->index = c->blocks[at->block].count;
    }
    return c->blocks[at->block].edge[--at->index];
}

int gnoi_status_meet(gno_clipper *c, uint32_t v, uint32_t ending, gnoi_status *met)
{
    gnoi_place at = ending == GNOI_CLIP_NONE ? search(c, c->vertices[v]) : place_of(c, ending), from = at;
    while ((met->below = before(c, &at)) != GNOI_CLIP_NONE && c->edges[met->below].b == v)
        from = at;
    met->at = at = from;
    met->count = 0;
    while (settle(c, &at)) {
        uint32_t edge = c->blocks[at.block].edge[at.index++];
        if (c->edges[edge].b != v)
            break;
        if (!GNOI_CLIP_RESERVE(c, ending, ending_capacity, met->count + 1))
            return 0;
        c->ending[met->count++] = edge;
    }
    return 1;
}

int gnoi_status_replace(gno_clipper *c, const gnoi_status *met, uint32_t first, size_t add)
{
    gnoi_place at = met->at;
    size_t drop = met->count, done = 0;
    for (; done < add && done < drop && settle(c, &at); done++)
        put(c, at.block, at.index++, first + (uint32_t)done);
    for (; done < drop && settle(c, &at); drop--)
        take_out(c, &at);
    for (; done < add; done++)
        if (!insert(c, &at, first + (uint32_t)done))
            return 0;
    return 1;
}
