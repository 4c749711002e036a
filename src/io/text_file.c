/* text_file.c -- see text_file.h. */
#include "io/text_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

gnoi_text *gnoi_text_begin(gnoi_file *file)
{
    gnoi_text *text = gno_context_realloc(file->context, NULL, 0, sizeof *text);
    if (text != NULL) {
        text->file = file;
        text->used = 0;
    }
    return text;
}

gno_status gnoi_text_open(gno_context *context, const char *path, gnoi_text **text)
{
    gnoi_text *fresh = gno_context_realloc(context, NULL, 0, sizeof *fresh);
    *text = NULL;
    if (fresh == NULL) {
        return gno_context_fail(context, GNO_ERROR_MEMORY, "out of memory");
    }
    gno_status status = gnoi_file_open(context, path, 0, &fresh->own);
    if (status != GNO_OK) {
        gno_context_realloc(context, fresh, sizeof *fresh, 0);
        return status;
    }
    fresh->file = &fresh->own;
    fresh->used = 0;
    *text = fresh;
    return GNO_OK;
}

static void flush(gnoi_text *text)
{
    gnoi_file_write(text->file, text->buffer, text->used);
    text->used = 0;
}

void gnoi_text_bytes(gnoi_text *text, const char *bytes, size_t length)
{
    while (length > 0) {
        const size_t room = GNOI_TEXT_BUFFER - text->used, n = length < room ? length : room;
        memcpy(text->buffer + text->used, bytes, n);
        text->used += n;
        bytes += n;
        length -= n;
        if (text->used == GNOI_TEXT_BUFFER) {
            flush(text);
        }
    }
}

void gnoi_text_put(gnoi_text *text, const char *string)
{
    gnoi_text_bytes(text, string, strlen(string));
}

void gnoi_text_char(gnoi_text *text, char c)
{
    text->buffer[text->used++] = c;
    if (text->used == GNOI_TEXT_BUFFER) {
        flush(text);
    }
}

void gnoi_text_size(gnoi_text *text, size_t value)
{
    char digits[GNOI_TEXT_LONGEST];
    size_t first = sizeof digits;
    do {
        digits[--first] = (char)('0' + value % 10);
    } while ((value /= 10) > 0);
    gnoi_text_bytes(text, digits + first, sizeof digits - first);
}

void gnoi_text_integer(gnoi_text *text, long long value)
{
    if (value < 0) {
        gnoi_text_char(text, '-');
    }
    gnoi_text_size(text, (size_t)(value < 0 ? -value : value));
}

/* What is no digit, sign or exponent is the locale's decimal point, of one byte or more. */
static void put_real(gnoi_text *text, double value, int precision)
{
    char digits[GNOI_TEXT_LONGEST];
    const int length = snprintf(digits, sizeof digits, "%.*g", precision, value);
    for (int i = 0, in_point = 0; i < length; i++) {
        const int is_digit = strchr("0123456789+-eainf", digits[i]) != NULL; /* with the letters of inf and nan */
        if (is_digit || !in_point) {
            gnoi_text_char(text, is_digit ? digits[i] : '.');
        }
        in_point = !is_digit;
    }
}

void gnoi_text_short(gnoi_text *text, double value)
{
    put_real(text, value, 12);
}

void gnoi_text_number(gnoi_text *text, double value)
{
    if (value > -1e9 && value < 1e9 && value == (double)(int)value) { /* also turns -0 into 0 */
        gnoi_text_integer(text, (int)value);
    } else {
        put_real(text, value, 15);
    }
}

void gnoi_text_exact(gnoi_text *text, double value)
{
    char digits[GNOI_TEXT_LONGEST];
    snprintf(digits, sizeof digits, "%.15g", value);
    put_real(text, value, strtod(digits, NULL) == value ? 15 : 17);
}

void gnoi_text_end(gnoi_text *text)
{
    flush(text);
    gno_context_realloc(text->file->context, text, sizeof *text, 0);
}

gno_status gnoi_text_close(gnoi_text *text, gno_status failed)
{
    gno_context *context = text->file->context;
    if (failed != GNO_OK) {
        gnoi_file_discard(text->file);
    } else {
        flush(text);
        failed = gnoi_file_commit(text->file);
    }
    gno_context_realloc(context, text, sizeof *text, 0);
    return failed;
}

size_t gnoi_json_byte(char byte, char escaped[GNOI_JSON_LONGEST])
{
    static const char hex[] = "0123456789abcdef";
    const unsigned char c = (unsigned char)byte;
    size_t n = 0;
    if (c < 32 || c == 127) {
        memcpy(escaped, "\\u00", 4);
        escaped[4] = hex[c >> 4];
        escaped[5] = hex[c & 15];
        return 6;
    }
    if (c == '"' || c == '\\') {
        escaped[n++] = '\\';
    }
    escaped[n++] = byte;
    return n;
}
