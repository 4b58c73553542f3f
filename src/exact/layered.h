/* Layers over a half-space with tractions on the surface: what they add to the compliances of a half-space of
 * the uppermost material. Formulas and sources: layered.c, doc/theory/layered.md. */
#ifndef SELAS_LAYERED_H
#define SELAS_LAYERED_H

#include "base/messages.h"
#include "exact/half_space.h"
#include "scene/scene.h"

struct stratum {
    double top; /* depth of its upper face; 0 for the first */
    double density, mu, p_speed, s_speed;
};

struct layered {
    size_t strata; /* the last one goes on for ever */
    struct stratum *stratum;
    double slowest;    /* below the speed of every surface, interface or guided wave */
    double fastest[2]; /* of P and of S waves */
};

/* Of a body with layers (half-space otherwise: one stratum). SELAS_NO_MEMORY. */
selas_status layered_create(const struct scene *scene, struct layered **layered, struct messages *messages);
/* From a list of strata by ascending top, copied. */
selas_status layered_from(size_t strata, const struct stratum *stratum, struct layered **layered,
                          struct messages *messages);
void layered_free(struct layered **layered);

/* Compliances times the mu of the first stratum at depth z >= 0 for wavenumbers k > 0, Re s > 0: as
 * half_space_compliance. */
void layered_compliance(const struct layered *layered, double complex s, double z, size_t count,
                        const double *k, bool horizontal_loads, struct compliance *compliance);
/* Adds them minus those of the half-space `top` of the first material; nothing where both are below rounding.
 */
void layered_add_difference(const struct layered *layered, const struct half_space *top, double complex s,
                            double z, size_t count, const double *k, bool horizontal_loads,
                            struct compliance *compliance);
#endif
