/* tile_texture.c -- textures and bumps of the surfaces seen in a tile: see tile.h, shade/texture.h, shade/relief.h. */
#include "engine/tile.h"
#include <string.h>

static gnoi_sight sight_of(const gnoi_tile *tile, gnoi_slot *slot)
{
    gnoi_sight sight = {tile->job->scene, &tile->job->view, slot->receiver.poly, &slot->receiver.nearness, &slot->interp};
    return sight;
}

/* The slot's mappings, of texture and bump; NULL when memory fails. */
static gnoi_mapping *seek_mappings(gnoi_tile *tile, gnoi_slot *slot)
{
    if (slot->mapping == GNOI_NONE) {
        if (!gnoi_reserve(tile->lines.context, (void **)&tile->mappings, &tile->mapping_capacity, tile->mapping_count + 2,
                          sizeof *tile->mappings)) {
            tile->failed = 1;
            return NULL;
        }
        slot->mapping = (uint32_t)tile->mapping_count;
        tile->mapping_count += 2;
        memset(&tile->mappings[slot->mapping], 0, 2 * sizeof *tile->mappings);
    }
    return &tile->mappings[slot->mapping];
}

void gnoi_tile_forget_texels(gnoi_tile *tile)
{
    for (int i = 0; i < GNOI_TEXELS && tile->texels; i++)
        tile->texels[i].poly = GNOI_NONE;
}

/* Where the texel is kept, or goes; NULL when memory fails. */
static gnoi_texel *kept_texel(gnoi_tile *tile, uint32_t poly, uint32_t pixel)
{
    if (!tile->texels) {
        tile->texels = gnoi_malloc(tile->lines.context, GNOI_TEXELS, sizeof *tile->texels);
        tile->failed |= !tile->texels;
        gnoi_tile_forget_texels(tile);
    }
    return tile->texels ? &tile->texels[(poly * 0x9e3779b1u ^ pixel) & (GNOI_TEXELS - 1)] : NULL;
}

void gnoi_tile_set_texel(gnoi_tile *tile, gnoi_slot *slot, int row, int column, double x, double y)
{
    uint32_t material = slot->receiver.poly->material, pixel = (uint32_t)(row * GNOI_TILE_W + column);
    int keep = tile->job->tones[material].has_holes;
    gnoi_texel *kept = keep ? kept_texel(tile, slot->receiver.index, pixel) : NULL;
    gnoi_sight sight = sight_of(tile, slot);
    gnoi_mapping *mappings;
    if (kept && kept->poly == slot->receiver.index && kept->pixel == pixel) {
        memcpy(tile->texel, kept->rgba, sizeof tile->texel);
        return;
    }
    mappings = seek_mappings(tile, slot);
    if (!mappings)
        return;
    gnoi_texture_at(&sight, &tile->job->scene->materials[material].texture, mappings, tile->x0 + column + 0.5, tile->y0 + row - 0.5, x, y,
                    tile->texel);
    if (kept) {
        kept->poly = slot->receiver.index;
        kept->pixel = pixel;
        memcpy(kept->rgba, tile->texel, sizeof kept->rgba);
    }
}

void gnoi_tile_ask_texel(gnoi_tile *tile, gnoi_slot *slot, int row, int column, double x, double y)
{
    uint32_t material = slot->receiver.poly->material;
    const gno_texture *texture = &tile->job->scene->materials[material].texture;
    float *texel = tile->asked[tile->texel_count++];
    if (texture->kind == GNO_TEXTURE_IMAGE && !tile->job->tones[material].has_holes) {
        gnoi_sight sight = sight_of(tile, slot);
        gnoi_mapping *mappings = seek_mappings(tile, slot);
        if (mappings)
            gnoi_texture_ask(&sight, texture, mappings, tile->x0 + column + 0.5, tile->y0 + row - 0.5, x, y, &tile->looks, texel);
        return;
    }
    gnoi_tile_set_texel(tile, slot, row, column, x, y);
    memcpy(texel, tile->texel, sizeof tile->texel);
}

/* Whether the pattern at the first of the samples is that at all of them. */
static int is_one_pattern(const gnoi_mapping *mapping, const gnoi_interp *interp, double x, double y)
{
    if (mapping->on_corners)
        return interp->triangle_count == 1 || gnoi_interp_depth(interp, x, y) >= 0;
    return mapping->place.map == GNO_MAP_PLANAR;
}

void gnoi_tile_ask_texels(gnoi_tile *tile, gnoi_slot *slot, int row, int first, int count, const double *x, const double *y)
{
    const gno_texture *texture = &tile->job->scene->materials[slot->receiver.poly->material].texture;
    gnoi_sight sight = sight_of(tile, slot);
    gnoi_mapping *mapping = seek_mappings(tile, slot);
    const gnoi_pattern *pattern = mapping ? gnoi_mapping_seek(mapping, &sight, texture, x[0], y[0]) : NULL;
    int is_one = mapping && is_one_pattern(mapping, &slot->interp, x[count - 1], y[count - 1]);
    double middle_x = tile->x0 + first + 0.5, middle_y = tile->y0 + row - 0.5;
    float(*texel)[4] = &tile->asked[tile->texel_count];
    if (is_one)
        gnoi_looks_ask(&tile->looks, &tile->job->scene->images[texture->image], texture, pattern, middle_x, middle_y, count, x, y, texel);
    for (int i = 0; i < count && mapping && !is_one; i++)
        gnoi_texture_ask(&sight, texture, mapping, middle_x + i, middle_y, x[i], y[i], &tile->looks, texel[i]);
    tile->texel_count += (size_t)count;
}

vec3 gnoi_tile_bumped(gnoi_tile *tile, gnoi_slot *slot, int row, int column, double x, double y, vec3 n)
{
    uint32_t material = slot->receiver.poly->material;
    gnoi_sight sight = sight_of(tile, slot);
    gnoi_mapping *mappings = seek_mappings(tile, slot);
    if (!mappings)
        return n;
    return gnoi_relief_normal(&sight, &tile->job->scene->materials[material].bump, &mappings[!tile->job->tones[material].one_place],
                              tile->x0 + column + 0.5, tile->y0 + row - 0.5, x, y, n);
}

int gnoi_tile_bump_run(gnoi_tile *tile, gnoi_slot *slot, int count, const double *x, const double *y, double (*n)[GNOI_RELIEF_RUN])
{
    uint32_t material = slot->receiver.poly->material;
    const gno_bump *bump = &tile->job->scene->materials[material].bump;
    gnoi_sight sight = sight_of(tile, slot);
    gnoi_mapping *mapping = bump->kind == GNO_BUMP_HEIGHT && bump->texture.kind == GNO_TEXTURE_IMAGE ? seek_mappings(tile, slot) : NULL;
    const gnoi_pattern *pattern;
    if (!mapping)
        return 0;
    mapping += !tile->job->tones[material].one_place;
    pattern = gnoi_mapping_seek(mapping, &sight, &bump->texture, x[0], y[0]);
    return is_one_pattern(mapping, &slot->interp, x[count - 1], y[count - 1]) && gnoi_relief_run(&sight, bump, pattern, count, x, y, n);
}
