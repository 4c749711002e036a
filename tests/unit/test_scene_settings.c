/* test_scene_settings.c -- settings over scene files, mesh files as scenes, numbers. Place: tests of src/io. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "io/yaml_value.h"

#include <gnomon/gnomon_io.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/gnomon-test-XXXXXX";

static const char scene_text[] = "gnomon: 1\n"
                                 "camera: {eye: [0, -5, 1], target: [0, 0, 1]}\n"
                                 "lights:\n"
                                 "  - {name: lamp, type: point, position: [2, -3, 5]}\n"
                                 "  - {type: directional, direction: [0, 0, -1]}\n"
                                 "materials: {brick: {diffuse: [0.6, 0.2, 0.1]}}\n"
                                 "objects:\n"
                                 "  - {polygon: [[0,0,0],[1,0,0],[0,1,0]], material: brick}\n";

static const char *const files[][2] = {
    {"scene.yaml", scene_text},
    {"tall.obj", "v 0 0 0\nv 1 0 0\nv 0 4 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\n"},
    {"plan.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 9 9 1\nf 1 2 4\nf 1 4 3\n"},
    {"smooth.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n"},
    {"flat.obj", "v 5 5 5\nv 6 5 5\nv 5 6 5\nf 1 2 3\n"},
    {"box.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 2\nendloop\nendfacet\nendsolid a\n"},
};

enum { FILES = sizeof files / sizeof *files };

static int set_up(void **state)
{
    (void)state;
    if (!mkdtemp(folder) || chdir(folder) != 0) return -1;
    for (int i = 0; i < FILES; i++) {
        FILE *file = fopen(files[i][0], "wb");
        if (!file || fputs(files[i][1], file) < 0 || fclose(file) != 0) return -1;
    }
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    for (int i = 0; i < FILES; i++) remove(files[i][0]);
    return chdir("/") == 0 && rmdir(folder) == 0 ? 0 : -1;
}

static void near_to(double value, double wanted)
{
    if (!(fabs(value - wanted) <= 1e-12 * (1 + fabs(wanted)))) fail_msg("%.17g is not %.17g", value, wanted);
}

static void three(const double v[3], double x, double y, double z)
{
    near_to(v[0], x);
    near_to(v[1], y);
    near_to(v[2], z);
}

static gno_context *new_context(void)
{
    gno_context *context = NULL;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    return context;
}

/* Settings are "key=value" texts, NULL at the end. */
static gno_scene *load_with(gno_context *context, const char *path, const char *const *texts)
{
    gno_setting settings[8] = {{NULL, NULL}};
    char keys[8][128];
    size_t count = 0;
    gno_scene *scene = NULL;
    for (; texts && texts[count]; count++) {
        const char *equals = strchr(texts[count], '=');
        snprintf(keys[count], sizeof keys[count], "%.*s", (int)(equals - texts[count]), texts[count]);
        settings[count].key = keys[count];
        settings[count].value = equals + 1;
    }
    gno_status status = gno_scene_load(context, path, settings, count, &scene);
    assert_true((status == GNO_OK) == (scene != NULL));
    return scene;
}

static gno_scene *load(gno_context *context, const char *path, const char *const *texts)
{
    gno_scene *scene = load_with(context, path, texts);
    if (!scene) fail_msg("%s", gno_context_message(context));
    return scene;
}

/* ---- settings ---------------------------------------------------------------------------------------------------------------- */

static void test_settings(void **state)
{
    (void)state;
    static const char *const texts[] = {"camera.eye=[1, 2, 3]",
                                        "lights[0].intensity=[0.5, 0.25, 0.125]",
                                        "lights[1].direction[0]=0.5",
                                        "materials.brick.specular=0.5",
                                        "materials.oak={diffuse: 0.3}",
                                        "objects[0].shading=phong",
                                        "image.width=320",
                                        NULL};
    gno_context *context = new_context();
    gno_scene *scene = load(context, "scene.yaml", texts);
    gno_camera camera = gno_scene_camera(scene);
    gno_light light;
    gno_polygon p;
    gno_material m;
    three(camera.eye, 1, 2, 3);
    three(camera.target, 0, 0, 1);
    gno_scene_light(scene, 0, &light, NULL);
    three(light.intensity, 0.5, 0.25, 0.125);
    gno_scene_light(scene, 1, &light, NULL);
    three(light.direction, 0.5, 0, -1);
    gno_scene_polygon(scene, 0, &p);
    assert_int_equal(p.shading, GNO_SHADING_PHONG);
    gno_scene_material(scene, p.material, &m);
    three(m.specular, 0.5, 0.5, 0.5);
    three(m.diffuse, 0.6, 0.2, 0.1);
    assert_int_equal(gno_scene_count(scene).materials, 3);
    assert_int_equal(gno_scene_image(scene).width, 320);
    assert_int_equal(gno_scene_image(scene).height, 720);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void test_later_settings_win(void **state)
{
    (void)state;
    static const char *const texts[] = {"image={width: 10, height: 20}", "image.width=30", "lights=", "ambient=.5", NULL};
    gno_context *context = new_context();
    gno_scene *scene = load(context, "scene.yaml", texts);
    assert_int_equal(gno_scene_image(scene).width, 30);
    assert_int_equal(gno_scene_image(scene).height, 20);
    assert_int_equal(gno_scene_count(scene).lights, 0);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void expect_message(const char *path, const char *setting, const char *message)
{
    const char *const texts[] = {setting, NULL};
    gno_context *context = new_context();
    gno_scene *scene = load_with(context, path, texts);
    assert_null(scene);
    assert_string_equal(gno_context_message(context), message);
    gno_context_destroy(context);
}

static void test_bad_settings(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        {"camera.eye=[1, 2]", "--set camera.eye: must have 3 numbers, has 2"},
        {"camera.eye=[1, 2, .nan]", "--set camera.eye[2]: .nan is not a finite number"},
        {"camera.eyes=3", "--set camera.eyes: unknown key, did you mean \"eye\"?"},
        {"camera.eye=[0, 0, 1]", "--set camera.eye: eye and target are the same point"},
        {"camera.up=[0, 1, 0]", "--set camera.up: is parallel to the view direction"},
        {"camera.eye=", "--set camera.eye: must be three numbers, [.., .., ..], is nothing"},
        {"camera.eye=[1, 2", "--set camera.eye: not YAML: while parsing a flow sequence did not find expected ',' or ']'"},
        {"camera.eye={a: 1, a: 2}", "--set camera.eye.a: is given twice"},
        {"lights[0].type=sunny", "--set lights[0].type: \"sunny\" is not one of point, directional, spot, area"},
        {"lights[2].type=point", "--set lights[2].type: the list has 2 entries, counted from 0"},
        {"lights[0=3", "--set lights[0: an index is a number in brackets, as in lights[0]"},
        {"lights[-1].type=point", "--set lights[-1].type: an index is a number in brackets, as in lights[0]"},
        {"lights[0]type=point", "--set lights[0]type: after an index comes a dot or another index"},
        {"camera[0]=3", "--set camera[0]: there is no list at the place of the index"},
        {"lights.lamp=3", "--set lights.lamp: the place of \"lamp\" is not one that has keys"},
        {"=3", "--set : is not a key like camera.eye or lights[0].intensity"},
        {"camera..eye=3", "--set camera..eye: is not a key like camera.eye or lights[0].intensity"},
        {"camera.=3", "--set camera.: is not a key like camera.eye or lights[0].intensity"},
        {"foo.bar=3", "--set foo: unknown key, the known ones are gnomon, image, camera, ambient, lights, materials, objects"},
        {"image.width=0", "--set image.width: 0 is not between 1 and 65536"},
        {"objects[0].material=oak", "--set objects[0].material: there is no material \"oak\""},
        {"lights[1].angle=3", "--set lights[1].angle: has no meaning for a directional light"},
        {"lights[0]={type: spot, position: [0, 0, 1]}", "--set lights[0].direction: is missing, a spot light needs it"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) expect_message("scene.yaml", rows[i][0], rows[i][1]);
    expect_message("flat.obj", "materials.a=3",
                   "--set materials: unknown key, the known ones are image, camera, ambient, lights, shading, crease, up, details");
    expect_message("flat.obj", "up=w", "--set up: \"w\" is not one of x, y, z");
    expect_message("flat.obj", "lights[0].intensity=1", "--set lights[0].intensity: there is no list at the place of the index");
}

/* ---- mesh files as scenes ------------------------------------------------------------------------------------------------------ */

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++) c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* The farthest that the object's corners reach, 1 being the frame's edge, in x and y. */
static void reach(const gno_scene *scene, int object, double *x, double *y)
{
    gno_camera camera = gno_scene_camera(scene);
    gno_image_def image = gno_scene_image(scene);
    double view[3], side[3], top[3], t = tan(camera.fov * 3.14159265358979323846 / 360);
    for (int i = 0; i < 3; i++) view[i] = camera.target[i] - camera.eye[i];
    cross(view, camera.up, side);
    cross(side, view, top);
    *x = *y = 0;
    for (size_t i = 0; i < gno_scene_count(scene).polygons; i++) {
        gno_polygon p;
        assert_int_equal(gno_scene_polygon(scene, i, &p), GNO_OK);
        for (unsigned c = p.ring_start[0]; c < p.ring_start[p.ring_count] && p.object == object; c++) {
            double d[3];
            for (int k = 0; k < 3; k++) d[k] = p.positions[3 * p.corner_vertex[c] + k] - camera.eye[k];
            double depth = dot(d, view) / sqrt(dot(view, view));
            assert_true(depth > 0);
            *x = fmax(*x, fabs(dot(d, side)) / sqrt(dot(side, side)) / depth / t * image.height / image.width);
            *y = fmax(*y, fabs(dot(d, top)) / sqrt(dot(top, top)) / depth / t);
        }
    }
}

static void test_default_view(void **state)
{
    (void)state;
    static const struct {
        const char *path, *setting;
        int up;
    } rows[] = {{"tall.obj", NULL, 1}, {"plan.obj", NULL, 2},    {"plan.obj", "up=x", 0}, {"box.stl", NULL, 2},
                {"flat.obj", NULL, 2}, {"tall.obj", "up=z", 2}, {"tall.obj", "image={width: 300, height: 600}", 1}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *const texts[] = {rows[i].setting, NULL};
        double x, y, lower[3], upper[3];
        const char *name;
        gno_context *context = new_context();
        gno_scene *scene = load(context, rows[i].path, texts);
        gno_camera camera = gno_scene_camera(scene);
        near_to(camera.up[rows[i].up], 1);
        reach(scene, 0, &x, &y);
        near_to(fmax(x, y), 0.9); /* touches the margin, and does so on both sides */
        assert_int_equal(gno_scene_count(scene).lights, 2);
        assert_int_equal(gno_scene_light(scene, 0, NULL, &name), GNO_OK);
        assert_string_equal(name, "sun");
        assert_int_equal(gno_scene_count(scene).objects, 2); /* the ground lies below all */
        gno_scene_bounds(scene, lower, upper);
        gno_polygon p;
        gno_scene_polygon(scene, gno_scene_count(scene).polygons - 1, &p);
        near_to(p.positions[3 * p.corner_vertex[p.ring_start[0]] + rows[i].up], lower[rows[i].up]);
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
}

static void test_mesh_settings(void **state)
{
    (void)state;
    static const char *const texts[] = {"camera.eye=[9, 9, 9]", "image.width=640", "ambient=0.5",
                                        "lights=[{name: mine, position: [0, 0, 9]}]", "shading=gouraud", NULL};
    gno_context *context = new_context();
    gno_scene *scene = load(context, "tall.obj", texts);
    gno_polygon p;
    const char *name;
    double ambient[3];
    three(gno_scene_camera(scene).eye, 9, 9, 9);
    assert_int_equal(gno_scene_image(scene).width, 640);
    gno_scene_ambient(scene, ambient);
    near_to(ambient[1], 0.5);
    assert_int_equal(gno_scene_count(scene).lights, 1);
    gno_scene_light(scene, 0, NULL, &name);
    assert_string_equal(name, "mine");
    gno_scene_polygon(scene, 0, &p);
    assert_int_equal(p.shading, GNO_SHADING_GOURAUD);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void test_mesh_shading(void **state)
{
    (void)state;
    gno_context *context = new_context();
    gno_polygon p;
    gno_scene *scene = load(context, "flat.obj", NULL);
    gno_scene_polygon(scene, 0, &p);
    assert_int_equal(p.shading, GNO_SHADING_FLAT);
    gno_scene_destroy(scene);
    scene = load(context, "smooth.obj", NULL);
    gno_scene_polygon(scene, 0, &p);
    assert_int_equal(p.shading, GNO_SHADING_PHONG);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* ---- numbers -------------------------------------------------------------------------------------------------------------------- */

static void check_numbers(void)
{
    static const char *const good[] = {"0", "-0", "1", "+1", ".5", "-.5", "5.", "1e3", "1E-3", "1.25e+2", "0.1", "123456789012345",
                                       "1234567890123456789", "2.2250738585072011e-308", "4.9e-324", "1.7976931348623157e308",
                                       "0.30000000000000004", "9007199254740993", "1e22", "1e23", "8.5e-22",
                                       "100000000000000000000000000000000000000000000000000e-50", "0.000000000000000000000001"};
    static const char *const bad[] = {"", "-", "+", ".", "e3", "1e", "1e+", "1.2.3", "1,5", "0x", "0xg", "0o8", "-0x1", "1_0",
                                      "nan", "inf", ".infinity", "1 2", " 1", "1f", "--1", "+-1", "0b1", "1:30", "true"};
    double number;
    char *end;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        char text[128]; /* strtod in the present locale is the judge */
        snprintf(text, sizeof text, "%s", good[i]);
        char *point = strchr(text, '.');
        if (point) *point = *localeconv()->decimal_point;
        if (!gnoi_yaml_parse_number(good[i], &number)) fail_msg("%s is no number", good[i]);
        double wanted = strtod(text, &end);
        assert_int_equal(*end, 0);
        assert_memory_equal(&number, &wanted, sizeof number);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        if (gnoi_yaml_parse_number(bad[i], &number)) fail_msg("\"%s\" is %g", bad[i], number);
    }
    assert_true(gnoi_yaml_parse_number("0x1F", &number) && number == 31);
    assert_true(gnoi_yaml_parse_number("0o17", &number) && number == 15);
    assert_true(gnoi_yaml_parse_number("010", &number) && number == 10);
    assert_true(gnoi_yaml_parse_number("-.Inf", &number) && number < 0 && isinf(number));
    assert_true(gnoi_yaml_parse_number(".NaN", &number) && isnan(number));
    assert_true(gnoi_yaml_parse_number("1e99999999999", &number) && isinf(number));
    assert_true(gnoi_yaml_parse_number("1e-99999999999", &number) && number == 0);
}

static void test_numbers(void **state)
{
    (void)state;
    static const char *const locales[] = {"C", "de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "ru_RU.UTF-8"};
    for (size_t i = 0; i < sizeof locales / sizeof *locales; i++) {
        if (setlocale(LC_NUMERIC, locales[i])) check_numbers();
    }
    setlocale(LC_NUMERIC, "C");
}

static void test_long_numbers(void **state)
{
    (void)state;
    char text[4096];
    double number;
    memset(text, '0', sizeof text);
    text[1] = '.';
    memcpy(text + 3000, "5e3000", 7);
    assert_true(gnoi_yaml_parse_number(text, &number) && number >= 0 && isfinite(number));
    memset(text, '9', 3000);
    memcpy(text + 3000, "e-2990", 7);
    assert_true(gnoi_yaml_parse_number(text, &number));
    near_to(number, 1e10);
}

static void test_nearest(void **state)
{
    (void)state;
    gnoi_nearest nearest = gnoi_nearest_start("positoin");
    gnoi_nearest_try(&nearest, "direction");
    gnoi_nearest_try(&nearest, "position");
    gnoi_nearest_try(&nearest, "intensity");
    assert_string_equal(nearest.best, "position");
    assert_int_equal(nearest.distance, 1);
    nearest = gnoi_nearest_start("qqqqqqqq");
    gnoi_nearest_try(&nearest, "position");
    assert_null(nearest.best);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_settings),      cmocka_unit_test(test_later_settings_win), cmocka_unit_test(test_bad_settings),
        cmocka_unit_test(test_default_view),  cmocka_unit_test(test_mesh_settings),      cmocka_unit_test(test_mesh_shading),
        cmocka_unit_test(test_numbers),       cmocka_unit_test(test_long_numbers),       cmocka_unit_test(test_nearest),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down) != 0;
}
