/* tree.h -- a packed tree of the casters' boxes on one light's plane: the sparse rows of the shadow matrix.
 *
 * Place in the data flow: prepared polygons -> boxes on the light's plane (frame.h) -> this tree -> candidate casters of
 * a receiver (column.h). Built without comparing pairs: boxes are sorted by size class and Morton number and packed eight
 * to a node, level by level (after Kamel and Faloutsos, "On packing R-trees", 1993; the size classes keep large polygons from
 * spoiling the nodes of small ones).
 * Invariants: children of node j of a level are entries 8j..8j+7 of the level below; a node's box holds its children's; slots
 * without a child hold an empty box that nothing meets.
 */
#ifndef GNOI_SHADOW_TREE_H
#define GNOI_SHADOW_TREE_H

#include "scene/scene.h"
#include "shadow/frame.h"

#define GNOI_TREE_FAN 8
#define GNOI_TREE_LEVELS 12

typedef struct gnoi_tree_node {
    float u0[GNOI_TREE_FAN], u1[GNOI_TREE_FAN], v0[GNOI_TREE_FAN], v1[GNOI_TREE_FAN];
    float z0[GNOI_TREE_FAN]; /* nearest depth from the light */
} gnoi_tree_node;

typedef struct gnoi_tree {
    gnoi_frame frame;
    size_t entry_count;
    uint32_t *caster;  /* prepared polygon of each entry, in packed order */
    int levels;        /* level 0 holds the entries' boxes; the last level is one node */
    size_t level_first[GNOI_TREE_LEVELS];
    size_t node_count;
    gnoi_tree_node *nodes;
} gnoi_tree;

/* Builds the tree of every polygon that lets less than all light through. Frees nothing on failure but what it took. */
gno_status gnoi_tree_build(const gno_scene *scene, const gnoi_lamp *lamp, gnoi_tree *tree);
void gnoi_tree_free(gno_context *context, gnoi_tree *tree);

/* A growing list of polygon numbers. */
typedef struct gnoi_list {
    size_t count, capacity;
    uint32_t *items;
} gnoi_list;

/* Appends every caster whose box meets `box` and does not begin behind its farthest depth; a caster may come twice (once for
 * each face of a six-face frame). Returns 0 when memory fails. */
int gnoi_tree_query(gno_context *context, const gnoi_tree *tree, const gnoi_lbox *box, gnoi_list *found);

/* Up to 8 points whose hull contains the polygon: its outer corners, or a rectangle in its plane. Returns their number. */
int gnoi_poly_hull(const gno_scene *scene, const gnoi_poly *poly, vec3 points[GNOI_FRAME_POINTS]);

#endif
