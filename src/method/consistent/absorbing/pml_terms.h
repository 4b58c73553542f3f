/* The terms of the absorbing layers: what the slabs' plans (pml_setup.c) and tables (pml_fast.c) are made of.
 */
#ifndef SELAS_METHOD_CONSISTENT_ABSORBING_PML_TERMS_H
#define SELAS_METHOD_CONSISTENT_ABSORBING_PML_TERMS_H

#include "method/consistent/absorbing/pml.h"

struct terms {
    struct consistent *c;
    struct slab *slab;
    struct tensor_term term[24];
    size_t count;
    bool good; /* false: no memory */
};

/* psi_ij = F_j[C_j u_i], C_j = N G: input u_i to component i. N over depth has the density in it. */
struct terms terms_gradient(struct consistent *c, struct slab *slab);
/* T_ij (Eqs 6 and 7): inputs u_i, psi_ij (from `dimension` on), psi_kk (from 2 * dimension on). */
struct terms terms_outer(struct consistent *c, struct slab *slab);
/* The acceleration that psi_ij of this slab makes (Eq 8): inputs psi_ij. */
struct terms terms_pull(struct consistent *c, struct slab *slab);

/* The boundary term of the slab's axis plays no part: its outer end is held, the other is a symmetry plane or
 * out of the region's reach. */
bool far_end_out(const struct consistent *c, const struct slab *slab);

#endif
