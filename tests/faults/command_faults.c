/* command_faults.c -- the tool with its allocations or its calls for files failing, one by one, or ended by signals at random moments.
 *
 * usage: command_faults KIND STEP OUTPUT -- ARGUMENTS...
 *   KIND   memory  every STEP-th allocation of the tool and its libraries fails, once alone and from there on for good
 *          files   every STEP-th call that opens, reads, writes, syncs, renames or closes a file fails, and as many writes are cut short
 *          signals STEP times SIGINT and STEP times SIGKILL, at moments spread over the run
 *   FAULT_PLACES=FILE in the environment: of memory and files each place (support/places.h) once; FILE keeps those that were tried
 *   OUTPUT the file that ARGUMENTS make, in the present folder; "-" is standard output
 *
 * Place: tests. Linked with the tool's own objects; the linker sends their calls of malloc, write and so on to the functions below (--wrap).
 * Each run is a child process. A fault is well taken when the run ends with status 1 and a message, or does without; the output is absent,
 * or as of an undisturbed run (or made without a material or texture, with a warning); and nothing is left beside it (SIGKILL may leave
 * the temporary file, never the output half done). The leak checker, where it is linked in, ends a run that leaks with another status.
 */
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "support/places.h"

int __real_main(int argc, char **argv);
int __wrap_main(int argc, char **argv);

/* ---- faults ------------------------------------------------------------------------------------------------------------------ */

typedef enum fault_kind { NONE, MEMORY, FILES } fault_kind;

typedef struct plan {
    fault_kind kind;
    unsigned long fail_at; /* 0: none */
    int for_good, shorten; /* files: a write is cut short before the next one fails */
    unsigned long counted[3];
} plan;

enum { MOST = 20000 }; /* calls of one kind whose places are noted */

/* Shared with the children. */
static struct shared {
    plan plan;
    int note; /* the places of a run without faults */
    uint64_t place[3][MOST];
} *board;

static plan *now; /* the same plan within the tool; NULL elsewhere, where nothing fails */

static int fails(fault_kind kind)
{
    unsigned long n;
    if (now == NULL) {
        return 0;
    }
    n = ++now->counted[kind];
    if (board->note && n <= MOST) {
        plan *here = now;
        now = NULL; /* looking may take memory */
        board->place[kind][n - 1] = place_here();
        now = here;
    }
    return now->kind == kind && now->fail_at > 0 && (n == now->fail_at || (now->for_good && n > now->fail_at));
}

#define WRAP_MEMORY(name, parameters, arguments)          \
    void *__real_##name parameters;                       \
    void *__wrap_##name parameters;                       \
    void *__wrap_##name parameters                        \
    {                                                     \
        if (fails(MEMORY)) {                              \
            errno = ENOMEM;                               \
            return NULL;                                  \
        }                                                 \
        return __real_##name arguments;                   \
    }

WRAP_MEMORY(malloc, (size_t size), (size))
WRAP_MEMORY(calloc, (size_t count, size_t size), (count, size))
WRAP_MEMORY(realloc, (void *block, size_t size), (block, size))

#define WRAP_FILE(result, name, parameters, arguments, error, failed) \
    result __real_##name parameters;                                  \
    result __wrap_##name parameters;                                  \
    result __wrap_##name parameters                                   \
    {                                                                 \
        if (fails(FILES)) {                                           \
            errno = error;                                            \
            return failed;                                            \
        }                                                             \
        return __real_##name arguments;                               \
    }

WRAP_FILE(FILE *, fopen64, (const char *path, const char *mode), (path, mode), EACCES, NULL)
WRAP_FILE(ssize_t, read, (int descriptor, void *to, size_t size), (descriptor, to, size), EIO, -1)
WRAP_FILE(int, fsync, (int descriptor), (descriptor), EIO, -1)
WRAP_FILE(int, rename, (const char *from, const char *to), (from, to), EACCES, -1)
WRAP_FILE(off64_t, lseek64, (int descriptor, off64_t offset, int whence), (descriptor, offset, whence), EIO, -1)
WRAP_FILE(int, mkstemp64, (char *name), (name), EMFILE, -1)
WRAP_FILE(int, fseek, (FILE *file, long offset, int whence), (file, offset, whence), EIO, -1)
WRAP_FILE(int, fstat64, (int descriptor, struct stat64 *found), (descriptor, found), EIO, -1)

/* A failed read is seen by ferror alone. */
static FILE *failed_file;

size_t __real_fread(void *to, size_t size, size_t count, FILE *file);
size_t __wrap_fread(void *to, size_t size, size_t count, FILE *file);
size_t __wrap_fread(void *to, size_t size, size_t count, FILE *file)
{
    if (fails(FILES)) {
        failed_file = file;
        errno = EIO;
        return 0;
    }
    return __real_fread(to, size, count, file);
}

int __real_ferror(FILE *file);
int __wrap_ferror(FILE *file);
int __wrap_ferror(FILE *file)
{
    const int failed = failed_file == file && file != NULL;
    failed_file = failed ? NULL : failed_file;
    return failed || __real_ferror(file);
}

int __real_open64(const char *path, int flags, ...);
int __wrap_open64(const char *path, int flags, ...);
int __wrap_open64(const char *path, int flags, ...)
{
    va_list more;
    mode_t mode;
    va_start(more, flags);
    mode = flags & O_CREAT ? (mode_t)va_arg(more, unsigned) : 0;
    va_end(more);
    if (fails(FILES)) {
        errno = EMFILE;
        return -1;
    }
    return __real_open64(path, flags, mode);
}

/* Closing fails after the fact, as network file systems do. */
int __real_close(int descriptor);
int __wrap_close(int descriptor);
int __wrap_close(int descriptor)
{
    const int failed = fails(FILES), result = __real_close(descriptor);
    if (failed) {
        errno = EIO;
    }
    return failed ? -1 : result;
}

#define WRAP_WRITE(name, parameters, arguments, shorter)             \
    ssize_t __real_##name parameters;                                \
    ssize_t __wrap_##name parameters;                                \
    ssize_t __wrap_##name parameters                                 \
    {                                                                \
        if (fails(FILES)) {                                          \
            if (now->shorten && size > 1) {                          \
                now->shorten = 0; /* once; the rest has to be asked for again */ \
                return __real_##name shorter;                        \
            }                                                        \
            errno = ENOSPC;                                          \
            return -1;                                               \
        }                                                            \
        return __real_##name arguments;                              \
    }

WRAP_WRITE(write, (int descriptor, const void *data, size_t size), (descriptor, data, size), (descriptor, data, size / 2))
WRAP_WRITE(pwrite64, (int descriptor, const void *data, size_t size, off64_t at), (descriptor, data, size, at), (descriptor, data, size / 2, at))

/* ---- runs --------------------------------------------------------------------------------------------------------------------- */

enum { FINE = 0, REFUSED = 1, SECONDS = 60 };

typedef struct run {
    int argc;
    char **argv;
    const char *output; /* the file to look at, standard output included */
    int is_stream;
    char *good; /* what an undisturbed run makes of it */
    size_t good_size;
    double seconds;
} run;

static double clock_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void redirect(const char *path, int descriptor)
{
    const int file = __real_open64(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file < 0 || dup2(file, descriptor) < 0) {
        _exit(3);
    }
    __real_close(file);
}

static pid_t start(const run *r, const plan *how)
{
    pid_t child;
    unlink(r->output);
    board->plan = *how;
    fflush(stdout);
    child = fork();
    if (child == 0) {
        char **argv = calloc((size_t)r->argc + 1, sizeof *argv);
        redirect("stdout", STDOUT_FILENO);
        redirect("stderr", STDERR_FILENO);
        for (int i = 0; i < r->argc; i++) { /* the tool cuts some in place */
            argv[i] = strdup(r->argv[i]);
        }
        alarm(SECONDS);
        now = &board->plan;
        const int status = __real_main(r->argc, argv);
        now = NULL;
        for (int i = 0; i < r->argc; i++) {
            free(argv[i]);
        }
        free(argv);
        exit(status);
    }
    if (child < 0) {
        exit(3);
    }
    return child;
}

static int finish(pid_t child)
{
    int status = -1;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

static char *contents(const char *path, size_t *size)
{
    char *data = NULL;
    FILE *file = fopen(path, "rb");
    *size = 0;
    if (file != NULL && fseek(file, 0, SEEK_END) == 0) {
        *size = (size_t)ftell(file);
        rewind(file);
        data = malloc(*size + 1);
        if (data == NULL || fread(data, 1, *size, file) != *size) {
            exit(3);
        }
    }
    if (file != NULL) {
        fclose(file);
    }
    return data;
}

/* 1: as of an undisturbed run, 0: there is none, -1: something else. */
static int compare_output(const run *r)
{
    size_t size;
    char *data = contents(r->output, &size);
    const int same = data == NULL ? 0 : size == r->good_size && memcmp(data, r->good, size) == 0 ? 1 : -1;
    free(data);
    return same;
}

/* Whether a temporary file is left; takes it away. */
static int left_over(void)
{
    DIR *folder = opendir(".");
    int found = 0;
    for (struct dirent *e; folder != NULL && (e = readdir(folder)) != NULL;) {
        if (strncmp(e->d_name, ".gnomon", 7) == 0) {
            found = 1;
            unlink(e->d_name);
        }
    }
    if (folder != NULL) {
        closedir(folder);
    }
    return found;
}

static int says(const char *begin)
{
    size_t size, length = strlen(begin);
    char *text = contents("stderr", &size);
    const int has = text != NULL && size > length && memcmp(text, begin, length) == 0;
    free(text);
    return has;
}

static int bad(const run *r, const char *what, int status)
{
    size_t size;
    char *text = contents("stderr", &size);
    printf("  %s: %s (%s %d)\n", r->argv[1], what, WIFSIGNALED(status) ? "signal" : "status",
           WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
    printf("  | %.*s\n", (int)(size < 1500 ? size : 1500), text != NULL ? text : "");
    free(text);
    return 1;
}

/* A report that goes to standard output names there what could not be read. */
static int reports(const run *r)
{
    size_t size;
    char *text = r->is_stream ? contents(r->output, &size) : NULL;
    const int found = text != NULL && memmem(text, size, "cannot", 6) != NULL;
    free(text);
    return found;
}

/* Returns 1 when a fault was taken badly. */
static int judge(const run *r, int status)
{
    const int output = compare_output(r), left = left_over();
    if (!WIFEXITED(status) || (WEXITSTATUS(status) != FINE && WEXITSTATUS(status) != REFUSED)) {
        return bad(r, "ended otherwise", status);
    }
    if (left) {
        return bad(r, "a temporary file is left", status);
    }
    if (WEXITSTATUS(status) == FINE) {
        /* Materials and textures that cannot be read are done without, and a warning says so. */
        return output == 1 || (output != 0 && (says("gnomon: warning: ") || reports(r))) ? 0 : bad(r, "done, but the output is not what it should be", status);
    }
    if (!says("gnomon: ")) {
        return bad(r, "no message", status);
    }
    return r->is_stream || output >= 0 ? 0 : bad(r, "half an output", status);
}

static void undisturbed(run *r)
{
    const plan none = {NONE, 0, 0, 0, {0, 0, 0}};
    const double begun = clock_now();
    int status;
    board->note = 1;
    status = finish(start(r, &none));
    board->note = 0;
    r->seconds = clock_now() - begun;
    r->good = contents(r->output, &r->good_size);
    if (status != 0 || r->good == NULL || r->good_size == 0) {
        bad(r, "does not even work undisturbed", status);
        exit(3);
    }
}

/* Reads the places tried by runs before, or writes them. */
static void keep_places(const char *path, places *seen, const char *mode)
{
    FILE *file = path != NULL ? fopen(path, mode) : NULL;
    if (file != NULL && (mode[0] == 'r' ? fread(seen, sizeof *seen, 1, file) : fwrite(seen, sizeof *seen, 1, file)) != 1) {
        exit(3);
    }
    if (file != NULL) {
        fclose(file);
    }
}

static int fault_runs(run *r, fault_kind kind, unsigned long step, unsigned long *faults)
{
    static places seen;
    const char *path = getenv("FAULT_PLACES");
    const unsigned long all = board->plan.counted[kind];
    int wrong = 0;
    keep_places(path, &seen, "rb");
    for (unsigned long at = 1; at <= all; at += step) {
        if (path != NULL && at <= MOST && places_visit(&seen, board->place[kind][at - 1]) > 0) {
            continue;
        }
        for (int way = 0; way < 2; way++, ++*faults) {
            const plan p = {kind, at, kind == MEMORY && way, kind == FILES && way, {0, 0, 0}};
            wrong += judge(r, finish(start(r, &p)));
        }
    }
    keep_places(path, &seen, "wb");
    return wrong;
}

static int signal_runs(run *r, unsigned long count, unsigned long *faults)
{
    static const int signals[2] = {SIGINT, SIGKILL};
    const plan none = {NONE, 0, 0, 0, {0, 0, 0}};
    int wrong = 0;
    for (unsigned long i = 0; i < 2 * count; i++, ++*faults) {
        const int sent = signals[i % 2];
        const double wait = 1.2 * r->seconds * (double)(i * 40503u % 65536u) / 65536; /* spread evenly, in no order */
        const struct timespec pause = {(time_t)wait, (long)(1e9 * (wait - (double)(time_t)wait))};
        const pid_t child = start(r, &none);
        nanosleep(&pause, NULL);
        kill(child, sent);
        const int status = finish(child), output = compare_output(r), left = left_over();
        const int ended = sent == SIGKILL ? 1
                          : WIFEXITED(status) ? WEXITSTATUS(status) == FINE || WEXITSTATUS(status) == 128 + SIGINT
                                              : WTERMSIG(status) == SIGINT;
        if (!ended) {
            wrong += bad(r, "ended otherwise", status);
        } else if (sent == SIGINT && left) {
            wrong += bad(r, "a temporary file is left", status);
        } else if (!r->is_stream && output < 0) {
            wrong += bad(r, "half an output", status);
        } else if (WIFEXITED(status) && WEXITSTATUS(status) == FINE && output != 1) {
            wrong += bad(r, "done, but the output is not what it should be", status);
        }
    }
    return wrong;
}

int __wrap_main(int argc, char **argv)
{
    run r;
    unsigned long faults = 0, step;
    int wrong;
    if (argc < 6 || strcmp(argv[4], "--") != 0) {
        fprintf(stderr, "usage: command_faults memory|files|signals STEP OUTPUT -- ARGUMENTS...\n");
        return 2;
    }
    memset(&r, 0, sizeof r);
    step = strtoul(argv[2], NULL, 10);
    step = step > 0 ? step : 1;
    r.is_stream = strcmp(argv[3], "-") == 0;
    r.output = r.is_stream ? "stdout" : argv[3];
    argv[4] = argv[0];
    r.argc = argc - 4;
    r.argv = argv + 4;
    board = mmap(NULL, sizeof *board, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (board == MAP_FAILED) {
        return 3;
    }
    undisturbed(&r);
    wrong = strcmp(argv[1], "memory") == 0  ? fault_runs(&r, MEMORY, step, &faults)
            : strcmp(argv[1], "files") == 0 ? fault_runs(&r, FILES, step, &faults)
                                            : signal_runs(&r, step, &faults);
    unlink(r.output);
    unlink("stdout");
    unlink("stderr");
    printf("%s faults: %s of gnomon %s to %s: %lu faults, %d taken badly\n", wrong ? "FAIL" : "PASS", argv[1], argv[5], argv[3], faults, wrong);
    free(r.good);
    return wrong > 0;
}
