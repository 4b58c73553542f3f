/* Runs: points in sequence whose rows are the same but for their place. On a lattice nearly all points stand
 * in runs; their weights are then read once for many points and their neighbours are contiguous in memory.
 *
 * Weights count as the same within TOLERANCE of the row's largest: on a lattice they differ by the rounding
 * of the positions, some 1e-13, and never do on scattered points. */
#include "method/total_lagrangian_kernels.h"

#include "base/memory.h"

#include <math.h>

static const double TOLERANCE = 1e-11;
enum { LONGEST = 64 };

static bool near(double a, double b, double scale)
{
    return fabs(a - b) <= TOLERANCE * scale;
}

/* Rows of i and j: same distances in memory, same weights. */
static bool same_rows(const struct tl_rows *rows, size_t width, size_t i, size_t j)
{
    const size_t of_i = rows->start[i], of_j = rows->start[j], count = rows->start[i + 1] - of_i;
    if (rows->start[j + 1] - of_j != count) return false;
    double largest = 0;
    for (size_t k = 0; k < width * count; k++)
        largest = fmax(largest, fabs(rows->weight[width * of_i + k]));
    for (size_t k = 0; k < count; k++) {
        if ((ptrdiff_t)rows->index[of_i + k] - (ptrdiff_t)i !=
            (ptrdiff_t)rows->index[of_j + k] - (ptrdiff_t)j)
            return false;
        for (size_t c = 0; c < width; c++)
            if (!near(rows->weight[width * (of_i + k) + c], rows->weight[width * (of_j + k) + c], largest))
                return false;
    }
    return true;
}

static bool same_gradient(const struct tl_model *tl, size_t i, size_t j)
{
    return same_rows(&tl->gradient, (size_t)tl->cloud->dimension, i, j);
}

static bool same_transposed(const struct tl_model *tl, size_t i, size_t j)
{
    const size_t n = tl->cloud->points;
    return (i < n) == (j < n) && same_rows(&tl->transposed, (size_t)tl->cloud->dimension, i, j);
}

/* Same law and volume, and hourglass pairs to the same places. */
static bool same_stress(const struct tl_model *tl, size_t i, size_t j)
{
    const struct elastic *one = &tl->elastic[i], *other = &tl->elastic[j];
    if (one->law != other->law || one->mu != other->mu || one->plane_lambda != other->plane_lambda ||
        one->lambda != other->lambda ||
        !near(tl->cloud->volume[i], tl->cloud->volume[j], tl->cloud->volume[i]))
        return false;
    if (tl->extra == NULL) return true;
    const struct tl_rows *rows = &tl->pair;
    if (!same_rows(rows, 1, i, j)) return false;
    const double *x = tl->site_position;
    for (size_t k = 0; k < rows->start[i + 1] - rows->start[i]; k++)
        for (size_t c = 0; c < 3; c++) {
            const double of_i = x[3 * rows->index[rows->start[i] + k] + c] - x[3 * i + c];
            const double of_j = x[3 * rows->index[rows->start[j] + k] + c] - x[3 * j + c];
            if (!near(of_i, of_j, tl->cloud->spacing)) return false;
        }
    return true;
}

/* Cuts `count` points from `first` on into blocks of at most LONGEST and much the same length. */
static void cut(struct tl_blocks *blocks, size_t first, size_t count, bool run)
{
    const size_t pieces = (count + LONGEST - 1) / LONGEST;
    for (size_t p = 0; p < pieces; p++) {
        const size_t from = count * p / pieces, to = count * (p + 1) / pieces;
        blocks->block[blocks->count++] =
            (struct tl_block){(uint32_t)(first + from), (uint32_t)first, (uint16_t)(to - from), run};
    }
}

static selas_status find(const struct tl_model *tl, size_t count,
                         bool (*same)(const struct tl_model *, size_t, size_t), struct tl_blocks *blocks,
                         struct messages *messages)
{
    /* at most count / VEC runs and one stretch more between them, each with one block that is not full */
    blocks->block = array_new(2 * (count / VEC) + count / LONGEST + 2, sizeof *blocks->block);
    if (blocks->block == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", count);
    size_t alone = 0; /* where the points begin that stand in no run */
    for (size_t i = 0; i < count;) {
        size_t next = i + 1;
        while (next < count && same(tl, i, next))
            next++;
        if (next - i >= VEC) {
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
