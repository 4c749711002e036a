/* test_context.c -- the context: accounts, limits, messages; and loops over pieces of work on several threads. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/parallel.h"
#include "scene_bed.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

/* ---- context ----------------------------------------------------------------------------------------------------- */

static void test_texts(void **state)
{
    int status;
    (void)state;
    assert_string_equal(gno_version(), "0.1.0");
    assert_string_equal(gno_status_text(GNO_OK), "ok");
    for (status = GNO_OK; status <= GNO_ERROR_CANCELLED; status++) {
        assert_true(strlen(gno_status_text((gno_status)status)) > 0);
    }
    assert_string_equal(gno_status_text((gno_status)99), "unknown status");
    assert_string_equal(gno_context_message(NULL), "");
    gno_context_destroy(NULL);
    gno_scene_destroy(NULL);
}

static void test_context_create(void **state)
{
    fail_alloc alloc = {0, 0, 1, 0};
    gno_context_def def = fail_alloc_def(&alloc);
    gno_context *context = (gno_context *)&alloc;
    (void)state;
    assert_int_equal(gno_context_create(&def, &context), GNO_ERROR_MEMORY);
    assert_null(context);
    assert_int_equal(gno_context_create(NULL, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    assert_string_equal(gno_context_message(context), "");
    gno_context_destroy(context);
}

static void test_account(void **state)
{
    bed *b = *state;
    size_t peak, before = gno_context_memory(b->context, &peak);
    int *block = gnoi_malloc(b->context, 100, sizeof *block), *grown;
    assert_int_equal(before + 400, b->alloc.held);
    assert_true(peak >= before);
    assert_int_equal(gno_context_memory(b->context, NULL), before + 400);
    block[99] = 7;
    grown = gnoi_realloc(b->context, block, 100, 200, sizeof *grown);
    assert_int_equal(grown[99], 7);
    assert_int_equal(gno_context_memory(b->context, NULL), before + 800);
    assert_null(gnoi_realloc(b->context, grown, 200, SIZE_MAX / 2, sizeof *grown)); /* overflow: the block stays */
    assert_int_equal(grown[99], 7);
    gnoi_free(b->context, grown, 200, sizeof *grown);
    assert_int_equal(gno_context_memory(b->context, &peak), before);
    assert_true(peak >= before + 800);
    block = gnoi_calloc(b->context, 0, sizeof *block); /* no elements: still a block, of one */
    assert_non_null(block);
    assert_int_equal(*block, 0);
    gnoi_free(b->context, block, 0, sizeof *block);
    assert_int_equal(gno_context_memory(b->context, NULL), b->alloc.held);
}

static void test_reserve(void **state)
{
    bed *b = *state;
    void *array = NULL;
    size_t capacity = 0;
    assert_int_equal(gnoi_reserve(b->context, &array, &capacity, 1, 8), 1);
    assert_int_equal(capacity, 16);
    assert_int_equal(gnoi_reserve(b->context, &array, &capacity, 33, 8), 1);
    assert_int_equal(capacity, 64);
    assert_int_equal(gnoi_reserve(b->context, &array, &capacity, SIZE_MAX / 4, 8), 0);
    assert_int_equal(capacity, 64);
    gnoi_free(b->context, array, capacity, 8);
}

static void test_messages(void **state)
{
    bed *b = *state;
    char longest[3000];
    assert_int_equal(gnoi_fail(b->context, GNO_ERROR_LIMIT, "%d of %d", 3, 2), GNO_ERROR_LIMIT);
    assert_string_equal(gno_context_message(b->context), "3 of 2");
    gnoi_fail(b->context, GNO_ERROR_INPUT, "file: %s", gno_context_message(b->context)); /* the message within itself */
    assert_string_equal(gno_context_message(b->context), "file: 3 of 2");
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    assert_int_equal(gno_context_fail(b->context, GNO_ERROR_FILE, longest), GNO_ERROR_FILE);
    assert_int_equal(strlen(gno_context_message(b->context)), 1023);
    gno_context_fail(b->context, GNO_ERROR_FILE, "100%s"); /* not a format */
    assert_string_equal(gno_context_message(b->context), "100%s");
}

static void keep_level(void *user, gno_log_level level, const char *text)
{
    int *seen = user;
    *seen = (int)level * 100 + (int)strlen(text);
}

static void test_log(void **state)
{
    gno_context_def def = gno_context_def_default();
    gno_context *context;
    int seen = 0;
    (void)state;
    def.log = keep_level;
    def.log_user = &seen;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    gnoi_warn(context, "%s", "four");
    assert_int_equal(seen, 104);
    gno_context_log(context, GNO_LOG_INFO, "hello");
    assert_int_equal(seen, 5);
    gno_context_destroy(context);
}

/* ---- parallel loops ---------------------------------------------------------------------------------------------- */

#define PIECES 1000

typedef struct counting {
    atomic_int seen[PIECES];
    atomic_int bad_worker;
    int threads;
    size_t fail_at;
} counting;

static gno_status count_piece(void *user, int worker, size_t piece)
{
    counting *c = user;
    atomic_fetch_add(&c->seen[piece], 1);
    if (worker < 0 || worker >= c->threads) {
        atomic_store(&c->bad_worker, 1);
    }
    return piece == c->fail_at ? GNO_ERROR_LIMIT : GNO_OK;
}

static void test_parallel_covers(void **state)
{
    bed *b = *state;
    static counting c;
    static const int threads[4] = {1, 2, 7, GNO_MAX_THREADS};
    int i, k;
    for (i = 0; i < 4; i++) {
        memset(&c, 0, sizeof c);
        c.threads = threads[i];
        c.fail_at = PIECES;
        assert_int_equal(gnoi_parallel(b->context, threads[i], PIECES, "test", count_piece, &c), GNO_OK);
        for (k = 0; k < PIECES; k++) {
            assert_int_equal(atomic_load(&c.seen[k]), 1);
        }
        assert_int_equal(atomic_load(&c.bad_worker), 0);
    }
    assert_int_equal(gnoi_parallel(b->context, 4, 0, "test", count_piece, &c), GNO_OK);
}

static void test_parallel_fails(void **state)
{
    bed *b = *state;
    static counting c;
    int threads, k;
    for (threads = 1; threads <= 4; threads++) {
        memset(&c, 0, sizeof c);
        c.threads = threads;
        c.fail_at = 10;
        assert_int_equal(gnoi_parallel(b->context, threads, PIECES, "stage", count_piece, &c), GNO_ERROR_LIMIT);
        assert_string_equal(gno_context_message(b->context), "stage: limit exceeded");
        for (k = 0; k < PIECES; k++) {
            assert_true(atomic_load(&c.seen[k]) <= 1);
        }
        assert_int_equal(atomic_load(&c.seen[10]), 1);
    }
    assert_int_equal(gnoi_thread_count(3), 3);
    assert_int_equal(gnoi_thread_count(100000), GNO_MAX_THREADS);
    assert_true(gnoi_thread_count(0) >= 1);
}

static int stop_now(void *user, const char *stage, double fraction)
{
    int *calls = user;
    assert_string_equal(stage, "slow");
    assert_true(fraction >= 0 && fraction <= 1);
    return ++*calls == 2;
}

static gno_status slow_piece(void *user, int worker, size_t piece)
{
    double end = gnoi_now() + 0.005;
    (void)user;
    (void)worker;
    (void)piece;
    while (gnoi_now() < end) {
    }
    return GNO_OK;
}

static void test_parallel_cancels(void **state)
{
    gno_context_def def = gno_context_def_default();
    gno_context *context;
    int calls = 0;
    (void)state;
    def.progress = stop_now;
    def.progress_user = &calls;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    assert_int_equal(gnoi_parallel(context, 2, 100000, "slow", slow_piece, NULL), GNO_ERROR_CANCELLED);
    assert_int_equal(calls, 2);
    assert_string_equal(gno_context_message(context), "slow: cancelled");
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_texts),
        cmocka_unit_test(test_context_create),
        cmocka_unit_test_setup_teardown(test_account, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_reserve, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_messages, set_up, tear_down),
        cmocka_unit_test(test_log),
        cmocka_unit_test_setup_teardown(test_parallel_covers, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_parallel_fails, set_up, tear_down),
        cmocka_unit_test(test_parallel_cancels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
