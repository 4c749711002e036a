/* test_engines.c -- two engines, one picture: the scan-line engine at 16 lines and the Weiler-Atherton engine on our own scenes, on
 * random ones and on glass; no pixel differs that holds no edge. The pieces' mean colours add up to the picture; threads change nothing.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <gnomon/gnomon_io.h>
#include <gnomon/gnomon_pieces.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/random_scene.h"

#define WIDTH 160
#define HEIGHT 90
#define PIXELS (WIDTH * HEIGHT)

/* The engines' bound, and what an inner pixel may differ by: both round alike, but shade from sums in another order. */
#define MEAN 5e-4
#define RANDOM_MEAN 1e-3 /* edges and slivers everywhere */
#define INNER 0.01
#define INNER_PANES 0.03 /* panes that cross: the order turns over within a pixel, which shows little */
#define FLAT 0.02 /* contrast around a pixel without an edge */

static void draw(gno_scene *scene, gno_engine engine, int threads, float *rgb)
{
    gno_render_def def = gno_render_def_default();
    def.engine = engine;
    def.lines = def.base_lines = 16;
    def.threads = threads;
    if (gno_render(scene, &def, rgb, NULL) != GNO_OK) fail_msg("%s", gno_context_message(gno_scene_context(scene)));
}

/* The greatest difference between a pixel's and its neighbours' channels. */
static double contrast(const float *rgb, int x, int y)
{
    double most = 0;
    for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < HEIGHT; v++)
        for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < WIDTH; u++)
            for (int k = 0; k < 3; k++)
                most = fmax(most, fabs((double)rgb[3 * (v * WIDTH + u) + k] - (double)rgb[3 * (y * WIDTH + x) + k]));
    return most;
}

static void compare(const char *name, const float *a, const float *b, double mean, double inner)
{
    double sum = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double worst = 0;
            for (int k = 0; k < 3; k++) {
                double d = fabs((double)a[3 * (y * WIDTH + x) + k] - (double)b[3 * (y * WIDTH + x) + k]);
                if (!(d < 1e9)) fail_msg("%s: pixel (%d,%d) is no number", name, x, y);
                worst = fmax(worst, d);
                sum += d;
            }
            if (worst > inner && contrast(a, x, y) < FLAT) fail_msg("%s: pixel (%d,%d) is off by %g without an edge", name, x, y, worst);
        }
    if (!(sum / (3 * PIXELS) < mean)) fail_msg("%s: mean difference %g", name, sum / (3 * PIXELS));
}

static void check(const char *name, gno_scene *scene, double mean, double inner)
{
    float *a = malloc(3 * PIXELS * sizeof *a), *b = malloc(3 * PIXELS * sizeof *b);
    assert_non_null(a);
    assert_non_null(b);
    draw(scene, GNO_ENGINE_SCANLINE, 0, a);
    draw(scene, GNO_ENGINE_WEILER_ATHERTON, 1, b);
    compare(name, a, b, mean, inner);
    draw(scene, GNO_ENGINE_WEILER_ATHERTON, 3, a);
    assert_memory_equal(a, b, 3 * PIXELS * sizeof *a);
    free(a);
    free(b);
}

static gno_scene *load(const char *path, const gno_setting *more, size_t count)
{
    gno_setting settings[8] = {{"image.width", "160"}, {"image.height", "90"}};
    gno_context *context = NULL;
    gno_scene *scene = NULL;
    for (size_t i = 0; i < count; i++) settings[2 + i] = more[i];
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    if (gno_scene_load(context, path, settings, 2 + count, &scene) != GNO_OK) fail_msg("%s", gno_context_message(context));
    return scene;
}

static void unload(gno_scene *scene)
{
    gno_context *context = gno_scene_context(scene);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void check_own(const char *name, const gno_setting *more, size_t count)
{
    char path[64];
    snprintf(path, sizeof path, "scenes/%s.yaml", name);
    gno_scene *scene = load(path, more, count);
    check(name, scene, MEAN, INNER);
    unload(scene);
}

/* The penumbra of 6 x 6 points takes long; 2 x 2 tell as much. */
static void test_own_scenes(void **state)
{
    const gno_setting few[] = {{"lights[1].samples", "2"}};
    (void)state;
    check_own("crossing", NULL, 0);
    check_own("house", NULL, 0);
    check_own("room", NULL, 0);
    check_own("sundial", NULL, 0);
    check_own("town", NULL, 0);
    check_own("lamps", few, 1);
}

/* Panes before a wall and the background: one behind the other, crossing, tinted, over the shadow of a post. */
static const char glass[] =
    "gnomon: 1\n"
    "image: {background: [0.2, 0.3, 0.5]}\n"
    "camera: {eye: [0.4, -6, 1.6], target: [0, 0, 0.9], up: [0, 0, 1], fov: 36}\n"
    "ambient: [0.3, 0.3, 0.3]\n"
    "lights: [{type: directional, direction: [0.4, 0.7, -0.6]}]\n"
    "materials:\n"
    "  red: {ambient: [0.2,0,0], diffuse: [0.2,0,0], transmission: [0.8,0.2,0.2]}\n"
    "  blue: {ambient: [0,0,0.1], diffuse: [0,0,0.1], transmission: [0.3,0.3,0.9]}\n"
    "objects:\n"
    "  - {polygon: [[-3,-2,0],[3,-2,0],[3,2,0],[-3,2,0]]}\n"
    "  - {polygon: [[-1,1,0],[1.5,1,0],[1.5,1,2],[-1,1,2]]}\n"
    "  - {polygon: [[-0.2,-1.3,0],[0,-1.3,0],[0,-1.3,1.8],[-0.2,-1.3,1.8]]}\n"
    "  - {polygon: [[-2,-0.5,0.2],[0.6,-0.5,0.2],[0.6,-0.5,1.7],[-2,-0.5,1.7]], material: red}\n"
    "  - {polygon: [[-0.7,-1,0.4],[1.7,0.4,0.4],[1.7,0.4,2.2],[-0.7,-1,2.2]], material: blue}\n";

static void test_glass(void **state)
{
    char folder[] = "/tmp/gnomon_engines_XXXXXX", path[64];
    (void)state;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/glass.yaml", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(glass, file);
    fclose(file);
    gno_scene *scene = load(path, NULL, 0);
    remove(path);
    remove(folder);
    check("glass", scene, MEAN, INNER);
    unload(scene);
}

static int is_soft(const gno_scene *scene)
{
    for (int i = 0; (size_t)i < gno_scene_count(scene).lights; i++) {
        gno_light light;
        gno_scene_light(scene, i, &light, NULL);
        if (light.softness > 0) return 1;
    }
    return 0;
}

/* Soft shadows have no edges that pieces could follow. */
static void test_random_scenes(void **state)
{
    (void)state;
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (unsigned seed = 1; seed <= 2; seed++) {
            gno_context *context = NULL;
            char name[64];
            assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
            gno_scene *scene = random_scene(context, (scene_kind)kind, seed, WIDTH, HEIGHT);
            assert_non_null(scene);
            snprintf(name, sizeof name, "%s %u", scene_kind_name((scene_kind)kind), seed);
            if (!is_soft(scene)) check(name, scene, RANDOM_MEAN, kind == SCENE_PANES ? INNER_PANES : INNER);
            gno_scene_destroy(scene);
            gno_context_destroy(context);
        }
}

/* Areas in the picture times mean colours, and what is free of pieces times the background, are the picture's sum. */
static void test_means(void **state)
{
    const gno_setting few[] = {{"lights[1].samples", "2"}};
    const char *const scenes[] = {"scenes/town.yaml", "scenes/lamps.yaml"};
    (void)state;
    for (int s = 0; s < 2; s++) {
        gno_scene *scene = load(scenes[s], few, (size_t)s);
        const gno_image_def image = gno_scene_image(scene);
        for (int split = 1; split <= 2; split++) {
            gno_visible_def def = gno_visible_def_default();
            gno_pieces *pieces = NULL;
            double sum[3] = {0, 0, 0}, drawn[3] = {0, 0, 0}, covered = 0;
            float *rgb = malloc(3 * PIXELS * sizeof *rgb);
            def.split = split;
            assert_int_equal(gno_visible_pieces(scene, &def, &pieces, NULL), GNO_OK);
            const size_t count = gno_pieces_count(pieces);
            double *means = malloc(3 * count * sizeof *means);
            assert_non_null(means);
            assert_int_equal(gno_pieces_colours(scene, pieces, 2, means), GNO_OK);
            for (size_t i = 0; i < count; i++) {
                gno_piece p;
                double area = 0;
                gno_pieces_get(pieces, i, &p);
                for (size_t r = 0; r < p.ring_count; r++) {
                    const size_t first = p.ring_start[r], n = p.ring_start[r + 1] - first;
                    double *at = malloc(3 * n * sizeof *at);
                    assert_non_null(at);
                    assert_int_equal(gno_project_points(scene, n, p.points + 3 * first, at), GNO_OK);
                    for (size_t k = 0; k < n; k++) {
                        const double *a = at + 3 * k, *b = at + 3 * ((k + 1) % n);
                        area -= 0.5 * (a[0] / a[2] * b[1] / b[2] - b[0] / b[2] * a[1] / a[2]);
                    }
                    free(at);
                }
                covered += area;
                for (size_t k = 0; k < 3; k++) sum[k] += area * means[3 * i + k];
            }
            draw(scene, GNO_ENGINE_WEILER_ATHERTON, 0, rgb);
            for (int i = 0; i < 3 * PIXELS; i++) drawn[i % 3] += (double)rgb[i];
            for (int k = 0; k < 3; k++) {
                sum[k] += (PIXELS - covered) * image.background[k];
                if (!(fabs(sum[k] - drawn[k]) < 2e-5 * drawn[k]))
                    fail_msg("%s, split %d: %.9g for %.9g", scenes[s], split, sum[k], drawn[k]);
            }
            free(rgb);
            free(means);
            gno_pieces_destroy(pieces);
        }
        unload(scene);
    }
}

static void test_wrong_arguments(void **state)
{
    gno_scene *scene = load("scenes/crossing.yaml", NULL, 0), *other = load("scenes/town.yaml", NULL, 0);
    gno_pieces *pieces = NULL;
    double rgb[3], point[3] = {0, 0, 0};
    (void)state;
    assert_int_equal(gno_visible_pieces(other, NULL, &pieces, NULL), GNO_OK);
    double *means = malloc(3 * gno_pieces_count(pieces) * sizeof *means);
    assert_int_equal(gno_pieces_colours(scene, pieces, 1, means), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_pieces_colours(scene, NULL, 1, rgb), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_pieces_colours(other, pieces, -1, means), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_pieces_colours(NULL, pieces, 1, means), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_project_points(scene, 1, NULL, rgb), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_project_points(NULL, 1, point, rgb), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_project_points(scene, 0, NULL, NULL), GNO_OK);
    free(means);
    gno_pieces_destroy(pieces);
    unload(other);
    unload(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_own_scenes), cmocka_unit_test(test_glass),           cmocka_unit_test(test_random_scenes),
        cmocka_unit_test(test_means),      cmocka_unit_test(test_wrong_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
