/* gnomon.h -- polygon scenes with exact hidden surfaces and exact shadows.
 *
 * The engine's whole public interface; it needs libc and libm alone. Compiles as C89 to C17 and C++98 to C++17.
 *
 * Conventions
 * - Coordinates are right-handed, in any one unit; colours are linear RGB triples, each component >= 0.
 * - Pixel (0,0) is the top left one; a picture row runs left to right; pixel centres lie at +0.5.
 * - A call that can fail returns a gno_status. The message behind a failure stays in the context
 *   (gno_context_message) until the next failure. On failure output pointers are set to NULL or left untouched.
 * - `_def` structures are filled by their gno_..._default function and then changed by the caller.
 * - A context, and the scenes made from it, belong to one thread at a time; two contexts are independent.
 *   The library keeps no global state, prints nothing, and never ends the process.
 */
#ifndef GNOMON_GNOMON_H
#define GNOMON_GNOMON_H

#include <gnomon/gnomon_math.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__) && __GNUC__ >= 4
#define GNO_API __attribute__((visibility("default")))
#else
#define GNO_API
#endif

#define GNO_VERSION_MAJOR 0
#define GNO_VERSION_MINOR 1
#define GNO_VERSION_PATCH 0

/* The library's version as "major.minor.patch"; constant storage. */
GNO_API const char *gno_version(void);

/* ---- status ------------------------------------------------------------------------------------------------- */

typedef enum gno_status {
    GNO_OK = 0,
    GNO_ERROR_MEMORY,    /* the allocator returned NULL, or max_memory would be exceeded */
    GNO_ERROR_ARGUMENT,  /* a NULL, an index or a value that the call does not accept */
    GNO_ERROR_LIMIT,     /* a count or size beyond the stated limits */
    GNO_ERROR_INPUT,     /* a file or scene that is not well formed; the message names file, line and key */
    GNO_ERROR_FILE,      /* a file that cannot be opened, read or written */
    GNO_ERROR_CANCELLED  /* the progress callback asked to stop */
} gno_status;

/* A short constant English text for a status. */
GNO_API const char *gno_status_text(gno_status status);

/* ---- limits -------------------------------------------------------------------------------------------------- */

#define GNO_MAX_IMAGE_SIDE 65536        /* pixels, each way */
#define GNO_MAX_LIGHTS 4096             /* after area lights are split into points */
#define GNO_MAX_POLYGONS 268435456      /* 2^28, and as many vertices */
#define GNO_MAX_CORNERS 1073741824      /* 2^30 polygon corners in all */
#define GNO_MAX_LINES 256               /* sample lines per pixel row */
#define GNO_MAX_COORDINATE 1e15         /* absolute value of any coordinate after transforms */
#define GNO_MAX_THREADS 256

/* ---- context ------------------------------------------------------------------------------------------------- */

typedef struct gno_context gno_context;

/* Allocates (block NULL), resizes, or frees (new_size 0, result ignored); old_size is always exact.
 * Returned blocks are aligned as malloc's are. Called from several threads at once during a render: must be thread safe. */
typedef void *(*gno_alloc_fn)(void *user, void *block, size_t old_size, size_t new_size);

typedef enum gno_log_level { GNO_LOG_INFO = 0, GNO_LOG_WARNING = 1 } gno_log_level;

/* Receives remarks that are not failures (skipped polygons and the like). Silent when NULL. */
typedef void (*gno_log_fn)(void *user, gno_log_level level, const char *text);

/* Called every 10 milliseconds or so while a long call runs, fraction of the stage in [0,1]; non-zero stops the call with
 * GNO_ERROR_CANCELLED. Always called from the thread that made the call. stage is constant text of the library, or what a companion
 * passed to gno_context_progress. It must not call back into the context. */
typedef int (*gno_progress_fn)(void *user, const char *stage, double fraction);

typedef struct gno_context_def {
    gno_alloc_fn alloc; /* NULL: malloc, realloc, free */
    void *alloc_user;
    gno_log_fn log; /* NULL: silent */
    void *log_user;
    gno_progress_fn progress; /* NULL: none */
    void *progress_user;
    size_t max_memory; /* bytes that the context may hold, by its account; 0 (default): no ceiling */
} gno_context_def;

GNO_API gno_context_def gno_context_def_default(void);

/* def may be NULL for the defaults. Errors: MEMORY, ARGUMENT. */
GNO_API gno_status gno_context_create(const gno_context_def *def, gno_context **context);

/* Destroys a context; every scene made from it must be gone. NULL is accepted. */
GNO_API void gno_context_destroy(gno_context *context);

/* The last failure's message ("" before any), valid until the next failure in this context. */
GNO_API const char *gno_context_message(const gno_context *context);

/* Bytes that the context holds now, and the most it has held, by exact account of its allocator. */
GNO_API size_t gno_context_memory(const gno_context *context, size_t *peak);

/* Sends one remark to the context's log; for the file library and other companions of the engine. */
GNO_API void gno_context_log(gno_context *context, gno_log_level level, const char *text);

/* Sets the context's message and returns status unchanged; for the file library and other companions of the engine. */
GNO_API gno_status gno_context_fail(gno_context *context, gno_status status, const char *text);

/* Asks the progress callback whether to go on, unless it was asked just now: GNO_OK or CANCELLED (message set). stage is constant
 * text, which is kept. On the thread that made the call; for companions of the engine that take long. Errors: CANCELLED. */
GNO_API gno_status gno_context_progress(gno_context *context, const char *stage, double fraction);

/* Memory from the context's allocator (see gno_alloc_fn); NULL when it fails. For companions of the engine. */
GNO_API void *gno_context_realloc(gno_context *context, void *block, size_t old_size, size_t new_size);

/* ---- scene --------------------------------------------------------------------------------------------------- */

typedef struct gno_scene gno_scene;

/* flat: the plane's normal, lighting taken at every point; constant: one intensity a polygon, lighting taken at its
 * centroid (8.2); gouraud: intensities interpolated from the vertices (8.2.1); phong: normals interpolated (8.2.4). */
typedef enum gno_shading {
    GNO_SHADING_FLAT = 0,
    GNO_SHADING_CONSTANT = 1,
    GNO_SHADING_GOURAUD = 2,
    GNO_SHADING_PHONG = 3
} gno_shading;

typedef enum gno_texture_kind {
    GNO_TEXTURE_NONE = 0,
    GNO_TEXTURE_IMAGE = 1,
    GNO_TEXTURE_PROCEDURAL = 2 /* a function of the point in the coordinates of the mesh before its transform */
} gno_texture_kind;

/* How a point of a surface finds its place (S, T) on the pattern. Points are those of the mesh before its transform, so that
 * a pattern moves, turns and grows with its object. Polygons without texture coordinates take `planar` along the two
 * axes that their normal lies farthest from. */
typedef enum gno_texture_map {
    GNO_MAP_UV = 0,         /* the mesh's texture coordinates */
    GNO_MAP_PLANAR = 1,     /* P = origin + S u + T v, whatever lies along u x v: a parallel projection */
    GNO_MAP_CYLINDRICAL = 2, /* about the axis v through the origin: S the angle in degrees, from u towards v x u; T v the height */
    GNO_MAP_SPHERICAL = 3   /* S as for a cylinder, T the angle in degrees from the axis v, 0 to 180 (8.5) */
} gno_texture_map;

/* What stands beside the pattern. */
typedef enum gno_wrap {
    GNO_WRAP_REPEAT = 0,
    GNO_WRAP_CLAMP = 1,  /* its border goes on */
    GNO_WRAP_MIRROR = 2, /* it repeats, every other time mirrored */
    GNO_WRAP_NONE = 3    /* nothing: the material's plain colour */
} gno_wrap;

typedef enum gno_texture_filter {
    GNO_FILTER_BOX = 0,   /* elements are squares of one colour, weighted by the share of each in the pixel */
    GNO_FILTER_LINEAR = 1 /* enlarged elements blend into each other */
} gno_texture_filter;

/* A pattern that multiplies ambient and diffuse coefficients (`t` of 8.1.7). Linear in (S, T): the pattern's lower left corner
 * lies at corners[0], its upper right one at corners[1]; then one pattern is made `scale` times as large. Where all of corners
 * is zero the map's own hold: (0,0) and (1,1), for a cylinder (0,0) and (360,1), for a sphere (0,180) and (360,0). */
typedef struct gno_texture {
    gno_texture_kind kind;
    int image;             /* of gno_scene_add_image; its alpha makes holes in the surface */
    gno_texture_map map;
    double origin[3];      /* default 0 */
    double u[3], v[3];     /* default x and y; not parallel. cylindrical, spherical: u x and v z; only u's part across v counts */
    double corners[2][2];
    double scale[2];       /* default 1, not 0; negative turns the pattern round */
    gno_wrap wrap;
    gno_texture_filter filter;
    gno_procedural procedural; /* of kind procedural, which reads nothing else here: it has a frame of its own */
} gno_texture;

/* kind none, map as given; the other fields as that map's defaults; procedural: wood. */
GNO_API gno_texture gno_texture_default(gno_texture_map map);

typedef enum gno_bump_kind {
    GNO_BUMP_NONE = 0,
    GNO_BUMP_HEIGHT = 1, /* the mean of red, green and blue is a height over the surface (8.6.7) */
    GNO_BUMP_NORMAL = 2  /* red, green, blue in [0,1] are twice a normal's parts along S, along T and outwards, plus one */
} gno_bump_kind;

/* Turns the normal before lighting; edges and shadows stay as they are. Taken at every sample of flat and phong surfaces. */
typedef struct gno_bump {
    gno_bump_kind kind;
    gno_texture texture; /* an image of linear values, or procedural; where it lies */
    double amount;       /* height: how far white stands over black, as a share of the pattern's size, so that the look does not
                            depend on the object's. normal: factor on the parts along the surface. Default 1 */
} gno_bump;

/* Coefficients of the simple lighting model (8.1.7), three channels each, >= 0. */
typedef struct gno_material {
    double ambient[3];      /* ka; default 0.8 */
    double diffuse[3];      /* kd; default 0.8 */
    double specular[3];     /* ks; default 0 */
    double shininess;       /* n, >= 0; default 1 */
    double transmission[3]; /* share of light passed to what lies behind, in [0,1]; default 0 (opaque) */
    gno_shading shading;    /* default flat */
    int two_sided;          /* default 1; 0: not drawn from behind, but casts shadows both ways */
    gno_texture texture;    /* default none */
    gno_bump bump;          /* default none */
} gno_material;

GNO_API gno_material gno_material_default(void);

typedef enum gno_light_type {
    GNO_LIGHT_POINT = 0,
    GNO_LIGHT_DIRECTIONAL = 1,
    GNO_LIGHT_SPOT = 2,
    GNO_LIGHT_AREA = 3 /* a parallelogram of samples x samples point lights sharing the intensity */
} gno_light_type;

typedef enum gno_falloff { GNO_FALLOFF_NONE = 0, GNO_FALLOFF_LINEAR = 1, GNO_FALLOFF_INVERSE_SQUARE = 2 } gno_falloff;

typedef struct gno_light {
    gno_light_type type;
    double position[3];  /* point, spot; area: the parallelogram's corner */
    double direction[3]; /* directional, spot: the way light travels; need not be unit */
    double edge1[3];     /* area */
    double edge2[3];
    double angle;        /* spot: full cone, degrees, in (0,180); hard edge; default 45 */
    double intensity[3]; /* Il; default 1 */
    gno_falloff falloff; /* default none */
    double falloff_k;    /* K of 1/(d+K); default 1 */
    int distance_from_viewer; /* linear falloff: 1 (default) d from the viewer, 0 from the light */
    int samples;         /* area: points each way, >= 1; default 4 */
    double softness;     /* D of shadows that weaken with the distance d of their caster, in scene units: a caster that passes t
                            leaves 1 - (1 - t) / (1 + d/D) of the light; 0 (default): no weakening */
} gno_light;

/* A white point light at the origin without falloff. */
GNO_API gno_light gno_light_default(void);

typedef enum gno_camera_type { GNO_CAMERA_PERSPECTIVE = 0, GNO_CAMERA_ORTHOGRAPHIC = 1 } gno_camera_type;

typedef struct gno_camera {
    gno_camera_type type;
    double eye[3];
    double target[3];
    double up[3];
    double fov;    /* perspective: vertical, degrees, in (0,180); default 40 */
    double height; /* orthographic: vertical extent of the picture in scene units; default 1 */
} gno_camera;

typedef struct gno_image_def {
    int width;            /* default 1280 */
    int height;           /* default 720 */
    double background[3]; /* default 0 */
} gno_image_def;

typedef enum gno_weighting { GNO_WEIGHTING_AREA = 0, GNO_WEIGHTING_ANGLE = 1, GNO_WEIGHTING_EQUAL = 2 } gno_weighting;

/* Polygons in flat arrays; all are read during the call and copied. A polygon is one outer ring followed by any
 * number of hole rings, in any winding; ring r has corners ring_start[r] .. ring_start[r+1]-1, polygon p has rings
 * polygon_start[p] .. polygon_start[p+1]-1. Corner arrays hold indices into the vertex, normal and texcoord arrays. */
typedef struct gno_mesh_def {
    const char *name; /* may be NULL */
    size_t vertex_count;
    const double *positions; /* 3 per vertex */
    size_t normal_count;
    const double *normals; /* 3 per normal, need not be unit; NULL: none */
    size_t texcoord_count;
    const double *texcoords; /* 2 per texcoord; NULL: none */
    size_t polygon_count;
    const unsigned *polygon_start; /* polygon_count+1 ring offsets; NULL: polygon p is ring p */
    size_t ring_count;             /* polygon_count when polygon_start is NULL */
    const unsigned *ring_start;    /* ring_count+1 corner offsets; NULL: all rings are triangles */
    size_t corner_count;
    const int *corner_vertex;   /* 0-based */
    const int *corner_normal;   /* 0-based, -1: none; NULL: none anywhere */
    const int *corner_texcoord; /* as corner_normal */
    const int *polygon_material; /* material index per polygon; NULL: material for all */
    int material;                /* index from gno_scene_add_material; default 0, the scene's default material */
    int shading;                 /* a gno_shading for all polygons, or -1 (default): as their materials say */
    int average_normals;         /* 1: ignore the given normals and average; 0 (default): average only where none are given */
    double crease;               /* degrees; polygons that meet at more are averaged apart; default 180 (never) */
    gno_weighting weighting;
    double transform[12]; /* rows of a 3x4 matrix applied to positions; normals take the inverse transpose; default identity */
    int priority;         /* among coplanar polygons the higher is in front; default 0 */
    int detail_of;        /* number of a polygon already in the scene on which these polygons lie as details (windows, lettering):
                             they take its plane, are in front of it (priority at least one above its own), receive shadows and
                             cast none. -1 (default): none. Details may have details */
    int find_details;     /* 1: polygons of this mesh that lie wholly inside another, larger polygon of a mesh with find_details, in
                             its plane and facing the same way, become its details; 0 (default): they do not */
} gno_mesh_def;

GNO_API gno_mesh_def gno_mesh_def_default(void);

/* An empty scene: one default material (index 0), no light, default camera and picture. Errors: MEMORY, ARGUMENT. */
GNO_API gno_status gno_scene_create(gno_context *context, gno_scene **scene);
GNO_API void gno_scene_destroy(gno_scene *scene); /* accepts NULL */
GNO_API gno_context *gno_scene_context(const gno_scene *scene);

/* A picture for textures, top row first. Exactly one of `linear` and `bytes` is given. */
typedef struct gno_pixels {
    int width, height;          /* 1 to GNO_MAX_IMAGE_SIDE */
    int channels;               /* 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha (0 a hole, 1 solid; not multiplied in) */
    const float *linear;        /* channels values a pixel, finite */
    const unsigned char *bytes; /* the same in 8 bits */
    int encoded;                /* bytes: 1 sRGB (alpha is linear always), 0 linear, as heights and normals are */
} gno_pixels;

/* Copies a picture into the scene, with its prefiltered levels. Index may be NULL. Errors: MEMORY, ARGUMENT, LIMIT. */
GNO_API gno_status gno_scene_add_image(gno_scene *scene, const gno_pixels *pixels, int *index);

/* Index may be NULL. Errors: MEMORY, ARGUMENT (values not finite or out of range), LIMIT. */
GNO_API gno_status gno_scene_add_material(gno_scene *scene, const gno_material *material, int *index);
GNO_API gno_status gno_scene_add_light(gno_scene *scene, const char *name, const gno_light *light, int *index);

/* Names a material for people's eyes: reports and drawings carry it. Copied; NULL takes it away. Errors: MEMORY, ARGUMENT. */
GNO_API gno_status gno_scene_set_material_name(gno_scene *scene, int index, const char *name);

/* Adds polygons; their numbers run on from *first_polygon (may be NULL). Corner indices, offsets and coordinates are
 * checked here; planarity and area when the scene is prepared. Errors: MEMORY, ARGUMENT, LIMIT; the scene is unchanged then. */
GNO_API gno_status gno_scene_add_mesh(gno_scene *scene, const gno_mesh_def *mesh, size_t *first_polygon);

/* Fractal ground: a polygon whose centre and edge middles are moved along its normal by random heights, each of the quadrilaterals so
 * made again, and so on (8.5). Edges decide by themselves whether and how they are divided: there are no cracks where levels differ,
 * nor between terrains of one plane, seed, height, roughness and viewer that share an edge. */
typedef struct gno_terrain {
    size_t corner_count; /* 3 to 65536 */
    const double *corners; /* 3 each: a convex polygon, counterclockwise seen from above */
    double height;       /* largest displacement of the first division, >= 0; default 1 */
    double roughness;    /* largest displacement of each division over that of the one before, in (0,1]; default 0.5 */
    int levels;          /* divisions at most, 0 to 14; default 6 */
    int least_levels;    /* divisions everywhere, however far; default 2 */
    double detail;       /* 0 (default): all levels everywhere. Else an edge is divided while it is longer than this times its distance
                            from the viewer */
    double viewer[3];    /* scene space */
    unsigned seed;       /* default 0 */
} gno_terrain;

GNO_API gno_terrain gno_terrain_default(void);

/* Adds a terrain as triangles, with texture coordinates from (0,0) to (1,1) over the polygon's extent, its first side along (1,0).
 * look: name, material, shading, averaging, transform and priority as of a mesh, its arrays unread; NULL: the defaults. The same
 * definition gives the same triangles on every machine. Errors: MEMORY, ARGUMENT, LIMIT (2^25 triangles), CANCELLED; the scene is
 * unchanged then. */
GNO_API gno_status gno_scene_add_terrain(gno_scene *scene, const gno_terrain *terrain, const gno_mesh_def *look, size_t *first_polygon);

/* Makes all polygons of an object (a mesh, numbered as added) details of a polygon, which may have been added later; polygon -1:
 * of none. Errors: ARGUMENT (no such object or polygon; a corner off the polygon's plane by more than 1e-4 of its extent; a detail of
 * itself). */
GNO_API gno_status gno_scene_set_detail_of(gno_scene *scene, size_t object, int polygon);

/* Sets find_details of every mesh in the scene. Errors: ARGUMENT. */
GNO_API gno_status gno_scene_find_details(gno_scene *scene, int find);

GNO_API gno_status gno_scene_set_camera(gno_scene *scene, const gno_camera *camera);
GNO_API gno_camera gno_scene_camera(const gno_scene *scene);
GNO_API gno_status gno_scene_set_image(gno_scene *scene, const gno_image_def *image);
GNO_API gno_image_def gno_scene_image(const gno_scene *scene);
GNO_API gno_status gno_scene_set_ambient(gno_scene *scene, const double ambient[3]);
GNO_API void gno_scene_ambient(const gno_scene *scene, double ambient[3]);

/* Perspective, eye (3,-6,2), target (0,0,1), up z, fov 40. */
GNO_API gno_camera gno_camera_default(void);
GNO_API gno_image_def gno_image_def_default(void);

/* ---- reading a scene back -------------------------------------------------------------------------------------- */

typedef struct gno_scene_counts {
    size_t vertices, polygons, rings, corners, normals, texcoords, materials, lights, objects, images;
} gno_scene_counts;

GNO_API gno_scene_counts gno_scene_count(const gno_scene *scene);

/* Axis-aligned bounds of all polygon corners; returns 0 and zeros for a scene without polygons. */
GNO_API int gno_scene_bounds(const gno_scene *scene, double lower[3], double upper[3]);
GNO_API gno_status gno_scene_material(const gno_scene *scene, int index, gno_material *material);
GNO_API gno_status gno_scene_light(const gno_scene *scene, int index, gno_light *light, const char **name);

/* Names as they were given, "" where none was or the index is out of range; valid until the scene changes. An object is what one
 * gno_scene_add_mesh added, numbered from 0. */
GNO_API const char *gno_scene_material_name(const gno_scene *scene, int index);
GNO_API const char *gno_scene_object_name(const gno_scene *scene, int index);

/* One polygon's view into the scene's arrays, valid until the scene changes. */
typedef struct gno_polygon {
    size_t ring_count;
    const unsigned *ring_start; /* ring_count+1 offsets into the corner arrays below */
    const int *corner_vertex;   /* indices into positions */
    const int *corner_normal;   /* indices into normals, -1: none */
    const int *corner_texcoord;
    const double *positions; /* 3 per vertex, scene space */
    const double *normals;
    const double *texcoords;
    int material;
    int object;   /* number of the mesh it came from */
    int shading;  /* a gno_shading, the mesh's or the material's */
    int priority;
    int detail_of; /* as its mesh was given it, -1: none */
} gno_polygon;

GNO_API gno_status gno_scene_polygon(const gno_scene *scene, size_t index, gno_polygon *polygon);

/* What preparing the scene found wrong; counts of source polygons. */
typedef struct gno_scene_problems {
    size_t degenerate; /* no area: skipped */
    size_t non_planar; /* split into triangles */
    size_t details;    /* found to be details of others (find_details): not a problem, but a change */
} gno_scene_problems;

/* Prepares the scene if need be (planes, triangulations, vertex normals); rendering does it by itself. */
GNO_API gno_status gno_scene_prepare(gno_scene *scene, int threads, gno_scene_problems *problems);

/* ---- rendering ------------------------------------------------------------------------------------------------ */

typedef enum gno_terminator {
    GNO_TERMINATOR_EXACT = 0, /* shadows as the flat facets cast them */
    GNO_TERMINATOR_SMOOTH = 1 /* phong-shaded polygons fade before the facets show: Chiang, Li and Burley 2019, see docs/algorithm.md */
} gno_terminator;

/* What is seen in each pixel as pairs of a number and the share of the pixel that it covers, the largest share first, of
 * equal ones the lower number. The background takes part under GNO_BACKGROUND. So the shares of a pixel add up to 1, but for
 * rounding, if no more than `count` numbers are seen there. Pairs left over are GNO_BACKGROUND with share 0. */
#define GNO_BACKGROUND 0xffffffffu
#define GNO_MAX_RANKS 256

typedef struct gno_ranks {
    int count;       /* pairs in each pixel, from 1 to GNO_MAX_RANKS */
    unsigned *id;    /* height x width x count; NULL: not wanted */
    float *coverage; /* the same shape */
} gno_ranks;

/* Layers beside the picture: what is seen, instead of its colour. The caller owns the buffers (height rows of width pixels, top
 * row first); NULL is not wanted. Depth, normal and uv belong to one surface a pixel, the one that covers the most of it (of equal
 * ones the nearest), at the middle of its seen part: a mean over several surfaces would be on none of them. */
typedef struct gno_layers {
    float *depth;    /* 1 a pixel: distance from the eye along the view direction; infinite where nothing is seen */
    float *normal;   /* 3: unit, scene space, on the viewer's side; interpolated where shading is; 0 where nothing is seen */
    float *uv;       /* 2: the mesh's texture coordinates; 0 where it has none or nothing is seen */
    float *coverage; /* 1: share of the pixel that surfaces cover, in [0,1] */
    float *shadow;   /* light count planes of height x width: the share of light j's rays, mean of the channels, that reaches what is seen
                        in the pixel; polygons facing away from a light are in their own shadow; 1 where nothing is seen */
    gno_ranks polygons;  /* numbers of gno_scene_polygon */
    gno_ranks objects;   /* numbers of the meshes they came from */
    gno_ranks materials; /* indices of their materials */
} gno_layers;

/* No layer wanted. */
GNO_API gno_layers gno_layers_default(void);
/* scanline: exact spans on sample lines, the fastest; weiler_atherton: visible pieces as polygons (gnomon_pieces.h), painted with exact
 * area coverage and shaded alike. `lines`, `base_lines` and `refine_above` concern the first alone; a scene whose shadows weaken with
 * distance (softness) or fall through holes of textures has sample lines in either case, and a warning says so. */
typedef enum gno_engine { GNO_ENGINE_SCANLINE = 0, GNO_ENGINE_WEILER_ATHERTON = 1 } gno_engine;

typedef struct gno_render_def {
    int lines;      /* sample lines per pixel row at the finest; default 18 */
    int base_lines; /* sample lines everywhere; default 2. Equal to lines: no refinement. Else lines must be an odd multiple of
                       base_lines, base_lines at most 4, and pixels whose colour bends from line to line get more, or all, of the lines */
    double refine_above; /* bend (second difference, linear colour) that calls for more lines; three times as much calls for all; default 0.025 */
    int threads;    /* 0 (default): one per processor */
    gno_terminator terminator;
    const gno_layers *layers; /* filled beside the picture; NULL (default): none */
    gno_engine engine; /* default scanline */
} gno_render_def;

GNO_API gno_render_def gno_render_def_default(void);

/* Seconds are wall-clock. Counts are exact and do not depend on the number of threads. */
typedef struct gno_stats {
    double prepare_seconds; /* planes, triangulations, normals */
    double shadow_seconds;  /* per light: projection and tree of casters; 0 when kept from an earlier view */
    double project_seconds; /* eye: projection, clipping, binning into tiles */
    double scan_seconds;    /* visible spans, splitting, shading */
    double total_seconds;
    double polygons;        /* prepared polygons */
    double lights;          /* after splitting area lights */
    double shadows_built;   /* of these, those whose casters were found in this call; 0 when kept from an earlier view */
    double tiles;
    double spans;           /* visible spans found */
    double columns;         /* (receiver, light) columns asked for, per tile */
    double ones;            /* casters in those columns */
    double columns_full;    /* columns that one caster covers wholly */
    double shaded;          /* evaluations of the lighting model */
    double refined_pixels;
    size_t peak_memory;     /* bytes, by account of the context's allocator */
} gno_stats;

/* Renders the scene's camera view into rgb: height rows of width linear RGB triples, top row first (size from
 * gno_scene_image). The same scene gives the same bytes for any number of threads. stats may be NULL.
 * Errors: MEMORY, ARGUMENT, CANCELLED; rgb is then partly written. */
GNO_API gno_status gno_render(gno_scene *scene, const gno_render_def *def, float *rgb, gno_stats *stats);

/* Receives row y of the picture, `width` linear RGB triples, valid during the call; non-zero stops the render with CANCELLED. */
typedef int (*gno_row_fn)(void *user, int y, const float *rgb);

/* As gno_render, byte for byte, but hands the picture out row by row, top to bottom, on the caller's thread, and holds memory for a
 * band of rows only (the scan-line engine; layers, if asked for, are whole). Errors: as gno_render. */
GNO_API gno_status gno_render_rows(gno_scene *scene, const gno_render_def *def, gno_row_fn row, void *user, gno_stats *stats);

/* ---- splitting one span by shadow polygons ---------------------------------------------------------------------- */

/* Where one shadow polygon of the column meets the span's line: [x0,x1), and the share of light that passes the caster. */
typedef struct gno_shadow_interval {
    double x0, x1;
    double transmission[3];
} gno_shadow_interval;

/* A part of a span over which the same casters lie: [x0,x1), and the product of their transmissions (1,1,1: lit). */
typedef struct gno_span_part {
    double x0, x1;
    double light[3];
} gno_span_part;

/* Splits the span [x0,x1) by the four rules of the shadow pass (docs/algorithm.md): no shadow polygon, or none that
 * meets the span: one lit part; wholly covered: one shaded part; partly covered: cut where shadow polygons begin and
 * end, until every part is wholly covered or free. Neighbouring parts differ in light; parts are in order, leave no gap
 * and have x0 < x1; casters that touch let nothing through between them. Intervals with x1 <= x0 count for nothing.
 * `shadows` is sorted by x0 in place. parts needs room for 2 count + 1. Returns the number of parts: 0 for an
 * empty span (x1 <= x0). No allocation, no failure; values must not be NaN. */
GNO_API size_t gno_span_split(double x0, double x1, gno_shadow_interval *shadows, size_t count, gno_span_part *parts);

/* ---- fractal dimension -------------------------------------------------------------------------------------------- */

/* H = log G / log A of a set of points (3 coordinates each), by counting boxes: the boxes that hold points grow G times in number when
 * they are made A times smaller. Boxes are cubes, the first the set's largest extent wide, each next level `magnification` A >= 2
 * times smaller, down to `levels` in [1, 52 / log2 A]; H is the slope of the straight line through (log A^k, log boxes at level k), k from
 * first_level in [0, levels) to levels. The first levels count the boxes of a set's outline, those where the points are sparser than the boxes the points: choose the
 * levels between. A set without extent has dimension 0. Errors: MEMORY, ARGUMENT (NULL, no points, coordinates
 * that are not finite, levels out of range). */
GNO_API gno_status gno_fractal_dimension(gno_context *context, size_t count, const double *points, int magnification, int first_level,
                                         int levels, double *dimension);

/* ---- visible spans of the picture's sample lines ------------------------------------------------------------------ */

/* One visible span: where the line sees one polygon. Depth is along the view direction; its inverse (for an orthographic view depth
 * itself) is linear in x between the ends. The parts of light j, by which shadow polygons split the span, are
 * parts[part_start[j]] .. parts[part_start[j+1]-1]: in order, without gaps, the first begins at x0, the last ends at x1. */
typedef struct gno_span {
    unsigned polygon;         /* number in the scene */
    int back;                 /* 1: its back is seen, in the winding of its outer ring */
    double x0, x1;            /* picture coordinates, x0 < x1 */
    double depth0, depth1;
    double tint[3];           /* share of its colour that reaches the eye: 1 where no see-through surface lies before it */
    const size_t *part_start; /* light_count+1 offsets */
    const gno_span_part *parts;
} gno_span;

/* A sample line of the picture: y is its height in picture coordinates, in pixel row `row`; of the row's lines it is the
 * `line`th from the top. light_count: as gno_stats.lights; an area light counts as its points, one after the other. */
typedef struct gno_span_line {
    int row, line;
    double y;
    int light_count;
    size_t span_count;
    const gno_span *spans;
} gno_span_line;

/* All is valid during the call; non-zero stops with CANCELLED. */
typedef int (*gno_spans_fn)(void *user, const gno_span_line *line);

/* Hands out the visible spans of every sample line, from the top down, on the caller's thread: def->base_lines lines in each
 * pixel row (the other fields but threads are not used). Spans are in the order of x0; they overlap only where surfaces let light
 * through, front before back there. What is not covered by a span is background. A light's softness is not applied: parts are
 * cut where shadows begin and end. The same for any number of threads. Errors: as gno_render. */
GNO_API gno_status gno_render_spans(gno_scene *scene, const gno_render_def *def, gno_spans_fn spans, void *user, gno_stats *stats);

#ifdef __cplusplus
}
#endif

#endif
