/* outputs.c -- see outputs.h. */
#include "cli/outputs.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct kind {
    int depths[2];
    int layers;
} kind;

static const char *const extensions_of_kinds[] = {".png", ".exr", ".pfm", NULL};
static const kind kinds[] = {{{8, 16}, 0}, {{16, 32}, 1}, {{32, 32}, 0}};

int output_extension(const char *path, const char *const *extensions)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash != NULL ? slash : path, '.');
    for (int i = 0; dot != NULL && extensions[i] != NULL; i++) {
        if (strcasecmp(dot, extensions[i]) == 0) {
            return i;
        }
    }
    return -1;
}

static const kind *kind_of(const char *path)
{
    const int found = strcmp(path, "-") == 0 ? 0 : output_extension(path, extensions_of_kinds);
    return found >= 0 ? &kinds[found] : NULL;
}

int output_is_stream(const char *path)
{
    struct stat found;
    return strcmp(path, "-") == 0 || (stat(path, &found) == 0 && !S_ISREG(found.st_mode));
}

int output_check_place(const char *path)
{
    struct stat found;
    const char *slash = strrchr(path, '/');
    if (strcmp(path, "-") == 0) {
        return EXIT_DONE;
    }
    if (stat(path, &found) == 0 && (S_ISDIR(found.st_mode) || access(path, W_OK) != 0)) {
        say("%s: cannot be written: %s", path, strerror(S_ISDIR(found.st_mode) ? EISDIR : errno));
        return EXIT_FAILED;
    }
    if (slash == NULL) {
        return EXIT_DONE;
    }
    const size_t length = slash == path ? 1 : (size_t)(slash - path);
    char *folder = malloc(length + 1);
    if (folder == NULL) {
        return EXIT_DONE;
    }
    memcpy(folder, path, length);
    folder[length] = '\0';
    const int missing = stat(folder, &found) != 0;
    if (missing) {
        say("%s: cannot be written: folder %s: %s", path, folder, strerror(errno));
    }
    free(folder);
    return missing ? EXIT_FAILED : EXIT_DONE;
}

char *output_default(const char *scene_path, const char *extension)
{
    const char *slash = strrchr(scene_path, '/');
    const char *name = slash != NULL ? slash + 1 : scene_path;
    const char *dot = strrchr(name, '.');
    const size_t length = dot != NULL && dot > name ? (size_t)(dot - name) : strlen(name), end = strlen(extension) + 1;
    char *path = malloc(length + end);
    if (path != NULL) {
        memcpy(path, name, length);
        memcpy(path + length, extension, end);
    }
    return path;
}

int outputs_check(outputs *files, int depth, const char *command_name)
{
    int standard = 0, deep = 0;
    for (int i = 0; i < files->count; i++) {
        const kind *format = kind_of(files->paths[i]);
        if (format == NULL) {
            return usage(command_name, "%s: the extension is not one of .png, .exr, .pfm", files->paths[i]);
        }
        const int has = depth == format->depths[0] || depth == format->depths[1];
        files->depths[i] = has ? (gno_pixel_depth)depth : GNO_DEPTH_DEFAULT;
        deep += has;
        standard += strcmp(files->paths[i], "-") == 0;
    }
    if (standard > 1) {
        return usage(command_name, "standard output can take one picture only");
    }
    if (depth != 0 && deep == 0) {
        return usage(command_name, "--depth %d: PNG has 8 or 16 bits, EXR 16 or 32, PFM 32", depth);
    }
    for (int i = 0; i < files->count; i++) {
        if (strcmp(files->paths[i], "-") == 0 && isatty(STDOUT_FILENO)) {
            say("standard output is a terminal: send the picture to a file or a pipe");
            return EXIT_FAILED;
        }
        const int status = output_check_place(files->paths[i]);
        if (status != EXIT_DONE) {
            return status;
        }
    }
    return EXIT_DONE;
}

int output_has_layers(const char *path)
{
    const kind *format = kind_of(path);
    return format != NULL && format->layers;
}

int outputs_has_layers(const outputs *files)
{
    for (int i = 0; i < files->count; i++) {
        if (output_has_layers(files->paths[i])) {
            return 1;
        }
    }
    return 0;
}
