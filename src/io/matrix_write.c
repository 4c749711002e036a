/* matrix_write.c -- a shadow matrix to a file: Matrix Market, CSV, or a picture of it.
 *
 * Place: gno_matrix -> columns one by one -> text_file -> atomic_file -> disk; pictures: matrix_spy.c.
 */
#include "io/file_name.h"
#include "io/matrix_spy.h"
#include "io/text_file.h"

#include <stdio.h>
#include <string.h>

#define SPY_SIDE 1024

gno_matrix_file_def gno_matrix_file_def_default(void)
{
    gno_matrix_file_def def;
    def.format = GNO_MATRIX_AUTO;
    def.note = NULL;
    def.spy_side = SPY_SIDE;
    return def;
}

typedef struct writer {
    gnoi_text *text;
    gno_matrix *matrix;
    char separator;
    size_t base; /* number of the first polygon */
} writer;

static gno_status put_entries(writer *w)
{
    size_t size = gno_matrix_size(w->matrix);
    for (size_t s = 0; s < size && w->text->file->error == 0; s++) {
        gno_matrix_column column;
        gno_status status = gno_matrix_get_column(w->matrix, s, &column);
        if (status != GNO_OK) return status;
        for (size_t i = 0; i < column.count; i++) {
            gnoi_text_size(w->text, column.casters[i] + w->base);
            gnoi_text_char(w->text, w->separator);
            gnoi_text_size(w->text, s + w->base);
            gnoi_text_char(w->text, '\n');
        }
    }
    return GNO_OK;
}

/* One comment line; what would end it or is no text becomes a question mark. */
static void put_note(writer *w, const char *note)
{
    char line[512];
    size_t n = 0;
    for (; note[n] != '\0' && n + 1 < sizeof line; n++) line[n] = (unsigned char)note[n] < ' ' || note[n] == 127 ? '?' : note[n];
    line[n] = '\0';
    gnoi_text_put(w->text, "% ");
    gnoi_text_put(w->text, line);
    gnoi_text_put(w->text, "\n");
}

static gno_status put_market_header(writer *w, const char *note)
{
    gno_matrix_info info;
    char line[96];
    gno_status status = gno_matrix_get_info(w->matrix, &info);
    if (status != GNO_OK) return status;
    gnoi_text_put(w->text, "%%MatrixMarket matrix coordinate pattern general\n"
                "% binary shadow matrix: the row's polygon may keep the light from the column's; a zero is certain\n"
                "% diagonal: own shadow; polygons are numbered from 1 in the order of the scene\n");
    if (note != NULL && note[0] != '\0') put_note(w, note);
    snprintf(line, sizeof line, "%zu %zu %zu\n", info.size, info.size, info.ones);
    gnoi_text_put(w->text, line);
    return GNO_OK;
}

static gno_status write_text(gno_matrix *matrix, const char *path, gno_matrix_format format, const char *note)
{
    const int is_csv = format == GNO_MATRIX_CSV;
    writer w = {NULL, matrix, is_csv ? ',' : ' ', is_csv ? 0 : 1};
    gno_status status = gnoi_text_open(gno_matrix_context(matrix), path, &w.text);
    if (status != GNO_OK) return status;
    if (is_csv) gnoi_text_put(w.text, "caster,receiver\n");
    else status = put_market_header(&w, note);
    if (status == GNO_OK) status = put_entries(&w);
    return gnoi_text_close(w.text, status);
}

static gno_matrix_format format_of(const char *path)
{
    if (strcmp(path, "-") == 0 || gnoi_has_extension(path, ".mtx")) return GNO_MATRIX_MTX;
    if (gnoi_has_extension(path, ".csv")) return GNO_MATRIX_CSV;
    return gnoi_has_extension(path, ".png") ? GNO_MATRIX_PNG : GNO_MATRIX_AUTO;
}

gno_status gno_matrix_save(gno_matrix *matrix, const char *path, const gno_matrix_file_def *def)
{
    gno_matrix_file_def used = def ? *def : gno_matrix_file_def_default();
    char text[400];
    if (!matrix) return GNO_ERROR_ARGUMENT;
    if (!path) return gno_context_fail(gno_matrix_context(matrix), GNO_ERROR_ARGUMENT, "gno_matrix_save: path is NULL");
    if (used.format == GNO_MATRIX_AUTO) used.format = format_of(path);
    if (used.format == GNO_MATRIX_PNG && used.spy_side >= 1 && used.spy_side <= GNO_MATRIX_MAX_SPY)
        return gnoi_matrix_spy(matrix, path, used.spy_side);
    if (used.format == GNO_MATRIX_MTX || used.format == GNO_MATRIX_CSV) return write_text(matrix, path, used.format, used.note);
    if (used.format == GNO_MATRIX_PNG) snprintf(text, sizeof text, "spy_side: %d is not between 1 and %d", used.spy_side, GNO_MATRIX_MAX_SPY);
    else snprintf(text, sizeof text, "%.300s: the extension is not one of .mtx, .csv, .png", path);
    return gno_context_fail(gno_matrix_context(matrix), GNO_ERROR_ARGUMENT, text);
}
