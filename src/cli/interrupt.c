/* interrupt.c -- see interrupt.h. */
#include "cli/interrupt.h"

#include <signal.h>
#include <stddef.h>
#include <string.h>
#include <time.h>

static const int caught[] = {SIGINT, SIGTERM, SIGHUP};

enum { CAUGHT = sizeof caught / sizeof caught[0] };

/* A signal so soon after the first is the same wish again: timeout(1) sends one to the program and one to its group. A later one
 * means that the user will not wait: it ends the program at once. */
#define SAME_WISH_SECONDS 1

static volatile sig_atomic_t received;
static time_t first_time; /* of the first signal; only the handler, which no other caught signal interrupts, uses it */

static void on_signal(int signal_number)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (received && now.tv_sec - first_time > SAME_WISH_SECONDS) {
        signal(signal_number, SIG_DFL);
        raise(signal_number); /* taken when the handler returns */
    } else if (!received) {
        first_time = now.tv_sec;
        received = signal_number;
    }
}

/* Signals that the program was started to ignore (nohup, background jobs) stay ignored. */
static void set_handlers(void (*handler)(int))
{
    for (int i = 0; i < CAUGHT; i++) {
        struct sigaction old, action;
        memset(&action, 0, sizeof action);
        action.sa_handler = handler;
        action.sa_flags = SA_RESTART;
        sigemptyset(&action.sa_mask);
        for (int k = 0; k < CAUGHT; k++) {
            sigaddset(&action.sa_mask, caught[k]);
        }
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
