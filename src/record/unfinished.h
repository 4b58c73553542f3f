/* What a run that is not over keeps beside its results: the folder `unfinished` in theirs, with checkpoints
 * and the snapshots so far, each a file of its own; gone when all results are there. And the lock by which
 * two runs never write into one folder. */
#ifndef SELAS_UNFINISHED_H
#define SELAS_UNFINISHED_H

#include "base/messages.h"

struct unfinished {
    char *results; /* folder of the results */
    char *path;    /* of what is not finished */
    int lock;      /* open file with a lock, -1: none */
    bool made;     /* the folder is there */
};

/* Names the folders and, of ranks the first one (`lock`), locks that of the results, which must be there
 * (SELAS_FILE_ERROR, with who holds it, if another run writes there). `work` is the folder of an earlier run that goes
 * on, or NULL: begins anew in `results`/unfinished; if there is a checkpoint in it, it is kept as
 * `results`/unfinished-old with a warning. */
selas_status unfinished_open(const char *results, const char *work, bool lock, struct unfinished *unfinished,
                             struct messages *messages);
/* Makes the folder; to be called before anything is written there. */
selas_status unfinished_make(struct unfinished *unfinished, struct messages *messages);
/* Removes the folder with all that the program puts there; what else is in it stays. */
void unfinished_remove(const struct unfinished *unfinished);
/* Lets the folder of the results go. */
void unfinished_close(struct unfinished *unfinished);

#endif
