/* lit.c -- asks only for lit areas: a wall with an overhang, morning to evening; what part of the wall does the sun reach? */
#include <gnomon/gnomon_pieces.h>
#include <stdio.h>

#define HOURS 4

/* The wall faces -y; the overhang juts out 0.5 above it, 1 deep. */
static const double positions[8 * 3] = {
    0, 0, 0,     4, 0, 0,   4, 0, 3,    0, 0, 3,
    -1, 0, 3.5,  5, 0, 3.5, 5, -1, 3.5, -1, -1, 3.5};
static const int corner_vertex[8] = {0, 1, 2, 3, 4, 5, 6, 7};
static const unsigned ring_start[3] = {0, 4, 8};
static const double travel[HOURS][3] = {{-1, 1, -0.5}, {-0.5, 1, -1}, {0.5, 1, -1.5}, {1, 1, -2.5}};

static gno_status fill(gno_scene *scene)
{
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_light sun = gno_light_default();
    gno_status status;
    int hour, k;
    mesh.vertex_count = mesh.corner_count = 8;
    mesh.positions = positions;
    mesh.polygon_count = mesh.ring_count = 2;
    mesh.ring_start = ring_start;
    mesh.corner_vertex = corner_vertex;
    status = gno_scene_add_mesh(scene, &mesh, NULL);
    sun.type = GNO_LIGHT_DIRECTIONAL;
    for (hour = 0; hour < HOURS && !status; hour++) {
        for (k = 0; k < 3; k++)
            sun.direction[k] = travel[hour][k];
        status = gno_scene_add_light(scene, NULL, &sun, NULL);
    }
    return status;
}

static gno_status ask(gno_scene *scene)
{
    gno_lit_row rows[2];
    gno_lit_summary summary;
    gno_status status = GNO_OK;
    int hour;
    for (hour = 0; hour < HOURS && !status; hour++) {
        status = gno_lit_pieces(scene, (size_t)hour, NULL, NULL, rows, &summary);
        if (!status)
            printf("sun %d: %.6f of the wall's %g, proof %s\n", hour, rows[0].lit_area, rows[0].area,
                   summary.area_residual < 1e-9 && summary.flux_residual < 1e-9 ? "holds" : "fails");
    }
    return status;
}

int main(void)
{
    gno_context *context = NULL;
    gno_scene *scene = NULL;
    gno_status status = gno_context_create(NULL, &context);
    if (!status) status = gno_scene_create(context, &scene);
    if (!status) status = fill(scene);
    if (!status) status = ask(scene);
    if (status) fprintf(stderr, "lit: %s: %s\n", gno_status_text(status), gno_context_message(context));
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return status != GNO_OK;
}
