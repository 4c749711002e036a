/* test_scene_yaml.c -- scene files read back through the getters, and what is said about bad ones. Place: tests of src/io. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon_io.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- files and contexts ---------------------------------------------------------------------------------------------------- */

static char folder[] = "/tmp/gnomon-test-XXXXXX";
static char log_text[4096];
static int log_count;
static size_t empty_memory; /* what a context holds by itself */

static void on_log(void *user, gno_log_level level, const char *text)
{
    (void)user;
    assert_int_equal(level, GNO_LOG_WARNING);
    snprintf(log_text, sizeof log_text, "%s", text);
    log_count++;
}

static void put(const char *name, const char *text)
{
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
}

static gno_context *new_context(void)
{
    gno_context *context = NULL;
    gno_context_def def = gno_context_def_default();
    def.log = on_log;
    log_count = 0;
    log_text[0] = 0;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    empty_memory = gno_context_memory(context, NULL);
    return context;
}

static void end_context(gno_context *context)
{
    assert_int_equal(gno_context_memory(context, NULL), empty_memory);
    gno_context_destroy(context);
}

static gno_scene *load(gno_context *context, const char *text)
{
    gno_scene *scene = NULL;
    put("scene.yaml", text);
    gno_status status = gno_scene_load(context, "scene.yaml", NULL, 0, &scene);
    if (status != GNO_OK) print_error("%s\n", gno_context_message(context));
    assert_int_equal(status, GNO_OK);
    assert_non_null(scene);
    return scene;
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

static int set_up(void **state)
{
    (void)state;
    if (!mkdtemp(folder) || chdir(folder) != 0) return -1;
    put("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    put("broken.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n");
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    remove("scene.yaml");
    remove("tri.obj");
    remove("broken.obj");
    return chdir("/") == 0 && rmdir(folder) == 0 ? 0 : -1;
}

/* ---- good scenes ------------------------------------------------------------------------------------------------------------- */

static void test_smallest_scene(void **state)
{
    (void)state;
    gno_context *context = new_context();
    gno_scene *scene = load(context, "gnomon: 1\n");
    gno_scene_counts counts = gno_scene_count(scene);
    gno_image_def image = gno_scene_image(scene);
    gno_camera camera = gno_scene_camera(scene);
    assert_int_equal(counts.polygons, 0);
    assert_int_equal(counts.lights, 0);
    assert_int_equal(counts.materials, 1);
    assert_int_equal(image.width, 1280);
    assert_int_equal(image.height, 720);
    three(camera.eye, 3, -6, 2);
    gno_scene_destroy(scene);
    end_context(context);
}

static void test_view(void **state)
{
    (void)state;
    gno_context *context = new_context();
    gno_scene *scene = load(context, "gnomon: 1\n"
                                     "image:   {width: 640, height: 480, background: [0.02, 3e-2, .05]}\n"
                                     "camera:  {type: orthographic, eye: [3, -6, +2], target: [0, 0, 1], up: [0, 0, 2], height: 8}\n"
                                     "ambient: 0.25\n");
    gno_image_def image = gno_scene_image(scene);
    gno_camera camera = gno_scene_camera(scene);
    double ambient[3];
    assert_int_equal(image.width, 640);
    assert_int_equal(image.height, 480);
    three(image.background, 0.02, 0.03, 0.05);
    assert_int_equal(camera.type, GNO_CAMERA_ORTHOGRAPHIC);
    three(camera.eye, 3, -6, 2);
    three(camera.target, 0, 0, 1);
    three(camera.up, 0, 0, 2);
    near_to(camera.height, 8);
    near_to(camera.fov, 40);
    gno_scene_ambient(scene, ambient);
    three(ambient, 0.25, 0.25, 0.25);
    gno_scene_destroy(scene);
    end_context(context);
}

static void test_lights(void **state)
{
    (void)state;
    gno_context *context = new_context();
    gno_scene *scene = load(
        context, "gnomon: 1\n"
                 "lights:\n"
                 "  - {name: lamp, type: point, position: [2, -3, 5], intensity: [0.8, 0.7, 0.6], falloff: linear, k: 2,\n"
                 "     distance: light, softness: 0}\n"
                 "  - {type: directional, direction: [-0.4, 0.3, -1]}\n"
                 "  - {type: spot, position: [1, 2, 3], direction: [0, 0, -1], angle: 30, falloff: inverse_square}\n"
                 "  - {type: area, position: [1, 2, 3], edge1: [1, 0, 0], edge2: [0, 2, 0], samples: 3, intensity: 0.5}\n"
                 "  - &again {position: [0, 0, 9], falloff: linear, distance: viewer}\n"
                 "  - *again\n");
    gno_light light;
    const char *name;
    assert_int_equal(gno_scene_count(scene).lights, 6);
    assert_int_equal(gno_scene_light(scene, 0, &light, &name), GNO_OK);
    assert_string_equal(name, "lamp");
    assert_int_equal(light.type, GNO_LIGHT_POINT);
    three(light.position, 2, -3, 5);
    three(light.intensity, 0.8, 0.7, 0.6);
    assert_int_equal(light.falloff, GNO_FALLOFF_LINEAR);
    near_to(light.falloff_k, 2);
    assert_int_equal(light.distance_from_viewer, 0);
    gno_scene_light(scene, 1, &light, &name);
    assert_string_equal(name, "light1");
    assert_int_equal(light.type, GNO_LIGHT_DIRECTIONAL);
    three(light.direction, -0.4, 0.3, -1);
    three(light.intensity, 1, 1, 1);
    gno_scene_light(scene, 2, &light, &name);
    assert_int_equal(light.type, GNO_LIGHT_SPOT);
    near_to(light.angle, 30);
    assert_int_equal(light.falloff, GNO_FALLOFF_INVERSE_SQUARE);
    gno_scene_light(scene, 3, &light, &name);
    assert_int_equal(light.type, GNO_LIGHT_AREA);
    three(light.edge2, 0, 2, 0);
    assert_int_equal(light.samples, 3);
    three(light.intensity, 0.5, 0.5, 0.5);
    gno_scene_light(scene, 5, &light, &name);
    assert_string_equal(name, "light5");
    assert_int_equal(light.type, GNO_LIGHT_POINT);
    assert_int_equal(light.distance_from_viewer, 1);
    three(light.position, 0, 0, 9);
    gno_scene_destroy(scene);
    end_context(context);
}

static void test_materials(void **state)
{
    (void)state;
    gno_context *context = new_context();
    gno_scene *scene = load(context, "gnomon: 1\n"
                                     "materials:\n"
                                     "  brick: {ambient: [0.6,0.2,0.15], diffuse: [0.6,0.2,0.1], specular: 0.1, shininess: 20, shading: phong,\n"
                                     "          two_sided: false, transmission: [0.1, 0.2, 1], reflection: 0, ior: 1.0}\n"
                                     "  plain: {}\n"
                                     "objects:\n"
                                     "  - {polygon: [[0,0,0],[1,0,0],[0,1,0]], material: plain}\n"
                                     "  - {polygon: [[0,0,1],[1,0,1],[0,1,1]], material: brick}\n"
                                     "  - {polygon: [[0,0,1],[1,0,1],[0,1,1]], material: brick, shading: constant}\n"
                                     "  - {polygon: [[0,0,2],[1,0,2],[0,1,2]]}\n");
    gno_material m;
    gno_polygon p;
    assert_int_equal(gno_scene_polygon(scene, 1, &p), GNO_OK);
    assert_int_equal(p.shading, GNO_SHADING_PHONG);
    assert_int_equal(gno_scene_material(scene, p.material, &m), GNO_OK);
    three(m.ambient, 0.6, 0.2, 0.15);
    three(m.diffuse, 0.6, 0.2, 0.1);
    three(m.specular, 0.1, 0.1, 0.1);
    near_to(m.shininess, 20);
    three(m.transmission, 0.1, 0.2, 1);
    assert_int_equal(m.two_sided, 0);
    gno_scene_polygon(scene, 0, &p);
    gno_scene_material(scene, p.material, &m);
    assert_int_not_equal(p.material, 0);
    three(m.ambient, 0.8, 0.8, 0.8);
    three(m.diffuse, 0.8, 0.8, 0.8);
    three(m.specular, 0, 0, 0);
    near_to(m.shininess, 1);
    assert_int_equal(m.two_sided, 1);
    gno_scene_polygon(scene, 2, &p);
    assert_int_equal(p.shading, GNO_SHADING_CONSTANT);
    gno_scene_polygon(scene, 3, &p);
    assert_int_equal(p.material, 0);
    assert_int_equal(log_count, 0);
    gno_scene_destroy(scene);
    end_context(context);
}

static void test_undrawn_keys_warn_once(void **state)
{
    (void)state;
    gno_context *context = new_context();
    gno_scene *scene = load(context, "gnomon: 1\n"
                                     "lights: [{type: point, position: [0,0,1], softness: 2}]\n"
                                     "materials:\n"
                                     "  a: {texture: {image: t/b.png, map: planar, origin: [0,0,0], u: [1,0,0], v: [0,0,1], scale: [2,2]},\n"
                                     "      bump: {image: t/h.png, amount: 0.05}, reflection: 0.2, ior: 1.5}\n"
                                     "  b: {texture: {procedural: wood, light: [0.7,0.5,0.3], dark: [0.4,0.2,0.1], rings: 12, seed: 1}}\n");
    assert_int_equal(log_count, 3); /* two pictures that are not there */
    assert_string_equal(log_text,
                        "scene.yaml: read and checked, but not drawn by this version: reflection, ior");
    gno_light light;
    assert_int_equal(gno_scene_light(scene, 0, &light, NULL), GNO_OK);
    near_to(light.softness, 2);
    gno_scene_destroy(scene);
    end_context(context);
}

static void test_polygon_with_holes(void **state)
{
    (void)state;
    gno_context *context = new_context();
    gno_scene *scene = load(context, "gnomon: 1\n"
                                     "objects:\n"
                                     "  - name: wall\n"
                                     "    polygon: [[0,0,0],[4,0,0],[4,0,3],[0,0,3]]\n"
                                     "    holes: [[[1,0,1],[1,0,2],[2,0,2],[2,0,1]], [[3,0,1],[3,0,2],[3.5,0,2]]]\n"
                                     "    transform: [{scale: [1, 2, 1]}, {rotate: [0,0,2], angle: 90}, {translate: [10,0,0]}]\n");
    gno_polygon p;
    double lower[3], upper[3];
    assert_int_equal(gno_scene_count(scene).polygons, 1);
    assert_int_equal(gno_scene_polygon(scene, 0, &p), GNO_OK);
    assert_int_equal(p.ring_count, 3);
    assert_int_equal(p.ring_start[1] - p.ring_start[0], 4);
    assert_int_equal(p.ring_start[2] - p.ring_start[1], 4);
    assert_int_equal(p.ring_start[3] - p.ring_start[2], 3);
    const double *corner = p.positions + 3 * p.corner_vertex[p.ring_start[2] + 2];
    three(corner, 10, 3.5, 2); /* a quarter turn is exact */
    assert_true(gno_scene_bounds(scene, lower, upper));
    three(lower, 10, 0, 0);
    three(upper, 10, 4, 3);
    gno_scene_destroy(scene);
    end_context(context);
}

static void test_sphere(void **state)
{
    (void)state;
    gno_context *context = new_context();
    gno_scene *scene = load(context, "gnomon: 1\n"
                                     "materials: {ball: {shading: phong}}\n"
                                     "objects: [{sphere: {center: [1, 2, 3], radius: 0.5}, material: ball}]\n");
    gno_scene_problems problems;
    gno_scene_counts counts = gno_scene_count(scene);
    assert_int_equal(counts.polygons, 64 * 32);
    for (size_t i = 0; i < counts.polygons; i++) {
        gno_polygon p;
        assert_int_equal(gno_scene_polygon(scene, i, &p), GNO_OK);
        assert_int_equal(p.shading, GNO_SHADING_PHONG);
        for (unsigned c = p.ring_start[0]; c < p.ring_start[1]; c++) {
            const double *v = p.positions + 3 * p.corner_vertex[c], *n = p.normals + 3 * p.corner_normal[c];
            three(v, 1 + 0.5 * n[0], 2 + 0.5 * n[1], 3 + 0.5 * n[2]);
            near_to(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1);
            const double *t = p.texcoords + 2 * p.corner_texcoord[c];
            double turn = atan2(n[1], n[0]) / 6.283185307179586;
            near_to(t[1], 1 - acos(n[2]) / 3.141592653589793);
            if (fabs(n[2]) < 1) near_to(cos(6.283185307179586 * (t[0] - turn)), 1);
            assert_true(t[0] >= 0 && t[0] <= 1);
        }
    }
    assert_int_equal(gno_scene_prepare(scene, 1, &problems), GNO_OK);
    assert_int_equal(problems.degenerate, 0);
    assert_int_equal(problems.non_planar, 0);
    gno_scene_destroy(scene);
    end_context(context);
}

static void test_details_add_up(void **state)
{
    (void)state;
    static const int wanted[] = {4, 3, 2, -5, 10};
    gno_context *context = new_context();
    gno_scene *scene = load(context, "gnomon: 1\n" /* in an order that is not the parents' */
                                     "objects:\n"
                                     "  - {name: c, polygon: [[0,0,0],[1,0,0],[0,1,0]], detail_of: b}\n"
                                     "  - {name: b, polygon: [[0,0,0],[1,0,0],[0,1,0]], detail_of: a, priority: -3}\n"
                                     "  - {name: a, polygon: [[0,0,0],[1,0,0],[0,1,0]], priority: 2}\n"
                                     "  - {polygon: [[0,0,0],[1,0,0],[0,1,0]], priority: -5}\n"
                                     "  - {polygon: [[0,0,0],[1,0,0],[0,1,0]], detail_of: b, priority: 7}\n");
    for (size_t i = 0; i < 5; i++) {
        gno_polygon p;
        assert_int_equal(gno_scene_polygon(scene, i, &p), GNO_OK);
        assert_int_equal(p.priority, wanted[i]);
    }
    gno_scene_destroy(scene);
    end_context(context);
}

static void test_mesh_object(void **state)
{
    (void)state;
    gno_context *context = new_context();
    gno_scene *scene = load(context, "gnomon: 1\n"
                                     "materials: {red: {diffuse: [1, 0, 0]}}\n"
                                     "objects:\n"
                                     "  - {mesh: tri.obj, material: red, shading: gouraud, crease: 40, normals: average, weighting: angle,\n"
                                     "     transform: [{translate: [0, 0, 0.5]}]}\n");
    gno_polygon p;
    gno_material m;
    assert_int_equal(gno_scene_polygon(scene, 0, &p), GNO_OK);
    assert_int_equal(p.shading, GNO_SHADING_GOURAUD);
    assert_int_equal(gno_scene_material(scene, p.material, &m), GNO_OK);
    three(m.diffuse, 1, 0, 0);
    three(p.positions + 3 * p.corner_vertex[p.ring_start[0] + 1], 1, 0, 0.5);
    gno_scene_destroy(scene);
    end_context(context);
}

static void test_alias_and_layout(void **state)
{
    (void)state;
    gno_context *context = new_context();
    gno_scene *scene = load(context, "%YAML 1.2\n---\n"
                                     "gnomon: 1\n"
                                     "materials:\n"
                                     "  a: &a\n"
                                     "    diffuse: &c [0.5, 0.25, 0x1]\n"
                                     "    ambient: *c\n"
                                     "  \"b\": *a\n"
                                     "lights: ~\n"
                                     "objects:\n"
                                     "  - polygon:\n"
                                     "      - [0, 0, 0]\n"
                                     "      - [1, 0, 0]\n"
                                     "      - [0, 1, 0]\n"
                                     "    material: b\n"
                                     "...\n");
    gno_polygon p;
    gno_material m;
    assert_int_equal(gno_scene_polygon(scene, 0, &p), GNO_OK);
    assert_int_equal(gno_scene_material(scene, p.material, &m), GNO_OK);
    three(m.ambient, 0.5, 0.25, 1);
    gno_scene_destroy(scene);
    end_context(context);
}

/* ---- bad scenes ---------------------------------------------------------------------------------------------------------------- */

typedef struct bad_scene {
    const char *text, *message;
} bad_scene;

#define G "gnomon: 1\n"
#define TRIANGLE "[[0,0,0],[1,0,0],[0,1,0]]"

static const bad_scene bad_scenes[] = {
#include "bad_scenes.h"
};

static void test_bad_scenes(void **state)
{
    (void)state;
    int wrong = 0;
    size_t count = sizeof bad_scenes / sizeof *bad_scenes;
    assert_true(count >= 60);
    for (size_t i = 0; i < count; i++) {
        gno_context *context = new_context();
        gno_scene *scene = (gno_scene *)context; /* any value that is not NULL */
        put("scene.yaml", bad_scenes[i].text);
        gno_status status = gno_scene_load(context, "scene.yaml", NULL, 0, &scene);
        if (status == GNO_OK || scene || strcmp(gno_context_message(context), bad_scenes[i].message)) {
            print_error("%s\n  says    %s\n  instead %s\n", bad_scenes[i].text, gno_context_message(context),
                        bad_scenes[i].message);
            wrong++;
        }
        if (status == GNO_OK) gno_scene_destroy(scene);
        end_context(context);
    }
    assert_int_equal(wrong, 0);
}

static void expect_status(const char *text, gno_status wanted)
{
    gno_context *context = new_context();
    gno_scene *scene = NULL;
    put("scene.yaml", text);
    assert_int_equal(gno_scene_load(context, "scene.yaml", NULL, 0, &scene), wanted);
    end_context(context);
}

static void test_statuses(void **state)
{
    (void)state;
    gno_context *context = new_context();
    gno_scene *scene = NULL;
    expect_status("gnomon: 2", GNO_ERROR_INPUT);
    expect_status(G "objects: [{mesh: nowhere.obj}]", GNO_ERROR_FILE);
    expect_status(G "lights: [{type: area, position: [0,0,0], edge1: [1,0,0], edge2: [0,1,0], samples: 64}, {position: [0,0,1]}]",
                  GNO_ERROR_LIMIT);
    assert_int_equal(gno_scene_load(context, "no/such.yaml", NULL, 0, &scene), GNO_ERROR_FILE);
    assert_string_equal(gno_context_message(context), "no/such.yaml: cannot be opened: No such file or directory");
    assert_int_equal(gno_scene_load(context, "no/such.obj", NULL, 0, &scene), GNO_ERROR_FILE);
    assert_int_equal(gno_scene_load(context, "scene.txt", NULL, 0, &scene), GNO_ERROR_INPUT);
    assert_string_equal(gno_context_message(context),
                        "scene.txt: \".txt\" is not one of .yaml, .yml, .obj, .ply, .stl, .gltf, .glb");
    assert_int_equal(gno_scene_load(context, NULL, NULL, 0, &scene), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_load(context, "scene.yaml", NULL, 1, &scene), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_load(context, "scene.yaml", NULL, 0, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_load(NULL, "scene.yaml", NULL, 0, &scene), GNO_ERROR_ARGUMENT);
    end_context(context);
}

/* Nine copies nine times over: 9^8 nodes would be 43 million. */
static void test_alias_bomb(void **state)
{
    (void)state;
    char text[4096] = "gnomon: 1\na0: &a0 [1,1,1,1,1,1,1,1,1]\n";
    for (int level = 1; level < 9; level++) {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "a%d: &a%d [*a%d,*a%d,*a%d,*a%d,*a%d,*a%d,*a%d,*a%d,*a%d]\n", level, level,
                 level - 1, level - 1, level - 1, level - 1, level - 1, level - 1, level - 1, level - 1, level - 1);
    }
    expect_status(text, GNO_ERROR_LIMIT);
}

static void test_deep_nesting(void **state)
{
    (void)state;
    size_t depth = 100000;
    char *text = malloc(2 * depth + 64);
    assert_non_null(text);
    strcpy(text, "gnomon: ");
    memset(text + 8, '[', depth);
    memset(text + 8 + depth, ']', depth);
    text[8 + 2 * depth] = 0;
    expect_status(text, GNO_ERROR_LIMIT);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_smallest_scene),         cmocka_unit_test(test_view),
        cmocka_unit_test(test_lights),                 cmocka_unit_test(test_materials),
        cmocka_unit_test(test_undrawn_keys_warn_once), cmocka_unit_test(test_polygon_with_holes),
        cmocka_unit_test(test_sphere),                 cmocka_unit_test(test_details_add_up),
        cmocka_unit_test(test_mesh_object),            cmocka_unit_test(test_alias_and_layout),
        cmocka_unit_test(test_bad_scenes),             cmocka_unit_test(test_statuses),
        cmocka_unit_test(test_alias_bomb),             cmocka_unit_test(test_deep_nesting),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down) != 0;
}
