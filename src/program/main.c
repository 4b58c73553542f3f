/* The program selas: one more host of the library. Subcommands, overrides, progress; exit status 0 done, 1
 * the run or the comparison failed, 2 bad deck or usage. */
#include "selas.h"

#include "advice/advice.h"
#include "base/crc64.h"
#include "host/simulation.h"
#include "parallel/few_ranks.h"
#include "program/commands.h"
#include "program/run.h"
#include "program/signals.h"

#include <argp.h>
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

SELAS_API const char *argp_program_version = "selas " SELAS_VERSION; /* glibc looks for it: must be visible */

static const char usage[] = "DECK [GROUP%NAME=VALUE ...]\n"
                            "check DECK [GROUP%NAME=VALUE ...]\n"
                            "exact DECK [GROUP%NAME=VALUE ...]\n"
                            "restart CHECKPOINT\n"
                            "rerun RUN.H5 [GROUP%NAME=VALUE ...]\n"
                            "diff A B\n"
                            "words [GROUP]";

static const char documentation[] =
    "Computes elastic waves in solids on points instead of a mesh.\n"
    "\n"
    "  selas DECK        runs the deck; histories, fields, report and plots go\n"
    "                    to output/DECKNAME/ (or &output directory)\n"
    "  selas check DECK  prints the plan: points, memory, time step, resolution\n"
    "  selas exact DECK  writes just the exact histories (&reference)\n"
    "  selas restart C   goes on with an unfinished run from its checkpoint C\n"
    "  selas rerun R     runs the deck stored in R (run.h5) again, in\n"
    "                    output/DECKNAME-rerun/\n"
    "  selas diff A B    compares two histories or two run folders\n"
    "  selas words       lists the groups of a deck; selas words GROUP the words of\n"
    "                    one: types, values, defaults, meaning; those for experts\n"
    "                    (numerics of a method, switches of a paper) come last\n"
    "\v"
    "Overrides change any name of the deck: body%spacing=0.25, load(2)%amplitude=3,\n"
    "method%variant=paper. The deck is explained in doc/reference/deck.md.\n"
    "\n"
    "Ctrl-C (SIGINT) and SIGTERM end a run with a checkpoint and say how to go on,\n"
    "SIGUSR1 leaves one and the run goes on; see doc/howto/long-runs.md.\n"
    "\n"
    "Exit status: 0 done; 1 the run failed or A and B differ (an unstable run says\n"
    "where and when); 2 bad deck or usage.\n"
    "OMP_NUM_THREADS sets the number of threads; the results do not depend on it.\n"
    "SELAS_PROCESSOR=x86-64, x86-64-v3 or x86-64-v4 takes the loops for that kind of processor.";

struct arguments {
    const char *command; /* "run", "check", "exact", "restart", "rerun" */
    const char *deck;
    size_t overrides;
    const char **override;
    bool quiet, strict, echo, plot;
    bool tells; /* --help and the like, after which argp goes on where others run too */
};

static const struct argp_option options[] = {
    {"quiet", 'q', NULL, 0, "No progress, no summary; only what is wrong", 0},
    {"strict", 's', NULL, 0, "Warnings of the deck and the scene are errors", 0},
    {"echo", 'e', NULL, 0, "With check: measure what the faces of the box send back", 0},
    {"plot", 'p', NULL, 0, "With check: draw the ground, sources and receivers: ground.png", 0},
    {0},
};

/* NULL: nothing. */
static const char *what_is_wrong(const struct arguments *arguments)
{
    const bool check = strcmp(arguments->command, "check") == 0;
    const bool restart = strcmp(arguments->command, "restart") == 0;
    if (arguments->deck == NULL)
        return restart ? "no checkpoint was named: selas restart output/NAME/unfinished/checkpoint.h5"
               : strcmp(arguments->command, "rerun") == 0
                   ? "no run was named: selas rerun output/NAME/run.h5"
                   : "no deck was named; try: selas input/halfspace.nml";
    if (arguments->echo && !check) return "--echo goes with check: selas check --echo DECK";
    if (arguments->plot && !check) return "--plot goes with check: selas check --plot DECK";
    if (arguments->overrides > 0 && restart)
        return "a restart takes no overrides: it ends as the run that was begun";
    return NULL;
}

/* On ranks argp_error() comes back. */
static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    struct arguments *arguments = state->input;
    const char *wrong;
    static const char *const commands[] = {"run", "check", "exact", "restart", "rerun"};
    switch (key) {
    case 'q':
        arguments->quiet = true;
        return 0;
    case 's':
        arguments->strict = true;
        return 0;
    case 'e':
        arguments->echo = true;
        return 0;
    case 'p':
        arguments->plot = true;
        return 0;
    case ARGP_KEY_ARG:
        if (arguments->deck == NULL && strcmp(arguments->command, "") == 0) {
            for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
                if (strcmp(argument, commands[i]) == 0) {
                    arguments->command = commands[i];
                    return 0;
                }
            arguments->command = "run";
            if (strpbrk(argument, "./") == NULL && access(argument, F_OK) != 0) {
                argp_error(state,
                           "'%s' is neither a command nor a deck; commands are run, check, exact, restart, "
                           "rerun, diff and words",
                           argument);
                return EINVAL;
            }
        }
        if (arguments->deck == NULL)
            arguments->deck = argument;
        else
            arguments->override[arguments->overrides++] = argument;
        return 0;
    case ARGP_KEY_END:
        wrong = arguments->tells ? NULL : what_is_wrong(arguments);
        if (wrong == NULL) return 0;
        argp_error(state, "%s", wrong);
        return EINVAL;
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

/* --- Commands --- */

static selas_status open_named(const struct arguments *arguments, struct ranks *ranks,
                               selas_simulation **simulation)
{
    if (strcmp(arguments->command, "restart") == 0)
        return simulation_open_checkpoint(arguments->deck, ranks, simulation);
    if (strcmp(arguments->command, "rerun") == 0)
        return simulation_open_run(arguments->deck, arguments->overrides, arguments->override, simulation);
    return selas_open_deck_with(arguments->deck, arguments->overrides, arguments->override, simulation);
}

static void print_error(void *context, const char *key, const char *value)
{
    (void)key;
    if (context != NULL) fprintf(context, "error: %s\n", value);
}

/* --strict: what would be a warning ends the program before anything is run. */
static selas_status be_strict(selas_simulation *simulation)
{
    selas_status status = selas_steps_needed(simulation) > 0 ? SELAS_OK : SELAS_BAD_SCENE;
    if (status != SELAS_OK) return status;
    const size_t wrong = advice_tell(simulation->scene, simulation->stepper, print_error,
                                     ranks_first(simulation->ranks) ? stderr : NULL);
    return wrong + simulation->messages.warnings > 0 ? SELAS_BAD_SCENE : SELAS_OK;
}

/* --plot: before anything is computed. */
static selas_status plot_ground(selas_simulation *simulation)
{
    selas_status status = simulation_scene(simulation);
    if (status == SELAS_OK) status = record_ground(simulation->scene, &simulation->messages);
    if (status == SELAS_OK) printf("plot: %s/ground.png\n", selas_output_directory(simulation));
    return status;
}

/* The program's user has nothing but files; hosts may look by themselves. */
static selas_status look_for_results(selas_simulation *simulation, bool strict)
{
    static const char nothing[] =
        "nothing is looked at: no receiver, no profile, no snapshot; the run leaves energies "
        "alone; a &receiver would be right";
    const selas_status status = simulation_scene(simulation);
    const struct scene *scene = simulation->scene;
    if (status != SELAS_OK || scene->receivers + scene->profiles + scene->snapshots > 0) return status;
    if (strict) return fail(&simulation->messages, SELAS_BAD_SCENE, "%s", nothing);
    warn(&simulation->messages, "%s", nothing);
    return SELAS_OK;
}

static selas_status carry_out(selas_simulation *simulation, const struct arguments *arguments, size_t *told)
{
    if (strcmp(arguments->command, "check") == 0) {
        const struct echo_deck deck = {arguments->deck, arguments->overrides, arguments->override};
        const bool first = ranks_first(simulation->ranks);
        selas_status status = arguments->plot && first ? plot_ground(simulation) : SELAS_OK;
        status = ranks_agree(simulation->ranks, status, &simulation->messages);
        if (status == SELAS_OK) status = selas_plan(simulation, print_line, first ? stdout : NULL);
        return status == SELAS_OK && arguments->echo && first ? check_echo(&deck) : status;
    }
    if (strcmp(arguments->command, "exact") == 0) {
        if (!ranks_first(simulation->ranks)) return SELAS_OK;
        const selas_status status = selas_write_exact(simulation);
        if (status == SELAS_OK && !arguments->quiet) {
            simulation->exact->class->describe(simulation->exact, print_line, stdout);
            printf("exact histories in %s/\n", selas_output_directory(simulation));
        }
        return status;
    }
    const bool restart = strcmp(arguments->command, "restart") == 0;
    return run_program(simulation, restart ? arguments->deck : NULL, arguments->quiet, told);
}

/* On ranks the first one speaks, and none ends by itself; what is wrong on one is wrong on all. */
static bool read_words(const struct argp *parser, int count, char **words, struct ranks *ranks,
                       struct arguments *arguments)
{
    const unsigned flags = ranks_count(ranks) == 1 ? 0 : ranks_first(ranks) ? ARGP_NO_EXIT : ARGP_SILENT;
    static const char *const telling[] = {"--help", "-?", "--usage", "--version", "-V"};
    for (int i = 1; i < count; i++)
        for (size_t t = 0; t < sizeof telling / sizeof *telling; t++)
            arguments->tells = arguments->tells || strcmp(words[i], telling[t]) == 0;
    double wrong = 0; /* silent ones know no --help */
    if (!arguments->tells || ranks_first(ranks))
        wrong = argp_parse(parser, count, words, flags, NULL, arguments) != 0 ||
                (arguments->deck == NULL && !arguments->tells);
    ranks_largest(ranks, 1, &wrong);
    return wrong == 0;
}

/* `selas -q diff A B` is `selas diff -q A B`. */
static void command_first(int count, char **words)
{
    int at = 1;
    while (at < count && words[at][0] == '-')
        at++;
    if (at == count) return;
    char *command = words[at];
    memmove(words + 2, words + 1, (size_t)(at - 1) * sizeof *words);
    words[1] = command;
}

/* Together. */
static bool same_words(int count, char **words, struct ranks *ranks)
{
    struct crc64_table table;
    uint64_t sum = 0;
    crc64_prepare(&table);
    for (int i = 1; i < count; i++)
        sum = crc64_add(&table, sum, words[i], strlen(words[i]) + 1);
    return ranks_same(ranks, sum);
}

int main(int count, char **words)
{
    command_first(count, words);
    struct ranks *ranks = ranks_begin();
    if (!same_words(count, words, ranks)) {
        if (ranks_first(ranks)) fprintf(stderr, "selas-mpi: ranks were given different commands\n");
        ranks_end(&ranks);
        return EXIT_BAD_INPUT;
    }
    const bool diff = count > 1 && strcmp(words[1], "diff") == 0;
    if (diff || (count > 1 && strcmp(words[1], "words") == 0)) {
        const int ended = !ranks_first(ranks) ? EXIT_DONE
                          : diff              ? diff_command(count - 1, words + 1)
                                              : words_command(count - 1, words + 1);
        ranks_end(&ranks);
        return ended;
    }
    const struct argp parser = {options, parse_option, usage, documentation, NULL, NULL, NULL};
    struct arguments arguments = {.command = ""};
    arguments.override = calloc((size_t)count + 1, sizeof *arguments.override);
    if (arguments.override == NULL) {
        ranks_abort(ranks, EXIT_RUN_FAILED);
        return EXIT_RUN_FAILED;
    }
    argp_err_exit_status = EXIT_BAD_INPUT;
    const bool right = read_words(&parser, count, words, ranks, &arguments);
    if (!right || arguments.tells) {
        free(arguments.override);
        ranks_end(&ranks);
        return right ? EXIT_DONE : EXIT_BAD_INPUT;
    }
    selas_simulation *simulation = NULL;
    size_t told = 0;
    signals_end_nothing();
    H5dont_atexit(); /* HDF5 would write to a full disk once more at exit, and crash; all files are closed
                        here */
    selas_status status = open_named(&arguments, ranks, &simulation);
    if (simulation == NULL) { /* no memory for anything */
        ranks_abort(ranks, EXIT_RUN_FAILED);
        status = SELAS_NO_MEMORY;
    } else {
        status = simulation_share(simulation, ranks, status);
    }
    if (status == SELAS_OK) status = look_for_results(simulation, arguments.strict);
    if (status == SELAS_OK && arguments.strict) status = be_strict(simulation);
    if (status == SELAS_OK) status = carry_out(simulation, &arguments, &told);
    if (ranks_idle(ranks)) signals_pass();
    if (simulation != NULL) status = ranks_agree(ranks, status, &simulation->messages);
    tell_messages(simulation, &told);
    selas_close(&simulation);
    free(arguments.override);
    const int ended = ranks_idle(ranks) ? EXIT_DONE : exit_status(status);
    ranks_end(&ranks);
    return ended;
}
