/* layers.h -- which layers beside the picture a run asks for, and their buffers.
 *
 * Place: under render.c: --aov LIST -> layers_wish -> gno_layers for gno_render and gno_picture_write_layers.
 */
#ifndef GNOMON_CLI_LAYERS_H
#define GNOMON_CLI_LAYERS_H

#include "cli/cli.h"

#define LAYER_NAMES "depth, normal, uv, coverage, shadow, polygon, object, material"

typedef struct layers_wish {
    unsigned wanted; /* a bit for each name; 0: none */
    int ranks;       /* pairs in each pixel of the layers that have them; 0: Cryptomatte's suggestion */
} layers_wish;

enum { LAYER_BUFFERS = 11 };

typedef struct layer_buffers {
    gno_context *context;
    gno_layers layers;
    void *blocks[LAYER_BUFFERS];
    size_t sizes[LAYER_BUFFERS];
    int count;
} layer_buffers;

layers_wish layers_none(void);

/* Adds the names of a list with commas to the wish; returns -1, or an exit status when one is wrong, its message being out. */
int layers_parse(layers_wish *wish, const char *list, const char *command_name);

/* -1, or an exit status when ranks are asked for and no layer that has them, the message being out. */
int layers_check(const layers_wish *wish, const char *command_name);

/* Buffers from the scene's context for the scene's picture size; 0 and nothing held when memory fails. */
int layers_allocate(const layers_wish *wish, const gno_scene *scene, layer_buffers *buffers);
void layers_free(layer_buffers *buffers);

#endif
