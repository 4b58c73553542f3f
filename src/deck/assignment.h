/* Inside of namelist reading: "name(subscript) = values". */
#ifndef SELAS_ASSIGNMENT_H
#define SELAS_ASSIGNMENT_H

#include "deck/scanner.h"
#include "deck/subscript.h"

/* Where values of an assignment go. */
struct target {
    const struct word *word;
    struct item *item;
    const struct item *defaults;
    struct section section;
    struct section substring; /* last = 0: the whole text */
    size_t at;                /* of the name */
};

/* Reads the values that stand behind '='. Returns false if something was wrong (reported). */
bool scan_values(struct scanner *scanner, const struct target *target);
/* Reads a whole assignment to a word of the group; the scanner is at its name. Likewise. */
bool scan_assignment(struct scanner *scanner, struct deck_group *group);

#endif
