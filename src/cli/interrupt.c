/* interrupt.c -- see interrupt.h. */
#include "cli/interrupt.h"

#include <signal.h>
#include <stddef.h>
#include <string.h>

static const int caught[] = {SIGINT, SIGTERM, SIGHUP};

enum { CAUGHT = sizeof caught / sizeof caught[0] };

static volatile sig_atomic_t received; /* the only thing a handler may set */

static void on_signal(int signal_number)
{
    received = signal_number;
}

/* Signals that the program was started to ignore (nohup, background jobs) stay ignored. */
static void set_handlers(void (*handler)(int))
{
    for (int i = 0; i < CAUGHT; i++) {
        struct sigaction old, action;
        memset(&action, 0, sizeof action);
        action.sa_handler = handler;
        action.sa_flags = (int)((unsigned)SA_RESTART | (unsigned)SA_RESETHAND);
        sigemptyset(&action.sa_mask);
        if (sigaction(caught[i], NULL, &old) == 0 && old.sa_handler != SIG_IGN) {
            sigaction(caught[i], &action, NULL);
        }
    }
}

void interrupt_catch(void)
{
    set_handlers(on_signal);
}

void interrupt_release(void)
{
    set_handlers(SIG_DFL);
}

int interrupt_signal(void)
{
    return received;
}
