/* draw.c -- a wall with a window on a floor, the sun behind it; the picture goes to draw.ppm. */
#include <gnomon/gnomon.h>
#include <math.h>
#include <stdio.h>

#define WIDTH 480
#define HEIGHT 270

/* Twelve points. The rings are lists of them, the polygons lists of rings: the second ring of the wall is its window. */
static const double positions[12 * 3] = {
    -4, -4, 0,   4, -4, 0,   4, 4, 0,   -4, 4, 0,
    -2,  1, 0,   2,  1, 0,   2, 1, 3,   -2, 1, 3,
    -1,  1, 1,   1,  1, 1,   1, 1, 2,   -1, 1, 2};
static const int corner_vertex[12] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
static const unsigned ring_start[4] = {0, 4, 8, 12};
static const unsigned polygon_start[3] = {0, 1, 3};

static float rgb[3 * WIDTH * HEIGHT];

static gno_status fill(gno_scene *scene)
{
    static const double ambient[3] = {0.2, 0.22, 0.28}, way[3] = {0.5, -0.8, -1}, warm[3] = {0.9, 0.85, 0.7};
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_light sun = gno_light_default();
    gno_image_def image = gno_image_def_default();
    gno_status status;
    int k;
    mesh.vertex_count = 12;
    mesh.positions = positions;
    mesh.polygon_count = 2;
    mesh.polygon_start = polygon_start;
    mesh.ring_count = 3;
    mesh.ring_start = ring_start;
    mesh.corner_count = 12;
    mesh.corner_vertex = corner_vertex;
    sun.type = GNO_LIGHT_DIRECTIONAL;
    for (k = 0; k < 3; k++) {
        sun.direction[k] = way[k];
        sun.intensity[k] = warm[k];
    }
    image.width = WIDTH;
    image.height = HEIGHT;
    status = gno_scene_add_mesh(scene, &mesh, NULL);
    if (!status) status = gno_scene_add_light(scene, "sun", &sun, NULL);
    if (!status) status = gno_scene_set_ambient(scene, ambient);
    if (!status) status = gno_scene_set_image(scene, &image);
    return status; /* the camera stays the default one */
}

static int write_ppm(const char *path)
{
    FILE *file = fopen(path, "wb");
    int i;
    if (!file) return 0;
    fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
    for (i = 0; i < 3 * WIDTH * HEIGHT; i++)
        putc((int)(255 * pow(rgb[i] < 1 ? rgb[i] : 1, 1 / 2.2) + 0.5), file);
    return fclose(file) == 0;
}

int main(void)
{
    gno_context *context = NULL;
    gno_scene *scene = NULL;
    gno_status status = gno_context_create(NULL, &context);
    if (!status) status = gno_scene_create(context, &scene);
    if (!status) status = fill(scene);
    if (!status) status = gno_render(scene, NULL, rgb, NULL);
    if (status) fprintf(stderr, "draw: %s: %s\n", gno_status_text(status), gno_context_message(context));
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return status || !write_ppm("draw.ppm");
}
