/* Access to the values of a deck, and errors at their places. */
#include "deck/deck.h"
#include "base/memory.h"
#include "deck/deck_private.h"

#include <assert.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

size_t deck_count(const struct deck *deck, const char *group)
{
    const size_t kind = words_find_group(deck->list.table, group, strlen(group));
    assert(kind < deck->list.table->groups);
    return deck->first[kind + 1] - deck->first[kind];
}

const struct deck_group *deck_get(const struct deck *deck, const char *group, size_t index)
{
    assert(index < deck_count(deck, group));
    const size_t kind = words_find_group(deck->list.table, group, strlen(group));
    return &deck->list.group[deck->first[kind] + index];
}

static const struct item *group_item(const struct deck_group *group, const char *name, size_t *index)
{
    *index = words_find(group->kind, name, strlen(name));
    assert(*index < group->kind->words);
    return &group->item[*index];
}

size_t group_values(const struct deck_group *group, size_t word)
{
    const size_t given = group->item[word].values;
    return given > 0 ? given : group->defaults[word].values;
}

const struct value *group_value(const struct deck_group *group, size_t word, size_t i)
{
    const struct item *item = &group->item[word], *defaults = &group->defaults[word];
    if (i < item->values && item->value[i].given) return &item->value[i];
    return i < defaults->values ? &defaults->value[i] : NULL;
}

static const struct value *typed_value(const struct deck_group *group, const char *name, size_t i,
                                       bool (*right)(enum word_type))
{
    size_t word;
    group_item(group, name, &word);
    assert(right(group->kind->word[word].type));
    const struct value *value = group_value(group, word, i);
    assert(value != NULL);
    (void)right;
    return value;
}

static bool is_real(enum word_type type)
{
    return type == WORD_REAL;
}

static bool is_integer(enum word_type type)
{
    return type == WORD_INTEGER;
}

static bool is_logical(enum word_type type)
{
    return type == WORD_LOGICAL;
}

static bool is_text(enum word_type type)
{
    return type >= WORD_TEXT;
}

static bool same_value(enum word_type type, const struct value *one, const struct value *other)
{
    switch (type) {
    case WORD_REAL:
        return one->as.real == other->as.real;
    case WORD_INTEGER:
        return one->as.integer == other->as.integer;
    case WORD_LOGICAL:
        return one->as.logical == other->as.logical;
    case WORD_TEXT:
    case WORD_FILE:
    case WORD_CHOICE:
        return strcmp(one->as.text, other->as.text) == 0;
    }
    return false;
}

const char *deck_word(const struct deck_group *group, size_t i)
{
    return i < group->kind->words ? group->kind->word[i].name : NULL;
}

bool deck_given(const struct deck_group *group, const char *name)
{
    size_t word;
    const struct item *item = group_item(group, name, &word), *defaults = &group->defaults[word];
    for (size_t i = 0; i < item->values; i++) {
        if (!item->value[i].given) continue;
        if (i >= defaults->values ||
            !same_value(group->kind->word[word].type, &item->value[i], &defaults->value[i]))
            return true;
    }
    return false;
}

size_t deck_values(const struct deck_group *group, const char *name)
{
    size_t word;
    group_item(group, name, &word);
    return group_values(group, word);
}

double deck_real(const struct deck_group *group, const char *name, size_t i)
{
    return typed_value(group, name, i, is_real)->as.real;
}

long deck_integer(const struct deck_group *group, const char *name, size_t i)
{
    return typed_value(group, name, i, is_integer)->as.integer;
}

bool deck_logical(const struct deck_group *group, const char *name, size_t i)
{
    return typed_value(group, name, i, is_logical)->as.logical;
}

const char *deck_text(const struct deck_group *group, const char *name, size_t i)
{
    return typed_value(group, name, i, is_text)->as.text;
}

/* The word that has the choices of a name. */
static const struct word *choice_word(const struct deck_group *group, const char *name)
{
    size_t word;
    group_item(group, name, &word);
    assert(group->kind->word[word].type == WORD_CHOICE);
    return &group->kind->word[word];
}

size_t deck_choice(const struct deck_group *group, const char *name, size_t i)
{
    return word_find_choice(choice_word(group, name), deck_text(group, name, i));
}

bool deck_chosen(const struct deck_group *group, const char *name, const char *choice)
{
    if (group == NULL || deck_values(group, name) == 0) return false;
    assert(word_find_choice(choice_word(group, name), choice) < word_choices(choice_word(group, name)));
    return strcmp(deck_text(group, name, 0), choice) == 0;
}

bool deck_says(const struct deck_group *group, const char *name, const char *text)
{
    size_t word;
    group_item(group, name, &word);
    const struct value *value = group_value(group, word, 0);
    if (value == NULL) return false;
    switch (group->kind->word[word].type) {
    case WORD_REAL:
        return value->as.real == strtod(text, NULL);
    case WORD_INTEGER:
        return value->as.integer == strtol(text, NULL, 10);
    case WORD_LOGICAL:
        return value->as.logical == (strcmp(text, ".true.") == 0);
    case WORD_TEXT:
    case WORD_FILE:
    case WORD_CHOICE:
        return strcmp(value->as.text, text) == 0;
    }
    return false;
}

const char *deck_source_path(const struct deck *deck)
{
    return deck->path;
}

const char *deck_name(const struct deck *deck)
{
    return deck->name;
}

const char *deck_source(const struct deck *deck)
{
    return deck->source;
}

static char *copy_of(const char *text)
{
    const size_t size = strlen(text) + 1;
    char *copy = array_new(size, 1);
    if (copy != NULL) memcpy(copy, text, size);
    return copy;
}

selas_status deck_set_source(struct deck *deck, const char *source, const char *origin,
                             struct messages *messages)
{
    char *copy = copy_of(source), *path = origin != NULL && *origin != '\0' ? copy_of(origin) : NULL;
    array_free(deck->origin);
    deck->origin = path;
    if (copy == NULL) return fail(messages, SELAS_NO_MEMORY, "not enough memory for the deck");
    array_free(deck->source);
    deck->source = copy;
    deck->length = strlen(source);
    return SELAS_OK;
}

const char *deck_origin(const struct deck *deck)
{
    return deck->origin != NULL ? deck->origin : "";
}

static void message_at(const struct deck *deck, const struct deck_group *group, const char *name,
                       struct messages *messages, bool is_error, const char *text)
{
    struct place place = group->place;
    if (name != NULL) {
        size_t word;
        const struct item *item = group_item(group, name, &word);
        if (item->named) place = item->place;
    }
    namelist_message(messages, deck->path, place, is_error, "%s", text);
}

selas_status deck_error(const struct deck *deck, const struct deck_group *group, const char *name,
                        struct messages *messages, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    message_at(deck, group, name, messages, true, text);
    return SELAS_BAD_DECK;
}

void deck_warning(const struct deck *deck, const struct deck_group *group, const char *name,
                  struct messages *messages, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    message_at(deck, group, name, messages, false, text);
}

void deck_free(struct deck **deck)
{
    if (deck == NULL || *deck == NULL) return;
    namelist_free(&(*deck)->list);
    array_free((*deck)->path);
    array_free((*deck)->name);
    array_free((*deck)->directory);
    free((*deck)->here);
    array_free((*deck)->source);
    array_free((*deck)->origin);
    array_free((*deck)->first);
    array_free(*deck);
    *deck = NULL;
}
