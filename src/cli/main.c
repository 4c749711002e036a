/* main.c -- the gnomon command: picks what to run.
 *
 * Place: first file to read of the tool. arguments -> command (render.c, info.c) -> libgnomon-io, libgnomon -> exit status.
 */
#include "cli/cli.h"
#include "cli/options.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

static const command *const commands[] = {&command_render, &command_vector, &command_lit, &command_info, &command_matrix};

enum { COMMANDS = sizeof commands / sizeof commands[0] };

void say(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("gnomon: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

int usage(const char *command_name, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("gnomon: ", stderr);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fprintf(stderr, "\nTry 'gnomon %s%s--help'.\n", command_name != NULL ? command_name : "", command_name != NULL ? " " : "");
    return EXIT_USAGE;
}

int close_output(void)
{
    const int failed = fflush(stdout) != 0;
    if (failed || ferror(stdout)) {
        say("standard output: writing failed: %s", failed ? strerror(errno) : "an earlier error");
        return EXIT_FAILED;
    }
    return EXIT_DONE;
}

static int help(void)
{
    printf("gnomon draws scenes made of polygons, with exact hidden surfaces and exact shadows.\n\n"
           "usage: gnomon COMMAND [OPTIONS] SCENE\n\n"
           "SCENE is a scene file (.yaml, .yml) or a mesh file alone (.obj, .ply, .stl, .gltf, .glb).\n\ncommands:\n");
    for (int i = 0; i < COMMANDS; i++) {
        printf("  %-10s%s\n", commands[i]->name, commands[i]->summary);
    }
    printf("\noptions:\n"
           "  -h, --help     this text; 'gnomon COMMAND --help' tells a command's options\n"
           "  --version      the version\n\n"
           "examples:\n"
           "  gnomon render bunny.obj                        a first look: bunny.png\n"
           "  gnomon render town.yaml -o town.exr --size 1920x1080\n"
           "  gnomon vector town.yaml -o town.svg            the same as shapes, without hidden parts\n"
           "  gnomon lit town.yaml -o lit.csv                how much of every polygon each light reaches\n"
           "  gnomon info town.yaml                          what is in it, and what is wrong with it\n"
           "  gnomon matrix town.yaml -o town.mtx            which polygons shade which\n\n"
           "exit status: 0 done, 1 it could not be done, 2 wrong usage, 128 + signal when interrupted\n");
    return close_output();
}

/* A closed standard stream would let the next opened file take its number, and messages would go into a picture.
 * Opened the wrong way round, so that using the stream still fails. */
static void keep_standard_streams(void)
{
    for (int descriptor = 0; descriptor < 3; descriptor++) {
        if (fcntl(descriptor, F_GETFD) == -1 && open("/dev/null", descriptor == 0 ? O_WRONLY : O_RDONLY) == -1) {
            return;
        }
    }
}

/* A freed block's pages serve the next one: given back to the system and asked for again, each would be cleared anew. */
static void keep_freed_pages(void)
{
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, INT_MAX);
#endif
}

int main(int argc, char **argv)
{
    keep_standard_streams();
    keep_freed_pages();
    /* A reader that went away shall be a failed write with a message and clean-up, not a sudden end. */
    signal(SIGPIPE, SIG_IGN);
    if (argc < 2) {
        return usage(NULL, "no command given");
    }
    const char *name = argv[1];
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || (strcmp(name, "help") == 0 && argc == 2)) {
        return help();
    }
    if (strcmp(name, "--version") == 0) {
        printf("gnomon %s\n", gno_version());
        return close_output();
    }
    static char help_option[] = "--help";
    const int asks_help = strcmp(name, "help") == 0;
    if (asks_help) {
        name = argv[2];
        argv[2] = help_option;
    }
    const char *names[COMMANDS + 2] = {[COMMANDS] = "--help", "--version"};
    for (int i = 0; i < COMMANDS; i++) {
        names[i] = commands[i]->name;
        if (strcmp(name, names[i]) == 0) {
            return commands[i]->run(argc - 2, argv + 2);
        }
    }
    const char *near = nearest_name(name, names, COMMANDS + 2);
    const char *kind = name[0] == '-' ? "option" : "command";
    return near != NULL ? usage(NULL, "unknown %s \"%s\"; did you mean \"%s\"?", kind, name, near)
                        : usage(NULL, "unknown %s \"%s\"", kind, name);
}
