/* lit_files.h -- what the writers of lit tables and pieces share.
 *
 * Place: gno_lit_table_write (lit_table.c), gno_pieces_write (pieces_file.c -> pieces_obj.c, pieces_geojson.c).
 */
#ifndef GNOI_IO_LIT_FILES_H
#define GNOI_IO_LIT_FILES_H

#include "io/text_file.h"
#include <gnomon/gnomon_clip.h>
#include <gnomon/gnomon_io.h>

/* The name of an expanded light's light, and which of its points this is. */
gno_status gnoi_light_name(const gno_scene *scene, size_t expanded, const char **name, long long *sample);

/* A piece with its names, on its way to a file. */
typedef struct gnoi_named_piece {
    gno_piece piece;
    const char *object, *light;
    long long sample;
} gnoi_named_piece;

/* A format: `begin` and `end` may be NULL; `put` gets every piece, first tells the first one. */
typedef struct gnoi_pieces_format {
    const char *extension;
    void (*begin)(gnoi_text *text);
    gno_status (*put)(gnoi_text *text, const gnoi_named_piece *piece, int first, void *state);
    void (*end)(gnoi_text *text);
} gnoi_pieces_format;

void gnoi_geojson_begin(gnoi_text *text);
gno_status gnoi_geojson_put(gnoi_text *text, const gnoi_named_piece *piece, int first, void *state);
void gnoi_geojson_end(gnoi_text *text);

void gnoi_obj_begin(gnoi_text *text);
gno_status gnoi_obj_put(gnoi_text *text, const gnoi_named_piece *piece, int first, void *state);

/* State of the OBJ writer. */
typedef struct gnoi_obj_state {
    gno_context *context;
    gno_clipper *clipper;
    long long vertices; /* written so far */
    size_t polygon;     /* of the piece before */
    size_t light;
} gnoi_obj_state;

/* Calls put(user, points, count) for polygons without holes (x,y pairs) that together make up the polygon of the rings given.
 * Errors: MEMORY. */
gno_status gnoi_without_holes(gno_context *context, gno_clipper *clipper, const gno_shape *polygon,
                              void (*put)(void *user, const double *points, size_t count), void *user);

#endif
