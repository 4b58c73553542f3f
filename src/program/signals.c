/* Signals (see the header): the handler only notes what came; the run looks after each step. */
#include "program/signals.h"

#include <signal.h>
#include <stddef.h>

static volatile sig_atomic_t stop_asked, save_asked;

static void note(int number)
{
    if (number == SIGUSR1)
        save_asked = 1;
    else
        stop_asked = number;
}

static void on(int number, void (*handler)(int), int flags)
{
    struct sigaction action = {.sa_handler = handler, .sa_flags = flags};
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, NULL);
}

void signals_catch(void)
{
    on(SIGINT, note, SA_RESTART | (int)SA_RESETHAND);
    on(SIGTERM, note, SA_RESTART | (int)SA_RESETHAND);
}

void signals_pass(void)
{
    on(SIGINT, SIG_IGN, 0);
    on(SIGTERM, SIG_IGN, 0);
}

void signals_end_nothing(void)
{
    on(SIGUSR1, note, SA_RESTART);
    on(SIGXFSZ, SIG_IGN, 0);
}

const char *signals_stop(void)
{
    return stop_asked == 0 ? NULL : stop_asked == SIGINT ? "SIGINT" : "SIGTERM";
}

bool signals_save(void)
{
    const bool asked = save_asked != 0;
    save_asked = 0;
    return asked;
}
