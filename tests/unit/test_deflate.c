/* test_deflate.c -- what the PNG encoder compresses, zlib has to give back, byte by byte. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "io/deflate.h"
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

static uint32_t random_state = 1;

static uint32_t random_below(uint32_t n)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (random_state >> 8) % n;
}

/* Compresses in blocks of `most` bytes, the last one of what is left, and compares what zlib reads. Returns the stream's size. */
static size_t check(const unsigned char *data, size_t size, size_t most)
{
    gno_context *context = NULL;
    gnoi_deflate d;
    unsigned char *stream = malloc(4 * size + 1024 * (size / most + 1)), *back = malloc(size);
    size_t filled = 0;
    uLongf got = (uLongf)size;
    assert_non_null(stream);
    assert_non_null(back);
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    assert_true(gnoi_deflate_create(context, most, &d));
    for (size_t i = 0; i < size; i += most) {
        size_t count = size - i < most ? size - i : most, out = gnoi_deflate_block(&d, data + i, count, i + count == size);
        memcpy(stream + filled, d.out, out);
        filled += out;
    }
    gnoi_deflate_destroy(&d);
    gno_context_destroy(context);
    assert_int_equal(uncompress(back, &got, stream, (uLong)filled), Z_OK);
    assert_int_equal(got, size);
    assert_memory_equal(back, data, size);
    free(stream);
    free(back);
    return filled;
}

/* Runs of every length, also where a block ends. */
static void test_runs(void **state)
{
    unsigned char data[2048];
    (void)state;
    for (size_t run = 1; run < 600; run++) {
        memset(data, 7, sizeof data);
        data[random_below(200)] = 1;
        memset(data + 300, 9, run);
        check(data, 300 + run, 2048);
        check(data, 1000 + run, 1 + random_below(700));
        memset(data, (int)run, run);
        check(data, run, 4096);
    }
}

/* From all alike to all different, with runs among them. */
static void test_random(void **state)
{
    size_t size = 70000;
    unsigned char *data = malloc(size);
    (void)state;
    assert_non_null(data);
    for (uint32_t values = 1; values <= 256; values *= 2)
        for (uint32_t runs = 0; runs < 3; runs++) {
            for (size_t i = 0; i < size; i++) data[i] = i > 0 && runs > 0 && random_below(runs * 8) > 0 ? data[i - 1] : (unsigned char)random_below(values);
            check(data, size, 65536);
            check(data, size, 1000);
        }
    free(data);
}

/* Counts that grow like Fibonacci's numbers would have codes longer than the format's 15 bits. */
static void test_long_codes(void **state)
{
    uint32_t count[25] = {1, 1};
    size_t size = 0, filled = 0;
    unsigned char *data;
    (void)state;
    for (int i = 2; i < 25; i++) count[i] = count[i - 1] + count[i - 2];
    for (int i = 0; i < 25; i++) size += count[i];
    data = malloc(size);
    assert_non_null(data);
    for (int i = 0; i < 25; i++)
        for (uint32_t k = 0; k < count[i]; k++) data[filled++] = (unsigned char)i;
    for (size_t i = size - 1; i > 0; i--) {
        size_t j = random_below((uint32_t)i + 1);
        unsigned char swap = data[i];
        data[i] = data[j];
        data[j] = swap;
    }
    assert_true(check(data, size, size) < size / 2);
    free(data);
}

/* Smooth differences, as rows of pictures have them: about as small as zlib makes them from runs and codes. */
static void test_size(void **state)
{
    enum { SIZE = 200000 };
    unsigned char *data = malloc(SIZE), *other = malloc(2 * SIZE);
    z_stream z;
    size_t size;
    (void)state;
    assert_non_null(data);
    assert_non_null(other);
    for (size_t i = 0; i < SIZE; i++)
        data[i] = i / 1000 % 3 == 0 ? 0 : (unsigned char)(random_below(4) + random_below(4) + random_below(4) - 5);
    memset(&z, 0, sizeof z);
    assert_int_equal(deflateInit2(&z, 1, Z_DEFLATED, 15, 8, Z_RLE), Z_OK);
    z.next_in = data;
    z.avail_in = SIZE;
    z.next_out = other;
    z.avail_out = 2 * SIZE;
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    size = check(data, SIZE, 65536);
    assert_true(size < z.total_out + z.total_out / 50);
    deflateEnd(&z);
    free(data);
    free(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_runs), cmocka_unit_test(test_random), cmocka_unit_test(test_long_codes),
                                       cmocka_unit_test(test_size)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
