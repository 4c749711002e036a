/* piece_bins.h -- visible pieces onto the picture, and which tiles each touches.
 *
 * Place in the data flow: visible pieces (gnomon_pieces.h) + view -> edges in picture coordinates, piece numbers by tile ->
 * coverage (coverage.h) -> engine/weiler_atherton.c.
 * Invariants: a tile's list holds, in ascending order, every piece whose box meets the tile; edges run so that gnoi_coverage_edge
 * with sign +1 makes a piece's area positive and its holes' negative.
 */
#ifndef GNOI_SCAN_PIECE_BINS_H
#define GNOI_SCAN_PIECE_BINS_H

#include "scan/bins.h"
#include <gnomon/gnomon_pieces.h>

/* From a to b in the picture. */
typedef struct gnoi_piece_edge {
    double ax, ay, bx, by;
} gnoi_piece_edge;

typedef struct gnoi_picture_piece {
    uint32_t poly;             /* prepared polygon that it is a part of */
    uint32_t sheet;            /* number of the lights' state among the polygon's */
    uint32_t group;            /* number, in the set, of the pieces of the same polygon and sheet */
    uint32_t edge, edge_count; /* into gnoi_piece_bins.edges */
    uint32_t bands;            /* of a piece of many edges: tiles_y + 1 offsets into band_edges from here in band_start;
                                  GNOI_NONE: a tile goes through all edges */
    double x0, y0, x1, y1;     /* its box in the picture */
} gnoi_picture_piece;

typedef struct gnoi_piece_bins {
    int tiles_x, tiles_y;
    size_t piece_count;
    gnoi_picture_piece *pieces; /* one for each of the set, same order */
    size_t edge_count;
    gnoi_piece_edge *edges;
    size_t band_start_count;
    uint32_t *band_start;
    size_t band_edge_count;
    uint32_t *band_edges; /* numbers of edges that meet a row of tiles */
    uint32_t *start;      /* tiles+1 offsets into items */
    uint32_t *items;
    size_t item_count;
} gnoi_piece_bins;

/* What the set keeps beside (shadow/piece_set.h), NULL: nothing. */
const gno_pieces *gnoi_pieces_beside(const gno_pieces *pieces);

/* Whether the pieces can be of this scene, which must be prepared. */
int gnoi_pieces_fit(const gno_scene *scene, const gno_pieces *pieces);

/* The scene must be prepared. Errors: MEMORY, LIMIT. */
gno_status gnoi_piece_bins_build(const gno_scene *scene, const gnoi_view *view, const gno_pieces *pieces, gnoi_piece_bins *bins);
void gnoi_piece_bins_free(gno_context *context, gnoi_piece_bins *bins);

/* Edges of a piece that may meet a row of tiles: *count of them; edge i is bins->edges[*first + i], or, when the result is not NULL,
 * bins->edges[result[i]]. */
const uint32_t *gnoi_piece_band(const gnoi_piece_bins *bins, const gnoi_picture_piece *piece, int tile_row, uint32_t *first,
                                uint32_t *count);

#endif
