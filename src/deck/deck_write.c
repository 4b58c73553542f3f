/* The echo of a deck: every value, defaults included, as a deck that reads again to the same bits, here and
 * in gfortran. */
#include "base/memory.h"
#include "deck/deck_private.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* folder "/" file in new memory. */
static char *join(const char *folder, const char *file)
{
    const size_t size = strlen(folder) + strlen(file) + 2;
    char *path = array_new(size, 1);
    if (path != NULL) snprintf(path, size, "%s%s%s", folder, strcmp(folder, "/") == 0 ? "" : "/", file);
    return path;
}

static char *relative(const struct deck *deck, const char *file)
{
    const bool here = *file == '/' || strcmp(deck->directory, ".") == 0;
    if (!here) return join(deck->directory, file);
    const size_t size = strlen(file) + 1;
    char *path = array_new(size, 1);
    if (path != NULL) memcpy(path, file, size);
    return path;
}

char *deck_absolute(const struct deck *deck, const char *file)
{
    char *path = relative(deck, file);
    if (path == NULL || *path == '/' || deck->here == NULL) return path;
    char *whole = join(deck->here, path);
    array_free(path);
    return whole;
}

bool deck_moved(const struct deck *deck)
{
    char *folder = getcwd(NULL, 0);
    const bool moved = deck->here != NULL && (folder == NULL || strcmp(folder, deck->here) != 0);
    free(folder);
    return moved;
}

char *deck_resolve(const struct deck *deck, const char *file)
{
    return deck_moved(deck) ? deck_absolute(deck, file) : relative(deck, file);
}

bool deck_files(const struct deck *deck, deck_visit *visit, void *context)
{
    for (size_t g = 0; g < deck->list.groups; g++) {
        const struct deck_group *group = &deck->list.group[g];
        for (size_t w = 0; w < group->kind->words; w++) {
            if (group->kind->word[w].type != WORD_FILE || group_values(group, w) == 0) continue;
            const struct value *value = group_value(group, w, 0);
            char name[80], *path = deck_resolve(deck, value->as.text);
            snprintf(name, sizeof name, "%s(%zu)%%%s", group->kind->name,
                     g - deck->first[group->kind - deck->list.table->group] + 1, group->kind->word[w].name);
            const bool good = path != NULL && visit(context, name, path, value->place.line == 0);
            array_free(path);
            if (!good) return false;
        }
    }
    return true;
}

static void write_text(const char *text, FILE *file)
{
    putc('\'', file);
    for (; *text != '\0'; text++) {
        if (*text == '\'') putc('\'', file);
        putc(*text, file);
    }
    putc('\'', file);
}

static bool write_value(const struct deck *deck, enum word_type type, const struct value *value, FILE *file)
{
    char *path;
    switch (type) {
    case WORD_REAL:
        fprintf(file, "%.17g", value->as.real);
        break;
    case WORD_INTEGER:
        fprintf(file, "%ld", value->as.integer);
        break;
    case WORD_LOGICAL:
        fputs(value->as.logical ? ".true." : ".false.", file);
        break;
    case WORD_FILE:
        path = deck_absolute(deck, value->as.text);
        if (path == NULL) return false;
        write_text(path, file);
        array_free(path);
        break;
    case WORD_TEXT:
    case WORD_CHOICE:
        write_text(value->as.text, file);
        break;
    }
    return true;
}

static bool write_group(const struct deck *deck, const struct deck_group *group, FILE *file)
{
    enum { VALUES_A_LINE = 6 };
    bool good = true;
    fprintf(file, "&%s\n", group->kind->name);
    for (size_t i = 0; i < group->kind->words; i++) {
        const size_t count = group_values(group, i);
        if (count == 0) continue;
        fprintf(file, "  %s =", group->kind->word[i].name);
        for (size_t j = 0; j < count && good; j++) {
            fputs(j == 0 ? " " : j % VALUES_A_LINE == 0 ? ",\n    " : ", ", file);
            good = write_value(deck, group->kind->word[i].type, group_value(group, i, j), file);
        }
        putc('\n', file);
    }
    fputs("/\n", file);
    return good;
}

selas_status deck_write(const struct deck *deck, FILE *file, struct messages *messages)
{
    bool good = true;
    for (size_t i = 0; i < deck->list.groups && good; i++)
        good = write_group(deck, &deck->list.group[i], file);
    if (!good) return fail(messages, SELAS_NO_MEMORY, "not enough memory to write the deck");
    if (ferror(file) != 0) return fail(messages, SELAS_FILE_ERROR, "the deck's echo: %s", strerror(errno));
    return SELAS_OK;
}

char *deck_echo(const struct deck *deck, struct messages *messages)
{
    char *text = NULL;
    size_t size = 0;
    if (deck == NULL) return strdup("");
    FILE *file = open_memstream(&text, &size);
    if (file == NULL) return NULL;
    const selas_status status = deck_write(deck, file, messages);
    if (fclose(file) == 0 && status == SELAS_OK) return text;
    free(text);
    return NULL;
}
