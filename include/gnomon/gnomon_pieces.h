/* gnomon_pieces.h -- the lit and the visible parts of polygons, as polygons with areas.
 *
 * Part of libgnomon. Compiles as C89 to C17 and C++98 to C++17. A light sees what is lit as an eye sees what is visible; both are
 * found by one method (docs/algorithm.md, "Lit and visible pieces"): every polygon minus the union of all that hides it.
 *
 * Conventions beyond gnomon.h's
 * - Polygons go by their numbers in the scene, also where preparing has split one that is not planar.
 * - Polygons lying on each other (docs/accuracy.md: coplanar) never shade each other. From an eye the higher priority is in front,
 *   then the lower number.
 * - A polygon is lit on the side that faces the light; a one-sided polygon (material two_sided 0) not from behind, though it casts.
 *   A polygon edge-on to the light has no lit side.
 */
#ifndef GNOMON_GNOMON_PIECES_H
#define GNOMON_GNOMON_PIECES_H

#include <gnomon/gnomon.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- lights as single points ------------------------------------------------------------------------------------ */

/* Lights after area lights are split into their sample points: a light's points follow one another, in the order of the lights. */
GNO_API size_t gno_expanded_light_count(const gno_scene *scene);

/* One of them as a point, directional or spot light with its share of the intensity; *source is its light's index in the scene (may
 * be NULL). Errors: ARGUMENT. */
GNO_API gno_status gno_expanded_light(const gno_scene *scene, size_t index, gno_light *light, int *source);

/* ---- pieces ----------------------------------------------------------------------------------------------------- */

/* A set of pieces, ordered by polygon. It keeps nothing of the scene and stays valid when the scene changes or goes; the context must
 * outlive it. */
typedef struct gno_pieces gno_pieces;

/* One piece: a detail polygon on its source's plane. Pointers stay valid as long as the set. */
typedef struct gno_piece {
    size_t polygon;           /* the scene's polygon that it is a part of */
    int side;                 /* +1: the side that the polygon's plane normal (counter-clockwise outer ring) points to; -1: the other */
    size_t ring_count;        /* the first is the outer ring, the others are holes */
    const size_t *ring_start; /* ring_count+1 offsets into points, counted in points */
    const double *points;     /* 3 per point, scene space; outer ring counter-clockwise as the piece's side is looked at, holes clockwise */
    double area;              /* scene units squared, on the source's plane */
    double centroid[3];
    size_t light_count;       /* expanded lights that reach the piece, each the whole of it */
    const unsigned *lights;   /* their numbers, ascending */
    const double *passed;     /* 3 per entry of lights: share of the light that arrives, per channel; 1 1 1 unless transparent
                                 polygons weaken it */
} gno_piece;

GNO_API void gno_pieces_destroy(gno_pieces *pieces); /* accepts NULL */
GNO_API size_t gno_pieces_count(const gno_pieces *pieces);
GNO_API gno_status gno_pieces_get(const gno_pieces *pieces, size_t index, gno_piece *piece);

/* The pieces of one polygon are *first .. *first + *count - 1 (count 0: it has none). */
GNO_API gno_status gno_pieces_of(const gno_pieces *pieces, size_t polygon, size_t *first, size_t *count);

/* ---- lit pieces -------------------------------------------------------------------------------------------------- */

/* One polygon under one light. Areas in scene units squared. */
typedef struct gno_lit_row {
    int side;           /* as in gno_piece; 0: edge-on, or a polygon without area */
    double area;        /* of the polygon, its holes left out */
    double lit_area;    /* what the light reaches undiminished */
    double dimmed_area; /* what it reaches through transparent polygons, beside lit_area */
    double fraction;    /* lit_area / area; 0 for a polygon without area */
    double centroid[3]; /* of the lit part; zeros when nothing is lit */
} gno_lit_row;

/* What a run proves of itself, and counts. */
typedef struct gno_lit_summary {
    double area, lit_area, dimmed_area; /* sums over all polygons */
    /* Certificate (only where asked for; else zeros). Lit and shadowed parts are found apart: the polygon minus its casters' union,
     * and the polygon's intersection with it. */
    double area_residual;   /* largest |lit + shadowed - area| / area of all polygons */
    size_t area_worst;      /* the polygon that has it */
    /* Flux: for a directional light the area of the projection along it (lit area times cosine of incidence); for a light at a
     * point the area of the central projection onto a cube of side 2 around it; inside the cone of a spot. */
    double flux_lit;        /* sum over all polygons that cast; parts that lie on each other and are lit count once */
    double flux_twice;      /* what was left out of flux_lit because it lies on another lit polygon */
    double flux_union;      /* of the union of all that casts, projected */
    double flux_residual;   /* |flux_lit - flux_union| / flux_union */
    size_t polygons;        /* prepared polygons asked about */
    size_t unlit, full, clipped; /* of them: wholly in the dark without clipping, wholly lit without clipping, clipped */
    size_t casters;         /* of those clipped, in all */
    double prepare_seconds, tree_seconds, piece_seconds, certificate_seconds; /* wall clock */
} gno_lit_summary;

typedef struct gno_lit_def {
    int threads; /* 0 (default): one per processor; results do not depend on it */
    int certify; /* 1 (default): fill in the certificate, which about doubles the time; 0: leave it out */
} gno_lit_def;

GNO_API gno_lit_def gno_lit_def_default(void);

/* The lit parts of every polygon under one expanded light. def may be NULL for the defaults. *pieces (may be NULL: not wanted) is
 * to be destroyed by the caller. rows (may be NULL) has room for one row a polygon of the scene (gno_scene_count); summary may be NULL.
 * Errors: MEMORY, ARGUMENT, LIMIT, CANCELLED; *pieces is NULL then. */
GNO_API gno_status gno_lit_pieces(gno_scene *scene, size_t light, const gno_lit_def *def, gno_pieces **pieces, gno_lit_row *rows,
                                  gno_lit_summary *summary);

/* ---- visible pieces ---------------------------------------------------------------------------------------------- */

typedef struct gno_visible_def {
    int threads;      /* 0 (default): one per processor; results do not depend on it */
    int split;        /* 1 (default): split by the lights that reach, area lights point by point; 0: not split, light_count is 0;
                         2: split by all but the points of area lights, of which a piece names those that reach all of it (what the
                         others reach is kept for gno_pieces_colours): the number of pieces stays small */
    int see_through;  /* 1 (default): transparent polygons hide nothing, their pieces lie over others; 0: every polygon hides */
    const gno_pieces *const *lit; /* lit pieces of this scene kept from gno_lit_pieces, one set for each expanded light, NULL where
                                     there is none; NULL (default): none at all. Saves time on every view but the first */
} gno_visible_def;

GNO_API gno_visible_def gno_visible_def_default(void);

typedef struct gno_visible_summary {
    size_t polygons;                /* prepared polygons inside the picture's frame, facing the eye as they must */
    size_t hidden, whole, clipped;  /* of them: wholly hidden or wholly visible without clipping, clipped */
    size_t casters;                 /* of those clipped, in all */
    double prepare_seconds, tree_seconds, piece_seconds;
} gno_visible_summary;

/* What the scene's camera sees within its picture, cut to the picture's frame. def and summary may be NULL.
 * Errors: MEMORY, ARGUMENT, LIMIT, CANCELLED; *pieces is NULL then. */
GNO_API gno_status gno_visible_pieces(gno_scene *scene, const gno_visible_def *def, gno_pieces **pieces, gno_visible_summary *summary);

/* ---- pieces in the picture ---------------------------------------------------------------------------------------- */

/* Where the scene's camera shows points: homogeneous picture coordinates X, Y, W, 3 for each of `count` points (3 values each, scene
 * space). The point appears at (X/W, Y/W) in pixels from the picture's top left corner; W is 1 for an orthographic camera, for a
 * perspective one the depth, which is not positive where the point is not before the eye. Errors: ARGUMENT. */
GNO_API gno_status gno_project_points(const gno_scene *scene, size_t count, const double *points, double *picture);

/* The colour of each visible piece on the whole: 3 linear values each, the mean of what the camera shows of it, by the lighting model
 * and the lights that reach the piece. Zeros for a piece that covers nothing of the picture. threads as in gno_render_def.
 * Errors: MEMORY, ARGUMENT (pieces of another scene), LIMIT, CANCELLED. */
GNO_API gno_status gno_pieces_colours(gno_scene *scene, const gno_pieces *pieces, int threads, double *rgb);

#ifdef __cplusplus
}
#endif

#endif
