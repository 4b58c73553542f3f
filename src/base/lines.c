/* Lines of text files of numbers (see the header). */
#include "base/lines.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum line_found line_next(FILE *file, char line[LINE_SIZE])
{
    size_t length = 0;
    int byte = getc(file);
    if (byte == EOF) return LINE_END;
    for (; byte != EOF && byte != '\n'; byte = getc(file)) {
        if (byte == '\0') return LINE_NO_TEXT;
        if (length + 1 == LINE_SIZE) return LINE_TOO_LONG;
        line[length++] = (char)byte;
    }
    if (length > 0 && line[length - 1] == '\r') length--;
    line[length] = '\0';
    return LINE_READ;
}

const char *line_fault(enum line_found found)
{
    return found == LINE_TOO_LONG ? "the line is too long: expected a few numbers"
                                  : "a byte 0: this is not a text file";
}

int line_numbers(const char *line, int most, double *value)
{
    int count = 0;
    while (true) {
        line += strspn(line, " \t,\r\n");
        if (*line == '\0' || *line == '#' || *line == '!') return count;
        char *end = NULL;
        const double x = strtod(line, &end);
        if (end == line || count == most) return -1;
        value[count++] = x;
        line = end;
    }
}
