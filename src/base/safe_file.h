/* Files that last: each is written under a temporary name in its own folder, flushed to the disk and renamed,
 * so that a run that is killed leaves either the old file or the new one, never half of one. */
#ifndef SELAS_BASE_SAFE_FILE_H
#define SELAS_BASE_SAFE_FILE_H

#include "base/messages.h"

#include <stdbool.h>
#include <stdio.h>

struct safe_file {
    FILE *file;      /* write here */
    char *path;      /* the name the file gets */
    char *temporary; /* the name it has until it is complete */
    bool twice;      /* what it holds stands in a synced file, too: not synced itself, which takes its time */
};

/* Opens `folder`/`name` for writing text. On failure file is NULL and nothing has to be closed. */
selas_status safe_file_open(const char *folder, const char *name, struct safe_file *file,
                            struct messages *messages);
/* Flushes, syncs and renames; what failed on the way (a full disk shows here at the latest) becomes a message
 * and the temporary file is removed. Pass `status` of the writing: anything but SELAS_OK discards the file
 * and is returned. */
selas_status safe_file_close(struct safe_file *file, selas_status status, struct messages *messages);

/* For files that another library writes: names (allocated with malloc, free both) ... */
selas_status safe_file_names(const char *folder, const char *name, char **path, char **temporary,
                             struct messages *messages);
/* ... and what follows when the temporary file is complete and closed: sync and rename, or remove it. */
selas_status safe_file_commit(const char *temporary, const char *path, struct messages *messages);

/* Makes a folder and those above it; no error if it is there and can be written to. */
selas_status make_folder(const char *path, struct messages *messages);

/* Name of a file or data set from a name of the deck: '/' and control characters become '_'; FILE_NAME_SIZE
 * is room for every name of a deck. */
enum { FILE_NAME_SIZE = 80 };
void file_name_of(const char *name, const char *ending, char *text, size_t size);

#endif
