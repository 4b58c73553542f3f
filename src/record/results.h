/* The files of a run in the folder of its results, as lists of names (free them): what a run may overwrite
 * there, and what an earlier run has left. Where a list is taken, NULL stands for one that got no memory. */
#ifndef SELAS_RECORD_RESULTS_H
#define SELAS_RECORD_RESULTS_H

#include "record/parts.h"

/* All that a run may write; with `done` what it has computed. Without a recorder: the exact histories. */
char *results_names(const struct scene *scene, const struct recorder *recorder, bool done);
/* SELAS_FILE_ERROR if one of the names is that of a file which is no result of selas, or is read by the deck.
 */
selas_status results_claim(const struct scene *scene, const char *names, struct messages *messages);
/* Notes the names as results of selas: before they are written. */
selas_status results_list(const struct scene *scene, const char *names, struct messages *messages);
/* After that: takes away what was noted and is not among the names, and all pictures, which are drawn anew.
 */
selas_status results_tidy(const struct scene *scene, const char *names, struct messages *messages);

#endif
