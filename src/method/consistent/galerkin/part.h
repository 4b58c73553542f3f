/* The part of a body that a rank has (doc/developers/ranks.md): planes of control values, the slot DEPTH. All ranks
 * know the axes of the whole body; a model's fields have a window of its planes, those of its own and on both
 * sides some of its neighbours', the halo. What is made of a window is right in own planes; the halo gets what
 * the neighbours have made. Alone, the window is the whole body. */
#ifndef SELAS_METHOD_CONSISTENT_GALERKIN_PART_H
#define SELAS_METHOD_CONSISTENT_GALERKIN_PART_H

#include "parallel/ranks.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct band;
struct consistent;

enum { PART_UNIT = 4, PART_NOWHERE = -1 }; /* windows are whole blocks of FUSED_PLANES planes */
enum { PART_MATRICES = 192 };

struct rank_part {
    struct ranks *ranks; /* NULL: alone */
    size_t whole;        /* planes of the body */
    size_t first;        /* the window's first */
    size_t own, end;     /* own planes: own .. end - 1 of the window */
    size_t halo;         /* planes on either side, fewer where the body ends */
    size_t *bound;       /* [count + 1] where the own planes of each rank begin, in the body */
    size_t matrices;
    const struct band *matrix[PART_MATRICES]; /* of the whole ... */
    struct band *cut[PART_MATRICES];          /* ... and the window's part of it */
};

/* Shares the planes of the body, after the axes are known: sets c->part and the window's sizes; ranks that are
 * too many become idle, whose status is SELAS_STOPPED. */
selas_status part_lay(struct consistent *c, struct messages *messages);
void part_free(struct consistent *c);

/* The window's rows and columns of a matrix over depth, kept by the model; the matrix itself if that is all.
 * NULL: no memory. */
const struct band *part_matrix(struct consistent *c, const struct band *whole);

/* The same for all matrices over depth of a plan's terms; false: no memory. */
struct tensor_term;
bool part_terms(struct consistent *c, struct tensor_term *terms, size_t count);

/* Plane of a body in the window; SIZE_MAX: it is not in it. */
size_t part_plane(const struct consistent *c, size_t plane);
/* Index across the face of its control values, in the window; SIZE_MAX: it does not have them. */
size_t part_face(const struct consistent *c, int face);
/* The rank that has this plane of the body for its own. */
int part_holder(const struct consistent *c, size_t plane);

/* Together: halo planes become what the neighbours have: `fields` fields of the window, `apart` bytes from one
 * to the next, `plane` bytes a plane. */
void part_exchange(const struct consistent *c, void *field, size_t fields, size_t apart, size_t plane);
/* Together: the largest of a number of each rank. */
double part_largest(const struct consistent *c, double value);
/* x.y of the own planes of two fields of unknowns. */
double part_product(const struct consistent *c, const double *x, const double *y);

/* Together: work that goes over the planes of the body in their order (or, not `forward`, the other way) and
 * reads `reach` planes before each, not more than the halo has: calls work(context, from, end) for the own planes once
 * those before them are there. Fields as in part_exchange(). */
void part_sweep(const struct consistent *c, bool forward, size_t reach, double *field, size_t fields,
                size_t apart, size_t plane, void (*work)(void *context, size_t from, size_t end),
                void *context);

#endif
