/* The words of the deck: every group and name, with type, number of values, default, range and a line of
 * documentation. One table (words.c) from which reading, checking, the echo and the manual are made: a new
 * word is one new line there. */
#ifndef SELAS_WORDS_H
#define SELAS_WORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum word_type {
    WORD_REAL,
    WORD_INTEGER,
    WORD_LOGICAL,
    WORD_TEXT,
    WORD_FILE,  /* text: a path, relative to the deck's folder; the echo writes it absolute */
    WORD_CHOICE /* text: one of a list */
};

enum {
    TEXT_SIZE = 1024, /* longest text value with its final '\0' */
    LIST_SIZE = 1000  /* most values of a list such as `times` */
};

/* Words of EXPERT are for experiments with a method: reference and help show them apart. */
enum word_need { OPTIONAL, OBLIGATORY, EXPERT };

struct word {
    const char *name;
    enum word_type type;
    size_t count; /* most values */
    const char
        *defaults;     /* as written in a deck; NULL: none. To give a name its default is as not to give it */
    const char *range; /* numbers: an interval such as "(0, inf)" or "[0, 1)", NULL: any;
                          choices: "one|two|three" */
    enum word_need need;
    const char *gloss; /* one line with the unit in brackets */
};

enum occurrence {
    GROUP_ALWAYS, /* once; is there with its defaults even if the deck does not have it */
    GROUP_ONCE,   /* at most once */
    GROUP_MANY    /* each occurrence is another thing */
};

/* A word that goes: in version `until` (as in SELAS_VERSION: 1.1.0) it is read as `now` of the same group, with a
 * warning; in any other version it is refused with the same advice. */
struct retired_word {
    const char *group, *old, *now, *until;
};

struct word_group {
    const char *name;
    enum occurrence occurrence;
    const char *gloss;
    const struct word *word;
    size_t words;
    const struct retired_word *retired; /* of all groups, ends with one without a name; NULL: none */
};

/* A table of groups: the deck's own (deck_words()), or another one in tests. */
struct word_table {
    const struct word_group *group;
    size_t groups;
};

const struct word_table *deck_words(void);

/* As text of at most 80 columns: the groups of a table; the words of a group, those for experts apart. */
void words_write_groups(const struct word_table *table, FILE *file);
void words_write(const struct word_group *group, FILE *file);

/* Index of a name (case-free, `length` bytes), or the number of groups or words if there is none. */
size_t words_find_group(const struct word_table *table, const char *name, size_t length);
size_t words_find(const struct word_group *group, const char *name, size_t length);
/* The same among words that went; NULL if there is none. */
const struct retired_word *words_find_retired(const struct word_group *group, const char *name,
                                              size_t length);

/* Number of choices; copies choice `index` (or "" beyond the last) into text[size]. */
size_t word_choices(const struct word *word);
void word_choice(const struct word *word, size_t index, char *text, size_t size);
/* Index of a choice (exactly as written), or word_choices() if there is none. */
size_t word_find_choice(const struct word *word, const char *text);

/* An interval: true if value lies in it (NaN and infinities never do); an absent range holds every finite
 * value. */
bool word_in_range(const struct word *word, double value);

/* Number of single-character changes, insertions, deletions and swaps of neighbours from one word to another
 * (optimal string alignment), case-free. Words of more than 63 characters count as infinitely far. */
size_t words_distance(const char *one, const char *other);
/* "; did you mean 'NAME'?" with the nearest name (of a group in the table, behind the mark; of a word in the
 * group, words for experts only where no other one is as near; of a choice), or "" if none is near; of a word of other
 * groups "; it is a word of &GROUP". Returns text. */
enum { SUGGESTION_SIZE = 96 };
const char *suggest_group(const struct word_table *table, const char *word, const char *mark,
                          char text[SUGGESTION_SIZE]);
const char *suggest_word(const struct word_table *table, const struct word_group *group, const char *word,
                         char text[SUGGESTION_SIZE]);
const char *suggest_choice(const struct word *word, const char *choice, char text[SUGGESTION_SIZE]);

#endif
