/* session.c -- see session.h. */
#include "cli/session.h"

#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/outputs.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- arguments -------------------------------------------------------------------------------------------------------------- */

int scene_wish_make(scene_wish *wish, int argc)
{
    memset(wish, 0, sizeof *wish);
    wish->settings = calloc((size_t)argc + 1, sizeof *wish->settings); /* one more so that the size is never zero */
    if (wish->settings == NULL) {
        say("out of memory");
    }
    return wish->settings != NULL;
}

void scene_wish_free(scene_wish *wish)
{
    free(wish->settings);
}

int take_common(scene_wish *wish, const char *command_name, const char *option_name, char *value)
{
    if (strcmp(option_name, "size") == 0) {
        return parse_size(value, &wish->width, &wish->height)
                   ? -1
                   : usage(command_name, "--size %s: not WIDTHxHEIGHT, each from 1 to %d", value, GNO_MAX_IMAGE_SIDE);
    }
    if (strcmp(option_name, "threads") == 0) {
        return parse_int(value, 0, GNO_MAX_THREADS, &wish->threads)
                   ? -1
                   : usage(command_name, "--threads %s: not a number from 0 to %d", value, GNO_MAX_THREADS);
    }
    if (strcmp(option_name, "memory") == 0) {
        return parse_bytes(value, &wish->memory) ? -1 : usage(command_name, "--memory %s: not a number of bytes, as 512M or 2G", value);
    }
    if (strcmp(option_name, "set") == 0) {
        return parse_setting(value, &wish->settings[wish->setting_count++]) ? -1 : usage(command_name, "--set %s: not KEY=VALUE", value);
    }
    wish->quiet = 1; /* --quiet, the last of them */
    return -1;
}

/* ---- the session --------------------------------------------------------------------------------------------------------------- */

/* Bytes, 0 when not known: the ceiling without a wish, so that a message comes before the system ends the program. */
static size_t machine_memory(void)
{
    const double size = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    return size > 0 && size < (double)SIZE_MAX ? (size_t)size : 0;
}

void session_begin(session *s, const scene_wish *wish)
{
    memset(s, 0, sizeof *s);
    s->wish = wish;
    s->begun = seconds_now();
    s->shown = progress_make(wish->quiet);
    s->def = progress_context_def(&s->shown);
    s->def.max_memory = wish->memory > 0 ? wish->memory : machine_memory();
}

int session_load(session *s)
{
    const scene_wish *wish = s->wish;
    if (gno_context_create(&s->def, &s->context) != GNO_OK) {
        say("out of memory");
        return EXIT_FAILED;
    }
    gno_status status = gno_scene_load(s->context, wish->path, wish->settings, wish->setting_count, &s->scene);
    if (status == GNO_OK && wish->width != 0) {
        gno_image_def image = gno_scene_image(s->scene);
        image.width = wish->width;
        image.height = wish->height;
        status = gno_scene_set_image(s->scene, &image);
    }
    s->load_seconds = seconds_now() - s->begun;
    return status == GNO_OK ? -1 : session_result(s, status);
}

int session_result(session *s, gno_status status)
{
    progress_clear(&s->shown);
    if (status == GNO_OK) {
        return EXIT_DONE;
    }
    if (interrupt_signal() != 0) {
        say("interrupted; nothing half done is left");
        return EXIT_SIGNAL + interrupt_signal();
    }
    say("%s", gno_context_message(s->context));
    return EXIT_FAILED;
}

void session_end(session *s)
{
    gno_scene_destroy(s->scene);
    gno_context_destroy(s->context);
}

int session_threads(const session *s)
{
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    if (s->wish->threads > 0) {
        return s->wish->threads;
    }
    return processors < 1 ? 1 : processors > GNO_MAX_THREADS ? GNO_MAX_THREADS : (int)processors;
}

int session_find_light(const session *s, const char *name)
{
    const int count = (int)gno_scene_count(s->scene).lights;
    const char **names = calloc((size_t)count + 1, sizeof *names);
    int found = -1;
    if (names == NULL) {
        say("out of memory");
        return -1;
    }
    for (int i = 0; i < count && found < 0; i++) {
        gno_scene_light(s->scene, i, NULL, &names[i]);
        found = strcmp(names[i], name) == 0 ? i : -1;
    }
    if (found < 0) {
        const char *near = nearest_name(name, names, count);
        say(near != NULL ? "%s: there is no light \"%s\"; did you mean \"%s\"?" : "%s: there is no light \"%s\"", s->wish->path, name, near);
    }
    free(names);
    return found;
}

/* ---- files ---------------------------------------------------------------------------------------------------------------------- */

int output_begin(const char *path)
{
    const int is_stream = output_is_stream(path);
    if (is_stream) {
        interrupt_release();
    }
    return is_stream;
}

void output_end(int is_stream, gno_status status)
{
    if (is_stream && status == GNO_OK) {
        interrupt_catch();
    }
}
