/* How a rank's part of an array lies in that of the whole body: runs of numbers that follow each other in both.
 * A rank has its window (doc/developers/ranks.md); each number is one rank's own. Alone, a rank has the whole. */
#ifndef SELAS_MODEL_SPREAD_H
#define SELAS_MODEL_SPREAD_H

#include <stdbool.h>
#include <stddef.h>

enum { SPREAD_RUNS = 512 };

/* `count` numbers from `here` on in the rank's array, from `there` on in the whole one; own: from .. end - 1 of
 * them. */
struct spread_run {
    size_t here, there, count, from, end;
};

struct spread {
    size_t here, there; /* numbers of the rank's array and of the whole one */
    size_t runs;
    bool full; /* there are more runs than fit */
    struct spread_run run[SPREAD_RUNS];
};

/* The next numbers of both arrays: `here` and `there` of them, of which the rank has the run (places in it are counted
 * from these). */
static inline void spread_add(struct spread *shares, size_t here, size_t there, const struct spread_run *run)
{
    if (run->count > 0 && shares->runs < SPREAD_RUNS) {
        struct spread_run *added = &shares->run[shares->runs++];
        *added = *run;
        added->here += shares->here;
        added->there += shares->there;
    } else if (run->count > 0) {
        shares->full = true;
    }
    shares->here += here;
    shares->there += there;
}

#endif
