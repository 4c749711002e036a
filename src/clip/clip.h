/* clip.h -- clipping as the passes of the library call it: gno_clip without a message, on any thread.
 *
 * Place: clip; includes only the public header. Arguments and results as gno_clip's; MEMORY stands also for a wish to stop (context.h),
 * and what is wrong is for the caller to say.
 */
#ifndef GNOI_CLIP_CLIP_H
#define GNOI_CLIP_CLIP_H

#include <gnomon/gnomon_clip.h>

gno_status gnoi_clip(gno_clipper *clipper, gno_clip_op op, const gno_shape *subject, const gno_shape *clip, gno_shape *result);

#endif
