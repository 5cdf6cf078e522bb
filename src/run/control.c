/* See control.h. */
#include "run/control.h"

#include <signal.h>
#include <stddef.h>

/* Handlers can reach nothing but a global. */
static volatile sig_atomic_t control_signal;

static void note_signal(int number)
{
    control_signal = number;
}

void control_install(void)
{
    struct sigaction action = {.sa_handler = note_signal, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGUSR1, &action, NULL);
    sigaction(SIGUSR2, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGINT, &action, NULL);
    signal(SIGPIPE, SIG_IGN); /* a pipe that nobody reads must not kill a run */
}

int control_asked(void)
{
    return (int)control_signal;
}
