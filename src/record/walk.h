/* One way through all arrays of a checkpoint, for writing, reading and comparing; all ranks walk together. What is
 * the first rank's, or the same for all, it passes alone. Arrays that ranks share come after that: the file is opened
 * by all together, and each rank passes its part straight from where it is (doc/developers/ranks.md).
 *
 *     for (bool more = walk_begin(&walk); more; more = walk_again(&walk))
 *         ... all arrays, in the same order ...
 */
#ifndef SELAS_RECORD_WALK_H
#define SELAS_RECORD_WALK_H

#include "model/spread.h"
#include "parallel/ranks.h"
#include "record/sets.h"

struct walk {
    struct ranks *ranks;
    const char *path;
    enum set_mode mode;
    size_t head; /* bytes before HDF5's own, of a file that is written */
    /* Set to nothing by who walks. */
    hid_t file;
    bool together; /* behind what the first rank passes alone */
    bool failed;   /* on this rank, */
    int error;     /* with the system's reason; 0: none */
    char *room;
};

bool walk_begin(struct walk *walk);
bool walk_again(struct walk *walk);
/* Together, behind a walk: did all go well on all ranks? */
bool walk_good(const struct walk *walk);
/* Together, behind a walk that failed: "cannot WHAT 'PATH': ..." with the reason, and the rank. */
selas_status walk_cannot(const struct walk *walk, const char *what, struct messages *messages);

/* An array that is the same for all ranks, or matters to the first one alone; read, all get it. */
void walk_pass(struct walk *walk, const char *name, hid_t type, void *data, size_t count);
/* The same of doubles, named NAME or, if number > 0, NAME_<number><ending>. */
void walk_real(struct walk *walk, const char *name, size_t number, const char *ending, double *data,
               size_t count);
void walk_text(struct walk *walk, const char *name, const char *text); /* not SET_READ */

/* An array of `count` numbers, each of `units` entries of the type, of which ranks have shares. Shares NULL:
 * one rank, which has the whole. */
void walk_shared(struct walk *walk, const char *name, hid_t type, size_t units, void *data, size_t count,
                 const struct spread *shares);

/* walk_recorder.c: the state and what the recorder has: `rows` of histories, `entries` in the list of
 * snapshots, for which there is room. */
struct recorder;
struct state;
void walk_recorder(struct walk *walk, struct recorder *recorder, struct state *state, size_t rows,
                   size_t entries);

#endif
