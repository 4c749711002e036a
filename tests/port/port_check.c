/* port_check.c -- the engine, and the file writers that need no other library, on another kind of machine.
 *
 * usage: port_check write FILE.pfm    draws a picture, streams its spans, prints numbers that must be the same everywhere, writes it
 *        port_check read FILE.pfm     prints the picture's number again, from the file, which may come from another machine
 */
#include "io/cryptomatte.h"
#include "io/picture.h"
#include "support/compare.h"
#include "support/random_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 160
#define HEIGHT 120

/* The formats that need libraries are not part of this. */
gno_status gnoi_picture_png(const gnoi_picture *picture, gnoi_file *file)
{
    (void)picture;
    return gno_context_fail(file->context, GNO_ERROR_FILE, "no PNG here");
}

gno_status gnoi_picture_exr(const gnoi_picture *picture, gnoi_file *file)
{
    (void)picture;
    return gno_context_fail(file->context, GNO_ERROR_FILE, "no EXR here");
}

/* By values, not by bytes. */
static unsigned long hash_floats(unsigned long hash, const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        hash = ((hash ^ bits) * 16777619u + (hash >> 15)) & 0xffffffffu;
    }
    return hash;
}

static int take_line(void *user, const gno_span_line *line)
{
    double *sums = user;
    for (size_t i = 0; i < line->span_count; i++) {
        sums[0] += line->spans[i].x1 - line->spans[i].x0;
        sums[1] += line->spans[i].depth0;
    }
    return 0;
}

static int draw(gno_context *context, scene_kind kind, const char *path)
{
    static float rgb[3 * WIDTH * HEIGHT];
    double sums[2] = {0, 0};
    gno_scene *scene = random_scene(context, kind, 11, WIDTH, HEIGHT);
    int good = scene && gno_render(scene, NULL, rgb, NULL) == GNO_OK && gno_render_spans(scene, NULL, take_line, sums, NULL) == GNO_OK &&
               gno_picture_write(context, path, NULL, WIDTH, HEIGHT, rgb) == GNO_OK;
    printf("%s: picture %08lx, spans %.17g %.17g\n", scene_kind_name(kind), hash_floats(2166136261u, rgb, 3 * WIDTH * HEIGHT), sums[0], sums[1]);
    gno_scene_destroy(scene);
    return good;
}

static int write_all(const char *path)
{
    gno_context *context = NULL;
    int good = gno_context_create(NULL, &context) == GNO_OK;
    for (int kind = 0; kind < SCENE_KINDS && good; kind++)
        good = draw(context, (scene_kind)kind, path);
    printf("ids %08lx %08lx\n", (unsigned long)gnoi_crypto_id("bunny"), (unsigned long)gnoi_crypto_id("default"));
    if (!good)
        printf("failed: %s\n", gno_context_message(context));
    gno_context_destroy(context);
    return good;
}

static int read_back(const char *path)
{
    int width, height;
    float *rgb = picture_read_pfm(path, &width, &height);
    if (rgb)
        printf("picture %08lx\n", hash_floats(2166136261u, rgb, 3 * (size_t)width * (size_t)height));
    free(rgb);
    return rgb != NULL;
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return 2;
    return strcmp(argv[1], "read") == 0 ? !read_back(argv[2]) : !write_all(argv[2]);
}
