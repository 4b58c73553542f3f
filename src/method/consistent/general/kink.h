/* Forces and receivers at a point beside an interface (doc/theory/general-ground.md, section 6). */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_KINK_H
#define SELAS_METHOD_CONSISTENT_GENERAL_KINK_H

#include "method/consistent/galerkin/galerkin.h"

/* Adds what the lattice's displacement lacks beside an interface (G30). Together. */
force_beside general_add_kink;
/* The same for each component, vectors that read control values of all; empty where nothing is lacking. */
struct kinks {
    struct sparse of[3];
    size_t sites; /* as many for each component, with weights of 0 where there are fewer */
};
/* At a place of the lattice. Together. False: no memory. */
bool general_see_kink(const struct consistent *c, const double place[3], struct kinks *kinks);
/* Makes them sites of a probe that has room, and keeps right what they read. False: no memory. */
bool general_keep_kink(struct consistent *c, const struct kinks *kinks, struct probe *probe);
void kinks_free(struct kinks *kinks);

#endif
