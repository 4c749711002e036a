/* parallel.h -- loops over independent pieces of work on POSIX threads.
 *
 * Place: base. Pieces are handed out in order from one counter; results must not depend on which worker ran them.
 */
#ifndef GNOI_BASE_PARALLEL_H
#define GNOI_BASE_PARALLEL_H

#include "base/context.h"

/* Number of workers for a request of `threads` (0: one per online processor), at least 1, at most GNO_MAX_THREADS. */
int gnoi_thread_count(int threads);

/* body(user, worker, piece) for every piece in [0,pieces); worker is in [0,threads). body returns a status; the first
 * failure stops the handing out and is returned (which failure, when several fail at once, is not defined).
 * Worker 0 runs on the calling thread, which also reports progress as stage; threads that cannot be started are done without. */
typedef gno_status (*gnoi_piece_fn)(void *user, int worker, size_t piece);
gno_status gnoi_parallel(gno_context *context, int threads, size_t pieces, const char *stage, gnoi_piece_fn body, void *user);

/* The same for the pieces [first, first + pieces) of a whole of `total`, as which progress counts them. */
gno_status gnoi_parallel_part(gno_context *context, int threads, size_t first, size_t pieces, size_t total, const char *stage,
                              gnoi_piece_fn body, void *user);

#endif
