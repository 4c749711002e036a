/* obj_parse.h -- numbers and words of OBJ and MTL lines.
 *
 * Place: under obj.c and mtl.c. All functions read from a block of whole lines (gnoi_blocks): they stop at or before a
 * newline, which is always there, so none needs an end pointer.
 */
#ifndef GNOI_IO_OBJ_PARSE_H
#define GNOI_IO_OBJ_PARSE_H

#include <stddef.h>

/* Reads [+-]digits[.digits][e[+-]digits] at p, correctly rounded whatever the locale (infinite when too large for a
 * double). Returns the end of the number, or p when there is none: "nan" and "inf" are none. */
const char *gnoi_parse_number(const char *p, double *value);

/* Spaces, tabs, carriage returns, and a backslash before the end of the line: the statement goes on in the next one,
 * and *line counts it. */
const char *gnoi_parse_blank(const char *p, size_t *line);

/* The end of the word at p: a blank or newline. */
const char *gnoi_parse_word(const char *p);

/* The newline that ends p's line. */
const char *gnoi_parse_line_end(const char *p);

/* The end of p's line's text: the newline without blanks before it. */
const char *gnoi_parse_text_end(const char *p);

/* The newline that ends the statement at p; counts lines continued by a backslash. A comment is not continued. */
const char *gnoi_parse_statement_end(const char *p, size_t *line);

/* 1 at the end of a statement's words: newline or comment. */
static inline int gnoi_parse_at_end(const char *p)
{
    return *p == '\n' || *p == '#';
}

static inline int gnoi_parse_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* 1 for what may stand right after a number or keyword. */
static inline int gnoi_parse_ends_word(char c)
{
    return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\\' || c == '#';
}

#endif
