/* Inside of the deck: what deck.c, deck_read.c and deck_write.c share. */
#ifndef SELAS_DECK_PRIVATE_H
#define SELAS_DECK_PRIVATE_H

#include "deck/deck.h"
#include "deck/namelist.h"

struct deck {
    char *path;      /* as given; names the deck in messages */
    char *name;      /* file name without folder and ".nml" */
    char *directory; /* folder of the file, "." if none */
    char *origin;    /* whole path of its file; NULL: of none */
    char *here;      /* folder of the process when it was read (of the system's memory); NULL: unknown */
    char *source;
    size_t length;        /* of source */
    struct namelist list; /* groups sorted by kind in the table's order, else as in the text */
    size_t *first; /* per kind: index of its first group in the list; first[kinds] = number of groups */
    const struct given_points *points; /* borrowed from the host; NULL: none */
};

/* The value that holds (given or default), or NULL. */
const struct value *group_value(const struct deck_group *group, size_t word, size_t i);
size_t group_values(const struct deck_group *group, size_t word);

/* Checks ranges and choices of what is given for one word of a group. */
void deck_check_values(const struct deck *deck, const struct deck_group *group, size_t word,
                       struct messages *messages);
/* Checks ranges, choices, gaps and obligatory names of all groups. */
void deck_check(const struct deck *deck, struct messages *messages);
/* Sorts the groups by kind, those of one kind as they stand in the text, and finds the first of each. */
bool deck_sort_groups(struct deck *deck);
/* Applies one override; reports what is wrong. */
void deck_override(struct deck *deck, const char *text, struct messages *messages);

#endif
