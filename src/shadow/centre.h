/* centre.h -- a light or the eye as a projection centre, and how every polygon stands to it.
 *
 * Place in the data flow: lamp or view -> gnoi_centre (this: sides, heights, who hides what; caster tree) -> cover.h.
 * Of a closed convex part with the centre outside, the sides turned away are in the dark of those that face the centre, and what
 * any of its sides hides a facing one hides: the others need not be asked about and need not cast.
 */
#ifndef GNOI_SHADOW_CENTRE_H
#define GNOI_SHADOW_CENTRE_H

#include "project/view.h"
#include "shadow/tree.h"

typedef struct gnoi_stand {
    double height;    /* of the centre over the polygon's plane (centre at infinity: the cosine); 0: edge-on */
    double lift;      /* of the polygon's first corner over its plane, seen from the centre's side: rounding, or what planarity allows */
    double tolerance; /* distance from the plane within which things lie on it */
    signed char side; /* on which side of the plane the centre is: +1 its normal's, -1, 0: edge-on */
    unsigned char hides;  /* 0: casts nothing; 1: hides wholly; 2: lets a part of the light through */
    unsigned char hidden; /* wholly in the dark, known beforehand */
    unsigned char absent; /* from the eye: not drawn at all */
    unsigned char convex; /* one ring, convex */
} gnoi_stand;

typedef struct gnoi_centre {
    const gno_scene *scene;
    gnoi_lamp lamp;
    const gnoi_view *view; /* the eye's; NULL for a light */
    int has_start;         /* an eye at infinity: nothing at negative start hides */
    gnoi_form start;
    double noise;          /* heights smaller than this are rounding */
    gnoi_stand *stands;    /* one for each prepared polygon */
    gnoi_tree tree;
} gnoi_centre;

/* The scene must be prepared. view: NULL for a light. see_through: from the eye, transparent polygons hide nothing. */
gno_status gnoi_centre_make(const gno_scene *scene, const gnoi_lamp *lamp, const gnoi_view *view, int see_through, gnoi_centre *centre);
void gnoi_centre_free(gnoi_centre *centre);

/* The eye as a lamp. */
gnoi_lamp gnoi_lamp_of_view(const gnoi_view *view);

/* Height of p over polygon `index`'s plane, positive on the centre's side. */
static inline double gnoi_height_over(const gnoi_centre *centre, uint32_t index, vec3 p)
{
    const gnoi_poly *poly = &centre->scene->prepared.polys[index];
    const gnoi_stand *s = &centre->stands[index];
    return (double)s->side * v3_dot(v3_from(poly->n), v3_sub(p, gnoi_corner_at(centre->scene, poly->corner))) + s->lift;
}

/* 1 when the two polygons lie on each other's plane where it matters: they never shade each other. The same for (a,b) and (b,a). */
int gnoi_coplanar(const gnoi_centre *centre, uint32_t a, uint32_t b);

/* 1 when, of two polygons lying on each other, a is in front: the higher priority, then the lower number in the scene. */
int gnoi_in_front(const gno_scene *scene, uint32_t a, uint32_t b);

#endif
