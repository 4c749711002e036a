/* fuzz_yaml.c -- bytes as a scene file. A scene or a message comes of it. */
#include "fuzz/fuzz.h"

#include <gnomon/gnomon_io.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gno_context *context = fuzz_context();
    gno_scene *scene = NULL;
    gno_status status = gno_scene_load(context, fuzz_file("fuzz.yaml", data, size), NULL, 0, &scene);
    fuzz_expect((status == GNO_OK) == (scene != NULL), "a scene exactly when all is well");
    fuzz_expect(status == GNO_OK || gno_context_message(context)[0] != '\0', "a message");
    gno_scene_destroy(scene);
    fuzz_expect(gno_context_memory(context, NULL) < 100000, "memory given back");
    gno_context_destroy(context);
    return 0;
}
