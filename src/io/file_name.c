/* file_name.c -- see file_name.h. */
#include "io/file_name.h"

#include <string.h>

const char *gnoi_base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

const char *gnoi_extension(const char *path)
{
    const char *dot = strrchr(gnoi_base_name(path), '.');
    return dot != NULL ? dot : "";
}

int gnoi_has_extension(const char *path, const char *lower)
{
    const char *own = gnoi_extension(path);
    for (; *own != '\0' && *lower != '\0'; own++, lower++) {
        const char c = *own >= 'A' && *own <= 'Z' ? (char)(*own - 'A' + 'a') : *own;
        if (c != *lower) {
            return 0;
        }
    }
    return *own == *lower;
}
