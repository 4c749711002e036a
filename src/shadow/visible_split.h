/* visible_split.h -- what the eye sees of one polygon, split by the lights that reach it.
 *
 * Place in the data flow: visible.c puts what the eye sees into `region` and one sheet of it into `now` -> here, light after light ->
 * visible.c makes pieces of the sheets. For src/shadow alone.
 * Parts that the same lights reach are a sheet; a light turns every sheet into at most two, and more only behind transparent casters. Of
 * lights that shall not split, the points of an area light for one, what they reach of each sheet is kept beside, light by light: their
 * number then adds up where it would multiply.
 * Invariant: sheets do not overlap, and together are what the eye sees but for slivers along borders.
 */
#ifndef GNOI_SHADOW_VISIBLE_SPLIT_H
#define GNOI_SHADOW_VISIBLE_SPLIT_H

#include "shadow/piece_set.h"
#include "shadow/receiver.h"

/* Which lights reach: the last one, and the lights without it. */
typedef struct gnoi_reach {
    uint32_t before; /* GNOI_NONE: none */
    unsigned light;
    double passed[3];
} gnoi_reach;

typedef struct gnoi_split_sheet {
    uint32_t reach;      /* GNOI_NONE: no light */
    size_t first, count; /* polygons of the shape beside */
} gnoi_split_sheet;

typedef struct gnoi_split_sheets {
    size_t count, capacity;
    gnoi_split_sheet *items;
    gnoi_shape shape;
} gnoi_split_sheets;

/* A worker's own; the first five members are the run's. */
typedef struct gnoi_splitter {
    gno_context *context;
    const gno_pieces *const *lit; /* for each light, kept lit pieces or NULL; NULL: none */
    const gnoi_centre *eye;
    const gnoi_centre *lights;    /* empty where kept pieces serve */
    gnoi_parter parter;
    gnoi_shape region;            /* what the eye sees */
    gnoi_shape single;            /* one sheet, offsets from 0 */
    gnoi_shape dark, thick;
    gnoi_split_sheets now, next;
    size_t reach_count, reach_capacity;
    gnoi_reach *reaches;
} gnoi_splitter;

/* Errors: MEMORY; the splitter is to be freed then too. The pointers of the run are the caller's to set. */
gno_status gnoi_splitter_make(const gno_scene *scene, gnoi_splitter *w);
void gnoi_splitter_free(gnoi_splitter *w);

/* Makes the region the only sheet. 0 when memory fails. */
int gnoi_split_begin(gnoi_splitter *w);

/* Splits every sheet by a light. convex: the region is one convex ring. *cut is set when sheets are no longer what the eye sees undivided. */
gno_status gnoi_split_by_light(gnoi_splitter *w, unsigned light, const gnoi_canvas *eye, int convex, int *cut);

/* Adds what a light reaches of every sheet, where that is neither all nor nothing, to `list`, and leaves the sheets as they are. */
gno_status gnoi_split_beside(gnoi_splitter *w, unsigned light, const gnoi_receiver_view *r, int convex, gnoi_piece_list *list);

/* Adds the lights of a reach to the list's last piece, by number. 0 when memory fails. */
int gnoi_split_add_lights(const gnoi_splitter *w, uint32_t reach, gnoi_piece_list *list);

#endif
