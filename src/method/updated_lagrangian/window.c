/* Particles of other ranks that own ones may meet (doc/developers/ranks.md): found anew at each search for neighbours.
 * All tell each other the boxes about their own particles; a rank gives those of its own that lie within reach of
 * another one's box, or whose ghosts do. What comes stands in the order of the body, so that own particles sum over
 * their neighbours in the order of one process. */
#include "base/memory.h"
#include "method/updated_lagrangian/updated_lagrangian.h"

#include <math.h>
#include <string.h>

/* What a particle has for good: place at rest, mass, length. */
enum { LASTING = 5 };

static size_t state_width(const struct updated *updated)
{
    return 2 * (size_t)updated->dimension + 1 + (size_t)updated->stresses;
}

/* Most numbers of a particle that are sent at once. */
static size_t widest(const struct updated *updated)
{
    const size_t width = state_width(updated);
    return width > LASTING ? width : LASTING;
}

/* Sends what is packed, `width` numbers a particle, rank by rank; `to` has room for the particles of others, or of all
 * here. */
static void swap(const struct updated *updated, size_t width, double *to, bool of_all)
{
    const struct updated_part *part = &updated->part;
    const size_t me = (size_t)ranks_me(part->ranks);
    size_t pieces = 0, packed = 0;
    for (size_t r = 0; r < (size_t)ranks_count(part->ranks); r++) {
        const struct updated_partner *with = &part->with[r];
        if (r == me || with->gives + with->gets == 0) continue;
        const size_t at = r > me && !of_all ? with->at - updated->own : with->at;
        part->piece[pieces++] = (struct ranks_piece){.with = (int)r,
                                                     .send = part->sent + packed,
                                                     .receive = to + width * at,
                                                     .send_bytes = width * with->gives * sizeof *to,
                                                     .receive_bytes = width * with->gets * sizeof *to};
        packed += width * with->gives;
    }
    ranks_exchange(part->ranks, pieces, part->piece);
}

/* The k-th own particle's state. */
static double *put_state(const struct updated *updated, const double *y, size_t k, double *to)
{
    const size_t row = k + updated->lead, d = (size_t)updated->dimension,
                 stresses = (size_t)updated->stresses;
    const double *v = y + updated->model.unknowns, *density = v + updated->model.unknowns,
                 *stress = density + updated->held;
    memcpy(to, y + d * row, d * sizeof *to);
    memcpy(to + d, v + d * row, d * sizeof *to);
    to[2 * d] = density[row];
    memcpy(to + 2 * d + 1, stress + stresses * row, stresses * sizeof *to);
    return to + 2 * d + 1 + stresses;
}

void updated_gather(const struct updated *updated, const double *y)
{
    const struct updated_part *part = &updated->part;
    double *to = part->sent;
    for (int r = 0; r < ranks_count(part->ranks); r++)
        for (size_t g = 0; g < part->with[r].gives; g++)
            to = put_state(updated, y, part->with[r].give[g], to);
    swap(updated, state_width(updated), part->arrived, false);
}

void updated_bring(const struct updated *updated, size_t width, double *array)
{
    const struct updated_part *part = &updated->part;
    if (part->ranks == NULL) return;
    double *to = part->sent;
    for (int r = 0; r < ranks_count(part->ranks); r++)
        for (size_t g = 0; g < part->with[r].gives; g++, to += width)
            memcpy(to, array + width * (updated->from + part->with[r].give[g]), width * sizeof *to);
    swap(updated, width, array, true);
}

static size_t source_of(const struct updated *updated, size_t place)
{
    return place < updated->points ? place : updated->ghost[place - updated->points].source;
}

static double search_radius(const struct updated *updated)
{
    return updated->longest * updated->reach + updated->skin;
}

/* Box about places as six numbers, -low and high of each axis. */
static void widen(double box[6], const double *place)
{
    for (size_t a = 0; a < 3; a++) {
        box[2 * a] = fmax(box[2 * a], -place[a]);
        box[2 * a + 1] = fmax(box[2 * a + 1], place[a]);
    }
}

static bool near_box(const double box[6], double radius, const double *place)
{
    bool within = true;
    for (size_t a = 0; a < 3; a++)
        within = within && -place[a] <= box[2 * a] + radius && place[a] <= box[2 * a + 1] + radius;
    return within;
}

/* Together: boxes of all; `mine` holds the ghosts of own particles, too. */
static void share_boxes(const struct updated *updated, double mine[6])
{
    const struct updated_part *part = &updated->part;
    const size_t ranks = (size_t)ranks_count(part->ranks), me = (size_t)ranks_me(part->ranks);
    for (size_t k = 0; k < 6 * ranks; k++)
        part->box[k] = -INFINITY;
    for (size_t i = updated->from; i < updated->from + updated->own; i++)
        widen(part->box + 6 * me, updated->searched + 3 * i);
    memcpy(mine, part->box + 6 * me, 6 * sizeof *mine);
    for (size_t g = 0; g < updated->ghosts; g++)
        if (updated_owns(updated, updated->ghost[g].source))
            widen(mine, updated->searched + 3 * (updated->points + g));
    ranks_largest(part->ranks, 6 * ranks, part->box);
}

static bool boxes_are_near(const double a[6], const double b[6], double radius)
{
    bool within = true;
    for (size_t c = 0; c < 6; c += 2)
        within = within && -a[c] <= b[c + 1] + radius && -b[c] <= a[c + 1] + radius;
    return within;
}

/* Lists the own particles that a rank gets. */
static bool choose(const struct updated *updated, const double mine[6], const double box[6],
                   struct updated_partner *with)
{
    const size_t places = updated->points + updated->ghosts, own = updated->own;
    const double radius = (1 + 1e-9) * search_radius(updated);
    size_t count = 0;
    with->gives = 0;
    if (!boxes_are_near(mine, box, radius)) return true;
    unsigned char *met = array_new(own, 1);
    if (met == NULL) return false;
    for (size_t i = 0; i < places; i++) {
        const size_t k = source_of(updated, i) - updated->from;
        if (k >= own || met[k] != 0 || !near_box(box, radius, updated->searched + 3 * i)) continue;
        met[k] = 1;
        count++;
    }
    if (count > with->room) {
        array_free(with->give);
        with->give = array_new(count, sizeof *with->give);
        with->room = with->give != NULL ? count : 0;
    }
    for (size_t k = 0; k < own && count <= with->room; k++)
        if (met[k] != 0) with->give[with->gives++] = (uint32_t)k;
    array_free(met);
    return count <= with->room;
}

/* Together: how many come from each. */
static void count_particles(struct updated *updated)
{
    const struct updated_part *part = &updated->part;
    const size_t me = (size_t)ranks_me(part->ranks), ranks = (size_t)ranks_count(part->ranks);
    size_t pieces = 0, at = 0;
    for (size_t r = 0; r < ranks; r++)
        if (r != me)
            part->piece[pieces++] = (struct ranks_piece){.with = (int)r,
                                                         .send = &part->with[r].gives,
                                                         .receive = &part->with[r].gets,
                                                         .send_bytes = sizeof part->with[r].gives,
                                                         .receive_bytes = sizeof part->with[r].gets};
    ranks_exchange(part->ranks, pieces, part->piece);
    for (size_t r = 0; r < ranks; r++) {
        if (r == me) updated->from = at;
        part->with[r].at = at;
        at += r == me ? updated->own : part->with[r].gets;
    }
    updated->points = at;
}

/* Memory for particles, whose ghosts are yet to come. */
static bool make_room(struct updated *updated)
{
    struct updated_part *part = &updated->part;
    size_t gives = 0;
    for (int r = 0; r < ranks_count(part->ranks); r++)
        gives += part->with[r].gives;
    double **const arrays[] = {&updated->mass, &updated->length, &updated->reference, &part->sent,
                               &part->arrived};
    const size_t counts[] = {updated->points, updated->points, 3 * updated->points, widest(updated) * gives,
                             widest(updated) * (updated->points - updated->own)};
    bool room = true;
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        array_free(*arrays[k]);
        *arrays[k] = array_new(counts[k], sizeof(double));
        room = room && *arrays[k] != NULL;
    }
    array_free(updated->ghost);
    updated->ghost = NULL;
    updated->ghosts = 0;
    return room;
}

/* Particle i here gets what it has for good. */
static void set_lasting(struct updated *updated, size_t i, const double *lasting)
{
    memcpy(updated->reference + 3 * i, lasting, 3 * sizeof *lasting);
    updated->mass[i] = lasting[3];
    updated->length[i] = lasting[4];
}

static void get_lasting(const struct updated *updated, size_t k, double lasting[LASTING])
{
    const size_t i = updated->made + k;
    memcpy(lasting, updated->cloud->position + 3 * i, 3 * sizeof *lasting);
    lasting[3] = updated->material->density * updated->cloud->volume[i];
    lasting[4] = updated->part.length[i];
}

/* Together. */
static void share_lasting(struct updated *updated)
{
    const struct updated_part *part = &updated->part;
    double own[LASTING], *to = part->sent;
    for (int r = 0; r < ranks_count(part->ranks); r++)
        for (size_t g = 0; g < part->with[r].gives; g++, to += LASTING)
            get_lasting(updated, part->with[r].give[g], to);
    swap(updated, LASTING, part->arrived, false);
    for (size_t i = 0; i < updated->points; i++) {
        const size_t k = i < updated->from ? i : i - updated->own;
        if (updated_owns(updated, i)) get_lasting(updated, i - updated->from, own);
        set_lasting(updated, i, updated_owns(updated, i) ? own : part->arrived + LASTING * k);
    }
}

/* Ghosts of the particles here, and memory for all places. */
static bool make_places(struct updated *updated)
{
    struct messages unheard = {0};
    array_free(updated->searched);
    updated->searched = NULL;
    bool room = updated_ghosts_create(updated, &unheard) == SELAS_OK;
    const size_t places = updated->points + updated->ghosts;
    if (room) updated->searched = array_new(3 * places, sizeof *updated->searched);
    room = room && updated->searched != NULL && updated_take_packed(updated, &unheard) == SELAS_OK &&
           updated_hourglass_room(updated);
    if (room) memcpy(updated->searched, updated->reference, 3 * places * sizeof *updated->searched);
    messages_free(&unheard);
    return room;
}

bool updated_meet(struct updated *updated)
{
    struct updated_part *part = &updated->part;
    bool room = true;
    if (part->ranks == NULL) return true;
    double mine[6];
    share_boxes(updated, mine);
    for (int r = 0; r < ranks_count(part->ranks); r++)
        if (r != ranks_me(part->ranks))
            room = choose(updated, mine, part->box + 6 * r, &part->with[r]) && room;
    count_particles(updated);
    room = updated_all_have(updated, make_room(updated) && room);
    if (room) share_lasting(updated);
    room = room && updated_all_have(updated, make_places(updated));
    part->lost = !room;
    return room;
}

selas_status updated_find_neighbours(struct updated *updated, struct messages *messages)
{
    selas_status status = neighbours_find_some(
        &updated->neighbours, updated->dimension, updated->points + updated->ghosts, updated->searched,
        search_radius(updated), updated->from, updated->from + updated->own, messages);
    if (status == SELAS_OK && updated->ordered) status = updated_merge_lists(updated, messages);
    if (status == SELAS_OK && !updated_hourglass_weights(updated))
        status =
            fail(messages, SELAS_NO_MEMORY, "no memory for hourglass control of %zu particles", updated->own);
    return status;
}

bool updated_search_is_due(const struct updated *updated)
{
    const size_t dimension = (size_t)updated->dimension, step = updated_step(updated);
    const size_t places = updated->points + updated->ghosts;
    const double limit = updated->skin * updated->skin / 4;
    bool moved = updated->neighbours.points != places;
#pragma omp parallel for schedule(static) reduction(|| : moved) if (places >= UPDATED_PARALLEL)
    for (size_t i = 0; i < places; i++) {
        double square = 0;
        for (size_t a = 0; a < dimension; a++) {
            const double d = updated_packed(updated, i)[step * a] - updated->searched[3 * i + a];
            square += d * d;
        }
        moved = moved || square > limit;
    }
    return !updated_all_have(updated, !moved);
}

size_t updated_window_bytes(const struct updated *updated)
{
    const struct updated_part *part = &updated->part;
    size_t bytes = 0;
    for (int r = 0; part->ranks != NULL && r < ranks_count(part->ranks); r++)
        bytes += part->with[r].room * sizeof *part->with[r].give +
                 (part->with[r].gives + (r != ranks_me(part->ranks) ? part->with[r].gets : 0)) *
                     widest(updated) * sizeof(double);
    return bytes;
}
