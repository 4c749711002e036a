/* packet.h -- all polygons of a scene as one light sees them, eight to a packet, with a tree of boxes above the packets.
 *
 * Place in the data flow: prepared polygons -> boxes on the light's plane (frame.h) -> packets (this) -> columns of the shadow
 * matrix (matrix_search.c). Other than in tree.h every polygon is in it, as caster and as receiver, and packets are small in depth
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
#define GNOI_PACKET_CORNERS 4
#define GNOI_RUN 4096 /* a power of 8, so that each half is whole packets and whole nodes */

/* Corners in scene space relative to the packet's origin, component by component, so that one test runs over all eight. A polygon
 * with more corners than there is room for stands with four points on its plane whose hull holds it. */
typedef struct gnoi_packet {
    double origin[3];
    float extent;         /* largest component of all corners, 0 for an empty packet */
    unsigned char casts;  /* bit k: lets less than all light through */
    unsigned char exact;  /* bit k: the points are the polygon's own corners */
    uint32_t poly[GNOI_PACKET];
    float x[GNOI_PACKET_CORNERS][GNOI_PACKET], y[GNOI_PACKET_CORNERS][GNOI_PACKET], z[GNOI_PACKET_CORNERS][GNOI_PACKET];
} gnoi_packet;

typedef struct gnoi_packets {
    gnoi_frame frame;
    size_t packet_count;
    gnoi_packet *packets;
    int levels; /* the last level is one node; 0 without polygons */
    size_t level_first[GNOI_PACKET_LEVELS];
    size_t node_count;
    gnoi_eight *nodes;
} gnoi_packets;

/* A polygon's box on its way into a packet. */
typedef struct gnoi_packet_entry {
    gnoi_lbox box;
    uint32_t poly, bin; /* bin: size class and face */
} gnoi_packet_entry;

/* Orders at most GNOI_RUN entries so that each eight, each 64, ... of them lie together. parallel: the frame's. */
void gnoi_packet_split(gnoi_packet_entry *entries, size_t count, int parallel);

/* Errors: MEMORY, CANCELLED; nothing is left to be freed then. */
gno_status gnoi_packets_build(const gno_scene *scene, const gnoi_lamp *lamp, int threads, gnoi_packets *packets);
void gnoi_packets_free(gno_context *context, gnoi_packets *packets);

/* Appends the packets that hold a box that may stand before `box`: numbers of packets, ascending within a node. Returns 0 when memory
 * fails. The list is a growing array of the context's. */
typedef struct gnoi_packet_list {
    size_t count, capacity;
    uint32_t *items;
} gnoi_packet_list;

int gnoi_packets_find(gno_context *context, const gnoi_packets *packets, const gnoi_lbox *box, gnoi_packet_list *found);

/* Up to four points on the polygon's plane whose hull contains it: its own corners where it has no more (1 is returned in *exact), a
 * rectangle otherwise. Returns their number. */
int gnoi_poly_points(const gno_scene *scene, const gnoi_poly *poly, vec3 points[GNOI_PACKET_CORNERS], int *exact);

#endif
