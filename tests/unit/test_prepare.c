/* test_prepare.c -- preparing a scene: planes, skipped and split polygons, triangulation, vertex normals.
 *
 * Triangulations are judged by area: in the plane, triangles of the polygon's own turn whose areas add up to the polygon's
 * and of which none is turned the other way cover it once.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "fail_alloc.h"
#include "scene/prepare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846
#define MOST 12000 /* corners of a test polygon */

typedef struct bed {
    gno_context *context;
    gno_scene *scene;
    int warnings;
    char warning[1024];
} bed;

static void keep_warning(void *user, gno_log_level level, const char *text)
{
    bed *b = user;
    (void)level;
    b->warnings++;
    snprintf(b->warning, sizeof b->warning, "%s", text);
}

static int set_up(void **state)
{
    bed *b = calloc(1, sizeof *b);
    gno_context_def def = gno_context_def_default();
    if (!b) {
        return 1;
    }
    def.log = keep_warning;
    def.log_user = b;
    *state = b;
    return gno_context_create(&def, &b->context) != GNO_OK || gno_scene_create(b->context, &b->scene) != GNO_OK;
}

static int tear_down(void **state)
{
    bed *b = *state;
    gno_scene_destroy(b->scene);
    if (gno_context_memory(b->context, NULL) > 4096) { /* what is left is the context itself */
        return 1;
    }
    gno_context_destroy(b->context);
    free(b);
    return 0;
}

static uint64_t random_bits(uint64_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return *seed;
}

static double random_unit(uint64_t *seed)
{
    return (double)(random_bits(seed) >> 11) / 9007199254740992.0;
}

/* ---- scenes to prepare ------------------------------------------------------------------------------------------- */

/* Adds one polygon of the rings given by sizes (0 ends them), its corners in order. */
static void add_polygon(bed *b, const double *positions, const unsigned *sizes, int shading)
{
    static int corners[MOST];
    static unsigned rings[MOST], polygons[2];
    gno_mesh_def mesh = gno_mesh_def_default();
    unsigned i, count = 0;
    for (i = 0; sizes[i] > 0; i++) {
        rings[i] = count;
        count += sizes[i];
    }
    rings[i] = count;
    polygons[0] = 0;
    polygons[1] = i;
    mesh.ring_count = i;
    for (i = 0; i < count; i++) {
        corners[i] = (int)i;
    }
    mesh.vertex_count = mesh.corner_count = count;
    mesh.positions = positions;
    mesh.polygon_count = 1;
    mesh.polygon_start = polygons;
    mesh.ring_start = rings;
    mesh.corner_vertex = corners;
    mesh.shading = shading;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
}

static const gnoi_prepared *prepare(bed *b, size_t degenerate, size_t non_planar)
{
    gno_scene_problems problems = {99, 99, 99};
    assert_int_equal(gno_scene_prepare(b->scene, 1, &problems), GNO_OK);
    assert_int_equal(problems.degenerate, degenerate);
    assert_int_equal(problems.non_planar, non_planar);
    return &b->scene->prepared;
}

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance)) {
        fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
    }
}

/* What every prepared scene promises. */
static void check_invariants(const gno_scene *scene)
{
    const gnoi_prepared *p = &scene->prepared;
    size_t i, k;
    assert_true(sizeof(gnoi_poly) == 64);
    assert_int_equal(p->ring_corner[p->ring_count], p->corner_count);
    for (i = 0; i < p->poly_count; i++) {
        const gnoi_poly *poly = &p->polys[i];
        assert_near(v3_length(v3_from(poly->n)), 1, 1e-12);
        assert_true(poly->ring + poly->ring_count <= p->ring_count);
        assert_int_equal(poly->corner, p->ring_corner[poly->ring]);
        assert_int_equal(poly->corner_count, p->ring_corner[poly->ring + poly->ring_count] - poly->corner);
        assert_true(poly->source < scene->polygon_count);
        assert_int_equal(poly->triangle == GNOI_NONE, !(gnoi_is_smooth(poly) && poly->corner_count > 3));
        for (k = poly->corner; k < (size_t)poly->corner + poly->corner_count; k++) {
            assert_true(p->corner_vertex[k] < p->vertex_count);
            if (p->corner_normal && gnoi_is_smooth(poly)) {
                const float *n = p->normals[p->corner_normal[k]];
                assert_true(p->corner_normal[k] < p->normal_count);
                assert_near(sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]), 1, 1e-6);
            } else if (p->corner_normal) {
                assert_int_equal(p->corner_normal[k], GNOI_NONE);
            }
        }
    }
}

/* ---- planes ------------------------------------------------------------------------------------------------------ */

static void test_concave_plane(void **state)
{
    /* An arrow whose first corner is the reflex one: a cross product there points down. */
    static const double arrow[12] = {1, 0, 5, 0, 2, 5, 0, -2, 5, 4, 0, 5};
    static const unsigned sizes[2] = {4, 0};
    double back[12];
    const gnoi_prepared *p;
    int i;
    for (i = 0; i < 4; i++) {
        memcpy(back + 3 * i, arrow + 3 * (3 - i), 3 * sizeof *back);
    }
    add_polygon(*state, arrow, sizes, 0);
    add_polygon(*state, back, sizes, 0);
    p = prepare(*state, 0, 0);
    check_invariants(((bed *)*state)->scene);
    assert_true(p->polys[0].n[2] == 1 && p->polys[0].d == -5);
    assert_true(p->polys[1].n[2] == -1 && p->polys[1].d == 5);
    assert_null(p->corner_normal);
    assert_null(p->normals);
    assert_int_equal(p->triangle_count, 0);
    assert_true(p->upper[0] == 4 && p->lower[2] == 5 && p->scale == 5);
}

static void test_far_from_origin(void **state)
{
    static const double far_square[12] = {1e9, 1e9, 1e9, 1e9 + 1, 1e9, 1e9, 1e9 + 1, 1e9 + 1, 1e9, 1e9, 1e9 + 1, 1e9};
    static const unsigned sizes[2] = {4, 0};
    const gnoi_prepared *p;
    add_polygon(*state, far_square, sizes, 0);
    p = prepare(*state, 0, 0);
    assert_true(p->polys[0].n[0] == 0 && p->polys[0].n[1] == 0 && p->polys[0].n[2] == 1 && p->polys[0].d == -1e9);
}

static void test_attributes(void **state)
{
    static const double triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const unsigned sizes[2] = {3, 0};
    bed *b = *state;
    gno_material m = gno_material_default();
    const gnoi_prepared *p;
    m.transmission[1] = 0.5;
    m.two_sided = 0;
    m.shading = GNO_SHADING_CONSTANT;
    assert_int_equal(gno_scene_add_material(b->scene, &m, NULL), GNO_OK);
    add_polygon(b, triangle, sizes, -1);
    add_polygon(b, triangle, sizes, GNO_SHADING_PHONG);
    b->scene->polygon_material[1] = 1;
    b->scene->objects[1].priority = -7;
    p = prepare(b, 0, 0);
    assert_int_equal(p->polys[0].opaque, 1);
    assert_int_equal(p->polys[0].two_sided, 1);
    assert_int_equal(p->polys[0].shading, GNO_SHADING_FLAT);
    assert_int_equal(p->polys[1].opaque, 0);
    assert_int_equal(p->polys[1].two_sided, 0);
    assert_int_equal(p->polys[1].material, 1);
    assert_int_equal(p->polys[1].shading, GNO_SHADING_PHONG);
    assert_int_equal(p->polys[1].priority, -7);
    check_invariants(b->scene);
}

/* ---- polygons that are skipped or split --------------------------------------------------------------------------- */

static void test_degenerate(void **state)
{
    static const double line[9] = {0, 0, 0, 1, 1, 1, 2, 2, 2};
    static const double point[12] = {3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3};
    static const double bow_tie[12] = {0, 0, 0, 1, 1, 0, 1, 0, 0, 0, 1, 0};
    static const double good[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const unsigned two[2] = {2, 0}, three[2] = {3, 0}, four[2] = {4, 0};
    bed *b = *state;
    const gnoi_prepared *p;
    add_polygon(b, line, three, 0);
    add_polygon(b, good, three, 0);
    add_polygon(b, good, two, 0);
    add_polygon(b, point, four, GNO_SHADING_PHONG); /* smooth, but not there: no normals are made */
    add_polygon(b, bow_tie, four, 0);
    add_polygon(b, good, three, 0);
    p = prepare(b, 4, 0);
    check_invariants(b->scene);
    assert_int_equal(p->poly_count, 2);
    assert_int_equal(p->polys[0].source, 1);
    assert_int_equal(p->polys[1].source, 5);
    assert_int_equal(p->corner_count, 6);
    assert_null(p->corner_normal);
    assert_true(p->upper[0] == 1 && p->upper[2] == 0); /* bounds are those of what is left */
    assert_int_equal(b->warnings, 1);
    assert_string_equal(b->warning, "4 of 6 polygons have no area and are skipped");
    prepare(b, 4, 0);
    assert_int_equal(b->warnings, 1); /* prepared already */
}

static void test_short_rings(void **state)
{
    /* A square; a hole of two corners, dropped; a hole of four, one of them repeated, kept. */
    static const double rings[30] = {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 1, 1, 0, 2, 1, 0,
                                     2, 2, 0, 2, 2, 0, 3, 2, 0, 3, 3, 0};
    static const unsigned sizes[4] = {4, 2, 4, 0};
    const gnoi_prepared *p;
    bed *b = *state;
    add_polygon(b, rings, sizes, GNO_SHADING_GOURAUD);
    p = prepare(b, 0, 0);
    check_invariants(b->scene);
    assert_int_equal(p->polys[0].ring_count, 2);
    assert_int_equal(p->polys[0].corner_count, 8);
    assert_memory_equal(p->positions[p->corner_vertex[4]], rings + 18, 3 * sizeof *rings);
    assert_int_equal(p->triangle_count, 8);
    assert_int_equal(b->warnings, 0);
}

static void test_non_planar(void **state)
{
    static const double saddle[12] = {0, 0, 0, 1, 0, 0.5, 1, 1, 0, 0, 1, 0.5};
    static const double flat[12] = {0, 0, 0, 1, 0, 1e-9, 1, 1, 0, 0, 1, 0};
    static const double lid[24] = {0, 0, 0, 4, 0, 0.3, 4, 4, 0, 0, 4, 0, 1, 1, 0, 1, 2, 0, 2, 2, 0, 2, 1, 0};
    static const unsigned four[2] = {4, 0}, holed[3] = {4, 4, 0};
    bed *b = *state;
    const gnoi_prepared *p;
    size_t i;
    add_polygon(b, saddle, four, GNO_SHADING_PHONG);
    add_polygon(b, flat, four, 0);
    add_polygon(b, lid, holed, 0);
    p = prepare(b, 0, 2);
    check_invariants(b->scene);
    assert_int_equal(p->poly_count, 2 + 1 + 8);
    for (i = 0; i < p->poly_count; i++) {
        assert_int_equal(p->polys[i].source, i < 2 ? 0 : i == 2 ? 1 : 2);
        assert_int_equal(p->polys[i].corner_count, i == 2 ? 4 : 3);
        assert_true(p->polys[i].n[2] > 0); /* triangles follow the outer ring */
    }
    assert_int_equal(b->warnings, 1);
    assert_string_equal(b->warning, "2 of 3 polygons are not planar and are split into triangles");
}

/* Small polygons that are bent by their own measure but not by the scene's. */
static void test_planar_by_scale(void **state)
{
    static const double bent[12] = {0, 0, 0, 1, 0, 0.01, 1, 1, 0, 0, 1, 0.01};
    static const double large[9] = {0, 0, 0, 1e6, 0, 0, 0, 1e6, 0};
    static const unsigned three[2] = {3, 0}, four[2] = {4, 0};
    bed *b = *state;
    add_polygon(b, bent, four, 0);
    prepare(b, 0, 1);
    add_polygon(b, large, three, 0); /* a change: all is prepared anew */
    assert_int_equal(b->scene->prepared.valid, 0);
    prepare(b, 0, 0);
}

/* ---- triangulation ----------------------------------------------------------------------------------------------- */

static double ring_area(const double *p, unsigned count)
{
    double area = 0;
    unsigned i;
    for (i = 0; i < count; i++) {
        const double *q = p + 3 * ((i + 1) % count);
        area += p[3 * i] * q[1] - p[3 * i + 1] * q[0];
    }
    return area / 2;
}

/* Triangulates rings in the plane z = 0; returns the sum of areas, and of the areas of triangles turned the wrong way. */
static double triangulated_area(gno_context *context, const double *positions, const unsigned *sizes, double *wrong)
{
    static uint32_t corner_vertex[MOST], rings[MOST], triangles[2 * MOST][3];
    const double normal[3] = {0, 0, 1};
    uint32_t count = 0, i, ring_count, expected;
    double area = 0;
    for (ring_count = 0; sizes[ring_count] > 0; ring_count++) {
        rings[ring_count] = count;
        count += sizes[ring_count];
    }
    rings[ring_count] = count;
    for (i = 0; i < count; i++) {
        corner_vertex[i] = i;
    }
    expected = count + 2 * (ring_count - 1) - 2;
    memset(triangles, 0xff, sizeof triangles);
    assert_int_equal(gnoi_triangulate(context, (const double(*)[3])positions, corner_vertex, rings, ring_count, normal, triangles),
                     GNO_OK);
    assert_int_equal(triangles[expected][0], GNOI_NONE); /* no more than promised */
    *wrong = 0;
    for (i = 0; i < expected; i++) {
        double corners[9], a;
        int k;
        for (k = 0; k < 3; k++) {
            assert_true(triangles[i][k] < count);
            memcpy(corners + 3 * k, positions + 3 * triangles[i][k], 3 * sizeof *corners);
        }
        a = ring_area(corners, 3);
        area += a;
        *wrong += a < 0 ? -a : 0;
    }
    return area;
}

static void check_simple(gno_context *context, const double *positions, const unsigned *sizes)
{
    double area = 0, wrong, found;
    unsigned i, from = 0;
    for (i = 0; sizes[i] > 0; i++) {
        double a = fabs(ring_area(positions + 3 * from, sizes[i]));
        area += i == 0 ? a : -a;
        from += sizes[i];
    }
    found = triangulated_area(context, positions, sizes, &wrong);
    assert_near(found, area, 1e-9 * (1 + area));
    assert_near(wrong, 0, 1e-9 * (1 + area));
}

/* A ring that turns once around (x,y), radii in [least,most]; counter-clockwise or not. */
static void star(double *out, unsigned count, double x, double y, double least, double most, int turn, uint64_t *seed)
{
    unsigned i;
    for (i = 0; i < count; i++) {
        double angle = turn * 2 * PI * (i + 0.8 * random_unit(seed)) / count;
        double radius = least + (most - least) * random_unit(seed);
        out[3 * i] = x + radius * cos(angle);
        out[3 * i + 1] = y + radius * sin(angle);
        out[3 * i + 2] = 0;
    }
}

static void test_stars_with_holes(void **state)
{
    static double positions[3 * MOST];
    uint64_t seed = 12345;
    bed *b = *state;
    int round;
    for (round = 0; round < 2000; round++) {
        unsigned sizes[18], holes = (unsigned)(random_bits(&seed) % 17), i, at;
        at = sizes[0] = 5 + (unsigned)(random_bits(&seed) % 60);
        star(positions, at, 0, 0, 10, 20, 1, &seed); /* with five corners the edges stay beyond 10 cos 65 > 4 */
        for (i = 1; i <= holes; i++) {               /* on a grid of 4 x 4 cells within 2.8 of the middle */
            double x = -1.5 + (i - 1) % 4, y = -1.5 + (i - 1) / 4;
            sizes[i] = 3 + (unsigned)(random_bits(&seed) % 12);
            star(positions + 3 * at, sizes[i], x, y, 0.05, 0.45, random_bits(&seed) % 2 ? 1 : -1, &seed);
            at += sizes[i];
        }
        sizes[i] = 0;
        check_simple(b->context, positions, sizes);
    }
}

static void test_grid_shapes(void **state)
{
    /* Straight corners, holes in one row of equal heights, holes that touch each other and the outer ring. */
    static const double straight[24] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 2, 1, 0, 2, 2, 0, 1, 2, 0, 0, 2, 0, 0, 1, 0};
    static const double row[48] = {0, 0, 0, 9, 0, 0, 9, 3, 0, 0, 3, 0, 1, 1, 0, 2, 1, 0, 2, 2, 0, 1, 2, 0,
                                   3, 1, 0, 4, 1, 0, 4, 2, 0, 3, 2, 0, 5, 1, 0, 6, 1, 0, 6, 2, 0, 5, 2, 0};
    static const double touching[36] = {0, 0, 0, 9, 0, 0, 9, 9, 0, 0, 9, 0, 1, 1, 0, 2, 1, 0,
                                        2, 2, 0, 1, 2, 0, 2, 2, 0, 3, 2, 0, 3, 3, 0, 2, 3, 0};
    static const double at_corner[21] = {0, 0, 0, 9, 0, 0, 9, 9, 0, 0, 9, 0, 0, 0, 0, 2, 1, 0, 1, 2, 0};
    static const double on_edge[21] = {0, 0, 0, 9, 0, 0, 9, 9, 0, 0, 9, 0, 0, 4, 0, 2, 3, 0, 2, 5, 0};
    static const unsigned eight[2] = {8, 0}, rows[5] = {4, 4, 4, 4, 0}, two[4] = {4, 4, 4, 0}, corner[3] = {4, 3, 0};
    bed *b = *state;
    check_simple(b->context, straight, eight);
    check_simple(b->context, row, rows);
    check_simple(b->context, touching, two);
    check_simple(b->context, at_corner, corner);
    check_simple(b->context, on_edge, corner);
}

/* A comb of many teeth and a spiral: long chains of reflex corners. */
static void test_comb_and_spiral(void **state)
{
    static double positions[3 * MOST];
    unsigned sizes[2] = {2002, 0}, i;
    bed *b = *state;
    for (i = 0; i < 2000; i++) {
        positions[3 * i] = 2000 - (double)i;
        positions[3 * i + 1] = i % 2 ? 10 : 1;
        positions[3 * i + 2] = 0;
    }
    memcpy(positions + 6000, (const double[6]){1, 0, 0, 2000, 0, 0}, 6 * sizeof *positions);
    check_simple(b->context, positions, sizes);
    sizes[0] = 3000;
    for (i = 0; i < 3000; i++) {
        unsigned k = i < 1500 ? i : 2999 - i;
        double angle = 0.05 * k, radius = (i < 1500 ? 2.0 : 1.0) + angle;
        positions[3 * i] = radius * cos(angle);
        positions[3 * i + 1] = radius * sin(angle);
    }
    check_simple(b->context, positions, sizes);
}

/* Rings that cross themselves, double back and repeat: no promise but the count, the range, and an end in good time. */
static void test_broken_rings(void **state)
{
    static double positions[3 * MOST];
    uint64_t seed = 99;
    bed *b = *state;
    double wrong;
    int round;
    for (round = 0; round < 500; round++) {
        unsigned sizes[5], rings = 1 + (unsigned)(random_bits(&seed) % 4), i, count = 0;
        for (i = 0; i < rings; i++) {
            sizes[i] = 3 + (unsigned)(random_bits(&seed) % 40);
            count += sizes[i];
        }
        sizes[rings] = 0;
        for (i = 0; i < 3 * count; i++) { /* few places, so that corners coincide */
            positions[i] = i % 3 == 2 ? 0 : (double)(random_bits(&seed) % 6);
        }
        triangulated_area(b->context, positions, sizes, &wrong);
    }
    for (round = 0; round < 2; round++) {
        unsigned sizes[2] = {10000, 0}, i;
        for (i = 0; i < 30000; i++) {
            positions[i] = i % 3 == 2 ? 0 : round == 0 ? random_unit(&seed) : (double)(random_bits(&seed) % 4);
        }
        triangulated_area(b->context, positions, sizes, &wrong);
    }
}

/* The same square seen along each axis from both sides: triangles turn as the polygon does. */
static void test_axes(void **state)
{
    static const double plane[10] = {0, 0, 3, 0, 3, 3, 1, 2, 0, 3}; /* five corners, one reflex */
    bed *b = *state;
    int axis, side, i;
    for (axis = 0; axis < 3; axis++) {
        for (side = 0; side < 2; side++) {
            double positions[15] = {0}, area = 0;
            uint32_t vertex[5] = {0, 1, 2, 3, 4}, rings[2] = {0, 5}, t[3][3];
            double normal[3] = {0, 0, 0};
            vec3 n;
            normal[axis] = side ? -1 : 1;
            n = v3_from(normal);
            for (i = 0; i < 5; i++) {
                int from = side ? 4 - i : i;
                positions[3 * i + (axis + 1) % 3] = plane[2 * from];
                positions[3 * i + (axis + 2) % 3] = plane[2 * from + 1];
            }
            assert_int_equal(gnoi_triangulate(b->context, (const double(*)[3])positions, vertex, rings, 1, normal, t), GNO_OK);
            for (i = 0; i < 3; i++) {
                vec3 p = v3_from(positions + 3 * t[i][0]), q = v3_from(positions + 3 * t[i][1]);
                vec3 r = v3_from(positions + 3 * t[i][2]);
                double a = v3_dot(n, v3_cross(v3_sub(q, p), v3_sub(r, p))) / 2;
                assert_true(a > 0);
                area += a;
            }
            assert_near(area, 7.5, 1e-12);
        }
    }
}

/* ---- vertex normals ---------------------------------------------------------------------------------------------- */

static const double cube_positions[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
static const int cube_corners[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
static const unsigned cube_rings[7] = {0, 4, 8, 12, 16, 20, 24};

static gno_mesh_def cube(double crease, gno_weighting weighting)
{
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = 8;
    mesh.positions = cube_positions;
    mesh.polygon_count = mesh.ring_count = 6;
    mesh.ring_start = cube_rings;
    mesh.corner_count = 24;
    mesh.corner_vertex = cube_corners;
    mesh.shading = GNO_SHADING_PHONG;
    mesh.crease = crease;
    mesh.weighting = weighting;
    return mesh;
}

static vec3 normal_at(const gnoi_prepared *p, size_t corner)
{
    const float *n = p->normals[p->corner_normal[corner]];
    return v3((double)n[0], (double)n[1], (double)n[2]);
}

static void test_cube_creases(void **state)
{
    static const double creases[4] = {40, 89.9, 90, 180};
    bed *b = *state;
    int k, weighting;
    size_t i, c;
    for (weighting = 0; weighting < 3; weighting++) {
        for (k = 0; k < 4; k++) {
            gno_mesh_def mesh = cube(creases[k], (gno_weighting)weighting);
            const gnoi_prepared *p;
            gno_scene_destroy(b->scene);
            assert_int_equal(gno_scene_create(b->context, &b->scene), GNO_OK);
            assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
            p = prepare(b, 0, 0);
            check_invariants(b->scene);
            assert_int_equal(p->normal_count, k < 2 ? 24 : 8);
            assert_int_equal(p->triangle_count, 12);
            for (i = 0; i < 6; i++) {
                for (c = 4 * i; c < 4 * i + 4; c++) {
                    const double *x = p->positions[p->corner_vertex[c]];
                    vec3 diagonal = v3_unit(v3(x[0] - 0.5, x[1] - 0.5, x[2] - 0.5));
                    vec3 expected = k < 2 ? v3_from(p->polys[i].n) : diagonal;
                    assert_near(v3_length(v3_sub(normal_at(p, c), expected)), 0, 1e-6);
                }
            }
        }
    }
}

/* Writes a sphere of triangles without an index: every triangle has vertices of its own, to be welded by position. */
static size_t sphere(double (*positions)[3], int rows, int columns)
{
    size_t count = 0;
    int i, k, c;
    for (i = 0; i < rows; i++) {
        for (k = 0; k < columns; k++) {
            const int at[6][2] = {{i, k}, {i + 1, k}, {i + 1, k + 1}, {i, k}, {i + 1, k + 1}, {i, k + 1}};
            for (c = 0; c < 6; c++) {
                double polar = PI * at[c][0] / rows, around = 2 * PI * (at[c][1] % columns) / columns;
                double ring = at[c][0] == 0 || at[c][0] == rows ? 0 : sin(polar);
                positions[count][0] = ring * cos(around);
                positions[count][1] = ring * sin(around);
                positions[count][2] = cos(polar);
                count++;
            }
        }
    }
    return count;
}

static gno_mesh_def sphere_mesh(int rows, int columns)
{
    static double positions[24 * 48 * 6][3];
    static int corners[24 * 48 * 6];
    gno_mesh_def mesh = gno_mesh_def_default();
    size_t i;
    mesh.vertex_count = mesh.corner_count = sphere(positions, rows, columns);
    for (i = 0; i < mesh.corner_count; i++) {
        corners[i] = (int)i;
    }
    mesh.positions = (const double *)positions;
    mesh.polygon_count = mesh.ring_count = mesh.corner_count / 3;
    mesh.corner_vertex = corners;
    mesh.shading = GNO_SHADING_GOURAUD;
    return mesh;
}

static void test_sphere(void **state)
{
    bed *b = *state;
    int k;
    for (k = 0; k < 6; k++) {
        gno_mesh_def mesh = sphere_mesh(24, 48);
        const gnoi_prepared *p;
        size_t c;
        mesh.weighting = (gno_weighting)(k % 3);
        mesh.crease = k < 3 ? 180 : 40;
        gno_scene_destroy(b->scene);
        assert_int_equal(gno_scene_create(b->context, &b->scene), GNO_OK);
        assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
        p = prepare(b, 2 * 48, 0); /* one triangle of each quad at the poles has no area */
        check_invariants(b->scene);
        assert_int_equal(p->normal_count, 23 * 48 + 2);
        for (c = 0; c < p->corner_count; c++) {
            vec3 x = v3_from(p->positions[p->corner_vertex[c]]);
            assert_true(v3_dot(normal_at(p, c), x) > 0.995);
        }
    }
}

/* A roof of two squares at 60 degrees, one three times as long: the ridge leans to the longer by area only. */
static void test_weighting(void **state)
{
    double h = sqrt(0.75);
    double positions[18] = {0, 0, 0, 0, 1, 0, 0.5, 0, 0, 0.5, 1, 0, -1.5, 0, 0, -1.5, 1, 0};
    static const int corners[8] = {0, 2, 3, 1, 0, 1, 5, 4};
    static const unsigned rings[3] = {0, 4, 8};
    gno_mesh_def mesh = gno_mesh_def_default();
    bed *b = *state;
    int k;
    positions[8] = positions[11] = -h;
    positions[14] = positions[17] = -3 * h;
    mesh.vertex_count = 6;
    mesh.positions = positions;
    mesh.polygon_count = mesh.ring_count = 2;
    mesh.ring_start = rings;
    mesh.corner_count = 8;
    mesh.corner_vertex = corners;
    mesh.shading = GNO_SHADING_PHONG;
    for (k = 0; k < 3; k++) {
        const gnoi_prepared *p;
        vec3 n, expected;
        mesh.weighting = (gno_weighting)k;
        assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
        p = prepare(b, 0, 0);
        n = normal_at(p, (size_t)k * 8);
        expected = v3_from(p->polys[2 * k].n);
        expected = v3_unit(v3_mad(expected, v3_from(p->polys[2 * k + 1].n), k == GNO_WEIGHTING_AREA ? 3 : 1));
        assert_near(v3_length(v3_sub(n, expected)), 0, 1e-6);
    }
}

static void test_file_normals(void **state)
{
    static const double normals[12] = {0, 0, 2, 0, 0, 0, 1e-200, 0, 0, 1e200, 1e200, 0};
    static const int corner_normal[24] = {0, 1, 2, 3, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    gno_mesh_def mesh = cube(180, GNO_WEIGHTING_AREA);
    bed *b = *state;
    const gnoi_prepared *p;
    double third = 1 / sqrt(3);
    mesh.normal_count = 4;
    mesh.normals = normals;
    mesh.corner_normal = corner_normal;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    p = prepare(b, 0, 0);
    check_invariants(b->scene);
    assert_near(v3_length(v3_sub(normal_at(p, 0), v3(0, 0, 1))), 0, 1e-6);
    assert_near(v3_length(v3_sub(normal_at(p, 1), v3(0, 0, -1))), 0, 1e-6); /* zero in the file: the plane's own */
    assert_near(v3_length(v3_sub(normal_at(p, 2), v3(1, 0, 0))), 0, 1e-6);
    assert_near(v3_length(v3_sub(normal_at(p, 3), v3(sqrt(0.5), sqrt(0.5), 0))), 0, 1e-6);
    assert_near(v3_length(v3_sub(normal_at(p, 4), v3(-third, -third, third))), 0, 1e-6); /* none in the file: averaged */
    mesh.average_normals = 1;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    p = prepare(b, 0, 0);
    check_invariants(b->scene);
    assert_near(v3_length(v3_sub(normal_at(p, 0), v3(0, 0, 1))), 0, 1e-6);
    assert_near(v3_length(v3_sub(normal_at(p, 24), v3(-third, -third, -third))), 0, 1e-6);
}

/* A cone of more sides than are averaged one by one: still smooth around its tip, its base still apart, and done in time. */
static void test_crowded_point(void **state)
{
    enum { SIDES = 100000 };
    bed *b = *state;
    double(*positions)[3] = malloc((SIDES + 2) * sizeof *positions);
    int(*corners)[3] = malloc(2 * SIDES * sizeof *corners);
    gno_mesh_def mesh = gno_mesh_def_default();
    const gnoi_prepared *p;
    int i;
    assert_true(positions && corners);
    for (i = 0; i < SIDES; i++) {
        double angle = 2 * PI * i / SIDES;
        positions[i][0] = cos(angle);
        positions[i][1] = sin(angle);
        positions[i][2] = 0;
        corners[i][0] = i;
        corners[i][1] = (i + 1) % SIDES;
        corners[i][2] = SIDES; /* the side: to the tip */
        corners[SIDES + i][0] = (i + 1) % SIDES;
        corners[SIDES + i][1] = i;
        corners[SIDES + i][2] = SIDES + 1; /* the base: to its middle */
    }
    memset(positions[SIDES], 0, 2 * sizeof *positions);
    positions[SIDES][2] = 1;
    mesh.vertex_count = SIDES + 2;
    mesh.positions = (const double *)positions;
    mesh.polygon_count = mesh.ring_count = 2 * SIDES;
    mesh.corner_count = 6 * SIDES;
    mesh.corner_vertex = (const int *)corners;
    mesh.shading = GNO_SHADING_PHONG;
    mesh.crease = 40;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    p = prepare(b, 0, 0);
    check_invariants(b->scene);
    for (i = 0; i < 2 * SIDES; i++) {
        vec3 own = v3_from(p->polys[i].n);
        size_t corner = p->polys[i].corner;
        if (p->polys[i].source < SIDES) {
            assert_true(v3_dot(normal_at(p, corner), own) > 0.9999);
            assert_true(v3_dot(normal_at(p, corner + 2), own) > 0.97);
        } else {
            assert_true(normal_at(p, corner + 2).z == -1);
        }
    }
    free(positions);
    free(corners);
}

/* The two sides of one square: sums cancel, each side keeps its own normal. */
static void test_cancelled_sums(void **state)
{
    static const double square[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const int corners[8] = {0, 1, 2, 3, 3, 2, 1, 0};
    static const unsigned rings[3] = {0, 4, 8};
    gno_mesh_def mesh = gno_mesh_def_default();
    bed *b = *state;
    int k;
    mesh.vertex_count = 4;
    mesh.positions = square;
    mesh.polygon_count = mesh.ring_count = 2;
    mesh.ring_start = rings;
    mesh.corner_count = 8;
    mesh.corner_vertex = corners;
    mesh.shading = GNO_SHADING_PHONG;
    for (k = 0; k < 2; k++) {
        const gnoi_prepared *p;
        mesh.crease = k ? 179.999999999 : 180;
        assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
        p = prepare(b, 0, 0);
        check_invariants(b->scene);
        assert_true(normal_at(p, (size_t)k * 8).z == 1 && normal_at(p, (size_t)k * 8 + 7).z == -1);
    }
}

/* ---- threads and memory ------------------------------------------------------------------------------------------ */

/* Flat, smooth, bent, empty and holed polygons together. */
static gno_status fill(gno_scene *scene)
{
    static const double saddle[12] = {0, 0, 0, 1, 0, 0.5, 1, 1, 0, 0, 1, 0.5};
    static const int saddle_corners[4] = {0, 1, 2, 3};
    static const unsigned saddle_rings[2] = {0, 4};
    gno_mesh_def mesh = cube(40, GNO_WEIGHTING_ANGLE);
    gno_status status = gno_scene_add_mesh(scene, &mesh, NULL);
    if (status == GNO_OK) {
        mesh = sphere_mesh(8, 40); /* of 40 corners around, so that fans at the poles need memory */
        status = gno_scene_add_mesh(scene, &mesh, NULL);
    }
    if (status == GNO_OK) {
        mesh = gno_mesh_def_default();
        mesh.vertex_count = mesh.corner_count = 4;
        mesh.positions = saddle;
        mesh.polygon_count = mesh.ring_count = 1;
        mesh.ring_start = saddle_rings;
        mesh.corner_vertex = saddle_corners;
        status = gno_scene_add_mesh(scene, &mesh, NULL);
    }
    return status;
}

static gno_status add_large_star(gno_scene *scene, int bent)
{
    static double positions[3 * 100];
    static int corners[100];
    static const unsigned rings[2] = {0, 100};
    gno_mesh_def mesh = gno_mesh_def_default();
    uint64_t seed = 7;
    int i;
    star(positions, 100, 0, 0, 1, 2, 1, &seed);
    for (i = 0; i < 100; i++) {
        corners[i] = i;
        positions[3 * i + 2] = bent ? random_unit(&seed) : 0;
    }
    mesh.vertex_count = mesh.corner_count = 100;
    mesh.positions = positions;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = rings;
    mesh.corner_vertex = corners;
    mesh.shading = GNO_SHADING_PHONG;
    return gno_scene_add_mesh(scene, &mesh, NULL);
}

static gno_status build(fail_alloc *alloc)
{
    gno_context_def def = fail_alloc_def(alloc);
    gno_context *context;
    gno_scene *scene = NULL;
    gno_status status = gno_context_create(&def, &context);
    if (status != GNO_OK) {
        return status;
    }
    status = gno_scene_create(context, &scene);
    if (status == GNO_OK) {
        status = fill(scene);
    }
    if (status == GNO_OK) {
        status = add_large_star(scene, 0);
    }
    if (status == GNO_OK) {
        status = add_large_star(scene, 1);
    }
    if (status == GNO_OK) {
        status = gno_scene_prepare(scene, 1, NULL);
        assert_int_equal(scene->prepared.valid, status == GNO_OK);
        assert_true(status == GNO_OK || strstr(gno_context_message(context), "out of memory"));
    }
    if (status == GNO_OK) {
        check_invariants(scene);
    }
    assert_int_equal(gno_context_memory(context, NULL), alloc->held);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return status;
}

/* A failure to shrink at the end is none: the last fail_at may succeed early, so the loop runs to the true end. */
static void test_every_allocation_fails(void **state)
{
    size_t fail_at = 0;
    fail_alloc whole = {0, 0, 0, 0};
    (void)state;
    assert_int_equal(build(&whole), GNO_OK);
    while (fail_at < whole.calls) {
        fail_alloc alloc = {0, 0, ++fail_at, 0};
        gno_status status = build(&alloc);
        assert_true(status == GNO_ERROR_MEMORY || (status == GNO_OK && fail_at == whole.calls));
        assert_int_equal(alloc.held, 0);
        assert_int_equal(alloc.wrong_size, 0);
    }
    assert_true(whole.calls > 60);
}

static void test_threads_agree(void **state)
{
    bed *b = *state;
    gno_scene *other;
    const gnoi_prepared *p = &b->scene->prepared, *q;
    size_t k;
    int i;
    assert_int_equal(gno_scene_create(b->context, &other), GNO_OK);
    q = &other->prepared;
    for (i = 0; i < 12; i++) { /* more than one piece of work */
        assert_int_equal(fill(b->scene), GNO_OK);
        assert_int_equal(fill(other), GNO_OK);
        assert_int_equal(add_large_star(b->scene, i % 2), GNO_OK);
        assert_int_equal(add_large_star(other, i % 2), GNO_OK);
    }
    assert_int_equal(gno_scene_prepare(b->scene, 1, NULL), GNO_OK);
    assert_int_equal(gno_scene_prepare(other, 5, NULL), GNO_OK);
    check_invariants(b->scene);
    assert_int_equal(p->poly_count, q->poly_count);
    assert_int_equal(p->normal_count, q->normal_count);
    assert_int_equal(p->triangle_count, q->triangle_count);
    for (k = 0; k < p->poly_count; k++) {
        assert_memory_equal(p->polys[k].n, q->polys[k].n, 4 * sizeof(double)); /* d follows n */
        assert_int_equal(p->polys[k].corner, q->polys[k].corner);
        assert_int_equal(p->polys[k].triangle, q->polys[k].triangle);
        assert_int_equal(p->polys[k].source, q->polys[k].source);
    }
    assert_memory_equal(p->normals, q->normals, p->normal_count * sizeof *p->normals);
    assert_memory_equal(p->triangles, q->triangles, p->triangle_count * sizeof *p->triangles);
    assert_memory_equal(p->corner_normal, q->corner_normal, p->corner_count * sizeof *p->corner_normal);
    gno_scene_destroy(other);
}

static void test_arguments(void **state)
{
    bed *b = *state;
    assert_int_equal(gno_scene_prepare(NULL, 1, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_prepare(b->scene, -1, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_prepare(b->scene, GNO_MAX_THREADS + 1, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_prepare(b->scene, 0, NULL), GNO_OK);
    assert_true(b->scene->prepared.scale == 1 && b->scene->prepared.poly_count == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_concave_plane, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_far_from_origin, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_attributes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_degenerate, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_short_rings, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_non_planar, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_planar_by_scale, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_stars_with_holes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_grid_shapes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_comb_and_spiral, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_broken_rings, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_axes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_cube_creases, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_sphere, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_weighting, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_file_normals, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_crowded_point, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_cancelled_sums, set_up, tear_down),
        cmocka_unit_test(test_every_allocation_fails),
        cmocka_unit_test_setup_teardown(test_threads_agree, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_arguments, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
