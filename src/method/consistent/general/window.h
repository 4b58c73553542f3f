/* A piece of the lattice about a moment tensor, in the ground of the line through it, and the fields that its
 * forces are held against (doc/theory/general-ground.md, Eqs G26 to G29). */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_WINDOW_H
#define SELAS_METHOD_CONSISTENT_GENERAL_WINDOW_H

#include "method/consistent/general/glut.h"
#include "method/consistent/general/steady.h"
#include "scene/grading.h"

#include <stddef.h>

#define GLUT_REACH 4 /* spacings: so near interfaces are felt, and forces changed */

struct glut_window {
    const struct glut *glut;
    struct ground_line line;
    struct grading grading; /* of a lattice that is graded over depth */
    struct steady steady[STEADY_MOST];
    size_t states;
    struct model *model;
    struct consistent *c; /* the model's */
    size_t n;             /* unknowns */
    ptrdiff_t from[3];    /* by slot: the whole's cell that is its first */
    bool bare[3][2];      /* by axis: ends at a free face */
    double *field,
        *rest; /* [states][n] control values of the exact field; what these lack in balance, where free */
    double *forces, *answer, *change, *weight; /* [n] of the moment; what they do; what was added; (G28) */
    bool *loose;                               /* [n] */
    double *work[3];                           /* [n] */
};

/* Sets the cells of each axis, by slot, and the line. False: the source is too near to an end of the body, or the
 * ground about it is not as the line says, or (good is false) there is no memory. */
bool glut_window_fits(struct glut_window *w, ptrdiff_t end[3], bool *good);
/* The model with the load alone, up to the cells `end`, and the fields. False: no memory. */
bool glut_window_lay(struct glut_window *w, const struct load *load, const ptrdiff_t end[3]);
void glut_window_free(struct glut_window *w);

#endif
