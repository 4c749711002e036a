/* calls.h -- every public call once, on one scene of many kinds of things, for call_faults.c. */
#ifndef FAULTS_CALLS_H
#define FAULTS_CALLS_H

#include <gnomon/gnomon_matrix.h>
#include <gnomon/gnomon_pieces.h>

enum { WIDE = 16, HIGH = 12, SIDE = 8, ROWS = 200 };

/* Of the memory that a context takes. */
typedef struct account {
    size_t held, calls, fail_at; /* 0: none fails */
    int for_good;
} account;

/* What calls work on: matrix and pieces only for those that need them. */
typedef struct stage {
    account memory;
    gno_context *context;
    gno_scene *scene;
    gno_matrix *matrix;
    gno_pieces *pieces;
    gno_lit_row rows[ROWS];
    float rgb[WIDE * HIGH * 3];
} stage;

typedef struct call {
    const char *name;
    gno_status (*run)(stage *s);
    enum { NEEDS_SCENE, NEEDS_PIECES, NEEDS_MATRIX } needs;
} call;

extern const call calls[];
extern const size_t call_count;

/* Fills the stage's scene by its context; 0 when something fails. */
int make_scene(stage *s);

/* The files that calls read, into the present folder; and takes away all that calls may have made there. */
void write_inputs(void);
void remove_files(void);

#endif
