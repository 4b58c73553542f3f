/* Single values of a namelist: repeat count, then a real, an integer, a logical or a text in the forms that
 * gfortran's list-directed reading takes. */
#include "base/memory.h"
#include "deck/scanner.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MOST_REPEATS = 200000000, NUMBER_SIZE = 512 };

static bool is_digit(int c)
{
    return c >= '0' && c <= '9';
}

/* End of the run of characters that are neither separators nor a comment. */
static size_t token_end(const struct scanner *scanner, size_t at)
{
    while (!is_separator(scan_peek(scanner, at)) && scan_peek(scanner, at) != '!')
        at++;
    return at;
}

static enum scanned wrong(struct scanner *scanner, size_t at, size_t length, const char *expected)
{
    char quoted[QUOTED_SIZE];
    scan_error(scanner, at, "expected %s, found '%s'", expected, scan_quote(scanner, at, length, quoted));
    return SCANNED_WRONG;
}

/* Reads "digits*" if it is there; false if the count is 0 or too large (reported). */
static bool read_repeat(struct scanner *scanner, struct value *value)
{
    size_t at = scanner->at;
    long count = 0;
    while (is_digit(scan_peek(scanner, at))) {
        if (count <= MOST_REPEATS) count = 10 * count + (scan_peek(scanner, at) - '0');
        at++;
    }
    if (at == scanner->at || scan_peek(scanner, at) != '*') return true;
    if (count == 0 || count > MOST_REPEATS) {
        wrong(scanner, scanner->at, at - scanner->at + 1, "a repeat count from 1 to 200000000");
        return false;
    }
    scanner->repeat = count;
    scanner->at = at + 1;
    value->place = scan_place(scanner, scanner->at);
    return true;
}

/* Copies a real number to the form that strtod takes: 'e' for any exponent letter or for none (1+3). Returns
 * false if it is not one. */
static bool plain_real(const char *from, size_t length, char number[NUMBER_SIZE])
{
    size_t i = 0, used = 0;
    bool digits = false;
    if (length + 2 >= NUMBER_SIZE) return false;
    if (i < length && (from[i] == '+' || from[i] == '-')) number[used++] = from[i++];
    for (bool point = false; i < length && (is_digit(from[i]) || (from[i] == '.' && !point)); i++) {
        if (from[i] == '.')
            point = true;
        else
            digits = true;
        number[used++] = from[i];
    }
    if (i < length) { /* exponent */
        number[used++] = 'e';
        if (strchr("eEdDqQ", from[i]) != NULL)
            i++;
        else if (from[i] != '+' && from[i] != '-')
            return false;
        if (i < length && (from[i] == '+' || from[i] == '-')) number[used++] = from[i++];
        if (i == length) return false;
        for (; i < length; i++) {
            if (!is_digit(from[i])) return false;
            number[used++] = from[i];
        }
    }
    number[used] = '\0';
    return digits;
}

/* inf, infinity, nan, nan(...) with a sign. */
static bool not_finite(const char *from, size_t length, double *real)
{
    const bool minus = length > 0 && *from == '-';
    if (length > 0 && (*from == '+' || *from == '-')) {
        from++;
        length--;
    }
    if ((length == 3 && strncasecmp(from, "inf", 3) == 0) ||
        (length == 8 && strncasecmp(from, "infinity", 8) == 0))
        *real = minus ? -INFINITY : INFINITY;
    else if (length >= 3 && strncasecmp(from, "nan", 3) == 0 &&
             (length == 3 || (from[3] == '(' && memchr(from, ')', length) == from + length - 1)))
        *real = NAN;
    else
        return false;
    return true;
}

static bool read_real(const char *from, size_t length, double *real)
{
    char number[NUMBER_SIZE];
    if (not_finite(from, length, real)) return true;
    if (!plain_real(from, length, number)) return false;
    *real = strtod(number, NULL);
    return true;
}

static bool read_integer(const char *from, size_t length, long *integer)
{
    char number[NUMBER_SIZE];
    if (length == 0 || length >= NUMBER_SIZE) return false;
    for (size_t i = 0; i < length; i++)
        if (!is_digit(from[i]) && !(i == 0 && length > 1 && (from[i] == '+' || from[i] == '-'))) return false;
    memcpy(number, from, length);
    number[length] = '\0';
    errno = 0;
    *integer = strtol(number, NULL, 10);
    return errno == 0;
}

/* T..., F..., .t..., .f...: what follows the letter is not looked at, as in Fortran. */
static bool read_logical(const char *from, size_t length, bool *logical)
{
    if (length > 0 && *from == '.') {
        from++;
        length--;
    }
    if (length == 0 || strchr("tTfF", *from) == NULL) return false;
    *logical = *from == 't' || *from == 'T';
    return true;
}

static bool is_blank_or_line_end(int c)
{
    return c == ' ' || c == '\n' || c == '\r';
}

static enum scanned read_plain(struct scanner *scanner, const struct word *word, struct value *value)
{
    static const char *const expected[] = {"a real number", "an integer", "a logical (.true. or .false.)"};
    const size_t start = scanner->at, end = token_end(scanner, start);
    const char *from = scanner->text + start;
    bool good = false;
    if (word->type == WORD_REAL) good = read_real(from, end - start, &value->as.real);
    if (word->type == WORD_INTEGER) good = read_integer(from, end - start, &value->as.integer);
    if (word->type == WORD_LOGICAL) good = read_logical(from, end - start, &value->as.logical);
    if (!good) return wrong(scanner, start, end - start, expected[word->type]);
    scanner->at = end;
    /* gfortran looks for '=' behind words that could be names: past line ends after inf and nan, past the
     * separator after a logical in letters, which makes it forget a line end in a comment */
    if (word->type == WORD_REAL && !isfinite(value->as.real) && !is_digit(from[end - start - 1]))
        while (is_blank_or_line_end(scan_peek(scanner, scanner->at)))
            scanner->at++;
    scan_separator(scanner);
    if (word->type == WORD_LOGICAL && *from != '.' && end - start > 1) {
        scan_next(scanner);
        scan_back(scanner);
    }
    return SCANNED_VALUE;
}

/* Length of a quoted text from after its quote to before its closing one; copies it (doubled quotes once, no
 * line ends) to `text` if that is not NULL. SIZE_MAX in *end: no closing quote. */
static size_t copy_quoted(const struct scanner *scanner, size_t at, int quote, char *text, size_t *end)
{
    size_t used = 0;
    for (;; at++) {
        const int c = scan_peek(scanner, at);
        if (c == END_OF_TEXT) {
            *end = SIZE_MAX;
            return used;
        }
        if (c == quote) {
            if (scan_peek(scanner, at + 1) != quote) break;
            at++;
        }
        if (c == '\n' || c == '\r') continue;
        if (text != NULL) text[used] = (char)c;
        used++;
    }
    *end = at + 1;
    return used;
}

static enum scanned keep_text(struct scanner *scanner, size_t start, int quote, size_t end,
                              struct value *value)
{
    size_t length = quote != 0 ? copy_quoted(scanner, start + 1, quote, NULL, &end) : end - start;
    if (length >= TEXT_SIZE) {
        scan_error(scanner, start, "text of %zu characters; at most %d are taken", length, TEXT_SIZE - 1);
        scanner->at = end;
        return SCANNED_WRONG;
    }
    char *text = array_new(length + 1, 1);
    if (text == NULL) {
        scan_no_memory(scanner, start);
        return SCANNED_WRONG;
    }
    if (quote != 0)
        copy_quoted(scanner, start + 1, quote, text, &end);
    else
        memcpy(text, scanner->text + start, length);
    while (length > 0 && text[length - 1] == ' ')
        text[--length] = '\0';
    value->as.text = text;
    scanner->at = end;
    scan_separator(scanner);
    return SCANNED_VALUE;
}

static enum scanned read_text(struct scanner *scanner, struct value *value)
{
    const size_t start = scanner->at;
    const int quote = scan_peek(scanner, start);
    if (quote != '\'' && quote != '"') {
        size_t end = start;
        while (!is_separator(scan_peek(scanner, end)))
            end++;
        /* gfortran takes text without quotes if it begins with a digit or after a repeat count */
        if (is_digit(quote) || scanner->repeat > 0) return keep_text(scanner, start, 0, end, value);
        return wrong(scanner, start, end - start, "a text in quotes");
    }
    size_t end;
    copy_quoted(scanner, start + 1, quote, NULL, &end);
    if (end == SIZE_MAX) {
        scan_error(scanner, start, "the text that begins here has no closing quote");
        scanner->at = scanner->length;
        return SCANNED_WRONG;
    }
    const int after = scan_peek(scanner, end);
    if (!is_separator(after) && after != '!') {
        scanner->at = end;
        return wrong(scanner, end, token_end(scanner, end) - end, "a blank or a comma after the text");
    }
    return keep_text(scanner, start, quote, end, value);
}

enum scanned scan_value(struct scanner *scanner, const struct word *word, struct value *value)
{
    scanner->repeat = 0;
    value->place = scan_place(scanner, scanner->at);
    if (scan_is_assignment(scanner, scanner->at)) return SCANNED_NAME;
    if (!read_repeat(scanner, value)) return SCANNED_WRONG;
    const int c = scan_peek(scanner, scanner->at);
    const bool is_text = word->type >= WORD_TEXT;
    if (c == '!' && scanner->repeat == 0) scanner->comment_null = true;
    /* to gfortran 12 a comment where a value should stand is a null value, or for texts the end of them */
    if (is_separator(c) || (c == '!' && !is_text)) {
        scan_separator(scanner);
        return SCANNED_NULL;
    }
    if (c == '!' && scanner->repeat == 0) return SCANNED_NAME;
    if ((c == '&' || c == '$') && scanner->repeat == 0) return SCANNED_NAME;
    return is_text ? read_text(scanner, value) : read_plain(scanner, word, value);
}
