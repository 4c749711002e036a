/* layers.c -- see layers.h. */
#include "cli/layers.h"

#include "cli/options.h"

#include <stdint.h>
#include <string.h>

enum layer { DEPTH, NORMAL, UV, COVERAGE, SHADOW, POLYGON, OBJECT, MATERIAL, LAYERS };

static const char *const names[LAYERS] = {"depth", "normal", "uv", "coverage", "shadow", "polygon", "object", "material"};

/* Cryptomatte's suggestion. */
enum { DEFAULT_RANKS = 6 };

layers_wish layers_none(void)
{
    const layers_wish none = {0, 0};
    return none;
}

static int is_name(const char *name, const char *text, size_t length)
{
    return strlen(name) == length && strncmp(name, text, length) == 0;
}

int layers_parse(layers_wish *wish, const char *list, const char *command_name)
{
    for (const char *at = list;; at++) {
        const size_t length = strcspn(at, ",");
        unsigned bit = 0;
        for (int i = 0; i < LAYERS; i++) {
            bit |= is_name(names[i], at, length) ? 1u << i : 0;
        }
        if (bit == 0) {
            return usage(command_name, "--aov: \"%.*s\" is not one of " LAYER_NAMES, (int)(length < 40 ? length : 40), at);
        }
        wish->wanted |= bit;
        at += length;
        if (*at == '\0') {
            return -1;
        }
    }
}

int layers_check(const layers_wish *wish, const char *command_name)
{
    const unsigned ranked = 1u << POLYGON | 1u << OBJECT | 1u << MATERIAL;
    return wish->ranks == 0 || (wish->wanted & ranked) != 0 ? -1 : usage(command_name, "--ranks: goes with --aov polygon, object or material");
}

static void *take(layer_buffers *b, const layers_wish *wish, int layer, size_t values, size_t each)
{
    const size_t size = values <= SIZE_MAX / 4 / each ? values * each * 4 : 0;
    void *block;
    if ((wish->wanted & 1u << layer) == 0 || b->count < 0) {
        return NULL;
    }
    block = size > 0 ? gno_context_realloc(b->context, NULL, 0, size) : NULL;
    if (block == NULL) {
        layers_free(b);
        b->count = -1;
        return NULL;
    }
    b->sizes[b->count] = size;
    b->blocks[b->count++] = block;
    return block;
}

static void take_ranks(layer_buffers *b, const layers_wish *wish, int layer, size_t pixels, gno_ranks *ranks)
{
    const int count = wish->ranks > 0 ? wish->ranks : DEFAULT_RANKS;
    ranks->count = count;
    ranks->id = take(b, wish, layer, pixels, (size_t)count);
    ranks->coverage = take(b, wish, layer, pixels, (size_t)count);
}

int layers_allocate(const layers_wish *wish, const gno_scene *scene, layer_buffers *buffers)
{
    const gno_image_def image = gno_scene_image(scene);
    const size_t pixels = (size_t)image.width * (size_t)image.height, lights = gno_scene_count(scene).lights;
    gno_layers *l = &buffers->layers;
    memset(buffers, 0, sizeof *buffers);
    buffers->context = gno_scene_context(scene);
    *l = gno_layers_default();
    l->depth = take(buffers, wish, DEPTH, pixels, 1);
    l->normal = take(buffers, wish, NORMAL, pixels, 3);
    l->uv = take(buffers, wish, UV, pixels, 2);
    l->coverage = take(buffers, wish, COVERAGE, pixels, 1);
    l->shadow = lights > 0 ? take(buffers, wish, SHADOW, pixels, lights) : NULL;
    take_ranks(buffers, wish, POLYGON, pixels, &l->polygons);
    take_ranks(buffers, wish, OBJECT, pixels, &l->objects);
    take_ranks(buffers, wish, MATERIAL, pixels, &l->materials);
    return buffers->count >= 0;
}

void layers_free(layer_buffers *buffers)
{
    for (int i = 0; i < buffers->count; i++) {
        gno_context_realloc(buffers->context, buffers->blocks[i], buffers->sizes[i], 0);
    }
    buffers->count = 0;
}
