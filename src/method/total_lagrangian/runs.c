/* Runs: points in sequence that share a row of weights. On a lattice nearly all points stand in runs; their
 * weights are then read once for many points and their neighbours are contiguous in memory. */
#include "method/total_lagrangian/run_loops.h"

#include "base/memory.h"

enum { LONGEST = TL_LONGEST_BLOCK };

static bool same_gradient(const struct tl_model *tl, size_t i, size_t j)
{
    return tl->gradient.of[i] == tl->gradient.of[j];
}

static bool same_transposed(const struct tl_model *tl, size_t i, size_t j)
{
    const size_t n = tl->cloud->points;
    return (i < n) == (j < n) && tl->transposed.of[i] == tl->transposed.of[j];
}

static bool same_law(const struct elastic *one, const struct elastic *other)
{
    return one->law == other->law && one->mu == other->mu && one->plane_lambda == other->plane_lambda &&
           one->lambda == other->lambda;
}

/* Same law and volume, and hourglass pairs to the same places. */
static bool same_stress(const struct tl_model *tl, size_t i, size_t j)
{
    return same_law(&tl->elastic[i], &tl->elastic[j]) &&
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
            (struct tl_block){(uint32_t)(first + from), (uint32_t)(first + from), (uint16_t)(to - from), run};
    }
}

static bool make_room(struct tl_blocks *blocks, size_t count, size_t layers, struct messages *messages)
{
    /* at most count / GROUP runs and one stretch more between them, each with one block that is not full; twice, for
     * points and ghosts; and one stretch more in each layer */
    blocks->block = array_new(2 * (count / GROUP) + count / LONGEST + layers + 4, sizeof *blocks->block);
    if (blocks->block == NULL) fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", count);
    return blocks->block != NULL;
}

/* Blocks of points from .. end - 1; returns whether there is a run. */
static bool find(const struct tl_model *tl, size_t from, size_t end,
                 bool (*same)(const struct tl_model *, size_t, size_t), struct tl_blocks *blocks)
{
    bool runs = false;
    size_t alone = from; /* where the points begin that stand in no run */
    for (size_t i = from; i < end;) {
        size_t next = i + 1;
        while (next < end && same(tl, i, next))
            next++;
        if (next - i >= GROUP) {
            cut(blocks, alone, i - alone, false);
            cut(blocks, i, next - i, true);
            alone = next;
            runs = true;
        }
        i = next;
    }
    cut(blocks, alone, end - alone, false);
    return runs;
}

/* Stresses of points in no run go by groups from the first of their block on, so that blocks are those of the whole
 * body. Lines of a lattice are alike: with no run here there is none, and its points are one stretch. */
static void cut_as_whole(const struct tl_model *tl, struct tl_blocks *blocks)
{
    const size_t whole = tl->cloud->whole, pieces = (whole + LONGEST - 1) / LONGEST, first = tl->cloud->first;
    const struct tl_range *made = &tl->part.pair;
    blocks->count = 0;
    for (size_t p = (first + made->from) / LONGEST; p < pieces; p++) {
        const size_t from = whole * p / pieces, to = whole * (p + 1) / pieces;
        if (to > first + made->end) break;
        if (from >= first + made->from)
            blocks->block[blocks->count++] = (struct tl_block){
                (uint32_t)(from - first), (uint32_t)(from - first), (uint16_t)(to - from), false};
    }
}

/* Blocks of points of a file are those of its layers, each of which a part has as a whole. */
static void find_in_layers(const struct tl_model *tl, const struct tl_range *made, struct tl_blocks *blocks)
{
    const struct cloud *cloud = tl->cloud;
    for (size_t l = 0; l < cloud->layers; l++)
        if (cloud->start[l] >= cloud->first + made->from && cloud->start[l + 1] <= cloud->first + made->end)
            find(tl, cloud->start[l] - cloud->first, cloud->start[l + 1] - cloud->first, same_stress, blocks);
}

selas_status tl_find_runs(struct tl_model *tl, struct messages *messages)
{
    const size_t n = tl->cloud->points;
    const struct tl_part *part = &tl->part;
    struct tl_blocks *gradient = &tl->gradient_blocks, *stress = &tl->stress_blocks,
                     *force = &tl->force_blocks;
    if (!make_room(gradient, n, 0, messages) || !make_room(stress, n, tl->cloud->layers, messages) ||
        !make_room(force, tl->sites, 0, messages))
        return SELAS_NO_MEMORY;
    find(tl, part->gradient.from, part->gradient.end, same_gradient, gradient);
    if (tl->cloud->layers > 0)
        find_in_layers(tl, &part->pair, stress);
    else if (!find(tl, part->pair.from, part->pair.end, same_stress, stress) && part->shared)
        cut_as_whole(tl, stress);
    find(tl, part->transposed.from, part->transposed.end, same_transposed, force);
    find(tl, n, tl->sites, same_transposed, force);
    return SELAS_OK;
}

static bool is_needed(const struct tl_model *tl, const bool *needed, size_t from, size_t end)
{
    bool any = false;
    for (size_t s = from; s < end; s++)
        any = any || needed[tl_source(tl, s)];
    return any;
}

/* Sites that one piece of a block has: GROUP; all, where groups of points of one law are found one after the other. */
static size_t piece_of(const struct tl_model *tl, const struct tl_block *block, bool stress)
{
    const size_t end = (size_t)block->first + block->count;
    for (size_t i = (size_t)block->first + 1; stress && !block->run && i < end; i++)
        if (!same_law(&tl->elastic[block->first], &tl->elastic[i])) return block->count;
    return GROUP;
}

/* The needed pieces of a block, those that follow each other as one; a run's have GROUP sites at least. Returns how
 * many there are, written where `kept` is not NULL. */
static size_t keep_pieces(const struct tl_model *tl, const bool *needed, const struct tl_block *block,
                          size_t piece, struct tl_block *kept)
{
    const size_t last = (size_t)block->first + block->count;
    size_t count = 0;
    for (size_t from = block->first, end; from < last; from = end) {
        end = from + piece < last ? from + piece : last;
        if (!is_needed(tl, needed, from, end)) continue;
        while (end < last && is_needed(tl, needed, end, end + piece < last ? end + piece : last))
            end = end + piece < last ? end + piece : last;
        const size_t first = block->run && end - from < GROUP ? end - GROUP : from;
        if (kept != NULL)
            kept[count] =
                (struct tl_block){(uint32_t)first, block->origin, (uint16_t)(end - first), block->run};
        count++;
    }
    return count;
}

bool tl_keep_blocks(const struct tl_model *tl, const bool *needed, bool stress, struct tl_blocks *blocks,
                    struct tl_blocks *all)
{
    struct tl_blocks kept = {0};
    for (size_t b = 0; b < blocks->count; b++)
        kept.count +=
            keep_pieces(tl, needed, &blocks->block[b], piece_of(tl, &blocks->block[b], stress), NULL);
    kept.block = array_new(kept.count, sizeof *kept.block);
    if (kept.block == NULL) return false;
    for (size_t b = 0, at = 0; b < blocks->count; b++)
        at += keep_pieces(tl, needed, &blocks->block[b], piece_of(tl, &blocks->block[b], stress),
                          kept.block + at);
    if (all != NULL)
        *all = *blocks;
    else
        array_free(blocks->block);
    *blocks = kept;
    return true;
}
