/* matrix.c -- the public calls of gnomon_matrix.h: building, columns, iterating, counts. See matrix.h. */
#include "shadow/matrix.h"
#include "scene/validate.h"
#include "shadow/lamp.h"

#include <string.h>

gno_matrix_def gno_matrix_def_default(void)
{
    gno_matrix_def def;
    def.threads = 0;
    def.point = -1;
    def.on_demand = 0;
    return def;
}

/* ---- building ----------------------------------------------------------------------------------------------------- */

static gno_status check(gno_scene *scene, int light, const gno_matrix_def *def)
{
    gno_context *context = scene->context;
    size_t points;
    if (light < 0 || (size_t)light >= scene->light_count)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_matrix_build: light %d of %lu", light, (unsigned long)scene->light_count);
    points = gnoi_light_points(&scene->lights[light].light);
    if (def->point < -1 || (def->point >= 0 && (size_t)def->point >= points))
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_matrix_build: point %d of a light of %lu", def->point, (unsigned long)points);
    if (def->threads < 0 || def->threads > GNO_MAX_THREADS)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "threads: %d is not between 0 and %d", def->threads, GNO_MAX_THREADS);
    return GNO_OK;
}

static gno_matrix *create(gno_context *context, size_t size)
{
    gno_matrix *m = gnoi_calloc(context, 1, sizeof *m);
    if (m) {
        m->context = context;
        m->size = size;
        m->findings.context = context;
        m->found = SIZE_MAX;
    }
    return m;
}

/* A matrix of its own for each further lamp, joined to the first. */
static gno_status build_all(gno_scene *scene, const gnoi_lamp *lamps, size_t count, int threads, gno_matrix *m)
{
    gno_status status = gnoi_matrix_fill(scene, &lamps[0], threads, m);
    for (size_t i = 1; i < count && !status; i++) {
        gno_matrix *one = create(scene->context, m->size);
        status = one ? gnoi_matrix_fill(scene, &lamps[i], threads, one) : GNO_ERROR_MEMORY;
        if (!status)
            status = gnoi_matrix_unite(m, one);
        gno_matrix_destroy(one);
    }
    return status;
}

static gno_status make_ready(gno_scene *scene, const gnoi_lamp *lamps, size_t count, int threads, gno_matrix *m)
{
    m->scene = scene;
    m->changes = scene->changes;
    m->poly_capacity = scene->prepared.poly_count;
    m->search_capacity = count;
    m->searches = gnoi_calloc(scene->context, count, sizeof *m->searches);
    if (!m->searches || !gnoi_polys_by_source(scene, &m->poly_start, &m->polys))
        return GNO_ERROR_MEMORY;
    for (; m->search_count < count; m->search_count++) {
        gno_status status = gnoi_search_make(scene, &lamps[m->search_count], threads, &m->searches[m->search_count]);
        if (status)
            return status;
    }
    return GNO_OK;
}

static gno_status build(gno_scene *scene, const gno_light *light, const gno_matrix_def *def, gno_matrix *m)
{
    size_t count = gnoi_light_points(light);
    gnoi_lamp *lamps = gnoi_malloc(scene->context, count, sizeof *lamps);
    const gnoi_lamp *first = lamps;
    size_t used = count;
    gno_status status;
    if (!lamps)
        return GNO_ERROR_MEMORY;
    gnoi_lamps_of(light, lamps);
    if (def->point >= 0) {
        first += def->point;
        used = 1;
    }
    status = def->on_demand ? make_ready(scene, first, used, def->threads, m) : build_all(scene, first, used, def->threads, m);
    gnoi_free(scene->context, lamps, count, sizeof *lamps);
    return status;
}

gno_status gno_matrix_build(gno_scene *scene, int light, const gno_matrix_def *def, gno_matrix **matrix)
{
    gno_matrix_def defaults = gno_matrix_def_default();
    double begun = gnoi_now(), prepared;
    gno_status status;
    gno_matrix *m;
    if (matrix)
        *matrix = NULL;
    if (!scene)
        return GNO_ERROR_ARGUMENT;
    if (!matrix)
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_matrix_build: matrix is NULL");
    def = def ? def : &defaults;
    gnoi_begin(scene->context, "shadow matrix");
    status = check(scene, light, def);
    if (!status)
        status = gnoi_scene_prepare(scene, def->threads);
    if (status)
        return status;
    prepared = gnoi_now();
    m = create(scene->context, scene->polygon_count);
    status = m ? build(scene, &scene->lights[light].light, def, m) : GNO_ERROR_MEMORY;
    if (status) {
        gno_matrix_destroy(m);
        return status == GNO_ERROR_MEMORY ? gnoi_fail(scene->context, status, "out of memory for the shadow matrix") : status;
    }
    m->prepare_seconds = prepared - begun;
    m->build_seconds = gnoi_now() - prepared;
    *matrix = m;
    return GNO_OK;
}

/* 0 where an offset falls, a row is out of range, or rows do not ascend; *wrong is the column then. */
static int are_columns(size_t size, const size_t *start, const unsigned *casters, size_t *wrong)
{
    for (size_t s = 0; s < size; s++) {
        *wrong = s;
        if (start[s + 1] < start[s] || start[s + 1] - start[s] > size)
            return 0;
        for (size_t i = start[s]; i < start[s + 1]; i++)
            if (casters[i] >= size || (i > start[s] && casters[i] <= casters[i - 1]))
                return 0;
    }
    return 1;
}

gno_status gno_matrix_from_columns(gno_context *context, size_t size, const size_t *start, const unsigned *casters, gno_matrix **matrix)
{
    size_t wrong = 0;
    gno_matrix *m;
    if (matrix)
        *matrix = NULL;
    if (!context)
        return GNO_ERROR_ARGUMENT;
    if (!matrix || !start || (!casters && start[size] > 0))
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_matrix_from_columns: matrix, start or casters is NULL");
    if (size > GNO_MAX_POLYGONS)
        return gnoi_fail(context, GNO_ERROR_LIMIT, "shadow matrix: %lu columns, the limit is %d", (unsigned long)size, GNO_MAX_POLYGONS);
    if (start[0] != 0 || !are_columns(size, start, casters, &wrong))
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "shadow matrix: column %lu is not a list of ascending rows", (unsigned long)wrong);
    m = create(context, size);
    if (m) {
        m->start = gnoi_malloc(context, size + 1, sizeof *m->start);
        m->caster_capacity = start[size];
        m->casters = gnoi_malloc(context, m->caster_capacity, sizeof *m->casters);
    }
    if (!m || !m->start || !m->casters) {
        gno_matrix_destroy(m);
        return gnoi_fail(context, GNO_ERROR_MEMORY, "out of memory for the shadow matrix");
    }
    memcpy(m->start, start, (size + 1) * sizeof *start);
    for (size_t i = 0; i < start[size]; i++)
        m->casters[i] = casters[i];
    *matrix = m;
    return GNO_OK;
}

void gno_matrix_destroy(gno_matrix *m)
{
    gno_context *context;
    if (!m)
        return;
    context = m->context;
    for (size_t i = 0; i < m->search_count; i++)
        gnoi_search_free(&m->searches[i]);
    gnoi_findings_free(&m->findings);
    gnoi_search_scratch_free(context, &m->scratch);
    gnoi_free(context, m->searches, m->search_capacity, sizeof *m->searches);
    gnoi_free(context, m->poly_start, m->size + 1, sizeof *m->poly_start);
    gnoi_free(context, m->polys, m->poly_capacity, sizeof *m->polys);
    gnoi_free(context, m->start, m->size + 1, sizeof *m->start);
    gnoi_free(context, m->casters, m->caster_capacity, sizeof *m->casters);
    gnoi_free(context, m->shade, m->size, sizeof *m->shade);
    gnoi_free(context, m, 1, sizeof *m);
}

/* ---- columns ------------------------------------------------------------------------------------------------------ */

size_t gno_matrix_size(const gno_matrix *matrix) { return matrix ? matrix->size : 0; }
gno_context *gno_matrix_context(const gno_matrix *matrix) { return matrix ? matrix->context : NULL; }

static int is_own(const gno_matrix_column *column)
{
    size_t low = 0, high = column->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (column->casters[middle] < column->receiver)
            low = middle + 1;
        else
            high = middle;
    }
    return low < column->count && column->casters[low] == column->receiver;
}

/* What the casters alone tell. */
static gno_shade plain_shade(const gno_matrix_column *column)
{
    return column->count == 0 ? GNO_SHADE_NONE : column->count == 1 && column->own ? GNO_SHADE_OWN : GNO_SHADE_PART;
}

/* Into m->findings, sorted. */
static gno_status find_column(gno_matrix *m, size_t receiver)
{
    gnoi_findings *f = &m->findings;
    int same = !m->scene->prepared.problems.non_planar;
    m->found = SIZE_MAX;
    m->found_shade = GNO_SHADE_NO_AREA;
    f->column_count = f->caster_count = 0;
    for (size_t k = 0; k < m->search_count; k++) {
        gno_shade of_lamp = GNO_SHADE_NO_AREA;
        size_t first = f->column_count;
        for (uint32_t i = m->poly_start[receiver]; i < m->poly_start[receiver + 1]; i++)
            if (!gnoi_search_poly(&m->searches[k], m->polys[i], &m->scratch, f))
                return gnoi_fail(m->context, GNO_ERROR_MEMORY, "out of memory for a column of the shadow matrix");
        for (size_t c = first; c < f->column_count; c++)
            of_lamp = c == first ? f->columns[c].shade : gnoi_shade_join(of_lamp, f->columns[c].shade, same);
        m->found_shade = k == 0 ? of_lamp : gnoi_shade_join(m->found_shade, of_lamp, 0);
    }
    f->caster_count = f->caster_count ? gnoi_sort_casters(f->context, f->casters, f->caster_count) : 0;
    m->found = receiver;
    return GNO_OK;
}

static gno_status get_on_demand(gno_matrix *m, size_t receiver, gno_matrix_column *column)
{
    if (m->scene->changes != m->changes)
        return gnoi_fail(m->context, GNO_ERROR_ARGUMENT, "shadow matrix: the scene has changed since the matrix was made");
    if (receiver != m->found) {
        gno_status status = find_column(m, receiver);
        if (status)
            return status;
    }
    column->count = m->findings.caster_count;
    column->casters = m->findings.casters;
    column->own = is_own(column);
    column->shade = m->found_shade;
    return GNO_OK;
}

gno_status gno_matrix_get_column(gno_matrix *m, size_t receiver, gno_matrix_column *column)
{
    if (!m)
        return GNO_ERROR_ARGUMENT;
    if (!column || receiver >= m->size)
        return gnoi_fail(m->context, GNO_ERROR_ARGUMENT, "shadow matrix: column %lu of %lu", (unsigned long)receiver, (unsigned long)m->size);
    column->receiver = receiver;
    if (!m->start)
        return get_on_demand(m, receiver, column);
    column->count = m->start[receiver + 1] - m->start[receiver];
    column->casters = m->casters + m->start[receiver];
    column->own = is_own(column);
    column->shade = m->shade ? (gno_shade)m->shade[receiver] : plain_shade(column);
    return GNO_OK;
}

int gno_matrix_next(gno_matrix *m, gno_matrix_cursor *cursor)
{
    gno_matrix_column column;
    if (!m || !cursor)
        return 0;
    for (cursor->status = GNO_OK; cursor->next_column < m->size; cursor->next_column++, cursor->next_place = 0) {
        cursor->status = gno_matrix_get_column(m, cursor->next_column, &column);
        if (cursor->status)
            return 0;
        if (cursor->next_place < column.count) {
            cursor->receiver = cursor->next_column;
            cursor->caster = column.casters[cursor->next_place++];
            return 1;
        }
    }
    return 0;
}

/* ---- counts ------------------------------------------------------------------------------------------------------- */

static size_t bytes_held(const gno_matrix *m)
{
    size_t bytes = sizeof *m;
    if (m->start)
        bytes += (m->size + 1) * sizeof *m->start + m->caster_capacity * sizeof *m->casters + (m->shade ? m->size : 0);
    for (size_t i = 0; i < m->search_count; i++)
        bytes += gnoi_packets_bytes(&m->searches[i].packets) + m->searches[i].facets.triangle_count * sizeof *m->searches[i].facets.triangles;
    return bytes;
}

gno_status gno_matrix_get_info(gno_matrix *m, gno_matrix_info *info)
{
    if (!m || !info)
        return gnoi_fail(gno_matrix_context(m), GNO_ERROR_ARGUMENT, "gno_matrix_get_info: matrix or info is NULL");
    memset(info, 0, sizeof *info);
    info->size = m->size;
    info->prepare_seconds = m->prepare_seconds;
    info->build_seconds = m->build_seconds;
    for (size_t s = 0; s < m->size; s++) {
        gno_matrix_column c;
        gno_status status = gno_matrix_get_column(m, s, &c);
        if (status)
            return status;
        info->ones += c.count;
        info->diagonal += (size_t)c.own;
        info->longest = c.count > info->longest ? c.count : info->longest;
        info->own += c.shade == GNO_SHADE_OWN;
        info->covered += c.shade == GNO_SHADE_COVERED;
        info->part += c.shade == GNO_SHADE_PART;
        info->none += c.shade == GNO_SHADE_NONE;
        info->no_area += c.shade == GNO_SHADE_NO_AREA;
    }
    info->bytes = bytes_held(m);
    return GNO_OK;
}
