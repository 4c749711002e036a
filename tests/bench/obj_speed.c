/* obj_speed.c -- how fast OBJ files are read: path to scene, best of several runs. Built and run by obj_speed.sh.
 *
 *   obj_speed RUNS FILE...      prints one CSV line a file: file, MB, polygons, best seconds, MB/s
 */
#include "io/mesh_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double file_megabytes(const char *path)
{
    FILE *file = fopen(path, "rb");
    long size = 0;
    if (file && fseek(file, 0, SEEK_END) == 0) size = ftell(file);
    if (file) fclose(file);
    return 1e-6 * (double)size;
}

static int time_file(const char *path, int runs)
{
    double best = 1e30;
    size_t polygons = 0;
    for (int i = 0; i < runs; i++) {
        gno_context *context = NULL;
        gno_scene *scene = NULL;
        gnoi_mesh_result result;
        if (gno_context_create(NULL, &context) != GNO_OK || gno_scene_create(context, &scene) != GNO_OK) return 0;
        double start = now();
        gno_status status = gnoi_mesh_load(scene, path, NULL, &result);
        double seconds = now() - start;
        if (status != GNO_OK) fprintf(stderr, "%s\n", gno_context_message(context));
        gno_scene_destroy(scene);
        gno_context_destroy(context);
        if (status != GNO_OK) return 0;
        polygons = result.polygon_count;
        if (seconds < best) best = seconds;
    }
    double size = file_megabytes(path);
    printf("%s,%.2f,%zu,%.4f,%.0f\n", path, size, polygons, best, size / best);
    return 1;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: obj_speed RUNS FILE...\n");
        return 2;
    }
    printf("file,megabytes,polygons,seconds,megabytes_per_second\n");
    for (int i = 2; i < argc; i++)
        if (!time_file(argv[i], atoi(argv[1]))) return 1;
    return 0;
}
