/* selas diff A B: compares two histories or the receivers of two run folders, with a table and a plot of
 * every channel that differs. Exit status 0: the same within the tolerances, 1: they differ or cannot be
 * read, 2: wrong usage. */
#include "program/commands.h"

#include "compare/diff.h"

#include <argp.h>
#include <math.h>
#include <stdlib.h>

struct arguments {
    const char *path[2];
    struct tolerance tolerance;
    const char *plots; /* folder */
    bool quiet;
};

enum { KEY_ABSOLUTE = 1000, KEY_RELATIVE, KEY_PLOTS, KEY_NO_PLOTS };

static const struct argp_option options[] = {
    {"atol", KEY_ABSOLUTE, "X", 0, "allowed part of the channel's range in A (1e-6)", 0},
    {"rtol", KEY_RELATIVE, "X", 0, "allowed part of the value itself (1e-6)", 0},
    {"plots", KEY_PLOTS, "FOLDER", 0, "where the plots of channels that differ go (output/diff)", 0},
    {"no-plots", KEY_NO_PLOTS, NULL, 0, "no plots", 0},
    {"quiet", 'q', NULL, 0, "no table", 0},
    {0},
};

static double read_tolerance(const char *text, struct argp_state *state)
{
    char *end = NULL;
    const double value = strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= 0.0) || !isfinite(value))
        argp_error(state, "'%s' is no tolerance: expected a number that is not negative", text);
    return value;
}

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    struct arguments *arguments = state->input;
    switch (key) {
    case KEY_ABSOLUTE:
        arguments->tolerance.absolute = read_tolerance(text, state);
        return 0;
    case KEY_RELATIVE:
        arguments->tolerance.relative = read_tolerance(text, state);
        return 0;
    case KEY_PLOTS:
        arguments->plots = text;
        return 0;
    case KEY_NO_PLOTS:
        arguments->plots = NULL;
        return 0;
    case 'q':
        arguments->quiet = true;
        return 0;
    case ARGP_KEY_ARG:
        if (state->arg_num >= 2) argp_error(state, "two histories or two folders are compared, not more");
        arguments->path[state->arg_num] = text;
        return 0;
    case ARGP_KEY_END:
        if (state->arg_num < 2) argp_error(state, "name two histories or two folders");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

int diff_command(int count, char **words)
{
    const struct argp parser = {
        options,
        parse_option,
        "A B",
        "Compares histories by receiver and component.\v|B - A| <= atol * range + rtol * |A| is the same. "
        "Exit status: 0 the same; 1 different or not readable; 2 wrong usage.",
        NULL,
        NULL,
        NULL};
    struct arguments arguments = {.tolerance = tolerance_default, .plots = "output/diff"};
    char name[] = "selas diff";
    words[0] = name;
    argp_err_exit_status = EXIT_BAD_INPUT;
    argp_parse(&parser, count, words, 0, NULL, &arguments);
    struct messages messages = {0};
    struct diff_report report = {arguments.quiet ? NULL : stdout, arguments.plots, 0};
    const selas_status status =
        diff_paths(arguments.path[0], arguments.path[1], &arguments.tolerance, &report, &messages);
    if (!arguments.quiet && report.plots != NULL && report.differences > 0)
        printf("plots in %s/\n", report.plots);
    if (messages.text != NULL) fputs(messages.text, stderr);
    messages_free(&messages);
    if (status == SELAS_BAD_ARGUMENT) return EXIT_BAD_INPUT;
    return status == SELAS_OK && report.differences == 0 ? EXIT_DONE : EXIT_RUN_FAILED;
}
