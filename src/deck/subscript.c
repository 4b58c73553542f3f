/* Subscripts and substrings of namelist names, as gfortran takes them: no blank before a colon. */
#include "deck/subscript.h"

#include <limits.h>

/* Reads up to the next ':' or ')'; *empty if no digits stand before it. */
static bool read_bound(struct scanner *scanner, long *bound, bool *empty, int *end)
{
    scan_blanks(scanner);
    int c = scan_next(scanner);
    const bool minus = c == '-';
    if (c == '-' || c == '+') c = scan_next(scanner);
    long number = 0;
    *empty = true;
    while (c >= '0' && c <= '9') {
        if (number <= INT_MAX) number = 10 * number + (c - '0');
        *empty = false;
        c = scan_next(scanner);
    }
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n') {
        scan_blanks(scanner);
        c = scan_next(scanner);
        if (c != ')') return false;
    }
    *end = c;
    if (!*empty) *bound = minus ? -number : number;
    return c == ':' || c == ')';
}

bool scan_subscript(struct scanner *scanner, struct section *section, bool substring)
{
    const size_t start = scanner->at;
    const long low = section->first, high = section->last;
    long *const bound[] = {&section->first, &section->last, &section->step};
    const char *what = substring ? "substring" : "subscript";
    bool good = true;
    int end = ':';
    section->step = 1;
    section->range = false;
    scan_next(scanner);
    for (int i = 0; i < 3 && good && end == ':'; i++) {
        bool empty = true;
        good = read_bound(scanner, bound[i], &empty, &end);
        if (i == 0 && end == ':') section->range = true;
        if (empty && ((i == 0 && end == ')') || (i == 1 && end == ':') || i == 2)) good = false;
    }
    if (!good || end != ')' || (substring && (!section->range || section->step != 1))) {
        scan_error(scanner, start, "bad %s; expected (2), (1:3) or (1:5:2)", what);
        return false;
    }
    if (section->first < low || section->first > high || section->last < low || section->last > high) {
        scan_error(scanner, start, "%s beyond %ld to %ld", what, low, high);
        return false;
    }
    if (section->step == 0 || (section->last - section->first) * (section->step > 0 ? 1 : -1) < 0) {
        scan_error(scanner, start, "%s that never gets from %ld to %ld", what, section->first, section->last);
        return false;
    }
    scan_blanks(scanner);
    return true;
}
