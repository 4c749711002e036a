/* packet_split.c -- puts a run of boxes into an order in which neighbours lie together: a kd tree without nodes.
 *
 * Place in the data flow: packet.c, one call for each run. A run is halved at the median of the boxes' middles along the longest of
 * the three axes, and so on; halves are powers of two, so that every eight entries are one cell of the tree, and every 64, and so on.
 * Before a light at a point, where u and v are slopes, depth counts as a share of itself.
 * Invariant: the same entries in the same order give the same result.
 * Source: median splits after Bentley, "Multidimensional binary search trees", 1975; selection after Hoare, "Find", 1961.
 */
#include "shadow/packet.h"

static float key_of(const gnoi_packet_entry *e, int axis)
{
    const gnoi_lbox *b = &e->box;
    return axis == 0 ? b->u0 + b->u1 : axis == 1 ? b->v0 + b->v1 : b->z0 + b->z1;
}

static void swap(gnoi_packet_entry *a, gnoi_packet_entry *b)
{
    gnoi_packet_entry t = *a;
    *a = *b;
    *b = t;
}

/* Hoare's selection: afterwards no entry before `middle` has a greater key than one from it on. */
static void select_middle(gnoi_packet_entry *e, size_t count, size_t middle, int axis)
{
    size_t low = 0, high = count - 1;
    while (low < high) {
        float pivot = key_of(&e[low + (high - low) / 2], axis);
        size_t i = low, j = high;
        for (;;) {
            while (key_of(&e[i], axis) < pivot)
                i++;
            while (pivot < key_of(&e[j], axis))
                j--;
            if (i >= j)
                break;
            swap(&e[i++], &e[j--]);
        }
        /* [low, j] holds keys <= pivot, [j + 1, high] keys >= pivot; i may stand on the one that parts them. */
        if (i == j) {
            if (middle == i)
                return;
            if (middle < i)
                high = i - 1;
            else
                low = i + 1;
        } else if (middle <= j) {
            high = j;
        } else {
            low = i;
        }
    }
}

static int longest_axis(const gnoi_packet_entry *e, size_t count, int parallel)
{
    float extent[3], far = 0;
    int axis;
    for (axis = 0; axis < 3; axis++) {
        float lo = key_of(&e[0], axis), hi = lo;
        for (size_t i = 1; i < count; i++) {
            float k = key_of(&e[i], axis);
            lo = k < lo ? k : lo;
            hi = k > hi ? k : hi;
        }
        extent[axis] = hi - lo;
        far = hi;
    }
    extent[2] = parallel ? extent[2] : 2 * extent[2] / (far > 0 ? far : 1);
    axis = extent[1] > extent[0];
    return extent[2] > extent[axis] ? 2 : axis;
}

void gnoi_packet_split(gnoi_packet_entry *entries, size_t count, int parallel)
{
    size_t left = GNOI_PACKET;
    if (count <= GNOI_PACKET)
        return;
    while (2 * left < count)
        left *= 2;
    select_middle(entries, count, left, longest_axis(entries, count, parallel));
    gnoi_packet_split(entries, left, parallel);
    gnoi_packet_split(entries + left, count - left, parallel);
}
