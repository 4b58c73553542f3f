/* Damped materials for linear methods (doc/theory/damping.md): relaxation mechanisms as displacement-like memory
 * variables on a model of the method, which itself knows nothing of damping.
 *
 * With unrelaxed moduli in K and D_l' = v - r_l D_l,
 *
 *   M a + C v + sum over parts p of K_p e_p = F,   e_p = given_p u + sum over l of memory_pl D_l.
 *
 * Part 0 has the unrelaxed moduli and everything else of the scene; others, one for each way in which weights
 * differ between moduli and materials, have what their weights are multiplied with. */
#ifndef SELAS_METHOD_DAMPED_DAMPED_H
#define SELAS_METHOD_DAMPED_DAMPED_H

#include "damping/ground.h"
#include "model/model.h"

struct damped_part {
    struct model *model;
    struct scene scene;        /* of the model: that of the run but for the materials */
    struct material *material; /* [materials] */
    double given, memory[MOST_MECHANISMS];
    size_t extra; /* where its own memory (absorbing layers) begins in the state's extra part */
};

struct damped {
    struct model model;
    struct model_core core; /* damped_core but for what part 0 does not have */
    struct ground_damping *damping;
    size_t parts;
    struct damped_part part[1 + MOST_MECHANISMS];
    struct ground_model
        *field;              /* [parts] of a model: with unrelaxed speeds and the part's shares; NULL: none */
    struct fitting *fitting; /* field.c: what that is made with */
    double *effective;       /* [2 * unknowns]: e_p, and what else stands behind u in a state */
    double *sum;             /* [unknowns]: accelerations of one part; NULL: there is only part 0 */
};

static inline struct damped *damped_of(struct model *model)
{
    return (struct damped *)model;
}

/* The scene's model by a method: damped if its materials are. SELAS_UNSUPPORTED, SELAS_BAD_SCENE,
 * SELAS_NO_MEMORY. */
selas_status damped_or_plain(const struct method *method, const struct scene *scene, struct model **model,
                             struct messages *messages);

void damped_free(struct model *model); /* the model_core's destroy */

/* split.c: the parts' materials and factors; SELAS_UNSUPPORTED in plane stress with Q_p other than Q_s. */
selas_status damped_split(struct damped *d, const struct scene *scene, struct messages *messages);

/* field.c: the parts' ground where it is that of a model; the samples in d->damping become what its values are fitted
 * with. SELAS_BAD_SCENE where no passive solid has the Q. */
selas_status damped_field(struct damped *d, const struct scene *scene, struct messages *messages);
void damped_field_free(struct damped *d);

/* effective[0 .. unknowns) := e_p of a state whose extra part is given. */
void damped_effective(const struct damped *d, const struct damped_part *part, const double *u,
                      const double *extra, double *effective);

/* plan.c: lines of the plan and the report. */
void damped_describe(const struct model *model,
                     void (*tell)(void *context, const char *key, const char *value), void *context);

/* show.c: what users see of it. */
extern const struct model_core damped_core;

#endif
