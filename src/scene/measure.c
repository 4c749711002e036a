/* measure.c -- plane, area and planarity of every polygon of a scene.
 *
 * Place in the data flow: first step of gnoi_scene_prepare. Planes are not kept: emit.c measures again what is left, in the order in
 * which it is stored, which takes less time than writing and fetching them.
 * Invariants: kind p depends on source polygon p and, for the verdict on bent ones, on the scene's scale alone, so the
 * result is the same for any number of threads; a plane follows the winding of the outer ring.
 * Source: Newell's sum for the normal (Sutherland, Sproull and Schumacker 1974), taken from the ring's first corner
 * rather than the origin, so that a small polygon far out loses no digits.
 */
#include "scene/prepare.h"
#include "base/fetch.h"
#include "base/parallel.h"
#include "base/tolerance.h"

#include <string.h>

#define AHEAD 64   /* corners */
#define CHUNK 8192 /* polygons a piece: some 0.3 ms of work; a multiple of GNOI_BLOCK */

typedef struct bounds {
    double lower[3], upper[3];
} bounds;

typedef struct chunk {
    bounds box; /* of all polygons with area */
    gnoi_measures measures;
    size_t bent;
} chunk;

typedef struct measuring {
    const gno_scene *scene;
    unsigned char *kinds;
    uint32_t *blocks; /* or NULL */
    chunk *chunks;
    unsigned char *material_flags, *object_flags; /* GNOI_IS_SMOOTH, GNOI_USES_NORMALS, DECIDES */
} measuring;

#define DECIDES 32u /* the object's shading goes before the material's */

static void clear_bounds(bounds *box)
{
    int i;
    for (i = 0; i < 3; i++) {
        box->lower[i] = HUGE_VAL;
        box->upper[i] = -HUGE_VAL;
    }
}

static void add_point(bounds *box, const double p[3])
{
    int i;
    for (i = 0; i < 3; i++) {
        box->lower[i] = p[i] < box->lower[i] ? p[i] : box->lower[i];
        box->upper[i] = p[i] > box->upper[i] ? p[i] : box->upper[i];
    }
}

/* Either may be empty, that is, have its lower ends at plus infinity. */
static void add_bounds(bounds *box, const bounds *other)
{
    int i;
    for (i = 0; i < 3; i++) {
        box->lower[i] = other->lower[i] < box->lower[i] ? other->lower[i] : box->lower[i];
        box->upper[i] = other->upper[i] > box->upper[i] ? other->upper[i] : box->upper[i];
    }
}

static double largest_side(const bounds *box)
{
    double side = 0;
    int i;
    for (i = 0; i < 3; i++) {
        double s = box->upper[i] - box->lower[i];
        side = s > side ? s : side;
    }
    return side;
}

/* ---- planes ---------------------------------------------------------------------------------------------------- */

/* Twice the area is `length`. Perimeter squared is at most 3 times the sum of squared sides, which spares the roots of
 * nearly every triangle. */
static int triangle_has_area(double length, double side0, double side1, double side2)
{
    double bound = 2 * GNOI_DEGENERATE;
    double perimeter;
    if (length > bound * 3 * (side0 + side1 + side2)) {
        return 1;
    }
    perimeter = sqrt(side0) + sqrt(side1) + sqrt(side2);
    return length > bound * perimeter * perimeter;
}

static inline int triangle_is_good(const double (*positions)[3], const uint32_t vertex[3])
{
    vec3 a = v3_from(positions[vertex[0]]), b = v3_from(positions[vertex[1]]), c = v3_from(positions[vertex[2]]);
    vec3 ab = v3_sub(b, a), ac = v3_sub(c, a), bc = v3_sub(c, b);
    return triangle_has_area(v3_length(v3_cross(ab, ac)), v3_dot(ab, ab), v3_dot(ac, ac), v3_dot(bc, bc));
}

int gnoi_measure_triangle(const double (*positions)[3], const uint32_t vertex[3], gnoi_poly *poly)
{
    int good = triangle_is_good(positions, vertex);
    if (good) {
        gnoi_set_triangle(positions, vertex, poly);
    }
    return good;
}

int gnoi_measure_ring(const double (*positions)[3], const uint32_t *vertex, size_t count, gnoi_poly *poly)
{
    vec3 first = v3_from(positions[vertex[0]]), normal = v3(0, 0, 0), sum = v3(0, 0, 0), previous = v3(0, 0, 0);
    double perimeter = 0, length;
    for (size_t i = 1; i < count; i++) {
        vec3 p = v3_sub(v3_from(positions[vertex[i]]), first);
        normal = v3_add(normal, v3_cross(previous, p));
        perimeter += v3_length(v3_sub(p, previous));
        sum = v3_add(sum, p);
        previous = p;
    }
    perimeter += v3_length(previous);
    length = v3_length(normal);
    if (!(length > 2 * GNOI_DEGENERATE * perimeter * perimeter)) {
        return 0;
    }
    gnoi_set_plane(poly, normal, length, v3_mad(first, sum, 1.0 / (double)count));
    return 1;
}

/* ---- one polygon ----------------------------------------------------------------------------------------------- */

/* A scene's indices are not negative. */
static const uint32_t *corners_of(const gno_scene *scene) { return (const uint32_t *)scene->corner_vertex; }

/* The largest distance of a corner of a ring of three corners or more from the plane; adds these corners to the box. */
static double reach_of_rings(const gno_scene *scene, size_t p, const gnoi_poly *plane, bounds *box)
{
    double off = 0;
    vec3 n = v3_from(plane->n);
    for (unsigned ring = scene->polygon_start[p]; ring < scene->polygon_start[p + 1]; ring++) {
        unsigned from = scene->ring_start[ring], to = scene->ring_start[ring + 1];
        for (unsigned corner = from; corner < to && to - from >= 3; corner++) {
            const double *position = scene->positions[scene->corner_vertex[corner]];
            double distance = fabs(v3_dot(n, v3_from(position)) + plane->d);
            off = distance > off ? distance : off;
            add_point(box, position);
        }
    }
    return off;
}

/* The plane of the outer ring; 0 when it has no area. */
static int measure_outer(const gno_scene *scene, size_t p, gnoi_poly *plane)
{
    unsigned ring = scene->polygon_start[p], from = scene->ring_start[ring], count = scene->ring_start[ring + 1] - from;
    return count >= 3 && gnoi_measure_ring((const double(*)[3])scene->positions, corners_of(scene) + from, count, plane);
}

static gnoi_kind measure_any(const gno_scene *scene, size_t p, bounds *box)
{
    gnoi_poly plane;
    bounds own;
    double off;
    if (!measure_outer(scene, p, &plane)) {
        return GNOI_EMPTY;
    }
    clear_bounds(&own);
    off = reach_of_rings(scene, p, &plane, &own);
    add_bounds(box, &own);
    return off > GNOI_PLANAR * largest_side(&own) ? GNOI_BENT : GNOI_KEPT;
}

static gnoi_kind judge_triangle(const gno_scene *scene, const uint32_t *vertex, bounds *box)
{
    if (!triangle_is_good((const double(*)[3])scene->positions, vertex)) {
        return GNOI_EMPTY;
    }
    for (int i = 0; i < 3; i++) {
        add_point(box, scene->positions[vertex[i]]);
    }
    return GNOI_KEPT;
}

static unsigned shading_flags(int shading)
{
    return shading == GNO_SHADING_GOURAUD || shading == GNO_SHADING_PHONG ? GNOI_IS_SMOOTH : 0;
}

static void set_flags(const measuring *m)
{
    for (size_t i = 0; i < m->scene->material_count; i++) {
        m->material_flags[i] = (unsigned char)shading_flags((int)m->scene->materials[i].shading);
    }
    for (size_t i = 0; i < m->scene->object_count; i++) {
        const gnoi_object *o = &m->scene->objects[i];
        unsigned flags = o->shading >= 0 ? DECIDES | shading_flags(o->shading) : 0;
        m->object_flags[i] = (unsigned char)(flags | (o->average_normals ? 0 : GNOI_USES_NORMALS));
    }
}

static unsigned flags_of(const measuring *m, size_t p)
{
    unsigned object = m->object_flags[m->scene->polygon_object[p]];
    unsigned shading = object & DECIDES ? object : m->material_flags[m->scene->polygon_material[p]];
    return shading & GNOI_IS_SMOOTH ? GNOI_IS_SMOOTH | (object & GNOI_USES_NORMALS) : 0;
}

static int follows(const gno_scene *scene, unsigned from)
{
    const int *v = scene->corner_vertex + from, *n = scene->corner_normal + from;
    return v[0] == n[0] && v[1] == n[1] && v[2] == n[2];
}

static void set_blocks(const measuring *m, size_t first, size_t end)
{
    const gno_scene *scene = m->scene;
    for (size_t p = first; p < end; p += GNOI_BLOCK) {
        unsigned all = GNOI_IS_TRIANGLE;
        for (size_t i = p; i < p + GNOI_BLOCK && i < end; i++) {
            all &= m->kinds[i];
        }
        m->blocks[p / GNOI_BLOCK] = all ? scene->ring_start[scene->polygon_start[p]] : GNOI_NONE;
    }
}

static gno_status measure_chunk(void *user, int worker, size_t piece)
{
    const measuring *m = user;
    const gno_scene *scene = m->scene;
    size_t p = piece * CHUNK, end = p + CHUNK;
    chunk *c = &m->chunks[piece], sums; /* a copy of its own: no two threads write to one line of the cache */
    (void)worker;
    memset(&sums, 0, sizeof sums);
    clear_bounds(&sums.box);
    end = end < scene->polygon_count ? end : scene->polygon_count;
    for (; p < end; p++) {
        unsigned ring = scene->polygon_start[p], from = scene->ring_start[ring];
        int triangle = scene->polygon_start[p + 1] - ring == 1 && scene->ring_start[ring + 1] - from == 3;
        gnoi_kind kind = triangle ? judge_triangle(scene, corners_of(scene) + from, &sums.box) : measure_any(scene, p, &sums.box);
        unsigned flags = flags_of(m, p);
        if (from + AHEAD < scene->corner_count)
            FETCH(scene->positions[scene->corner_vertex[from + AHEAD]]);
        m->kinds[p] = (unsigned char)((unsigned)kind | flags | (triangle ? GNOI_IS_TRIANGLE : 0));
        if (triangle && (flags & GNOI_USES_NORMALS) && follows(scene, from))
            m->kinds[p] |= GNOI_FOLLOWS;
        sums.measures.empty += kind == GNOI_EMPTY;
        sums.bent += kind == GNOI_BENT;
        sums.measures.smooth |= kind != GNOI_EMPTY && (flags & GNOI_IS_SMOOTH);
        sums.measures.using_normals += kind != GNOI_EMPTY && (flags & GNOI_USES_NORMALS);
    }
    *c = sums;
    if (m->blocks) {
        set_blocks(m, piece * CHUNK, end);
    }
    return GNO_OK;
}

/* ---- the scene ------------------------------------------------------------------------------------------------- */

static void set_scale(gnoi_prepared *prepared, const bounds *box)
{
    double scale = largest_side(box); /* 0 for the empty box */
    int i;
    for (i = 0; i < 3; i++) {
        int any = box->lower[i] <= box->upper[i];
        prepared->lower[i] = any ? box->lower[i] : 0;
        prepared->upper[i] = any ? box->upper[i] : 0;
        scale = fabs(prepared->lower[i]) > scale ? fabs(prepared->lower[i]) : scale;
        scale = fabs(prepared->upper[i]) > scale ? fabs(prepared->upper[i]) : scale;
    }
    prepared->scale = scale > 0 ? scale : 1;
}

/* Bent polygons that lie in their plane by the measure of the scene are kept, the others split. */
static size_t judge_bent(const measuring *m, size_t piece, double tolerance)
{
    size_t p = piece * CHUNK, split = 0, left = m->chunks[piece].bent;
    for (; left > 0; p++) {
        if ((m->kinds[p] & GNOI_KIND_MASK) == GNOI_BENT) {
            gnoi_poly plane;
            bounds unused;
            int is_split;
            clear_bounds(&unused);
            left--;
            is_split = measure_outer(m->scene, p, &plane) && reach_of_rings(m->scene, p, &plane, &unused) > tolerance;
            m->kinds[p] = (unsigned char)((m->kinds[p] & ~GNOI_KIND_MASK) | (unsigned)(is_split ? GNOI_SPLIT : GNOI_KEPT));
            split += (size_t)is_split;
        }
    }
    return split;
}

static void add_chunks(gno_scene *scene, const measuring *m, size_t pieces, gnoi_measures *measures)
{
    bounds box;
    clear_bounds(&box);
    for (size_t i = 0; i < pieces; i++) {
        add_bounds(&box, &m->chunks[i].box);
        measures->empty += m->chunks[i].measures.empty;
        measures->using_normals += m->chunks[i].measures.using_normals;
        measures->smooth |= m->chunks[i].measures.smooth;
    }
    set_scale(&scene->prepared, &box);
    for (size_t i = 0; i < pieces; i++) {
        measures->split += judge_bent(m, i, GNOI_COPLANAR * scene->prepared.scale);
    }
}

gno_status gnoi_measure_scene(gno_scene *scene, int threads, unsigned char *kinds, uint32_t *blocks, gnoi_measures *measures)
{
    gno_context *context = scene->context;
    size_t pieces = (scene->polygon_count + CHUNK - 1) / CHUNK;
    gno_status status = GNO_OK;
    measuring m;
    memset(measures, 0, sizeof *measures);
    m.scene = scene;
    m.kinds = kinds;
    m.blocks = blocks;
    m.chunks = gnoi_malloc(context, pieces, sizeof *m.chunks);
    m.material_flags = gnoi_malloc(context, scene->material_count, 1);
    m.object_flags = gnoi_malloc(context, scene->object_count, 1);
    if (!m.chunks || !m.material_flags || !m.object_flags) {
        status = gnoi_fail(context, GNO_ERROR_MEMORY, "prepare: out of memory");
    } else {
        set_flags(&m);
        status = gnoi_parallel(context, threads, pieces, "prepare", measure_chunk, &m);
    }
    if (status == GNO_OK) {
        add_chunks(scene, &m, pieces, measures);
    }
    gnoi_free(context, m.chunks, pieces, sizeof *m.chunks);
    gnoi_free(context, m.material_flags, scene->material_count, 1);
    gnoi_free(context, m.object_flags, scene->object_count, 1);
    return status;
}

double gnoi_plane_tolerance(const gnoi_prepared *prep, const double (*positions)[3], const gnoi_poly *poly)
{
    double reach = 0, far_away = 0;
    for (uint32_t i = poly->corner; i < poly->corner + poly->corner_count; i++) {
        const double *p = positions[prep->corner_vertex[i]];
        for (int k = 0; k < 3; k++) {
            double r = fabs(p[k] - 0.5 * (prep->lower[k] + prep->upper[k]));
            reach = r > reach ? r : reach;
            far_away = fabs(p[k]) > far_away ? fabs(p[k]) : far_away;
        }
    }
    return GNOI_COPLANAR * reach + GNOI_COORDINATE_NOISE * far_away;
}
