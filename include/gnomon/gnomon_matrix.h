/* gnomon_matrix.h -- the binary shadow matrix of a light as a result of its own. Part of libgnomon.
 *
 * For each light, rows are casters and columns are receivers; both are polygon numbers of the scene (gno_scene_add_mesh), counted
 * from 0. A one at (caster, receiver) means that the caster may keep the light from a part of the receiver; a zero is certain:
 * the caster darkens no point of the receiver by more than the coplanarity tolerance (docs/accuracy.md). Nothing in it depends on a
 * viewer. Compiles as C89 to C17 and C++98 to C++17.
 *
 * The diagonal tells of own shadow. A polygon's front is the side that its normal points to, by its winding; of a closed solid
 * that has the light outside it (one whose only opening is flat, as a house without a floor, counts as closed
 * for light that does not come through the opening) it is the outer side,
 * whatever the winding. A one at (p, p) means that the light stands behind polygon p or
 * in its plane: seen from the front, all of p is in its own shadow. (A polygon that is not planar and shades a part of itself has it too.)
 * - A one-sided polygon, one that the light meets edge-on, and one of a closed solid that has the light outside, is dark then
 *   from wherever it is seen: nothing else is looked for, and the diagonal is the only one in its column.
 * - Any other two-sided polygon can be seen from behind, on the side that the light shines on: its column lists the casters of that side.
 * A polygon that lets all light through casts nothing: its row is empty. So is that of a detail of another polygon (gno_mesh_def), and row and
 * column of a polygon without area.
 */
#ifndef GNOMON_GNOMON_MATRIX_H
#define GNOMON_GNOMON_MATRIX_H

#include <gnomon/gnomon.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gno_matrix gno_matrix;

typedef struct gno_matrix_def {
    int threads;   /* 0 (default): one per processor; the matrix is the same */
    int point;     /* area lights: 0 .. samples*samples-1 takes one of its points; -1 (default): a one where any point has a one */
    int on_demand; /* 0 (default): all columns are found at once; 1: a column is found when it is asked for */
} gno_matrix_def;

GNO_API gno_matrix_def gno_matrix_def_default(void);

/* What is known of a whole column. */
typedef enum gno_shade {
    GNO_SHADE_NONE = 0,    /* no caster: all of the side that the light meets is lit */
    GNO_SHADE_PART = 1,    /* casters, none of which is known to cover all of it */
    GNO_SHADE_COVERED = 2, /* one opaque caster covers all of it */
    GNO_SHADE_OWN = 3,     /* in its own shadow from wherever it is seen; no caster was looked for */
    GNO_SHADE_NO_AREA = 4  /* the polygon has no area and was skipped */
} gno_shade;

/* One column: casters in ascending order, the receiver itself among them when `own` is 1. */
typedef struct gno_matrix_column {
    size_t receiver;
    size_t count;
    const unsigned *casters;
    int own;         /* the diagonal */
    gno_shade shade; /* of a matrix that was loaded or made from columns only what the casters tell: NONE, PART, or OWN (diagonal alone) */
} gno_matrix_column;

/* Builds the matrix of light `light` (index as in gno_scene_light). A matrix built at once stands on its own; one on demand refers to
 * the scene, which must live and stay unchanged as long as columns are asked for. Spots count as points: their cone cuts nothing
 * from the matrix. Time grows with the polygons and the ones, not with the pairs. def may be NULL.
 * Errors: MEMORY, ARGUMENT, LIMIT, CANCELLED. *matrix is NULL then. */
GNO_API gno_status gno_matrix_build(gno_scene *scene, int light, const gno_matrix_def *def, gno_matrix **matrix);

/* A matrix of `size` columns from elsewhere: column c has the rows casters[start[c]] .. casters[start[c+1]-1], ascending, each below
 * size; start[0] is 0. Both arrays are copied. Errors: MEMORY, ARGUMENT, LIMIT. */
GNO_API gno_status gno_matrix_from_columns(gno_context *context, size_t size, const size_t *start, const unsigned *casters,
                                           gno_matrix **matrix);

GNO_API void gno_matrix_destroy(gno_matrix *matrix); /* accepts NULL */

/* Number of columns, which is that of rows: the scene's polygons. */
GNO_API size_t gno_matrix_size(const gno_matrix *matrix);
GNO_API gno_context *gno_matrix_context(const gno_matrix *matrix);

/* One column. Its casters stay valid until the matrix goes, or, of a matrix on demand, until the next column is asked for.
 * Errors: ARGUMENT (no such column; the scene of a matrix on demand has changed), MEMORY (on demand only). */
GNO_API gno_status gno_matrix_get_column(gno_matrix *matrix, size_t receiver, gno_matrix_column *column);

/* The ones in order of columns, then rows: set the cursor to zero, then call until 0 is returned. Of a matrix on demand,
 * 0 is also returned where a column fails; the context has its message then, and cursor->status the status. */
typedef struct gno_matrix_cursor {
    size_t receiver; /* of the one that was found */
    size_t caster;
    size_t next_column, next_place; /* the iterator's own */
    gno_status status;
} gno_matrix_cursor;

GNO_API int gno_matrix_next(gno_matrix *matrix, gno_matrix_cursor *cursor);

/* Counts over all columns, and how the matrix was built. Columns are counted once each: own + covered + part + none + no_area = size. */
typedef struct gno_matrix_info {
    size_t size;
    size_t ones;     /* with the diagonal */
    size_t diagonal; /* ones on the diagonal */
    size_t own, covered, part, none, no_area;
    size_t longest;  /* ones in the fullest column */
    size_t bytes;    /* that the matrix itself holds */
    double prepare_seconds; /* preparing the scene; 0 when it was prepared */
    double build_seconds;   /* everything else; of a matrix on demand, without its columns */
} gno_matrix_info;

/* Of a matrix on demand this finds all columns. Errors: as gno_matrix_get_column. */
GNO_API gno_status gno_matrix_get_info(gno_matrix *matrix, gno_matrix_info *info);

/* Judges every one off the diagonal by a second, slower way: the caster is cut at the receiver's plane, thrown on it, and cut with the
 * receiver. `false_ones` cast no shadow at all, or one whose area is below 1e-9 of the receiver's; `judged` were looked at (ones of
 * polygons that are not planar are left out). Time grows with the ones. Errors: MEMORY, ARGUMENT, CANCELLED. */
typedef struct gno_matrix_check_result {
    size_t judged, false_ones;
} gno_matrix_check_result;

GNO_API gno_status gno_matrix_check(gno_scene *scene, int light, gno_matrix *matrix, gno_matrix_check_result *result);

#ifdef __cplusplus
}
#endif

#endif
