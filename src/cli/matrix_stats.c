/* matrix_stats.c -- see matrix_stats.h. */
#include "cli/matrix_stats.h"

#include "cli/json.h"

static void print_light(FILE *out, const matrix_report *report, const matrix_stats *s)
{
    const gno_matrix_info *i = &s->info;
    fprintf(out, "{\n  \"scene\": ");
    json_string(out, report->scene);
    fprintf(out, ",\n  \"light\": ");
    json_string(out, s->light);
    fprintf(out, ",\n  \"polygons\": %zu,\n  \"seconds\": {\"load\": ", i->size);
    json_seconds(out, report->load_seconds);
    fprintf(out, ", \"prepare\": ");
    json_seconds(out, i->prepare_seconds);
    fprintf(out, ", \"build\": ");
    json_seconds(out, i->build_seconds);
    fprintf(out, ", \"write\": ");
    json_seconds(out, s->write_seconds);
    fprintf(out, "},\n  \"counts\": {\"ones\": %zu, \"diagonal\": %zu, \"longest_column\": %zu},\n", i->ones, i->diagonal, i->longest);
    fprintf(out, "  \"columns\": {\"own_shadow\": %zu, \"covered\": %zu, \"part\": %zu, \"no_caster\": %zu, \"no_area\": %zu},\n", i->own,
            i->covered, i->part, i->none, i->no_area);
    if (s->checked) {
        fprintf(out, "  \"false_ones\": {\"judged\": %zu, \"false\": %zu, \"share\": ", s->check.judged, s->check.false_ones);
        json_number(out, s->check.judged > 0 ? (double)s->check.false_ones / (double)s->check.judged : 0);
        fprintf(out, "},\n");
    }
    fprintf(out, "  \"matrix_bytes\": %zu, \"peak_memory\": %zu\n}\n", i->bytes, s->peak_memory);
}

void matrix_stats_print(FILE *out, const void *data)
{
    const matrix_report *report = data;
    for (int i = 0; i < report->count; i++) {
        print_light(out, report, &report->lights[i]);
    }
}
