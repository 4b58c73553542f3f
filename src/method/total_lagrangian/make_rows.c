/* The rows of weights of all kinds, in their order. On a lattice nearly every point has the row of the one below it,
 * down to the first planes of the body (rows.c). A part of the body that does not begin with these takes rows from
 * them: they are made besides, and freed when all rows are there. So its rows are those of the whole body, bit for
 * bit. */
#include "method/total_lagrangian/setup.h"

#include "base/memory.h"

#include <math.h>

enum kind { GRADIENT, TRANSPOSED, PAIR, VISCOUS, KINDS };

static struct tl_rows *rows_of(struct tl_model *tl, enum kind kind)
{
    struct tl_rows *const rows[KINDS] = {&tl->gradient, &tl->transposed, &tl->pair, &tl->viscous};
    return rows[kind];
}

static struct tl_range made(const struct tl_model *tl, enum kind kind)
{
    const struct tl_range range[KINDS] = {tl->part.gradient, tl->part.transposed, tl->part.pair,
                                          tl->part.pair};
    return range[kind];
}

/* The ghost of a model that stands at a place; tl->sites if there is none. */
static size_t ghost_at(struct tl_making *making, const double place[3])
{
    const struct tl_model *tl = making->tl;
    const size_t found = neighbours_within(&making->near, place, 1e-3 * tl->cloud->spacing, making->work.room,
                                           making->work.near);
    for (size_t k = 0; k < found && k < making->work.room; k++)
        if (making->work.near[k] >= tl->cloud->points) return making->work.near[k];
    return tl->sites;
}

/* Gives point i the row of point q of the first planes, as a new one. */
static bool copy_row(struct tl_making *making, struct tl_rows *rows, size_t i, const struct tl_model *below,
                     const struct tl_rows *there, size_t q)
{
    const struct tl_model *tl = making->tl;
    static const struct tl_like none = {0};
    for (size_t k = tl_first(there, q); k < tl_last(there, q); k++) {
        const size_t of_q = tl_neighbour(there, q, k);
        size_t of_i = i + of_q - q;
        if (of_q >= below->cloud->points) {
            double place[3];
            for (size_t c = 0; c < 3; c++)
                place[c] = tl->site_position[3 * i + c] +
                           (below->site_position[3 * of_q + c] - below->site_position[3 * q + c]);
            of_i = ghost_at(making, place);
            if (of_i == tl->sites) of_i = i;
        }
        if (!tl_rows_add(rows, i, of_i, there->weight + there->width * k)) return false;
    }
    return tl_rows_close(rows, i, &none, NULL, 0);
}

/* First point of a plane of the body. */
static size_t plane_at(const struct tl_model *tl, size_t number)
{
    return number * tl->part.plane - tl->cloud->first;
}

/* The plane `to` of a part takes the rows of the plane `from` of another one (planes of the body). */
static selas_status take_plane(struct tl_making *making, size_t to, const struct tl_making *other,
                               size_t from, enum kind kind, struct messages *messages)
{
    struct tl_model *tl = making->tl;
    struct tl_rows *rows = rows_of(tl, kind);
    const struct tl_rows *there = rows_of(other->tl, kind);
    const size_t first = plane_at(tl, to), like = plane_at(other->tl, from);
    uint32_t *taken = array_new(there->rows, sizeof *taken); /* 1 + the number of a row here */
    bool room = taken != NULL;
    for (size_t k = 0; room && k < tl->part.plane; k++) {
        uint32_t *number = &taken[there->of[like + k]];
        if (*number == 0) {
            room = copy_row(making, rows, first + k, other->tl, there, like + k);
            *number = rows->of[first + k] + 1;
        }
        rows->of[first + k] = *number - 1;
    }
    array_free(taken);
    return room ? SELAS_OK : tl_no_memory(tl, messages);
}

static selas_status begin(struct tl_making *making, struct tl_model *tl, struct messages *messages)
{
    making->tl = tl;
    const int d = tl->cloud->dimension;
    const double most = tl_search_radius(tl), usual = most / 1.5;
    const selas_status status = tl_make_ghosts(tl, most, messages);
    if (status != SELAS_OK) return status;
    if (tl->sites > INT32_MAX / 3)
        return fail(messages, SELAS_UNSUPPORTED, "%zu points are more than this method can number",
                    tl->sites);
    if (!tl_work_allocate(&making->work, 256)) return tl_no_memory(tl, messages);
    return tl->options.form != NULL
               ? neighbours_find(&making->near, d, tl->sites, tl->site_position, most, true, messages)
               : neighbours_cells(&making->near, d, tl->sites, tl->site_position, usual, messages);
}

static bool begin_rows(struct tl_model *tl, enum kind kind)
{
    const size_t d = (size_t)tl->cloud->dimension, width[KINDS] = {d, d, 1, 2};
    struct tl_rows *rows = rows_of(tl, kind);
    static const struct tl_like none = {0};
    if (!tl_rows_begin(rows, (int)d, kind == TRANSPOSED ? tl->sites : tl->cloud->points, width[kind]))
        return false;
    if (kind == VISCOUS) tl->site_v = array_new(d * tl->sites, sizeof(double));
    /* the row of points of a part that have none */
    return (kind != VISCOUS || tl->site_v != NULL) &&
           (!tl->part.shared || tl_rows_close(rows, 0, &none, NULL, 0));
}

static selas_status fill(struct tl_making *making, enum kind kind, struct messages *messages)
{
    static selas_status (*const fills[KINDS])(struct tl_making *, struct messages *) = {
        tl_fill_gradient, tl_transpose, tl_make_hourglass, tl_make_viscosity};
    const struct tl_form *form = making->tl->options.form;
    return kind == GRADIENT && form != NULL ? form->gradients(making->tl, &making->near, messages)
                                            : fills[kind](making, messages);
}

static void end(struct tl_making *making)
{
    neighbours_free(&making->near);
    tl_work_free(&making->work);
    *making = (struct tl_making){0};
}

/* One more part of the body beside one with rows of a kind up to the plane `from` (and not it): with those of
 * from .. last. */
static selas_status climb(const struct tl_model *tl, struct tl_making *reached, size_t from, size_t last,
                          enum kind kind, struct messages *messages)
{
    struct tl_making next = {0};
    struct tl_model *part = NULL;
    const size_t more = tl->part.reach + 1;
    selas_status status = tl_make_beside(tl, from - more, last + 1 + more, &part, messages);
    if (status == SELAS_OK) {
        part->part.pair = (struct tl_range){plane_at(part, from), plane_at(part, last + 1)};
        status = begin(&next, part, messages);
    }
    if (status == SELAS_OK && !begin_rows(part, kind)) status = tl_no_memory(tl, messages);
    if (status == SELAS_OK) status = take_plane(&next, from - 1, reached, from - 1, kind, messages);
    if (status == SELAS_OK) status = fill(&next, kind, messages);
    struct tl_model *old = reached->tl;
    end(reached);
    tl_free(old);
    next.tl = part;
    *reached = next;
    return status;
}

/* Rows of pairs of several materials hang on what is below them, plane by plane: the plane `wanted` gets those of
 * parts of the body that are made one after the other from its bottom on. */
static selas_status take_from_all_below(struct tl_making *making, size_t wanted, enum kind kind,
                                        struct messages *messages)
{
    struct tl_making reached = {0};
    struct tl_model *tl = making->tl, *first = NULL;
    selas_status status = tl_make_below(tl, &first, messages);
    if (status == SELAS_OK) status = begin(&reached, first, messages);
    if (status == SELAS_OK && !begin_rows(first, kind)) status = tl_no_memory(tl, messages);
    if (status == SELAS_OK) status = fill(&reached, kind, messages);
    reached.tl = first;
    size_t up = first != NULL ? first->part.pair.end / tl->part.plane : 0; /* planes that have rows */
    while (status == SELAS_OK && up <= wanted) {
        const size_t last = up + tl->part.layers < wanted ? up + tl->part.layers : wanted;
        status = climb(tl, &reached, up, last, kind, messages);
        up = last + 1;
    }
    if (status == SELAS_OK) status = take_plane(making, wanted, &reached, wanted, kind, messages);
    struct tl_model *old = reached.tl;
    end(&reached);
    tl_free(old);
    return status;
}

/* Rows of one kind of the part and, if there are any, of the first planes. */
static selas_status make(struct tl_making *making, struct tl_making *below, enum kind kind,
                         struct messages *messages)
{
    struct tl_model *tl = making->tl;
    const size_t under = (tl->cloud->first + made(tl, kind).from) / tl->part.plane - 1; /* of a lattice */
    const bool of_materials = (kind == PAIR || kind == VISCOUS) && tl->model.scene->materials > 1;
    selas_status status = begin_rows(tl, kind) ? SELAS_OK : tl_no_memory(tl, messages);
    if (status == SELAS_OK && below->tl != NULL && of_materials)
        status = take_from_all_below(making, under, kind, messages);
    if (status == SELAS_OK && below->tl != NULL && !of_materials) {
        status = begin_rows(below->tl, kind) ? fill(below, kind, messages) : tl_no_memory(tl, messages);
        if (status == SELAS_OK) status = take_plane(making, under, below, tl->part.layers, kind, messages);
    }
    return status == SELAS_OK ? fill(making, kind, messages) : status;
}

/* Ghosts of each point that has some. */
static selas_status return_rows(struct tl_model *tl, struct messages *messages)
{
    const size_t n = tl->cloud->points;
    uint32_t *count = array_new(n + 1, sizeof *count);
    bool room = count != NULL;
    for (size_t g = 0; room && g < tl->ghosts; g++)
        tl->sources += count[tl->ghost[g].source]++ == 0;
    tl->source = array_new(tl->sources, sizeof *tl->source);
    tl->returned_start = array_new(tl->sources + 1, sizeof *tl->returned_start);
    tl->returned = array_new(tl->ghosts, sizeof *tl->returned);
    room = room && tl->source != NULL && tl->returned_start != NULL && tl->returned != NULL;
    for (size_t i = 0, s = 0; room && i < n; i++) {
        if (count[i] == 0) continue;
        tl->source[s] = i;
        tl->returned_start[s + 1] = tl->returned_start[s] + count[i];
        count[i] = (uint32_t)s++;
    }
    for (size_t g = 0; room && g < tl->ghosts; g++)
        tl->returned[tl->returned_start[count[tl->ghost[g].source]]++] = (uint32_t)g;
    for (size_t s = tl->sources; room && s > 0; s--) /* moved on while filling, and now back */
        tl->returned_start[s] = tl->returned_start[s - 1];
    if (room) tl->returned_start[0] = 0;
    array_free(count);
    return room ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory for %zu ghosts", tl->ghosts);
}

/* Together where memory is shared: the largest distance of neighbours. */
static void find_reach(const struct tl_model *tl, struct tl_making *making, struct tl_making *below)
{
    double reach = tl_reach_of_rows(tl);
    if (below->tl != NULL) reach = fmax(reach, tl_reach_of_rows(below->tl));
    if (tl->part.shared) ranks_largest(tl->part.ranks, 1, &reach);
    making->reach = below->reach = reach;
}

static selas_status make_others(struct tl_making *making, struct tl_making *below, struct messages *messages)
{
    struct tl_model *tl = making->tl;
    selas_status status = make(making, below, TRANSPOSED, messages);
    if (status == SELAS_OK) status = return_rows(tl, messages);
    if (status == SELAS_OK && tl->options.hourglass > 0) status = make(making, below, PAIR, messages);
    if (status == SELAS_OK && (tl->options.viscosity_alpha > 0 || tl->options.viscosity_beta > 0))
        status = make(making, below, VISCOUS, messages);
    return status == SELAS_OK ? tl_find_runs(tl, messages) : status;
}

selas_status tl_make_rows(struct tl_model *tl, selas_status status, struct messages *messages)
{
    struct tl_making making = {.tl = tl}, below = {0};
    struct tl_model *first = NULL; /* the first planes */
    if (status == SELAS_OK) status = begin(&making, tl, messages);
    if (status == SELAS_OK && tl->part.reach > 0) {
        status = tl_make_below(tl, &first, messages);
        if (status == SELAS_OK) status = begin(&below, first, messages);
    }
    if (status == SELAS_OK) status = make(&making, &below, GRADIENT, messages);
    status = tl_agree(tl, status, messages);
    if (status == SELAS_OK) {
        find_reach(tl, &making, &below);
        status = make_others(&making, &below, messages);
    }
    end(&making);
    end(&below);
    tl_free(first);
    return status;
}
