/* text_file.h -- buffered text on its way into an atomic file.
 *
 * Place: tables and geometry as text (lit_table.c, pieces_obj.c, pieces_geojson.c) -> here -> atomic_file. Errors stay in the file.
 */
#ifndef GNOI_IO_TEXT_FILE_H
#define GNOI_IO_TEXT_FILE_H

#include "io/atomic_file.h"

enum { GNOI_TEXT_BUFFER = 1 << 16, GNOI_TEXT_LONGEST = 64 /* a number's text fits */ };

typedef struct gnoi_text {
    gnoi_file file;
    size_t used;
    char buffer[GNOI_TEXT_BUFFER];
} gnoi_text;

/* Errors: MEMORY, FILE. *text is NULL then. */
gno_status gnoi_text_open(gno_context *context, const char *path, gnoi_text **text);

void gnoi_text_put(gnoi_text *text, const char *string);
void gnoi_text_char(gnoi_text *text, char c);
void gnoi_text_number(gnoi_text *text, double value); /* 15 digits where needed */
void gnoi_text_exact(gnoi_text *text, double value);  /* 17 where 15 give another double */
void gnoi_text_integer(gnoi_text *text, long long value);

/* Makes the file appear and frees the text, or, failed not GNO_OK, removes it and returns that status. Errors: FILE. */
gno_status gnoi_text_close(gnoi_text *text, gno_status failed);

#endif
