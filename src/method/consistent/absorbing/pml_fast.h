/* The step of the absorbing layers on one kind of ground in three dimensions, with the passes of a slab
 * shared (doc/theory/absorbing-faces.md, section 4). It serves where the fused operator (fused.h) does.
 *
 * A slab is worked on in rows along an axis f (x, or y where the slab lies across x), row after row along
 * the third axis, b (y for slabs across depth, else z). Along the axis s across the face there are few rows,
 * so products along s are small dense matrices, whose sums stay in registers. Arrays of a slab are [b][s][f],
 * rows padded with zeros to whole vectors: products along b take all of s and f as one long row. With
 * B = N M over depth (the identity in slabs across depth), j the slab's axis, m = psi at the middle of the
 * step, k the other axes and terms as in Eqs 6 to 8 (factors with them):
 *
 *   g_i  = C_j u_i,   psi_ij moved on, m_ij                                                             (L1)
 *   T'_i = A_j u_i + C_j m_ij,   i != j
 *   T'_j = A_j u_j + C_j m_jj + C1_f (C2_j u_f)                                                         (L2)
 *   T_i  = B T'_i,   i != j
 *   T_j  = B (T'_j + C2_j m_ff) + C1_b (C2_j u_b) + C2_j m_bb,   phi_ij moved on                        (L3)
 *   a_i += C_j B psi_ij + phi_ij + (C2_f B psi_jj if i = f; C2_b psi_jj if i = b)                       (L4)
 *
 * m_ff, m_bb: those of the slabs across f and b. (Across depth, where b = y: m_bb with B, which is the
 * identity there.) */
#ifndef SELAS_METHOD_CONSISTENT_ABSORBING_PML_FAST_H
#define SELAS_METHOD_CONSISTENT_ABSORBING_PML_FAST_H

#include "method/consistent/absorbing/pml.h"
#include "method/consistent/galerkin/window.h"

/* Rows made together, at most: along s, along b; numbers in a vector of doubles; numbers left free beside
 * rows that are read with neighbours; blocks of rows that a thread needs. */
enum { FAST_ROWS = 9, FAST_GROUP = 4, FAST_LANES = 8, FAST_PAD = 16, FAST_BLOCKS = 19 };

/* Roles of the axes. */
enum role { ROLE_S, ROLE_B, ROLE_F };

/* A matrix over rows: each group of rows of the result with those that it is made from. */
struct row_group {
    size_t to, rows, from, inputs;
    void *weight; /* [inputs][rows] */
};
struct row_table {
    size_t groups;
    struct row_group *group;
};

struct fast_slab {
    const struct slab *slab;
    int axis[3];                     /* by role */
    size_t ns, nb, nf, width;        /* numbers of the slab by role; in a padded row */
    size_t first_b;                  /* row of the whole body that is the first one over b */
    struct block inside;             /* the slab's, without its outer end */
    const double *damping;           /* [ns] d there */
    size_t start;                    /* index of the region's first row along s */
    size_t region, offset;           /* rows along s of its region; the first of them inside */
    size_t first, step[3];           /* in fields: the region's first value, steps by role */
    struct row_table gradient[3];    /* by component; region to inside: C_j of L1 */
    struct row_table second[3];      /* A_j, region to inside */
    struct row_table slope[3];       /* C_j, inside to inside */
    struct row_table change[3];      /* by role, b and f: C2_j of u_b and u_f, region to inside */
    struct row_table divergence;     /* C2_j of m_ff and m_bb, region to inside */
    struct row_table pull[3];        /* C_j, inside to region */
    struct row_table bare[3];        /* B, by component, over b; no groups: the identity */
    struct row_table over_b, pull_b; /* C1_b, C2_b */
    void *along_f, *pull_f;          /* C1_f, C2_f by diagonals: [taps_f * width] */
    size_t taps_f;
    void *wait[3], *change_b, *middle; /* [nb][ns][width]: T'_i; C2_j u_b; m_jj */
    bool *rests;                       /* [nb] rows in which nothing moves, in this call */
};

/* Tables and room for numbers of one kind, doubles or floats; the memory variables are laid out alike in
 * both. */
struct pml_fast {
    bool single;
    struct fast_slab slab[BOX_FACES];
    void **buffer; /* [threads] */
    size_t bytes;
    unsigned long groups, skipped; /* of rows so far */
};

/* Builds c->pml->fast if all slabs are for it (else it stays NULL), with options.single c->pml->single too,
 * and sets the slabs' `inner`. False: no memory. */
bool pml_fast_create(struct consistent *c);
void pml_fast_free(struct consistent *c);

void pml_fast_accelerate_double(const struct consistent *c, double factor, const double *extra, double *a);
void pml_fast_accelerate_single(const struct consistent *c, double factor, const float *extra, float *a);
/* Brings the windows of planes out to where the last call has changed a. */
void pml_fast_reached_double(const struct consistent *c, struct window *reached);
void pml_fast_reached_single(const struct consistent *c, struct window *reached);
/* Displacements of this size and less move nothing: method%quiet times the largest in u (0 without quiet). */
double pml_fast_quiet_double(const struct consistent *c, const double *u);
double pml_fast_quiet_single(const struct consistent *c, const float *u);
/* quiet: that size, for whoever knows it already. */
void pml_fast_remember_double(const struct consistent *c, double dt, double to_middle, double quiet,
                              const double *u, const double *v, double *extra);
void pml_fast_remember_single(const struct consistent *c, double dt, double to_middle, double quiet,
                              const float *u, const float *v, float *extra);

#endif
