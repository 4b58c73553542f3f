/* The deck: namelist text checked against the table of words (deck/words.c), stored as typed values with
 * their place in the file.
 *
 * Reading finds all errors of syntax, names, types, counts and ranges in one pass. What the words mean
 * together (a receiver outside the body, a material that nobody defines) is checked by scene/, with
 * deck_error(). */
#ifndef SELAS_DECK_H
#define SELAS_DECK_H

#include "base/messages.h"

#include <stdio.h>

struct deck;
struct deck_group; /* one occurrence of a group */

/* Reads a file, then applies overrides ("group%name=value", "load(2)%amplitude=3"); every error becomes a
 * line "FILE:LINE:COLUMN: error: ..." or "override: error: ...". On failure *deck is NULL. Name a deck's own
 * name "path". */
selas_status deck_read_file(const char *path, size_t overrides, const char *const *override,
                            struct deck **deck, struct messages *messages);
/* The same from text in memory (length bytes, may hold '\0' bytes: an error); name stands for FILE in
 * messages. */
selas_status deck_read_text(const char *name, const char *text, size_t length, size_t overrides,
                            const char *const *override, struct deck **deck, struct messages *messages);
void deck_free(struct deck **deck);

/* A deck made by calls (deck/deck_build.c): it begins with the groups that are always there and nothing in
 * them. */
selas_status deck_new(const char *name, struct deck **deck, struct messages *messages);
/* Adds a group; *number is its occurrence, from 1. */
selas_status deck_add(struct deck *deck, const char *group, size_t *number, struct messages *messages);
/* "load(2)%amplitude=3": as an override, and once more in place of what was set before. Values are
 * checked at once. After an error the deck is as it was. */
selas_status deck_set(struct deck *deck, const char *text, struct messages *messages);
/* The checks of the table (ranges, choices, obligatory names) after the last deck_set. */
selas_status deck_complete(struct deck *deck, struct messages *messages);

/* Points that a host hands over in place of body%file; all arrays stay the caller's. */
struct given_points {
    size_t count;
    const double *position; /* [3 * count], frame of the body */
    const double *volume;   /* [count] > 0 */
    const size_t *material; /* [count] index of &material from 0; NULL: the body's */
};
void deck_hand_points(struct deck *deck, const struct given_points *points);
const struct given_points *deck_points(const struct deck *deck); /* NULL: none */

/* Number of times a group occurs; groups that are always there once (scene, method, stepping, output) give 1.
 */
size_t deck_count(const struct deck *deck, const char *group);
/* Occurrence `index` (from 0) of a group. */
const struct deck_group *deck_get(const struct deck *deck, const char *group, size_t index);

/* Name i (from 0) of those that the table lists for the group; NULL beyond the last. */
const char *deck_word(const struct deck_group *group, size_t i);
/* True if the deck or an override gave the name a value other than its default (the echo of a deck writes all
 * defaults and must mean the same). */
bool deck_given(const struct deck_group *group, const char *name);
/* Number of values: given ones or defaults; 0 if neither. Nulls among given values keep the default there. */
size_t deck_values(const struct deck_group *group, const char *name);
/* Value `i` (from 0); the name and type must be right (asserted) and i < deck_values(). */
double deck_real(const struct deck_group *group, const char *name, size_t i);
long deck_integer(const struct deck_group *group, const char *name, size_t i);
bool deck_logical(const struct deck_group *group, const char *name, size_t i);
const char *deck_text(const struct deck_group *group, const char *name, size_t i); /* trimmed at the right */
/* Is the value `choice`, one of those that the table lists for the name (asserted)? No without a group or a
 * value. */
bool deck_chosen(const struct deck_group *group, const char *name, const char *choice);
/* Is the first value the one that the text says ('3', '.true.', a choice)? No without a value. */
bool deck_says(const struct deck_group *group, const char *name, const char *text);
/* Index of a text value in those choices, that is, the member of the enumeration made from the same list
 * (deck/choices.h). */
size_t deck_choice(const struct deck_group *group, const char *name, size_t i);

/* Adds "FILE:LINE:COLUMN: error: ..." at the place where name stands in the group (or the group itself if
 * name is NULL or was not given); "override: error: ..." if an override gave it. Returns SELAS_BAD_DECK. */
selas_status deck_error(const struct deck *deck, const struct deck_group *group, const char *name,
                        struct messages *messages, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
void deck_warning(const struct deck *deck, const struct deck_group *group, const char *name,
                  struct messages *messages, const char *format, ...) __attribute__((format(printf, 5, 6)));

const char *deck_source_path(const struct deck *deck); /* of the file, as given */
const char *deck_name(const struct deck *deck);        /* file name without folder and ".nml" */
/* Path of a file that the deck names (a word of type WORD_FILE), relative to the deck's folder unless it is
 * absolute, as seen from where the program stands; new memory (array_free), NULL if there is none. */
char *deck_resolve(const struct deck *deck, const char *file);
/* The same from the root, wherever the program stands. */
char *deck_absolute(const struct deck *deck, const char *file);
/* The program stands in another folder than when the deck was read. */
bool deck_moved(const struct deck *deck);
/* All files that the deck names, one call each with the word ("load(2)%file"), the path, and whether an override gave
 * it, until one returns false: then, and without memory, false. */
typedef bool deck_visit(void *context, const char *word, const char *path, bool overridden);
bool deck_files(const struct deck *deck, deck_visit *visit, void *context);
const char *deck_source(const struct deck *deck); /* the text as read, without overrides */
/* Whole path of the file that it was read from; "": from none. */
const char *deck_origin(const struct deck *deck);
/* That file is there, and holds another text than the deck was read from. */
bool deck_changed(const struct deck *deck);
/* Gives a deck that was made from an echo the text that it came from, and the path of its file (or "", NULL). */
selas_status deck_set_source(struct deck *deck, const char *source, const char *origin,
                             struct messages *messages);

/* Prints the tables of all groups and names in Markdown (the deck reference of doc/reference/deck.md). */
void deck_reference(FILE *file);

/* Writes the echo: every group with every name that has a value, defaults included, reals to the last bit
 * (%.17g); a file that gfortran's namelist reading takes and that runs to the same bits. Paths are written so
 * that the echo, which lies in another folder, still finds them. */
selas_status deck_write(const struct deck *deck, FILE *file, struct messages *messages);
/* The same in new memory (free it), "" without a deck; NULL if that failed. */
char *deck_echo(const struct deck *deck, struct messages *messages);

#endif
