/* json.h -- the little of JSON that the tool prints. Place: under the commands. */
#ifndef GNOMON_CLI_JSON_H
#define GNOMON_CLI_JSON_H

#include <stdio.h>

/* A quoted string; control characters and quotes escaped, bytes that are no UTF-8 (file names can be anything) as U+FFFD. */
void json_string(FILE *out, const char *text);

/* As few digits as give the same double back. */
void json_number(FILE *out, double value);
void json_seconds(FILE *out, double value); /* to the microsecond */
void json_vector(FILE *out, const double value[3]);

#endif
