/* The deck reference: the table of words as Markdown. */
#include "deck/deck.h"
#include "deck/words.h"

#include <string.h>

static void write_type(const struct word *word, FILE *file)
{
    static const char *const types[] = {"real", "integer", "logical", "text", "file", "text"};
    fputs(types[word->type], file);
    if (word->count > 1) fprintf(file, ", up to %zu", word->count);
}

static void write_values(const struct word *word, FILE *file)
{
    if (word->type == WORD_CHOICE) {
        char choice[64];
        for (size_t i = 0; i < word_choices(word); i++) {
            word_choice(word, i, choice, sizeof choice);
            fprintf(file, "%s'%s'", i > 0 ? ", " : "", choice);
        }
    } else if (word->range != NULL) {
        fputs(word->range, file);
    }
}

void deck_reference(FILE *file)
{
    static const char *const occurrences[] = {"always there, at most once in a deck", "at most once",
                                              "as often as wanted"};
    const struct word_table *table = deck_words();
    for (size_t i = 0; i < table->groups; i++) {
        const struct word_group *group = &table->group[i];
        fprintf(file, "### `&%s`\n\n%s; %s.\n\n", group->name, group->gloss, occurrences[group->occurrence]);
        fputs("| name | type | values | default | meaning [unit] |\n|---|---|---|---|---|\n", file);
        for (size_t j = 0; j < group->words; j++) {
            const struct word *word = &group->word[j];
            fprintf(file, "| `%s` | ", word->name);
            write_type(word, file);
            fputs(" | ", file);
            write_values(word, file);
            fprintf(file, " | %s | %s |\n",
                    word->need == OBLIGATORY ? "**must be given**"
                    : word->defaults == NULL ? ""
                                             : word->defaults,
                    word->gloss);
        }
        putc('\n', file);
    }
}
