/* test_scenes.c -- our own scenes: every one loads and is sound, and the sundial tells the right time.
 * Place: tests; run from the project's folder, as `make test` does.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <dirent.h>
#include <gnomon/gnomon_io.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEGREES (180 / 3.14159265358979323846)

static int warnings;

static void on_log(void *user, gno_log_level level, const char *text)
{
    (void)user;
    if (level != GNO_LOG_WARNING) return;
    print_error("%s\n", text);
    warnings++;
}

static gno_context *new_context(void)
{
    gno_context *context = NULL;
    gno_context_def def = gno_context_def_default();
    def.log = on_log;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    return context;
}

static gno_scene *load(gno_context *context, const char *path)
{
    gno_scene *scene = NULL;
    if (gno_scene_load(context, path, NULL, 0, &scene) != GNO_OK) fail_msg("%s", gno_context_message(context));
    return scene;
}

static void check_scene(const char *path)
{
    gno_context *context = new_context();
    gno_scene *scene = load(context, path);
    gno_scene_counts counts = gno_scene_count(scene);
    gno_scene_problems problems;
    warnings = 0;
    assert_true(counts.polygons > 0);
    assert_true(counts.lights > 0);
    assert_int_equal(gno_scene_prepare(scene, 1, &problems), GNO_OK);
    if (warnings + problems.degenerate + problems.non_planar > 0) {
        fail_msg("%s: %lu degenerate, %lu non-planar", path, (unsigned long)problems.degenerate, (unsigned long)problems.non_planar);
    }
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void test_every_scene_is_sound(void **state)
{
    (void)state;
    int count = 0;
    DIR *folder = opendir("scenes");
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        char path[300];
        const char *dot = strrchr(entry->d_name, '.');
        if (!dot || strcmp(dot, ".yaml")) continue;
        snprintf(path, sizeof path, "scenes/%s", entry->d_name);
        check_scene(path);
        count++;
    }
    closedir(folder);
    assert_true(count >= 7);
}

/* ---- the sundial ----------------------------------------------------------------------------------------------------------------- */

/* The gnomon is the one polygon that stands in the meridian plane x = 0; its tip is its highest corner. */
static void find_tip(const gno_scene *scene, double tip[3])
{
    int found = 0;
    for (size_t i = 0; i < gno_scene_count(scene).polygons; i++) {
        gno_polygon p;
        int in_meridian = 1;
        assert_int_equal(gno_scene_polygon(scene, i, &p), GNO_OK);
        for (unsigned c = p.ring_start[0]; c < p.ring_start[1]; c++) in_meridian &= p.positions[3 * p.corner_vertex[c]] == 0;
        if (!in_meridian) continue;
        found++;
        tip[2] = -1;
        for (unsigned c = p.ring_start[0]; c < p.ring_start[1]; c++) {
            const double *at = p.positions + 3 * p.corner_vertex[c];
            if (at[2] > tip[2]) memcpy(tip, at, 3 * sizeof *tip);
        }
    }
    assert_int_equal(found, 1);
}

/* Whether some hour line, a strip on the dial with its middle line through the origin, points this way (degrees from north). */
static int is_on_a_line(const gno_scene *scene, double angle)
{
    for (size_t i = 0; i < gno_scene_count(scene).polygons; i++) {
        gno_polygon p;
        assert_int_equal(gno_scene_polygon(scene, i, &p), GNO_OK);
        if (p.priority < 1 || p.ring_count != 1 || p.ring_start[1] - p.ring_start[0] != 4) continue;
        double near[2], far[2], middle[4][2];
        for (int k = 0; k < 4; k++) memcpy(middle[k], p.positions + 3 * p.corner_vertex[p.ring_start[0] + (unsigned)k], sizeof middle[k]);
        for (int k = 0; k < 2; k++) {
            near[k] = (middle[0][k] + middle[1][k]) / 2;
            far[k] = (middle[2][k] + middle[3][k]) / 2;
        }
        double a = atan2(near[0], near[1]) * DEGREES, b = atan2(far[0], far[1]) * DEGREES;
        if (hypot(near[0], near[1]) < 0.2 && fabs(a - b) < 0.01 && fabs(b - angle) < 0.01) return 1;
    }
    return 0;
}

static void test_sundial_tells_the_time(void **state)
{
    (void)state;
    const double latitude = 48.2, hour = 15;
    gno_context *context = new_context();
    gno_scene *scene = load(context, "scenes/sundial.yaml");
    gno_light sun;
    double tip[3];
    find_tip(scene, tip);
    assert_int_equal(gno_scene_light(scene, 0, &sun, NULL), GNO_OK);
    assert_int_equal(sun.type, GNO_LIGHT_DIRECTIONAL);
    /* The style points to the pole. */
    assert_true(fabs(atan2(tip[2], tip[1]) * DEGREES - latitude) < 0.001);
    /* The shadow of its tip on the dial, z = 0, and so that of the whole style, which starts at the origin. */
    double t = -tip[2] / sun.direction[2], x = tip[0] + t * sun.direction[0], y = tip[1] + t * sun.direction[1];
    double shadow = atan2(x, y) * DEGREES;
    double wanted = atan(sin(latitude / DEGREES) * tan(15 * (hour - 12) / DEGREES)) * DEGREES;
    assert_true(fabs(shadow - wanted) < 0.001);
    assert_true(is_on_a_line(scene, wanted));
    assert_false(is_on_a_line(scene, wanted + 0.5));
    /* The sun's height above the horizon by the formula of spherical astronomy. */
    double declination = -23.44 * cos(360.0 / 365 * (121 + 10) / DEGREES) / DEGREES;
    double height = sin(declination) * sin(latitude / DEGREES) + cos(declination) * cos(latitude / DEGREES) * cos(45 / DEGREES);
    double length = sqrt(sun.direction[0] * sun.direction[0] + sun.direction[1] * sun.direction[1] +
                         sun.direction[2] * sun.direction[2]);
    assert_true(fabs(-sun.direction[2] / length - height) < 1e-6);
    /* Every hour has its line. */
    for (int h = 7; h <= 17; h++) {
        double angle = 15.0 * (h - 12) / DEGREES;
        assert_true(is_on_a_line(scene, atan(sin(latitude / DEGREES) * tan(angle)) * DEGREES));
    }
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_scene_is_sound),
        cmocka_unit_test(test_sundial_tells_the_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
