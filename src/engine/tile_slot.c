/* tile_slot.c -- a slot for each polygon drawn in a tile: its plane as the tile's lines see it, and what its lamps will be asked for. See
 * tile.h.
 */
#include "engine/tile.h"

int gnoi_tile_reserve_slots(gnoi_tile *tile, size_t more)
{
    gnoi_lines *lines = &tile->lines;
    return gnoi_reserve(lines->context, (void **)&tile->slots, &tile->slot_capacity, tile->slot_count + more, sizeof *tile->slots) &&
           gnoi_reserve(lines->context, (void **)&tile->briefs, &tile->brief_capacity, tile->slot_count + more, sizeof *tile->briefs) &&
           gnoi_reserve(lines->context, (void **)&lines->depths, &lines->depth_capacity, tile->slot_count + more, sizeof *lines->depths);
}

static double clamp(double v, double lo, double hi) { return v < lo ? lo : v > hi ? hi : v; }

static int row_of(double y)
{
    int row = (int)y;
    return row - (y < row);
}

static void set_receiver(const gnoi_tile *tile, const gnoi_lanes *l, unsigned lane, uint32_t index, int cut, gnoi_receiver *r)
{
    const gnoi_rect rect = tile->rect;
    r->poly = &tile->job->scene->prepared.polys[index];
    r->index = index;
    r->side = l->side[lane];
    r->nearness.fx = l->fx[lane];
    r->nearness.fy = l->fy[lane];
    r->nearness.f0 = l->f0[lane];
    r->tolerance = l->tolerance[lane];
    r->x0 = clamp(l->x0[lane], rect.x0, rect.x1);
    r->x1 = clamp(l->x1[lane], rect.x0, rect.x1);
    r->y0 = clamp(l->y0[lane], rect.y0, rect.y1);
    r->y1 = clamp(l->y1[lane], rect.y0, rect.y1);
    r->first_row = row_of(r->y0);
    r->rows = row_of(r->y1) - r->first_row + 1;
    r->whole = !cut && r->x0 == l->x0[lane] && r->x1 == l->x1[lane] && r->y0 == l->y0[lane] && r->y1 == l->y1[lane];
}

/* Bounds of the surface's nearness in the tile: those of its corners, and those of its plane over the tile. */
static void set_depth(const gnoi_tile *tile, const gnoi_lanes *l, unsigned lane, const gnoi_receiver *r, gnoi_depth *depth)
{
    double tolerance = r->tolerance / fabs(r->side);
    float nearest = l->z1[lane] < l->high[lane] ? l->z1[lane] : l->high[lane];
    float farthest = l->z0[lane] > l->low[lane] ? l->z0[lane] : l->low[lane];
    depth->fx = r->nearness.fx / GNOI_X_ONE;
    depth->fy = r->nearness.fy;
    depth->f0 = r->nearness.f0 + r->nearness.fx * tile->x0;
    depth->tolerance_z = tile->job->view.orthographic ? 0 : tolerance;
    depth->tolerance_0 = tile->job->view.orthographic ? tolerance : 0;
    depth->index = r->poly->source;
    depth->priority = r->poly->priority;
    depth->nearest = nearest + GNOI_FLOAT_SLACK * fabsf(nearest);
    depth->farthest = farthest - GNOI_FLOAT_SLACK * fabsf(farthest);
    depth->surely_before = depth->nearest + (float)(depth->tolerance_z * fabs((double)depth->nearest) + depth->tolerance_0);
    depth->surely_behind = depth->farthest - (float)(depth->tolerance_z * fabs((double)depth->farthest) + depth->tolerance_0);
    depth->surely_before += GNOI_FLOAT_SLACK * fabsf(depth->surely_before);
    depth->surely_behind -= GNOI_FLOAT_SLACK * fabsf(depth->surely_behind);
}

uint32_t gnoi_tile_new_slot(gnoi_tile *tile, const gnoi_lanes *lanes, unsigned lane, uint32_t index, int cut)
{
    static const gnoi_brief none;
    gnoi_slot *slot = &tile->slots[tile->slot_count];
    double side = lanes->side[lane];
    if (side == 0 || (side < 0 && !tile->job->scene->prepared.polys[index].two_sided))
        return GNOI_NONE;
    slot->first_column = slot->first_intensity = slot->mapping = GNOI_NONE;
    slot->intensity_triangle = GNOI_NONE;
    tile->briefs[tile->slot_count] = none;
    slot->interp.ready = 0;
    set_receiver(tile, lanes, lane, index, cut, &slot->receiver);
    set_depth(tile, lanes, lane, &slot->receiver, &tile->lines.depths[tile->slot_count]);
    return (uint32_t)tile->slot_count++;
}
