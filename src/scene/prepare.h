/* prepare.h -- the steps of preparing a scene, in the order they run.
 *
 * Place in the data flow: gno_scene -> measure.c (which polygons have area and are planar; bounds) -> split.c (triangles of those that
 * are not planar) -> order.c (what is left, as it lies in space) -> weld.c (vertices at one place), emit.c (rings and corners in that
 * order) -> number.c (vertices, and normals of which few are used, numbered in the order of first use) -> emit.c (records: planes, triangulations) -> normals.c, average.c
 * (vertex normals of smooth polygons) -> details.c -> solid.c (connected parts, which of them are closed) -> cap.c (closes those that
 * stand open on a plane) -> gnoi_prepared.
 * Steps return a status, with a message only for limits; prepare.c writes the others.
 * Every step but the numbering and parts of the last ones runs in pieces on several threads; what comes out does not depend on how many.
 */
#ifndef GNOI_SCENE_PREPARE_H
#define GNOI_SCENE_PREPARE_H

#include "scene/scene.h"
#include "scene/triangles.h"

/* What becomes of a source polygon. */
typedef enum gnoi_kind {
    GNOI_EMPTY, /* no area */
    GNOI_KEPT,
    GNOI_SPLIT,
    GNOI_BENT /* off its plane by its own measure; the scene's scale decides. None is left after gnoi_measure_scene */
} gnoi_kind;

/* A byte for each source polygon: its kind, and what later steps would have to look up far away. */
#define GNOI_KIND_MASK 3u
#define GNOI_IS_TRIANGLE 4u  /* one ring of three corners */
#define GNOI_IS_SMOOTH 8u
#define GNOI_USES_NORMALS 16u /* smooth, and the object takes the file's normals where there are some */
#define GNOI_FOLLOWS 64u /* such a triangle whose corners name normals by the numbers of their vertices: none need be looked up */

typedef struct gnoi_measures {
    size_t empty, split; /* polygons of the kind */
    size_t using_normals; /* polygons that are not empty and GNOI_USES_NORMALS */
    int smooth;          /* some polygon that is not empty is smooth */
} gnoi_measures;

/* Source polygons in a run whose corners are found from one number: scenes of triangles spare two ways through memory. */
#define GNOI_BLOCK 64

/* Triangles of split polygons, as scene corners (indices into scene->corner_vertex and its like), by rising source. Those without
 * area come to no prepared polygon. */
typedef struct gnoi_splits {
    size_t count;
    uint32_t (*corner)[3];
    uint32_t *source;
    unsigned char *has_area;
} gnoi_splits;

/* GNOI_CHUNK ordered polygons: what comes before them. */
typedef struct gnoi_chunk {
    size_t ring, corner, triangle;
    int open;   /* some smooth corner has no normal from the file */
    int closes; /* all polygons are opaque, seen from both sides and without holes */
    int summed; /* all are triangles, and `sums` is theirs */
    gnoi_triangle_sums sums;
} gnoi_chunk;

/* A preparation at work. What steps leave for later ones is freed at its end. */
typedef struct gnoi_preparing {
    gno_scene *scene;
    gnoi_prepared *out; /* of the scene */
    int threads;
    unsigned char *kinds; /* of source polygons */
    uint32_t *blocks;     /* of GNOI_BLOCK source polygons: their first corner where all are triangles, else GNOI_NONE */
    gnoi_measures measures;
    gnoi_splits splits;
    uint32_t *order;      /* items: a source polygon, or polygon_count and the number of a split triangle more */
    size_t item_count;    /* = out->poly_count */
    int mapped;           /* a material asks for texture coordinates, and there are some */
    gnoi_chunk *chunks;   /* chunk_count + 1: the last holds the totals */
    size_t chunk_count;
    uint32_t *same;          /* of scene vertices: the first one at the place */
    uint32_t *vertex_number; /* of those: the prepared vertex, or GNOI_NONE where there is none */
    uint32_t *normal_source; /* of prepared normals: the scene's; NULL: they are numbered as the scene's are */
    size_t normal_source_count;
} gnoi_preparing;

/* measure.c: fills kinds (of source polygons), measures and, unless it is NULL, blocks; and the bounds and scale of the prepared scene. */
gno_status gnoi_measure_scene(gno_scene *scene, int threads, unsigned char *kinds, uint32_t *blocks, gnoi_measures *measures);
static inline size_t gnoi_block_count(const gno_scene *scene) { return (scene->polygon_count + GNOI_BLOCK - 1) / GNOI_BLOCK; }

/* Unit normal and offset of the plane of a triangle, and of one ring; 0 when it has no area. positions: of whatever `vertex` indexes.
 * gnoi_set_triangle: of a triangle that is known to have area. */
int gnoi_measure_triangle(const double (*positions)[3], const uint32_t vertex[3], gnoi_poly *poly);
int gnoi_measure_ring(const double (*positions)[3], const uint32_t *vertex, size_t count, gnoi_poly *poly);

static inline void gnoi_set_plane(gnoi_poly *poly, vec3 normal, double length, vec3 through)
{
    vec3 n = v3_scale(normal, 1 / length);
    poly->n[0] = n.x;
    poly->n[1] = n.y;
    poly->n[2] = n.z;
    poly->d = -v3_dot(n, through);
}

static inline void gnoi_set_triangle(const double (*positions)[3], const uint32_t vertex[3], gnoi_poly *poly)
{
    vec3 a = v3_from(positions[vertex[0]]), b = v3_from(positions[vertex[1]]), c = v3_from(positions[vertex[2]]);
    vec3 normal = v3_cross(v3_sub(b, a), v3_sub(c, a));
    gnoi_set_plane(poly, normal, v3_length(normal), v3_scale(v3_add(a, v3_add(b, c)), 1.0 / 3));
}

/* split.c */
gno_status gnoi_split_bent(gnoi_preparing *w);
void gnoi_splits_free(gno_context *context, gnoi_splits *splits);

/* order.c */
gno_status gnoi_order_items(gnoi_preparing *w);

/* emit.c: first ring_corner and the corner arrays, with the scene's vertices (the first of each place) and normals; once these are
 * numbered the records. */
gno_status gnoi_emit_corners(gnoi_preparing *w);
gno_status gnoi_emit_polygons(gnoi_preparing *w);

/* number.c: fills vertex_number, positions, chunk_vertex, chunk_corner, normal_source; corners name prepared vertices and normals. */
gno_status gnoi_number_corners(gnoi_preparing *w);

/* normals.c: fills normals and gives every corner of a smooth polygon one: the file's normals as unit vectors, averages (average.c),
 * and planes' normals where neither serves. */
gno_status gnoi_prepare_normals(gnoi_preparing *w);

/* details.c: finds the details among the prepared polygons and gives all details plane and priority. */
gno_status gnoi_prepare_details(gno_scene *scene);

/* solid.c: finds the connected parts and which are closed: fills solids and vertex_solid. */
gno_status gnoi_find_solids(gnoi_preparing *w);

/* Closes parts that one flat polygon on their outside can close, as a floor does a house: appends caps, sets `closed`, `outwards`
 * and `cap`. taken[i]: polygon i is of a part that is not closed, but opaque, seen from both sides and without holes; no detail. */
gno_status gnoi_cap_solids(gno_scene *scene, const unsigned char *taken);

/* 1 when the point is on the inner side of the plane of the part's cap. */
int gnoi_cap_inside(const gno_scene *scene, size_t solid, vec3 point);

static inline gnoi_kind gnoi_kind_of(const gnoi_preparing *w, size_t source) { return (gnoi_kind)(w->kinds[source] & GNOI_KIND_MASK); }

static inline int gnoi_is_smooth(const gnoi_poly *poly)
{
    return poly->shading == GNO_SHADING_GOURAUD || poly->shading == GNO_SHADING_PHONG;
}

/* Triangles that gnoi_triangulate makes of a polygon. */
static inline size_t gnoi_triangle_count(size_t corners, size_t rings) { return corners + 2 * (rings - 1) - 2; }
static inline size_t gnoi_triangles_of(const gnoi_poly *poly) { return gnoi_triangle_count(poly->corner_count, poly->ring_count); }

#endif
