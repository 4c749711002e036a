/* lit.c -- gnomon lit: the lit area of every polygon under every light, as a table and as polygons.
 *
 * Place: arguments -> gno_scene_load -> gno_lit_pieces for each light -> gno_lit_table_write, gno_pieces_write -> summary.
 */
#include "cli/lit.h"

#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/progress.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

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
    const char *scene_path, *table_path, *stats_path;
    int piece_files;
    const char *piece_paths[MOST_FILES];
    const char **light_names; /* room for one an argument */
    size_t light_count;
    gno_setting *settings;
    size_t setting_count;
    gno_lit_def def;
    size_t memory; /* ceiling, 0: none */
    int quiet;
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

static int has_extension(const char *path, const char *const *extensions, int count)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash != NULL ? slash : path, '.');
    for (int i = 0; dot != NULL && i < count; i++) {
        if (strcasecmp(dot, extensions[i]) == 0) {
            return 1;
        }
    }
    return 0;
}

/* Returns an exit status, or -1 to go on. */
static int take_option(void *job_of, int id, char *value)
{
    job *work = job_of;
    static const char *const table[] = {".csv"}, *const geometry[] = {".obj", ".geojson", ".json"};
    switch (id) {
    case OUTPUT:
        if (work->table_path != NULL) {
            return usage("lit", "one table at a time: \"%s\" after \"%s\"", value, work->table_path);
        }
        work->table_path = value;
        return strcmp(value, "-") == 0 || has_extension(value, table, 1) ? -1 : usage("lit", "%s: the extension is not .csv", value);
    case PIECES:
        if (work->piece_files == MOST_FILES) {
            return usage("lit", "more than %d files of pieces", MOST_FILES);
        }
        work->piece_paths[work->piece_files++] = value;
        return has_extension(value, geometry, 3) ? -1 : usage("lit", "%s: the extension is not one of .obj, .geojson, .json", value);
    case LIGHT:
        work->light_names[work->light_count++] = value;
        return -1;
    case THREADS:
        return parse_int(value, 0, GNO_MAX_THREADS, &work->def.threads)
                   ? -1
                   : usage("lit", "--threads %s: not a number from 0 to %d", value, GNO_MAX_THREADS);
    case NO_CERTIFICATE:
        work->def.certify = 0;
        return -1;
    case SET:
        return parse_setting(value, &work->settings[work->setting_count++]) ? -1 : usage("lit", "--set %s: not KEY=VALUE", value);
    case MEMORY:
        return take_memory("lit", value, &work->memory);
    case STATS:
        work->stats_path = value;
        return -1;
    case QUIET:
        work->quiet = 1;
        return -1;
    default:
        return help();
    }
}

/* Returns an exit status, or -1 to go on. */
static int read_arguments(job *work, int argc, char **argv)
{
    option_reader reader = option_reader_make("lit", options, OPTIONS, argc, argv);
    const int wrong = options_read(&reader, take_option, work, &work->scene_path);
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

static int report(gno_context *context, progress *shown)
{
    progress_clear(shown);
    if (interrupt_signal() != 0) {
        say("interrupted; nothing half done is left");
        return EXIT_SIGNAL + interrupt_signal();
    }
    say("%s", gno_context_message(context));
    return EXIT_FAILED;
}

static int wanted(const job *work, const char *name)
{
    int found = work->light_count == 0;
    for (size_t i = 0; i < work->light_count; i++) {
        found |= strcmp(work->light_names[i], name) == 0;
    }
    return found;
}

/* Says which name is not a light's; returns 0 then. */
static int know_lights(const job *work, const gno_scene *scene)
{
    const int count = (int)gno_scene_count(scene).lights;
    const char **names = calloc((size_t)count + 1, sizeof *names);
    int known = names != NULL;
    gno_light light;
    if (names == NULL) {
        say("out of memory");
    }
    for (int i = 0; i < count && known; i++) {
        known = gno_scene_light(scene, i, &light, &names[i]) == GNO_OK;
    }
    for (size_t k = 0; k < work->light_count && known; k++) {
        known = 0;
        for (int i = 0; i < count && !known; i++) {
            known = strcmp(names[i], work->light_names[k]) == 0;
        }
        if (!known) {
            const char *near = nearest_name(work->light_names[k], names, count);
            say("%s: no light is called \"%s\"%s%s%s", work->scene_path, work->light_names[k], near != NULL ? "; did you mean \"" : "",
                near != NULL ? near : "", near != NULL ? "\"?" : "");
        }
    }
    if (known && count == 0) {
        say("%s: no lights", work->scene_path);
        known = 0;
    }
    free(names);
    return known;
}

/* Bytes of one light's rows; through the context, so that they count for --memory. */
static size_t rows_size(const gno_scene *scene)
{
    return (gno_scene_count(scene).polygons + 1) * sizeof(gno_lit_row);
}

static gno_status light_scene(const job *work, lit_run *run)
{
    gno_context *context = gno_scene_context(run->scene);
    const size_t lights = gno_expanded_light_count(run->scene), polygons = gno_scene_count(run->scene).polygons;
    gno_status status = GNO_OK;
    for (size_t i = 0; i < lights && status == GNO_OK; i++) {
        gno_lit_result *result = &run->results[run->count];
        gno_pieces *pieces = NULL;
        gno_light light;
        const char *name;
        int source;
        status = gno_expanded_light(run->scene, i, &light, &source);
        if (status == GNO_OK) {
            status = gno_scene_light(run->scene, source, &light, &name);
        }
        if (status != GNO_OK || !wanted(work, name)) {
            continue;
        }
        gno_lit_row *rows = polygons < SIZE_MAX / sizeof *rows ? gno_context_realloc(context, NULL, 0, rows_size(run->scene)) : NULL;
        if (rows == NULL) {
            return gno_context_fail(context, GNO_ERROR_MEMORY, "out of memory for the table");
        }
        status = gno_lit_pieces(run->scene, i, &work->def, work->piece_files > 0 ? &pieces : NULL, rows, &run->summaries[run->count]);
        result->light = i;
        result->rows = rows;
        result->pieces = pieces;
        run->count++;
    }
    return status;
}

/* piece: which file of pieces, -1 for the table. A signal ends the program at once while it writes to a stream: see render.c. */
static gno_status write_file(const job *work, const lit_run *run, int piece)
{
    const char *path = piece < 0 ? work->table_path : work->piece_paths[piece];
    const int stream = output_is_stream(path);
    if (stream) {
        interrupt_release();
    }
    const gno_status status = piece < 0 ? gno_lit_table_write(run->scene, path, run->results, run->count)
                                        : gno_pieces_write(run->scene, path, run->results, run->count);
    if (stream && status == GNO_OK) {
        interrupt_catch();
    }
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

static int run_scene(const job *work, gno_context *context, lit_run *run, progress *shown, double begun)
{
    const size_t lights = gno_expanded_light_count(run->scene);
    gno_status status;
    if (!know_lights(work, run->scene)) {
        return EXIT_FAILED;
    }
    run->results = calloc(lights, sizeof *run->results);
    run->summaries = calloc(lights, sizeof *run->summaries);
    if (run->results == NULL || run->summaries == NULL) {
        say("out of memory");
        return EXIT_FAILED;
    }
    interrupt_catch();
    status = light_scene(work, run);
    progress_clear(shown);
    const double written_from = seconds_now();
    if (status == GNO_OK) {
        status = write_files(work, run);
    }
    if (status != GNO_OK) {
        return report(context, shown);
    }
    interrupt_release();
    run->write_seconds = seconds_now() - written_from;
    run->total_seconds = seconds_now() - begun;
    gno_context_memory(context, &run->peak_memory);
    if (!work->quiet) {
        lit_summary(run);
    }
    return work->stats_path != NULL ? lit_stats(work->stats_path, run) : EXIT_DONE;
}

static int run_job(const job *work)
{
    progress shown = progress_make(work->quiet);
    const double begun = seconds_now();
    gno_context_def def = progress_context_def(&shown);
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    gno_context *context = NULL;
    lit_run run;
    int status = EXIT_FAILED;
    memset(&run, 0, sizeof run);
    run.scene_path = work->scene_path;
    run.certified = work->def.certify;
    run.threads = work->def.threads > 0 ? work->def.threads : processors < 1 ? 1 : processors > GNO_MAX_THREADS ? GNO_MAX_THREADS : (int)processors;
    def.max_memory = work->memory;
    if (gno_context_create(&def, &context) != GNO_OK) {
        say("out of memory");
        return EXIT_FAILED;
    }
    if (gno_scene_load(context, work->scene_path, work->settings, work->setting_count, &run.scene) == GNO_OK) {
        run.load_seconds = seconds_now() - begun;
        status = run_scene(work, context, &run, &shown, begun);
    } else {
        status = report(context, &shown);
    }
    free_results(&run);
    gno_scene_destroy(run.scene);
    gno_context_destroy(context);
    return status;
}

static int run(int argc, char **argv)
{
    job work;
    memset(&work, 0, sizeof work);
    work.def = gno_lit_def_default();
    /* No more settings and names than arguments; one more so that the size is never zero. */
    work.settings = calloc((size_t)argc + 1, sizeof *work.settings);
    work.light_names = calloc((size_t)argc + 1, sizeof *work.light_names);
    int status = EXIT_FAILED;
    if (work.settings == NULL || work.light_names == NULL) {
        say("out of memory");
    } else {
        status = read_arguments(&work, argc, argv);
        if (status < 0) {
            status = run_job(&work);
        }
    }
    free(work.settings);
    free(work.light_names);
    return status;
}

const command command_lit = {"lit", "lit area of every polygon and light, as a table and polygons", run};
