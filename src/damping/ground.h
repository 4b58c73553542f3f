/* The damping of a scene's materials: what is wanted, and the relaxation mechanisms that a run and an exact
 * solution take in its place (doc/theory/damping.md, section 2). */
#ifndef SELAS_DAMPING_GROUND_H
#define SELAS_DAMPING_GROUND_H

#include "damping/relaxation.h"
#include "scene/scene.h"

/* Moduli lambda + 2 mu and mu of a material. */
struct damped_moduli {
    struct modulus axial, shear;
};

struct ground_damping {
    struct relaxation_band band;  /* of the loads and moved faces */
    double centroid;              /* angular frequency */
    size_t mechanisms;            /* common to all materials */
    double rate[MOST_MECHANISMS]; /* angular frequencies */
    double
        misfit; /* root mean square of Q |M/M_wanted - 1| of the middle one of all Q, weighed by the band */
    size_t materials;
    struct damped_moduli *wanted, *fitted; /* [materials]; equal where there is no damping */
};

/* Is any of the scene's materials damped? */
bool ground_is_damped(const struct scene *scene);
/* What is wanted; with `fitted`, method%mechanisms (3 if none are said) for all damped materials too. NULL
 * where nothing is damped. SELAS_BAD_SCENE, SELAS_NO_MEMORY. */
selas_status ground_damping_new(const struct scene *scene, bool fitted, struct ground_damping **damping,
                                struct messages *messages);
void ground_damping_free(struct ground_damping *damping);

#endif
