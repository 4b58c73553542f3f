/* Inside of namelist reading: (2), (1:3), (5:1:-2), (:2) after a name. */
#ifndef SELAS_SUBSCRIPT_H
#define SELAS_SUBSCRIPT_H

#include "deck/scanner.h"

struct section {
    long first, last, step; /* from 1 */
    bool range;             /* a colon was there; otherwise values go on to the end of the list */
};

/* Reads what stands in brackets (the scanner is at '('); first and last hold the bounds on entry. Reports
 * what is wrong and returns false. */
bool scan_subscript(struct scanner *scanner, struct section *section, bool substring);

#endif
