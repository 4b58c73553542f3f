/* The schemes known to the table, and the two halves of a step that the leapfrog family shares. */
#ifndef SELAS_SCHEMES_H
#define SELAS_SCHEMES_H

#include "stepping/stepping.h"

#define SCHEME_DECLARATION(symbol, word) extern const struct scheme_class scheme_##symbol;
SCHEMES(SCHEME_DECLARATION)
#undef SCHEME_DECLARATION

/* Fits the memory of a model that has some to the displacements at the start. */
void leapfrog_begin(struct stepper *stepper, struct state *state);
/* That memory, for a drive; NULL: none. */
const double *leapfrog_memory(const struct stepper *stepper, const struct state *state);
/* v := v + dt/2 a, u := u + dt v, filter and memory of the model if it has them, time and step move on. Needs
 * work[0] if the model filters. */
void leapfrog_drift(struct stepper *stepper, struct state *state);
/* v := v + dt/2 a, and back. */
void leapfrog_kick(struct stepper *stepper, struct state *state);
void leapfrog_unkick(struct stepper *stepper, struct state *state);
/* Brings held loads that have changed into a and, by half a step, into v; false if that takes the operator. */
bool leapfrog_hold(struct stepper *stepper, struct state *state);

#endif
