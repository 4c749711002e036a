/* weld.h -- the points at which an object's normals are to be averaged, told apart by position.
 *
 * Place in the data flow: normals.c makes one for each object whose normals are averaged.
 */
#ifndef GNOI_SCENE_WELD_H
#define GNOI_SCENE_WELD_H

#include "scene/scene.h"

/* Vertices of equal position share a class, a number in [0,count) given in the order of first use. Vertices at places where
 * every corner has a normal already have none. */
typedef struct gnoi_weld {
    uint32_t low;       /* first vertex of the object's range */
    size_t span;        /* vertices in the range */
    uint32_t *class_of; /* per vertex of the range, or GNOI_NONE, GNOI_WELD_NOWHERE */
    size_t table_size;  /* a power of two */
    uint32_t *table;    /* vertices by hash of position; GNOI_NONE: free */
    uint32_t count;
} gnoi_weld;

#define GNOI_WELD_NOWHERE 0xfffffffeu /* looked for and at no point with a class */

/* Welds the corners of smooth polygons among the prepared ones [first,last) at every place where one of them has no normal
 * yet (prepared.corner_normal is GNOI_NONE); there is at least one such corner. Returns 0 without memory; gnoi_weld_free is due all the same. */
int gnoi_weld_make(const gno_scene *scene, size_t first, size_t last, gnoi_weld *weld);
void gnoi_weld_free(gno_context *context, gnoi_weld *weld);

/* The class of a vertex that a smooth polygon uses; >= GNOI_WELD_NOWHERE: none. */
static inline uint32_t gnoi_weld_class(const gnoi_weld *weld, uint32_t vertex)
{
    return weld->class_of[vertex - weld->low];
}

#endif
