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
    fprintf(out, "  \"%s\": {", name);
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "%s\"%s\": ", i > 0 ? ", " : "", entries[i].name);
        print_value(out, entries[i].value);
    }
    fprintf(out, "},\n");
}

static void print(FILE *out, const void *data)
{
    const run_stats *stats = data;
    const gno_stats *e = &stats->engine;
    const entry seconds[] = {
        {"load", stats->load_seconds},     {"prepare", e->prepare_seconds}, {"shadow", e->shadow_seconds},
        {"project", e->project_seconds},   {"scan", e->scan_seconds},       {"render", stats->render_seconds},
        {"write", stats->write_seconds},   {"total", stats->total_seconds},
    };
    const entry counts[] = {
        {"polygons", e->polygons}, {"lights", e->lights},
        {"tiles", e->tiles},       {"spans", e->spans},
        {"columns", e->columns},   {"ones", e->ones},
        {"columns_full", e->columns_full}, {"shaded", e->shaded},
        {"refined_pixels", e->refined_pixels},
    };
    fprintf(out, "{\n  \"scene\": ");
    json_string(out, stats->scene);
    fprintf(out, ",\n  \"width\": %d, \"height\": %d, \"threads\": %d,\n", stats->width, stats->height, stats->threads);
    print_group(out, "seconds", seconds, sizeof seconds / sizeof seconds[0], json_seconds);
    print_group(out, "counts", counts, sizeof counts / sizeof counts[0], json_number);
    fprintf(out, "  \"peak_memory\": %zu\n}\n", stats->peak_memory);
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
