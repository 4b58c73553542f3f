/* The deck that a checkpoint or run.h5 keeps, and what tells that a scene is the very same. */
#ifndef SELAS_RECORD_CHECKPOINT_KEPT_H
#define SELAS_RECORD_CHECKPOINT_KEPT_H

#include "scene/scene.h"

#include <stdint.h>

struct kept_deck {
    char *text;   /* with all defaults and overrides: runs to the same bits */
    char *source; /* as it was read */
    char *name;   /* file name without folder and ".nml" */
    char *origin; /* of a checkpoint: whole path of the file that it was read from, or ""; NULL: not kept */
    char *files;  /* of run.h5: kept_files() of that run; else NULL */
};

/* SELAS_FILE_ERROR with the reason if the file is damaged or holds none. Ranks: together; each looks for itself. */
selas_status kept_deck_of_checkpoint(const char *path, struct ranks *ranks, struct kept_deck *kept,
                                     struct messages *messages);
selas_status kept_deck_of_run(const char *path, struct kept_deck *kept, struct messages *messages);
void kept_deck_free(struct kept_deck *kept);

/* What tells whether that which the deck only names is the same: a line "load(1)%file=0123456789abcdef" for each file
 * (points, tables, references), the last, "host=...", of what a host gives beside it: points, and which loads and faces
 * it drives. In new memory (free it); NULL without memory. */
char *kept_files(const struct scene *scene);
/* Does one of them differ from those lines, beside files that an override names? */
bool kept_files_changed(const struct scene *scene, const char *files);
/* The lines, or NULL, in one number. */
uint64_t kept_sum(const char *files);

#endif
