/* The part of a body that a rank has (doc/developers/ranks.md): a block of control values, planes over depth and in
 * three dimensions rows over y. All ranks know the axes of the whole body; a model's fields have a window of it, a
 * rank's own planes and rows and on all sides some of its neighbours', the halo. What is made of a window is right in
 * own rows of own planes; the halo gets what the neighbours have made. Alone, the window is the whole body. */
#ifndef SELAS_METHOD_CONSISTENT_GALERKIN_PART_H
#define SELAS_METHOD_CONSISTENT_GALERKIN_PART_H

#include "parallel/few_ranks.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct band;
struct consistent;

/* Windows are whole blocks of FUSED_PLANES planes, and for the fused operator whole strips of FUSED_STRIP rows. */
enum { PART_PLANES = 4, PART_STRIP = 8 };
enum { PART_MATRICES = 256, PART_NUMBERS = 3 };

/* What a rank has along a slot. */
struct part_axis {
    size_t whole;    /* control values of the body */
    size_t first;    /* the window's first */
    size_t own, end; /* own ones: own .. end - 1 of the window */
    size_t halo;     /* on either side, fewer where the body ends */
    int ranks, me;   /* parts of the body; which of them this is */
    size_t *bound;   /* [ranks + 1] where own ones begin, in the body; NULL: one part */
};

/* Own planes are made in turns, so that halos travel while the rest is made (doc/developers/ranks.md, Order of planes):
 * those that neighbours over depth get, low and high, then the others in two parts, first and last. Alone all are in
 * the last. Where rows are not shared, planes travel after high. Where they are, first is three quarters of the inside:
 * rows of low and high travel after high; planes with all rows, and rows of first, after first; its own after last. */
enum { PART_LOW, PART_HIGH, PART_FIRST, PART_LAST, PART_TURNS };
struct part_range {
    size_t from, end;
};

struct rank_part {
    struct ranks *ranks; /* NULL: alone */
    struct part_axis along[3];
    size_t matrices;
    struct {
        int slot;
        const struct band *whole;
        struct band *cut; /* the window's part of it */
    } matrix[PART_MATRICES];
    char *room
        [4]; /* rows that are sent and received, of the neighbours before and behind; NULL: rows are not shared */
    /* planes of a turn that are made, so many further than those that are sent that what is added to some planes
     * together can be added once one of them is sent */
    struct part_range made[PART_TURNS], sent[PART_TURNS];
};

/* Shares the control values of the body, after the axes are known: sets c->part and the window's sizes; ranks that are
 * too many become idle, whose status is SELAS_STOPPED. */
selas_status part_lay(struct consistent *c, struct messages *messages);
/* Seconds that Eq (R2b) takes of doc/developers/ranks.md: of a point (measured), of a point of the halo (assumed). */
#define PART_POINT 16.4e-9
#define PART_HALO_POINT 3e-9
/* Of the blocks, of a step in one pass on even ground. */
struct ranks_outlook part_outlook(const struct consistent *c);
void part_free(struct consistent *c);

/* Does the rank have a part of the rows alone? */
static inline bool part_rows(const struct rank_part *part)
{
    return part->along[1].ranks > 1;
}

/* The window's rows and columns of a matrix of a slot, kept by the model; the matrix itself if that is all, or
 * if it is a part already. NULL: no memory. */
const struct band *part_matrix(struct consistent *c, int slot, const struct band *whole);

/* The same for all matrices of a plan's terms; false: no memory. */
struct tensor_term;
bool part_terms(struct consistent *c, struct tensor_term *terms, size_t count);

/* Index across the face of its control values, in the window; SIZE_MAX: it does not have them. */
size_t part_face(const struct consistent *c, int face);
/* The rank that has row j of plane k of the body for its own. */
int part_holder(const struct consistent *c, size_t j, size_t k);
/* Is this control value of the window the rank's own? */
static inline bool part_owns(const struct rank_part *part, size_t j, size_t k)
{
    const struct part_axis *y = &part->along[1], *z = &part->along[2];
    return j >= y->own && j < y->end && k >= z->own && k < z->end;
}

/* Fields of the window that ranks share, `apart` bytes from one to the next, planes, rows. */
struct part_fields {
    void *field;
    size_t fields, apart, plane, row;
};
/* Fields of control values, `number` bytes each. */
struct part_fields part_values(const struct consistent *c, void *field, size_t fields, size_t number);

/* Together: halos become what the neighbours have. */
void part_exchange(const struct consistent *c, const struct part_fields *fields);

/* The turn in which what is added to planes from .. end - 1 together is due: the first that sends one of them. */
int part_turn_of(const struct rank_part *part, size_t from, size_t end);
/* Together: planes sent in this turn are as they stay; after the last one halos are what the neighbours have. */
void part_send(const struct consistent *c, const struct part_fields *fields, int turn);
/* Together: the largest of a number of each rank. */
double part_largest(const struct consistent *c, double value);
/* Bytes that a rank sends in part_exchange(). */
double part_bytes(const struct consistent *c, const struct part_fields *fields);
/* x.y of the own control values of two fields of unknowns. */
double part_product(const struct consistent *c, const double *x, const double *y);

/* Together: work that goes over the planes, or rows, of the body in their order (or, not `forward`, the other way) and
 * reads `reach` of them before each, not more than the halo has: calls work(context, from, end) for the own ones once
 * those before them are there. */
void part_sweep(const struct consistent *c, int slot, bool forward, size_t reach,
                const struct part_fields *fields, void (*work)(void *context, size_t from, size_t end),
                void *context);

#endif
