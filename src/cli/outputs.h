/* outputs.h -- the picture files of one run, checked before the work starts.
 *
 * Place: under render.c. Rendering can take long; a misspelt extension or folder must show up before it, not after.
 */
#ifndef GNOMON_CLI_OUTPUTS_H
#define GNOMON_CLI_OUTPUTS_H

#include "cli/cli.h"

enum { MOST_OUTPUTS = 16 };

typedef struct outputs {
    int count;
    const char *paths[MOST_OUTPUTS];
    gno_pixel_depth depths[MOST_OUTPUTS]; /* the wished depth where the format has it, its default elsewhere */
} outputs;

/* Checks names and depth (0: none wished); returns an exit status, its message being out. */
int outputs_check(outputs *files, int depth, const char *command_name);

/* Whether a file can come to be under this name; says so when not. Returns an exit status. */
int output_check_place(const char *path);

/* Whether a path's extension, ".csv", is in a list that ends with NULL, in any case. Returns its place in the list, or -1. */
int output_extension(const char *path, const char *const *extensions);

/* The scene's name with another extension, without its folder: folder/town.yaml -> town.png. To be freed; NULL when memory fails. */
char *output_default(const char *scene_path, const char *extension);

/* Standard output, a pipe or a device: takes the bytes as they come and leaves nothing half done in a folder. */
int output_is_stream(const char *path);

/* Whether a file, or any of them, can hold layers beside the picture. */
int output_has_layers(const char *path);
int outputs_has_layers(const outputs *files);

#endif
