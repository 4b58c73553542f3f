/* Lines of text files of numbers (points, tables, histories): of bounded length, and text only, so that
 * neither a file without ends of lines nor one of zeros takes memory or time. */
#ifndef SELAS_LINES_H
#define SELAS_LINES_H

#include <stdio.h>

enum { LINE_SIZE = 1024 }; /* with the final '\0' */

enum line_found {
    LINE_READ,     /* a line, without its end */
    LINE_END,      /* there is none any more, or the file cannot be read (ferror) */
    LINE_TOO_LONG, /* more than LINE_SIZE - 1 bytes */
    LINE_NO_TEXT   /* a byte 0 */
};

/* The next line of the file; its end may be "\n", "\r\n", "\r" or the end of the file. A mark of UTF-8 (BOM) before
 * it is left out. */
enum line_found line_next(FILE *file, char line[LINE_SIZE]);
/* What is wrong after LINE_TOO_LONG or LINE_NO_TEXT, for a message. */
const char *line_fault(enum line_found found);

/* The number at a place of a line and where it ends, as strtod(); its exponent may follow d or D or no letter, as of
 * Fortran (1-103). What is not parted from what follows by a blank, a comma or a comment is none. */
double line_number(const char *at, char **end);
/* Numbers of a line, parted by blanks or commas, up to its end or a comment (# or !). Returns how many; -1 if there
 * is something else in it, or more than `most`. */
int line_numbers(const char *line, int most, double *value);

#endif
