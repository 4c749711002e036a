/* same.c -- how far two pictures differ, and whether only along edges. Place: under engines.sh and vector.sh.
 *
 * usage: same A B      both .pfm (linear) or .png (values as encoded); prints: mean difference, greatest, and the pixels that differ by more
 * than 0.01 where A's pixels around them differ by less than 0.02, from each other. Exit status 1 when sizes differ.
 */
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define OFF 0.01
#define FLAT 0.02

typedef struct picture {
    int width, height;
    float *rgb;
} picture;

static void die(const char *path)
{
    fprintf(stderr, "same: cannot read %s\n", path);
    exit(2);
}

static picture read_pfm(const char *path)
{
    picture p;
    char kind[3];
    double scale;
    FILE *f = fopen(path, "rb");
    if (!f || fscanf(f, "%2s %d %d %lf", kind, &p.width, &p.height, &scale) != 4 || strcmp(kind, "PF") || fgetc(f) != '\n') die(path);
    size_t row = 3 * (size_t)p.width;
    p.rgb = malloc(row * (size_t)p.height * sizeof *p.rgb);
    if (!p.rgb) die(path);
    for (int y = p.height - 1; y >= 0; y--)
        if (fread(p.rgb + row * (size_t)y, sizeof *p.rgb, row, f) != row) die(path);
    fclose(f);
    return p;
}

static picture read_png(const char *path)
{
    picture p;
    png_image image;
    memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&image, path)) die(path);
    image.format = PNG_FORMAT_RGB;
    png_byte *bytes = malloc(PNG_IMAGE_SIZE(image));
    size_t count = 3 * (size_t)image.width * image.height;
    p.width = (int)image.width;
    p.height = (int)image.height;
    p.rgb = malloc(count * sizeof *p.rgb);
    if (!bytes || !p.rgb || !png_image_finish_read(&image, NULL, bytes, 0, NULL)) die(path);
    for (size_t i = 0; i < count; i++) p.rgb[i] = (float)bytes[i] / 255;
    free(bytes);
    return p;
}

static picture read_picture(const char *path)
{
    size_t n = strlen(path);
    return n > 4 && !strcmp(path + n - 4, ".png") ? read_png(path) : read_pfm(path);
}

static double contrast(const picture *p, int x, int y)
{
    double most = 0;
    for (int k = 0; k < 3; k++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < p->height; v++)
            for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < p->width; u++) {
                double c = (double)p->rgb[3 * ((size_t)v * (size_t)p->width + (size_t)u) + (size_t)k];
                low = fmin(low, c);
                high = fmax(high, c);
            }
        most = fmax(most, high - low);
    }
    return most;
}

int main(int argc, char **argv)
{
    if (argc != 3) return 2;
    picture a = read_picture(argv[1]), b = read_picture(argv[2]);
    double sum = 0, worst = 0;
    long off = 0;
    if (a.width != b.width || a.height != b.height) {
        fprintf(stderr, "same: %d x %d and %d x %d\n", a.width, a.height, b.width, b.height);
        return 1;
    }
    for (int y = 0; y < a.height; y++)
        for (int x = 0; x < a.width; x++) {
            double here = 0;
            for (size_t k = 0; k < 3; k++) {
                size_t i = 3 * ((size_t)y * (size_t)a.width + (size_t)x) + k;
                double d = fabs((double)a.rgb[i] - (double)b.rgb[i]);
                sum += d;
                here = fmax(here, d);
            }
            worst = fmax(worst, here);
            off += here > OFF && contrast(&a, x, y) < FLAT;
        }
    printf("%.6f %.4f %ld\n", sum / (3.0 * a.width * a.height), worst, off);
    return 0;
}
