/* move_scene.c -- a scene copied through the getters, magnified and moved: see random_scene.h. */
#include "support/random_scene.h"

#include <math.h>
#include <stddef.h>

static int copy_polygon(gno_scene *to, const gno_polygon *p, double scale, const double offset[3], double grid)
{
    double positions[256][3];
    unsigned ring_start[64], first = p->ring_start[0], polygon_start[2] = {0, 0};
    int order[256], own_normal[256];
    gno_mesh_def d = gno_mesh_def_default();
    size_t corners = p->ring_start[p->ring_count] - first, normal_count = 0;
    if (corners > 256 || p->ring_count > 63) return 0;
    for (unsigned r = 0; r <= p->ring_count; r++) ring_start[r] = p->ring_start[r] - first;
    for (unsigned i = 0; i < corners; i++) {
        for (int k = 0; k < 3; k++) {
            double x = scale * p->positions[3 * (size_t)p->corner_vertex[first + i] + (size_t)k] + offset[k];
            positions[i][k] = grid > 0 ? grid * floor(x / grid + 0.5) : x;
        }
        order[i] = (int)i;
        own_normal[i] = p->corner_normal ? p->corner_normal[first + i] : -1;
        if (own_normal[i] >= (int)normal_count) normal_count = (size_t)own_normal[i] + 1;
    }
    polygon_start[1] = (unsigned)p->ring_count;
    d.vertex_count = d.corner_count = corners;
    d.positions = positions[0];
    d.normal_count = normal_count;
    d.normals = normal_count ? p->normals : NULL;
    d.corner_normal = normal_count ? own_normal : NULL;
    d.corner_vertex = order;
    d.polygon_count = 1;
    d.polygon_start = polygon_start;
    d.ring_count = p->ring_count;
    d.ring_start = ring_start;
    d.material = p->material;
    d.shading = p->shading;
    d.priority = p->priority;
    d.detail_of = p->detail_of;
    return gno_scene_add_mesh(to, &d, NULL) == GNO_OK;
}

/* The light as it was, seen at the new size: intensities follow the distances they fall off with. */
static int copy_light(gno_scene *to, gno_light l, double scale, const double offset[3])
{
    int falls = l.type != GNO_LIGHT_DIRECTIONAL || (l.falloff == GNO_FALLOFF_LINEAR && l.distance_from_viewer);
    for (int k = 0; k < 3; k++) {
        l.position[k] = scale * l.position[k] + offset[k];
        l.edge1[k] *= scale;
        l.edge2[k] *= scale;
        if (falls && l.falloff == GNO_FALLOFF_LINEAR) l.intensity[k] *= scale;
        if (falls && l.falloff == GNO_FALLOFF_INVERSE_SQUARE) l.intensity[k] *= scale * scale;
    }
    l.falloff_k *= scale;
    return gno_scene_add_light(to, NULL, &l, NULL) == GNO_OK;
}

gno_scene *move_scene(gno_scene *from, double scale, const double offset[3], double grid)
{
    gno_scene *to = NULL;
    gno_scene_counts counts = gno_scene_count(from);
    gno_camera camera = gno_scene_camera(from);
    gno_image_def image = gno_scene_image(from);
    double ambient[3];
    gno_scene_ambient(from, ambient);
    for (int k = 0; k < 3; k++) {
        camera.eye[k] = scale * camera.eye[k] + offset[k];
        camera.target[k] = scale * camera.target[k] + offset[k];
    }
    camera.height *= scale;
    int ok = gno_scene_create(gno_scene_context(from), &to) == GNO_OK && gno_scene_set_camera(to, &camera) == GNO_OK &&
             gno_scene_set_image(to, &image) == GNO_OK && gno_scene_set_ambient(to, ambient) == GNO_OK;
    for (size_t i = 1; i < counts.materials && ok; i++) { /* material 0 is in every scene */
        gno_material m;
        ok = gno_scene_material(from, (int)i, &m) == GNO_OK && gno_scene_add_material(to, &m, NULL) == GNO_OK;
    }
    for (size_t i = 0; i < counts.lights && ok; i++) {
        gno_light l;
        ok = gno_scene_light(from, (int)i, &l, NULL) == GNO_OK && copy_light(to, l, scale, offset);
    }
    for (size_t i = 0; i < counts.polygons && ok; i++) {
        gno_polygon p;
        ok = gno_scene_polygon(from, i, &p) == GNO_OK && copy_polygon(to, &p, scale, offset, grid);
    }
    if (ok) return to;
    gno_scene_destroy(to);
    return NULL;
}
