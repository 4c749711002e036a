/* test_prepare_order.c -- the order of prepared polygons, and what is computed of many triangles or vertices side by side, each against
 * the obvious way.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "prepare_test.h"
#include "shadow/located.h"

#define PLACES 40 /* cells of the order are narrower than their distance */

/* `count` small triangles, the first corner of each at one of the places along the x axis: every third one at the first place. */
static void add_row(bed *b, size_t count, int threads)
{
    double *positions = calloc(9 * count, sizeof *positions);
    int *corners = calloc(3 * count, sizeof *corners);
    gno_mesh_def mesh = gno_mesh_def_default();
    uint64_t seed = 17 + count;
    assert_true(positions && corners);
    for (size_t i = 0; i < 3 * count; i++)
        corners[i] = (int)i;
    for (size_t i = 0; i < count; i++) {
        double place = i % 3 == 0 ? 0 : floor(random_unit(&seed) * PLACES), *p = positions + 9 * i;
        p[0] = p[3] = p[6] = place;
        p[3] += 1e-3 + 1e-3 * random_unit(&seed);
        p[7] = 1e-3 + 1e-3 * random_unit(&seed);
        p[8] = 1e-3 * random_unit(&seed);
    }
    mesh.positions = positions;
    mesh.vertex_count = 3 * count;
    mesh.corner_vertex = corners;
    mesh.corner_count = 3 * count;
    mesh.ring_count = mesh.polygon_count = count;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    assert_int_equal(gnoi_scene_prepare(b->scene, threads), GNO_OK);
    assert_int_equal(b->scene->prepared.poly_count, count);
    free(positions);
    free(corners);
}

static double place_of(const bed *b, size_t i) { return gnoi_corner_at(b->scene, b->scene->prepared.polys[i].corner).x; }

/* By place, and at a place as the caller lists them. */
static void check_order(void **state, size_t count, int threads)
{
    bed *b = *state;
    add_row(b, count, threads);
    for (size_t i = 1; i < count; i++) {
        const gnoi_poly *poly = &b->scene->prepared.polys[i];
        assert_true(place_of(b, i) >= place_of(b, i - 1));
        assert_true(place_of(b, i) > place_of(b, i - 1) || poly->source > poly[-1].source);
    }
}

static void test_order_of_many(void **state) { check_order(state, 70000, 3); }
static void test_order_of_some(void **state) { check_order(state, 1100, 1); }

/* Fewer stay as they are. */
static void test_order_of_few(void **state)
{
    bed *b = *state;
    add_row(b, 900, 2);
    for (size_t i = 0; i < 900; i++)
        assert_int_equal(b->scene->prepared.polys[i].source, i);
}

/* To the last bit. */
static void test_planes(void **state)
{
    bed *b = *state;
    const gnoi_prepared *prep = &b->scene->prepared;
    add_row(b, 20001, 1);
    for (size_t i = 0; i < prep->poly_count; i++) {
        gnoi_poly twin = prep->polys[i];
        gnoi_set_triangle((const double(*)[3])prep->positions, prep->corner_vertex + twin.corner, &twin);
        assert_memory_equal(&twin, &prep->polys[i], sizeof twin);
    }
}

static void test_sums(void **state)
{
    bed *b = *state;
    gnoi_prepared *prep = &b->scene->prepared;
    gnoi_triangle_sums sums = {0}, twin = {0};
    vec3 base;
    add_row(b, 1000, 1);
    base = v3_from(prep->lower);
    gnoi_set_triangles(prep, 3, 990, &sums);
    for (size_t i = 3; i < 993; i++) {
        const uint32_t *v = prep->corner_vertex + prep->polys[i].corner;
        vec3 a = v3_from(prep->positions[v[0]]), ab = v3_sub(v3_from(prep->positions[v[1]]), a), ac = v3_sub(v3_from(prep->positions[v[2]]), a);
        twin.volume += v3_dot(v3_cross(ab, ac), v3_sub(a, base));
        for (int k = 0; k < 3; k++) {
            twin.edges += gnoi_edge_number(v[k], v[(k + 1) % 3]);
            assert_true(gnoi_edge_number(v[k], v[(k + 1) % 3]) + gnoi_edge_number(v[(k + 1) % 3], v[k]) == 0);
        }
    }
    assert_true(sums.edges == twin.edges);
    assert_true(fabs(sums.volume - twin.volume) <= 1e-12 * fabs(twin.volume));
}

/* A lamp among the vertices sees them on all six faces; one vertex lies where it stands. */
static void test_places_on_cube(void **state)
{
    bed *b = *state;
    const gnoi_prepared *prep = &b->scene->prepared;
    gnoi_lamp lamp = {0};
    gnoi_frame frame;
    gnoi_located *located;
    int faces = 0;
    add_row(b, 2000, 1);
    lamp.position = v3_from(prep->positions[prep->vertex_count / 3 * 2]);
    frame = gnoi_frame_make(&lamp, prep->lower, prep->upper);
    assert_int_equal(frame.faces, 6);
    located = gnoi_locate_vertices(b->scene, &frame);
    assert_non_null(located);
    for (size_t v = 0; v < prep->vertex_count; v++) {
        const vec3 p = v3_from(prep->positions[v]);
        gnoi_lpoint l = {0, 0, 1};
        int good = gnoi_frame_locate(&frame, &p, 1, &l);
        assert_int_equal(located[v].face, good ? gnoi_frame_face(&frame, l.u) : GNOI_NO_FACE);
        assert_true(located[v].u == (float)l.u && located[v].v == (float)l.v && located[v].z == (float)(1 / l.q));
        faces |= good ? 1 << located[v].face : 64;
    }
    assert_true((faces & 67) == 67); /* both ways along the row, and the vertex itself */
    gnoi_free(b->context, located, prep->vertex_count, sizeof *located);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_order_of_many, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_order_of_some, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_order_of_few, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_planes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_sums, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_places_on_cube, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
