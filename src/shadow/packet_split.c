/* packet_split.c -- puts a run of boxes into an order in which neighbours lie together: a kd tree without nodes.
 *
 * Place in the data flow: packet.c, one call for each run. A run is halved at the median of the boxes' middles along the longest of
 * the three axes, and so on; halves are powers of two, so that every eight entries are one cell of the tree, and every 64, and so on.
 * Before a light at a point, where u and v are slopes, depth counts as a share of itself. Middles are rounded to 16 bits of the run's extent and
 * packed into one word with the entry's number, so that a whole run is worked on in the nearest cache.
 * Invariant: the same entries in the same order give the same result.
 * Source: median splits after Bentley, "Multidimensional binary search trees", 1975; selection after Hoare, "Find", 1961; parting without
 * branches after Lomuto as told by Alexandrescu, 2020.
 */
#include "shadow/packet.h"

#include <float.h>

/* Bits 0-15, 16-31 and 32-47: the middle; 48-63: the entry's number. */
typedef uint64_t word;

static unsigned key_of(word w, int axis) { return (unsigned)(w >> (16 * axis)) & 0xffffu; }

/* Words with smaller keys than the pivot come first; returns their number. */
static size_t part(word *w, size_t count, int axis, unsigned pivot)
{
    size_t smaller = 0;
    for (size_t i = 0; i < count; i++) {
        word x = w[i];
        w[i] = w[smaller];
        w[smaller] = x;
        smaller += key_of(x, axis) < pivot;
    }
    return smaller;
}

static unsigned middle_of(unsigned a, unsigned b, unsigned c)
{
    unsigned low = a < b ? a : b, high = a < b ? b : a;
    return c < low ? low : c > high ? high : c;
}

static unsigned pivot_of(const word *w, size_t count, int axis)
{
    unsigned k[3];
    size_t step = count / 9;
    if (count < 40)
        return middle_of(key_of(w[0], axis), key_of(w[count / 2], axis), key_of(w[count - 1], axis));
    for (size_t i = 0; i < 3; i++)
        k[i] = middle_of(key_of(w[3 * i * step], axis), key_of(w[(3 * i + 1) * step], axis), key_of(w[(3 * i + 2) * step], axis));
    return middle_of(k[0], k[1], k[2]);
}

/* Afterwards no word before `middle` has a greater key than one from it on. */
static void select_middle(word *w, size_t count, size_t middle, int axis)
{
    while (count > 1) {
        unsigned pivot = pivot_of(w, count, axis);
        size_t smaller = part(w, count, axis, pivot);
        if (middle < smaller) {
            count = smaller;
            continue;
        }
        w += smaller;
        count -= smaller;
        middle -= smaller;
        smaller = part(w, count, axis, pivot + 1); /* those that equal the pivot */
        if (middle < smaller)
            return;
        w += smaller;
        count -= smaller;
        middle -= smaller;
    }
}

static int longest_axis(const word *w, size_t count)
{
    unsigned extent[3];
    for (int axis = 0; axis < 3; axis++) {
        unsigned low = 0xffff, high = 0;
        for (size_t i = 0; i < count; i++) {
            unsigned k = key_of(w[i], axis);
            low = k < low ? k : low;
            high = k > high ? k : high;
        }
        extent[axis] = high - low;
    }
    return extent[2] > extent[0] && extent[2] > extent[1] ? 2 : extent[1] > extent[0];
}

static void split(word *w, size_t count)
{
    size_t left = GNOI_PACKET;
    if (count <= GNOI_PACKET)
        return;
    while (2 * left < count)
        left *= 2;
    select_middle(w, count, left, longest_axis(w, count));
    split(w, left);
    split(w + left, count - left);
}

/* Halved one by one, so that the sum stays finite. */
static void middle_of_box(const gnoi_lbox *b, float at[3])
{
    at[0] = 0.5f * b->u0 + 0.5f * b->u1;
    at[1] = 0.5f * b->v0 + 0.5f * b->v1;
    at[2] = 0.5f * b->z0 + 0.5f * b->z1;
}

void gnoi_packet_split(const gnoi_packet_entry *entries, size_t count, int parallel, uint16_t *order)
{
    word words[GNOI_RUN];
    float low[3] = {FLT_MAX, FLT_MAX, FLT_MAX}, high[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX}, at[3], scale[3], longest = 0;
    for (size_t i = 0; i < count; i++) {
        middle_of_box(&entries[i].box, at);
        for (int a = 0; a < 3; a++) {
            low[a] = at[a] < low[a] ? at[a] : low[a];
            high[a] = at[a] > high[a] ? at[a] : high[a];
        }
    }
    for (int a = 0; a < 3; a++) {
        scale[a] = a < 2 || parallel ? 1 : high[2] > 0 ? 1 / high[2] : 1;
        longest = (high[a] - low[a]) * scale[a] > longest ? (high[a] - low[a]) * scale[a] : longest;
    }
    for (int a = 0; a < 3; a++)
        scale[a] = longest > 0 ? scale[a] * (65535 / longest) : 0;
    for (size_t i = 0; i < count; i++) {
        words[i] = (word)i << 48;
        middle_of_box(&entries[i].box, at);
        for (int a = 0; a < 3; a++) {
            float k = (at[a] - low[a]) * scale[a];
            words[i] |= (word)(k > 0 ? k < 65535 ? (unsigned)k : 65535u : 0u) << (16 * a);
        }
    }
    split(words, count);
    for (size_t i = 0; i < count; i++)
        order[i] = (uint16_t)(words[i] >> 48);
}
