/* cache.c -- see cache.h. */
#include "shadow/cache.h"
#include "base/parallel.h"
#include "shadow/lamp.h"

/* Lamps up to which the vertices' places are kept for each. */
#define FEW_LAMPS 4

/* Entries of `halved` beyond which it is not worth its memory. */
#define MOST_HALVED ((size_t)1 << 26)

static void free_cache(gno_context *context, gnoi_shadow_cache *cache)
{
    for (size_t i = 0; cache->casters && i < cache->lamp_count; i++)
        gnoi_casters_free(context, &cache->casters[i]);
    gnoi_free(context, cache->halved, cache->lamp_count * cache->solid_count, 1);
    gnoi_free(context, cache->casters, cache->lamp_count, sizeof *cache->casters);
    gnoi_free(context, cache->lamps, cache->lamp_count, sizeof *cache->lamps);
    gnoi_free(context, cache, 1, sizeof *cache);
}

typedef struct job {
    const gno_scene *scene;
    gnoi_shadow_cache *cache;
} job;

static gno_status build_casters(void *user, int worker, size_t piece)
{
    job *j = user;
    (void)worker;
    return gnoi_casters_build(j->scene, &j->cache->lamps[piece],
                              j->cache->solid_count ? j->cache->halved + piece * j->cache->solid_count : NULL,
                              j->cache->lamp_count <= FEW_LAMPS, &j->cache->casters[piece]);
}

/* Whether all that is in sight is seen from outside the solid: an orthographic view begins at a plane, which must not cut it. */
static int eye_outside(const gno_scene *scene, size_t solid, const gnoi_view *view)
{
    const gnoi_solid *s = &scene->prepared.solids[solid];
    if (!view->orthographic)
        return gnoi_solid_outside(scene, solid, view->eye);
    for (int i = 0; i < 8; i++) {
        vec3 p = v3(i & 1 ? s->upper[0] : s->lower[0], i & 2 ? s->upper[1] : s->lower[1], i & 4 ? s->upper[2] : s->lower[2]);
        if (!(gnoi_form_at(&view->depth, p) > view->near_depth))
            return 0;
    }
    return s->cap == GNOI_NONE || v3_dot(v3_from(scene->prepared.polys[s->cap].n), view->forward) > 0;
}

/* Finds which closed solids have lamp and eye outside. */
static void set_halved(const gno_scene *scene, const gnoi_view *view, gnoi_shadow_cache *cache)
{
    for (size_t k = 0; k < cache->solid_count; k++) {
        if (!scene->prepared.solids[k].closed || !eye_outside(scene, k, view))
            continue;
        for (size_t i = 0; i < cache->lamp_count; i++) {
            /* where shadows weaken with distance each of the two sides of a solid counts for itself */
            if (!(cache->lamps[i].softness > 0))
                cache->halved[i * cache->solid_count + k] = (unsigned char)gnoi_lamp_outside(scene, k, &cache->lamps[i]);
        }
    }
}

static int still_serves(const gno_scene *scene, const gnoi_view *view)
{
    const gnoi_shadow_cache *cache = scene->shadows;
    for (size_t k = 0; k < cache->solid_count; k++) {
        int used = 0;
        for (size_t i = 0; i < cache->lamp_count; i++)
            used |= cache->halved[i * cache->solid_count + k];
        if (used && !eye_outside(scene, k, view))
            return 0;
    }
    return 1;
}

gno_status gnoi_shadow_cache_build(gno_scene *scene, const gnoi_view *view, int threads)
{
    gno_context *context = scene->context;
    gnoi_shadow_cache *cache;
    gno_status status = GNO_ERROR_MEMORY;
    size_t n = 0;
    job j;
    if (scene->shadows && still_serves(scene, view))
        return GNO_OK;
    if (scene->shadows) {
        free_cache(context, scene->shadows);
        scene->shadows = NULL;
    }
    cache = gnoi_calloc(context, 1, sizeof *cache);
    if (!cache)
        return gnoi_fail(context, GNO_ERROR_MEMORY, "out of memory for the lights");
    cache->lamp_count = gnoi_lamps_count(scene);
    if (cache->lamp_count > GNO_MAX_LIGHTS) {
        n = cache->lamp_count;
        cache->lamp_count = 0;
        free_cache(context, cache);
        return gnoi_fail(context, GNO_ERROR_LIMIT, "%lu points of light in all; the limit is %d", (unsigned long)n, GNO_MAX_LIGHTS);
    }
    cache->lamps = gnoi_calloc(context, cache->lamp_count, sizeof *cache->lamps);
    cache->casters = gnoi_calloc(context, cache->lamp_count, sizeof *cache->casters);
    cache->solid_count = cache->lamp_count * scene->prepared.solid_count <= MOST_HALVED ? scene->prepared.solid_count : 0;
    cache->halved = gnoi_calloc(context, cache->lamp_count * cache->solid_count, 1);
    if (cache->lamps && cache->casters && cache->halved) {
        gnoi_lamps_fill(scene, cache->lamps);
        set_halved(scene, view, cache);
        j.scene = scene;
        j.cache = cache;
        status = gnoi_parallel(context, threads, cache->lamp_count, "shadow matrix", build_casters, &j);
    }
    if (status) {
        free_cache(context, cache);
        return status == GNO_ERROR_MEMORY ? gnoi_fail(context, status, "out of memory for the shadow matrix") : status;
    }
    scene->shadows = cache;
    scene->shadow_builds++;
    scene->free_shadows = free_cache;
    return GNO_OK;
}
