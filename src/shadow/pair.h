/* pair.h -- one receiver under one lamp: the exact tests of its casters.
 *
 * Place in the data flow: column.c asks the tree for candidates -> caster.c tests each and makes its shadow polygon -> column.c
 * keeps the column, interval.c finds where a line meets it. For src/shadow alone.
 */
#ifndef GNOI_SHADOW_PAIR_H
#define GNOI_SHADOW_PAIR_H

#include "shadow/column.h"

/* Everything about one (receiver, lamp) pair that its casters' tests share. */
typedef struct gnoi_pair {
    const gno_scene *scene;
    const gnoi_receiver *receiver;
    const gnoi_lamp *lamp;
    gnoi_form h;         /* height over the receiver's plane, positive on the lit side */
    double lamp_height;  /* H; directional: the cosine */
    double tolerance;
    gnoi_form x, y, w;   /* homogeneous picture coordinates of the shadow */
    double w_min;
    int triangle;        /* the receiver has three corners */
    vec3 corner[3];
} gnoi_pair;

/* 0 when viewer and lamp are on opposite sides of the receiver's plane: it is in its own shadow. */
int gnoi_pair_make(gnoi_pair *p, const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *receiver);

typedef enum gnoi_found { GNOI_FOUND_NOTHING, GNOI_FOUND_PART, GNOI_FOUND_ALL, GNOI_FOUND_NO_MEMORY } gnoi_found;

/* Tests one candidate and appends its shadow polygon to the store if it may darken a part of the region; FOUND_ALL: it
 * darkens the whole. */
gnoi_found gnoi_pair_try(const gnoi_pair *p, const gnoi_view *view, uint32_t index, gnoi_columns *columns);

/* 1 when receiver and caster, both triangles, do not overlap as the light sees them; 0 also for other polygons. */
int gnoi_pair_separated(const gnoi_pair *p, const gnoi_poly *caster);

/* ---- far sides of halved solids: sheet.c ---- */

typedef enum gnoi_sheet_state {
    GNOI_SHEET_NOWHERE,  /* no far side is over the region */
    GNOI_SHEET_ALL,      /* far sides are over all of it */
    GNOI_SHEET_PART,     /* they may be over a part of it: the contour edges that cross it are appended to the column */
    GNOI_SHEET_PIERCED,  /* a far side may pass through the receiver: they must be taken one by one */
    GNOI_SHEET_NO_MEMORY
} gnoi_sheet_state;

struct gnoi_region; /* region.h */

/* How the far sides lie over the receiver's region on the light's plane. */
gnoi_sheet_state gnoi_sheet_try(const gnoi_pair *p, const gnoi_casters *casters, const struct gnoi_region *region,
                                const gnoi_probe *probe, gnoi_columns *columns, gnoi_column *column);

/* The same of a region that lies on several faces of the frame, or that has no corners there, by its boxes; never ALL. Uses the last of
 * columns->nears, which columns->near then is. */
gnoi_sheet_state gnoi_sheet_try_apart(const gnoi_pair *p, const gnoi_casters *casters, const gnoi_lbox *boxes, int count,
                                      gnoi_columns *columns, gnoi_column *column);

/* Each item once, for lists gathered from several boxes. */
void gnoi_list_drop_repeats(gnoi_list *list);

/* Where no contour edge and no far side comes near: ALL or NOWHERE, as at this point of the receiver's plane. */
gnoi_sheet_state gnoi_sheet_at(const gnoi_pair *p, const gnoi_casters *casters, vec3 point);

/* The number of far sides over a point of the receiver's plane. */
int gnoi_sheet_count(const gnoi_pair *p, const gnoi_casters *casters, vec3 point);

/* Gathers the contour edges of columns->near, unless that was done. Returns 0 when memory fails. */
int gnoi_sheet_gather_rims(const gnoi_casters *casters, gnoi_columns *columns);

/* sheet_line.c: appends the intervals of line y that the column's contour edges bound. Returns 0 when memory fails. */
int gnoi_sheet_intervals(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_casters *casters,
                         const gnoi_receiver *receiver, gnoi_column *column, double y, double xa, double xb, gnoi_columns *columns);

/* interval.c: appends one interval; transmission NULL: none. Returns 0 when memory fails. */
int gnoi_interval_add(gnoi_columns *columns, double x0, double x1, const double *transmission);

static inline vec3 gnoi_corner_position(const gno_scene *scene, uint32_t corner)
{
    return v3_from(scene->prepared.positions[scene->prepared.corner_vertex[corner]]);
}

/* Pixel row of the receiver's region, for sorting casters; rows beyond it are its first and last. */
static inline int gnoi_region_row(const gnoi_receiver *r, double y)
{
    double row = y - r->first_row;
    return row < 0 ? 0 : row >= r->rows ? r->rows - 1 : (int)row;
}

/* What of a column may cross a row: all of it when it is short, else what is listed for the row. */
typedef struct gnoi_row_list {
    const uint32_t *items; /* NULL: first, first + 1, ... */
    uint32_t first, count;
} gnoi_row_list;

static inline gnoi_row_list gnoi_row_list_of(const gnoi_columns *columns, const gnoi_receiver *r, uint32_t rows, uint32_t first,
                                             uint32_t count, int row)
{
    gnoi_row_list list = {NULL, first, count};
    if (rows != GNOI_NONE) {
        const uint32_t *start = columns->rows.items + rows;
        list.items = start + r->rows + 1 + start[row];
        list.count = start[row + 1] - start[row];
    }
    return list;
}

static inline uint32_t gnoi_row_list_item(const gnoi_row_list *list, uint32_t i)
{
    return list->items ? list->items[i] : list->first + i;
}

#endif
