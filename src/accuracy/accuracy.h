/* scene%accuracy: spacing, method and step from a wanted error (doc/verification/accuracy.md). */
#ifndef SELAS_ACCURACY_ACCURACY_H
#define SELAS_ACCURACY_ACCURACY_H

#include "accuracy/trial.h"

/* Builds the scene of a deck, which may ask for an accuracy in place of a spacing; else as scene_build(). `run`
 * may be NULL: then the choice follows from the laws alone. */
selas_status accuracy_build(const struct deck *deck, trial_run *run, struct scene **scene,
                            struct messages *messages);

#endif
