/* pieces.c -- seconds for the lit pieces of every polygon under the scene's first light, and for the visible pieces, unsplit and split by
 * that light; one thread, least of five. Place: benchmarks; uses the public libraries alone.
 *
 * usage: pieces SCENE...
 */
#include <gnomon/gnomon_io.h>
#include <gnomon/gnomon_pieces.h>
#include <stdio.h>
#include <time.h>

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* What is timed: 0 lit pieces, 1 visible ones, 2 those split by the lights. The scene is loaded anew, so that nothing is kept. */
static double seconds(gno_context *context, const char *path, int what, double *polygons, double *pieces)
{
    gno_scene *scene = NULL;
    gno_pieces *found = NULL;
    gno_lit_def lit = gno_lit_def_default();
    gno_visible_def visible = gno_visible_def_default();
    gno_status status = gno_scene_load(context, path, NULL, 0, &scene);
    double from, taken;
    lit.threads = visible.threads = 1;
    lit.certify = 0;
    visible.split = what == 2;
    from = now();
    if (!status)
        status = what ? gno_visible_pieces(scene, &visible, &found, NULL) : gno_lit_pieces(scene, 0, &lit, &found, NULL, NULL);
    taken = status ? -1 : now() - from;
    *polygons = status ? 0 : (double)gno_scene_count(scene).polygons;
    *pieces = status ? 0 : (double)gno_pieces_count(found);
    gno_pieces_destroy(found);
    gno_scene_destroy(scene);
    return taken;
}

int main(int argc, char **argv)
{
    static const char *const names[3] = {"lit", "visible", "visible, split"};
    gno_context *context = NULL;
    if (gno_context_create(NULL, &context))
        return 1;
    printf("| polygons | what | seconds | pieces |\n|---|---|---|---|\n");
    for (int i = 1; i < argc; i++)
        for (int what = 0; what < 3; what++) {
            double least = -1, polygons = 0, pieces = 0;
            for (int k = 0; k < 5; k++) {
                double t = seconds(context, argv[i], what, &polygons, &pieces);
                if (t < 0) {
                    fprintf(stderr, "pieces: %s: %s\n", argv[i], gno_context_message(context));
                    return 1;
                }
                least = least < 0 || t < least ? t : least;
            }
            printf("| %.0f | %s | %.3f | %.0f |\n", polygons, names[what], least, pieces);
            fflush(stdout);
        }
    gno_context_destroy(context);
    return 0;
}
