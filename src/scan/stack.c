/* stack.c -- see stack.h. A line is swept from left to right over the ends of its segments and the places where two of them
 * cross; between two such places the order of the segments is one and the same.
 */
#include "scan/stack.h"
#include <string.h>

void gnoi_stacks_free(gnoi_stacks *stacks)
{
    gno_context *context = stacks->context;
    gnoi_free(context, stacks->segments, stacks->segment_capacity, sizeof *stacks->segments);
    gnoi_free(context, stacks->heads, stacks->head_capacity, sizeof *stacks->heads);
    gnoi_free(context, stacks->order, stacks->order_capacity, sizeof *stacks->order);
    gnoi_free(context, stacks->active, stacks->active_capacity, sizeof *stacks->active);
    gnoi_free(context, stacks->tints, stacks->tint_capacity, sizeof *stacks->tints);
    gnoi_free(context, stacks->bares, stacks->bare_capacity, sizeof *stacks->bares);
    gnoi_free(context, stacks->bare_start, stacks->start_capacity, sizeof *stacks->bare_start);
}

void gnoi_stacks_reset(gnoi_stacks *stacks, const gnoi_lines *lines)
{
    stacks->segment_count = 1;
    stacks->bare_count = 0;
    if (!gnoi_reserve(stacks->context, (void **)&stacks->heads, &stacks->head_capacity, lines->line_count + 1, sizeof *stacks->heads) ||
        !gnoi_reserve(stacks->context, (void **)&stacks->bare_start, &stacks->start_capacity, lines->line_count + 1,
                      sizeof *stacks->bare_start)) {
        stacks->failed = 1;
        return;
    }
    memset(stacks->heads, 0, lines->line_count * sizeof *stacks->heads);
}

/* ---- segments before the opaque pieces ------------------------------------------------------------------------------ */

static void add_segment(gnoi_stacks *stacks, uint32_t line, uint32_t slot, int32_t x0, int32_t x1)
{
    uint32_t head = stacks->heads[line];
    gnoi_segment *s;
    if (x0 >= x1)
        return;
    if (head && stacks->segments[head].slot == slot && stacks->segments[head].x1 == x0) {
        stacks->segments[head].x1 = x1;
        return;
    }
    if (!gnoi_reserve(stacks->context, (void **)&stacks->segments, &stacks->segment_capacity, stacks->segment_count + 1,
                      sizeof *stacks->segments)) {
        stacks->failed = 1;
        return;
    }
    s = &stacks->segments[stacks->segment_count];
    s->x0 = x0;
    s->x1 = x1;
    s->slot = slot;
    s->next = head;
    stacks->heads[line] = (uint32_t)stacks->segment_count++;
}

void gnoi_stacks_insert(gnoi_stacks *stacks, const gnoi_lines *lines, uint32_t line, uint32_t slot, int32_t x0, int32_t x1)
{
    const gnoi_line *l = &lines->lines[line];
    uint32_t p = l->first;
    x0 = x0 < l->xa ? l->xa : x0;
    x1 = x1 > l->xb ? l->xb : x1;
    while (x0 < x1 && !stacks->failed) {
        int32_t v, cut = 0;
        int front, new_first = 0;
        while (p && lines->pieces[p].x1 <= x0)
            p = lines->pieces[p].next;
        if (!p || lines->pieces[p].x0 > x0) {
            v = p && lines->pieces[p].x0 < x1 ? lines->pieces[p].x0 : x1;
            add_segment(stacks, line, slot, x0, v);
            x0 = v;
            continue;
        }
        v = lines->pieces[p].x1 < x1 ? lines->pieces[p].x1 : x1;
        front = gnoi_lines_compare(&lines->depths[slot], &lines->depths[lines->pieces[p].slot], l->y, x0, v, &cut, &new_first);
        if (front >= 0)
            add_segment(stacks, line, slot, front || new_first ? x0 : cut, front || !new_first ? v : cut);
        x0 = v;
    }
}

/* ---- one line ---------------------------------------------------------------------------------------------------------- */

typedef struct sweep {
    gnoi_stacks *stacks;
    gnoi_lines *lines;
    gnoi_pass_fn pass;
    void *user;
    uint32_t line;
    double y;
    size_t count, next, active; /* segments of the line, those taken up, those that lie here */
    uint32_t before, made;      /* last opaque piece left of the sweep; last new piece, 0: none */
    int32_t run_from;           /* begun on what lies farthest back: where, and the tint of it */
    gnoi_tint run_tint;
} sweep;

static const gnoi_tint whole = {{1, 1, 1}, 1};

static int same_tint(gnoi_tint a, gnoi_tint b)
{
    return a.rgb[0] == b.rgb[0] && a.rgb[1] == b.rgb[1] && a.rgb[2] == b.rgb[2] && a.hides == b.hides;
}

static int is_dark(gnoi_tint a) { return !(a.rgb[0] > 0) && !(a.rgb[1] > 0) && !(a.rgb[2] > 0); }

/* A piece that is in no list yet, with its tint; 0 when memory fails. */
static uint32_t new_piece(sweep *s, uint32_t slot, int32_t x0, int32_t x1, gnoi_tint tint)
{
    gnoi_stacks *stacks = s->stacks;
    uint32_t p = gnoi_lines_new_piece(s->lines, s->line, slot, x0, x1);
    if (!p || !gnoi_reserve(stacks->context, (void **)&stacks->tints, &stacks->tint_capacity, s->lines->piece_count, sizeof *stacks->tints)) {
        stacks->failed = 1;
        return 0;
    }
    stacks->tints[p] = tint;
    return p;
}

/* Ends the piece begun on a segment at x. */
static void end_piece(sweep *s, gnoi_segment *g, int32_t x)
{
    uint32_t p;
    if (g->from >= x || is_dark(g->tint))
        return;
    p = new_piece(s, g->slot, g->from, x, g->tint);
    if (!p)
        return;
    s->lines->pieces[p].next = s->made;
    s->made = p;
}

static void add_bare(sweep *s, int32_t x0, int32_t x1, gnoi_tint tint)
{
    gnoi_stacks *stacks = s->stacks;
    gnoi_bare *b;
    if (!gnoi_reserve(stacks->context, (void **)&stacks->bares, &stacks->bare_capacity, stacks->bare_count + 1, sizeof *stacks->bares)) {
        stacks->failed = 1;
        return;
    }
    b = &stacks->bares[stacks->bare_count++];
    b->x0 = x0;
    b->x1 = x1;
    b->tint = tint;
}

/* Cuts opaque piece p at x; returns the right part. */
static uint32_t cut_piece(sweep *s, uint32_t p, int32_t x)
{
    gnoi_piece *old = &s->lines->pieces[p];
    uint32_t q = new_piece(s, old->slot, x, old->x1, s->stacks->tints[p]);
    old = &s->lines->pieces[p];
    if (!q)
        return 0;
    s->lines->pieces[q].next = old->next;
    old->next = q;
    old->x1 = x;
    return q;
}

static uint32_t *link_to(sweep *s) { return s->before ? &s->lines->pieces[s->before].next : &s->lines->lines[s->line].first; }

/* Tints the opaque pieces over [x0,x1) and notes what is bare between them; hides them where nothing is let through. */
static void tint_opaque(sweep *s, int32_t x0, int32_t x1, gnoi_tint tint)
{
    uint32_t p;
    if (is_dark(tint))
        add_bare(s, x0, x1, tint);
    while ((p = *link_to(s)) != 0 && s->lines->pieces[p].x1 <= x0)
        s->before = p;
    for (; p && s->lines->pieces[p].x0 < x1 && !s->stacks->failed; p = *link_to(s)) {
        if (s->lines->pieces[p].x0 < x0) {
            s->before = p;
            p = cut_piece(s, p, x0);
        }
        if (p && s->lines->pieces[p].x1 > x1)
            cut_piece(s, p, x1);
        if (!p || s->stacks->failed)
            return;
        if (is_dark(tint)) {
            *link_to(s) = s->lines->pieces[p].next;
            continue;
        }
        if (s->lines->pieces[p].x0 > x0)
            add_bare(s, x0, s->lines->pieces[p].x0, tint);
        s->stacks->tints[p] = tint;
        x0 = s->lines->pieces[p].x1;
        s->before = p;
    }
    if (x0 < x1 && !is_dark(tint))
        add_bare(s, x0, x1, tint);
}

static void end_run(sweep *s, int32_t x)
{
    if (s->run_from < x && !same_tint(s->run_tint, whole))
        tint_opaque(s, s->run_from, x, s->run_tint);
}

/* Orders what lies over [x0,*x1) front to back; *x1 moves left to where two of them cross. */
static void order_stack(sweep *s, int32_t x0, int32_t *x1)
{
    uint32_t *stack = s->stacks->active;
    for (size_t i = 1; i < s->active; i++) {
        uint32_t g = stack[i];
        size_t j = i;
        for (; j > 0; j--) {
            const gnoi_depth *a = &s->lines->depths[s->stacks->segments[stack[j - 1]].slot];
            const gnoi_depth *b = &s->lines->depths[s->stacks->segments[g].slot];
            int32_t cut = 0;
            int first = 0, front = gnoi_lines_compare(a, b, s->y, x0, *x1, &cut, &first);
            if (front == 0)
                *x1 = cut;
            if (front > 0 || (front == 0 && first))
                break;
            stack[j] = stack[j - 1];
        }
        stack[j] = g;
    }
}

/* One part [x0,x1) of the line, over which the stack is one and the same: pieces go on, or end and begin. */
static void add_part(sweep *s, int32_t x0, int32_t x1)
{
    gnoi_tint light = whole;
    for (size_t i = 0; i < s->active; i++) {
        gnoi_segment *g = &s->stacks->segments[s->stacks->active[i]];
        gnoi_tint tint;
        float hides = light.hides;
        if (g->pass.varies)
            g->pass = s->pass(s->user, g->slot, x0, x1, s->y);
        for (int k = 0; k < 3; k++) {
            tint.rgb[k] = light.rgb[k] * g->pass.own;
            light.rgb[k] *= g->pass.through[k];
        }
        light.hides = (light.rgb[0] + light.rgb[1] + light.rgb[2]) / 3;
        tint.hides = hides - light.hides;
        if (!same_tint(tint, g->tint)) {
            end_piece(s, g, x0);
            g->from = x0;
            g->tint = tint;
        }
    }
    if (!same_tint(light, s->run_tint)) {
        end_run(s, x0);
        s->run_from = x0;
        s->run_tint = light;
    }
}

/* Takes up the segments that begin at x; returns where the part at x ends at the farthest. */
static int32_t take_segments(sweep *s, int32_t x)
{
    gnoi_segment *segments = s->stacks->segments;
    const gnoi_keyed *order = s->stacks->order;
    int32_t end = INT32_MAX, pixel_end = (x | (GNOI_X_ONE - 1)) + 1;
    int varies = 0;
    for (; s->next < s->count && segments[order[s->next].value].x0 <= x; s->next++) {
        gnoi_segment *g = &segments[order[s->next].value];
        g->pass = s->pass(s->user, g->slot, x, x, s->y);
        g->from = x;
        g->tint.rgb[0] = -1; /* no piece begun */
        s->stacks->active[s->active++] = order[s->next].value;
    }
    for (size_t i = 0; i < s->active; i++) {
        const gnoi_segment *g = &segments[s->stacks->active[i]];
        end = g->x1 < end ? g->x1 : end;
        varies |= g->pass.varies;
    }
    if (s->next < s->count && segments[order[s->next].value].x0 < end)
        end = segments[order[s->next].value].x0;
    return varies && pixel_end < end ? pixel_end : end;
}

/* Ends the pieces of segments that end at x. */
static void drop_segments(sweep *s, int32_t x)
{
    size_t kept = 0;
    for (size_t i = 0; i < s->active; i++) {
        gnoi_segment *g = &s->stacks->segments[s->stacks->active[i]];
        if (g->x1 > x)
            s->stacks->active[kept++] = s->stacks->active[i];
        else
            end_piece(s, g, x);
    }
    s->active = kept;
}

/* The line's segments by beginning; those of one beginning as they were inserted. Returns how many, 0 when memory fails. */
static size_t sort_segments(gnoi_stacks *stacks, uint32_t line)
{
    size_t count = 0, i;
    for (uint32_t g = stacks->heads[line]; g; g = stacks->segments[g].next)
        count++;
    if (!gnoi_reserve(stacks->context, (void **)&stacks->order, &stacks->order_capacity, 2 * count, sizeof *stacks->order) ||
        !gnoi_reserve(stacks->context, (void **)&stacks->active, &stacks->active_capacity, count, sizeof *stacks->active)) {
        stacks->failed = 1;
        return 0;
    }
    i = count;
    for (uint32_t g = stacks->heads[line]; g; g = stacks->segments[g].next) {
        stacks->order[--i].key = (uint32_t)stacks->segments[g].x0;
        stacks->order[i].value = g;
    }
    gnoi_sort(stacks->order, stacks->order + count, count);
    return count;
}

static void resolve_line(sweep *s)
{
    gnoi_line *l = &s->lines->lines[s->line];
    int32_t x = 0;
    s->y = l->y;
    s->count = sort_segments(s->stacks, s->line);
    s->next = s->active = 0;
    s->before = s->made = 0;
    s->run_from = l->xa;
    s->run_tint = whole;
    while ((s->active > 0 || s->next < s->count) && !s->stacks->failed) {
        int32_t end;
        if (s->active == 0) {
            add_part(s, x, x); /* nothing lies here: ends the run */
            x = s->stacks->segments[s->stacks->order[s->next].value].x0;
        }
        end = take_segments(s, x);
        order_stack(s, x, &end);
        add_part(s, x, end);
        drop_segments(s, end);
        x = end;
    }
    end_run(s, x);
    if (!s->made)
        return;
    for (uint32_t p = s->made;; p = s->lines->pieces[p].next)
        if (!s->lines->pieces[p].next) {
            s->lines->pieces[p].next = l->first;
            l->first = s->made;
            return;
        }
}

void gnoi_stacks_resolve(gnoi_stacks *stacks, gnoi_lines *lines, gnoi_pass_fn pass, void *user)
{
    sweep s;
    memset(&s, 0, sizeof s);
    s.stacks = stacks;
    s.lines = lines;
    s.pass = pass;
    s.user = user;
    if (!stacks->failed && !gnoi_reserve(stacks->context, (void **)&stacks->tints, &stacks->tint_capacity, lines->piece_count, sizeof *stacks->tints))
        stacks->failed = 1;
    for (size_t p = 0; p < lines->piece_count && !stacks->failed; p++)
        stacks->tints[p] = whole;
    for (size_t line = 0; line < lines->line_count && !stacks->failed; line++) {
        stacks->bare_start[line] = (uint32_t)stacks->bare_count;
        s.line = (uint32_t)line;
        if (stacks->heads[line])
            resolve_line(&s);
    }
    if (!stacks->failed)
        stacks->bare_start[lines->line_count] = (uint32_t)stacks->bare_count;
}
