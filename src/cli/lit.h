/* lit.h -- what gnomon lit tells of a run. Place: lit.c fills it in, lit_report.c prints it. */
#ifndef GNOMON_CLI_LIT_H
#define GNOMON_CLI_LIT_H

#include "cli/cli.h"
#include <gnomon/gnomon_pieces.h>

typedef struct lit_run {
    const char *scene_path;
    gno_scene *scene;
    int threads, certified;
    size_t count;             /* expanded lights asked for */
    gno_lit_result *results;
    gno_lit_summary *summaries;
    double load_seconds, write_seconds, total_seconds;
    size_t peak_memory;
} lit_run;

/* A few lines a light on standard error, the certificate among them. */
void lit_summary(const lit_run *run);

/* One JSON object, to a file, whole or not at all, or "-" for standard output. Returns an exit status. */
int lit_stats(const char *path, const lit_run *run);

#endif
