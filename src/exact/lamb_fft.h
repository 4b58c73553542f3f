/* The half-space under surface patches by FFT over frequency: what exact/lamb.c puts together and the tests
 * call directly. Coordinates: the body's own, relative to the surface; z down. */
#ifndef SELAS_LAMB_FFT_H
#define SELAS_LAMB_FFT_H

#include "base/messages.h"
#include "exact/half_space.h"
#include "exact/layered.h"
#include "exact/patch.h"
#include "scene/history.h"

struct lamb_load {
    struct patch patch;
    double traction[3]; /* amplitude times direction; for a point: the force */
    const struct history *history;
};

struct lamb_problem {
    struct half_space ground;     /* of the uppermost material */
    const struct layered *layers; /* NULL: there is no other */
    size_t loads;
    const struct lamb_load *load;
    double tolerance; /* wanted: L2 error of a velocity component over the L2 of the largest; 0: default */
};

/* How it was computed, largest over the receivers. */
struct lamb_effort {
    double cutoff; /* largest angular frequency */
    double largest_wavenumber;
    double period, decay; /* T and eta of the complex frequencies eta + 2 pi i j / T */
    double evaluations;   /* compliances */
    double estimate;      /* of the error, as in `tolerance` */
};

/* Part of one receiver's history that is found by FFT, times exp(-decay t), on a regular grid. */
struct lamb_signal {
    double position[3];
    double end_time, decay, step;
    size_t rows;
    double *statics; /* [3 * loads]: static displacements that are split off */
    double *front;   /* [3 * loads]: lamb_split_front */
    double *value;   /* [6 * rows], each component in one piece: ux uy uz vx vy vz */
    struct lamb_effort effort;
};

/* Computes n receivers at once for times up to end_time; signal[i].position is given, the rest is set. On
 * failure all value are NULL. */
selas_status lamb_fft(const struct lamb_problem *problem, double end_time, size_t n,
                      struct lamb_signal *signal, struct messages *messages);
void lamb_signal_free(struct lamb_signal *signal);
/* Displacement and velocity at a time <= end_time: the FFT part plus the closed forms split off. */
void lamb_signal_value(const struct lamb_problem *problem, const struct lamb_signal *signal, double t,
                       double value[6]);

/* The closed forms that are split off (lamb_split.c). */
/* True if the Rayleigh wave of this load is split off: piecewise linear history, vertical load. */
bool lamb_split_rayleigh(const struct lamb_load *load);
/* Adds the closed forms of one load at a point (x, y from the patch's centre). */
void lamb_split_static(const struct half_space *ground, const struct lamb_load *load, double x, double y,
                       double z, double displacement[3]);
/* What begins at once: velocity = front[i] * history(t - z/c), c the P speed for uz, the S speed for ux, uy.
 */
void lamb_split_front(const struct half_space *ground, const struct lamb_load *load, double x, double y,
                      double z, double front[3]);
/* Laplace transform of its displacement, per unit of the history's. */
void lamb_split_front_laplace(const struct half_space *ground, const double front[3], double complex s,
                              double z, double complex displacement[3]);
void lamb_split_value(const struct half_space *ground, const struct lamb_load *load, double x, double y,
                      double z, double t, const double front[3], double value[6]);

#endif
