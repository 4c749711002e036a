/* text_file.h -- buffered text on its way into an atomic file.
 *
 * Place: tables, geometry, drawings and matrices as text (lit_table.c, pieces_*.c, vector_svg.c, matrix_write.c) -> here -> atomic_file.
 * Errors stay in the file. Numbers are written with a point whatever the locale.
 */
#ifndef GNOI_IO_TEXT_FILE_H
#define GNOI_IO_TEXT_FILE_H

#include "io/atomic_file.h"

enum { GNOI_TEXT_BUFFER = 1 << 16, GNOI_TEXT_LONGEST = 64 /* a number's text fits */, GNOI_JSON_LONGEST = 8 };

typedef struct gnoi_text {
    gnoi_file *file;
    gnoi_file own; /* of gnoi_text_open */
    size_t used;
    char buffer[GNOI_TEXT_BUFFER];
} gnoi_text;

/* Errors: MEMORY, FILE. *text is NULL then. */
gno_status gnoi_text_open(gno_context *context, const char *path, gnoi_text **text);

/* Makes the file appear and frees the text, or, failed not GNO_OK, removes it and returns that status. Errors: FILE. */
gno_status gnoi_text_close(gnoi_text *text, gno_status failed);

/* The same for a file that the caller has opened and will commit. NULL: out of memory. */
gnoi_text *gnoi_text_begin(gnoi_file *file);
void gnoi_text_end(gnoi_text *text);

void gnoi_text_bytes(gnoi_text *text, const char *bytes, size_t length);
void gnoi_text_put(gnoi_text *text, const char *string);
void gnoi_text_char(gnoi_text *text, char c);
void gnoi_text_short(gnoi_text *text, double value);  /* 12 digits where needed */
void gnoi_text_number(gnoi_text *text, double value); /* 15 digits where needed */
void gnoi_text_exact(gnoi_text *text, double value);  /* 17 where 15 give another double */
void gnoi_text_integer(gnoi_text *text, long long value);
void gnoi_text_size(gnoi_text *text, size_t value);

/* A byte of a JSON string as it is written there: quotes, backslashes and control characters escaped, others as they are, as names
 * in files are UTF-8. Returns the length; no zero is put behind. */
size_t gnoi_json_byte(char byte, char escaped[GNOI_JSON_LONGEST]);

#endif
