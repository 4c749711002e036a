/* compare.h -- how far two float pictures are apart, and PFM files for tests. Place: tests; knows nothing of gnomon. */
#ifndef TESTS_SUPPORT_COMPARE_H
#define TESTS_SUPPORT_COMPARE_H

#include <stddef.h>

typedef struct picture_difference {
    double rms;    /* over all pixels and channels; infinite when a value is not finite */
    double max;    /* largest absolute difference of a channel; infinite when a value is not finite */
    size_t worst;  /* the pixel of max */
    size_t above;  /* pixels with a channel that differs by more than the threshold, or is not finite */
    size_t broken; /* values that are not finite, in either picture */
} picture_difference;

/* a and b hold `pixels` RGB triples. */
picture_difference picture_compare(const float *a, const float *b, size_t pixels, double threshold);

/* Reads a three-channel PFM of either byte order, top row first in memory; free() the result. NULL when it cannot. */
float *picture_read_pfm(const char *path, int *width, int *height);

/* Returns 0 when the file could not be written. */
int picture_write_pfm(const char *path, int width, int height, const float *rgb);

#endif
