/* lit_report.c -- the summary and the statistics of gnomon lit: see lit.h. */
#include "cli/lit.h"

#include "cli/json.h"
#include "cli/stats.h"

#include <stdio.h>

static const char *light_name(const lit_run *run, size_t i, int *source)
{
    gno_light light;
    const char *name = "";
    *source = -1;
    if (gno_expanded_light(run->scene, run->results[i].light, &light, source) != GNO_OK ||
        gno_scene_light(run->scene, *source, &light, &name) != GNO_OK) {
        return "";
    }
    return name;
}

/* Names come from files and must not reach the terminal as commands. */
static void print_name(const char *name)
{
    for (const unsigned char *c = (const unsigned char *)name; *c != '\0'; c++) {
        fputc(*c < 0x20 || *c == 0x7F ? '?' : *c, stderr);
    }
}

void lit_summary(const lit_run *run)
{
    for (size_t i = 0; i < run->count; i++) {
        const gno_lit_summary *s = &run->summaries[i];
        int source;
        fputs("light ", stderr);
        print_name(light_name(run, i, &source));
        fprintf(stderr, " (%zu): %.9g of %.9g lit", run->results[i].light, s->lit_area, s->area);
        if (s->dimmed_area > 0) {
            fprintf(stderr, ", %.9g behind transparent polygons", s->dimmed_area);
        }
        fprintf(stderr, "; %zu polygons: %zu unlit, %zu wholly lit, %zu clipped\n", s->polygons, s->unlit, s->full, s->clipped);
        if (run->certified) {
            fprintf(stderr, "  lit + shadowed = area: largest residual %.2g (polygon %zu)\n", s->area_residual, s->area_worst);
            fprintf(stderr, "  lit flux %.12g = flux of all projected %.12g: residual %.2g\n", s->flux_lit, s->flux_union, s->flux_residual);
        }
    }
}

static void print_light(FILE *out, const lit_run *run, size_t i)
{
    const gno_lit_summary *s = &run->summaries[i];
    int source;
    const char *name = light_name(run, i, &source);
    const struct { const char *key; double value; } numbers[] = {
        {"area", s->area}, {"lit_area", s->lit_area}, {"dimmed_area", s->dimmed_area}, {"polygons", (double)s->polygons},
        {"unlit", (double)s->unlit}, {"full", (double)s->full}, {"clipped", (double)s->clipped}, {"casters", (double)s->casters},
    };
    const struct { const char *key; double value; } proof[] = {
        {"area_residual", s->area_residual}, {"area_worst", (double)s->area_worst}, {"flux_lit", s->flux_lit},
        {"flux_twice", s->flux_twice}, {"flux_union", s->flux_union}, {"flux_residual", s->flux_residual},
    };
    fprintf(out, "%s\n    {\"light\": ", i > 0 ? "," : "");
    json_string(out, name);
    fprintf(out, ", \"number\": %zu, \"source\": %d", run->results[i].light, source);
    for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++) {
        fprintf(out, ", \"%s\": ", numbers[k].key);
        json_number(out, numbers[k].value);
    }
    if (run->certified) {
        fprintf(out, ",\n     \"certificate\": {");
        for (size_t k = 0; k < sizeof proof / sizeof proof[0]; k++) {
            fprintf(out, "%s\"%s\": ", k > 0 ? ", " : "", proof[k].key);
            json_number(out, proof[k].value);
        }
        fputc('}', out);
    }
    fprintf(out, ",\n     \"seconds\": {\"prepare\": %.6f, \"tree\": %.6f, \"pieces\": %.6f, \"certificate\": %.6f}}", s->prepare_seconds,
            s->tree_seconds, s->piece_seconds, s->certificate_seconds);
}

static void print(FILE *out, const void *user)
{
    const lit_run *run = user;
    fprintf(out, "{\n  \"scene\": ");
    json_string(out, run->scene_path);
    fprintf(out, ",\n  \"threads\": %d,\n  \"lights\": [", run->threads);
    for (size_t i = 0; i < run->count; i++) {
        print_light(out, run, i);
    }
    fprintf(out, "],\n  \"seconds\": {\"load\": %.6f, \"write\": %.6f, \"total\": %.6f},\n  \"peak_memory\": %zu\n}\n", run->load_seconds,
            run->write_seconds, run->total_seconds, run->peak_memory);
}

int lit_stats(const char *path, const lit_run *run)
{
    return report_write(path, print, run);
}
