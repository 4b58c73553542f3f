/* Time stepping: state in, state out. Schemes are in the table of names in stepping/schemes.c, one file each.
 */
#ifndef SELAS_STEPPING_H
#define SELAS_STEPPING_H

#include "method/model.h"

struct state {
    double time;
    unsigned long step;
    double *y; /* [model->state_size] = [u | v | extra] at `time` */
    double *a; /* [model->unknowns] acceleration at `time` (as the scheme sees it) */
};

struct stepper;

struct scheme_class {
    const char *name;
    int order;               /* in time */
    bool needs_acceleration; /* uses accelerate() (second-order form); otherwise rate() */
    double evaluations;      /* operator calls a step (for stages = 0: per stage) */
    /* Largest stable dt for undamped frequency omega and damping rate (real eigenvalue) `viscous`, either may
     * be 0. */
    double (*limit)(double omega, double viscous, long stages);
    size_t vectors; /* work vectors of state_size that the scheme needs */
    /* Makes state->a (and what else the scheme keeps) right at the start or after a restart. */
    void (*start)(struct stepper *stepper, struct state *state);
    void (*step)(struct stepper *stepper, struct state *state);
    /* Corrects a receiver's finished history in place; rows 0..n-1 are steps of dt; u, v, a: [3 * n],
     * row-major. NULL: nothing. */
    void (*finish)(const struct stepper *stepper, size_t n, double *u, double *v, double *a);
};

struct stepper {
    const struct scheme_class *scheme;
    struct model *model;
    double dt;
    long stages;
    double largest_frequency; /* measured, 0 if not asked for */
    double viscous_radius;    /* measured, 0 if none */
    char dt_reason[160];      /* how the step was chosen, for the report */
    double **work;            /* [scheme->vectors] arrays of state_size */
    double *load, *motion;    /* amplitudes: [3 * loads], [3 * FACES] (three instants for differences) */
    void *memory;             /* of the scheme */
};

const struct scheme_class *scheme_find(const char *name);
/* Chooses scheme, stages and dt from scene->stepping and the measured spectrum; refuses what cannot be stable
 * unless `force`. */
selas_status stepper_create(struct model *model, struct stepper **stepper, struct messages *messages);
void stepper_free(struct stepper **stepper);

/* stepping/drive.c: fills a drive for time t; `derivative` 0, or 2 = second difference over dt of the load
 * amplitudes. */
void drive_at(struct stepper *stepper, double time, struct drive *drive);
/* stepping/spectrum.c: largest frequency of the undamped operator (rad per time) by Lanczos or power
 * iteration. */
double largest_frequency(struct model *model, double *work[4], double tolerance);

#endif
