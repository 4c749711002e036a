/* parallel.c -- loops over independent pieces of work on POSIX threads.
 *
 * Place: base; every pass that can be cut into pieces runs through gnoi_parallel.
 * Invariants: a piece is handed out at most once, in order; after the first failure no further piece is handed out;
 * every thread started is joined before the call returns. The caller is worker 0, so that callbacks run on its thread.
 * Threads live for one call: starting one costs some 20 microseconds, which a pool with its idle state would not repay.
 */
#include "base/parallel.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#define PROGRESS_SECONDS 0.02 /* often enough for a smooth bar and a prompt stop, rare enough to cost nothing */

typedef struct loop {
    gnoi_piece_fn body;
    void *user;
    size_t pieces;
    atomic_size_t next;
    atomic_int failure; /* a gno_status; the first one other than GNO_OK stays */
} loop;

typedef struct worker {
    loop *work;
    int number;
    pthread_t thread;
} worker;

int gnoi_thread_count(int threads)
{
    if (threads <= 0) {
        long online = sysconf(_SC_NPROCESSORS_ONLN);
        threads = online < 1 ? 1 : online > GNO_MAX_THREADS ? GNO_MAX_THREADS : (int)online;
    }
    return threads > GNO_MAX_THREADS ? GNO_MAX_THREADS : threads;
}

static void stop(loop *work, gno_status failure)
{
    int none = GNO_OK;
    atomic_compare_exchange_strong(&work->failure, &none, (int)failure);
}

/* Runs the next piece; 0 when there is none left or the loop has failed. */
static int run_piece(loop *work, int number)
{
    size_t piece;
    gno_status status;
    if (atomic_load_explicit(&work->failure, memory_order_relaxed) != GNO_OK) {
        return 0;
    }
    piece = atomic_fetch_add_explicit(&work->next, 1, memory_order_relaxed);
    if (piece >= work->pieces) {
        return 0;
    }
    status = work->body(work->user, number, piece);
    if (status != GNO_OK) {
        stop(work, status);
    }
    return status == GNO_OK;
}

static void *worker_main(void *argument)
{
    worker *self = argument;
    while (run_piece(self->work, self->number)) {
    }
    return NULL;
}

/* Worker 0: as the others, with a look at the clock between pieces. */
static void caller_main(gno_context *context, loop *work, const char *stage)
{
    double last = gnoi_now();
    while (run_piece(work, 0)) {
        double now = gnoi_now();
        if (now - last >= PROGRESS_SECONDS) {
            size_t done = atomic_load_explicit(&work->next, memory_order_relaxed);
            double fraction = (double)(done < work->pieces ? done : work->pieces) / (double)work->pieces;
            last = now;
            if (gnoi_progress(context, stage, fraction) != GNO_OK) {
                stop(work, GNO_ERROR_CANCELLED);
            }
        }
    }
}

gno_status gnoi_parallel(gno_context *context, int threads, size_t pieces, const char *stage, gnoi_piece_fn body, void *user)
{
    worker workers[GNO_MAX_THREADS];
    loop work;
    int started = 0, number;
    gno_status status;
    threads = gnoi_thread_count(threads);
    if ((size_t)threads > pieces) {
        threads = (int)pieces;
    }
    work.body = body;
    work.user = user;
    work.pieces = pieces;
    atomic_init(&work.next, 0);
    atomic_init(&work.failure, GNO_OK);
    for (number = 1; number < threads; number++) {
        workers[started].work = &work;
        workers[started].number = number;
        if (pthread_create(&workers[started].thread, NULL, worker_main, &workers[started]) != 0) {
            break; /* the threads there are do the work */
        }
        started++;
    }
    caller_main(context, &work, stage);
    while (started > 0) {
        pthread_join(workers[--started].thread, NULL);
    }
    status = (gno_status)atomic_load(&work.failure);
    if (status != GNO_OK && status != GNO_ERROR_CANCELLED) {
        gnoi_fail(context, status, "%s: %s", stage, gno_status_text(status)); /* workers must not write the message */
    }
    return status;
}
