/* fuzz_mesh.c -- bytes as a Wavefront OBJ file and, after a zero byte, the fuzz.mtl beside it. */
#include "fuzz/fuzz.h"

#include <gnomon/gnomon_io.h>
#include <gnomon/gnomon_problems.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint8_t *cut = size > 0 ? memchr(data, 0, size) : NULL;
    size_t first = cut != NULL ? (size_t)(cut - data) : size, rest = cut != NULL ? size - first - 1 : 0;
    gno_context *context = fuzz_context();
    gno_scene *scene = NULL;
    fuzz_file("fuzz.mtl", data + size - rest, rest);
    gno_status status = gno_scene_load(context, fuzz_file("fuzz.obj", data, first), NULL, 0, &scene);
    fuzz_expect((status == GNO_OK) == (scene != NULL), "a scene exactly when all is well");
    fuzz_expect(status == GNO_OK || gno_context_message(context)[0] != '\0', "a message");
    if (scene != NULL) {
        size_t counts[GNO_PROBLEM_KINDS];
        gno_scene_find_problems(scene, 1, NULL, NULL, counts);
    }
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return 0;
}
