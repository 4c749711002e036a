/* vertices.c -- the distinct points, numbered from left to right and, on one vertical, upwards: the order of the sweep.
 *
 * Place: third pass (clipper.h). In: points. Out: vertices in order, and the vertex of each point.
 */
#include "clip/clipper.h"

#define SHORT_RUN 24

static void sort_run_by_comparing(const gno_clipper *c, gnoi_keyed *run, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        gnoi_keyed moved = run[i];
        gnoi_site p = c->points[moved.value];
        size_t j = i;
        for (; j > 0 && gnoi_site_less(p, c->points[run[j - 1].value]); j--)
            run[j] = run[j - 1];
        run[j] = moved;
    }
}

/* Points that agree in the first digits of x: by the other digits, the last ones first. */
static void sort_run_by_digits(const gno_clipper *c, gnoi_keyed *run, size_t count)
{
    for (int digit = 0; digit < 3; digit++) {
        for (size_t i = 0; i < count; i++) {
            gnoi_site p = c->points[run[i].value];
            run[i].key = digit == 0 ? (uint32_t)p.y : digit == 1 ? (uint32_t)(p.y >> 32) : (uint32_t)p.x;
        }
        gnoi_sort(run, c->key_scratch, count);
    }
}

static int sort_points(gno_clipper *c)
{
    int shift = c->bits > 31 ? c->bits - 31 : 0;
    for (size_t i = 0; i < c->point_count; i++) {
        c->keys[i].key = (uint32_t)(c->points[i].x >> shift);
        c->keys[i].value = (uint32_t)i;
    }
    if (!gnoi_sort_asking(c->context, c->keys, c->key_scratch, c->point_count))
        return 0;
    for (size_t i = 0, j; i < c->point_count; i = j) {
        uint32_t key = c->keys[i].key;
        if (gnoi_clip_stopped(c, 1))
            return 0;
        for (j = i + 1; j < c->point_count && c->keys[j].key == key; j++)
            ;
        if (j - i <= SHORT_RUN)
            sort_run_by_comparing(c, c->keys + i, j - i);
        else
            sort_run_by_digits(c, c->keys + i, j - i);
    }
    return 1;
}

gno_status gnoi_clip_vertices(gno_clipper *c)
{
    if (!GNOI_CLIP_RESERVE(c, keys, key_capacity, c->point_count) ||
        !GNOI_CLIP_RESERVE(c, key_scratch, key_scratch_capacity, c->point_count) ||
        !GNOI_CLIP_RESERVE(c, vertex_of, vertex_of_capacity, c->point_count) ||
        !GNOI_CLIP_RESERVE(c, vertices, vertex_capacity, c->point_count))
        return GNO_ERROR_MEMORY;
    if (!sort_points(c))
        return GNO_ERROR_MEMORY;
    c->vertex_count = 0;
    for (size_t i = 0; i < c->point_count; i++) {
        gnoi_site p = c->points[c->keys[i].value];
        if (gnoi_clip_stopped_at(c, i))
            return GNO_ERROR_MEMORY;
        if (c->vertex_count == 0 || !gnoi_site_equal(p, c->vertices[c->vertex_count - 1]))
            c->vertices[c->vertex_count++] = p;
        c->vertex_of[c->keys[i].value] = (uint32_t)(c->vertex_count - 1);
    }
    return GNO_OK;
}
