/* rows.c -- a program's own polygons drawn into its own buffer, row by row: a lit step pyramid, written as rows.ppm. */
#include <gnomon/gnomon.h>
#include <stdio.h>

#define WIDTH 320
#define HEIGHT 200

static unsigned char screen[HEIGHT][WIDTH][3]; /* what the old program draws into */

/* Takes one finished row. The square root is near enough to the sRGB curve for a screen. */
static int take_row(void *user, int y, const float *rgb)
{
    int i;
    (void)user;
    for (i = 0; i < 3 * WIDTH; i++) {
        float value = rgb[i] < 1 ? rgb[i] : 1, root = 1;
        int step;
        for (step = 0; step < 12; step++) root = (root + value / root) / 2;
        screen[y][i / 3][i % 3] = (unsigned char)(255 * root + 0.5f);
    }
    return 0; /* anything else would stop the picture here */
}

/* A box without a floor, from its half width and its two heights. */
static gno_status add_box(gno_scene *scene, double half, double z0, double z1)
{
    static const int corner[20] = {0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7, 4, 5, 6, 7};
    static const unsigned ring[6] = {0, 4, 8, 12, 16, 20};
    double p[24];
    gno_mesh_def mesh = gno_mesh_def_default();
    int i;
    for (i = 0; i < 8; i++) {
        p[3 * i] = (i & 3) == 1 || (i & 3) == 2 ? half : -half;
        p[3 * i + 1] = (i & 2) ? half : -half;
        p[3 * i + 2] = i < 4 ? z0 : z1;
    }
    mesh.vertex_count = 8;
    mesh.positions = p;
    mesh.polygon_count = mesh.ring_count = 5;
    mesh.ring_start = ring;
    mesh.corner_count = 20;
    mesh.corner_vertex = corner;
    return gno_scene_add_mesh(scene, &mesh, NULL);
}

int main(void)
{
    gno_context *context = NULL;
    gno_scene *scene = NULL;
    gno_light sun = gno_light_default();
    gno_image_def image = gno_image_def_default();
    FILE *file;
    gno_status status = gno_context_create(NULL, &context);
    int step;
    image.width = WIDTH;
    image.height = HEIGHT;
    sun.type = GNO_LIGHT_DIRECTIONAL;
    sun.direction[0] = 1;
    sun.direction[1] = 0.6;
    sun.direction[2] = -0.9;
    if (!status) status = gno_scene_create(context, &scene);
    if (!status) status = gno_scene_set_image(scene, &image);
    if (!status) status = gno_scene_add_light(scene, "sun", &sun, NULL);
    for (step = 0; step < 5 && !status; step++)
        status = add_box(scene, step ? 2 - 0.4 * step : 40, 0.5 * step - 0.5, 0.5 * step);
    if (!status) status = gno_render_rows(scene, NULL, take_row, NULL, NULL);
    if (status) fprintf(stderr, "rows: %s\n", gno_context_message(context));
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    file = status ? NULL : fopen("rows.ppm", "wb");
    if (!file) return 1;
    fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
    fwrite(screen, 1, sizeof screen, file);
    return fclose(file) != 0;
}
