/* job.h -- what every engine needs of a picture before its tiles are made.
 *
 * Place in the data flow: scene + camera -> prepared polygons, view, lamps, materials -> engine (scanline.c, weiler_atherton.c).
 */
#ifndef GNOI_ENGINE_JOB_H
#define GNOI_ENGINE_JOB_H

#include "engine/tile.h"
#include <gnomon/gnomon_pieces.h>

/* Fills `frame` but for rgb, and the stages' seconds in `stats`. Free in any case. */
gno_status gnoi_frame_job_make(gno_scene *scene, const gno_render_def *def, gnoi_frame_job *frame, gno_stats *stats);
void gnoi_frame_job_free(gnoi_frame_job *frame);

/* weiler_atherton.c: paints what the camera sees as pieces (gno_visible_pieces) into frame->rgb. */
gno_status gnoi_paint_visible(gno_scene *scene, gnoi_frame_job *frame, gno_stats *stats);

/* weiler_atherton.c: the mean colour of each piece, 3 values each, as it appears in the picture; zeros for one that covers nothing. */
gno_status gnoi_paint_means(gnoi_frame_job *frame, const gno_pieces *pieces, double *means);

#endif
