/* cases.h -- the cases of hostile.c. Each returns 1 when all went as promised, and says in `outcome` what came of it. Place: tests. */
#ifndef TESTS_HOSTILE_CASES_H
#define TESTS_HOSTILE_CASES_H

#include <gnomon/gnomon.h>
#include <stddef.h>

typedef int (*hostile_fn)(size_t size, char *outcome, size_t room);

/* limits.c */
int hostile_counts(size_t size, char *outcome, size_t room);
int hostile_scales(size_t size, char *outcome, size_t room);
int hostile_lights(size_t size, char *outcome, size_t room);
int hostile_picture(size_t size, char *outcome, size_t room);
int hostile_picture_refused(size_t size, char *outcome, size_t room);

/* piles.c: many polygons in one place */
int hostile_soup_drawn(size_t size, char *outcome, size_t room);
int hostile_soup_rows(size_t size, char *outcome, size_t room);
int hostile_soup_lit(size_t size, char *outcome, size_t room);
int hostile_soup_pieces(size_t size, char *outcome, size_t room);
int hostile_pile_drawn(size_t size, char *outcome, size_t room);
int hostile_pile_painted(size_t size, char *outcome, size_t room);
int hostile_pile_glass(size_t size, char *outcome, size_t room);
int hostile_pile_lit(size_t size, char *outcome, size_t room);
int hostile_pile_crossing(size_t size, char *outcome, size_t room);
int hostile_pile_matrix(size_t size, char *outcome, size_t room);

/* rings.c: polygons of many corners */
int hostile_ring_drawn(size_t size, char *outcome, size_t room);
int hostile_ring_smooth(size_t size, char *outcome, size_t room);
int hostile_ring_lit(size_t size, char *outcome, size_t room);
int hostile_ring_pieces(size_t size, char *outcome, size_t room);
int hostile_ring_matrix(size_t size, char *outcome, size_t room);
int hostile_ring_clipped(size_t size, char *outcome, size_t room);
int hostile_holes(size_t size, char *outcome, size_t room);

/* ---- what the cases share: stage.c ------------------------------------------------------------------------------------ */

/* A context of at most 1 GiB and a scene of 64 x 48 pixels, seen from above: the eye at (0, 0, 10), the square from -1 to 1 fills most of the picture,
 * with a light of the sun from aside. Ends the process when it cannot be made. */
typedef struct hostile_stage {
    gno_context *context;
    gno_scene *scene;
} hostile_stage;

hostile_stage hostile_stage_make(void);
void hostile_stage_drop(hostile_stage *s);

/* Adds polygons of one ring of n corners each, one after the other in `positions`. */
gno_status hostile_add(hostile_stage *s, const double *positions, size_t polygons, size_t n, int material, int shading);

/* Draws by an engine. Returns 1 when it is done and all values are numbers, or when the ceiling of memory was named. */
int hostile_draw(hostile_stage *s, gno_engine engine, char *outcome, size_t room);

/* Writes the status and message of a call that failed, and returns `as_promised`. */
int hostile_say(hostile_stage *s, gno_status status, int as_promised, char *outcome, size_t room);

/* [0, 1) */
double hostile_random(unsigned long long *state);

#endif
