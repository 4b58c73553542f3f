/* Groups and names of namelist text; see namelist.h. */
#include "deck/namelist.h"
#include "base/memory.h"
#include "deck/scanner.h"
#include "deck/subscript.h"

#include <string.h>
#include <strings.h>

enum { MOST_GROUPS = 100000 };

static void free_items(struct item *item, size_t count)
{
    for (size_t i = 0; item != NULL && i < count; i++)
        array_free(item[i].value);
    array_free(item);
}

static void free_texts(const struct word_group *kind, struct item *item)
{
    for (size_t i = 0; item != NULL && i < kind->words; i++)
        for (size_t j = 0; kind->word[i].type >= WORD_TEXT && j < item[i].room; j++)
            array_free(item[i].value[j].as.text);
}

static void free_group(struct deck_group *group)
{
    free_texts(group->kind, group->item);
    free_items(group->item, group->kind->words);
    array_free(group);
}

void namelist_free(struct namelist *list)
{
    for (size_t i = 0; i < list->groups; i++)
        free_group(list->group[i]);
    array_free(list->group);
    for (size_t i = 0; list->defaults != NULL && i < list->table->groups; i++) {
        free_texts(&list->table->group[i], list->defaults[i]);
        free_items(list->defaults[i], list->table->group[i].words);
    }
    array_free(list->defaults);
    *list = (struct namelist){0};
}

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

/* Where values of an assignment go. */
struct target {
    const struct word *word;
    struct item *item;
    const struct item *defaults;
    struct section section;
    struct section substring; /* last = 0: the whole text */
    size_t at;                /* of the name */
};

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

/* Stores a value in the element `index`; takes value->as.text if `own`, else copies it. */
static bool store(const struct target *target, size_t index, struct value value, bool own)
{
    struct item *item = target->item;
    const bool is_text = target->word->type >= WORD_TEXT;
    if (!reserve(item, index + 1)) return false;
    if (is_text && !own && !copy_text(&value)) return false;
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

/* Reads the values of one assignment. Returns false if something was wrong (reported). */
static bool read_values(struct scanner *scanner, const struct target *target)
{
    struct value value = {0};
    enum scanned scanned = SCANNED_NULL;
    bool good = true, stored = false;
    const struct section *section = &target->section;
    scanner->repeat = 0;
    scan_blanks(scanner);
    for (long i = section->first; section->step > 0 ? i <= section->last : i >= section->last;
         i += section->step) {
        if (--scanner->repeat <= 0) {
            if (!scanner->complete && scanner->at_line_end) scan_rest_of_separator(scanner);
            if (scanner->complete) break;
            if (scanned == SCANNED_VALUE && !stored && target->word->type >= WORD_TEXT)
                array_free(value.as.text);
            value = (struct value){0};
            stored = false;
            scanned = scan_value(scanner, target->word, &value);
            if (scanned == SCANNED_NAME || scanned == SCANNED_WRONG) break;
        }
        if (scanned != SCANNED_VALUE) continue;
        const size_t index = (size_t)i - 1;
        if (is_given_twice(scanner, target, index)) {
            scan_error(scanner, target->at, "value %ld of '%s' is given twice", i, target->word->name);
            good = false;
        }
        if (!store(target, index, value, !stored)) {
            scan_error(scanner, target->at, "not enough memory");
            return false;
        }
        stored = true;
    }
    if (scanned == SCANNED_WRONG) return false;
    if (scanned != SCANNED_NAME && !scanner->complete) scanner->full = target->word->name;
    if (scanner->repeat > 1) {
        scan_error(scanner, target->at, "too many values for '%s': at most %zu", target->word->name,
                   target->word->count);
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

static void unknown_word(struct scanner *scanner, const struct word_group *kind, size_t at, size_t length)
{
    char quoted[QUOTED_SIZE];
    scan_quote(scanner, at, length, quoted);
    const char *nearest = words_nearest(kind, quoted);
    if (*nearest != '\0')
        scan_error(scanner, at, "unknown name '%s' in &%s; did you mean '%s'?", quoted, kind->name, nearest);
    else
        scan_error(scanner, at, "unknown name '%s' in &%s", quoted, kind->name);
}

/* Reads "name(subscript) = values"; the scanner is at the name. */
static bool read_assignment(struct scanner *scanner, struct deck_group *group)
{
    const size_t at = scanner->at, length = scan_name_length(scanner, at);
    char quoted[QUOTED_SIZE];
    if (length == 0 || !scan_is_assignment(scanner, at)) {
        size_t end = at + (length > 0 ? length : 1);
        while (!is_separator(scan_peek(scanner, end)))
            end++;
        scan_quote(scanner, at, end - at, quoted);
        if (scanner->full != NULL)
            scan_error(scanner, at, "too many values for '%s': '%s'", scanner->full, quoted);
        else
            scan_error(scanner, at, "expected 'name =' or '/' in &%s, found '%s'", group->kind->name, quoted);
        scanner->at = end;
        return false;
    }
    scanner->full = NULL;
    scanner->at = at + length;
    const size_t index = words_find(group->kind, scanner->text + at, length);
    if (index == group->kind->words) {
        unknown_word(scanner, group->kind, at, length);
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
    target.item->wrong = !read_values(scanner, &target);
    return !target.item->wrong;
}

/* True if '&' or '$' at a position begins a line (after blanks) and has a letter after it. */
static bool begins_group(const struct scanner *scanner, size_t at, size_t earliest)
{
    const int c = scan_peek(scanner, at);
    if ((c != '&' && c != '$') || scan_name_length(scanner, at + 1) == 0) return false;
    while (at > earliest && (scanner->text[at - 1] == ' ' || scanner->text[at - 1] == '\t'))
        at--;
    return at == 0 || at == earliest || scanner->text[at - 1] == '\n';
}

/* After an error: goes on to the next assignment, the group's end or the next group. */
static void recover(struct scanner *scanner)
{
    scanner->at_line_end = false;
    for (;;) {
        const int c = scan_peek(scanner, scanner->at);
        if (c == END_OF_TEXT || c == '/' || begins_group(scanner, scanner->at, 0)) return;
        if (c == '!') {
            scan_line(scanner);
            scanner->at_line_end = false;
        } else if (c == '\'' || c == '"') {
            const char *close = memchr(scanner->text + scanner->at + 1, c, scanner->length - scanner->at - 1);
            if (close == NULL)
                scanner->at = scanner->length;
            else
                scanner->at = (size_t)(close - scanner->text) + 1;
        } else if (is_name_character(c)) {
            if (scan_is_assignment(scanner, scanner->at)) return;
            while (is_name_character(scan_peek(scanner, scanner->at)))
                scanner->at++;
        } else {
            scanner->at++;
        }
    }
}

/* Reads the names of a group up to its end; the scanner is after the group's name. */
static void read_group(struct scanner *scanner, struct deck_group *group, size_t start)
{
    scanner->complete = false;
    scanner->at_line_end = false;
    scanner->full = NULL;
    scan_separator(scanner);
    while (!scanner->complete) {
        scan_separator(scanner);
        if (!scanner->complete && scanner->at_line_end) scan_rest_of_separator(scanner);
        if (scanner->complete) return;
        int c = scan_peek(scanner, scanner->at);
        if (c == '&' || c == '$') {
            if (strncasecmp(scanner->text + scanner->at + 1, "end", 3) == 0 &&
                scan_name_length(scanner, scanner->at + 1) == 3) {
                scanner->at += 4;
                return;
            }
            scan_error(scanner, start, "&%s is not closed: expected '/' before line %zu", group->kind->name,
                       scan_place(scanner, scanner->at).line);
            return;
        }
        if (c == END_OF_TEXT) {
            scan_error(scanner, start, "&%s is not closed: expected '/' before the end of the text",
                       group->kind->name);
            return;
        }
        while (c == ',' || c == ';' || c == '\n' || c == '\r')
            c = scan_peek(scanner, ++scanner->at);
        if (!read_assignment(scanner, group)) recover(scanner);
    }
}

struct deck_group *namelist_add(struct namelist *list, size_t kind, struct place place)
{
    if (list->groups == list->room) {
        const size_t room = list->room == 0 ? 16 : 2 * list->room;
        struct deck_group **larger = array_new(room, sizeof *larger);
        if (larger == NULL) return NULL;
        if (list->groups > 0) memcpy(larger, list->group, list->groups * sizeof *larger);
        array_free(list->group);
        list->group = larger;
        list->room = room;
    }
    struct deck_group *group = array_new(1, sizeof *group);
    struct item *item = array_new(list->table->group[kind].words, sizeof *item);
    if (group == NULL || item == NULL) {
        array_free(group);
        array_free(item);
        return NULL;
    }
    *group = (struct deck_group){&list->table->group[kind], place, item, list->defaults[kind]};
    list->group[list->groups++] = group;
    return group;
}

static void unknown_group(struct scanner *scanner, const struct word_table *table, size_t at)
{
    char quoted[QUOTED_SIZE];
    const size_t length = scan_name_length(scanner, at + 1);
    scan_quote(scanner, at + 1, length, quoted);
    const char *nearest = words_nearest_group(table, quoted);
    if (words_find_group(table, quoted, length) < table->groups)
        scan_error(scanner, at, "expected a blank after '&%s'", quoted);
    else if (*nearest != '\0')
        scan_error(scanner, at, "unknown group '&%s'; did you mean '&%s'?", quoted, nearest);
    else
        scan_error(scanner, at, "unknown group '&%s'", quoted);
}

/* Skips a group that nobody knows. */
static void skip_group(struct scanner *scanner, size_t start)
{
    for (;;) {
        recover(scanner);
        const int c = scan_peek(scanner, scanner->at);
        if (c == '/') {
            scanner->at++;
            return;
        }
        if (c == END_OF_TEXT || c == '&' || c == '$') {
            if (c == END_OF_TEXT || strncasecmp(scanner->text + scanner->at + 1, "end", 3) != 0)
                scan_error(scanner, start, "the group is not closed: expected '/'");
            else
                scanner->at += 4;
            return;
        }
        scanner->at += scan_name_length(scanner, scanner->at); /* an assignment */
    }
}

/* Handles '&' or '$' outside groups; `earliest` is where the last group ended. */
static bool find_group(struct namelist *list, struct scanner *scanner, size_t at, size_t earliest)
{
    const size_t length = scan_name_length(scanner, at + 1);
    const size_t kind = words_find_group(list->table, scanner->text + at + 1, length);
    const int after = scan_peek(scanner, at + 1 + length);
    if (kind < list->table->groups && (is_separator(after) || after == '!')) {
        if (list->groups == MOST_GROUPS) {
            scan_error(scanner, at, "more than %d groups", MOST_GROUPS);
            return false;
        }
        struct deck_group *group = namelist_add(list, kind, scan_place(scanner, at));
        if (group == NULL) {
            scan_error(scanner, at, "not enough memory");
            return false;
        }
        scanner->at = at + 1 + length;
        read_group(scanner, group, at);
    } else if (begins_group(scanner, at, earliest)) {
        unknown_group(scanner, list->table, at);
        scanner->at = at + 1 + length;
        skip_group(scanner, at);
    }
    return true;
}

selas_status namelist_read(struct namelist *list, const char *name, const char *text, size_t length,
                           struct messages *messages)
{
    struct scanner scanner = {.name = name, .text = text, .length = length, .messages = messages};
    const char *zero = length > 0 ? memchr(text, '\0', length) : NULL;
    if (zero != NULL) {
        scan_error(&scanner, (size_t)(zero - text), "a byte 0: this is not a text file");
        return SELAS_BAD_DECK;
    }
    size_t earliest = 0;
    for (;;) {
        const int c = scan_next(&scanner);
        if (c == END_OF_TEXT) break;
        if (c == '!') scan_line(&scanner);
        if (c != '&' && c != '$') continue;
        const size_t after = scanner.at;
        if (!find_group(list, &scanner, after - 1, earliest)) break;
        if (scanner.at != after) earliest = scanner.at;
    }
    return scanner.errors == 0 ? SELAS_OK : SELAS_BAD_DECK;
}

selas_status namelist_assign(struct deck_group *group, const char *text, size_t length,
                             struct messages *messages)
{
    struct scanner scanner = {.text = text, .length = length, .messages = messages};
    const size_t name_length = scan_name_length(&scanner, 0);
    const size_t index = words_find(group->kind, text, name_length);
    if (index < group->kind->words && scan_peek(&scanner, name_length) != '(') { /* replaces it all */
        struct item *item = &group->item[index];
        if (item->place.line != 0) {
            for (size_t i = 0; group->kind->word[index].type >= WORD_TEXT && i < item->room; i++)
                array_free(item->value[i].as.text);
            array_free(item->value);
            *item = (struct item){0};
        }
    }
    if (read_assignment(&scanner, group)) {
        scan_separator(&scanner);
        if (scanner.at < length) scan_error(&scanner, scanner.at, "too many values in '%.200s'", text);
    }
    return scanner.errors == 0 ? SELAS_OK : SELAS_BAD_DECK;
}

static bool read_defaults(struct namelist *list, size_t kind, struct messages *messages)
{
    const struct word_group *words = &list->table->group[kind];
    list->defaults[kind] = array_new(words->words, sizeof **list->defaults);
    if (list->defaults[kind] == NULL) return false;
    const struct item none = {0};
    for (size_t i = 0; i < words->words; i++) {
        const struct word *word = &words->word[i];
        if (word->defaults == NULL) continue;
        struct scanner scanner = {
            .text = word->defaults, .length = strlen(word->defaults), .messages = messages};
        const struct target target = {.word = word,
                                      .item = &list->defaults[kind][i],
                                      .defaults = &none,
                                      .section = {1, (long)word->count, 1, false}};
        if (!read_values(&scanner, &target)) return false;
    }
    return true;
}

bool namelist_begin(struct namelist *list, const struct word_table *table, struct messages *messages)
{
    *list = (struct namelist){.table = table};
    list->defaults = array_new(table->groups, sizeof *list->defaults);
    bool good = list->defaults != NULL;
    for (size_t i = 0; good && i < table->groups; i++)
        good = read_defaults(list, i, messages);
    if (!good) namelist_free(list);
    return good;
}
