/* Sum over the wavenumbers of the half-space's compliance times a load's transform, at complex frequencies
 * (doc/theory/lamb.md, Eq 7). */
#ifndef SELAS_LAMB_SUM_H
#define SELAS_LAMB_SUM_H

#include "exact/lamb_fft.h"

enum { LAMB_COMPONENTS = 3 };

/* One load seen from one receiver. */
struct lamb_path {
    const struct lamb_load *load;
    double x, y, z; /* from the patch's centre */
    bool without_rayleigh, horizontal;
};

/* The wavenumbers that count at one frequency: all up to `flat`, fading out until `end`. */
struct lamb_range {
    double flat, end;
};

/* 12-point Gauss panels of one width from k = 0 on. */
struct lamb_grid {
    double panel;
    size_t nodes, room; /* nodes so far, room for them */
    double *k;          /* [room] */
    double *weight;     /* [paths][3 components][5 compliances][room]: coefficients of the compliances */
    double *statics;    /* [paths][5 compliances][room]: static ones, for the first path of a group */
};

/* Wide panels, and narrow ones, `refine` to a wide one, where poles and branch points are near the path. */
struct lamb_sum {
    const struct half_space *ground;
    const struct layered *layers; /* NULL: none */
    double slowest, fastest;      /* phase speeds of the poles and branch points */
    size_t paths, refine;
    struct lamb_path *path;
    struct lamb_grid wide, narrow;
};

/* `decay`: real part of the frequencies to come. */
selas_status lamb_sum_set(struct lamb_sum *sum, const struct lamb_problem *problem, size_t receivers,
                          const struct lamb_signal *signal, double decay, struct messages *messages);
void lamb_sum_free(struct lamb_sum *sum);
/* Makes ready for angular frequencies up to `cutoff` and wavenumbers up to `largest`; false: no memory. */
bool lamb_sum_extend(struct lamb_sum *sum, double cutoff, double largest);
/* Compliances that one sum up to the wavenumber `end` takes, about. */
double lamb_sum_effort(const struct lamb_sum *sum, double end);
/* Displacements times mu less the static ones, per unit of the history's transform: [paths][3]. Several
 * threads may call it at once. */
void lamb_sum_at(const struct lamb_sum *sum, double complex s, struct lamb_range range,
                 double complex *value);

#endif
