/* Patches that move over the surface of a homogeneous or layered half-space. */
#ifndef SELAS_LAMB_MOVING_H
#define SELAS_LAMB_MOVING_H

#include "exact/lamb_fft.h"

struct moving_patch {
    struct lamb_load load; /* where it is at t = 0 */
    double velocity[2];
};

/* Histories at n receivers for times up to end_time, from all the patches; signal[i].position is given. To be
 * read by lamb_signal_value() with a problem without loads. Histories must be smooth; points, and loads on
 * layers, slower than every Rayleigh wave (SELAS_BAD_SCENE). Behind a patch that is faster velocity has
 * logarithmic poles on the Mach lines of its corners: values there are those of wavenumbers up to 400/edge to
 * 670/edge, displacements good to 1e-4 .. 1e-3. On failure, and without `compute`,
 * which asks only whether they are refused, all value are NULL. */
selas_status lamb_moving(const struct lamb_problem *ground, size_t patches, const struct moving_patch *patch,
                         double end_time, size_t n, struct lamb_signal *signal, bool compute,
                         struct messages *messages);

#endif
