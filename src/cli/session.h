/* session.h -- what every command on a scene begins and ends with.
 *
 * Place: arguments -> scene_wish -> session_begin, session_load -> the command's own work on session.scene -> session_end.
 * Invariant: what fails has said so on standard error before it returns.
 */
#ifndef GNOMON_CLI_SESSION_H
#define GNOMON_CLI_SESSION_H

#include "cli/progress.h"

/* What the arguments common to the commands ask for. */
typedef struct scene_wish {
    const char *path;
    gno_setting *settings; /* room for one an argument */
    size_t setting_count;
    int width, height; /* 0: the scene's */
    int threads;       /* 0: one per processor */
    size_t memory;     /* ceiling, 0: what the machine has */
    int quiet;
} scene_wish;

/* Room for settings; 0 when memory fails. The rest is zero. */
int scene_wish_make(scene_wish *wish, int argc);
void scene_wish_free(scene_wish *wish);

/* An option that commands share, by its name: size, threads, memory, set, quiet. Returns -1, or an exit status. */
int take_common(scene_wish *wish, const char *command_name, const char *option_name, char *value);

typedef struct session {
    const scene_wish *wish;
    progress shown;
    gno_context_def def;
    gno_context *context;
    gno_scene *scene;
    double begun, load_seconds;
} session;

/* The session stays where it is: callbacks point into it. Afterwards `def` may be changed. */
void session_begin(session *s, const scene_wish *wish);

/* The scene with the wish's settings and size. Returns -1, or an exit status. */
int session_load(session *s);

/* The exit status of work that ended so; what went wrong is said, an interruption too. */
int session_result(session *s, gno_status status);

/* Releases scene and context, whatever there is of them. */
void session_end(session *s);

/* Threads that a wish comes to on this machine. */
int session_threads(const session *s);

/* The light of that name, or -1. */
int session_find_light(const session *s, const char *name);

/* ---- files while signals are caught ----------------------------------------------------------------------------------------- */

/* A stream leaves nothing behind, and a reader that does not read could hold it up for ever: there a signal ends the program at once. A file
 * that is being written is given up and leaves nothing behind. output_begin before a file is written, output_end with its result after. */
int output_begin(const char *path);
void output_end(int is_stream, gno_status status);

#endif
