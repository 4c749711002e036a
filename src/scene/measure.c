/* measure.c -- plane, area and planarity of every polygon of a scene.
 *
 * Place in the data flow: first step of gnoi_scene_prepare; its records become the prepared polygons.
 * Invariants: record p depends on source polygon p and, for the verdict on bent ones, on the scene's scale alone, so the
 * result is the same for any number of threads; a plane follows the winding of the outer ring.
 * Source: Newell's sum for the normal (Sutherland, Sproull and Schumacker 1974), taken from the ring's first corner
 * rather than the origin, so that a small polygon far out loses no digits.
 */
#include "scene/prepare.h"
#include "base/parallel.h"
#include "base/tolerance.h"

#include <string.h>

#define CHUNK 8192 /* polygons a piece: some 0.3 ms of work */

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
    gnoi_poly *polys;
    unsigned char *kinds;
    chunk *chunks;
} measuring;

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

static void set_plane(gnoi_poly *poly, vec3 normal, double length, vec3 through)
{
    vec3 n = v3_scale(normal, 1 / length);
    poly->n[0] = n.x;
    poly->n[1] = n.y;
    poly->n[2] = n.z;
    poly->d = -v3_dot(n, through);
}

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

/* Apart from the function that other files call, so that the loop over a scene's triangles takes it in line. */
static inline int measure_triangle(const double (*positions)[3], const uint32_t vertex[3], gnoi_poly *poly)
{
    vec3 a = v3_from(positions[vertex[0]]), b = v3_from(positions[vertex[1]]), c = v3_from(positions[vertex[2]]);
    vec3 ab = v3_sub(b, a), ac = v3_sub(c, a), bc = v3_sub(c, b);
    vec3 normal = v3_cross(ab, ac);
    double length = v3_length(normal);
    if (!triangle_has_area(length, v3_dot(ab, ab), v3_dot(ac, ac), v3_dot(bc, bc))) {
        return 0;
    }
    set_plane(poly, normal, length, v3_scale(v3_add(a, v3_add(b, c)), 1.0 / 3));
    return 1;
}

int gnoi_measure_triangle(const double (*positions)[3], const uint32_t vertex[3], gnoi_poly *poly)
{
    return measure_triangle(positions, vertex, poly);
}

static int measure_ring(const double (*positions)[3], const int *vertex, unsigned count, gnoi_poly *poly)
{
    vec3 first = v3_from(positions[vertex[0]]), normal = v3(0, 0, 0), sum = v3(0, 0, 0), previous = v3(0, 0, 0);
    double perimeter = 0, length;
    unsigned i;
    for (i = 1; i < count; i++) {
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
    set_plane(poly, normal, length, v3_mad(first, sum, 1.0 / count));
    return 1;
}

/* Counts rings of three corners or more and their corners into poly, their bounds into box; returns the largest distance
 * of a corner from the plane. */
static double measure_rings(const gno_scene *scene, size_t p, gnoi_poly *poly, bounds *box)
{
    unsigned ring, corner, rings = 0, corners = 0;
    double off = 0;
    vec3 n = v3_from(poly->n);
    for (ring = scene->polygon_start[p]; ring < scene->polygon_start[p + 1]; ring++) {
        unsigned from = scene->ring_start[ring], to = scene->ring_start[ring + 1];
        if (to - from < 3) {
            continue;
        }
        rings++;
        corners += to - from;
        for (corner = from; corner < to; corner++) {
            const double *position = scene->positions[scene->corner_vertex[corner]];
            double distance = fabs(v3_dot(n, v3_from(position)) + poly->d);
            off = distance > off ? distance : off;
            add_point(box, position);
        }
    }
    poly->ring_count = rings & 0xffffffu;
    poly->corner_count = corners;
    return off;
}

/* ---- one polygon ----------------------------------------------------------------------------------------------- */

static void set_attributes(const gno_scene *scene, size_t p, gnoi_poly *poly)
{
    int number = scene->polygon_material[p];
    const gno_material *material = &scene->materials[number];
    const gnoi_object *object = &scene->objects[scene->polygon_object[p]];
    const double *t = material->transmission;
    unsigned shading = object->shading >= 0 ? (unsigned)object->shading : (unsigned)material->shading;
    memset(poly, 0, sizeof *poly); /* its padding too: the same scene gives the same bytes */
    poly->ring = scene->polygon_start[p];
    poly->corner = scene->ring_start[poly->ring];
    poly->triangle = GNOI_NONE;
    poly->source = (uint32_t)p;
    poly->shading = shading & 15u;
    poly->two_sided = material->two_sided != 0;
    poly->opaque = t[0] == 0 && t[1] == 0 && t[2] == 0 && !gnoi_has_holes(scene, material);
    poly->material = (uint16_t)number;
    poly->priority = (int16_t)object->priority;
}

static gnoi_kind measure_any(const gno_scene *scene, size_t p, gnoi_poly *poly, bounds *box, size_t *dropped)
{
    const double(*positions)[3] = (const double(*)[3])scene->positions;
    unsigned rings = scene->polygon_start[p + 1] - poly->ring;
    unsigned count = scene->ring_start[poly->ring + 1] - poly->corner;
    bounds own;
    double off;
    poly->ring_count = 1;
    poly->corner_count = count;
    if (count < 3 || !measure_ring(positions, scene->corner_vertex + poly->corner, count, poly)) {
        return GNOI_EMPTY;
    }
    clear_bounds(&own);
    off = measure_rings(scene, p, poly, &own);
    add_bounds(box, &own);
    *dropped += rings - poly->ring_count;
    return off > GNOI_PLANAR * largest_side(&own) ? GNOI_BENT : GNOI_KEPT;
}

static gnoi_kind measure_polygon(const gno_scene *scene, size_t p, gnoi_poly *poly, bounds *box, size_t *dropped)
{
    const double(*positions)[3] = (const double(*)[3])scene->positions;
    const int *vertex;
    uint32_t v[3];
    int i;
    set_attributes(scene, p, poly);
    if (scene->polygon_start[p + 1] - poly->ring != 1 || scene->ring_start[poly->ring + 1] - poly->corner != 3) {
        return measure_any(scene, p, poly, box, dropped);
    }
    vertex = scene->corner_vertex + poly->corner;
    for (i = 0; i < 3; i++) {
        v[i] = (uint32_t)vertex[i];
    }
    poly->ring_count = 1;
    poly->corner_count = 3;
    if (!measure_triangle(positions, v, poly)) {
        return GNOI_EMPTY;
    }
    for (i = 0; i < 3; i++) {
        add_point(box, positions[v[i]]);
    }
    return GNOI_KEPT;
}

static gno_status measure_chunk(void *user, int worker, size_t piece)
{
    const measuring *m = user;
    size_t p = piece * CHUNK, end = p + CHUNK;
    chunk *c = &m->chunks[piece];
    (void)worker;
    memset(c, 0, sizeof *c);
    clear_bounds(&c->box);
    end = end < m->scene->polygon_count ? end : m->scene->polygon_count;
    for (; p < end; p++) {
        gnoi_poly *poly = &m->polys[p];
        gnoi_kind kind = measure_polygon(m->scene, p, poly, &c->box, &c->measures.dropped);
        m->kinds[p] = (unsigned char)kind;
        c->measures.empty += kind == GNOI_EMPTY;
        c->bent += kind == GNOI_BENT;
        c->measures.smooth |= kind != GNOI_EMPTY && gnoi_is_smooth(poly);
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
        if (m->kinds[p] == GNOI_BENT) {
            bounds unused;
            clear_bounds(&unused);
            left--;
            m->kinds[p] = GNOI_KEPT;
            if (measure_rings(m->scene, p, &m->polys[p], &unused) > tolerance) {
                m->kinds[p] = GNOI_SPLIT;
                split++;
            }
        }
    }
    return split;
}

gno_status gnoi_measure_scene(gno_scene *scene, int threads, gnoi_poly *polys, unsigned char *kinds, gnoi_measures *measures)
{
    size_t pieces = (scene->polygon_count + CHUNK - 1) / CHUNK, i;
    measuring m;
    bounds box;
    gno_status status;
    memset(measures, 0, sizeof *measures);
    m.scene = scene;
    m.polys = polys;
    m.kinds = kinds;
    m.chunks = gnoi_malloc(scene->context, pieces, sizeof *m.chunks);
    if (!m.chunks) {
        return gnoi_fail(scene->context, GNO_ERROR_MEMORY, "prepare: out of memory");
    }
    status = gnoi_parallel(scene->context, threads, pieces, "prepare", measure_chunk, &m);
    if (status == GNO_OK) {
        clear_bounds(&box);
        for (i = 0; i < pieces; i++) {
            add_bounds(&box, &m.chunks[i].box);
            measures->empty += m.chunks[i].measures.empty;
            measures->dropped += m.chunks[i].measures.dropped;
            measures->smooth |= m.chunks[i].measures.smooth;
        }
        set_scale(&scene->prepared, &box);
        for (i = 0; i < pieces; i++) {
            measures->split += judge_bent(&m, i, GNOI_COPLANAR * scene->prepared.scale);
        }
    }
    gnoi_free(scene->context, m.chunks, pieces, sizeof *m.chunks);
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
