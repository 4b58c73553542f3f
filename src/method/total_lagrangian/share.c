/* Total-Lagrangian points on ranks (doc/developers/ranks.md, Eq. R3): a rank has points of its own, and a window of
 * points about them, outside of which its state is 0. The forces on own points take A of all points whose gradients
 * they are in, these the H of their partners in hourglass control, and these the displacements of their neighbours:
 * the window is that of three reaches. Rows of weights are those of the whole body, so each sum is over the same
 * numbers in the same order as in one process. */
#include "method/total_lagrangian/total_lagrangian.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Seconds that Eq (R3b) takes of a neighbour in the gradients of a point (measured). */
#define TL_NEIGHBOUR 1.2e-9

/* Marks what stands in the row of a point or site. */
static void mark_row(const struct tl_model *tl, const struct tl_rows *rows, size_t i, bool *mark)
{
    for (size_t k = tl_first(rows, i); k < tl_last(rows, i); k++)
        mark[tl_source(tl, tl_neighbour(rows, i, k))] = true;
}

/* Marks the same of all marked points in `wider`, and these. */
static void mark_rows(const struct tl_model *tl, const struct tl_rows *rows, const bool *mark, bool *wider)
{
    for (size_t i = 0; i < tl->cloud->points; i++) {
        if (!mark[i]) continue;
        wider[i] = true;
        if (rows->of != NULL) mark_row(tl, rows, i, wider);
    }
}

/* What the forces on a rank's own points take: A of points, H of points, displacements of points; marks of all points
 * here. */
struct reach {
    bool *own, *stress, *gradient, *window;
};

static void find_reach(const struct tl_model *tl, struct reach *reach)
{
    const struct tl_set *own = &tl->part.own;
    for (size_t r = 0; r < own->count; r++)
        memset(reach->own + own->range[r].from, true, own->range[r].end - own->range[r].from);
    mark_rows(tl, &tl->transposed, reach->own, reach->stress);
    for (size_t g = 0; g < tl->ghosts; g++)
        if (reach->own[tl->ghost[g].source])
            mark_row(tl, &tl->transposed, tl->cloud->points + g, reach->stress);
    mark_rows(tl, &tl->pair, reach->stress, reach->gradient);
    mark_rows(tl, &tl->gradient, reach->gradient, reach->window);
    mark_rows(tl, &tl->viscous, reach->own, reach->window);
}

/* Where memory is shared, a range: from the first to the last point that is marked, and those that values at places
 * among the own points are taken from, which are within `radius` of them, and their rows. */
static void widen_window(const struct tl_model *tl, bool *window)
{
    const struct tl_part *part = &tl->part;
    const size_t n = tl->cloud->points, *dealt = part->dealt + ranks_me(part->ranks);
    const size_t more = tl_planes_within(tl, tl_probe_radius(tl));
    const size_t low = dealt[0] < more ? 0 : dealt[0] - more;
    const size_t high = part->planes - dealt[1] < more ? part->planes : dealt[1] + more;
    size_t from = part->start[low], end = part->start[high];
    from = from < tl->cloud->first ? 0 : from - tl->cloud->first;
    end = end - tl->cloud->first < n ? end - tl->cloud->first : n;
    for (size_t i = from; i < end; i++) {
        window[i] = true;
        mark_row(tl, &tl->gradient, i, window);
    }
    for (from = 0; !window[from];)
        from++;
    for (end = n; !window[end - 1];)
        end--;
    memset(window + from, true, end - from);
}

/* Adds what a value at a place of the deck is taken from, where the point that weighs most is an own one. What is wrong
 * with the place is told where its probe is made. */
static void widen_to(struct tl_model *tl, const double position[3], const bool *own, bool *window)
{
    struct tl_value value = {0};
    double place[3];
    struct messages unheard = {0};
    body_from_deck(&tl->model.scene->body, position, place);
    const selas_status status = tl_value_at(tl, place, &value, &unheard);
    messages_free(&unheard);
    for (size_t k = 0; status == SELAS_OK && own[value.heaviest] && k < value.count + value.sites; k++) {
        window[value.source[k]] = true;
        mark_row(tl, &tl->gradient, value.source[k], window);
    }
}

/* The same of all receivers and profiles. */
static void widen_to_places(struct tl_model *tl, const bool *own, bool *window)
{
    const struct scene *scene = tl->model.scene;
    for (size_t k = 0; k < scene->receivers; k++)
        widen_to(tl, scene->receiver[k].position, own, window);
    for (size_t p = 0; p < scene->profiles; p++) {
        const struct profile *profile = &scene->profile[p];
        for (size_t k = 0; k < profile->points; k++) {
            double position[3];
            profile_position(profile, k, position);
            widen_to(tl, position, own, window);
        }
    }
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

/* The own window and blocks. */
static bool find_own(struct tl_model *tl, struct reach *reach)
{
    struct tl_part *part = &tl->part;
    struct tl_set *window = &part->window[ranks_me(part->ranks)];
    bool *const marks[] = {reach->own, reach->stress, reach->gradient, reach->window};
    for (size_t k = 0; k < sizeof marks / sizeof *marks; k++)
        if (marks[k] == NULL) return false;
    find_reach(tl, reach);
    if (part->shared) widen_window(tl, reach->window);
    if (!part->shared) widen_to_places(tl, reach->own, reach->window);
    struct tl_set here = {0};
    const bool room = tl_set_marked(reach->window, tl->cloud->points, &here) &&
                      tl_set_cut(&here, (size_t)0 - tl->cloud->first, tl->cloud->whole, window) &&
                      tl_keep_blocks(tl, reach->gradient, false, &tl->gradient_blocks,
                                     part->shared ? NULL : &tl->all_gradients) &&
                      tl_keep_blocks(tl, reach->stress, true, &tl->stress_blocks, NULL) &&
                      tl_keep_blocks(tl, reach->own, false, &tl->force_blocks, NULL);
    tl_set_free(&here);
    return room;
}

/* What goes to each rank and comes from it. */
static bool find_halos(struct tl_model *tl)
{
    struct tl_part *part = &tl->part;
    const size_t ranks = (size_t)ranks_count(part->ranks), me = (size_t)ranks_me(part->ranks),
                 first = tl->cloud->first;
    size_t numbers = 0, most = 0;
    for (size_t r = 0; r < ranks; r++) {
        if (part->owned[r].points > most) most = part->owned[r].points;
        if (r == me) continue;
        struct tl_halo *halo = &part->halo[r];
        if (!tl_set_common(&part->owned[me], &part->window[r], first, &halo->give) ||
            !tl_set_common(&part->owned[r], &part->window[me], first, &halo->get))
            return false;
        numbers += halo->give.points + halo->get.points;
    }
    if (!part->shared && numbers < most) numbers = most;
    part->packed = array_new((size_t)tl->cloud->dimension * numbers, sizeof *part->packed);
    return part->packed != NULL;
}

/* Together, whether this rank has room so far or not. */
static bool share(struct tl_model *tl, bool room, struct reach *reach)
{
    struct tl_part *part = &tl->part;
    const size_t ranks = (size_t)ranks_count(part->ranks);
    part->window = array_new(ranks, sizeof *part->window);
    part->halo = array_new(ranks, sizeof *part->halo);
    part->piece = array_new(ranks, sizeof *part->piece);
    room = room && part->window != NULL && part->halo != NULL && part->piece != NULL && find_own(tl, reach);
    double missing = room ? 0 : 1;
    ranks_largest(part->ranks, 1, &missing);
    room = room && missing == 0;
    for (size_t r = 0; room && r < ranks; r++)
        room = tl_set_spread(part->ranks, (int)r, &part->window[r]);
    return room && find_halos(tl);
}

/* Together: Eq (R3b). */
static void look_ahead(struct tl_model *tl)
{
    struct tl_part *part = &tl->part;
    double own = 0, made = 0, sent = 0, messages = 0;
    for (size_t k = 0; k < part->own.count; k++)
        own += tl_neighbours(tl, part->own.range[k]);
    for (size_t b = 0; b < tl->gradient_blocks.count; b++) {
        const struct tl_block *block = &tl->gradient_blocks.block[b];
        made += tl_neighbours(tl, (struct tl_range){block->first, (size_t)block->first + block->count});
    }
    for (int r = 0; r < ranks_count(part->ranks); r++) {
        sent += (double)(part->halo[r].give.points * sizeof(double)) * tl->cloud->dimension;
        messages += part->halo[r].give.points + part->halo[r].get.points > 0;
    }
    part->outlook = ranks_look_ahead(
        part->ranks, own, TL_NEIGHBOUR / 2 * (made + own) + RANKS_BYTE * sent + RANKS_MESSAGE * messages,
        TL_NEIGHBOUR * part->neighbours);
}

selas_status tl_share_points(struct tl_model *tl, struct messages *messages)
{
    const size_t n = tl->cloud->points;
    count_all(tl);
    bool room = tl_divide(tl);
    if (tl->part.ranks != NULL) {
        struct reach reach = {array_new(n, 1), array_new(n, 1), array_new(n, 1), array_new(n, 1)};
        room = share(tl, room, &reach);
        array_free(reach.own);
        array_free(reach.stress);
        array_free(reach.gradient);
        array_free(reach.window);
    }
    const selas_status status = ranks_agree(tl->part.ranks,
                                            room ? tl_keep_dampers(tl, messages)
                                                 : fail(messages, SELAS_NO_MEMORY, "no memory for the ranks"),
                                            messages);
    if (status == SELAS_OK && tl->part.ranks != NULL) look_ahead(tl);
    return status;
}

void tl_part_free(struct tl_part *part)
{
    for (int r = 0; r < ranks_count(part->ranks); r++) {
        if (part->owned != NULL) tl_set_free(&part->owned[r]);
        if (part->window != NULL) tl_set_free(&part->window[r]);
        if (part->halo != NULL) tl_set_free(&part->halo[r].give);
        if (part->halo != NULL) tl_set_free(&part->halo[r].get);
    }
    tl_set_free(&part->own);
    void *const arrays[] = {part->start,  part->dealt, part->bound, part->owned,
                            part->window, part->halo,  part->piece, part->packed};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        array_free(arrays[k]);
}

void tl_exchange(const struct tl_model *tl, double *a)
{
    const struct tl_part *part = &tl->part;
    const size_t d = (size_t)tl->cloud->dimension, ranks = (size_t)ranks_count(part->ranks);
    size_t pieces = 0, at = 0;
    if (part->ranks == NULL) return;
    for (size_t r = 0; r < ranks; r++) {
        const struct tl_halo *halo = &part->halo[r];
        const size_t give = d * halo->give.points, get = d * halo->get.points;
        if (give + get == 0) continue;
        tl_set_take(&halo->give, d, a, part->packed + at);
        part->piece[pieces++] = (struct ranks_piece){.with = (int)r,
                                                     .send = part->packed + at,
                                                     .receive = part->packed + at + give,
                                                     .send_bytes = give * sizeof *a,
                                                     .receive_bytes = get * sizeof *a};
        at += give + get;
    }
    ranks_exchange(part->ranks, pieces, part->piece);
    for (size_t p = 0; p < pieces; p++)
        tl_set_put(&part->halo[part->piece[p].with].get, d, part->piece[p].receive, a);
}

void tl_complete(struct model *model, double *u)
{
    const struct tl_model *tl = (const struct tl_model *)model;
    const struct tl_part *part = &tl->part;
    const size_t d = (size_t)tl->cloud->dimension;
    for (int r = 0; r < ranks_count(part->ranks); r++) {
        const struct tl_set *owned = &part->owned[r];
        if (r == ranks_me(part->ranks)) tl_set_take(owned, d, u, part->packed);
        ranks_spread(part->ranks, r, part->packed, d * owned->points * sizeof *u);
        tl_set_put(owned, d, part->packed, u);
    }
}

void tl_keep_window(const struct tl_model *tl, double *u)
{
    const struct tl_part *part = &tl->part;
    if (part->ranks == NULL) return;
    const size_t d = (size_t)tl->cloud->dimension, first = tl->cloud->first;
    const struct tl_set *window = &part->window[ranks_me(part->ranks)];
    size_t end = 0;
    for (size_t r = 0; r < window->count; r++) {
        memset(u + d * end, 0, d * (window->range[r].from - first - end) * sizeof *u);
        end = window->range[r].end - first;
    }
    memset(u + d * end, 0, d * (tl->cloud->points - end) * sizeof *u);
}

/* A rank can take stresses at points whose neighbours all are in its window. */
static bool sees(const struct tl_model *tl, size_t rank, size_t count, const size_t *index)
{
    const struct tl_set *window = &tl->part.window[rank];
    const size_t first = tl->cloud->first;
    for (size_t p = 0; p < count; p++) {
        if (!tl_set_has(window, first + index[p])) return false;
        for (size_t k = tl_first(&tl->gradient, index[p]); k < tl_last(&tl->gradient, index[p]); k++)
            if (!tl_set_has(window, first + tl_source(tl, tl_neighbour(&tl->gradient, index[p], k))))
                return false;
    }
    return true;
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

int tl_holder(const struct model *model, size_t point)
{
    const struct tl_part *part = &((const struct tl_model *)model)->part;
    int rank = 0;
    while (point >= part->bound[rank + 1])
        rank++;
    return rank;
}

void tl_share(struct model *model, enum model_array array, struct spread *shares)
{
    const struct tl_model *tl = (const struct tl_model *)model;
    const struct tl_part *part = &tl->part;
    const size_t d = (size_t)tl->cloud->dimension, me = (size_t)ranks_me(part->ranks);
    const struct tl_range *window = part->window[me].range;
    const struct spread_run run =
        spread_line(d * (window->from - tl->cloud->first), d * window->from, d * (window->end - window->from),
                    d * (part->bound[me] - window->from), d * (part->bound[me + 1] - window->from));
    if (array == ARRAY_UNKNOWNS) spread_add(shares, model->unknowns, model->whole_unknowns, &run);
}

/* Adds point i to what is found: the fastest, or the middle of those that are spoiled. */
static void look_at(const struct tl_model *tl, const double *y, size_t i, struct unseen *found,
                    double place[3])
{
    const size_t d = (size_t)tl->cloud->dimension;
    double square = 0, way = 0;
    for (size_t k = d * i; k < d * (i + 1); k++) {
        square += y[tl->model.unknowns + k] * y[tl->model.unknowns + k];
        way += y[k] * y[k];
    }
    const bool spoiled = !isfinite(square + way);
    if (!spoiled && (found->spoiled > 0 || sqrt(square) <= found->speed)) return;
    for (size_t c = 0; c < 3; c++)
        place[c] = (spoiled && found->spoiled > 0 ? place[c] : 0) + tl->deck_position[3 * i + c];
    found->spoiled += spoiled;
    found->speed = spoiled ? INFINITY : sqrt(square);
}

void tl_unseen(struct model *model, const double *y, struct unseen *found)
{
    const struct tl_model *tl = (const struct tl_model *)model;
    const struct tl_set *own = &tl->part.own;
    double place[3] = {0};
    *found = (struct unseen){.speed = -1, .places = own->points};
    for (size_t r = 0; r < own->count; r++)
        for (size_t i = own->range[r].from; i < own->range[r].end; i++)
            look_at(tl, y, i, found, place);
    const double of = found->spoiled > 0 ? (double)found->spoiled : 1;
    snprintf(found->place, sizeof found->place, "%s (%.6g, %.6g, %.6g)", found->spoiled > 0 ? "about" : "at",
             place[0] / of, place[1] / of, place[2] / of);
}

void tl_describe_part(const struct tl_model *tl,
                      void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct tl_part *part = &tl->part;
    if (part->ranks == NULL) return;
    const size_t ranks = (size_t)ranks_count(part->ranks);
    const size_t operators = tl->model.parts > 1 ? tl->model.parts : 1; /* of damped materials */
    char text[200];
    size_t sent = 0;
    int used = snprintf(text, sizeof text, "%zu, points:", ranks);
    for (size_t r = 0; r < ranks && (size_t)used + 24 < sizeof text; r++)
        used += snprintf(text + used, sizeof text - (size_t)used, " %zu", part->owned[r].points);
    tell(context, "ranks", text);
    for (size_t r = 0; r < ranks; r++)
        sent += part->halo[r].give.points;
    snprintf(text, sizeof text, "%zu by the first rank in each operator call (%zu points of its %zu)",
             operators * sent * (size_t)tl->cloud->dimension * sizeof(double), sent, part->owned[0].points);
    tell(context, "halo bytes a step", text);
    snprintf(text, sizeof text, "with %g ns a neighbour", TL_NEIGHBOUR * 1e9);
    ranks_tell_outlook(&part->outlook, text, tell, context);
}
