/* fuzz_span.c -- bytes as a span and its shadow polygons: parts in order, without gaps, and the light over each unit interval that of
 * the casters over it, multiplied one by one. */
#include "fuzz/fuzz.h"

#include <math.h>

enum { MOST = 64 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gno_shadow_interval given[MOST], sorted[MOST];
    gno_span_part parts[2 * MOST + 1];
    fuzz_bytes bytes = {data, size};
    int x0 = (int)(fuzz_byte(&bytes) & 63), x1 = (int)(fuzz_byte(&bytes) & 63);
    size_t count = 0, n, at = 0;
    for (; bytes.size > 0 && count < MOST; count++) {
        given[count].x0 = (int)fuzz_byte(&bytes) % 70 - 3;
        given[count].x1 = (int)fuzz_byte(&bytes) % 70 - 3;
        for (int k = 0; k < 3; k++) {
            given[count].transmission[k] = (fuzz_byte(&bytes) & 3) / 2.0 > 1 ? 1 : (k == 0 ? 0 : 0.5);
        }
        sorted[count] = given[count];
    }
    n = gno_span_split(x0, x1, sorted, count, parts);
    fuzz_expect(n <= 2 * count + 1, "no more parts than room");
    fuzz_expect((n == 0) == (x1 <= x0), "parts exactly when there is a span");
    fuzz_expect(n == 0 || (parts[0].x0 == x0 && parts[n - 1].x1 == x1), "the ends");
    for (size_t i = 0; i < n; i++) {
        fuzz_expect(parts[i].x0 < parts[i].x1 && (i == 0 || parts[i - 1].x1 == parts[i].x0), "order");
    }
    for (int x = x0; x < x1; x++) {
        double light[3] = {1, 1, 1};
        for (size_t i = 0; i < count; i++) {
            for (int k = 0; k < 3 && given[i].x0 <= x && given[i].x1 >= x + 1; k++) {
                light[k] *= given[i].transmission[k];
            }
        }
        while (at < n && parts[at].x1 <= x) {
            at++;
        }
        for (int k = 0; k < 3; k++) {
            fuzz_expect(at < n && fabs(parts[at].light[k] - light[k]) <= 1e-12, "light");
        }
    }
    return 0;
}
