/* render.c -- gnomon render: a scene file to pictures.
 *
 * Place: arguments -> settings -> gno_scene_load -> for every frame (frames.h): gno_render -> gno_picture_write for every -o -> --stats.
 */
#include "cli/cli.h"
#include "cli/frames.h"
#include "cli/interrupt.h"
#include "cli/layers.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/session.h"
#include "cli/stats.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum option_id { OUTPUT, FRAMES, SIZE, LINES, THREADS, EXPOSURE, DEPTH, TERMINATOR, DETAILS, ENGINE, AOV, RANKS, MEMORY, SET, STATS, QUIET, HELP };

static const option options[] = {
    [OUTPUT] = {"output", 'o', "FILE", "picture, by extension: .png (sRGB), .exr (linear), .pfm (linear);\n"
                                       "\"-\" is a PNG on standard output; may be given several times;\n"
                                       "without it the scene's name with .png, in the current folder"},
    [FRAMES] = {"frames", 0, "A:B", "frames of the scene's camera.path: A to B, one, or all; several need\n"
                                    "a number in FILE, such as out_%04d.png, which alone means all"},
    [SIZE] = {"size", 0, "WxH", "pixels, instead of the scene's"},
    [LINES] = {"lines", 0, "N or B:N", "sample lines per pixel row: N everywhere, or B and up to N where\n"
                                       "the picture varies (N an odd multiple of B)"},
    [THREADS] = {"threads", 0, "N", "0, the default: one per processor; the picture is the same"},
    [EXPOSURE] = {"exposure", 0, "X", "factor on all values of the picture (1)"},
    [DEPTH] = {"depth", 0, "BITS", "8 or 16 for PNG (8), 16 or 32 for EXR (16), 32 for PFM"},
    [TERMINATOR] = {"terminator", 0, "KIND", "shadows on smooth-shaded meshes: exact, as the flat facets cast\n"
                                             "them (default), or smooth"},
    [DETAILS] = {"details", 0, "KIND", "coplanar: polygons lying wholly inside larger ones in their plane,\n"
                                       "as windows on uncut walls, are drawn on them; or none; instead of\n"
                                       "what the scene's meshes ask for"},
    [ENGINE] = {"engine", 0, "NAME", "scanline (default); weiler-atherton: visible pieces as polygons, painted\n"
                                 "with exact coverage (--lines has no meaning there; scenes with softness or\n"
                                 "holes of textures are drawn by 16 sample lines, with a warning)"},
    [AOV] = {"aov", 0, "LIST", "layers beside the picture in .exr files (scanline engine only), with commas between:\n" LAYER_NAMES},
    [RANKS] = {"ranks", 0, "N", "pairs of id and coverage in each pixel for the layers polygon,\n"
                                "object and material (6)"},
    [SET] = {"set", 0, "KEY=VALUE", "override a scene value, e.g. camera.eye=[1,2,3]; may be given\n"
                                    "several times"},
    [MEMORY] = {"memory", 0, "SIZE", MEMORY_HELP},
    [STATS] = {"stats", 0, "FILE", "one JSON object: seconds per stage, counts, peak memory; \"-\" is\n"
                                   "standard output"},
    [QUIET] = {"quiet", 'q', NULL, "no progress bar and no warnings"},
    [HELP] = {"help", 'h', NULL, "this text"},
};

enum { OPTIONS = sizeof options / sizeof options[0] };

typedef struct job {
    scene_wish scene;
    outputs files;
    frame_wish frames;
    char *default_output;
    int details;       /* -1: the scene's */
    int depth;
    double exposure;
    gno_render_def def;
    layers_wish layers;
    const char *stats_path;
} job;

static int help(void)
{
    const gno_render_def def = gno_render_def_default();
    printf("usage: gnomon render [OPTIONS] SCENE [-o FILE]...\n\n"
           "Draws SCENE, a scene file (.yaml, .yml) or a mesh file alone (.obj, .ply, .stl, .gltf, .glb).\n\noptions:\n");
    option_print(options, OPTIONS);
    printf("\nThe default of --lines is %d:%d.\n\n"
           "examples:\n"
           "  gnomon render town.yaml                                    town.png\n"
           "  gnomon render town.yaml -o town.png -o town.exr --size 1920x1080\n"
           "  gnomon render bunny.obj --set camera.eye=[0,-3,1] --set 'image.background=[1,1,1]'\n"
           "  gnomon render town.yaml -o town.exr --aov depth,normal,object\n"
           "  gnomon render town.yaml -o town_%%04d.png --frames all       every frame of its camera.path\n"
           "  gnomon render town.yaml -o - --size 320x180 | display -\n"
           "  gnomon render town.yaml --threads 1 --stats -              how long each stage took\n",
           def.base_lines, def.lines);
    return close_output();
}

static int parse_lines(const char *text, gno_render_def *def)
{
    char copy[32];
    snprintf(copy, sizeof copy, "%s", text);
    char *colon = strchr(copy, ':');
    if (strlen(text) >= sizeof copy) {
        return 0;
    }
    if (colon != NULL) {
        *colon = '\0';
    }
    if (!parse_int(copy, 1, GNO_MAX_LINES, &def->base_lines) ||
        !parse_int(colon != NULL ? colon + 1 : copy, 1, GNO_MAX_LINES, &def->lines)) {
        return 0;
    }
    return def->lines % def->base_lines == 0 && def->lines / def->base_lines % 2 == 1;
}

/* Returns an exit status, or -1 to go on. */
static int take_option(void *job_of, int id, char *value)
{
    job *work = job_of;
    switch (id) {
    case OUTPUT:
        if (work->files.count == MOST_OUTPUTS) {
            return usage("render", "more than %d outputs", MOST_OUTPUTS);
        }
        work->files.paths[work->files.count++] = value;
        return -1;
    case FRAMES:
        return frames_parse(value, &work->frames) ? -1 : usage("render", "--frames %s: not all, a frame, or A:B with A not after B", value);
    case LINES:
        return parse_lines(value, &work->def)
                   ? -1
                   : usage("render", "--lines %s: not a number from 1 to %d, nor B:N with N an odd multiple of B", value, GNO_MAX_LINES);
    case EXPOSURE:
        return parse_real(value, &work->exposure) && work->exposure >= 0.0 ? -1 : usage("render", "--exposure %s: not a number, 0 or more", value);
    case DEPTH:
        return parse_int(value, 8, 32, &work->depth) && (work->depth == 8 || work->depth == 16 || work->depth == 32)
                   ? -1
                   : usage("render", "--depth %s: not one of 8, 16, 32", value);
    case TERMINATOR:
        work->def.terminator = strcmp(value, "smooth") == 0 ? GNO_TERMINATOR_SMOOTH : GNO_TERMINATOR_EXACT;
        return strcmp(value, "exact") == 0 || strcmp(value, "smooth") == 0 ? -1
                                                                           : usage("render", "--terminator %s: not one of exact, smooth", value);
    case DETAILS:
        work->details = strcmp(value, "coplanar") == 0;
        return work->details || strcmp(value, "none") == 0 ? -1 : usage("render", "--details %s: not one of coplanar, none", value);
    case ENGINE:
        work->def.engine = strcmp(value, "weiler-atherton") == 0 ? GNO_ENGINE_WEILER_ATHERTON : GNO_ENGINE_SCANLINE;
        return strcmp(value, "scanline") == 0 || strcmp(value, "weiler-atherton") == 0
                   ? -1
                   : usage("render", "--engine %s: not one of scanline, weiler-atherton", value);
    case AOV:
        return layers_parse(&work->layers, value, "render");
    case RANKS:
        return parse_int(value, 1, GNO_MAX_RANKS, &work->layers.ranks)
                   ? -1
                   : usage("render", "--ranks %s: not a number from 1 to %d", value, GNO_MAX_RANKS);
    case STATS:
        work->stats_path = value;
        return -1;
    case HELP:
        return help();
    default:
        return take_common(&work->scene, "render", options[id].name, value);
    }
}

/* Returns an exit status, or -1 to go on. */
static int read_arguments(job *work, int argc, char **argv)
{
    option_reader reader = option_reader_make("render", options, OPTIONS, argc, argv);
    const int wrong = options_read(&reader, take_option, work, &work->scene.path);
    if (wrong >= 0) {
        return wrong;
    }
    if (work->files.count == 0) {
        const int several = work->frames.all || work->frames.last > work->frames.first;
        work->default_output = output_default(work->scene.path, several ? "_%04d.png" : ".png");
        if (work->default_output == NULL) {
            say("out of memory");
            return EXIT_FAILED;
        }
        work->files.paths[work->files.count++] = work->default_output;
    }
    for (int i = 0; i < work->files.count; i++) {
        if (work->stats_path != NULL && strcmp(work->stats_path, "-") == 0 && strcmp(work->files.paths[i], "-") == 0) {
            return usage("render", "standard output cannot take both the picture and --stats");
        }
    }
    if (work->layers.wanted != 0 && !outputs_has_layers(&work->files)) {
        return usage("render", "--aov: layers need an output in .exr");
    }
    const int ranks = layers_check(&work->layers, "render");
    if (ranks >= 0) {
        return ranks;
    }
    const int status = outputs_check(&work->files, work->depth, "render");
    return status != EXIT_DONE ? status : -1;
}

static gno_status write_picture(const job *work, gno_scene *scene, int i, int frame, const float *rgb, const gno_layers *layers)
{
    gno_context *context = gno_scene_context(scene);
    const gno_image_def image = gno_scene_image(scene);
    gno_picture_def def = gno_picture_def_default();
    char *path = frame < 0 ? NULL : frame_name(work->files.paths[i], frame);
    const char *name = frame < 0 ? work->files.paths[i] : path;
    if (name == NULL) {
        return gno_context_fail(context, GNO_ERROR_MEMORY, "out of memory");
    }
    def.exposure = work->exposure;
    def.depth = work->files.depths[i];
    const int stream = output_begin(work->files.paths[i]);
    const gno_status status = layers != NULL && output_has_layers(name)
                                  ? gno_picture_write_layers(scene, name, &def, rgb, layers)
                                  : gno_picture_write(context, name, &def, image.width, image.height, rgb);
    output_end(stream, status);
    free(path);
    return status;
}

/* size: bytes, 0 when not known. */
static int no_room(gno_context *context, const char *what, const gno_image_def *image, double size)
{
    char text[160], bytes[32] = "";
    if (size > 0.0) {
        snprintf(bytes, sizeof bytes, " (%.1f %s)", size < 1e9 ? size * 1e-6 : size * 1e-9, size < 1e9 ? "MB" : "GB");
    }
    snprintf(text, sizeof text, "out of memory for %s of %d x %d%s", what, image->width, image->height, bytes);
    gno_context_fail(context, GNO_ERROR_MEMORY, text);
    say("%s", gno_context_message(context));
    return EXIT_FAILED;
}

/* frame: its number for the names, or -1. */
static gno_status write_pictures(const job *work, gno_scene *scene, int frame, const float *rgb, const gno_layers *layers)
{
    gno_status status = GNO_OK;
    for (int i = 0; i < work->files.count && status == GNO_OK && interrupt_signal() == 0; i++) {
        status = write_picture(work, scene, i, frame, rgb, layers);
    }
    return status == GNO_OK && interrupt_signal() != 0 ? gno_context_fail(gno_scene_context(scene), GNO_ERROR_CANCELLED, "interrupted") : status;
}

/* One frame; its times and counts go to `stats`. */
static gno_status run_frame(const job *work, gno_scene *scene, const frame_plan *plan, int frame, const gno_render_def *how, float *rgb,
                            frame_stats *stats)
{
    const double begun = seconds_now();
    gno_status status = frames_set_camera(plan, scene, frame);
    if (status == GNO_OK) {
        status = gno_render(scene, how, rgb, &stats->engine);
    }
    const double rendered = seconds_now();
    if (status == GNO_OK) {
        status = write_pictures(work, scene, plan->numbered ? frame : -1, rgb, how->layers);
    }
    stats->frame = frame;
    stats->render_seconds = rendered - begun;
    stats->write_seconds = seconds_now() - rendered;
    return status;
}

static gno_status run_frames(const job *work, session *s, const frame_plan *plan, const gno_render_def *how, float *rgb, run_stats *stats)
{
    gno_status status = GNO_OK;
    interrupt_catch();
    for (int i = 0; i < plan->count && status == GNO_OK; i++) {
        progress_set_frame(&s->shown, i, plan->count);
        status = run_frame(work, s->scene, plan, plan->first + i, how, rgb, &stats->frames[stats->frame_count++]);
    }
    return status;
}

/* Buffers are made once for all frames. Through the context, so that the picture is part of the peak memory told by --stats. */
static int run_scene(const job *work, session *s, const frame_plan *plan)
{
    gno_context *context = s->context;
    const gno_image_def image = gno_scene_image(s->scene);
    const size_t bytes = (size_t)image.width * (size_t)image.height * 3 * sizeof(float);
    run_stats stats = {work->scene.path, image.width, image.height, session_threads(s), plan->numbered, 0, NULL, seconds_now() - s->begun, 0, 0};
    gno_render_def how = work->def;
    layer_buffers buffers;
    const int has_layers = work->layers.wanted != 0;
    float *rgb = gno_context_realloc(context, NULL, 0, bytes);
    stats.frames = calloc((size_t)plan->count, sizeof *stats.frames);
    if (rgb == NULL || stats.frames == NULL) {
        if (rgb != NULL) {
            gno_context_realloc(context, rgb, bytes, 0);
        }
        free(stats.frames);
        return no_room(context, "a picture", &image, (double)bytes);
    }
    int result = EXIT_FAILED;
    if (has_layers && !layers_allocate(&work->layers, s->scene, &buffers)) {
        no_room(context, "the layers of a picture", &image, 0.0);
    } else {
        how.threads = work->scene.threads;
        how.layers = has_layers ? &buffers.layers : NULL;
        result = session_result(s, run_frames(work, s, plan, &how, rgb, &stats));
        if (has_layers) {
            layers_free(&buffers);
        }
    }
    gno_context_realloc(context, rgb, bytes, 0);
    if (result == EXIT_DONE) {
        interrupt_release();
        stats.total_seconds = seconds_now() - s->begun;
        gno_context_memory(context, &stats.peak_memory);
        for (int i = 0; i < work->files.count && s->shown.terminal && !work->scene.quiet; i++) {
            say("%s: %d x %d in %.2f s", work->files.paths[i], image.width, image.height, stats.total_seconds);
        }
        result = work->stats_path != NULL ? stats_write(work->stats_path, &stats) : EXIT_DONE;
    }
    free(stats.frames);
    return result;
}

static int run_job(const job *work)
{
    session s;
    frame_plan plan;
    session_begin(&s, &work->scene);
    int status = session_load(&s);
    if (status < 0 && work->details >= 0) {
        const gno_status found = gno_scene_find_details(s.scene, work->details);
        status = found == GNO_OK ? -1 : session_result(&s, found);
    }
    if (status < 0) {
        progress_clear(&s.shown);
        status = frames_plan(&work->frames, work->scene.path, s.scene, work->files.paths, work->files.count, &plan);
    }
    if (status < 0) {
        status = run_scene(work, &s, &plan);
    }
    session_end(&s);
    return status;
}

static int run(int argc, char **argv)
{
    job work;
    int status = EXIT_FAILED;
    memset(&work, 0, sizeof work);
    work.exposure = 1.0;
    work.details = -1;
    work.def = gno_render_def_default();
    work.layers = layers_none();
    if (scene_wish_make(&work.scene, argc)) {
        status = read_arguments(&work, argc, argv);
        status = status < 0 ? run_job(&work) : status;
    }
    scene_wish_free(&work.scene);
    free(work.default_output);
    return status;
}

const command command_render = {"render", "draw a scene: PNG, OpenEXR, PFM", run};
