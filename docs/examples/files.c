/* files.c -- SCENE in, PICTURE out, by the file library: a small `gnomon render`. */
#include <gnomon/gnomon_io.h>
#include <stdio.h>
#include <stdlib.h>

static void show(void *user, gno_log_level level, const char *text)
{
    (void)user;
    fprintf(stderr, "%s%s\n", level == GNO_LOG_WARNING ? "warning: " : "", text);
}

static gno_status draw(gno_context *context, const char *from, const char *to)
{
    static const gno_setting small[1] = {{"image", "{width: 320, height: 180}"}};
    gno_scene *scene = NULL;
    float *rgb = NULL;
    gno_status status = gno_scene_load(context, from, small, 1, &scene);
    if (!status) {
        gno_image_def image = gno_scene_image(scene);
        rgb = (float *)malloc(3 * sizeof *rgb * (size_t)image.width * (size_t)image.height);
        status = rgb ? gno_render(scene, NULL, rgb, NULL) : gno_context_fail(context, GNO_ERROR_MEMORY, "no room for the picture");
        if (!status) status = gno_picture_write(context, to, NULL, image.width, image.height, rgb);
    }
    free(rgb);
    gno_scene_destroy(scene);
    return status;
}

int main(int argc, char **argv)
{
    gno_context_def def = gno_context_def_default();
    gno_context *context = NULL;
    gno_status status;
    if (argc != 3) {
        fprintf(stderr, "usage: files SCENE PICTURE\n");
        return 2;
    }
    def.log = show;
    status = gno_context_create(&def, &context);
    if (!status) status = draw(context, argv[1], argv[2]);
    if (status) fprintf(stderr, "%s\n", gno_context_message(context));
    gno_context_destroy(context);
    return status != GNO_OK;
}
