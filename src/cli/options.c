/* options.c -- see options.h. */
#include "cli/options.h"

#include "cli/cli.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST_NAME = 31, MOST_OPTIONS = 32 };

option_reader option_reader_make(const char *command_name, const option *options, int option_count, int argc, char **argv)
{
    const option_reader reader = {command_name, options, option_count, argc, argv, 0, 0, NULL};
    return reader;
}

static int wrong_name(const option_reader *reader, const char *name, size_t length)
{
    char given[LONGEST_NAME + 1];
    const char *names[MOST_OPTIONS];
    int count = 0;
    for (; count < reader->option_count && count < MOST_OPTIONS; count++) {
        names[count] = reader->options[count].name;
    }
    snprintf(given, sizeof given, "%.*s", (int)length, name);
    const char *near = nearest_name(given, names, count);
    if (near != NULL) {
        usage(reader->command, "unknown option \"--%s\"; did you mean \"--%s\"?", given, near);
    } else {
        usage(reader->command, "unknown option \"--%s\"", given);
    }
    return OPTION_WRONG;
}

/* Takes the value from the same word or the next one. */
static int take_value(option_reader *reader, int index, char *attached)
{
    const option *found = &reader->options[index];
    reader->value = attached;
    if (found->argument == NULL) {
        if (attached == NULL) {
            return index;
        }
        usage(reader->command, "option --%s takes no value", found->name);
        return OPTION_WRONG;
    }
    if (attached == NULL) {
        if (reader->next >= reader->argc) {
            usage(reader->command, "option --%s needs a value: %s", found->name, found->argument);
            return OPTION_WRONG;
        }
        reader->value = reader->argv[reader->next++];
    }
    return index;
}

static int long_option(option_reader *reader, char *name)
{
    char *equals = strchr(name, '=');
    const size_t length = equals != NULL ? (size_t)(equals - name) : strlen(name);
    for (int i = 0; i < reader->option_count; i++) {
        if (strlen(reader->options[i].name) == length && strncmp(reader->options[i].name, name, length) == 0) {
            return take_value(reader, i, equals != NULL ? equals + 1 : NULL);
        }
    }
    return wrong_name(reader, name, length);
}

int option_next(option_reader *reader)
{
    if (reader->next >= reader->argc) {
        return OPTION_END;
    }
    char *word = reader->argv[reader->next++];
    if (!reader->only_operands && strcmp(word, "--") == 0) {
        reader->only_operands = 1;
        return option_next(reader);
    }
    if (reader->only_operands || word[0] != '-' || word[1] == '\0') {
        reader->value = word;
        return OPTION_OPERAND;
    }
    if (word[1] == '-') {
        return long_option(reader, word + 2);
    }
    for (int i = 0; i < reader->option_count; i++) {
        if (reader->options[i].letter == word[1]) {
            return take_value(reader, i, word[2] != '\0' ? word + 2 : NULL);
        }
    }
    usage(reader->command, "unknown option \"%s\"", word);
    return OPTION_WRONG;
}

int options_read(option_reader *reader, int (*take)(void *job, int id, char *value), void *job, const char **scene)
{
    *scene = NULL;
    for (int id = option_next(reader); id != OPTION_END; id = option_next(reader)) {
        if (id == OPTION_WRONG) {
            return EXIT_USAGE;
        }
        if (id == OPTION_OPERAND) {
            if (*scene != NULL) {
                return usage(reader->command, "one scene at a time: \"%s\" after \"%s\"", reader->value, *scene);
            }
            *scene = reader->value;
            continue;
        }
        const int status = take(job, id, reader->value);
        if (status >= 0) {
            return status;
        }
    }
    return *scene != NULL ? -1 : usage(reader->command, "no scene given");
}

void option_print(const option *options, int option_count)
{
    enum { COLUMN = 28 };
    for (int i = 0; i < option_count; i++) {
        char left[80];
        const char letter[] = {'-', options[i].letter, ',', ' ', '\0'};
        snprintf(left, sizeof left, "  %s--%s%s%s", options[i].letter != 0 ? letter : "", options[i].name,
                 options[i].argument != NULL ? " " : "", options[i].argument != NULL ? options[i].argument : "");
        printf("%-*s", COLUMN, left);
        for (const char *c = options[i].help; *c != '\0'; c++) {
            putchar(*c);
            if (*c == '\n') {
                printf("%*s", COLUMN, "");
            }
        }
        putchar('\n');
    }
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

/* Edit distance with swaps of neighbours counting one (Damerau 1964), by the usual table of prefixes. */
static int distance(const char *a, const char *b)
{
    int table[LONGEST_NAME + 1][LONGEST_NAME + 1];
    const int rows = (int)strlen(a), columns = (int)strlen(b);
    for (int i = 0; i <= rows; i++) {
        for (int j = 0; j <= columns; j++) {
            if (i == 0 || j == 0) {
                table[i][j] = i + j;
                continue;
            }
            int best = smaller(table[i - 1][j], table[i][j - 1]) + 1;
            best = smaller(best, table[i - 1][j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                best = smaller(best, table[i - 2][j - 2] + 1);
            }
            table[i][j] = best;
        }
    }
    return table[rows][columns];
}

const char *nearest_name(const char *name, const char *const *names, int count)
{
    const char *best = NULL;
    int best_distance = LONGEST_NAME;
    if (name[0] == '\0' || strlen(name) > LONGEST_NAME) {
        return NULL;
    }
    for (int i = 0; i < count; i++) {
        const int length = (int)strlen(names[i]);
        const int far = length <= LONGEST_NAME ? distance(name, names[i]) : LONGEST_NAME;
        /* More than a third wrong is another word. */
        if (far < best_distance && far <= (length + 2) / 3) {
            best = names[i];
            best_distance = far;
        }
    }
    return best;
}

int parse_int(const char *text, int least, int most, int *value)
{
    char *end;
    errno = 0;
    if (text[0] < '0' || text[0] > '9') {
        return 0;
    }
    const long number = strtol(text, &end, 10);
    if (*end != '\0' || errno != 0 || number < least || number > most) {
        return 0;
    }
    *value = (int)number;
    return 1;
}

int parse_real(const char *text, double *value)
{
    char *end;
    const double number = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(number)) {
        return 0;
    }
    *value = number;
    return 1;
}

int parse_size(const char *text, int *width, int *height)
{
    char copy[32];
    snprintf(copy, sizeof copy, "%s", text);
    char *x = strpbrk(copy, "xX");
    if (x == NULL || strlen(text) >= sizeof copy) {
        return 0;
    }
    *x = '\0';
    return parse_int(copy, 1, GNO_MAX_IMAGE_SIDE, width) && parse_int(x + 1, 1, GNO_MAX_IMAGE_SIDE, height);
}

int parse_bytes(const char *text, size_t *value)
{
    static const char letters[] = "kKmMgGtT";
    char *end;
    double number = strtod(text, &end);
    const char *letter = *end != '\0' ? strchr(letters, *end) : NULL;
    if (end == text) {
        return 0;
    }
    for (int i = 0; letter != NULL && i <= (letter - letters) / 2; i++) {
        number *= 1024.0;
    }
    end += letter != NULL;
    end += end[0] == 'i' && end[1] == 'B' && letter != NULL;
    end += *end == 'B';
    if (*end != '\0' || !(number >= 1.0) || number >= (double)SIZE_MAX) {
        return 0;
    }
    *value = (size_t)number;
    return 1;
}

int parse_setting(char *text, gno_setting *setting)
{
    char *equals = strchr(text, '=');
    if (equals == NULL || equals == text) {
        return 0;
    }
    *equals = '\0';
    setting->key = text;
    setting->value = equals + 1;
    return 1;
}
