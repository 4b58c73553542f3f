/* A trial: the scene run once with coarser points than scene%accuracy is about to choose, held against the exact
 * solution or a finer trial, so that the choice stands on what was measured in this very scene
 * (doc/verification/accuracy.md, sections 2 and 8). */
#ifndef SELAS_ACCURACY_TRIAL_H
#define SELAS_ACCURACY_TRIAL_H

#include "compare/diff.h"
#include "exact/exact.h"
#include "scene/scene.h"

/* Runs the scene to its end, nothing of it written. `exact` not NULL: sets error [receivers] to the relative L2 errors
 * of the velocity vectors against it. `kept` [receivers] not NULL: copies of the histories, to be freed whatever comes
 * back. The scene stays the caller's. */
typedef selas_status trial_run(struct scene *scene, struct exact *exact, double *error,
                               struct history_file *kept, struct messages *messages);

/* Who can be asked for a trial; run NULL: nobody. */
struct trial {
    const struct deck *deck;
    trial_run *run;
};

#endif
