/* What the law of scene%accuracy expects of a half-space whose spacing the deck chose itself
 * (ground.c, doc/verification/accuracy.md). */
#ifndef SELAS_ACCURACY_OUTLOOK_H
#define SELAS_ACCURACY_OUTLOOK_H

#include "scene/scene.h"

/* Thickness of absorbing layers that is enough, in P wavelengths at the mean frequency of the velocities. */
#define LAYER_THICKNESS 0.15

struct ground_outlook {
    double error;      /* relative L2 of the velocity at the worst receiver, by the spacing alone */
    double wavelength; /* of P at the mean frequency of the exact velocity, the longest of the receivers */
    long layer_points; /* that scene%accuracy would take for such an error */
};

/* False if there is no law for the scene, no exact solution or no memory. Takes the exact histories of at
 * most eight receivers: a tenth of a second, more for kinked histories. */
bool ground_outlook(const struct scene *scene, struct ground_outlook *outlook);

#endif
