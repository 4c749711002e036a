/* test_terrain.c -- fractal ground without cracks, fine near the viewer; the fractal dimension of sets of points. Place: tests of
 * src/scene. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fail_alloc.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double square[12] = {0, 0, 0, 8, 0, 0, 8, 8, 0, 0, 8, 0};

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

static gno_terrain terrain_on(const double *corners, size_t count)
{
    gno_terrain t = gno_terrain_default();
    t.corners = corners;
    t.corner_count = count;
    return t;
}

static gno_scene *new_scene(gno_context **context)
{
    gno_scene *scene = NULL;
    assert_int_equal(gno_context_create(NULL, context), GNO_OK);
    assert_int_equal(gno_scene_create(*context, &scene), GNO_OK);
    return scene;
}

static void end(gno_context *context, gno_scene *scene)
{
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* ---- cracks ------------------------------------------------------------------------------------------------------------ */

typedef struct side {
    double a[3], b[3]; /* in order of their coordinates */
    int times;         /* passed one way less the other */
} side;

static int compare_points(const double *a, const double *b)
{
    for (int k = 0; k < 3; k++)
        if (a[k] != b[k])
            return a[k] < b[k] ? -1 : 1;
    return 0;
}

static int compare_sides(const void *a, const void *b)
{
    const side *s = a, *t = b;
    int c = compare_points(s->a, t->a);
    return c ? c : compare_points(s->b, t->b);
}

/* Every side of a triangle is met by exactly one other the other way round, at the same two points to the last bit, but for those whose ends
 * both lie over the outline, 0 to `x` by 0 to `y`, on one of its sides. Returns the length of that border seen from above. */
static double assert_no_cracks(gno_scene *scene, double x, double y)
{
    size_t count = gno_scene_count(scene).polygons, n = 0;
    side *sides = malloc(3 * count * sizeof *sides);
    double border = 0;
    assert_non_null(sides);
    for (size_t p = 0; p < count; p++) {
        gno_polygon polygon;
        assert_int_equal(gno_scene_polygon(scene, p, &polygon), GNO_OK);
        for (unsigned i = 0; i < 3; i++) {
            unsigned from = polygon.ring_start[0];
            const double *a = polygon.positions + 3 * polygon.corner_vertex[from + i];
            const double *b = polygon.positions + 3 * polygon.corner_vertex[from + (i + 1) % 3];
            int forwards = compare_points(a, b) < 0;
            memcpy(sides[n].a, forwards ? a : b, sizeof sides[n].a);
            memcpy(sides[n].b, forwards ? b : a, sizeof sides[n].b);
            sides[n++].times = forwards ? 1 : -1;
        }
    }
    qsort(sides, n, sizeof *sides, compare_sides);
    for (size_t i = 0, j; i < n; i = j) {
        int times = 0;
        const double *a = sides[i].a, *b = sides[i].b;
        for (j = i; j < n && !compare_sides(&sides[i], &sides[j]); j++)
            times += sides[j].times;
        if (times == 0) {
            assert_int_equal(j - i, 2);
            continue;
        }
        assert_int_equal(j - i, 1);
        assert_true((a[0] == 0 && b[0] == 0) || (a[0] == x && b[0] == x) || (a[1] == 0 && b[1] == 0) || (a[1] == y && b[1] == y));
        border += hypot(b[0] - a[0], b[1] - a[1]);
    }
    free(sides);
    return border;
}

static void test_counts(void **state)
{
    (void)state;
    for (int levels = 0; levels < 6; levels++) {
        gno_context *context;
        gno_scene *scene = new_scene(&context);
        gno_terrain t = terrain_on(square, 4);
        size_t n = (size_t)1 << levels;
        gno_scene_counts counts;
        t.levels = levels;
        assert_int_equal(gno_scene_add_terrain(scene, &t, NULL, NULL), GNO_OK);
        counts = gno_scene_count(scene);
        /* level 0: a fan about the centre; then 2^levels squared quadrilaterals of two triangles */
        assert_int_equal(counts.polygons, levels ? 2 * n * n : 4);
        assert_int_equal(counts.vertices, levels ? (n + 1) * (n + 1) : 5);
        assert_near(assert_no_cracks(scene, 8, 8), 32, 1e-9);
        end(context, scene);
    }
}

/* Heights: none of the corners', at most height (1 + roughness + roughness^2 ...) beyond them, and not nothing. */
static void test_heights(void **state)
{
    gno_context *context;
    gno_scene *scene = new_scene(&context);
    gno_terrain t = terrain_on(square, 4);
    double low[3], high[3];
    (void)state;
    t.height = 0.75;
    t.roughness = 0.6;
    assert_int_equal(gno_scene_add_terrain(scene, &t, NULL, NULL), GNO_OK);
    assert_int_equal(gno_scene_bounds(scene, low, high), 1);
    assert_true(low[0] == 0 && low[1] == 0 && high[0] == 8 && high[1] == 8);
    assert_true(high[2] - low[2] > 0.75 && high[2] < 0.75 / 0.4 && low[2] > -0.75 / 0.4);
    for (size_t i = 0; i < 4; i++)
        assert_true(scene->positions[i][2] == 0);
    end(context, scene);
}

/* The root mean square of what the finest edges' middles are off their edges falls with the roughness from level to level. */
static void test_roughness(void **state)
{
    static const double roughness[2] = {0.5, 0.8};
    (void)state;
    for (int r = 0; r < 2; r++) {
        double squares[2];
        for (int level = 0; level < 2; level++) {
            gno_context *context;
            gno_scene *scene = new_scene(&context);
            gno_terrain t = terrain_on(square, 4);
            size_t to;
            t.levels = 6 + level;
            t.roughness = roughness[r];
            assert_int_equal(gno_scene_add_terrain(scene, &t, NULL, NULL), GNO_OK);
            to = gno_scene_count(scene).vertices;
            squares[level] = 0;
            {
                double step = 8.0 / (1 << t.levels);
                size_t n = ((size_t)1 << t.levels) + 1;
                double *grid = calloc(n * n, sizeof *grid);
                size_t used = 0;
                assert_non_null(grid);
                for (size_t i = 0; i < to; i++)
                    grid[(size_t)(scene->positions[i][1] / step + 0.5) * n + (size_t)(scene->positions[i][0] / step + 0.5)] =
                        scene->positions[i][2];
                for (size_t y = 0; y < n; y += 2)
                    for (size_t x = 1; x < n; x += 2, used++)
                        squares[level] += pow(grid[y * n + x] - 0.5 * (grid[y * n + x - 1] + grid[y * n + x + 1]), 2);
                squares[level] /= (double)used;
                free(grid);
            }
            end(context, scene);
        }
        assert_near(sqrt(squares[1] / squares[0]), roughness[r], 0.05 * roughness[r]);
    }
}

static void test_same_bits(void **state)
{
    gno_context *context[3];
    gno_scene *scene[3];
    gno_terrain t = terrain_on(square, 4);
    size_t size;
    (void)state;
    for (int i = 0; i < 3; i++) {
        scene[i] = new_scene(&context[i]);
        t.seed = i == 2 ? 8 : 7;
        assert_int_equal(gno_scene_add_terrain(scene[i], &t, NULL, NULL), GNO_OK);
    }
    size = gno_scene_count(scene[0]).vertices * sizeof *scene[0]->positions;
    assert_memory_equal(scene[0]->positions, scene[1]->positions, size);
    assert_true(memcmp(scene[0]->positions, scene[2]->positions, size) != 0);
    for (int i = 0; i < 3; i++)
        end(context[i], scene[i]);
}

/* A value of a middle worked out by an independent program (Python), so that other machines and later versions agree. */
static void test_known_height(void **state)
{
    gno_context *context;
    gno_scene *scene = new_scene(&context);
    gno_terrain t = terrain_on(square, 4);
    (void)state;
    t.levels = 1;
    assert_int_equal(gno_scene_add_terrain(scene, &t, NULL, NULL), GNO_OK);
    assert_true(scene->positions[4][0] == 4 && scene->positions[4][1] == 0);
    assert_true(scene->positions[4][2] == 0x1.3bb81c5ba8fa8p-2);
    end(context, scene);
}

/* ---- finer near the viewer --------------------------------------------------------------------------------------------- */

static void test_detail(void **state)
{
    (void)state;
    for (unsigned seed = 0; seed < 5; seed++) {
        gno_context *context;
        gno_scene *scene = new_scene(&context);
        gno_terrain t = terrain_on(square, 4);
        double nearest = HUGE_VAL, farthest = 0;
        size_t count;
        t.levels = 9;
        t.least_levels = 2;
        t.detail = 0.1;
        t.height = 0.2;
        t.seed = seed;
        t.viewer[0] = 1 + seed;
        t.viewer[1] = 0.5;
        t.viewer[2] = 0.6;
        assert_int_equal(gno_scene_add_terrain(scene, &t, NULL, NULL), GNO_OK);
        assert_near(assert_no_cracks(scene, 8, 8), 32, 1e-9);
        count = gno_scene_count(scene).polygons;
        assert_true(count < 2 * 512 * 512 / 8);
        for (size_t i = 0; i < count; i++) { /* areas from above: small near the viewer, large far off */
            const int *v = scene->corner_vertex + 3 * i;
            const double *a = scene->positions[v[0]], *b = scene->positions[v[1]], *c = scene->positions[v[2]];
            double area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
            double distance = hypot((a[0] + b[0] + c[0]) / 3 - t.viewer[0], (a[1] + b[1] + c[1]) / 3 - t.viewer[1]);
            assert_true(area > 0);
            if (distance < 0.5)
                nearest = fmin(nearest, area);
            if (distance > 5)
                farthest = fmax(farthest, area);
        }
        if (!(nearest < 0.002 && farthest > 20 * nearest))
            fail_msg("%g near, %g far", nearest, farthest);
        end(context, scene);
    }
}

/* Two terrains side by side, and a viewer on one of them: one surface. */
static void test_neighbours_fit(void **state)
{
    static const double left[12] = {0, 0, 0, 4, 0, 0, 4, 8, 0, 0, 8, 0}, right[12] = {8, 8, 0, 4, 8, 0, 4, 0, 0, 8, 0, 0};
    (void)state;
    for (int detail = 0; detail < 2; detail++) {
        gno_context *context;
        gno_scene *scene = new_scene(&context);
        gno_terrain t = terrain_on(left, 4);
        t.detail = detail ? 0.15 : 0;
        t.viewer[0] = 1;
        t.viewer[1] = 2;
        t.viewer[2] = 1;
        assert_int_equal(gno_scene_add_terrain(scene, &t, NULL, NULL), GNO_OK);
        t.corners = right;
        assert_int_equal(gno_scene_add_terrain(scene, &t, NULL, NULL), GNO_OK);
        assert_near(assert_no_cracks(scene, 8, 8), 32, 1e-9);
        end(context, scene);
    }
}

/* Any number of corners, any plane: displacements are along its normal. */
static void test_polygons(void **state)
{
    double corners[21];
    gno_mesh_def look = gno_mesh_def_default();
    (void)state;
    look.transform[3] = 5;
    for (int i = 0; i < 7; i++) {
        corners[3 * i] = 2;
        corners[3 * i + 1] = cos(0.897597901025655 * i);
        corners[3 * i + 2] = sin(0.897597901025655 * i);
    }
    for (int count = 3; count <= 7; count += 2) {
        gno_context *context;
        gno_scene *scene = new_scene(&context);
        gno_terrain t = terrain_on(corners, (size_t)count);
        double low[3], high[3];
        t.height = 0.1;
        t.levels = 4;
        assert_int_equal(gno_scene_add_terrain(scene, &t, &look, NULL), GNO_OK);
        assert_int_equal(gno_scene_count(scene).polygons, count * 2 * 64);
        gno_scene_bounds(scene, low, high);
        assert_true(low[0] > 6.7 && high[0] < 7.3 && high[0] - low[0] > 0.01);
        assert_true(low[1] > -1.0001 && high[1] < 1.0001);
        for (size_t i = 0; i < scene->texcoord_count; i++)
            for (int k = 0; k < 2; k++)
                assert_true(scene->texcoords[i][k] >= -1e-12 && scene->texcoords[i][k] <= 1 + 1e-12);
        end(context, scene);
    }
}

static void test_bad_terrains(void **state)
{
    static const double line[9] = {0, 0, 0, 1, 1, 1, 2, 2, 2};
    static const double wild[9] = {0, 0, 0, 1, 0, NAN, 0, 1, 0};
    gno_context *context;
    gno_scene *scene = new_scene(&context);
    gno_terrain good = terrain_on(square, 4), t;
    (void)state;
#define REFUSED(change, status, text)                                                                                              \
    t = good;                                                                                                                      \
    change;                                                                                                                        \
    assert_int_equal(gno_scene_add_terrain(scene, &t, NULL, NULL), status);                                                        \
    assert_string_equal(gno_context_message(context), text)
    REFUSED(t.corner_count = 2, GNO_ERROR_ARGUMENT, "terrain: 2 corners are not 3 to 65536");
    REFUSED(t.corners = NULL, GNO_ERROR_ARGUMENT, "terrain: 4 corners are not 3 to 65536");
    REFUSED((t.corners = wild, t.corner_count = 3), GNO_ERROR_ARGUMENT, "terrain: corners is out of range");
    REFUSED((t.corners = line, t.corner_count = 3), GNO_ERROR_ARGUMENT, "terrain: the corners have no area");
    REFUSED(t.height = -1, GNO_ERROR_ARGUMENT, "terrain: height is out of range");
    REFUSED(t.roughness = 0, GNO_ERROR_ARGUMENT, "terrain: roughness is out of range");
    REFUSED(t.levels = 15, GNO_ERROR_ARGUMENT, "terrain: levels is out of range");
    REFUSED(t.least_levels = -1, GNO_ERROR_ARGUMENT, "terrain: least_levels is out of range");
    REFUSED(t.detail = NAN, GNO_ERROR_ARGUMENT, "terrain: detail is out of range");
    REFUSED(t.viewer[1] = INFINITY, GNO_ERROR_ARGUMENT, "terrain: viewer is out of range");
    REFUSED(t.levels = 14, GNO_ERROR_LIMIT, "terrain: 14 levels of 4 corners make more than 33554432 triangles");
    assert_int_equal(gno_scene_count(scene).polygons, 0);
    assert_int_equal(gno_scene_add_terrain(NULL, &good, NULL, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_add_terrain(scene, NULL, NULL, NULL), GNO_ERROR_ARGUMENT);
    end(context, scene);
}

static int stop_at_once(void *user, const char *stage, double fraction)
{
    assert_true(fraction >= 0 && fraction <= 1);
    ++*(int *)user;
    return !strcmp(stage, "terrain");
}

/* A large one can be stopped while it grows. */
static void test_cancel(void **state)
{
    int asked = 0;
    gno_context_def def = gno_context_def_default();
    gno_context *context;
    gno_scene *scene;
    gno_terrain t = terrain_on(square, 4);
    (void)state;
    def.progress = stop_at_once;
    def.progress_user = &asked;
    t.levels = 9;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    assert_int_equal(gno_scene_add_terrain(scene, &t, NULL, NULL), GNO_ERROR_CANCELLED);
    assert_string_equal(gno_context_message(context), "terrain: cancelled");
    assert_true(asked > 0);
    assert_int_equal(gno_scene_count(scene).polygons, 0);
    end(context, scene);
}

/* Every allocation fails once; nothing is lost, the scene stays as it was. */
static void test_no_memory(void **state)
{
    fail_alloc alloc = {0, 0, 0, 0};
    gno_context_def def = fail_alloc_def(&alloc);
    gno_context *context;
    gno_scene *scene;
    gno_terrain t = terrain_on(square, 4);
    double points[12], dimension;
    int fails = 0;
    (void)state;
    memcpy(points, square, sizeof points);
    t.levels = 5;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    for (;; fails++) {
        size_t held = alloc.held;
        gno_status status;
        alloc.fail_at = alloc.calls + (size_t)fails + 1;
        status = gno_scene_add_terrain(scene, &t, NULL, NULL);
        alloc.fail_at = 0;
        if (status == GNO_OK)
            break;
        assert_int_equal(status, GNO_ERROR_MEMORY);
        assert_int_equal(alloc.held, held);
        assert_int_equal(gno_scene_count(scene).polygons, 0);
    }
    assert_true(fails > 20);
    alloc.fail_at = alloc.calls + 1;
    assert_int_equal(gno_fractal_dimension(context, 4, points, 2, 0, 2, &dimension), GNO_ERROR_MEMORY);
    alloc.fail_at = 0;
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    assert_int_equal(alloc.held, 0);
    assert_false(alloc.wrong_size);
}

/* ---- dimension ----------------------------------------------------------------------------------------------------------- */

static double dimension_of(size_t count, const double *points, int magnification, int first, int levels)
{
    gno_context *context;
    double dimension = -1;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    assert_int_equal(gno_fractal_dimension(context, count, points, magnification, first, levels, &dimension), GNO_OK);
    gno_context_destroy(context);
    return dimension;
}

/* The chapter's: a segment doubled is twice itself, a square four times. */
static void test_segment_and_square(void **state)
{
    enum { SIDE = 256 };
    double *points = malloc(SIDE * SIDE * 3 * sizeof *points);
    (void)state;
    assert_non_null(points);
    for (int i = 0; i < SIDE * SIDE; i++) {
        points[3 * i] = 3 + i / (double)(SIDE * SIDE);
        points[3 * i + 1] = 5 + 2 * i / (double)(SIDE * SIDE);
        points[3 * i + 2] = -4 * i / (double)(SIDE * SIDE);
    }
    assert_near(dimension_of(SIDE * SIDE, points, 2, 0, 8), 1, 0.05);
    for (int i = 0; i < SIDE * SIDE; i++) {
        points[3 * i] = (i % SIDE + 0.5) / SIDE;
        points[3 * i + 1] = 7;
        points[3 * i + 2] = (i / SIDE + 0.5) / SIDE;
    }
    assert_near(dimension_of(SIDE * SIDE, points, 2, 0, 8), 2, 1e-9);
    assert_near(dimension_of(SIDE * SIDE, points, 4, 0, 4), 2, 1e-9);
    for (int i = 0; i < 4096; i++) /* a cube */
        for (int k = 0; k < 3; k++)
            points[3 * i + k] = (i >> (4 * k) & 15) + 0.5;
    assert_near(dimension_of(4096, points, 2, 0, 4), 3, 1e-9);
    assert_near(dimension_of(1, points, 2, 0, 4), 0, 0);
    free(points);
}

/* Points of the curve that replaces each segment by four of a third its length (level 0: its ends). */
static double *koch(double *out, double ax, double ay, double bx, double by, int level)
{
    double dx = (bx - ax) / 3, dy = (by - ay) / 3, px, py, h = 0.86602540378443865;
    if (level == 0) {
        out[0] = ax;
        out[1] = ay;
        out[2] = 0;
        return out + 3;
    }
    px = ax + 1.5 * dx - h * dy;
    py = ay + 1.5 * dy + h * dx;
    out = koch(out, ax, ay, ax + dx, ay + dy, level - 1);
    out = koch(out, ax + dx, ay + dy, px, py, level - 1);
    out = koch(out, px, py, ax + 2 * dx, ay + 2 * dy, level - 1);
    return koch(out, ax + 2 * dx, ay + 2 * dy, bx, by, level - 1);
}

/* The chapter's third example: four pieces a third as long, H = log 4 / log 3 = 1.26. */
static void test_koch_curve(void **state)
{
    enum { LEVELS = 9 };
    size_t count = (size_t)1 << (2 * LEVELS);
    double *points = malloc(count * 3 * sizeof *points);
    (void)state;
    assert_non_null(points);
    koch(points, 0, 0, 1, 0, LEVELS);
    assert_near(dimension_of(count, points, 3, 4, 7), log(4) / log(3), 0.02);
    assert_near(dimension_of(count, points, 2, 4, 11), log(4) / log(3), 0.04);
    free(points);
}

/* Cantor's dust, thirds: log 2 / log 3. */
static void test_cantor_set(void **state)
{
    double points[3 * 4096];
    (void)state;
    for (int i = 0; i < 4096; i++) {
        double x = 0, step = 2.0 / 3;
        for (int k = 11; k >= 0; k--, step /= 3)
            x += i >> k & 1 ? step : 0;
        points[3 * i] = x + 0.5 * step; /* the middle of its smallest piece: not on a box's border */
        points[3 * i + 1] = points[3 * i + 2] = 0;
    }
    assert_near(dimension_of(4096, points, 3, 0, 10), log(2) / log(3), 0.01);
}

static void test_bad_dimensions(void **state)
{
    gno_context *context;
    double points[6] = {0, 0, 0, 1, 0, NAN}, dimension;
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    assert_int_equal(gno_fractal_dimension(context, 2, points, 2, 0, 3, &dimension), GNO_ERROR_ARGUMENT);
    points[5] = 0;
    assert_int_equal(gno_fractal_dimension(context, 2, points, 1, 0, 3, &dimension), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_fractal_dimension(context, 2, points, 2, 3, 3, &dimension), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_fractal_dimension(context, 2, points, 2, -1, 3, &dimension), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_fractal_dimension(context, 2, points, 2, 0, 53, &dimension), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_fractal_dimension(context, 0, points, 2, 0, 3, &dimension), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_fractal_dimension(context, 2, NULL, 2, 0, 3, &dimension), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_fractal_dimension(context, 2, points, 2, 0, 52, &dimension), GNO_OK);
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_counts),
        cmocka_unit_test(test_heights),
        cmocka_unit_test(test_roughness),
        cmocka_unit_test(test_same_bits),
        cmocka_unit_test(test_known_height),
        cmocka_unit_test(test_detail),
        cmocka_unit_test(test_neighbours_fit),
        cmocka_unit_test(test_polygons),
        cmocka_unit_test(test_bad_terrains),
        cmocka_unit_test(test_cancel),
        cmocka_unit_test(test_no_memory),
        cmocka_unit_test(test_segment_and_square),
        cmocka_unit_test(test_koch_curve),
        cmocka_unit_test(test_cantor_set),
        cmocka_unit_test(test_bad_dimensions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
