/* Damping of the ground of reference 'layered' by the relaxation mechanisms of a run. */
#ifndef SELAS_LAYERED_DAMPING_H
#define SELAS_LAYERED_DAMPING_H

#include "exact/seismogram.h"
#include "scene/scene.h"

struct layered_damping {
    size_t mechanisms;            /* 0: constant Q, or no damping */
    double rate[MOST_MECHANISMS]; /* angular frequencies */
    double misfit;                /* of the modulus, relative, times Q */
};

/* Puts method%mechanisms of them (3 if none are said) in the place of constant Q, with rates that suit the
 * middle one of all Q. SELAS_BAD_SCENE, SELAS_NO_MEMORY. */
selas_status layered_mechanisms(const struct scene *scene, size_t rocks, struct seismogram_rock *rock,
                                struct layered_damping *damping, struct messages *messages);

#endif
