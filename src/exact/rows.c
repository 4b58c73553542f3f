/* Lagrange interpolation on the 12 nearest rows. */
#include "exact/rows.h"

#include <math.h>

double rows_between(const double *line, size_t rows, double at)
{
    enum { POINTS = 12, BEFORE = 5 };
    const double place = fmin(fmax(floor(at) - BEFORE, 0), (double)(rows - POINTS));
    const size_t first = (size_t)place;
    const double x = at - place;
    double sum = 0;
    for (int i = 0; i < POINTS; i++) {
        double weight = 1;
        for (int j = 0; j < POINTS; j++)
            if (j != i) weight *= (x - j) / (i - j);
        sum += weight * line[first + (size_t)i];
    }
    return sum;
}
