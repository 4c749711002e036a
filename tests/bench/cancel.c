/* cancel.c -- how soon a call answers when it is told to stop: usage: cancel WHAT SCENE WIDTH HEIGHT THREADS TRIES
 *
 * WHAT: render (load SCENE, render it, write it as EXR), lit (load, lit pieces of the first light with the certificate), matrix (load,
 * build, check), visible (load, visible pieces), info (load, find problems), or clip (two stars of WIDTH x HEIGHT corners, no scene).
 * It is done once undisturbed and TRIES times with a stop asked for at a random moment, from a clock as a user's program would. Prints
 * for every stage the longest time between two questions of the progress callback (of the processor, so that a busy machine does not
 * count), and the longest time by the clock from the wish to stop to the return of the call. Exit status 1 when that is over 50 ms.
 */
#include <gnomon/gnomon_clip.h>
#include <gnomon/gnomon_io.h>
#include <gnomon/gnomon_matrix.h>
#include <gnomon/gnomon_pieces.h>
#include <gnomon/gnomon_problems.h>
#include <math.h>
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

static gno_status render(gno_context *context, watch *w, gno_scene *scene, char **argv, int threads)
{
    gno_render_def def = gno_render_def_default();
    gno_image_def image;
    float *rgb = NULL;
    gno_status status;
    char path[64];
    snprintf(path, sizeof path, "/tmp/gnomon-cancel-%ld.exr", (long)getpid());
    def.threads = threads;
    image = gno_scene_image(scene);
    image.width = atoi(argv[3]);
    image.height = atoi(argv[4]);
    status = gno_scene_set_image(scene, &image);
    rgb = malloc(3 * sizeof *rgb * (size_t)image.width * (size_t)image.height);
    if (!status)
        status = gno_render(scene, &def, rgb, NULL);
    note(w, "(after the last question of rendering)", worked() - w->last);
    w->last = worked();
    if (!status)
        status = gno_picture_write(context, path, NULL, image.width, image.height, rgb);
    free(rgb);
    remove(path);
    return status;
}

static gno_status light(gno_scene *scene, int threads)
{
    gno_lit_def def = gno_lit_def_default();
    def.threads = threads;
    return gno_lit_pieces(scene, 0, &def, NULL, NULL, NULL);
}

static gno_status see(gno_scene *scene, int threads)
{
    gno_visible_def def = gno_visible_def_default();
    gno_pieces *pieces = NULL;
    gno_status status;
    def.threads = threads;
    status = gno_visible_pieces(scene, &def, &pieces, NULL);
    gno_pieces_destroy(pieces);
    return status;
}

static gno_status matrix(gno_scene *scene, int threads)
{
    gno_matrix_def def = gno_matrix_def_default();
    gno_matrix_check_result result;
    gno_matrix *m = NULL;
    gno_status status;
    def.threads = threads;
    status = gno_matrix_build(scene, 0, &def, &m);
    if (!status)
        status = gno_matrix_check(scene, 0, m, &result);
    gno_matrix_destroy(m);
    return status;
}

/* A ring that goes `turns` times around from near to far and back: every tooth crosses those of another such star. */
static double *star(size_t corners, double phase)
{
    double *p = malloc(2 * corners * sizeof *p);
    for (size_t i = 0; p && i < corners; i++) {
        double a = 6.283185307179586 * ((double)i + phase) / (double)corners, r = i % 2 ? 1 : 0.9;
        p[2 * i] = r * cos(a);
        p[2 * i + 1] = r * sin(a);
    }
    return p;
}

static gno_status clip(gno_context *context, watch *w, size_t corners)
{
    size_t start[2] = {0, corners};
    gno_shape a = {1, NULL, 1, start, NULL}, b = a, result;
    gno_clipper *clipper = NULL;
    double *at[2] = {star(corners, 0), star(corners, 0.5)};
    gno_status status = at[0] && at[1] ? gno_clipper_create(context, &clipper) : GNO_ERROR_MEMORY;
    a.points = at[0];
    b.points = at[1];
    w->last = worked();
    if (!status)
        status = gno_clip(clipper, GNO_CLIP_XOR, &a, &b, &result);
    gno_clipper_destroy(clipper);
    free(at[0]);
    free(at[1]);
    return status;
}

static gno_status work(gno_context *context, watch *w, char **argv, int threads)
{
    const char *what = argv[1];
    gno_scene *scene = NULL;
    gno_status status;
    w->last = worked();
    if (!strcmp(what, "clip"))
        return clip(context, w, (size_t)atoi(argv[3]) * (size_t)atoi(argv[4]));
    status = gno_scene_load(context, argv[2], NULL, 0, &scene);
    if (!status)
        status = !strcmp(what, "lit")       ? light(scene, threads)
                 : !strcmp(what, "matrix")  ? matrix(scene, threads)
                 : !strcmp(what, "visible") ? see(scene, threads)
                 : !strcmp(what, "info")    ? gno_scene_find_problems(scene, threads, NULL, NULL, NULL)
                                            : render(context, w, scene, argv, threads);
    note(w, "(after the last question)", worked() - w->last);
    w->last = worked();
    if (!w->stop_at)
        gno_scene_destroy(scene);
    else {
        double from = now();
        gno_scene_destroy(scene);
        w->stop_at += now() - from; /* giving memory back is the program's own time */
    }
    return status;
}

int main(int argc, char **argv)
{
    gno_context_def def = gno_context_def_default();
    gno_context *context = NULL;
    double whole, worst = 0;
    const char *where = "";
    watch w;
    if (argc != 7) {
        fprintf(stderr, "usage: cancel WHAT SCENE WIDTH HEIGHT THREADS TRIES\n");
        return 2;
    }
    memset(&w, 0, sizeof w);
    def.progress = on_progress;
    def.progress_user = &w;
    if (gno_context_create(&def, &context) != GNO_OK)
        return 1;
    whole = now();
    if (work(context, &w, argv, atoi(argv[5])) != GNO_OK) {
        fprintf(stderr, "cancel: %s\n", gno_context_message(context));
        return 1;
    }
    whole = now() - whole;
    for (int i = 0; i < w.count; i++)
        printf("%-40s %7.1f ms at most between two questions\n", w.stage[i], 1e3 * w.gap[i]);
    srand(1);
    for (int i = 0; i < atoi(argv[6]); i++) {
        double late;
        gno_status status;
        w.stop_at = now() + whole * (rand() + 0.5) / ((double)RAND_MAX + 1);
        status = work(context, &w, argv, atoi(argv[5]));
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
    printf("%s: whole run %.2f s; stopped %s times at random: the longest to return %.1f ms (%s)\n", argv[1], whole, argv[6], 1e3 * worst, where);
    return worst > LIMIT;
}
