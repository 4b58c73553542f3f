/* A run of the program: steps with progress, checkpoints, signals; then the results. */
#ifndef SELAS_RUN_H
#define SELAS_RUN_H

#include "selas.h"

/* Runs to the end and writes the results; `from` is the checkpoint that the run goes on from, or NULL.
 * Messages of the simulation that are already on standard error are counted in *told (bytes). */
selas_status run_program(selas_simulation *simulation, const char *from, bool quiet, size_t *told);
/* Prints what the simulation has said since the last call. */
void tell_messages(const selas_simulation *simulation, size_t *told);
/* Prints a line `key: value` to the FILE `context`; NULL: nothing (ranks but the first, a quiet run). */
void print_line(void *context, const char *key, const char *value);

#endif
