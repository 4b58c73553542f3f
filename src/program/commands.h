/* Subcommands of the program that need no deck; each returns the exit status. */
#ifndef SELAS_COMMANDS_H
#define SELAS_COMMANDS_H

enum { EXIT_DONE = 0, EXIT_RUN_FAILED = 1, EXIT_BAD_INPUT = 2 };

/* selas words [GROUP]; words[0] is "words". */
int words_command(int count, char **words);

/* selas diff A B [--atol=X] [--rtol=X] [--plots=FOLDER]; words[0] is "diff". */
int diff_command(int count, char **words);

#endif
