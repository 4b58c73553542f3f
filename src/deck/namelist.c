/* Groups and names of namelist text; see namelist.h. */
#include "deck/namelist.h"
#include "base/memory.h"
#include "deck/assignment.h"

#include <string.h>
#include <strings.h>

enum { MOST_GROUPS = 100000 };

static void free_items(struct item *item, size_t count)
{
    for (size_t i = 0; item != NULL && i < count; i++)
        array_free(item[i].value);
    array_free(item);
}

void item_clear(const struct word *word, struct item *item)
{
    for (size_t i = 0; word->type >= WORD_TEXT && i < item->room; i++)
        array_free(item->value[i].as.text);
    array_free(item->value);
    *item = (struct item){0};
}

static void free_texts(const struct word_group *kind, struct item *item)
{
    for (size_t i = 0; item != NULL && i < kind->words; i++)
        for (size_t j = 0; kind->word[i].type >= WORD_TEXT && j < item[i].room; j++)
            array_free(item[i].value[j].as.text);
}

void namelist_drop(struct namelist *list)
{
    const struct deck_group *group = &list->group[--list->groups];
    free_texts(group->kind, group->item);
    free_items(group->item, group->kind->words);
}

void namelist_free(struct namelist *list)
{
    while (list->groups > 0)
        namelist_drop(list);
    array_free(list->group);
    for (size_t i = 0; list->defaults != NULL && i < list->table->groups; i++) {
        free_texts(&list->table->group[i], list->defaults[i].item);
        free_items(list->defaults[i].item, list->table->group[i].words);
    }
    array_free(list->defaults);
    *list = (struct namelist){0};
}

/* True if only blanks stand before a position on its line, or after `earliest`. */
static bool begins_line(const struct scanner *scanner, size_t at, size_t earliest)
{
    while (at > earliest && (scanner->text[at - 1] == ' ' || scanner->text[at - 1] == '\t'))
        at--;
    return at == 0 || at == earliest || scanner->text[at - 1] == '\n';
}

/* True if '&' or '$' at a position begins a line and has a name after it. */
static bool begins_group(const struct scanner *scanner, size_t at, size_t earliest)
{
    const int c = scan_peek(scanner, at);
    return (c == '&' || c == '$') && scan_name_length(scanner, at + 1) > 0 &&
           begins_line(scanner, at, earliest);
}

/* &end or $end, which close a group as '/' does. */
static bool is_end(const struct scanner *scanner, size_t at)
{
    const int c = scan_peek(scanner, at);
    return (c == '&' || c == '$') && scan_name_length(scanner, at + 1) == 3 &&
           strncasecmp(scanner->text + at + 1, "end", 3) == 0;
}

/* After an error: goes on to the next assignment, the group's end or the next group. */
static void recover(struct scanner *scanner)
{
    scanner->at_line_end = false;
    for (;;) {
        const int c = scan_peek(scanner, scanner->at);
        if (c == END_OF_TEXT || c == '/' || is_end(scanner, scanner->at) ||
            begins_group(scanner, scanner->at, 0))
            return;
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
            if (is_end(scanner, scanner->at)) {
                scanner->at += 4;
                return;
            }
            scan_error(scanner, start, "&%s is not closed: expected '/' before line %zu", group->kind->name,
                       scan_place(scanner, scanner->at).line);
            return;
        }
        if (c == '/') {
            scanner->at++;
            return;
        }
        if (c == END_OF_TEXT) {
            scan_error(scanner, start, "&%s is not closed: expected '/' before the end of the text",
                       group->kind->name);
            return;
        }
        while (c == ',' || c == ';' || c == '\n' || c == '\r')
            c = scan_peek(scanner, ++scanner->at);
        if (!scan_assignment(scanner, group)) recover(scanner);
    }
}

struct deck_group *namelist_add(struct namelist *list, size_t kind, struct place place)
{
    if (list->groups == list->room) {
        const size_t room = list->room == 0 ? 16 : 2 * list->room;
        struct deck_group *larger = array_new(room, sizeof *larger);
        if (larger == NULL) return NULL;
        if (list->groups > 0) memcpy(larger, list->group, list->groups * sizeof *larger);
        array_free(list->group);
        list->group = larger;
        list->room = room;
    }
    struct item *item = array_new(list->table->group[kind].words, sizeof *item);
    if (item == NULL) return NULL;
    struct deck_group *group = &list->group[list->groups++];
    *group = (struct deck_group){&list->table->group[kind], place, item, list->defaults[kind].item};
    return group;
}

static void unknown_group(struct scanner *scanner, const struct word_table *table, size_t at)
{
    char quoted[QUOTED_SIZE];
    const size_t length = scan_name_length(scanner, at + 1);
    scan_quote(scanner, at + 1, length, quoted);
    char suggestion[SUGGESTION_SIZE];
    if (words_find_group(table, quoted, length) < table->groups)
        scan_error(scanner, at, "expected a blank after '&%s'", quoted);
    else
        scan_error(scanner, at, "unknown group '&%s'%s", quoted,
                   suggest_group(table, quoted, "&", suggestion));
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
            scan_no_memory(scanner, at);
            return false;
        }
        scanner->at = at + 1 + length;
        read_group(scanner, group, at);
    } else if (begins_group(scanner, at, earliest)) {
        unknown_group(scanner, list->table, at);
        scanner->at = at + 1 + length;
        skip_group(scanner, at);
    } else if (length == 0 && begins_line(scanner, at, earliest)) {
        size_t name = at + 1;
        while (scan_peek(scanner, name) == ' ' || scan_peek(scanner, name) == '\t')
            name++;
        const size_t name_length = scan_name_length(scanner, name);
        if (words_find_group(list->table, scanner->text + name, name_length) < list->table->groups)
            scan_error(scanner, at, "no blank may stand between '%c' and the group's name",
                       scan_peek(scanner, at));
    }
    return true;
}

static bool is_blank(int c)
{
    return c == ' ' || c == '\t';
}

/* A group of the table, with its mark? */
static bool is_known_group(const struct scanner *scanner, size_t at)
{
    const int c = scan_peek(scanner, at);
    const size_t length = c == '&' || c == '$' ? scan_name_length(scanner, at + 1) : 0;
    return length > 0 &&
           words_find_group(scanner->table, scanner->text + at + 1, length) < scanner->table->groups;
}

/* Quotes the text from a position to the end of its line, a comment or a group; false if there is none. */
static bool quote_rest(const struct scanner *scanner, size_t at, char quoted[QUOTED_SIZE])
{
    size_t end = at;
    for (int c = scan_peek(scanner, end);
         c != '\n' && c != '\r' && c != '!' && c != END_OF_TEXT && !is_known_group(scanner, end);
         c = scan_peek(scanner, ++end)) {
    }
    while (end > at && is_blank(scan_peek(scanner, end - 1)))
        end--;
    scan_quote(scanner, at, end - at, quoted);
    return end > at;
}

/* A word of a group, with '=' behind it, outside of the group? */
static bool is_lost(const struct scanner *scanner, size_t at, const struct word_group *kind)
{
    if (at > 0 && is_name_character(scan_peek(scanner, at - 1))) return false;
    const size_t length = scan_name_length(scanner, at);
    return length > 0 && words_find(kind, scanner->text + at, length) < kind->words &&
           scan_is_assignment(scanner, at);
}

/* What stands behind a group's end on its line: gfortran drops the 4 of 1/4 without a word. */
static bool look_behind(struct scanner *scanner, const struct word_group *kind)
{
    char quoted[QUOTED_SIZE];
    size_t at = scanner->at;
    int c = scan_peek(scanner, at);
    const bool slash = at > 0 && scanner->text[at - 1] == '/';
    bool fraction = slash && (is_name_character(c) || c == '.' || c == '+' || c == '-' || c == '*');
    while (is_blank(c) || c == ',' || c == ';')
        c = scan_peek(scanner, ++at);
    fraction = fraction || (slash && ((c >= '0' && c <= '9') || c == '.'));
    if ((c == '&' || c == '$') && scan_name_length(scanner, at + 1) > 0)
        return false; /* a group, known or not */
    if (!quote_rest(scanner, at, quoted) || (!fraction && is_lost(scanner, at, kind))) return false;
    if (fraction)
        scan_error(scanner, scanner->at - 1,
                   "this '/' ends &%s, and '%s' behind it is not read; expected a fraction as one number, "
                   "0.25, or a comment with '!'",
                   kind->name, quoted);
    else
        namelist_message(scanner->messages, scanner->name, scan_place(scanner, at), false,
                         "'%s' behind the end of &%s is not read; a comment begins with '!'", quoted,
                         kind->name);
    return fraction;
}

/* Text before a group on its line does not make a comment of it. */
static void look_before(struct scanner *scanner, size_t at, size_t earliest)
{
    size_t start = at;
    while (start > earliest && scanner->text[start - 1] != '\n')
        start--;
    if (start > 0 && start == earliest) return; /* told as behind the group before */
    if (start == 0 && at >= 3 && memcmp(scanner->text, "\xef\xbb\xbf", 3) == 0) start = 3;
    while (start < at && is_blank(scanner->text[start]))
        start++;
    char quoted[QUOTED_SIZE];
    if (quote_rest(scanner, start, quoted))
        namelist_message(
            scanner->messages, scanner->name, scan_place(scanner, at), false,
            "'%s' before it makes no comment of this group, which is read; a comment begins with '!'",
            quoted);
}

selas_status namelist_read(struct namelist *list, const char *name, const char *text, size_t length,
                           struct messages *messages)
{
    struct scanner scanner = {
        .name = name, .table = list->table, .text = text, .length = length, .messages = messages};
    const char *zero = length > 0 ? memchr(text, '\0', length) : NULL;
    if (zero != NULL) {
        scan_error(&scanner, (size_t)(zero - text), "a byte 0: this is not a text file");
        return SELAS_BAD_DECK;
    }
    size_t earliest = 0;
    const struct word_group *last = NULL; /* the group that has ended, until something behind it is refused */
    for (;;) {
        const size_t at = scanner.at, groups = list->groups;
        const int c = scan_next(&scanner);
        if (c == END_OF_TEXT) break;
        if (c == '!') scan_line(&scanner);
        if (last != NULL && is_lost(&scanner, at, last)) {
            scan_error(
                &scanner, at,
                "this stands outside of a group and would not be read: &%s has ended; take the '/' or &end "
                "before it away, or begin a comment with '!'",
                last->name);
            last = NULL;
        }
        if (c != '&' && c != '$') continue;
        if (!find_group(list, &scanner, at, earliest)) break;
        if (scanner.at == at + 1) continue;
        last = NULL;
        if (list->groups > groups) {
            last = list->group[groups].kind;
            look_before(&scanner, at, earliest);
            if (look_behind(&scanner, last)) last = NULL;
        }
        earliest = scanner.at;
    }
    return scanner.errors == 0 ? SELAS_OK : SELAS_BAD_DECK;
}

selas_status namelist_assign(const struct namelist *list, struct deck_group *group, const char *text,
                             size_t length, struct messages *messages)
{
    struct scanner scanner = {.table = list->table, .text = text, .length = length, .messages = messages};
    const size_t name_length = scan_name_length(&scanner, 0);
    const size_t index = words_find(group->kind, text, name_length);
    if (index < group->kind->words && scan_peek(&scanner, name_length) != '(') { /* replaces it all */
        struct item *item = &group->item[index];
        if (item->place.line != 0) item_clear(&group->kind->word[index], item);
    }
    if (scan_assignment(&scanner, group)) {
        scan_separator(&scanner);
        if (scanner.at < length) scan_error(&scanner, scanner.at, "too many values in '%.200s'", text);
    }
    return scanner.errors == 0 ? SELAS_OK : SELAS_BAD_DECK;
}

static bool read_defaults(struct namelist *list, size_t kind, struct messages *messages)
{
    const struct word_group *words = &list->table->group[kind];
    struct item *items = array_new(words->words, sizeof *items);
    if (items == NULL) return false;
    list->defaults[kind].item = items;
    const struct item none = {0};
    for (size_t i = 0; i < words->words; i++) {
        const struct word *word = &words->word[i];
        if (word->defaults == NULL) continue;
        struct scanner scanner = {
            .text = word->defaults, .length = strlen(word->defaults), .messages = messages};
        const struct target target = {
            .word = word, .item = &items[i], .defaults = &none, .section = {1, (long)word->count, 1, false}};
        if (!scan_values(&scanner, &target)) return false;
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
    if (good) return true;
    namelist_free(list);
    fail(messages, SELAS_NO_MEMORY, "not enough memory for the deck");
    return false;
}
