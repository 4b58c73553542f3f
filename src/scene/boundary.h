/* What the faces of a body do. All that a kind of boundary means stands in one line of BOUNDARY_KINDS
 * (deck/choices.h); what must know it asks the functions below, not for the kind. */
#ifndef SELAS_SCENE_BOUNDARY_H
#define SELAS_SCENE_BOUNDARY_H

#include "deck/choices.h"
#include "scene/history.h"

#define BOUNDARY_KIND(symbol, ...) symbol,
enum boundary_kind { BOUNDARY_KINDS(BOUNDARY_KIND) };
#undef BOUNDARY_KIND
enum absorber { ABSORBERS(CHOICE_SYMBOL) };

/* What gives the motion of a face or the amplitude of a load: its history, a function of the host, or the
 * host holds a load at a value until it changes it. With a host the history is empty. */
enum driven { BY_HISTORY, BY_HOST, HELD_BY_HOST };

struct boundary {
    enum boundary_kind kind;
    enum absorber absorber;
    long layer_points;       /* of the absorbing layer; 0: by one of the next two, or chosen */
    double layer_thickness;  /* length; 0: not given */
    double layer_reflection; /* wanted; 0: not given */
    long least_points;       /* where they are chosen, at least so many; 0: the default */
    bool fallen; /* dampers in place of an absorbing layer, which the consistent method has, but not here */
    bool always; /* keep the absorbing layer even where no reflection can be seen by end_time */
    double normal_factor, shear_factor; /* Lysmer-Kuhlemeyer: traction = -factor rho c v; 1, 1 as published */
    double direction[3];                /* of a moved face: unit vector in the deck's coordinates */
    double amplitude;
    bool slip; /* leave components across `direction` free (direction along an axis of the body) */
    struct history history;
    enum driven driven;
    bool given;   /* false: nobody named this face, it is free */
    size_t group; /* occurrence of &boundary that named it */
};

/* Components of the displacement that a face prescribes, at rest or moved; with slip only the one along the
 * direction. */
enum face_holds { HOLDS_NOTHING, HOLDS_NORMAL, HOLDS_ALL };
enum { NO_MOTION = -1 };

/* What a method, or an exact solution, can do at a face: bits. */
enum {
    CAN_HOLD = 1,   /* components at rest */
    CAN_MOVE = 2,   /* components with a prescribed motion */
    CAN_MIRROR = 4, /* a symmetry plane, which cuts loads in half */
    CAN_DAMP = 8,   /* dampers */
    CAN_ABSORB = 16 /* absorbing layers */
};

struct boundary_meaning {
    const char *name; /* as in the deck */
    enum face_holds holds;
    int motion; /* order of the time derivative of the displacement that its time function is, or NO_MOTION */
    unsigned needs; /* what a method must be able to do there, CAN_... */
};

const struct boundary_meaning *boundary_meaning(const struct boundary *boundary);
/* CAN_... of this face; an absorbing layer in place of dampers where it asks for one. */
unsigned boundary_needs(const struct boundary *boundary);
/* Displacement of a moved face per amplitude, or its derivative of order `derivative`; 0 if it does not move.
 */
double boundary_displacement(const struct boundary *boundary, double time, int derivative);

static inline bool boundary_moves(const struct boundary *boundary)
{
    return boundary_meaning(boundary)->motion != NO_MOTION;
}
/* The same, but not by nothing: a face of amplitude 0 is a support. */
static inline bool boundary_acts(const struct boundary *boundary)
{
    return boundary_moves(boundary) && boundary->amplitude != 0;
}
/* Neither held nor with forces of its own. */
static inline bool boundary_is_free(const struct boundary *boundary)
{
    return boundary_needs(boundary) == 0;
}
/* All components at rest. */
static inline bool boundary_is_fixed(const struct boundary *boundary)
{
    return boundary_meaning(boundary)->holds == HOLDS_ALL && !boundary_moves(boundary);
}
/* The normal component at rest, no shear traction: roller or symmetry plane. */
static inline bool boundary_slides(const struct boundary *boundary)
{
    return boundary_meaning(boundary)->holds == HOLDS_NORMAL;
}
/* Symmetry plane: slides, and loads that it cuts are whole loads. */
static inline bool boundary_mirrors(const struct boundary *boundary)
{
    return (boundary_needs(boundary) & CAN_MIRROR) != 0;
}
/* Takes waves up: by dampers, by an absorbing layer, by one of them. */
static inline bool boundary_damps(const struct boundary *boundary)
{
    return (boundary_needs(boundary) & CAN_DAMP) != 0;
}
static inline bool boundary_has_layer(const struct boundary *boundary)
{
    return (boundary_needs(boundary) & CAN_ABSORB) != 0;
}
static inline bool boundary_absorbs(const struct boundary *boundary)
{
    return boundary_damps(boundary) || boundary_has_layer(boundary);
}

#endif
