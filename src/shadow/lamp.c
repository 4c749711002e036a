/* lamp.c -- see lamp.h. */
#include "shadow/lamp.h"

#define PI 3.14159265358979323846

size_t gnoi_lamp_count(const gno_light *light)
{
    return light->type == GNO_LIGHT_AREA ? (size_t)light->samples * (size_t)light->samples : 1;
}

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
static void add_area(const gno_light *light, gnoi_lamp *lamps)
{
    int n = light->samples;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            gnoi_lamp lamp = lamp_from(light);
            lamp.position = v3_mad(lamp.position, v3_from(light->edge1), (i + 0.5) / n);
            lamp.position = v3_mad(lamp.position, v3_from(light->edge2), (j + 0.5) / n);
            for (int k = 0; k < 3; k++)
                lamp.intensity[k] /= (double)n * n;
            *lamps++ = lamp;
        }
}

void gnoi_lamps_of(const gno_light *light, gnoi_lamp *lamps)
{
    if (light->type == GNO_LIGHT_AREA)
        add_area(light, lamps);
    else
        *lamps = lamp_from(light);
}

size_t gnoi_lamps_count(const gno_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->light_count; i++)
        count += gnoi_lamp_count(&scene->lights[i].light);
    return count;
}

void gnoi_lamps_fill(const gno_scene *scene, gnoi_lamp *lamps)
{
    for (size_t i = 0; i < scene->light_count; i++) {
        const gno_light *light = &scene->lights[i].light;
        gnoi_lamps_of(light, lamps);
        lamps += gnoi_lamp_count(light);
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
        first += gnoi_lamp_count(&scene->lights[i].light);
    return first == light;
}
