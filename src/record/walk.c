/* Arrays of a checkpoint (see the header). Shares go through the first rank piece by piece, each straight from
 * where it is: no rank ever has the whole. */
#include "record/walk.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PIECE = 1 << 22 }; /* bytes */

bool walk_begin(struct walk *walk)
{
    const bool first = ranks_first(walk->ranks);
    walk->room = first && ranks_count(walk->ranks) > 1 ? malloc(PIECE) : NULL;
    walk->good = !first || (walk->file >= 0 && (walk->room != NULL || ranks_count(walk->ranks) == 1));
    ranks_spread(walk->ranks, 0, &walk->good, sizeof walk->good);
    return walk->good;
}

bool walk_end(struct walk *walk)
{
    free(walk->room);
    walk->room = NULL;
    ranks_spread(walk->ranks, 0, &walk->good, sizeof walk->good);
    return walk->good;
}

/* The set, of the first rank and as long as all is well. */
static hid_t open_set(struct walk *walk, const char *name, hid_t type, size_t count)
{
    if (!ranks_first(walk->ranks) || !walk->good) return -1;
    const hid_t set = set_open(walk->file, name, type, count, walk->mode);
    walk->good = set >= 0;
    return set;
}

static void close_set(struct walk *walk, hid_t set)
{
    if (set >= 0) walk->good = H5Dclose(set) >= 0 && walk->good;
}

void walk_pass(struct walk *walk, const char *name, hid_t type, void *data, size_t count)
{
    if (count == 0) return;
    const hid_t set = open_set(walk, name, type, count);
    if (set >= 0) walk->good = set_pass(set, type, walk->mode, data, 0, count);
    close_set(walk, set);
    if (walk->mode == SET_READ) ranks_spread(walk->ranks, 0, data, count * H5Tget_size(type));
}

void walk_text(struct walk *walk, const char *name, const char *text)
{
    walk_pass(walk, name, H5T_NATIVE_CHAR, (char *)text, strlen(text) + 1);
}

void walk_real(struct walk *walk, const char *name, size_t number, const char *ending, double *data,
               size_t count)
{
    char full[48];
    snprintf(full, sizeof full, number > 0 ? "%s_%zu%s" : "%s", name, number, ending);
    walk_pass(walk, full, H5T_NATIVE_DOUBLE, data, count);
}

/* Where numbers of a shared array are. */
struct place {
    int rank;
    hid_t set, type;
    char *data;   /* the rank's array */
    size_t width; /* bytes of a number */
    size_t units; /* entries of the set in a number */
};

/* `count` numbers, which the rank has from `here` on. */
static void pass_piece(struct walk *walk, const struct place *place, size_t here, size_t there, size_t count)
{
    const bool own = place->rank == ranks_me(walk->ranks);
    char *data = own ? place->data + here * place->width : walk->room;
    if (walk->mode != SET_READ) ranks_fetch(walk->ranks, place->rank, data, count * place->width);
    if (walk->good && place->set >= 0)
        walk->good =
            set_pass(place->set, place->type, walk->mode, data, there * place->units, count * place->units);
    if (walk->mode == SET_READ) ranks_give(walk->ranks, place->rank, data, count * place->width);
}

/* The runs of one rank: what it has, or where it wants what is read, halo and all. */
static void pass_runs(struct walk *walk, const struct place *place, const struct spread *shares)
{
    const size_t most = PIECE / place->width;
    for (size_t r = 0; r < shares->runs; r++) {
        const struct spread_run *run = &shares->run[r];
        const bool window = walk->mode == SET_READ;
        const size_t end = window ? run->count : run->end, last = window ? run->times : run->last;
        for (size_t t = window ? 0 : run->first; t < last; t++) {
            const size_t here = run->here + t * run->here_step, there = run->there + t * run->there_step;
            for (size_t from = window ? 0 : run->from, count; from < end; from += count) {
                count = end - from < most ? end - from : most;
                pass_piece(walk, place, here + from, there + from, count);
            }
        }
    }
}

void walk_shared(struct walk *walk, const char *name, hid_t type, size_t units, void *data, size_t count,
                 const struct spread *shares)
{
    if (shares == NULL || ranks_count(walk->ranks) == 1) {
        walk_pass(walk, name, type, data, count * units);
        return;
    }
    const int me = ranks_me(walk->ranks);
    struct place place = {.set = open_set(walk, name, type, shares->there * units),
                          .type = type,
                          .data = data,
                          .width = units * H5Tget_size(type),
                          .units = units};
    for (place.rank = 0; place.rank < ranks_count(walk->ranks); place.rank++) {
        struct spread its = *shares;
        ranks_fetch(walk->ranks, place.rank, &its, sizeof its);
        walk->good = walk->good && !its.full;
        if (me == 0 || me == place.rank) pass_runs(walk, &place, &its);
    }
    close_set(walk, place.set);
}
