/* spans.c -- the visible spans of a picture, split by shadow, without any picture: prints those of one line. */
#include <gnomon/gnomon.h>
#include <stdio.h>

#define WIDTH 100
#define HEIGHT 60
#define SHOWN 38 /* the row whose spans are printed */

static int take_line(void *user, const gno_span_line *line)
{
    size_t i, k;
    double *lit = (double *)user;
    for (i = 0; i < line->span_count; i++) {
        const gno_span *s = &line->spans[i];
        if (line->row == SHOWN && line->line == 0)
            printf("[%.2f, %.2f) polygon %u, depth %.2f to %.2f:", s->x0, s->x1, s->polygon, s->depth0, s->depth1);
        for (k = s->part_start[0]; k < s->part_start[1]; k++) { /* under light 0 */
            lit[s->parts[k].light[0] > 0] += s->parts[k].x1 - s->parts[k].x0;
            if (line->row == SHOWN && line->line == 0)
                printf(" [%.2f, %.2f) %s", s->parts[k].x0, s->parts[k].x1, s->parts[k].light[0] > 0 ? "lit" : "dark");
        }
        if (line->row == SHOWN && line->line == 0) printf("\n");
    }
    return 0;
}

int main(void)
{
    /* A floor, and a fence over it that the sun throws a shadow of. */
    static const double p[24] = {-9, -9, 0, 9, -9, 0, 9, 9, 0, -9, 9, 0, 0.5, -2, 0, 0.5, 2, 0, 0.5, 2, 1, 0.5, -2, 1};
    static const int corner[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    static const unsigned ring[3] = {0, 4, 8};
    gno_context *context = NULL;
    gno_scene *scene = NULL;
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_light sun = gno_light_default();
    gno_image_def image = gno_image_def_default();
    gno_render_def def = gno_render_def_default();
    double length[2] = {0, 0};
    gno_status status = gno_context_create(NULL, &context);
    mesh.vertex_count = mesh.corner_count = 8;
    mesh.positions = p;
    mesh.polygon_count = mesh.ring_count = 2;
    mesh.ring_start = ring;
    mesh.corner_vertex = corner;
    sun.type = GNO_LIGHT_DIRECTIONAL;
    sun.direction[0] = 1;
    sun.direction[2] = -1;
    image.width = WIDTH;
    image.height = HEIGHT;
    def.base_lines = 1; /* one line through the middle of each pixel row */
    if (!status) status = gno_scene_create(context, &scene);
    if (!status) status = gno_scene_add_mesh(scene, &mesh, NULL);
    if (!status) status = gno_scene_add_light(scene, "sun", &sun, NULL);
    if (!status) status = gno_scene_set_image(scene, &image);
    if (!status) status = gno_render_spans(scene, &def, take_line, length, NULL);
    if (status) fprintf(stderr, "spans: %s\n", gno_context_message(context));
    else printf("of all that is seen %.2f %% is lit\n", 100 * length[1] / (length[0] + length[1]));
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return status != GNO_OK;
}
