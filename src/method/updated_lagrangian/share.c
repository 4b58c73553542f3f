/* Updated-Lagrangian particles on ranks (doc/developers/ranks.md): a rank owns a range of the body's particles, has
 * them in its state, and works out their rates. Those that they meet come from the ranks that own them (window.c). The
 * state has particles besides that values at receivers are taken from, whose rates come the same way. Each sum is over
 * the same numbers in the same order as in one process. */
#include "base/memory.h"
#include "base/vectors.h"
#include "method/updated_lagrangian/updated_lagrangian.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Components of the rates that follow from sums over neighbours: acceleration, density, stress. */
enum { SUMMED = 3 };
/* Seconds that Eq (R9b) takes of a neighbour of an own particle, and of any particle here (measured). */
#define NEIGHBOUR 4.5e-9
#define PARTICLE 18e-9

bool updated_all_have(const struct updated *updated, bool mine)
{
    double missing = mine ? 0 : 1;
    ranks_largest(updated->part.ranks, 1, &missing);
    return missing == 0;
}

selas_status updated_agree(const struct updated *updated, selas_status status, struct messages *messages)
{
    return ranks_agree(updated->part.ranks, status, messages);
}

static double one(const void *context, size_t place)
{
    (void)context;
    (void)place;
    return 1;
}

/* Deals out `points` particles in units that stay together. */
static selas_status deal(struct updated *updated, size_t points, size_t unit, const char *what,
                         struct messages *messages)
{
    struct updated_part *part = &updated->part;
    const size_t units = (points + unit - 1) / unit;
    selas_status status = ranks_at_most(part->ranks, units, what, messages);
    if (status != SELAS_OK) return status;
    const size_t ranks = (size_t)ranks_count(part->ranks), me = (size_t)ranks_me(part->ranks);
    part->bound = array_new(ranks + 1, sizeof *part->bound);
    part->held = array_new(2 * ranks, sizeof *part->held);
    part->with = array_new(ranks, sizeof *part->with);
    part->piece = array_new(SUMMED * ranks, sizeof *part->piece);
    part->box = array_new(6 * ranks, sizeof *part->box);
    if (part->bound == NULL || part->held == NULL || part->with == NULL || part->piece == NULL ||
        part->box == NULL)
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
    status = updated_agree(updated, status, messages);
    if (status != SELAS_OK || part->bound == NULL) return status;
    ranks_deal(units, one, NULL, ranks, part->bound);
    for (size_t r = 0; r <= ranks; r++)
        part->bound[r] = unit * part->bound[r] < points ? unit * part->bound[r] : points;
    updated->own = part->bound[me + 1] - part->bound[me];
    return SELAS_OK;
}

static double plane_step(const struct scene *scene, const size_t grid[3])
{
    const int last = scene->dimension - 1;
    return (scene->body.high[last] - scene->body.low[last]) / (double)grid[last];
}

/* Planes over the last axis within a radius of one. */
static size_t planes_within(const struct scene *scene, const size_t grid[3], double radius)
{
    return 1 +
           (size_t)ceil((radius + 2 * scene->body.jitter * scene->body.spacing) / plane_step(scene, grid));
}

/* Makes the planes of the own particles, and those beside them that hold neighbours at rest of these and of the seven
 * behind them, and what receivers there see. */
static selas_status make_planes(struct updated *updated, const size_t grid[3], struct messages *messages)
{
    const struct scene *scene = updated->model.scene;
    const struct updated_part *part = &updated->part;
    const size_t last = grid[scene->dimension - 1], plane = grid[0] * grid[1] * grid[2] / last,
                 me = (size_t)ranks_me(part->ranks);
    const double reach =
        updated->options.kernel->support * updated->options.smoothing_length * scene->body.spacing;
    const bool seen = scene->receivers + scene->profiles > 0 || model_is_watched(&updated->model);
    const size_t beside =
        planes_within(scene, grid, (seen ? 1.75 : 1) * reach + UPDATED_SKIN * scene->body.spacing) +
        cloud_margin(scene);
    const size_t from = part->bound[me] / plane, end = (part->bound[me + 1] + GROUP - 2) / plane + 1 + beside;
    return cloud_create_planes(scene, from > beside ? from - beside : 0, end < last ? end : last,
                               &updated->cloud, messages);
}

selas_status updated_make_points(struct updated *updated, struct messages *messages)
{
    const struct scene *scene = updated->model.scene;
    struct updated_part *part = &updated->part;
    size_t grid[3];
    selas_status status;
    if (ranks_count(scene->ranks) == 1) {
        if (updated->cloud == NULL && (status = cloud_create(scene, &updated->cloud, messages)) != SELAS_OK)
            return status;
        updated->own = updated->points = updated->held = updated->cloud->points;
        return SELAS_OK;
    }
    part->ranks = scene->ranks;
    part->planes = updated->cloud == NULL && cloud_in_planes(scene, grid);
    if (part->planes) {
        status = deal(updated, grid[0] * grid[1] * grid[2], grid[0], "rows of particles", messages);
        if (status == SELAS_OK) status = make_planes(updated, grid, messages);
    } else {
        status = updated->cloud == NULL ? cloud_create(scene, &updated->cloud, messages) : SELAS_OK;
        status = updated_agree(updated, status, messages);
        if (status == SELAS_OK)
            status = deal(updated, updated->cloud->points, UPDATED_BLOCK, "blocks of 32 particles", messages);
    }
    if (status != SELAS_STOPPED) status = updated_agree(updated, status, messages);
    if (status != SELAS_OK || updated->cloud == NULL) return status;
    updated->points = updated->cloud->points;
    updated->first = part->bound[ranks_me(part->ranks)];
    updated->from = updated->made = updated->first - updated->cloud->first;
    updated->held = updated->own;
    return SELAS_OK;
}

int updated_holder(const struct model *model, size_t point)
{
    const struct updated_part *part = &((const struct updated *)model)->part;
    int rank = 0;
    while (point >= part->bound[rank + 1])
        rank++;
    return rank;
}

int updated_owner(const struct updated *updated, const double place[3])
{
    const struct scene *scene = updated->model.scene;
    const struct cloud *cloud = updated->cloud;
    size_t nearest = 0, grid[3];
    double least = INFINITY;
    if (updated->part.planes && cloud_in_planes(scene, grid)) {
        for (int c = scene->dimension - 1; c > 0; c--) {
            const double low = scene->body.low[c], size = scene->body.high[c] - low;
            const double row = floor((place[c] - low) / size * (double)grid[c]);
            nearest = grid[c] * nearest + (size_t)fmin(fmax(row, 0), (double)grid[c] - 1);
        }
        return updated_holder(&updated->model, grid[0] * nearest);
    }
    for (size_t i = 0; i < cloud->points; i++) {
        double square = 0;
        for (size_t a = 0; a < 3; a++)
            square += pow(cloud->position[3 * i + a] - place[a], 2);
        if (square < least) nearest = i;
        least = fmin(least, square);
    }
    return updated_holder(&updated->model, nearest);
}

/* Adds what a probe at a place takes values from, if this rank is to have it. What is wrong with the place is told
 * where the probe is made. */
static void widen_to(const struct updated *updated, const double position[3], size_t range[2])
{
    double place[3];
    size_t from, end;
    struct messages unheard = {0};
    body_from_deck(&updated->model.scene->body, position, place);
    if (updated_owner(updated, place) == ranks_me(updated->part.ranks) &&
        updated_reads(updated, position, &from, &end, &unheard) == SELAS_OK) {
        range[0] = from < range[0] ? from : range[0];
        range[1] = end > range[1] ? end : range[1];
    }
    messages_free(&unheard);
}

/* Adds what is watched for rotations. */
static void widen_to_watched(const struct updated *updated, size_t range[2])
{
    const struct scene *scene = updated->model.scene;
    for (size_t k = 0; k < MODEL_WATCHED; k++) {
        const size_t point = model_watched(updated->cloud->whole, k);
        double position[3];
        if (updated->part.planes)
            cloud_place(scene, point, position);
        else
            body_to_deck(&scene->body, updated->cloud->position + 3 * point, position);
        widen_to(updated, position, range);
    }
}

void updated_share(struct updated *updated)
{
    struct updated_part *part = &updated->part;
    const struct scene *scene = updated->model.scene;
    const size_t own = updated->first;
    size_t range[2] = {own, own + updated->own};
    if (part->ranks == NULL) return;
    if (model_is_watched(&updated->model)) widen_to_watched(updated, range);
    for (size_t k = 0; k < scene->receivers; k++)
        widen_to(updated, scene->receiver[k].position, range);
    for (size_t p = 0; p < scene->profiles; p++)
        for (size_t k = 0; k < scene->profile[p].points; k++) {
            double position[3];
            profile_position(&scene->profile[p], k, position);
            widen_to(updated, position, range);
        }
    updated->first = range[0];
    updated->lead = own - range[0];
    updated->held = range[1] - range[0];
    for (size_t r = 0; r < (size_t)ranks_count(part->ranks); r++) {
        if (r == (size_t)ranks_me(part->ranks)) memcpy(part->held + 2 * r, range, sizeof range);
        ranks_spread(part->ranks, (int)r, part->held + 2 * r, sizeof range);
    }
}

void updated_part_free(struct updated_part *part)
{
    for (int r = 0; part->with != NULL && r < ranks_count(part->ranks); r++)
        array_free(part->with[r].give);
    void *const arrays[] = {part->bound, part->held, part->length, part->with,
                            part->piece, part->box,  part->sent,   part->arrived};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        array_free(arrays[k]);
}

void updated_spread(struct model *model, enum model_array array, struct spread *shares)
{
    const struct updated *updated = updated_of(model);
    const size_t widths[2] = {array == ARRAY_UNKNOWNS ? (size_t)updated->dimension : 1,
                              (size_t)updated->stresses};
    for (size_t k = 0; k < (array == ARRAY_UNKNOWNS ? 1 : 2); k++) {
        const size_t d = widths[k], held = d * updated->held, lead = d * updated->lead;
        const struct spread_run run = spread_line(0, d * updated->first, held, lead, lead + d * updated->own);
        spread_add(shares, held, d * updated->cloud->whole, &run);
    }
}

/* Particles of one rank's own that are in another one's state, by their number in the body. */
static size_t common(const struct updated_part *part, size_t owner, size_t other, size_t *from)
{
    const size_t *own = part->bound + owner, *held = part->held + 2 * other;
    const size_t end = own[1] < held[1] ? own[1] : held[1];
    *from = own[0] > held[0] ? own[0] : held[0];
    return end > *from ? end - *from : 0;
}

void updated_exchange(const struct updated *updated, double *dydt)
{
    const struct updated_part *part = &updated->part;
    const size_t unknowns = updated->model.unknowns, me = (size_t)ranks_me(part->ranks);
    const size_t width[SUMMED] = {(size_t)updated->dimension, 1, (size_t)updated->stresses};
    double *const array[SUMMED] = {dydt + unknowns, dydt + 2 * unknowns, dydt + 2 * unknowns + updated->held};
    size_t pieces = 0;
    for (size_t r = 0; part->ranks != NULL && r < (size_t)ranks_count(part->ranks); r++) {
        size_t mine, theirs;
        const size_t gives = common(part, me, r, &mine), gets = common(part, r, me, &theirs);
        if (r == me || gives + gets == 0) continue;
        mine -= updated->first;
        theirs -= updated->first;
        for (size_t k = 0; k < SUMMED; k++)
            part->piece[pieces++] =
                (struct ranks_piece){.with = (int)r,
                                     .send = gives > 0 ? array[k] + width[k] * mine : NULL,
                                     .receive = gets > 0 ? array[k] + width[k] * theirs : NULL,
                                     .send_bytes = width[k] * gives * sizeof(double),
                                     .receive_bytes = width[k] * gets * sizeof(double)};
    }
    if (part->ranks != NULL) ranks_exchange(part->ranks, pieces, part->piece);
}

/* Sent in an evaluation: numbers and messages. */
static size_t numbers_sent(const struct updated *updated, size_t *messages)
{
    const struct updated_part *part = &updated->part;
    const size_t d = (size_t)updated->dimension, stresses = (size_t)updated->stresses,
                 me = (size_t)ranks_me(part->ranks), moved = 2 * d + 1 + stresses,
                 turns = updated->hourglass != NULL ? 2 * d * d : 0;
    size_t numbers = 0, none;
    *messages = 0;
    for (size_t r = 0; r < (size_t)ranks_count(part->ranks); r++) {
        if (r == me) continue;
        const size_t shown = common(part, me, r, &none);
        numbers += part->with[r].gives * (moved + turns) + shown * (d + 1 + stresses);
        if (part->with[r].gives + part->with[r].gets > 0) *messages += turns > 0 ? 3 : 1;
        if (shown + common(part, r, me, &none) > 0) *messages += SUMMED;
    }
    return numbers;
}

void updated_look_ahead(struct updated *updated)
{
    struct updated_part *part = &updated->part;
    size_t messages;
    const double here = (double)updated->points, own = (double)updated->neighbours.start[updated->points];
    updated->pairs = own;
    if (part->ranks == NULL) return;
    ranks_sum(part->ranks, 1, &updated->pairs);
    const double sent = (double)(numbers_sent(updated, &messages) * sizeof(double));
    part->outlook = ranks_look_ahead(part->ranks, own,
                                     NEIGHBOUR * own + PARTICLE * here + RANKS_BYTE * sent +
                                         RANKS_MESSAGE * (double)(messages + 1),
                                     NEIGHBOUR * updated->pairs + PARTICLE * (double)updated->cloud->whole);
}

void updated_describe_part(const struct updated *updated,
                           void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct updated_part *part = &updated->part;
    if (part->ranks == NULL) return;
    const size_t ranks = (size_t)ranks_count(part->ranks);
    char text[200];
    size_t messages;
    int used = snprintf(text, sizeof text, "%zu, particles:", ranks);
    for (size_t r = 0; r < ranks && (size_t)used + 24 < sizeof text; r++)
        used +=
            snprintf(text + used, sizeof text - (size_t)used, " %zu", part->bound[r + 1] - part->bound[r]);
    tell(context, "ranks", text);
    size_t met = 0;
    for (size_t r = 0; r < ranks; r++)
        met += part->with[r].gives;
    snprintf(text, sizeof text,
             "%zu by the first rank in each evaluation (%zu of its particles, which others may meet)",
             numbers_sent(updated, &messages) * sizeof(double), met);
    tell(context, "halo bytes a step", text);
    snprintf(text, sizeof text, "with %g ns a neighbour, %g ns a particle", NEIGHBOUR * 1e9, PARTICLE * 1e9);
    ranks_tell_outlook(&part->outlook, text, tell, context);
}
