/* tree.h -- a packed tree of the casters' boxes on one light's plane: the sparse rows of the shadow matrix.
 *
 * Place in the data flow: prepared polygons -> boxes on the light's plane (frame.h) -> this tree -> candidate casters of
 * a receiver (column.h). Built without comparing pairs: boxes are sorted by size class and Hilbert number and packed eight
 * to a node, level by level (after Kamel and Faloutsos, "On packing R-trees", 1993; the size classes keep large polygons from
 * spoiling the nodes of small ones). Beside each lowest node lie its triangles' corners, so that most candidates are ruled
 * out without touching the scene.
 * Invariants: children of node j of a level are entries 8j..8j+7 of the level below; a node's box holds its children's; slots
 * without a child hold an empty box that nothing meets.
 */
#ifndef GNOI_SHADOW_TREE_H
#define GNOI_SHADOW_TREE_H

#include "scene/scene.h"
#include "shadow/eight.h"

#define GNOI_TREE_FAN GNOI_EIGHT
#define GNOI_TREE_LEVELS 12

/* The corners of a lowest node's triangles, relative to an origin near them for the sake of precision. Children that are no
 * triangle on one face have a NaN: every comparison fails, nothing is ruled out. */
typedef struct gnoi_tree_leaf {
    gnoi_lpoint origin;
    float u[3][GNOI_TREE_FAN], v[3][GNOI_TREE_FAN], q[3][GNOI_TREE_FAN];
} gnoi_tree_leaf;

/* What is known of a receiver on the light's plane. A candidate is ruled out when all its corners lie outside one of the edges
 * (a u + b v + c <= slack, positive inside) or none is nearer to the light than the receiver's plane. */
#define GNOI_PROBE_EDGES 4
typedef struct gnoi_probe {
    int edge_count;
    double a[GNOI_PROBE_EDGES], b[GNOI_PROBE_EDGES], c[GNOI_PROBE_EDGES], slack[GNOI_PROBE_EDGES];
    double qa, qb, qc; /* nearness of the receiver's plane, plus half its tolerance */
    double lift;       /* that half tolerance, as nearness */
} gnoi_probe;

typedef struct gnoi_tree {
    gnoi_frame frame;
    size_t entry_count;
    uint32_t *caster;  /* what each entry is: a prepared polygon, or a contour's edge; in packed order */
    int levels;        /* level 0 holds the entries' boxes; the last level is one node */
    size_t level_first[GNOI_TREE_LEVELS];
    size_t node_count;
    gnoi_eight *nodes;
    gnoi_tree_leaf *leaves; /* one for each node of level 0; NULL in a tree of edges */
} gnoi_tree;

/* A growing list of boxes, each with the number of what it holds; one thing may have several boxes (one for each face). */
typedef struct gnoi_boxes {
    gno_context *context;
    size_t count, box_capacity, number_capacity;
    gnoi_lbox *box;
    uint32_t *number;
} gnoi_boxes;

int gnoi_boxes_reserve(gnoi_boxes *boxes, size_t more); /* 0 when memory fails */
void gnoi_boxes_free(gnoi_boxes *boxes);

/* Packs boxes into a tree whose frame the caller has set. Leaves without corners unless `scene` is given, whose prepared polygons
 * the numbers then are. */
gno_status gnoi_tree_pack(gno_context *context, const gnoi_boxes *boxes, const gno_scene *scene, gnoi_tree *tree);

/* Of which polygons a tree is built. `halved` (one for each solid, or NULL) tells of which solids the polygons facing one way are
 * enough: where eye and lamp are both outside a closed solid, every path from the lamp to a point in sight crosses as many
 * of its polygons outwards as inwards, so the far sides cast the whole shadow. */
typedef enum gnoi_tree_part {
    GNOI_TREE_ALL,    /* every caster but the near sides of halved solids */
    GNOI_TREE_SINGLE, /* casters that belong to no halved solid */
    GNOI_TREE_FAR,    /* far sides of halved solids */
    GNOI_TREE_SEEN    /* every polygon, as an eye asks: details hide what bears them, though they cast no shadow */
} gnoi_tree_part;

/* Builds the tree of the polygons that let less than all light through. */
gno_status gnoi_tree_build_part(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, gnoi_tree_part part,
                                gnoi_tree *tree);
void gnoi_tree_free(gno_context *context, gnoi_tree *tree);

/* 1 for a far side, -1 for a near side of a halved solid, 0 for any other polygon. */
int gnoi_halved_side(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, const gnoi_poly *poly);

/* A growing list of polygon numbers. */
typedef struct gnoi_list {
    size_t count, capacity;
    uint32_t *items;
} gnoi_list;

/* Nodes of one level that hold every caster whose box may meet a given box: where queries for receivers near each other begin. */
typedef struct gnoi_tree_front {
    int level;
    gnoi_list nodes;
} gnoi_tree_front;

/* Sets the front of everything that meets `box`. Returns 0 when memory fails. */
int gnoi_tree_gather(gno_context *context, const gnoi_tree *tree, const gnoi_lbox *box, gnoi_tree_front *front);

/* Appends every caster whose box meets `box`, does not begin behind its farthest depth and is not ruled out by the probe (NULL:
 * none); boxes on several faces of a six-face frame may each find the same caster. front: one gathered for a box that holds this
 * one, or NULL. Returns 0 when memory fails. */
int gnoi_tree_query(gno_context *context, const gnoi_tree *tree, const gnoi_tree_front *front, const gnoi_lbox *box,
                    const gnoi_probe *probe, gnoi_list *found);

/* The same, but casters whose box ends before the nearest depth of `box` are not listed: *before tells whether there are any. */
int gnoi_tree_query_level(gno_context *context, const gnoi_tree *tree, const gnoi_tree_front *front, const gnoi_lbox *box,
                          const gnoi_probe *probe, gnoi_list *found, int *before);

/* Up to 8 points whose hull contains the polygon: its outer corners, or a rectangle in its plane. Returns their number. */
int gnoi_poly_hull(const gno_scene *scene, const gnoi_poly *poly, vec3 points[GNOI_FRAME_POINTS]);

#endif
