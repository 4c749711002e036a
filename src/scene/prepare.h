/* prepare.h -- the steps of preparing a scene, in the order they run.
 *
 * Place in the data flow: gno_scene -> measure.c (planes, what each polygon is) -> prepare.c (prepared polygons, rings,
 * corners, triangulations; corner_vertex still indexes the scene's positions) -> normals.c (vertex normals of smooth polygons)
 * -> order.c (polygons, vertices and normals numbered as they lie in space; corner_vertex indexes prepared.positions)
 * -> solid.c (connected parts, which of them are closed) -> cap.c (closes those that stand open on a plane) -> gnoi_prepared.
 */
#ifndef GNOI_SCENE_PREPARE_H
#define GNOI_SCENE_PREPARE_H

#include "scene/scene.h"

/* What becomes of a source polygon. */
typedef enum gnoi_kind {
    GNOI_KEPT,
    GNOI_BENT, /* off its plane by its own measure; the scene's scale decides. None is left after gnoi_measure_scene */
    GNOI_SPLIT,
    GNOI_EMPTY /* no area */
} gnoi_kind;

typedef struct gnoi_measures {
    size_t empty, split; /* polygons of the kind */
    size_t dropped;      /* holes of fewer than three corners */
    int smooth;          /* some polygon that is not empty is smooth */
} gnoi_measures;

/* Fills polys[p] and kinds[p] for every source polygon p as if all were kept with their own rings and corners
 * (fields ring and corner are the scene's offsets), and the bounds and scale of scene->prepared. */
gno_status gnoi_measure_scene(gno_scene *scene, int threads, gnoi_poly *polys, unsigned char *kinds, gnoi_measures *measures);

/* Plane of the triangle of three vertices; 0 when it has no area. */
int gnoi_measure_triangle(const double (*positions)[3], const uint32_t vertex[3], gnoi_poly *poly);

/* Turns prepared.corner_normal from indices into the scene's normals into indices into prepared.normals, made here:
 * the file's normals as unit vectors, averages, and planes' normals where neither serves. */
gno_status gnoi_prepare_normals(gno_scene *scene);

/* details.c: finds the details among the prepared polygons and gives all details plane and priority. */
gno_status gnoi_prepare_details(gno_scene *scene);

/* Renumbers everything in scene->prepared by place and fills prepared.positions. */
gno_status gnoi_order_polygons(gno_scene *scene);

/* Finds the connected parts and which are closed: fills prepared.solids and vertex_solid. vertex_number: the prepared vertex of each scene vertex. */
gno_status gnoi_find_solids(gno_scene *scene, const uint32_t *vertex_number);

/* Closes parts that one flat polygon on their outside can close, as a floor does a house: appends caps, sets `closed`, `outwards`
 * and `cap`. may_close[i]: part i is opaque, seen from both sides and without holes. */
gno_status gnoi_cap_solids(gno_scene *scene, const unsigned char *may_close);

/* 1 when the point is on the inner side of the plane of the part's cap. */
int gnoi_cap_inside(const gno_scene *scene, size_t solid, vec3 point);

static inline int gnoi_is_smooth(const gnoi_poly *poly)
{
    return poly->shading == GNO_SHADING_GOURAUD || poly->shading == GNO_SHADING_PHONG;
}

/* Triangles that gnoi_triangulate makes of a polygon. */
static inline size_t gnoi_triangles_of(const gnoi_poly *poly)
{
    return (size_t)poly->corner_count + 2 * ((size_t)poly->ring_count - 1) - 2;
}

#endif
