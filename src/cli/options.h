/* options.h -- reading a command's arguments by a table of its options.
 *
 * Place: under each command. Options and operands may come in any order; "--name value" and "--name=value", "-o value" and
 * "-ovalue" are the same; "--" ends the options; "-" is an operand or a value.
 */
#ifndef GNOMON_CLI_OPTIONS_H
#define GNOMON_CLI_OPTIONS_H

#include <gnomon/gnomon_io.h>

typedef struct option {
    const char *name;     /* without the dashes */
    char letter;          /* 0: none */
    const char *argument; /* what it is called in the help; NULL: the option takes none */
    const char *help;     /* lines after the first are indented by the printer */
} option;

/* Results of option_next beside an index into the table. */
enum { OPTION_END = -1, OPTION_OPERAND = -2, OPTION_WRONG = -3 };

typedef struct option_reader {
    const char *command;
    const option *options;
    int option_count;
    int argc;
    char **argv;
    int next;
    int only_operands;
    char *value; /* the option's argument or the operand */
} option_reader;

option_reader option_reader_make(const char *command_name, const option *options, int option_count, int argc, char **argv);

/* The next option's index in the table, or one of the above; after OPTION_WRONG the message is out already. */
int option_next(option_reader *reader);

/* Reads all arguments of a command that works on one scene: `take` gets each option with its argument and returns an exit status, or -1 to
 * go on. Returns an exit status, or -1 with the scene's path in *scene. */
int options_read(option_reader *reader, int (*take)(void *job, int id, char *value), void *job, const char **scene);

void option_print(const option *options, int option_count);

/* The name most like the given one, or NULL when none is. */
const char *nearest_name(const char *name, const char *const *names, int count);

/* Strict readers: the whole text must be a number in the range. Return 0 when it is not. */
int parse_int(const char *text, int least, int most, int *value);
int parse_real(const char *text, double *value);

/* WIDTHxHEIGHT, each from 1 to GNO_MAX_IMAGE_SIDE. */
int parse_size(const char *text, int *width, int *height);

/* Bytes: a number with K, M, G or T behind it for powers of 1024 ("512M", "1.5G", "64MiB"); at least 1. */
int parse_bytes(const char *text, size_t *value);

/* The words for --memory in every command's help. */
#define MEMORY_HELP                                                          \
    "stop with a message before more than SIZE bytes are held, e.g. 512M\n" \
    "or 2G; default: the machine's memory (what the file libraries take\n" \
    "for themselves is not counted)"

/* KEY=VALUE, cut in place at the first equals sign; the setting points into the text. */
int parse_setting(char *text, gno_setting *setting);

#endif
