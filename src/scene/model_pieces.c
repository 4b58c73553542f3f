/* Pieces of a model's grid (doc/developers/ranks.md). */
#include "scene/model_pieces.h"

#include "base/memory.h"

#include <math.h>
#include <omp.h>
#include <sched.h>
#include <stdlib.h>

/* Values of a piece along the axes: few over depth, across which ranks share a lattice. */
static const size_t extent[3] = {16, 16, 8};
/* Bytes of a box of model_walk(), if that has one column at least; of the pieces that are kept, if those are not fewer
 * than LAYERS layers over depth, which lattices ask for from the top down; threads that are told apart. */
enum { BOX_BYTES = 8 << 20, KEPT_BYTES = 8 << 20, LAYERS = 3, READERS = 64 };

/* How many threads that share its number look at values: alone on its cache line. */
struct reader {
    int now;
    char line[64 - sizeof(int)];
};

/* In place of a piece that was let go of. */
static double gone[1];

struct model_pieces {
    struct model_origin origin;
    size_t count[3];
    double **piece;     /* [count[0] count[1] count[2]], each [sets][values] */
    double *other;      /* in their place where they cannot be read */
    size_t bytes, most; /* of pieces that are kept; when they are let go of */
    size_t read;        /* of pieces that were asked for */
    bool broken, letting_go;
    struct reader reader[READERS];
    unsigned *rock;
    double *fill;
};

double model_pieces_kept(double most)
{
    const char *bytes = getenv("SELAS_MODEL_KEPT");
    return bytes != NULL ? strtod(bytes, NULL) : most;
}

bool model_pieces_new(struct model_grid *grid, const struct model_origin *origin)
{
    struct model_pieces *pieces = array_new(1, sizeof *pieces);
    size_t all = 1;
    for (int axis = 0; axis < 3 && pieces != NULL; axis++) {
        pieces->count[axis] = (grid->n[axis] + extent[axis] - 1) / extent[axis];
        all *= pieces->count[axis];
    }
    if (pieces != NULL) {
        pieces->piece = array_new(all, sizeof *pieces->piece);
        pieces->other = array_new((size_t)origin->sets * extent[0] * extent[1] * extent[2], sizeof(double));
        pieces->origin = *origin;
        pieces->most = (size_t)fmax(model_pieces_kept(KEPT_BYTES),
                                    (double)(LAYERS * extent[2] * grid->n[0] * grid->n[1] * sizeof(double)) *
                                        origin->sets);
    }
    if (pieces == NULL || pieces->piece == NULL || pieces->other == NULL) {
        if (pieces != NULL) array_free(pieces->piece);
        if (pieces != NULL) array_free(pieces->other);
        array_free(pieces);
        return false;
    }
    for (size_t i = 0; i < (size_t)origin->sets * extent[0] * extent[1] * extent[2]; i++)
        pieces->other[i] = i < extent[0] * extent[1] * extent[2] ? 2 : 1;
    grid->pieces = pieces;
    return true;
}

static void let_go(struct model_pieces *pieces, double *left)
{
    for (size_t i = 0; i < pieces->count[0] * pieces->count[1] * pieces->count[2]; i++) {
        double **piece = &pieces->piece[i];
        const bool own = *piece != NULL && *piece != gone && *piece != pieces->other;
        if (own) array_free(*piece);
        if (own || left == NULL) *piece = left;
    }
    __atomic_store_n(&pieces->bytes, 0, __ATOMIC_RELAXED);
}

void model_pieces_forget(const struct model_grid *grid)
{
    if (grid->pieces == NULL) return;
    let_go(grid->pieces, NULL);
    grid->pieces->read = 0;
}

/* Lets go of all pieces, when no thread looks at one. */
static void make_room(struct model_pieces *pieces)
{
#pragma omp critical(selas_model_room)
    if (__atomic_load_n(&pieces->bytes, __ATOMIC_RELAXED) > pieces->most) {
        __atomic_store_n(&pieces->letting_go, true, __ATOMIC_SEQ_CST);
        for (size_t i = 0; i < READERS; i++)
            while (__atomic_load_n(&pieces->reader[i].now, __ATOMIC_SEQ_CST) > 0)
                sched_yield();
        let_go(pieces, gone);
        __atomic_store_n(&pieces->letting_go, false, __ATOMIC_SEQ_CST);
    }
}

void model_pieces_look(const struct model_grid *grid)
{
    struct model_pieces *pieces = grid->pieces;
    int *now = &pieces->reader[omp_get_thread_num() % READERS].now;
    if (__atomic_load_n(&pieces->bytes, __ATOMIC_RELAXED) > pieces->most) make_room(pieces);
    __atomic_fetch_add(now, 1, __ATOMIC_SEQ_CST);
    while (__atomic_load_n(&pieces->letting_go, __ATOMIC_SEQ_CST)) {
        __atomic_fetch_sub(now, 1, __ATOMIC_SEQ_CST);
        sched_yield();
        __atomic_fetch_add(now, 1, __ATOMIC_SEQ_CST);
    }
}

void model_pieces_looked(const struct model_grid *grid)
{
    __atomic_fetch_sub(&grid->pieces->reader[omp_get_thread_num() % READERS].now, 1, __ATOMIC_RELEASE);
}

void model_pieces_free(struct model_grid *grid)
{
    struct model_pieces *pieces = grid->pieces;
    if (pieces == NULL) return;
    model_pieces_forget(grid);
    pieces->origin.free(pieces->origin.context);
    array_free(pieces->piece);
    array_free(pieces->other);
    array_free(pieces->rock);
    array_free(pieces->fill);
    array_free(pieces);
    grid->pieces = NULL;
}

void *model_pieces_context(const struct model_grid *grid)
{
    return grid->pieces->origin.context;
}

size_t model_pieces_asked(const struct model_grid *grid)
{
    return grid->pieces != NULL ? grid->pieces->read : 0;
}

bool model_pieces_broken(const struct model_grid *grid)
{
    return grid->pieces != NULL && grid->pieces->broken;
}

void model_pieces_fill(struct model_grid *grid, unsigned *rock, double *value)
{
    grid->pieces->rock = rock;
    grid->pieces->fill = value;
}

/* Values above the rock are what they become. */
static void mend(const struct model_grid *grid, const struct model_grid *box, const size_t first[3])
{
    const struct model_pieces *pieces = grid->pieces;
    const int sets = pieces->origin.sets;
    for (size_t column = 0; column < box->n[0] * box->n[1] && pieces->rock != NULL; column++) {
        const size_t whole = (first[0] + column / box->n[1]) * grid->n[1] + first[1] + column % box->n[1];
        for (size_t k = 0; k < box->n[2] && first[2] + k < pieces->rock[whole]; k++)
            for (int set = 0; set < sets; set++)
                box->value[set][column * box->n[2] + k] = pieces->fill[whole * (size_t)sets + (size_t)set];
    }
}

bool model_pieces_read(const struct model_grid *grid, const struct model_grid *box, const size_t first[3])
{
    struct model_pieces *pieces = grid->pieces;
    if (!pieces->origin.read(pieces->origin.context, box, first)) {
        pieces->broken = true;
        return false;
    }
    mend(grid, box, first);
    return true;
}

/* A box without values: those of a grid from first[] on. */
static struct model_grid box_at(const struct model_grid *grid, const size_t first[3], const size_t most[3],
                                double *value)
{
    struct model_grid box = {.pieces = NULL};
    for (int axis = 0; axis < 3; axis++) {
        const size_t left = grid->n[axis] - first[axis];
        box.n[axis] = left < most[axis] ? left : most[axis];
        box.at[axis] = grid->at[axis] + first[axis];
    }
    for (int set = 0; set < grid->pieces->origin.sets && value != NULL; set++)
        box.value[set] = value + (size_t)set * box.n[0] * box.n[1] * box.n[2];
    return box;
}

/* `again`: it was let go of. */
static double *read_piece(const struct model_grid *grid, const size_t number[3], bool again)
{
    struct model_pieces *pieces = grid->pieces;
    size_t first[3];
    for (int axis = 0; axis < 3; axis++)
        first[axis] = number[axis] * extent[axis];
    struct model_grid box = box_at(grid, first, extent, NULL);
    const size_t values = box.n[0] * box.n[1] * box.n[2];
    double *value = array_new(values * (size_t)pieces->origin.sets, sizeof *value);
    if (value != NULL) {
        box = box_at(grid, first, extent, value);
        if (model_pieces_read(grid, &box, first)) {
            const size_t bytes = values * (size_t)pieces->origin.sets * sizeof *value;
            __atomic_fetch_add(&pieces->bytes, bytes, __ATOMIC_RELAXED);
            if (!again) pieces->read += bytes;
            return value;
        }
        array_free(value);
    }
    pieces->broken = true;
    if (pieces->origin.of != NULL) pieces->origin.of->pieces->broken = true;
    return pieces->other;
}

struct model_piece model_pieces_at(const struct model_grid *grid, const size_t at[3])
{
    const struct model_pieces *pieces = grid->pieces;
    struct model_piece found = {.step = {0, 0, 1, 1}};
    size_t number[3], within = 0, index = 0, n[3];
    for (int axis = 0; axis < 3; axis++) {
        number[axis] = at[axis] / extent[axis];
        const size_t first = number[axis] * extent[axis], left = grid->n[axis] - first;
        n[axis] = left < extent[axis] ? left : extent[axis];
        found.left[axis] = n[axis] - 1 - (at[axis] - first);
        index = index * pieces->count[axis] + number[axis];
        within = within * n[axis] + at[axis] - first;
        found.step[3] *= n[axis];
    }
    found.step[1] = n[2];
    found.step[0] = n[1] * n[2];
    double **piece = &pieces->piece[index];
    found.value = __atomic_load_n(piece, __ATOMIC_ACQUIRE);
    if (found.value == NULL || found.value == gone) {
#pragma omp critical(selas_model)
        {
            if (*piece == NULL || *piece == gone) {
                double *made = read_piece(grid, number, *piece == gone);
                __atomic_store_n(piece, made, __ATOMIC_RELEASE);
            }
            found.value = *piece;
        }
    }
    found.value += within;
    return found;
}

bool model_walk(const struct model_grid *grid, model_visit *visit, void *context, bool *unread)
{
    if (grid->pieces == NULL) return visit(context, grid, 0);
    const size_t sets = (size_t)grid->pieces->origin.sets;
    size_t columns = (size_t)model_pieces_kept(BOX_BYTES) / (grid->n[2] * sets * sizeof(double)) + 1;
    if (columns > grid->n[0] * grid->n[1]) columns = grid->n[0] * grid->n[1];
    const size_t most[3] = {columns > grid->n[1] ? columns / grid->n[1] : 1,
                            columns > grid->n[1] ? grid->n[1] : columns, grid->n[2]};
    double *value = array_new(most[0] * most[1] * most[2] * sets, sizeof *value);
    *unread = value == NULL;
    bool good = value != NULL;
    for (size_t first[3] = {0}; first[0] < grid->n[0] && good; first[0] += most[0])
        for (first[1] = 0; first[1] < grid->n[1] && good; first[1] += most[1]) {
            const struct model_grid box = box_at(grid, first, most, value);
#pragma omp critical(selas_model)
            good = model_pieces_read(grid, &box, first);
            *unread = !good;
            good = good && visit(context, &box, first[0] * grid->n[1] + first[1]);
        }
    array_free(value);
    return good;
}
