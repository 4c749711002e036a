/* picture.h -- a picture on its way to a file, as the encoders get it.
 *
 * Place: gno_picture_write (picture.c) checks the arguments, opens the file and hands both to one of the encoders
 * picture_png.c, picture_exr.c, picture_pfm.c.
 */
#ifndef GNOI_IO_PICTURE_H
#define GNOI_IO_PICTURE_H

#include "io/atomic_file.h"

#include <gnomon/gnomon_io.h>

/* A further channel of a format that has any number of them: values of 32 bits, one a pixel, `step` values apart. */
typedef struct gnoi_channel {
    char name[256];
    int is_number;     /* unsigned instead of float */
    const void *values;
    size_t step;
    const float *table; /* NULL, or what numbers stand for: GNO_BACKGROUND is 0, any other number n is table[n] */
} gnoi_channel;

/* An entry of the file's head. */
typedef struct gnoi_note {
    char name[64];
    const char *text;
} gnoi_note;

typedef struct gnoi_picture {
    const float *rgb; /* height rows of width linear triples, top row first */
    int width, height;
    int depth; /* bits, one that the format has */
    double exposure;
    size_t channel_count, note_count; /* beside R, G, B */
    const gnoi_channel *channels;
    const gnoi_note *notes;
} gnoi_picture;

static inline const float *gnoi_picture_row(const gnoi_picture *picture, int y)
{
    return picture->rgb + (size_t)y * (size_t)picture->width * 3;
}

/* Each writes the whole picture into the open file; picture.c commits or discards it. File errors stay in the file;
 * a status other than GNO_OK (message set) is the encoder's own failure. */
gno_status gnoi_picture_png(const gnoi_picture *picture, gnoi_file *file);
gno_status gnoi_picture_exr(const gnoi_picture *picture, gnoi_file *file);
gno_status gnoi_picture_pfm(const gnoi_picture *picture, gnoi_file *file);

/* picture.c: checks def and path, then writes; channels and notes need a format that has them. Errors as gno_picture_write. */
gno_status gnoi_picture_write(gno_context *context, const char *path, const gno_picture_def *def, const gnoi_picture *picture);

#endif
