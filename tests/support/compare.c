/* compare.c -- see compare.h. */
#include "support/compare.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

picture_difference picture_compare(const float *a, const float *b, size_t pixels, double threshold)
{
    picture_difference r = {0, 0, 0, 0, 0};
    double sum = 0;
    for (size_t p = 0; p < pixels; p++) {
        double largest = 0;
        for (size_t c = 0; c < 3; c++) {
            double d = fabs((double)a[3 * p + c] - (double)b[3 * p + c]);
            if (!isfinite(d)) {
                d = INFINITY; /* a NaN must not slip through the comparisons below */
                r.broken++;
            }
            sum += d * d;
            if (d > largest) largest = d;
        }
        if (largest > threshold) r.above++;
        if (largest > r.max) {
            r.max = largest;
            r.worst = p;
        }
    }
    r.rms = pixels ? sqrt(sum / (3 * (double)pixels)) : 0;
    return r;
}

static int little_endian(void)
{
    uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1;
}

static void swap_floats(float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        unsigned char in[4], out[4];
        memcpy(in, &values[i], 4);
        for (int k = 0; k < 4; k++) out[k] = in[3 - k];
        memcpy(&values[i], out, 4);
    }
}

float *picture_read_pfm(const char *path, int *width, int *height)
{
    FILE *f = fopen(path, "rb");
    float *rgb = NULL;
    char kind[3] = "";
    double scale = 0;
    if (!f) return NULL;
    /* one single white character ends the header: fscanf must not eat more, data may look like spaces */
    if (fscanf(f, "%2s %d %d %lf", kind, width, height, &scale) != 4 || strcmp(kind, "PF") != 0 || fgetc(f) == EOF) goto end;
    if (*width < 1 || *height < 1 || *width > 65536 || *height > 65536 || scale == 0) goto end;
    size_t row = (size_t)*width * 3;
    rgb = malloc(row * (size_t)*height * sizeof *rgb);
    if (!rgb) goto end;
    for (int y = *height - 1; y >= 0; y--) { /* the file begins with the bottom row */
        if (fread(rgb + (size_t)y * row, sizeof *rgb, row, f) == row) continue;
        free(rgb);
        rgb = NULL;
        goto end;
    }
    if ((scale < 0) != little_endian()) swap_floats(rgb, row * (size_t)*height);
end:
    fclose(f);
    return rgb;
}

int picture_write_pfm(const char *path, int width, int height, const float *rgb)
{
    FILE *f = fopen(path, "wb");
    size_t row = (size_t)width * 3;
    if (!f) return 0;
    int ok = fprintf(f, "PF\n%d %d\n%s\n", width, height, little_endian() ? "-1.0" : "1.0") > 0;
    for (int y = height - 1; y >= 0 && ok; y--) ok = fwrite(rgb + (size_t)y * row, sizeof *rgb, row, f) == row;
    if (fclose(f) != 0) ok = 0;
    return ok;
}
