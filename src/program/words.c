/* selas words [GROUP]: the groups of a deck, or the words of one. */
#include "program/commands.h"

#include "deck/words.h"

#include <argp.h>
#include <string.h>

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    const char **group = state->input;
    if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
    if (state->arg_num > 0) argp_error(state, "one group is shown at a time");
    *group = text;
    return 0;
}

int words_command(int count, char **words)
{
    const struct argp parser = {
        NULL, parse_option, "[GROUP]", "Prints the groups of a deck, or the words of one.", NULL, NULL, NULL};
    const struct word_table *table = deck_words();
    const char *name = NULL;
    char program[] = "selas words", suggestion[SUGGESTION_SIZE];
    words[0] = program;
    argp_err_exit_status = EXIT_BAD_INPUT;
    argp_parse(&parser, count, words, 0, NULL, &name);
    if (name == NULL) {
        puts("The groups of a deck; selas words GROUP prints the words of one:\n");
        words_write_groups(table, stdout);
        return EXIT_DONE;
    }
    if (*name == '&') name++;
    const size_t group = words_find_group(table, name, strlen(name));
    if (group == table->groups) {
        fprintf(stderr, "error: unknown group '%.60s'%s\nThe groups are:\n\n", name,
                suggest_group(table, name, "", suggestion));
        words_write_groups(table, stderr);
        return EXIT_BAD_INPUT;
    }
    words_write(&table->group[group], stdout);
    return EXIT_DONE;
}
