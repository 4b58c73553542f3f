/* The H-form's operator on even and layered ground in three dimensions, fused (manual, doc/developers/performance.md).
 *
 * With b = B_z u (N M over depth, or the identity), each line one pass over rows that stay in the cache,
 *
 *   a_x = A_z u_x + N_x [p S_x b_x + q G_x (N_y G_y b_y + C_z u_z)] + N_y m S_y b_x
 *   a_y = A_z u_y + N_y [p S_y b_y + q G_y (N_x G_x b_x + C_z u_z)] + N_x m S_x b_y                     (F1)
 *   a_z = A_z u_z + N_x [m S_x b_z + G_x q C_z u_x] + N_y [m S_y b_z + G_y q C_z u_y]
 *
 * p = -(lambda + 2 mu) / rho, m = -mu / rho, q = (lambda + mu) / rho, G with its share of the boundary terms
 * (Eq 17 of the manual). All weights come from tables by row: ends, held values and symmetry planes cost no branch.
 * Edges, loads, dampers and layers are added by others.
 *
 * Damped ground whose lambda and mu relax unlike each other has a second displacement e that acts by lambda_e
 * alone. It goes through the same passes, since they are linear in the moduli:
 *
 *   m multiplies u,   q multiplies u + lambda_e / (lambda + mu) e,   p: u + lambda_e / (lambda + 2 mu) e   (F1a)
 *
 * and what the boundary terms in G would ask for besides is left at the faces (D: G without its share, E_i: -1 at
 * the low and 1 at the high end of axis i, elsewhere 0),
 *
 *   a_i += lambda_e mu / ((lambda + mu) rho) sum over j != i of N (G_i E_j - E_i D_j) e_j.                 (F1b)
 *
 * On layered ground the moduli stand in the products over depth, m B = N M_mu, q B = m B + N M_lambda, p B = m B + q B
 * with the density in N, those along the ground are D, and A and C are
 *
 *   A = -N S_mu, of u_z -N S_(lambda+2mu),   C_x, C_y = N (G_mu - G_lambda^T),   C_z = N (G_lambda - G_mu^T);   (F1c)
 *
 * with K_ij = lambda G_i^T G_j + mu G_i G_j^T and G_i^T = E_i - D_i a face across x or y that is neither mirror nor
 * held leaves, i across the face, j along the ground (nothing at the ends of depth and where two faces meet),
 *
 *   a_i -= N E_i (D_j N M_lambda u_j + N G_lambda u_z),   a_j -= N E_i D_j N M_mu u_i,   a_z -= N E_i N G_mu u_i.
 *                                                                                                       (F1d) */
#ifndef SELAS_METHOD_CONSISTENT_FUSED_FUSED_H
#define SELAS_METHOD_CONSISTENT_FUSED_FUSED_H

#include "method/consistent/fused/relax.h"
#include "method/consistent/galerkin/galerkin.h"
#include "method/consistent/galerkin/window.h"

/* Planes that are made together; rows that passes over y take together; rows of a strip, not less than passes
 * over y reach; bytes of a vector; room for taps and the planes or rows made together. */
enum { FUSED_PLANES = 4, FUSED_ROWS = 4, FUSED_STRIP = 8, FUSED_VECTOR = 64, FUSED_MOST_TAPS = 24 };

/* Rows in the ring of a plane: inputs along the plane, what is summed, and what waits for its pass over y. b_x
 * and b_y by what multiplies them: p; m and q where those are of other displacements (F1a). */
enum fused_row {
    ROW_BX,
    ROW_BY,
    ROW_BX_SHEAR,
    ROW_BY_SHEAR,
    ROW_BX_MIXED,
    ROW_BY_MIXED,
    ROW_BZ,
    ROW_CX,
    ROW_CY,
    ROW_CZ,
    ROW_AX,
    ROW_AY,
    ROW_AZ,
    ROW_G,
    ROW_T1,
    ROW_T2,
    ROW_T3,
    ROW_T4,
    FUSED_FIELDS
};

/* Matrices along x and y, and over depth by the component they are applied to. */
enum fused_side {
    SIDE_N_EVEN,
    SIDE_N_ODD,
    SIDE_S_EVEN,
    SIDE_S_ODD,
    SIDE_G_FIRST,
    SIDE_G_SECOND,
    SIDE_MATRICES
};
enum fused_depth { OVER_DEPTH_A, OVER_DEPTH_C, OVER_DEPTH_B, OVER_DEPTH_LAMBDA, OVER_DEPTH_MATRICES };
/* Results over depth behind A, C and B, where displacements are mixed or the ground is layered: B of what q and p
 * multiply. */
enum fused_mixed { OVER_DEPTH_B_MIXED = OVER_DEPTH_B + 1, OVER_DEPTH_B_AXIAL, OVER_DEPTH_RESULTS };
enum { SHARE_MIXED, SHARE_AXIAL, SHARES };

/* What is left at a face (F1b, F1d): `factor` times weights of its planes across, index `at`
 * being read, from .. to - 1 written. */
struct fused_face {
    int axis, end;
    double factor;
    size_t at, from, to;
    const double *column[3]; /* N e by component, from index 0 on */
};

struct fused_faces {
    size_t count;
    struct fused_face face[BOX_FACES];
    /* [axis] -N D, N (D - lambda / (lambda + mu) E); on layered ground -N D, -N G_lambda, -N G_mu */
    struct band *first[3], *second[3];
    struct band *bare[2];  /* B over depth of what goes across the face and along it; NULL: the identity */
    size_t row, room_size; /* numbers in a row with what is 0 on both sides; in the room of a thread */
    void *room, *flat[2];  /* of all threads; three components of a face across depth */
    size_t bytes;
};

static inline size_t fused_rounded(size_t n, size_t unit)
{
    return (n + unit - 1) / unit * unit;
}

/* One kind of ground has not more than two parts that relax (relax.h). */
enum { FUSED_PARTS = 2 };

/* Rows in the ring of each field of a plane, rows before it, numbers in all. */
struct fused_rings {
    size_t rows[FUSED_FIELDS], start[FUSED_FIELDS], size;
};

struct fused {
    size_t n[3], plane, volume;
    size_t width, stride;        /* numbers in a row, from row to row */
    struct fused_rings rings[2]; /* of one displacement, of two */
    int narrow, wide, deep;      /* taps of S and G, of N, of products over depth */
    bool bare;                   /* B is the identity */
    bool layered;                /* moduli stand in B (F1c) */
    bool bulk; /* mu is 0, and all that it is a factor of: A of x and y, S_x b_y, S_y b_x, S_x b_z, S_y b_z */
    size_t late[2];            /* rows that narrow and wide passes over y lag behind */
    void *x[SIDE_MATRICES];    /* [width / vector][taps][vector] */
    void *y[SIDE_MATRICES];    /* [rows * taps] */
    double share[SHARES];      /* of e_1 in what q and p multiply (F1a) ... */
    struct fused_faces *faces; /* what e_1 or layered ground leave; NULL: nothing */
    bool *plain;               /* [rows / FUSED_ROWS] rows of y in this group are like those in the middle */
    void *z[3][OVER_DEPTH_MATRICES]; /* [component]: [planes * deep] */
    double quiet;   /* where displacements are all below this times the largest they do not move others */
    double *size;   /* [n[2]] largest displacement in each plane, ... */
    void *column;   /* ... [n[2] * n[0]] in each of its columns, ... */
    void *strip;    /* ... [n[2] * strips] in each strip of its rows */
    size_t strips;  /* of a plane */
    double largest; /* of them after the last step in one pass ... */
    size_t loudest; /* ... and its plane */
    struct window *computed;   /* [blocks of planes] in this call */
    struct window *reached;    /* [n[2]] outside of it u and w are 0 in steps in one pass, if `known`, ... */
    struct window *will_reach; /* ... after this step ... */
    struct window *loaded;     /* ... [n[2]] where loads act */
    bool known;
    size_t *bound;          /* [threads + 1] planes where those of a thread begin */
    size_t points, skipped; /* of all calls so far */
    size_t number;          /* bytes of a number in tables and rings */
    struct fused *single;   /* the same in floats, if the scene's steps are */
    void *kept;             /* what steps in one pass go on from: the velocity half a step ahead, ... */
    size_t kept_bytes;      /* ... the e_p behind it if they relax; in single precision u or e_0 before it
                                 and all memory, then e_1, behind it */
    struct fused_relaxing *relaxing; /* NULL: steps do not relax */
    struct ranks *ranks;             /* NULL: alone */
    struct part_axis rows, planes;
    double *loud; /* [4 * blocks of planes of the body] where it is loud, if ranks share rows */
    int threads;
    void **buffer;      /* [threads] */
    size_t buffer_size; /* numbers */
    size_t bytes;
};

/* What a block of planes works on: a := (F1), or with `moved` not NULL the step u += dt w, w += dt (F1). */
struct fused_fields {
    const void *u;
    void *a;     /* w in a step */
    void *moved; /* u again */
    double dt;
    const struct fused_relax *relax; /* the fields `kept` go on by this, u being the first; NULL: u by dt w */
    void *const *kept;
    const void *other;         /* e_1, NULL if there is one part */
    const struct pml *dragged; /* layers that damp w besides; NULL: none do */
    size_t bring_on, before;   /* planes of u to be brought on on the way */
};

/* Builds c->fused if the scene is one for it (c->fused stays NULL if not); false: no memory. Needs c->hform.
 */
bool fused_create(struct consistent *c);
void fused_free(struct fused *fused);
/* tables.c: weights of the operator; false: no memory. */
bool fused_lay_tables(struct consistent *c, struct fused *f);
/* Tables of weights: of each row, `taps` a row, rows up to `rows` being 0; the same by vectors, [width / vector][taps]
 * [vector]. NULL: no memory. */
double *fused_by_rows(const struct band *band, double factor, int taps, size_t rows);
double *fused_by_vectors(const struct band *band, double factor, int taps, size_t width, size_t vector);
/* plain[group] stays true for groups of rows whose weights are all the same, but for the rounding of positions up to n
 * spacings. */
void fused_find_plain(const double *table, size_t taps, size_t n, bool *plain);
/* Numbers of a table in single precision, in place. */
void fused_shorten(void *table, size_t n);
/* (F1) in the window computed[] of the planes first .. first + FUSED_PLANES - 1 (those that are there), first
 * a multiple of FUSED_PLANES; an acceleration is 0 outside. */
void fused_planes_double(const struct fused *fused, int thread, size_t first,
                         const struct fused_fields *fields);
void fused_planes_single(const struct fused *fused, int thread, size_t first,
                         const struct fused_fields *fields);
/* integral of test and trial functions of an axis, odd or even, with slopes or not, less `share` of the
 * boundary term E (-1 at the low, 1 at the high end; 0 at mirrors). NULL: no memory. */
struct band *fused_narrow_matrix(struct consistent *c, int axis, bool test_odd, bool test_slope,
                                 bool trial_odd, bool trial_slope, double share);
/* Rings of rows of `displacements` (1 or 2), and rooms that hold them; false: no memory. */
bool fused_lay_rings(struct fused *f, int displacements);
/* faces.c: from now on calls have displacements besides that act by the lambda of `second` (F1a); false: no
 * memory. */
bool fused_mix(struct consistent *c, const struct consistent *second);
bool fused_layered_faces(struct consistent *c);   /* what (F1d) needs; false: no memory */
void fused_faces_free(struct fused_faces *faces); /* takes NULL */
/* Adds what layered ground leaves at faces (F1d) to an acceleration; false: nothing. */
bool fused_add_faces_double(const struct consistent *c, const double *u, double *a);
/* active.h. Sets computed[] for the displacements given: within reach of what is not quiet. */
void fused_look_double(struct fused *fused, const double *u);
void fused_look_single(struct fused *fused, const float *u);
/* All columns and rows; those that are computed here. */
struct window fused_whole(const struct fused *fused);
struct window fused_own(const struct fused *fused);
/* Counts the points of a call and keeps the largest displacement. */
void fused_count(struct fused *fused);
void fused_forget(struct fused *fused); /* these counts; takes NULL */

/* What steps in one pass work on. Each part has displacements u and the layers' memory variables (NULL
 * without layers); with `relax` (NULL: none) u of part p is e_p, and these and memory are the fields `kept`. */
#define STEP_FIELDS(real, precision)                                                                         \
    struct step_fields_##precision {                                                                         \
        real *w, *work;                                                                                      \
        const struct fused_relax *relax;                                                                     \
        void *kept[FUSED_FIELDS_KEPT];                                                                       \
        size_t parts;                                                                                        \
        struct {                                                                                             \
            const struct consistent *c;                                                                      \
            real *u, *extra;                                                                                 \
        } part[FUSED_PARTS];                                                                                 \
    };
STEP_FIELDS(double, double)
STEP_FIELDS(float, single)
#undef STEP_FIELDS

/* fused_step.h. w := v + dt/2 a from w = v, with entries of a that are watched; `work` has room for a. */
void fused_begin_double(const struct consistent *c, const struct drive *drive, double dt,
                        const struct step_fields_double *fields, double *a);
void fused_begin_single(const struct consistent *c, const struct drive *drive, double dt,
                        const struct step_fields_single *fields, double *a);
/* u += dt w, w += dt a at the new u; entries of y and a that are watched. */
void fused_advance_double(const struct consistent *c, const struct drive *drive, double dt,
                          const struct step_fields_double *fields, double *y, double *a);
void fused_advance_single(const struct consistent *c, const struct drive *drive, double dt,
                          const struct step_fields_single *fields, double *y, double *a);
/* u and v = w - dt/2 a in y; a if it is not NULL. */
void fused_settle_double(const struct consistent *c, const struct drive *drive, double dt,
                         const struct step_fields_double *fields, double *y, double *a);
void fused_settle_single(const struct consistent *c, const struct drive *drive, double dt,
                         const struct step_fields_single *fields, double *y, double *a);

/* one_pass.c: if the scene's steps of leapfrog can be made in one pass, takes what that needs and puts it
 * into the model's class; SELAS_UNSUPPORTED: options.single, but they cannot. Needs model.state_size. */
selas_status fused_steps_create(struct consistent *c, struct messages *messages);

#endif
