/* Signals that ask a run to stop (SIGINT, SIGTERM) or to leave a checkpoint and go on (SIGUSR1). */
#ifndef SELAS_SIGNALS_H
#define SELAS_SIGNALS_H

#include <stdbool.h>

/* From now on SIGINT and SIGTERM are remembered; a second one ends the program at once. */
void signals_catch(void);
/* From now on SIGINT and SIGTERM do nothing: a rank without work must not end those that take them for a stop. */
void signals_pass(void);
/* From now on SIGUSR1 is remembered, and a file that becomes too long is an error: neither ends the program. */
void signals_end_nothing(void);
/* Name of the signal that asked to stop, NULL if none did. */
const char *signals_stop(void);
/* True once for each SIGUSR1. */
bool signals_save(void);

#endif
