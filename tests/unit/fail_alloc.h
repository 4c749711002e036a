/* fail_alloc.h -- an allocator for tests: keeps its own account, checks every old_size, and can fail at a given call.
 * For inclusion after cmocka.h, in test programs only. Single threaded.
 */
#ifndef FAIL_ALLOC_H
#define FAIL_ALLOC_H

#include <gnomon/gnomon.h>
#include <stdlib.h>

#define FAIL_ALLOC_HEAD 16 /* bytes before a block that hold its size; keeps malloc's alignment */

typedef struct fail_alloc {
    size_t held;    /* bytes */
    size_t calls;   /* that ask for memory */
    size_t fail_at; /* this call and all after it fail; 0: none */
    int wrong_size; /* an old_size was not the block's */
} fail_alloc;

static inline void *fail_alloc_fn(void *user, void *block, size_t old_size, size_t new_size)
{
    fail_alloc *a = user;
    size_t *head = block ? (size_t *)((char *)block - FAIL_ALLOC_HEAD) : NULL;
    size_t *fresh;
    if ((head ? *head : 0) != old_size) {
        a->wrong_size = 1;
    }
    if (new_size == 0) {
        a->held -= head ? *head : 0;
        free(head);
        return NULL;
    }
    if (++a->calls >= a->fail_at && a->fail_at > 0) {
        return NULL;
    }
    fresh = malloc(FAIL_ALLOC_HEAD + new_size); /* always a new place, so that stale pointers show */
    if (!fresh) {
        return NULL;
    }
    if (head) {
        const char *from = (const char *)head + FAIL_ALLOC_HEAD;
        char *to = (char *)fresh + FAIL_ALLOC_HEAD;
        size_t i, count = *head < new_size ? *head : new_size;
        for (i = 0; i < count; i++) {
            to[i] = from[i];
        }
    }
    a->held += new_size - (head ? *head : 0);
    free(head);
    *fresh = new_size;
    return (char *)fresh + FAIL_ALLOC_HEAD;
}

static inline gno_context_def fail_alloc_def(fail_alloc *a)
{
    gno_context_def def = gno_context_def_default();
    def.alloc = fail_alloc_fn;
    def.alloc_user = a;
    return def;
}

#endif
