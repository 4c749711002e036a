/* normals.c -- vertex normals of smooth polygons.
 *
 * Place in the data flow: last step of gnoi_scene_prepare; shading interpolates what is made here.
 * A corner takes the file's normal where it has one (and its object does not insist on averages). The others take, object
 * by object, the weighted sum of the planes of the smooth polygons around their point, those beyond the crease angle from
 * the corner's own polygon left out; points are told apart by position, for files repeat vertices along seams.
 * Where neither gives a direction the corner takes its own plane's normal.
 * Invariants: every normal that a corner names is a unit vector; sums run in the order of corners, so the result is always
 * the same bits; until a corner is settled, corner_normal holds GNOI_NONE.
 * Source: Gouraud 1971 for averages; textbook equations 8.1.9 and 8.1.10 for weights by area; Thuermer and Wuethrich 1998
 * for weights by angle.
 */
#include "scene/prepare.h"
#include "base/tolerance.h"
#include "scene/weld.h"

#include <string.h>

/* A corner at a point: what its polygon adds to the sum there. */
typedef struct entry {
    uint32_t corner, poly;
    double weight;
} entry;

typedef struct smoothing {
    gno_scene *scene;
    gnoi_prepared *out;
    const gnoi_object *object;
    size_t first, last; /* the object's polygons among the prepared ones */
    gnoi_weld points;
    uint32_t plane_of;   /* polygon whose plane's normal was stored last */
    uint32_t plane_normal;
} smoothing;

typedef struct sum {
    vec3 n;
    double weight;
} sum;

/* ---- storing normals --------------------------------------------------------------------------------------------- */

/* Room for `more` normals that are sure to come, without the excess of doubling; several objects may each add some. */
static int make_room(smoothing *s, size_t more)
{
    gnoi_prepared *out = s->out;
    size_t need = out->normal_count + more;
    float(*grown)[3];
    if (need <= out->normal_capacity || need < out->normal_capacity + out->normal_capacity / 2) {
        return 1; /* store doubles */
    }
    grown = gnoi_realloc(s->scene->context, out->normals, out->normal_capacity, need, sizeof *grown);
    if (!grown) {
        return 0;
    }
    out->normals = grown;
    out->normal_capacity = need;
    return 1;
}

static int store(smoothing *s, vec3 unit, uint32_t *index)
{
    gnoi_prepared *out = s->out;
    void *array = out->normals;
    float *n;
    if (out->normal_count >= GNOI_NONE ||
        !gnoi_reserve(s->scene->context, &array, &out->normal_capacity, out->normal_count + 1, sizeof *out->normals)) {
        return 0;
    }
    out->normals = array;
    n = out->normals[out->normal_count];
    n[0] = (float)unit.x;
    n[1] = (float)unit.y;
    n[2] = (float)unit.z;
    *index = (uint32_t)out->normal_count++;
    return 1;
}

static int store_plane(smoothing *s, size_t poly, uint32_t *index)
{
    if (s->plane_of != poly) {
        if (!store(s, v3_from(s->out->polys[poly].n), &s->plane_normal)) {
            return 0;
        }
        s->plane_of = (uint32_t)poly;
    }
    *index = s->plane_normal;
    return 1;
}

/* ---- the file's normals ------------------------------------------------------------------------------------------ */

/* Unit vector of a normal of any length; zero stays zero. */
static vec3 unit_of(const double n[3])
{
    double largest = fmax(fabs(n[0]), fmax(fabs(n[1]), fabs(n[2])));
    if (!(largest > 0)) {
        return v3(0, 0, 0);
    }
    return v3_unit(v3(n[0] / largest, n[1] / largest, n[2] / largest)); /* squares neither overflow nor vanish */
}

/* All of the scene's normals at their own indices, so that corner_normal can stay as it is. */
static int store_file_normals(smoothing *s)
{
    gnoi_prepared *out = s->out;
    size_t count = s->scene->normal_count, i;
    out->normals = gnoi_malloc(s->scene->context, count, sizeof *out->normals);
    if (!out->normals) {
        return 0;
    }
    out->normal_count = out->normal_capacity = count;
    for (i = 0; i < count; i++) {
        vec3 n = unit_of(s->scene->normals[i]);
        if (gnoi_stopped_at(s->scene->context, i)) {
            return 0;
        }
        out->normals[i][0] = (float)n.x;
        out->normals[i][1] = (float)n.y;
        out->normals[i][2] = (float)n.z;
    }
    return 1;
}

static int is_zero(const float n[3])
{
    return !(n[0] != 0 || n[1] != 0 || n[2] != 0);
}

/* Takes indices out of corners that are not smooth or to be averaged; returns whether any file normal is left in use. */
static int clear_unused(const smoothing *s)
{
    const gnoi_prepared *out = s->out;
    int used = 0;
    size_t i, k;
    for (i = 0; i < out->poly_count; i++) {
        const gnoi_poly *poly = &out->polys[i];
        uint32_t *normal = out->corner_normal + poly->corner;
        if (!gnoi_is_smooth(poly) || s->scene->objects[s->scene->polygon_object[poly->source]].average_normals) {
            memset(normal, 0xff, poly->corner_count * sizeof *normal); /* GNOI_NONE */
            continue;
        }
        for (k = 0; k < poly->corner_count; k++) {
            used |= normal[k] != GNOI_NONE;
        }
    }
    return used;
}

/* Corners whose file normal is zero take their plane's. Returns whether corners are left to average, -1 without memory or when
 * stopped. */
static int settle_file_normals(smoothing *s, size_t first, size_t last)
{
    const gnoi_prepared *out = s->out;
    int open = 0;
    size_t i, k;
    for (i = first; i < last; i++) {
        const gnoi_poly *poly = &out->polys[i];
        uint32_t *normal = out->corner_normal + poly->corner;
        for (k = 0; gnoi_is_smooth(poly) && k < poly->corner_count; k++) {
            if (normal[k] == GNOI_NONE) {
                open = 1;
            } else if (is_zero(out->normals[normal[k]]) && !store_plane(s, i, &normal[k])) {
                return -1;
            }
        }
        if (gnoi_stopped_at(s->scene->context, i)) {
            return -1;
        }
    }
    return open;
}

/* ---- weights and sums --------------------------------------------------------------------------------------------- */

static uint32_t class_at(const smoothing *s, size_t corner)
{
    return gnoi_weld_class(&s->points, s->out->corner_vertex[corner]);
}

static vec3 position_at(const smoothing *s, size_t corner)
{
    return v3_from(s->scene->positions[s->out->corner_vertex[corner]]);
}

/* Twice the area inside the outer ring. */
static double doubled_area(const smoothing *s, const gnoi_poly *poly)
{
    size_t corner, end = s->out->ring_corner[poly->ring + 1];
    vec3 first = position_at(s, poly->corner), normal = v3(0, 0, 0), before = v3(0, 0, 0);
    for (corner = (size_t)poly->corner + 1; corner < end; corner++) {
        vec3 p = v3_sub(position_at(s, corner), first);
        normal = v3_add(normal, v3_cross(before, p));
        before = p;
    }
    return v3_length(normal);
}

/* The next corner around the ring, by `step` 1 or -1, at another point; `corner` itself where there is none. */
static size_t neighbour(const smoothing *s, size_t from, size_t to, size_t corner, int step)
{
    size_t other = corner;
    do {
        if (step > 0) {
            other = other + 1 < to ? other + 1 : from;
        } else {
            other = other > from ? other - 1 : to - 1;
        }
    } while (other != corner && class_at(s, other) == class_at(s, corner));
    return other;
}

/* The polygon's angle at a corner; beyond 180 degrees at a reflex corner of the outer ring. */
static double angle_at(const smoothing *s, const gnoi_poly *poly, size_t from, size_t to, size_t corner)
{
    vec3 at = position_at(s, corner);
    vec3 after = v3_sub(position_at(s, neighbour(s, from, to, corner, 1)), at);
    vec3 before = v3_sub(position_at(s, neighbour(s, from, to, corner, -1)), at);
    vec3 cross = v3_cross(after, before);
    double angle = atan2(v3_length(cross), v3_dot(after, before));
    int reflex = from == poly->corner && v3_dot(cross, v3_from(poly->n)) < 0;
    return reflex ? 2 * acos(-1.0) - angle : angle;
}

/* Calls add for every corner of a polygon with its weight. A corner that repeats the point before it weighs nothing. */
typedef void (*add_fn)(void *user, uint32_t class, entry e);

static void add_polygon(const smoothing *s, size_t i, add_fn add, void *user)
{
    const gnoi_poly *poly = &s->out->polys[i];
    gno_weighting weighting = s->object->weighting;
    double weight;
    uint32_t ring, k = 0;
    while (k < poly->corner_count && class_at(s, poly->corner + k) >= GNOI_WELD_NOWHERE) {
        k++;
    }
    if (k == poly->corner_count) {
        return;
    }
    weight = weighting == GNO_WEIGHTING_AREA ? doubled_area(s, poly) : 1;
    for (ring = poly->ring; ring < poly->ring + poly->ring_count; ring++) {
        size_t from = s->out->ring_corner[ring], to = s->out->ring_corner[ring + 1], corner;
        uint32_t before = class_at(s, to - 1);
        for (corner = from; corner < to; corner++) {
            uint32_t class = class_at(s, corner);
            entry e;
            if (class >= GNOI_WELD_NOWHERE) {
                before = class;
                continue;
            }
            e.corner = (uint32_t)corner;
            e.poly = (uint32_t)i;
            e.weight = weighting == GNO_WEIGHTING_ANGLE ? angle_at(s, poly, from, to, corner) : weight;
            e.weight = class == before ? 0 : e.weight;
            before = class;
            add(user, class, e);
        }
    }
}

/* 0 when stopped. */
static int add_smooth(const smoothing *s, add_fn add, void *user)
{
    size_t i;
    for (i = s->first; i < s->last; i++) {
        if (gnoi_is_smooth(&s->out->polys[i])) {
            add_polygon(s, i, add, user);
        }
        if (gnoi_stopped_at(s->scene->context, i)) {
            return 0;
        }
    }
    return 1;
}

static void add_term(sum *total, const gnoi_poly *poly, double weight)
{
    total->n = v3_mad(total->n, v3_from(poly->n), weight);
    total->weight += weight;
}

static int has_cancelled(const sum *total)
{
    return !(v3_length(total->n) > GNOI_CANCELLED * total->weight);
}

/* ---- no crease: one normal a point ------------------------------------------------------------------------------- */

typedef struct summing {
    const gnoi_prepared *out;
    sum *sums;
} summing;

static void add_to_sum(void *user, uint32_t class, entry e)
{
    const summing *t = user;
    add_term(&t->sums[class], &t->out->polys[e.poly], e.weight);
}

static int settle_points(smoothing *s, const sum *sums)
{
    gnoi_prepared *out = s->out;
    uint32_t base = (uint32_t)out->normal_count, class, unused;
    size_t i, k;
    if (!make_room(s, s->points.count)) {
        return 0;
    }
    for (class = 0; class < s->points.count; class++) {
        if (!store(s, v3_unit(sums[class].n), &unused) || gnoi_stopped_at(s->scene->context, class)) {
            return 0;
        }
    }
    for (i = s->first; i < s->last; i++) {
        const gnoi_poly *poly = &out->polys[i];
        uint32_t *normal = out->corner_normal + poly->corner;
        for (k = 0; gnoi_is_smooth(poly) && k < poly->corner_count; k++) {
            if (normal[k] == GNOI_NONE) {
                class = class_at(s, poly->corner + k);
                normal[k] = base + class;
                if (has_cancelled(&sums[class]) && !store_plane(s, i, &normal[k])) {
                    return 0;
                }
            }
        }
        if (gnoi_stopped_at(s->scene->context, i)) {
            return 0;
        }
    }
    return 1;
}

static int average_all(smoothing *s)
{
    gno_context *context = s->scene->context;
    summing t;
    int good;
    t.out = s->out;
    t.sums = gnoi_calloc(context, s->points.count, sizeof *t.sums);
    if (!t.sums) {
        return 0;
    }
    good = add_smooth(s, add_to_sum, &t) && settle_points(s, t.sums);
    gnoi_free(context, t.sums, s->points.count, sizeof *t.sums);
    return good;
}

/* ---- a crease: sums per point and side --------------------------------------------------------------------------- */

#define KEPT_RESULTS 8    /* sides of a point that share one stored normal; more sides than these only cost memory */
#define MOST_PAIRED 2048  /* polygons at a point up to which every pair is looked at */
#define CELL_ROWS 16      /* of cells along an edge of the cube that parts directions beyond that */
#define CELLS (6 * CELL_ROWS * CELL_ROWS)

typedef struct listing {
    size_t *start; /* per class, and one more: where its entries begin */
    entry *entries;
} listing;

typedef struct result {
    sum total;
    uint32_t normal;
} result;

typedef struct cell {
    sum total;
    vec3 mean; /* direction of its polygons, zero without any */
    uint32_t normal;
} cell;

static void count_entry(void *user, uint32_t class, entry e)
{
    listing *l = user;
    (void)e;
    l->start[class + 1]++;
}

static void list_entry(void *user, uint32_t class, entry e)
{
    listing *l = user;
    l->entries[l->start[class]++] = e;
}

/* Entries by class. Filling moves start[class] to the class's end, which is the next one's beginning: shift back. */
static int make_listing(smoothing *s, listing *l, size_t *entry_count)
{
    gno_context *context = s->scene->context;
    size_t count = s->points.count, i;
    l->start = gnoi_calloc(context, count + 1, sizeof *l->start);
    l->entries = NULL;
    if (!l->start) {
        return 0;
    }
    if (!add_smooth(s, count_entry, l)) {
        return 0;
    }
    for (i = 0; i < count; i++) {
        l->start[i + 1] += l->start[i];
    }
    *entry_count = l->start[count];
    l->entries = gnoi_malloc(context, *entry_count, sizeof *l->entries);
    if (!l->entries) {
        return 0;
    }
    if (!add_smooth(s, list_entry, l)) {
        return 0;
    }
    memmove(l->start + 1, l->start, count * sizeof *l->start);
    l->start[0] = 0;
    return 1;
}

static double cosine_between(const smoothing *s, const entry *a, const entry *b)
{
    return v3_dot(v3_from(s->out->polys[a->poly].n), v3_from(s->out->polys[b->poly].n));
}

/* The sum over the entries within `cosine` of entry `own`. */
static sum side_of(const smoothing *s, const entry *entries, size_t count, const entry *own, double cosine)
{
    sum total = {{0, 0, 0}, 0};
    size_t i;
    for (i = 0; i < count; i++) {
        if (cosine_between(s, own, &entries[i]) >= cosine) {
            add_term(&total, &s->out->polys[entries[i].poly], entries[i].weight);
        }
    }
    return total;
}

/* Whether all planes lie within half the crease angle of the first, hence all within the crease angle of one another. */
static int is_one_side(const smoothing *s, const entry *entries, size_t count, double half_cosine)
{
    size_t i;
    for (i = 1; i < count; i++) {
        if (!(cosine_between(s, &entries[0], &entries[i]) >= half_cosine)) {
            return 0;
        }
    }
    return 1;
}

static int store_sum(smoothing *s, const sum *total, uint32_t poly, uint32_t *index)
{
    return has_cancelled(total) ? store_plane(s, poly, index) : store(s, v3_unit(total->n), index);
}

static int same_sum(const sum *a, const sum *b)
{
    return a->n.x == b->n.x && a->n.y == b->n.y && a->n.z == b->n.z && a->weight == b->weight;
}

/* Equal sets of polygons give equal sums to the last bit, for they are added in one order; these share one normal. */
static int settle_point(smoothing *s, const entry *entries, size_t count, double cosine, double half_cosine)
{
    result results[KEPT_RESULTS];
    size_t kept = 0, i, k;
    int one_side = is_one_side(s, entries, count, half_cosine);
    for (i = 0; i < count; i++) {
        uint32_t *normal = &s->out->corner_normal[entries[i].corner];
        result r;
        if (*normal != GNOI_NONE) {
            continue;
        }
        if (one_side && kept > 0) {
            *normal = results[0].normal;
            continue;
        }
        r.total = side_of(s, entries, count, &entries[i], one_side ? -2 : cosine);
        for (k = 0; k < kept && !same_sum(&results[k].total, &r.total); k++) {
        }
        if (k < kept) {
            *normal = results[k].normal;
            continue;
        }
        if (!store_sum(s, &r.total, entries[i].poly, &r.normal)) {
            return 0;
        }
        *normal = r.normal;
        if (kept < KEPT_RESULTS && !has_cancelled(&r.total)) {
            results[kept++] = r;
        }
    }
    return 1;
}

/* A point where very many polygons meet, as at the tip of a finely cut cone: pairs of polygons would take too long, so
 * those of nearly one direction, a cell of some 5 degrees, are taken together and share a normal. */
static unsigned cell_of(const double n[3])
{
    double m[3] = {fabs(n[0]), fabs(n[1]), fabs(n[2])}, u, v;
    unsigned axis = m[0] > m[1] && m[0] > m[2] ? 0 : m[1] > m[2] ? 1 : 2, face = 2 * axis + (n[axis] < 0), i, j;
    u = n[(axis + 1) % 3] / m[axis];
    v = n[(axis + 2) % 3] / m[axis];
    i = (unsigned)((u + 1) / 2 * CELL_ROWS);
    j = (unsigned)((v + 1) / 2 * CELL_ROWS);
    i = i < CELL_ROWS ? i : CELL_ROWS - 1;
    j = j < CELL_ROWS ? j : CELL_ROWS - 1;
    return (face * CELL_ROWS + i) * CELL_ROWS + j;
}

static sum side_of_cell(const cell *cells, const cell *own, double cosine)
{
    sum total = {{0, 0, 0}, 0};
    int i;
    for (i = 0; i < CELLS; i++) {
        if (cells[i].total.weight > 0 && v3_dot(own->mean, cells[i].mean) >= cosine) {
            total.n = v3_add(total.n, cells[i].total.n);
            total.weight += cells[i].total.weight;
        }
    }
    return total;
}

static int settle_cells(smoothing *s, const entry *entries, size_t count, double cosine, cell *cells)
{
    const gnoi_poly *polys = s->out->polys;
    size_t i;
    for (i = 0; i < count; i++) {
        cell *c = &cells[cell_of(polys[entries[i].poly].n)];
        add_term(&c->total, &polys[entries[i].poly], entries[i].weight);
        c->mean = v3_add(c->mean, v3_from(polys[entries[i].poly].n)); /* not zero: the directions of a cell are alike */
    }
    for (i = 0; i < CELLS; i++) {
        cells[i].mean = v3_unit(cells[i].mean);
        cells[i].normal = GNOI_NONE;
    }
    for (i = 0; i < count; i++) {
        uint32_t *normal = &s->out->corner_normal[entries[i].corner];
        cell *c = &cells[cell_of(polys[entries[i].poly].n)];
        if (*normal == GNOI_NONE && c->normal == GNOI_NONE) {
            sum total = side_of_cell(cells, c, cosine);
            if (!store_sum(s, &total, entries[i].poly, &c->normal)) {
                return 0;
            }
        }
        *normal = *normal == GNOI_NONE ? c->normal : *normal;
    }
    return 1;
}

static int settle_crowd(smoothing *s, const entry *entries, size_t count, double cosine)
{
    cell *cells = gnoi_calloc(s->scene->context, CELLS, sizeof *cells);
    int good = cells && settle_cells(s, entries, count, cosine, cells);
    gnoi_free(s->scene->context, cells, CELLS, sizeof *cells);
    return good;
}

static int average_sides(smoothing *s)
{
    gno_context *context = s->scene->context;
    double radians = s->object->crease * acos(-1.0) / 180;
    double cosine = cos(radians) - GNOI_CREASE, half_cosine = cos(radians / 2);
    listing l;
    size_t entry_count = 0, class;
    int good = make_listing(s, &l, &entry_count);
    for (class = 0; good && class < s->points.count; class++) {
        size_t from = l.start[class], count = l.start[class + 1] - from;
        int crowd = count > MOST_PAIRED && !is_one_side(s, l.entries + from, count, half_cosine);
        good = crowd ? settle_crowd(s, l.entries + from, count, cosine)
                     : settle_point(s, l.entries + from, count, cosine, half_cosine);
        good = good && !gnoi_stopped_at(context, class);
    }
    gnoi_free(context, l.entries, entry_count, sizeof *l.entries);
    gnoi_free(context, l.start, (size_t)s->points.count + 1, sizeof *l.start);
    return good;
}

/* ---- the whole ---------------------------------------------------------------------------------------------------- */

static int average_object(smoothing *s)
{
    int good = gnoi_weld_make(s->scene, s->first, s->last, &s->points);
    if (good) {
        good = s->object->crease >= 180 ? average_all(s) : average_sides(s);
    }
    gnoi_weld_free(s->scene->context, &s->points);
    return good;
}

/* Prepared polygons of one object are neighbours, as their sources are. */
static int settle_objects(smoothing *s)
{
    const gnoi_prepared *out = s->out;
    const int *object_of = s->scene->polygon_object;
    for (s->first = 0; s->first < out->poly_count; s->first = s->last) {
        int object = object_of[out->polys[s->first].source], open;
        for (s->last = s->first; s->last < out->poly_count && object_of[out->polys[s->last].source] == object; s->last++) {
        }
        open = settle_file_normals(s, s->first, s->last);
        s->object = &s->scene->objects[object];
        if (open < 0 || (open && !average_object(s))) {
            return 0;
        }
    }
    return 1;
}

gno_status gnoi_prepare_normals(gno_scene *scene)
{
    gnoi_prepared *out = &scene->prepared;
    smoothing s;
    memset(&s, 0, sizeof s);
    s.scene = scene;
    s.out = out;
    s.plane_of = GNOI_NONE;
    if ((clear_unused(&s) && !store_file_normals(&s)) || !settle_objects(&s)) {
        return gnoi_fail(scene->context, GNO_ERROR_MEMORY, "prepare: out of memory");
    }
    if (out->normal_count < out->normal_capacity && out->normal_count > 0) {
        float(*exact)[3] = gnoi_realloc(scene->context, out->normals, out->normal_capacity, out->normal_count, sizeof *exact);
        if (exact) { /* else the larger block serves as well */
            out->normals = exact;
            out->normal_capacity = out->normal_count;
        }
    }
    return GNO_OK;
}
