/* Fewer ranks where the body has no work for all of them. */
#include "parallel/few_ranks.h"

selas_status ranks_at_most(struct ranks *ranks, size_t places, const char *what, struct messages *messages)
{
    const int wanted = ranks_count(ranks);
    if ((size_t)wanted <= places) return SELAS_OK;
    if (ranks_fixed(ranks))
        return fail(
            messages, SELAS_UNSUPPORTED,
            "%zu of the %d ranks of the communicator would have work: the body has %zu %s; open it with "
            "as many",
            places, wanted, places, what);
    warn(messages, "of %d ranks %zu can work: the body has %zu %s", wanted, places, places, what);
    ranks_take(ranks, (int)places);
    return ranks_idle(ranks) ? SELAS_STOPPED : SELAS_OK;
}

void ranks_deal(size_t places, double (*cost)(const void *context, size_t place), const void *context,
                size_t ranks, size_t *bound)
{
    double whole = 0, sum = 0;
    for (size_t p = 0; p < places; p++)
        whole += cost(context, p);
    size_t rank = 1;
    bound[0] = 0;
    for (size_t p = 0; p < places && rank < ranks; p++) {
        const double here = cost(context, p);
        const bool due = sum + 0.5 * here >= whole * (double)rank / (double)ranks;
        if ((due && p > bound[rank - 1]) || places - p == ranks - rank) bound[rank++] = p;
        sum += here;
    }
    bound[ranks] = places;
}
