/* cli.h -- what the files of the command line tool share.
 *
 * Place: main.c picks a command by its name; each command is one file (render.c, info.c) that uses the libraries through
 * their public headers alone, and the helpers named here.
 */
#ifndef GNOMON_CLI_H
#define GNOMON_CLI_H

#include <gnomon/gnomon.h>
#include <gnomon/gnomon_io.h>

#if defined(__GNUC__)
#define CLI_PRINTF(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define CLI_PRINTF(format_index, first)
#endif

/* Exit statuses; an interrupted run ends with 128 + signal, as shells count it. */
enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2, EXIT_SIGNAL = 128 };

typedef struct command {
    const char *name;
    const char *summary;
    int (*run)(int argc, char **argv); /* arguments after the command's name; returns the exit status */
} command;

extern const command command_render, command_vector, command_lit, command_info, command_matrix;

/* One line on standard error, with the program's name in front. */
void say(const char *format, ...) CLI_PRINTF(1, 2);

/* The same, followed by a pointer to the help; returns EXIT_USAGE. command_name may be NULL. */
int usage(const char *command_name, const char *format, ...) CLI_PRINTF(2, 3);

/* Whether everything printed to standard output really went out; says so when not. Returns an exit status. */
int close_output(void);

#endif
