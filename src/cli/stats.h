/* stats.h -- the JSON object of --stats. Place: end of render.c. */
#ifndef GNOMON_CLI_STATS_H
#define GNOMON_CLI_STATS_H

#include "cli/cli.h"

#include <stdio.h>

typedef struct frame_stats {
    int frame;
    gno_stats engine;
    double render_seconds, write_seconds;
} frame_stats;

typedef struct run_stats {
    const char *scene;
    int width, height, threads;
    int numbered; /* a film: every frame is told, then the totals */
    int frame_count;
    frame_stats *frames;
    double load_seconds, total_seconds;
    size_t peak_memory;
} run_stats;

/* What print_report prints of data, to a file, whole or not at all, or "-" for standard output; says what went wrong. Returns an exit
 * status. */
int report_write(const char *path, void (*print_report)(FILE *out, const void *data), const void *data);

/* To a file, whole or not at all, or "-" for standard output; says what went wrong. Returns an exit status. */
int stats_write(const char *path, const run_stats *stats);

#endif
