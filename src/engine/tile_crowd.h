/* tile_crowd.h -- where sample lines cross a polygon of very many edges.
 *
 * Place in the data flow: as gnoi_edges_cross (project/edge.h), with the same results. Edges are sorted by their upper ends; a sweep
 * down the lines keeps those at hand together, so that each is looked at on the lines it crosses alone. A line above the one before
 * begins another sweep.
 */
#ifndef GNOI_ENGINE_TILE_CROWD_H
#define GNOI_ENGINE_TILE_CROWD_H

#include "project/edge.h"

#include <stddef.h>

/* From so many edges on it pays. */
#define GNOI_CROWD 128

typedef struct gnoi_crowd {
    gnoi_edge *edges;         /* [0,done): ended above; [done,next): at hand; [next,count): begin below, by upper end */
    size_t done, next, count;
    double y;                 /* of the last line */
} gnoi_crowd;

/* Takes over the array, for lines from y0 to y1, both included. */
gnoi_crowd gnoi_crowd_make(gnoi_edge *edges, size_t count, double y0, double y1);

/* Crossings of a line in ascending order, into x (room for all edges); returns their number. */
unsigned gnoi_crowd_cross(gnoi_crowd *c, double y, double *x);

#endif
