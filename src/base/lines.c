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

/* As strtod(), with Fortran's exponents. */
static double number_at(const char *at, char **end)
{
    const double value = strtod(at, end);
    char *letter = *end;
    if (letter == at || *letter == '\0' || strchr("Dd+-", *letter) == NULL) return value;
    if (strspn(at, "+-.0123456789") < (size_t)(letter - at)) return value; /* inf, or of another base */
    char number[LINE_SIZE];
    char *exponent = *letter == '+' || *letter == '-' ? letter : letter + 1;
    const size_t sign = *exponent == '+' || *exponent == '-' ? 1 : 0,
                 digits = strspn(exponent + sign, "0123456789"), before = (size_t)(letter - at);
    if (digits == 0 || before + 2 + sign + digits > sizeof number) return value;
    memcpy(number, at, before);
    number[before] = 'e';
    memcpy(number + before + 1, exponent, sign + digits);
    number[before + 1 + sign + digits] = '\0';
    *end = exponent + sign + digits;
    return strtod(number, NULL);
}

double line_number(const char *at, char **end)
{
    const double value = number_at(at, end);
    if (strchr(" \t,\r\n#!", **end) == NULL) *end -= *end - at; /* what follows is part of it */
    return value;
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
