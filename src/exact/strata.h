/* Plane strata over a half-space in (wavenumber, Laplace) space with sources and receivers at any of their
 * levels: what a jump of motion or traction at one level moves at the others. Formulas and sources: strata.c,
 * doc/theory/seismograms.md (Eqs 1-13). */
#ifndef SELAS_STRATA_H
#define SELAS_STRATA_H

#include "exact/matrix2.h"
#include "exact/pair.h"

#include <stdbool.h>
#include <stddef.h>

/* One material at one Laplace frequency: moduli over a common one, s^2 over the squared speeds. */
struct rock_at {
    struct pair mu, axial; /* mu, lambda + 2 mu */
    struct pair w_p, w_s;  /* s^2 / c_p^2, s^2 / c_s^2 */
};

/* Jumps at a source of P-SV motion, each with its own responses. */
enum strata_column {
    COLUMN_VERTICAL, /* force down: Z = 1 */
    COLUMN_AXIAL,    /* M_zz: W = 1/(lambda + 2 mu), Q = k lambda/(lambda + 2 mu) */
    COLUMN_RADIAL,   /* force along k, M_nn: Q = 1 */
    COLUMN_DIP,      /* M_nz: U = 1/mu */
    COLUMN_ACROSS,   /* SH: force across k, M_tn: Y = 1 */
    COLUMN_TWIST,    /* SH: M_tz: V = 1/mu */
    COLUMNS
};

/* What a column moves at a receiver: u_r = i U, u_z = W, u_t = V, sigma_zz = -Z, sigma_nz = -i Q, sigma_tz =
 * -Y, (sigma_nn +- sigma_tt)/2 = MEAN, DIFFERENCE, sigma_nt = i TWIST. P-SV columns have U W Q Z and both
 * halves, SH columns V Y X in the places of U W Q. */
enum strata_response {
    RESPONSE_U,
    RESPONSE_W,
    RESPONSE_Q,
    RESPONSE_Z,
    RESPONSE_MEAN,
    RESPONSE_DIFFERENCE,
    RESPONSES
};
enum { RESPONSE_V = RESPONSE_U, RESPONSE_Y = RESPONSE_W, RESPONSE_X = RESPONSE_Q };

struct strata {
    size_t levels; /* faces of pieces: the surface, interfaces, sources, receivers */
    double *depth; /* [levels] ascending from 0 */
    size_t *rock;  /* [levels] material below each level */
    size_t rocks;
    size_t sources;   /* levels with sources */
    size_t *source;   /* [sources] */
    bool *moments;    /* [sources] whether more than forces act there */
    size_t receivers; /* levels with receivers */
    size_t *receiver; /* [receivers] */
    bool stress;      /* responses of stress are wanted */
};

/* One piece of ground between two levels, or below the last one: what one wavenumber makes of it. */
struct strata_piece {
    struct matrix2 below, above; /* impedances of the ground below and above its upper level */
    struct matrix2 down, up;     /* motions carried from the upper level to the lower one and back */
    struct pair across_below, across_above, across_down, across_up;
};

/* Responses for a wavenumber k > 0 and materials rock[strata->rocks] at one frequency of Re s > 0, Im s >= 0:
 * response[((source * receivers + receiver) * COLUMNS + column) * RESPONSES + response]; those that are not wanted
 * (no moments, no stress) are left alone. piece[levels]: scratch. */
void strata_responses(const struct strata *strata, const struct rock_at *rock, double k,
                      struct strata_piece *piece, struct pair *response);

#endif
