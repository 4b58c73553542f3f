/* The deck: typed values, defaults, overrides, errors with their places, and the echo. */
#include "base/memory.h"
#include "deck/deck.h"
#include "deck/words.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
/* after the four above, as cmocka asks */
#include <cmocka.h>

#include <locale.h>
#include <unistd.h>

#define SCENE "&scene end_time = 2 /\n"

struct reading {
    struct deck *deck;
    struct messages messages;
    selas_status status;
};

static struct reading read_with(const char *text, size_t overrides, const char *const *override)
{
    struct reading reading = {0};
    reading.status = deck_read_text("folder/case.nml", text, strlen(text), overrides, override, &reading.deck,
                                    &reading.messages);
    return reading;
}

static struct reading read_text(const char *text)
{
    return read_with(text, 0, NULL);
}

static void release(struct reading *reading)
{
    deck_free(&reading->deck);
    messages_free(&reading->messages);
}

/* Reads a deck that must fail with exactly these lines. */
static void expect_errors(const char *text, size_t overrides, const char *const *override, const char *lines)
{
    struct reading reading = read_with(text, overrides, override);
    assert_int_equal(reading.status, SELAS_BAD_DECK);
    assert_null(reading.deck);
    assert_string_equal(reading.messages.text, lines);
    release(&reading);
}

static void gives_values_and_defaults(void **state)
{
    (void)state;
    struct reading r = read_text("&SCENE Title='a  ', end_time=1d1 /\n&body low=1,2, spacing=.5 /\n"
                                 "&receiver name='one' position=1,2,3 /\n"
                                 "&load direction(2)=4 velocity=,5 /\n"
                                 "&receiver name='two' position=3*0 /\n");
    assert_int_equal(r.status, SELAS_BAD_DECK); /* direction(1) is missing */
    assert_non_null(strstr(r.messages.text, "4:7: error: value 1 of 'direction' in &load is missing\n"));
    release(&r);
    r = read_text("&SCENE Title='a  ', end_time=1d1 /\n&body low=1,2, rotation=,5 seed=1 /\n"
                  "&receiver name='one' position=1,2,3 /\n&load /\n"
                  "&receiver name='two' position=3*0 /\n");
    assert_int_equal(r.status, SELAS_OK);
    const struct deck_group *scene = deck_get(r.deck, "scene", 0), *body = deck_get(r.deck, "body", 0);
    assert_string_equal(deck_text(scene, "title", 0), "a");
    assert_true(deck_real(scene, "end_time", 0) == 10.0);
    assert_int_equal(deck_integer(scene, "dimension", 0), 3);
    assert_false(deck_given(scene, "dimension"));
    assert_true(deck_given(scene, "end_time"));
    assert_int_equal(deck_values(scene, "accuracy"), 0);
    assert_int_equal(deck_values(body, "low"), 2);
    assert_int_equal(deck_values(body, "rotation"), 2);
    assert_true(deck_given(body, "rotation")); /* a null keeps its default */
    assert_true(deck_real(body, "rotation", 0) == 0.0 && deck_real(body, "rotation", 1) == 5.0);
    assert_false(deck_given(body, "seed")); /* the default, as the echo writes it */
    assert_int_equal(deck_count(r.deck, "receiver"), 2);
    assert_string_equal(deck_text(deck_get(r.deck, "receiver", 1), "name", 0), "two");
    assert_int_equal(deck_count(r.deck, "output"), 1);
    assert_int_equal(deck_count(r.deck, "initial"), 0);
    assert_true(deck_logical(deck_get(r.deck, "output", 0), "plots", 0));
    const struct deck_group *load = deck_get(r.deck, "load", 0);
    assert_int_equal(deck_choice(load, "kind", 0), 0);
    assert_string_equal(deck_name(r.deck), "case");
    char *file = deck_resolve(r.deck, "points.txt");
    assert_string_equal(file, "folder/points.txt");
    array_free(file);
    release(&r);
}

static void reports_all_errors_at_their_places(void **state)
{
    (void)state;
    expect_errors(
        "&scene end_time = 'a', dimension = 2.5\n tilte = 'x' /\n"
        "&body shape = 'bxo', low = 0,0,0,0 spacing = .1 spacing = .2 /\n"
        "&material name = 'a', density = -1, mu = 0 /\n"
        "&bdoy /\n"
        "&receiver name = 'it''s', position = 1, , 3 /\n"
        "&receiver position = 1 /\n"
        "&boundary face = 'x-', 'left', kind = 'free' /\n"
        "&load amplitude = nan, cycles = 0 /\n"
        "&snapshot times = 1, -2 /",
        0, NULL,
        "folder/case.nml:1:19: error: expected a real number, found ''a''\n"
        "folder/case.nml:1:36: error: expected an integer, found '2.5'\n"
        "folder/case.nml:2:2: error: unknown name 'tilte' in &scene; did you mean 'title'?\n"
        "folder/case.nml:3:34: error: too many values for 'low': '0'; expected at most 3\n"
        "folder/case.nml:3:49: error: 'spacing' is given twice in one group (first on line 3)\n"
        "folder/case.nml:5:1: error: unknown group '&bdoy'; did you mean '&body'?\n"
        "folder/case.nml:4:33: error: -1 for 'density' in &material; expected a number in (0, inf)\n"
        "folder/case.nml:4:42: error: 0 for 'mu' in &material; expected a number in (0, inf)\n"
        "folder/case.nml:3:15: error: 'bxo' for 'shape' in &body; expected one of 'box', "
        "'half-space', 'plate-with-hole', 'points'; did you mean 'box'?\n"
        "folder/case.nml:8:24: error: 'left' for 'face' in &boundary; expected one of 'x-', 'x+', "
        "'y-', 'y+', 'z-', 'z+', 'hole', 'all'\n"
        "folder/case.nml:9:19: error: nan for 'amplitude' in &load; expected a finite number\n"
        "folder/case.nml:9:33: error: 0 for 'cycles' in &load; expected a number in (0, inf)\n"
        "folder/case.nml:6:27: error: value 2 of 'position' in &receiver is missing\n"
        "folder/case.nml:7:1: error: 'name' is missing in &receiver: name of the history's files\n"
        "folder/case.nml:10:22: error: -2 for 'times' in &snapshot; expected a number in [0, inf)\n");
}

static void reports_groups_that_never_end(void **state)
{
    (void)state;
    expect_errors("&scene end_time = 1\n&body spacing = 1 /\n", 0, NULL,
                  "folder/case.nml:1:1: error: &scene is not closed: expected '/' before line 2\n");
    expect_errors(
        "&scene end_time = 1 /\n&body spacing = 1\n", 0, NULL,
        "folder/case.nml:2:1: error: &body is not closed: expected '/' before the end of the text\n");
    expect_errors(SCENE "&output directory = 'abc\n/\n", 0, NULL,
                  "folder/case.nml:2:21: error: the text that begins here has no closing quote\n"
                  "folder/case.nml:2:1: error: &output is not closed: expected '/' before the end of the "
                  "text\n");
    expect_errors(SCENE SCENE, 0, NULL,
                  "folder/case.nml:2:1: error: &scene is given twice (first on line 1); it may occur once\n");
    expect_errors("", 0, NULL,
                  "folder/case.nml:1:1: error: no group of a deck is in this file; expected '&scene ... /' "
                  "and others\n"
                  "folder/case.nml:1:1: error: 'end_time' is missing in &scene: end of the computation "
                  "[time]\n");
}

static void takes_overrides(void **state)
{
    (void)state;
    const char *const override[] = {
        "body%spacing=0.25", "load(2)%amplitude = 3",   "stepping%scheme=rk4",    "body%low=0,0,1",
        "body%high(2)=9",    "boundary%face=x-, y+",    "boundary%kind='fixed'",  "scene%title=It's, new",
        "output%plots=F",    "receiver%position=3*1.5", "receiver(1)%name=\"r\"", "output%directory=a/b"};
    struct reading r = read_with("&scene end_time=1 title='old' /\n&body spacing=1 high=1,2,3 /\n&load /\n"
                                 "&load amplitude=2/\n",
                                 sizeof override / sizeof *override, override);
    if (r.messages.text != NULL) print_error("%s", r.messages.text);
    assert_int_equal(r.status, SELAS_OK);
    const struct deck_group *body = deck_get(r.deck, "body", 0), *boundary = deck_get(r.deck, "boundary", 0);
    assert_true(deck_real(body, "spacing", 0) == 0.25);
    assert_true(deck_real(body, "low", 2) == 1.0);
    assert_true(deck_real(body, "high", 1) == 9.0 && deck_real(body, "high", 2) == 3.0);
    assert_true(deck_real(deck_get(r.deck, "load", 0), "amplitude", 0) == 1.0);
    assert_true(deck_real(deck_get(r.deck, "load", 1), "amplitude", 0) == 3.0);
    assert_string_equal(deck_text(deck_get(r.deck, "stepping", 0), "scheme", 0), "rk4");
    assert_int_equal(deck_values(boundary, "face"), 2);
    assert_int_equal(deck_choice(boundary, "face", 1), 3);
    assert_string_equal(deck_text(deck_get(r.deck, "scene", 0), "title", 0), "It's, new");
    assert_string_equal(deck_text(deck_get(r.deck, "output", 0), "directory", 0), "a/b");
    assert_false(deck_logical(deck_get(r.deck, "output", 0), "plots", 0));
    deck_error(r.deck, body, "spacing", &r.messages, "too %s", "small");
    deck_error(r.deck, body, NULL, &r.messages, "odd");
    deck_warning(r.deck, boundary, "layer", &r.messages, "none");
    assert_string_equal(r.messages.text, "override: error: too small\nfolder/case.nml:2:1: error: odd\n"
                                         "override: warning: none\n");
    assert_string_equal(deck_source(r.deck), "&scene end_time=1 title='old' /\n&body spacing=1 high=1,2,3 /\n"
                                             "&load /\n&load amplitude=2/\n");
    release(&r);
}

static void refuses_wrong_overrides(void **state)
{
    (void)state;
    const char *const override[] = {"body%spacing=-1",
                                    "boddy%spacing=1",
                                    "body%spcing=1",
                                    "body%low=0,0,0,0",
                                    "receiver%name=a",
                                    "receiver(4)%name=a",
                                    "body(2)%seed=1",
                                    "body%jitter=x",
                                    "body%jitter(1)=",
                                    "body%jiter=",
                                    "snapshot%every=",
                                    "receiver(3)%name=",
                                    "body",
                                    "spacing=1",
                                    "body%seed=1 2",
                                    "body%seed=2",
                                    "receiver(0)%name=a",
                                    "output%low_pass=.1 / body%seed=3"};
    expect_errors(
        SCENE "&body /\n&receiver name='a' position=0/\n&receiver name='b' position=0/\n",
        sizeof override / sizeof *override, override,
        "override: error: unknown group 'boddy'; did you mean 'body'?\n"
        "override: error: unknown name 'spcing' in &body; did you mean 'spacing'?\n"
        "override: error: too many values in 'low=0,0,0,0'\n"
        "override: error: which of the 2 groups &receiver does 'receiver%name=a' mean? Write "
        "receiver(1)%... to receiver(2)%...\n"
        "override: error: there is no receiver(4): the deck has 2\n"
        "override: error: there is no body(2): the deck has 1\n"
        "override: error: expected a real number, found 'x'\n"
        "override: error: no value for 'jitter' of &body; a name without a subscript would be "
        "unset\n"
        "override: error: unknown name 'jiter' in &body; did you mean 'jitter'?\n"
        "override: error: 'snapshot%every=' would unset a name, but the deck has 0 groups &snapshot\n"
        "override: error: 'receiver(3)%name=' would unset a name, but the deck has 2 groups "
        "&receiver\n"
        "override: error: no '=' in 'body'; expected group%name=value\n"
        "override: error: no '%' between group and name in 'spacing=1'; expected group%name=value\n"
        "override: error: too many values in 'seed=1 2'\n"
        "override: error: 'seed' is given twice\n"
        "override: error: bad number of the group in 'receiver(0)%name=a'; expected "
        "group%name=value\n"
        "override: error: too many values in 'low_pass=.1 / body%seed=3'\n"
        "override: error: -1 for 'spacing' in &body; expected a number in (0, inf)\n");
}

/* A name without a value is unset: an obligatory one is then missing, others have their defaults. */
static void unsets_names(void **state)
{
    (void)state;
    const char *const override[] = {"body%jitter=",      "snapshot(2)%every= ", "snapshot(2)%times=1,2",
                                    "output%directory=", "body%seed=4",         "body%seed="};
    struct reading r = read_with(SCENE "&body jitter=.2, seed=7 /\n&snapshot every=1 /\n&snapshot every=2 /\n"
                                       "&output directory='there' /\n",
                                 sizeof override / sizeof *override, override);
    assert_int_equal(r.status, SELAS_OK);
    const struct deck_group *body = deck_get(r.deck, "body", 0), *shot = deck_get(r.deck, "snapshot", 1);
    assert_true(deck_real(body, "jitter", 0) == 0 && deck_integer(body, "seed", 0) == 1);
    assert_true(deck_values(shot, "every") == 0 && deck_values(shot, "times") == 2);
    assert_true(deck_real(deck_get(r.deck, "snapshot", 0), "every", 0) == 1);
    assert_true(deck_values(deck_get(r.deck, "output", 0), "directory") == 0);
    release(&r);
    const char *const obligatory[] = {"receiver%position="};
    expect_errors(SCENE "&receiver name='a' position=0/\n", 1, obligatory,
                  "folder/case.nml:2:1: error: 'position' is missing in &receiver: position [length]\n");
}

static char *echo(const struct deck *deck)
{
    char *text = NULL;
    size_t size = 0;
    struct messages messages = {0};
    FILE *file = open_memstream(&text, &size);
    assert_int_equal(deck_write(deck, file, &messages), SELAS_OK);
    fclose(file);
    return text;
}

static void echo_reads_again_to_the_same(void **state)
{
    (void)state;
    struct reading r = read_text("&scene end_time=.1 title='it''s \"x\"' accuracy=4.9406564584124654e-324 /\n"
                                 "&body file='points.h5' spacing=.3333333333333333148 jitter=+.1d0 /\n"
                                 "&load file='/abs/table' amplitude=-1.7976931348623157e308 /\n"
                                 "&snapshot times=1,2,3,4,5,6,7,8.1 fields='stress','energy' /\n"
                                 "&receiver name='a' position=-0.,1e-9,1e22 /\n");
    assert_int_equal(r.status, SELAS_OK);
    char *first = echo(r.deck), *folder = getcwd(NULL, 0);
    char path[8192];
    snprintf(path, sizeof path, "file = '%s/folder/points.h5'\n", folder);
    assert_non_null(strstr(first, path));
    assert_non_null(strstr(first, "file = '/abs/table'\n"));
    struct reading again = read_text(first);
    assert_int_equal(again.status, SELAS_OK);
    const struct deck_group *one = deck_get(r.deck, "body", 0), *two = deck_get(again.deck, "body", 0);
    assert_true(deck_real(one, "spacing", 0) == deck_real(two, "spacing", 0));
    assert_true(deck_given(two, "jitter") && !deck_given(two, "seed") && !deck_given(two, "rotation"));
    char *second = echo(again.deck);
    assert_string_equal(first, second);
    char *resolved = deck_resolve(r.deck, "points.h5");
    assert_string_equal(resolved, "folder/points.h5");
    array_free(resolved);
    free(first);
    free(second);
    free(folder);
    release(&r);
    release(&again);
}

/* A host may have set a locale whose decimal sign is a comma (if the machine has one). */
static void numbers_do_not_depend_on_the_locale(void **state)
{
    (void)state;
    if (setlocale(LC_NUMERIC, "de_DE.UTF-8") == NULL) setlocale(LC_NUMERIC, "C.UTF-8");
    struct reading r = read_text("&scene end_time=2.5 accuracy=0.25 /\n");
    assert_int_equal(r.status, SELAS_OK);
    assert_true(deck_real(deck_get(r.deck, "scene", 0), "end_time", 0) == 2.5);
    char *text = echo(r.deck);
    assert_non_null(strstr(text, "end_time = 2.5\n"));
    free(text);
    release(&r);
    setlocale(LC_NUMERIC, "C");
}

static void hostile_files_end_in_messages(void **state)
{
    (void)state;
    struct deck *deck;
    struct messages messages = {0};
    assert_int_equal(deck_read_file("no/such.nml", 0, NULL, &deck, &messages), SELAS_BAD_DECK);
    assert_int_equal(deck_read_file("/", 0, NULL, &deck, &messages), SELAS_BAD_DECK);
    assert_int_equal(deck_read_text("z", "&scene\0/", 8, 0, NULL, &deck, &messages), SELAS_BAD_DECK);
    assert_null(deck);
    assert_string_equal(messages.text, "no/such.nml:1:1: error: cannot be opened: No such file or directory\n"
                                       "/:1:1: error: is a directory, not a deck\n"
                                       "z:1:7: error: a byte 0: this is not a text file\n");
    messages_free(&messages);
    expect_errors("&scene end_time = 1000000000*0 /", 0, NULL,
                  "folder/case.nml:1:19: error: expected a repeat count from 1 to 200000000, found "
                  "'1000000000*'\n");
    expect_errors(SCENE "&snapshot times = 200000000*0 /", 0, NULL,
                  "folder/case.nml:2:11: error: too many values for 'times': at most 1000\n");
}

/* A million bytes of each of these end in a bounded number of errors. */
static void junk_ends_quickly(void **state)
{
    (void)state;
    static const char *const pieces[] = {
        "&scene x = 'a' (((,,,=\n",     "'\"", "&a ", "&load\n", "&load/", "((((", "a=", "\n",
        "\377\376 &body name = \201 /", "1*",  "!",   "&",       "T ! x\n"};
    const size_t length = 1000000;
    char *text = malloc(length);
    assert_non_null(text);
    for (size_t i = 0; i < sizeof pieces / sizeof *pieces; i++) {
        const size_t size = strlen(pieces[i]);
        for (size_t j = 0; j < length; j++)
            text[j] = pieces[i][j % size];
        if (i % 2 == 0) memcpy(text, "&snapshot times = ", 18);
        struct deck *deck;
        struct messages messages = {0};
        assert_int_equal(deck_read_text("junk", text, length, 0, NULL, &deck, &messages), SELAS_BAD_DECK);
        assert_in_range(messages.errors, 1, 1000);
        messages_free(&messages);
    }
    free(text);
}

/* What every entry of the table must keep to. */
static void table_is_sound(void **state)
{
    (void)state;
    const struct word_table *table = deck_words();
    for (size_t i = 0; i < table->groups; i++) {
        const struct word_group *group = &table->group[i];
        assert_int_equal(words_find_group(table, group->name, strlen(group->name)), i);
        for (size_t j = 0; j < group->words; j++) {
            const struct word *word = &group->word[j];
            assert_int_equal(words_find(group, word->name, strlen(word->name)), j);
            assert_true(word->count >= 1 && *word->gloss != '\0');
            assert_false(word->need == OBLIGATORY && word->defaults != NULL);
            if (word->type == WORD_CHOICE) {
                assert_non_null(word->range);
            } else if (word->range != NULL) {
                const size_t length = strlen(word->range);
                assert_true(word->type == WORD_REAL || word->type == WORD_INTEGER);
                assert_true(strchr("([", word->range[0]) != NULL &&
                            strchr(")]", word->range[length - 1]) != NULL);
                assert_non_null(strchr(word->range, ','));
            }
        }
    }
    struct reading r = read_text(SCENE); /* reads all defaults */
    assert_int_equal(r.status, SELAS_OK);
    char *text = echo(r.deck);
    struct reading again = read_text(text); /* and finds them within their ranges */
    assert_int_equal(again.status, SELAS_OK);
    free(text);
    release(&r);
    release(&again);
}

static void ranges_and_spellings(void **state)
{
    (void)state;
    const struct word half_open = {"a", WORD_REAL, 1, NULL, "(-1, 0.5]", OPTIONAL, ""};
    assert_false(word_in_range(&half_open, -1.0));
    assert_true(word_in_range(&half_open, 0.5));
    assert_false(word_in_range(&half_open, 0.5000001));
    const struct word positive = {"a", WORD_REAL, 1, NULL, "(0, inf)", OPTIONAL, ""};
    assert_false(word_in_range(&positive, 0.0));
    assert_true(word_in_range(&positive, 1e300));
    assert_false(word_in_range(&positive, 1e300 * 1e300));
    assert_int_equal(words_distance("spacing", "SPACING"), 0);
    assert_int_equal(words_distance("spcaing", "spacing"), 1); /* neighbours swapped */
    assert_int_equal(words_distance("spacing", "spaing"), 1);
    assert_int_equal(words_distance("kitten", "sitting"), 3);
    assert_int_equal(words_distance("", "abc"), 3);
}

/* Words for experts are suggested only where no other word is as near. */
static void suggestions(void **state)
{
    (void)state;
    static const struct word words[] = {{"quiet", WORD_REAL, 1, NULL, NULL, EXPERT, ""},
                                        {"quint", WORD_REAL, 1, NULL, NULL, OPTIONAL, ""},
                                        {"force", WORD_CHOICE, 1, NULL, "push|pull", EXPERT, ""}};
    static const struct word_group group = {"group", GROUP_ONCE, "", words, 3, NULL};
    static const struct word_table table = {&group, 1};
    char text[SUGGESTION_SIZE];
    assert_string_equal(suggest_word(NULL, &group, "quit", text),
                        "; did you mean 'quint'?"); /* both 1 away */
    assert_string_equal(suggest_word(NULL, &group, "quite", text),
                        "; did you mean 'quiet'?"); /* 1 against 2 */
    assert_string_equal(suggest_word(NULL, &group, "forec", text), "; did you mean 'force'?");
    assert_string_equal(suggest_word(NULL, &group, "spacing", text), "");
    assert_string_equal(suggest_word(deck_words(),
                                     &deck_words()->group[words_find_group(deck_words(), "material", 8)],
                                     "Vp", text),
                        "; did you mean 'p_speed'?"); /* what others call it */
    assert_string_equal(suggest_group(&table, "gruop", "&", text), "; did you mean '&group'?");
    assert_string_equal(suggest_group(&table, "body", "&", text), "");
    assert_string_equal(suggest_choice(&words[2], "pul", text), "; did you mean 'pull'?");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gives_values_and_defaults),
        cmocka_unit_test(reports_all_errors_at_their_places),
        cmocka_unit_test(reports_groups_that_never_end),
        cmocka_unit_test(takes_overrides),
        cmocka_unit_test(refuses_wrong_overrides),
        cmocka_unit_test(unsets_names),
        cmocka_unit_test(echo_reads_again_to_the_same),
        cmocka_unit_test(numbers_do_not_depend_on_the_locale),
        cmocka_unit_test(hostile_files_end_in_messages),
        cmocka_unit_test(junk_ends_quickly),
        cmocka_unit_test(table_is_sound),
        cmocka_unit_test(ranges_and_spellings),
        cmocka_unit_test(suggestions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
