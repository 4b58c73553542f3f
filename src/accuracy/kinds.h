/* Parts of scene%accuracy (doc/verification/accuracy.md): one file for each kind of scene that there is a law for. */
#ifndef SELAS_ACCURACY_KINDS_H
#define SELAS_ACCURACY_KINDS_H

#include "accuracy/trial.h"
#include "scene/build.h"

struct accuracy_kind {
    /* True if the scene looks like one of this kind; what is wrong with it is then said by `refusal`. */
    bool (*looks_like)(const struct scene *scene);
    /* Variant of the method that was measured, and what to say of others; NULL: refusal() looks at it. */
    const char *variant, *served;
    /* NULL, or what this kind can be served with ("loads on a square or a disc"). */
    const char *(*refusal)(const struct scene *scene);
    /* Fails (SELAS_BAD_SCENE) only if no spacing will do or the exact solution is not for this scene. */
    selas_status (*choose)(const struct scene *scene, double accuracy, const struct trial *trial,
                           struct scene_choice *choice, struct messages *messages);
    bool velocity;  /* the error is that of the velocities at receivers */
    bool particles; /* the deck may say gradient and viscosity of particles: there are tables for them */
};

extern const struct accuracy_kind accuracy_beam, accuracy_ground, accuracy_plate, accuracy_refined,
    accuracy_wave;

/* NULL, or what this kind can be served with: the method first. */
const char *accuracy_refusal(const struct accuracy_kind *kind, const struct scene *scene);

/* Gradient of particles that the deck asks for, or the default. */
const char *accuracy_gradient(const struct scene *scene);

/* The middle, in ratio, of a fifth of the wanted error and all of it. */
#define ACCURACY_AIM 0.45
/* Where only few spacings will do: predictions up to here are taken before one below the least. */
#define ACCURACY_MOST 0.65
#define ACCURACY_LEAST 0.3

#endif
