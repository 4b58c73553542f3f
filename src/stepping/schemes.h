/* The schemes known to the table, and the two halves of a step that the leapfrog family shares. */
#ifndef SELAS_SCHEMES_H
#define SELAS_SCHEMES_H

#include "stepping/stepping.h"

extern const struct scheme_class scheme_leapfrog;
extern const struct scheme_class scheme_modified_equation;
extern const struct scheme_class scheme_euler;
extern const struct scheme_class scheme_pc2;
extern const struct scheme_class scheme_rk4;
extern const struct scheme_class scheme_rkc;
extern const struct scheme_class scheme_lsrk54;

/* v := v + dt/2 a, u := u + dt v, filter of the model if it has one, time and step move on. Needs work[0] if
 * the model filters. */
void leapfrog_drift(struct stepper *stepper, struct state *state);
/* v := v + dt/2 a, and back. */
void leapfrog_kick(struct stepper *stepper, struct state *state);
void leapfrog_unkick(struct stepper *stepper, struct state *state);

#endif
