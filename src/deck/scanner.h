/* Inside of namelist reading: the text with a position in it, separators, and the reading of single values.
 *
 * Separators follow gfortran's runtime step by step (a comma after a line end is a null value, a comment ends
 * a line, ...), because the same text must give the same values there and here. */
#ifndef SELAS_SCANNER_H
#define SELAS_SCANNER_H

#include "deck/namelist.h"

enum { END_OF_TEXT = -1 };

struct scanner {
    const char *name;               /* of the file, for messages; NULL: an override */
    const struct word_table *table; /* all groups; NULL: of defaults */
    const char *text;
    size_t length, at;
    bool at_line_end;        /* the last character read ended a line */
    bool comma;              /* the last separator held a comma */
    bool complete;           /* the group's '/' has been read */
    long repeat;             /* how often the value just read is to be used, counted down */
    const struct word *full; /* whose values have just been read to the last one; NULL: none */
    bool comment_null;       /* a comment stood where a value of this name should */
    size_t known_at, known_line, known_start; /* where the last place asked for was */
    size_t errors;
    struct messages *messages;
};

int scan_next(struct scanner *scanner);
void scan_back(struct scanner *scanner);
int scan_peek(const struct scanner *scanner, size_t at);
bool is_separator(int c);
bool is_name_character(int c);
void scan_blanks(struct scanner *scanner);
void scan_line(struct scanner *scanner);
void scan_separator(struct scanner *scanner);
void scan_rest_of_separator(struct scanner *scanner);

/* Line and column of a position. */
struct place scan_place(struct scanner *scanner, size_t at);
/* Reports an error at a position; after the hundredth only counts. */
void scan_error(struct scanner *scanner, size_t at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Reports that memory has run out. */
void scan_no_memory(struct scanner *scanner, size_t at);
/* Copies length bytes from `at` for a message: unprintable ones as '?', shortened with "..." */
enum { QUOTED_SIZE = 48 };
const char *scan_quote(const struct scanner *scanner, size_t at, size_t length, char quoted[QUOTED_SIZE]);
/* Length of the name that begins at a position (0: none), and whether `name =` or `name(...) =` does. */
size_t scan_name_length(const struct scanner *scanner, size_t at);
bool scan_is_assignment(const struct scanner *scanner, size_t at);

enum scanned {
    SCANNED_VALUE,
    SCANNED_NULL,
    SCANNED_NAME, /* no value: the next name begins here */
    SCANNED_WRONG /* reported */
};

/* Reads one value of the word's type with its repeat count and the separator after it; text is NULL or new
 * memory (array_new). */
enum scanned scan_value(struct scanner *scanner, const struct word *word, struct value *value);

#endif
