/* Where, when and at what wavelength anything acts on a scene or is looked at. Every group of the deck, and
 * every kind within a group, states this here and nowhere else (doc/reference/scene.md, section 7): the box of a
 * half-space is fitted to it (fitted_box.c), and what a face sends back is judged by it (echo.c). */
#ifndef SELAS_SCENE_EXTENT_H
#define SELAS_SCENE_EXTENT_H

#include "scene/scene.h"

enum extent_role { EXTENT_IDLE, EXTENT_ACTS, EXTENT_SEEN };

struct extent {
    enum extent_role role;
    const char *group; /* of the deck, with its occurrence */
    size_t index;
    double low[3], high[3]; /* body frame; -INFINITY and INFINITY: as far as the body goes */
    double from, until;     /* ACTS: no motion before `from`; SEEN: not looked at after `until` */
    double wavelength; /* ACTS: P waves at the root mean square frequency of the velocity; INFINITY: static */
    double lasts, middle; /* ACTS: of a load's pulse (history.h) */
    bool skew[3];         /* ACTS: not its own mirror image across this axis of the body */
    bool dipole;          /* ACTS: a moment tensor */
    bool plane;           /* ACTS: alike all over the surface, along its normal */
};

/* Number `index` (from 0) of all extents of a scene, IDLE ones included; false past the last. Places need
 * body.frame; low and high of the body are not asked. */
bool scene_extent(const struct scene *scene, size_t index, struct extent *extent);

/* Does a group of the deck state what it acts on or looks at, or that it does neither? */
bool extent_stated(const char *group);

#endif
