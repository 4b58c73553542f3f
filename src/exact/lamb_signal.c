/* History of one receiver from its part found by FFT (lamb_fft.c) and the closed forms (lamb_split.c). */
#include "base/memory.h"
#include "exact/lamb_fft.h"

#include <math.h>

void lamb_signal_free(struct lamb_signal *signal)
{
    array_free(signal->value);
    array_free(signal->statics);
    array_free(signal->front);
    signal->value = signal->statics = signal->front = NULL;
}

/* Lagrange interpolation on 12 rows of the grid (band limit an eighth of its own). */
static double interpolate(const double *line, size_t rows, double at)
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

void lamb_signal_value(const struct lamb_problem *problem, const struct lamb_signal *signal, double t,
                       double value[6])
{
    for (size_t c = 0; c < 6; c++)
        value[c] = 0;
    if (t <= 0) return;
    const double growth = exp(signal->decay * t);
    for (size_t c = 0; c < 6; c++)
        value[c] = growth * interpolate(signal->value + c * signal->rows, signal->rows, t / signal->step);
    for (size_t l = 0; l < problem->loads; l++) {
        const struct lamb_load *load = &problem->load[l];
        lamb_split_value(&problem->ground, load, signal->position[0] - load->patch.centre[0],
                         signal->position[1] - load->patch.centre[1], signal->position[2], t,
                         signal->front + 3 * l, value);
    }
}
