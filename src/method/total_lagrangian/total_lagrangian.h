/* Total-Lagrangian SPH: what its files share, and how tests build it without a deck.
 *
 * Unknowns: displacements of the points in the body's frame, u[dimension * i + c]. Sites are the points and,
 * after them, the ghosts beyond mirror planes and on clamped faces. */
#ifndef SELAS_METHOD_TOTAL_LAGRANGIAN_TOTAL_LAGRANGIAN_H
#define SELAS_METHOD_TOTAL_LAGRANGIAN_TOTAL_LAGRANGIAN_H

#include "kernel/kernel.h"
#include "method/total_lagrangian/elastic_law.h"
#include "method/total_lagrangian/sets.h"
#include "model/model.h"
#include "parallel/few_ranks.h"
#include "points/cloud.h"
#include "points/neighbours.h"

#include <stdint.h>

struct tl_model;
struct tl_form;

struct tl_options {
    int degree;                  /* 1: linear (TL1), 2: quadratic (TL2) gradients */
    const struct tl_form *form;  /* other points and gradients (the cloud method); NULL: those of SPH */
    bool central;                /* degree 1 by differences along the axes of a lattice */
    const struct kernel *kernel; /* shape of the weights */
    double smoothing_length;     /* in spacings; 0: the degree's default */
    double hourglass;            /* strength of the penalty on what the gradients do not see; 0: none */
    double viscosity_alpha, viscosity_beta; /* Monaghan 1992; 0: none */
    enum elastic_law law;
};

extern const struct method method_total_lagrangian;

/* What a method does in its own way that carries this model with points on the faces too: they are held, not
 * mirrored by ghosts, and values are interpolated. */
struct tl_form {
    const struct method *method;
    const char *gradient; /* what the plan says of them */
    selas_status (*points)(const struct scene *scene, struct cloud **cloud, struct messages *messages);
    /* Fills tl->gradient. */
    selas_status (*gradients)(struct tl_model *tl, const struct neighbours *near, struct messages *messages);
    /* Fills tl->held. */
    selas_status (*hold)(struct tl_model *tl, struct messages *messages);
    /* Adds a traction on a face of the box to force[dimension * points]. */
    selas_status (*traction)(struct tl_model *tl, const struct load *load, const double centre[3],
                             const double direction[3], double *force, struct messages *messages);
};

struct tl_options tl_default_options(void);
selas_status total_lagrangian_create(const struct scene *scene, const struct tl_options *options,
                                     struct model **model, struct messages *messages);

/* Rows of weights, shared by the points (or sites) that have the same: rows.c. The numbers
 * of neighbour start[of[i]] + n of point i stand shift[that] after those of i. */
struct tl_rows {
    size_t points, width, rows;
    ptrdiff_t dimension;
    uint32_t *of;                      /* [points] row of each */
    size_t *start;                     /* [rows + 1] */
    int32_t *shift;                    /* dimension * (number of the neighbour less that of the point) */
    double *weight;                    /* [width] numbers an entry */
    uint32_t *example;                 /* [rows] a point of each */
    size_t open, entry_room, row_room; /* while they are made */
};

static inline size_t tl_first(const struct tl_rows *rows, size_t i)
{
    return rows->start[rows->of[i]];
}

static inline size_t tl_last(const struct tl_rows *rows, size_t i)
{
    return rows->start[rows->of[i] + 1];
}

static inline size_t tl_neighbour(const struct tl_rows *rows, size_t i, size_t k)
{
    return (size_t)((ptrdiff_t)i + rows->shift[k] / rows->dimension);
}

/* Points (of a kind of row: sites) in sequence that one kernel does at a time. In a run all have the same
 * row: runs.c. */
struct tl_block {
    uint32_t first;
    uint32_t origin; /* the first point of the run's block where it is whole: pairs have its distances */
    uint16_t count;
    bool run;
};

struct tl_blocks {
    size_t count;
    struct tl_block *block;
};

/* A ghost repeats a point mirrored in one or more faces: u = sign * u_source + prescribed motion. */
struct tl_ghost {
    size_t source;
    double sign[3];          /* of the displacement */
    double mirror[3];        /* of the position: d u_a / d X_b changes its sign by sign[a] * mirror[b] */
    bool curved;             /* mirrored in the hole: no isometry, takes no part in hourglass control */
    double motion[3][FACES]; /* displacement = sum over faces of motion * amplitude of the face's history */
    double volume;
};

/* Entries of a load: force on points per unit of its history. */
struct tl_load {
    size_t count;
    size_t *point;
    double *force; /* [dimension * count], amplitude included */
};

/* Dampers pull at a point, and at `layers` of them, `step` apart, with the weights. */
enum { TL_LAYERS = 16 };
struct tl_damper {
    size_t point, layers;
    ptrdiff_t step;
    const double *weight;
    double impedance[3]; /* of the components, times the area */
};
static inline size_t tl_layer(const struct tl_damper *damper, size_t layer)
{
    return (size_t)((ptrdiff_t)damper->point + (ptrdiff_t)layer * damper->step);
}
struct tl_dampers {
    size_t count;
    struct tl_damper *damper;
    size_t layers[FACES]; /* of a lattice behind each face with dampers */
    double weight[FACES][TL_LAYERS];
};

/* What goes to another rank and what comes from it. */
struct tl_halo {
    struct tl_set give, get;
};

/* The points of a rank (divide.c, share.c); alone, all. Where memory is shared (planes.c) the cloud is a part of the
 * body, and numbers of points are those of the part, but for those of `bound`, `owned` and `window`. */
struct tl_part {
    struct ranks *ranks;   /* NULL: alone */
    struct tl_set own;     /* own points, in pieces for threads */
    size_t plane;          /* points of a plane of a lattice over its last axis, else 1 */
    int axis;              /* over which planes or, of points of a file, layers stand, ... */
    size_t planes, *start; /* ... and the first point of each, [planes + 1], where memory is shared, ... */
    size_t *dealt, *bound; /* ... and the first plane and point of each rank, [ranks + 1] */
    struct tl_set *owned, *window; /* [ranks]: own points and those of the window of each rank */
    struct tl_halo *halo;          /* [ranks] */
    struct ranks_piece *piece;     /* [ranks], of an exchange */
    double *packed;                /* what it sends and gets */
    bool shared;                   /* memory is */
    struct tl_range gradient, transposed,
        pair;             /* points whose rows are made: of pairs, the viscous ones too */
    size_t layers, reach; /* planes: from a face on that may feel it, and that a row reaches over; 0: the part
                                  begins with the body */
    double spacing;       /* the largest one of all points, if it is not that of each; else 0 */
    double neighbours, ghosts; /* in the gradients of all points, and of all ranks, for describe() */
    struct ranks_outlook outlook;
};

struct tl_model {
    struct model model;
    struct tl_part part;
    struct tl_options options;
    struct cloud *cloud;
    struct scene *own_scene; /* of a shortened model, else NULL */
    double frame[3][3];
    double *deck_position; /* [3 * points] */
    double *site_position; /* [3 * sites], body frame */
    double *place;         /* [dimension * sites] the same */
    size_t sites, ghosts;
    struct tl_ghost *ghost;
    bool moving;               /* some face is prescribed to move */
    bool mirrors[FACES];       /* what is near the face has ghosts behind it */
    struct tl_rows gradient;   /* rows of points over sites: G_ij */
    struct tl_rows transposed; /* rows of sites over points: G_ji, G_ii = minus the sum over j of G_ij */
    size_t sources, *source;   /* points that have ghosts */
    size_t *returned_start;    /* [sources + 1]: their ghosts, numbered from 0, ... */
    uint32_t *returned;        /* ... stand in here */
    /* of the points, the last of the sites; on ranks those that the own points need */
    struct tl_blocks gradient_blocks, stress_blocks, force_blocks;
    struct tl_blocks all_gradients; /* of points that every rank has; else empty */
    struct tl_rows pair;            /* hourglass: rows of points over points, weight = stiffness, width 1 */
    struct tl_rows viscous;         /* rows of points over sites, m_i m_j |W'| and h_ij, width 2 */
    double *mass;                   /* [points] */
    double *spacing;                /* [points] of the points around each */
    size_t held_count, *held;       /* numbers of u that rest (cloud method) */
    struct tl_dampers dampers;
    const struct material **material; /* [points] */
    struct elastic *elastic;          /* [points] */
    struct tl_load *load;             /* [scene->loads] */
    struct neighbours near;           /* of the points, for probes */
    uint32_t *found;                  /* [points] for tl_probe */
    double *numbers;                  /* what site_u, H, A, force and extra stand in */
    double *site_u, *site_v;          /* [dimension * sites]; site_v NULL without viscosity */
    size_t plane;                     /* at least dimension * sites */
    double *H;     /* [dimension * plane]: H_ab of site s at b * plane + dimension * s + a */
    double *A;     /* the same, of the points: V P (and the hourglass part) */
    double *force; /* [dimension * sites] */
    double *extra; /* [dimension * points] hourglass forces */
    bool linear;   /* linearise() is on */
    double displacement[FACES], velocity[FACES], acceleration[FACES]; /* amplitudes of the last drive */
};

/* ghosts.c: sites beyond and on the faces. */
selas_status tl_make_ghosts(struct tl_model *tl, double radius, struct messages *messages);
/* planes.c: the points of the body, or a rank's part of them. SELAS_STOPPED: this rank has no work. */
selas_status tl_make_points(struct tl_model *tl, struct messages *messages);
/* Planes from .. end - 1 of the body, no rank's own, with no rows; free with tl_free(), whatever the status. */
selas_status tl_make_beside(const struct tl_model *tl, size_t from, size_t end, struct tl_model **beside,
                            struct messages *messages);
/* The first planes of the body, of which the rows of those in its midst are taken. */
selas_status tl_make_below(const struct tl_model *tl, struct tl_model **below, struct messages *messages);
/* Together where memory is shared; else nothing to do. */
selas_status tl_agree(const struct tl_model *tl, selas_status status, struct messages *messages);
/* Together where memory is shared: the sum with which add() goes on from 0, over the own points of rank after rank. */
double tl_sum_in_order(struct tl_model *tl,
                       void (*add)(struct tl_model *tl, const void *context, double *sum),
                       const void *context);
/* Own points for such sums: all, where memory is not shared. */
struct tl_range tl_summed(const struct tl_model *tl);
double tl_plane_step(const struct tl_model *tl); /* from plane to plane */
/* Planes, each side of one, with points within a radius of a place in it. */
size_t tl_planes_within(const struct tl_model *tl, double radius);
/* The rank that a place of the body's frame belongs to, where memory is shared. */
int tl_owner(const struct tl_model *tl, const double place[3]);
/* It is this one, or memory is not shared. */
bool tl_owns(const struct tl_model *tl, const double place[3]);
/* The numbers that belong to each point: mass, material, place; where the points are. */
selas_status tl_fill_points(struct tl_model *tl, struct messages *messages);
void tl_free(struct tl_model *tl); /* NULL is fine */
/* make_rows.c: gradient weights, hourglass pairs, viscosity pairs. Together where memory is shared, whatever the
 * status so far. */
selas_status tl_make_rows(struct tl_model *tl, selas_status status, struct messages *messages);
/* Points before one that may share its row; `sure` of them do, but for ghosts. `inside`: no ghost is near. */
struct tl_like {
    size_t before, sure, point[3];
    bool inside;
};
/* rows.c: rows are made point by point, in sequence, by sharing or by adding entries and
 * closing. False: no memory. */
bool tl_rows_begin(struct tl_rows *rows, int dimension, size_t points, size_t width);
bool tl_rows_add(struct tl_rows *rows, size_t i, size_t j, const double *weight);
/* With x, places of the sites, the row is shared only where neighbours stand in the same directions. */
bool tl_rows_close(struct tl_rows *rows, size_t i, const struct tl_like *like, const double *x, double scale);
bool tl_rows_end(struct tl_rows *rows);
void tl_rows_free(struct tl_rows *rows);
size_t tl_rows_bytes(const struct tl_rows *rows);
double tl_neighbours(const struct tl_model *tl, struct tl_range range); /* in the gradients of these points */
void tl_likes(const struct tl_model *tl, size_t i, size_t layers, struct tl_like *like);
/* Takes the row of a point that is sure to have the same; false if there is none. */
bool tl_rows_share(const struct tl_model *tl, struct tl_rows *rows, size_t i, const struct tl_like *like,
                   bool of_materials);
bool tl_near(double a, double b, double scale); /* the same but for the rounding of positions */
/* runs.c: cuts the points into blocks, after all rows are there. */
selas_status tl_find_runs(struct tl_model *tl, struct messages *messages);
enum { TL_LONGEST_BLOCK = 64 };
/* Keeps of the blocks what has a site that is a needed point (needed[points]) or mirrors one; stress: groups of points
 * that are rounded together stay so. `all` gets what there was, or is NULL. False: no memory. */
bool tl_keep_blocks(const struct tl_model *tl, const bool *needed, bool stress, struct tl_blocks *blocks,
                    struct tl_blocks *all);
double tl_reach(const struct tl_options *options);  /* of the weights, in spacings */
double tl_radius(const struct tl_model *tl);        /* the same in length */
double tl_search_radius(const struct tl_model *tl); /* the largest a point's weights may take */
/* Neighbours that a quadratic fit should have: those of a point inside a lattice; linear ones take what there
 * is. */
size_t tl_wanted(const struct tl_model *tl);
/* central.c: gradient = 'central'. Weights of a point over sites, of those near it, into
 * index and gradient (3 numbers a site, at most 12 sites), 0 if it has no neighbour along an axis; weights of
 * a value at a place of the body over at most 64 points. */
size_t tl_central_row(const struct tl_model *tl, const uint32_t *near, size_t count, size_t i,
                      uint32_t *index, double *gradient);
size_t tl_lattice_probe(const struct tl_model *tl, const double place[3], bool ghosts, size_t *index,
                        double *weight, double *gradient);
/* A place of the body's frame on a symmetry plane or roller across the axis. */
bool tl_on_mirror(const struct tl_model *tl, const double place[3], int axis);
/* tractions.c. Fails if no element of the surface lies on a face. */
selas_status tl_need_surface(const struct tl_model *tl, enum face face, struct messages *messages);
/* Forces of the uniform stress -direction x normal, into tl->force. */
void tl_uniform_stress(struct tl_model *tl, const double direction[3], enum face face);
/* Adds the forces of a load on a face of the box. */
selas_status tl_traction_on_box(struct tl_model *tl, const struct load *load, const double centre[3],
                                const double direction[3], double *forces, struct messages *messages);
/* loads.c, probes.c */
enum { TL_PROBE_ROOM = 512 };
selas_status tl_make_loads(struct tl_model *tl, struct messages *messages);
/* dampers.c */
selas_status tl_make_dampers(struct tl_model *tl, struct messages *messages);
selas_status tl_keep_dampers(struct tl_model *tl, struct messages *messages); /* those of own points */
/* Adds their forces to tl->force, which has all others. Velocities v (NULL: 0) go on for half a step. */
void tl_damp(struct tl_model *tl, double half_step, const double *v);
double tl_damped(const struct tl_model *tl, const double *v); /* the power that they take */
/* How far from a place the points are at most that tl_probe() takes. */
double tl_probe_radius(const struct tl_model *tl);
selas_status tl_probe(struct tl_model *tl, const double body_position[3], size_t *count, size_t *index,
                      double *weight, double *gradient, struct messages *messages);
/* A value at a place: from points, and beside faces with ghosts from sites, too, which hold what faces prescribe. */
struct tl_value {
    size_t count, sites; /* entries from points, and those from sites behind them (0 elsewhere) */
    size_t heaviest;     /* the point that weighs most */
    size_t index[2 * TL_PROBE_ROOM], source[2 * TL_PROBE_ROOM];
    double weight[2 * TL_PROBE_ROOM], gradient[3 * TL_PROBE_ROOM]; /* the gradient of the points' value */
};
selas_status tl_value_at(struct tl_model *tl, const double place[3], struct tl_value *value,
                         struct messages *messages);
/* energy.c: adds what the loads of a drive pull at the points to tl->force; entries of the
 * model's class. */
void tl_add_loads(struct tl_model *tl, const struct drive *drive);
void tl_weigh(struct model *model, const double *v, double *product);
void tl_energy(struct model *model, const double *y, struct energy *energy);
void tl_power(struct model *model, const struct drive *drive, const double *y, double *load,
              double *absorbed);
/* shorter.c: entry of the model's class. */
selas_status tl_shorten(const struct model *model, struct model **shorter, double *deficit,
                        struct messages *messages);
/* observe.c: entries of the model's class. */
selas_status tl_model_probe(struct model *model, const double position[3], struct probe *probe,
                            struct messages *messages);
void tl_observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                const double *a, double *value);
void tl_field(struct model *model, selas_field field, const double *y, const double *a, size_t from,
              size_t end, double *value);
/* divide.c: tl->part.owned and own. Together; false: no memory. */
bool tl_divide(struct tl_model *tl);
/* share.c: together, after all else of the set-up: finds the windows and keeps the blocks that the own points need. */
selas_status tl_share_points(struct tl_model *tl, struct messages *messages);
void tl_part_free(struct tl_part *part);
void tl_exchange(const struct tl_model *tl,
                 double *a); /* together: a like u of own points to the windows they are in */
void tl_keep_window(const struct tl_model *tl, double *u); /* 0 outside */
/* The rank that reads a value from `count` points about a place: the owner of the place, where memory is shared, else
 * the first whose window has the points. SELAS_UNSUPPORTED if no window has. */
selas_status tl_find_holder(const struct tl_model *tl, size_t count, const size_t *index, int *holder,
                            struct messages *messages);
/* Entries of the model's class, on ranks. */
int tl_holder(const struct model *model, size_t point);
void tl_share(struct model *model, enum model_array array, struct spread *shares);
void tl_complete(struct model *model, double *u);
void tl_unseen(struct model *model, const double *y, struct unseen *found);
void tl_describe_part(const struct tl_model *tl,
                      void (*tell)(void *context, const char *key, const char *value), void *context);
/* Up to so many points one thread is as fast as several (the cost of a parallel region is that of about a
 * hundred points, much more on a busy machine). */
enum { TL_SERIAL = 3000 };
/* force.c: internal forces of displacements u into tl->force (points), H and A on the way.
 */
void tl_sites(struct tl_model *tl, const double *u, const double *v, const double *displacement,
              const double *velocity);
/* What ghosts have in the drive's motion, for those who read them between evaluations. */
void tl_keep_amplitudes(struct tl_model *tl, const struct drive *drive);
/* Component c of ghost g from a field of the points and its amplitudes. */
double tl_ghost_value(const struct tl_model *tl, const double *field, size_t g, size_t c,
                      const double *amplitude);
void tl_gradients(struct tl_model *tl);
void tl_all_gradients(struct tl_model *tl); /* of all points here, on ranks too */
void tl_stresses(struct tl_model *tl);
void tl_divergence(struct tl_model *tl); /* of A, with the hourglass forces */
void tl_forces(struct tl_model *tl);     /* the last two */
/* H of site i from tl->H, row-major. */
static inline void tl_tensor(const struct tl_model *tl, size_t i, double H[9])
{
    const size_t d = (size_t)tl->cloud->dimension;
    for (size_t a = 0; a < d; a++)
        for (size_t b = 0; b < d; b++)
            H[d * a + b] = tl->H[b * tl->plane + d * i + a];
}
/* The point that a site is or mirrors. */
static inline size_t tl_source(const struct tl_model *tl, size_t site)
{
    return site < tl->cloud->points ? site : tl->ghost[site - tl->cloud->points].source;
}
/* Points across a gap of a file are no neighbours, though they lie within the reach of gradients, four spacings
 * at faces: may there be gaps? points_connected() of the sites. */
bool tl_has_gaps(const struct tl_model *tl);
size_t tl_connected(const struct tl_model *tl, size_t first, size_t count, uint32_t *site);
/* Adds to tl->force of the ghosts what the hourglass pairs of own points pull at them. */
void tl_ghost_hourglass(struct tl_model *tl);
/* H of one point for displacements u (ghosts by the amplitudes of the last drive). */
void tl_gradient_at(const struct tl_model *tl, const double *u, size_t i, double H[9]);
void tl_viscosity(struct tl_model *tl);
double tl_strain_energy(struct tl_model *tl);

#endif
