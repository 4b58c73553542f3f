/* How a rank's part of an array lies in that of the whole body: runs of numbers that follow each other in both, again
 * and again at equal distances (a block of rows and planes). A rank has its window (doc/developers/ranks.md); each
 * number is one rank's own. Alone, a rank has the whole. */
#ifndef SELAS_MODEL_SPREAD_H
#define SELAS_MODEL_SPREAD_H

#include <stdbool.h>
#include <stddef.h>

enum { SPREAD_RUNS = 512 };

/* `times` times `count` numbers, from `here` on in the rank's array, from `there` on in the whole one; the next time
 * here_step and there_step further. Own: from .. end - 1 of them, in the times first .. last - 1. `abreast` ranks have
 * parts of each time, one behind the other. */
struct spread_run {
    size_t here, there, count, from, end;
    size_t times, here_step, there_step, first, last;
    int abreast;
};

struct spread {
    size_t here, there; /* numbers of the rank's array and of the whole one */
    size_t runs;
    bool full; /* there are more runs than fit */
    struct spread_run run[SPREAD_RUNS];
};

/* Numbers that follow each other, once. */
static inline struct spread_run spread_line(size_t here, size_t there, size_t count, size_t from, size_t end)
{
    return (struct spread_run){here, there, count, from, end, .times = 1, .last = 1, .abreast = 1};
}

/* The next numbers of both arrays: `here` and `there` of them, of which the rank has the run (places in it are counted
 * from these). */
static inline void spread_add(struct spread *shares, size_t here, size_t there, const struct spread_run *run)
{
    if (run->count > 0 && run->times > 0 && shares->runs < SPREAD_RUNS) {
        struct spread_run *added = &shares->run[shares->runs++];
        *added = *run;
        added->here += shares->here;
        added->there += shares->there;
    } else if (run->count > 0 && run->times > 0) {
        shares->full = true;
    }
    shares->here += here;
    shares->there += there;
}

#endif
