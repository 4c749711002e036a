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

typedef struct loop {
    gnoi_piece_fn body;
    void *user;
    gno_context *context;
    size_t before, pieces, total; /* pieces [before, before + pieces) of total */
    atomic_size_t next;
    atomic_int failure; /* a gno_status; the first one other than GNO_OK stays */
    pthread_mutex_t lock;
    pthread_cond_t done;
    int finished; /* threads beside the caller's, under the lock */
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
    if (atomic_load_explicit(&work->failure, memory_order_relaxed) != GNO_OK || gnoi_stopped(work->context)) {
        return 0;
    }
    piece = atomic_fetch_add_explicit(&work->next, 1, memory_order_relaxed);
    if (piece >= work->pieces) {
        return 0;
    }
    status = work->body(work->user, number, work->before + piece);
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
    pthread_mutex_lock(&self->work->lock);
    self->work->finished++;
    pthread_cond_signal(&self->work->done);
    pthread_mutex_unlock(&self->work->lock);
    return NULL;
}

/* Worker 0: as the others, and says between pieces how far the loop is. */
static void caller_main(gno_context *context, loop *work)
{
    while (run_piece(work, 0)) {
        size_t done = atomic_load_explicit(&work->next, memory_order_relaxed);
        gnoi_set_fraction(context, (double)(work->before + (done < work->pieces ? done : work->pieces)) / (double)work->total);
    }
}

/* The caller has nothing left to do, but still has to ask whether the others shall stop. */
static void wait_for_others(gno_context *context, loop *work, int started)
{
    pthread_mutex_lock(&work->lock);
    while (work->finished < started) {
        struct timespec until;
        clock_gettime(CLOCK_MONOTONIC, &until);
        until.tv_nsec += (long)(GNOI_POLL_SECONDS * 1e9);
        until.tv_sec += until.tv_nsec / 1000000000;
        until.tv_nsec %= 1000000000;
        if (pthread_cond_timedwait(&work->done, &work->lock, &until) != 0) {
            pthread_mutex_unlock(&work->lock); /* the callback may take its time */
            gnoi_stopped(context);
            pthread_mutex_lock(&work->lock);
        }
    }
    pthread_mutex_unlock(&work->lock);
}

static int prepare_waiting(loop *work)
{
    pthread_condattr_t how;
    int good = pthread_condattr_init(&how) == 0;
    if (!good) {
        return 0;
    }
    good = pthread_condattr_setclock(&how, CLOCK_MONOTONIC) == 0 && pthread_cond_init(&work->done, &how) == 0;
    pthread_condattr_destroy(&how);
    if (good && pthread_mutex_init(&work->lock, NULL) != 0) {
        pthread_cond_destroy(&work->done);
        good = 0;
    }
    return good;
}

/* Starts as many as can be; returns how many. */
static int start_workers(loop *work, int threads, worker *workers)
{
    int started = 0;
    for (int number = 1; number < threads; number++) {
        workers[started].work = work;
        workers[started].number = number;
        if (pthread_create(&workers[started].thread, NULL, worker_main, &workers[started]) != 0) {
            break; /* the threads there are do the work */
        }
        started++;
    }
    return started;
}

gno_status gnoi_parallel(gno_context *context, int threads, size_t pieces, const char *stage, gnoi_piece_fn body, void *user)
{
    return gnoi_parallel_part(context, threads, 0, pieces, pieces, stage, body, user);
}

gno_status gnoi_parallel_part(gno_context *context, int threads, size_t first, size_t pieces, size_t total, const char *stage,
                              gnoi_piece_fn body, void *user)
{
    worker workers[GNO_MAX_THREADS];
    loop work;
    int started, waits;
    gno_status status = gnoi_progress(context, stage, total > 0 ? (double)first / (double)total : 0);
    if (status != GNO_OK) {
        return status;
    }
    threads = gnoi_thread_count(threads);
    if ((size_t)threads > pieces) {
        threads = (int)pieces;
    }
    work.body = body;
    work.user = user;
    work.context = context;
    work.before = first;
    work.pieces = pieces;
    work.total = total;
    work.finished = 0;
    atomic_init(&work.next, 0);
    atomic_init(&work.failure, GNO_OK);
    waits = threads > 1 && prepare_waiting(&work);
    started = waits ? start_workers(&work, threads, workers) : 0;
    caller_main(context, &work);
    if (waits) {
        wait_for_others(context, &work, started);
        while (started > 0) {
            pthread_join(workers[--started].thread, NULL);
        }
        pthread_mutex_destroy(&work.lock);
        pthread_cond_destroy(&work.done);
    }
    status = gnoi_stopped(context) ? GNO_ERROR_CANCELLED : (gno_status)atomic_load(&work.failure);
    /* Workers must not write the message. */
    return status == GNO_OK ? status : gnoi_fail(context, status, "%s: %s", stage, gno_status_text(status));
}
