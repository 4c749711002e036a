/* picture_png.c -- PNG, 8 or 16 bit sRGB, some rows encoded at a time.
 *
 * Place: encoder under picture.c; srgb.c has the curve, deflate.c the compression, libpng makes the chunks. It reports errors by
 * longjmp, so one function holds the setjmp and everything that could be lost by it lives in the caller's `encoder`.
 */
#include "io/deflate.h"
#include "io/picture.h"
#include "io/srgb.h"

#include <png.h>
#include <setjmp.h>
#include <string.h>

enum {
    BLOCK_BYTES = 65536, /* of what is compressed together; a row at least */
    FILTER_UP = 2        /* each byte less the one above */
};

typedef struct encoder {
    const gnoi_picture *picture;
    gnoi_file *file;
    png_structp png;
    png_infop info;
    gnoi_srgb srgb;
    gnoi_deflate deflate;
    png_byte *rows; /* this row and the one above, then those of a block, filtered, with their filter in front */
    size_t row_size, block_rows;
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

static void encode_row(const encoder *e, const float *source, png_byte *out)
{
    const size_t values = (size_t)e->picture->width * 3;
    const double exposure = e->picture->exposure;
    if (e->picture->depth == 8) {
        for (size_t i = 0; i < values; i++) {
            out[i] = (png_byte)gnoi_srgb_level(&e->srgb, source[i] * exposure);
        }
        return;
    }
    for (size_t i = 0; i < values; i++) {
        const unsigned level = gnoi_srgb_level(&e->srgb, source[i] * exposure);
        out[2 * i] = (png_byte)(level >> 8);
        out[2 * i + 1] = (png_byte)(level & 255);
    }
}

static void filter_row(const png_byte *row, const png_byte *above, size_t size, png_byte *out)
{
    out[0] = FILTER_UP;
    for (size_t i = 0; i < size; i++) {
        out[1 + i] = (png_byte)(row[i] - above[i]);
    }
}

static size_t rows_size(const encoder *e)
{
    return 2 * e->row_size + e->block_rows * (e->row_size + 1);
}

/* Returns 0 when the caller of gno_picture_write wants no more. */
static int write_rows(encoder *e)
{
    static const png_byte type[] = "IDAT";
    const int height = e->picture->height;
    png_byte *const block = e->rows + 2 * e->row_size;
    size_t filled = 0;
    memset(e->rows, 0, 2 * e->row_size); /* there is nothing above the first row */
    for (int y = 0; y < height; y++) {
        png_byte *const row = e->rows + (y & 1 ? e->row_size : 0), *const above = e->rows + (y & 1 ? 0 : e->row_size);
        if (!gnoi_file_go_on(e->file, (double)y / height)) {
            return 0;
        }
        encode_row(e, gnoi_picture_row(e->picture, y), row);
        filter_row(row, above, e->row_size, block + filled);
        filled += e->row_size + 1;
        if (y + 1 == height || filled == e->block_rows * (e->row_size + 1)) {
            const size_t size = gnoi_deflate_block(&e->deflate, block, filled, y + 1 == height);
            png_write_chunk(e->png, type, e->deflate.out, size);
            filled = 0;
        }
    }
    return 1;
}

/* Returns 0 when libpng gave up. */
static int encode(encoder *e)
{
    static const png_byte end[] = "IEND";
    if (setjmp(png_jmpbuf(e->png)) != 0) {
        return 0;
    }
    png_set_write_fn(e->png, e, on_write, on_flush);
    png_set_user_limits(e->png, GNO_MAX_IMAGE_SIDE, GNO_MAX_IMAGE_SIDE);
    png_set_IHDR(e->png, e->info, (png_uint_32)e->picture->width, (png_uint_32)e->picture->height, e->picture->depth, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(e->png, e->info, PNG_sRGB_INTENT_RELATIVE);
    png_write_info(e->png, e->info);
    if (!write_rows(e)) {
        return 0;
    }
    png_write_chunk(e->png, end, NULL, 0);
    return 1;
}

gno_status gnoi_picture_png(const gnoi_picture *picture, gnoi_file *file)
{
    encoder e;
    memset(&e, 0, sizeof e);
    e.picture = picture;
    e.file = file;
    e.row_size = (size_t)picture->width * 3 * (size_t)(picture->depth / 8);
    e.block_rows = e.row_size < BLOCK_BYTES ? BLOCK_BYTES / e.row_size : 1;
    e.block_rows = e.block_rows < (size_t)picture->height ? e.block_rows : (size_t)picture->height;
    e.rows = gno_context_realloc(file->context, NULL, 0, rows_size(&e));
    e.png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &e, on_error, on_warning, &e, allocate, release);
    e.info = e.png != NULL ? png_create_info_struct(e.png) : NULL;
    gno_status status = GNO_OK;
    if (e.rows == NULL || e.info == NULL || !gnoi_srgb_create(file->context, picture->depth, &e.srgb) ||
        !gnoi_deflate_create(file->context, e.block_rows * (e.row_size + 1), &e.deflate)) {
        status = gno_context_fail(file->context, GNO_ERROR_MEMORY, "out of memory for writing a PNG picture");
    } else if (!encode(&e) && file->error == 0) {
        char text[256];
        memcpy(text, "PNG: ", 6);
        strncat(text, e.message, sizeof text - 6);
        status = gno_context_fail(file->context, strstr(e.message, "memory") != NULL ? GNO_ERROR_MEMORY : GNO_ERROR_FILE, text);
    }
    gnoi_srgb_destroy(&e.srgb);
    if (e.png != NULL) {
        png_destroy_write_struct(&e.png, &e.info);
    }
    gnoi_deflate_destroy(&e.deflate);
    if (e.rows != NULL) {
        gno_context_realloc(file->context, e.rows, rows_size(&e), 0);
    }
    return status;
}
