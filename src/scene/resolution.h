/* How finely a scene's points resolve its waves. */
#ifndef SELAS_SCENE_RESOLUTION_H
#define SELAS_SCENE_RESOLUTION_H

#include "scene/scene.h"

/* Part of the largest amplitude in the spectrum that still counts. */
#define SOURCE_COUNTS 0.05

/* Angular frequency above which the spectra of all loads and prescribed motions lie below SOURCE_COUNTS of
 * their largest amplitude (history_cutoff) [rad/time], but those of amplitude 0; 0 if there is none, INFINITY if it is
 * not known. */
double source_cutoff(const struct scene *scene);
/* The same for another part. */
double source_cutoff_at(const struct scene *scene, double counts);

/* Of the slowest wave in any of the materials: S, in one dimension P; INFINITY without materials. */
double slowest_speed(const struct scene *scene);

/* Smoothing with which a step has the cutoff of waves of this period (history_cutoff's bound (8 / (omega
 * smoothing))^4). */
double jump_smoothing(double period);

/* Of the slowest wave at that frequency, ahead of loads that move; 0 if nothing tells. */
double points_per_wavelength(const struct scene *scene);

#endif
