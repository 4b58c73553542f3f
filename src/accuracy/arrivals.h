/* Exact plane waves at receivers and the error that a lattice makes of them, for scene%accuracy. */
#ifndef SELAS_ACCURACY_ARRIVALS_H
#define SELAS_ACCURACY_ARRIVALS_H

#include "accuracy/lattice.h"

/* Rows of a history; row i stands at (i + 1) time_step, the transforms' frequency j is pi (j + 1) / ((rows +
 * 1) time_step). */
enum { ARRIVAL_ROWS = 4096 };

struct arrivals {
    double *velocity;   /* [ARRIVAL_ROWS] along the component that moves most */
    double *change;     /* [ARRIVAL_ROWS] sine coefficients of q (Eq 6) */
    double *spectrum;   /* [ARRIVAL_ROWS] sine coefficients of the velocity */
    double largest;     /* velocity */
    double whole;       /* sum of the squared velocities until end_time */
    double travel;      /* mean travel time of what arrives */
    double middle;      /* mean time of what arrives */
    double position[3]; /* in the body's frame */
    double held;        /* mean number of reflections at held ends */
    bool damped;        /* sees what a damper sends back */
    double time_step;
};

/* One for each receiver; to be freed after a failure too. */
selas_status arrivals_create(const struct scene *scene, struct arrivals **arrivals,
                             struct messages *messages);
void arrivals_free(struct arrivals **arrivals);

/* Relative L2 error of the velocity; speed[ARRIVAL_ROWS]: lattice_speed_error of the frequencies; work:
 * [2 * ARRIVAL_ROWS]. */
double arrivals_error(const struct lattice_wave *wave, const struct arrivals *place, double spacing,
                      const double *speed, double *work);

#endif
