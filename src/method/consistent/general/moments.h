/* The memory phi_ij of absorbing layers of the general operator (doc/theory/general-ground.md, section 5): forces are
 * moments of the field with the splines, f_i = sum of N_i(q) g(q), and the moments of d g are
 *
 *   (D f)_i = (d_i + d''_i h^2/8) f_i + d'_i h/8 (f_(i+1) - f_(i-1))                                       (G13a)
 *
 * up to h^4, h^2/4 being the variance of a spline of degree 2. Then phi' = -alpha phi - D (f + phi). */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_MOMENTS_H
#define SELAS_METHOD_CONSISTENT_GENERAL_MOMENTS_H

#include "method/consistent/absorbing/pml.h"

/* D of one layer, row by row along the axis across its face. */
struct moment_rows {
    size_t count;
    double *below, *own, *above; /* [count] D_(i,i-1), D_ii, D_(i,i+1) */
    double *left, *pivot;        /* [count] of the step's elimination (Thomas) */
};

bool moment_rows_lay(struct moment_rows *rows, const struct consistent *c, const struct slab *slab);
void moment_rows_free(struct moment_rows *rows);

/* The elimination of a step dt by the trapezoidal rule. */
void moment_rows_eliminate(struct moment_rows *rows, const struct slab *slab, double dt);
/* Moves phi of a component of a slab on by that step: across x and y in plane `line`, across depth in row `line` of all
 * planes. f in the middle of the step stands in c->general->pulled from `moments` on, phi in the middle goes to
 * c->general->middle. */
void moment_rows_move(const struct consistent *c, const struct moment_rows *rows, const struct slab *slab,
                      double dt, size_t moments, size_t component, size_t line, double *extra);
/* How many lines there are. */
size_t moment_rows_lines(const struct consistent *c, const struct slab *slab);

#endif
