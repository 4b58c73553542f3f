/* Runs: points in sequence that share a row of weights. On a lattice nearly all points stand in runs; their
 * weights are then read once for many points and their neighbours are contiguous in memory. */
#include "method/total_lagrangian/run_loops.h"

#include "base/memory.h"

enum { LONGEST = 64 };

static bool same_gradient(const struct tl_model *tl, size_t i, size_t j)
{
    return tl->gradient.of[i] == tl->gradient.of[j];
}

static bool same_transposed(const struct tl_model *tl, size_t i, size_t j)
{
    const size_t n = tl->cloud->points;
    return (i < n) == (j < n) && tl->transposed.of[i] == tl->transposed.of[j];
}

/* Same law and volume, and hourglass pairs to the same places. */
static bool same_stress(const struct tl_model *tl, size_t i, size_t j)
{
    const struct elastic *one = &tl->elastic[i], *other = &tl->elastic[j];
    return one->law == other->law && one->mu == other->mu && one->plane_lambda == other->plane_lambda &&
           one->lambda == other->lambda &&
           tl_near(tl->cloud->volume[i], tl->cloud->volume[j], tl->cloud->volume[i]) &&
           (tl->pair.of == NULL || tl->pair.of[i] == tl->pair.of[j]);
}

/* Cuts `count` points from `first` on into blocks of at most LONGEST and much the same length. */
static void cut(struct tl_blocks *blocks, size_t first, size_t count, bool run)
{
    const size_t pieces = (count + LONGEST - 1) / LONGEST;
    for (size_t p = 0; p < pieces; p++) {
        const size_t from = count * p / pieces, to = count * (p + 1) / pieces;
        blocks->block[blocks->count++] =
            (struct tl_block){(uint32_t)(first + from), (uint16_t)(to - from), run};
    }
}

static selas_status find(const struct tl_model *tl, size_t count,
                         bool (*same)(const struct tl_model *, size_t, size_t), struct tl_blocks *blocks,
                         struct messages *messages)
{
    /* at most count / GROUP runs and one stretch more between them, each with one block that is not full */
    blocks->block = array_new(2 * (count / GROUP) + count / LONGEST + 2, sizeof *blocks->block);
    if (blocks->block == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", count);
    size_t alone = 0; /* where the points begin that stand in no run */
    for (size_t i = 0; i < count;) {
        size_t next = i + 1;
        while (next < count && same(tl, i, next))
            next++;
        if (next - i >= GROUP) {
            cut(blocks, alone, i - alone, false);
            cut(blocks, i, next - i, true);
            alone = next;
        }
        i = next;
    }
    cut(blocks, alone, count - alone, false);
    return SELAS_OK;
}

selas_status tl_find_runs(struct tl_model *tl, struct messages *messages)
{
    selas_status status = find(tl, tl->cloud->points, same_gradient, &tl->gradient_blocks, messages);
    if (status == SELAS_OK) status = find(tl, tl->cloud->points, same_stress, &tl->stress_blocks, messages);
    if (status == SELAS_OK) status = find(tl, tl->sites, same_transposed, &tl->force_blocks, messages);
    return status;
}
