/* edge.h -- an edge of a polygon in the picture, as sample lines cross it.
 *
 * Place in the data flow: outlines of polygons (scan) and of shadow polygons (shadow) -> edges -> crossings of lines.
 * Invariants: an edge is kept from its upper end, whichever way its polygon runs along it, so that both polygons at it are
 * crossed at the very same places; a line y crosses it when y0 <= y < y1, so that lines through vertices count once.
 */
#ifndef GNOI_PROJECT_EDGE_H
#define GNOI_PROJECT_EDGE_H

typedef struct gnoi_edge {
    double x, y, y1, slope; /* upper end, lower end's y, dx/dy */
} gnoi_edge;

/* Sets the edge between two picture points; 0 for a level one, which no line crosses. */
static inline int gnoi_edge_set(gnoi_edge *e, double ax, double ay, double bx, double by)
{
    if (ay == by)
        return 0;
    if (ay < by) {
        e->x = ax;
        e->y = ay;
        e->y1 = by;
    } else {
        e->x = bx;
        e->y = by;
        e->y1 = ay;
    }
    e->slope = ay < by ? (bx - ax) / (by - ay) : (ax - bx) / (ay - by);
    return 1;
}

/* Where lines at y cross `count` edges, in ascending order, into x (room for count); returns how many do. */
static inline unsigned gnoi_edges_cross(const gnoi_edge *edges, unsigned count, double y, double *x)
{
    unsigned n = 0;
    for (unsigned i = 0; i < count; i++) {
        const gnoi_edge *e = &edges[i];
        double v;
        unsigned k;
        if (y < e->y || y >= e->y1)
            continue;
        v = e->x + (y - e->y) * e->slope;
        for (k = n++; k > 0 && x[k - 1] > v; k--)
            x[k] = x[k - 1];
        x[k] = v;
    }
    return n;
}

#endif
