/* gnomon_io.h -- files for gnomon: scenes and meshes in, pictures and drawings out. Library libgnomon-io.
 *
 * Needs libyaml, assimp, libpng, libdeflate, OpenEXRCore and cairo. Compiles as C89 to C17 and C++98 to C++17.
 * All messages are kept in the context, as gnomon.h says: "FILE:LINE: key: what is wrong".
 */
#ifndef GNOMON_GNOMON_IO_H
#define GNOMON_GNOMON_IO_H

#include <gnomon/gnomon.h>
#include <gnomon/gnomon_matrix.h>
#include <gnomon/gnomon_pieces.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One `--set KEY=VALUE` override: key is a dotted path with indices (camera.eye, lights[0].intensity), value is YAML. */
typedef struct gno_setting {
    const char *key;
    const char *value;
} gno_setting;

/* Reads a scene file (*.yaml, *.yml; docs/scene-format.md) or a mesh file alone (.obj .ply .stl .gltf .glb), which is
 * shown from a default three-quarter view with a default light and a ground unless the file has its own camera and lights.
 * Settings override values of the scene file, or, for a mesh file, camera, image, ambient and lights (see docs).
 * Errors: MEMORY, FILE, INPUT, LIMIT. *scene is NULL then. */
GNO_API gno_status gno_scene_load(gno_context *context, const char *path, const gno_setting *settings, size_t setting_count,
                                  gno_scene **scene);

/* Picture formats. The path "-" is standard output; otherwise the file appears whole or not at all (written beside and
 * renamed). rgb holds height rows of width linear RGB triples, top row first. */
typedef enum gno_pixel_depth { GNO_DEPTH_DEFAULT = 0, GNO_DEPTH_8 = 8, GNO_DEPTH_16 = 16, GNO_DEPTH_32 = 32 } gno_pixel_depth;

typedef enum gno_picture_format { GNO_FORMAT_AUTO = 0, GNO_FORMAT_PNG, GNO_FORMAT_EXR, GNO_FORMAT_PFM } gno_picture_format;

typedef struct gno_picture_def {
    gno_picture_format format; /* AUTO: by the path's extension; "-" is then PNG */
    gno_pixel_depth depth;     /* PNG: 8 (default) or 16 bit sRGB; EXR: 16 half (default) or 32 float; PFM: 32 */
    double exposure;           /* factor on all values; default 1 */
} gno_picture_def;

GNO_API gno_picture_def gno_picture_def_default(void);

/* Errors: MEMORY, ARGUMENT (unknown extension, size), FILE. */
GNO_API gno_status gno_picture_write(gno_context *context, const char *path, const gno_picture_def *def, int width, int height,
                                     const float *rgb);

/* Writes an .exr file with the layers of a rendered scene beside the picture: the channels depth.Z, normal.X .Y .Z, uv.U .V,
 * coverage.A, shadow.LIGHT for each light, polygon.id, and ranked pairs as Cryptomatte files of the sets CryptoPolygon,
 * CryptoObject, CryptoMaterial (docs/layers.md). scene is the one rendered, unchanged; NULL buffers of `layers` are left out.
 * Layers are 32 bits whatever the depth, and without exposure. Errors: as gno_picture_write; ARGUMENT (not an .exr). */
GNO_API gno_status gno_picture_write_layers(const gno_scene *scene, const char *path, const gno_picture_def *def, const float *rgb,
                                            const gno_layers *layers);

/* Shadow matrices (gnomon_matrix.h). Matrix Market (.mtx, text): coordinate, pattern, general, polygons counted from 1, columns in
 * order. CSV: a line "caster,receiver", then a line for each one, polygons counted from 0. PNG: a picture, rows (casters) downwards,
 * columns to the right, own shadow red; large matrices are gathered into cells, darker where there are more ones. */
typedef enum gno_matrix_format { GNO_MATRIX_AUTO = 0, GNO_MATRIX_MTX, GNO_MATRIX_CSV, GNO_MATRIX_PNG } gno_matrix_format;

#define GNO_MATRIX_MAX_SPY 4096

typedef struct gno_matrix_file_def {
    gno_matrix_format format; /* AUTO: by the path's extension; "-" (standard output) is then MTX */
    const char *note;         /* MTX: one more comment line; NULL: none */
    int spy_side;             /* PNG: largest side in pixels, 1 .. GNO_MATRIX_MAX_SPY; default 1024 */
} gno_matrix_file_def;

GNO_API gno_matrix_file_def gno_matrix_file_def_default(void);

/* The file appears whole or not at all. def may be NULL. Errors: MEMORY, ARGUMENT (unknown extension), FILE. */
GNO_API gno_status gno_matrix_save(gno_matrix *matrix, const char *path, const gno_matrix_file_def *def);

/* Reads a Matrix Market file: coordinate, pattern, general, square; entries in any order. What it does not hold is not known of
 * the columns afterwards (which were covered, which polygons have no area). Errors: MEMORY, FILE, INPUT, LIMIT; messages name file and line. */
GNO_API gno_status gno_matrix_load(gno_context *context, const char *path, gno_matrix **matrix);
/* What gno_lit_pieces gave for one expanded light. */
typedef struct gno_lit_result {
    size_t light;             /* its number */
    const gno_lit_row *rows;  /* one a polygon of the scene; for the table */
    const gno_pieces *pieces; /* for the pieces file */
} gno_lit_result;

/* Writes a CSV table (RFC 4180, one header line), light after light, one line a polygon: polygon, object, light, sample (which point of
 * an area light, else 0), side, area, lit_area, lit_fraction, dimmed_area, centroid_x, centroid_y, centroid_z (empty where nothing
 * is lit). Path as for pictures. Errors: MEMORY, ARGUMENT, FILE. */
GNO_API gno_status gno_lit_table_write(const gno_scene *scene, const char *path, const gno_lit_result *results, size_t count);

/* Writes the pieces of all results, by the path's extension: .obj (one object a polygon and light; pieces with holes are cut into
 * faces without) or .geojson, .json (a FeatureCollection of Polygons, three coordinates, with the properties polygon, object, light,
 * sample, side, area, passed). Errors: MEMORY, ARGUMENT (unknown extension), FILE. */
GNO_API gno_status gno_pieces_write(const gno_scene *scene, const char *path, const gno_lit_result *results, size_t count);

/* ---- drawings --------------------------------------------------------------------------------------------------------- */

typedef enum gno_vector_format { GNO_VECTOR_AUTO = 0, GNO_VECTOR_SVG, GNO_VECTOR_PDF } gno_vector_format;

/* Lines on a drawing; each includes those before it. An edge is drawn where it is visible. */
typedef enum gno_vector_edges {
    GNO_EDGES_NONE = 0,
    GNO_EDGES_SILHOUETTE, /* edges of one polygon alone, and between one that faces the eye and one that does not */
    GNO_EDGES_VISIBLE,    /* edges at which planes meet at more than the crease angle */
    GNO_EDGES_ALL         /* outlines of all pieces: shadows, and where polygons cross or hide each other */
} gno_vector_edges;

typedef struct gno_vector_def {
    gno_vector_format format;  /* AUTO (default): by the path's extension, .svg or .pdf; "-" needs one given */
    gno_vector_edges edges;    /* default none */
    double edge_width;         /* pixels of the picture, > 0; default 1 */
    double edge_colour[3];     /* linear RGB; default 0 */
    double crease;             /* degrees, in [0,180]; default 1 */
    int background;            /* 1 (default): the picture's background fills what no polygon covers; 0: nothing there */
    int underlay;              /* 1 (default): shapes are drawn once more beneath, with a rim, so that no viewer shows seams */
    int digits;                /* of picture coordinates after the point, 0 to 9; default 4 */
    double exposure;           /* factor on all colours; default 1 */
    int threads;               /* as in gno_render_def; the file is the same */
    const char *title;         /* UTF-8; NULL (default): none */
} gno_vector_def;

GNO_API gno_vector_def gno_vector_def_default(void);

/* Draws what the camera sees as shapes: one for each polygon seen and each set of lights that reaches parts of it, filled with its
 * mean colour (docs/api.md, "Drawings"). def may be NULL. The file appears whole or not at all; path "-" is standard output.
 * Errors: MEMORY, ARGUMENT, LIMIT, FILE, CANCELLED. */
GNO_API gno_status gno_vector_write(gno_scene *scene, const char *path, const gno_vector_def *def);

#ifdef __cplusplus
}
#endif

#endif
