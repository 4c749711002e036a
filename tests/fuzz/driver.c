/* driver.c -- runs a fuzz target where the compiler brings no libFuzzer: the corpus once, then random mutations of it.
 *
 * usage: fuzz_TARGET SECONDS|xEXECUTIONS SEED FOLDER OUTDIR
 *
 * Place: tests. A child process does the work in memory shared with its parent, so that a crash or a hang (20 seconds) leaves the input
 * behind: the parent writes it to OUTDIR and starts another child. The last line is "TARGET: N executions, M failures". The same seed
 * tries the same inputs in the same order.
 */
#define _DEFAULT_SOURCE
#include "fuzz/fuzz.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { LONGEST = 1 << 16, INPUTS = 1000, HANG_SECONDS = 20, FAILURES = 20 };

typedef struct shared {
    unsigned long executions;
    size_t size;
    uint8_t input[LONGEST];
} shared;

typedef struct input {
    uint8_t *data;
    size_t size;
} input;

static input corpus[INPUTS];
static size_t corpus_count;
static uint64_t state;

static size_t below(size_t n)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return n > 0 ? (size_t)((state >> 11) % n) : 0;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

static void read_corpus(const char *folder)
{
    struct dirent **names = NULL;
    const int count = scandir(folder, &names, NULL, by_name);
    for (int i = 0; i < count; i++) {
        char path[4096];
        FILE *file;
        snprintf(path, sizeof path, "%s/%s", folder, names[i]->d_name);
        file = names[i]->d_name[0] != '.' && corpus_count < INPUTS ? fopen(path, "rb") : NULL;
        if (file != NULL) {
            input *in = &corpus[corpus_count];
            in->data = malloc(LONGEST);
            in->size = in->data != NULL ? fread(in->data, 1, LONGEST, file) : 0;
            corpus_count++;
            fclose(file);
        }
        free(names[i]);
    }
    free(names);
}

/* One change: bits, bytes, a stretch repeated, moved or left out, a stretch of another input, or a digit of a number. */
static void mutate(shared *s)
{
    static const char *const words[] = {"-1", "0", "1e308", "nan", "999999999999", "-0", "1e-320", "[", "}", ": ", "\n", "2147483648"};
    size_t at = below(s->size + 1), length = below(s->size - at + 1), room = LONGEST - s->size;
    const input *other = &corpus[below(corpus_count)];
    const char *word = words[below(sizeof words / sizeof words[0])];
    switch (below(7)) {
    case 0:
        if (at < s->size) {
            s->input[at] ^= (uint8_t)(1u << below(8));
        }
        break;
    case 1:
        if (at < s->size) {
            s->input[at] = (uint8_t)below(256);
        }
        break;
    case 2:
        memmove(s->input + at, s->input + at + length, s->size - at - length);
        s->size -= length;
        break;
    case 3:
        length = length < room ? length : room;
        memmove(s->input + at + length, s->input + at, s->size - at);
        s->size += length;
        break;
    case 4:
        length = below(other->size + 1);
        length = length < LONGEST - at ? length : LONGEST - at;
        memcpy(s->input + at, other->data + below(other->size - length + 1), length);
        s->size = at + length > s->size ? at + length : s->size;
        break;
    case 5:
        length = strlen(word);
        if (length <= room) {
            memmove(s->input + at + length, s->input + at, s->size - at);
            memcpy(s->input + at, word, length);
            s->size += length;
        }
        break;
    default:
        while (at < s->size && (s->input[at] < '0' || s->input[at] > '9')) {
            at++;
        }
        if (at < s->size) {
            s->input[at] = (uint8_t)('0' + below(10));
        }
    }
}

/* From execution number `first` on; inputs depend on the seed and the number alone. */
static void work(shared *s, unsigned long seed, unsigned long most, double end)
{
    while (s->executions < corpus_count || (most > 0 ? s->executions < most : now() < end)) {
        const unsigned long n = s->executions++;
        state = (seed + 1) * 0x9e3779b97f4a7c15u ^ (n + 1) * 0xbf58476d1ce4e5b9u;
        for (int i = 0; i < 8; i++) {
            below(1);
        }
        const input *in = &corpus[n < corpus_count ? n : below(corpus_count)];
        memcpy(s->input, in->data, in->size);
        s->size = in->size;
        for (size_t i = n < corpus_count ? 0 : 1 + below(4); i > 0; i--) {
            mutate(s);
        }
        alarm(HANG_SECONDS);
        uint8_t *exact = malloc(s->size > 0 ? s->size : 1); /* so that reading past the end is seen */
        if (exact != NULL) {
            memcpy(exact, s->input, s->size);
            LLVMFuzzerTestOneInput(exact, s->size);
            free(exact);
        }
    }
}

static void keep_input(const shared *s, const char *folder, const char *name, int number)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s-%d-%d", folder, name, (int)getpid(), number);
    FILE *file = fopen(path, "wb");
    if (file != NULL) {
        fwrite(s->input, 1, s->size, file);
        fclose(file);
        printf("%s: kept as %s\n", name, path);
    }
}

int main(int argc, char **argv)
{
    if (argc != 5) {
        fprintf(stderr, "usage: %s SECONDS|xEXECUTIONS SEED CORPUS OUTDIR\n", argv[0]);
        return 2;
    }
    const char *name = strrchr(argv[0], '/') != NULL ? strrchr(argv[0], '/') + 1 : argv[0];
    const unsigned long most = argv[1][0] == 'x' ? strtoul(argv[1] + 1, NULL, 10) : 0;
    const double end = now() + atof(argv[1]);
    shared *s = mmap(NULL, sizeof *s, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    int failures = 0, status = 1;
    read_corpus(argv[3]);
    if (s == MAP_FAILED || corpus_count == 0) {
        fprintf(stderr, "%s: no memory, or no corpus in %s\n", name, argv[3]);
        return 2;
    }
    while (status != 0 && failures < FAILURES) {
        fflush(stdout);
        const pid_t child = fork();
        if (child == 0) {
            work(s, strtoul(argv[2], NULL, 10), most, end);
            exit(0);
        }
        if (child < 0 || waitpid(child, &status, 0) != child) {
            return 2;
        }
        if (status != 0) {
            keep_input(s, argv[4], name, failures++);
        }
    }
    printf("%s: %lu executions, %d failures\n", name, s->executions, failures);
    return failures > 0;
}
