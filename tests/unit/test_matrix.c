/* test_matrix.c -- the binary shadow matrix on scenes whose answer is plain, and its calls: own shadow, covered columns, area lights, columns
 * on demand, iterating, wrong arguments, memory that fails.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <gnomon/gnomon_matrix.h>
#include <stdio.h>
#include <string.h>

#include "fail_alloc.h"
#include "support/random_scene.h"

static gno_context *context;

static int make_context(void **state)
{
    (void)state;
    return gno_context_create(NULL, &context) != GNO_OK;
}

static int drop_context(void **state)
{
    (void)state;
    size_t held = gno_context_memory(context, NULL);
    gno_context_destroy(context);
    return held > sizeof(gno_camera) * 64; /* scenes and matrices are gone; what remains is the context's own */
}

static gno_scene *empty_scene(void)
{
    gno_scene *scene;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    return scene;
}

/* A rectangle at height z with its front upwards (or downwards). */
static void add_plate(gno_scene *scene, double x0, double y0, double x1, double y1, double z, int downwards, int material)
{
    double up[4][3] = {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}, down[4][3];
    for (int i = 0; i < 4; i++) memcpy(down[i], up[3 - i], sizeof down[i]);
    assert_true(add_polygon(scene, (const double(*)[3])(downwards ? down : up), 4, material, 0));
}

static void add_sun(gno_scene *scene, double x, double y, double z)
{
    gno_light light = gno_light_default();
    light.type = GNO_LIGHT_DIRECTIONAL;
    light.direction[0] = x;
    light.direction[1] = y;
    light.direction[2] = z;
    assert_int_equal(gno_scene_add_light(scene, "sun", &light, NULL), GNO_OK);
}

static void add_lamp(gno_scene *scene, double x, double y, double z)
{
    gno_light light = gno_light_default();
    light.position[0] = x;
    light.position[1] = y;
    light.position[2] = z;
    assert_int_equal(gno_scene_add_light(scene, "lamp", &light, NULL), GNO_OK);
}

static gno_matrix *build(gno_scene *scene)
{
    gno_matrix *matrix;
    gno_matrix_def def = gno_matrix_def_default();
    def.threads = 1;
    assert_int_equal(gno_matrix_build(scene, 0, &def, &matrix), GNO_OK);
    assert_non_null(matrix);
    assert_int_equal(gno_matrix_size(matrix), gno_scene_count(scene).polygons);
    return matrix;
}

/* Column as a text: its casters, then a letter for the shade (n p c o -). */
static const char *column(gno_matrix *matrix, size_t receiver)
{
    static char text[4][200];
    static int turn;
    char *out = text[turn = (turn + 1) % 4];
    gno_matrix_column c;
    size_t used = 0;
    int own = 0;
    assert_int_equal(gno_matrix_get_column(matrix, receiver, &c), GNO_OK);
    assert_int_equal(c.receiver, receiver);
    for (size_t i = 0; i < c.count && used < 150; i++) {
        used += (size_t)snprintf(out + used, sizeof text[0] - used, "%u ", c.casters[i]);
        own |= c.casters[i] == receiver;
    }
    assert_int_equal(c.own, own);
    snprintf(out + used, sizeof text[0] - used, "%c", "npco-"[c.shade]);
    return out;
}

/* ---- what casts on what ----------------------------------------------------------------------------------------------- */

static void test_plate_over_floor(void **state)
{
    (void)state;
    for (int lamp = 0; lamp < 2; lamp++) {
        gno_scene *scene = empty_scene();
        add_plate(scene, -4, -4, 4, 4, 0, 0, 0);
        add_plate(scene, -1, -1, 1, 1, 1, 0, 0);
        add_plate(scene, 2, 2, 3, 3, -1, 0, 0); /* below the floor */
        if (lamp) add_lamp(scene, 0.5, 0.5, 6);
        else add_sun(scene, 0.1, 0, -1);
        gno_matrix *m = build(scene);
        assert_string_equal(column(m, 0), "1 p");
        assert_string_equal(column(m, 1), "n");
        assert_string_equal(column(m, 2), "0 c");
        gno_matrix_destroy(m);
        gno_scene_destroy(scene);
    }
}

/* Away from the light: two-sided open surfaces still list those that shade the side that the light meets. */
static void test_own_shadow(void **state)
{
    (void)state;
    gno_scene *scene = empty_scene();
    gno_material one_sided = gno_material_default();
    int material;
    one_sided.two_sided = 0;
    assert_int_equal(gno_scene_add_material(scene, &one_sided, &material), GNO_OK);
    add_plate(scene, -4, -4, 4, 4, 0, 1, 0);
    add_plate(scene, -1, -1, 1, 1, 1, 1, 0);
    add_plate(scene, -4, -4, 4, 4, -1, 1, material);
    add_plate(scene, -4, -4, 4, 4, -2, 0, material);
    double wall[4][3] = {{5, 0, 0}, {5, 0, 1}, {5, 0, 2}, {6, 0, 1}}; /* the sun lies in its plane */
    assert_true(add_polygon(scene, (const double(*)[3])wall, 4, 0, 0));
    add_sun(scene, 0, 0, -1);
    gno_matrix *m = build(scene);
    assert_string_equal(column(m, 0), "0 1 p");
    assert_string_equal(column(m, 1), "1 n"); /* seen from below, lit */
    assert_string_equal(column(m, 2), "2 o"); /* one-sided, away: nothing else is looked for */
    assert_string_equal(column(m, 3), "0 1 2 c");
    assert_string_equal(column(m, 4), "4 o");
    gno_matrix_destroy(m);
    gno_scene_destroy(scene);
}

/* A closed box: lit outer sides have no caster, the others are in their own shadow, whatever the winding. */
static void test_box(void **state)
{
    (void)state;
    for (int inside = 0; inside < 2; inside++) {
        gno_scene *scene = empty_scene();
        const double a[3] = {-1, -1, 0}, b[3] = {1, 1, 2};
        gno_matrix_info info;
        assert_true(add_box(scene, a, b, inside, 0));
        add_plate(scene, -9, -9, 9, 9, 0, 0, 0);
        add_sun(scene, 0.5, 0.3, -1);
        gno_matrix *m = build(scene);
        assert_int_equal(gno_matrix_get_info(m, &info), GNO_OK);
        assert_int_equal(info.own, 3);
        assert_int_equal(info.diagonal, 3);
        assert_int_equal(info.none, 3);
        assert_int_equal(info.part, 1);
        assert_int_equal(info.ones, 3 + info.longest);
        /* All but the box's underside, which lies on the ground, throw shadows there. */
        assert_int_equal(info.longest, 5);
        gno_matrix_destroy(m);
        gno_scene_destroy(scene);
    }
}

/* A box without its underside is closed for light from above; light from below comes in, and its inner sides are lit. */
static void test_open_box(void **state)
{
    (void)state;
    static const double p[8][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}};
    static const int corners[] = {4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    static const unsigned rings[] = {0, 4, 8, 12, 16, 20};
    for (int below = 0; below < 4; below++) {
        gno_scene *scene = empty_scene();
        gno_mesh_def mesh = gno_mesh_def_default();
        gno_matrix_info info;
        mesh.vertex_count = 8;
        mesh.positions = &p[0][0];
        mesh.polygon_count = mesh.ring_count = 5;
        mesh.ring_start = rings;
        mesh.corner_count = 20;
        mesh.corner_vertex = corners;
        assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
        if (below < 2) add_sun(scene, 0.3, 0.2, below ? 1 : -1);
        else add_lamp(scene, -3, -2, below > 2 ? -10 : 10);
        gno_matrix *m = build(scene);
        assert_int_equal(gno_matrix_get_info(m, &info), GNO_OK);
        if (below % 2) { /* the inner top is lit but for what the walls shade */
            gno_matrix_column top;
            assert_int_equal(gno_matrix_get_column(m, 0, &top), GNO_OK);
            assert_true(top.own && top.shade == GNO_SHADE_PART);
            assert_int_equal(info.own, 0);
        } else {
            assert_int_equal(info.own, 2);
            assert_int_equal(info.none, 3);
        }
        gno_matrix_destroy(m);
        gno_scene_destroy(scene);
    }
}

static void test_lamp_in_room(void **state)
{
    (void)state;
    gno_scene *scene = empty_scene();
    const double a[3] = {-4, -4, 0}, b[3] = {4, 4, 3}, c[3] = {1, 1, 0}, d[3] = {2, 2, 1};
    gno_matrix_info info;
    assert_true(add_box(scene, a, b, 1, 0));
    assert_true(add_box(scene, c, d, 0, 0));
    add_lamp(scene, 0, 0, 2.5);
    gno_matrix *m = build(scene);
    assert_int_equal(gno_matrix_get_info(m, &info), GNO_OK);
    assert_int_equal(info.diagonal, 3); /* of the small box: bottom and two sides */
    for (size_t s = 0; s < 6; s++) {
        gno_matrix_column column;
        assert_int_equal(gno_matrix_get_column(m, s, &column), GNO_OK);
        assert_false(column.own);
        for (size_t i = 0; i < column.count; i++) assert_true(column.casters[i] >= 6); /* walls do not shade walls */
    }
    gno_matrix_destroy(m);
    gno_scene_destroy(scene);
}

/* A hole lets light through: the matrix sees polygons as they are. */
static void test_holes_and_concave(void **state)
{
    (void)state;
    gno_scene *scene = empty_scene();
    const double frame[8][3] = {{-2, -2, 2}, {2, -2, 2}, {2, 2, 2}, {-2, 2, 2}, {-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}};
    const double angle[6][3] = {{3, -2, 2}, {7, -2, 2}, {7, -1, 2}, {4, -1, 2}, {4, 2, 2}, {3, 2, 2}};
    const unsigned rings[] = {0, 4, 8}, polygons[] = {0, 2};
    const int corners[] = {0, 1, 2, 3, 4, 5, 6, 7};
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = mesh.corner_count = 8;
    mesh.positions = &frame[0][0];
    mesh.polygon_count = 1;
    mesh.polygon_start = polygons;
    mesh.ring_count = 2;
    mesh.ring_start = rings;
    mesh.corner_vertex = corners;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    assert_true(add_polygon(scene, angle, 6, 0, 0));
    add_plate(scene, -0.9, -0.9, 0.9, 0.9, 0, 0, 0);  /* under the hole */
    add_plate(scene, -1.1, -0.9, 0.9, 0.9, -1, 0, 0); /* reaches under the frame */
    add_plate(scene, 4.1, -0.9, 7, 2, 0, 0, 0);       /* in the angle's notch */
    add_plate(scene, 3.1, -1.9, 3.9, 1.9, 0, 0, 0);   /* under one arm */
    add_sun(scene, 0, 0, -1);
    gno_matrix *m = build(scene);
    assert_string_equal(column(m, 2), "n");
    assert_string_equal(column(m, 3), "0 2 p");
    assert_string_equal(column(m, 4), "n");
    assert_true(!strcmp(column(m, 5), "1 p") || !strcmp(column(m, 5), "1 c"));
    gno_matrix_destroy(m);
    gno_scene_destroy(scene);
}

/* Numbers are the caller's: of a bent polygon split in triangles, of a skipped one, of one that lets all light through. */
static void test_source_numbers(void **state)
{
    (void)state;
    gno_scene *scene = empty_scene();
    gno_material air = gno_material_default();
    int material;
    for (int k = 0; k < 3; k++) air.transmission[k] = 1;
    assert_int_equal(gno_scene_add_material(scene, &air, &material), GNO_OK);
    const double bent[4][3] = {{-1, -1, 1}, {1, -1, 1.5}, {1, 1, 1}, {-1, 1, 1.5}}, line[3][3] = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
    add_plate(scene, -3, -3, 3, 3, 3, 0, material);
    assert_true(add_polygon(scene, bent, 4, 0, 0));
    assert_true(add_polygon(scene, line, 3, 0, 0));
    add_plate(scene, -4, -4, 4, 4, 0, 0, 0);
    add_sun(scene, 0, 0, -1);
    gno_matrix *m = build(scene);
    assert_string_equal(column(m, 0), "n");
    assert_string_equal(column(m, 1), "n");
    assert_string_equal(column(m, 2), "-");
    assert_string_equal(column(m, 3), "1 p");
    gno_matrix_destroy(m);
    gno_scene_destroy(scene);
}

/* Casters that were split into triangles stand in a column once, in order, however long it is: three ways to sort. */
static void test_long_columns(void **state)
{
    static const size_t counts[3] = {9, 100, 4500};
    (void)state;
    for (int i = 0; i < 3; i++) {
        gno_scene *scene = empty_scene();
        gno_matrix_column c;
        for (size_t k = 0; k < counts[i]; k++) {
            double x = (double)(k % 67) - 33, y = (double)(k / 67) - 33;
            const double bent[4][3] = {{x, y, 1}, {x + 0.9, y, 1.2}, {x + 0.9, y + 0.9, 1}, {x, y + 0.9, 1.2}};
            assert_true(add_polygon(scene, bent, 4, 0, 0));
        }
        add_plate(scene, -40, -40, 40, 40, 0, 0, 0);
        add_sun(scene, 0, 0, -1);
        gno_matrix *m = build(scene);
        assert_int_equal(gno_matrix_get_column(m, counts[i], &c), GNO_OK);
        assert_int_equal(c.count, counts[i]);
        for (size_t k = 0; k < c.count; k++) assert_int_equal(c.casters[k], k);
        gno_matrix_destroy(m);
        gno_scene_destroy(scene);
    }
}

static void test_area_light(void **state)
{
    (void)state;
    gno_scene *scene = empty_scene();
    gno_light light = gno_light_default();
    gno_matrix_def def = gno_matrix_def_default();
    gno_matrix *m;
    light.type = GNO_LIGHT_AREA;
    light.samples = 2;
    light.position[0] = -4;
    light.position[2] = 4;
    light.edge1[0] = 8; /* points at x -2 and 2 */
    light.edge2[1] = 0.001;
    add_plate(scene, -1, -1, 1, 1, 2, 0, 0);
    add_plate(scene, 1.8, -0.2, 2.2, 0.2, 0, 0, 0);   /* in the shadow of the left points */
    add_plate(scene, -2.2, -0.2, -1.8, 0.2, 0, 0, 0); /* of the right ones */
    assert_int_equal(gno_scene_add_light(scene, "panel", &light, NULL), GNO_OK);
    m = build(scene);
    assert_string_equal(column(m, 1), "0 p");
    assert_string_equal(column(m, 2), "0 p");
    gno_matrix_destroy(m);
    def.point = 0;
    assert_int_equal(gno_matrix_build(scene, 0, &def, &m), GNO_OK);
    assert_string_equal(column(m, 1), "0 c");
    assert_string_equal(column(m, 2), "n");
    gno_matrix_destroy(m);
    def.point = 4;
    assert_int_equal(gno_matrix_build(scene, 0, &def, &m), GNO_ERROR_ARGUMENT);
    assert_null(m);
    gno_scene_destroy(scene);
}

static void test_nothing(void **state)
{
    (void)state;
    gno_scene *scene = empty_scene();
    gno_matrix_cursor cursor = {0, 0, 0, 0, GNO_OK};
    gno_matrix_info info;
    gno_matrix *m;
    assert_int_equal(gno_matrix_build(scene, 0, NULL, &m), GNO_ERROR_ARGUMENT); /* no light */
    assert_null(m);
    add_sun(scene, 0, 0, -1);
    m = build(scene);
    assert_int_equal(gno_matrix_size(m), 0);
    assert_int_equal(gno_matrix_next(m, &cursor), 0);
    assert_int_equal(gno_matrix_get_info(m, &info), GNO_OK);
    assert_int_equal(info.ones, 0);
    gno_matrix_destroy(m);
    gno_matrix_destroy(NULL);
    assert_int_equal(gno_matrix_build(scene, -1, NULL, &m), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_build(scene, 1, NULL, &m), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_build(NULL, 0, NULL, &m), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_build(scene, 0, NULL, NULL), GNO_ERROR_ARGUMENT);
    gno_scene_destroy(scene);
}

/* ---- calls ------------------------------------------------------------------------------------------------------------ */

static void assert_same(gno_matrix *a, gno_matrix *b)
{
    assert_int_equal(gno_matrix_size(a), gno_matrix_size(b));
    for (size_t s = 0; s < gno_matrix_size(a); s++) {
        gno_matrix_column x, y;
        assert_int_equal(gno_matrix_get_column(a, s, &x), GNO_OK);
        assert_int_equal(gno_matrix_get_column(b, s, &y), GNO_OK);
        assert_int_equal(x.count, y.count);
        assert_int_equal(x.own, y.own);
        assert_int_equal(x.shade, y.shade);
        if (x.count > 0) assert_memory_equal(x.casters, y.casters, x.count * sizeof *x.casters);
    }
}

static void test_threads_and_demand(void **state)
{
    (void)state;
    const scene_kind kinds[] = {SCENE_SOUP, SCENE_ROOM, SCENE_BLOB, SCENE_HOLES, SCENE_SOLIDS};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        gno_scene *scene = random_scene(context, kinds[k], 77, 64, 64);
        gno_matrix *one, *other;
        gno_matrix_def def = gno_matrix_def_default();
        gno_matrix_cursor a = {0, 0, 0, 0, GNO_OK}, b = a;
        assert_non_null(scene);
        one = build(scene);
        def.threads = 5;
        assert_int_equal(gno_matrix_build(scene, 0, &def, &other), GNO_OK);
        assert_same(one, other);
        gno_matrix_destroy(other);
        def.on_demand = 1;
        assert_int_equal(gno_matrix_build(scene, 0, &def, &other), GNO_OK);
        assert_same(one, other);
        while (gno_matrix_next(one, &a)) {
            assert_int_equal(gno_matrix_next(other, &b), 1);
            assert_int_equal(a.caster, b.caster);
            assert_int_equal(a.receiver, b.receiver);
        }
        assert_int_equal(gno_matrix_next(other, &b), 0);
        gno_matrix_destroy(other);
        gno_matrix_destroy(one);
        gno_scene_destroy(scene);
    }
}

static void test_scene_that_changed(void **state)
{
    (void)state;
    gno_scene *scene = empty_scene();
    gno_matrix_def def = gno_matrix_def_default();
    gno_matrix_column c;
    gno_matrix *m, *whole;
    add_plate(scene, -1, -1, 1, 1, 1, 0, 0);
    add_plate(scene, -1, -1, 1, 1, 0, 0, 0);
    add_sun(scene, 0, 0, -1);
    whole = build(scene);
    def.on_demand = 1;
    assert_int_equal(gno_matrix_build(scene, 0, &def, &m), GNO_OK);
    assert_string_equal(column(m, 1), "0 c");
    assert_int_equal(gno_matrix_get_column(m, 2, &c), GNO_ERROR_ARGUMENT);
    add_plate(scene, -1, -1, 1, 1, 2, 0, 0);
    assert_int_equal(gno_matrix_get_column(m, 1, &c), GNO_ERROR_ARGUMENT);
    assert_non_null(strstr(gno_context_message(context), "changed"));
    assert_string_equal(column(whole, 1), "0 c");
    gno_matrix_destroy(m);
    gno_scene_destroy(scene);
    assert_string_equal(column(whole, 1), "0 c"); /* stands on its own */
    gno_matrix_destroy(whole);
}

static void test_from_columns(void **state)
{
    (void)state;
    const size_t start[] = {0, 2, 2, 3}, falling[] = {0, 2, 1, 3}, late[] = {1, 2, 2, 3};
    const unsigned casters[] = {0, 2, 2}, high[] = {0, 3, 2}, twice[] = {2, 2, 2};
    gno_matrix *m;
    assert_int_equal(gno_matrix_from_columns(context, 3, start, casters, &m), GNO_OK);
    assert_string_equal(column(m, 0), "0 2 p");
    assert_string_equal(column(m, 1), "n");
    assert_string_equal(column(m, 2), "2 o");
    gno_matrix_destroy(m);
    assert_int_equal(gno_matrix_from_columns(context, 3, falling, casters, &m), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_from_columns(context, 3, late, casters, &m), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_from_columns(context, 3, start, high, &m), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_from_columns(context, 3, start, twice, &m), GNO_ERROR_ARGUMENT);
    assert_null(m);
}

/* Every allocation of building, whole and on demand, fails once: a status, no leak, no harm. */
static void test_memory(void **state)
{
    (void)state;
    for (int on_demand = 0; on_demand < 2; on_demand++) {
        size_t fail_at = 1;
        for (int done = 0; !done; fail_at++) {
            fail_alloc account = {0, 0, 0, 0};
            gno_context_def def = fail_alloc_def(&account);
            gno_matrix_def wish = gno_matrix_def_default();
            gno_context *own;
            gno_matrix *m;
            assert_int_equal(gno_context_create(&def, &own), GNO_OK);
            gno_scene *scene = random_scene(own, SCENE_HOLES, 3, 32, 32);
            assert_non_null(scene);
            wish.threads = 1;
            wish.on_demand = on_demand;
            account.calls = 0;
            account.fail_at = fail_at;
            gno_status status = gno_matrix_build(scene, 0, &wish, &m);
            if (status == GNO_OK) {
                gno_matrix_info info;
                status = gno_matrix_get_info(m, &info);
                gno_matrix_check_result result;
                if (status == GNO_OK) status = gno_matrix_check(scene, 0, m, &result);
            }
            assert_true(status == GNO_OK || status == GNO_ERROR_MEMORY);
            done = status == GNO_OK;
            gno_matrix_destroy(m);
            gno_scene_destroy(scene);
            gno_context_destroy(own);
            assert_int_equal(account.held, 0);
            assert_false(account.wrong_size);
        }
        assert_true(fail_at > 8);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plate_over_floor), cmocka_unit_test(test_own_shadow),         cmocka_unit_test(test_box),
        cmocka_unit_test(test_open_box),
        cmocka_unit_test(test_lamp_in_room),     cmocka_unit_test(test_holes_and_concave),  cmocka_unit_test(test_source_numbers),
        cmocka_unit_test(test_area_light), cmocka_unit_test(test_long_columns),       cmocka_unit_test(test_nothing),            cmocka_unit_test(test_threads_and_demand),
        cmocka_unit_test(test_scene_that_changed), cmocka_unit_test(test_from_columns),     cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, make_context, drop_context) != 0;
}
