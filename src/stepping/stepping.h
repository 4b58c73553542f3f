/* Time stepping: state in, state out. Schemes are in the table of names in stepping/schemes.c, one file each.
 */
#ifndef SELAS_STEPPING_H
#define SELAS_STEPPING_H

#include "model/model.h"

struct state {
    double time;
    unsigned long step;
    double *y; /* [model->state_size] = [u | v | extra] at `time` */
    double *a; /* [model->unknowns] acceleration at `time` (as the scheme sees it) */
};

struct stepper;

/* What a host of the library drives in place of the deck's histories. */
struct host_drive {
    void *context;
    /* Amplitudes of all loads and displacements of all faces (per amplitude) at `time`: come in as the deck
     * has them; the host changes those that it drives. Called once for each step's time, in order, and for
     * one step ahead where a scheme takes second differences. */
    void (*at)(void *context, double time, double *load, double *displacement);
    bool moves;       /* drives faces */
    const bool *held; /* [loads] a value that the host holds until it changes it: no differences are taken */
};

/* Rows of a host's amplitudes at three neighbouring steps. */
enum { HOST_ROWS = 4 };

struct scheme_class {
    const char *name;
    int order;               /* in time */
    bool needs_acceleration; /* uses accelerate() (second-order form); otherwise rate() */
    double evaluations;      /* operator calls a step (for stages = 0: per stage) */
    /* Largest stable dt; 0 if none is, INFINITY if any is. */
    double (*limit)(const struct spectrum *spectrum, long stages);
    /* Schemes with a free number of stages: the number for a step dt (0: dt is free too). NULL: fixed. */
    long (*choose_stages)(const struct stepper *stepper, double dt);
    size_t vectors; /* work vectors of state_size that the scheme needs */
    /* Makes state->a (and what else the scheme keeps) right at the start or after a restart. */
    void (*start)(struct stepper *stepper, struct state *state);
    void (*step)(struct stepper *stepper, struct state *state);
    /* Makes state->a anew after a change of the loads at the state's own time, and the velocity with it where
     * that has half a step of a in it. */
    void (*again)(struct stepper *stepper, struct state *state);
    /* Corrects a receiver's finished history in place; rows 0..n-1 are steps of dt; u, v, a: [3 * n],
     * row-major. NULL: nothing to correct. */
    selas_status (*finish)(const struct stepper *stepper, size_t n, double *u, double *v, double *a,
                           struct messages *messages);
};

struct stepper {
    const struct scheme_class *scheme;
    struct model *model;
    double dt;
    long stages;
    struct spectrum spectrum; /* measured; omega with the bound on its error added */
    double frequency_error;   /* bound on the relative error of omega (Lanczos residual); 0 if unknown */
    double limit;             /* largest stable dt by the scheme's own limit; INFINITY if nothing vibrates */
    char dt_reason[160];      /* how the step was chosen, for the report */
    bool unwarp; /* time-dispersion transform: loads are warped beforehand, histories un-warped at the end */
    unsigned long steps;   /* steps from t = 0 until end_time is reached or passed */
    unsigned long extra;   /* steps beyond that the finished histories need */
    double **work;         /* [scheme->vectors] arrays of state_size */
    double *load, *motion; /* amplitudes handed to the model: [loads], [3 * FACES]: see drive_at */
    double *
        warped_load; /* [rows * loads] and [rows * FACES] if unwarp: amplitudes of the warped histories ... */
    double *warped_motion; /* ... (motion: of the displacement, not its second derivative) */
    unsigned long warped_rows;
    bool one_pass;                 /* the model makes whole steps: settle() before all of y is looked at */
    void *memory;                  /* of the scheme */
    const struct host_drive *host; /* borrowed; NULL: the deck's histories drive */
    double *host_row;              /* [HOST_ROWS * (loads + FACES)] */
    long host_step[HOST_ROWS];     /* step of each row, -1: none */
};

const struct scheme_class *scheme_find(const char *name);
/* Chooses scheme, stages and dt from scene->stepping and the measured spectrum; refuses what cannot be stable
 * unless `force` (SELAS_BAD_SCENE). */
selas_status stepper_create(struct model *model, struct stepper **stepper, struct messages *messages);
void stepper_free(struct stepper **stepper);

/* stepping/state.c: the state at t = 0 as the scene and the scheme have it. */
selas_status state_create(struct stepper *stepper, struct state *state, struct messages *messages);
void state_free(struct state *state);
/* Makes all of y right, and of a if wanted, where the model makes whole steps (model.h); else nothing. To be
 * called before anything but probes and the power of loads is looked at. */
void state_settle(const struct stepper *stepper, const struct state *state, bool acceleration);

/* stepping/drive.c: what drives the model at any time (Runge-Kutta stages: exact second derivative of
 * motions) ... */
void drive_at(struct stepper *stepper, double time, struct drive *drive);
/* ... and at step n (leapfrog family): second differences of motions over dt, warped histories if unwarp.
 * With `corrected` one twelfth of its own second difference is added to each amplitude (the load term of the
 * modified equation). */
void drive_at_step(struct stepper *stepper, unsigned long n, bool corrected, struct drive *drive);
/* The drive that was made last. */
struct drive drive_last(const struct stepper *stepper, double time);
/* Puts a host in the histories' place (the stepper must not unwarp). */
selas_status drive_by_host(struct stepper *stepper, const struct host_drive *host, struct messages *messages);
/* The host has changed what it drives: rows from the step given on are asked for again. */
void drive_changed(struct stepper *stepper, unsigned long step);
/* Makes the acceleration at the state's own time anew after a change of the loads there. */
void drive_again(struct stepper *stepper, struct state *state);

/* stepping/spectrum.c: largest frequency (rad per time) of the undamped operator; *error gets a bound on its
 * relative error or 0. */
selas_status largest_frequency(struct model *model, double *omega, double *error, struct messages *messages);
/* Largest damping rate (1 / time) of the body at rest, a(0, v) = -rate v, by power iteration at velocities
 * far below `speed`. */
selas_status largest_damping(struct model *model, double speed, double *rate, struct messages *messages);

#endif
