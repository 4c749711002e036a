/* hostile.c -- sizes that no one means: each either works, within time and memory that are stated here, or ends with a message early.
 *
 * usage: hostile quick|full|SIZE [CASE]
 *
 * Place: tests. Each case runs in a process of its own. Prints a line a case: its name, seconds of the processor, peak memory, what came
 * of it; PASS in front, or FAIL when it crashed, gave a wrong answer, or took more than its limits. Limits are for the full size; they
 * leave room for slow machines and sanitizers' absence is assumed.
 */
#define _DEFAULT_SOURCE
#include "hostile/cases.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

typedef struct hostile_case {
    const char *name;
    hostile_fn run;
    size_t quick, full;  /* sizes */
    double seconds;      /* of the processor, for the full size */
    double megabytes;
} hostile_case;

static const hostile_case cases[] = {
    {"counts near the limits of integers", hostile_counts, 1, 1, 2, 64},
    {"the same scene 10^12 times as large and as small", hostile_scales, 1, 1, 20, 64},
    {"triangles in one plane, drawn", hostile_soup_drawn, 1000, 20000, 60, 512},
    {"triangles in one plane, lit, with the certificate", hostile_soup_lit, 60, 300, 60, 512},
    {"triangles in one plane, lit", hostile_soup_rows, 300, 20000, 60, 512},
    {"triangles in one plane, visible pieces", hostile_soup_pieces, 80, 300, 60, 512},
    {"polygons through one pixel, drawn", hostile_pile_drawn, 5000, 100000, 60, 1024},
    {"polygons through one pixel, as pieces", hostile_pile_painted, 3000, 100000, 60, 1024},
    {"polygons through one pixel, seen through", hostile_pile_glass, 300, 100000, 120, 1100},
    {"lit pieces of a pile", hostile_pile_lit, 100, 500, 60, 1024},
    {"polygons all crossing in one pixel", hostile_pile_crossing, 300, 10000, 120, 1100},
    {"shadow matrix of a pile", hostile_pile_matrix, 1000, 10000, 60, 2048},
    {"one polygon of so many corners, drawn", hostile_ring_drawn, 20000, 1000000, 60, 1024},
    {"the same, smooth", hostile_ring_smooth, 3000, 100000, 60, 1024},
    {"the same, its lit parts", hostile_ring_lit, 5000, 1000000, 120, 2048},
    {"the same, as pieces", hostile_ring_pieces, 5000, 1000000, 120, 2048},
    {"the same, its shadow matrix and problems", hostile_ring_matrix, 5000, 1000000, 60, 1024},
    {"the same, clipped by another", hostile_ring_clipped, 5000, 1000000, 60, 2048},
    {"one polygon of so many holes", hostile_holes, 1000, 100000, 60, 1024},
    {"lights", hostile_lights, 100, 10000, 120, 2048},
    {"a picture of 65,536 x 65,536, row by row until told to stop", hostile_picture, 65536, 65536, 30, 1024},
    {"a picture of 100,000 x 100,000", hostile_picture_refused, 100000, 100000, 2, 64},
};

enum { CASES = sizeof cases / sizeof cases[0], OUTCOME = 400 };

typedef struct shared {
    char outcome[OUTCOME];
} shared;

static double of_timeval(struct timeval t) { return (double)t.tv_sec + 1e-6 * (double)t.tv_usec; }

/* 0 when all is well. */
static int run_case(const hostile_case *c, const char *how, shared *s)
{
    struct rusage used;
    int status = 1, bad;
    double seconds, megabytes;
    const size_t wished = (size_t)strtoul(how, NULL, 10), size = strcmp(how, "full") == 0 ? c->full : wished > 0 ? wished : c->quick;
    fflush(stdout);
    s->outcome[0] = '\0';
    const pid_t child = fork();
    if (child == 0) {
        struct rlimit limit = {(rlim_t)(2 * c->seconds) + 5, (rlim_t)(2 * c->seconds) + 10};
        setrlimit(RLIMIT_CPU, &limit);
        _exit(c->run(size, s->outcome, OUTCOME) ? 0 : 1);
    }
    if (child < 0 || wait4(child, &status, 0, &used) != child) {
        return 1;
    }
    seconds = of_timeval(used.ru_utime) + of_timeval(used.ru_stime);
    megabytes = (double)used.ru_maxrss / 1024;
    bad = status != 0 || seconds > c->seconds || megabytes > c->megabytes;
    printf("%s hostile: %s (%zu): %.2f s, %.0f MB: %s%s%s\n", bad ? "FAIL" : "PASS", c->name, size, seconds, megabytes,
           WIFSIGNALED(status) ? "killed by a signal; " : "", s->outcome, bad && status == 0 ? "; beyond its limits" : "");
    return bad;
}

int main(int argc, char **argv)
{
    shared *s = mmap(NULL, sizeof *s, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    int failures = 0, runs = 0;
    if (argc < 2 || s == MAP_FAILED) {
        fprintf(stderr, "usage: hostile quick|full|SIZE [CASE]\n");
        return 2;
    }
    for (int i = 0; i < CASES; i++) {
        if (argc < 3 || strstr(cases[i].name, argv[2])) {
            failures += run_case(&cases[i], argv[1], s);
            runs++;
        }
    }
    printf("hostile sizes: %d cases, %d failures\n", runs, failures);
    return failures > 0;
}
