/* Updated-Lagrangian particles on ranks (doc/developers/ranks.md, Eq. R9): particles move and meet others, so each rank
 * keeps the state of the whole body. It works out the rates of some blocks of particles, and gets those of the others
 * from the ranks that do. Each sum is over the same numbers in the same order as in one process. */
#include "method/updated_lagrangian/updated_lagrangian.h"

#include "base/memory.h"
#include "parallel/few_ranks.h"

#include <math.h>
#include <stdio.h>

/* Components of the rates that follow from sums over neighbours: acceleration, density, stress. */
enum { SUMMED = 3 };
/* Seconds that Eq (R9b) takes of a neighbour of an own particle, and of any particle (measured). */
#define NEIGHBOUR 4.5e-9
#define PARTICLE 18e-9

/* Neighbours in the lists of a block. */
static double cost(const void *context, size_t block)
{
    const struct updated *updated = context;
    const size_t points = updated->cloud->points, first = UPDATED_BLOCK * block;
    const size_t last = first + UPDATED_BLOCK < points ? first + UPDATED_BLOCK : points;
    return (double)(updated->neighbours.start[last] - updated->neighbours.start[first]);
}

selas_status updated_share(struct updated *updated, struct messages *messages)
{
    struct updated_part *part = &updated->part;
    const size_t blocks = (updated->cloud->points + UPDATED_BLOCK - 1) / UPDATED_BLOCK;
    if (ranks_count(updated->model.scene->ranks) == 1) return SELAS_OK;
    part->ranks = updated->model.scene->ranks;
    const selas_status status = ranks_at_most(part->ranks, blocks, "blocks of 32 particles", messages);
    if (status != SELAS_OK) return status;
    const size_t ranks = (size_t)ranks_count(part->ranks);
    part->bound = array_new(ranks + 1, sizeof *part->bound);
    part->piece = array_new(SUMMED * ranks, sizeof *part->piece);
    if (part->bound == NULL || part->piece == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
    ranks_deal(blocks, cost, updated, ranks, part->bound);
    updated->model.replicated = true;
    return SELAS_OK;
}

void updated_part_free(struct updated_part *part)
{
    array_free(part->bound);
    array_free(part->piece);
}

void updated_own_blocks(const struct updated *updated, size_t *from, size_t *end)
{
    const struct updated_part *part = &updated->part;
    const size_t me = (size_t)ranks_me(part->ranks);
    *from = part->bound != NULL ? part->bound[me] : 0;
    *end = part->bound != NULL ? part->bound[me + 1]
                               : (updated->cloud->points + UPDATED_BLOCK - 1) / UPDATED_BLOCK;
}

/* Particles of a rank: *from .. the number behind them. */
static size_t particles_of(const struct updated *updated, size_t rank, size_t *from)
{
    const size_t points = updated->cloud->points, end = UPDATED_BLOCK * updated->part.bound[rank + 1];
    *from = UPDATED_BLOCK * updated->part.bound[rank];
    return end < points ? end : points;
}

/* In an evaluation by a rank with so many particles. */
static size_t numbers_sent(const struct updated *updated, size_t particles)
{
    const size_t others = (size_t)ranks_count(updated->part.ranks) - 1;
    return others * particles * (size_t)(updated->dimension + 1 + updated->stresses);
}

/* Eq (R9b). */
static struct ranks_outlook look_ahead(const struct updated *updated)
{
    const size_t *start = updated->neighbours.start, ranks = (size_t)ranks_count(updated->part.ranks);
    const double all = PARTICLE * (double)updated->cloud->points,
                 whole = (double)start[updated->cloud->points], mean = whole / (double)ranks;
    double most = 0, longest = 0;
    for (size_t r = 0; r < ranks; r++) {
        size_t from;
        const size_t end = particles_of(updated, r, &from);
        const double own = (double)(start[end] - start[from]),
                     sent = (double)(sizeof(double) * numbers_sent(updated, end - from));
        most = fmax(most, own);
        longest = fmax(longest, all + NEIGHBOUR * own + RANKS_BYTE * sent +
                                    RANKS_MESSAGE * (double)(SUMMED * (ranks - 1)));
    }
    return (struct ranks_outlook){mean / most, (all + NEIGHBOUR * whole) / (double)ranks / longest};
}

void updated_exchange(const struct updated *updated, double *dydt)
{
    const struct updated_part *part = &updated->part;
    const size_t points = updated->cloud->points, unknowns = updated->model.unknowns;
    const size_t width[SUMMED] = {(size_t)updated->dimension, 1, (size_t)updated->stresses};
    double *const array[SUMMED] = {dydt + unknowns, dydt + 2 * unknowns, dydt + 2 * unknowns + points};
    if (part->ranks == NULL) return;
    size_t mine, pieces = 0;
    const size_t me = (size_t)ranks_me(part->ranks), my_end = particles_of(updated, me, &mine);
    for (size_t r = 0; r < (size_t)ranks_count(part->ranks); r++) {
        size_t first;
        const size_t end = particles_of(updated, r, &first);
        for (size_t k = 0; r != me && k < SUMMED; k++)
            part->piece[pieces++] =
                (struct ranks_piece){.with = (int)r,
                                     .send = array[k] + width[k] * mine,
                                     .receive = array[k] + width[k] * first,
                                     .send_bytes = width[k] * (my_end - mine) * sizeof(double),
                                     .receive_bytes = width[k] * (end - first) * sizeof(double)};
    }
    ranks_exchange(part->ranks, pieces, part->piece);
}

void updated_describe_part(const struct updated *updated,
                           void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct updated_part *part = &updated->part;
    if (part->ranks == NULL) return;
    const size_t ranks = (size_t)ranks_count(part->ranks);
    char text[200];
    size_t from, end;
    int used = snprintf(text, sizeof text, "%zu, particles:", ranks);
    for (size_t r = 0; r < ranks && (size_t)used + 24 < sizeof text; r++) {
        end = particles_of(updated, r, &from);
        used += snprintf(text + used, sizeof text - (size_t)used, " %zu", end - from);
    }
    tell(context, "ranks", text);
    end = particles_of(updated, 0, &from);
    const size_t numbers = numbers_sent(updated, end - from);
    snprintf(text, sizeof text,
             "%zu by the first rank in each evaluation (the rates of its particles, to all)",
             numbers * sizeof(double));
    tell(context, "halo bytes a step", text);
    const struct ranks_outlook outlook = look_ahead(updated);
    snprintf(text, sizeof text, "with %g ns a neighbour, %g ns a particle on all ranks", NEIGHBOUR * 1e9,
             PARTICLE * 1e9);
    ranks_tell_outlook(&outlook, text, tell, context);
}
