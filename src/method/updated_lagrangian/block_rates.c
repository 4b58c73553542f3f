/* Rates of blocks of particles in updated-Lagrangian SPH (equations: rate.c).
 *
 * One pass over the pairs: L_i^-1 does not depend on j, so the sums are taken with the plain grad W and
 * contracted with L_i^-1 afterwards. A particle only gathers: the sums do not depend on the number of
 * threads. Particles in some order (lattices, rings) are summed several at a time, others one by one
 * (gather.h, pairs.h); what the sums say is worked out for several at a time (contract.h). */
#include "method/updated_lagrangian/gather.h"

/* Rates of the own particles first ... last - 1; first is a multiple of GROUP beyond the first own one. */
INLINED void rates(const struct updated *updated, const int dimension, size_t first, size_t last,
                   const double *y, double *dydt)
{
    const struct pair_switches on = {updated->alpha > 0 || updated->beta > 0, updated->repulsive,
                                     updated->cubic, updated->even, updated->pressed};
    _Alignas(64) struct lane_sums sums[UPDATED_BLOCK / LANES] = {{.matrix = {{0}}}};
    if (updated->ordered)
        gather_ordered(updated, dimension, on, first, last, sums);
    else
        for (size_t i = first; i < last; i++)
            gather_one(updated, dimension, on, i, (i - first) % LANES, &sums[(i - first) / LANES]);
    for (size_t i = first; i < last; i += LANES)
        contract(updated, dimension, i, i + LANES < last ? LANES : last - i, &sums[(i - first) / LANES], y,
                 dydt);
}

/* Instances with constant dimension. */
#define RATES(dimension)                                                                                     \
    static void rates_##dimension(const struct updated *updated, size_t first, size_t last, const double *y, \
                                  double *dydt)                                                              \
    {                                                                                                        \
        rates(updated, dimension, first, last, y, dydt);                                                     \
    }
RATES(1)
RATES(2)
RATES(3)
#undef RATES

const struct updated_rates OF_PROCESSOR(updated_rates) = {{rates_1, rates_2, rates_3}};
