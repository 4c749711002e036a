/* texture_file.h -- pictures for textures: files in, scene images out.
 *
 * Place: under the readers of materials (scene_texture.c, mtl.c, assimp_material.c).
 *
 *   name beside a file --> texture_file.c: path, each file once --+-- texture_png.c, texture_exr.c --> gnoi_raster
 *                                                                +--> alpha as the material wants it --> gno_scene_add_image
 *
 * A picture that is missing or cannot be read is no error: the caller warns and the surface keeps its plain colour.
 */
#ifndef GNOI_IO_TEXTURE_FILE_H
#define GNOI_IO_TEXTURE_FILE_H

#include <gnomon/gnomon.h>

#define GNOI_TEXTURE_REASON 400

/* One decoded picture, top row first; exactly one of the two blocks is there, of the context's memory. */
typedef struct gnoi_raster {
    gno_context *context;
    int width, height, channels;
    unsigned char *bytes; /* as stored: colours are sRGB if they are colours */
    float *linear;        /* alpha not multiplied in */
} gnoi_raster;

typedef enum gnoi_alpha_use {
    GNOI_ALPHA_KEEP,
    GNOI_ALPHA_DROP,
    GNOI_ALPHA_CUT /* a hole where it is under the limit, solid elsewhere */
} gnoi_alpha_use;

/* What is wanted of a picture. Two requests that are equal get the same image. */
typedef struct gnoi_texture_request {
    const char *beside; /* the file that names it: its folder is where relative names begin */
    const char *name;   /* NULL with a mask alone: white */
    const char *mask;   /* another picture whose grey value becomes the alpha, or NULL */
    const void *data;   /* the file's bytes where it is not a file of its own (name then only tells it apart), or NULL */
    size_t data_size;
    int is_colour;      /* 1: sRGB in files of whole numbers; 0: heights, normals */
    gnoi_alpha_use alpha;
    double limit;       /* CUT */
} gnoi_texture_request;

struct gnoi_texture_entry;

/* The pictures of one scene or mesh file; zero but for the scene is an empty one. */
typedef struct gnoi_textures {
    gno_scene *scene;
    struct gnoi_texture_entry *entries;
    size_t count, capacity;
    gnoi_raster kept;  /* what was decoded last, if that was bytes, for entry kept_entry */
    size_t kept_entry;
} gnoi_textures;

/* *image is the scene's image, or -1 where there is none; reason then says why, the first time, and is "" later.
 * Errors: MEMORY (message set). */
gno_status gnoi_textures_get(gnoi_textures *textures, const gnoi_texture_request *request, int *image,
                             char reason[GNOI_TEXTURE_REASON]);
void gnoi_textures_free(gnoi_textures *textures);

/* ---- decoders: GNO_OK, MEMORY, or INPUT with the reason; gnoi_raster_free is due in any case ---- */

/* From the file at path or, where data is not NULL, from memory. */
gno_status gnoi_raster_png(gnoi_raster *raster, const char *path, const void *data, size_t size, int is_colour,
                           char reason[GNOI_TEXTURE_REASON]);
gno_status gnoi_raster_exr(gnoi_raster *raster, const char *path, char reason[GNOI_TEXTURE_REASON]);

/* Takes the memory for a picture whose size and channels are set, of bytes or of floats. LIMIT counts as INPUT. */
gno_status gnoi_raster_allocate(gnoi_raster *raster, int of_floats, char reason[GNOI_TEXTURE_REASON]);
void gnoi_raster_free(gnoi_raster *raster);

#endif
