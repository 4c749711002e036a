/* packet.h -- all polygons of a scene as one light sees them, eight to a packet, with a tree of boxes above the packets.
 *
 * Place in the data flow: prepared polygons -> boxes on the light's plane (frame.h) -> packets (this) -> columns of the shadow
 * matrix (sieve.h, matrix_search.c). Other than in tree.h every polygon is in it, as caster and as receiver, and packets are small in depth
 * too, so that a walk for receivers passes by what lies behind them. Prepared polygons already lie in rough spatial order: runs of GNOI_RUN
 * of them are halved at medians until eight are left, all within the cache (packet_split.c). Size classes and the faces of a cube frame
 * are kept apart: a large polygon would spoil the packets of small ones.
 * Invariants: packet i's boxes are node i of level 0; entries 8j..8j+7 of a level are the children of node j above; places without a
 * polygon hold GNOI_NONE and an empty box. The order depends on the scene and the light alone, not on the threads.
 */
#ifndef GNOI_SHADOW_PACKET_H
#define GNOI_SHADOW_PACKET_H

#include "scene/scene.h"
#include "shadow/eight.h"

#define GNOI_PACKET GNOI_EIGHT
#define GNOI_PACKET_LEVELS 12
#define GNOI_PACKET_CORNERS 6
#define GNOI_RUN 4096 /* a power of 8, so that each half is whole packets and whole nodes */

/* Corners in scene space relative to the packet's origin, so that one test runs over all eight: for each corner eight x, eight y, eight z.
 * Polygons with fewer corners than others of the packet have their last one several times. A polygon with more corners than there is
 * room for, or one that is not convex, stands with four points on its plane whose hull holds it. */
typedef struct gnoi_packet {
    double origin[3];
    float extent;         /* largest component of all corners, 0 for an empty packet */
    unsigned char casts;  /* bit k: lets less than all light through */
    unsigned char exact;  /* bit k: the points are the polygon's own corners */
    unsigned char own;    /* bit k: in its own shadow: a one on the diagonal */
    unsigned char search; /* bit k: casters are to be looked for */
    uint32_t corner_count; /* 3 .. GNOI_PACKET_CORNERS */
    const float *corner;  /* [corner_count][3][GNOI_PACKET], of the run's block */
    uint32_t poly[GNOI_PACKET], source[GNOI_PACKET];
} gnoi_packet;

/* Corners of the packets of a run; the first begins where eight numbers do not cross a line of the cache. */
typedef struct gnoi_packet_block {
    size_t count;
    float *corners;
} gnoi_packet_block;

typedef struct gnoi_packets {
    gnoi_frame frame;
    size_t packet_count;
    gnoi_packet *packets;
    size_t block_count;
    gnoi_packet_block *blocks;
    int all_convex; /* no polygon has to be taken apart */
    int levels; /* the last level is one node, level 0 never is; 0 without polygons */
    size_t level_first[GNOI_PACKET_LEVELS];
    size_t node_count;
    gnoi_eight *nodes;
} gnoi_packets;

/* Whether the polygon's diagonal is a one, and whether casters are to be looked for: see gnomon_matrix.h. */
enum { GNOI_OWN = 1, GNOI_SEARCH = 2 };

/* What a light's packets are made of. */
typedef struct gnoi_packet_source {
    const gno_scene *scene;
    gnoi_lamp lamp;
    unsigned char *outside; /* by solid: closed, and the light is outside */
} gnoi_packet_source;

int gnoi_judge_own_shadow(const gnoi_packet_source *source, const gnoi_poly *poly);

/* A polygon's box on its way into a packet. */
typedef struct gnoi_packet_entry {
    gnoi_lbox box;
    uint32_t poly;
    uint16_t bin; /* size class and face */
    unsigned char own; /* GNOI_OWN and GNOI_SEARCH */
    unsigned char exact; /* its points are its own corners */
} gnoi_packet_entry;

/* An order of at most GNOI_RUN entries in which each eight, each 64, ... of them lie together: order[i] is the number of the entry at place i.
 * parallel: the frame's. */
void gnoi_packet_split(const gnoi_packet_entry *entries, size_t count, int parallel, uint16_t *order);

/* Errors: MEMORY, CANCELLED; nothing is left to be freed then. */
gno_status gnoi_packets_build(const gnoi_packet_source *source, int threads, gnoi_packets *packets);
void gnoi_packets_free(gno_context *context, gnoi_packets *packets);

/* The growing array of a walk's findings: nodes of one level, numbered from the level's first. */
typedef struct gnoi_node_list {
    size_t count, capacity;
    uint32_t *items;
} gnoi_node_list;

/* Appends the nodes of a level that hold a box that may stand before `box`, a level >= 1. Returns 0 when memory fails. */
int gnoi_packets_find(gno_context *context, const gnoi_packets *packets, const gnoi_lbox *box, int level, gnoi_node_list *found);

/* Bytes held. */
size_t gnoi_packets_bytes(const gnoi_packets *packets);

/* packet_points.c: points on the polygon's plane whose hull contains it: its own corners where it is convex and has no more than there is room for (1 is
 * returned in *exact), a rectangle otherwise. Returns their number. */
int gnoi_poly_points(const gno_scene *scene, const gnoi_poly *poly, vec3 points[GNOI_PACKET_CORNERS], int *exact);
int gnoi_poly_points_again(const gno_scene *scene, const gnoi_poly *poly, int exact, vec3 points[GNOI_PACKET_CORNERS]); /* exact: as found */

/* A convex polygon of more corners is taken apart too. */
#define GNOI_FACET_CORNERS 16

/* Whether the polygon is one ring of at most GNOI_FACET_CORNERS corners that turns one way and around once. */
int gnoi_poly_is_convex(const gno_scene *scene, const gnoi_poly *poly);

#endif
