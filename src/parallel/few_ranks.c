/* Fewer ranks where the body has no work for all of them; what those that work let expect. */
#include "parallel/few_ranks.h"

#include <stdio.h>

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

bool ranks_same(struct ranks *ranks, uint64_t number)
{
    const double half[2] = {(double)(uint32_t)number, (double)(uint32_t)(number >> 32)};
    double most[4] = {half[0], half[1], -half[0], -half[1]};
    ranks_largest(ranks, 4, most);
    return most[0] + most[2] == 0 && most[1] + most[3] == 0;
}

struct ranks_outlook ranks_look_ahead(struct ranks *ranks, double work, double seconds, double alone)
{
    double most[2] = {work, seconds}, sum = work;
    ranks_largest(ranks, 2, most);
    ranks_sum(ranks, 1, &sum);
    const double count = ranks_count(ranks);
    return (struct ranks_outlook){.balance = sum / count / most[0], .efficiency = alone / count / most[1]};
}

void ranks_tell_outlook(const struct ranks_outlook *outlook, const char *with,
                        void (*tell)(void *context, const char *key, const char *value), void *context)
{
    char text[200];
    snprintf(text, sizeof text, "%.2f (balance %.2f; %s, %g GB/s and %g us a message)", outlook->efficiency,
             outlook->balance, with, 1e-9 / RANKS_BYTE, RANKS_MESSAGE * 1e6);
    tell(context, "efficiency expected", text);
}
