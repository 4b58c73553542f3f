/* Messages: what the library has to say, kept as lines of text until the caller asks for them. */
#ifndef SELAS_MESSAGES_H
#define SELAS_MESSAGES_H

#include "selas.h"

struct messages {
    char *text;      /* all lines so far, each ended by '\n'; NULL while there is none */
    size_t length;   /* bytes in text without the final '\0' */
    size_t errors;   /* number of error lines */
    size_t warnings; /* number of warning lines */
    bool no_memory;  /* one of the errors was that memory ran out */
};

/* Adds the line "error: ..." (printf-like) and returns the status given, so that a function can end with it.
 */
selas_status fail(struct messages *messages, selas_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Adds the line "warning: ..."; one that is there already is counted alone. */
void warn(struct messages *messages, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Adds one line as it is (no prefix); counts it as an error or a warning by the flags. */
void messages_add(struct messages *messages, bool is_error, bool is_warning, const char *line);
/* SELAS_OK if there are `errors` errors as before; else SELAS_NO_MEMORY if memory has run out, or
 * `otherwise`. */
selas_status messages_since(const struct messages *messages, size_t errors, selas_status otherwise);
void messages_free(struct messages *messages);

#endif
