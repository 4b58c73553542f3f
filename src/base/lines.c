/* Lines of text files of numbers (see the header). */
#include "base/lines.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* The mark of UTF-8 that some editors put before a file, and others where files are joined: before a line. */
static const char mark[3] = {'\xEF', '\xBB', '\xBF'};

enum line_found line_next(FILE *file, char line[LINE_SIZE])
{
    size_t length = 0;
    int byte = getc(file);
    if (byte == EOF) return LINE_END;
    for (; byte != EOF && byte != '\n' && byte != '\r'; byte = getc(file)) {
        if (byte == '\0') return LINE_NO_TEXT;
        if (length + 1 == LINE_SIZE) return LINE_TOO_LONG;
        line[length++] = (char)byte;
        if (length == sizeof mark && memcmp(line, mark, sizeof mark) == 0) length = 0;
    }
    if (byte == '\r') {
        const int next = getc(file);
        if (next != '\n' && next != EOF) ungetc(next, file);
    }
    line[length] = '\0';
    return LINE_READ;
}

const char *line_fault(enum line_found found)
{
    return found == LINE_TOO_LONG ? "the line is too long: expected a few numbers"
                                  : "a byte 0: this is not a text file";
}

double line_number(const char *at, char **end)
{
    const double value = strtod(at, end);
    char *letter = *end;
    if (letter == at || (*letter != 'D' && *letter != 'd')) return value;
    if (strspn(at, "+-.0123456789") < (size_t)(letter - at)) return value; /* inf, or of another base */
    char number[LINE_SIZE];
    const size_t sign = letter[1] == '+' || letter[1] == '-' ? 1 : 0,
                 digits = strspn(letter + 1 + sign, "0123456789"), before = (size_t)(letter - at);
    const size_t length = before + 1 + sign + digits;
    if (digits == 0 || length >= sizeof number) return value;
    memcpy(number, at, length);
    number[before] = 'e';
    number[length] = '\0';
    *end = letter + 1 + sign + digits;
    return strtod(number, NULL);
}

int line_numbers(const char *line, int most, double *value)
{
    int count = 0;
    while (true) {
        line += strspn(line, " \t,\r\n");
        if (*line == '\0' || *line == '#' || *line == '!') return count;
        char *end = NULL;
        const double x = line_number(line, &end);
        if (end == line || count == most) return -1;
        value[count++] = x;
        line = end;
    }
}
