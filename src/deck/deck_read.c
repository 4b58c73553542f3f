/* Reading a deck: the file, the groups that are always there, overrides, and the checks of the table. */
#include "base/memory.h"
#include "deck/deck.h"
#include "deck/deck_private.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    MOST_BYTES = 16 << 20,
    MOST_REPEATED = 10 /* occurrences of a group too many that are reported */
};

static char *copy_bytes(const char *text, size_t length)
{
    char *copy = array_new(length + 1, 1);
    if (copy != NULL && length > 0) memcpy(copy, text, length);
    return copy;
}

static char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *base = slash == NULL ? path : slash + 1;
    size_t length = strlen(base);
    if (length > 4 && strcmp(base + length - 4, ".nml") == 0) length -= 4;
    return copy_bytes(base, length);
}

static char *directory_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (slash == NULL) return copy_bytes(".", 1);
    return copy_bytes(path, slash == path ? 1 : (size_t)(slash - path));
}

bool deck_sort_groups(struct deck *deck)
{
    struct namelist *list = &deck->list;
    const size_t kinds = list->table->groups;
    struct deck_group *sorted = array_new(list->groups, sizeof *sorted);
    if (deck->first == NULL) deck->first = array_new(kinds + 1, sizeof *deck->first);
    if (sorted == NULL || deck->first == NULL) {
        array_free(sorted);
        return false;
    }
    size_t used = 0;
    for (size_t kind = 0; kind < kinds; kind++) {
        deck->first[kind] = used;
        for (size_t i = 0; i < list->groups; i++)
            if (list->group[i].kind == &list->table->group[kind]) sorted[used++] = list->group[i];
    }
    deck->first[kinds] = used;
    array_free(list->group);
    list->group = sorted;
    list->room = list->groups;
    return true;
}

/* Groups that occur once occur once; those that are always there are there. */
static bool complete_groups(struct deck *deck, struct messages *messages)
{
    const struct word_table *table = deck->list.table;
    for (size_t kind = 0; kind < table->groups; kind++) {
        const struct word_group *words = &table->group[kind];
        const size_t first = deck->first[kind], count = deck->first[kind + 1] - first;
        for (size_t i = 1; words->occurrence != GROUP_MANY && i < count && i < MOST_REPEATED; i++)
            namelist_message(messages, deck->path, deck->list.group[first + i].place, true,
                             "&%s is given twice (first on line %zu); it may occur once", words->name,
                             deck->list.group[first].place.line);
    }
    for (size_t kind = 0; kind < table->groups; kind++)
        if (table->group[kind].occurrence == GROUP_ALWAYS && deck->first[kind + 1] == deck->first[kind] &&
            namelist_add(&deck->list, kind, (struct place){1, 1}) == NULL)
            return false;
    return deck_sort_groups(deck);
}

static selas_status read_all(struct deck *deck, size_t overrides, const char *const *override, bool check,
                             struct messages *messages)
{
    const size_t errors = messages->errors;
    if (!namelist_begin(&deck->list, deck_words(), messages)) return SELAS_NO_MEMORY;
    if (memchr(deck->source, '\0', deck->length) != NULL) /* no deck: one message is enough */
        return namelist_read(&deck->list, deck->path, deck->source, deck->length, messages);
    namelist_read(&deck->list, deck->path, deck->source, deck->length, messages);
    if (deck->list.groups == 0 && messages->errors == errors)
        namelist_message(messages, deck->path, (struct place){1, 1}, true,
                         "no group of a deck is in this file; expected '&scene ... /' and others");
    if (!deck_sort_groups(deck) || !complete_groups(deck, messages))
        return fail(messages, SELAS_NO_MEMORY, "not enough memory for the deck");
    for (size_t i = 0; i < overrides; i++) {
        deck_override(deck, override[i], messages);
        if (!deck_sort_groups(deck)) return fail(messages, SELAS_NO_MEMORY, "not enough memory for the deck");
    }
    if (check) deck_check(deck, messages);
    return messages_since(messages, errors, SELAS_BAD_DECK);
}

static selas_status read_text(const char *name, const char *text, size_t length, size_t overrides,
                              const char *const *override, bool check, struct deck **deck,
                              struct messages *messages)
{
    *deck = NULL;
    struct deck *made = array_new(1, sizeof *made);
    if (made == NULL) return fail(messages, SELAS_NO_MEMORY, "not enough memory for the deck");
    made->path = copy_bytes(name, strlen(name));
    made->name = name_of(name);
    made->directory = directory_of(name);
    made->here = getcwd(NULL, 0);
    made->source = copy_bytes(text, length);
    made->length = length;
    selas_status status = SELAS_NO_MEMORY;
    if (made->path == NULL || made->name == NULL || made->directory == NULL || made->source == NULL) {
        status = fail(messages, status, "not enough memory for the deck");
    } else {
        status = read_all(made, overrides, override, check, messages);
    }
    if (status == SELAS_OK)
        *deck = made;
    else
        deck_free(&made);
    return status;
}

selas_status deck_read_text(const char *name, const char *text, size_t length, size_t overrides,
                            const char *const *override, struct deck **deck, struct messages *messages)
{
    return read_text(name, text, length, overrides, override, true, deck, messages);
}

selas_status deck_new(const char *name, struct deck **deck, struct messages *messages)
{
    static const char start[] = "&scene /\n";
    return read_text(name, start, sizeof start - 1, 0, NULL, false, deck, messages);
}

/* The whole of a file, at most MOST_BYTES. */
static char *read_file(const char *path, size_t *length, struct messages *messages)
{
    const struct place start = {1, 1};
    struct stat about;
    FILE *file = fopen(path, "rb");
    if (file == NULL || fstat(fileno(file), &about) != 0) {
        namelist_message(messages, path, start, true, "cannot be opened: %s", strerror(errno));
        if (file != NULL) fclose(file);
        return NULL;
    }
    char *text = NULL;
    if (S_ISDIR(about.st_mode)) {
        namelist_message(messages, path, start, true, "is a directory, not a deck");
    } else if (S_ISREG(about.st_mode) && about.st_size > MOST_BYTES) {
        namelist_message(messages, path, start, true, "%lld bytes: a deck has at most %d",
                         (long long)about.st_size, MOST_BYTES);
    } else {
        /* a pipe has no size: room for the most, and one byte to see that there is more */
        const size_t room = S_ISREG(about.st_mode) ? (size_t)about.st_size + 1 : MOST_BYTES + 1;
        text = array_new(room, 1);
        *length = text == NULL ? 0 : fread(text, 1, room, file);
        if (text == NULL) {
            fail(messages, SELAS_NO_MEMORY, "not enough memory for the deck");
        } else if (ferror(file) != 0 || *length == MOST_BYTES + 1) {
            namelist_message(messages, path, start, true, "cannot be read: %s",
                             ferror(file) != 0 ? strerror(errno) : "too long for a deck");
            array_free(text);
            text = NULL;
        }
    }
    fclose(file);
    return text;
}

selas_status deck_read_file(const char *path, size_t overrides, const char *const *override,
                            struct deck **deck, struct messages *messages)
{
    *deck = NULL;
    const size_t errors = messages->errors;
    size_t length = 0;
    char *text = read_file(path, &length, messages);
    if (text == NULL) return messages_since(messages, errors, SELAS_BAD_DECK);
    const selas_status status = deck_read_text(path, text, length, overrides, override, deck, messages);
    const char *slash = strrchr(path, '/');
    if (*deck != NULL) (*deck)->origin = deck_absolute(*deck, slash != NULL ? slash + 1 : path);
    array_free(text);
    return status;
}

bool deck_changed(const struct deck *deck)
{
    struct messages unsaid = {0};
    struct stat about;
    size_t length = 0;
    if (deck->origin == NULL || stat(deck->origin, &about) != 0 || !S_ISREG(about.st_mode)) return false;
    char *text = read_file(deck->origin, &length, &unsaid);
    const bool changed = text != NULL && (length != deck->length || memcmp(text, deck->source, length) != 0);
    array_free(text);
    messages_free(&unsaid);
    return changed;
}
