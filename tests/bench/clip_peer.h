/* clip_peer.h -- Clipper 6 or Clipper2 (C++) behind a C call, for clip_speed.c. */
#ifndef BENCH_CLIP_PEER_H
#define BENCH_CLIP_PEER_H

#include <gnomon/gnomon_clip.h>

#ifdef __cplusplus
extern "C" {
#endif

extern const char *const peer_name;

/* Area of the difference or union of two shapes of simple counter-clockwise rings, one per polygon. Coordinates are multiplied by
 * `scale` and rounded to integers; only the clipping itself is timed: its seconds are added to *seconds. */
double peer_clip(gno_clip_op op, const gno_shape *subject, const gno_shape *clip, double scale, double *seconds);

#ifdef __cplusplus
}
#endif

#endif
