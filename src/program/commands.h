/* Subcommands of the program beside a run. */
#ifndef SELAS_COMMANDS_H
#define SELAS_COMMANDS_H

#include "selas.h"

enum { EXIT_DONE = 0, EXIT_RUN_FAILED = 1, EXIT_BAD_INPUT = 2 };

/* selas words [GROUP]; words[0] is "words"; returns the exit status, as the next one. */
int words_command(int count, char **words);

/* selas diff A B [--atol=X] [--rtol=X] [--plots=FOLDER]; words[0] is "diff". */
int diff_command(int count, char **words);

/* A deck as the command line names it. */
struct echo_deck {
    const char *path;
    size_t overrides;
    const char *const *override;
};
/* selas check --echo: prints what the faces send back to each receiver, measured in a box twice as large with
 * points up to twice as far apart, and what the law of absorbing layers expects there. */
selas_status check_echo(const struct echo_deck *deck);

#endif
