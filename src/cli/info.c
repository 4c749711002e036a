/* info.c -- gnomon info: what is in a scene, as a table or as JSON.
 *
 * Place: arguments -> gno_scene_load -> gno_scene_find_problems -> gathered in a `summary` -> printed
 * by info_text.c or info_json.c.
 */
#include "cli/cli.h"
#include "cli/info.h"
#include "cli/options.h"
#include "cli/session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum option_id { SET, MEMORY, THREADS, JSON, QUIET, HELP };

static const option options[] = {
    [SET] = {"set", 0, "KEY=VALUE", "override a scene value, as in gnomon render"},
    [MEMORY] = {"memory", 0, "SIZE", MEMORY_HELP},
    [THREADS] = {"threads", 0, "N", "0, the default: one per processor"},
    [JSON] = {"json", 0, NULL, "one JSON object instead of the table"},
    [QUIET] = {"quiet", 'q', NULL, "no progress bar"},
    [HELP] = {"help", 'h', NULL, "this text"},
};

enum { OPTIONS = sizeof options / sizeof options[0] };

typedef struct job {
    scene_wish scene;
    int json;
} job;

static int help(void)
{
    printf("usage: gnomon info [OPTIONS] SCENE\n\n"
           "Tells what is in SCENE, a scene file (.yaml, .yml) or a mesh file alone (.obj, .ply, .stl, .gltf, .glb):\n"
           "counts, bounds, camera, lights, materials, and what is wrong with its polygons: those without area, not\n"
           "planar, given twice, wound against their neighbours; edges of one polygon alone, and of more than two. An edge\n"
           "of one polygon is no problem where flat parts end, as a floor does; elsewhere it may be a gap in a body. The\n"
           "table names the first of each, --json all of them; polygons are numbered from 0 as they are read.\n\noptions:\n");
    option_print(options, OPTIONS);
    printf("\nexamples:\n"
           "  gnomon info town.yaml\n"
           "  gnomon info --json bunny.obj | jq .counts.polygons\n"
           "  gnomon info --json bunny.obj | jq .problems.ids.flipped\n");
    return close_output();
}

/* Returns an exit status, or -1 to go on. */
static int take_option(void *job_of, int id, char *value)
{
    job *work = job_of;
    switch (id) {
    case JSON:
        work->json = 1;
        return -1;
    case HELP:
        return help();
    default:
        return take_common(&work->scene, "info", options[id].name, value);
    }
}

static int read_arguments(job *work, int argc, char **argv)
{
    option_reader reader = option_reader_make("info", options, OPTIONS, argc, argv);
    return options_read(&reader, take_option, work, &work->scene.path);
}

/* Stops the search when memory is short; `full` tells so. */
static int keep_problem(void *user, const gno_problem *problem)
{
    found_list *list = user;
    if (list->count == list->room) {
        const size_t room = list->room * 2 + 64;
        gno_problem *grown = gno_context_realloc(list->context, list->items, list->room * sizeof *grown, room * sizeof *grown);
        if (grown == NULL) {
            list->full = 1;
            return 1;
        }
        list->items = grown;
        list->room = room;
    }
    list->items[list->count++] = *problem;
    return 0;
}

static gno_status gather(const job *work, gno_scene *scene, summary *found)
{
    gno_status status = gno_scene_prepare(scene, work->scene.threads, &found->problems);
    found->list.context = gno_scene_context(scene);
    if (status == GNO_OK) {
        status = gno_scene_find_problems(scene, work->scene.threads, keep_problem, &found->list, found->problem_counts);
    }
    if (found->list.full) {
        return gno_context_fail(gno_scene_context(scene), GNO_ERROR_MEMORY, "out of memory for the list of problems");
    }
    if (status != GNO_OK) {
        return status;
    }
    found->path = work->scene.path;
    found->counts = gno_scene_count(scene);
    found->has_bounds = gno_scene_bounds(scene, found->lower, found->upper);
    found->material_polygons = calloc(found->counts.materials + 1, sizeof *found->material_polygons);
    if (found->material_polygons == NULL) {
        return gno_context_fail(gno_scene_context(scene), GNO_ERROR_MEMORY, "out of memory");
    }
    for (size_t i = 0; i < found->counts.polygons; i++) {
        gno_polygon polygon;
        if (gno_scene_polygon(scene, i, &polygon) == GNO_OK) {
            found->material_polygons[polygon.material]++;
            found->holes += polygon.ring_count - 1;
        }
    }
    return GNO_OK;
}

/* The reader's remarks belong into the report, so they are kept instead of printed; a remark that memory is too short for is
 * printed after all. */
static void keep_warning(void *user, gno_log_level level, const char *text)
{
    summary *found = user;
    if (level != GNO_LOG_WARNING || found->scene != NULL) {
        return; /* what preparing remarks is in the counts of problems */
    }
    if (found->warning_count == found->warning_room) {
        const size_t room = found->warning_room * 2 + 16;
        char **grown = realloc(found->warnings, room * sizeof *grown);
        if (grown == NULL) {
            say("warning: %s", text);
            return;
        }
        found->warnings = grown;
        found->warning_room = room;
    }
    const size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    if (copy == NULL) {
        say("warning: %s", text);
        return;
    }
    memcpy(copy, text, size);
    found->warnings[found->warning_count++] = copy;
}

static int run_loaded(const job *work, session *s, summary *found)
{
    found->scene = s->scene;
    int status = session_result(s, gather(work, s->scene, found));
    if (status == EXIT_DONE) {
        if (work->json) {
            info_json(found);
        } else {
            info_text(found);
        }
        status = close_output();
    }
    return status;
}

static int run_job(const job *work)
{
    session s;
    summary found;
    memset(&found, 0, sizeof found);
    session_begin(&s, &work->scene);
    s.def.log = keep_warning;
    s.def.log_user = &found;
    int status = session_load(&s);
    status = status < 0 ? run_loaded(work, &s, &found) : status;
    for (size_t i = 0; i < found.warning_count; i++) {
        free(found.warnings[i]);
    }
    free(found.warnings);
    free(found.material_polygons);
    if (found.list.items != NULL) {
        gno_context_realloc(s.context, found.list.items, found.list.room * sizeof *found.list.items, 0);
    }
    session_end(&s);
    return status;
}

static int run(int argc, char **argv)
{
    job work;
    int status = EXIT_FAILED;
    memset(&work, 0, sizeof work);
    if (scene_wish_make(&work.scene, argc)) {
        status = read_arguments(&work, argc, argv);
        status = status < 0 ? run_job(&work) : status;
    }
    scene_wish_free(&work.scene);
    return status;
}

const command command_info = {"info", "tell what is in a scene", run};
