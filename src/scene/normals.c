/* normals.c -- vertex normals of smooth polygons.
 *
 * Place in the data flow: emit.c -> here, average.c -> details.c; shading interpolates what is made here.
 * A corner takes the file's normal where it has one (and its object does not insist on averages). The others take averages.
 * Where neither gives a direction the corner takes its own plane's normal.
 * Invariants: every normal that a corner names is a unit vector; until a corner is settled, corner_normal holds GNOI_NONE or, where the
 * file's normal is zero, GNOI_ZERO_NORMAL.
 */
#include "base/parallel.h"
#include "scene/average.h"

#define PIECE 16384 /* normals */

/* Unit vector of a normal of any length but zero. */
static vec3 unit_of(const double n[3])
{
    double largest = fmax(fabs(n[0]), fmax(fabs(n[1]), fabs(n[2])));
    return v3_unit(v3(n[0] / largest, n[1] / largest, n[2] / largest)); /* squares neither overflow nor vanish */
}

static gno_status unit_piece(void *user, int worker, size_t piece)
{
    const gnoi_preparing *w = user;
    gnoi_prepared *out = w->out;
    size_t end = (piece + 1) * PIECE < out->normal_count ? (piece + 1) * PIECE : out->normal_count;
    (void)worker;
    for (size_t i = piece * PIECE; i < end; i++) {
        vec3 n = unit_of(w->scene->normals[w->normal_source[i]]);
        out->normals[i][0] = (float)n.x;
        out->normals[i][1] = (float)n.y;
        out->normals[i][2] = (float)n.z;
    }
    return GNO_OK;
}

/* One more normal, the polygon's own. */
static int store_plane(gnoi_preparing *w, const gnoi_poly *poly)
{
    gnoi_prepared *out = w->out;
    void *array = out->normals;
    if (!gnoi_reserve(w->scene->context, &array, &out->normal_capacity, out->normal_count + 1, sizeof *out->normals))
        return 0;
    out->normals = array;
    for (int k = 0; k < 3; k++)
        out->normals[out->normal_count][k] = (float)poly->n[k];
    out->normal_count++;
    return 1;
}

static gno_status settle_zeros(gnoi_preparing *w)
{
    gnoi_prepared *out = w->out;
    for (size_t i = 0; i < out->poly_count; i++) {
        const gnoi_poly *poly = &out->polys[i];
        uint32_t own = GNOI_NONE;
        for (uint32_t k = poly->corner; k < poly->corner + poly->corner_count; k++) {
            if (out->corner_normal[k] != GNOI_ZERO_NORMAL)
                continue;
            if (own == GNOI_NONE && !store_plane(w, poly))
                return GNO_ERROR_MEMORY;
            own = own == GNOI_NONE ? (uint32_t)(out->normal_count - 1) : own;
            out->corner_normal[k] = own;
        }
        if (gnoi_stopped_at(w->scene->context, i))
            return GNO_ERROR_CANCELLED;
    }
    return GNO_OK;
}

gno_status gnoi_prepare_normals(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    gnoi_prepared *out = w->out;
    int open = 0;
    gno_status status;
    out->normals = gnoi_malloc(context, out->normal_count, sizeof *out->normals);
    if (!out->normals)
        return GNO_ERROR_MEMORY;
    out->normal_capacity = out->normal_count > 0 ? out->normal_count : 1; /* a block of no elements has one */
    status = gnoi_parallel(context, w->threads, (out->normal_count + PIECE - 1) / PIECE, "prepare", unit_piece, w);
    for (size_t k = 0; k < w->chunk_count; k++)
        open |= w->chunks[k].open;
    if (status == GNO_OK && open)
        status = gnoi_average_normals(w);
    return status == GNO_OK && w->zero_normals ? settle_zeros(w) : status;
}
