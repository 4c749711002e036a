/* chunks.c -- see chunks.h. */
#include "scene/chunks.h"
#include "base/parallel.h"

typedef struct passing {
    const gnoi_prepared *prep;
    gnoi_run_fn body;
    void *user;
} passing;

/* The place in prep->seams of the first seam from polygon `i` on. */
static size_t first_seam(const gnoi_prepared *prep, size_t i)
{
    size_t low = 0, high = prep->seam_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (prep->seams[middle] < i)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static gno_status pass_chunk(void *user, int worker, size_t chunk)
{
    const passing *p = user;
    const gnoi_prepared *prep = p->prep;
    size_t from = chunk * GNOI_CHUNK, end = from + GNOI_CHUNK < prep->poly_count ? from + GNOI_CHUNK : prep->poly_count;
    (void)worker;
    for (size_t s = first_seam(prep, from); s < prep->seam_count && prep->seams[s] < end; s++) {
        if (prep->seams[s] > from)
            p->body(p->user, from, prep->seams[s]);
        from = prep->seams[s] + 1;
    }
    if (from < end)
        p->body(p->user, from, end);
    return GNO_OK;
}

gno_status gnoi_over_polygons(gno_context *context, const gnoi_prepared *prep, int threads, gnoi_run_fn body, void *user)
{
    passing p = {prep, body, user};
    gno_status status = gnoi_parallel(context, threads, prep->chunk_count, "prepare", pass_chunk, &p);
    for (size_t s = 0; s < prep->seam_count && !status; s++) {
        body(user, prep->seams[s], (size_t)prep->seams[s] + 1);
        if (gnoi_stopped_at(context, s))
            status = GNO_ERROR_CANCELLED;
    }
    return status;
}
