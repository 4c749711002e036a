/* test_threads.c -- what goes wrong on worker threads: the ceiling of memory holds for all of them together, failed memory and a wish to
 * stop come back as what they are, with the message of the call; under the thread sanitizer (make check-tsan) without a race. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon_clip.h>
#include <gnomon/gnomon_matrix.h>
#include <gnomon/gnomon_pieces.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <support/random_scene.h>

#define THREADS 4

/* An allocator for several threads that counts what is held, and fails from one call on. */
typedef struct account {
    atomic_size_t held, most, calls;
    size_t fail_at; /* 0: never */
} account;

static void *count_alloc(void *user, void *block, size_t old_size, size_t new_size)
{
    account *a = user;
    size_t held, most;
    void *fresh;
    if (new_size == 0) {
        atomic_fetch_sub(&a->held, old_size);
        free(block);
        return NULL;
    }
    if (atomic_fetch_add(&a->calls, 1) + 1 >= a->fail_at && a->fail_at > 0)
        return NULL;
    fresh = realloc(block, new_size);
    if (!fresh)
        return NULL;
    held = atomic_fetch_add(&a->held, new_size - old_size) + (new_size - old_size);
    most = atomic_load(&a->most);
    while (held > most && !atomic_compare_exchange_weak(&a->most, &most, held)) {
    }
    return fresh;
}

/* Says stop at the question number `stop_at`. */
typedef struct stopper {
    int asked, stop_at;
} stopper;

static int on_progress(void *user, const char *stage, double fraction)
{
    stopper *s = user;
    (void)stage;
    (void)fraction;
    return ++s->asked >= s->stop_at && s->stop_at > 0;
}

typedef gno_status (*work_fn)(gno_scene *scene);

static gno_status work_lit(gno_scene *scene)
{
    gno_lit_def def = gno_lit_def_default();
    def.threads = THREADS;
    return gno_lit_pieces(scene, 0, &def, NULL, NULL, NULL);
}

static gno_status work_visible(gno_scene *scene)
{
    gno_visible_def def = gno_visible_def_default();
    gno_pieces *pieces = NULL;
    gno_status status;
    def.threads = THREADS;
    status = gno_visible_pieces(scene, &def, &pieces, NULL);
    gno_pieces_destroy(pieces);
    return status;
}

static gno_status work_matrix(gno_scene *scene)
{
    gno_matrix_def def = gno_matrix_def_default();
    gno_matrix *matrix = NULL;
    gno_status status;
    def.threads = THREADS;
    status = gno_matrix_build(scene, 0, &def, &matrix);
    gno_matrix_destroy(matrix);
    return status;
}

static gno_status work_render(gno_scene *scene)
{
    static float rgb[64 * 48 * 3];
    gno_render_def def = gno_render_def_default();
    def.threads = THREADS;
    return gno_render(scene, &def, rgb, NULL);
}

static gno_status work_paint(gno_scene *scene)
{
    static float rgb[64 * 48 * 3];
    gno_render_def def = gno_render_def_default();
    def.threads = THREADS;
    def.engine = GNO_ENGINE_WEILER_ATHERTON;
    return gno_render(scene, &def, rgb, NULL);
}

static const work_fn works[] = {work_lit, work_visible, work_matrix, work_render, work_paint};
#define WORKS (sizeof works / sizeof works[0])

static gno_scene *scene_in(gno_context *context, unsigned seed)
{
    gno_scene *scene = random_scene(context, SCENE_PANES, seed, 64, 48);
    assert_non_null(scene);
    return scene;
}

static void test_ceiling(void **state)
{
    (void)state;
    for (size_t k = 0; k < WORKS; k++) {
        size_t least = 0, whole = 0;
        for (int part = 0; part <= 8; part++) {
            account a = {0};
            gno_context_def def = gno_context_def_default();
            gno_context *context;
            gno_scene *scene;
            gno_status status;
            size_t peak;
            def.alloc = count_alloc;
            def.alloc_user = &a;
            if (part > 0) /* between what making the scene takes and what the work takes */
                def.max_memory = least + (whole - least) * (size_t)part / 9;
            assert_int_equal(gno_context_create(&def, &context), GNO_OK);
            scene = scene_in(context, 3);
            gno_context_memory(context, &least);
            status = works[k](scene);
            gno_context_memory(context, &peak);
            if (part == 0) {
                assert_int_equal(status, GNO_OK);
                whole = peak;
            } else {
                assert_true(peak <= def.max_memory && atomic_load(&a.most) <= def.max_memory);
                assert_true(status == GNO_OK || status == GNO_ERROR_MEMORY);
                assert_true(status == GNO_OK || strstr(gno_context_message(context), "memory ceiling"));
            }
            gno_scene_destroy(scene);
            gno_context_destroy(context);
            assert_int_equal(atomic_load(&a.held), 0);
        }
    }
}

static void test_failing_memory(void **state)
{
    (void)state;
    for (size_t k = 0; k < WORKS; k++) {
        size_t calls = 1;
        for (size_t at = 0; at < calls; at = at * 5 / 4 + 1) {
            account a = {0};
            gno_context_def def = gno_context_def_default();
            gno_context *context;
            gno_scene *scene;
            gno_status status;
            size_t before;
            def.alloc = count_alloc;
            def.alloc_user = &a;
            assert_int_equal(gno_context_create(&def, &context), GNO_OK);
            scene = scene_in(context, 5);
            before = atomic_load(&a.calls);
            a.fail_at = at ? before + at : 0;
            status = works[k](scene);
            if (at == 0) {
                assert_int_equal(status, GNO_OK);
                calls = atomic_load(&a.calls) - before;
            } else if (status != GNO_OK) { /* on several threads fewer calls may do */
                assert_int_equal(status, GNO_ERROR_MEMORY);
                assert_true(strstr(gno_context_message(context), "memory") && !strstr(gno_context_message(context), "ceiling"));
                a.fail_at = 0;
                assert_int_equal(works[k](scene), GNO_OK);
            }
            gno_scene_destroy(scene);
            gno_context_destroy(context);
            assert_int_equal(atomic_load(&a.held), 0);
        }
    }
}

/* A wish to stop is never taken for want of memory, whichever thread finds it first, and the next call knows nothing of it. */
static void test_stop(void **state)
{
    (void)state;
    for (size_t k = 0; k < WORKS; k++) {
        for (int at = 1; at < 6; at++) {
            stopper s = {0, 0};
            gno_context_def def = gno_context_def_default();
            gno_context *context;
            gno_scene *scene;
            gno_status status;
            def.progress = on_progress;
            def.progress_user = &s;
            assert_int_equal(gno_context_create(&def, &context), GNO_OK);
            scene = scene_in(context, 7);
            s.asked = 0;
            s.stop_at = at;
            status = works[k](scene);
            assert_true(status == GNO_ERROR_CANCELLED || (status == GNO_OK && s.asked < at));
            assert_true(status == GNO_OK || strstr(gno_context_message(context), "cancelled"));
            s.stop_at = 0;
            assert_int_equal(works[k](scene), GNO_OK);
            gno_scene_destroy(scene);
            gno_context_destroy(context);
        }
    }
}

/* Two stars, every tooth of one across many of the other. */
#define CORNERS 20000
static void test_stop_clipping(void **state)
{
    static double points[2][2 * CORNERS];
    const size_t start[2] = {0, CORNERS};
    gno_context_def def = gno_context_def_default();
    gno_shape shape[2] = {{1, NULL, 1, start, points[0]}, {1, NULL, 1, start, points[1]}}, result;
    stopper s = {0, 0};
    gno_context *context;
    gno_clipper *clipper;
    gno_status status;
    (void)state;
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < CORNERS; i++) {
            double a = 6.283185307179586 * (i + 0.5 * k) / CORNERS, r = i % 2 ? 1 : 0.9;
            points[k][2 * i] = r * cos(a);
            points[k][2 * i + 1] = r * sin(a);
        }
    def.progress = on_progress;
    def.progress_user = &s;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    assert_int_equal(gno_clipper_create(context, &clipper), GNO_OK);
    s.stop_at = 1;
    for (int at = 1; at <= 3; at++) {
        s.asked = 0;
        s.stop_at = at;
        status = gno_clip(clipper, GNO_CLIP_XOR, &shape[0], &shape[1], &result);
        assert_int_equal(status, GNO_ERROR_CANCELLED);
        assert_string_equal(gno_context_message(context), "clipping: cancelled");
        assert_int_equal(result.polygon_count, 0);
    }
    s.stop_at = 0;
    assert_int_equal(gno_clip(clipper, GNO_CLIP_XOR, &shape[0], &shape[1], &result), GNO_OK);
    assert_true(result.polygon_count > 0);
    gno_clipper_destroy(clipper);
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ceiling),
        cmocka_unit_test(test_failing_memory),
        cmocka_unit_test(test_stop),
        cmocka_unit_test(test_stop_clipping),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
