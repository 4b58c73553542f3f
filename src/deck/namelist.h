/* Fortran namelist text (Fortran 2018, 13.11, as gfortran 12 reads it) into typed values with their places.
 *
 * Reading is led by the table of words, as in Fortran: the type and the size of the name on the left say how
 * what stands on the right is read. What is right or wrong is settled here for syntax, names, types and
 * counts; ranges and obligatory names are the deck's business. Every error is reported, then reading goes on
 * at the next name or group. */
#ifndef SELAS_NAMELIST_H
#define SELAS_NAMELIST_H

#include "base/messages.h"
#include "deck/words.h"

struct place {
    size_t line, column; /* from 1, in bytes; line 0: an override */
};

struct value {
    bool given; /* false: null, the default holds */
    struct place place;
    union {
        double real;
        long integer;
        bool logical;
        char *text; /* owned (array_new); no blanks at the right */
    } as;
};

#define COMMENT_NULL " (a comment right after '=' or ',' is a null value, as in gfortran 12)"

/* What a group says about one word of its kind. */
struct item {
    bool named;        /* the name stands in the text, perhaps with nulls only */
    bool whole;        /* without a subscript */
    bool wrong;        /* an error was reported for it */
    bool comment_null; /* a comment took the place of a value, see COMMENT_NULL */
    struct place place;
    size_t values; /* 1 + index of the last value given */
    size_t room;
    struct value *value; /* room values */
};

struct deck_group {
    const struct word_group *kind;
    struct place place;          /* of '&'; line 0: made by an override; 1, 1: there by default */
    struct item *item;           /* one per word of the kind */
    const struct item *defaults; /* likewise: the table's defaults; owned by the list */
};

/* The table's defaults for one kind of group, shared by all its occurrences. */
struct group_defaults {
    struct item *item; /* one per word */
};

struct namelist {
    const struct word_table *table;
    size_t groups, room;
    struct deck_group *group;        /* in the order of the text; moves when one is added */
    struct group_defaults *defaults; /* per kind of group */
};

/* Reads all groups of a text and adds them to the list; errors as "NAME:LINE:COLUMN: error: ...". Returns
 * SELAS_BAD_DECK if there was one. What stands between groups is not read: it is refused where it was meant to be
 * (a fraction, a word behind a '/' too early), and warned of on the line of a group. */
selas_status namelist_read(struct namelist *list, const char *name, const char *text, size_t length,
                           struct messages *messages);

/* Reads "name = values" or "name(2) = ..." (length bytes, the whole of it) into one group; errors as
 * "override: error: ...". What the text says replaces what the group had. */
selas_status namelist_assign(const struct namelist *list, struct deck_group *group, const char *text,
                             size_t length, struct messages *messages);

/* Takes all values away: as if the text did not have the name. */
void item_clear(const struct word *word, struct item *item);

/* An empty list for a table; false if there is no memory or the table's defaults cannot be read. */
bool namelist_begin(struct namelist *list, const struct word_table *table, struct messages *messages);
/* Adds a group with nothing but its defaults; NULL if there is no memory. */
struct deck_group *namelist_add(struct namelist *list, size_t kind, struct place place);
/* Takes the group that was added last away again. */
void namelist_drop(struct namelist *list);
void namelist_free(struct namelist *list);

/* Adds "NAME:LINE:COLUMN: error: ..." (or warning), with place.line = 0 "override: error: ...". */
void namelist_message(struct messages *messages, const char *name, struct place place, bool is_error,
                      const char *format, ...) __attribute__((format(printf, 5, 6)));

#endif
