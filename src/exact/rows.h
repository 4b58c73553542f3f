/* Values between the rows of a regular grid. */
#ifndef SELAS_ROWS_H
#define SELAS_ROWS_H

#include <stddef.h>

/* Lagrange interpolation on 12 rows, at the place `at` in rows from the first (band limit an eighth of the
 * grid's own: 1e-11). At least 12 rows. */
double rows_between(const double *line, size_t rows, double at);

#endif
