/* The speed that plane waves have on a lattice, for scene%accuracy (lattice.c). */
#ifndef SELAS_ACCURACY_LATTICE_H
#define SELAS_ACCURACY_LATTICE_H

#include "scene/scene.h"

/* What may be chosen: degree, sweeps (0: exact mass), scheme with its order, 2 or 4, and whether the
 * time-dispersion transform goes with it; c_p dt / spacing at .9 of the limit in 1, 2, 3 dimensions and
 * nanoseconds a point and step. */
struct accuracy_setting {
    int degree, sweeps;
    const char *scheme;
    int order;
    bool transforms;
    double courant[3], cost;
};
enum { ACCURACY_SETTINGS = 4, LATTICE_OFFSETS = 5 };
extern const struct accuracy_setting accuracy_settings[ACCURACY_SETTINGS];

struct lattice_wave {
    const struct scene *scene;
    double direction[3], motion[3]; /* unit vectors in the body's frame */
    double speed;
    const struct accuracy_setting *setting;
    bool transformed; /* the time-dispersion transform leaves no error in time */
    double mass[LATTICE_OFFSETS], stiffness[LATTICE_OFFSETS], gradient[LATTICE_OFFSETS]; /* rows, spacing 1 */
};

/* Fills setting, transformed and rows. */
void lattice_wave_set(struct lattice_wave *wave, const struct accuracy_setting *setting);

/* e(omega): what speed and frequency are too large by, in parts of themselves; 1 where there is no such wave.
 */
double lattice_speed_error(const struct lattice_wave *wave, double spacing, double omega);

/* What a recorded velocity errs wherever the wave is (doc/verification/accuracy.md, section 5): in time, and
 * in place where it is read between lattice points. */
double lattice_local_error(const struct lattice_wave *wave, double spacing, double omega,
                           const double position[3]);
/* What each reflection at a held end costs. */
double lattice_held_error(const struct lattice_wave *wave, double spacing, double omega);
/* The part of a wave that a damper (a transmitting face) sends back. */
double lattice_damper_error(const struct lattice_wave *wave, double spacing, double omega);

#endif
