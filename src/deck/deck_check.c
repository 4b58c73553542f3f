/* What the table of words asks of the values of a deck: ranges, choices, no gaps, nothing obligatory missing.
 */
#include "deck/deck_private.h"

#include <string.h>

static void check_choice(const struct deck *deck, const struct deck_group *group, const struct word *word,
                         const struct value *value, struct messages *messages)
{
    const size_t count = word_choices(word);
    if (word_find_choice(word, value->as.text) < count) return;
    char list[512], choice[64], suggestion[SUGGESTION_SIZE];
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        word_choice(word, i, choice, sizeof choice);
        if (used < sizeof list)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s'%s'", i > 0 ? ", " : "", choice);
    }
    namelist_message(messages, deck->path, value->place, true, "'%.60s' for '%s' in &%s; expected %s%s%s",
                     value->as.text, word->name, group->kind->name, count > 1 ? "one of " : "", list,
                     suggest_choice(word, value->as.text, suggestion));
}

static void check_range(const struct deck *deck, const struct deck_group *group, const struct word *word,
                        const struct value *value, struct messages *messages)
{
    const bool is_real = word->type == WORD_REAL;
    const double number = is_real ? value->as.real : (double)value->as.integer;
    if (word_in_range(word, number)) return;
    char text[32];
    snprintf(text, sizeof text, "%.15g", number);
    if (word->range == NULL)
        namelist_message(messages, deck->path, value->place, true,
                         "%s for '%s' in &%s; expected a finite number", text, word->name, group->kind->name);
    else
        namelist_message(messages, deck->path, value->place, true,
                         "%s for '%s' in &%s; expected a number in %s", text, word->name, group->kind->name,
                         word->range);
}

static void check_text(const struct deck *deck, const struct word *word, const struct value *value,
                       struct messages *messages)
{
    for (const char *c = value->as.text; *c != '\0'; c++)
        if (((unsigned char)*c < ' ' && *c != '\t') || *c == 127) {
            namelist_message(messages, deck->path, value->place, true, "unprintable character %d in '%s'", *c,
                             word->name);
            return;
        }
}

void deck_check_values(const struct deck *deck, const struct deck_group *group, size_t index,
                       struct messages *messages)
{
    const struct word *word = &group->kind->word[index];
    const struct item *item = &group->item[index];
    for (size_t i = 0; i < item->values; i++) {
        const struct value *value = &item->value[i];
        if (!value->given) continue;
        if (word->type == WORD_CHOICE)
            check_choice(deck, group, word, value, messages);
        else if (word->type >= WORD_TEXT)
            check_text(deck, word, value, messages);
        else if (word->type != WORD_LOGICAL)
            check_range(deck, group, word, value, messages);
    }
}

static void check_item(const struct deck *deck, const struct deck_group *group, size_t index,
                       struct messages *messages)
{
    const struct word *word = &group->kind->word[index];
    const struct item *item = &group->item[index];
    for (size_t i = 0; i < item->values; i++)
        if (!item->value[i].given && group_value(group, index, i) == NULL && !item->wrong)
            namelist_message(messages, deck->path, item->place, true, "value %zu of '%s' in &%s is missing%s",
                             i + 1, word->name, group->kind->name, item->comment_null ? COMMENT_NULL : "");
    deck_check_values(deck, group, index, messages);
    if (word->need == OBLIGATORY && item->values == 0 && !item->wrong) {
        const struct place place = item->named ? item->place : group->place;
        namelist_message(messages, deck->path, place, true, "'%s' is missing in &%s: %s%s", word->name,
                         group->kind->name, word->gloss, item->comment_null ? COMMENT_NULL : "");
    }
}

void deck_check(const struct deck *deck, struct messages *messages)
{
    enum { MOST_ERRORS = 100 };
    const size_t errors = messages->errors;
    for (size_t i = 0; i < deck->list.groups; i++) {
        if (messages->errors >= errors + MOST_ERRORS) {
            namelist_message(messages, deck->path, deck->list.group[i].place, true,
                             "too many errors: from here on nothing is checked");
            return;
        }
        const struct deck_group *group = &deck->list.group[i];
        for (size_t j = 0; j < group->kind->words; j++)
            check_item(deck, group, j, messages);
    }
}
