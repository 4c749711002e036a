/* frames.c -- see frames.h. */
#include "cli/frames.h"

#include "cli/options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDEST = 9 }; /* digits that a name may ask for */

int frames_parse(const char *text, frame_wish *wish)
{
    char copy[32];
    wish->given = 1;
    wish->all = strcmp(text, "all") == 0;
    if (wish->all) {
        return 1;
    }
    if (strlen(text) >= sizeof copy) {
        return 0;
    }
    strcpy(copy, text);
    char *colon = strchr(copy, ':');
    if (colon != NULL) {
        *colon = '\0';
    }
    return parse_int(copy, 0, GNO_MAX_FRAMES - 1, &wish->first) &&
           parse_int(colon != NULL ? colon + 1 : copy, 0, GNO_MAX_FRAMES - 1, &wish->last) && wish->first <= wish->last;
}

/* The place for a number from `at` on: its length and width; NULL when there is none. */
static const char *find_number(const char *at, size_t *length, int *width, int *zeros)
{
    for (at = strchr(at, '%'); at != NULL; at = strchr(at + 1, '%')) {
        const char *p = at + 1;
        *zeros = *p == '0';
        *width = 0;
        while (*p >= '0' && *p <= '9' && *width <= WIDEST) {
            *width = *width * 10 + (*p++ - '0');
        }
        if (*p == 'd' && *width <= WIDEST) {
            *length = (size_t)(p + 1 - at);
            return at;
        }
    }
    return NULL;
}

int frame_name_has_number(const char *name)
{
    size_t length;
    int width, zeros;
    const char *at = find_number(name, &length, &width, &zeros);
    return at != NULL && find_number(at + length, &length, &width, &zeros) == NULL;
}

char *frame_name(const char *name, int frame)
{
    const size_t room = strlen(name) + 2 * WIDEST;
    size_t length = 0;
    int width = 0, zeros = 0;
    char *out = malloc(room);
    if (out == NULL) {
        return NULL;
    }
    const char *at = frame_name_has_number(name) ? find_number(name, &length, &width, &zeros) : NULL;
    if (at == NULL) {
        strcpy(out, name);
    } else {
        snprintf(out, room, zeros ? "%.*s%0*d%s" : "%.*s%*d%s", (int)(at - name), name, width, frame, at + length);
    }
    return out;
}

static int plan_many(const frame_wish *wish, const char *scene_path, const char *const *names, int name_count, frame_plan *plan)
{
    const int last = wish->given && !wish->all ? wish->last : plan->path.frames - 1;
    plan->numbered = 1;
    plan->first = wish->given && !wish->all ? wish->first : 0;
    plan->count = last - plan->first + 1;
    if (last >= plan->path.frames) {
        say("--frames %d:%d: the path of %s has the frames 0 to %d", plan->first, last, scene_path, plan->path.frames - 1);
        return EXIT_FAILED;
    }
    for (int i = 0; i < name_count && plan->count > 1; i++) {
        if (!frame_name_has_number(names[i])) {
            return usage("render", "%s: %d frames need a number in the name, such as %%04d", names[i], plan->count);
        }
    }
    return -1;
}

int frames_plan(const frame_wish *wish, const char *scene_path, const gno_scene *scene, const char *const *names, int name_count,
                frame_plan *plan)
{
    int asked = wish->given;
    memset(plan, 0, sizeof *plan);
    plan->count = 1;
    plan->start = gno_scene_camera(scene);
    plan->has_path = gno_scene_camera_path(scene, &plan->path);
    if (plan->has_path && !asked) {
        for (int i = 0; i < name_count; i++) {
            asked |= frame_name_has_number(names[i]);
        }
    }
    if (!asked) {
        return -1;
    }
    if (!plan->has_path) {
        say("%s: has no camera.path for --frames", scene_path);
        return EXIT_FAILED;
    }
    return plan_many(wish, scene_path, names, name_count, plan);
}

gno_status frames_set_camera(const frame_plan *plan, gno_scene *scene, int frame)
{
    gno_camera camera;
    if (!plan->has_path) {
        return GNO_OK;
    }
    const gno_status status = gno_camera_path_at(&plan->path, &plan->start, frame, &camera);
    return status == GNO_OK ? gno_scene_set_camera(scene, &camera) : gno_context_fail(gno_scene_context(scene), status, "camera path: no such frame");
}
