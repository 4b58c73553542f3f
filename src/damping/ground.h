/* The damping of a scene's materials: what is wanted, and the relaxation mechanisms that a run and an exact
 * solution take in its place (doc/theory/damping.md, section 2). */
#ifndef SELAS_DAMPING_GROUND_H
#define SELAS_DAMPING_GROUND_H

#include "damping/relaxation.h"
#include "scene/ground.h"

/* Moduli lambda + 2 mu and mu of a material. */
struct damped_moduli {
    struct modulus axial, shear;
};

struct ground_damping {
    struct relaxation_band band;  /* of the loads and moved faces */
    double centroid;              /* angular frequency */
    size_t mechanisms;            /* common to all materials */
    double rate[MOST_MECHANISMS]; /* angular frequencies */
    double
        misfit; /* root mean square of Q |M/M_wanted - 1| of the middle one of all Q, weighed by the band */
    size_t materials; /* the scene's; behind them some values of its model (damping/samples.c) */
    struct damped_moduli *wanted, *fitted; /* [materials]; equal where there is no damping */
};

/* What is wanted; with `fitted`, method%mechanisms (3 if none are said) for all damped materials too. NULL
 * where nothing is damped. SELAS_BAD_SCENE, SELAS_NO_MEMORY. */
selas_status ground_damping_new(const struct scene *scene, bool fitted, struct ground_damping **damping,
                                struct messages *messages);
void ground_damping_free(struct ground_damping *damping);

/* Largest root mean square, weighed by the band, of |M/M_wanted - 1| of all moduli as fitted. */
double ground_damping_off(const struct ground_damping *damping);

/* Largest error of waves that ring, below the source's band, at frequencies (in cycles) from `lowest` on until end_time
 * or until they have faded: what the moduli are off there times pi times the cycles; 0 where none comes round once. */
double ground_damping_rings(const struct ground_damping *damping, double lowest, double end_time);

/* samples.c: values of a model's ground that have, of all, the least and the largest loss in compression at some Q_s:
 * at most MOST_SAMPLES; how many. Those without Q as one of them, undamped. */
enum { SAMPLE_CLASSES = 8, MOST_SAMPLES = 2 * SAMPLE_CLASSES + 1 };
size_t damping_samples(const struct ground_model *model, struct material sample[MOST_SAMPLES]);

/* Weights for each Q between the least and the largest one of a model, over 1/Q. */
enum { CURVE_NODES = 65 };
struct damping_curve {
    double from, step;
    double weight[CURVE_NODES][MOST_MECHANISMS]; /* over 1/Q */
};
selas_status damping_curve_set(const struct ground_damping *damping, const struct ground_model *model,
                               struct damping_curve *curve, struct messages *messages);
/* weight[mechanisms] of a modulus with this Q. */
void damping_curve_at(const struct damping_curve *curve, size_t mechanisms, double q, double *weight);

#endif
