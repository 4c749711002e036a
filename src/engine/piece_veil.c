/* piece_veil.c -- see piece_veil.h. */
#include "engine/piece_veil.h"

/* Planes nearer to each other than this share of their nearness lie on each other. */
#define SAME_NEARNESS 1e-9

int gnoi_piece_veils_add(gnoi_piece_veils *veils, gnoi_tile *tile, uint32_t slot, gnoi_tile_values area)
{
    const gnoi_receiver *r = &tile->slots[slot].receiver;
    gnoi_piece_veil *veil;
    if (!gnoi_reserve(tile->lines.context, (void **)&veils->list, &veils->capacity, veils->count + 1, sizeof *veils->list))
        return 0;
    veil = &veils->list[veils->count++];
    veil->poly = r->poly;
    veil->nearness = r->nearness;
    for (int y = 0; y < tile->height; y++)
        for (int x = 0; x < tile->width; x++) {
            gnoi_pass pass = {1, {1, 1, 1}, 0};
            if (area[y][x] > 0)
                pass = gnoi_tile_pass(tile, slot, x * GNOI_X_ONE, (x + 1) * GNOI_X_ONE, tile->y0 + y + 0.5);
            veil->own[y][x] = pass.own;
            veil->area[y][x] = (float)area[y][x];
            veil->before[y][x] = 0;
            for (int k = 0; k < 3; k++)
                veil->through[k][y][x] = pass.through[k];
        }
    return 1;
}

void gnoi_piece_veils_free(gno_context *context, gnoi_piece_veils *veils)
{
    gnoi_free(context, veils->list, veils->capacity, sizeof *veils->list);
}

/* Between surfaces that lie on each other the order is that of lines.h. */
static int lies_before(const gnoi_piece_veil *veil, const gnoi_receiver *r, double x, double y)
{
    double near = gnoi_plane_at(&veil->nearness, x, y), z = gnoi_plane_at(&r->nearness, x, y);
    if (veil->poly == r->poly)
        return 0;
    if (fabs(near - z) > SAME_NEARNESS * (fabs(near) + fabs(z)))
        return near > z;
    if (veil->poly->priority != r->poly->priority)
        return veil->poly->priority > r->poly->priority;
    return veil->poly->source < r->poly->source;
}

void gnoi_piece_veils_cover(gnoi_piece_veils *veils, const gnoi_tile *tile, const gnoi_receiver *receiver, gnoi_tile_values area)
{
    for (size_t i = 0; i < veils->count; i++)
        for (int y = 0; y < tile->height; y++)
            for (int x = 0; x < tile->width; x++)
                if (area[y][x] > 0 && !lies_before(&veils->list[i], receiver, tile->x0 + x + 0.5, tile->y0 + y + 0.5))
                    veils->list[i].before[y][x] += (float)area[y][x];
}

void gnoi_piece_veils_finish(gnoi_piece_veils *veils, const gnoi_tile *tile)
{
    for (size_t i = 0; i < veils->count; i++) {
        gnoi_piece_veil *veil = &veils->list[i];
        for (int y = 0; y < tile->height; y++)
            for (int x = 0; x < tile->width; x++) {
                /* Areas are sums: where there is nothing they may be as far under zero as rounding takes them. */
                float bare = 1 - veil->before[y][x], area = veil->area[y][x], share = area > 0 ? area < bare ? area / bare : 1 : 0;
                for (int k = 0; k < 3; k++)
                    veil->through[k][y][x] = 1 - share * (1 - veil->through[k][y][x]);
            }
    }
}

void gnoi_piece_veils_at(const gnoi_piece_veils *veils, const gnoi_tile *tile, const gnoi_receiver *receiver, int x, int y, double left[3])
{
    left[0] = left[1] = left[2] = 1;
    for (size_t i = 0; i < veils->count; i++) {
        const gnoi_piece_veil *veil = &veils->list[i];
        for (int k = 0; k < 3 && receiver && receiver->poly == veil->poly; k++)
            left[k] *= (double)veil->own[y][x];
        if (receiver && !lies_before(veil, receiver, tile->x0 + x + 0.5, tile->y0 + y + 0.5))
            continue;
        for (int k = 0; k < 3; k++)
            left[k] *= (double)veil->through[k][y][x];
    }
}
