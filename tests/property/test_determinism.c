/* test_determinism.c -- the same scene gives the same bytes: for any number of threads, the second time as the first, and
 * while another context renders at the same time.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <gnomon/gnomon.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "support/random_scene.h"

#define WIDTH 211 /* no multiple of a tile */
#define HEIGHT 157
#define BYTES ((size_t)WIDTH * HEIGHT * 3 * sizeof(float))
#define SEED 4711

static const scene_kind kinds[] = {SCENE_GLASS, SCENE_BLOB, SCENE_AROUND};
#define KINDS (sizeof kinds / sizeof *kinds)

static uint64_t hash_bytes(const float *rgb)
{
    const unsigned char *bytes = (const unsigned char *)rgb;
    uint64_t hash = 14695981039346656037u;
    for (size_t i = 0; i < BYTES; i++) hash = (hash ^ bytes[i]) * 1099511628211u;
    return hash;
}

/* Renders a scene made anew in a context of its own; 0 when a call fails (no hash is likely to be 0). */
static uint64_t render_anew(scene_kind kind, int threads, int times)
{
    uint64_t hash = 0;
    gno_context *context = NULL;
    gno_scene *scene = NULL;
    gno_render_def d = gno_render_def_default();
    float *rgb = malloc(BYTES);
    d.threads = threads;
    if (!rgb || gno_context_create(NULL, &context) != GNO_OK) goto end;
    scene = random_scene(context, kind, SEED, WIDTH, HEIGHT);
    if (!scene) goto end;
    for (int i = 0; i < times; i++) {
        memset(rgb, 0xff, BYTES); /* NaN where nothing is written */
        if (gno_render(scene, &d, rgb, NULL) != GNO_OK) goto end;
    }
    hash = hash_bytes(rgb);
end:
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    free(rgb);
    return hash;
}

static void test_threads(void **state)
{
    (void)state;
    static const int threads[] = {2, 3, 7};
    for (size_t k = 0; k < KINDS; k++) {
        uint64_t one = render_anew(kinds[k], 1, 1);
        assert_true(one != 0);
        for (size_t t = 0; t < sizeof threads / sizeof *threads; t++) assert_true(render_anew(kinds[k], threads[t], 1) == one);
    }
}

/* What a scene keeps from its first view must not change the second. */
static void test_twice(void **state)
{
    (void)state;
    for (size_t k = 0; k < KINDS; k++) {
        uint64_t once = render_anew(kinds[k], 1, 1);
        assert_true(once != 0);
        assert_true(render_anew(kinds[k], 1, 2) == once);
        assert_true(render_anew(kinds[k], 2, 3) == once);
    }
}

/* A view that another view of the same scene went before is the view that a fresh scene gives. */
static void test_other_view_between(void **state)
{
    (void)state;
    gno_context *context = NULL;
    float *first = malloc(BYTES), *again = malloc(BYTES);
    gno_render_def d = gno_render_def_default();
    assert_true(first && again);
    d.threads = 2;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    gno_scene *scene = random_scene(context, SCENE_BOXES, SEED, WIDTH, HEIGHT);
    assert_non_null(scene);
    assert_int_equal(gno_render(scene, &d, first, NULL), GNO_OK);
    gno_camera here = gno_scene_camera(scene), there = here;
    there.eye[0] += 2;
    there.eye[1] -= 3;
    assert_int_equal(gno_scene_set_camera(scene, &there), GNO_OK);
    assert_int_equal(gno_render(scene, &d, again, NULL), GNO_OK);
    assert_memory_not_equal(first, again, BYTES);
    assert_int_equal(gno_scene_set_camera(scene, &here), GNO_OK);
    assert_int_equal(gno_render(scene, &d, again, NULL), GNO_OK);
    assert_memory_equal(first, again, BYTES);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    free(first);
    free(again);
}

typedef struct job {
    scene_kind kind;
    uint64_t hash;
} job;

static void *work(void *user)
{
    job *j = user;
    j->hash = render_anew(j->kind, 2, 2);
    return NULL;
}

static void test_two_contexts_at_once(void **state)
{
    (void)state;
    job jobs[2] = {{SCENE_GLASS, 0}, {SCENE_AROUND, 0}};
    pthread_t threads[2];
    for (int i = 0; i < 2; i++) assert_int_equal(pthread_create(&threads[i], NULL, work, &jobs[i]), 0);
    for (int i = 0; i < 2; i++) assert_int_equal(pthread_join(threads[i], NULL), 0);
    for (int i = 0; i < 2; i++) {
        assert_true(jobs[i].hash != 0);
        assert_true(jobs[i].hash == render_anew(jobs[i].kind, 1, 1));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_twice),
        cmocka_unit_test(test_other_view_between),
        cmocka_unit_test(test_two_contexts_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
