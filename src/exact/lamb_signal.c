/* History of one receiver from its part found by FFT (lamb_fft.c) and the closed forms (lamb_split.c). */
#include "base/memory.h"
#include "exact/lamb_fft.h"
#include "exact/rows.h"

#include <math.h>

void lamb_signal_free(struct lamb_signal *signal)
{
    array_free(signal->value);
    array_free(signal->statics);
    array_free(signal->front);
    signal->value = signal->statics = signal->front = NULL;
}

void lamb_signal_value(const struct lamb_problem *problem, const struct lamb_signal *signal, double t,
                       double value[6])
{
    for (size_t c = 0; c < 6; c++)
        value[c] = 0;
    if (t <= 0) return;
    const double growth = exp(signal->decay * t);
    for (size_t c = 0; c < 6; c++)
        value[c] = growth * rows_between(signal->value + c * signal->rows, signal->rows, t / signal->step);
    for (size_t l = 0; l < problem->loads; l++) {
        const struct lamb_load *load = &problem->load[l];
        lamb_split_value(&problem->ground, load, signal->position[0] - load->patch.centre[0],
                         signal->position[1] - load->patch.centre[1], signal->position[2], t,
                         signal->front + 3 * l, value);
    }
}
