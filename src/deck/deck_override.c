/* Overrides of the command line: group%name=value, group(2)%name(1:2)=value, quotes around texts optional;
 * group%name= unsets the name. */
#include "base/memory.h"
#include "deck/deck_private.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static void wrong(struct messages *messages, const char *what, const char *text)
{
    namelist_message(messages, NULL, (struct place){0, 0}, true, "%s in '%.200s'; expected group%%name=value",
                     what, text);
}

/* Quotes texts that have none: each of several between commas. `quoted` has room for 2 * length + 8. */
static void quote_texts(const char *text, bool several, char *quoted)
{
    size_t used = 0;
    quoted[used++] = '\'';
    while (*text == ' ')
        text++;
    for (; *text != '\0'; text++) {
        if (several && *text == ',') {
            memcpy(quoted + used, "','", 3);
            used += 3;
            while (text[1] == ' ')
                text++;
            continue;
        }
        if (*text == '\'') quoted[used++] = '\'';
        quoted[used++] = *text;
    }
    quoted[used++] = '\'';
    quoted[used] = '\0';
}

/* True if the value is written as in a deck: it begins with a quote, perhaps after a repeat count. */
static bool has_quotes(const char *text)
{
    text += strspn(text, " ");
    const size_t digits = strspn(text, "0123456789");
    if (digits > 0 && text[digits] == '*') text += digits + 1;
    return *text == '\'' || *text == '"';
}

static bool is_empty(const char *equals)
{
    return equals[1 + strspn(equals + 1, " ")] == '\0';
}

/* "snapshot%every=": as if the deck did not have the name. */
static void unset(const struct deck *deck, struct deck_group *group, const char *name, const char *equals,
                  struct messages *messages)
{
    const size_t length = strcspn(name, "(= "), index = words_find(group->kind, name, length);
    if (index == group->kind->words)
        namelist_assign(&deck->list, group, name, strlen(name),
                        messages); /* knows what may have been meant */
    else if (strcspn(name, "(") < (size_t)(equals - name))
        namelist_message(messages, NULL, (struct place){0, 0}, true,
                         "no value for '%.*s' of &%s; a name without a subscript would be unset", (int)length,
                         name, group->kind->name);
    else
        item_clear(&group->kind->word[index], &group->item[index]);
}

static void assign(const struct deck *deck, struct deck_group *group, const char *name, const char *equals,
                   struct messages *messages)
{
    const size_t size = 2 * strlen(name) + 16;
    const size_t name_length = strcspn(name, "(= ");
    const size_t index = words_find(group->kind, name, name_length);
    char *text = array_new(size, 1);
    if (text == NULL) {
        fail(messages, SELAS_NO_MEMORY, "not enough memory for the override");
        return;
    }
    memcpy(text, name, (size_t)(equals - name) + 1);
    char *value = text + (equals - name) + 1;
    const struct word *word = index < group->kind->words ? &group->kind->word[index] : NULL;
    if (word != NULL && word->type >= WORD_TEXT && !has_quotes(equals + 1))
        quote_texts(equals + 1, word->count > 1, value);
    else
        memcpy(value, equals + 1, strlen(equals + 1));
    namelist_assign(&deck->list, group, text, strlen(text), messages);
    array_free(text);
}

static void unknown_group(const struct deck *deck, const char *text, size_t length, struct messages *messages)
{
    char name[64], suggestion[SUGGESTION_SIZE];
    snprintf(name, sizeof name, "%.*s", length < 60 ? (int)length : 60, text);
    namelist_message(messages, NULL, (struct place){0, 0}, true, "unknown group '%s'%s", name,
                     suggest_group(deck->list.table, name, "", suggestion));
}

/* The group that "group" or "group(2)" means, made if there is none; NULL after an error. */
static struct deck_group *find(struct deck *deck, size_t kind, long number, const char *text,
                               struct messages *messages)
{
    const struct word_group *words = &deck->list.table->group[kind];
    const size_t first = deck->first[kind], count = deck->first[kind + 1] - first;
    const struct place place = {0, 0};
    if (number == 0 && count > 1) {
        namelist_message(messages, NULL, place, true,
                         "which of the %zu groups &%s does '%.200s' mean? Write %s(1)%%... to %s(%zu)%%...",
                         count, words->name, text, words->name, words->name, count);
        return NULL;
    }
    const size_t index = number == 0 ? 0 : (size_t)number - 1;
    const size_t most = words->occurrence == GROUP_MANY || count == 0 ? count + 1 : count;
    if (index >= most) {
        namelist_message(messages, NULL, place, true, "there is no %s(%ld): the deck has %zu", words->name,
                         number, count);
        return NULL;
    }
    if (index < count) return &deck->list.group[first + index];
    struct deck_group *group = namelist_add(&deck->list, kind, place);
    if (group == NULL) fail(messages, SELAS_NO_MEMORY, "not enough memory for the override");
    return group;
}

void deck_override(struct deck *deck, const char *text, struct messages *messages)
{
    const char *start = text + strspn(text, " ");
    const size_t length = strcspn(start, "(%= ");
    const char *percent = start + length;
    const char *equals = strchr(start, '=');
    long number = 0;
    if (equals == NULL || equals < percent) {
        wrong(messages, "no '='", text);
        return;
    }
    if (*percent == '(') {
        char *end;
        number = strtol(percent + 1, &end, 10);
        if (*end != ')' || number < 1 || !isdigit((unsigned char)percent[1])) {
            wrong(messages, "bad number of the group", text);
            return;
        }
        percent = end + 1;
    }
    if (*percent != '%' || percent > equals) {
        wrong(messages, "no '%' between group and name", text);
        return;
    }
    const size_t kind = words_find_group(deck->list.table, start, length);
    if (kind == deck->list.table->groups) {
        unknown_group(deck, start, length, messages);
        return;
    }
    const char *name = percent + 1 + strspn(percent + 1, " ");
    const size_t there = deck->first[kind + 1] - deck->first[kind];
    if (is_empty(equals) && (there == 0 || (size_t)number > there)) {
        namelist_message(messages, NULL, (struct place){0, 0}, true,
                         "'%.200s' would unset a name, but the deck has %zu groups &%.*s", text, there,
                         (int)length, start);
        return;
    }
    struct deck_group *group = find(deck, kind, number, text, messages);
    if (group == NULL) return;
    if (is_empty(equals))
        unset(deck, group, name, equals, messages);
    else
        assign(deck, group, name, equals, messages);
}
