/* Helper of regress/checks/namelist.sh: what the deck reader makes of namelist files, and a Fortran program
 * that does the same with gfortran's read (nml=...), so that the two can be compared.
 *
 *   values fortran TABLE        prints the Fortran program
 *   values read TABLE FILE...   prints "== FILE", then per group "& NAME" and per value given "NAME(I) VALUE",
 *                               or "refused" and the messages
 *   values echo deck FILE       prints the echo of a deck
 *
 * TABLE is "sample" (a group of every type) or "deck". Reals and logicals are printed as bits. */
#include "deck/deck.h"
#include "deck/namelist.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct word sample_words[] = {
    {"x", WORD_REAL, 1, NULL, NULL, OPTIONAL, ""},     {"r", WORD_REAL, 5, NULL, NULL, OPTIONAL, ""},
    {"k", WORD_INTEGER, 1, NULL, NULL, OPTIONAL, ""},  {"i", WORD_INTEGER, 5, NULL, NULL, OPTIONAL, ""},
    {"b", WORD_LOGICAL, 1, NULL, NULL, OPTIONAL, ""},  {"l", WORD_LOGICAL, 5, NULL, NULL, OPTIONAL, ""},
    {"s", WORD_TEXT, 1, NULL, NULL, OPTIONAL, ""},     {"c", WORD_TEXT, 5, NULL, NULL, OPTIONAL, ""},
    {"table", WORD_REAL, 1, NULL, NULL, OPTIONAL, ""}, {"names", WORD_TEXT, 3, NULL, NULL, OPTIONAL, ""},
};
static const struct word other_words[] = {{"x", WORD_REAL, 3, NULL, NULL, OPTIONAL, ""}};
static const struct word_group sample_groups[] = {
    {"sample", GROUP_MANY, "", sample_words, sizeof sample_words / sizeof *sample_words},
    {"other", GROUP_MANY, "", other_words, 1},
};
static const struct word_table sample = {sample_groups, 2};

static void declare(const struct word_group *group)
{
    static const char *const types[] = {"real(real64)", "integer(int64)", "logical(int32)"};
    for (size_t j = 0; j < group->words; j++) {
        const struct word *word = &group->word[j];
        if (word->type >= WORD_TEXT)
            printf("  character(len=%d)", TEXT_SIZE - 1);
        else
            printf("  %s", types[word->type]);
        printf(" :: %s", word->name);
        if (word->count > 1) printf("(%zu)", word->count);
        printf("\n");
    }
    printf("  namelist /%s/", group->name);
    for (size_t j = 0; j < group->words; j++)
        printf("%s %s", j > 0 ? ", &\n   " : "", group->word[j].name);
    printf("\n");
}

/* A subroutine that reads every group of one kind. */
static void write_reader(const struct word_group *group)
{
    static const char *const unset[] = {"transfer(unset, 1._real64)", "unset",
                                        "transfer(unset_logical, .true.)"};
    static const char *const show[] = {"real", "integer", "logical"};
    printf("subroutine read_%s(reads)\n  use show\n  implicit none\n  integer, intent(inout) :: reads\n"
           "  integer :: ios\n",
           group->name);
    declare(group);
    printf("  rewind (10)\n  do\n");
    for (size_t j = 0; j < group->words; j++) {
        const struct word *word = &group->word[j];
        printf("    %s = %s\n", word->name, word->type >= WORD_TEXT ? "' '" : unset[word->type]);
    }
    printf("    read (10, nml=%s, iostat=ios)\n"
           "    if (ios /= 0) exit\n    reads = reads + 1\n    print '(a)', '& %s'\n",
           group->name, group->name);
    for (size_t j = 0; j < group->words; j++) {
        const struct word *word = &group->word[j];
        printf("    call show_%s('%s', %s%s%s)\n", word->type >= WORD_TEXT ? "text" : show[word->type],
               word->name, word->count > 1 ? "" : "[", word->name, word->count > 1 ? "" : "]");
    }
    printf("  end do\n  if (ios > 0) reads = -1\nend subroutine\n\n");
}

static void write_fortran(const struct word_table *table)
{
    for (size_t i = 0; i < table->groups; i++)
        write_reader(&table->group[i]);
    printf("program reader\n  implicit none\n  character(len=1000) :: path\n  integer :: i, reads\n"
           "  do i = 1, command_argument_count()\n    call get_command_argument(i, path)\n"
           "    print '(2a)', '== ', trim(path)\n"
           "    open (10, file=path, status='old', action='read')\n    reads = 0\n");
    for (size_t i = 0; i < table->groups; i++)
        printf("    if (reads >= 0) call read_%s(reads)\n", table->group[i].name);
    printf("    if (reads <= 0) print '(a)', 'refused'\n    close (10)\n  end do\nend program\n");
}

static void show_group(const struct deck_group *group)
{
    printf("& %s\n", group->kind->name);
    for (size_t j = 0; j < group->kind->words; j++) {
        const struct word *word = &group->kind->word[j];
        const struct item *item = &group->item[j];
        for (size_t i = 0; i < item->values; i++) {
            const struct value *value = &item->value[i];
            uint64_t bits = 0;
            if (!value->given || (word->type >= WORD_TEXT && *value->as.text == '\0')) continue;
            printf("%s(%zu) ", word->name, i + 1);
            memcpy(&bits, &value->as.real, sizeof bits);
            if (word->type == WORD_REAL && value->as.real != value->as.real)
                printf("NaN\n");
            else if (word->type == WORD_REAL)
                printf("%016" PRIX64 "\n", bits);
            else if (word->type == WORD_INTEGER)
                printf("%ld\n", value->as.integer);
            else if (word->type == WORD_LOGICAL)
                printf("%d\n", value->as.logical);
            else
                printf("[%s]\n", value->as.text);
        }
    }
}

static void read_file(const struct word_table *table, const char *path)
{
    static char text[1 << 20];
    struct messages messages = {0};
    struct namelist list;
    FILE *file = fopen(path, "rb");
    const size_t length = file == NULL ? 0 : fread(text, 1, sizeof text, file);
    if (file != NULL) fclose(file);
    printf("== %s\n", path);
    if (file == NULL || !namelist_begin(&list, table, &messages)) exit(2);
    if (namelist_read(&list, path, text, length, &messages) != SELAS_OK || list.groups == 0) {
        printf("refused\n%s", messages.text == NULL ? "" : messages.text);
    } else {
        for (size_t k = 0; k < table->groups; k++)
            for (size_t i = 0; i < list.groups; i++)
                if (list.group[i].kind == &table->group[k]) show_group(&list.group[i]);
    }
    namelist_free(&list);
    messages_free(&messages);
}

static int echo(const char *path)
{
    struct messages messages = {0};
    struct deck *deck;
    selas_status status = deck_read_file(path, 0, NULL, &deck, &messages);
    if (status == SELAS_OK) status = deck_write(deck, stdout, &messages);
    if (messages.text != NULL) fputs(messages.text, stderr);
    deck_free(&deck);
    messages_free(&messages);
    return status == SELAS_OK ? 0 : 1;
}

int main(int count, char **argument)
{
    if (count < 3) return 2;
    const struct word_table *table = strcmp(argument[2], "sample") == 0 ? &sample : deck_words();
    if (strcmp(argument[1], "fortran") == 0) write_fortran(table);
    if (strcmp(argument[1], "echo") == 0) return count == 4 ? echo(argument[3]) : 2;
    for (int i = 3; i < count; i++)
        read_file(table, argument[i]);
    return 0;
}
