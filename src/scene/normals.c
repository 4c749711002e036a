/* normals.c -- vertex normals of smooth polygons.
 *
 * Place in the data flow: emit.c -> here, average.c -> details.c; shading interpolates what is made here.
 * A corner takes the file's normal where it has one (and its object does not insist on averages). The others take averages.
 * Where neither gives a direction the corner takes its own plane's normal.
 * Invariants: every normal that a corner names is a unit vector; until a corner is settled, corner_normal holds GNOI_NONE or names a
 * normal of the file that is zero.
 */
#include "base/fetch.h"
#include "base/parallel.h"
#include "scene/average.h"

#define PIECE 16384 /* normals */
#define AHEAD 16    /* normals */

typedef struct storing {
    gnoi_preparing *w;
    unsigned char *zero; /* of pieces: some normal is zero */
} storing;

/* Unit vector of a normal of any length; zero stays zero. */
static vec3 unit_of(const double n[3])
{
    double largest = fmax(fabs(n[0]), fmax(fabs(n[1]), fabs(n[2])));
    if (largest > 1e-100 && largest < 1e100)
        return v3_unit(v3_from(n));
    return largest > 0 ? v3_unit(v3(n[0] / largest, n[1] / largest, n[2] / largest)) : v3(0, 0, 0); /* squares would overflow or vanish */
}

static gno_status unit_piece(void *user, int worker, size_t piece)
{
    const storing *s = user;
    gnoi_prepared *out = s->w->out;
    size_t end = (piece + 1) * PIECE < out->normal_count ? (piece + 1) * PIECE : out->normal_count;
    int zero = 0;
    (void)worker;
    for (size_t i = piece * PIECE; i < end; i++) {
        const uint32_t *source = s->w->normal_source;
        vec3 n;
        if (source && i + AHEAD < end)
            FETCH(s->w->scene->normals[source[i + AHEAD]]);
        n = unit_of(s->w->scene->normals[source ? source[i] : i]);
        out->normals[i][0] = (float)n.x;
        out->normals[i][1] = (float)n.y;
        out->normals[i][2] = (float)n.z;
        zero |= !(v3_dot(n, n) > 0);
    }
    s->zero[piece] = (unsigned char)zero;
    return GNO_OK;
}

/* Fills the file's normals; *zero: whether one of them is. */
static gno_status store_units(gnoi_preparing *w, int *zero)
{
    gno_context *context = w->scene->context;
    size_t pieces = (w->out->normal_count + PIECE - 1) / PIECE;
    storing s = {w, gnoi_calloc(context, pieces, 1)};
    gno_status status = GNO_ERROR_MEMORY;
    if (s.zero)
        status = gnoi_parallel(context, w->threads, pieces, "prepare", unit_piece, &s);
    for (size_t k = 0; s.zero && k < pieces; k++)
        *zero |= s.zero[k];
    gnoi_free(context, s.zero, pieces, 1);
    return status;
}

static int is_zero(const float n[3]) { return !(n[0] != 0 || n[1] != 0 || n[2] != 0); }

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
            if (out->corner_normal[k] == GNOI_NONE || !is_zero(out->normals[out->corner_normal[k]]))
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
    int open = 0, zero = 0;
    gno_status status;
    out->normals = gnoi_malloc(context, out->normal_count, sizeof *out->normals);
    if (!out->normals)
        return GNO_ERROR_MEMORY;
    out->normal_capacity = out->normal_count > 0 ? out->normal_count : 1; /* a block of no elements has one */
    status = store_units(w, &zero);
    for (size_t k = 0; k < w->chunk_count; k++)
        open |= w->chunks[k].open;
    if (status == GNO_OK && open)
        status = gnoi_average_normals(w);
    return status == GNO_OK && zero ? settle_zeros(w) : status;
}
