/* Namelist reading: places of values, what a group is and is not, and going on after an error. That values
 * are gfortran's is shown by regress/checks/namelist.sh. */
#include "deck/namelist.h"
#include "selas.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
/* after the four above, as cmocka asks */
#include <cmocka.h>

static const struct word words[] = {
    {"x", WORD_REAL, 1, NULL, NULL, OPTIONAL, ""},
    {"list", WORD_REAL, 6, "9, 8", NULL, OPTIONAL, ""},
    {"text", WORD_TEXT, 2, "'default'", NULL, OPTIONAL, ""},
    {"flag", WORD_LOGICAL, 1, NULL, NULL, OPTIONAL, ""},
};
static const struct retired_word retired[] = {
    {"one", "row", "list", SELAS_VERSION},
    {"one", "ex", "x", "0.0.1"},
    {NULL, NULL, NULL, NULL},
};
static const struct word_group groups[] = {
    {"one", GROUP_MANY, "", words, 4, retired},
    {"two", GROUP_MANY, "", words, 1, retired},
};
static const struct word_table table = {groups, 2};

struct reading {
    struct namelist list;
    struct messages messages;
    selas_status status;
};

static struct reading read_text(const char *text)
{
    struct reading reading = {0};
    assert_true(namelist_begin(&reading.list, &table, &reading.messages));
    reading.status = namelist_read(&reading.list, "f", text, strlen(text), &reading.messages);
    return reading;
}

static void release(struct reading *reading)
{
    namelist_free(&reading->list);
    messages_free(&reading->messages);
}

static void values_keep_their_places(void **state)
{
    (void)state;
    struct reading r = read_text("\n &one x=1\n\tlist = 2*3, ,\r\n  5\n text(2) = 'a\nb' flag = T /\n");
    assert_int_equal(r.status, SELAS_OK);
    const struct deck_group *group = &r.list.group[0];
    assert_int_equal(group->place.line, 2);
    assert_int_equal(group->place.column, 2);
    assert_int_equal(group->item[1].place.line, 3);
    assert_int_equal(group->item[1].place.column, 2);
    assert_int_equal(group->item[1].values, 4);
    assert_int_equal(group->item[1].value[1].place.column, 11); /* the number behind 2* */
    assert_false(group->item[1].value[2].given);
    assert_int_equal(group->item[1].value[3].place.line, 4);
    assert_int_equal(group->item[1].value[3].place.column, 3);
    assert_string_equal(group->item[2].value[1].as.text, "ab");
    assert_int_equal(group->item[3].place.line, 6);
    assert_int_equal(group->defaults[1].values, 2);
    assert_true(group->defaults[1].value[1].as.real == 8.0);
    release(&r);
}

static void text_between_groups_is_ignored(void **state)
{
    (void)state;
    struct reading r =
        read_text("R&D cost 5$ & more\n$5 &one! x = 7\n/ ! &one\nsee &one x=1 / &two x=2 / x &ab\n");
    assert_int_equal(r.status, SELAS_OK);
    assert_int_equal(r.list.groups, 3);
    assert_int_equal(r.list.group[0].item[0].values, 0);
    assert_true(r.list.group[1].item[0].value[0].as.real == 1.0);
    assert_ptr_equal(r.list.group[2].kind, &groups[1]);
    release(&r);
}

static void expect(const char *text, const char *lines)
{
    struct reading r = read_text(text);
    assert_int_equal(r.status, SELAS_BAD_DECK);
    assert_string_equal(r.messages.text, lines);
    release(&r);
}

static void groups_that_nobody_knows_are_errors(void **state)
{
    (void)state;
    expect("&on x=1 /\n", "f:1:1: error: unknown group '&on'; did you mean '&one'?\n");
    expect("&one x=1 / &three y='/' /\n&one=3 /\n& two x=1 /\n",
           "f:1:12: error: unknown group '&three'\nf:2:1: error: expected a blank after '&one'\n"
           "f:3:1: error: no blank may stand between '&' and the group's name\n");
}

static void reading_goes_on_after_errors(void **state)
{
    (void)state;
    expect("&one x = a, list = 1, b, text(3) = 'c' flag = maybe\n y(1:2) = 'x = 1', x = 2 /\n"
           "&two x = 1 2 &end\n&two z = 1\n&one text = abc x = 1d / &two x = 0x1 /",
           "f:1:10: error: expected a real number, found 'a'\n"
           "f:1:23: error: expected a real number, found 'b'\n"
           "f:1:30: error: subscript beyond 1 to 2\n"
           "f:1:47: error: expected a logical (.true. or .false.), found 'maybe'\n"
           "f:2:2: error: unknown name 'y' in &one\n"
           "f:2:20: error: 'x' is given twice in one group (first on line 1)\n"
           "f:3:12: error: too many values for 'x': '2'; expected 1 (decimals have a point, 0.5)\n"
           "f:4:6: error: unknown name 'z' in &two\n"
           "f:4:1: error: &two is not closed: expected '/' before line 5\n"
           "f:5:13: error: expected a text in quotes, found 'abc'\n"
           "f:5:21: error: expected a real number, found '1d'\n"
           "f:5:35: error: expected a real number, found '0x1'\n");
}

static void what_stands_outside_of_groups_is_told(void **state)
{
    (void)state;
    expect("&one x = 1/4, list = 2 /\n", "f:1:11: error: this '/' ends &one, and '4, list = 2 /' behind it "
                                         "is not read; expected a fraction as one "
                                         "number, 0.25, or a comment with '!'\n");
    expect("&one x = 1 /\n flag = T, list = 2 /\n", "f:2:2: error: this stands outside of a group and would "
                                                    "not be read: &one has ended; take the '/' or &end "
                                                    "before it away, or begin a comment with '!'\n");
    struct reading r = read_text("\xef\xbb\xbf&one x = 1 / y = 2, or so &two x = 1 / ! flag = T\n"
                                 "ex = 2\nflag = T\n# &two x = 3 /! &one flag = T /\n");
    assert_int_equal(r.status, SELAS_OK);
    assert_int_equal(r.list.groups, 3);
    assert_string_equal(
        r.messages.text,
        "f:1:17: warning: 'y = 2, or so' behind the end of &one is not read; a comment "
        "begins with '!'\n"
        "f:4:3: warning: '#' before it makes no comment of this group, which is read; a comment begins "
        "with '!'\n");
    release(&r);
}

static void names_of_other_groups_are_known(void **state)
{
    (void)state;
    expect("&two flag = T, list 3 /\n&one x 1 /",
           "f:1:6: error: unknown name 'flag' in &two; it is a word of &one\n"
           "f:2:6: error: no '=' behind 'x' of &one\n");
}

static void assignments_replace_values(void **state)
{
    (void)state;
    struct reading r = read_text("&one list = 1, 2, 3 text = 'a', 'b' /\n");
    struct deck_group *group = &r.list.group[0];
    assert_int_equal(namelist_assign(&r.list, group, "list=7", 6, &r.messages), SELAS_OK);
    assert_int_equal(group->item[1].values, 1);
    assert_int_equal(group->item[1].place.line, 0);
    assert_int_equal(namelist_assign(&r.list, group, "text(2)='c'", 11, &r.messages), SELAS_OK);
    assert_string_equal(group->item[2].value[0].as.text, "a");
    assert_string_equal(group->item[2].value[1].as.text, "c");
    assert_null(r.messages.text);
    assert_int_equal(namelist_assign(&r.list, group, "list=1,,x", 9, &r.messages), SELAS_BAD_DECK);
    assert_string_equal(r.messages.text, "override: error: 'list' is given twice\n");
    release(&r);
}

static void words_that_go_warn_for_one_version(void **state)
{
    (void)state;
    struct reading r = read_text("&one ROW(2) = 5, x = 1 /\n");
    assert_int_equal(r.status, SELAS_OK);
    assert_string_equal(r.messages.text,
                        "f:1:6: warning: 'row' in &one is for the last time in version " SELAS_VERSION
                        "; write 'list'\n");
    assert_true(r.list.group[0].item[1].value[1].as.real == 5.0);
    release(&r);
    expect("&one row = 1, list = 2 /\n",
           "f:1:6: warning: 'row' in &one is for the last time in version " SELAS_VERSION "; write 'list'\n"
           "f:1:15: error: 'list' is given twice in one group (first on line 1)\n");
    expect("&one ex = 1 /\n",
           "f:1:6: error: 'ex' in &one was for the last time in version 0.0.1; write 'x'\n");
    expect("&two row = 1 /\n", "f:1:6: error: unknown name 'row' in &two\n"); /* of another group */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_keep_their_places),
        cmocka_unit_test(text_between_groups_is_ignored),
        cmocka_unit_test(groups_that_nobody_knows_are_errors),
        cmocka_unit_test(reading_goes_on_after_errors),
        cmocka_unit_test(what_stands_outside_of_groups_is_told),
        cmocka_unit_test(names_of_other_groups_are_known),
        cmocka_unit_test(assignments_replace_values),
        cmocka_unit_test(words_that_go_warn_for_one_version),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
