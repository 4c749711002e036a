/* sides.c -- see sides.h. The sum of a corner is over the polygons whose planes lie within the crease angle of its own. */
#include "scene/sides.h"
#include "base/tolerance.h"
#include "scene/scene.h"

#define KEPT_RESULTS 8    /* sides of a point that share one stored normal; more sides than these only cost memory */
#define MOST_PAIRED 2048  /* polygons at a point up to which every pair is looked at */
#define CELL_ROWS 16      /* of cells along an edge of the cube that parts directions beyond that */
#define CELLS (6 * CELL_ROWS * CELL_ROWS)

typedef struct sum {
    vec3 n;
    double weight;
} sum;

typedef struct settling {
    gno_context *context;
    const gnoi_around_entry *entries;
    size_t count;
    uint32_t mark;
    gnoi_normals *normals;
} settling;

typedef struct result {
    sum total;
    uint32_t normal;
} result;

typedef struct cell {
    sum total;
    vec3 mean; /* direction of its polygons, zero without any */
    uint32_t normal;
} cell;

/* ---- sums ------------------------------------------------------------------------------------------------------------ */

static void add_term(sum *total, const gnoi_around_entry *e)
{
    total->n = v3_mad(total->n, e->n, e->weight);
    total->weight += e->weight;
}

static int has_cancelled(const sum *total) { return !(v3_length(total->n) > GNOI_CANCELLED * total->weight); }

static int store(const settling *s, vec3 unit, uint32_t *number)
{
    gnoi_normals *out = s->normals;
    void *array = out->n;
    float *n;
    if (!gnoi_reserve(s->context, &array, &out->capacity, out->count + 1, sizeof *out->n))
        return 0;
    out->n = array;
    n = out->n[out->count];
    n[0] = (float)unit.x;
    n[1] = (float)unit.y;
    n[2] = (float)unit.z;
    *number = (uint32_t)out->count++ | s->mark;
    return 1;
}

/* The sum's direction, or `plane` where it has none. */
static int store_sum(const settling *s, const sum *total, vec3 plane, uint32_t *number)
{
    return store(s, has_cancelled(total) ? plane : v3_unit(total->n), number);
}

/* The sum over the entries within `cosine` of n. */
static sum side_of(const settling *s, vec3 n, double cosine)
{
    sum total = {{0, 0, 0}, 0};
    for (size_t i = 0; i < s->count; i++)
        if (v3_dot(n, s->entries[i].n) >= cosine)
            add_term(&total, &s->entries[i]);
    return total;
}

/* Whether all planes lie within half the crease angle of the first, hence all within the crease angle of one another. */
static int is_one_side(const settling *s, double half_cosine)
{
    for (size_t i = 1; i < s->count; i++)
        if (!(v3_dot(s->entries[0].n, s->entries[i].n) >= half_cosine))
            return 0;
    return 1;
}

/* ---- one normal for all, unless the sum cancels ------------------------------------------------------------------------- */

static int settle_together(const settling *s)
{
    sum total = side_of(s, v3(0, 0, 0), -1);
    uint32_t shared = GNOI_NONE;
    int cancelled = has_cancelled(&total);
    for (size_t i = 0; i < s->count; i++) {
        uint32_t *normal = s->entries[i].normal;
        if (*normal != GNOI_NONE)
            continue;
        if ((shared == GNOI_NONE || cancelled) && !store_sum(s, &total, s->entries[i].n, &shared))
            return 0;
        *normal = shared;
    }
    return 1;
}

/* ---- a sum for each side ------------------------------------------------------------------------------------------------- */

static int same_sum(const sum *a, const sum *b)
{
    return a->n.x == b->n.x && a->n.y == b->n.y && a->n.z == b->n.z && a->weight == b->weight;
}

/* Equal sets of polygons give equal sums to the last bit, for they are added in one order; these share one normal. */
static int settle_pairs(const settling *s, double cosine)
{
    result results[KEPT_RESULTS];
    size_t kept = 0, k;
    for (size_t i = 0; i < s->count; i++) {
        uint32_t *normal = s->entries[i].normal;
        result r;
        if (*normal != GNOI_NONE)
            continue;
        r.total = side_of(s, s->entries[i].n, cosine);
        for (k = 0; k < kept && !same_sum(&results[k].total, &r.total); k++)
            ;
        if (k < kept) {
            *normal = results[k].normal;
            continue;
        }
        if (!store_sum(s, &r.total, s->entries[i].n, &r.normal))
            return 0;
        *normal = r.normal;
        if (kept < KEPT_RESULTS && !has_cancelled(&r.total))
            results[kept++] = r;
    }
    return 1;
}

/* ---- crowds -------------------------------------------------------------------------------------------------------------- */

/* A point where very many polygons meet, as at the tip of a finely cut cone: pairs of polygons would take too long, so
 * those of nearly one direction, a cell of some 5 degrees, are taken together and share a normal. */
static unsigned cell_of(vec3 direction)
{
    const double n[3] = {direction.x, direction.y, direction.z}, m[3] = {fabs(n[0]), fabs(n[1]), fabs(n[2])};
    unsigned axis = m[0] > m[1] && m[0] > m[2] ? 0 : m[1] > m[2] ? 1 : 2, face = 2 * axis + (n[axis] < 0), i, j;
    double u = n[(axis + 1) % 3] / m[axis], v = n[(axis + 2) % 3] / m[axis];
    i = (unsigned)((u + 1) / 2 * CELL_ROWS);
    j = (unsigned)((v + 1) / 2 * CELL_ROWS);
    i = i < CELL_ROWS ? i : CELL_ROWS - 1;
    j = j < CELL_ROWS ? j : CELL_ROWS - 1;
    return (face * CELL_ROWS + i) * CELL_ROWS + j;
}

static sum side_of_cell(const cell *cells, const cell *own, double cosine)
{
    sum total = {{0, 0, 0}, 0};
    for (int i = 0; i < CELLS; i++)
        if (cells[i].total.weight > 0 && v3_dot(own->mean, cells[i].mean) >= cosine) {
            total.n = v3_add(total.n, cells[i].total.n);
            total.weight += cells[i].total.weight;
        }
    return total;
}

static int settle_cells(const settling *s, double cosine, cell *cells)
{
    for (size_t i = 0; i < s->count; i++) {
        cell *c = &cells[cell_of(s->entries[i].n)];
        add_term(&c->total, &s->entries[i]);
        c->mean = v3_add(c->mean, s->entries[i].n); /* not zero: the directions of a cell are alike */
    }
    for (int i = 0; i < CELLS; i++) {
        cells[i].mean = v3_unit(cells[i].mean);
        cells[i].normal = GNOI_NONE;
    }
    for (size_t i = 0; i < s->count; i++) {
        uint32_t *normal = s->entries[i].normal;
        cell *c = &cells[cell_of(s->entries[i].n)];
        if (*normal != GNOI_NONE)
            continue;
        if (c->normal == GNOI_NONE) {
            sum total = side_of_cell(cells, c, cosine);
            if (!store_sum(s, &total, s->entries[i].n, &c->normal))
                return 0;
        }
        *normal = c->normal;
    }
    return 1;
}

static int settle_crowd(const settling *s, double cosine)
{
    cell *cells = gnoi_calloc(s->context, CELLS, sizeof *cells);
    int good = cells && settle_cells(s, cosine, cells);
    gnoi_free(s->context, cells, CELLS, sizeof *cells);
    return good;
}

gno_status gnoi_settle_sides(gno_context *context, const gnoi_around *around, double crease, uint32_t mark, gnoi_normals *normals)
{
    const settling s = {context, around->entries, around->count, mark, normals};
    double radians = crease * acos(-1.0) / 180, cosine = cos(radians) - GNOI_CREASE;
    int good;
    if (crease >= 180 || is_one_side(&s, cos(radians / 2)))
        good = settle_together(&s);
    else
        good = s.count > MOST_PAIRED ? settle_crowd(&s, cosine) : settle_pairs(&s, cosine);
    return good ? GNO_OK : GNO_ERROR_MEMORY;
}
