/* tree.h -- a packed tree of the casters' boxes on one light's plane: the sparse rows of the shadow matrix.
 *
 * Place in the data flow: prepared polygons -> boxes on the light's plane (frame.h) -> this tree -> candidate casters of
 * a group of receivers (gather.h). Built without comparing pairs: boxes are sorted by size class and cell along a Hilbert curve and packed eight
 * to a node, level by level (after Kamel and Faloutsos, "On packing R-trees", 1993; the size classes keep large polygons from
 * spoiling the nodes of small ones). Beside each lowest node its triangles' corners may lie, so that most candidates are ruled
 * out without touching the scene.
 * Invariants: children of node j of a level are entries 8j..8j+7 of the level below; a node's box holds its children's; slots
 * without a child hold an empty box that nothing meets.
 */
#ifndef GNOI_SHADOW_TREE_H
#define GNOI_SHADOW_TREE_H

#include "shadow/leaf.h"
#include "shadow/located.h"

#define GNOI_TREE_FAN GNOI_EIGHT
#define GNOI_TREE_LEVELS 12

typedef struct gnoi_tree {
    gnoi_frame frame;
    size_t entry_count;
    uint32_t *caster;  /* what each entry is: a prepared polygon, or a contour's edge; in packed order */
    int levels;        /* level 0 holds the entries' boxes; the last level is one node */
    size_t level_first[GNOI_TREE_LEVELS];
    size_t node_count;
    gnoi_eight *nodes;
    gnoi_leaf *leaves; /* one for each node of level 0, or NULL */
} gnoi_tree;

/* A growing list of boxes, each with the number of what it holds; one thing may have several boxes (one for each face). */
typedef struct gnoi_boxes {
    gno_context *context;
    size_t count, box_capacity, number_capacity;
    gnoi_lbox *box;
    uint32_t *number;
    gnoi_lbox whole; /* u and v of all of them */
} gnoi_boxes;

gnoi_boxes gnoi_boxes_make(gno_context *context);

/* Takes in the `n` boxes that lie behind the last one, where there is room for them; all are of `number`. */
static inline void gnoi_boxes_take(gnoi_boxes *b, size_t n, uint32_t number)
{
    for (; n > 0; n--) {
        const gnoi_lbox *box = &b->box[b->count];
        b->whole.u0 = box->u0 < b->whole.u0 ? box->u0 : b->whole.u0;
        b->whole.u1 = box->u1 > b->whole.u1 ? box->u1 : b->whole.u1;
        b->whole.v0 = box->v0 < b->whole.v0 ? box->v0 : b->whole.v0;
        b->whole.v1 = box->v1 > b->whole.v1 ? box->v1 : b->whole.v1;
        b->number[b->count++] = number;
    }
}

int gnoi_boxes_reserve(gnoi_boxes *boxes, size_t more); /* 0 when memory fails */
void gnoi_boxes_free(gnoi_boxes *boxes);

/* Packs boxes into a tree whose frame the caller has set. No leaves unless `scene` is given, whose prepared polygons the numbers
 * then are. */
gno_status gnoi_tree_pack(gno_context *context, const gnoi_boxes *boxes, const gno_scene *scene, gnoi_tree *tree);

typedef enum gnoi_tree_part {
    GNOI_TREE_ALL, /* every caster: what lets less than all light through */
    GNOI_TREE_SEEN /* every polygon, as an eye asks: details hide what bears them, though they cast no shadow */
} gnoi_tree_part;

/* With leaves. */
gno_status gnoi_tree_build_part(const gno_scene *scene, const gnoi_lamp *lamp, gnoi_tree_part part, gnoi_tree *tree);

/* What becomes of a polygon in the casters' trees. */
typedef enum gnoi_caster_side {
    GNOI_CASTS_NOT, /* lets all light through */
    GNOI_CASTS_FAR, /* = 1, as gnoi_boundary_find wants: a far side of a halved solid */
    GNOI_CASTS,     /* belongs to no halved solid */
    GNOI_CASTS_NEAR /* a near side of a halved solid: nothing */
} gnoi_caster_side;

/* Builds two trees of casters: the far sides of halved solids, without leaves, and whatever belongs to no halved solid. `halved` (one
 * for each solid, or NULL: none is) tells of which solids the polygons facing one way are enough: where eye and lamp are both
 * outside a closed solid, every path from the lamp to a point in sight crosses as many of its polygons outwards as inwards, so the
 * far sides cast the whole shadow. located: the scene's vertices on the trees' frame, which the caller has set in both, all else of them
 * zero. The trees are to be freed in any case. Left behind: sides, a gnoi_caster_side for each polygon and each cap;
 * near_by, 1 for each vertex of a near side. */
gno_status gnoi_tree_build_casters(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved,
                                   const gnoi_located *located, unsigned char *sides, unsigned char *near_by, gnoi_tree *single,
                                   gnoi_tree *far);
void gnoi_tree_free(gno_context *context, gnoi_tree *tree);

/* A growing list of polygon numbers. */
typedef struct gnoi_list {
    size_t count, capacity;
    uint32_t *items;
} gnoi_list;

/* Appends every caster whose box meets `box`, does not begin behind its farthest depth and is not ruled out by the probe (NULL:
 * none; a tree without leaves takes no notice of it); boxes on several faces of a six-face frame may each find the same caster.
 * Returns 0 when memory fails. */
int gnoi_tree_query(gno_context *context, const gnoi_tree *tree, const gnoi_lbox *box, const gnoi_probe *probe, gnoi_list *found);

/* Visits every lowest node that holds entries whose boxes meet `box` and do not begin behind its farthest depth: bit k of mask is entry
 * GNOI_TREE_FAN node + k. A visit that returns 0 is the last; then so does the walk. */
typedef int (*gnoi_visit_fn)(void *user, uint32_t node, unsigned mask);
int gnoi_tree_walk(const gnoi_tree *tree, const gnoi_lbox *box, gnoi_visit_fn visit, void *user);

/* The rectangle around a polygon's outer corners in its plane, whose sides run along the unit vector e1 and across it. */
void gnoi_poly_rectangle(const gnoi_prepared *prep, const gnoi_poly *poly, vec3 e1, vec3 points[4]);

/* Up to 8 points whose hull contains the polygon: its outer corners, or a rectangle in its plane. Returns their number. */
int gnoi_poly_hull(const gno_scene *scene, const gnoi_poly *poly, vec3 points[GNOI_FRAME_POINTS]);

#endif
