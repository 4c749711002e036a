/* gather.h -- what a tree holds about a group of receivers that lie near each other.
 *
 * Place in the data flow: tree of casters or contour edges (tree.h) + the box of a group -> this -> the same for each half of the group
 * (column.c) -> candidates of each receiver (column.c, sheet.c). Group and tree are walked down together: the nodes held are about as
 * large as the group.
 * Invariant: every entry of the tree that meets the group's box, and does not begin behind its farthest depth, lies in a node that is
 * held.
 */
#ifndef GNOI_SHADOW_GATHER_H
#define GNOI_SHADOW_GATHER_H

#include "shadow/tree.h"

typedef struct gnoi_held {
    uint32_t node; /* of its level */
    int level;
} gnoi_held;

typedef struct gnoi_gathered {
    const gnoi_tree *tree;
    size_t count;
    size_t level; /* how many nodes, or entries of the lowest ones, do not end before the group's nearest depth */
    size_t box_capacity, held_capacity;
    gnoi_eight *boxes; /* of what is held */
    gnoi_held *held;
} gnoi_gathered;

/* How far a tree is walked down. */
typedef struct gnoi_grain {
    float side;  /* nodes larger than this are parted; negative: down to the lowest */
    int before;  /* but for those that end before the group */
} gnoi_grain;

/* whole: gathered for a box that holds this one; NULL: the tree itself is asked. Returns 0 when memory fails. */
int gnoi_gather(gno_context *context, const gnoi_tree *tree, const gnoi_gathered *whole, const gnoi_lbox *box, gnoi_grain grain,
                gnoi_gathered *gathered);

/* Takes out lowest nodes whose polygons have planes nowhere in the group's box nearer to the light than its farthest depth. */
void gnoi_gathered_drop_behind(const gno_scene *scene, const gnoi_lbox *box, gnoi_gathered *gathered);

void gnoi_gathered_free(gno_context *context, gnoi_gathered *gathered);

/* Appends what the tree holds for every entry that meets `box`, does not begin behind its farthest depth and, given a probe and a tree
 * with leaves, is not ruled out by it. before, not NULL: what ends before the nearest depth of `box` is not listed, *before
 * is set when there is any. All must have been parted down to the lowest nodes
 * but for those before the group. Returns 0 when memory fails. */
int gnoi_gathered_query(gno_context *context, const gnoi_gathered *gathered, const gnoi_lbox *box, const gnoi_probe *probe,
                        gnoi_list *found, int *before);

#endif
