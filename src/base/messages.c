/* Messages: what the library has to say, kept as lines of text until the caller asks for them. */
#include "base/messages.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Is the line there already? */
static bool is_told(const struct messages *messages, const char *line)
{
    const size_t length = strlen(line);
    const char *at = messages->text;
    while (at != NULL && length > 0 && (at = strstr(at, line)) != NULL) {
        if ((at == messages->text || at[-1] == '\n') && at[length] == '\n') return true;
        at += length;
    }
    return false;
}

void messages_add(struct messages *messages, bool is_error, bool is_warning, const char *line)
{
    if (messages == NULL) return;
    if (is_error) messages->errors++;
    if (is_warning) messages->warnings++;
    if (is_warning && !is_error && is_told(messages, line)) return; /* of a scene that is built anew */
    const size_t extra = strlen(line) + 1;
    char *text = realloc(messages->text, messages->length + extra + 1);
    if (text == NULL) return; /* the count still tells that something was wrong */
    memcpy(text + messages->length, line, extra - 1);
    text[messages->length + extra - 1] = '\n';
    text[messages->length + extra] = '\0';
    messages->text = text;
    messages->length += extra;
}

static void add_formatted(struct messages *messages, bool is_error, const char *format, va_list arguments)
{
    char line[2048];
    const int prefix = snprintf(line, sizeof line, "%s: ", is_error ? "error" : "warning");
    vsnprintf(line + prefix, sizeof line - (size_t)prefix, format, arguments);
    messages_add(messages, is_error, !is_error, line);
}

selas_status fail(struct messages *messages, selas_status status, const char *format, ...)
{
    va_list arguments;
    if (messages != NULL && status == SELAS_NO_MEMORY) messages->no_memory = true;
    va_start(arguments, format);
    add_formatted(messages, true, format, arguments);
    va_end(arguments);
    return status;
}

void warn(struct messages *messages, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_formatted(messages, false, format, arguments);
    va_end(arguments);
}

selas_status messages_since(const struct messages *messages, size_t errors, selas_status otherwise)
{
    if (messages->errors == errors) return SELAS_OK;
    return messages->no_memory ? SELAS_NO_MEMORY : otherwise;
}

void messages_free(struct messages *messages)
{
    free(messages->text);
    *messages = (struct messages){0};
}
