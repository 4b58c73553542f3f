/* Loads that stay between absorbing layers, which give way to them (doc/theory/absorbing-faces.md, section 7). */
#ifndef SELAS_SCENE_RESTS_H
#define SELAS_SCENE_RESTS_H

#include "scene/scene.h"

/* The worst pair of a load that stays and a receiver. */
struct rest {
    size_t load, receiver;
    double error; /* of the displacement at the end of the run, over what the load leaves at that distance */
    long
        points; /* of layers that would leave little enough, if that much needs a word; 0: not even the most do */
};

/* Does any load stay in a scene with absorbing layers? Sets the worst pair by (17) to (19). */
bool worst_rest(const struct scene *scene, struct rest *rest);

/* An error that is not worth a word. */
#define REST_SEEN .02

#endif
