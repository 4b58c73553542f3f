/* The program selas: one more host of the library. Subcommands, overrides, progress; exit status 0 done, 1
 * the run or the comparison failed, 2 bad deck or usage. */
#include "selas.h"

#include "program/commands.h"
#include "record/progress.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

SELAS_API const char *argp_program_version = "selas " SELAS_VERSION; /* glibc looks for it: must be visible */

static const char usage[] = "DECK [GROUP%NAME=VALUE ...]\n"
                            "check DECK [GROUP%NAME=VALUE ...]\n"
                            "exact DECK [GROUP%NAME=VALUE ...]\n"
                            "diff A B";

static const char documentation[] =
    "Computes elastic waves in solids on points instead of a mesh.\n"
    "\n"
    "  selas DECK        runs the deck; histories, fields, report and plots go\n"
    "                    to output/DECKNAME/ (or &output directory)\n"
    "  selas check DECK  prints the plan: points, memory, time step, resolution\n"
    "  selas exact DECK  writes just the exact histories (&reference)\n"
    "  selas diff A B    compares two histories or two run folders\n"
    "\v"
    "Overrides change any name of the deck: body%spacing=0.25, load(2)%amplitude=3,\n"
    "method%variant=paper. The deck is explained in doc/deck.md.\n"
    "\n"
    "Exit status: 0 done; 1 the run failed or A and B differ (an unstable run says\n"
    "where and when); 2 bad deck or usage.\n"
    "OMP_NUM_THREADS sets the number of threads; the results do not depend on it.";

struct arguments {
    const char *command; /* "run", "check", "exact" */
    const char *deck;
    size_t overrides;
    const char **override;
    bool quiet;
};

static const struct argp_option options[] = {
    {"quiet", 'q', NULL, 0, "No progress, no summary; only what is wrong", 0},
    {0},
};

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    struct arguments *arguments = state->input;
    static const char *const commands[] = {"run", "check", "exact"};
    switch (key) {
    case 'q':
        arguments->quiet = true;
        return 0;
    case ARGP_KEY_ARG:
        if (arguments->deck == NULL && strcmp(arguments->command, "") == 0) {
            for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
                if (strcmp(argument, commands[i]) == 0) {
                    arguments->command = commands[i];
                    return 0;
                }
            arguments->command = "run";
        }
        if (arguments->deck == NULL)
            arguments->deck = argument;
        else
            arguments->override[arguments->overrides++] = argument;
        return 0;
    case ARGP_KEY_END:
        if (arguments->deck == NULL) argp_error(state, "no deck was named; try: selas input/halfspace.nml");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static int exit_status(selas_status status)
{
    switch (status) {
    case SELAS_OK:
        return EXIT_DONE;
    case SELAS_BAD_DECK:
    case SELAS_BAD_SCENE:
    case SELAS_UNSUPPORTED:
    case SELAS_BAD_ARGUMENT:
        return EXIT_BAD_INPUT;
    default:
        return EXIT_RUN_FAILED;
    }
}

/* --- Commands
 * -------------------------------------------------------------------------------------------------- */

static void print_line(void *context, const char *key, const char *value)
{
    fprintf(context, "%s: %s\n", key, value);
}

static void print_text(void *context, const char *text)
{
    fputs(text, context);
    fflush(context);
}

static selas_status run_with_progress(selas_simulation *simulation, bool quiet)
{
    struct progress progress;
    selas_status status = selas_step(simulation, 0); /* builds everything; says what cannot be */
    const unsigned long needed = status == SELAS_OK ? selas_steps_needed(simulation) : 0;
    if (status != SELAS_OK) return status;
    progress_start(&progress, selas_end_time(simulation), isatty(STDERR_FILENO) != 0, print_text, stderr);
    while (status == SELAS_OK && selas_steps(simulation) < needed) {
        status = selas_step(simulation, 1);
        if (!quiet) progress_update(&progress, selas_time(simulation), selas_steps(simulation));
    }
    if (!quiet)
        progress_finish(&progress, selas_time(simulation), selas_steps(simulation), status == SELAS_OK);
    return status;
}

/* The report's last part, speed against error, for the eye. */
static void print_summary(selas_simulation *simulation)
{
    char path[4096];
    char line[1024];
    snprintf(path, sizeof path, "%s/report.txt", selas_output_directory(simulation));
    FILE *report = fopen(path, "r");
    if (report == NULL) return;
    while (fgets(line, sizeof line, report) != NULL)
        if (strncmp(line, "point-steps", 11) == 0 || strncmp(line, "CPU seconds", 11) == 0 ||
            (strncmp(line, "error", 5) == 0 &&
             (strstr(line, "velocity") != NULL || strstr(line, " vz:") != NULL)))
            fputs(line, stdout);
    fclose(report);
    printf("results in %s/\n", selas_output_directory(simulation));
}

static selas_status run(selas_simulation *simulation, const struct arguments *arguments)
{
    selas_status status = selas_record(simulation);
    if (status == SELAS_OK) status = run_with_progress(simulation, arguments->quiet);
    if (status == SELAS_OK) status = selas_write(simulation);
    if (status == SELAS_OK && !arguments->quiet) print_summary(simulation);
    return status;
}

static selas_status carry_out(selas_simulation *simulation, const struct arguments *arguments)
{
    if (strcmp(arguments->command, "check") == 0) return selas_plan(simulation, print_line, stdout);
    if (strcmp(arguments->command, "exact") == 0) {
        const selas_status status = selas_write_exact(simulation);
        if (status == SELAS_OK && !arguments->quiet)
            printf("exact histories in %s/\n", selas_output_directory(simulation));
        return status;
    }
    return run(simulation, arguments);
}

int main(int count, char **words)
{
    if (count > 1 && strcmp(words[1], "diff") == 0) return diff_command(count - 1, words + 1);
    const struct argp parser = {options, parse_option, usage, documentation, NULL, NULL, NULL};
    struct arguments arguments = {.command = ""};
    arguments.override = calloc((size_t)count + 1, sizeof *arguments.override);
    if (arguments.override == NULL) return EXIT_RUN_FAILED;
    argp_err_exit_status = EXIT_BAD_INPUT;
    argp_parse(&parser, count, words, 0, NULL, &arguments);
    selas_simulation *simulation = NULL;
    selas_status status =
        selas_open_deck_with(arguments.deck, arguments.overrides, arguments.override, &simulation);
    if (status == SELAS_OK) status = carry_out(simulation, &arguments);
    fputs(simulation != NULL ? selas_message(simulation) : "error: no memory\n", stderr);
    selas_close(&simulation);
    free(arguments.override);
    return exit_status(status);
}
