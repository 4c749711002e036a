/* scene.h -- the scene's storage: flat arrays as the caller gave them, and the prepared polygons made from them.
 *
 * Place in the data flow: gno_scene_add_* -> gno_scene (this) -> gnoi_scene_prepare -> prepared polygons -> shadow, scan.
 * Invariants: every index in the corner arrays is in range; all numbers are finite; ring offsets never decrease;
 * `prepared` is valid exactly while prepared.valid is set, which every change of geometry or materials clears.
 */
#ifndef GNOI_SCENE_SCENE_H
#define GNOI_SCENE_SCENE_H

#include "base/context.h"
#include "base/vec.h"
#include "scene/image.h"

typedef struct gnoi_object {
    char *name; /* gnoi_malloc of name_size bytes, or NULL */
    size_t name_size;
    size_t first_polygon, polygon_count;
    int shading; /* a gno_shading or -1 */
    int average_normals;
    double crease;
    gno_weighting weighting;
    int priority;
    int detail_of; /* polygon number or -1 */
    int find_details;
    double to_local[12]; /* rows of a 3x4 matrix from scene space to that before the transform; zeros where there is none */
} gnoi_object;

typedef struct gnoi_named_light {
    gno_light light;
    char *name; /* gnoi_malloc of name_size bytes; never NULL */
    size_t name_size;
} gnoi_named_light;

typedef struct gnoi_name_text {
    char *text; /* gnoi_malloc of size bytes, or NULL */
    size_t size;
} gnoi_name_text;

/* A polygon ready for the passes: planar, with area. Two cache lines hold three; keep it at 64 bytes. */
typedef struct gnoi_poly {
    double n[3], d;        /* unit normal and offset: n.x + d = 0; n follows the winding of the outer ring */
    uint32_t ring;         /* first of its rings in prepared.ring_corner */
    uint32_t corner;       /* = prepared.ring_corner[ring] */
    uint32_t corner_count; /* of all its rings */
    uint32_t triangle;     /* first of its corner_count + 2 (ring_count - 1) - 2 triangles in prepared.triangles,
                              GNOI_NONE where no triangulation is kept (three corners, or neither smooth nor mapped) */
    uint32_t source;       /* polygon number in the scene */
    uint32_t ring_count : 24;
    uint32_t shading : 4; /* gno_shading */
    uint32_t two_sided : 1;
    uint32_t detail : 1; /* lies on another polygon, whose plane it has: receives shadows and casts none */
    uint32_t opaque : 1; /* transmission is zero in all channels, and the texture has no holes */
    uint16_t material;
    int16_t priority;
} gnoi_poly;

#define GNOI_NONE 0xffffffffu
#define GNOI_CHUNK 8192 /* polygons a piece of work: some 0.3 ms */

/* What is known of polygons that hang together by their vertices. `closed`: they are opaque, seen from both sides, without holes, and every edge is passed as often one way
 * as the other, so that a path that begins and ends outside crosses as many polygons inwards as outwards. */
typedef struct gnoi_solid {
    int closed;
    uint32_t cap; /* the prepared polygon that closes it; GNOI_NONE: none is needed */
    int outwards; /* normals point outwards on the whole (signed volume) */
    float lower[3], upper[3]; /* bounds, rounded outwards */
} gnoi_solid;

typedef struct gnoi_prepared {
    int valid;
    size_t poly_count, poly_capacity;
    gnoi_poly *polys;
    size_t cap_count; /* caps, behind the polygons in the same array: they close open solids for the shadow passes, and are
                         neither drawn nor receivers */
    size_t ring_count, ring_capacity;
    uint32_t *ring_corner; /* ring_count+1 offsets into corner arrays; ring_capacity counts its elements */
    size_t corner_count, corner_capacity;
    uint32_t *corner_vertex;    /* index into positions; has room for corner_vertex_capacity corners, those of caps too */
    size_t corner_vertex_capacity;
    size_t vertex_count, vertex_capacity;
    double (*positions)[3];     /* the scene's, those that corners use, each once, in the order of first use */
    size_t chunk_count;         /* runs of GNOI_CHUNK polygons; chunk_count + 1 elements of the following */
    uint32_t *chunk_corner;     /* first corner of each whose polygons are all triangles, else GNOI_NONE */
    unsigned char *chunk_opaque; /* whether all polygons of each are opaque */
    uint32_t *chunk_vertex;     /* vertices before each: numbers from chunk_vertex[k] to chunk_vertex[k + 1] are first used in chunk k */
    size_t seam_count, seam_capacity;
    uint32_t *seams;            /* polygons that share a vertex with one of an earlier chunk, by rising number */
    size_t joint_count, joint_capacity;
    uint32_t *joints;           /* vertices of polygons without area, which close seams between others; some more than once */
    size_t solid_count;
    gnoi_solid *solids;         /* connected parts */
    uint32_t *vertex_solid;     /* the part that a vertex belongs to */
    uint32_t *corner_normal;    /* index into normals, GNOI_NONE where the polygon is not smooth (NULL: no smooth polygon at all) */
    uint32_t *corner_texcoord;  /* index into the scene's texcoords, GNOI_NONE for none (NULL: no material asks for them) */
    size_t normal_count, normal_capacity;
    float (*normals)[3];        /* unit */
    size_t triangle_count, triangle_capacity;
    uint32_t (*triangles)[3];   /* indices into corner arrays */
    double lower[3], upper[3];  /* bounds of all prepared polygons' corners (zeros without any) */
    double scale;               /* largest absolute coordinate or extent, the unit of relative tolerances; 1 without polygons */
    gno_scene_problems problems;
} gnoi_prepared;

typedef struct gnoi_shadow_cache gnoi_shadow_cache; /* owned by shadow/; freed through the function below */

struct gno_scene {
    gno_context *context;
    size_t vertex_count, vertex_capacity;
    double (*positions)[3];
    size_t normal_count, normal_capacity;
    double (*normals)[3];
    size_t texcoord_count, texcoord_capacity;
    double (*texcoords)[2];
    size_t polygon_count, polygon_capacity; /* elements used and held of polygon_start are one more */
    unsigned *polygon_start;
    int *polygon_material;
    int *polygon_object;
    size_t ring_count, ring_capacity;
    unsigned *ring_start;
    size_t corner_count, corner_capacity;
    int *corner_vertex, *corner_normal, *corner_texcoord;
    size_t object_count, object_capacity;
    gnoi_object *objects;
    size_t material_count, material_capacity;
    gno_material *materials;
    size_t material_name_count; /* at most material_count: the rest have none */
    gnoi_name_text *material_names;
    size_t image_count, image_capacity;
    gnoi_image *images;
    size_t light_count, light_capacity;
    gnoi_named_light *lights;
    gno_camera camera;
    struct gno_camera_path *path; /* NULL: none */
    struct gno_camera_key *path_keys; /* of the path; owned */
    gno_image_def image;
    double ambient[3];
    unsigned long changes; /* how often gnoi_scene_changed was called */
    gnoi_prepared prepared;
    gnoi_shadow_cache *shadows; /* kept from view to view; NULL until a view needs it */
    unsigned long shadow_builds; /* how often `shadows` was filled */
    void (*free_shadows)(gno_context *context, gnoi_shadow_cache *shadows); /* set by whoever fills `shadows` */
};

/* Makes scene->prepared valid: planes, splitting of polygons that are not planar, triangulations of smooth n-gons, normals.
 * Warns once with counts of degenerate and non-planar polygons. */
gno_status gnoi_scene_prepare(gno_scene *scene, int threads);

/* details.c: GNO_ERROR_ARGUMENT unless `count` polygons from `first` on (of the arrays, which may reach beyond the counts) lie in the plane of
 * polygon `parent`. label: what a message calls them. */
gno_status gnoi_check_detail(gno_scene *scene, const char *label, size_t first, size_t count, int parent);

/* 1 when the material's texture or bump lies on texture coordinates. */
static inline int gnoi_is_mapped(const gno_material *m)
{
    return (m->texture.kind == GNO_TEXTURE_IMAGE && m->texture.map == GNO_MAP_UV) ||
           (m->bump.kind != GNO_BUMP_NONE && m->bump.texture.kind == GNO_TEXTURE_IMAGE && m->bump.texture.map == GNO_MAP_UV);
}

/* 1 when the material's texture has holes. */
static inline int gnoi_has_holes(const gno_scene *scene, const gno_material *m)
{
    return m->texture.kind == GNO_TEXTURE_IMAGE && scene->images[m->texture.image].has_alpha;
}

/* Distance from a prepared polygon's plane within which things lie on it. positions: what corner_vertex indexes, prep's own once
 * the polygons are in order, the scene's before. */
double gnoi_plane_tolerance(const gnoi_prepared *prep, const double (*positions)[3], const gnoi_poly *poly);

/* The vertices of a prepared polygon's corners; those of triangles are found without fetching their records. Not for caps. */
static inline const uint32_t *gnoi_corners_of(const gnoi_prepared *prep, size_t i, uint32_t *count)
{
    const uint32_t first = prep->chunk_corner[i / GNOI_CHUNK];
    *count = first != GNOI_NONE ? 3 : prep->polys[i].corner_count;
    return prep->corner_vertex + (first != GNOI_NONE ? first + 3 * (i % GNOI_CHUNK) : prep->polys[i].corner);
}

/* The connected part that a prepared polygon belongs to. */
static inline uint32_t gnoi_solid_of(const gnoi_prepared *prep, const gnoi_poly *poly)
{
    return prep->vertex_solid[prep->corner_vertex[poly->corner]];
}

/* 1 when `point` is certainly outside a closed part: the signed crossings of a path from far away sum to zero; and, where a cap
 * closes it, on the cap's inner side. */
int gnoi_solid_outside(const gno_scene *scene, size_t solid, vec3 point);

/* names.c */
void gnoi_scene_free_names(gno_scene *scene);

/* Takes the camera's path away. */
void gnoi_scene_drop_path(gno_scene *scene);

/* Drops what was derived from geometry, materials or lights; every change of them calls it. */
void gnoi_scene_changed(gno_scene *scene);
void gnoi_prepared_free(gno_context *context, gnoi_prepared *prepared);

/* Triangulates a planar polygon with holes by ear clipping (holes joined to the outer ring by bridges), in the plane
 * coordinate pair `axis_u`, `axis_v` of its dominant projection. Works on corner indices of prepared.ring_corner's rings; writes
 * corner_count + 2 (ring_count - 1) - 2 triples to `triangles` (degenerate ones where the polygon is not simple). */
gno_status gnoi_triangulate(gno_context *context, const double (*positions)[3], const uint32_t *corner_vertex,
                            const uint32_t *ring_corner, uint32_t ring_count, const double normal[3],
                            uint32_t (*triangles)[3]);

/* Place of a prepared corner. */
static inline vec3 gnoi_corner_at(const gno_scene *scene, uint32_t corner)
{
    return v3_from(scene->prepared.positions[scene->prepared.corner_vertex[corner]]);
}

#endif
