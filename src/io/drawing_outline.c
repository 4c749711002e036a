/* drawing_outline.c -- what the shapes leave free of the picture, as rings: see drawing.h.
 *
 * Shapes fit together, so an edge that two of them share runs once each way: such pairs cancel, and what is left bounds their
 * union. The picture's frame, which runs the other way round, is cut where outlines touch it and cancels likewise. Where a corner of
 * one shape lies within an edge of another, that edge is cut there first. What is flat all the same is dropped: viewers that make
 * every shape at least a pixel wide would show it.
 */
#include "io/drawing.h"

#include <math.h>
#include <stdlib.h>

/* Rings of less than this area, in pixels squared, show nothing. */
#define LEAST_RING 1e-3

/* Corners this near to an edge, in units, lie on it: both were rounded once. */
#define ON_EDGE 2.0

/* An edge with its ends in order; `turns` says how many times it runs from a to b less how many times from b to a. */
typedef struct side {
    gnoi_dot a, b;
    int turns;
} side;

static int compare_dots(gnoi_dot p, gnoi_dot q)
{
    if (p.x != q.x) {
        return p.x < q.x ? -1 : 1;
    }
    return (p.y > q.y) - (p.y < q.y);
}

static int by_ends(const void *a, const void *b)
{
    const side *s = a, *t = b;
    const int order = compare_dots(s->a, t->a);
    return order != 0 ? order : compare_dots(s->b, t->b);
}

static int add_side(gno_context *context, gnoi_mesh_array *sides, gnoi_dot from, gnoi_dot to)
{
    const int forwards = compare_dots(from, to) < 0;
    const side s = {forwards ? from : to, forwards ? to : from, forwards ? 1 : -1};
    if (!gnoi_mesh_array_room(context, sides, 1, sizeof s)) {
        return 0;
    }
    ((side *)sides->data)[sides->count++] = s;
    return 1;
}

/* The rings of all shapes; holes run against their outer ring as they do in the pieces. */
static int add_shapes(const gnoi_drawing *d, gnoi_mesh_array *sides)
{
    for (size_t r = 0; r < d->rings.ring_end.count; r++) {
        const gnoi_dot *dots = gnoi_dots(&d->rings.dots) + gnoi_ring_begin(&d->rings, r);
        const size_t count = gnoi_ring_end(&d->rings, r) - gnoi_ring_begin(&d->rings, r);
        for (size_t i = 0; i < count; i++) {
            if (!add_side(d->context, sides, dots[i], dots[(i + 1) % count])) {
                return 0;
            }
        }
    }
    return 1;
}

static int by_place(const void *a, const void *b)
{
    return compare_dots(*(const gnoi_dot *)a, *(const gnoi_dot *)b);
}

/* One side of the frame, from corner to corner, cut at every dot that lies on it. */
static int add_frame_side(const gnoi_drawing *d, gnoi_mesh_array *on, gnoi_mesh_array *sides, gnoi_dot from, gnoi_dot to)
{
    const gnoi_dot *dots = gnoi_dots(&d->rings.dots);
    const int upright = from.x == to.x, forwards = compare_dots(from, to) < 0;
    on->count = 0;
    for (size_t i = 0; i < d->rings.dots.count + 2; i++) {
        const gnoi_dot dot = i < 2 ? (i == 0 ? from : to) : dots[i - 2];
        if (upright ? dot.x != from.x : dot.y != from.y) {
            continue;
        }
        if (!gnoi_mesh_array_room(d->context, on, 1, sizeof dot)) {
            return 0;
        }
        ((gnoi_dot *)on->data)[on->count++] = dot;
    }
    qsort(on->data, on->count, sizeof(gnoi_dot), by_place);
    for (size_t i = 0; i + 1 < on->count; i++) {
        const gnoi_dot a = gnoi_dots(on)[i], b = gnoi_dots(on)[i + 1];
        if (compare_dots(a, b) != 0 && !add_side(d->context, sides, forwards ? a : b, forwards ? b : a)) {
            return 0;
        }
    }
    return 1;
}

/* The frame clockwise as seen, shapes running counter-clockwise. */
static int add_frame(const gnoi_drawing *d, gnoi_mesh_array *sides)
{
    const int64_t w = d->width * d->unit, h = d->height * d->unit;
    const gnoi_dot corner[5] = {{0, 0}, {w, 0}, {w, h}, {0, h}, {0, 0}};
    gnoi_mesh_array on = {NULL, 0, 0};
    int done = 1;
    for (int i = 0; i < 4 && done; i++) {
        done = add_frame_side(d, &on, sides, corner[i], corner[i + 1]);
    }
    gnoi_mesh_array_free(d->context, &on, sizeof(gnoi_dot));
    return done;
}

/* Leaves of each edge what does not cancel, as edges from a to b, sorted by a, then b. */
static void cancel(gnoi_mesh_array *sides)
{
    side *s = sides->data;
    size_t count = 0;
    if (sides->count > 1) {
        qsort(s, sides->count, sizeof *s, by_ends);
    }
    for (size_t i = 0, n; i < sides->count; i += n) {
        side sum = s[i];
        for (n = 1; i + n < sides->count && by_ends(&s[i], &s[i + n]) == 0; n++) {
            sum.turns += s[i + n].turns;
        }
        const side left = {sum.turns > 0 ? sum.a : sum.b, sum.turns > 0 ? sum.b : sum.a, 1};
        for (int k = abs(sum.turns); k > 0; k--) {
            s[count++] = left;
        }
    }
    sides->count = count;
    if (count > 1) {
        qsort(s, count, sizeof *s, by_ends);
    }
}

/* A corner on an edge, and how far along. */
typedef struct stop {
    gnoi_dot dot;
    double along;
} stop;

static int by_way(const void *a, const void *b)
{
    const stop *s = a, *t = b;
    return s->along != t->along ? (s->along > t->along) - (s->along < t->along) : compare_dots(s->dot, t->dot);
}

/* The first of the corners, sorted, that is not left of x. */
static size_t first_right_of(const gnoi_mesh_array *corners, int64_t x)
{
    size_t low = 0, high = corners->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (gnoi_dots(corners)[middle].x < x) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Collects the corners that lie within an edge, in order. */
static int find_stops(gno_context *context, const side *s, const gnoi_mesh_array *corners, gnoi_mesh_array *stops)
{
    const double dx = (double)(s->b.x - s->a.x), dy = (double)(s->b.y - s->a.y), length2 = dx * dx + dy * dy;
    const int64_t right = s->a.x > s->b.x ? s->a.x : s->b.x, left = s->a.x + s->b.x - right, slack = (int64_t)ON_EDGE;
    stops->count = 0;
    for (size_t i = first_right_of(corners, left - slack); i < corners->count && gnoi_dots(corners)[i].x <= right + slack; i++) {
        const gnoi_dot dot = gnoi_dots(corners)[i];
        const double px = (double)(dot.x - s->a.x), py = (double)(dot.y - s->a.y), along = px * dx + py * dy, off = px * dy - py * dx;
        if (along <= 0 || along >= length2 || off * off > ON_EDGE * ON_EDGE * length2 || compare_dots(dot, s->a) == 0 ||
            compare_dots(dot, s->b) == 0) {
            continue;
        }
        if (!gnoi_mesh_array_room(context, stops, 1, sizeof(stop))) {
            return 0;
        }
        const stop fresh = {dot, along};
        ((stop *)stops->data)[stops->count++] = fresh;
    }
    if (stops->count > 1) {
        qsort(stops->data, stops->count, sizeof(stop), by_way);
    }
    return 1;
}

/* Puts the edges, cut at every corner of others that lies on them, into `cut`. */
static int cut_at_corners(gno_context *context, const gnoi_mesh_array *sides, gnoi_mesh_array *corners, gnoi_mesh_array *stops,
                          gnoi_mesh_array *cut)
{
    const side *s = sides->data;
    if (!gnoi_mesh_array_room(context, corners, sides->count, sizeof(gnoi_dot))) {
        return 0;
    }
    /* Sorted by where they begin, and what is left begins at every corner. */
    for (size_t i = 0; i < sides->count; i++) {
        if (i == 0 || compare_dots(s[i - 1].a, s[i].a) != 0) {
            ((gnoi_dot *)corners->data)[corners->count++] = s[i].a;
        }
    }
    for (size_t i = 0; i < sides->count; i++) {
        gnoi_dot from = s[i].a;
        if (!find_stops(context, &s[i], corners, stops)) {
            return 0;
        }
        for (size_t k = 0; k <= stops->count; k++) {
            const gnoi_dot to = k < stops->count ? ((const stop *)stops->data)[k].dot : s[i].b;
            if (compare_dots(from, to) != 0 && !add_side(context, cut, from, to)) {
                return 0;
            }
            from = to;
        }
    }
    return 1;
}

/* Cancels, cuts what is left at the corners, and cancels again. */
static int cancel_all(gno_context *context, gnoi_mesh_array *sides)
{
    gnoi_mesh_array corners = {NULL, 0, 0}, stops = {NULL, 0, 0}, cut = {NULL, 0, 0};
    cancel(sides);
    const int done = cut_at_corners(context, sides, &corners, &stops, &cut);
    gnoi_mesh_array_free(context, &corners, sizeof(gnoi_dot));
    gnoi_mesh_array_free(context, &stops, sizeof(stop));
    gnoi_mesh_array_free(context, sides, sizeof(side));
    *sides = cut;
    cancel(sides);
    return done;
}

static size_t find_start(const gnoi_mesh_array *sides, gnoi_dot dot)
{
    const side *s = sides->data;
    size_t low = 0, high = sides->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare_dots(s[middle].a, dot) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* An edge not taken yet that begins at a dot, or sides->count. `taken` holds for the first edge of each dot how many were. */
static size_t take_from(const gnoi_mesh_array *sides, size_t *taken, gnoi_dot dot)
{
    const side *s = sides->data;
    const size_t first = find_start(sides, dot);
    if (first == sides->count || compare_dots(s[first].a, dot) != 0) {
        return sides->count;
    }
    const size_t at = first + taken[first];
    if (at == sides->count || compare_dots(s[at].a, dot) != 0) {
        return sides->count;
    }
    taken[first]++;
    return at;
}

/* Joins edges to rings; a ring is closed as soon as it comes back to where it began. */
static int join(gnoi_drawing *d, const gnoi_mesh_array *sides, size_t *taken)
{
    const side *s = sides->data;
    const double least = 2 * LEAST_RING * (double)d->unit * (double)d->unit;
    for (size_t i = 0; i < sides->count;) {
        size_t at = take_from(sides, taken, s[i].a);
        const size_t closed = d->around.ring_end.count, begin = gnoi_ring_begin(&d->around, closed);
        if (at == sides->count) {
            i++;
            continue;
        }
        const gnoi_dot start = s[at].a;
        for (; at != sides->count; at = compare_dots(s[at].b, start) != 0 ? take_from(sides, taken, s[at].b) : sides->count) {
            if (!gnoi_rings_add(d->context, &d->around, s[at].a)) {
                return 0;
            }
        }
        if (!gnoi_rings_close(d->context, &d->around)) {
            return 0;
        }
        if (d->around.ring_end.count > closed &&
            fabs(gnoi_dots_area2(gnoi_dots(&d->around.dots) + begin, d->around.dots.count - begin)) < least) {
            d->around.ring_end.count = closed;
            d->around.dots.count = begin;
        }
    }
    return 1;
}

gno_status gnoi_drawing_outline(gnoi_drawing *d)
{
    gnoi_mesh_array sides = {NULL, 0, 0};
    int done = add_shapes(d, &sides) && add_frame(d, &sides) && cancel_all(d->context, &sides);
    if (done) {
        const size_t bytes = (sides.count + 1) * sizeof(size_t);
        size_t *taken = gno_context_realloc(d->context, NULL, 0, bytes);
        done = taken != NULL;
        for (size_t i = 0; done && i < sides.count; i++) {
            taken[i] = 0;
        }
        done = done && join(d, &sides, taken);
        gno_context_realloc(d->context, taken, bytes, 0);
    }
    gnoi_mesh_array_free(d->context, &sides, sizeof(side));
    return done ? GNO_OK : gnoi_drawing_no_memory(d);
}
