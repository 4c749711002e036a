/* vector_pdf.c -- a drawing as PDF, one page, through cairo.
 *
 * Place: writer under vector.c; the layers are those of vector_svg.c. A pixel is 0.75 points, as in browsers (96 to the inch), so that
 * `pdftoppm -r 96` gives the picture's own size.
 */
#include "io/drawing.h"

#include <cairo-pdf.h>
#include <stdio.h>
#include <string.h>

#define POINTS_PER_PIXEL 0.75

/* The same drawing gives the same bytes: the date of making is not the clock's. */
#define MADE "1970-01-01T00:00:00Z"

static cairo_status_t write_bytes(void *user, const unsigned char *data, unsigned length)
{
    return gnoi_file_write(user, data, length) ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

static void set_colour(cairo_t *c, const unsigned char rgb[3])
{
    cairo_set_source_rgb(c, rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0);
}

static void trace(cairo_t *c, const gnoi_drawing *d, const gnoi_dot *dots, size_t count, int closed)
{
    for (size_t i = 0; i < count; i++) {
        const double x = (double)dots[i].x / (double)d->unit, y = (double)dots[i].y / (double)d->unit;
        if (i == 0) {
            cairo_move_to(c, x, y);
        } else {
            cairo_line_to(c, x, y);
        }
    }
    if (closed) {
        cairo_close_path(c);
    }
}

static void trace_rings(cairo_t *c, const gnoi_drawing *d, const gnoi_rings *rings, size_t first, size_t count)
{
    for (size_t r = first; r < first + count; r++) {
        const size_t begin = gnoi_ring_begin(rings, r);
        trace(c, d, gnoi_dots(&rings->dots) + begin, gnoi_ring_end(rings, r) - begin, 1);
    }
}

static void draw_underlay(cairo_t *c, const gnoi_drawing *d)
{
    cairo_save(c);
    if (!d->def->background) {
        cairo_rectangle(c, 0, 0, d->width, d->height);
        trace_rings(c, d, &d->around, 0, d->around.ring_end.count);
        cairo_clip(c);
    }
    cairo_set_line_width(c, GNOI_UNDERLAY_RIM);
    for (size_t i = 0; i < d->shapes.count && cairo_status(c) == CAIRO_STATUS_SUCCESS; i++) {
        const gnoi_shape *shape = gnoi_drawing_shape(d, i);
        set_colour(c, shape->rgb);
        trace_rings(c, d, &d->rings, shape->first_ring, shape->ring_count);
        cairo_fill_preserve(c);
        cairo_stroke(c);
    }
    cairo_restore(c);
}

static void draw_shapes(cairo_t *c, const gnoi_drawing *d)
{
    for (size_t i = 0; i < d->shapes.count && cairo_status(c) == CAIRO_STATUS_SUCCESS; i++) {
        const gnoi_shape *shape = gnoi_drawing_shape(d, i);
        set_colour(c, shape->rgb);
        trace_rings(c, d, &d->rings, shape->first_ring, shape->ring_count);
        cairo_fill(c);
    }
}

static void draw_strokes(cairo_t *c, const gnoi_drawing *d)
{
    cairo_set_line_width(c, d->def->edge_width);
    cairo_set_line_cap(c, CAIRO_LINE_CAP_ROUND);
    set_colour(c, d->edge_colour);
    for (size_t i = 0; i < d->strokes.count && cairo_status(c) == CAIRO_STATUS_SUCCESS; i++) {
        const gnoi_stroke *s = gnoi_drawing_stroke(d, i);
        trace(c, d, gnoi_dots(&d->stroke_dots) + s->first_dot, s->dot_count, s->closed);
        cairo_stroke(c);
    }
}

static void draw(cairo_t *c, const gnoi_drawing *d)
{
    cairo_scale(c, POINTS_PER_PIXEL, POINTS_PER_PIXEL);
    cairo_set_fill_rule(c, CAIRO_FILL_RULE_EVEN_ODD);
    cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
    if (d->def->underlay) {
        draw_underlay(c, d);
    }
    draw_shapes(c, d);
    if (d->def->background) {
        set_colour(c, d->background);
        trace_rings(c, d, &d->around, 0, d->around.ring_end.count);
        cairo_fill(c);
    }
    draw_strokes(c, d);
}

static void set_metadata(cairo_surface_t *surface, const gnoi_drawing *d)
{
    char creator[64];
    snprintf(creator, sizeof creator, "gnomon %s", gno_version());
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, creator);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, MADE);
    if (d->def->title != NULL) {
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, d->def->title);
    }
}

gno_status gnoi_vector_pdf(const gnoi_drawing *d, gnoi_file *file)
{
    cairo_surface_t *surface = cairo_pdf_surface_create_for_stream(write_bytes, file, d->width * POINTS_PER_PIXEL, d->height * POINTS_PER_PIXEL);
    set_metadata(surface, d);
    cairo_t *c = cairo_create(surface);
    draw(c, d);
    cairo_status_t failed = cairo_status(c);
    cairo_destroy(c);
    cairo_surface_finish(surface);
    if (failed == CAIRO_STATUS_SUCCESS) {
        failed = cairo_surface_status(surface);
    }
    cairo_surface_destroy(surface);
    if (failed == CAIRO_STATUS_SUCCESS || file->error != 0) {
        return GNO_OK;
    }
    char text[200];
    snprintf(text, sizeof text, "cairo: %s", cairo_status_to_string(failed));
    return gno_context_fail(d->context, failed == CAIRO_STATUS_NO_MEMORY ? GNO_ERROR_MEMORY : GNO_ERROR_FILE, text);
}
