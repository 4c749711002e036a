/* matrix_read.c -- a shadow matrix from a Matrix Market file.
 *
 *   file -- gnoi_blocks: whole lines --> header --> size line --> entries --> ordered by column --> gno_matrix_from_columns
 *
 * Read: "matrix coordinate pattern general", square, entries in any order, counted from 1. Room is made for the entries that are there,
 * not for those that the size line announces. Format: Boisvert, Pozo and Remington, "The Matrix Market exchange formats", 1996.
 */
#include "io/mesh_util.h"
#include "io/obj_parse.h"

#include <gnomon/gnomon_io.h>
#include <string.h>

typedef struct entry {
    unsigned row, column; /* from 0 */
} entry;

typedef struct reader {
    gno_context *context;
    const char *path;
    size_t line;
    int header, sized; /* lines seen */
    unsigned long size, announced;
    gnoi_mesh_array entries;
} reader;

static gno_status wrong(reader *r, const char *what)
{
    return gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, r->line, "%s", what);
}

/* ---- header ----------------------------------------------------------------------------------------------------- */

static int is_word(const char *p, const char *end, const char *lower)
{
    for (; p < end && *lower; p++, lower++)
        if ((*p >= 'A' && *p <= 'Z' ? *p - 'A' + 'a' : *p) != *lower) return 0;
    return p == end && !*lower;
}

static const char *skip_blanks(const char *p)
{
    while (gnoi_parse_is_blank(*p)) p++;
    return p;
}

static const char *word_end(const char *p)
{
    while (*p != '\n' && !gnoi_parse_is_blank(*p)) p++;
    return p;
}

static gno_status read_header(reader *r, const char *p)
{
    static const char *const words[] = {"%%matrixmarket", "matrix", "coordinate", "pattern", "general"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        const char *end;
        p = i == 0 ? p : skip_blanks(p);
        end = word_end(p);
        if (!is_word(p, end, words[i])) {
            return wrong(r, i == 0 ? "not a Matrix Market file: it does not begin with %%MatrixMarket"
                                   : "not a shadow matrix: the header must be %%MatrixMarket matrix coordinate pattern general");
        }
        p = end;
    }
    if (*skip_blanks(p) != '\n') return wrong(r, "more words in the header than Matrix Market has");
    r->header = 1;
    return GNO_OK;
}

/* ---- numbers ---------------------------------------------------------------------------------------------------- */

/* The next whole number of the line, at most `limit`; NULL when there is none or it is larger (*too_large). */
static const char *read_count(const char *p, unsigned long limit, unsigned long *value, int *too_large)
{
    unsigned long v = 0;
    p = skip_blanks(p);
    if (*p < '0' || *p > '9') return NULL;
    for (; *p >= '0' && *p <= '9'; p++) {
        unsigned long digit = (unsigned long)(*p - '0');
        if (digit > limit || v > (limit - digit) / 10) {
            *too_large = 1;
            return NULL;
        }
        v = v * 10 + digit;
    }
    *value = v;
    return *p == '\n' || gnoi_parse_is_blank(*p) ? p : NULL;
}

static gno_status read_size(reader *r, const char *p)
{
    unsigned long rows = 0, columns = 0;
    int large = 0;
    p = read_count(p, GNO_MAX_POLYGONS, &rows, &large);
    if (p) p = read_count(p, GNO_MAX_POLYGONS, &columns, &large);
    if (p) p = read_count(p, (unsigned long)-1 / 16, &r->announced, &large);
    if (large) return gnoi_mesh_fail(r->context, GNO_ERROR_LIMIT, r->path, r->line, "too large: the limit is %d rows and columns", GNO_MAX_POLYGONS);
    if (!p || *skip_blanks(p) != '\n') return wrong(r, "the size line must be three whole numbers: rows, columns, entries");
    if (rows != columns) {
        return gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, r->line, "a shadow matrix is square, not %lu by %lu", rows, columns);
    }
    r->size = rows;
    if (rows == 0 ? r->announced > 0 : r->announced / rows > rows || (r->announced / rows == rows && r->announced % rows > 0)) {
        return gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, r->line, "%lu entries do not fit in %lu by %lu", r->announced, rows, rows);
    }
    r->sized = 1;
    return GNO_OK;
}

static gno_status read_entry(reader *r, const char *p)
{
    unsigned long row = 0, column = 0;
    int large = 0;
    entry e;
    p = read_count(p, r->size, &row, &large);
    if (p) p = read_count(p, r->size, &column, &large);
    if (large || (p && (row == 0 || column == 0)))
        return gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, r->line, "an index is not between 1 and %lu", r->size);
    if (!p || *skip_blanks(p) != '\n') return wrong(r, "an entry must be two whole numbers: row, column");
    if (r->entries.count == r->announced)
        return gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, r->line, "more entries than the %lu announced", r->announced);
    if (r->entries.count == r->entries.capacity && !gnoi_mesh_array_room(r->context, &r->entries, 1, sizeof e))
        return gnoi_mesh_no_memory(r->context, r->path);
    e.row = (unsigned)row - 1;
    e.column = (unsigned)column - 1;
    ((entry *)r->entries.data)[r->entries.count++] = e;
    return GNO_OK;
}

/* ---- the file ----------------------------------------------------------------------------------------------------- */

static gno_status read_line(reader *r, const char *p)
{
    if (!r->header) return read_header(r, p);
    if (*p == '%' || *skip_blanks(p) == '\n') return GNO_OK;
    return r->sized ? read_entry(r, p) : read_size(r, p);
}

static gno_status read_lines(reader *r)
{
    gnoi_blocks blocks;
    const char *p = NULL, *last = NULL;
    gno_status status = gnoi_blocks_open(&blocks, r->context, r->path);
    while (status == GNO_OK && (status = gnoi_blocks_next(&blocks, &p, &last)) == GNO_OK && p) {
        for (; p < last && status == GNO_OK; p = gnoi_parse_line_end(p) + 1) {
            r->line++;
            status = read_line(r, p);
        }
    }
    gnoi_blocks_close(&blocks);
    r->line = 0;
    if (status == GNO_OK && !r->sized) status = wrong(r, r->header ? "the size line is missing" : "the file is empty");
    if (status == GNO_OK && r->entries.count < r->announced)
        status = gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, 0, "cut short: %lu of %lu entries", (unsigned long)r->entries.count, r->announced);
    return status;
}

/* Two stable passes, by row and then by column, put entries of a column next to each other in the order of rows. */
static void order_by(const entry *from, entry *to, size_t count, size_t *start, size_t size, int by_column)
{
    memset(start, 0, (size + 1) * sizeof *start);
    for (size_t i = 0; i < count; i++) start[(by_column ? from[i].column : from[i].row) + 1]++;
    for (size_t s = 0; s < size; s++) start[s + 1] += start[s];
    for (size_t i = 0; i < count; i++) to[start[by_column ? from[i].column : from[i].row]++] = from[i];
    for (size_t s = size; s > 0; s--) start[s] = start[s - 1];
    start[0] = 0;
}

static gno_status find_repeat(reader *r, const entry *e, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        if (e[i].row == e[i - 1].row && e[i].column == e[i - 1].column)
            return gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, 0, "the entry %u %u is there twice", e[i].row + 1, e[i].column + 1);
    }
    return GNO_OK;
}

static gno_status make_matrix(reader *r, gno_matrix **matrix)
{
    size_t count = r->entries.count, start_bytes = (r->size + 1) * sizeof(size_t), bytes = (count + 1) * sizeof(entry);
    entry *first = r->entries.data, *second = gno_context_realloc(r->context, NULL, 0, bytes);
    size_t *start = gno_context_realloc(r->context, NULL, 0, start_bytes);
    gno_status status = GNO_OK;
    if (!second || !start) {
        status = gnoi_mesh_no_memory(r->context, r->path);
    } else {
        unsigned *casters = (unsigned *)(void *)second;
        order_by(first, second, count, start, r->size, 0);
        order_by(second, first, count, start, r->size, 1);
        status = find_repeat(r, first, count);
        for (size_t i = 0; i < count && status == GNO_OK; i++) casters[i] = first[i].row;
        if (status == GNO_OK) status = gno_matrix_from_columns(r->context, r->size, start, casters, matrix);
    }
    if (second) gno_context_realloc(r->context, second, bytes, 0);
    if (start) gno_context_realloc(r->context, start, start_bytes, 0);
    return status;
}

gno_status gno_matrix_load(gno_context *context, const char *path, gno_matrix **matrix)
{
    reader r;
    gno_status status;
    if (matrix) *matrix = NULL;
    if (!context) return GNO_ERROR_ARGUMENT;
    if (!path || !matrix) return gno_context_fail(context, GNO_ERROR_ARGUMENT, "gno_matrix_load: path or matrix is NULL");
    memset(&r, 0, sizeof r);
    r.context = context;
    r.path = path;
    status = read_lines(&r);
    if (status == GNO_OK) status = make_matrix(&r, matrix);
    gnoi_mesh_array_free(context, &r.entries, sizeof(entry));
    return status;
}
