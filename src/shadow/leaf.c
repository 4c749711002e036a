/* leaf.c -- see leaf.h. */
#include "shadow/leaf.h"

static void clear(gnoi_leaf *leaf)
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < GNOI_EIGHT; k++)
            leaf->u[i][k] = leaf->v[i][k] = leaf->q[i][k] = NAN;
}

/* 0 for what is no triangle on one face. */
static int locate(const gno_scene *scene, const gnoi_frame *frame, uint32_t index, gnoi_lpoint l[3])
{
    const gnoi_prepared *prep = &scene->prepared;
    vec3 p[3];
    if (index == GNOI_NONE || prep->polys[index].corner_count != 3)
        return 0;
    for (uint32_t i = 0; i < 3; i++)
        p[i] = v3_from(prep->positions[prep->corner_vertex[prep->polys[index].corner + i]]);
    return gnoi_frame_locate(frame, p, 3, l);
}

void gnoi_leaf_set(const gno_scene *scene, const gnoi_frame *frame, const uint32_t *polys, size_t count, gnoi_leaf *leaf)
{
    int placed = 0;
    clear(leaf);
    for (size_t k = 0; k < count; k++) {
        gnoi_lpoint l[3];
        if (!locate(scene, frame, polys[k], l))
            continue;
        if (!placed)
            leaf->origin = l[0];
        placed = 1;
        for (int i = 0; i < 3; i++) {
            leaf->u[i][k] = (float)(l[i].u - leaf->origin.u);
            leaf->v[i][k] = (float)(l[i].v - leaf->origin.v);
            leaf->q[i][k] = (float)(l[i].q - leaf->origin.q);
        }
    }
    if (!placed)
        leaf->origin.u = leaf->origin.v = leaf->origin.q = 0;
}

/* Edges first, one comparison for all eight at a time. */
unsigned gnoi_leaf_mask(const gnoi_leaf *leaf, const gnoi_probe *probe)
{
    int32_t out[GNOI_EIGHT], behind[GNOI_EIGHT];
    float qa = (float)probe->qa, qb = (float)probe->qb;
    float qc = (float)(probe->qc + probe->qa * leaf->origin.u + probe->qb * leaf->origin.v - leaf->origin.q);
    unsigned mask = 0;
    for (int k = 0; k < GNOI_EIGHT; k++) {
        behind[k] = (leaf->q[0][k] <= qa * leaf->u[0][k] + qb * leaf->v[0][k] + qc) &
                    (leaf->q[1][k] <= qa * leaf->u[1][k] + qb * leaf->v[1][k] + qc) &
                    (leaf->q[2][k] <= qa * leaf->u[2][k] + qb * leaf->v[2][k] + qc);
    }
    for (int e = 0; e < probe->edge_count; e++) {
        float a = (float)probe->a[e], b = (float)probe->b[e];
        float limit = (float)(probe->slack[e] - (probe->c[e] + probe->a[e] * leaf->origin.u + probe->b[e] * leaf->origin.v));
        for (int k = 0; k < GNOI_EIGHT; k++)
            out[k] = (a * leaf->u[0][k] + b * leaf->v[0][k] <= limit) & (a * leaf->u[1][k] + b * leaf->v[1][k] <= limit) &
                     (a * leaf->u[2][k] + b * leaf->v[2][k] <= limit);
        for (int k = 0; k < GNOI_EIGHT; k++)
            behind[k] |= out[k];
    }
    for (int k = 0; k < GNOI_EIGHT; k++)
        mask |= (unsigned)!behind[k] << k;
    return mask;
}

int gnoi_leaf_rules_out(const gnoi_leaf *leaf, unsigned k, const gnoi_probe *probe)
{
    const float(*u)[GNOI_EIGHT] = leaf->u, (*v)[GNOI_EIGHT] = leaf->v, (*q)[GNOI_EIGHT] = leaf->q;
    float qa = (float)probe->qa, qb = (float)probe->qb;
    float qc = (float)(probe->qc + probe->qa * leaf->origin.u + probe->qb * leaf->origin.v - leaf->origin.q);
    if (q[0][k] <= qa * u[0][k] + qb * v[0][k] + qc && q[1][k] <= qa * u[1][k] + qb * v[1][k] + qc && q[2][k] <= qa * u[2][k] + qb * v[2][k] + qc)
        return 1;
    for (int e = 0; e < probe->edge_count; e++) {
        float a = (float)probe->a[e], b = (float)probe->b[e];
        float limit = (float)(probe->slack[e] - (probe->c[e] + probe->a[e] * leaf->origin.u + probe->b[e] * leaf->origin.v));
        if (a * u[0][k] + b * v[0][k] <= limit && a * u[1][k] + b * v[1][k] <= limit && a * u[2][k] + b * v[2][k] <= limit)
            return 1;
    }
    return 0;
}
