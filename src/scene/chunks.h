/* chunks.h -- passes over prepared polygons that write to their vertices.
 *
 * Place in the data flow: prepared polygons (see chunk_vertex and seams in scene.h) -> average.c, solid.c, boundary.c.
 */
#ifndef GNOI_SCENE_CHUNKS_H
#define GNOI_SCENE_CHUNKS_H

#include "scene/scene.h"

/* body(user, first, end) for runs of polygons that together are all of them, each once. It may write to what belongs to the vertices of
 * these polygons: chunks run side by side without the polygons that share vertices with an earlier chunk; these follow, one run after
 * the other. Runs and, for each vertex, their order do not depend on the number of threads. Errors: CANCELLED. */
typedef void (*gnoi_run_fn)(void *user, size_t first, size_t end);
gno_status gnoi_over_polygons(gno_context *context, const gnoi_prepared *prep, int threads, gnoi_run_fn body, void *user);

#endif
