/* test_pictures.c -- small pictures of our own scenes, held to stored ones and, at scattered pixels, to the oracle.
 *
 * Stored pictures, tests/pictures/NAME.pfm, were made by the engine and judged in every pixel by the oracle before
 * they were taken in. To take in new ones, from the project's folder:
 *   GNOMON_PICTURES_JUDGE=1 build/tests/pictures/test_pictures      every pixel against the oracle; takes minutes
 *   GNOMON_PICTURES_WRITE=tests/pictures build/tests/pictures/test_pictures
 * GNOMON_PICTURES_WRITE=folder writes what the engine drew, so that a picture that differs can be looked at.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <gnomon/gnomon_io.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/compare.h"
#include "support/oracle.h"
#include "support/random_scene.h"

#define WIDTH 112
#define HEIGHT 63
#define PIXELS (WIDTH * HEIGHT)
#define RAYS 10
#define SHOWN 6

/* Stored pictures: what other sample lines, or an edge moved by rounding, may change. */
#define STORED_RMS 1e-3
#define STORED_PIXEL 0.02
#define STORED_ABOVE (PIXELS / 500)

/* The oracle's noise and the engine's 16 lines in one pixel, as shares of the contrast among its rays. */
#define PROBE 4e-3
#define PROBE_CONTRAST 0.12
#define RAYS_AGAIN 40

/* Face tests that the probes of one scene may cost. */
#define BUDGET 1.5e8

static int is_set(const char *name)
{
    const char *text = getenv(name);
    return text && *text;
}

static int agrees(const float *engine, const oracle_pixel *p)
{
    for (int k = 0; k < 3; k++) {
        double slack = PROBE + PROBE_CONTRAST * (p->upper[k] - p->lower[k]);
        double e = (double)engine[k], least = fmin(p->rgb[k], p->centred[k]), most = fmax(p->rgb[k], p->centred[k]);
        if (!(e >= least - slack && e <= most + slack)) return 0;
    }
    return 1;
}

/* Holds one pixel to the oracle, with more rays where the first do not agree; 1 when it is wrong. */
static int pixel_is_wrong(const oracle *o, const float *rgb, int x, int y, int show)
{
    const float *e = rgb + 3 * (y * WIDTH + x);
    oracle_pixel p = oracle_look_pixel(o, x, y, RAYS, 1);
    if (agrees(e, &p)) return 0;
    p = oracle_look_pixel(o, x, y, RAYS_AGAIN, 2);
    if (agrees(e, &p)) return 0;
    if (show)
        print_message("pixel (%d,%d): engine %.4f %.4f %.4f, oracle %.4f %.4f %.4f\n", x, y, (double)e[0], (double)e[1], (double)e[2],
                      p.rgb[0], p.rgb[1], p.rgb[2]);
    return 1;
}

/* One pixel in each of columns x rows fields of the picture, or every pixel. */
static void check_oracle(gno_scene *scene, const float *rgb)
{
    uint64_t random = 3;
    int wrong = 0;
    oracle *o = oracle_create(scene);
    assert_non_null(o);
    double each = (double)oracle_polygons(o) * (1 + (double)oracle_lights(o)) * RAYS * RAYS;
    int rows = (int)sqrt(BUDGET / each / 1.6), columns;
    rows = is_set("GNOMON_PICTURES_JUDGE") ? HEIGHT : rows < 3 ? 3 : rows > 12 ? 12 : rows;
    columns = rows == HEIGHT ? WIDTH : rows * 16 / 10;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            double u = random_unit(&random), v = random_unit(&random);
            wrong += pixel_is_wrong(o, rgb, (int)((j + u) * WIDTH / columns), (int)((i + v) * HEIGHT / rows), wrong < SHOWN);
        }
    oracle_destroy(o);
    assert_int_equal(wrong, 0);
}

static void check_stored(const char *name, const float *rgb)
{
    char path[512];
    int width = 0, height = 0;
    snprintf(path, sizeof path, "tests/pictures/%s.pfm", name);
    float *stored = picture_read_pfm(path, &width, &height);
    if (!stored) fail_msg("cannot read %s; tests run from the project's folder", path);
    assert_int_equal(width, WIDTH);
    assert_int_equal(height, HEIGHT);
    picture_difference d = picture_compare(rgb, stored, PIXELS, STORED_PIXEL);
    free(stored);
    if (d.rms <= STORED_RMS && d.above <= STORED_ABOVE && d.broken == 0) return;
    fail_msg("%s: RMS %g, %lu pixels differ, most (%g) at (%d,%d)", name, d.rms, (unsigned long)d.above, d.max, (int)(d.worst % WIDTH),
             (int)(d.worst / WIDTH));
}

static void check_picture(const char *name)
{
    const gno_setting settings[] = {{"image.width", "112"}, {"image.height", "63"}};
    char path[512];
    gno_context *context = NULL;
    gno_scene *scene = NULL;
    gno_render_def d = gno_render_def_default();
    float *rgb = malloc(3 * PIXELS * sizeof *rgb);
    const char *folder = getenv("GNOMON_PICTURES_WRITE");
    assert_non_null(rgb);
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    snprintf(path, sizeof path, "scenes/%s.yaml", name);
    if (gno_scene_load(context, path, settings, 2, &scene) != GNO_OK) fail_msg("%s", gno_context_message(context));
    d.lines = d.base_lines = 16; /* fixed, so that new defaults do not need new pictures */
    assert_int_equal(gno_render(scene, &d, rgb, NULL), GNO_OK);
    if (folder && *folder) {
        snprintf(path, sizeof path, "%s/%s.pfm", folder, name);
        assert_true(picture_write_pfm(path, WIDTH, HEIGHT, rgb));
    }
    check_oracle(scene, rgb);
    check_stored(name, rgb);
    free(rgb);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void test_crossing(void **state) { (void)state; check_picture("crossing"); }
static void test_details(void **state) { (void)state; check_picture("details"); }
static void test_glass(void **state) { (void)state; check_picture("glass"); }
static void test_house(void **state) { (void)state; check_picture("house"); }
static void test_lamps(void **state) { (void)state; check_picture("lamps"); }
static void test_room(void **state) { (void)state; check_picture("room"); }
static void test_smooth(void **state) { (void)state; check_picture("smooth"); }
static void test_soft_shadows(void **state) { (void)state; check_picture("soft_shadows"); }
static void test_sundial(void **state) { (void)state; check_picture("sundial"); }
static void test_town(void **state) { (void)state; check_picture("town"); }

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_crossing), cmocka_unit_test(test_house),  cmocka_unit_test(test_lamps),   cmocka_unit_test(test_room),
        cmocka_unit_test(test_smooth),   cmocka_unit_test(test_sundial), cmocka_unit_test(test_town),    cmocka_unit_test(test_details),
        cmocka_unit_test(test_glass),    cmocka_unit_test(test_soft_shadows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
