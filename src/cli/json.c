/* json.c -- see json.h. */
#include "cli/json.h"

#include <math.h>
#include <stdlib.h>

/* Length of the UTF-8 sequence that starts here, 0: none. Overlong forms, surrogates and values beyond U+10FFFF are none. */
static int utf8_length(const unsigned char *c)
{
    const int length = c[0] < 0x80 ? 1 : c[0] < 0xC2 ? 0 : c[0] < 0xE0 ? 2 : c[0] < 0xF0 ? 3 : c[0] < 0xF5 ? 4 : 0;
    for (int i = 1; i < length; i++) {
        if ((c[i] & 0xC0) != 0x80) {
            return 0;
        }
    }
    const int wrong = (c[0] == 0xE0 && c[1] < 0xA0) || (c[0] == 0xED && c[1] > 0x9F) || (c[0] == 0xF0 && c[1] < 0x90) ||
                      (c[0] == 0xF4 && c[1] > 0x8F);
    return length > 1 && wrong ? 0 : length;
}

void json_string(FILE *out, const char *text)
{
    const unsigned char *c = (const unsigned char *)text;
    fputc('"', out);
    while (*c != '\0') {
        const int length = utf8_length(c);
        if (length == 0) {
            fputs("\\ufffd", out);
        } else if (*c == '"' || *c == '\\') {
            fprintf(out, "\\%c", *c);
        } else if (*c < 0x20) {
            fprintf(out, "\\u%04x", *c);
        } else {
            fwrite(c, 1, (size_t)length, out);
        }
        c += length > 0 ? length : 1;
    }
    fputc('"', out);
}

void json_number(FILE *out, double value)
{
    char text[40] = "null"; /* JSON has no infinities */
    for (int digits = 6; isfinite(value) && digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) { /* exact on purpose */
            break;
        }
    }
    fputs(text, out);
}

void json_seconds(FILE *out, double value)
{
    fprintf(out, "%.6f", value);
}

void json_vector(FILE *out, const double value[3])
{
    for (int i = 0; i < 3; i++) {
        fputs(i == 0 ? "[" : ", ", out);
        json_number(out, value[i]);
    }
    fputc(']', out);
}
