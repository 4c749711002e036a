/* picture_png.c -- PNG, 8 or 16 bit sRGB.
 *
 * Place: encoder under picture.c; srgb.c has the curve. Rows of floats become levels, and these differences from the row above (filter
 * type Up). A picture of common size has them all in one block, which libdeflate packs and libpng gets as chunks; of a large one libpng
 * filters and packs row by row. libpng reports errors by longjmp, so one function holds the setjmp and everything that could be lost by
 * it lives in the caller's `encoder`.
 * Source: W3C, Portable Network Graphics, 3rd edition, 9.2 (filter types), 10.1 (zlib streams).
 */
#include "base/fetch.h"
#include "io/picture.h"
#include "io/srgb.h"

#include <libdeflate.h>
#include <png.h>
#include <setjmp.h>
#include <string.h>

/* libdeflate takes a whole block, cannot be told to stop on the way, and takes up to 8 ms for a million bytes: a picture of
 * 1920 x 1080 x 3 bytes is the largest that it gets. */
#define PACKED_MOST ((size_t)6 << 20)

/* Bytes of a chunk: in between we can be told to stop. */
#define CHUNK ((size_t)1 << 20)

/* libdeflate's level. Of 17 rendered pictures of 1920 x 1080 those where one byte in eight or fewer differs from the row above pack faster at 2
 * (8 to 15 ms instead of 13 to 15), the others at 1 (14 to 27 ms instead of 14 to 41). zlib at level 1 with Z_RLE takes 9 to 56 ms for more
 * bytes. */
enum { LEVEL_FLAT = 2, LEVEL_DETAILED = 1 };

typedef struct encoder {
    const gnoi_picture *picture;
    gnoi_file *file;
    png_structp png;
    png_infop info;
    gnoi_srgb srgb;
    size_t row_size;       /* bytes of a row's levels */
    png_byte *levels;      /* two rows: the one being made and the one above it, zeros above the first */
    png_byte *row, *above; /* these two */
    png_byte *filtered;    /* every row, its filter type in front; NULL: libpng gets the rows */
    size_t filtered_size, zeros; /* how many of these bytes are zero */
    struct libdeflate_compressor *compressor;
    png_byte *packed; /* zlib stream of what was filtered */
    size_t packed_room;
    char message[200];
} encoder;

/* Our allocator wants the size back that libpng forgets, so each block carries it in front; 16 bytes keep the alignment. */
enum { BLOCK_HEAD = 16 };

static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    const encoder *e = png_get_mem_ptr(png);
    char *block = size <= SIZE_MAX - BLOCK_HEAD ? gno_context_realloc(e->file->context, NULL, 0, size + BLOCK_HEAD) : NULL;
    if (block == NULL) {
        return NULL;
    }
    const size_t whole = size + BLOCK_HEAD;
    memcpy(block, &whole, sizeof whole);
    return block + BLOCK_HEAD;
}

static void release(png_structp png, png_voidp pointer)
{
    const encoder *e = png_get_mem_ptr(png);
    if (pointer != NULL) {
        char *block = (char *)pointer - BLOCK_HEAD;
        size_t whole;
        memcpy(&whole, block, sizeof whole);
        gno_context_realloc(e->file->context, block, whole, 0);
    }
}

static void on_error(png_structp png, png_const_charp text)
{
    encoder *e = png_get_error_ptr(png);
    strncpy(e->message, text, sizeof e->message - 1);
    png_longjmp(png, 1);
}

/* Nothing that libpng warns of when writing concerns a user. */
static void on_warning(png_structp png, png_const_charp text)
{
    (void)png;
    (void)text;
}

static void on_write(png_structp png, png_bytep data, size_t size)
{
    encoder *e = png_get_io_ptr(png);
    if (!gnoi_file_write(e->file, data, size)) {
        png_error(png, "write error");
    }
}

static void on_flush(png_structp png)
{
    (void)png;
}

/* The row below is asked for on the way: to this loop alone memory is too slow. */
static void encode_row(encoder *e, int y)
{
    const size_t values = (size_t)e->picture->width * 3;
    const double exposure = e->picture->exposure;
    const gnoi_srgb srgb = e->srgb; /* here no byte that is written can be a part of it */
    const float *source = gnoi_picture_row(e->picture, y), *below = gnoi_picture_row(e->picture, y + 1 < e->picture->height ? y + 1 : y);
    png_byte *out = e->row;
    if (e->picture->depth == 8) {
        for (size_t i = 0; i < values; i++) {
            FETCH(below + i);
            out[i] = (png_byte)gnoi_srgb_level(&srgb, source[i] * exposure);
        }
        return;
    }
    for (size_t i = 0; i < values; i++) {
        const unsigned level = gnoi_srgb_level(&srgb, source[i] * exposure);
        FETCH(below + i);
        out[2 * i] = (png_byte)(level >> 8);
        out[2 * i + 1] = (png_byte)(level & 255);
    }
}

/* Returns how many differences are zero. */
static unsigned filter_up(png_byte *restrict out, const png_byte *restrict row, const png_byte *restrict above, size_t size)
{
    unsigned zeros = 0;
    out[0] = PNG_FILTER_VALUE_UP;
    for (size_t i = 0; i < size; i++) {
        out[1 + i] = (png_byte)(row[i] - above[i]);
        zeros += row[i] == above[i];
    }
    return zeros;
}

static void set_head(encoder *e)
{
    png_set_user_limits(e->png, GNO_MAX_IMAGE_SIDE, GNO_MAX_IMAGE_SIDE);
    png_set_IHDR(e->png, e->info, (png_uint_32)e->picture->width, (png_uint_32)e->picture->height, e->picture->depth, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(e->png, e->info, PNG_sRGB_INTENT_RELATIVE);
    /* For rows that libpng packs. Measured on rendered pictures: four times as fast as its defaults, for a third more bytes. */
    png_set_filter(e->png, PNG_FILTER_TYPE_DEFAULT, PNG_FILTER_UP);
    png_set_compression_level(e->png, 1);
    png_set_compression_strategy(e->png, 3); /* zlib's Z_RLE: of differences from row to row only runs repeat */
    png_set_compression_buffer_size(e->png, 65536);
}

static void put_row(encoder *e, int y)
{
    if (e->filtered == NULL) {
        png_write_row(e->png, e->row);
        return;
    }
    e->zeros += filter_up(e->filtered + (size_t)y * (e->row_size + 1), e->row, e->above, e->row_size);
    png_byte *const done = e->row;
    e->row = e->above;
    e->above = done;
}

/* Returns 0 when told to stop. */
static int put_packed(encoder *e)
{
    e->compressor = libdeflate_alloc_compressor(e->zeros > e->filtered_size / 8 * 7 ? LEVEL_FLAT : LEVEL_DETAILED);
    if (e->compressor == NULL) {
        png_error(e->png, "out of memory");
    }
    const size_t size = libdeflate_zlib_compress(e->compressor, e->filtered, e->filtered_size, e->packed, e->packed_room);
    if (size == 0) {
        png_error(e->png, "the rows do not fit into the bound of their packed size");
    }
    for (size_t at = 0; at < size; at += CHUNK) {
        if (!gnoi_file_go_on(e->file, 1)) {
            return 0;
        }
        png_write_chunk(e->png, (png_const_bytep)"IDAT", e->packed + at, size - at < CHUNK ? size - at : CHUNK);
    }
    png_write_chunk(e->png, (png_const_bytep)"IEND", NULL, 0); /* png_write_end wants rows that it packed itself */
    return 1;
}

/* Returns 0 when libpng gave up or when told to stop. */
static int encode(encoder *e)
{
    if (setjmp(png_jmpbuf(e->png)) != 0) {
        return 0;
    }
    png_set_write_fn(e->png, e, on_write, on_flush);
    set_head(e);
    png_write_info(e->png, e->info);
    for (int y = 0; y < e->picture->height; y++) {
        if (!gnoi_file_go_on(e->file, (double)y / e->picture->height)) {
            return 0;
        }
        encode_row(e, y);
        put_row(e, y);
    }
    if (e->filtered != NULL) {
        return put_packed(e);
    }
    png_write_end(e->png, NULL);
    return 1;
}

/* Returns 0 when memory fails. */
static int prepare_packing(encoder *e)
{
    e->filtered_size = (size_t)e->picture->height * (e->row_size + 1);
    e->filtered = gno_context_realloc(e->file->context, NULL, 0, e->filtered_size);
    e->packed_room = libdeflate_zlib_compress_bound(NULL, e->filtered_size); /* at any level */
    e->packed = gno_context_realloc(e->file->context, NULL, 0, e->packed_room);
    return e->filtered != NULL && e->packed != NULL;
}

/* Returns 0 when memory fails; release_all gives back what was got till then. */
static int prepare(encoder *e)
{
    e->row_size = (size_t)e->picture->width * 3 * (size_t)(e->picture->depth / 8);
    e->levels = gno_context_realloc(e->file->context, NULL, 0, 2 * e->row_size);
    e->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, e, on_error, on_warning, e, allocate, release);
    e->info = e->png != NULL ? png_create_info_struct(e->png) : NULL;
    if (e->levels == NULL || e->info == NULL || !gnoi_srgb_create(e->file->context, e->picture->depth, &e->srgb)) {
        return 0;
    }
    e->row = e->levels;
    e->above = e->levels + e->row_size;
    memset(e->above, 0, e->row_size);
    return (size_t)e->picture->height > PACKED_MOST / (e->row_size + 1) || prepare_packing(e);
}

static void release_block(gno_context *context, void *block, size_t size)
{
    if (block != NULL) {
        gno_context_realloc(context, block, size, 0);
    }
}

static void release_all(encoder *e)
{
    gno_context *context = e->file->context;
    gnoi_srgb_destroy(&e->srgb);
    if (e->png != NULL) {
        png_destroy_write_struct(&e->png, &e->info);
    }
    release_block(context, e->packed, e->packed_room);
    release_block(context, e->filtered, e->filtered_size);
    release_block(context, e->levels, 2 * e->row_size);
    libdeflate_free_compressor(e->compressor);
}

gno_status gnoi_picture_png(const gnoi_picture *picture, gnoi_file *file)
{
    encoder e;
    memset(&e, 0, sizeof e);
    e.picture = picture;
    e.file = file;
    gno_status status = GNO_OK;
    int has_memory = prepare(&e);
    if (has_memory && !encode(&e) && file->error == 0) {
        char text[256];
        memcpy(text, "PNG: ", 6);
        strncat(text, e.message, sizeof text - 6);
        has_memory = strstr(e.message, "memory") == NULL;
        status = gno_context_fail(file->context, GNO_ERROR_FILE, text);
    }
    if (!has_memory) {
        status = gno_context_fail(file->context, GNO_ERROR_MEMORY, "out of memory for writing a PNG picture");
    }
    release_all(&e);
    return status;
}
