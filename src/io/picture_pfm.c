/* picture_pfm.c -- portable float map: a three-line head, then 32-bit floats as they lie in memory, bottom row first.
 *
 * Place: encoder under picture.c. The sign of the third number tells the byte order (negative: little endian).
 */
#include "io/picture.h"

#include <stdio.h>

/* Rows from the lowest up. */
static void write_rows(const gnoi_picture *picture, gnoi_file *file, size_t bytes, float *row)
{
    const size_t values = (size_t)picture->width * 3;
    int count = 1;
    for (int y = picture->height - 1; y >= 0 && gnoi_file_go_on(file, 1 - (y + 1.0) / picture->height); y -= count) {
        const float *source = gnoi_picture_row(picture, y);
        if (picture->exposure == 1) {
            count = y + 1 < GNOI_FILE_ROWS ? y + 1 : GNOI_FILE_ROWS;
            gnoi_file_write_rows(file, source, -(ptrdiff_t)bytes, bytes, count);
            continue;
        }
        for (size_t i = 0; i < values; i++) {
            row[i] = (float)(source[i] * picture->exposure);
        }
        gnoi_file_write(file, row, bytes);
    }
}

gno_status gnoi_picture_pfm(const gnoi_picture *picture, gnoi_file *file)
{
    const unsigned one = 1;
    const int little = *(const unsigned char *)&one == 1;
    char head[64];
    const int length = snprintf(head, sizeof head, "PF\n%d %d\n%s\n", picture->width, picture->height, little ? "-1.0" : "1.0");
    const size_t bytes = (size_t)picture->width * 3 * sizeof(float);
    float *row = gno_context_realloc(file->context, NULL, 0, bytes);
    if (row == NULL) {
        return gno_context_fail(file->context, GNO_ERROR_MEMORY, "out of memory for a picture row");
    }
    gnoi_file_write(file, head, (size_t)length);
    write_rows(picture, file, bytes, row);
    gno_context_realloc(file->context, row, bytes, 0);
    return GNO_OK;
}
