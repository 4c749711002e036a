/* tile_soft.c -- splitting a visible piece where a lamp's shadows weaken with the distance of their casters: see tile.h.
 *
 * The piece is cut where shadow polygons begin and end, as by gno_span_split, and at the borders of pixels. Over such a part the casters
 * are the same and their distances change evenly: each caster's v = 1 - s / (1 + d/D) is taken at the middle, and they multiply.
 */
#include "engine/tile.h"

/* Parts shorter than this, in pixels, carry no light worth a sample: see GNOI_LEAK_LENGTH of tile.h. */
#define LEAST_LENGTH (2.0 / GNOI_X_ONE)

/* Puts the column's intervals that meet (x0,x1) to the head of the list; returns how many do. */
static size_t keep_meeting(gnoi_columns *store, double x0, double x1)
{
    size_t n = 0;
    for (size_t i = 0; i < store->interval_count; i++) {
        gno_shadow_interval s = store->intervals[i];
        uint32_t source = store->sources[i];
        if (!(s.x0 < x1 && s.x1 > x0))
            continue;
        store->intervals[i] = store->intervals[n];
        store->sources[i] = store->sources[n];
        store->intervals[n] = s;
        store->sources[n++] = source;
    }
    return n;
}

/* The end of the part that begins at x: the next place where an interval begins or ends, or the border of a pixel. */
static double part_end(const gno_shadow_interval *s, size_t count, double x, double x1)
{
    double end = floor(x) + 1 < x1 ? floor(x) + 1 : x1;
    for (size_t i = 0; i < count; i++) {
        if (s[i].x0 > x && s[i].x0 < end)
            end = s[i].x0;
        if (s[i].x1 > x && s[i].x1 < end)
            end = s[i].x1;
    }
    return end;
}

/* What is left of the lamp's light at the receiver's point seen at (x,y). */
static void light_at(const gnoi_tile *tile, int lamp, const gnoi_slot *slot, size_t count, double x, double y, double light[3])
{
    const gnoi_frame_job *job = tile->job;
    light[0] = light[1] = light[2] = 1;
    for (size_t i = 0; i < count; i++) {
        const gno_shadow_interval *s = &tile->store.intervals[i];
        double v[3] = {0, 0, 0};
        if (!(s->x0 <= x && s->x1 > x))
            continue;
        if (tile->store.sources[i] != GNOI_NONE)
            gnoi_caster_light(job->scene, &job->view, &job->lamps[lamp], &slot->receiver, tile->store.sources[i], x, y, v);
        for (int k = 0; k < 3; k++)
            light[k] *= v[k];
    }
}

void gnoi_tile_split_soft(gnoi_tile *tile, int lamp, const gnoi_slot *slot, const gnoi_piece *piece, float dy, int line)
{
    double x0 = tile->x0 + (double)piece->x0 / GNOI_X_ONE, x1 = tile->x0 + (double)piece->x1 / GNOI_X_ONE, y = tile->lines.lines[piece->line].y;
    size_t count = keep_meeting(&tile->store, x0, x1);
    for (double x = x0, end; x < x1; x = end) {
        double light[3];
        end = part_end(tile->store.intervals, count, x, x1);
        light_at(tile, lamp, slot, count, 0.5 * (x + end), y, light);
        if (end - x >= LEAST_LENGTH && (light[0] > 0 || light[1] > 0 || light[2] > 0))
            gnoi_tile_add_lit(tile, lamp, piece, (float)(x - tile->x0), (float)(end - tile->x0), light, dy, line);
    }
}
