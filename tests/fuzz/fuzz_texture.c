/* fuzz_texture.c -- bytes as a picture for a texture: PNG from memory, or EXR, by their first byte. */
#include "fuzz/fuzz.h"
#include "io/texture_file.h"

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char reason[GNOI_TEXTURE_REASON] = "";
    gnoi_raster raster;
    gno_status status;
    memset(&raster, 0, sizeof raster);
    raster.context = fuzz_context();
    if (size > 0 && data[0] == 0x89) {
        status = gnoi_raster_png(&raster, "fuzz.png", data, size, 1, reason);
    } else {
        status = gnoi_raster_exr(&raster, fuzz_file("fuzz.exr", data, size), reason);
    }
    fuzz_expect(status == GNO_OK || status == GNO_ERROR_MEMORY || reason[0] != '\0', "a reason");
    if (status == GNO_OK) {
        fuzz_expect(raster.width > 0 && raster.height > 0 && (raster.bytes == NULL) != (raster.linear == NULL), "one picture");
    }
    gnoi_raster_free(&raster);
    gno_context_destroy(raster.context);
    return 0;
}
