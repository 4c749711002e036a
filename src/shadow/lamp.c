/* lamp.c -- see lamp.h. */
#include "shadow/lamp.h"

#include "scene/validate.h"
#include <gnomon/gnomon_pieces.h>

#define PI 3.14159265358979323846

static gnoi_lamp lamp_from(const gno_light *light)
{
    gnoi_lamp lamp;
    lamp.directional = light->type == GNO_LIGHT_DIRECTIONAL;
    lamp.spot = light->type == GNO_LIGHT_SPOT;
    lamp.position = v3_from(light->position);
    lamp.axis = v3_unit(v3_from(light->direction));
    lamp.to_light = v3_scale(lamp.axis, -1);
    lamp.cos_half_angle = cos(light->angle * PI / 360);
    for (int k = 0; k < 3; k++)
        lamp.intensity[k] = light->intensity[k];
    lamp.falloff = light->falloff;
    lamp.falloff_k = light->falloff_k;
    lamp.distance_from_viewer = light->distance_from_viewer;
    lamp.softness = light->softness;
    return lamp;
}

/* An area light is a grid of points at the centres of its parallelogram's cells, each with its share of the intensity. */
static gno_light point_of(const gno_light *light, size_t k)
{
    gno_light point = *light;
    const size_t n = (size_t)light->samples;
    if (light->type != GNO_LIGHT_AREA)
        return point;
    point.type = GNO_LIGHT_POINT;
    for (int c = 0; c < 3; c++) {
        point.position[c] += light->edge1[c] * (((double)(k / n) + 0.5) / (double)n);
        point.position[c] += light->edge2[c] * (((double)(k % n) + 0.5) / (double)n);
        point.intensity[c] /= (double)n * (double)n;
    }
    return point;
}

void gnoi_lamps_of(const gno_light *light, gnoi_lamp *lamps)
{
    size_t count = gnoi_light_points(light);
    for (size_t k = 0; k < count; k++) {
        const gno_light point = point_of(light, k);
        lamps[k] = lamp_from(&point);
    }
}

size_t gnoi_lamps_count(const gno_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->light_count; i++)
        count += gnoi_light_points(&scene->lights[i].light);
    return count;
}

void gnoi_lamps_fill(const gno_scene *scene, gnoi_lamp *lamps)
{
    for (size_t i = 0; i < scene->light_count; i++) {
        const gno_light *light = &scene->lights[i].light;
        gnoi_lamps_of(light, lamps);
        lamps += gnoi_light_points(light);
    }
}

int gnoi_lamp_outside(const gno_scene *scene, size_t solid, const gnoi_lamp *lamp)
{
    uint32_t cap = scene->prepared.solids[solid].cap;
    if (!lamp->directional)
        return gnoi_solid_outside(scene, solid, lamp->position);
    return cap == GNOI_NONE || v3_dot(v3_from(scene->prepared.polys[cap].n), lamp->to_light) < 0;
}

int gnoi_shadows_have_edges(const gno_scene *scene)
{
    for (size_t i = 0; i < scene->light_count; i++)
        if (scene->lights[i].light.softness > 0)
            return 0;
    for (size_t i = 0; i < scene->material_count; i++)
        if (gnoi_has_holes(scene, &scene->materials[i]))
            return 0;
    return 1;
}

int gnoi_lamp_is_first(const gno_scene *scene, size_t light)
{
    size_t first = 0;
    for (size_t i = 0; i < scene->light_count && first < light; i++)
        first += gnoi_light_points(&scene->lights[i].light);
    return first == light;
}

/* ---- public ----------------------------------------------------------------------------------------------------------- */

size_t gno_expanded_light_count(const gno_scene *scene)
{
    return scene ? gnoi_lamps_count(scene) : 0;
}

gno_status gno_expanded_light(const gno_scene *scene, size_t index, gno_light *light, int *source)
{
    size_t first = 0;
    if (!scene || !light)
        return GNO_ERROR_ARGUMENT;
    for (size_t i = 0; i < scene->light_count; i++) {
        const size_t count = gnoi_light_points(&scene->lights[i].light);
        if (index < first + count) {
            *light = point_of(&scene->lights[i].light, index - first);
            if (source)
                *source = (int)i;
            return GNO_OK;
        }
        first += count;
    }
    return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "light %lu: the scene has %lu", (unsigned long)index, (unsigned long)first);
}
