/* Displacements that relax in steps in one pass (doc/theory/damping.md, sections 3 and 4). The stiffness of part p acts
 * on e_p = given_p u + sum over l of weight_pl D_l. Steps keep fields z: e_p of all parts, then D_l of as many
 * mechanisms as make 1 + mechanisms fields, which tell u and the other D_l. (14) is, with the velocity w in the middle
 * of a step,
 *
 *   z_f += rate_f w + sum over g of by_fg z_g.                                                          (F2) */
#ifndef SELAS_METHOD_CONSISTENT_FUSED_RELAX_H
#define SELAS_METHOD_CONSISTENT_FUSED_RELAX_H

#include "model/model.h"

enum { FUSED_FIELDS_KEPT = 1 + MODEL_MECHANISMS };
/* Of a step dt. by_fg: D_l has that of itself alone. u = sum over f of displacement_f z_f; mechanism m has its memory
 * kept in field of[m], or, if that is 0, it is the sum over f of told_mf z_f. */
struct fused_relax {
    size_t parts, fields;
    double dt, rate[FUSED_FIELDS_KEPT], by[FUSED_FIELDS_KEPT][FUSED_FIELDS_KEPT];
    double displacement[FUSED_FIELDS_KEPT];
    size_t of[MODEL_MECHANISMS];
    double told[MODEL_MECHANISMS][FUSED_FIELDS_KEPT];
};

/* With the factors of the step that they were asked for last. */
struct fused_relaxing {
    struct relaxing of;
    struct fused_relax factors;
};

/* NULL: no memory. */
struct fused_relaxing *fused_relaxing_new(const struct relaxing *relaxing);
/* Factors of steps of dt; NULL if `relaxing` is. */
const struct fused_relax *fused_factors(struct fused_relaxing *relaxing, double dt);

/* e_p of a state y at entry `at` of n. */
double fused_effective(const struct relaxing *relaxing, size_t p, size_t n, const double *y, size_t at);
/* u and all D_l of entry `at` of n into a state y, from the fields, of so many bytes a number; those of D_l may be
 * y's. */
void fused_tell(const struct fused_relax *relax, size_t n, size_t at, const void *const *field, size_t number,
                double *y);
/* The same of all entries. */
void fused_tell_all(const struct fused_relax *relax, size_t n, int threads, const void *const *field,
                    size_t number, double *y);

#endif
