/* The consistent smoothed point method: inside of the model (doc/theory/consistent-method.md).
 *
 * Unknowns are control values of tensor-product B-splines in the body's own frame, component c of control
 * value (i, j, k) at c * volume + i + n[0] * (j + n[1] * k). The scene's axes lie in the slots x, y, z of
 * that layout: one axis in slot 2; two in 0 and 2; three in 0, 1, 2. The last axis (depth, slot 2) may have
 * material that varies. */
#ifndef SELAS_METHOD_CONSISTENT_GALERKIN_GALERKIN_H
#define SELAS_METHOD_CONSISTENT_GALERKIN_GALERKIN_H

#include "method/consistent/galerkin/part.h"
#include "method/spline/tensor.h"
#include "method/spline/tuned.h"
#include "model/model.h"

struct consistent_options {
    int degree;       /* 1 .. SPLINE_MAX_DEGREE */
    bool tuned;       /* exact mass: splines of all axes but the last tuned (tuned.h) */
    bool mapped;      /* ends mapped instead of open */
    int sweeps;       /* 0: exact mass; 1 .. 3: van Cittert mass and H-form */
    bool depth_exact; /* H-form: the stiffness keeps M over depth (always so with layers) */
    double
        dissipation; /* H-form: rate at which the shortest waves die away, in units of speed over spacing */
    double quiet;    /* H-form: displacements below this times the largest move nothing; 0: all do */
    bool single;     /* layers: tables for steps in single precision, too */
    bool general;    /* the general operator (general/general.h) in place of the H-form */
    bool unfused;    /* H-form: passes one by one even where the fused operator (fused.h) would do */
};

/* Beside absorbing layers the inverse of an exact mass is a band of this half-width at most: its columns fall off by a
 * factor an entry (.27, .43, .54, .61 for degrees 1 to 4), and what is further off is below 1e-10 of the largest. */
static inline size_t exact_inverse_half(const struct consistent_options *options)
{
    return 10 * (size_t)options->degree + 8;
}

enum { MAX_MATRICES = 96, DEPTH = 2, FACTOR_SETS = 3, LINES = 8 };

/* Material property that weights an integral over depth. */
enum weighting { WEIGHT_DENSITY, WEIGHT_LAMBDA, WEIGHT_MU, WEIGHT_P, WEIGHT_NONE };

struct axis_matrix {
    int axis, test_slope, trial_slope;
    bool test_odd, trial_odd;
    enum weighting weight;
    struct band *band;
};

/* Control values from[] up to to[], not included, by slot; to[0] = 0: none. */
struct footprint {
    size_t from[3], to[3];
};

/* A field of which little is known to be not 0. */
struct dense {
    double *value;                 /* [dimension * volume] */
    struct footprint footprint[3]; /* by component: 0 out of it */
};

/* A vector with few entries. Plane p of component c is number c * n[2] + p; index is that within the plane. */
struct sparse {
    size_t planes, *plane, *start; /* that have any, ascending; their entries are start[p] to start[p + 1] */
    size_t *index;
    double *value;
};

/* Vectors, and of each plane which have entries there: number[i] in their planes part[i], start[plane] <= i <
 * start[plane + 1], ascending. */
struct sparse_list {
    size_t count;
    struct sparse *of;
    size_t *start, *number, *part;
};

/* Factors of M + half_step C, product form (section 5 of the manual); NULL for slots that are not used. */
struct mass_factors {
    double half_step;
    size_t half[3];        /* [slot]: half-widths */
    double *depth[3];      /* [component] */
    double *(*side)[3][2]; /* [class][component][slot] */
};

/* Entries of u that someone looks at after every step in one pass, in all components. */
struct watch {
    size_t count, room, *entry;
    bool sorted;
    double *before;       /* [count] room for the velocities before a step */
    unsigned char *taken; /* a bit a control value: is there */
};

struct consistent {
    struct model model;
    struct consistent_options options;
    int dimension, slot[3];         /* slot of each axis */
    struct spline *spline[3];       /* by axis */
    const struct spline *layout[3]; /* by slot; NULL where there is no axis */
    size_t n[3], plane, volume;     /* of the fields: over depth those of the rank's window */
    struct rank_part part;
    double property[WEIGHT_NONE];  /* of the body's material */
    double *weighted[WEIGHT_NONE]; /* per element of the depth axis; NULL: the same everywhere */
    size_t matrices;
    struct axis_matrix matrix[MAX_MATRICES];
    const struct band *mass_band[3][3]; /* [component][axis], weighted by density where that varies */
    const struct band *mass_depth[3];   /* the window's part of those over depth */
    struct tensor_plan *stiffness, *mass;
    bool held[3][BOX_FACES]; /* the face's control values of this component are prescribed */
    bool moving[BOX_FACES];
    double motion[BOX_FACES][3]; /* amplitude and direction in the body's frame */
    bool damped[BOX_FACES];
    double
        *speed[BOX_FACES]
              [3]; /* of a damped face's component at each plane of the whole body: factor times wave speed */
    size_t classes;                    /* kinds of planes by material; 1 without layers */
    size_t *plane_class, *class_plane; /* of the whole body; [classes]: the first plane of a class */
    struct band *side[BOX_FACES][3];   /* layers: matrix over depth of a damped face across x or y */
    struct sparse_list load;           /* of the scene; 0 for those that move */
    size_t moving_loads;
    struct moving_load *moving_load;                      /* moving_load.c */
    struct sparse pattern[BOX_FACES], inertia[BOX_FACES]; /* of moving faces: where; M times it */
    struct mass_factors factors[FACTOR_SETS];
    struct band *scratch[3]; /* [axis]: matrix to be factorised */
    double *surface;         /* [n[0] * n[1]] control values of s (surface.c); NULL: the surface is level */
    size_t layer[BOX_FACES]; /* points of the absorbing layer behind the face; 0: none */
    struct pml *pml;         /* NULL: no layers */
    struct scene *own_scene; /* of a body that was cut (shorter.c); NULL: the scene is borrowed */
    double *lane_buffer;     /* [threads * n[0] * LINES] */
    double *line_buffer;     /* [threads * (n[0] + n[1])] */
    double *face_buffer;     /* [dimension * plane] */
    struct hform *hform;     /* NULL: exact mass */
    struct general *general; /* NULL: the H-form or the exact mass */
    struct watch watch;
    struct fused *fused; /* NULL: the scene is none for it, or it is not wanted */
    int threads;
    struct tuned_point *lattice[3][2]; /* [axis][odd]: functions at the lattice points of an axis */
    struct band *collocation[3][2];    /* [axis][odd]: LU factors of the values at the Greville points */
};

/* Lines of control values along a slot: `lanes` neighbouring lines may be worked on at once. */
struct line_set {
    size_t lines, lanes, length, stride;
};
static inline struct line_set line_set(const struct consistent *c, int slot)
{
    const size_t stride = slot == 0 ? 1 : slot == 1 ? c->n[0] : c->plane;
    return (struct line_set){c->volume / c->n[slot], stride, c->n[slot], stride};
}
static inline size_t line_start(const struct line_set *set, size_t line)
{
    return line / set->stride * set->stride * set->length + line % set->stride;
}

static inline struct consistent *consistent_of(struct model *model)
{
    return (struct consistent *)model;
}

/* matrices.c: 1-D matrix of an axis, kept by the model; NULL: no memory. */
const struct band *consistent_matrix(struct consistent *c, int axis, int test_slope, bool test_odd,
                                     int trial_slope, bool trial_odd, enum weighting weight);
bool consistent_plans(struct consistent *c);

/* watch.c: keeps v and a (and y, if the state is kept apart) right at these control values, in all components; the same
 * where loads act, whose power is that of the velocities there. False: no memory. */
bool watch_places(struct consistent *c, size_t count, const size_t *place);
bool watch_loads(struct consistent *c);
void watch_sort(struct watch *watch); /* in the order of memory */
void watch_free(struct watch *watch);

/* mass.c */
bool mass_allocate(struct consistent *c);
void mass_free(struct consistent *c);
const struct mass_factors *mass_factors_for(struct consistent *c, double half_step);
/* a := (M + half_step C)^-1 a */
void mass_solve(struct consistent *c, const struct mass_factors *factors, double *a);

/* loads.c: loads, prescribed faces. */
selas_status forces_create(struct consistent *c, struct messages *messages);
/* Adds to `field` forces of a moment tensor, by slot, at `centre` of the lattice; `moment` then
 * holds what is left to act on the splines' strain. False: no memory. */
typedef bool moment_beside(const struct consistent *c, const struct load *load, const double centre[3],
                           double moment[3][3], struct dense *field);
/* Adds what the splines' displacement at `centre` lacks, times a direction by slot; half: halved on symmetry planes.
 * False: no memory. */
typedef bool force_beside(const struct consistent *c, const double centre[3], const double direction[3],
                          bool half, struct dense *field);
/* Together: makes moment tensors and body forces again. */
selas_status forces_in_ground(struct consistent *c, moment_beside *beside, force_beside *at_kink,
                              struct messages *messages);
/* Together: those of one, NULL or not. To be freed. False: no memory. */
bool forces_of_moment(struct consistent *c, moment_beside *beside, const struct load *load,
                      struct sparse *sparse);
void forces_free(struct consistent *c);
size_t forces_bytes(const struct consistent *c); /* of the loads' and moving faces' vectors */
/* Values (or slopes) of an axis's functions at x; halved where x lies on a symmetry plane and half is true.
 */
void consistent_point_line(const struct consistent *c, int axis, bool odd, bool slope, bool half, double x,
                           double *line);
/* The same for a moment tensor: of higher order, halved on symmetry planes. */
void consistent_source_line(const struct consistent *c, int axis, bool odd, bool slope, double x,
                            double *line);
/* beneath.c: adds the forces of what a moment tensor, by slot, pulls at across a free face that is near; `moment` keeps
 * the rest. False: no memory. */
bool consistent_beneath(const struct consistent *c, const double centre[3], double moment[3][3],
                        struct dense *field);
/* The free face that a source is right below: spacings, its normal there by slot, the hats between it and the next
 * interface. False: below none. */
struct consistent_face {
    int face, hats;
    double depth, normal[3];
};
bool consistent_face_above(const struct consistent *c, const double centre[3], struct consistent_face *face);
/* (G21): the strain across n, and the part of M n along it over mu; `moment` keeps the rest. */
void consistent_part_moment(const double n[3], double lambda, double mu, double moment[3][3],
                            double strain[3][3], double slip[3]);
/* Spacings from a free face within which moment tensors that pull across it err; 0: none do. */
double consistent_shallow(const struct consistent *c);
/* Rock at a place of the lattice, by axis. */
struct rock consistent_rock_at(const struct consistent *c, const double place[3]);
/* Does the rock change by more than a twentieth? */
bool consistent_rock_differs(struct rock one, struct rock other);
/* field += factor * product of the lines, by axis. */
void consistent_add_product(const struct consistent *c, double *const line[3], int component, double factor,
                            struct dense *field);
/* sparse.c: takes the entries of a dense field that are not zero, which leaves it 0. False: no memory. */
bool sparse_take(const struct consistent *c, struct dense *field, struct sparse *sparse);
/* A component may be not 0 there, too; all may be, everywhere. */
void dense_widen(struct dense *field, int component, const struct footprint *there);
void dense_whole(const struct consistent *c, struct dense *field);
void sparse_free(struct sparse *sparse);
size_t sparse_bytes(const struct sparse *sparse);
/* `count` vectors, all 0; then, once they are made, which planes they have entries in. False: no memory. */
bool sparse_list_new(struct sparse_list *list, size_t count);
bool sparse_list_sort(const struct consistent *c, struct sparse_list *list);
void sparse_list_free(struct sparse_list *list);
size_t sparse_list_bytes(const struct consistent *c, const struct sparse_list *list);
/* Adds loads and the pull of moving faces, as vectors given, in plane k. */
void add_forces(const struct consistent *c, const struct drive *drive, const struct sparse_list *load,
                const struct sparse *pull, int component, size_t k, double *plane);
void sparse_add(const struct consistent *c, const struct sparse *sparse, int component, size_t k,
                double factor, double *plane);
double sparse_dot(const struct consistent *c, const struct sparse *sparse, const double *field);

/* dampers.c: subtracts C v from plane k of each component; power v.Cv. */
bool dampers_allocate(struct consistent *c);
void dampers_subtract(const struct consistent *c, int thread, size_t k, const double *v, double *const *out);
double dampers_power(const struct consistent *c, const double *v);

/* axes.c: sets a component's prescribed control values in plane k to 0. */
void consistent_clear_held(const struct consistent *c, int component, size_t k, double *plane);

/* axes.c: axes, what faces do to control values, materials over depth. SELAS_NO_MEMORY,
 * SELAS_BAD_SCENE. */
selas_status consistent_lay(struct consistent *c, struct messages *messages);
/* surface.c: false: no memory. */
bool consistent_lay_surface(struct consistent *c);
/* Values at the Greville points from control values, as LU factors; free it with band_free(). NULL: no memory. */
struct band *consistent_collocation(const struct spline *spline, bool odd);
/* Fastest wave of the ground that a face touches. */
double consistent_fastest(const struct consistent *c, int face);

#endif
