/* The step of the absorbing layers on level ground in three dimensions, with the passes of a slab shared
 * (doc/theory/absorbing-faces.md, section 4). It serves where the fused operator (fused.h) does, and in layered ground.
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
 * identity there.) Where B is the identity phi_ij, i != j, moves on with L2.
 *
 * Layered ground has no pair C1, C2 common to both moduli. With B_w = N M_w over depth, w over the density,
 * D_k = -N G_k^T (C_k but at free ends of axis k) and b = z, in slabs along depth
 *
 *   T_j  = B_(lambda + 2 mu) T'_j + B_lambda C_j (C_f u_f + m_ff) + B_mu C_j (D_f u_f + m_ff)
 *          + N (G_lambda - G_mu^T) C_j u_b + (lambda + mu) / rho C_j m_bb,                              (L5)
 *
 * T'_j here without its last term, B_mu for the other T_i; psi_jj acts by B_lambda D_f + B_mu C_f if i = f. What the
 * products with C_j u_f make waits in parts of its own (struct cross). As B_(lambda + 2 mu) = B_lambda + 2 B_mu, T'_j
 * joins what B_lambda acts on, twice of it what B_mu does. In slabs across depth the matrices of lambda and of mu over
 * depth stand in place of the B. */
#ifndef SELAS_METHOD_CONSISTENT_ABSORBING_PML_FAST_H
#define SELAS_METHOD_CONSISTENT_ABSORBING_PML_FAST_H

#include "method/consistent/absorbing/pml.h"
#include "method/consistent/galerkin/window.h"

/* Rows made together, at most: along s (more would read more inputs for each row, and not all sums of two vectors
 * would find registers), along b; numbers in a vector of doubles; numbers left free beside
 * rows that are read with neighbours; blocks of rows that a thread needs. */
enum { FAST_ROWS = 5, FAST_GROUP = 4, FAST_LANES = 8, FAST_PAD = 16, FAST_BLOCKS = 27 };

/* Parts of the T'_i, one a component and those of lambda and mu; products with slopes along f or b: one of both, or one
 * each. */
enum { PART_LAMBDA = 3, PART_MU = 4, FAST_PARTS = 5, FAST_CROSSES = 2 };

/* Roles of the axes. */
enum role { ROLE_S, ROLE_B, ROLE_F };

/* A matrix over rows: each group of rows of the result with those that it is made from. With `changes` the weights of
 * the input in the middle are the sums of all, and the others are taken of differences from it. */
struct row_group {
    size_t to, rows, from, inputs;
    bool changes;
    void *weight; /* [inputs][rows] */
};
struct row_table {
    size_t groups;
    struct row_group *group;
};

/* C1_f (C2_j u_f) of L2, and what it is of in L4. */
struct cross {
    struct row_table change; /* C2_j, region to inside; no groups: of the cross before it, or C_j of L1 */
    void *along, *pull;      /* C1_f, C2_f by diagonals: [taps_f * width]; NULL: not in L4 */
    int part;                /* where it waits, with the B of psi_jj in L4 */
};

/* C1_b (C2_j u_b) of L3. */
struct over {
    struct row_table change, over_b; /* change: no groups: C_j of L1 */
    void *wait;                      /* [nb][ns][width] */
};

struct fast_slab {
    const struct slab *slab;
    int axis[3];                  /* by role */
    size_t ns, nb, nf, width;     /* numbers of the slab by role; in a padded row */
    size_t first_b, first_f;      /* rows of the whole body that are the first ones over b and f */
    struct block inside;          /* the slab's, without its outer end */
    const double *damping;        /* [ns] d there */
    size_t start;                 /* index of the region's first row along s */
    size_t region, offset;        /* rows along s of its region; the first of them inside */
    size_t first, step[3];        /* in fields: the region's first value, steps by role */
    struct row_table gradient[3]; /* by component; region to inside: C_j of L1 */
    struct row_table second[3];   /* A_j, region to inside */
    struct row_table slope[3];    /* C_j, inside to inside */
    struct cross cross[FAST_CROSSES];
    struct over over[FAST_CROSSES];
    size_t crosses, overs, parts;
    struct row_table divergence;       /* C2_j of m_ff and m_bb, region to inside */
    double *beyond;                    /* [nb] factor of m_bb besides; NULL: 1 */
    struct row_table pull[3];          /* C_j, inside to region */
    struct row_table bare[FAST_PARTS]; /* B, by part, over b; no groups: the identity */
    struct row_table pull_b;           /* C2_b */
    size_t taps_f;
    int own;                         /* the part in which T'_j waits */
    void *wait[FAST_PARTS], *middle; /* [nb][ns][width]: T'_i, NULL: it is not waited for; m_jj */
    bool *rests;                     /* [nb] rows in which nothing moves, in this call */
    bool *moves;                     /* [nb] own rows in which something moves phi */
    bool *idle;                      /* [nb] rows of `wait` and `middle` that are 0 */
};

/* Tables and room for numbers of one kind, doubles or floats; the memory variables are laid out alike in
 * both. */
struct pml_fast {
    bool single;
    struct fast_slab slab[BOX_FACES];
    void **buffer; /* [threads] */
    size_t bytes;
    double *told; /* [2 * planes of the body] what ranks that share rows along f agree on, by face */
    unsigned long groups, skipped; /* of rows so far */
};

/* Builds c->pml->fast if all slabs are for it (else it stays NULL), with options.single c->pml->single too,
 * and sets the slabs' `inner`. False: no memory. */
bool pml_fast_create(struct consistent *c);
/* Numbers in a row of so many, padded. */
size_t pml_fast_width(const struct consistent *c, size_t numbers);
void pml_fast_free(struct consistent *c);

void pml_fast_accelerate_double(const struct consistent *c, double factor, const double *extra, double *a);
void pml_fast_accelerate_single(const struct consistent *c, double factor, const float *extra, float *a);
/* The same in turns (part.h): once after memory has gone on, then what is due in each. */
void pml_fast_look_double(const struct consistent *c, const double *extra);
void pml_fast_look_single(const struct consistent *c, const float *extra);
void pml_fast_pull_double(const struct consistent *c, int turn, double factor, const double *extra,
                          double *a);
void pml_fast_pull_single(const struct consistent *c, int turn, double factor, const float *extra, float *a);
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
