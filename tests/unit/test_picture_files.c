/* test_picture_files.c -- gno_picture_write: a file is there whole or not at all, whatever fails. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "picture_test.h"
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

/* ---- whole or not at all --------------------------------------------------------------------------------------------- */

/* The way through the writers differs by format and, for PNG, by size. */
enum { WAYS = 4, LARGE = 1500 };
static const char *const every_way[WAYS] = {"a.png", "a.exr", "a.pfm", "large.png"};

static int side_of(int way, int usual)
{
    return way == 3 ? LARGE : usual;
}

static float *noise(int width, int height)
{
    float *rgb = gradient(width, height);
    uint32_t seed = 1;
    for (size_t i = 0; i < (size_t)width * (size_t)height * 3; i++) {
        seed = seed * 1664525u + 1013904223u;
        rgb[i] = (float)(seed / 4294967296.0);
    }
    return rgb;
}

static void put_text(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

static void expect_text(const char *path, const char *text)
{
    char read[100] = "";
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    assert_non_null(fgets(read, sizeof read, in));
    fclose(in);
    assert_string_equal(read, text);
}

static void test_unwritable(void **state)
{
    (void)state;
    const float rgb[3] = {0};
    gno_context *context = new_context();
    for (int i = 0; i < WAYS; i++) {
        char path[64];
        snprintf(path, sizeof path, "nowhere/%s", every_way[i]);
        assert_int_equal(write_picture(context, in_folder(path), GNO_DEPTH_DEFAULT, 1, 1, rgb), GNO_ERROR_FILE);
        expect_message(context, path);
        expect_message(context, "No such file");
        assert_int_equal(mkdir(in_folder(every_way[i]), 0777), 0);
        assert_int_equal(write_picture(context, in_folder(every_way[i]), GNO_DEPTH_DEFAULT, 1, 1, rgb), GNO_ERROR_FILE);
        expect_message(context, "directory");
    }
    assert_int_equal(files_in_folder(), WAYS);
    gno_context_destroy(context);
}

/* A limit on file sizes stands in for a full disk: writing fails half-way. */
static void test_failure_keeps_the_old_file(void **state)
{
    (void)state;
    gno_context *context = new_context();
    float *rgb = noise(LARGE, LARGE); /* cannot be compressed below the limit */
    const size_t held = gno_context_memory(context, NULL);
    struct rlimit old, low;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    low = old;
    low.rlim_cur = 20000;
    signal(SIGXFSZ, SIG_IGN);
    for (int i = 0; i < WAYS; i++) {
        const int side = side_of(i, 300);
        put_text(in_folder(every_way[i]), "old picture");
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &low), 0);
        const gno_status status = write_picture(context, in_folder(every_way[i]), GNO_DEPTH_DEFAULT, side, side, rgb);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
        assert_int_equal(status, GNO_ERROR_FILE);
        expect_message(context, every_way[i]);
        expect_message(context, "too large");
        expect_text(in_folder(every_way[i]), "old picture");
        assert_int_equal(files_in_folder(), i + 1);
        assert_int_equal(gno_context_memory(context, NULL), held);
    }
    signal(SIGXFSZ, SIG_DFL);
    free(rgb);
    gno_context_destroy(context);
}

static void test_success_replaces_the_old_file(void **state)
{
    (void)state;
    gno_context *context = new_context();
    float *rgb = gradient(5, 4);
    struct stat found;
    put_text(in_folder("a.png"), "old picture");
    assert_int_equal(chmod(in_folder("a.png"), 0640), 0);
    assert_int_equal(symlink("a.png", in_folder("link.png")), 0);
    assert_int_equal(write_picture(context, in_folder("link.png"), GNO_DEPTH_DEFAULT, 5, 4, rgb), GNO_OK);
    free(read_png(in_folder("a.png"), 8, 5, 4));
    assert_int_equal(stat(in_folder("a.png"), &found), 0);
    assert_int_equal(found.st_mode & 0777, 0640);
    assert_int_equal(lstat(in_folder("link.png"), &found), 0);
    assert_true(S_ISLNK(found.st_mode));
    assert_int_equal(files_in_folder(), 2);
    free(rgb);
    gno_context_destroy(context);
}

static void test_full_device(void **state)
{
    (void)state;
    if (access("/dev/full", W_OK) != 0) {
        skip();
    }
    gno_context *context = new_context();
    float *rgb = gradient(LARGE, LARGE);
    for (int i = 0; i < WAYS; i++) {
        assert_int_equal(symlink("/dev/full", in_folder(every_way[i])), 0);
        assert_int_equal(write_picture(context, in_folder(every_way[i]), GNO_DEPTH_DEFAULT, side_of(i, 200), side_of(i, 200), rgb), GNO_ERROR_FILE);
        expect_message(context, "No space");
    }
    assert_int_equal(files_in_folder(), WAYS);
    free(rgb);
    gno_context_destroy(context);
}

static int stop_at_the_end(void *user, const char *stage, double fraction)
{
    (void)user;
    (void)stage;
    return fraction >= 1;
}

/* All rows are packed, and nothing but chunks is left to write. */
static void test_stop_between_chunks(void **state)
{
    (void)state;
    const int width = 1999, height = 1048;
    float *rgb = noise(width, height);
    gno_context_def def = gno_context_def_default();
    gno_context *context = NULL;
    def.progress = stop_at_the_end;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    const size_t held = gno_context_memory(context, NULL);
    assert_int_equal(write_picture(context, in_folder("a.png"), GNO_DEPTH_DEFAULT, width, height, rgb), GNO_ERROR_CANCELLED);
    assert_int_equal(files_in_folder(), 0);
    assert_int_equal(gno_context_memory(context, NULL), held);
    free(rgb);
    gno_context_destroy(context);
}

/* ---- memory ---------------------------------------------------------------------------------------------------------- */

typedef struct counter {
    int left; /* allocations that still succeed */
} counter;

static void *counted(void *user, void *block, size_t old_size, size_t new_size)
{
    counter *count = user;
    (void)old_size;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    return count->left-- > 0 ? realloc(block, new_size) : NULL;
}

static void test_every_allocation_fails_once(void **state)
{
    (void)state;
    float *rgb = gradient(LARGE, LARGE);
    counter count = {1000000};
    gno_context_def def = gno_context_def_default();
    def.alloc = counted;
    def.alloc_user = &count;
    gno_context *context = NULL;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    const size_t held = gno_context_memory(context, NULL);
    for (int i = 0; i < WAYS; i++) {
        gno_status status = GNO_ERROR_MEMORY;
        for (int allowed = 0; status != GNO_OK; allowed++) {
            assert_true(allowed < 100);
            count.left = allowed;
            status = write_picture(context, in_folder(every_way[i]), GNO_DEPTH_DEFAULT, side_of(i, 40), side_of(i, 40), rgb);
            assert_true(status == GNO_OK || status == GNO_ERROR_MEMORY);
            assert_int_equal(files_in_folder(), status == GNO_OK ? i + 1 : i);
            assert_int_equal(gno_context_memory(context, NULL), held);
        }
    }
    free(rgb);
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_unwritable, empty_folder),
        cmocka_unit_test_setup(test_failure_keeps_the_old_file, empty_folder),
        cmocka_unit_test_setup(test_success_replaces_the_old_file, empty_folder),
        cmocka_unit_test_setup(test_full_device, empty_folder),
        cmocka_unit_test_setup(test_stop_between_chunks, empty_folder),
        cmocka_unit_test_setup(test_every_allocation_fails_once, empty_folder),
    };
    if (mkdtemp(folder) == NULL) {
        perror(folder);
        return 1;
    }
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    empty_folder(NULL);
    rmdir(folder);
    return failed != 0;
}
