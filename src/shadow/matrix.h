/* matrix.h -- inside a gno_matrix: its columns, and the search that finds one.
 *
 * Place in the data flow: scene and one lamp -> gnoi_search (packets, convex parts) -> columns -> gno_matrix (compressed columns)
 * -> public calls of gnomon_matrix.h. matrix_search.c finds columns, matrix_build.c all of them on any number of threads,
 * matrix.c keeps them, matrix_check.c judges them.
 * Invariants: casters of a column ascend and are the scene's polygon numbers; the result does not depend on the threads.
 */
#ifndef GNOI_SHADOW_MATRIX_H
#define GNOI_SHADOW_MATRIX_H

#include "shadow/overlap.h"
#include "shadow/packet.h"
#include <gnomon/gnomon_matrix.h>

/* What is needed to find columns of one lamp's matrix. */
typedef struct gnoi_search {
    gnoi_packet_source from;
    gnoi_packets packets;
    gnoi_facets facets;
} gnoi_search;

/* Errors: MEMORY, CANCELLED; nothing is left to be freed then. */
gno_status gnoi_search_make(const gno_scene *scene, const gnoi_lamp *lamp, int threads, gnoi_search *search);
void gnoi_search_free(gnoi_search *search);

/* A column of a prepared polygon of scene polygon `source`: scene numbers of casters are appended to a list, in no order, some twice. */
typedef struct gnoi_found_column {
    uint32_t source, count;
    gno_shade shade;
} gnoi_found_column;

#define GNOI_LANE 28
_Static_assert(GNO_MAX_POLYGONS <= 1 << GNOI_LANE, "a caster and its receiver's lane share a word");

/* What a walk leaves behind for the next one; one for each worker. */
typedef struct gnoi_search_scratch {
    gnoi_node_list far, near;
    size_t found_count, found_capacity;
    uint32_t *found; /* casters, with the number of the receiver in its packet in the bits from GNOI_LANE on */
} gnoi_search_scratch;

void gnoi_search_scratch_free(gno_context *context, gnoi_search_scratch *scratch);

/* Growing storage of columns; one for each piece. */
typedef struct gnoi_findings {
    gno_context *context;
    size_t column_count, column_capacity;
    gnoi_found_column *columns;
    size_t caster_count, caster_capacity;
    uint32_t *casters;
} gnoi_findings;

void gnoi_findings_free(gnoi_findings *findings);

/* Packets that are searched for together: their receivers share the upper part of a walk. */
#define GNOI_PIECE (GNOI_EIGHT * GNOI_EIGHT)

/* Appends the columns of all polygons of the packets of a piece. Returns 0 when memory fails or the call shall stop. A polygon on several faces of a cube frame has a
 * column in each of its packets. */
int gnoi_search_piece(const gnoi_search *search, size_t piece, gnoi_search_scratch *scratch, gnoi_findings *findings);

/* Appends the column of one prepared polygon, one for each face that it lies on. Returns 0 when memory fails. */
int gnoi_search_poly(const gnoi_search *search, uint32_t poly, gnoi_search_scratch *scratch, gnoi_findings *findings);

/* Sorts casters and drops repeats; returns how many are left. */
size_t gnoi_sort_casters(gno_context *context, uint32_t *casters, size_t count);

/* The shade of a polygon from two of its columns: of one prepared polygon on two faces (same), or of two parts. */
gno_shade gnoi_shade_join(gno_shade a, gno_shade b, int same);

struct gno_matrix {
    gno_context *context;
    size_t size;
    size_t *start;          /* size + 1; NULL: on demand */
    uint32_t *casters;
    size_t caster_capacity;
    unsigned char *shade;   /* gno_shade by column; NULL: told by the casters alone */
    double prepare_seconds, build_seconds;
    /* on demand */
    gno_scene *scene;
    unsigned long changes;  /* of the scene when the search was made */
    size_t search_count, search_capacity;
    gnoi_search *searches;  /* one for each point of the light */
    uint32_t *poly_start, *polys; /* prepared polygons by scene polygon: size + 1 offsets */
    size_t poly_capacity;
    size_t found;           /* the column asked for last, which `findings` holds; SIZE_MAX: none */
    gno_shade found_shade;
    gnoi_findings findings;
    gnoi_search_scratch scratch;
};

/* All columns of one lamp, into an empty matrix of the scene's size. Errors: MEMORY, CANCELLED. */
gno_status gnoi_matrix_fill(gno_scene *scene, const gnoi_lamp *lamp, int threads, gno_matrix *matrix);

/* Adds another matrix's ones; the shade of a column is what both are. Errors: MEMORY. */
gno_status gnoi_matrix_unite(gno_matrix *matrix, const gno_matrix *other);

/* The prepared polygons of each scene polygon, as offsets and numbers; both arrays from gnoi_malloc (size + 1 and poly_count).
 * Returns 0 when memory fails. */
int gnoi_polys_by_source(const gno_scene *scene, uint32_t **start, uint32_t **polys);

#endif
