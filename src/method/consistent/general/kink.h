/* Forces and receivers at a point beside an interface (doc/theory/general-ground.md, section 6). */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_KINK_H
#define SELAS_METHOD_CONSISTENT_GENERAL_KINK_H

#include "method/consistent/galerkin/galerkin.h"

/* Adds what the lattice's displacement lacks beside an interface (G30). Together. */
force_beside general_add_kink;
/* What receivers read of control values of all components beside an interface: what the lattice's displacements lack
 * (G30), in each component, and strains (G21 to G29), ij = xx, xy, ..., yy, ...; empty where the rock does not jump. */
struct readings {
    struct sparse kink[3], strain[6];
};
/* At a place of the lattice, for fields (bit 1 << selas_field) of it. Together. False: no memory. */
bool general_see(struct consistent *c, const double place[3], unsigned fields, struct readings *readings);
size_t readings_sites(const struct consistent *c, const struct readings *readings);
/* Makes them sites of a probe that has room, and keeps right what they read: as many for each kink, and for each
 * strain, with weights of 0 where there are fewer. False: no memory. */
bool readings_keep(struct consistent *c, const struct readings *readings, struct probe *probe);
void readings_free(struct readings *readings);
/* traction.c: slopes of a displacement, [3 * component + axis], at a point of the lattice beside an interface become
 * those of the rock there (G34). */
void general_mend(const struct consistent *c, const size_t point[3], const double place[3], const double *u,
                  double gradient[9]);

#endif
