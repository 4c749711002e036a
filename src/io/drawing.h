/* drawing.h -- a drawing on its way to a file: shapes, the background around them, lines.
 *
 * Place in the data flow: visible pieces + mean colours -> drawing.c (shapes) -> drawing_outline.c (background), drawing_edges.c
 * (lines) -> vector_svg.c or vector_pdf.c -> atomic_file. vector.c calls them in order.
 * Invariants: coordinates are whole numbers of units, `unit` to a pixel, rounded once for each point, so that what meets in the
 * scene meets in the file; a shape is one polygon under one set of lights; shapes do not overlap.
 */
#ifndef GNOI_IO_DRAWING_H
#define GNOI_IO_DRAWING_H

#include "io/atomic_file.h"
#include "io/mesh_util.h"
#include <gnomon/gnomon_io.h>
#include <gnomon/gnomon_pieces.h>

typedef struct gnoi_dot {
    int64_t x, y;
} gnoi_dot;

/* Rings of dots: ring r holds dots ring_end[r-1] .. ring_end[r]-1. */
typedef struct gnoi_rings {
    gnoi_mesh_array dots;     /* gnoi_dot */
    gnoi_mesh_array ring_end; /* size_t */
} gnoi_rings;

typedef struct gnoi_shape {
    size_t polygon;
    unsigned state;    /* number of the shape among its polygon's */
    size_t piece;      /* one of its pieces: all have the same lights */
    size_t first_ring, ring_count;
    double area;       /* scene units squared */
    unsigned char rgb[3];
} gnoi_shape;

/* An open line of dots, or a closed one. */
typedef struct gnoi_stroke {
    size_t polygon;
    gno_vector_edges kind; /* the least setting that draws it */
    size_t first_dot, dot_count;
    int closed;
} gnoi_stroke;

typedef struct gnoi_drawing {
    gno_context *context;
    gno_scene *scene;
    const gno_vector_def *def;
    gno_pieces *pieces;
    int width, height;         /* pixels */
    int64_t unit;
    unsigned char background[3], edge_colour[3];
    gnoi_mesh_array shapes;    /* gnoi_shape, ordered by polygon */
    gnoi_rings rings;          /* of the shapes */
    gnoi_rings around;         /* what the shapes leave free of the picture; filled by the even-odd rule */
    gnoi_mesh_array strokes;   /* gnoi_stroke, ordered by polygon */
    gnoi_mesh_array stroke_dots; /* gnoi_dot */
    int *light_of;             /* scene light of each expanded one */
    size_t light_count;        /* expanded */
} gnoi_drawing;

static inline const gnoi_shape *gnoi_drawing_shape(const gnoi_drawing *d, size_t i) { return (const gnoi_shape *)d->shapes.data + i; }
static inline const gnoi_stroke *gnoi_drawing_stroke(const gnoi_drawing *d, size_t i) { return (const gnoi_stroke *)d->strokes.data + i; }
static inline const gnoi_dot *gnoi_dots(const gnoi_mesh_array *dots) { return dots->data; }
static inline size_t gnoi_ring_begin(const gnoi_rings *rings, size_t r) { return r > 0 ? ((const size_t *)rings->ring_end.data)[r - 1] : 0; }
static inline size_t gnoi_ring_end(const gnoi_rings *rings, size_t r) { return ((const size_t *)rings->ring_end.data)[r]; }

/* Each may fail with MEMORY among others (message set). gnoi_drawing_make finds pieces, colours and shapes; free in any case. */
gno_status gnoi_drawing_make(gno_scene *scene, const gno_vector_def *def, gnoi_drawing *drawing);
gno_status gnoi_drawing_outline(gnoi_drawing *drawing);
gno_status gnoi_drawing_edges(gnoi_drawing *drawing);
void gnoi_drawing_free(gnoi_drawing *drawing);
gno_status gnoi_drawing_no_memory(const gnoi_drawing *drawing);

/* Where the scene's points appear, in units: `count` points, 3 values each; dots: room for as many. */
gno_status gnoi_drawing_dots(const gnoi_drawing *drawing, size_t count, const double *points, gnoi_dot *dots);

/* Appends a dot, or closes the ring of dots appended since the last; a ring of fewer than three dots, those that repeat their
 * neighbour left out, is dropped. Both return 0 when memory fails. */
int gnoi_rings_add(gno_context *context, gnoi_rings *rings, gnoi_dot dot);
int gnoi_rings_close(gno_context *context, gnoi_rings *rings);

/* Twice the signed area of the dots as a ring, in units squared; double, for it weighs and compares only. */
double gnoi_dots_area2(const gnoi_dot *dots, size_t count);

/* The writers; file errors stay in the file, a status other than GNO_OK (message set) is the writer's own failure. */
gno_status gnoi_vector_svg(const gnoi_drawing *drawing, gnoi_file *file);
gno_status gnoi_vector_pdf(const gnoi_drawing *drawing, gnoi_file *file);

/* Width in pixels of the rim that shapes of the underlay have: a pixel's diagonal, so that it fills every pixel on an edge. */
#define GNOI_UNDERLAY_RIM 1.5

#endif
