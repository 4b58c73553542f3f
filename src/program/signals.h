/* Signals that ask a run to stop (SIGINT, SIGTERM) or to leave a checkpoint and go on (SIGUSR1). */
#ifndef SELAS_SIGNALS_H
#define SELAS_SIGNALS_H

#include <stdbool.h>

/* From now on signals are remembered; a second SIGINT or SIGTERM ends the program at once. Files that become
 * too long are errors, not signals. */
void signals_watch(void);
/* Name of the signal that asked to stop, NULL if none did. */
const char *signals_stop(void);
/* True once for each SIGUSR1. */
bool signals_save(void);

#endif
