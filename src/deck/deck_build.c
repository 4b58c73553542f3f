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

/* The item that "group(2)%name=..." names, NULL if there is none (yet). */
static struct item *named_item(struct deck *deck, const char *text)
{
    const struct word_table *table = deck->list.table;
    const size_t length = strcspn(text, "(%= ");
    const size_t kind = words_find_group(table, text, length);
    const char *percent = strchr(text, '%');
    if (kind == table->groups || percent == NULL) return NULL;
    const size_t count = deck->first[kind + 1] - deck->first[kind];
    const unsigned long number = text[length] == '(' ? strtoul(text + length + 1, NULL, 10) : 1;
    const size_t word = words_find(&table->group[kind], percent + 1, strcspn(percent + 1, "(= "));
    if (number < 1 || number > count || word == table->group[kind].words) return NULL;
    return &deck->list.group[deck->first[kind] + number - 1].item[word];
}

static void clear(struct deck *deck, const char *text)
{
    struct item *item = named_item(deck, text);
    if (item == NULL) return;
    const struct word_table *table = deck->list.table;
    const size_t kind = words_find_group(table, text, strcspn(text, "(%= "));
    const char *name = strchr(text, '%') + 1;
    const struct word *word =
        &table->group[kind].word[words_find(&table->group[kind], name, strcspn(name, "(= "))];
    item_clear(word, item);
}

selas_status deck_set(struct deck *deck, const char *text, struct messages *messages)
{
    const size_t errors = messages->errors;
    clear(deck, text);
    deck_override(deck, text, messages);
    if (!deck_sort_groups(deck)) return fail(messages, SELAS_NO_MEMORY, "not enough memory for the deck");
    const selas_status status = messages_since(messages, errors, SELAS_BAD_DECK);
    if (status != SELAS_OK) clear(deck, text);
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
