/* The receivers of a ground and the spectra of its exact velocities there: what the choice of a spacing looks at. */
#ifndef SELAS_ACCURACY_GROUND_TASK_H
#define SELAS_ACCURACY_GROUND_TASK_H

#include "accuracy/surface.h"
#include "exact/exact.h"

/* A ground, its receivers and the exact solution; what a trial measured is in the places' factors. */
struct task {
    const struct scene *scene;
    struct scene longer; /* the same for a quarter longer, which the exact solution is for */
    struct exact *exact;
    struct surface_place *place; /* [receivers] */
    double *power;
    double accuracy, aim;
    double expected; /* error of a trial before the last one that is taken as it is; else 0 */
};

/* Does a force or a moment tensor act at a point? */
bool points_act(const struct scene *scene);

/* The reference that knows the ground: 'lamb' or, with points that act or damping (constant Q), 'layered'. */
const char *exact_of_ground(const struct scene *scene);

/* Places and spectra of all receivers. To be ended whatever comes back. */
selas_status begin_task(const struct scene *scene, struct task *task, struct messages *messages);
void end_task(struct task *task);

enum { DAMPING_TEXT = 64 };
/* Damped ground: the fewest relaxation mechanisms whose exact histories are at all receivers within .3 of the wanted
 * error of those of constant Q, and words of it for the plan. SELAS_BAD_SCENE: none are. */
selas_status enough_mechanisms(const struct task *task, struct scene_choice *choice, char text[DAMPING_TEXT],
                               struct messages *messages);

#endif
