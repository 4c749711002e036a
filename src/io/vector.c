/* vector.c -- gno_vector_write: what the camera sees to a drawing.
 *
 * Place: scene -> (checks here) -> drawing.h: shapes, background, lines -> writer by format -> atomic_file -> disk.
 */
#include "io/drawing.h"
#include "io/file_name.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

gno_vector_def gno_vector_def_default(void)
{
    gno_vector_def def;
    memset(&def, 0, sizeof def);
    def.format = GNO_VECTOR_AUTO;
    def.edges = GNO_EDGES_NONE;
    def.edge_width = 1;
    def.crease = 1;
    def.background = 1;
    def.underlay = 1;
    def.digits = 4;
    def.exposure = 1;
    return def;
}

static gno_status refuse(gno_context *context, const char *path, const char *what)
{
    char text[512];
    snprintf(text, sizeof text, "%.300s: %s", path, what);
    return gno_context_fail(context, GNO_ERROR_ARGUMENT, text);
}

static gno_vector_format format_of(const char *path, gno_vector_format format)
{
    if (format != GNO_VECTOR_AUTO) {
        return format;
    }
    return gnoi_has_extension(path, ".svg") ? GNO_VECTOR_SVG : gnoi_has_extension(path, ".pdf") ? GNO_VECTOR_PDF : GNO_VECTOR_AUTO;
}

/* What is wrong with a def, NULL: nothing. */
static const char *fault(const gno_vector_def *def)
{
    if ((int)def->edges < GNO_EDGES_NONE || def->edges > GNO_EDGES_ALL) {
        return "edges are not none, silhouette, visible or all";
    }
    if (!(def->edge_width > 0) || isinf(def->edge_width)) {
        return "the edges' width must be a number greater than 0";
    }
    if (!(def->crease >= 0 && def->crease <= 180)) {
        return "the crease angle must be from 0 to 180 degrees";
    }
    if (def->digits < 0 || def->digits > 9) {
        return "digits must be from 0 to 9";
    }
    if (!(def->exposure >= 0) || isinf(def->exposure)) {
        return "the exposure must be a number, 0 or more";
    }
    for (int k = 0; k < 3; k++) {
        if (!(def->edge_colour[k] >= 0)) {
            return "the edges' colour must be three numbers, each 0 or more";
        }
    }
    return NULL;
}

static gno_status write_drawing(const gnoi_drawing *drawing, const char *path, gno_vector_format format)
{
    gnoi_file file;
    gno_status status = gnoi_file_open(drawing->context, path, 0, &file);
    if (status != GNO_OK) {
        return status;
    }
    status = format == GNO_VECTOR_SVG ? gnoi_vector_svg(drawing, &file) : gnoi_vector_pdf(drawing, &file);
    if (status != GNO_OK && file.error == 0) {
        gnoi_file_discard(&file);
        return status;
    }
    return gnoi_file_commit(&file);
}

gno_status gno_vector_write(gno_scene *scene, const char *path, const gno_vector_def *def)
{
    const gno_vector_def used = def != NULL ? *def : gno_vector_def_default();
    gnoi_drawing drawing;
    if (scene == NULL) {
        return GNO_ERROR_ARGUMENT;
    }
    gno_context *context = gno_scene_context(scene);
    if (path == NULL) {
        return gno_context_fail(context, GNO_ERROR_ARGUMENT, "gno_vector_write: a path must be given");
    }
    const gno_vector_format format = format_of(path, used.format);
    if (format != GNO_VECTOR_SVG && format != GNO_VECTOR_PDF) {
        return refuse(context, path, "the extension is not one of .svg, .pdf");
    }
    const char *wrong = fault(&used);
    if (wrong != NULL) {
        return refuse(context, path, wrong);
    }
    gno_status status = gnoi_drawing_make(scene, &used, &drawing);
    if (status == GNO_OK) {
        status = gnoi_drawing_outline(&drawing);
    }
    if (status == GNO_OK) {
        status = gnoi_drawing_edges(&drawing);
    }
    if (status == GNO_OK) {
        status = write_drawing(&drawing, path, format);
    }
    gnoi_drawing_free(&drawing);
    return status;
}
