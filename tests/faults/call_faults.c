/* call_faults.c -- every allocation of every public call fails: once alone, and from there on for good.
 *
 * usage: call_faults [STEP]    every STEP-th allocation only (1)
 *
 * Place: tests. Each call runs in a context of its own, made anew for each fault, on one thread. A fault is well taken when the call
 * returns MEMORY with a message (or does without the memory), does its work when asked again, and when nothing is held at the end. Prints
 * a PASS or FAIL line a call with the number of faults, and their sum. Run it under the leak checker: make faults.
 */
#include "faults/calls.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- memory ---------------------------------------------------------------------------------------------------------------- */

static void *failing(void *user, void *block, size_t old_size, size_t new_size)
{
    account *a = user;
    void *fresh;
    if (new_size == 0) {
        a->held -= old_size;
        free(block);
        return NULL;
    }
    a->calls++;
    if (a->fail_at > 0 && (a->calls == a->fail_at || (a->for_good && a->calls > a->fail_at))) {
        return NULL;
    }
    fresh = malloc(new_size); /* always a new place, so that stale pointers show */
    if (fresh == NULL) {
        return NULL;
    }
    if (block != NULL) {
        memcpy(fresh, block, old_size < new_size ? old_size : new_size);
        free(block);
    }
    a->held += new_size - old_size;
    return fresh;
}

/* ---- faults ---------------------------------------------------------------------------------------------------------------------- */

static void stage_make(stage *s, const call *c)
{
    gno_context_def def = gno_context_def_default();
    gno_lit_def lit_def = gno_lit_def_default();
    gno_matrix_def matrix_def = gno_matrix_def_default();
    memset(s, 0, sizeof *s);
    def.alloc = failing;
    def.alloc_user = &s->memory;
    lit_def.threads = matrix_def.threads = 1;
    if (gno_context_create(&def, &s->context) != GNO_OK || !make_scene(s) ||
        (c->needs == NEEDS_PIECES && gno_lit_pieces(s->scene, 0, &lit_def, &s->pieces, s->rows, NULL) != GNO_OK) ||
        (c->needs == NEEDS_MATRIX && gno_matrix_build(s->scene, 0, &matrix_def, &s->matrix) != GNO_OK)) {
        fprintf(stderr, "call_faults: %s\n", s->context ? gno_context_message(s->context) : "no context");
        exit(3);
    }
}

/* Returns what is still held, which should be nothing. */
static size_t stage_drop(stage *s)
{
    gno_pieces_destroy(s->pieces);
    gno_matrix_destroy(s->matrix);
    gno_scene_destroy(s->scene);
    gno_context_destroy(s->context);
    return s->memory.held;
}

/* 1 when fault number `at` was taken well; *calls is how many allocations the call makes without a fault. */
static int try_fault(const call *c, size_t at, int for_good, size_t *allocations)
{
    static stage s;
    gno_status status;
    size_t before, held;
    int good;
    stage_make(&s, c);
    before = s.memory.calls;
    s.memory.fail_at = at > 0 ? before + at : 0;
    s.memory.for_good = for_good;
    status = c->run(&s);
    s.memory.fail_at = 0;
    if (at == 0) {
        *allocations = s.memory.calls - before;
        good = status == GNO_OK;
    } else {
        good = status == GNO_OK || (status == GNO_ERROR_MEMORY && gno_context_message(s.context)[0] != '\0');
        if (!good) {
            printf("  %s: allocation %lu: %s: %s\n", c->name, (unsigned long)at, gno_status_text(status), gno_context_message(s.context));
        } else if ((status = c->run(&s)) != GNO_OK) {
            printf("  %s: allocation %lu: and then: %s\n", c->name, (unsigned long)at, gno_context_message(s.context));
            good = 0;
        }
    }
    held = stage_drop(&s);
    if (held != 0) {
        printf("  %s: allocation %lu: %lu bytes are still held\n", c->name, (unsigned long)at, (unsigned long)held);
    }
    return good && held == 0;
}

int main(int argc, char **argv)
{
    size_t step = argc > 1 ? (size_t)atoi(argv[1]) : 1, all = 0, wrong = 0;
    char folder[] = "/tmp/gnomon-faults-XXXXXX";
    step = step > 0 ? step : 1;
    if (mkdtemp(folder) == NULL || chdir(folder) != 0) {
        return 3;
    }
    write_inputs();
    for (size_t i = 0; i < call_count; i++) {
        size_t allocations = 0, faults = 0, bad = !try_fault(&calls[i], 0, 0, &allocations);
        for (size_t at = 1; at <= allocations; at += step) {
            for (int for_good = 0; for_good <= 1; for_good++, faults++) {
                bad += !try_fault(&calls[i], at, for_good, &allocations);
            }
        }
        printf("%s faults: %s: %lu faults in %lu allocations, %lu taken badly\n", bad ? "FAIL" : "PASS", calls[i].name, (unsigned long)faults,
               (unsigned long)allocations, (unsigned long)bad);
        fflush(stdout);
        all += faults;
        wrong += bad;
    }
    remove_files();
    if (chdir("/") != 0 || rmdir(folder) != 0) {
        printf("FAIL faults: files are left in %s\n", folder);
        wrong++;
    }
    printf("faults: %lu allocations failed in %lu calls, %lu taken badly\n", (unsigned long)all, (unsigned long)call_count,
           (unsigned long)wrong);
    return wrong > 0;
}
