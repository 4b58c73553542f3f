/* One way through all arrays of a checkpoint, for writing, reading and comparing. The first rank has the file;
 * all ranks walk together. */
#ifndef SELAS_RECORD_WALK_H
#define SELAS_RECORD_WALK_H

#include "model/spread.h"
#include "parallel/ranks.h"
#include "record/sets.h"

struct walk {
    struct ranks *ranks;
    hid_t file; /* of the first rank */
    enum set_mode mode;
    bool good; /* so far, for the first rank */
    char *room;
};

/* Takes its room; false: the first rank has none, or no file (negative). */
bool walk_begin(struct walk *walk);
/* Ends it; true if all was good. */
bool walk_end(struct walk *walk);

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
