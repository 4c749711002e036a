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

#endif
