/* test_matrix_files.c -- shadow matrices as files: what is saved is loaded again, other programs' files are read, and no bad file does harm.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <gnomon/gnomon_io.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fail_alloc.h"
#include "support/random_scene.h"

static char folder[] = "/tmp/gnomon-matrix-XXXXXX";
static char path[600];
static gno_context *context;

static const char *in_folder(const char *name)
{
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int set_up(void **state)
{
    (void)state;
    return mkdtemp(folder) == NULL || gno_context_create(NULL, &context) != GNO_OK;
}

static int tear_down(void **state)
{
    (void)state;
    static const char *const names[] = {"m.mtx", "m.csv", "m.png"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) remove(in_folder(names[i]));
    gno_context_destroy(context);
    return rmdir(folder);
}

static void write_text(const char *text, size_t length)
{
    FILE *f = fopen(in_folder("m.mtx"), "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(text, 1, length, f), length);
    assert_int_equal(fclose(f), 0);
}

static char *read_text(const char *name, size_t *length)
{
    char *text = malloc(1 << 20);
    FILE *f = fopen(in_folder(name), "rb");
    assert_true(f && text);
    *length = fread(text, 1, (1 << 20) - 1, f);
    text[*length] = '\0';
    fclose(f);
    return text;
}

static gno_matrix *some_matrix(void)
{
    gno_matrix *m;
    gno_scene *scene = random_scene(context, SCENE_BOXES, 5, 64, 64);
    assert_non_null(scene);
    assert_int_equal(gno_matrix_build(scene, 0, NULL, &m), GNO_OK);
    gno_scene_destroy(scene);
    return m;
}

static void assert_same(gno_matrix *a, gno_matrix *b)
{
    gno_matrix_cursor x = {0, 0, 0, 0, GNO_OK}, y = x;
    assert_int_equal(gno_matrix_size(a), gno_matrix_size(b));
    while (gno_matrix_next(a, &x)) {
        assert_int_equal(gno_matrix_next(b, &y), 1);
        assert_int_equal(x.caster, y.caster);
        assert_int_equal(x.receiver, y.receiver);
    }
    assert_int_equal(gno_matrix_next(b, &y), 0);
}

static void test_round_trip(void **state)
{
    (void)state;
    gno_matrix *m = some_matrix(), *again;
    gno_matrix_file_def def = gno_matrix_file_def_default();
    char *text;
    size_t length;
    def.note = "light \"a\nb\"";
    assert_int_equal(gno_matrix_save(m, in_folder("m.mtx"), &def), GNO_OK);
    text = read_text("m.mtx", &length);
    assert_ptr_equal(strstr(text, "%%MatrixMarket matrix coordinate pattern general\n"), text);
    assert_non_null(strstr(text, "\n% light \"a?b\"\n"));
    free(text);
    assert_int_equal(gno_matrix_load(context, in_folder("m.mtx"), &again), GNO_OK);
    assert_same(m, again);
    gno_matrix_destroy(again);
    gno_matrix_destroy(m);
}

static void test_csv(void **state)
{
    (void)state;
    const size_t start[] = {0, 1, 3, 3};
    const unsigned casters[] = {2, 0, 1};
    gno_matrix *m;
    char *text;
    size_t length;
    assert_int_equal(gno_matrix_from_columns(context, 3, start, casters, &m), GNO_OK);
    assert_int_equal(gno_matrix_save(m, in_folder("m.csv"), NULL), GNO_OK);
    text = read_text("m.csv", &length);
    assert_string_equal(text, "caster,receiver\n2,0\n0,1\n1,1\n");
    free(text);
    assert_int_equal(gno_matrix_save(m, in_folder("m.jpg"), NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_save(m, "/nowhere/m.csv", NULL), GNO_ERROR_FILE);
    gno_matrix_destroy(m);
}

static void test_picture(void **state)
{
    (void)state;
    const size_t start[] = {0, 1, 3, 3};
    const unsigned casters[] = {2, 0, 1};
    gno_matrix_file_def def = gno_matrix_file_def_default();
    gno_matrix *m;
    png_image image;
    unsigned char *pixels;
    assert_int_equal(gno_matrix_from_columns(context, 3, start, casters, &m), GNO_OK);
    def.spy_side = 30;
    assert_int_equal(gno_matrix_save(m, in_folder("m.png"), &def), GNO_OK);
    memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    assert_true(png_image_begin_read_from_file(&image, path));
    assert_int_equal(image.width, 30);
    assert_int_equal(image.height, 30);
    image.format = PNG_FORMAT_RGB;
    pixels = malloc(PNG_IMAGE_SIZE(image));
    assert_non_null(pixels);
    assert_true(png_image_finish_read(&image, NULL, pixels, 0, NULL));
#define PIXEL(row, column) (pixels + ((row) * 10 + 5) * 90 + ((column) * 10 + 5) * 3)
    assert_true(PIXEL(2, 0)[0] < 128 && PIXEL(2, 0)[1] < 128);  /* row 2, column 0: a one */
    assert_true(PIXEL(0, 2)[0] > 250 && PIXEL(0, 2)[1] > 250);  /* a zero */
    assert_true(PIXEL(1, 1)[0] > 180 && PIXEL(1, 1)[1] < 128);  /* own shadow */
    free(pixels);
    def.spy_side = 0;
    assert_int_equal(gno_matrix_save(m, in_folder("m.png"), &def), GNO_ERROR_ARGUMENT);
    gno_matrix_destroy(m);
}

#define HEAD "%%MatrixMarket matrix coordinate pattern general\n"

static void test_good_files(void **state)
{
    (void)state;
    static const char *const texts[] = {
        HEAD "2 2 2\n1 2\n2 2\n",
        "%%matrixmarket MATRIX Coordinate Pattern General\r\n% a remark\r\n\r\n  2\t2 2 \r\n2 2\r\n% another\n1 2",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        gno_matrix *m;
        gno_matrix_column c;
        write_text(texts[i], strlen(texts[i]));
        assert_int_equal(gno_matrix_load(context, path, &m), GNO_OK);
        assert_int_equal(gno_matrix_size(m), 2);
        assert_int_equal(gno_matrix_get_column(m, 1, &c), GNO_OK);
        assert_int_equal(c.count, 2);
        assert_true(c.own && c.casters[0] == 0 && c.casters[1] == 1);
        gno_matrix_destroy(m);
    }
}

static void test_bad_files(void **state)
{
    (void)state;
    static const struct { const char *text, *message; } files[] = {
        {"", "is empty"},
        {"1 1 0\n", "m.mtx:1: not a Matrix Market file"},
        {"%%MatrixMarket matrix array real general\n1 1\n0\n", "m.mtx:1: not a shadow matrix"},
        {"%%MatrixMarket matrix coordinate pattern symmetric\n1 1 0\n", "m.mtx:1: not a shadow matrix"},
        {HEAD, "the size line is missing"},
        {HEAD "% only remarks\n", "the size line is missing"},
        {HEAD "2 2\n1 1\n", "m.mtx:2: the size line"},
        {HEAD "2 two 1\n", "m.mtx:2: the size line"},
        {HEAD "-1 -1 0\n", "m.mtx:2: the size line"},
        {HEAD "2 2 1 1\n", "m.mtx:2: the size line"},
        {HEAD "2 3 1\n1 1\n", "m.mtx:2: a shadow matrix is square"},
        {HEAD "2 2 5\n1 1\n", "m.mtx:2: 5 entries do not fit"},
        {HEAD "0 0 1\n1 1\n", "m.mtx:2: 1 entries do not fit"},
        {HEAD "268435457 268435457 0\n", "m.mtx:2: too large"},
        {HEAD "99999999999999999999999999 1 0\n", "m.mtx:2: too large"},
        {HEAD "1000 1000 18446744073709551615\n", "m.mtx:2: too large"},
        {HEAD "100000 100000 10000000000\n1 1\n", "cut short: 1 of 10000000000"},
        {HEAD "2 2 2\n1 1\n", "cut short: 1 of 2"},
        {HEAD "2 2 1\n1 1\n2 1\n", "m.mtx:4: more entries"},
        {HEAD "2 2 1\n0 1\n", "m.mtx:3: an index is not between 1 and 2"},
        {HEAD "2 2 1\n1 3\n", "m.mtx:3: an index is not between 1 and 2"},
        {HEAD "2 2 1\n1 99999999999999999999\n", "m.mtx:3: an index is not between 1 and 2"},
        {HEAD "0 0 0\n1 1\n", "m.mtx:3:"},
        {HEAD "2 2 1\n1\n", "m.mtx:3: an entry must be"},
        {HEAD "2 2 1\n1 1 1\n", "m.mtx:3: an entry must be"},
        {HEAD "2 2 1\n1 x\n", "m.mtx:3: an entry must be"},
        {HEAD "2 2 1\n1 1.5\n", "m.mtx:3: an entry must be"},
        {HEAD "2 2 2\n2 1\n2 1\n", "the entry 2 1 is there twice"},
    };
    gno_matrix *m;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        write_text(files[i].text, strlen(files[i].text));
        gno_status status = gno_matrix_load(context, path, &m);
        if (status != GNO_ERROR_INPUT && status != GNO_ERROR_LIMIT) fail_msg("status %d for: %s", (int)status, files[i].text);
        if (!strstr(gno_context_message(context), files[i].message))
            fail_msg("\"%s\" should hold \"%s\"", gno_context_message(context), files[i].message);
        assert_null(m);
    }
    assert_int_equal(gno_matrix_load(context, "/nowhere/m.mtx", &m), GNO_ERROR_FILE);
    assert_int_equal(gno_matrix_load(context, folder, &m), GNO_ERROR_FILE);
}

/* A saved file cut off anywhere, or with one byte changed, is refused or read; nothing worse. */
static void test_damaged_files(void **state)
{
    (void)state;
    gno_matrix *m = some_matrix(), *other;
    char *text;
    size_t length;
    uint64_t random = 9;
    assert_int_equal(gno_matrix_save(m, in_folder("m.mtx"), NULL), GNO_OK);
    gno_matrix_destroy(m);
    text = read_text("m.mtx", &length);
    for (int i = 0; i < 400; i++) {
        size_t at = (size_t)(random_unit(&random) * (double)(i % 4 == 0 ? length : length < 400 ? length : 400));
        char old = text[at];
        if (i % 2) {
            text[at] = (char)(256 * random_unit(&random));
            write_text(text, length);
        } else {
            write_text(text, at);
        }
        (void)gno_matrix_load(context, path, &other);
        gno_matrix_destroy(other);
        text[at] = old;
    }
    free(text);
}

static void test_memory(void **state)
{
    (void)state;
    size_t fail_at = 1;
    static const char text[] = HEAD "3 3 3\n1 2\n2 2\n3 1\n";
    write_text(text, sizeof text - 1);
    for (int done = 0; !done; fail_at++) {
        fail_alloc account = {0, 0, 0, 0};
        gno_context_def def = fail_alloc_def(&account);
        gno_context *own;
        gno_matrix *m;
        assert_int_equal(gno_context_create(&def, &own), GNO_OK);
        account.calls = 0;
        account.fail_at = fail_at;
        gno_status status = gno_matrix_load(own, in_folder("m.mtx"), &m);
        if (status == GNO_OK) status = gno_matrix_save(m, in_folder("m.csv"), NULL);
        if (status == GNO_OK) status = gno_matrix_save(m, in_folder("m.png"), NULL);
        assert_true(status == GNO_OK || status == GNO_ERROR_MEMORY);
        done = status == GNO_OK;
        gno_matrix_destroy(m);
        gno_context_destroy(own);
        assert_int_equal(account.held, 0);
        assert_false(account.wrong_size);
    }
    assert_true(fail_at > 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip), cmocka_unit_test(test_csv),           cmocka_unit_test(test_picture), cmocka_unit_test(test_good_files),
        cmocka_unit_test(test_bad_files),  cmocka_unit_test(test_damaged_files), cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down) != 0;
}
