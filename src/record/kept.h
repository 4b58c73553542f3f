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
    char *files;  /* of run.h5: kept_files_text() of that run; else NULL */
};

/* SELAS_FILE_ERROR with the reason if the file is damaged or holds none. Ranks: together; each looks for itself. */
selas_status kept_deck_of_checkpoint(const char *path, struct ranks *ranks, struct kept_deck *kept,
                                     struct messages *messages);
selas_status kept_deck_of_run(const char *path, struct kept_deck *kept, struct messages *messages);
void kept_deck_free(struct kept_deck *kept);

/* Checksum of what the deck only names: points, tables, references, and what a host gives beside it: points, and which
 * loads and faces it drives; false without memory. */
bool kept_files_checksum(const struct scene *scene, uint64_t *checksum);
enum { KEPT_CHECKSUM = 17 };
void kept_text_of(uint64_t checksum, char text[KEPT_CHECKSUM]);
/* The scene's as text. */
bool kept_files_text(const struct scene *scene, char text[KEPT_CHECKSUM]);

#endif
