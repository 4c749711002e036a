/* vector.c -- gnomon vector: what the camera sees as a drawing, SVG or PDF.
 *
 * Place: arguments -> settings -> gno_scene_load -> gno_vector_write for every -o.
 */
#include "cli/cli.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum option_id { OUTPUT, FORMAT, SIZE, EDGES, EDGE_WIDTH, EDGE_COLOUR, CREASE, BACKGROUND, UNDERLAY, DIGITS, TITLE, EXPOSURE, THREADS, SET, MEMORY, QUIET, HELP };

static const option options[] = {
    [OUTPUT] = {"output", 'o', "FILE", "drawing, by extension: .svg or .pdf; \"-\" is standard output and needs\n"
                                       "--format; may be given several times; without it the scene's name\n"
                                       "with .svg, in the current folder"},
    [FORMAT] = {"format", 0, "NAME", "svg or pdf, whatever the extension"},
    [SIZE] = {"size", 0, "WxH", "pixels, instead of the scene's"},
    [EDGES] = {"edges", 0, "NAME", "lines where edges are visible: none (default), silhouette, visible\n"
                                   "(those and where planes meet), all (outlines of shadows too)"},
    [EDGE_WIDTH] = {"edge-width", 0, "X", "pixels (1)"},
    [EDGE_COLOUR] = {"edge-colour", 0, "R,G,B", "linear, as colours in scenes (0,0,0)"},
    [CREASE] = {"crease", 0, "ANGLE", "planes that meet at less have no edge, degrees (1)"},
    [BACKGROUND] = {"background", 0, "KIND", "scene (default), or none: nothing is drawn where nothing is seen"},
    [UNDERLAY] = {"underlay", 0, "KIND", "rims (default): shapes once more beneath, with rims, against seams in\n"
                                         "viewers; none: each shape once"},
    [DIGITS] = {"digits", 0, "N", "of coordinates in the SVG after the point, 0 to 9 (4)"},
    [TITLE] = {"title", 0, "TEXT", "the drawing's title"},
    [EXPOSURE] = {"exposure", 0, "X", "factor on all colours (1)"},
    [THREADS] = {"threads", 0, "N", "0, the default: one per processor; the drawing is the same"},
    [SET] = {"set", 0, "KEY=VALUE", "override a scene value, e.g. camera.eye=[1,2,3]; may be given\n"
                                    "several times"},
    [MEMORY] = {"memory", 0, "SIZE", MEMORY_HELP},
    [QUIET] = {"quiet", 'q', NULL, "no progress bar and no warnings"},
    [HELP] = {"help", 'h', NULL, "this text"},
};

enum { OPTIONS = sizeof options / sizeof options[0] };

typedef struct job {
    scene_wish scene;
    const char *paths[MOST_OUTPUTS];
    int path_count;
    char *default_output;
    gno_vector_def def;
} job;

static int help(void)
{
    printf("usage: gnomon vector [OPTIONS] SCENE [-o FILE]...\n\n"
           "Draws what the camera of SCENE sees as filled shapes without hidden parts, one for each polygon and each set of\n"
           "lights that reaches parts of it. SCENE is a scene file (.yaml, .yml) or a mesh file alone (.obj, .ply, .stl, .gltf, .glb).\n\n"
           "options:\n");
    option_print(options, OPTIONS);
    printf("\nLimits: glass hides what lies behind it; a shape has one colour, the mean of its texture and of its smooth\n"
           "shading; soft shadows, and those of textures with holes, are whole. gnomon render has none of these limits.\n\n"
           "Each shape of an SVG says where it comes from: data-polygon, data-object, data-material, data-lights, data-area.\n\n"
           "examples:\n"
           "  gnomon vector town.yaml -o town.svg -o town.pdf\n"
           "  gnomon vector town.yaml --edges visible --edge-width 0.7 -o town.svg\n"
           "  gnomon vector town.yaml -o - --format svg | rsvg-convert -o town.png\n");
    return close_output();
}

/* The index of a word in a list that ends with NULL, -1: none of them. */
static int choose(const char *word, const char *const *words)
{
    for (int i = 0; words[i] != NULL; i++) {
        if (strcmp(word, words[i]) == 0) {
            return i;
        }
    }
    return -1;
}

static int parse_colour(char *text, double colour[3])
{
    char *rest = text;
    for (int k = 0; k < 3; k++) {
        char *comma = strchr(rest, ',');
        if ((comma != NULL) != (k < 2)) {
            return 0;
        }
        if (comma != NULL) {
            *comma = '\0';
        }
        if (!parse_real(rest, &colour[k]) || colour[k] < 0.0) {
            return 0;
        }
        rest = comma != NULL ? comma + 1 : rest;
    }
    return 1;
}

/* Options about edges; returns an exit status, or -1 to go on. */
static int take_edge_option(job *work, int id, char *value)
{
    static const char *const kinds[] = {"none", "silhouette", "visible", "all", NULL};
    gno_vector_def *def = &work->def;
    int index;
    switch (id) {
    case EDGES:
        index = choose(value, kinds);
        def->edges = index >= 0 ? (gno_vector_edges)index : GNO_EDGES_NONE;
        return index >= 0 ? -1 : usage("vector", "--edges %s: not one of none, silhouette, visible, all", value);
    case EDGE_WIDTH:
        return parse_real(value, &def->edge_width) && def->edge_width > 0.0
                   ? -1
                   : usage("vector", "--edge-width %s: not a number greater than 0", value);
    case EDGE_COLOUR:
        return parse_colour(value, def->edge_colour) ? -1 : usage("vector", "--edge-colour: not three numbers, each 0 or more, with commas");
    default:
        return parse_real(value, &def->crease) && def->crease >= 0.0 && def->crease <= 180.0
                   ? -1
                   : usage("vector", "--crease %s: not a number from 0 to 180", value);
    }
}

/* Returns an exit status, or -1 to go on. */
static int take_option(void *job_of, int id, char *value)
{
    job *work = job_of;
    static const char *const formats[] = {"svg", "pdf", NULL}, *const backgrounds[] = {"none", "scene", NULL},
                             *const underlays[] = {"none", "rims", NULL};
    gno_vector_def *def = &work->def;
    int index;
    switch (id) {
    case OUTPUT:
        if (work->path_count == MOST_OUTPUTS) {
            return usage("vector", "more than %d outputs", MOST_OUTPUTS);
        }
        work->paths[work->path_count++] = value;
        return -1;
    case FORMAT:
        index = choose(value, formats);
        def->format = index == 0 ? GNO_VECTOR_SVG : GNO_VECTOR_PDF;
        return index >= 0 ? -1 : usage("vector", "--format %s: not one of svg, pdf", value);
    case EDGES:
    case EDGE_WIDTH:
    case EDGE_COLOUR:
    case CREASE:
        return take_edge_option(work, id, value);
    case BACKGROUND:
        def->background = choose(value, backgrounds);
        return def->background >= 0 ? -1 : usage("vector", "--background %s: not one of scene, none", value);
    case UNDERLAY:
        def->underlay = choose(value, underlays);
        return def->underlay >= 0 ? -1 : usage("vector", "--underlay %s: not one of rims, none", value);
    case DIGITS:
        return parse_int(value, 0, 9, &def->digits) ? -1 : usage("vector", "--digits %s: not a number from 0 to 9", value);
    case TITLE:
        def->title = value;
        return -1;
    case EXPOSURE:
        return parse_real(value, &def->exposure) && def->exposure >= 0.0 ? -1 : usage("vector", "--exposure %s: not a number, 0 or more", value);
    case HELP:
        return help();
    default:
        return take_common(&work->scene, "vector", options[id].name, value);
    }
}

/* Names and places of the files, before the work starts; returns an exit status, or -1 to go on. */
static int check_outputs(job *work)
{
    static const char *const extensions[] = {".svg", ".pdf", NULL};
    int standard = 0;
    if (work->path_count == 0) {
        work->default_output = output_default(work->scene.path, work->def.format == GNO_VECTOR_PDF ? ".pdf" : ".svg");
        if (work->default_output == NULL) {
            say("out of memory");
            return EXIT_FAILED;
        }
        work->paths[work->path_count++] = work->default_output;
    }
    for (int i = 0; i < work->path_count; i++) {
        const char *path = work->paths[i];
        standard += strcmp(path, "-") == 0;
        if (work->def.format == GNO_VECTOR_AUTO && strcmp(path, "-") == 0) {
            return usage("vector", "standard output needs --format svg or --format pdf");
        }
        if (work->def.format == GNO_VECTOR_AUTO && output_extension(path, extensions) < 0) {
            return usage("vector", "%s: the extension is not one of .svg, .pdf", path);
        }
    }
    if (standard > 1) {
        return usage("vector", "standard output can take one drawing only");
    }
    for (int i = 0; i < work->path_count; i++) {
        const int status = output_check_place(work->paths[i]);
        if (status != EXIT_DONE) {
            return status;
        }
    }
    return -1;
}

/* Returns an exit status, or -1 to go on. */
static int read_arguments(job *work, int argc, char **argv)
{
    option_reader reader = option_reader_make("vector", options, OPTIONS, argc, argv);
    const int wrong = options_read(&reader, take_option, work, &work->scene.path);
    return wrong >= 0 ? wrong : check_outputs(work);
}

static gno_status draw(const job *work, gno_scene *scene)
{
    gno_status status = GNO_OK;
    gno_vector_def def = work->def;
    def.threads = work->scene.threads;
    interrupt_catch();
    for (int i = 0; i < work->path_count && status == GNO_OK; i++) {
        const int stream = output_begin(work->paths[i]);
        status = gno_vector_write(scene, work->paths[i], &def);
        output_end(stream, status);
    }
    if (status == GNO_OK && interrupt_signal() != 0) {
        status = GNO_ERROR_CANCELLED;
    }
    return status;
}

static int run_job(const job *work)
{
    session s;
    session_begin(&s, &work->scene);
    int result = session_load(&s);
    if (result < 0) {
        result = session_result(&s, draw(work, s.scene));
    }
    interrupt_release();
    session_end(&s);
    return result;
}

static int run(int argc, char **argv)
{
    job work;
    int status = EXIT_FAILED;
    memset(&work, 0, sizeof work);
    work.def = gno_vector_def_default();
    if (scene_wish_make(&work.scene, argc)) {
        status = read_arguments(&work, argc, argv);
        status = status < 0 ? run_job(&work) : status;
    }
    scene_wish_free(&work.scene);
    free(work.default_output);
    return status;
}

const command command_vector = {"vector", "draw a scene as shapes: SVG, PDF", run};
