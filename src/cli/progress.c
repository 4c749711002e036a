/* progress.c -- see progress.h. */
#include "cli/progress.h"

#include "cli/interrupt.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* Short work needs no bar; a bar that is redrawn oftener than this only flickers. Seconds. */
static const double SHOW_AFTER = 1.0, REDRAW_AFTER = 0.1;

enum { BAR = 30, LINE = 72 };

double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

progress progress_make(int quiet)
{
    const char *terminal = getenv("TERM");
    progress shown;
    memset(&shown, 0, sizeof shown);
    shown.quiet = quiet;
    shown.terminal = isatty(STDERR_FILENO) && terminal != NULL && strcmp(terminal, "dumb") != 0;
    shown.begun = seconds_now();
    return shown;
}

void progress_clear(progress *shown)
{
    if (shown->drawn > 0.0) {
        fprintf(stderr, "\r%*s\r", LINE, "");
        fflush(stderr);
        shown->drawn = 0.0;
    }
}

static void draw(const progress *shown, double now)
{
    char bar[BAR + 1], left[40] = "";
    const int filled = (int)(shown->stage_fraction * BAR);
    memset(bar, ' ', BAR);
    memset(bar, '=', (size_t)filled);
    bar[BAR] = '\0';
    if (shown->stage_fraction > 0.02) {
        const double seconds = (now - shown->stage_begun) * (1.0 - shown->stage_fraction) / shown->stage_fraction;
        const long whole = seconds < 359999.0 ? (long)(seconds + 0.999) : 359999;
        snprintf(left, sizeof left, "%ld:%02ld:%02ld left", whole / 3600, whole / 60 % 60, whole % 60);
    }
    fprintf(stderr, "\r%-12.12s [%s] %3d %%  %-16s", shown->stage, bar, (int)(shown->stage_fraction * 100.0), left);
    fflush(stderr);
}

void progress_set_frame(progress *shown, int frame, int frames)
{
    shown->frame = frame;
    shown->frames = frames > 1 ? frames : 0;
    if (frame == 0) {
        shown->stage_fraction = 0.0; /* of what came before, such as reading */
    }
}

static int on_progress(void *user, const char *stage, double fraction)
{
    progress *shown = user;
    const int stop = interrupt_signal() != 0;
    if (shown->quiet || !shown->terminal || stop) {
        return stop;
    }
    const double now = seconds_now();
    if (shown->frames > 0) {
        /* Of a frame only the drawing counts: what comes before it takes next to no time but in the first. */
        fraction = (shown->frame + (strcmp(stage, "render") == 0 ? fraction : 0.0)) / shown->frames;
        fraction = fraction < shown->stage_fraction ? shown->stage_fraction : fraction;
        stage = "frames";
    }
    /* A stage can come again (a light after the other): its clock starts anew when its share falls. */
    if (strncmp(stage, shown->stage, sizeof shown->stage - 1) != 0 || fraction < shown->stage_fraction) {
        snprintf(shown->stage, sizeof shown->stage, "%s", stage);
        shown->stage_begun = now;
    }
    shown->stage_fraction = fraction < 0.0 ? 0.0 : fraction > 1.0 ? 1.0 : fraction;
    if (now - shown->begun > SHOW_AFTER && now - shown->drawn > REDRAW_AFTER) {
        shown->drawn = now;
        draw(shown, now);
    }
    return 0;
}

static void on_log(void *user, gno_log_level level, const char *text)
{
    progress *shown = user;
    if (!shown->quiet) {
        progress_clear(shown);
        say("%s%s", level == GNO_LOG_WARNING ? "warning: " : "", text);
    }
}

gno_context_def progress_context_def(progress *shown)
{
    gno_context_def def = gno_context_def_default();
    def.log = on_log;
    def.log_user = shown;
    def.progress = on_progress;
    def.progress_user = shown;
    return def;
}
