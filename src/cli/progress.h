/* progress.h -- what a command shows while it works: a bar on a terminal, and the libraries' remarks.
 *
 * Place: under the commands; the callbacks of their gno_context. Standard error only.
 */
#ifndef GNOMON_CLI_PROGRESS_H
#define GNOMON_CLI_PROGRESS_H

#include "cli/cli.h"

typedef struct progress {
    int quiet;       /* no bar, no remarks */
    int terminal;    /* standard error is one that understands \r */
    double begun;    /* seconds */
    double drawn;    /* when the bar was last drawn, 0: it is not on the screen */
    char stage[32];  /* of the bar, and when it began */
    double stage_begun, stage_fraction;
    int frame, frames; /* of a film: which, and how many; 0 frames: a picture */
} progress;

progress progress_make(int quiet);

/* A context definition with this progress as its callbacks. */
gno_context_def progress_context_def(progress *shown);

/* From now on the bar shows all `frames`, of which `frame` (from 0) is drawn now. One frame is a picture as ever. */
void progress_set_frame(progress *shown, int frame, int frames);

/* Takes the bar off the screen, before something else is printed. */
void progress_clear(progress *shown);

/* Monotonic wall-clock seconds. */
double seconds_now(void);

#endif
