/* cancel.c -- how soon a call answers when it is told to stop: usage: cancel SCENE WIDTH HEIGHT THREADS TRIES
 *
 * Loads SCENE, renders it and writes it as EXR, once undisturbed and TRIES times with a stop asked for at a random moment, from a clock as a
 * user's program would. Prints for every stage the longest time between two questions of the progress callback (of the processor,
 * so that a busy machine does not count), and the longest time by the clock from the wish to stop to the return of the call. Exit
 * status 1 when that is over 50 ms.
 */
#include <gnomon/gnomon_io.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define LIMIT 0.05
#define STAGES 32

typedef struct watch {
    double last, stop_at; /* stop_at 0: never */
    int count;
    const char *stage[STAGES];
    double gap[STAGES];
    const char *current;
} watch;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* What the calling thread has worked. */
static double worked(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void note(watch *w, const char *stage, double gap)
{
    int i = 0;
    while (i < w->count && strcmp(w->stage[i], stage) != 0)
        i++;
    if (i == STAGES)
        return;
    if (i == w->count) {
        w->stage[w->count++] = stage;
        w->gap[i] = 0;
    }
    w->gap[i] = gap > w->gap[i] ? gap : w->gap[i];
}

static int on_progress(void *user, const char *stage, double fraction)
{
    watch *w = user;
    double t = worked();
    (void)fraction;
    note(w, stage, t - w->last);
    w->last = t;
    w->current = stage;
    return w->stop_at > 0 && now() >= w->stop_at;
}

static gno_status work(gno_context *context, watch *w, char **argv, int threads)
{
    gno_scene *scene = NULL;
    gno_render_def def = gno_render_def_default();
    gno_image_def image;
    float *rgb = NULL;
    gno_status status;
    char path[64];
    snprintf(path, sizeof path, "/tmp/gnomon-cancel-%ld.exr", (long)getpid());
    def.threads = threads;
    w->last = worked();
    status = gno_scene_load(context, argv[1], NULL, 0, &scene);
    if (!status) {
        image = gno_scene_image(scene);
        image.width = atoi(argv[2]);
        image.height = atoi(argv[3]);
        status = gno_scene_set_image(scene, &image);
        rgb = malloc(3 * sizeof *rgb * (size_t)image.width * (size_t)image.height);
    }
    if (!status)
        status = gno_render(scene, &def, rgb, NULL);
    note(w, "(after the last question of rendering)", worked() - w->last);
    w->last = worked();
    if (!status)
        status = gno_picture_write(context, path, NULL, image.width, image.height, rgb);
    note(w, "(after the last question)", worked() - w->last);
    w->last = worked();
    free(rgb);
    if (!w->stop_at)
        gno_scene_destroy(scene);
    else {
        double from = now();
        gno_scene_destroy(scene);
        w->stop_at += now() - from; /* giving memory back is the program's own time */
    }
    remove(path);
    return status;
}

int main(int argc, char **argv)
{
    gno_context_def def = gno_context_def_default();
    gno_context *context = NULL;
    double whole, worst = 0;
    const char *where = "";
    watch w;
    if (argc != 6) {
        fprintf(stderr, "usage: cancel SCENE WIDTH HEIGHT THREADS TRIES\n");
        return 2;
    }
    memset(&w, 0, sizeof w);
    def.progress = on_progress;
    def.progress_user = &w;
    if (gno_context_create(&def, &context) != GNO_OK)
        return 1;
    whole = now();
    if (work(context, &w, argv, atoi(argv[4])) != GNO_OK) {
        fprintf(stderr, "cancel: %s\n", gno_context_message(context));
        return 1;
    }
    whole = now() - whole;
    for (int i = 0; i < w.count; i++)
        printf("%-40s %7.1f ms at most between two questions\n", w.stage[i], 1e3 * w.gap[i]);
    srand(1);
    for (int i = 0; i < atoi(argv[5]); i++) {
        double late;
        gno_status status;
        w.stop_at = now() + whole * (rand() + 0.5) / ((double)RAND_MAX + 1);
        status = work(context, &w, argv, atoi(argv[4]));
        late = now() - w.stop_at;
        if (status == GNO_OK)
            continue;
        if (status != GNO_ERROR_CANCELLED)
            printf("unexpected: %s\n", gno_context_message(context));
        if (late > worst) {
            worst = late;
            where = w.current;
        }
    }
    gno_context_destroy(context);
    printf("whole run %.2f s; stopped %s times at random: the longest to return %.1f ms (%s)\n", whole, argv[5], 1e3 * worst, where);
    return worst > LIMIT;
}
