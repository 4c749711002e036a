/* test_embedding.c -- the library inside another program: stopped at any question of the progress callback, held under a memory
 * ceiling, and two contexts at work in two threads at once.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fail_alloc.h"
#include "support/random_scene.h"
#include <gnomon/gnomon_io.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define WIDTH 160
#define HEIGHT 120
#define LEVEL 5 /* 20,480 triangles */
#define VALUES (3 * WIDTH * HEIGHT)

/* ---- stopping -------------------------------------------------------------------------------------------------------------- */

typedef struct watch {
    int questions, stop_at; /* stop_at 0: never */
    int wrong;              /* a fraction outside of [0,1], no stage, or another thread */
    double last, longest;   /* seconds of the processors between questions: what other programs take does not count */
    pthread_t caller;
} watch;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int on_progress(void *user, const char *stage, double fraction)
{
    watch *w = user;
    double t = now();
    w->wrong |= !stage || !stage[0] || !(fraction >= 0 && fraction <= 1) || !pthread_equal(w->caller, pthread_self());
    w->longest = t - w->last > w->longest ? t - w->last : w->longest;
    w->last = t;
    return ++w->questions == w->stop_at;
}

static gno_context *watched_context(watch *w)
{
    gno_context_def def = gno_context_def_default();
    gno_context *context = NULL;
    memset(w, 0, sizeof *w);
    w->caller = pthread_self();
    def.progress = on_progress;
    def.progress_user = w;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    return context;
}

/* Smooth triangles, an n-gon, two lights. */
static gno_scene *large_scene(gno_context *context)
{
    static const double centre[3] = {0, 0, 1.2}, ground[4][3] = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
    gno_scene *scene = NULL;
    gno_image_def image = gno_image_def_default();
    gno_light light = gno_light_default();
    image.width = WIDTH;
    image.height = HEIGHT;
    light.position[0] = 2;
    light.position[1] = -3;
    light.position[2] = 6;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_int_equal(gno_scene_add_light(scene, "a", &light, NULL), GNO_OK);
    light.position[0] = -4;
    assert_int_equal(gno_scene_add_light(scene, "b", &light, NULL), GNO_OK);
    assert_true(add_blob(scene, LEVEL, 1, 0.2, centre, 0, GNO_SHADING_PHONG) && add_polygon(scene, ground, 4, 0, 0));
    return scene;
}

static gno_status render(gno_scene *scene, int threads, float *rgb)
{
    gno_render_def def = gno_render_def_default();
    def.threads = threads;
    return gno_render(scene, &def, rgb, NULL);
}

/* From the first question to the last: each time the call ends as cancelled, and the next one draws the same picture. */
static void test_stop_anywhere(void **state)
{
    static float good[VALUES], rgb[VALUES];
    watch w;
    gno_context *context = watched_context(&w);
    gno_scene *scene = large_scene(context);
    (void)state;
    assert_int_equal(render(scene, 1, good), GNO_OK);
    for (int threads = 1; threads <= 2; threads++)
        for (int at = 1, done = 0; !done; at += 1 + at / 2) {
            gno_status status;
            gno_scene_destroy(scene); /* a fresh one has to be prepared */
            w.stop_at = 0;
            scene = large_scene(context);
            w.questions = 0;
            w.stop_at = at;
            status = render(scene, threads, rgb);
            done = status == GNO_OK;
            if (!done) {
                assert_int_equal(status, GNO_ERROR_CANCELLED);
                assert_non_null(strstr(gno_context_message(context), "cancelled"));
                w.stop_at = 0;
                assert_int_equal(render(scene, threads, rgb), GNO_OK);
            }
            assert_memory_equal(good, rgb, sizeof good);
        }
    assert_false(w.wrong);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* A whole run on two threads asks often. The bound is 2.5 times what is promised of each, for the sanitizers. */
static void test_asks_often(void **state)
{
    static float rgb[VALUES];
    watch w;
    gno_context *context = watched_context(&w);
    gno_scene *scene = large_scene(context);
    (void)state;
    w.last = now();
    w.longest = 0;
    assert_int_equal(render(scene, 2, rgb), GNO_OK);
    print_message("asked %d times, every %.1f ms at the longest\n", w.questions, 1e3 * w.longest);
    assert_true(w.longest < 0.25 && !w.wrong);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* Writing is stopped too, and leaves no file; a later call is not stopped by what an earlier one was told. */
static void test_stop_writing(void **state)
{
    static const char *const extensions[] = {"png", "exr", "pfm"};
    static float rgb[VALUES];
    (void)state;
    for (size_t i = 0; i < sizeof extensions / sizeof extensions[0]; i++) {
        watch w;
        gno_context *context = watched_context(&w);
        char path[64];
        snprintf(path, sizeof path, "/tmp/gnomon-embedding-%ld.%s", (long)getpid(), extensions[i]);
        w.stop_at = 1;
        assert_int_equal(gno_picture_write(context, path, NULL, WIDTH, HEIGHT, rgb), GNO_ERROR_CANCELLED);
        assert_int_equal(access(path, F_OK), -1);
        assert_int_equal(gno_picture_write(context, path, NULL, WIDTH, HEIGHT, rgb), GNO_OK);
        assert_int_equal(access(path, F_OK), 0);
        unlink(path);
        gno_context_destroy(context);
    }
}

static void test_own_progress(void **state)
{
    watch w;
    gno_context *context = watched_context(&w);
    (void)state;
    assert_int_equal(gno_context_progress(context, "mine", 0.5), GNO_OK);
    assert_int_equal(w.questions, 1);
    assert_int_equal(gno_context_progress(context, "mine", 0.6), GNO_OK); /* just asked */
    assert_int_equal(w.questions, 1);
    assert_int_equal(gno_context_progress(NULL, "mine", 0), GNO_ERROR_ARGUMENT);
    gno_context_destroy(context);
}

/* ---- a ceiling ------------------------------------------------------------------------------------------------------------- */

static void test_ceiling(void **state)
{
    static float good[VALUES], rgb[VALUES];
    gno_context_def def = gno_context_def_default();
    gno_context *context = NULL;
    gno_scene *scene;
    size_t before, peak;
    int failures = 0;
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    scene = large_scene(context);
    before = gno_context_memory(context, NULL);
    assert_int_equal(render(scene, 2, good), GNO_OK);
    gno_context_memory(context, &peak);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    assert_true(peak > before + 1000000);
    for (size_t room = before * 3; room < 2 * peak; room += (peak - before) / 4) {
        gno_status status;
        size_t most;
        def.max_memory = room;
        assert_int_equal(gno_context_create(&def, &context), GNO_OK);
        scene = large_scene(context);
        status = render(scene, 2, rgb);
        gno_context_memory(context, &most);
        assert_true(most <= room);
        if (status != GNO_OK) {
            assert_int_equal(status, GNO_ERROR_MEMORY);
            assert_non_null(strstr(gno_context_message(context), "memory ceiling of"));
            assert_non_null(strstr(gno_context_message(context), "MiB"));
            failures++;
        } else {
            assert_memory_equal(good, rgb, sizeof good);
        }
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
    assert_true(failures > 0);
    def.max_memory = 16;
    assert_int_equal(gno_context_create(&def, &context), GNO_ERROR_MEMORY);
    assert_null(context);
}

static void test_ceiling_exact(void **state)
{
    gno_context_def def = gno_context_def_default();
    gno_context *context = NULL;
    size_t held;
    void *block;
    (void)state;
    def.max_memory = 100000;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    held = gno_context_memory(context, NULL);
    assert_null(gno_context_realloc(context, NULL, 0, 100001 - held));
    assert_int_equal(gno_context_memory(context, NULL), held);
    block = gno_context_realloc(context, NULL, 0, 100000 - held);
    assert_non_null(block);
    assert_null(gno_context_realloc(context, block, 100000 - held, 100001 - held));
    block = gno_context_realloc(context, block, 100000 - held, 10);
    gno_context_realloc(context, block, 10, 0);
    assert_int_equal(gno_context_memory(context, NULL), held);
    gno_context_destroy(context);
}

/* ---- two contexts at once ---------------------------------------------------------------------------------------------------- */

typedef struct program {
    int kind;
    int renders;
    float rgb[VALUES];
    gno_status status;
} program;

static void *run_program(void *argument)
{
    program *p = argument;
    gno_context *context = NULL;
    gno_scene *scene = NULL;
    p->status = gno_context_create(NULL, &context);
    if (!p->status && !(scene = random_scene(context, (scene_kind)p->kind, 9, WIDTH, HEIGHT)))
        p->status = GNO_ERROR_MEMORY;
    for (int i = 0; i < p->renders && !p->status; i++)
        p->status = render(scene, 2, p->rgb);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return NULL;
}

static void test_two_threads(void **state)
{
    static program alone[2], together[2];
    pthread_t thread[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        alone[i].kind = together[i].kind = i ? SCENE_ROOM : SCENE_SOLIDS;
        alone[i].renders = 1;
        together[i].renders = 3;
        run_program(&alone[i]);
        assert_int_equal(alone[i].status, GNO_OK);
    }
    for (int i = 0; i < 2; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, run_program, &together[i]), 0);
    for (int i = 0; i < 2; i++) {
        pthread_join(thread[i], NULL);
        assert_int_equal(together[i].status, GNO_OK);
        assert_memory_equal(alone[i].rgb, together[i].rgb, sizeof alone[i].rgb);
    }
}

/* ---- log ------------------------------------------------------------------------------------------------------------------- */

static void on_log(void *user, gno_log_level level, const char *text)
{
    *(int *)user += level == GNO_LOG_WARNING && strstr(text, "no area") != NULL;
}

static void test_log(void **state)
{
    static const double flat[3][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    gno_context_def def = gno_context_def_default();
    gno_context *context = NULL;
    gno_scene *scene = NULL;
    int warnings = 0;
    (void)state;
    def.log = on_log;
    def.log_user = &warnings;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    assert_true(add_polygon(scene, flat, 3, 0, 0));
    assert_int_equal(gno_scene_prepare(scene, 1, NULL), GNO_OK);
    assert_int_equal(warnings, 1);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_stop_anywhere), cmocka_unit_test(test_asks_often),
                                       cmocka_unit_test(test_stop_writing),  cmocka_unit_test(test_own_progress),
                                       cmocka_unit_test(test_ceiling),       cmocka_unit_test(test_ceiling_exact),
                                       cmocka_unit_test(test_two_threads),   cmocka_unit_test(test_log)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
