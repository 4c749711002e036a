/* text_file.c -- see text_file.h. */
#include "io/text_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

gno_status gnoi_text_open(gno_context *context, const char *path, gnoi_text **text)
{
    gnoi_text *fresh = gno_context_realloc(context, NULL, 0, sizeof *fresh);
    gno_status status;
    *text = NULL;
    if (!fresh) {
        return gno_context_fail(context, GNO_ERROR_MEMORY, "out of memory");
    }
    fresh->used = 0;
    status = gnoi_file_open(context, path, 0, &fresh->file);
    if (status != GNO_OK) {
        gno_context_realloc(context, fresh, sizeof *fresh, 0);
        return status;
    }
    *text = fresh;
    return GNO_OK;
}

static void flush(gnoi_text *text)
{
    gnoi_file_write(&text->file, text->buffer, text->used);
    text->used = 0;
}

void gnoi_text_put(gnoi_text *text, const char *string)
{
    for (size_t left = strlen(string); left > 0;) {
        size_t room = GNOI_TEXT_BUFFER - text->used, n = left < room ? left : room;
        memcpy(text->buffer + text->used, string, n);
        text->used += n;
        string += n;
        left -= n;
        if (text->used == GNOI_TEXT_BUFFER) {
            flush(text);
        }
    }
}

void gnoi_text_char(gnoi_text *text, char c)
{
    text->buffer[text->used++] = c;
    if (text->used == GNOI_TEXT_BUFFER) {
        flush(text);
    }
}

void gnoi_text_integer(gnoi_text *text, long long value)
{
    char digits[GNOI_TEXT_LONGEST];
    snprintf(digits, sizeof digits, "%lld", value);
    gnoi_text_put(text, digits);
}

void gnoi_text_number(gnoi_text *text, double value)
{
    char digits[GNOI_TEXT_LONGEST];
    if (value > -1e9 && value < 1e9 && value == (double)(int)value) { /* also turns -0 into 0 */
        gnoi_text_integer(text, (int)value);
        return;
    }
    snprintf(digits, sizeof digits, "%.15g", value);
    gnoi_text_put(text, digits);
}

void gnoi_text_exact(gnoi_text *text, double value)
{
    char digits[GNOI_TEXT_LONGEST];
    snprintf(digits, sizeof digits, "%.15g", value);
    if (strtod(digits, NULL) != value) {
        snprintf(digits, sizeof digits, "%.17g", value);
    }
    gnoi_text_put(text, digits);
}

gno_status gnoi_text_close(gnoi_text *text, gno_status failed)
{
    gno_context *context = text->file.context;
    if (failed != GNO_OK) {
        gnoi_file_discard(&text->file);
    } else {
        flush(text);
        failed = gnoi_file_commit(&text->file);
    }
    gno_context_realloc(context, text, sizeof *text, 0);
    return failed;
}
