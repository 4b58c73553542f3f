/* What the files of the seismograms share: paths from sources to receivers, wavenumbers of a band of
 * frequencies, the weights of responses. Inside exact/ only. */
#ifndef SELAS_SEISMOGRAM_WORK_H
#define SELAS_SEISMOGRAM_WORK_H

#include "exact/seismogram.h"
#include "exact/strata.h"

enum {
    NODES = 48,          /* wavenumbers of a block: 4 panels of 12 */
    COMPONENTS = 9,      /* r theta z; stress rr tt zz rt tz zr */
    MOST_LINES = 58,     /* a column and what it is seen through */
    STATIC_RESPONSES = 5 /* vertical, horizontal, radial, coupled, shear */
};

/* A source seen from a receiver. */
struct path {
    const struct seismogram_source *source;
    size_t source_index, receiver_index;
    size_t source_level, receiver_level; /* indices into strata->source and ->receiver */
    double x, y, distance, cosine, sine; /* from the source, in the plane */
    double force[3], moment[6];          /* turned to axes along and across the path */
    bool patch;
    double statics[2][3]; /* of a patch: displacement times mu at Poisson's ratio 0, and its slope */
    size_t lines;
    unsigned char line[MOST_LINES]; /* those that are not 0 */
    double centre, width;           /* wavenumbers fade out as erfc((k - centre)/width)/2; width 0: do not */
    double end;                     /* beyond it nothing is left */
};

/* Accuracy of the sums: exp(-digits) of the integrands is left out, panels are `finer` times as narrow. */
struct finesse {
    double digits, finer;
};

struct wavenumbers {
    size_t nodes, room;
    double *k, *weight;
};

/* What a band of frequencies [low, high] asks for: singularities lie on k = t exp(-i angle), from <= t <= to.
 */
struct band {
    double complex low, high; /* Laplace variables */
    double from, to, angle;
};

/* --- seismogram_paths.c */
void path_set(struct path *path, const struct seismogram_source *source, const double position[3]);
/* Marks the lines of a path that are used. */
void path_find_lines(struct path *path, bool stress);
/* Weights [lines][NODES] of `count` wavenumbers with their quadrature weights. */
void path_weights(const struct path *path, size_t count, const double *k, const double *quadrature,
                  double *weight);
/* Adds the sum over the nodes of weights and responses ([COLUMNS * RESPONSES][2][NODES], real and imaginary
 * parts; of a patch [STATIC_RESPONSES][2][NODES]) to the components along and across the path. */
void path_sum(const struct path *path, size_t count, const double *weight, const double *response,
              double complex component[COMPONENTS]);
/* Components along and across the path to x y z (and xx yy zz xy yz zx). */
void path_turn(const struct path *path, bool stress, double complex component[COMPONENTS]);

/* --- seismogram_grid.c */
void band_set(struct band *band, const struct seismogram_problem *problem, double complex low,
              double complex high);
/* Range of a path's wavenumbers in a band: sets centre, width and end. */
void path_range(struct path *path, const struct seismogram_problem *problem, const struct strata *strata,
                const struct band *band, double digits);
/* Gauss panels up to `end`, fine enough for distances up to `reach`; false: no memory. */
bool wavenumbers_set(struct wavenumbers *grid, const struct band *band, double reach, double end,
                     struct finesse finesse);
void wavenumbers_free(struct wavenumbers *grid);

/* --- seismogram_sum.c */
/* Everything that the sums over wavenumbers need. */
struct sums {
    const struct seismogram_problem *problem;
    struct strata strata;
    size_t paths, receivers;
    struct path *path; /* [paths], those of a receiver together */
    double reach;      /* longest distance */
    bool patches;
    double evaluations;
};

selas_status sums_set(struct sums *sums, const struct seismogram_problem *problem, size_t receivers,
                      const struct seismogram *seismogram, struct messages *messages);
void sums_free(struct sums *sums);
/* Displacement (and stress: COMPONENTS in place of 3) of all receivers at n frequencies s[n] within the band,
 * each source's history included: value[(receiver * n + frequency) * COMPONENTS]. `unit`: per unit of the
 * histories. False: no memory. */
bool sums_at(struct sums *sums, const struct band *band, struct finesse finesse, size_t n,
             const double complex *s, bool unit, double complex *value);

#endif
