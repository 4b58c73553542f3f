/* Laplace variables s = eta + 2 pi i j/T and the way back to time by FFT: what lamb_fft.c and seismogram.c share. */
#ifndef SELAS_CONTOUR_H
#define SELAS_CONTOUR_H

#include <complex.h>
#include <fftw3.h>
#include <stdbool.h>
#include <stddef.h>

struct contour {
    double period, decay; /* T, eta */
    size_t rows;          /* of the time grid over the whole period; 0: not made yet */
    fftw_plan plan;
    double complex *in;
    double *out; /* [rows] */
};

/* s of index j. */
double complex contour_frequency(const struct contour *contour, size_t j);
/* Makes the time grid for `frequencies` of them, eight samples in the shortest period; false: no memory. */
bool contour_grid(struct contour *contour, size_t frequencies);
/* (1/T) sum over j in [from, until) of line[j] exp(2 pi i j t/T), negative j by conjugation, to out: without
 * exp(eta t). `rate`: of its derivative. `faded`: the share at the upper end of [0, until) that fades out, less
 * what the same share of [0, from) does: what the band adds to histories that were faded out before it. */
void contour_transform(struct contour *contour, const double complex *line, size_t from, size_t until,
                       bool rate, double faded);
/* L2 norm over [0, end] of what out holds, times exp(eta t). */
double contour_norm(const struct contour *contour, double end);
void contour_free(struct contour *contour);

/* Gives each of `lines` lines of `used` numbers more room than until; *room: numbers a line has. False: no memory. */
bool contour_widen(double complex **spectrum, size_t lines, size_t used, size_t until, size_t *room);

#endif
