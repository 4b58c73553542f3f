/* A deck made by calls instead of text: groups are added, words are set one by one, the checks follow when it
 * is used. Also the points that a host hands over in memory. */
#include "base/memory.h"
#include "deck/deck_private.h"

#include <stdlib.h>
#include <string.h>

selas_status deck_add(struct deck *deck, const char *group, size_t *number, struct messages *messages)
{
    const struct word_table *table = deck->list.table;
    const size_t kind = words_find_group(table, group, strlen(group));
    char suggestion[SUGGESTION_SIZE];
    if (kind == table->groups)
        return fail(messages, SELAS_BAD_DECK, "unknown group '%.60s'%s", group,
                    suggest_group(table, group, "", suggestion));
    const size_t count = deck->first[kind + 1] - deck->first[kind];
    if (table->group[kind].occurrence != GROUP_MANY && count > 0)
        return fail(messages, SELAS_BAD_DECK, "&%s is there already and may occur once",
                    table->group[kind].name);
    if (namelist_add(&deck->list, kind, (struct place){0, 0}) == NULL || !deck_sort_groups(deck))
        return fail(messages, SELAS_NO_MEMORY, "not enough memory for the deck");
    *number = count + 1;
    return SELAS_OK;
}

/* What "group(2)%name=..." names. */
struct named {
    const struct word_group *kind;
    struct deck_group *group; /* NULL: there is none (yet), or it is not said which */
    size_t word;              /* kind->words: none */
};

static struct named find_named(struct deck *deck, const char *text)
{
    const struct word_table *table = deck->list.table;
    const size_t length = strcspn(text, "(%= ");
    const size_t kind = words_find_group(table, text, length);
    const char *percent = strchr(text, '%');
    if (kind == table->groups || percent == NULL) return (struct named){NULL, NULL, 0};
    const size_t count = deck->first[kind + 1] - deck->first[kind];
    unsigned long number = count == 1 ? 1 : 0;
    if (text[length] == '(') number = strtoul(text + length + 1, NULL, 10);
    struct named named = {&table->group[kind], NULL, 0};
    percent += 1 + strspn(percent + 1, " ");
    named.word = words_find(named.kind, percent, strcspn(percent, "(= "));
    if (number >= 1 && number <= count) named.group = &deck->list.group[deck->first[kind] + number - 1];
    return named;
}

selas_status deck_set(struct deck *deck, const char *text, struct messages *messages)
{
    const size_t errors = messages->errors, groups = deck->list.groups;
    text += strspn(text, " ");
    struct named named = find_named(deck, text);
    const bool known = named.kind != NULL && named.word < named.kind->words;
    struct item kept = {0};
    if (known && named.group != NULL) {
        kept = named.group->item[named.word];
        named.group->item[named.word] = (struct item){0};
    }
    deck_override(deck, text, messages);
    const bool made = deck->list.groups > groups;
    if (made) named.group = &deck->list.group[groups];
    if (known && named.group != NULL && messages->errors == errors)
        deck_check_values(deck, named.group, named.word, messages);
    const selas_status status = messages_since(messages, errors, SELAS_BAD_DECK);
    if (status != SELAS_OK && made) namelist_drop(&deck->list);
    if (known && named.group != NULL && !made) {
        struct item *item = &named.group->item[named.word];
        if (status != SELAS_OK) { /* as it was */
            item_clear(&named.kind->word[named.word], item);
            *item = kept;
        } else {
            item_clear(&named.kind->word[named.word], &kept);
        }
    }
    if (status == SELAS_OK && !deck_sort_groups(deck))
        return fail(messages, SELAS_NO_MEMORY, "not enough memory for the deck");
    return status;
}

selas_status deck_complete(struct deck *deck, struct messages *messages)
{
    const size_t errors = messages->errors;
    deck_check(deck, messages);
    return messages_since(messages, errors, SELAS_BAD_DECK);
}

void deck_hand_points(struct deck *deck, const struct given_points *points)
{
    deck->points = points;
}

const struct given_points *deck_points(const struct deck *deck)
{
    return deck->points;
}
