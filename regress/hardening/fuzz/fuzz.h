/* What the fuzz targets share: libFuzzer's entry point, and inputs as files. */
#ifndef SELAS_FUZZ_H
#define SELAS_FUZZ_H

#include "base/messages.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { FUZZ_PATH = 64 };

/* A file with these bytes (in memory, where /dev/shm is that) and its name. */
static inline void fuzz_file(const uint8_t *data, size_t size, char path[FUZZ_PATH])
{
    snprintf(path, FUZZ_PATH, "%s/selas-fuzz-XXXXXX", access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp");
    const int file = mkstemp(path);
    if (file < 0 || write(file, data, size) != (ssize_t)size) abort();
    close(file);
}

/* What must hold whatever the input; a failure shows as a crash, with the place. */
static inline void fuzz_require(bool holds, const char *what)
{
    if (holds) return;
    fprintf(stderr, "does not hold: %s\n", what);
    abort();
}

/* Nothing is refused without a reason and nothing is done in spite of one. */
static inline void fuzz_told(selas_status status, struct messages *messages)
{
    fuzz_require((status == SELAS_OK) == (messages->errors == 0), "errors and status go together");
    fuzz_require(status == SELAS_OK || messages->length > 0, "a refusal has its message");
    messages_free(messages);
}

#endif
