/* texture_file.c -- see texture_file.h. */
#include "io/texture_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

/* More pixels than this are taken for a broken or hostile file. */
#define MOST_PIXELS ((size_t)1 << 28)

typedef struct gnoi_texture_entry {
    char *key;
    size_t key_size;
    int image;
} gnoi_texture_entry;

/* ---- rasters ------------------------------------------------------------------------------------------------------------ */

static size_t raster_size(const gnoi_raster *r)
{
    return (size_t)r->width * (size_t)r->height * (size_t)r->channels * (r->linear ? sizeof(float) : 1);
}

gno_status gnoi_raster_allocate(gnoi_raster *r, int of_floats, char reason[GNOI_TEXTURE_REASON])
{
    if (r->width < 1 || r->height < 1 || r->width > GNO_MAX_IMAGE_SIDE || r->height > GNO_MAX_IMAGE_SIDE ||
        (size_t)r->width * (size_t)r->height > MOST_PIXELS) {
        snprintf(reason, GNOI_TEXTURE_REASON, "%d x %d pixels are not read", r->width, r->height);
        return GNO_ERROR_INPUT;
    }
    size_t count = (size_t)r->width * (size_t)r->height * (size_t)r->channels;
    if (of_floats) r->linear = gno_context_realloc(r->context, NULL, 0, count * sizeof *r->linear);
    else r->bytes = gno_context_realloc(r->context, NULL, 0, count);
    return r->linear || r->bytes ? GNO_OK : GNO_ERROR_MEMORY;
}

void gnoi_raster_free(gnoi_raster *r)
{
    size_t size = raster_size(r);
    if (r->bytes) gno_context_realloc(r->context, r->bytes, size, 0);
    if (r->linear) gno_context_realloc(r->context, r->linear, size, 0);
    r->bytes = NULL;
    r->linear = NULL;
}

/* ---- finding and decoding ------------------------------------------------------------------------------------------------- */

static int begins_with(const unsigned char *head, size_t size, const char *magic, size_t length)
{
    return size >= length && memcmp(head, magic, length) == 0;
}

/* By what the file begins with; names lie. */
static gno_status decode(gnoi_raster *r, const char *path, const void *data, size_t size, int is_colour,
                         char reason[GNOI_TEXTURE_REASON])
{
    unsigned char head[8];
    size_t got;
    if (data) {
        got = size < sizeof head ? size : sizeof head;
        memcpy(head, data, got);
    } else {
        FILE *file = fopen(path, "rb");
        if (!file) {
            snprintf(reason, GNOI_TEXTURE_REASON, "cannot open %.300s: %s", path, strerror(errno));
            return GNO_ERROR_INPUT;
        }
        got = fread(head, 1, sizeof head, file);
        fclose(file);
    }
    if (begins_with(head, got, "\x89PNG", 4)) return gnoi_raster_png(r, path, data, size, is_colour, reason);
    if (begins_with(head, got, "\x76\x2f\x31\x01", 4) && !data) return gnoi_raster_exr(r, path, reason);
    snprintf(reason, GNOI_TEXTURE_REASON, "%.300s is %s, and only PNG and EXR are read", data ? "the picture within the file" : path,
             begins_with(head, got, "\xff\xd8\xff", 3) ? "JPEG" : "neither PNG nor EXR");
    return GNO_ERROR_INPUT;
}

static int can_open(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (file) fclose(file);
    return file != NULL;
}

/* The path of `name` beside a file; the caller frees *size bytes. NULL when memory fails. */
static char *path_beside(gno_context *context, const char *beside, const char *name, size_t *size)
{
    const char *slash = strrchr(beside, '/');
    size_t folder = name[0] == '/' || !slash ? 0 : (size_t)(slash - beside) + 1;
    *size = folder + strlen(name) + 1;
    char *path = gno_context_realloc(context, NULL, 0, *size);
    if (!path) return NULL;
    memcpy(path, beside, folder);
    memcpy(path + folder, name, strlen(name) + 1);
    if (can_open(path)) return path;
    for (char *c = path + folder; *c; c++) /* written on Windows? */
        if (*c == '\\') *c = '/';
    return path;
}

static gno_status decode_beside(gnoi_raster *r, const gnoi_texture_request *q, const char *name, char reason[GNOI_TEXTURE_REASON])
{
    size_t size = 0;
    if (q->data) return decode(r, name, q->data, q->data_size, q->is_colour, reason);
    char *path = path_beside(r->context, q->beside, name, &size);
    if (!path) return GNO_ERROR_MEMORY;
    gno_status status = decode(r, path, NULL, 0, q->is_colour, reason);
    gno_context_realloc(r->context, path, size, 0);
    return status;
}

/* ---- alpha ---------------------------------------------------------------------------------------------------------------- */

static double value_at(const gnoi_raster *r, size_t pixel, int channel)
{
    size_t at = pixel * (size_t)r->channels + (size_t)channel;
    return r->bytes ? r->bytes[at] / 255.0 : (double)r->linear[at];
}

static void set_alpha(gnoi_raster *r, size_t pixel, double alpha)
{
    size_t at = pixel * (size_t)r->channels + (size_t)r->channels - 1;
    if (r->bytes) r->bytes[at] = (unsigned char)(alpha * 255 + 0.5);
    else r->linear[at] = (float)alpha;
}

static void use_alpha(gnoi_raster *r, gnoi_alpha_use use, double limit)
{
    size_t count = (size_t)r->width * (size_t)r->height;
    if (r->channels % 2 != 0 || use == GNOI_ALPHA_KEEP) return;
    for (size_t i = 0; i < count; i++)
        set_alpha(r, i, use == GNOI_ALPHA_DROP || value_at(r, i, r->channels - 1) >= limit ? 1 : 0);
}

/* The mask's grey value where the picture's pixel lies. A mask with an alpha of its own gives that. */
static double mask_at(const gnoi_raster *mask, double x, double y)
{
    int column = (int)(x * mask->width), row = (int)(y * mask->height), channels = mask->channels;
    size_t pixel = (size_t)row * (size_t)mask->width + (size_t)column;
    double alpha = channels % 2 == 0 ? value_at(mask, pixel, channels - 1) : 1;
    double grey = channels < 3 ? value_at(mask, pixel, 0)
                               : (value_at(mask, pixel, 0) + value_at(mask, pixel, 1) + value_at(mask, pixel, 2)) / 3;
    double v = alpha < 1 ? alpha : grey;
    return v < 0 ? 0 : v > 1 ? 1 : v;
}

/* Gives the picture the mask as its alpha; a picture without room for one, or none at all, is made anew. */
static gno_status put_mask(gnoi_raster *r, const gnoi_raster *mask, char reason[GNOI_TEXTURE_REASON])
{
    gnoi_raster out = {r->context, r->bytes || r->linear ? r->width : mask->width, r->bytes || r->linear ? r->height : mask->height, 4, NULL, NULL};
    gno_status status = gnoi_raster_allocate(&out, r->linear != NULL, reason);
    if (status != GNO_OK) return status;
    for (int y = 0; y < out.height; y++)
        for (int x = 0; x < out.width; x++) {
            size_t pixel = (size_t)y * (size_t)out.width + (size_t)x;
            for (int k = 0; k < 3; k++) {
                size_t from = pixel * (size_t)r->channels + (size_t)(r->channels >= 3 ? k : 0);
                if (out.linear) out.linear[4 * pixel + (size_t)k] = r->linear[from];
                else out.bytes[4 * pixel + (size_t)k] = r->bytes ? r->bytes[from] : 255;
            }
            set_alpha(&out, pixel, mask_at(mask, (x + 0.5) / out.width, (y + 0.5) / out.height));
        }
    gnoi_raster_free(r);
    *r = out;
    return GNO_OK;
}

/* ---- one picture ------------------------------------------------------------------------------------------------------------ */

static gno_status make_raster(gnoi_raster *r, const gnoi_texture_request *q, char reason[GNOI_TEXTURE_REASON])
{
    gnoi_raster mask = {r->context, 0, 0, 0, NULL, NULL};
    gno_status status = q->name ? decode_beside(r, q, q->name, reason) : GNO_OK;
    if (status == GNO_OK) use_alpha(r, q->alpha, q->limit);
    if (status != GNO_OK || !q->mask) return status;
    gnoi_texture_request of_mask = *q;
    of_mask.is_colour = 0;
    status = decode_beside(&mask, &of_mask, q->mask, reason);
    if (status == GNO_OK) status = put_mask(r, &mask, reason);
    gnoi_raster_free(&mask);
    return status;
}

/* Values of float pictures that are no numbers become 0. */
static void mend(gnoi_raster *r)
{
    size_t count = (size_t)r->width * (size_t)r->height * (size_t)r->channels;
    for (size_t i = 0; r->linear && i < count; i++)
        if (!(r->linear[i] >= -65504.0f && r->linear[i] <= 1e30f)) r->linear[i] = 0;
}

/* The pixels of a request go to t->kept, unless they are there already: a picture is often asked for as colours and as heights in turn. */
static gno_status keep_raster(gnoi_textures *t, const gnoi_texture_request *q, size_t entry, char reason[GNOI_TEXTURE_REASON])
{
    const gnoi_texture_entry *last = &t->entries[t->kept_entry], *now = &t->entries[entry];
    int is_same = t->kept.bytes && last->key_size == now->key_size && memcmp(last->key + 1, now->key + 1, now->key_size - 1) == 0;
    t->kept_entry = entry;
    if (is_same) return GNO_OK;
    gnoi_raster_free(&t->kept);
    memset(&t->kept, 0, sizeof t->kept);
    t->kept.context = gno_scene_context(t->scene);
    return make_raster(&t->kept, q, reason);
}

static gno_status load(gnoi_textures *t, const gnoi_texture_request *q, size_t entry, int *image, char reason[GNOI_TEXTURE_REASON])
{
    gnoi_raster *r = &t->kept;
    gno_status status = keep_raster(t, q, entry, reason);
    if (status == GNO_OK) {
        gno_pixels pixels;
        memset(&pixels, 0, sizeof pixels);
        mend(r);
        pixels.width = r->width;
        pixels.height = r->height;
        pixels.channels = r->channels;
        pixels.linear = r->linear;
        pixels.bytes = r->bytes;
        pixels.encoded = q->is_colour;
        status = gno_scene_add_image(t->scene, &pixels, image);
    }
    if (status != GNO_OK || !r->bytes) gnoi_raster_free(r);
    if (status == GNO_ERROR_MEMORY) return gno_context_fail(r->context, status, "out of memory while reading a texture");
    if (status != GNO_OK && !reason[0]) snprintf(reason, GNOI_TEXTURE_REASON, "%.390s", gno_context_message(r->context));
    return GNO_OK;
}

/* ---- each once ---------------------------------------------------------------------------------------------------------------- */

/* Everything that tells requests apart, as text; whether they are colours by its first character alone. */
static int write_key(const gnoi_texture_request *q, char *text, size_t size)
{
    return snprintf(text, size, "%d %d %.17g\n%s\n%s\n%s", q->is_colour, (int)q->alpha, q->limit, q->beside, q->name ? q->name : "",
                    q->mask ? q->mask : "") + 1;
}

static gnoi_texture_entry *add_entry(gnoi_textures *t, char *key, size_t size)
{
    gno_context *context = gno_scene_context(t->scene);
    if (t->count == t->capacity) {
        size_t capacity = t->capacity ? 2 * t->capacity : 16;
        gnoi_texture_entry *grown =
            gno_context_realloc(context, t->entries, t->capacity * sizeof *grown, capacity * sizeof *grown);
        if (!grown) return NULL;
        t->entries = grown;
        t->capacity = capacity;
    }
    gnoi_texture_entry *entry = &t->entries[t->count++];
    entry->key = key;
    entry->key_size = size;
    entry->image = -1;
    return entry;
}

gno_status gnoi_textures_get(gnoi_textures *t, const gnoi_texture_request *q, int *image, char reason[GNOI_TEXTURE_REASON])
{
    gno_context *context = gno_scene_context(t->scene);
    size_t size = (size_t)write_key(q, NULL, 0);
    char *key = gno_context_realloc(context, NULL, 0, size);
    gnoi_texture_entry *entry = NULL;
    *image = -1;
    reason[0] = '\0';
    if (key) write_key(q, key, size);
    for (size_t i = 0; key && i < t->count; i++) {
        if (t->entries[i].key_size == size && memcmp(t->entries[i].key, key, size) == 0) {
            *image = t->entries[i].image;
            gno_context_realloc(context, key, size, 0);
            return GNO_OK;
        }
    }
    if (key) entry = add_entry(t, key, size);
    if (!entry) {
        if (key) gno_context_realloc(context, key, size, 0);
        return gno_context_fail(context, GNO_ERROR_MEMORY, "out of memory while reading a texture");
    }
    gno_status status = load(t, q, (size_t)(entry - t->entries), &entry->image, reason);
    *image = entry->image;
    return status;
}

void gnoi_textures_free(gnoi_textures *t)
{
    gno_context *context = gno_scene_context(t->scene);
    if (t->kept.context) gnoi_raster_free(&t->kept);
    t->kept_entry = 0;
    for (size_t i = 0; i < t->count; i++) gno_context_realloc(context, t->entries[i].key, t->entries[i].key_size, 0);
    if (t->entries) gno_context_realloc(context, t->entries, t->capacity * sizeof *t->entries, 0);
    t->entries = NULL;
    t->count = t->capacity = 0;
}
