/* Signals that ask a run to stop (SIGINT, SIGTERM) or to leave a checkpoint and go on (SIGUSR1). */
#ifndef SELAS_SIGNALS_H
#define SELAS_SIGNALS_H

#include <stdbool.h>

/* From now on signals are remembered; a second SIGINT or SIGTERM ends the program at once. */
void signals_catch(void);
/* From now on a file that becomes too long is an error, not a signal that ends the program. */
void signals_no_size_limit(void);
/* Name of the signal that asked to stop, NULL if none did. */
const char *signals_stop(void);
/* True once for each SIGUSR1. */
bool signals_save(void);

#endif
