/* matrix_stats.h -- the JSON of gnomon matrix --stats. Place: end of matrix.c. */
#ifndef GNOMON_CLI_MATRIX_STATS_H
#define GNOMON_CLI_MATRIX_STATS_H

#include "cli/stats.h"

typedef struct matrix_stats {
    const char *light;
    gno_matrix_info info;
    gno_matrix_check_result check;
    int checked;
    double write_seconds;
    size_t peak_memory;
} matrix_stats;

typedef struct matrix_report {
    const char *scene;
    int threads;
    double load_seconds;
    int count;
    matrix_stats *lights;
} matrix_report;

/* One object for each light. data: a matrix_report. */
void matrix_stats_print(FILE *out, const void *data);

#endif
