/* clip3.c -- see clip3.h. */
#include "project/clip3.h"

/* Always from the end kept to the end cut off: the same two points in the same order, whichever way the edge runs. */
static gnoi_hpoint cut_edge(const gnoi_hpoint *kept, const gnoi_hpoint *lost)
{
    gnoi_hpoint p;
    double t = kept->side / (kept->side - lost->side);
    p.x = kept->x + t * (lost->x - kept->x);
    p.y = kept->y + t * (lost->y - kept->y);
    p.w = kept->w + t * (lost->w - kept->w);
    p.side = 0;
    return p;
}

size_t gnoi_clip_ring(const gnoi_hpoint *in, size_t count, gnoi_hpoint *out)
{
    size_t n = 0;
    for (size_t i = 0; i < count; i++) {
        const gnoi_hpoint *a = &in[i], *b = &in[i + 1 < count ? i + 1 : 0];
        if (a->side >= 0)
            out[n++] = *a;
        if (a->side > 0 && b->side < 0)
            out[n++] = cut_edge(a, b);
        else if (a->side < 0 && b->side > 0)
            out[n++] = cut_edge(b, a);
    }
    return n;
}
