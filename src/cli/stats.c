/* stats.c -- see stats.h. */
#include "cli/stats.h"

#include "cli/json.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct entry {
    const char *name;
    double value;
} entry;

static void print_group(FILE *out, const char *name, const entry *entries, size_t count, void (*print_value)(FILE *, double))
{
    fprintf(out, "\"%s\": {", name);
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "%s\"%s\": ", i > 0 ? ", " : "", entries[i].name);
        print_value(out, entries[i].value);
    }
    fprintf(out, "}");
}

/* load, total: not below 0 where they are known. */
static void print_seconds(FILE *out, const frame_stats *f, double load, double total)
{
    const gno_stats *e = &f->engine;
    const entry seconds[] = {
        {"load", load},
        {"prepare", e->prepare_seconds}, {"shadow", e->shadow_seconds}, {"project", e->project_seconds},
        {"scan", e->scan_seconds},       {"render", f->render_seconds}, {"write", f->write_seconds},
        {"total", total},
    };
    const size_t skipped = load < 0;
    print_group(out, "seconds", seconds + skipped, sizeof seconds / sizeof seconds[0] - skipped - (total < 0), json_seconds);
}

static void print_counts(FILE *out, const gno_stats *e)
{
    const entry counts[] = {
        {"polygons", e->polygons}, {"lights", e->lights},
        {"shadows_built", e->shadows_built},
        {"tiles", e->tiles},       {"spans", e->spans},
        {"columns", e->columns},   {"ones", e->ones},
        {"columns_full", e->columns_full}, {"shaded", e->shaded},
        {"refined_pixels", e->refined_pixels},
    };
    print_group(out, "counts", counts, sizeof counts / sizeof counts[0], json_number);
}

/* Sums over all frames; polygons and lights are the same in each. */
static frame_stats totals(const run_stats *stats)
{
    frame_stats sum = stats->frames[0];
    for (int i = 1; i < stats->frame_count; i++) {
        const gno_stats *e = &stats->frames[i].engine;
        sum.render_seconds += stats->frames[i].render_seconds;
        sum.write_seconds += stats->frames[i].write_seconds;
        sum.engine.prepare_seconds += e->prepare_seconds;
        sum.engine.shadow_seconds += e->shadow_seconds;
        sum.engine.project_seconds += e->project_seconds;
        sum.engine.scan_seconds += e->scan_seconds;
        sum.engine.shadows_built += e->shadows_built;
        sum.engine.tiles += e->tiles;
        sum.engine.spans += e->spans;
        sum.engine.columns += e->columns;
        sum.engine.ones += e->ones;
        sum.engine.columns_full += e->columns_full;
        sum.engine.shaded += e->shaded;
        sum.engine.refined_pixels += e->refined_pixels;
    }
    return sum;
}

static void print_frames(FILE *out, const run_stats *stats)
{
    fprintf(out, "  \"frames\": [\n");
    for (int i = 0; i < stats->frame_count; i++) {
        fprintf(out, "    {\"frame\": %d, ", stats->frames[i].frame);
        print_seconds(out, &stats->frames[i], -1, -1);
        fprintf(out, ", ");
        print_counts(out, &stats->frames[i].engine);
        fprintf(out, "}%s\n", i + 1 < stats->frame_count ? "," : "");
    }
    fprintf(out, "  ],\n");
}

static void print(FILE *out, const void *data)
{
    const run_stats *stats = data;
    const frame_stats sum = totals(stats);
    fprintf(out, "{\n  \"scene\": ");
    json_string(out, stats->scene);
    fprintf(out, ",\n  \"width\": %d, \"height\": %d, \"threads\": %d,\n", stats->width, stats->height, stats->threads);
    if (stats->numbered) {
        print_frames(out, stats);
    }
    fprintf(out, "  ");
    print_seconds(out, &sum, stats->load_seconds, stats->total_seconds);
    fprintf(out, ",\n  ");
    print_counts(out, &sum.engine);
    fprintf(out, ",\n  \"peak_memory\": %zu\n}\n", stats->peak_memory);
}

static int failed(const char *path)
{
    say("%s: cannot be written: %s", path, strerror(errno));
    return EXIT_FAILED;
}

int report_write(const char *path, void (*print_report)(FILE *out, const void *data), const void *data)
{
    if (strcmp(path, "-") == 0) {
        print_report(stdout, data);
        return close_output();
    }
    /* A device or pipe takes the text as it comes; a file is written beside and renamed. */
    struct stat old;
    const int direct = stat(path, &old) == 0 && !S_ISREG(old.st_mode);
    const size_t size = strlen(path) + 32;
    char *name = malloc(size);
    if (name == NULL) {
        say("%s: out of memory", path);
        return EXIT_FAILED;
    }
    if (direct) {
        snprintf(name, size, "%s", path);
    } else {
        snprintf(name, size, "%s.tmp-%ld", path, (long)getpid());
    }
    int status = EXIT_DONE;
    FILE *out = fopen(name, "w");
    if (out == NULL) {
        status = failed(path);
    } else {
        print_report(out, data);
        const int bad = ferror(out);
        if (fclose(out) != 0 || bad || (!direct && rename(name, path) != 0)) {
            status = failed(path);
            if (!direct) {
                unlink(name);
            }
        }
    }
    free(name);
    return status;
}

int stats_write(const char *path, const run_stats *stats)
{
    return report_write(path, print, stats);
}
