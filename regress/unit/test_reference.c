/* doc/reference/deck.md holds the tables of words as deck_reference() prints them, between its two marks. After a
 * change of words.c write them anew with: SELAS_WRITE_REFERENCE=1 build/test/test_reference */
#include "deck/deck.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
/* after the four above, as cmocka asks */
#include <cmocka.h>

static const char path[] = "doc/reference/deck.md";
static const char begin[] = "<!-- tables: made from src/deck/words.c by build/test/test_reference -->\n\n";
static const char end[] = "<!-- end of tables -->\n";

static char *read_manual(void)
{
    enum { ROOM = 1 << 20 };
    char *text = calloc(ROOM, 1);
    FILE *file = fopen(path, "r");
    assert_non_null(text);
    assert_non_null(file);
    const size_t length = fread(text, 1, ROOM - 1, file);
    fclose(file);
    assert_true(length > 0);
    return text;
}

static void manual_holds_the_table(void **state)
{
    (void)state;
    char *tables = NULL, *manual = read_manual();
    size_t size = 0;
    FILE *file = open_memstream(&tables, &size);
    deck_reference(file);
    fclose(file);
    char *first = strstr(manual, begin);
    assert_non_null(first);
    first += strlen(begin);
    char *last = strstr(first, end);
    assert_non_null(last);
    if (getenv("SELAS_WRITE_REFERENCE") != NULL) {
        file = fopen(path, "w");
        assert_non_null(file);
        fprintf(file, "%.*s%s%s", (int)(first - manual), manual, tables, last);
        fclose(file);
    } else if ((size_t)(last - first) != size || memcmp(first, tables, size) != 0) {
        fail_msg("doc/reference/deck.md is not what src/deck/words.c says: run SELAS_WRITE_REFERENCE=1 "
                 "build/test/test_reference");
    }
    free(tables);
    free(manual);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(manual_holds_the_table)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
