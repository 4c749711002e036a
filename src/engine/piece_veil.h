/* piece_veil.h -- surfaces that let light through, over painted pieces.
 *
 * Place in the data flow: under weiler_atherton.c, for tiles that hold such surfaces: coverage of each -> what it keeps of every
 * pixel's light from behind -> factor on each surface painted and on the background. I = own + kt I_behind, as tile_stack.c has it.
 * What lies in front is told by the planes at the pixel's middle. A surface weakens all that lies behind it in a pixel by the share
 * that it covers of what opaque surfaces before it leave free there: exact wherever a pixel holds no edge of a transparent surface.
 */
#ifndef GNOI_ENGINE_PIECE_VEIL_H
#define GNOI_ENGINE_PIECE_VEIL_H

#include "engine/tile.h"

/* A picture tile's worth of values. */
typedef double gnoi_tile_values[GNOI_TILE_H][GNOI_TILE_W];

/* One surface that is not opaque: what of light from behind is left. */
typedef struct gnoi_piece_veil {
    const gnoi_poly *poly;
    gnoi_screen_plane nearness;
    float area[GNOI_TILE_H][GNOI_TILE_W], before[GNOI_TILE_H][GNOI_TILE_W]; /* what it covers, and opaque surfaces before it */
    float through[3][GNOI_TILE_H][GNOI_TILE_W]; /* where it is, then, finished, on the whole */
    float own[GNOI_TILE_H][GNOI_TILE_W]; /* weight of its own colour */
} gnoi_piece_veil;

typedef struct gnoi_piece_veils {
    size_t count, capacity;
    gnoi_piece_veil *list;
} gnoi_piece_veils;

/* Adds the surface of tile->slots[slot] that covers `area` of the pixels. Returns 0 when memory fails. */
int gnoi_piece_veils_add(gnoi_piece_veils *veils, gnoi_tile *tile, uint32_t slot, gnoi_tile_values area);

/* Then, for every opaque surface, what it covers; and once, after all of them, the end of it. */
void gnoi_piece_veils_cover(gnoi_piece_veils *veils, const gnoi_tile *tile, const gnoi_receiver *receiver, gnoi_tile_values area);
void gnoi_piece_veils_finish(gnoi_piece_veils *veils, const gnoi_tile *tile);

void gnoi_piece_veils_free(gno_context *context, gnoi_piece_veils *veils);

/* What reaches the eye of the surface of a receiver in the pixel (x,y) of the tile, of the background for NULL. */
void gnoi_piece_veils_at(const gnoi_piece_veils *veils, const gnoi_tile *tile, const gnoi_receiver *receiver, int x, int y, double left[3]);

#endif
