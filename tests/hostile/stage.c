/* stage.c -- see cases.h. */
#include "hostile/cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

hostile_stage hostile_stage_make(void)
{
    hostile_stage s = {NULL, NULL};
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    gno_light light = gno_light_default();
    gno_context_def def = gno_context_def_default();
    def.max_memory = (size_t)1 << 30;
    image.width = 64;
    image.height = 48;
    image.background[2] = 0.5;
    camera.eye[0] = camera.eye[1] = 0;
    camera.eye[2] = 10;
    camera.target[2] = 0;
    camera.up[1] = 1;
    camera.up[2] = 0;
    camera.fov = 14;
    light.type = GNO_LIGHT_DIRECTIONAL;
    light.direction[0] = 0.3;
    light.direction[1] = 0.2;
    light.direction[2] = -1;
    if (gno_context_create(&def, &s.context) || gno_scene_create(s.context, &s.scene) || gno_scene_set_camera(s.scene, &camera) ||
        gno_scene_set_image(s.scene, &image) || gno_scene_add_light(s.scene, "sun", &light, NULL)) {
        exit(3);
    }
    return s;
}

void hostile_stage_drop(hostile_stage *s)
{
    gno_scene_destroy(s->scene);
    gno_context_destroy(s->context);
}

gno_status hostile_add(hostile_stage *s, const double *positions, size_t polygons, size_t n, int material, int shading)
{
    gno_mesh_def mesh = gno_mesh_def_default();
    unsigned *start = malloc((polygons + 1) * sizeof *start);
    int *corner = malloc(polygons * n * sizeof *corner);
    gno_status status = GNO_ERROR_MEMORY;
    if (start && corner) {
        for (size_t i = 0; i <= polygons; i++) {
            start[i] = (unsigned)(i * n);
        }
        for (size_t i = 0; i < polygons * n; i++) {
            corner[i] = (int)i;
        }
        mesh.vertex_count = mesh.corner_count = polygons * n;
        mesh.polygon_count = mesh.ring_count = polygons;
        mesh.positions = positions;
        mesh.ring_start = start;
        mesh.corner_vertex = corner;
        mesh.material = material;
        mesh.shading = shading;
        status = gno_scene_add_mesh(s->scene, &mesh, NULL);
    }
    free(start);
    free(corner);
    return status;
}

int hostile_say(hostile_stage *s, gno_status status, int as_promised, char *outcome, size_t room)
{
    snprintf(outcome, room, "%s: %s", gno_status_text(status), gno_context_message(s->context));
    return as_promised && (status == GNO_OK || gno_context_message(s->context)[0] != '\0');
}

int hostile_draw(hostile_stage *s, gno_engine engine, char *outcome, size_t room)
{
    gno_render_def def = gno_render_def_default();
    gno_image_def image = gno_scene_image(s->scene);
    size_t values = (size_t)image.width * (size_t)image.height * 3;
    float *rgb = malloc(values * sizeof *rgb);
    double sum = 0;
    gno_status status;
    def.engine = engine;
    status = rgb ? gno_render(s->scene, &def, rgb, NULL) : GNO_ERROR_MEMORY;
    for (size_t i = 0; i < values && status == GNO_OK; i++) {
        sum += rgb[i];
    }
    free(rgb);
    if (status) {
        return hostile_say(s, status, strstr(gno_context_message(s->context), "the memory ceiling of") != NULL, outcome, room);
    }
    snprintf(outcome, room, "drawn, mean %.4f", sum / (double)values);
    return isfinite(sum) && sum > 0;
}

double hostile_random(unsigned long long *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}
