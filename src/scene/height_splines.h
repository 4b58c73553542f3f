/* Splines of degree 3 along one axis of a grid of heights, by least squares. */
#ifndef SELAS_SCENE_HEIGHT_SPLINES_H
#define SELAS_SCENE_HEIGHT_SPLINES_H

#include <stdbool.h>
#include <stddef.h>

enum { HEIGHT_ORDER = 4 }; /* degree and one */

struct axis_map {
    size_t values, order, count; /* of the grid; of the splines: order, coefficients */
    double *place;               /* [values] */
    size_t pieces, parts;        /* of the splines; 0: no such axis; even parts, one or several to a piece */
    double *knot;                /* [pieces + 1] ends of the pieces, in parts */
    size_t *piece_of;            /* [parts] */
    bool gaps;                   /* between the values: pieces of even parts would swing */
};

/* Lays the splines of an axis whose places are known: pieces no shorter than `piece`. False: no memory. */
bool height_splines_lay(struct axis_map *along, double piece);
/* Values of the splines that are not 0 at x, from *first on; how many. */
size_t height_splines_at(const struct axis_map *along, double x, double basis[HEIGHT_ORDER], size_t *first);

/* Coefficients along an axis: `lines` lines of values, number i of line l at in[l * skip + i * step]; out alike,
 * with steps of its own. */
struct lines_of {
    double *at;
    size_t step, skip;
};

/* False: no memory. */
bool height_splines_fit(const struct axis_map *along, size_t lines, struct lines_of in, struct lines_of out);

#endif
