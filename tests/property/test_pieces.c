/* test_pieces.c -- lit and visible pieces of random scenes against rays, one by one: whether a random point of a polygon is lit, what
 * of the light arrives there, what the eye sees at a random point of the picture, and by which lights it is reached.
 * A ray and a piece may differ on a border only. Beside it the certificates, and sums of areas.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/oracle.h"
#include "support/random_scene.h"
#include <gnomon/gnomon_pieces.h>
#include <math.h>
#include <stdlib.h>

#define SEEDS 2 /* raise it for a long run: 40 take a minute */
#define POINTS 12       /* tried on each polygon and light */
#define LOOKS 400       /* in each picture */
#define BORDER 4e-5     /* share of the scene's size: a cone's polygon, and coplanarity tolerance seen at a slant */

/* ---- points and pieces ------------------------------------------------------------------------------------------------ */

static double distance_to_edge(const double p[3], const double a[3], const double b[3])
{
    double ab[3], ap[3], length = 0, along = 0, d = 0;
    for (int k = 0; k < 3; k++) {
        ab[k] = b[k] - a[k];
        ap[k] = p[k] - a[k];
        length += ab[k] * ab[k];
        along += ab[k] * ap[k];
    }
    along = length > 0 ? fmin(1, fmax(0, along / length)) : 0;
    for (int k = 0; k < 3; k++) d += (ap[k] - along * ab[k]) * (ap[k] - along * ab[k]);
    return sqrt(d);
}

/* Even-odd by a line in the plane of the two axes along which the ring is widest. */
static int ring_holds(const double *points, size_t count, const double p[3], const int axes[2], double *border)
{
    int odd = 0;
    for (size_t i = 0; i < count; i++) {
        const double *a = points + 3 * i, *b = points + 3 * (i + 1 < count ? i + 1 : 0);
        double y = p[axes[1]], d = distance_to_edge(p, a, b);
        *border = fmin(*border, d);
        if ((a[axes[1]] > y) != (b[axes[1]] > y) &&
            p[axes[0]] < a[axes[0]] + (y - a[axes[1]]) / (b[axes[1]] - a[axes[1]]) * (b[axes[0]] - a[axes[0]])) odd = !odd;
    }
    return odd;
}

static void widest_axes(const double *points, size_t count, int axes[2])
{
    double n[3] = {0, 0, 0};
    int most = 0;
    for (size_t i = 0; i < count; i++) {
        const double *a = points + 3 * i, *b = points + 3 * (i + 1 < count ? i + 1 : 0);
        for (int k = 0; k < 3; k++) n[k] += (a[(k + 1) % 3] - b[(k + 1) % 3]) * (a[(k + 2) % 3] + b[(k + 2) % 3]);
    }
    for (int k = 1; k < 3; k++) most = fabs(n[k]) > fabs(n[most]) ? k : most;
    axes[0] = (most + 1) % 3;
    axes[1] = (most + 2) % 3;
}

/* Whether the piece holds the point; *border becomes the least distance to any of its edges, when less. */
static int piece_holds(const gno_piece *piece, const double p[3], double *border)
{
    int axes[2], odd = 0;
    const double *first = piece->points + 3 * piece->ring_start[0];
    widest_axes(first, piece->ring_start[1] - piece->ring_start[0], axes);
    for (size_t r = 0; r < piece->ring_count; r++)
        odd ^= ring_holds(piece->points + 3 * piece->ring_start[r], piece->ring_start[r + 1] - piece->ring_start[r], p, axes, border);
    return odd;
}

/* The pieces of a polygon that hold the point: how many, and the last of them. */
static int holders(const gno_pieces *pieces, size_t polygon, const double p[3], gno_piece *which, double *border)
{
    size_t first, count;
    int found = 0;
    assert_int_equal(gno_pieces_of(pieces, polygon, &first, &count), GNO_OK);
    for (size_t i = first; i < first + count; i++) {
        gno_piece piece;
        assert_int_equal(gno_pieces_get(pieces, i, &piece), GNO_OK);
        if (piece_holds(&piece, p, border)) {
            *which = piece;
            found++;
        }
    }
    return found;
}

static double scene_size(const gno_scene *scene)
{
    double low[3], high[3], size = 0;
    if (!gno_scene_bounds(scene, low, high)) return 1;
    for (int k = 0; k < 3; k++) size = fmax(size, high[k] - low[k]);
    return size;
}

/* A random point of the polygon, from the rectangle around its outer ring; 0 when tries fail. */
static int random_point(const gno_scene *scene, size_t index, uint64_t *state, double p[3])
{
    gno_polygon polygon;
    double ring[64][3];
    size_t n;
    int axes[2];
    assert_int_equal(gno_scene_polygon(scene, index, &polygon), GNO_OK);
    n = polygon.ring_start[1] - polygon.ring_start[0];
    if (n < 3 || n > 64) return 0;
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) ring[i][k] = polygon.positions[3 * (size_t)polygon.corner_vertex[polygon.ring_start[0] + i] + (size_t)k];
    widest_axes(&ring[0][0], n, axes);
    for (int tries = 0; tries < 50; tries++) {
        /* a combination of three corners stays in the plane */
        size_t i = (size_t)(random_unit(state) * (double)n), j = (size_t)(random_unit(state) * (double)n), m = (size_t)(random_unit(state) * (double)n);
        double a = 1.6 * random_unit(state) - 0.3, b = 1.6 * random_unit(state) - 0.3, border = HUGE_VAL;
        if (i == j || j == m || i == m) continue;
        for (int k = 0; k < 3; k++) p[k] = ring[i][k] + a * (ring[j][k] - ring[i][k]) + b * (ring[m][k] - ring[i][k]);
        if (ring_holds(&ring[0][0], n, p, axes, &border)) return 1;
    }
    return 0;
}

static int in_a_hole(const gno_scene *scene, size_t index, const double p[3])
{
    gno_polygon polygon;
    double ring[64][3];
    int axes[2], odd = 0;
    assert_int_equal(gno_scene_polygon(scene, index, &polygon), GNO_OK);
    for (size_t r = 1; r < polygon.ring_count; r++) {
        size_t n = polygon.ring_start[r + 1] - polygon.ring_start[r];
        double border = HUGE_VAL;
        if (n < 3 || n > 64) continue;
        for (size_t i = 0; i < n; i++)
            for (int k = 0; k < 3; k++) ring[i][k] = polygon.positions[3 * (size_t)polygon.corner_vertex[polygon.ring_start[r] + i] + (size_t)k];
        widest_axes(&ring[0][0], n, axes);
        odd |= ring_holds(&ring[0][0], n, p, axes, &border);
    }
    return odd;
}

/* ---- lit ------------------------------------------------------------------------------------------------------------------ */

/* Where shadows weaken with distance a piece is what lies in no shadow; rays know how deep a shadow is. */
static int soft(const gno_scene *scene, size_t expanded)
{
    gno_light light;
    assert_int_equal(gno_expanded_light(scene, expanded, &light, NULL), GNO_OK);
    return light.softness > 0;
}

/* Compares one point; returns 1 when ray and pieces agree or the point lies on a border. */
static int agree_lit(const oracle *o, const gno_pieces *pieces, size_t polygon, size_t light, const double p[3], double size)
{
    double passed[3], border = HUGE_VAL;
    gno_piece piece;
    int found = holders(pieces, polygon, p, &piece, &border), reached;
    oracle_reach(o, (long)polygon, p, light, passed);
    reached = passed[0] > 0 || passed[1] > 0 || passed[2] > 0;
    if (border < BORDER * size) return 1;
    if (found != reached) return 0;
    for (int k = 0; k < 3 && found; k++)
        if (fabs(piece.passed[k] - passed[k]) > 1e-12) return 0;
    return 1;
}

static void check_lit(scene_kind kind, unsigned seed, gno_context *context, long *tried)
{
    gno_scene *scene = random_scene(context, kind, seed, 64, 48);
    oracle *o;
    size_t polygons;
    gno_lit_row *rows;
    uint64_t state = seed * 7919 + (uint64_t)kind + 1;
    double size;
    assert_non_null(scene);
    o = oracle_create(scene);
    size = scene_size(scene);
    polygons = gno_scene_count(scene).polygons;
    rows = malloc((polygons + 1) * sizeof *rows);
    assert_true(o && rows);
    for (size_t light = 0; light < gno_expanded_light_count(scene) && light < 3; light++) {
        gno_pieces *pieces;
        gno_lit_summary sum;
        int hard = !soft(scene, light);
        assert_int_equal(gno_lit_pieces(scene, light, NULL, &pieces, rows, &sum), GNO_OK);
        if (!(sum.area_residual <= 1e-9 && sum.flux_residual <= 1e-9)) {
            print_error("%s %u light %zu: residuals %g %g\n", scene_kind_name(kind), seed, light, sum.area_residual, sum.flux_residual);
            fail();
        }
        for (size_t k = 0; k < polygons && hard; k++) {
            gno_polygon polygon;
            gno_material material;
            int points = polygons > 200 ? 2 : POINTS;
            double p[3];
            assert_int_equal(gno_scene_polygon(scene, k, &polygon), GNO_OK);
            assert_int_equal(gno_scene_material(scene, polygon.material, &material), GNO_OK);
            if (rows[k].side == 0 || (rows[k].side < 0 && !material.two_sided)) continue;
            for (int i = 0; i < points; i++) {
                if (!random_point(scene, k, &state, p) || in_a_hole(scene, k, p)) continue;
                (*tried)++;
                if (!agree_lit(o, pieces, k, light, p, size)) {
                    print_error("%s %u light %zu polygon %zu: (%.9g, %.9g, %.9g)\n", scene_kind_name(kind), seed, light, k, p[0], p[1], p[2]);
                    fail();
                }
            }
        }
        gno_pieces_destroy(pieces);
    }
    free(rows);
    oracle_destroy(o);
    gno_scene_destroy(scene);
}

static void test_lit_points(void **state)
{
    gno_context *context;
    long tried = 0;
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (unsigned seed = 1; seed <= SEEDS; seed++) check_lit((scene_kind)kind, seed, context, &tried);
    print_message("%ld points\n", tried);
    assert_true(tried > 10000);
    gno_context_destroy(context);
}

/* ---- visible --------------------------------------------------------------------------------------------------------------- */

static int same_lights(const oracle *o, const gno_piece *piece, const double p[3], size_t lights)
{
    size_t at = 0;
    for (size_t i = 0; i < lights; i++) {
        double passed[3];
        int listed = at < piece->light_count && piece->lights[at] == i;
        oracle_reach(o, (long)piece->polygon, p, i, passed);
        for (int k = 0; k < 3 && listed; k++)
            if (fabs(piece->passed[3 * at + (size_t)k] - passed[k]) > 1e-12) return 0;
        at += (size_t)listed;
        if (!listed && (passed[0] > 0 || passed[1] > 0 || passed[2] > 0)) return 2; /* reached, but perhaps from behind */
    }
    return at == piece->light_count;
}

/* Whether eye and light are on one side of the polygon. */
static int facing(const gno_scene *scene, const gno_piece *piece, size_t light)
{
    gno_lit_row *rows = malloc(gno_scene_count(scene).polygons * sizeof *rows);
    gno_lit_def def = gno_lit_def_default();
    int side;
    def.certify = 0;
    assert_non_null(rows);
    assert_int_equal(gno_lit_pieces((gno_scene *)scene, light, &def, NULL, rows, NULL), GNO_OK);
    side = rows[piece->polygon].side;
    free(rows);
    return side == piece->side;
}

static int explained(const oracle *o, const gno_scene *scene, const gno_piece *piece, const double p[3], size_t lights)
{
    int how = same_lights(o, piece, p, lights);
    size_t at = 0;
    if (how != 2) return how;
    for (size_t i = 0; i < lights; i++) {
        double passed[3];
        int listed = at < piece->light_count && piece->lights[at] == i;
        at += (size_t)listed;
        oracle_reach(o, (long)piece->polygon, p, i, passed);
        if (!listed && (passed[0] > 0 || passed[1] > 0 || passed[2] > 0) && facing(scene, piece, i)) return 0;
    }
    return 1;
}

static void check_visible(scene_kind kind, unsigned seed, gno_context *context, long *tried)
{
    gno_scene *scene = random_scene(context, kind, seed, 64, 48);
    oracle *o;
    gno_pieces *sets[2], *lit[64] = {NULL};
    gno_visible_def def = gno_visible_def_default();
    uint64_t state = seed * 104729 + (uint64_t)kind + 1;
    size_t lights;
    double size;
    int looks = LOOKS;
    assert_non_null(scene);
    o = oracle_create(scene);
    assert_non_null(o);
    size = scene_size(scene);
    lights = gno_expanded_light_count(scene);
    assert_int_equal(gno_visible_pieces(scene, &def, &sets[0], NULL), GNO_OK);
    for (size_t i = 0; i < lights && i < 64; i++) assert_int_equal(gno_lit_pieces(scene, i, NULL, &lit[i], NULL, NULL), GNO_OK);
    def.lit = (const gno_pieces *const *)lit;
    if (lights > 64) def.lit = NULL;
    def.threads = 3;
    assert_int_equal(gno_visible_pieces(scene, &def, &sets[1], NULL), GNO_OK);
    for (size_t i = 0; i < lights; i++) looks = soft(scene, i) ? 0 : looks;
    for (int look = 0; look < looks; look++) {
        oracle_sample s = oracle_look(o, 64 * random_unit(&state), 48 * random_unit(&state));
        if (s.polygon < 0) continue;
        (*tried)++;
        for (int k = 0; k < 2; k++) {
            gno_piece piece;
            double border = HUGE_VAL;
            int found = holders(sets[k], (size_t)s.polygon, s.point, &piece, &border);
            if (border < BORDER * size) continue;
            if (found != 1 || !explained(o, scene, &piece, s.point, lights)) {
                print_error("%s %u, %s: polygon %ld at (%.9g, %.9g, %.9g) is in %d pieces\n", scene_kind_name(kind), seed,
                            k ? "with kept lit pieces" : "from scratch", s.polygon, s.point[0], s.point[1], s.point[2], found);
                fail();
            }
        }
    }
    for (size_t i = 0; i < lights && i < 64; i++) gno_pieces_destroy(lit[i]);
    gno_pieces_destroy(sets[0]);
    gno_pieces_destroy(sets[1]);
    oracle_destroy(o);
    gno_scene_destroy(scene);
}

static void test_visible_points(void **state)
{
    gno_context *context;
    long tried = 0;
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (unsigned seed = 1; seed <= SEEDS; seed++) check_visible((scene_kind)kind, seed, context, &tried);
    print_message("%ld looks\n", tried);
    assert_true(tried > 3000);
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_lit_points), cmocka_unit_test(test_visible_points)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
