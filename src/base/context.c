/* context.c -- the allocator, account, message and log behind gno_context.
 *
 * Place: the root; everything else allocates, fails and warns through here.
 * Invariants: `used` is the sum of the sizes of all blocks handed out and not yet freed, the context's own included;
 * `peak` is the largest value `used` ever had; neither exceeds the ceiling. Both are atomic, for worker threads allocate too; the
 * message and the callbacks belong to the calling thread alone.
 * Source: allocator with user and old size after Lua's lua_Alloc; message kept in a fixed buffer, so failing cannot fail.
 */
#include "base/context.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define MESSAGE_SIZE 1024
#define FIRST_CAPACITY 16

struct gno_context {
    gno_context_def def;
    atomic_size_t used;
    atomic_size_t peak;
    atomic_int refused;  /* the ceiling, not the allocator, refused memory last */
    atomic_int stopped;  /* the callback asked to stop, and no failure has been made of it yet */
    pthread_t caller;    /* the thread that may ask the callback */
    double asked;        /* when it did last, seconds */
    const char *stage;   /* what it was told */
    double fraction;
    char message[MESSAGE_SIZE];
};

/* ---- version and status --------------------------------------------------------------------------------------- */

#define TEXT_OF(x) #x
#define VERSION_TEXT(major, minor, patch) TEXT_OF(major) "." TEXT_OF(minor) "." TEXT_OF(patch)

const char *gno_version(void)
{
    return VERSION_TEXT(GNO_VERSION_MAJOR, GNO_VERSION_MINOR, GNO_VERSION_PATCH);
}

const char *gno_status_text(gno_status status)
{
    switch (status) {
    case GNO_OK: return "ok";
    case GNO_ERROR_MEMORY: return "out of memory";
    case GNO_ERROR_ARGUMENT: return "invalid argument";
    case GNO_ERROR_LIMIT: return "limit exceeded";
    case GNO_ERROR_INPUT: return "malformed input";
    case GNO_ERROR_FILE: return "file cannot be read or written";
    case GNO_ERROR_CANCELLED: return "cancelled";
    }
    return "unknown status";
}

/* ---- memory ---------------------------------------------------------------------------------------------------- */

static void *default_alloc(void *user, void *block, size_t old_size, size_t new_size)
{
    (void)user;
    (void)old_size;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    return realloc(block, new_size);
}

static void raise_peak(gno_context *context, size_t used)
{
    size_t peak = atomic_load_explicit(&context->peak, memory_order_relaxed);
    while (used > peak && !atomic_compare_exchange_weak_explicit(&context->peak, &peak, used, memory_order_relaxed,
                                                                 memory_order_relaxed)) {
    }
}

/* Enters a change of size before it is made, so that threads together never pass the ceiling; *after is what is used then. 0, and
 * nothing entered, when it would. */
static int account(gno_context *context, size_t old_size, size_t new_size, size_t *after)
{
    size_t ceiling = context->def.max_memory > 0 ? context->def.max_memory : SIZE_MAX, growth = new_size - old_size;
    size_t used = atomic_load_explicit(&context->used, memory_order_relaxed);
    if (new_size <= old_size) {
        *after = atomic_fetch_sub_explicit(&context->used, old_size - new_size, memory_order_relaxed) - (old_size - new_size);
        return 1;
    }
    do {
        if (used > ceiling || growth > ceiling - used) {
            atomic_store_explicit(&context->refused, 1, memory_order_relaxed);
            return 0;
        }
        *after = used + growth;
    } while (!atomic_compare_exchange_weak_explicit(&context->used, &used, *after, memory_order_relaxed, memory_order_relaxed));
    return 1;
}

void *gnoi_realloc(gno_context *context, void *block, size_t old_count, size_t count, size_t size)
{
    size_t old_size = block ? old_count * size : 0; /* the block exists, so this product did not overflow */
    size_t after;
    void *fresh;
    if (count == 0) {
        if (block) {
            context->def.alloc(context->def.alloc_user, block, old_size, 0);
            account(context, old_size, 0, &after);
        }
        return NULL;
    }
    if (size == 0 || count > (size_t)PTRDIFF_MAX / size || !account(context, old_size, count * size, &after)) {
        return NULL;
    }
    fresh = context->def.alloc(context->def.alloc_user, block, old_size, count * size);
    if (!fresh) {
        atomic_fetch_sub_explicit(&context->used, count * size - old_size, memory_order_relaxed);
        atomic_store_explicit(&context->refused, 0, memory_order_relaxed);
    } else if (count * size > old_size) {
        raise_peak(context, after);
    }
    return fresh;
}

void *gnoi_malloc(gno_context *context, size_t count, size_t size)
{
    return gnoi_realloc(context, NULL, 0, count ? count : 1, size);
}

void *gnoi_calloc(gno_context *context, size_t count, size_t size)
{
    void *block = gnoi_malloc(context, count, size);
    if (block) {
        memset(block, 0, (count ? count : 1) * size);
    }
    return block;
}

void gnoi_free(gno_context *context, void *block, size_t count, size_t size)
{
    if (block) {
        gnoi_realloc(context, block, count ? count : 1, 0, size);
    }
}

int gnoi_reserve(gno_context *context, void **array, size_t *capacity, size_t need, size_t size)
{
    size_t wanted = *capacity ? *capacity : FIRST_CAPACITY;
    void *fresh;
    if (need <= *capacity) {
        return 1;
    }
    while (wanted < need) {
        if (wanted > SIZE_MAX / 2) {
            wanted = need;
            break;
        }
        wanted *= 2;
    }
    fresh = gnoi_realloc(context, *array, *capacity, wanted, size);
    if (!fresh) {
        return 0;
    }
    *array = fresh;
    *capacity = wanted;
    return 1;
}

void *gno_context_realloc(gno_context *context, void *block, size_t old_size, size_t new_size)
{
    return context ? gnoi_realloc(context, block, old_size, new_size, 1) : NULL;
}

size_t gno_context_memory(const gno_context *context, size_t *peak)
{
    if (peak) {
        *peak = context ? atomic_load_explicit(&context->peak, memory_order_relaxed) : 0;
    }
    return context ? atomic_load_explicit(&context->used, memory_order_relaxed) : 0;
}

/* ---- the context itself ---------------------------------------------------------------------------------------- */

gno_context_def gno_context_def_default(void)
{
    gno_context_def def;
    memset(&def, 0, sizeof def);
    return def;
}

gno_status gno_context_create(const gno_context_def *def, gno_context **context)
{
    gno_context_def used = def ? *def : gno_context_def_default();
    gno_context *fresh;
    if (!context) {
        return GNO_ERROR_ARGUMENT;
    }
    *context = NULL;
    if (!used.alloc) {
        used.alloc = default_alloc;
        used.alloc_user = NULL;
    }
    fresh = used.max_memory == 0 || used.max_memory >= sizeof *fresh ? used.alloc(used.alloc_user, NULL, 0, sizeof *fresh) : NULL;
    if (!fresh) {
        return GNO_ERROR_MEMORY;
    }
    fresh->def = used;
    atomic_init(&fresh->used, sizeof *fresh);
    atomic_init(&fresh->peak, sizeof *fresh);
    atomic_init(&fresh->refused, 0);
    atomic_init(&fresh->stopped, 0);
    fresh->caller = pthread_self();
    fresh->asked = 0;
    fresh->stage = "";
    fresh->fraction = 0;
    fresh->message[0] = '\0';
    *context = fresh;
    return GNO_OK;
}

void gno_context_destroy(gno_context *context)
{
    if (context) {
        context->def.alloc(context->def.alloc_user, context, sizeof *context, 0);
    }
}

/* ---- messages -------------------------------------------------------------------------------------------------- */

const char *gno_context_message(const gno_context *context)
{
    return context ? context->message : "";
}

gno_status gno_context_fail(gno_context *context, gno_status status, const char *text)
{
    return gnoi_fail(context, status, "%s", text ? text : "");
}

/* "... (the memory ceiling of 64 MiB is reached)" */
static void add_ceiling(const gno_context *context, char *text, size_t size)
{
    size_t length = strlen(text);
    snprintf(text + length, size - length, "%s(the memory ceiling of %.6g MiB is reached)", length > 0 ? " " : "",
             (double)context->def.max_memory / 1048576);
}

gno_status gnoi_fail(gno_context *context, gno_status status, const char *format, ...)
{
    char text[MESSAGE_SIZE]; /* an argument may be the present message, so it must not be overwritten while it is read */
    va_list arguments;
    if (!context) {
        return status;
    }
    va_start(arguments, format);
    if (vsnprintf(text, sizeof text, format, arguments) < 0) {
        text[0] = '\0';
    }
    va_end(arguments);
    if (atomic_exchange(&context->stopped, 0)) {
        status = GNO_ERROR_CANCELLED;
        snprintf(text, sizeof text, "%s: cancelled", context->stage);
    }
    if (status != GNO_ERROR_MEMORY) {
        atomic_store_explicit(&context->refused, 0, memory_order_relaxed);
    } else if (atomic_load_explicit(&context->refused, memory_order_relaxed) && !strstr(text, "memory ceiling")) {
        add_ceiling(context, text, sizeof text);
    }
    memcpy(context->message, text, strlen(text) + 1);
    return status;
}

void gno_context_log(gno_context *context, gno_log_level level, const char *text)
{
    if (context && text && context->def.log) {
        context->def.log(context->def.log_user, level, text);
    }
}

void gnoi_warn(gno_context *context, const char *format, ...)
{
    char text[MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    if (vsnprintf(text, sizeof text, format, arguments) >= 0) {
        gno_context_log(context, GNO_LOG_WARNING, text);
    }
    va_end(arguments);
}

/* ---- progress and cancelling ------------------------------------------------------------------------------------ */

void gnoi_begin(gno_context *context, const char *stage)
{
    atomic_store(&context->stopped, 0);
    atomic_store(&context->refused, 0);
    context->caller = pthread_self();
    context->stage = stage;
    context->fraction = 0;
}

void gnoi_set_fraction(gno_context *context, double fraction) { context->fraction = fraction; }

int gnoi_stopped(gno_context *context)
{
    double now;
    if (atomic_load_explicit(&context->stopped, memory_order_relaxed)) {
        return 1;
    }
    if (!context->def.progress || !pthread_equal(context->caller, pthread_self())) {
        return 0;
    }
    now = gnoi_now();
    if (now - context->asked < GNOI_POLL_SECONDS) {
        return 0;
    }
    context->asked = now;
    if (context->def.progress(context->def.progress_user, context->stage, context->fraction) == 0) {
        return 0;
    }
    atomic_store(&context->stopped, 1);
    return 1;
}

gno_status gnoi_progress(gno_context *context, const char *stage, double fraction)
{
    context->caller = pthread_self();
    context->stage = stage;
    context->fraction = fraction;
    return gnoi_stopped(context) ? gnoi_fail(context, GNO_ERROR_CANCELLED, "%s: cancelled", stage) : GNO_OK;
}

gno_status gno_context_progress(gno_context *context, const char *stage, double fraction)
{
    return context ? gnoi_progress(context, stage ? stage : "", fraction) : GNO_ERROR_ARGUMENT;
}

double gnoi_now(void)
{
    struct timespec now;
    if (clock_gettime(CLOCK_MONOTONIC, &now) != 0) {
        return 0;
    }
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
