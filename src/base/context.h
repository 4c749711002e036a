/* context.h -- allocator, account, messages and log behind gno_context.
 *
 * Place: the root of everything; includes only the public header. All memory of the library goes through
 * gnoi_realloc, so that the account is exact and every allocation can be made to fail in tests.
 */
#ifndef GNOI_BASE_CONTEXT_H
#define GNOI_BASE_CONTEXT_H

#include <gnomon/gnomon.h>
#include <stdarg.h>
#include <stdint.h>

/* Resizes a block of `count` elements of `size` bytes (old_count elements before); NULL block allocates, count 0 frees and
 * returns NULL. NULL on overflow or when the allocator fails; the old block is then still valid. Thread safe. */
void *gnoi_realloc(gno_context *context, void *block, size_t old_count, size_t count, size_t size);

/* Zeroed array; NULL on overflow or failure. count 0 gives a valid block of one element. */
void *gnoi_calloc(gno_context *context, size_t count, size_t size);
void *gnoi_malloc(gno_context *context, size_t count, size_t size);

/* Frees a block of gnoi_malloc or gnoi_calloc made with the same count and size; NULL is accepted. */
void gnoi_free(gno_context *context, void *block, size_t count, size_t size);

/* Formats the context's message and returns status; never called from worker threads. */
gno_status gnoi_fail(gno_context *context, gno_status status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;
void gnoi_warn(gno_context *context, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/* Cancelling. A long call says where it is by gnoi_progress on the caller's thread, and asks gnoi_stopped in every loop that may
 * take longer than some milliseconds, on any thread. When it says 1, stop and report a failure as if memory had run out: the
 * gnoi_fail at the end of every such path, or gnoi_parallel, makes GNO_ERROR_CANCELLED of it. Either looks at the clock and asks the
 * progress callback every GNOI_POLL_SECONDS at most, on the caller's thread alone; a question costs some 30 nanoseconds. */
#define GNOI_POLL_SECONDS 0.01
gno_status gnoi_progress(gno_context *context, const char *stage, double fraction);
int gnoi_stopped(gno_context *context);

/* The same in a loop of small steps: asks at every 512th. */
static inline int gnoi_stopped_at(gno_context *context, size_t step) { return step % 512 == 511 && gnoi_stopped(context); }

/* What the next question tells of the stage at hand; on the caller's thread. */
void gnoi_set_fraction(gno_context *context, double fraction);

/* Forgets a stop that an earlier call was told; first thing in a public call. */
void gnoi_begin(gno_context *context, const char *stage);

/* Monotonic wall-clock seconds. */
double gnoi_now(void);

/* A growing array's capacity made ready for `need` elements: doubles, starts at 16. Returns 0 when memory fails
 * (array and capacity unchanged then). */
int gnoi_reserve(gno_context *context, void **array, size_t *capacity, size_t need, size_t size);

#endif
