/* One way through all that is in a file, for writing, reading and comparing; all ranks walk together. What is
 * the first rank's, or the same for all, it passes alone. What ranks share comes after that: the file is opened
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
    size_t head;       /* bytes before HDF5's own, of a file that is written */
    const char *named; /* in messages; NULL: path */
    /* Set to nothing by who walks. */
    hid_t file;
    bool together; /* behind what the first rank passes alone */
    bool failed;   /* on this rank, */
    int error;     /* with the system's reason; 0: none */
    char *room;
};

bool walk_begin(struct walk *walk);
bool walk_again(struct walk *walk);
/* Notes what went wrong first on this rank, with the system's reason. */
void walk_note(struct walk *walk, bool good);
/* The first rank, or one that is alone, makes what is the same for all. */
bool walk_makes(const struct walk *walk);
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

/* What is written besides arrays. A group, open to the one that makes it; negative for all others. */
hid_t walk_group(struct walk *walk, const char *name);
/* A table, by its whole name, open to all (negative: to those who make it for all, and on failure); its rows from
 * `first` on; and which rows first .. end - 1 a rank writes where any could. */
hid_t walk_table(struct walk *walk, const char *name, hid_t type, size_t rows, size_t columns);
void walk_rows(struct walk *walk, hid_t table, size_t first, size_t rows, size_t columns, double *value);
void walk_share(const struct walk *walk, size_t rows, size_t *first, size_t *end);
void walk_close(struct walk *walk, hid_t table);

/* walk_recorder.c: the state and what the recorder has: `rows` of histories, `entries` in the list of
 * snapshots, for which there is room. */
struct recorder;
struct state;
void walk_recorder(struct walk *walk, struct recorder *recorder, struct state *state, size_t rows,
                   size_t entries);

#endif
