/* scanline.c -- the scan-line engine: gno_render calls the passes in order.
 *
 * prepare (scene) -> shadow matrix by light (shadow) -> projection and bins (scan) -> tiles (engine/tile.h) -> picture.
 */
#include "base/parallel.h"
#include "engine/bands.h"
#include "engine/job.h"
#include "scene/validate.h"
#include "shadow/lamp.h"
#include <string.h>

gno_render_def gno_render_def_default(void)
{
    gno_render_def def;
    def.lines = 18;
    def.base_lines = 2;
    def.refine_above = 0.025;
    def.threads = 0;
    def.terminator = GNO_TERMINATOR_EXACT;
    def.layers = NULL;
    def.engine = GNO_ENGINE_SCANLINE;
    return def;
}

gno_layers gno_layers_default(void)
{
    gno_layers layers;
    memset(&layers, 0, sizeof layers);
    return layers;
}

static gno_status check_ranks(gno_context *context, const char *name, const gno_ranks *ranks)
{
    if (!ranks->id && !ranks->coverage)
        return GNO_OK;
    if (!ranks->id || !ranks->coverage)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "layers.%s: id and coverage must both be given", name);
    if (ranks->count < 1 || ranks->count > GNO_MAX_RANKS)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "layers.%s.count: %d is not between 1 and %d", name, ranks->count, GNO_MAX_RANKS);
    return GNO_OK;
}

static gno_status check_layers(gno_context *context, const gno_layers *layers)
{
    gno_status status = check_ranks(context, "polygons", &layers->polygons);
    if (!status)
        status = check_ranks(context, "objects", &layers->objects);
    return status ? status : check_ranks(context, "materials", &layers->materials);
}

static gno_status check_def(gno_context *context, const gno_render_def *def)
{
    if (def->lines < 1 || def->lines > GNO_MAX_LINES)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "lines: %d is not between 1 and %d", def->lines, GNO_MAX_LINES);
    if (def->base_lines < 1 || def->lines % def->base_lines != 0 || def->lines / def->base_lines % 2 == 0)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "lines: %d is not an odd multiple of %d base lines", def->lines,
                         def->base_lines);
    if (def->lines > def->base_lines && def->base_lines > GNOI_BASE_LINES)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "lines: at most %d base lines can be refined, not %d", GNOI_BASE_LINES,
                         def->base_lines);
    if (!(def->refine_above >= 0))
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "refine_above: %g is negative", def->refine_above);
    if (def->engine != GNO_ENGINE_SCANLINE && def->engine != GNO_ENGINE_WEILER_ATHERTON)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "engine: %d is none", (int)def->engine);
    if (def->threads < 0 || def->threads > GNO_MAX_THREADS)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "threads: %d is not between 0 and %d", def->threads, GNO_MAX_THREADS);
    if (def->layers && def->engine != GNO_ENGINE_SCANLINE)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "layers: only the scan-line engine makes them");
    return def->layers ? check_layers(context, def->layers) : GNO_OK;
}

/* Enough that no edge shows the difference to exact coverage. */
#define LINES_FOR_PIECES 16

typedef struct tile_job {
    gnoi_frame_job *frame;
    const gnoi_bands *bands;
    gnoi_tile **workers; /* made when a thread takes its first tile */
} tile_job;

static gno_status render_tile(void *user, int worker, size_t piece)
{
    tile_job *job = user;
    gno_context *context = job->frame->scene->context;
    if (!job->workers[worker]) {
        job->workers[worker] = gnoi_calloc(context, 1, sizeof **job->workers);
        if (!job->workers[worker] || !gnoi_tile_init(job->workers[worker], job->frame))
            return GNO_ERROR_MEMORY;
    }
    return job->bands->make(job->bands->user, job->workers[worker], piece) ? GNO_OK : GNO_ERROR_MEMORY;
}

static void add_stats(gno_stats *stats, const gnoi_tile *tile)
{
    stats->spans += tile->spans;
    stats->shaded += tile->shaded;
    stats->refined_pixels += tile->refined;
    stats->columns += tile->store.asked;
    stats->ones += tile->store.ones;
    stats->columns_full += tile->store.full;
}

/* Band after band, each handed out before the next is begun. */
static gno_status render_bands(tile_job *job, int threads)
{
    gnoi_frame_job *frame = job->frame;
    const gnoi_bands *bands = job->bands;
    size_t across = (size_t)frame->bins.tiles_x;
    int rows = bands->hand_out ? gnoi_band_rows(frame->bins.tiles_x, threads) : frame->bins.tiles_y;
    gno_status status = GNO_OK;
    for (int y = 0; y < frame->bins.tiles_y && !status; y += rows) {
        int count = frame->bins.tiles_y - y < rows ? frame->bins.tiles_y - y : rows;
        frame->first_row = bands->hand_out ? y * GNOI_TILE_H : 0;
        status = gnoi_parallel_part(frame->scene->context, threads, (size_t)y * across, (size_t)count * across,
                                    across * (size_t)frame->bins.tiles_y, "render", render_tile, job);
        if (!status && bands->hand_out)
            status = bands->hand_out(bands->user, frame, y, count);
    }
    return status;
}

static gno_status render_tiles(gnoi_frame_job *frame, int threads, const gnoi_bands *bands, gno_stats *stats)
{
    gno_context *context = frame->scene->context;
    gno_status status;
    tile_job job;
    job.frame = frame;
    job.bands = bands;
    job.workers = gnoi_calloc(context, (size_t)threads, sizeof *job.workers);
    if (!job.workers)
        return GNO_ERROR_MEMORY;
    status = render_bands(&job, threads);
    for (int i = 0; i < threads; i++)
        if (job.workers[i]) {
            add_stats(stats, job.workers[i]);
            gnoi_tile_free(job.workers[i]);
            gnoi_free(context, job.workers[i], 1, sizeof **job.workers);
        }
    gnoi_free(context, job.workers, (size_t)threads, sizeof *job.workers);
    return status;
}

/* Whether two pictures lie on a surface alike. */
static int is_one_place(const gno_texture *a, const gno_texture *b)
{
    return a->kind == GNO_TEXTURE_IMAGE && b->kind == GNO_TEXTURE_IMAGE && a->map == b->map &&
           memcmp(a->origin, b->origin, sizeof a->origin) == 0 && memcmp(a->u, b->u, sizeof a->u) == 0 &&
           memcmp(a->v, b->v, sizeof a->v) == 0 && memcmp(a->corners, b->corners, sizeof a->corners) == 0 &&
           memcmp(a->scale, b->scale, sizeof a->scale) == 0;
}

/* The mean of a material's picture. */
static void set_mean(const gno_scene *scene, const gno_material *m, gnoi_tone *tone)
{
    const gnoi_image *image = &scene->images[m->texture.image];
    float value[4];
    gnoi_image_value(image, image->level_count - 1, 0, 0, value);
    for (int k = 0; k < 3; k++)
        tone->mean[k] = value[3] > 0 ? value[k] / value[3] : 0;
}

static float largest(const float rgb[3])
{
    float most = rgb[0] > rgb[1] ? rgb[0] : rgb[1];
    return most > rgb[2] ? most : rgb[2];
}

/* The share of a highlight below which its bending is not seen. */
#define LEAST_HIGHLIGHT 0.02

/* The scene's materials in single precision; NULL when memory fails. */
static gnoi_tone *make_tones(const gno_scene *scene)
{
    gnoi_tone *tones = gnoi_malloc(scene->context, scene->material_count, sizeof *tones);
    for (size_t i = 0; tones && i < scene->material_count; i++) {
        const gno_material *m = &scene->materials[i];
        for (int k = 0; k < 3; k++) {
            tones[i].ambient[k] = (float)(scene->ambient[k] * m->ambient[k]);
            tones[i].diffuse[k] = (float)m->diffuse[k];
            tones[i].specular[k] = (float)m->specular[k];
        }
        tones[i].shininess = (float)m->shininess;
        tones[i].glint = 2 * tones[i].shininess * largest(tones[i].specular);
        tones[i].glint_edge = m->shininess > 0 ? (float)pow(LEAST_HIGHLIGHT, 1 / m->shininess) : 0;
        tones[i].textured = m->texture.kind != GNO_TEXTURE_NONE;
        tones[i].has_holes = gnoi_has_holes(scene, m);
        tones[i].bumped = m->bump.kind != GNO_BUMP_NONE;
        tones[i].one_place = is_one_place(&m->texture, &m->bump.texture);
        tones[i].mean[0] = tones[i].mean[1] = tones[i].mean[2] = -1;
        if (m->texture.kind == GNO_TEXTURE_IMAGE)
            set_mean(scene, m, &tones[i]);
    }
    return tones;
}

/* The light that each lamp is of; NULL when memory fails. */
static uint32_t *map_lamps(const gno_scene *scene, size_t lamp_count)
{
    uint32_t *light = gnoi_malloc(scene->context, lamp_count, sizeof *light);
    size_t n = 0;
    for (size_t i = 0; light && i < scene->light_count; i++)
        for (size_t k = gnoi_light_points(&scene->lights[i].light); k > 0; k--)
            light[n++] = (uint32_t)i;
    return light;
}

/* Whether light may arrive in more ways than all or nothing. */
static int is_tinted(const gno_scene *scene)
{
    int tinted = 0;
    for (size_t i = 0; i < scene->material_count; i++) {
        const double *t = scene->materials[i].transmission;
        tinted |= t[0] > 0 || t[1] > 0 || t[2] > 0 || gnoi_has_holes(scene, &scene->materials[i]);
    }
    for (size_t i = 0; i < scene->light_count; i++)
        tinted |= scene->lights[i].light.softness > 0;
    return tinted;
}

/* Seconds since *from, which becomes now. */
static double lap(double *from)
{
    double now = gnoi_now(), seconds = now - *from;
    *from = now;
    return seconds;
}

gno_status gnoi_frame_job_make(gno_scene *scene, const gno_render_def *def, gnoi_frame_job *frame, gno_stats *stats)
{
    gno_status status;
    int threads = gnoi_thread_count(def->threads);
    double t = gnoi_now();
    memset(frame, 0, sizeof *frame);
    frame->scene = scene;
    frame->def = *def;
    frame->layers = def->layers;
    status = gnoi_scene_prepare(scene, threads);
    stats->prepare_seconds = lap(&t);
    if (status)
        return status;
    frame->view = gnoi_view_make(&scene->camera, &scene->image, scene->prepared.scale);
    status = gnoi_shadow_cache_build(scene, &frame->view, threads);
    stats->shadow_seconds = lap(&t);
    if (status)
        return status;
    frame->lamps = scene->shadows->lamps;
    frame->casters = scene->shadows->casters;
    frame->lamp_count = (int)scene->shadows->lamp_count;
    frame->tinted = is_tinted(scene);
    frame->tones = make_tones(scene);
    for (size_t i = 0; frame->tones && i < scene->material_count; i++)
        frame->textured |= frame->tones[i].textured;
    frame->lamp_light = frame->layers ? map_lamps(scene, (size_t)frame->lamp_count) : NULL;
    if (!frame->tones || (frame->layers && !frame->lamp_light))
        return GNO_ERROR_MEMORY;
    status = gnoi_bins_build(scene, &frame->view, def->lines, threads, &frame->bins);
    stats->project_seconds = lap(&t);
    return status;
}

void gnoi_frame_job_free(gnoi_frame_job *frame)
{
    gno_context *context = frame->scene->context;
    gnoi_free(context, frame->tones, frame->scene->material_count, sizeof *frame->tones);
    gnoi_free(context, frame->lamp_light, (size_t)frame->lamp_count, sizeof *frame->lamp_light);
    gnoi_bins_free(context, &frame->bins);
}

static gno_status render(gno_scene *scene, const gno_render_def *def, const gnoi_bands *bands, gno_stats *stats)
{
    gnoi_frame_job frame;
    double start = gnoi_now(), t;
    unsigned long builds = scene->shadow_builds;
    gno_status status = gnoi_frame_job_make(scene, def, &frame, stats);
    frame.rgb = bands->rgb;
    t = gnoi_now();
    if (!status && def->engine == GNO_ENGINE_WEILER_ATHERTON)
        status = gnoi_paint_visible(scene, &frame, stats);
    else if (!status)
        status = render_tiles(&frame, gnoi_thread_count(def->threads), bands, stats);
    stats->scan_seconds = lap(&t);
    stats->total_seconds = t - start;
    stats->polygons = (double)scene->prepared.poly_count;
    stats->lights = frame.lamp_count;
    stats->shadows_built = scene->shadow_builds == builds ? 0 : frame.lamp_count;
    stats->tiles = (double)frame.bins.tiles_x * frame.bins.tiles_y;
    gnoi_frame_job_free(&frame);
    gno_context_memory(scene->context, &stats->peak_memory);
    return status;
}

gno_status gnoi_render(gno_scene *scene, const gno_render_def *def, const gnoi_bands *bands, gno_stats *stats)
{
    gno_render_def defaults = gno_render_def_default();
    gno_stats unused;
    gno_status status;
    def = def ? def : &defaults;
    stats = stats ? stats : &unused;
    memset(stats, 0, sizeof *stats);
    gnoi_begin(scene->context, "render");
    status = check_def(scene->context, def);
    if (status)
        return status;
    status = render(scene, def, bands, stats);
    if (status == GNO_ERROR_MEMORY)
        return gnoi_fail(scene->context, status, "out of memory for the picture");
    return status;
}

static int make_pixels(void *user, gnoi_tile *tile, size_t index)
{
    (void)user;
    return gnoi_tile_render(tile, index);
}

/* Sample lines, all of them everywhere, in the place of pieces that cannot bound the scene's shadows. */
static gno_render_def lines_for_pieces(gno_context *context, gno_render_def def)
{
    gnoi_warn(context, "shadows that weaken with distance, or of textures with holes, have no edges: the picture is made by %d sample lines",
              LINES_FOR_PIECES);
    def.engine = GNO_ENGINE_SCANLINE;
    def.lines = def.base_lines = LINES_FOR_PIECES;
    return def;
}

gno_status gno_render(gno_scene *scene, const gno_render_def *def, float *rgb, gno_stats *stats)
{
    gno_render_def used;
    gnoi_bands whole;
    if (!scene)
        return GNO_ERROR_ARGUMENT;
    if (!rgb)
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_render: no picture buffer");
    memset(&whole, 0, sizeof whole);
    whole.make = make_pixels;
    whole.rgb = rgb;
    if (def && def->engine == GNO_ENGINE_WEILER_ATHERTON && !gnoi_shadows_have_edges(scene)) {
        used = lines_for_pieces(scene->context, *def);
        def = &used;
    }
    return gnoi_render(scene, def, &whole, stats);
}
