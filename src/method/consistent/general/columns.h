/* Columns along an axis of the surface, over which the ground is averaged (doc/theory/general-ground.md, section 4): a
 * fraction of the spacing wide, and cut where boxes end. */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_COLUMNS_H
#define SELAS_METHOD_CONSISTENT_GENERAL_COLUMNS_H

#include "method/consistent/general/piece.h"

struct columns {
    const struct spline *spline;
    int slot;
    size_t count, points, a_cell;
    size_t lines; /* of a column: more than one where a model's values lie closer than columns */
    double from, step, spacing;
    bool varies;
    /* Of each column: middle and width in even ones, and the column of the lattice that it is the mirror image of. */
    double *middle, *width;
    size_t *image;
    size_t *first; /* column of each half cell */
    struct column_weight {
        double average, smooth[3];
    } * weight[2];              /* [at][point * most + n] of the columns about a point: (G11b), (G10a) */
    size_t most, halves, bytes; /* columns about a point, at most; half cells; memory */
};

/* Does ground that varies over depth vary along the lattice too? */
bool columns_bend(const struct scene *scene);
bool columns_lay(struct columns *columns, const struct consistent *c, int slot); /* false: no memory */
void columns_free(struct columns *columns);
/* Place of column n; beyond a symmetry plane its mirror image. */
double columns_place(const struct columns *columns, size_t n);
/* Place of a line of column n from its middle. */
double columns_line(const struct columns *columns, size_t n, size_t line);
/* Averages about point i from columns `stride` apart. */
void columns_average(const struct columns *columns, enum at at, size_t i, const struct piece *column,
                     size_t stride, struct piece *sum);

#endif
