/* Which points are whose (doc/developers/ranks.md). Where memory is shared, planes of a lattice; else all ranks have
 * all points, and cut them in two again and again: across the longest extent of the part, so that either side has as
 * many neighbours as its ranks are worth. So parts are compact whatever the body's shape, and few neighbours are on
 * other ranks. */
#include "method/total_lagrangian/total_lagrangian.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/* A point, and where it stands along the axis that is cut. */
struct standing {
    double at;
    uint32_t point;
};

static int in_order(const void *one, const void *other)
{
    const struct standing *a = one, *b = other;
    if (a->at != b->at) return a->at < b->at ? -1 : 1;
    return a->point < b->point ? -1 : a->point > b->point;
}

/* Points of some ranks: `count` of the order from `from` on. */
struct piece {
    size_t from, count, rank, ranks;
};

/* What a point costs: its neighbours in the gradients, and itself. */
static size_t weight_of(const struct tl_model *tl, size_t point)
{
    return 1 + tl_last(&tl->gradient, point) - tl_first(&tl->gradient, point);
}

/* Sorts the points along their longest extent. */
static void sort_along(const struct tl_model *tl, struct standing *standing, size_t count)
{
    const double *x = tl->cloud->position;
    size_t longest = 0;
    double most = -1;
    for (size_t c = 0; c < (size_t)tl->cloud->dimension; c++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t k = 0; k < count; k++) {
            low = fmin(low, x[3 * standing[k].point + c]);
            high = fmax(high, x[3 * standing[k].point + c]);
        }
        if (high - low > most * (1 + 1e-9)) {
            longest = c;
            most = high - low;
        }
    }
    for (size_t k = 0; k < count; k++)
        standing[k].at = x[3 * standing[k].point + longest];
    qsort(standing, count, sizeof *standing, in_order);
}

/* Cuts a piece in two for the lower and the upper half of its ranks; each rank has a point at least. */
static struct piece cut(const struct tl_model *tl, struct standing *standing, struct piece *piece)
{
    const size_t ranks = piece->ranks / 2, least = ranks, most = piece->count - (piece->ranks - ranks);
    size_t whole = 0, sum = 0, count = 0;
    sort_along(tl, standing + piece->from, piece->count);
    for (size_t k = 0; k < piece->count; k++)
        whole += weight_of(tl, standing[piece->from + k].point);
    for (; count < most && (count < least || sum * piece->ranks < whole * ranks); count++)
        sum += weight_of(tl, standing[piece->from + count].point);
    const struct piece upper = {piece->from + count, piece->count - count, piece->rank + ranks,
                                piece->ranks - ranks};
    piece->count = count;
    piece->ranks = ranks;
    return upper;
}

static void cut_all(const struct tl_model *tl, struct standing *standing, struct piece *piece, size_t ranks)
{
    for (size_t i = 0; i < tl->cloud->points; i++)
        standing[i].point = (uint32_t)i;
    piece[0] = (struct piece){0, tl->cloud->points, 0, ranks};
    for (size_t p = 0, pieces = 1; p < pieces;) {
        if (piece[p].ranks == 1)
            p++;
        else {
            piece[pieces] = cut(tl, standing, &piece[p]);
            pieces++;
        }
    }
}

/* Layers behind a face with a damper belong to the rank of the first one. */
static void keep_layers(const struct tl_model *tl, uint32_t *rank)
{
    for (size_t k = 0; k < tl->dampers.count; k++) {
        const struct tl_damper *damper = &tl->dampers.damper[k];
        for (size_t l = 1; l < damper->layers; l++)
            rank[tl_layer(damper, l)] = rank[damper->point];
    }
}

static bool divide_all(struct tl_model *tl, size_t ranks)
{
    const size_t n = tl->cloud->points;
    struct standing *standing = array_new(n, sizeof *standing);
    struct piece *piece = array_new(ranks, sizeof *piece);
    uint32_t *rank = array_new(n, sizeof *rank);
    bool *mark = array_new(n, sizeof *mark);
    bool room = standing != NULL && piece != NULL && rank != NULL && mark != NULL;
    if (room) cut_all(tl, standing, piece, ranks);
    for (size_t p = 0; room && p < ranks; p++)
        for (size_t k = piece[p].from; k < piece[p].from + piece[p].count; k++)
            rank[standing[k].point] = (uint32_t)piece[p].rank;
    if (room) keep_layers(tl, rank);
    for (size_t r = 0; room && r < ranks; r++) {
        for (size_t i = 0; i < n; i++)
            mark[i] = rank[i] == r;
        room = tl_set_marked(mark, n, &tl->part.owned[r]);
    }
    array_free(standing);
    array_free(piece);
    array_free(rank);
    array_free(mark);
    return room;
}

bool tl_divide(struct tl_model *tl)
{
    enum { LONGEST = 256 }; /* pieces for threads */
    struct tl_part *part = &tl->part;
    const size_t ranks = (size_t)ranks_count(part->ranks), me = (size_t)ranks_me(part->ranks);
    part->owned = array_new(ranks, sizeof *part->owned);
    bool room = part->owned != NULL;
    for (size_t r = 0; room && part->shared && r < ranks; r++)
        room = tl_set_range(part->bound[r], part->bound[r + 1], &part->owned[r]);
    if (room && !part->shared)
        room = ranks > 1 ? divide_all(tl, ranks) : tl_set_range(0, tl->cloud->points, part->owned);
    return room && tl_set_cut(&part->owned[me], tl->cloud->first, LONGEST, &part->own);
}
