/* Absorbing layers of the consistent method: convolutional perfectly matched layers on the control values of
 * the H-form (doc/theory/absorbing-faces.md).
 *
 * The body goes on behind a face for some points; along the axis j across the face d/dx_j becomes
 *
 *   (1 / s_j) d/dx_j,   s_j = 1 + d_j(x_j) / (alpha + i omega).
 *
 * With F_j = 1 / s_j - 1 = -d_j / (i omega + alpha + d_j), that is
 *
 *   f = F_j[g]   <=>   f' = -(alpha + d_j) f - d_j g,
 *
 * the layer keeps
 *
 *   psi_ij = F_j[C_j u_i],
 *   phi_ij = F_j[T_ij],   T_ij: terms of rho a_i whose outer derivative is along j (Eqs 6 to 8 of the manual).
 *
 * These memory variables are the extra part of the state; only slabs of layer points have them. */
#ifndef SELAS_METHOD_CONSISTENT_ABSORBING_PML_H
#define SELAS_METHOD_CONSISTENT_ABSORBING_PML_H

#include "method/consistent/galerkin/hform.h"

enum { SLAB_BANDS = 48, LAYER_POWER = 2 };

/* A box of control values: first one and number of them by slot. */
struct block {
    size_t at[3], n[3];
};

/* The layer behind one face. */
struct slab {
    int axis, end;
    struct block inside;  /* control values with d > 0 */
    struct block region;  /* and those that the matrices reach from them */
    size_t inner, volume; /* numbers of a memory variable (with padding, pml_fast.h); in the region */
    double most, edge;    /* largest d; where the body ends */
    double relaxation;    /* alpha: the rate at which the layer forgets */
    double *damping;      /* d at the control values inside, along the axis */
    double *drag;         /* rates at which velocities there are damped besides; NULL: not at all */
    double *kept;         /* what is left of them after a step */
    size_t psi, phi;      /* places of memory variables in the extra part: component i at psi + i * inner */
    size_t bands;
    struct band *band[SLAB_BANDS];
    /* Where passes are not shared (pml_fast.h): */
    double *middle;               /* [dimension * inner] psi at the middle of a step */
    struct tensor_plan *gradient; /* C_j u_i */
    struct tensor_plan *outer;    /* T_ij from u, psi of this slab and psi_kk of the others */
    struct tensor_plan *pull;     /* the acceleration that psi of this slab makes */
};

struct pml {
    size_t slabs, extra;
    const struct band *inverse[3][3]; /* N [component][axis] */
    struct band *own[3][3];           /* of them, those made here: exact masses */
    struct slab slab[BOX_FACES];
    double drag; /* share of d at which velocities are damped against guided waves; 0: none */
    struct pml_fast *fast,
        *single;      /* shared passes (options.single: in floats too); NULL: one by one, with ... */
    double *in, *out; /* ... fields of a region: [(2 * dimension + 3) * volume], [dimension * volume] */
    size_t bytes;
};

/* Lines of the plan about layers, built and left out. */
void layers_describe(const struct consistent *c,
                     void (*tell)(void *context, const char *key, const char *value), void *context);

/* What the second of these lines counts begins anew; takes NULL. */
void layers_forget(struct pml *pml);

/* The fastest control value of the layers, or the middle of those that are spoiled, if it is faster, or more are, than
 * what was found. */
void layers_fastest(struct model *model, const double *y, struct unseen *found);

/* d at a place along the slab's axis. */
double pml_damping_at(const struct consistent *c, const struct slab *slab, double x);

/* Builds the layers of the faces with c->layer[face] > 0 and sets c->pml. With the general
 * operator the slabs alone: it has memory and steps of its own. */
selas_status pml_create(struct consistent *c, struct messages *messages);
void pml_free(struct consistent *c);
/* a += factor * what the memory variables do: nothing at control values that are held at rest. */
void pml_accelerate(const struct consistent *c, double factor, const double *extra, double *a);
/* Brings the memory variables from one step to the next (Eq 10): u + to_middle * v are the displacements in
 * the middle of the step, v being the mean velocity over it, u those of its end (to_middle = -dt/2) or start
 * (dt/2). */
void pml_remember(struct consistent *c, double dt, double to_middle, const double *u, const double *v,
                  double *extra);
/* Mean velocities over a step where layers damp them besides (Eq 11): only if c->pml->drag > 0. In single
 * precision pml_fast_accelerate_single() and pml_fast_remember_single() serve (pml_fast.h) where
 * c->pml->single is not NULL. */
void pml_damp(const struct consistent *c, double dt, double *v);
/* What is left of velocities over a step so long: `kept` of the slabs. */
void pml_keep(const struct consistent *c, double dt);

#endif
