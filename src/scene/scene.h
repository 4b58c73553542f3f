/* The scene: what the user said, checked and complete, nothing numerical in it.
 *
 * Vectors have three components whatever the dimension (unused ones are 0). Positions, directions and
 * receivers are in the deck's coordinates; `low`, `high` and the face names belong to the body's own frame,
 * which `rotation` turns about the centre of the box. */
#ifndef SELAS_SCENE_H
#define SELAS_SCENE_H

#include "base/messages.h"
#include "deck/deck.h"
#include "scene/boundary.h"

enum { NAME_SIZE = 64, FACES = 7, BOX_FACES = 6, ACCURACY_TEXT = 480 };

enum face { FACE_NAMES(CHOICE_SYMBOL) };

enum plane { PLANES(CHOICE_SYMBOL) };

struct material {
    char name[NAME_SIZE];
    double density;
    double q_p, q_s;    /* quality of P and S waves; 0: undamped */
    double q_frequency; /* where the moduli and qualities are meant [cycles/time]; 0: at the centroid of the
                           source's spectrum (damping/ground.h) */
    double q_power;     /* qualities grow as this power of the frequency */
    double lambda, mu;  /* of the solid in three dimensions */
    double young, poisson;
    double plane_lambda; /* lambda that enters the equations: in plane stress 2 lambda mu / (lambda + 2 mu),
                            in 1D stress such that plane_lambda + 2 mu = E; otherwise lambda */
    double p_speed, s_speed; /* with plane_lambda: the fastest waves of the scene's own dimension */
};

enum body_shape { BODY_SHAPES(CHOICE_SYMBOL) };
enum block_shape { BLOCK_SHAPES(CHOICE_SYMBOL) };
enum arrangement { ARRANGEMENTS(CHOICE_SYMBOL) };

struct layer {
    size_t material; /* index into scene->materials */
    double top;      /* depth (distance from the z- face) of its upper face; tilted: where x = y = 0 ... */
    double slope[2]; /* ... and what it gains along x and y of the body's frame; 0, 0: level */
    struct height_map *map; /* of a file: how far it lies above `top`, its mean; NULL: none */
    bool graded; /* speeds and density go over to those of `bottom` at the next layer's upper face */
    size_t bottom;
};

/* A part of the ground of another material, in the body's frame. */
struct ground_block {
    enum block_shape shape;
    size_t material;
    double centre[3], half[3]; /* half edges or axes */
};

/* Density, speeds of P and S waves, and where they are damped Q_p and Q_s (0: not damped there), between places along
 * the axes of a model's file, z fastest; a surface has the first alone, and one place along z. A part of damped ground
 * has its shares of the bulk and shear modulus in the place of Q (method/damped/field.c). */
enum { MODEL_VALUES = 3, MODEL_SETS = 5 };
struct model_pieces; /* model_pieces.h */
struct model_grid {
    size_t n[3];
    double *at[3]; /* [n] rising */
    double *value[MODEL_SETS];
    struct model_pieces *pieces; /* of a grid that is not kept whole, in the place of values; NULL */
};

/* How the third coordinate of a place in a grid, downward, comes from the depth below the body's z- face and the
 * model's surfaces, depths below the sea (model_grid.c). */
enum model_depth {
    MODEL_LEVEL,    /* depth + shift */
    MODEL_BELOW,    /* depth below the sea; surface 0: the ground */
    MODEL_BETWEEN,  /* grid i between surfaces i and i + 1, in parts; surface 0: the ground */
    MODEL_STRETCHED /* between surface 0, the top, and the bottom; last surface: the ground */
};

/* The ground from a file: the part that the body needs (model_file.c). */
struct ground_model {
    double low[3], high[3];       /* the body's: beyond it the ground is that of its nearest face */
    double origin[2], turn[2][2]; /* place along the model's axes = origin + turn (x, y) */
    enum model_depth depth;
    bool sea;                         /* depth + shift is one below the sea, not below the model's ground */
    double shift, bottom;             /* bottom: of MODEL_STRETCHED, below the sea */
    double detail[2];                 /* least distance of values along x and y of the body */
    bool damped;                      /* by the file's Q */
    double q_frequency, q_power;      /* of all of it, as a material's */
    double loss[2];                   /* least (above 0) and largest 1/Q */
    size_t undamped;                  /* values without Q */
    const struct ground_model *given; /* of a part of damped ground: the one in the file */
    size_t grids, surfaces;
    struct model_grid *grid, *surface; /* from the top down */
    char text[400];                    /* for the plan */
};

struct topography;  /* topography.h */
struct grading;     /* grading.h */
struct ground_line; /* ground_line.h */

struct body {
    char name[NAME_SIZE];
    enum body_shape shape;
    enum arrangement arrangement;
    size_t material;
    double low[3], high[3];
    double spacing;
    double hole_centre[3], hole_radius;
    double rotation[3]; /* degrees about x, then y, then z (fixed axes) */
    double frame[3][3]; /* deck direction = frame * body direction (rotation matrix R = Rz Ry Rx) */
    double pivot[3];    /* centre of the box: position = pivot + frame * (body position - pivot) */
    bool rotated;
    double jitter; /* fraction of the spacing */
    long seed;
    char *file;                       /* points from a file: path, already resolved; NULL */
    const struct given_points *given; /* points from the host: borrowed; NULL */
    size_t layers;
    struct layer *layer;
    struct topography *topography;  /* the surface, where it is not level; NULL: it is */
    double most_stretch;            /* largest spacing over depth in that of the surface */
    struct grading *grading;        /* by that and the ground; NULL: even */
    struct ground_model *model;     /* in the place of material and layers; NULL: none */
    const struct ground_line *line; /* borrowed: in the place of all of these; NULL: none */
    size_t blocks;
    struct ground_block *block; /* later ones lie in earlier ones */
    bool chosen;    /* half-space: low and high were chosen by the program (scene/fitted_box.c) ... */
    bool absorbing; /* ... with absorbing layers at its sides and bottom where no &boundary names them ... */
    bool plane;     /* ... or with rollers at its sides: all moves along the depth alone ... */
    bool dampers;   /* ... and dampers at its bottom send hardly anything back of that ... */
    double waves_low[3], waves_high[3]; /* ... as far as what is seen of waves comes from ... */
    char choice[200];                   /* ... which box and why, for the plan */
    char accuracy
        [ACCURACY_TEXT]; /* what scene%accuracy chose, for the plan; "" if the deck gives the spacing */
};

enum load_kind { LOAD_KINDS(CHOICE_SYMBOL) };
enum load_shape { LOAD_SHAPES(CHOICE_SYMBOL) };

struct load {
    char name[NAME_SIZE]; /* "" if it has none */
    enum load_kind kind;
    enum load_shape shape;
    enum face face;
    double centre[3];
    double size[3]; /* square: edge lengths along the face's two axes, in the order of the axes; disc: [0] =
                       diameter */
    double direction[3]; /* unit vector */
    double amplitude;    /* traction (force per area; force if POINT); body force: per volume, over the body
                            (FACE shape), or a force at `centre` (POINT); moment tensor: scale of `moment` */
    double moment[6];    /* xx yy zz xy yz zx */
    double velocity[3];  /* of a moving patch; 0 = at rest */
    struct history history;
    enum driven driven;
    size_t group; /* occurrence of &load */
};

struct receiver {
    char name[NAME_SIZE];
    double position[3];
};

struct profile {
    char name[NAME_SIZE];
    double from[3], to[3];
    size_t points;
    size_t times;
    double *time;
    unsigned fields; /* bit 1 << selas_field */
};

/* Point i of a profile, deck coordinates. */
static inline void profile_position(const struct profile *profile, size_t i, double position[3])
{
    const double s = profile->points > 1 ? (double)i / (double)(profile->points - 1) : 0.0;
    for (int axis = 0; axis < 3; axis++)
        position[axis] = (1.0 - s) * profile->from[axis] + s * profile->to[axis];
}

struct snapshot {
    double every; /* 0: use `time` */
    size_t times;
    double *time;
    unsigned fields;
    double region_low[3], region_high[3]; /* points outside are left out; whole body by default */
    bool whole;                           /* no region was given */
};

enum initial_kind { INITIAL_KINDS(CHOICE_SYMBOL) };

struct initial {
    enum initial_kind kind;
    double velocity[3];
    double amplitude;
    bool shear;             /* plane wave: S instead of P */
    double direction[3];    /* plane wave: of propagation; gaussian: of displacement; unit */
    double polarisation[3]; /* plane wave, S: unit and across direction */
    double wavelength;
    double centre[3], width;
};

/* Where the points of a method lie: on the faces of a box, whose spacing must divide every edge; there too, or
 * scattered; in the middles of cells that fit edge by edge. */
enum point_places { POINTS_ON_FACES, POINTS_SCATTERED, POINTS_IN_CELLS };

struct method_choice {
    char name[NAME_SIZE], variant[NAME_SIZE]; /* as in deck/choices.h */
    enum point_places points;
    const struct deck_group *group; /* further options: each method reads its own with deck_*() */
    int degree, sweeps; /* of the consistent method, chosen by scene%accuracy; degree 0: by group */
    size_t mechanisms;  /* relaxation mechanisms of damped materials */
};

struct stepping_choice {
    char scheme[NAME_SIZE];
    double time_step, courant, safety; /* the one that was given is > 0, the others 0 (safety: default) */
    long stages, max_stages;           /* 0: chosen */
    bool paper_rule;                   /* rkc: stages by Eq 28 of He & Seaid, from the step alone */
    bool unwarp, unwarp_given, force;
};

enum { UNIT_SIZE = 16 };
struct output_choice {
    char *directory; /* resolved: output/DECKNAME or as given */
    bool plots;
    char length_unit[UNIT_SIZE], time_unit[UNIT_SIZE]; /* their names, "" if the deck has none */
    double history_step;                               /* 0: every step */
    double low_pass;           /* angular frequency of the zero-phase low-pass, 0: none */
    bool balance;              /* what damped materials take is measured */
    long checkpoint_every;     /* steps between checkpoints; 0: none */
    double checkpoint_minutes; /* the same by the clock */
};

struct reference {
    char kind[NAME_SIZE]; /* "" if none */
    char *file;
    double tolerance; /* wanted relative error; 0: the solution's own default */
    bool scheme;      /* damping by relaxation mechanisms in place of constant Q */
    bool stress;      /* histories of stress are wanted too */
    const struct deck_group *group;
};

struct scene {
    const struct deck *deck; /* borrowed; must outlive the scene */
    char title[256];
    int dimension;
    enum plane plane;
    double end_time;
    size_t materials;
    struct material *material;
    const struct material
        *whole; /* [materials] a part of damped ground (method/damped/damped.h): materials of the
                                     whole, whose moduli those of `material` are a part of; itself: all. NULL: no
                                     part */
    struct body body;
    struct boundary boundary[FACES];
    size_t loads;
    struct load *load; /* the deck's in its order; behind them the pieces of those that a host drives */
    size_t receivers;
    struct receiver *receiver;
    size_t profiles;
    struct profile *profile;
    size_t snapshots;
    struct snapshot *snapshot;
    struct initial initial;
    struct method_choice method;
    struct stepping_choice stepping;
    struct output_choice output;
    struct reference reference;
    double accuracy; /* wanted relative L2 error of the velocities at receivers (scene%accuracy); 0: none */
    struct ranks *ranks; /* that share the work (parallel/ranks.h), borrowed; NULL: one alone */
};

/* What the program chooses in place of the deck (scene%accuracy). */
struct builder;
struct scene_choice {
    double spacing;     /* 0: a first guess */
    double grading;     /* where the deck says none; 0: even */
    const char *large;  /* why the fitted box is the one from which nothing returns; NULL: the cheaper one */
    long layer_points;  /* of absorbing layers at least, where there are any; 0: the default */
    int degree, sweeps; /* of the consistent method; degree 0: as without a choice */
    size_t mechanisms;  /* of damped materials; 0: as without */
    const char *scheme; /* NULL: as without */
    double courant;     /* 0: the default step */
    const char *exact;  /* reference that a deck without one gets; NULL: none */
    char text[ACCURACY_TEXT]; /* for the plan */
    /* Refuses what cannot be served or leaves no choice (complain()); called when all else is built. */
    void (*check)(struct builder *builder);
};

/* Builds the scene of a deck; all errors in one pass. choice NULL: all as the deck says. The deck stays the
 * caller's. On failure *scene is NULL. */
selas_status scene_build(const struct deck *deck, const struct scene_choice *choice, struct scene **scene,
                         struct messages *messages);
void scene_free(struct scene **scene);

/* Position and direction between the deck's coordinates and the body's own frame. */
void body_from_deck(const struct body *body, const double position[3], double body_position[3]);
void body_to_deck(const struct body *body, const double body_position[3], double position[3]);
/* The same below a surface that is not level with the depth as it is, for ground_at() and ground_jumps(). */
void ground_from_deck(const struct body *body, const double position[3], double place[3]);
/* The same for places of the lattice, which is even there: those of the body's own frame but for depths of a graded
 * one. */
void lattice_from_deck(const struct body *body, const double position[3], double place[3]);
void lattice_to_deck(const struct body *body, const double place[3], double position[3]);
void body_direction_from_deck(const struct body *body, const double direction[3], double body_direction[3]);
void body_direction_to_deck(const struct body *body, const double body_direction[3], double direction[3]);

/* Outward unit normal of a box face in the body's frame has only this axis (0, 1, 2) and sign (-1, +1). */
static inline int face_axis(enum face face)
{
    return (int)face / 2;
}
static inline int face_sign(enum face face)
{
    return (int)face % 2 == 0 ? -1 : 1;
}
const char *face_name(enum face face); /* "x-" ... "hole" */
/* Where the plane of a face of the box cuts its axis. */
static inline double face_plane(const struct body *body, enum face face)
{
    return face_sign(face) < 0 ? body->low[face_axis(face)] : body->high[face_axis(face)];
}

/* Cells of a lattice that fills a box, as the spacing has them: near a whole number. */
double body_cells(const struct body *body, int axis);
/* Largest distance of neighbouring points about a place of the body. */
double body_spacing_at(const struct body *body, const double place[3]);

static inline bool body_is_box(const struct body *body)
{
    return body->shape == BODY_BOX || body->shape == BODY_HALF_SPACE;
}
/* Behind the names of axes of the body's own frame, where they are not the deck's. */
static inline const char *own_axes(const struct body *body)
{
    return body->rotated ? " of the body" : "";
}
/* More than one material over the depth. */
static inline bool body_is_layered(const struct body *body)
{
    return body->layers > 1 || (body->layers == 1 && body->layer[0].top > 0);
}
/* Does the patch of a load move along its face? */
static inline bool load_moves(const struct load *load)
{
    return load->velocity[0] != 0 || load->velocity[1] != 0 || load->velocity[2] != 0;
}

/* questions.c. Is a component (0, 1, 2, of the body's frame) at rest or moved on a face? */
bool face_holds(const struct scene *scene, enum face face, int component);
/* CAN_... of all faces together. */
unsigned scene_needs(const struct scene *scene);
/* SELAS_UNSUPPORTED, with the face and its place in the deck, if a face needs more than `who` can do. */
selas_status scene_check_faces(const struct scene *scene, unsigned can, const char *who,
                               struct messages *messages);
/* Is there an exact solution that tells the errors? (Histories of a file may be anybody's.) */
bool scene_has_exact(const struct scene *scene);
bool scene_loads_move(const struct scene *scene); /* any of them */
bool scene_driven(const struct scene *scene);     /* a host drives a load or a face */
/* Loads of the deck; behind them come the pieces of those that a host drives, each within its load. */
size_t scene_deck_loads(const struct scene *scene);
double scene_fastest(const struct scene *scene); /* speed of P waves in the fastest material */
/* The same of their front: where they are damped those of the source's highest frequencies are faster than those at
 * q_frequency (constant Q: by ln(f / q_frequency) / (pi Q) of themselves; doc/theory/damping.md). */
double scene_first(const struct scene *scene);
/* Part of a point source at a place (body's frame) that the body carries: a half for each symmetry plane in
 * which it lies. */
double scene_carries(const struct scene *scene, const double place[3]);

/* materials.c. From density, lambda and mu: Young, Poisson, and what enters the equations of a plane or a thin
 * bar (doc/reference/scene.md, Eqs S4-S10). */
void material_complete(const struct scene *scene, struct material *material);
/* What rounding may make of a place of the last axis: a layer begins where its top lies within it. */
double body_rounding(const struct scene *scene);
/* Material at a depth below the z- face of the body (the body's own material if it has no layers). */
const struct material *scene_material_at(const struct scene *scene, double depth);
/* Material of point `index`: the one a host gave it, else by depth. */
const struct material *scene_point_material(const struct scene *scene, size_t index, double depth);

#endif
