/* Steps of leapfrog of the general operator in one pass over the fields, in three dimensions
 * (doc/theory/general-ground.md, section 2).
 *
 * Control values are those of the unclamped splines along x and y, c~ of (G5); over depth the weights of the ends say
 * the same. A plane of points on the knots of depth and the plane of middles below it are made together, row after
 * row: values and slopes over depth, along y, along x, stresses, and back the same way. Forces of a plane that is
 * done go through N along x and y; N over depth and the update follow four planes at a time. */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_SWEEP_H
#define SELAS_METHOD_CONSISTENT_GENERAL_SWEEP_H

#include "base/processor.h"
#include "method/consistent/fused/kernels.h"
#include "method/consistent/general/layers.h"

/* Fields over depth: values and slopes at the middles, then at the knots. Taps of N; planes whose update is made
 * together, and those that N reaches beyond them. */
enum sweep_field { VALUE_MIDDLES, SLOPE_MIDDLES, VALUE_KNOTS, SLOPE_KNOTS, DEPTH_FIELDS };
/* Fields of pulls: those, and where absorbing layers are, of stresses along y, which else are among the values'. */
enum { ACROSS_MIDDLES = DEPTH_FIELDS, ACROSS_KNOTS, PULL_FIELDS };
enum { SWEEP_TAPS = 13, SWEEP_REACH = SWEEP_TAPS / 2, SWEEP_PLANES = 4, SPAN = 3 };
/* Rows of stresses of a family: the six, then what pulls along depth below a hill. */
enum { STRESS_ROOM = STRESSES + 3 };

/* Rows from .. end - 1. */
struct rows {
    size_t from, end;
};

/* Weights over depth of a pair of planes of points: control planes base .. base + 2. */
struct over_depth {
    size_t base;
    void *weight[2]; /* [odd]: [DEPTH_FIELDS][SPAN] */
};

/* Where the forces of stresses along the axis of a layer are kept apart: rows, columns and planes by slot, numbers of
 * the unclamped splines along x and y; rows in the ring. */
struct sweep_part {
    size_t at[3], n[3], stride, start;
};

/* [family]: rows of `width` numbers; of parts but the first 0 at points that are not isotropic. */
struct sweep_moduli {
    void *lambda[3], *mu[3];
};

struct sweep {
    size_t n[3], plane, volume; /* of the fields */
    size_t cells[3], low[3];    /* control values beyond a symmetry plane at the low end: 0 or 1 */
    bool mirror[3][2];
    size_t number;        /* bytes of a number */
    size_t width, stride; /* numbers of a row, from row to row */
    size_t rows;          /* of a plane that is ready */
    struct over_depth *pair;
    void *weights;                                 /* of all pairs */
    void *x[3], *y[3], *z[3];                      /* [component]: N by vectors, by rows, by planes */
    bool *plain;                                   /* groups of rows of y with the same weights */
    struct sweep_moduli moduli[FUSED_FIELDS_KEPT]; /* of the parts of damped ground, else one */
    size_t points[3][2];                           /* [family]: rows and planes */
    double factor[3][3];                           /* [family]: of slopes along x, y and depth */
    void *hill[3][3];                              /* [family]: s and its slopes, rows of `width` numbers */
    void *root;                                    /* [volume] */
    void *ready;  /* [component][planes][rows][stride]: N along x and y of the forces */
    bool layered; /* the body has absorbing layers: the same on all ranks */
    struct sweep_part part[BOX_FACES];
    size_t part_size; /* numbers of their rings */
    double quiet, largest;
    double *size;         /* [planes * n[1]]: largest displacement of each row */
    struct rows *reached; /* [planes]: u and w are 0 in other rows */
    struct rows *loaded;  /* [planes]: rows where loads act */
    struct rows *filled;  /* [planes]: rows of `ready` that are not 0 */
    struct rows *waiting; /* [planes]: rows of forces */
    bool known;           /* `reached` and `largest` are right */
    void *kept; /* w, in single precision behind u; the fields that relax behind it, but in double memory */
    size_t kept_bytes;
    struct fused_relaxing *relaxing; /* NULL: steps do not relax */
    size_t parts;                    /* of damped ground, else 1 */
    int threads;
    size_t *bound; /* [threads + 1] planes where those of a thread begin */
    void **buffer; /* [threads] */
    size_t bytes;
};

/* s and its slopes along x and y at the points of a row, f and its slope over depth (G16). */
#define SWEEP_KERNELS(real, precision)                                                                               \
    struct sweep_hill_##precision {                                                                                  \
        const real *drop, *slope[2];                                                                                 \
        real share, fall;                                                                                            \
    };                                                                                                               \
    /* A row of points of a family: moduli, factors of slopes along x, y and depth; y_knots, x_knots: where  \
     * its points are; hill NULL: level. Runs as in points.h. */       \
    struct sweep_row_##precision {                                                                                   \
        bool x_knots, y_knots;                                                                                       \
        size_t width, stride;                                                                                        \
        real factor[3];                                                                                              \
        const real *lambda, *mu;                                                                                     \
        const struct sweep_hill_##precision *hill;                                                                   \
        const struct run_of_points *run;                                                                             \
        size_t runs;                                                                                                 \
        const double *stiffness;                                                                                     \
        const real *in[SPAN]; /* of the ring of values over depth: [component][DEPTH_FIELDS][stride] */              \
        real *out[SPAN];      /* of pulls, PULL_FIELDS each: the last of them is set, the others grow */             \
        int field, across;    /* in rings: of values, slopes come next; of pulls along y in stresses() */            \
        real *scratch;        /* [(9 + STRESS_ROOM) * stride] with room before it */                                 \
    };                                                                                                               \
    struct sweep_kernels_##precision {                                                                               \
        /* u += dt w, n numbers; gives the largest |u| */                                                            \
        real (*bring)(size_t n, real dt, const real *w, real *u);                                                    \
        /* out[q][i] := sum over d of weight[q][d] in[d][i], i < n */                                                \
        void (*depth)(size_t n, const real *const in[SPAN], const real weight[DEPTH_FIELDS][SPAN],                   \
                      real *const out[DEPTH_FIELDS]);                                                                \
        void (*points)(const struct sweep_row_##precision *row);                                                     \
        /* The same in two: slopes at the points, [3 * component + slot] rows of the scratch, where others may    \
         * change them; and the pulls of their stresses, those along y apart. */  \
        void (*slopes)(const struct sweep_row_##precision *row);                                                     \
        void (*stresses)(const struct sweep_row_##precision *row);                                                   \
        /* Those slopes along one slot only, at points from .. end - 1 at least. */                                  \
        void (*slope)(const struct sweep_row_##precision *row, int slot, size_t from, size_t end);                   \
        /* The same of several parts: the stresses of one, from slopes that are there or not, in the place of or   \
         * beside those of others; then what they pull at. */ \
        void (*stresses_of)(const struct sweep_row_##precision *row, bool made, bool more);                          \
        void (*pulls_of)(const struct sweep_row_##precision *row, bool made);                                        \
        /* out[d][i] -= sum over q of weight[q][d] in[q][i], i < width; apart: in[] has all PULL_FIELDS, those    \
         * of y with the weights of values */  \
        void (*pulls)(bool apart, size_t width, const real *const in[PULL_FIELDS],                                   \
                      const real weight[DEPTH_FIELDS][SPAN], real *const out[SPAN]);                                 \
        /* Memory of absorbing layers at n points of a row: slope[i] += psi[i]; */                                   \
        void (*recall)(size_t n, const double *psi, real *slope);                                                    \
        /* psi brought on by the slope less `half` of its rate before, by factors of one point or of each along   \
         * the row; */  \
        void (*remember)(size_t n, bool along, const double *kept, const double *taken, real half,                   \
                         const real *rate, double *psi, real *slope);                                                \
        /* out[i] += root[i] phi[i] */                                                                               \
        void (*pull)(size_t n, const double *phi, const real *root, real *out);                                      \
        /* out[i] -= a one[i] + b other[i], i < n */                                                                 \
        void (*keep)(size_t n, real a, const real *one, real b, const real *other, real *out);                       \
        /* out[i] := factor[i] in[i], i < n */                                                                       \
        void (*scale)(size_t n, const real *factor, const real *in, real *out);                                      \
        /* Slopes along the axes of a component u at a point near an edge, n numbers along each axis. */             \
        void (*edge_slopes)(const struct edge_taps *of, const double *slope, const size_t n[3],                      \
                            const real *u, double sum[3]);                                                           \
        /* What its stresses pull at in a plane of slope[], off rows of forces, over EDGE_LANES columns. */          \
        void (*edge_pulls)(const struct edge_taps *of, const double *slope, const double pull[3],                    \
                           size_t stride, real *force);                                                              \
        /* out[p][i] += factor root[p][i] sum over t of weight[p][t] in[p + t][i], p < planes, i < n; what is   \
         * `ahead` numbers on, the next row, is asked for */    \
        void (*finish)(size_t n, size_t planes, const real *weight, const real *const *in, size_t ahead,             \
                       real factor, const real *const *root, real *const *out);                                      \
    };                                                                                                               \
    EACH_PROCESSOR(struct sweep_kernels_##precision, sweep_kernels_##precision)
SWEEP_KERNELS(double, double)
SWEEP_KERNELS(float, single)
#undef SWEEP_KERNELS

/* sweep.c: builds general->sweep if the scene is one for it; false: no memory. */
bool sweep_create(struct consistent *c);
void sweep_free(struct sweep *sweep);

/* From now on steps relax, and have the parts' stiffness in them; false: no memory. */
bool sweep_relax(struct consistent *c, const struct relaxing *relaxing);

/* What steps work on. Each part has displacements u and the layers' memory in the state, double in either precision; if
 * they relax u of part p is e_p, and these and memory are the fields `kept`, else u alone is. */
#define SWEEP_FIELDS(real, precision)                                                                        \
    struct sweep_fields_##precision {                                                                        \
        real *w, *work;                                                                                      \
        const struct fused_relax *relax;                                                                     \
        size_t fields, parts;                                                                                \
        void *kept[FUSED_FIELDS_KEPT];                                                                       \
        struct {                                                                                             \
            struct general *ground;                                                                          \
            real *u;                                                                                         \
            double *extra;                                                                                   \
        } part[FUSED_FIELDS_KEPT];                                                                           \
    };
SWEEP_FIELDS(double, double)
SWEEP_FIELDS(float, single)
#undef SWEEP_FIELDS

/* sweep_step.h. w := v + dt/2 a from w = v; a in `work`. */
void sweep_begin_double(struct consistent *c, const struct drive *drive, double dt,
                        const struct sweep_fields_double *fields);
void sweep_begin_single(struct consistent *c, const struct drive *drive, double dt,
                        const struct sweep_fields_single *fields);
/* u += dt w, w += dt a at the new u, with the loads of the drive, and the layers' memory; entries of y and a that are
 * watched. */
void sweep_advance_double(struct consistent *c, const struct drive *drive, double dt,
                          const struct sweep_fields_double *fields, double *y, double *a);
void sweep_advance_single(struct consistent *c, const struct drive *drive, double dt,
                          const struct sweep_fields_single *fields, double *y, double *a);
/* u of the first part and v = w - dt/2 a in y; a if it is not NULL. */
void sweep_settle_double(struct consistent *c, const struct drive *drive, double dt,
                         const struct sweep_fields_double *fields, double *y, double *a);
void sweep_settle_single(struct consistent *c, const struct drive *drive, double dt,
                         const struct sweep_fields_single *fields, double *y, double *a);

/* one_pass.c: as fused_steps_create(). */
selas_status general_steps_create(struct consistent *c, struct messages *messages);

#endif
