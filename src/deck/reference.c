/* The table of words for those who read: as Markdown for the manual, as text for `selas words`. */
#include "deck/deck.h"
#include "deck/words.h"

#include <string.h>

enum { WIDTH = 80, INDENT = 6, GROUP_INDENT = 13, LINE_SIZE = 1024 };

static const char *const types[] = {"real", "integer", "logical", "text", "file", "text"};
static const char *const occurrences[] = {"always there, at most once in a deck", "at most once",
                                          "as often as wanted"};

/* "real", "real, up to 3" */
static const char *type_text(const struct word *word, char text[LINE_SIZE])
{
    const int used = snprintf(text, LINE_SIZE, "%s", types[word->type]);
    if (word->count > 1) snprintf(text + used, (size_t)(LINE_SIZE - used), ", up to %zu", word->count);
    return text;
}

/* "[0, inf)", "'exact', 'same'", or "" */
static const char *values_text(const struct word *word, char text[LINE_SIZE])
{
    char choice[TEXT_SIZE];
    int used =
        snprintf(text, LINE_SIZE, "%s", word->type == WORD_CHOICE || word->range == NULL ? "" : word->range);
    for (size_t i = 0; word->type == WORD_CHOICE && i < word_choices(word) && used < LINE_SIZE; i++) {
        word_choice(word, i, choice, sizeof choice);
        used += snprintf(text + used, (size_t)(LINE_SIZE - used), "%s'%s'", i > 0 ? ", " : "", choice);
    }
    return text;
}

static bool has_experts(const struct word_group *group)
{
    size_t i = 0;
    while (i < group->words && group->word[i].need != EXPERT)
        i++;
    return i < group->words;
}

/* "| `low` | real, up to 3; default 0, 0, 0 | meaning |"; a list of words needs no type */
static void write_row(const struct word *word, FILE *file)
{
    char type[LINE_SIZE], values[LINE_SIZE];
    const bool listed = word->type == WORD_CHOICE;
    values_text(word, values);
    fprintf(file, "| `%s` | ", word->name);
    if (!listed || word->count > 1) fputs(type_text(word, type), file);
    fprintf(file, "%s%s", listed && word->count > 1 ? ": " : !listed && values[0] != '\0' ? " " : "", values);
    if (word->need == OBLIGATORY) fputs("; **must be given**", file);
    if (word->defaults != NULL) fprintf(file, "; default %s", word->defaults);
    fprintf(file, " | %s |\n", word->gloss);
}

static void end_row(const struct word_group *same, FILE *file)
{
    fprintf(file, " | as of [`&%s`](#%s) | |\n", same->name, same->name);
}

static bool same_text(const char *a, const char *b)
{
    return a == b || (a != NULL && b != NULL && strcmp(a, b) == 0);
}

static bool same_word(const struct word *a, const struct word *b)
{
    return same_text(a->name, b->name) && a->type == b->type && a->count == b->count &&
           same_text(a->range, b->range) && same_text(a->defaults, b->defaults) &&
           same_text(a->gloss, b->gloss);
}

/* The first group of the table before `group` that has the same optional word, or NULL */
static const struct word_group *earlier(const struct word_group *group, const struct word *word)
{
    for (const struct word_group *other = deck_words()->group; word->need != OBLIGATORY && other < group;
         other++)
        for (size_t i = 0; i < other->words; i++)
            if (same_word(&other->word[i], word)) return other;
    return NULL;
}

/* Words that an earlier group has too share a row, which names that group. */
static void write_table(const struct word_group *group, bool expert, FILE *file)
{
    fputs("| name | values | meaning [unit] |\n|---|---|---|\n", file);
    const struct word_group *row = NULL; /* of the row that is not ended yet */
    for (size_t j = 0; j < group->words; j++) {
        const struct word *word = &group->word[j];
        if ((word->need == EXPERT) != expert) continue;
        const struct word_group *same = earlier(group, word);
        if (row != NULL && same != row) end_row(row, file);
        if (same == NULL)
            write_row(word, file);
        else
            fprintf(file, "%s`%s`", same == row ? ", " : "| ", word->name);
        row = same;
    }
    if (row != NULL) end_row(row, file);
    putc('\n', file);
}

void deck_reference(FILE *file)
{
    const struct word_table *table = deck_words();
    for (size_t i = 0; i < table->groups; i++) {
        const struct word_group *group = &table->group[i];
        fprintf(file, "### `&%s`\n\n%s; %s.\n\n", group->name, group->gloss, occurrences[group->occurrence]);
        write_table(group, false, file);
        if (!has_experts(group)) continue;
        fprintf(file, "For experts, in `&%s`:\n\n", group->name);
        write_table(group, true, file);
    }
}

/* Writes a text in lines of at most WIDTH columns, each behind `indent` blanks but the first, which goes on
 * at `column`. */
static void write_wrapped(const char *text, int indent, int column, FILE *file)
{
    bool first = true;
    while (*text != '\0') {
        const int length = (int)strcspn(text, " ");
        if (!first && column + 1 + length > WIDTH) {
            fprintf(file, "\n%*s", indent, "");
            column = indent;
            first = true;
        }
        column += fprintf(file, "%s%.*s", first ? "" : " ", length, text);
        first = false;
        text += length + (int)strspn(text + length, " ");
    }
    putc('\n', file);
}

/* "name (type): values; default" and the gloss */
static void write_word(const struct word *word, FILE *file)
{
    char head[4 * LINE_SIZE], type[LINE_SIZE], values[LINE_SIZE];
    values_text(word, values);
    const char *defaults = word->need == OBLIGATORY ? "must be given" : word->defaults;
    snprintf(head, sizeof head, "(%s)%s%s%s%s%s", type_text(word, type), *values != '\0' ? ": " : "", values,
             defaults != NULL ? "; " : "", defaults != NULL && word->need != OBLIGATORY ? "default " : "",
             defaults != NULL ? defaults : "");
    write_wrapped(head, INDENT, fprintf(file, "  %s ", word->name), file);
    write_wrapped(word->gloss, INDENT, fprintf(file, "%*s", INDENT, ""), file);
}

void words_write_groups(const struct word_table *table, FILE *file)
{
    for (size_t i = 0; i < table->groups; i++)
        write_wrapped(table->group[i].gloss, GROUP_INDENT,
                      fprintf(file, "  %-*s", GROUP_INDENT - 2, table->group[i].name), file);
}

void words_write(const struct word_group *group, FILE *file)
{
    fprintf(file, "&%s (%s)\n", group->name, occurrences[group->occurrence]);
    write_wrapped(group->gloss, INDENT, fprintf(file, "%*s", INDENT, ""), file);
    putc('\n', file);
    for (int expert = 0; expert < 2; expert++) {
        if (expert && has_experts(group)) fputs("\nFor experts:\n\n", file);
        for (size_t j = 0; j < group->words; j++)
            if ((group->word[j].need == EXPERT) == expert) write_word(&group->word[j], file);
    }
}
