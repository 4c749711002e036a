/* located.c -- see located.h. */
#include "shadow/located.h"
#include "base/pages.h"
#include "base/vector.h"

VECTOR_CLONES
static void locate_on_plane(const gnoi_frame *frame, const double (*restrict positions)[3], size_t count, gnoi_located *restrict located)
{
    const vec3 origin = frame->origin, a = frame->axis[0], b = frame->axis[1], c = frame->axis[2];
    const int parallel = frame->parallel;
    for (size_t i = 0; i < count; i++) {
        vec3 q = v3_sub(v3_from(positions[i]), origin);
        double x = v3_dot(q, a), y = v3_dot(q, b), z = v3_dot(q, c), k = parallel ? 1 : 1 / z;
        located[i].u = (float)(x * k);
        located[i].v = (float)(y * k);
        located[i].z = (float)z;
        located[i].face = parallel || z > 0 ? 0 : GNOI_NO_FACE;
    }
}

static void locate_on_cube(const gnoi_frame *frame, const double (*positions)[3], size_t count, gnoi_located *located)
{
    for (size_t i = 0; i < count; i++) {
        const vec3 p = v3_from(positions[i]);
        gnoi_lpoint l = {0, 0, 1};
        located[i].face = gnoi_frame_locate(frame, &p, 1, &l) ? gnoi_frame_face(frame, l.u) : GNOI_NO_FACE;
        located[i].u = (float)l.u;
        located[i].v = (float)l.v;
        located[i].z = (float)(1 / l.q);
    }
}

gnoi_located *gnoi_locate_vertices(const gno_scene *scene, const gnoi_frame *frame)
{
    const gnoi_prepared *prep = &scene->prepared;
    gnoi_located *located = gnoi_malloc(scene->context, prep->vertex_count, sizeof *located);
    if (located)
        gnoi_pages_ready(located, prep->vertex_count * sizeof *located);
    if (located && frame->faces == 1)
        locate_on_plane(frame, (const double(*)[3])prep->positions, prep->vertex_count, located);
    else if (located)
        locate_on_cube(frame, (const double(*)[3])prep->positions, prep->vertex_count, located);
    return located;
}
