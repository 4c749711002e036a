/* matrix_spy.c -- see matrix_spy.h. */
#include "io/matrix_spy.h"

#include <math.h>
#include <stddef.h>

#define LARGEST_CELL 32 /* pixels of one entry at most */

typedef struct spy {
    gno_context *context;
    size_t size;
    int cells, cell, pixels; /* cells each way, pixels of one, pixels each way */
    size_t bytes;
    unsigned *ones; /* of each cell; the highest bit: a diagonal one */
    float *rgb;
} spy;

#define DIAGONAL 0x80000000u

static void plan(spy *s, int side)
{
    s->cells = s->size < (size_t)side ? (int)s->size : side;
    s->cells = s->cells > 0 ? s->cells : 1;
    s->cell = side / s->cells < LARGEST_CELL ? side / s->cells : LARGEST_CELL;
    s->pixels = s->cells * s->cell;
}

static size_t cell_at(const spy *s, size_t number)
{
    return s->size <= (size_t)s->cells ? number : (size_t)((double)number * s->cells / (double)s->size);
}

static unsigned count_ones(spy *s, gno_matrix *matrix, gno_status *status)
{
    unsigned most = 1;
    gno_matrix_cursor cursor = {0, 0, 0, 0, GNO_OK};
    while (gno_matrix_next(matrix, &cursor)) {
        unsigned *at = &s->ones[cell_at(s, cursor.caster) * (size_t)s->cells + cell_at(s, cursor.receiver)];
        *at += (*at & ~DIAGONAL) < ~DIAGONAL;
        most = (*at & ~DIAGONAL) > most ? *at & ~DIAGONAL : most;
        if (cursor.caster == cursor.receiver) *at |= DIAGONAL;
    }
    *status = cursor.status;
    return most;
}

/* A single one is well seen beside none; more only make it darker. */
static void paint(spy *s, unsigned most)
{
    for (int y = 0; y < s->pixels; y++) {
        for (int x = 0; x < s->pixels; x++) {
            unsigned at = s->ones[(size_t)(y / s->cell) * (size_t)s->cells + (size_t)(x / s->cell)], n = at & ~DIAGONAL;
            float *p = s->rgb + ((size_t)y * (size_t)s->pixels + (size_t)x) * 3;
            double dark = n == 0 ? 0 : 0.55 + 0.45 * (most > 1 ? log((double)n) / log((double)most) : 1);
            p[0] = (float)(at & DIAGONAL ? 0.75 : 1 - dark);
            p[1] = p[2] = (float)(1 - dark);
        }
    }
}

gno_status gnoi_matrix_spy(gno_matrix *matrix, const char *path, int side)
{
    spy s;
    gno_status status;
    gno_picture_def def = gno_picture_def_default();
    s.context = gno_matrix_context(matrix);
    s.size = gno_matrix_size(matrix);
    plan(&s, side);
    s.bytes = (size_t)s.cells * (size_t)s.cells * sizeof *s.ones;
    size_t picture = (size_t)s.pixels * (size_t)s.pixels * 3 * sizeof *s.rgb;
    s.ones = gno_context_realloc(s.context, NULL, 0, s.bytes);
    s.rgb = gno_context_realloc(s.context, NULL, 0, picture);
    if (s.ones && s.rgb) {
        for (size_t i = 0; i < s.bytes / sizeof *s.ones; i++) s.ones[i] = 0;
        unsigned most = count_ones(&s, matrix, &status);
        def.format = GNO_FORMAT_PNG;
        if (status == GNO_OK) {
            paint(&s, most);
            status = gno_picture_write(s.context, path, &def, s.pixels, s.pixels, s.rgb);
        }
    } else {
        status = gno_context_fail(s.context, GNO_ERROR_MEMORY, "out of memory for a picture of the shadow matrix");
    }
    if (s.ones) gno_context_realloc(s.context, s.ones, s.bytes, 0);
    if (s.rgb) gno_context_realloc(s.context, s.rgb, picture, 0);
    return status;
}
