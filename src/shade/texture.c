/* texture.c -- see texture.h. */
#include "shade/texture.h"
#include "project/filter.h"
#include <string.h>

static const gnoi_object *object_of(const gnoi_sight *sight)
{
    return &sight->scene->objects[sight->scene->polygon_object[sight->poly->source]];
}

static vec3 apply(const double m[12], vec3 p, double w)
{
    return v3(m[0] * p.x + m[1] * p.y + m[2] * p.z + w * m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + w * m[7],
              m[8] * p.x + m[9] * p.y + m[10] * p.z + w * m[11]);
}

static void store(vec3 v, double out[3])
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

/* A perspective view sees eye + ray/z: numerator eye z + ray and divisor z are linear over the picture. */
gno_footprint gnoi_sight_footprint(const gnoi_sight *sight, double x, double y)
{
    const gnoi_view *view = sight->view;
    const gnoi_screen_plane *nearness = sight->nearness;
    const double *m = object_of(sight)->to_local;
    double z = gnoi_plane_at(nearness, x, y);
    vec3 p = gnoi_view_point(view, x, y, z), dx = v3_scale(view->right, view->unit), dy = v3_scale(view->up, -view->unit);
    gno_footprint f;
    f.wx = f.wy = 0;
    if (view->orthographic) {
        dx = v3_mad(dx, view->forward, -nearness->fx);
        dy = v3_mad(dy, view->forward, -nearness->fy);
    } else {
        f.wx = nearness->fx / z;
        f.wy = nearness->fy / z;
        dx = v3_mad(v3_scale(dx, 1 / z), view->eye, f.wx);
        dy = v3_mad(v3_scale(dy, 1 / z), view->eye, f.wy);
    }
    store(apply(m, p, 1), f.point);
    store(apply(m, dx, f.wx), f.dx);
    store(apply(m, dy, f.wy), f.dy);
    return f;
}

static int has_coordinates(const gnoi_sight *sight)
{
    const uint32_t *texcoord = sight->scene->prepared.corner_texcoord;
    for (uint32_t i = 0; texcoord && i < sight->poly->corner_count; i++)
        if (texcoord[sight->poly->corner + i] == GNOI_NONE)
            return 0;
    return texcoord != NULL;
}

static void start(gnoi_mapping *mapping, const gnoi_sight *sight, const gno_texture *texture)
{
    const double *to_local = object_of(sight)->to_local;
    mapping->ready = 1;
    mapping->on_corners = texture->map == GNO_MAP_UV && has_coordinates(sight);
    mapping->triangle = GNOI_NONE;
    if (texture->map == GNO_MAP_UV && !mapping->on_corners)
        mapping->place = gnoi_place_plain(texture, to_local, sight->poly->n);
    else
        mapping->place = gnoi_place_make(texture, to_local);
    if (mapping->place.map == GNO_MAP_PLANAR)
        mapping->pattern = gnoi_pattern_planar(&mapping->place, sight->view, sight->nearness);
}

static void set_triangle(gnoi_mapping *mapping, const gnoi_sight *sight)
{
    const gnoi_prepared *prep = &sight->scene->prepared;
    const gnoi_interp *interp = sight->interp;
    const double *coordinate[3];
    for (int i = 0; i < 3; i++)
        coordinate[i] = sight->scene->texcoords[prep->corner_texcoord[interp->corner[i]]];
    mapping->triangle = interp->triangle;
    mapping->pattern = gnoi_pattern_uv(&mapping->place, interp->weight, coordinate);
}

const gnoi_pattern *gnoi_mapping_seek(gnoi_mapping *mapping, const gnoi_sight *sight, const gno_texture *texture, double x, double y)
{
    if (!mapping->ready)
        start(mapping, sight, texture);
    if (mapping->on_corners) {
        gnoi_interp_seek(sight->interp, sight->scene, sight->view, sight->poly, x, y);
        if (mapping->triangle != sight->interp->triangle)
            set_triangle(mapping, sight);
    } else if (mapping->place.map != GNO_MAP_PLANAR) {
        mapping->pattern = gnoi_pattern_round(&mapping->place, sight->view, sight->nearness, x, y);
    }
    return &mapping->pattern;
}

void gnoi_texture_at(const gnoi_sight *sight, const gno_texture *texture, gnoi_mapping *mapping, double x, double y, double xs,
                     double ys, float rgba[4])
{
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = 1;
    if (texture->kind == GNO_TEXTURE_PROCEDURAL) {
        /* A pixel whose centre looks past the plane's horizon is taken about the point it sees. */
        int past = !sight->view->orthographic && !(gnoi_plane_at(sight->nearness, x, y) > 0);
        gno_footprint footprint = gnoi_sight_footprint(sight, past ? xs : x, past ? ys : y);
        double rgb[3];
        gno_procedural_colour(&texture->procedural, &footprint, rgb);
        for (int k = 0; k < 3; k++)
            rgba[k] = (float)rgb[k];
    } else if (texture->kind == GNO_TEXTURE_IMAGE) {
        const gnoi_pattern *pattern = gnoi_mapping_seek(mapping, sight, texture, xs, ys);
        gnoi_filter_pixel(&sight->scene->images[texture->image], texture, pattern, x, y, xs, ys, rgba);
        for (int k = 0; k < 3 && rgba[3] < 1; k++)
            rgba[k] = rgba[3] > 0 ? rgba[k] / rgba[3] : 0;
    }
}

void gnoi_texture_ask(const gnoi_sight *sight, const gno_texture *texture, gnoi_mapping *mapping, double x, double y, double xs,
                      double ys, gnoi_looks *looks, float rgba[4])
{
    const gnoi_pattern *pattern = gnoi_mapping_seek(mapping, sight, texture, xs, ys);
    gnoi_looks_ask(looks, &sight->scene->images[texture->image], texture, pattern, x, y, 1, &xs, &ys, (float(*)[4])rgba);
}
