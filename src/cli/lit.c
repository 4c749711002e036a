/* lit.c -- gnomon lit: the lit area of every polygon under every light, as a table and as polygons.
 *
 * Place: arguments -> gno_scene_load -> gno_lit_pieces for each light -> gno_lit_table_write, gno_pieces_write -> summary.
 */
#include "cli/lit.h"

#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/session.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum option_id { OUTPUT, PIECES, LIGHT, THREADS, NO_CERTIFICATE, SET, MEMORY, STATS, QUIET, HELP };

static const option options[] = {
    [OUTPUT] = {"output", 'o', "FILE", "the table, .csv; \"-\" or no -o at all: standard output"},
    [PIECES] = {"pieces", 0, "FILE", "the lit pieces as polygons, by extension: .obj, .geojson, .json;\nmay be given several times"},
    [LIGHT] = {"light", 0, "NAME", "this light only; may be given several times (all lights)"},
    [THREADS] = {"threads", 0, "N", "0, the default: one per processor; the results are the same"},
    [NO_CERTIFICATE] = {"no-certificate", 0, NULL, "leave out the run's proof, which takes about half the time"},
    [SET] = {"set", 0, "KEY=VALUE", "override a scene value, e.g. lights[0].direction=[1,0,-2]; may be\ngiven several times"},
    [MEMORY] = {"memory", 0, "SIZE", MEMORY_HELP},
    [STATS] = {"stats", 0, "FILE", "the summary as one JSON object; \"-\" is standard output"},
    [QUIET] = {"quiet", 'q', NULL, "no progress bar, no warnings, no summary"},
    [HELP] = {"help", 'h', NULL, "this text"},
};

enum { OPTIONS = sizeof options / sizeof options[0], MOST_FILES = 8 };

typedef struct job {
    scene_wish scene;
    const char *table_path, *stats_path;
    int piece_files;
    const char *piece_paths[MOST_FILES];
    const char **light_names; /* room for one an argument */
    size_t light_count;
    gno_lit_def def;
} job;

static int help(void)
{
    printf("usage: gnomon lit [OPTIONS] SCENE [-o FILE]\n\n"
           "Finds the lit part of every polygon under every light, exactly, and writes a table with one line\n"
           "a polygon and light: polygon number, object, light, sample (point of an area light), side that\n"
           "faces the light (1: front, -1: back, 0: edge-on), area, lit area, lit fraction, area reached\n"
           "through transparent polygons only, centroid of the lit part.\n\noptions:\n");
    option_print(options, OPTIONS);
    printf("\nA summary on standard error gives the run's own proof: lit + shadowed area of every polygon against its\n"
           "area, and the light taken by all lit parts against the area of everything projected along the light.\n\n"
           "examples:\n"
           "  gnomon lit town.yaml -o lit.csv\n"
           "  gnomon lit house.yaml --light sun --set 'lights[0].direction=[-1,0.4,-1]' -o morning.csv --pieces morning.obj\n"
           "  gnomon lit house.yaml -q | awk -F, '$8 < 0.5'               polygons less than half lit\n");
    return close_output();
}

/* Returns an exit status, or -1 to go on. */
static int take_option(void *job_of, int id, char *value)
{
    job *work = job_of;
    static const char *const table[] = {".csv", NULL}, *const geometry[] = {".obj", ".geojson", ".json", NULL};
    switch (id) {
    case OUTPUT:
        if (work->table_path != NULL) {
            return usage("lit", "one table at a time: \"%s\" after \"%s\"", value, work->table_path);
        }
        work->table_path = value;
        return strcmp(value, "-") == 0 || output_extension(value, table) >= 0 ? -1 : usage("lit", "%s: the extension is not .csv", value);
    case PIECES:
        if (work->piece_files == MOST_FILES) {
            return usage("lit", "more than %d files of pieces", MOST_FILES);
        }
        work->piece_paths[work->piece_files++] = value;
        return output_extension(value, geometry) >= 0 ? -1 : usage("lit", "%s: the extension is not one of .obj, .geojson, .json", value);
    case LIGHT:
        work->light_names[work->light_count++] = value;
        return -1;
    case NO_CERTIFICATE:
        work->def.certify = 0;
        return -1;
    case STATS:
        work->stats_path = value;
        return -1;
    case HELP:
        return help();
    default:
        return take_common(&work->scene, "lit", options[id].name, value);
    }
}

/* Returns an exit status, or -1 to go on. */
static int read_arguments(job *work, int argc, char **argv)
{
    option_reader reader = option_reader_make("lit", options, OPTIONS, argc, argv);
    const int wrong = options_read(&reader, take_option, work, &work->scene.path);
    if (wrong >= 0) {
        return wrong;
    }
    if (work->table_path == NULL) {
        work->table_path = "-";
    }
    if (work->stats_path != NULL && strcmp(work->stats_path, "-") == 0 && strcmp(work->table_path, "-") == 0) {
        return usage("lit", "standard output cannot take both the table and --stats");
    }
    int status = output_check_place(work->table_path);
    for (int i = 0; i < (int)work->piece_files && status == EXIT_DONE; i++) {
        status = output_check_place(work->piece_paths[i]);
    }
    return status == EXIT_DONE ? -1 : status;
}

/* Marks the lights asked for, or all; returns 0 when there is none of that name, or none at all. */
static int mark_lights(const job *work, const session *s, unsigned char *wanted)
{
    const int count = (int)gno_scene_count(s->scene).lights;
    memset(wanted, work->light_count == 0, (size_t)count);
    for (size_t i = 0; i < work->light_count; i++) {
        const int light = session_find_light(s, work->light_names[i]);
        if (light < 0) {
            return 0;
        }
        wanted[light] = 1;
    }
    if (count == 0) {
        say("%s: no lights", work->scene.path);
    }
    return count > 0;
}

/* Bytes of one light's rows; through the context, so that they count for --memory. */
static size_t rows_size(const gno_scene *scene)
{
    return (gno_scene_count(scene).polygons + 1) * sizeof(gno_lit_row);
}

static gno_status light_scene(const job *work, const unsigned char *wanted, lit_run *run)
{
    gno_context *context = gno_scene_context(run->scene);
    const size_t lights = gno_expanded_light_count(run->scene), polygons = gno_scene_count(run->scene).polygons;
    gno_status status = GNO_OK;
    gno_lit_def def = work->def;
    def.threads = work->scene.threads;
    for (size_t i = 0; i < lights && status == GNO_OK; i++) {
        gno_lit_result *result = &run->results[run->count];
        gno_pieces *pieces = NULL;
        gno_light light;
        int source;
        status = gno_expanded_light(run->scene, i, &light, &source);
        if (status != GNO_OK || !wanted[source]) {
            continue;
        }
        gno_lit_row *rows = polygons < SIZE_MAX / sizeof *rows ? gno_context_realloc(context, NULL, 0, rows_size(run->scene)) : NULL;
        if (rows == NULL) {
            return gno_context_fail(context, GNO_ERROR_MEMORY, "out of memory for the table");
        }
        status = gno_lit_pieces(run->scene, i, &def, work->piece_files > 0 ? &pieces : NULL, rows, &run->summaries[run->count]);
        result->light = i;
        result->rows = rows;
        result->pieces = pieces;
        run->count++;
    }
    return status;
}

/* piece: which file of pieces, -1 for the table. */
static gno_status write_file(const job *work, const lit_run *run, int piece)
{
    const char *path = piece < 0 ? work->table_path : work->piece_paths[piece];
    const int stream = output_begin(path);
    const gno_status status = piece < 0 ? gno_lit_table_write(run->scene, path, run->results, run->count)
                                        : gno_pieces_write(run->scene, path, run->results, run->count);
    output_end(stream, status);
    return status;
}

static gno_status write_files(const job *work, const lit_run *run)
{
    gno_status status = GNO_OK;
    for (int i = -1; i < work->piece_files && status == GNO_OK; i++) {
        status = write_file(work, run, i);
    }
    return status == GNO_OK && interrupt_signal() != 0 ? gno_context_fail(gno_scene_context(run->scene), GNO_ERROR_CANCELLED, "interrupted") : status;
}

static void free_results(lit_run *run)
{
    for (size_t i = 0; i < run->count; i++) {
        gno_context_realloc(gno_scene_context(run->scene), (void *)run->results[i].rows, rows_size(run->scene), 0);
        gno_pieces_destroy((gno_pieces *)run->results[i].pieces);
    }
    free(run->results);
    free(run->summaries);
}

static int run_scene(const job *work, session *s, const unsigned char *wanted, lit_run *run)
{
    interrupt_catch();
    gno_status status = light_scene(work, wanted, run);
    progress_clear(&s->shown);
    const double written_from = seconds_now();
    if (status == GNO_OK) {
        status = write_files(work, run);
    }
    if (status != GNO_OK) {
        return session_result(s, status);
    }
    interrupt_release();
    run->write_seconds = seconds_now() - written_from;
    run->total_seconds = seconds_now() - s->begun;
    gno_context_memory(s->context, &run->peak_memory);
    if (!work->scene.quiet) {
        lit_summary(run);
    }
    return work->stats_path != NULL ? lit_stats(work->stats_path, run) : EXIT_DONE;
}

static int run_loaded(const job *work, session *s)
{
    const size_t points = gno_expanded_light_count(s->scene), lights = gno_scene_count(s->scene).lights;
    unsigned char *wanted = calloc(lights + 1, 1);
    lit_run run;
    int status = EXIT_FAILED;
    memset(&run, 0, sizeof run);
    run.scene_path = work->scene.path;
    run.scene = s->scene;
    run.certified = work->def.certify;
    run.threads = session_threads(s);
    run.load_seconds = s->load_seconds;
    run.results = calloc(points + 1, sizeof *run.results);
    run.summaries = calloc(points + 1, sizeof *run.summaries);
    if (wanted == NULL || run.results == NULL || run.summaries == NULL) {
        say("out of memory");
    } else if (mark_lights(work, s, wanted)) {
        status = run_scene(work, s, wanted, &run);
    }
    free(wanted);
    free_results(&run);
    return status;
}

static int run_job(const job *work)
{
    session s;
    session_begin(&s, &work->scene);
    int status = session_load(&s);
    status = status < 0 ? run_loaded(work, &s) : status;
    session_end(&s);
    return status;
}

static int run(int argc, char **argv)
{
    job work;
    int status = EXIT_FAILED;
    memset(&work, 0, sizeof work);
    work.def = gno_lit_def_default();
    work.light_names = calloc((size_t)argc + 1, sizeof *work.light_names); /* no more names than arguments */
    if (work.light_names == NULL) {
        say("out of memory");
    } else if (scene_wish_make(&work.scene, argc)) {
        status = read_arguments(&work, argc, argv);
        status = status < 0 ? run_job(&work) : status;
    }
    scene_wish_free(&work.scene);
    free(work.light_names);
    return status;
}

const command command_lit = {"lit", "lit area of every polygon and light, as a table and polygons", run};
