/* picture_of.c -- pieces as the picture shows them: where their points appear and what colour they have on the whole.
 *
 * Place in the data flow: pieces (gnomon_pieces.h) + camera -> picture coordinates, mean colours -> drawings (libgnomon-io).
 */
#include "engine/job.h"
#include "scan/piece_bins.h"
#include <string.h>

gno_status gno_project_points(const gno_scene *scene, size_t count, const double *points, double *picture)
{
    gnoi_view view;
    if (!scene)
        return GNO_ERROR_ARGUMENT;
    if (count > 0 && (!points || !picture))
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_project_points: no points, or no room for them");
    view = gnoi_view_make(&scene->camera, &scene->image, 1);
    for (size_t i = 0; i < count; i++) {
        vec3 p = v3_from(points + 3 * i);
        picture[3 * i] = gnoi_form_at(&view.x, p);
        picture[3 * i + 1] = gnoi_form_at(&view.y, p);
        picture[3 * i + 2] = gnoi_form_at(&view.w, p);
    }
    return GNO_OK;
}

gno_status gno_pieces_colours(gno_scene *scene, const gno_pieces *pieces, int threads, double *rgb)
{
    gno_render_def def = gno_render_def_default();
    gno_stats stats;
    gnoi_frame_job frame;
    gno_status status;
    if (!scene)
        return GNO_ERROR_ARGUMENT;
    if (!pieces || (!rgb && gno_pieces_count(pieces) > 0))
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_pieces_colours: no pieces, or no room for their colours");
    if (threads < 0 || threads > GNO_MAX_THREADS)
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "threads: %d is not between 0 and %d", threads, GNO_MAX_THREADS);
    gnoi_begin(scene->context, "colours of pieces");
    memset(&stats, 0, sizeof stats);
    def.threads = threads;
    status = gnoi_frame_job_make(scene, &def, &frame, &stats);
    if (!status && !gnoi_pieces_fit(scene, pieces))
        status = gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_pieces_colours: the pieces are not of this scene");
    if (!status)
        status = gnoi_paint_means(&frame, pieces, rgb);
    gnoi_frame_job_free(&frame);
    return status == GNO_ERROR_MEMORY ? gnoi_fail(scene->context, status, "out of memory for colours of pieces") : status;
}
