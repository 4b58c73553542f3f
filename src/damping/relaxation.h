/* Relaxation mechanisms that stand for a wanted Q over the frequencies of a source (doc/theory/damping.md, Eqs 5 to
 * 8). */
#ifndef SELAS_RELAXATION_H
#define SELAS_RELAXATION_H

#include "base/messages.h"
#include "damping/modulus.h"

enum { RELAXATION_SAMPLES = 80 };

/* Angular frequencies, ascending, and what a misfit there counts: the squared spectrum of the source times
 * the step. */
struct relaxation_band {
    double angular_frequency[RELAXATION_SAMPLES], weight[RELAXATION_SAMPLES];
    struct mechanism_step by;
};

/* Squared spectrum of the source's velocity at an angular frequency. */
typedef double relaxation_power(const void *source, double angular_frequency);

/* Samples of three decades up to the angular frequency `top`. */
void relaxation_band_set(struct relaxation_band *band, double top, relaxation_power *power,
                         const void *source);

/* Centroid of the weights; where they, ascending, have come to a share of all. */
double relaxation_centroid(const struct relaxation_band *band);
double relaxation_quantile(const struct relaxation_band *band, double share);

/* Where a fit keeps the speed of what is wanted: at its reference or, where the source has nothing there and the fit
 * is free, at the next end of the band. */
double relaxation_held(const struct relaxation_band *band, double angular_frequency);

/* Rates of `mechanisms` (1 to MOST_MECHANISMS) mechanisms that fit the wanted modulus best, whatever its size;
 * *misfit: weighed root mean square of Q |M/M_Q - 1|, Q at the reference. SELAS_NO_MEMORY. */
selas_status relaxation_rates(const struct relaxation_band *band, const struct modulus *wanted,
                              size_t mechanisms, double rate[MOST_MECHANISMS], double *misfit,
                              struct messages *messages);

/* Weights that stand for one wanted modulus (Eq 6), whatever the others. SELAS_BAD_SCENE where they leave
 * nothing of it. */
selas_status relaxation_weights(const struct relaxation_band *band, size_t mechanisms,
                                const double rate[MOST_MECHANISMS], const struct modulus *wanted,
                                double weight[MOST_MECHANISMS], struct messages *messages);

/* Moduli with mechanisms of these rates in place of the wanted lambda + 2 mu and mu; the phase speeds are
 * kept at relaxation_held() of the reference. All weights, those of the bulk modulus too, are >= 0.
 * SELAS_BAD_SCENE where that is not possible. */
selas_status relaxation_fit(const struct relaxation_band *band, size_t mechanisms,
                            const double rate[MOST_MECHANISMS], struct modulus *axial, struct modulus *shear,
                            struct messages *messages);

#endif
