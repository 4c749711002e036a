/* frames.h -- which frames of a camera's path a run draws, and the names of their files.
 *
 * Place: under render.c: --frames, file names, the scene's path -> frame_plan -> a camera and names for each frame.
 */
#ifndef GNOMON_CLI_FRAMES_H
#define GNOMON_CLI_FRAMES_H

#include "cli/cli.h"

#include <gnomon/gnomon_path.h>

typedef struct frame_wish {
    int given, all; /* --frames was there; it was "all" */
    int first, last;
} frame_wish;

typedef struct frame_plan {
    int first, count;   /* count 1 and numbered 0: a picture, not a film */
    int numbered;
    int has_path;
    gno_camera start;
    gno_camera_path path;
} frame_plan;

/* "all", "N" or "A:B"; 0 when it is none of them. */
int frames_parse(const char *text, frame_wish *wish);

/* Whether the name has one place for a number: %d, %4d or %04d. */
int frame_name_has_number(const char *name);

/* The name with the frame's number in its place, if it has one; to be freed. NULL: out of memory. */
char *frame_name(const char *name, int frame);

/* What to draw; returns -1, or an exit status, its message being out. names: of the pictures. */
int frames_plan(const frame_wish *wish, const char *scene_path, const gno_scene *scene, const char *const *names, int name_count,
                frame_plan *plan);

/* Gives the scene the camera of a frame. */
gno_status frames_set_camera(const frame_plan *plan, gno_scene *scene, int frame);

#endif
