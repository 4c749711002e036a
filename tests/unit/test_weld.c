/* test_weld.c -- which vertices lie at one place, against the obvious way by qsort. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene/weld.h"
#include "support/random_scene.h"
#include "support/weld_twin.h"

#include <stdlib.h>
#include <string.h>

static int below(uint64_t *seed, int n) { return (int)(random_unit(seed) * n); }

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
        cmocka_unit_test(test_weld),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
