/* Updated-Lagrangian SPH of He & Seaid (2016), section 2: what its files share.
 *
 * State y = [u | v | density | stress]: u and v with `dimension` numbers a particle, one density, and the
 * stress components in the plane (1D: xx; 2D: xx yy xy; 3D: xx yy zz xy yz zx). Everything is in the body's
 * own frame. Particles are followed by ghosts in all geometric arrays; ghosts have no state of their own.
 *
 * On ranks (doc/developers/ranks.md) a rank owns a range of the body's particles. The state has these, and others
 * beside them that receivers look at. The geometric arrays have the own particles, and those of others that they may
 * meet, in the order of the body. */
#ifndef SELAS_METHOD_UPDATED_LAGRANGIAN_UPDATED_LAGRANGIAN_H
#define SELAS_METHOD_UPDATED_LAGRANGIAN_UPDATED_LAGRANGIAN_H

#include "base/processor.h"
#include "kernel/kernel.h"
#include "model/model.h"
#include "parallel/few_ranks.h"
#include "points/cloud.h"
#include "points/neighbours.h"

#include <stdint.h>

/* Switches of the method; each costs nothing when off. */
struct updated_options {
    const struct kernel *kernel;
    double smoothing_length;  /* in spacings; the paper: 1.5 */
    double alpha, beta;       /* of Monaghan's viscosity, Eq 17; both 0: off */
    double artificial_stress; /* epsilon of Eq 22; 0: off */
    bool correction;          /* kernel gradient correction L */
    bool jaumann;             /* rotation of the stress, Eqs 8 and 9 */
    bool adjoint;             /* stresses act by the adjoint of grad v, not by Eq 19 */
    double hourglass;         /* xi of hourglass.c; 0: off, as published */
};

/* A ghost mirrors a particle at one to six faces, in this order: of a thin body at two across an axis. */
struct updated_ghost {
    uint32_t source;
    unsigned char count, face[6];
    uint64_t loads; /* bit k: load k presses on its face at this place */
};

/* What a face does to its ghosts. */
enum updated_wall { WALL_NONE, WALL_STICK, WALL_SLIP, WALL_TRACTION };
enum updated_motion { WALL_PLACE, WALL_SPEED, WALL_ACCELERATION, WALL_MOTIONS };

/* Components of a packed particle: place, velocity, volume, span (the volume, or 0 for ghosts that carry a
 * traction but do not deform with the body), mass, density, smoothing length over the usual one, stress /
 * density^2, artificial stress. */
struct updated_layout {
    size_t velocity, volume, span, mass, density, length, tension, repulsion, size;
};

struct updated_hourglass;

/* Own particles that another rank gets, by their number among the own ones, and its particles that are here. */
struct updated_partner {
    uint32_t *give;
    size_t gives, room, gets, at; /* at: the first one's number here */
};

/* The share of a rank (share.c, window.c). */
struct updated_part {
    struct ranks *ranks; /* borrowed; NULL: alone */
    bool planes;         /* the cloud has but some planes of the body */
    size_t *bound;       /* [ranks + 1] first own particle of each rank, in the body */
    size_t *held;        /* [2 * ranks] first particle in the state of each rank, and the one behind */
    double *length;      /* [cloud->points] smoothing length over the usual one */
    struct updated_partner *with; /* [ranks] */
    struct ranks_piece *piece;
    double *box; /* [6 * ranks] where each one's particles are */
    double *sent,
        *arrived; /* what is sent to others; their particles, ascending: a state each, u v density stress */
    bool lost;    /* no memory for what moves: nothing goes on */
    struct ranks_outlook outlook;
};

#define UPDATED_SKIN .15  /* spacings that lists reach further than the kernel */
enum { UPDATED_END = 8 }; /* empty places at both ends of the planes */

struct updated {
    struct model model; /* first: the public face */
    struct updated_options options;
    int dimension;
    int stresses;   /* components of the stress */
    bool repulsive; /* artificial stress is on; off while the spectrum is measured */
    double alpha, beta;
    bool pressed;             /* some face has ghosts that carry a traction */
    bool velocities_displace; /* while waves are measured v stands for u: hourglass control takes it, dampers
                                 rest */
    struct updated_hourglass *hourglass; /* NULL without hourglass control */
    bool both_sides; /* viscosity between receding pairs too: while the spectrum is measured */
    struct cloud *cloud;
    size_t points;            /* particles here */
    size_t from, own;         /* the first own one of them, and how many */
    size_t made;              /* the same one's number in the cloud */
    size_t first, held, lead; /* in the state: the body's number of the first, how many, the first own one */
    double pairs, images;     /* in the lists of all particles of the body; their ghosts */
    const struct material *material;
    double sound_speed, smoothing_length, reach;
    double repulsion_scale; /* 1 over the kernel's shape at one spacing */
    double slope_scale;     /* W'/r over w'(q)/q */
    bool cubic;             /* the kernel is the cubic spline */
    double *mass;
    double *length; /* smoothing length of a particle over the usual one */
    bool even;      /* all of them are 1 */
    double longest; /* the largest of them */
    size_t ghosts;
    struct updated_ghost *ghost;
    enum updated_wall wall[FACES];
    double direction[FACES][3]; /* of prescribed motions, body frame */
    /* times amplitude, when rates were last asked for: */
    double amplitude[WALL_MOTIONS][FACES];
    double *load_direction; /* [3 * loads] times amplitude, body frame */
    double *reference;      /* [3 * (points + ghosts)] */
    double *searched;       /* the same at the last search for neighbours */
    double skin;            /* lists reach this much further than the kernel */
    bool ordered;           /* particles are summed eight at a time: chosen from the reference places */
    double *record;         /* [layout.size * (points + ghosts)] particle by particle; NULL where ordered */
    size_t stride;          /* of the planes */
    double *planes; /* [layout.size * stride] component by component, UPDATED_END empty places at both ends */
    uint32_t *shifts;          /* [own / 8] number of distances in memory of each eight particles ... */
    int32_t *shift;            /* ... which stand from neighbours.start of the first of them on */
    size_t shift_room, merged; /* pairs that were merged into them */
    double *deck_position;     /* model.position; NULL: made in planes */
    struct updated_layout layout;
    struct neighbours neighbours;
    struct updated_part part;
    bool search_failed; /* no memory: rates become NaN, which the run notices */
};

/* A packed particle: its component c stands at c times updated_step(). */
static inline double *updated_packed(const struct updated *updated, size_t place)
{
    return updated->ordered ? updated->planes + UPDATED_END + place
                            : updated->record + updated->layout.size * place;
}

static inline size_t updated_step(const struct updated *updated)
{
    return updated->ordered ? updated->stride : 1;
}

/* Row in the state, and volume, of an own particle. */
static inline size_t updated_row(const struct updated *updated, size_t i)
{
    return i - updated->from + updated->lead;
}

static inline double updated_volume(const struct updated *updated, size_t i)
{
    return updated->cloud->volume[i - updated->from + updated->made];
}

static inline bool updated_owns(const struct updated *updated, size_t i)
{
    return i - updated->from < updated->own;
}

enum { UPDATED_PARALLEL = 1000 }; /* fewer particles run on one thread */

static inline struct updated *updated_of(struct model *model)
{
    return (struct updated *)model;
}

/* Index of the stress component (a, b). */
static const int updated_component[4][3][3] = {
    {{0}}, {{0}}, {{0, 2, 0}, {2, 1, 0}, {0}}, {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};

extern const struct method method_updated_lagrangian;

/* The switches as published: cubic spline, h = 1.5 spacings, alpha = beta = 2.5, epsilon = .3, all
 * corrections. */
struct updated_options updated_lagrangian_published(void);

/* Takes the cloud, all points of the body; on failure it is freed too. NULL: as the scene says, on ranks a part. */
selas_status updated_lagrangian_new(const struct scene *scene, const struct updated_options *options,
                                    struct cloud *cloud, struct model **model, struct messages *messages);

/* ghosts.c */
selas_status updated_ghosts_create(struct updated *updated, struct messages *messages);
/* Fills the packed particles, ghosts included, from a state. */
void updated_fill(struct updated *updated, const struct drive *drive, const double *y);
/* Power of the tractions and moving walls at all faces; transmitting faces in *absorbed. */
double updated_power_of_faces(const struct updated *updated, const struct drive *drive, const double *y,
                              double *absorbed);

/* artificial_stress.c: R of Eqs 20-23 in any dimension from s / rho^2: minus epsilon times its
 * positive (tensile) part. UPDATED_TENSORS tensors in sequence; their components stand `stride` apart. */
enum { UPDATED_TENSORS = 16 };
struct updated_stresses {
    void (*artificial)(int dimension, double epsilon, size_t stride, const double *tension,
                       double *repulsion);
};
EACH_PROCESSOR(struct updated_stresses, updated_stresses)

/* block_rates.c, by dimension less one: rates of the own particles first ... last - 1, at most UPDATED_BLOCK;
 * first is a multiple of GROUP beyond the first own one. */
enum { UPDATED_BLOCK = 32 };
struct updated_rates {
    void (*of[3])(const struct updated *updated, size_t first, size_t last, const double *y, double *dydt);
};
EACH_PROCESSOR(struct updated_rates, updated_rates)

/* order.c: the lists of eight particles at a time, after each search ... */
selas_status updated_merge_lists(struct updated *updated, struct messages *messages);
/* ... and whether that pays in the body at rest, whose groups of eight begin with its first particle. Ranks: together.
 * Takes the memory for it. */
selas_status updated_choose_order(struct updated *updated, struct messages *messages);
/* Memory for packed particles, as many as are here. */
selas_status updated_take_packed(struct updated *updated, struct messages *messages);
/* Has particles summed one by one from now on. */
selas_status updated_one_by_one(struct updated *updated, struct messages *messages);

/* rate.c: inverse of L; the identity where the neighbours do not span the space. */
void updated_invert(int dimension, const double matrix[6], double inverse[3][3]);
/* dy/dt. */
void updated_rate(struct model *model, const struct drive *drive, const double *y, double *dydt);
/* hourglass.c: memory for it; for as many particles and pairs as are here ... */
selas_status updated_hourglass_new(struct updated *updated, struct messages *messages);
bool updated_hourglass_room(const struct updated *updated);
bool updated_hourglass_weights(const struct updated *updated);
void updated_hourglass_free(struct updated_hourglass *all);
size_t updated_hourglass_bytes(const struct updated *updated);
/* ... and what it adds to the acceleration; after updated_fill(). Ranks: together. */
void updated_add_hourglass(struct updated *updated, const double *y, double *acceleration);

/* share.c. Together: makes the points of this rank, all of them alone. SELAS_STOPPED: this rank has none. */
selas_status updated_make_points(struct updated *updated, struct messages *messages);
/* Together, at rest: which particles are in the state of each rank. */
void updated_share(struct updated *updated);
void updated_part_free(struct updated_part *part);
/* The rank that owns a particle, by its number in the body; and that which sees a place (body frame). */
int updated_holder(const struct model *model, size_t point);
int updated_owner(const struct updated *updated, const double place[3]);
void updated_spread(struct model *model, enum model_array array, struct spread *shares);
/* Together: those in the state that are not own ones get their rates. */
void updated_exchange(const struct updated *updated, double *dydt);
/* Together: counts neighbours in all lists; Eq (R9b). */
void updated_look_ahead(struct updated *updated);
void updated_describe_part(const struct updated *updated,
                           void (*tell)(void *context, const char *key, const char *value), void *context);
/* Together: whether all have; and the first failure. */
bool updated_all_have(const struct updated *updated, bool mine);
selas_status updated_agree(const struct updated *updated, selas_status status, struct messages *messages);

/* window.c. Together: brings others' particles here from the state, or from an array of `width` numbers a particle. */
void updated_gather(const struct updated *updated, const double *y);
void updated_bring(const struct updated *updated, size_t width, double *array);
/* Together: finds those that own particles may meet until the next search, from `searched`. False: no memory. */
bool updated_meet(struct updated *updated);
/* Neighbours of own particles, from `searched`. */
selas_status updated_find_neighbours(struct updated *updated, struct messages *messages);
/* Does a place need a new search for neighbours? Together. */
bool updated_search_is_due(const struct updated *updated);
size_t updated_window_bytes(const struct updated *updated);

/* spectrum.c; the model's bytes and those that it takes, with the run's state */
size_t updated_spectrum_bytes(const struct updated *updated);
selas_status updated_spectrum(struct model *model, struct spectrum *spectrum, struct messages *messages);
double updated_mean_power(const struct updated *updated, double order);
/* What a uniform stress does to scattered particles: points/disorder.h. */
selas_status updated_disorder(struct updated *updated, double *disorder, struct messages *messages);

/* probes.c */
/* Range of the body's particles that a probe takes values from; at rest. */
selas_status updated_reads(const struct updated *updated, const double position[3], size_t *from, size_t *end,
                           struct messages *messages);
selas_status updated_probe(struct model *model, const double position[3], struct probe *probe,
                           struct messages *messages);
/* fields.c */
void updated_unseen(struct model *model, const double *y, struct unseen *found);
void updated_initialise(struct model *model, double *y);
void updated_observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                     const double *a, double *value);
void updated_field(struct model *model, selas_field field, const double *y, const double *a, size_t from,
                   size_t end, double *value);
void updated_energy(struct model *model, const double *y, struct energy *energy);
void updated_power(struct model *model, const struct drive *drive, const double *y, double *load,
                   double *absorbed);
void updated_describe(const struct model *model,
                      void (*tell)(void *context, const char *key, const char *value), void *context);

/* gaps.c: warns of gaps of a file that kernels reach across at rest. Ranks: together. */
selas_status updated_warn_of_gaps(const struct updated *updated, struct messages *messages);

#endif
