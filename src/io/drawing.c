/* drawing.c -- visible pieces into shapes: see drawing.h. */
#include "io/drawing.h"
#include "io/srgb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

gno_status gnoi_drawing_no_memory(const gnoi_drawing *d)
{
    return gno_context_fail(d->context, GNO_ERROR_MEMORY, "out of memory for a drawing");
}

/* ---- rings -------------------------------------------------------------------------------------------------------------- */

int gnoi_rings_add(gno_context *context, gnoi_rings *rings, gnoi_dot dot)
{
    if (!gnoi_mesh_array_room(context, &rings->dots, 1, sizeof dot)) {
        return 0;
    }
    ((gnoi_dot *)rings->dots.data)[rings->dots.count++] = dot;
    return 1;
}

static int same(gnoi_dot a, gnoi_dot b)
{
    return a.x == b.x && a.y == b.y;
}

int gnoi_rings_close(gno_context *context, gnoi_rings *rings)
{
    const size_t begin = rings->ring_end.count > 0 ? gnoi_ring_end(rings, rings->ring_end.count - 1) : 0;
    gnoi_dot *dots = rings->dots.data;
    size_t count = begin;
    for (size_t i = begin; i < rings->dots.count; i++) {
        if (count == begin || !same(dots[count - 1], dots[i])) {
            dots[count++] = dots[i];
        }
    }
    while (count > begin + 1 && same(dots[count - 1], dots[begin])) {
        count--;
    }
    if (count < begin + 3) {
        rings->dots.count = begin;
        return 1;
    }
    rings->dots.count = count;
    if (!gnoi_mesh_array_room(context, &rings->ring_end, 1, sizeof(size_t))) {
        return 0;
    }
    ((size_t *)rings->ring_end.data)[rings->ring_end.count++] = count;
    return 1;
}

double gnoi_dots_area2(const gnoi_dot *dots, size_t count)
{
    double sum = 0;
    for (size_t i = 0, j = count - 1; i < count; j = i++) {
        sum += (double)(dots[j].x - dots[0].x) * (double)(dots[i].y - dots[0].y) -
               (double)(dots[i].x - dots[0].x) * (double)(dots[j].y - dots[0].y);
    }
    return sum;
}

static void rings_free(gno_context *context, gnoi_rings *rings)
{
    gnoi_mesh_array_free(context, &rings->dots, sizeof(gnoi_dot));
    gnoi_mesh_array_free(context, &rings->ring_end, sizeof(size_t));
}

void gnoi_drawing_free(gnoi_drawing *d)
{
    gno_pieces_destroy(d->pieces);
    gnoi_mesh_array_free(d->context, &d->shapes, sizeof(gnoi_shape));
    rings_free(d->context, &d->rings);
    rings_free(d->context, &d->around);
    gnoi_mesh_array_free(d->context, &d->strokes, sizeof(gnoi_stroke));
    gnoi_mesh_array_free(d->context, &d->stroke_dots, sizeof(gnoi_dot));
    if (d->light_of != NULL) {
        gno_context_realloc(d->context, d->light_of, d->light_count * sizeof *d->light_of, 0);
    }
    memset(d, 0, sizeof *d);
}

/* ---- points ------------------------------------------------------------------------------------------------------------- */

/* Points of pieces lie in the picture, but for rounding; those of whole polygons need not. */
static int64_t units(double pixels, int64_t unit)
{
    const double most = 4.0 * GNO_MAX_IMAGE_SIDE;
    if (!(pixels > -most)) {
        pixels = -most;
    }
    return (int64_t)floor((pixels < most ? pixels : most) * (double)unit + 0.5);
}

gno_status gnoi_drawing_dots(const gnoi_drawing *d, size_t count, const double *points, gnoi_dot *dots)
{
    enum { BLOCK = 64 };
    double picture[3 * BLOCK];
    for (size_t first = 0; first < count; first += BLOCK) {
        const size_t n = count - first < BLOCK ? count - first : BLOCK;
        const gno_status status = gno_project_points(d->scene, n, points + 3 * first, picture);
        if (status != GNO_OK) {
            return status;
        }
        for (size_t i = 0; i < n; i++) {
            const double *p = picture + 3 * i;
            dots[first + i].x = units(p[0] / p[2], d->unit);
            dots[first + i].y = units(p[1] / p[2], d->unit);
        }
    }
    return GNO_OK;
}

/* ---- shapes ------------------------------------------------------------------------------------------------------------- */

/* A piece and the state by which it is grouped. */
typedef struct entry {
    size_t index;
    gno_piece piece;
} entry;

static int compare_states(const gno_piece *p, const gno_piece *q)
{
    if (p->light_count != q->light_count) {
        return p->light_count > q->light_count ? -1 : 1; /* best lit first */
    }
    for (size_t i = 0; i < p->light_count; i++) {
        if (p->lights[i] != q->lights[i]) {
            return p->lights[i] < q->lights[i] ? -1 : 1;
        }
    }
    for (size_t i = 0; i < 3 * p->light_count; i++) {
        if (p->passed[i] != q->passed[i]) {
            return p->passed[i] > q->passed[i] ? -1 : 1;
        }
    }
    return 0;
}

static int by_state(const void *a, const void *b)
{
    const entry *x = a, *y = b;
    const int order = compare_states(&x->piece, &y->piece);
    return order != 0 ? order : (x->index > y->index) - (x->index < y->index);
}

/* Appends a piece's rings; *weight grows by twice the area they have in the picture, in units squared. */
static gno_status add_rings(gnoi_drawing *d, const gno_piece *piece, double *weight)
{
    gnoi_rings *rings = &d->rings;
    for (size_t r = 0; r < piece->ring_count; r++) {
        const size_t first = piece->ring_start[r], count = piece->ring_start[r + 1] - first;
        const size_t closed = rings->ring_end.count, begin = rings->dots.count;
        if (!gnoi_mesh_array_room(d->context, &rings->dots, count, sizeof(gnoi_dot))) {
            return gnoi_drawing_no_memory(d);
        }
        const gno_status status = gnoi_drawing_dots(d, count, piece->points + 3 * first, (gnoi_dot *)rings->dots.data + begin);
        if (status != GNO_OK) {
            return status;
        }
        rings->dots.count += count;
        if (!gnoi_rings_close(d->context, rings)) {
            return gnoi_drawing_no_memory(d);
        }
        if (rings->ring_end.count > closed) {
            const double area = fabs(gnoi_dots_area2(gnoi_dots(&rings->dots) + begin, rings->dots.count - begin));
            *weight += r == 0 ? area : -area;
        }
    }
    return GNO_OK;
}

/* One shape from pieces of one state. A shape that is rounded to nothing is left out. */
static gno_status add_shape(gnoi_drawing *d, const gnoi_srgb *srgb, const double *colours, const entry *entries, size_t count,
                            unsigned *state)
{
    gnoi_shape shape;
    double sum[3] = {0, 0, 0}, whole = 0;
    memset(&shape, 0, sizeof shape);
    shape.polygon = entries[0].piece.polygon;
    shape.piece = entries[0].index;
    shape.first_ring = d->rings.ring_end.count;
    for (size_t i = 0; i < count; i++) {
        double weight = 0;
        const gno_status status = add_rings(d, &entries[i].piece, &weight);
        if (status != GNO_OK) {
            return status;
        }
        weight = weight > 0 ? weight : 0;
        whole += weight;
        shape.area += entries[i].piece.area;
        for (size_t k = 0; k < 3; k++) {
            sum[k] += weight * colours[3 * entries[i].index + k];
        }
    }
    shape.ring_count = d->rings.ring_end.count - shape.first_ring;
    if (!(whole > 0)) {
        d->rings.dots.count = gnoi_ring_begin(&d->rings, shape.first_ring);
        d->rings.ring_end.count = shape.first_ring;
        return GNO_OK;
    }
    for (int k = 0; k < 3; k++) {
        shape.rgb[k] = (unsigned char)gnoi_srgb_level(srgb, d->def->exposure * sum[k] / whole);
    }
    shape.state = (*state)++;
    if (!gnoi_mesh_array_room(d->context, &d->shapes, 1, sizeof shape)) {
        return gnoi_drawing_no_memory(d);
    }
    ((gnoi_shape *)d->shapes.data)[d->shapes.count++] = shape;
    return GNO_OK;
}

/* The shapes of one polygon, whose pieces are entries[0..count). */
static gno_status add_polygon(gnoi_drawing *d, const gnoi_srgb *srgb, const double *colours, entry *entries, size_t count)
{
    gno_status status = GNO_OK;
    unsigned state = 0;
    qsort(entries, count, sizeof *entries, by_state);
    for (size_t i = 0, n; i < count && status == GNO_OK; i += n) {
        for (n = 1; i + n < count && compare_states(&entries[i].piece, &entries[i + n].piece) == 0; n++) {
        }
        status = add_shape(d, srgb, colours, entries + i, n, &state);
    }
    return status;
}

static gno_status add_shapes(gnoi_drawing *d, const gnoi_srgb *srgb, const double *colours)
{
    const size_t pieces = gno_pieces_count(d->pieces);
    gnoi_mesh_array entries = {NULL, 0, 0};
    gno_status status = GNO_OK;
    for (size_t i = 0; i < pieces && status == GNO_OK;) {
        const size_t first = i;
        size_t polygon = 0;
        entries.count = 0;
        for (; i < pieces; i++) {
            entry *e;
            gno_piece piece;
            gno_pieces_get(d->pieces, i, &piece);
            if (i > first && piece.polygon != polygon) {
                break;
            }
            if (!gnoi_mesh_array_room(d->context, &entries, 1, sizeof *e)) {
                status = gnoi_drawing_no_memory(d);
                break;
            }
            polygon = piece.polygon;
            e = (entry *)entries.data + entries.count++;
            e->index = i;
            e->piece = piece;
        }
        if (status == GNO_OK) {
            status = add_polygon(d, srgb, colours, entries.data, entries.count);
        }
    }
    gnoi_mesh_array_free(d->context, &entries, sizeof(entry));
    return status;
}

static gno_status colour_shapes(gnoi_drawing *d)
{
    const size_t bytes = 3 * gno_pieces_count(d->pieces) * sizeof(double) + sizeof(double);
    const gno_image_def image = gno_scene_image(d->scene);
    double *colours = gno_context_realloc(d->context, NULL, 0, bytes);
    gnoi_srgb srgb;
    gno_status status;
    if (colours == NULL || !gnoi_srgb_create(d->context, 8, &srgb)) {
        gno_context_realloc(d->context, colours, bytes, 0);
        return gnoi_drawing_no_memory(d);
    }
    for (int k = 0; k < 3; k++) {
        d->background[k] = (unsigned char)gnoi_srgb_level(&srgb, d->def->exposure * image.background[k]);
        d->edge_colour[k] = (unsigned char)gnoi_srgb_level(&srgb, d->def->edge_colour[k]);
    }
    status = gno_pieces_colours(d->scene, d->pieces, d->def->threads, colours);
    if (status == GNO_OK) {
        status = add_shapes(d, &srgb, colours);
    }
    gnoi_srgb_destroy(&srgb);
    gno_context_realloc(d->context, colours, bytes, 0);
    return status;
}

static gno_status list_lights(gnoi_drawing *d)
{
    gno_light light;
    d->light_count = gno_expanded_light_count(d->scene);
    if (d->light_count == 0) {
        return GNO_OK;
    }
    d->light_of = gno_context_realloc(d->context, NULL, 0, d->light_count * sizeof *d->light_of);
    if (d->light_of == NULL) {
        return gnoi_drawing_no_memory(d);
    }
    for (size_t i = 0; i < d->light_count; i++) {
        const gno_status status = gno_expanded_light(d->scene, i, &light, &d->light_of[i]);
        if (status != GNO_OK) {
            return status;
        }
    }
    return GNO_OK;
}

gno_status gnoi_drawing_make(gno_scene *scene, const gno_vector_def *def, gnoi_drawing *d)
{
    const gno_image_def image = gno_scene_image(scene);
    gno_visible_def visible = gno_visible_def_default();
    gno_status status;
    memset(d, 0, sizeof *d);
    d->context = gno_scene_context(scene);
    d->scene = scene;
    d->def = def;
    d->width = image.width;
    d->height = image.height;
    d->unit = 1;
    for (int i = 0; i < def->digits; i++) {
        d->unit *= 10;
    }
    visible.threads = def->threads;
    visible.split = 2;
    visible.see_through = 0;
    status = gno_visible_pieces(scene, &visible, &d->pieces, NULL);
    if (status == GNO_OK) {
        status = list_lights(d);
    }
    return status == GNO_OK ? colour_shapes(d) : status;
}
