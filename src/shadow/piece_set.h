/* piece_set.h -- sets of pieces, while they are collected and as the caller gets them.
 *
 * Place in the data flow: parts on a receiver's plane -> one list for each chunk of receivers -> joined in the order of the
 * scene's polygons -> gno_pieces.
 */
#ifndef GNOI_SHADOW_PIECE_SET_H
#define GNOI_SHADOW_PIECE_SET_H

#include "shadow/cover.h"
#include <gnomon/gnomon_pieces.h>

typedef struct gnoi_piece {
    size_t polygon; /* source number */
    uint32_t prepared; /* number among the prepared polygons */
    size_t ring, ring_count, light, light_count;
    double area, centroid[3];
    int side;
    uint32_t sheet; /* visible pieces of one prepared polygon that the same lights reach have the same number, and follow one another */
} gnoi_piece;

/* Offsets are into the list's own arrays; ring_start counts points. */
typedef struct gnoi_piece_list {
    gno_context *context;
    size_t count, capacity;
    gnoi_piece *pieces;
    size_t ring_count, ring_capacity;
    size_t *ring_start; /* ring_count+1 in use once there is a piece */
    size_t point_count, point_capacity; /* capacity in doubles */
    double *points;
    size_t light_count, light_capacity;
    unsigned *lights;
    size_t passed_capacity;
    double *passed;
} gnoi_piece_list;

struct gno_pieces {
    gnoi_piece_list list;
    size_t polygon_count;
    size_t *first; /* polygon_count+1: the pieces of each polygon of the scene */
    gno_pieces *beside; /* visible pieces: what single lights reach of a sheet that they did not split, one light a piece, the sheet's
                           number with it; NULL when every light splits */
};



void gnoi_piece_list_free(gnoi_piece_list *list);

/* Adds a part on the canvas' plane; scale: the polygon's true area over its area as the centre sees it. Lights are added to the last
 * piece by the next function. Both return 0 when memory fails. */
int gnoi_piece_list_add(gnoi_piece_list *list, const gnoi_canvas *canvas, const gno_shape *shape, size_t polygon, double scale);
int gnoi_piece_list_add_light(gnoi_piece_list *list, unsigned light, const double passed[3]);

/* Adds the whole prepared polygon by its own corners; area and centroid are given. */
int gnoi_piece_list_add_whole(gnoi_piece_list *list, const gnoi_canvas *canvas, double area, vec3 centroid);

/* Joins the lists of `count` chunks; polygons: of the scene. */
gno_status gnoi_pieces_join(gno_context *context, const gnoi_piece_list *lists, size_t count, size_t polygons, gno_pieces **pieces);

#endif
