/* Seismograms of plane, damped strata over a half-space: sources and receivers at any depth
 * (doc/theory/seismograms.md). Coordinates: depth z down from the free surface z = 0. */
#ifndef SELAS_SEISMOGRAM_H
#define SELAS_SEISMOGRAM_H

#include "base/messages.h"
#include "damping/modulus.h"
#include "exact/patch.h"
#include "scene/history.h"

struct seismogram_rock {
    double top; /* depth of its upper face; 0 for the first */
    double density;
    struct modulus axial, shear; /* lambda + 2 mu, mu */
};

struct seismogram_source {
    double position[3];
    double force[3];    /* of a point; per area of a patch */
    double moment[6];   /* xx yy zz xy yz zx; points only */
    struct patch patch; /* PATCH_POINT: a point; else on the surface, centred at the position */
    const struct history *history;
};

struct seismogram_problem {
    size_t rocks;
    const struct seismogram_rock *rock; /* ascending tops; the last one goes on for ever */
    size_t sources;
    const struct seismogram_source *source;
    double end_time;
    double tolerance; /* wanted: L2 error of a velocity component over the L2 of the largest; 0: default */
    double stretch;   /* period of the FFT over end_time; 0: default */
    bool stress;      /* wanted too (point sources only) */
};

/* How it was computed, and what was reached: relative errors as in `tolerance`, bounds from samples. */
struct seismogram_effort {
    double cutoff;         /* largest angular frequency */
    double period, decay;  /* T and eta of s = eta + 2 pi i j / T */
    double evaluations;    /* wavenumbers times frequencies */
    double of_wavenumbers; /* error of the sums over wavenumbers */
    double of_frequencies; /* of what lies above the cutoff */
    double of_period;      /* of what comes round from the next period */
    double reached;        /* all of them */
};

enum { SEISMOGRAM_DISPLACEMENT = 0, SEISMOGRAM_VELOCITY = 3, SEISMOGRAM_STRESS = 6, SEISMOGRAM_LINES = 12 };

/* One receiver: regular rows, each line times exp(-decay t). */
struct seismogram {
    double position[3];
    double end_time, decay, step;
    size_t lines, rows; /* lines: 6, or 12 with stress (xx yy zz xy yz zx) */
    double *value;      /* [lines * rows] */
    struct seismogram_effort effort;
};

/* Whether there are such seismograms: SELAS_BAD_SCENE, with the reason. */
selas_status seismograms_check(const struct seismogram_problem *problem, size_t n,
                               const struct seismogram *seismogram, struct messages *messages);
/* n receivers; seismogram[i].position is given, the rest is set. SELAS_BAD_SCENE (with the reason),
 * SELAS_NO_MEMORY; then no value is kept. */
selas_status seismograms(const struct seismogram_problem *problem, size_t n, struct seismogram *seismogram,
                         struct messages *messages);
void seismogram_free(struct seismogram *seismogram);
/* All lines at a time <= end_time; 0 before t = 0. */
void seismogram_at(const struct seismogram *seismogram, double t, double value[SEISMOGRAM_LINES]);

#endif
