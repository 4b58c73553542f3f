/* Position, places, separators and messages of namelist reading (gfortran's rules, see scanner.h). */
#include "deck/scanner.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { MOST_ERRORS = 100 };

int scan_next(struct scanner *scanner)
{
    const int c = scan_peek(scanner, scanner->at);
    if (scanner->at <= scanner->length) scanner->at++;
    scanner->at_line_end = c == '\n' || c == '\r' || c == END_OF_TEXT;
    return c;
}

void scan_back(struct scanner *scanner)
{
    scanner->at--;
}

int scan_peek(const struct scanner *scanner, size_t at)
{
    return at < scanner->length ? (unsigned char)scanner->text[at] : END_OF_TEXT;
}

bool is_separator(int c)
{
    return c == ' ' || c == ',' || c == '/' || c == '\n' || c == '\t' || c == '\r' || c == ';' ||
           c == END_OF_TEXT;
}

bool is_name_character(int c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

void scan_blanks(struct scanner *scanner)
{
    int c;
    do
        c = scan_next(scanner);
    while (c == ' ' || c == '\t' || c == '\r');
    scan_back(scanner);
}

void scan_line(struct scanner *scanner)
{
    int c;
    do
        c = scan_next(scanner);
    while (c != '\n' && c != END_OF_TEXT);
}

/* Skips line ends, blanks and comments up to what follows them. */
static void skip_lines(struct scanner *scanner)
{
    int c;
    do {
        c = scan_next(scanner);
        if (c == '!') {
            scan_line(scanner);
            c = '\n';
        }
    } while (c == '\n' || c == '\r' || c == ' ' || c == '\t');
    scan_back(scanner);
}

void scan_separator(struct scanner *scanner)
{
    scan_blanks(scanner);
    scanner->comma = false;
    const int c = scan_next(scanner);
    switch (c) {
    case ',':
    case ';':
        scanner->comma = true;
        scan_blanks(scanner);
        break;
    case '/':
        scanner->complete = true;
        break;
    case '\n':
        skip_lines(scanner);
        break;
    case '!':
        scan_line(scanner);
        break;
    default:
        scan_back(scanner);
    }
}

void scan_rest_of_separator(struct scanner *scanner)
{
    for (;;) {
        scan_blanks(scanner);
        const int c = scan_next(scanner);
        if (c == ',') {
            if (scanner->comma) {
                scan_back(scanner);
                return;
            }
            scan_blanks(scanner);
            const int after = scan_peek(scanner, scanner->at);
            if (after != '\n' && after != '\r') return;
        } else if (c == '!') {
            scan_line(scanner);
        } else if (c != '\n' && c != '\r') {
            if (c == '/')
                scanner->complete = true;
            else
                scan_back(scanner);
            return;
        }
    }
}

struct place scan_place(struct scanner *scanner, size_t at)
{
    const char *text = scanner->text;
    if (at > scanner->length) at = scanner->length;
    for (size_t i = scanner->known_at; i < at; i++)
        if (text[i] == '\n') {
            scanner->known_line++;
            scanner->known_start = i + 1;
        }
    while (at < scanner->known_start) {
        scanner->known_line--;
        size_t start = scanner->known_start - 1;
        while (start > 0 && text[start - 1] != '\n')
            start--;
        scanner->known_start = start;
    }
    scanner->known_at = at;
    if (scanner->name == NULL) return (struct place){0, 0};
    return (struct place){scanner->known_line + 1, at - scanner->known_start + 1};
}

void namelist_message(struct messages *messages, const char *name, struct place place, bool is_error,
                      const char *format, ...)
{
    char line[2048];
    const char *kind = is_error ? "error" : "warning";
    int used;
    if (place.line == 0)
        used = snprintf(line, sizeof line, "override: %s: ", kind);
    else
        used = snprintf(line, sizeof line, "%.1000s:%zu:%zu: %s: ", name, place.line, place.column, kind);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + used, sizeof line - (size_t)used, format, arguments);
    va_end(arguments);
    messages_add(messages, is_error, !is_error, line);
}

void scan_error(struct scanner *scanner, size_t at, const char *format, ...)
{
    if (++scanner->errors > MOST_ERRORS) return;
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    const struct place place = scan_place(scanner, at);
    namelist_message(scanner->messages, scanner->name, place, true, "%s", text);
    if (scanner->errors == MOST_ERRORS)
        namelist_message(scanner->messages, scanner->name, place, true,
                         "too many errors: the rest is not shown");
}

void scan_no_memory(struct scanner *scanner, size_t at)
{
    scan_error(scanner, at, "not enough memory");
    scanner->messages->no_memory = true;
}

const char *scan_quote(const struct scanner *scanner, size_t at, size_t length, char quoted[QUOTED_SIZE])
{
    const size_t room = QUOTED_SIZE - 4;
    size_t i = 0;
    for (; i < length && i < room && at + i < scanner->length; i++) {
        const char c = scanner->text[at + i];
        quoted[i] = (unsigned char)c < 32 || c == 127 ? '?' : c;
    }
    while (i > 0 && i == room && ((unsigned char)quoted[i - 1] & 0x80) != 0)
        i--; /* no half characters */
    memcpy(quoted + i, i < length && i + 4 >= room ? "...\0" : "\0\0\0", 4);
    return quoted;
}

size_t scan_name_length(const struct scanner *scanner, size_t at)
{
    const int first = scan_peek(scanner, at);
    if (!is_name_character(first) || (first >= '0' && first <= '9')) return 0;
    size_t length = 1;
    while (is_name_character(scan_peek(scanner, at + length)))
        length++;
    return length;
}

bool scan_is_assignment(const struct scanner *scanner, size_t at)
{
    const size_t length = scan_name_length(scanner, at);
    if (length == 0) return false;
    at += length;
    while (scan_peek(scanner, at) == '(') { /* subscript, perhaps a substring after it */
        const size_t longest = at + 80;
        while (scan_peek(scanner, at) != ')' && at < longest && scan_peek(scanner, at) != '\n')
            at++;
        if (scan_peek(scanner, at) != ')') return false;
        at++;
    }
    for (;;) {
        const int c = scan_peek(scanner, at);
        if (c == '!') {
            while (scan_peek(scanner, at) != '\n' && scan_peek(scanner, at) != END_OF_TEXT)
                at++;
        } else if (c == ' ' || c == '\t' || c == '\r' || c == '\n') {
            at++;
        } else {
            return c == '=';
        }
    }
}
