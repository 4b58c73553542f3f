/* The H-form of the consistent method (manual, sections 8 and 9): the inverse mass of each axis is a short
 * van Cittert series N, and H = N^-1 stands for M in the stiffness too, so that no solve is left. */
#ifndef SELAS_METHOD_CONSISTENT_GALERKIN_HFORM_H
#define SELAS_METHOD_CONSISTENT_GALERKIN_HFORM_H

#include "method/consistent/galerkin/galerkin.h"

enum { MAX_PRODUCTS = 64, MAX_EDGES = 24 };

/* Correction where two faces meet: to component `out`, from `in`'s values on the edge. */
struct edge {
    int out, in;
    double factor;
    size_t at[3], from[3], to[3]; /* by slot: index read (edge slots); range written */
    const double *column[3];      /* by slot: weights; NULL: along the edge */
    const struct band *depth;     /* edge along depth: applied to what is read; NULL: identity */
};

struct hform {
    struct band *inverse[3][3]; /* N of [component][axis], 0 where held */
    bool owns_inverse[3][3];
    double *factor[3][3];        /* Cholesky factors of N (1 where held), for energies; [component][axis] */
    struct mass_factors factors; /* the same for mass_solve() */
    double *upper[3];            /* layers: factor of the depth axis's N, turned round; by component */
    size_t upper_half;
    double *column[3][3][2]; /* [component][axis][end]: N e */
    size_t reach[3];         /* by axis: entries of a column that are not 0 */
    size_t products;
    struct band *product[MAX_PRODUCTS];
    struct tensor_plan *acceleration; /* -M^-1 K but for the edges */
    size_t edges;
    struct edge edge[MAX_EDGES];
    struct sparse_list load;         /* M^-1 F */
    struct sparse pulled[BOX_FACES]; /* M^-1 M_IB a_B of moving faces */
    double
        *loudest; /* where the fused operator does not serve: of plane k, strip s, the largest displacement */
    double *face[2];                 /* face values */
    double *work;                    /* [unknowns], energies */
    struct band *smoother[3][3];     /* dissipation: P of [component][axis] ... */
    struct tensor_plan *dissipation; /* ... and -rate sum of P; NULL: none asked for */
};

selas_status hform_create(struct consistent *c, struct messages *messages);
void hform_free(struct consistent *c);
size_t hform_bytes(const struct consistent *c); /* fields and buffers; 0 without H-form */
/* New van Cittert inverse of an axis's mass between functions that are even or odd at symmetry planes, 0
 * where the component is held. NULL: no memory. */
struct band *hform_inverse(const struct consistent *c, int component, int axis, bool odd);
double hform_damper_power(struct consistent *c, const double *v);

/* hform_forces.c: h->load and h->pulled; false: no memory. */
bool hform_forces(struct consistent *c);

/* hform_edges.h: adds factor times what edges do in plane k. */
void hform_edges_double(const struct consistent *c, size_t k, double factor, const double *u,
                        double *const *out);
/* hform_faces.c: the dampers' part of an acceleration that is otherwise complete. */
void hform_dampers(struct consistent *c, double half_step, const double *v, double *a);

/* hform_dissipation.c: high-frequency dissipation, if the options ask for it; false: no memory. */
bool hform_dissipation_create(struct consistent *c);
void hform_dissipation_free(struct consistent *c);
double hform_dissipation_power(struct consistent *c, const double *v);

#endif
