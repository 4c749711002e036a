/* test_weld.c -- sorting on several threads, and which vertices lie at one place, each against the obvious way by qsort. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/sort_parallel.h"
#include "scene/weld.h"
#include "support/random_scene.h"
#include "support/weld_twin.h"

#include <stdlib.h>
#include <string.h>

static int below(uint64_t *seed, int n) { return (int)(random_unit(seed) * n); }

static int by_key_then_value(const void *a, const void *b)
{
    const gnoi_keyed *x = a, *y = b;
    return x->key != y->key ? (x->key < y->key ? -1 : 1) : x->value < y->value ? -1 : x->value > y->value;
}

static void test_sort(void **state)
{
    static const size_t counts[] = {0, 1, 1000, 131071, 131072, 300001};
    gno_context *context;
    uint64_t seed = 5;
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
        for (unsigned bits = 1; bits <= 32; bits += 31 / 3) {
            size_t n = counts[c];
            gnoi_keyed *pairs = calloc(2 * n + 1, sizeof *pairs), *twin = calloc(n + 1, sizeof *twin), *sorted;
            assert_true(pairs && twin);
            for (size_t i = 0; i < n; i++) {
                pairs[i].key = (uint32_t)(random_unit(&seed) * 4294967295.0) >> (32 - bits);
                pairs[i].value = (uint32_t)i;
            }
            memcpy(twin, pairs, n * sizeof *pairs);
            qsort(twin, n, sizeof *twin, by_key_then_value);
            sorted = gnoi_sort_parallel(context, 1 + (int)c % 3, "test", pairs, pairs + n, n, bits);
            assert_non_null(sorted);
            assert_memory_equal(sorted, twin, n * sizeof *pairs);
            free(pairs);
            free(twin);
        }
    gno_context_destroy(context);
}

static void test_weld(void **state)
{
    static const struct { size_t count; int places; } cases[] = {{0, 1}, {1, 1}, {1000, 1}, {3000, 3}, {5000, 20}, {100000, 30}, {120000, 1000000}};
    gno_context *context;
    uint64_t seed = 3;
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
        for (int threads = 1; threads <= 3; threads += 2) {
            size_t n = cases[c].count;
            double(*positions)[3] = calloc(n + 1, sizeof *positions);
            uint32_t *same = calloc(n + 1, sizeof *same), *twin;
            assert_true(positions && same);
            for (size_t v = 0; v < n; v++)
                for (int k = 0; k < 3; k++) {
                    positions[v][k] = below(&seed, cases[c].places) - cases[c].places / 2;
                    if (positions[v][k] == 0 && below(&seed, 2))
                        positions[v][k] = -0.0;
                }
            twin = weld_twin((const double(*)[3])positions, n);
            assert_int_equal(gnoi_weld(context, threads, n, (const double(*)[3])positions, same), GNO_OK);
            assert_non_null(twin);
            assert_memory_equal(same, twin, n * sizeof *same);
            free(positions);
            free(same);
            free(twin);
        }
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sort),
        cmocka_unit_test(test_weld),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
