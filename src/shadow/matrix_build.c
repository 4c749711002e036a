/* matrix_build.c -- all columns of a light's shadow matrix.
 *
 *   pieces of GNOI_PIECE packets, any thread -> findings of each piece -> columns counted by scene polygon, each thread a run of these
 *   -> offsets -> casters moved to their places, likewise -> columns with several parts sorted again and closed up
 */
#include "base/fetch.h"
#include "base/parallel.h"
#include "shadow/matrix.h"

#include <string.h>

/* Beside a shade while columns are put together: the polygon has several. */
#define SEVERAL 0x80u

typedef struct job {
    const gnoi_search *search;
    gno_matrix *matrix;
    size_t piece_count;
    gnoi_findings *pieces;
    size_t worker_count;
    gnoi_search_scratch *scratch; /* one for each worker */
} job;

/* ---- finding ------------------------------------------------------------------------------------------------------ */

/* Casters ascend within each column. */
static void sort_columns(gnoi_findings *f)
{
    size_t from = 0, to = 0;
    if (f->caster_count == 0)
        return; /* there may be no list at all */
    for (size_t i = 0; i < f->column_count; i++) {
        size_t count = f->columns[i].count, left = gnoi_sort_casters(f->context, f->casters + from, count);
        memmove(f->casters + to, f->casters + from, left * sizeof *f->casters);
        f->columns[i].count = (uint32_t)left;
        from += count;
        to += left;
    }
    f->caster_count = to;
}

/* Gives back what growing left over, so that all pieces together hold little more than the matrix. */
static void trim(gno_context *context, void **array, size_t *capacity, size_t count, size_t size)
{
    void *less = count < *capacity && count > 0 ? gnoi_realloc(context, *array, *capacity, count, size) : NULL;
    if (!less)
        return;
    *array = less;
    *capacity = count;
}

static gno_status find_piece(void *user, int worker, size_t piece)
{
    job *j = user;
    gnoi_findings *f = &j->pieces[piece];
    f->context = j->search->from.scene->context;
    if (!gnoi_search_piece(j->search, piece, &j->scratch[worker], f))
        return GNO_ERROR_MEMORY;
    sort_columns(f);
    trim(f->context, (void **)&f->casters, &f->caster_capacity, f->caster_count, sizeof *f->casters);
    trim(f->context, (void **)&f->columns, &f->column_capacity, f->column_count, sizeof *f->columns);
    return GNO_OK;
}

/* ---- putting together ----------------------------------------------------------------------------------------------- */

/* Columns lie by place in space, the matrix by the scene's numbers: each thread goes through all columns for a run of those. */
typedef struct source_run {
    uint32_t first, end;
} source_run;

static source_run run_of(const job *j, size_t run)
{
    const size_t size = (j->matrix->size + j->worker_count - 1) / j->worker_count, first = run * size;
    source_run r = {(uint32_t)first, (uint32_t)(first + size)};
    return r;
}

static int is_in(const source_run *run, uint32_t source) { return source >= run->first && source < run->end; }

#define AHEAD 16 /* columns */

static void fetch_ahead(const job *j, const gnoi_findings *f, size_t k)
{
    if (k + AHEAD < f->column_count) {
        FETCH(&j->matrix->start[f->columns[k + AHEAD].source + 1]);
        FETCH(&j->matrix->shade[f->columns[k + AHEAD].source]);
    }
}

static void count_column(const job *j, const gnoi_found_column *c)
{
    gno_matrix *m = j->matrix;
    unsigned char *shade = &m->shade[c->source];
    /* Parts of a polygon that is not planar are other prepared polygons; each then stands for a part only. */
    const int same = !j->search->from.scene->prepared.problems.non_planar;
    if (*shade == GNO_SHADE_NO_AREA)
        *shade = (unsigned char)c->shade;
    else
        *shade = (unsigned char)(SEVERAL | (unsigned)gnoi_shade_join((gno_shade)(*shade & ~SEVERAL), c->shade, same));
    m->start[c->source + 1] += c->count;
}

/* matrix->start[s + 1]: ones of scene polygon s; its shade. */
static gno_status count_run(void *user, int worker, size_t number)
{
    const job *j = user;
    const source_run run = run_of(j, number);
    (void)worker;
    for (size_t i = 0; i < j->piece_count; i++) {
        const gnoi_findings *f = &j->pieces[i];
        for (size_t k = 0; k < f->column_count; k++) {
            fetch_ahead(j, f, k);
            if (is_in(&run, f->columns[k].source))
                count_column(j, &f->columns[k]);
        }
        if (gnoi_stopped(j->matrix->context))
            return GNO_ERROR_CANCELLED;
    }
    return GNO_OK;
}

/* After this start[s] is where column s ends. */
static gno_status move_run(void *user, int worker, size_t number)
{
    const job *j = user;
    const source_run run = run_of(j, number);
    gno_matrix *m = j->matrix;
    (void)worker;
    for (size_t i = 0; i < j->piece_count; i++) {
        const gnoi_findings *f = &j->pieces[i];
        const uint32_t *from = f->casters;
        for (size_t k = 0; k < f->column_count; k++) {
            const gnoi_found_column *c = &f->columns[k];
            fetch_ahead(j, f, k);
            if (is_in(&run, c->source)) {
                size_t at = m->start[c->source];
                m->start[c->source] += c->count;
                for (size_t n = 0; n < c->count; n++)
                    m->casters[at + n] = from[n];
            }
            from += c->count;
        }
        if (gnoi_stopped(m->context))
            return GNO_ERROR_CANCELLED;
    }
    return GNO_OK;
}

static void restore_starts(gno_matrix *m)
{
    for (size_t s = m->size; s > 0; s--)
        m->start[s] = m->start[s - 1];
    m->start[0] = 0;
}

static int is_in_parts(const gno_matrix *m, size_t s) { return m->shade[s] != GNO_SHADE_NO_AREA && (m->shade[s] & SEVERAL); }

/* Sorts columns that came in several parts, and closes the gaps that repeats leave. */
static int close_up(gno_matrix *m)
{
    size_t s = 0, from, to;
    while (s < m->size && !is_in_parts(m, s))
        s++;
    for (from = to = m->start[s]; s < m->size; s++) {
        size_t count = m->start[s + 1] - from;
        if (is_in_parts(m, s)) {
            m->shade[s] &= (unsigned char)~SEVERAL;
            count = gnoi_sort_casters(m->context, m->casters + from, count);
        }
        if (to != from)
            memmove(m->casters + to, m->casters + from, count * sizeof *m->casters);
        from = m->start[s + 1];
        m->start[s] = to;
        to += count;
        if (gnoi_stopped_at(m->context, s))
            return 0;
    }
    m->start[m->size] = to;
    return 1;
}

static gno_status assemble(job *j)
{
    gno_matrix *m = j->matrix;
    gno_status status;
    m->start = gnoi_calloc(m->context, m->size + 1, sizeof *m->start);
    m->shade = gnoi_malloc(m->context, m->size, sizeof *m->shade);
    if (!m->start || !m->shade)
        return GNO_ERROR_MEMORY;
    memset(m->shade, GNO_SHADE_NO_AREA, m->size);
    status = gnoi_parallel(m->context, (int)j->worker_count, j->worker_count, "shadow matrix", count_run, j);
    if (status)
        return status;
    for (size_t s = 0; s < m->size; s++)
        m->start[s + 1] += m->start[s];
    m->caster_capacity = m->start[m->size];
    m->casters = gnoi_malloc(m->context, m->caster_capacity, sizeof *m->casters);
    if (!m->casters)
        return GNO_ERROR_MEMORY;
    status = gnoi_parallel(m->context, (int)j->worker_count, j->worker_count, "shadow matrix", move_run, j);
    if (status)
        return status;
    for (size_t i = 0; i < j->piece_count; i++)
        gnoi_findings_free(&j->pieces[i]);
    restore_starts(m);
    return close_up(m) ? GNO_OK : GNO_ERROR_MEMORY;
}

/* ---- building ----------------------------------------------------------------------------------------------------- */

static gno_status find_columns(job *j, int threads)
{
    gno_context *context = j->search->from.scene->context;
    gno_status status = GNO_ERROR_MEMORY;
    j->worker_count = (size_t)gnoi_thread_count(threads);
    j->piece_count = (j->search->packets.packet_count + GNOI_PIECE - 1) / GNOI_PIECE;
    j->pieces = gnoi_calloc(context, j->piece_count, sizeof *j->pieces);
    j->scratch = gnoi_calloc(context, j->worker_count, sizeof *j->scratch);
    if (j->pieces && j->scratch)
        status = gnoi_parallel(context, threads, j->piece_count, "shadow matrix", find_piece, j);
    for (size_t i = 0; j->scratch && i < j->worker_count; i++)
        gnoi_search_scratch_free(context, &j->scratch[i]);
    gnoi_free(context, j->scratch, j->worker_count, sizeof *j->scratch);
    return status;
}

gno_status gnoi_matrix_fill(gno_scene *scene, const gnoi_lamp *lamp, int threads, gno_matrix *matrix)
{
    gnoi_search search;
    gno_status status = gnoi_search_make(scene, lamp, threads, &search);
    job j;
    if (status)
        return status;
    memset(&j, 0, sizeof j);
    j.search = &search;
    j.matrix = matrix;
    status = find_columns(&j, threads);
    gnoi_packets_free(scene->context, &search.packets); /* before the columns are copied: it is the larger */
    if (!status)
        status = assemble(&j);
    for (size_t i = 0; j.pieces && i < j.piece_count; i++)
        gnoi_findings_free(&j.pieces[i]);
    gnoi_free(scene->context, j.pieces, j.piece_count, sizeof *j.pieces);
    gnoi_search_free(&search);
    return status;
}

gno_status gnoi_matrix_unite(gno_matrix *matrix, const gno_matrix *other)
{
    size_t *start = gnoi_malloc(matrix->context, matrix->size + 1, sizeof *start);
    size_t room = matrix->start[matrix->size] + other->start[other->size], to = 0;
    uint32_t *casters = gnoi_malloc(matrix->context, room, sizeof *casters);
    if (!start || !casters) {
        gnoi_free(matrix->context, start, matrix->size + 1, sizeof *start);
        gnoi_free(matrix->context, casters, room, sizeof *casters);
        return GNO_ERROR_MEMORY;
    }
    for (size_t s = 0; s < matrix->size; s++) {
        size_t a = matrix->start[s], b = other->start[s], a1 = matrix->start[s + 1], b1 = other->start[s + 1];
        start[s] = to;
        while (a < a1 || b < b1) {
            uint32_t x = a < a1 ? matrix->casters[a] : GNOI_NONE, y = b < b1 ? other->casters[b] : GNOI_NONE;
            casters[to++] = x < y ? x : y;
            a += x <= y;
            b += y <= x;
        }
        if (gnoi_stopped_at(matrix->context, s)) {
            gnoi_free(matrix->context, start, matrix->size + 1, sizeof *start);
            gnoi_free(matrix->context, casters, room, sizeof *casters);
            return GNO_ERROR_MEMORY;
        }
        matrix->shade[s] = (unsigned char)gnoi_shade_join((gno_shade)matrix->shade[s], (gno_shade)other->shade[s], 0);
    }
    start[matrix->size] = to;
    gnoi_free(matrix->context, matrix->start, matrix->size + 1, sizeof *matrix->start);
    gnoi_free(matrix->context, matrix->casters, matrix->caster_capacity, sizeof *matrix->casters);
    matrix->start = start;
    matrix->casters = casters;
    matrix->caster_capacity = room;
    return GNO_OK;
}

int gnoi_polys_by_source(const gno_scene *scene, uint32_t **start, uint32_t **polys)
{
    const gnoi_prepared *prep = &scene->prepared;
    size_t size = scene->polygon_count;
    *start = gnoi_calloc(scene->context, size + 1, sizeof **start);
    *polys = gnoi_malloc(scene->context, prep->poly_count, sizeof **polys);
    if (!*start || !*polys)
        return 0;
    for (size_t i = 0; i < prep->poly_count; i++)
        (*start)[prep->polys[i].source + 1]++;
    for (size_t s = 0; s < size; s++)
        (*start)[s + 1] += (*start)[s];
    for (size_t i = prep->poly_count; i-- > 0;)
        (*polys)[--(*start)[prep->polys[i].source + 1]] = (uint32_t)i;
    /* Each end has become the beginning of its own polygons: one place further on it is the offset asked for. */
    for (size_t s = 0; s < size; s++)
        (*start)[s] = (*start)[s + 1];
    (*start)[size] = (uint32_t)prep->poly_count;
    return 1;
}
