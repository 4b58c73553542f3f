/* Total-Lagrangian points on ranks (doc/developers/ranks.md, Eq. R3): a rank has a range of the points in their order,
 * its own, and a window about them, outside of which its state is 0. The forces on own points take A of all points
 * whose gradients they are in, these the H of their partners in hourglass control, and these the displacements of
 * their neighbours: the window is that of three reaches. Rows of weights are those of the whole body, so each sum is
 * over the same numbers in the same order as in one process. */
#include "method/total_lagrangian/total_lagrangian.h"

#include "base/memory.h"
#include "parallel/few_ranks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void widen(struct tl_range *range, size_t point)
{
    if (point < range->from) range->from = point;
    if (point >= range->end) range->end = point + 1;
}

/* Adds what stands in the row of a point or site. */
static void add_row(const struct tl_model *tl, const struct tl_rows *rows, size_t i, struct tl_range *range)
{
    for (size_t k = tl_first(rows, i); k < tl_last(rows, i); k++)
        widen(range, tl_source(tl, tl_neighbour(rows, i, k)));
}

static struct tl_range with_rows(const struct tl_model *tl, const struct tl_rows *rows, struct tl_range range)
{
    struct tl_range wider = range;
    for (size_t i = range.from; rows->of != NULL && i < range.end; i++)
        add_row(tl, rows, i, &wider);
    return wider;
}

/* What the forces on a rank's own points take: A of points, H of points, displacements of points. */
struct reach {
    struct tl_range own, stress, gradient, window;
};

static struct reach reach_of(const struct tl_model *tl, size_t from, size_t end)
{
    struct reach reach = {.own = {from, end}};
    reach.stress = with_rows(tl, &tl->transposed, reach.own);
    for (size_t g = 0; g < tl->ghosts; g++)
        if (tl->ghost[g].source >= from && tl->ghost[g].source < end)
            add_row(tl, &tl->transposed, tl->cloud->points + g, &reach.stress);
    reach.gradient = with_rows(tl, &tl->pair, reach.stress);
    reach.window = with_rows(tl, &tl->gradient, reach.gradient);
    const struct tl_range near = with_rows(tl, &tl->viscous, reach.own);
    widen(&reach.window, near.from);
    widen(&reach.window, near.end - 1);
    return reach;
}

/* Blocks that have a site of the range, by the points that they are or mirror. */
static void keep_blocks(const struct tl_model *tl, struct tl_range range, struct tl_blocks *blocks)
{
    size_t kept = 0;
    for (size_t b = 0; b < blocks->count; b++) {
        const struct tl_block *block = &blocks->block[b];
        bool needed = false;
        for (size_t s = block->first; s < (size_t)block->first + block->count; s++)
            needed = needed || (tl_source(tl, s) >= range.from && tl_source(tl, s) < range.end);
        if (needed) blocks->block[kept++] = *block;
    }
    blocks->count = kept;
}

/* The window; where memory is shared, that of places among the own points, too: of the points within `radius` of them,
 * and their rows. */
static struct tl_range window_of(const struct tl_model *tl, const struct reach *reach)
{
    struct tl_range window = reach->window, near = reach->own;
    if (!tl->part.shared) return window;
    const size_t more = tl->part.plane * (size_t)(0.5 + tl_probe_radius(tl) / tl_plane_step(tl));
    near.from -= near.from < more ? near.from : more;
    near.end += tl->cloud->points - near.end < more ? tl->cloud->points - near.end : more;
    near = with_rows(tl, &tl->gradient, near);
    widen(&window, near.from);
    widen(&window, near.end - 1);
    return window;
}

/* Windows of all ranks, told by each where memory is shared. Numbers of points are whole and small enough. */
static void find_windows(struct tl_model *tl, const struct tl_range *own, double *told)
{
    struct tl_part *part = &tl->part;
    const size_t ranks = (size_t)ranks_count(part->ranks), me = (size_t)ranks_me(part->ranks);
    for (size_t r = 0; r < ranks; r++) {
        struct tl_range window = *own;
        if (!part->shared) window = reach_of(tl, part->bound[r], part->bound[r + 1]).window;
        if (part->shared && r != me) continue;
        told[2 * r] = (double)(tl->cloud->first + window.from);
        told[2 * r + 1] = (double)(tl->cloud->first + window.end);
    }
    if (part->shared) ranks_largest(part->ranks, 2 * ranks, told);
    for (size_t k = 0; k < 2 * ranks; k++)
        part->window[k] = (size_t)told[k];
}

/* What describe() tells. */
static void count_all(struct tl_model *tl)
{
    struct tl_part *part = &tl->part;
    const struct tl_range range = tl_summed(tl);
    double counts[2] = {tl_neighbours(tl, range), 0};
    for (size_t g = 0; g < tl->ghosts; g++)
        counts[1] += tl->ghost[g].source >= range.from && tl->ghost[g].source < range.end;
    if (part->shared) ranks_sum(part->ranks, 2, counts);
    part->neighbours = counts[0];
    part->ghosts = counts[1];
}

selas_status tl_share_points(struct tl_model *tl, struct messages *messages)
{
    struct tl_part *part = &tl->part;
    count_all(tl);
    if (part->ranks == NULL) return SELAS_OK;
    double *told = array_new(2 * (size_t)ranks_count(part->ranks), sizeof *told);
    const selas_status status = tl_agree(
        tl, told != NULL ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory for the ranks"), messages);
    if (status == SELAS_OK && told != NULL) {
        const struct reach reach = reach_of(tl, part->own, part->end);
        const struct tl_range window = window_of(tl, &reach);
        find_windows(tl, &window, told);
        keep_blocks(tl, reach.gradient, &tl->gradient_blocks);
        keep_blocks(tl, reach.stress, &tl->stress_blocks);
        keep_blocks(tl, reach.own, &tl->force_blocks);
    }
    array_free(told);
    return status;
}

void tl_part_free(struct tl_part *part)
{
    array_free(part->bound);
    array_free(part->window);
    array_free(part->piece);
}

/* Own points of rank `from` in the window of rank `to`. */
static struct tl_range halo(const struct tl_part *part, size_t from, size_t to)
{
    const size_t low = part->bound[from] > part->window[2 * to] ? part->bound[from] : part->window[2 * to];
    const size_t high =
        part->bound[from + 1] < part->window[2 * to + 1] ? part->bound[from + 1] : part->window[2 * to + 1];
    return (struct tl_range){low, high > low ? high : low};
}

void tl_exchange(const struct tl_model *tl, double *a)
{
    const struct tl_part *part = &tl->part;
    const size_t d = (size_t)tl->cloud->dimension, me = (size_t)ranks_me(part->ranks),
                 first = tl->cloud->first;
    size_t pieces = 0;
    for (size_t r = 0; part->ranks != NULL && r < (size_t)ranks_count(part->ranks); r++) {
        const struct tl_range give = halo(part, me, r), get = halo(part, r, me);
        if (r == me || (give.end == give.from && get.end == get.from)) continue;
        part->piece[pieces++] = (struct ranks_piece){.with = (int)r,
                                                     .send = a + d * (give.from - first),
                                                     .receive = a + d * (get.from - first),
                                                     .send_bytes = d * (give.end - give.from) * sizeof *a,
                                                     .receive_bytes = d * (get.end - get.from) * sizeof *a};
    }
    ranks_exchange(part->ranks, pieces, part->piece);
}

/* The window of a rank among the points of this one. */
static struct tl_range window_here(const struct tl_model *tl, size_t rank)
{
    const size_t *window = tl->part.window + 2 * rank, first = tl->cloud->first;
    return (struct tl_range){window[0] - first, window[1] - first};
}

void tl_keep_window(const struct tl_model *tl, double *u)
{
    if (tl->part.ranks == NULL) return;
    const size_t d = (size_t)tl->cloud->dimension;
    const struct tl_range window = window_here(tl, (size_t)ranks_me(tl->part.ranks));
    memset(u, 0, d * window.from * sizeof *u);
    memset(u + d * window.end, 0, d * (tl->cloud->points - window.end) * sizeof *u);
}

/* A rank can take stresses at points whose neighbours all are in its window. */
static bool sees(const struct tl_model *tl, size_t rank, size_t count, const size_t *index)
{
    const struct tl_range window = window_here(tl, rank);
    struct tl_range range = {index[0], index[0] + 1};
    for (size_t k = 0; k < count; k++) {
        widen(&range, index[k]);
        add_row(tl, &tl->gradient, index[k], &range);
    }
    return range.from >= window.from && range.end <= window.end;
}

selas_status tl_find_holder(const struct tl_model *tl, size_t count, const size_t *index, int *holder,
                            struct messages *messages)
{
    const size_t me = (size_t)ranks_me(tl->part.ranks);
    const size_t ranks = tl->part.shared ? me + 1 : (size_t)ranks_count(tl->part.ranks);
    size_t rank = tl->part.shared ? me : 0;
    while (tl->part.ranks != NULL && rank < ranks && !sees(tl, rank, count, index))
        rank++;
    *holder = (int)rank;
    if (rank < ranks) return SELAS_OK;
    const double *place = tl->deck_position + 3 * index[0];
    return fail(messages, SELAS_UNSUPPORTED,
                "the points about (%g, %g, %g), from which a value is taken, are on no rank together: take "
                "fewer ranks",
                place[0], place[1], place[2]);
}

int tl_holder(const struct model *model, size_t plane)
{
    const struct tl_part *part = &((const struct tl_model *)model)->part;
    const size_t points = model->grid[0] > 0 ? part->plane : 1;
    int rank = 0;
    while (plane * points >= part->bound[rank + 1])
        rank++;
    return rank;
}

void tl_share(struct model *model, enum model_array array, struct spread *shares)
{
    const struct tl_model *tl = (const struct tl_model *)model;
    const struct tl_part *part = &tl->part;
    const size_t d = (size_t)tl->cloud->dimension;
    const struct tl_range window = window_here(tl, (size_t)ranks_me(part->ranks));
    const struct spread_run run = {d * window.from, d * (tl->cloud->first + window.from),
                                   d * (window.end - window.from), d * (part->own - window.from),
                                   d * (part->end - window.from)};
    if (array == ARRAY_UNKNOWNS) spread_add(shares, model->unknowns, model->whole_unknowns, &run);
}

/* The fastest of the own points, or the middle of those that are spoiled. */
void tl_unseen(struct model *model, const double *y, struct unseen *found)
{
    const struct tl_model *tl = (const struct tl_model *)model;
    const size_t d = (size_t)tl->cloud->dimension;
    double place[3] = {0};
    *found = (struct unseen){.speed = -1, .places = tl->part.end - tl->part.own};
    for (size_t i = tl->part.own; i < tl->part.end; i++) {
        double square = 0, way = 0;
        for (size_t k = d * i; k < d * (i + 1); k++) {
            square += y[model->unknowns + k] * y[model->unknowns + k];
            way += y[k] * y[k];
        }
        const bool spoiled = !isfinite(square + way);
        if (!spoiled && (found->spoiled > 0 || sqrt(square) <= found->speed)) continue;
        for (size_t c = 0; c < 3; c++)
            place[c] = (spoiled && found->spoiled > 0 ? place[c] : 0) + tl->deck_position[3 * i + c];
        found->spoiled += spoiled;
        found->speed = spoiled ? INFINITY : sqrt(square);
    }
    const double of = found->spoiled > 0 ? (double)found->spoiled : 1;
    snprintf(found->place, sizeof found->place, "%s (%.6g, %.6g, %.6g)", found->spoiled > 0 ? "about" : "at",
             place[0] / of, place[1] / of, place[2] / of);
}

void tl_describe_part(const struct tl_model *tl,
                      void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct tl_part *part = &tl->part;
    if (part->ranks == NULL) return;
    const size_t ranks = (size_t)ranks_count(part->ranks), me = (size_t)ranks_me(part->ranks);
    const size_t operators = tl->model.parts > 1 ? tl->model.parts : 1; /* of damped materials */
    char text[200];
    size_t sent = 0;
    int used = snprintf(text, sizeof text, "%zu, points:", ranks);
    for (size_t r = 0; r < ranks && (size_t)used + 24 < sizeof text; r++)
        used +=
            snprintf(text + used, sizeof text - (size_t)used, " %zu", part->bound[r + 1] - part->bound[r]);
    tell(context, "ranks", text);
    for (size_t r = 0; r < ranks; r++)
        if (r != me) sent += halo(part, me, r).end - halo(part, me, r).from;
    snprintf(text, sizeof text, "%zu by the first rank in each operator call (%zu points of its %zu)",
             operators * sent * (size_t)tl->cloud->dimension * sizeof(double), sent,
             part->bound[1] - part->bound[0]);
    tell(context, "halo bytes a step", text);
}
