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

/* As gnoi_frame_locate does it for one point, without a branch: what it finds depends on the point's largest coordinate. */
VECTOR_CLONES
static void locate_on_cube(const gnoi_frame *frame, const double (*restrict positions)[3], size_t count, gnoi_located *restrict located)
{
    const double x0 = frame->origin.x, y0 = frame->origin.y, z0 = frame->origin.z;
    for (size_t i = 0; i < count; i++) {
        const double x = positions[i][0] - x0, y = positions[i][1] - y0, z = positions[i][2] - z0;
        const double ax = fabs(x), ay = fabs(y), az = fabs(z), yz = ay >= az ? ay : az;
        const int on_x = ax >= yz, on_y = ay >= az;
        const double depth = on_x ? ax : yz, along = on_x ? x : on_y ? y : z;
        const double across = on_x ? y : on_y ? z : x, up = on_x ? z : on_y ? x : y;
        const double near = 1 / depth;
        const int face = (on_x ? 0 : on_y ? 2 : 4) + (along < 0), good = depth > 0;
        const float u = (float)(across * near + GNOI_FACE_STEP * face), v = (float)(up * near), far = (float)(1 / near);
        located[i].u = good ? u : 0;
        located[i].v = good ? v : 0;
        located[i].z = good ? far : 1;
        located[i].face = good ? face : GNOI_NO_FACE;
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
