/* The model: points, operator and loads of one scene by one method; knows nothing of files.
 *
 * State. A linear method has the second-order form M a + C v + K u = F(t) with n = `unknowns` numbers in each
 * of u, v, a. The state vector of every method is y = [u | v | extra], `state_size` numbers: u are
 * displacements (control values where the method has them), v their rates, extra what else the method
 * integrates (stress, density; none for linear methods). Component c of point i stands at y[c *
 * component_stride + i * point_stride] in u and likewise in v.
 *
 * A model's functions come in groups; a group that a model does not have is NULL. Linear methods fill
 * `accelerate`; methods with state of their own fill `rate`; a method may fill both. Nothing here allocates
 * memory after create(). */
#ifndef SELAS_MODEL_MODEL_H
#define SELAS_MODEL_MODEL_H

#include "base/messages.h"
#include "model/spread.h"
#include "scene/scene.h"

#include <math.h>
#include <stdint.h>

/* Amplitudes that drive the model at one instant; the stepping scheme fills them (so it may take differences
 * of them or warp them). A NULL array means all zero. */
struct drive {
    double time;
    const double *load; /* [scene->loads]: history value times load amplitude is load[k] * amplitude */
    const double
        *motion; /* [FACES]: second time derivative of the prescribed displacement history (per amplitude) */
    const double *displacement, *velocity; /* [FACES]: that history itself and its first derivative */
    const double *extra; /* the state's extra part, for models that have `remember`; NULL: all 0, and
                            materials as stiff as to what is very fast */
};

struct energy {
    double kinetic, strain;
};

/* Where and how to read a point value: sum over j of weight[j] * (value at point index[j]). */
struct probe {
    double position[3]; /* deck coordinates */
    unsigned fields;    /* what will be asked for, bit 1 << selas_field: set before the probe is made */
    size_t count;
    size_t sites;     /* entries of index and weight behind these, which only the method knows, */
    size_t strains;   /* so many of them for strains */
    size_t *index;    /* [count + sites] */
    double *weight;   /* [count + sites] */
    double *gradient; /* [3 * count]: weights of d/dx, d/dy, d/dz at gradient[3 * j + axis], axes of the frame
                         of the unknowns (the body's if model->frame is set, else the deck's) */
    const struct material *material;
    int holder;        /* the rank that can read it; on the others count is 0, and nothing reads it */
    unsigned mirrored; /* method/mirror.c: bit 1 << axis if the values come from the mirror image across it */
};

/* What limits an explicit time step, about the body at rest. */
struct spectrum {
    double omega;        /* largest frequency of the undamped waves [rad/time] */
    double wave_damping; /* mean damping rate of those fastest waves [1/time]; 0 if interior waves are
                            undamped */
    double viscous;      /* largest damping rate of any motion [1/time] */
    bool dampers;        /* transmitting faces have dampers, which the scheme takes implicitly */
    bool layers;         /* absorbing layers with memory, which the scheme brings over each step */
};

/* As half_step of accelerate(): so large that components with dampers do not accelerate. */
#define DAMPERS_HOLD 1e30

/* What is wrong where users see nothing: in absorbing layers, in the density of particles. */
struct unseen {
    double speed;           /* largest; infinite if it is not finite */
    size_t spoiled, places; /* places whose numbers are not finite or overflow when squared, of all of them */
    char place[160]; /* where: "in the layer behind face x+, about (1, 2, 3)"; the middle of the spoiled ones
                      */
};

struct model;

/* A method of the list in deck/choices.h: what a deck may ask for. */
struct method {
    const char *name, *variant; /* as in the deck */
    const char
        *words; /* of &method that it takes, parted by blanks, beside name, variant, symmetry and precision */
    bool mirrors;         /* exact on the half of a symmetric scene with symmetry on the middle plane: see
                       method/mirror.h */
    unsigned faces;       /* what it can do at faces: CAN_... (scene/boundary.h) */
    bool single;          /* some scenes may keep the state in single precision */
    bool any_ground;      /* takes blocks, tilted and graded layers, topography */
    bool damping;         /* materials may have q_p and q_s: see method/damped/damped.h */
    bool ranks;           /* shares its work among ranks (parallel/ranks.h) */
    bool point_materials; /* each point that a host gives may have a material of its own */
    /* SELAS_OK if it takes the scene's points and loads, for those who ask before a model is built; NULL: it does. */
    selas_status (*suits)(const struct scene *scene, struct messages *messages);
    /* Checks the scene for this method and builds the model; says in messages what cannot be. */
    selas_status (*create)(const struct scene *scene, struct model **model, struct messages *messages);
};

enum model_array { ARRAY_UNKNOWNS, ARRAY_EXTRA };

/* What every model has. */
struct model_core {
    void (*destroy)(struct model *model);
    /* Initial state from scene->initial; y is zero on entry. NULL: at rest. */
    void (*initialise)(struct model *model, double *y);
    /* Finds weights for a position (deck coordinates). */
    selas_status (*probe)(struct model *model, const double position[3], struct probe *probe,
                          struct messages *messages);
    /* Value of a field at a probe in deck coordinates; `value` has room for 6. NULL: the linear standard in
     * model/probe.c (from u, v, a, weights and Hooke's law). */
    void (*observe)(struct model *model, const struct probe *probe, selas_field field, const double *y,
                    const double *a, double *value);
    /* Field at the body points from .. end - 1, value[components * (i - from) + c], deck coordinates. Of a model with
     * `holder`: whole planes over the last axis, or rows over the first, if points form a lattice; this rank holds
     * them. */
    void (*field)(struct model *model, selas_field field, const double *y, const double *a, size_t from,
                  size_t end, double *value);
    /* The rank that can show a point, in three dimensions all of its row over the first axis of the lattice, in fewer
     * all of its plane over the last one. NULL: points are shown together, by a model that is alone. */
    int (*holder)(const struct model *model, size_t point);
    /* Together: adds how an array like u, or the extra part of the state, lies in that of all ranks. NULL: a
     * model that is alone. */
    void (*share)(struct model *model, enum model_array array, struct spread *shares);
    /* Together: brings an array like u, of which each rank has what is its own, to what all ranks have of it. Ranks of
     * a model with this have arrays of the whole body: it has no `holder` and no `share`. NULL: another model. */
    void (*complete)(struct model *model, double *u);
    void (*energy)(struct model *model, const double *y, struct energy *energy); /* ranks: together */
    /* Power of the loads and power absorbed by dampers at this instant (both >= 0 when energy goes in / out);
     * on ranks each one's part of it. */
    void (*power)(struct model *model, const struct drive *drive, const double *y, double *load,
                  double *absorbed);
    /* Power that materials take beside that, >= 0, at the cost of energy_calls operator calls or so. NULL:
     * they take none. */
    double (*loss)(struct model *model, const double *y);
    /* Where the body moves fastest, or is spoiled, where no field of the body shows it (absorbing layers and
     * their memory; density). Only called when a run has failed. NULL: there are no such places. */
    void (*unseen)(struct model *model, const double *y, struct unseen *found);
    /* Lines of the plan and the report that only this method can tell: calls tell(context, key, value). NULL:
     * none. */
    void (*describe)(const struct model *model,
                     void (*tell)(void *context, const char *key, const char *value), void *context);
    /* What describe() counts of calls so far begins anew. NULL: it counts nothing. */
    void (*forget)(struct model *model);
};

/* The spatial operator. */
struct model_operator {
    /* Solves (M + half_step C) a = F(drive) - K u - C v for a. half_step = 0 is the plain acceleration;
     * leapfrog passes dt/2. Prescribed components get a from drive->motion. v may be NULL where the model has
     * no C. */
    void (*accelerate)(struct model *model, const struct drive *drive, double half_step, const double *u,
                       const double *v, double *a);
    /* dy/dt for the Runge-Kutta family. */
    void (*rate)(struct model *model, const struct drive *drive, const double *y, double *dydt);
    /* product := M v, in the inner product of energy() or a multiple of it; v is 0 where it is prescribed.
     * NULL: Lanczos takes two calls of energy() in its place. */
    void (*weigh)(struct model *model, const double *v, double *product);
    /* Nonlinear models: while on, accelerate() and energy() are those of the operator linearised about the
     * body at rest (for measuring its spectrum). NULL for linear models. */
    void (*linearise)(struct model *model, bool on);
    /* A smaller model with the same operator but for its length (*shorter; NULL: none that is worth it),
     * whose largest frequency is below this one's by not more than the part `deficit` of it. Free it with
     * model_free(). NULL: there is none. */
    selas_status (*shorten)(const struct model *model, struct model **shorter, double *deficit,
                            struct messages *messages);
    /* Methods with state of their own. NULL: measured with accelerate(). */
    selas_status (*spectrum)(struct model *model, struct spectrum *spectrum, struct messages *messages);
    /* Filters the increment of one step: u_before and u are the displacements at both ends; changes u and
     * sets the velocity of the increment, v = (u - u_before) / dt (leapfrog's half-step velocity), to match.
     * Called right after u has moved, before the acceleration there. NULL where there is no filter. */
    void (*after_step)(struct model *model, double dt, const double *u_before, double *u, double *v);
};

enum { MODEL_MECHANISMS = 8 };

/* Relaxation mechanisms, D_l' = v - rate_l D_l: the stiffness of the model of each part p acts on
 * e_p = given_p u + sum over l of weight_pl D_l (doc/theory/damping.md, Eqs 11, 12). The extra part of the state,
 * `extra` numbers, begins with the D_l, [mechanisms][unknowns]; that of part p is at `extra` of the part. */
struct relaxing {
    size_t mechanisms, parts, extra;
    double rate[MODEL_MECHANISMS];
    struct relaxing_part {
        struct model *model;
        double given, weight[MODEL_MECHANISMS];
        size_t extra;
    } part[1 + MODEL_MECHANISMS];
};

/* Steps of leapfrog in one pass over the fields. The model keeps the velocity half a step ahead and perhaps
 * u; from begin() on, which takes y as the state at the drive's time, y and a are right only where probes and
 * the power of loads look, until settle() makes y whole, and a if it is not NULL. settle() changes nothing of
 * what is kept. */
struct model_one_pass {
    void (*begin)(struct model *model, const struct drive *drive, double dt, double *y, double *a);
    /* From one step to the next, whose drive it is. */
    void (*advance)(struct model *model, const struct drive *drive, double dt, double *y, double *a);
    void (*settle)(struct model *model, const struct drive *drive, double dt, double *y, double *a);
    /* What is kept beside y, for checkpoints. */
    void *(*kept)(struct model *model, size_t *bytes);
    /* The same for that, in numbers. */
    void (*share)(struct model *model, struct spread *shares);
    /* From now on steps in one pass, and they alone, relax; the model is that of part 0. SELAS_UNSUPPORTED:
     * not in one pass; SELAS_NO_MEMORY. NULL: the model is never one of a part. */
    selas_status (*relax)(struct model *model, const struct relaxing *relaxing);
};

/* Memory of linear models (absorbing layers, damped materials). */
struct model_memory {
    /* Fits memory to the displacements that time stepping starts with. */
    void (*start)(struct model *model, const double *u, double *extra);
    /* Brings the extra part of the state over a step dt. On entry u is that of the end of the step, v the
     * mean velocity over it (leapfrog's half-step velocity), extra that of the start. Called before the
     * acceleration at the end, which gets it in drive->extra, and the same u. */
    void (*remember)(struct model *model, double dt, const double *u, const double *v, double *extra);
    /* Damps that velocity besides, before displacements and memory go on by it. */
    void (*drag)(struct model *model, double dt, double *v);
};

/* How points see a patch that a traction presses. */
enum patch_sight {
    PATCH_WHOLE,     /* as it is */
    PATCH_RINGS,     /* as it is, but the short surface waves that a narrow patch makes ring on */
    PATCH_BY_POINTS, /* as wide as the points in it */
    PATCH_BY_CELLS   /* as the cells of the points in it */
};

/* What a plane wave errs by for each of its wavelengths that it travels, if it has p points: floor + constant /
 * p^order (doc/howto/spacing.md), S waves shear more; all 0: not told. What waves of loads err by, p at half their
 * largest amplitude: floor + sent / p^sent_order. Of the consistent method alone: shares of it that a Gaussian
 * state errs by, as it is and as slower waves (initial-states.md). Of the paper's: what they err by at each end of
 * a bar that is not held. Of scattered points the share of `floor` that their scatter has. Frequencies of a beam
 * of n points across are bends / n^bends_order of themselves too low; 0: not told. By `bare` spacings less waves run to
 * and fro at each free face that no load acts on. */
struct wave_law {
    double constant, order, floor, spread, turned, shear, sent, sent_order, ends, scatter, bends, bends_order,
        bare;
};

struct model {
    const struct method *method;
    const struct model_core *core;
    const struct model_operator *spatial;
    const struct model_one_pass *one_pass; /* NULL: steps are made with the operator */
    const struct model_memory *memory;     /* NULL: none */
    struct model *part;  /* method/mirror.c: the part below mirror planes, whose state and functions (but for
                           the core) this model has: ask model_computed(); NULL: the whole body is computed */
    struct model *whole; /* of a part of damped ground: the part that is the whole; NULL: none */
    const struct scene *scene; /* borrowed */
    size_t points;             /* points of the body that users see */
    const double *position;    /* [3 * points], deck coordinates; NULL: a lattice that fills the body, not
                                  stored. Ask model_position(). */
    const uint32_t *number;    /* [points] places of points of a file in it, from 0 on; NULL: as they stand */
    /* Where a point is that is not stored, in deck coordinates; NULL: at its place of that lattice. */
    void (*place)(const struct scene *scene, size_t point, double position[3]);
    size_t grid[3];        /* points per axis if they form a lattice (x fastest), else 0, 0, 0 */
    size_t unknowns;       /* numbers in u */
    size_t whole_unknowns; /* those of all ranks together; 0: one alone */
    size_t state_size;     /* numbers in y */
    size_t component_stride, point_stride;
    size_t bytes;       /* memory held by the model */
    size_t setup_bytes; /* most that was held while it was made; 0: no more than later */
    bool single;        /* steps in one pass keep the state in single precision; y is what others see of it */
    bool damped;        /* C is not zero */
    bool layers;        /* absorbing layers take energy, nobody tells how much */
    double dissipation; /* bound on the damping rate of forces that accelerate() takes from v as it is
                           [1/time] */
    bool small_strain;  /* forces are linear in grad u: rotations must stay small */
    bool level_images;  /* images behind faces with tractions stay across where the faces were */
    bool leaks;         /* parts of the operator hold or take energy that energy() and power() do not tell */
    bool untold;        /* power() does not tell all that dampers absorb */
    unsigned energy_calls; /* operator calls that energy() takes, if more than one */
    unsigned parts;        /* operators whose sum a step takes, each rounded, if more than one */
    enum patch_sight patch;
    struct wave_law waves;
    bool alternates;   /* nothing holds motions that alternate from point to point */
    double shallow;    /* moment tensors that pull across a free face err nearer to it than this [spacings] */
    bool self_adjoint; /* K is symmetric and energy() gives u.Ku/2 and v.Mv/2: Lanczos may be used */
    const double (
        *frame)[3]; /* unknowns are in the body's frame: rotate to deck coordinates; NULL: they are not */
    unsigned long evaluations; /* calls of accelerate or rate so far */
};

/* The model whose state, operator, passes and memory these are: what time stepping works on. */
static inline struct model *model_computed(struct model *model)
{
    return model->part != NULL ? model->part : model;
}

/* Together: brings state and acceleration to what all ranks have of them, where ranks have arrays of the whole body
 * with their own part alone; y is made of arrays like u. */
static inline void model_complete(struct model *model, double *y, double *a)
{
    if (model->core->complete == NULL) return;
    model->core->complete(model, a);
    for (size_t k = 0; k + model->unknowns <= model->state_size; k += model->unknowns)
        model->core->complete(model, y + k);
}

/* Points about which a run looks for rotations (record/hindsight.c), of a model with exact values to compare with or
 * one that takes rotations for small: evenly spread, along no row of a lattice. */
enum { MODEL_WATCHED = 64 };
static inline bool model_is_watched(const struct model *model)
{
    return model->scene->dimension > 1 && model->scene->body.shape != BODY_HALF_SPACE &&
           (model->small_strain || model->level_images || scene_has_exact(model->scene));
}

static inline size_t model_watched(size_t points, size_t k)
{
    const double part = fmod(0.618034 * ((double)k + 0.5), 1.0);
    return (size_t)(part * (double)points);
}

/* Frees the model and sets the pointer to NULL. */
void model_free(struct model **model);

/* model/positions.c: deck coordinates of a point that users see. */
void model_position(const struct model *model, size_t point, double position[3]);

/* What is known at one place, in the frame of the unknowns. */
struct point_values {
    double displacement[3], velocity[3], acceleration[3];
    double gradient[9]; /* d u_i / d x_j at [3 * i + j] */
};

/* model/probe.c */
/* Room for count weights, all zero; SELAS_NO_MEMORY. */
selas_status probe_allocate(struct probe *probe, size_t count, struct messages *messages);
void probe_free(struct probe *probe);
/* A field in deck coordinates from values at one place: rotation by model->frame, strain, Hooke's law of the
 * material in the scene's dimension and plane (out-of-plane strain and stress included). */
void field_from_values(const struct model *model, const struct material *material,
                       const struct point_values *values, selas_field field, double *value);
/* The linear standard (methods without an `observe` of their own). */
void probe_observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                   const double *a, double *value);
/* Value of a field at a probe by the method's own `observe` or the standard: what everybody else calls. */
void model_observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                   const double *a, double *value);
int field_components(selas_field field); /* 3, 6 or 1 */
const char *field_name(selas_field field);
const char *const *component_names(selas_field field); /* "x", "y", ... or "xx", ... */

#endif
