/* fuzz.c -- see fuzz.h. */
#include "fuzz/fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static char folder[200], path[300];
static struct timespec began;

void fuzz_expect(int good, const char *what)
{
    if (!good) {
        fprintf(stderr, "fuzz: not so: %s\n", what);
        abort();
    }
}

static int too_long(void *user, const char *stage, double fraction)
{
    struct timespec now;
    (void)user;
    (void)stage;
    (void)fraction;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return now.tv_sec - began.tv_sec > 4;
}

gno_context *fuzz_context(void)
{
    gno_context_def def = gno_context_def_default();
    gno_context *context;
    def.max_memory = (size_t)256 << 20;
    def.progress = too_long;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &began);
    fuzz_expect(gno_context_create(&def, &context) == GNO_OK, "a context");
    return context;
}

static void remove_folder(void)
{
    static const char *const names[] = {"fuzz.yaml", "fuzz.obj", "fuzz.mtl", "fuzz.exr", "fuzz.mtx"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        unlink(path);
    }
    rmdir(folder);
}

const char *fuzz_file(const char *name, const uint8_t *data, size_t size)
{
    FILE *file;
    if (folder[0] == '\0') {
        const char *base = getenv("FUZZ_FOLDER");
        snprintf(folder, sizeof folder, "%s/gnomon-fuzz-XXXXXX", base != NULL ? base : "/tmp");
        fuzz_expect(mkdtemp(folder) != NULL, "a folder");
        atexit(remove_folder);
    }
    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "wb");
    fuzz_expect(file != NULL && fwrite(data, 1, size, file) == size && fclose(file) == 0, "a file");
    return path;
}

unsigned fuzz_byte(fuzz_bytes *bytes)
{
    if (bytes->size == 0) {
        return 0;
    }
    bytes->size--;
    return *bytes->data++;
}
