/* matrix.c -- gnomon matrix: the binary shadow matrix of a light, as a list or a picture.
 *
 * Place: arguments -> gno_scene_load -> for each light asked for: gno_matrix_build -> gno_matrix_save -> --stats (matrix_stats.c).
 */
#include "cli/cli.h"
#include "cli/interrupt.h"
#include "cli/matrix_stats.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum option_id { OUTPUT, LIGHT, THREADS, CHECK, SET, MEMORY, STATS, QUIET, HELP };

static const option options[] = {
    [OUTPUT] = {"output", 'o', "FILE", "by extension: .mtx (Matrix Market, pattern), .csv, .png (picture);\n"
                                       "\"-\", the default, is a .mtx on standard output; %s in FILE\n"
                                       "stands for the light's name: a file for each light"},
    [LIGHT] = {"light", 0, "NAME", "the light, by its name; default: the first (all with %s in FILE)"},
    [THREADS] = {"threads", 0, "N", "0, the default: one per processor; the matrix is the same"},
    [CHECK] = {"check", 0, NULL, "count the ones that cast no shadow at all, for --stats (done for\n"
                                 "small scenes in any case)"},
    [SET] = {"set", 0, "KEY=VALUE", "override a scene value, as in gnomon render"},
    [MEMORY] = {"memory", 0, "SIZE", MEMORY_HELP},
    [STATS] = {"stats", 0, "FILE", "one JSON object for each light: seconds, counts, share of false\n"
                                   "ones, memory; \"-\" is standard output"},
    [QUIET] = {"quiet", 'q', NULL, "no progress bar and no warnings"},
    [HELP] = {"help", 'h', NULL, "this text"},
};

enum { OPTIONS = sizeof options / sizeof options[0] };

/* Up to so many polygons the ones are checked without being asked for: it takes no time to speak of. */
enum { SMALL_SCENE = 2000 };

typedef struct job {
    scene_wish scene;
    const char *output, *light, *stats_path;
    int check;
    int each; /* the output's name has %s */
} job;

static int help(void)
{
    printf("usage: gnomon matrix [OPTIONS] SCENE [-o FILE]\n\n"
           "The binary shadow matrix of a light in SCENE: rows are casters, columns are receivers. A one means that the\n"
           "row's polygon may keep the light from a part of the column's; a zero is certain. A one on the diagonal is own\n"
           "shadow: the light is behind the polygon. Polygons have the numbers of the scene, in the order of its objects,\n"
           "from 1 in .mtx and from 0 in .csv.\n\noptions:\n");
    option_print(options, OPTIONS);
    printf("\nexamples:\n"
           "  gnomon matrix town.yaml -o town.mtx --light sun\n"
           "  gnomon matrix town.yaml -o town_%%s.png                     a picture for each light\n"
           "  gnomon matrix town.yaml -o town.csv --check --stats -\n");
    return close_output();
}

static int check_output(job *work)
{
    static const char *const extensions[] = {".mtx", ".csv", ".png", NULL};
    const char *percent = strchr(work->output, '%');
    if (strcmp(work->output, "-") == 0) {
        return work->stats_path != NULL && strcmp(work->stats_path, "-") == 0
                   ? usage("matrix", "standard output cannot take both the matrix and --stats")
                   : -1;
    }
    if (output_extension(work->output, extensions) < 0) {
        return usage("matrix", "%s: the extension is not one of .mtx, .csv, .png", work->output);
    }
    if (percent != NULL) {
        if (percent[1] != 's' || strchr(percent + 1, '%') != NULL) {
            return usage("matrix", "%s: a %% in the name must be one %%s", work->output);
        }
        work->each = 1;
    }
    const int status = output_check_place(work->output);
    return status == EXIT_DONE ? -1 : status;
}

/* Returns an exit status, or -1 to go on. */
static int take_option(void *job_of, int id, char *value)
{
    job *work = job_of;
    switch (id) {
    case OUTPUT:
        work->output = value;
        return -1;
    case LIGHT:
        work->light = value;
        return -1;
    case CHECK:
        work->check = 1;
        return -1;
    case STATS:
        work->stats_path = value;
        return -1;
    case HELP:
        return help();
    default:
        return take_common(&work->scene, "matrix", options[id].name, value);
    }
}

static int read_arguments(job *work, int argc, char **argv)
{
    option_reader reader = option_reader_make("matrix", options, OPTIONS, argc, argv);
    const int wrong = options_read(&reader, take_option, work, &work->scene.path);
    return wrong >= 0 ? wrong : check_output(work);
}

/* ---- one light ----------------------------------------------------------------------------------------------------- */

/* FILE with %s replaced by the light's name; what is no part of a file name becomes an underscore. NULL: out of memory. */
static char *path_for(const job *work, const char *name)
{
    const char *percent = work->each ? strchr(work->output, '%') : NULL;
    const size_t head = percent != NULL ? (size_t)(percent - work->output) : strlen(work->output);
    char *path = malloc(strlen(work->output) + strlen(name) + 1);
    if (path == NULL) {
        return NULL;
    }
    memcpy(path, work->output, head);
    path[head] = '\0';
    if (percent != NULL) {
        char *at = path + head;
        for (; *name != '\0'; name++) {
            *at++ = *name == '/' || (unsigned char)*name < ' ' ? '_' : *name;
        }
        strcpy(at, percent + 2);
    }
    return path;
}

static gno_status save(const job *work, gno_context *context, gno_matrix *matrix, const char *name)
{
    gno_matrix_file_def def = gno_matrix_file_def_default();
    char note[300];
    char *path = path_for(work, name);
    if (path == NULL) {
        return gno_context_fail(context, GNO_ERROR_MEMORY, "out of memory");
    }
    snprintf(note, sizeof note, "light \"%.100s\" of %.150s", name, work->scene.path);
    def.note = note;
    const int stream = output_begin(path);
    const gno_status status = gno_matrix_save(matrix, path, &def);
    output_end(stream, status);
    free(path);
    return status;
}

static gno_status run_light(const job *work, gno_scene *scene, int light, matrix_stats *stats)
{
    gno_context *context = gno_scene_context(scene);
    gno_matrix_def def = gno_matrix_def_default();
    gno_matrix *matrix = NULL;
    gno_status status = gno_scene_light(scene, light, NULL, &stats->light);
    def.threads = work->scene.threads;
    if (status == GNO_OK) {
        status = gno_matrix_build(scene, light, &def, &matrix);
    }
    const double built = seconds_now();
    if (status == GNO_OK) {
        status = save(work, context, matrix, stats->light);
    }
    stats->write_seconds = seconds_now() - built;
    if (status == GNO_OK && work->stats_path != NULL) {
        status = gno_matrix_get_info(matrix, &stats->info);
        stats->checked = work->check || stats->info.size <= SMALL_SCENE;
        if (status == GNO_OK && stats->checked) {
            status = gno_matrix_check(scene, light, matrix, &stats->check);
        }
        gno_context_memory(context, &stats->peak_memory);
    }
    gno_matrix_destroy(matrix);
    return status;
}

/* ---- the run ------------------------------------------------------------------------------------------------------- */

static int run_lights(const job *work, session *s)
{
    int first = 0, end = (int)gno_scene_count(s->scene).lights;
    if (end == 0) {
        say("%s: has no light", work->scene.path);
        return EXIT_FAILED;
    }
    if (work->light != NULL) {
        first = session_find_light(s, work->light);
        if (first < 0) {
            return EXIT_FAILED;
        }
    }
    end = work->each && work->light == NULL ? end : first + 1;
    matrix_report report = {work->scene.path, work->scene.threads, s->load_seconds, 0, calloc((size_t)(end - first), sizeof(matrix_stats))};
    if (report.lights == NULL) {
        say("out of memory");
        return EXIT_FAILED;
    }
    gno_status status = GNO_OK;
    interrupt_catch();
    for (int light = first; light < end && status == GNO_OK; light++) {
        status = run_light(work, s->scene, light, &report.lights[report.count++]);
    }
    if (status == GNO_OK && interrupt_signal() != 0) {
        status = GNO_ERROR_CANCELLED;
    }
    int result = session_result(s, status);
    if (result == EXIT_DONE) {
        interrupt_release();
        result = work->stats_path != NULL ? report_write(work->stats_path, matrix_stats_print, &report) : EXIT_DONE;
    }
    free(report.lights);
    return result;
}

static int run_job(const job *work)
{
    session s;
    session_begin(&s, &work->scene);
    int status = session_load(&s);
    status = status < 0 ? run_lights(work, &s) : status;
    session_end(&s);
    return status;
}

static int run(int argc, char **argv)
{
    job work;
    int status = EXIT_FAILED;
    memset(&work, 0, sizeof work);
    work.output = "-";
    if (scene_wish_make(&work.scene, argc)) {
        status = read_arguments(&work, argc, argv);
        status = status < 0 ? run_job(&work) : status;
    }
    scene_wish_free(&work.scene);
    return status;
}

const command command_matrix = {"matrix", "the binary shadow matrix of a light: Matrix Market, CSV, picture", run};
