/* picture.h -- a picture on its way to a file, as the encoders get it.
 *
 * Place: gno_picture_write (picture.c) checks the arguments, opens the file and hands both to one of the encoders
 * picture_png.c, picture_exr.c, picture_pfm.c.
 */
#ifndef GNOI_IO_PICTURE_H
#define GNOI_IO_PICTURE_H

#include "io/atomic_file.h"

typedef struct gnoi_picture {
    const float *rgb; /* height rows of width linear triples, top row first */
    int width, height;
    int depth; /* bits, one that the format has */
    double exposure;
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

#endif
