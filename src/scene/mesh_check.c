/* mesh_check.c -- see mesh_check.h. */
#include "scene/mesh_check.h"

#include <string.h>

/* ---- messages -------------------------------------------------------------------------------------------------- */

static void append(char *label, size_t *length, const char *text)
{
    while (*text && *length + 1 < GNOI_LABEL_SIZE) {
        label[(*length)++] = *text++;
    }
    label[*length] = '\0';
}

void gnoi_label_mesh(gnoi_adding *a)
{
    size_t length = 0, number = a->scene->object_count;
    char digits[24];
    size_t at = sizeof digits - 1;
    append(a->label, &length, "mesh ");
    if (a->mesh->name) {
        append(a->label, &length, "'");
        append(a->label, &length, a->mesh->name);
        append(a->label, &length, "'");
        return;
    }
    digits[at] = '\0';
    do {
        digits[--at] = (char)('0' + number % 10);
        number /= 10;
    } while (number);
    append(a->label, &length, digits + at);
}

/* ---- checks of counts and options ------------------------------------------------------------------------------- */

static gno_status check_limit(const gnoi_adding *a, const char *what, size_t there, size_t more, size_t limit)
{
    if (more <= limit && there <= limit - more) {
        return GNO_OK;
    }
    return gnoi_fail(a->context, GNO_ERROR_LIMIT, "%s: %zu %s, with %zu in the scene, exceed the limit of %zu", a->label, more,
                     what, there, limit);
}

static gno_status check_limits(const gnoi_adding *a)
{
    const gno_scene *s = a->scene;
    const gno_mesh_def *m = a->mesh;
    gno_status status = check_limit(a, "vertices", s->vertex_count, m->vertex_count, GNO_MAX_POLYGONS);
    if (status == GNO_OK) {
        status = check_limit(a, "polygons", s->polygon_count, m->polygon_count, GNO_MAX_POLYGONS);
    }
    if (status == GNO_OK) {
        status = check_limit(a, "rings", s->ring_count, m->ring_count, GNO_MAX_CORNERS);
    }
    if (status == GNO_OK) {
        status = check_limit(a, "corners", s->corner_count, m->corner_count, GNO_MAX_CORNERS);
    }
    if (status == GNO_OK) {
        status = check_limit(a, "normals", s->normal_count, m->normal_count, GNO_MAX_CORNERS);
    }
    if (status == GNO_OK) {
        status = check_limit(a, "texture coordinates", s->texcoord_count, m->texcoord_count, GNO_MAX_CORNERS);
    }
    if (status == GNO_OK) {
        status = check_limit(a, "object", s->object_count, 1, GNO_MAX_POLYGONS);
    }
    return status;
}

/* Before anything is read by these counts: a wrong one is found where it does no harm. */
static gno_status check_ends(const gnoi_adding *a, const char *what, const unsigned *offsets, size_t count, size_t total)
{
    if (offsets && (offsets[0] != 0 || offsets[count] != total)) {
        return gnoi_fail(a->context, GNO_ERROR_ARGUMENT, "%s: %s runs from %u to %u, not from 0 to %zu", a->label, what, offsets[0],
                         offsets[count], total);
    }
    return GNO_OK;
}

static gno_status check_arrays(const gnoi_adding *a)
{
    const gno_mesh_def *m = a->mesh;
    const char *missing = NULL;
    if (!m->positions && m->vertex_count) {
        missing = "positions";
    } else if (!m->normals && m->normal_count) {
        missing = "normals";
    } else if (!m->texcoords && m->texcoord_count) {
        missing = "texcoords";
    } else if (!m->corner_vertex && m->corner_count) {
        missing = "corner_vertex";
    }
    if (missing) {
        return gnoi_fail(a->context, GNO_ERROR_ARGUMENT, "%s: %s is NULL but its count is not 0", a->label, missing);
    }
    if (!m->polygon_start && m->ring_count != m->polygon_count) {
        return gnoi_fail(a->context, GNO_ERROR_ARGUMENT, "%s: %zu rings for %zu polygons, and no polygon_start", a->label,
                         m->ring_count, m->polygon_count);
    }
    if (!m->ring_start && (m->corner_count % 3 != 0 || m->corner_count / 3 != m->ring_count)) {
        return gnoi_fail(a->context, GNO_ERROR_ARGUMENT, "%s: %zu corners for %zu triangles (no ring_start)", a->label,
                         m->corner_count, m->ring_count);
    }
    const gno_status status = check_ends(a, "polygon_start", m->polygon_start, m->polygon_count, m->ring_count);
    return status == GNO_OK ? check_ends(a, "ring_start", m->ring_start, m->ring_count, m->corner_count) : status;
}

static gno_status check_options(const gnoi_adding *a)
{
    const gno_mesh_def *m = a->mesh;
    const char *key = NULL;
    double value = 0;
    int i;
    if (m->shading < -1 || m->shading > GNO_SHADING_PHONG) {
        key = "shading", value = m->shading;
    } else if ((unsigned)m->weighting > GNO_WEIGHTING_EQUAL) {
        key = "weighting", value = (double)m->weighting;
    } else if (!(m->crease >= 0 && m->crease <= 180)) {
        key = "crease", value = m->crease;
    } else if (m->priority < INT16_MIN || m->priority > INT16_MAX) {
        key = "priority", value = m->priority;
    } else if (m->material < 0 || (size_t)m->material >= a->scene->material_count) {
        key = "material", value = m->material;
    }
    for (i = 0; i < 12 && !key; i++) {
        if (!(fabs(m->transform[i]) <= GNO_MAX_COORDINATE)) {
            key = "transform", value = m->transform[i];
        }
    }
    return key ? gnoi_fail(a->context, GNO_ERROR_ARGUMENT, "%s: %s %g is out of range", a->label, key, value) : GNO_OK;
}

gno_status gnoi_check_mesh(const gnoi_adding *a)
{
    gno_status status = check_limits(a);
    if (status == GNO_OK) {
        status = check_arrays(a);
    }
    return status == GNO_OK ? check_options(a) : status;
}
