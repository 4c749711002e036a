/* matrix_write.c -- a shadow matrix to a file: Matrix Market, CSV, or a picture of it.
 *
 * Place: gno_matrix -> columns one by one -> text in blocks -> atomic_file -> disk; pictures: matrix_spy.c.
 */
#include "io/atomic_file.h"
#include "io/matrix_spy.h"
#include "io/scene_yaml.h" /* gnoi_has_extension */

#include <stdio.h>
#include <string.h>

#define BLOCK 65536
#define ENTRY_LENGTH 48 /* bytes, two numbers of up to 20 digits, separator and newline */
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
    gno_matrix *matrix;
    gnoi_file file;
    char separator;
    size_t base; /* number of the first polygon */
    size_t used;
    char block[BLOCK];
} writer;

static void flush(writer *w)
{
    gnoi_file_write(&w->file, w->block, w->used);
    w->used = 0;
}

static void put_text(writer *w, const char *text)
{
    flush(w);
    gnoi_file_write(&w->file, text, strlen(text));
}

static void put_number(writer *w, size_t number)
{
    char digits[24];
    int n = 0;
    do digits[n++] = (char)('0' + number % 10);
    while ((number /= 10) > 0);
    while (n > 0) w->block[w->used++] = digits[--n];
}

static gno_status put_entries(writer *w)
{
    size_t size = gno_matrix_size(w->matrix);
    for (size_t s = 0; s < size && w->file.error == 0; s++) {
        gno_matrix_column column;
        gno_status status = gno_matrix_get_column(w->matrix, s, &column);
        if (status != GNO_OK) return status;
        for (size_t i = 0; i < column.count; i++) {
            if (w->used + ENTRY_LENGTH > BLOCK) flush(w);
            put_number(w, column.casters[i] + w->base);
            w->block[w->used++] = w->separator;
            put_number(w, s + w->base);
            w->block[w->used++] = '\n';
        }
    }
    flush(w);
    return GNO_OK;
}

/* One comment line; what would end it or is no text becomes a question mark. */
static void put_note(writer *w, const char *note)
{
    char line[512];
    size_t n = 0;
    for (; note[n] != '\0' && n + 1 < sizeof line; n++) line[n] = (unsigned char)note[n] < ' ' || note[n] == 127 ? '?' : note[n];
    line[n] = '\0';
    put_text(w, "% ");
    put_text(w, line);
    put_text(w, "\n");
}

static gno_status put_market_header(writer *w, const char *note)
{
    gno_matrix_info info;
    char line[96];
    gno_status status = gno_matrix_get_info(w->matrix, &info);
    if (status != GNO_OK) return status;
    put_text(w, "%%MatrixMarket matrix coordinate pattern general\n"
                "% binary shadow matrix: the row's polygon may keep the light from the column's; a zero is certain\n"
                "% diagonal: own shadow; polygons are numbered from 1 in the order of the scene\n");
    if (note != NULL && note[0] != '\0') put_note(w, note);
    snprintf(line, sizeof line, "%zu %zu %zu\n", info.size, info.size, info.ones);
    put_text(w, line);
    return GNO_OK;
}

static gno_status write_text(gno_matrix *matrix, const char *path, gno_matrix_format format, const char *note)
{
    gno_context *context = gno_matrix_context(matrix);
    gno_status status = GNO_OK;
    writer *w = gno_context_realloc(context, NULL, 0, sizeof *w);
    if (w == NULL) return gno_context_fail(context, GNO_ERROR_MEMORY, "out of memory for writing a shadow matrix");
    memset(w, 0, sizeof *w);
    w->matrix = matrix;
    w->separator = format == GNO_MATRIX_CSV ? ',' : ' ';
    w->base = format == GNO_MATRIX_CSV ? 0 : 1;
    status = gnoi_file_open(context, path, 0, &w->file);
    if (status == GNO_OK) {
        if (format == GNO_MATRIX_CSV) put_text(w, "caster,receiver\n");
        else status = put_market_header(w, note);
        if (status == GNO_OK) status = put_entries(w);
        if (status == GNO_OK) status = gnoi_file_commit(&w->file);
        else gnoi_file_discard(&w->file);
    }
    gno_context_realloc(context, w, sizeof *w, 0);
    return status;
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
