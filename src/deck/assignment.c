/* Assignments of namelist text: the name, its subscript and the values, stored in the group's items. */
#include "deck/assignment.h"
#include "base/memory.h"
#include "selas.h"

#include <string.h>

/* Makes room for `count` values. */
static bool reserve(struct item *item, size_t count)
{
    if (count <= item->room) return true;
    size_t room = item->room == 0 ? 1 : item->room;
    while (room < count)
        room *= 2;
    struct value *value = array_new(room, sizeof *value);
    if (value == NULL) return false;
    if (item->value != NULL) memcpy(value, item->value, item->room * sizeof *value);
    array_free(item->value);
    item->value = value;
    item->room = room;
    return true;
}

static bool copy_text(struct value *value)
{
    const size_t size = strlen(value->as.text) + 1;
    char *text = array_new(size, 1);
    if (text == NULL) return false;
    memcpy(text, value->as.text, size);
    value->as.text = text;
    return true;
}

/* Puts value->as.text into part of the text that the element holds already (or has by default). */
static bool keep_substring(const struct target *target, size_t index, struct value *value)
{
    const size_t first = (size_t)target->substring.first - 1, last = (size_t)target->substring.last;
    const struct value *held = &target->item->value[index];
    const char *old = held->given ? held->as.text : NULL;
    if (old == NULL && index < target->defaults->values) old = target->defaults->value[index].as.text;
    char *text = array_new(TEXT_SIZE, 1);
    if (text == NULL) return false;
    memset(text, ' ', TEXT_SIZE - 1);
    if (old != NULL) memcpy(text, old, strlen(old));
    const size_t length = strnlen(value->as.text, last - first);
    memset(text + first, ' ', last - first);
    memcpy(text + first, value->as.text, length);
    for (size_t i = TEXT_SIZE - 1; i > 0 && text[i - 1] == ' '; i--)
        text[i - 1] = '\0';
    array_free(value->as.text);
    value->as.text = text;
    return true;
}

/* Stores a value in the element `index`; texts are copied. */
static bool store(const struct target *target, size_t index, struct value value)
{
    struct item *item = target->item;
    const bool is_text = target->word->type >= WORD_TEXT;
    if (!reserve(item, index + 1)) return false;
    if (is_text && !copy_text(&value)) return false;
    if (is_text && target->substring.last > 0 && !keep_substring(target, index, &value)) return false;
    if (is_text) array_free(item->value[index].as.text);
    item->value[index] = value;
    item->value[index].given = true;
    if (item->values < index + 1) item->values = index + 1;
    return true;
}

/* An override may give again what the deck gives, but not what another override gave. */
static bool is_given_twice(const struct scanner *scanner, const struct target *target, size_t index)
{
    const struct item *item = target->item;
    if (index >= item->room || !item->value[index].given || target->substring.last > 0) return false;
    return scanner->name != NULL || item->value[index].place.line == 0;
}

/* Reads the next value and its separator if the repeat count of the last one is used up. */
static enum scanned next_value(struct scanner *scanner, const struct target *target, enum scanned last,
                               struct value *value)
{
    if (--scanner->repeat > 0) return last;
    if (!scanner->complete && scanner->at_line_end) scan_rest_of_separator(scanner);
    if (scanner->complete) return SCANNED_NAME;
    if (target->word->type >= WORD_TEXT) array_free(value->as.text);
    *value = (struct value){0};
    return scan_value(scanner, target->word, value);
}

bool scan_values(struct scanner *scanner, const struct target *target)
{
    const struct section *section = &target->section;
    const struct word *word = target->word;
    struct value value = {0};
    enum scanned scanned = SCANNED_NULL;
    bool good = true;
    long i = section->first;
    scanner->repeat = 0;
    scan_blanks(scanner);
    for (; section->step > 0 ? i <= section->last : i >= section->last; i += section->step) {
        scanned = next_value(scanner, target, scanned, &value);
        if (scanned == SCANNED_NAME || scanned == SCANNED_WRONG) break;
        if (scanned == SCANNED_NULL) continue;
        const size_t index = (size_t)i - 1;
        if (good && is_given_twice(scanner, target, index)) {
            scan_error(scanner, target->at, "value %ld of '%s' is given twice", i, word->name);
            good = false;
        }
        if (!store(target, index, value)) {
            scan_no_memory(scanner, target->at);
            scanned = SCANNED_WRONG;
            break;
        }
    }
    if (word->type >= WORD_TEXT) array_free(value.as.text);
    if (scanned == SCANNED_WRONG) return false;
    if (scanned != SCANNED_NAME && !scanner->complete) scanner->full = word;
    if (scanner->repeat > 1) {
        scan_error(scanner, target->at, "too many values for '%s': at most %zu", word->name, word->count);
        return false;
    }
    return good;
}

/* Reads what stands in brackets after the name. */
static bool read_subscripts(struct scanner *scanner, struct target *target)
{
    const struct word *word = target->word;
    target->section = (struct section){1, (long)word->count, 1, false};
    target->substring = (struct section){1, 0, 1, false};
    const size_t start = scanner->at;
    bool subscripted = false;
    if (scan_peek(scanner, scanner->at) == '(' && word->count > 1) {
        if (!scan_subscript(scanner, &target->section, false)) return false;
        subscripted = true;
        if (!target->section.range) target->section.last = (long)word->count;
    }
    if (scan_peek(scanner, scanner->at) == '(' && word->type >= WORD_TEXT) {
        target->substring.last = TEXT_SIZE - 1;
        if (!scan_subscript(scanner, &target->substring, true)) return false;
        subscripted = true;
    }
    if (scan_peek(scanner, scanner->at) == '(') {
        scan_error(scanner, start, "'%s' takes one value and no subscript", word->name);
        return false;
    }
    struct item *item = target->item;
    const struct place before = item->place;
    if (item->named && (!subscripted || item->whole) && (scanner->name != NULL || before.line == 0)) {
        if (before.line != 0)
            scan_error(scanner, target->at, "'%s' is given twice in one group (first on line %zu)",
                       word->name, before.line);
        else
            scan_error(scanner, target->at, "'%s' is given twice", word->name);
        return false;
    }
    item->whole = !subscripted;
    return true;
}

/* Index of the word that took the place of one that goes, with a warning; else the number of words. */
static size_t successor(struct scanner *scanner, const struct word_group *kind, size_t at,
                        const struct retired_word *retired)
{
    if (retired == NULL || strcmp(retired->until, SELAS_VERSION) != 0) return kind->words;
    namelist_message(scanner->messages, scanner->name, scan_place(scanner, at), false,
                     "'%s' in &%s is for the last time in version %s; write '%s'", retired->old, kind->name,
                     retired->until, retired->now);
    return words_find(kind, retired->now, strlen(retired->now));
}

static void unknown_word(struct scanner *scanner, const struct word_group *kind, size_t at, size_t length,
                         const struct retired_word *retired)
{
    char quoted[QUOTED_SIZE], suggestion[SUGGESTION_SIZE];
    if (retired != NULL) {
        scan_error(scanner, at, "'%s' in &%s was for the last time in version %s; write '%s'", retired->old,
                   kind->name, retired->until, retired->now);
        return;
    }
    scan_quote(scanner, at, length, quoted);
    scan_error(scanner, at, "unknown name '%s' in &%s%s", quoted, kind->name,
               suggest_word(scanner->table, kind, quoted, suggestion));
}

bool scan_assignment(struct scanner *scanner, struct deck_group *group)
{
    const size_t at = scanner->at, length = scan_name_length(scanner, at);
    char quoted[QUOTED_SIZE];
    if (length == 0 || !scan_is_assignment(scanner, at)) {
        size_t end = at + (length > 0 ? length : 1);
        while (!is_separator(scan_peek(scanner, end)))
            end++;
        scan_quote(scanner, at, end - at, quoted);
        const bool is_word = words_find(group->kind, scanner->text + at, length) < group->kind->words;
        if (length > 0 && is_word)
            scan_error(scanner, at, "no '=' behind '%.*s' of &%s", (int)length, scanner->text + at,
                       group->kind->name);
        else if (scanner->full != NULL)
            scan_error(scanner, at, "too many values for '%s': '%s'; expected %s%zu%s%s", scanner->full->name,
                       quoted, scanner->full->count > 1 ? "at most " : "", scanner->full->count,
                       scanner->full->type == WORD_REAL && scanner->full->count == 1
                           ? " (decimals have a point, 0.5)"
                           : "",
                       scanner->comment_null ? COMMENT_NULL : "");
        else
            scan_error(scanner, at, "expected 'name =' or '/' in &%s, found '%s'", group->kind->name, quoted);
        scanner->at = end;
        return false;
    }
    scanner->full = NULL;
    scanner->at = at + length;
    size_t index = words_find(group->kind, scanner->text + at, length);
    const struct retired_word *retired = words_find_retired(group->kind, scanner->text + at, length);
    if (index == group->kind->words) index = successor(scanner, group->kind, at, retired);
    if (index == group->kind->words) {
        unknown_word(scanner, group->kind, at, length, retired);
        return false;
    }
    struct target target = {.word = &group->kind->word[index],
                            .item = &group->item[index],
                            .defaults = &group->defaults[index],
                            .at = at};
    target.item->wrong = true; /* until all is well */
    if (!read_subscripts(scanner, &target)) return false;
    target.item->named = true;
    target.item->place = scan_place(scanner, at);
    scan_separator(scanner);
    if (scanner->at_line_end) scan_rest_of_separator(scanner);
    if (scan_next(scanner) != '=') {
        scan_error(scanner, at, "expected '=' after '%s'", scan_quote(scanner, at, length, quoted));
        return false;
    }
    scanner->comment_null = false;
    target.item->wrong = !scan_values(scanner, &target);
    target.item->comment_null = scanner->comment_null;
    return !target.item->wrong;
}
