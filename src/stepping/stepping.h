/* Time stepping: state in, state out. Schemes are in the table of names in stepping/schemes.c, one file each.
 */
#ifndef SELAS_STEPPING_H
#define SELAS_STEPPING_H

#include "stepping/driver.h"
#include "stepping/held.h"

struct state {
    double time;
    unsigned long step;
    double *y; /* [model->state_size] = [u | v | extra] at `time` */
    double *a; /* [model->unknowns] acceleration at `time` (as the scheme sees it) */
};

struct stepper;

/* What a scheme can do that not every scene or model asks for. */
enum scheme_ability {
    SCHEME_WAVES = 1,         /* bounded for undamped waves if the step is short enough */
    SCHEME_MOVING_LOADS = 2,  /* loads may move */
    SCHEME_FILTERS = 4,       /* calls the filter of a model, which acts on the velocity at half a step */
    SCHEME_LAYERS = 8,        /* brings the memory of absorbing layers over each step */
    SCHEME_ONE_PASS = 16,     /* lets a model make whole steps (single precision) */
    SCHEME_UNWARPS = 32,      /* its only time error is the warp of the time-dispersion transform */
    SCHEME_STAGES = 64,       /* their number is free */
    SCHEME_DAMPED = 128,      /* brings the memory of damped materials over each step */
    SCHEME_DAMPED_FACES = 256 /* and that beside dampers */
};

/* Models for which a scheme is the default: all that have accelerate(); else by C. */
enum scheme_default { DEFAULT_FOR_NONE, DEFAULT_FOR_ACCELERATE, DEFAULT_FOR_DAMPED, DEFAULT_FOR_UNDAMPED };

struct scheme_class {
    const char *name;
    int order;    /* in time */
    unsigned can; /* enum scheme_ability */
    enum scheme_default default_for;
    bool needs_acceleration; /* uses accelerate() (second-order form); otherwise rate() */
    double evaluations;      /* operator calls a step, or a stage where their number is free */
    /* Acceleration in a step other than the first, as a linear function of u, v and the drive: held loads change
     * without the operator (held.h; the scheme is the stepper). NULL: they do not. */
    held_acceleration *accelerate;
    /* R(z) of a Runge-Kutta scheme, y_(n+1) = R(dt lambda) y_n, from which its limit follows; else NULL and
     * limit(): see scheme_limit(). */
    double _Complex (*polynomial)(double _Complex z, long stages);
    double (*limit)(const struct spectrum *spectrum, long stages);
    /* Schemes with a free number of stages: the number for a step dt (0: dt is free too). NULL: fixed. */
    long (*choose_stages)(const struct stepper *stepper, double dt);
    size_t vectors; /* work vectors of state_size that the scheme needs; one at least if the model filters */
    bool keeps;     /* work[1] holds unknowns of two earlier steps */
    /* Makes state->a (and what else the scheme keeps) right at the start. */
    void (*start)(struct stepper *stepper, struct state *state);
    /* The same after a restart, which has given state->a. NULL: nothing else is kept. */
    void (*resume)(struct stepper *stepper, struct state *state);
    void (*step)(struct stepper *stepper, struct state *state);
    /* Makes state->a anew after a change of the loads at the state's own time, and the velocity with it where
     * that has half a step of a in it. */
    void (*again)(struct stepper *stepper, struct state *state);
    /* Gives the state velocities of the scheme's order, for who looks at a step; then (`shown` is false) the scheme's
     * own again, to the bit. NULL: these are of its order. */
    void (*show)(const struct stepper *stepper, const struct state *state, bool shown);
    /* What `show` adds to the velocities: so many parts of three vectors of unknowns. NULL like it. */
    void (*shown)(const struct stepper *stepper, const struct state *state, const double *of[3],
                  double part[3]);
    /* Corrects a receiver's finished history in place; rows 0..n-1 are steps of dt; u, v, a: [3 * n],
     * row-major. NULL: nothing to correct. */
    selas_status (*finish)(const struct stepper *stepper, size_t n, double *u, double *v, double *a,
                           struct messages *messages);
};

struct stepper {
    const struct scheme_class *scheme;
    const char *
        scheme_reason; /* why it is not the usual one, where the deck names none; NULL: it is, or the deck does */
    struct model *model;
    double dt;
    long stages;
    struct spectrum spectrum; /* measured; omega with the bound on its error added */
    double frequency_error;   /* bound on the relative error of omega (Lanczos residual); 0 if unknown */
    double limit;             /* largest stable dt by the scheme's own limit; INFINITY if nothing vibrates */
    char dt_reason[160];      /* how the step was chosen, for the report */
    bool unwarp; /* time-dispersion transform: loads are warped beforehand, histories un-warped at the end */
    unsigned long steps; /* steps from t = 0 until end_time is reached or passed */
    unsigned long extra; /* steps beyond that the finished histories need */
    size_t vectors;
    double **work; /* [vectors] arrays of state_size */
    struct driver driver;
    struct held held;
    bool one_pass; /* the model makes whole steps: settle() before all of y is looked at */
};

/* stepping/schemes.c: the table, ended by NULL. */
extern const struct scheme_class *const scheme_table[];
const struct scheme_class *scheme_find(const char *name);
/* True if the model has the functions that the scheme calls. */
bool scheme_fits(const struct scheme_class *scheme, const struct model *model);
/* True if it can do all that the model and its scene ask for. */
bool scheme_serves(const struct scheme_class *scheme, const struct model *model);
/* Largest stable dt; 0 if none is, INFINITY if any is. */
double scheme_limit(const struct scheme_class *scheme, const struct spectrum *spectrum, long stages);
const struct scheme_class *scheme_default(const struct model *model);
/* Text such as "'leapfrog' or 'rk4'": schemes that fit the model and can do all that is asked for, in words if
 * there is none. */
enum { SCHEME_NAMES_SIZE = 200 };
const char *scheme_names(const struct model *model, unsigned abilities, char text[SCHEME_NAMES_SIZE]);

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
/* Gives the state velocities of the scheme's order, for who looks at it; then (`shown` is false) those that it goes on
 * with. */
void state_show(const struct stepper *stepper, const struct state *state, bool shown);

/* stepping/spectrum.c: largest frequency (rad per time) of the undamped operator; *error gets a bound on its
 * relative error or 0. */
selas_status largest_frequency(struct model *model, double *omega, double *error, struct messages *messages);
/* Largest damping rate (1 / time) of the body at rest, a(0, v) = -rate v, by power iteration at velocities
 * far below `speed`. */
selas_status largest_damping(struct model *model, double speed, double *rate, struct messages *messages);

#endif
