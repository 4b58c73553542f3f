/* Kinds of boundaries: what each holds, and which methods refuse it, with its place in the deck. */
#include "from_deck.h"
#include "method/methods.h"

#define SQUARE                                                                                               \
    "&scene dimension=2, end_time=1 /\n&material name='rock', density=1, lambda=1, mu=1 /\n"                 \
    "&body material='rock', low=0,0, high=3,3, spacing=.25 /\n"
#define MOTION ", direction=1,0, history='step'"

/* Components x and y that are held on a face, as letters, and where its motion goes with slip. */
static void faces_hold(void **state)
{
    (void)state;
    static const struct {
        const char *face, *treatment, *held;
    } cases[] = {
        {"x-", "'free'", ""},
        {"x-", "'fixed'", "xy"},
        {"x-", "'roller'", "x"},
        {"y+", "'roller'", "y"},
        {"x-", "'symmetry'", "x"},
        {"y+", "'symmetry'", "y"},
        {"x-", "'transmitting'", ""},
        {"x-", "'velocity'" MOTION, "xy"},
        {"x-", "'displacement'" MOTION, "xy"},
        {"y+", "'velocity', slip=T" MOTION, "x"},
        {"x-", "'displacement', slip=T" MOTION, "x"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[600];
        snprintf(text, sizeof text, SQUARE "&boundary face='%s', kind=%s /\n", cases[i].face,
                 cases[i].treatment);
        struct from_deck d = right_scene(text);
        const enum face face = cases[i].face[0] == 'x' ? FACE_X_LOW : FACE_Y_HIGH;
        for (int c = 0; c < 2; c++)
            if (face_holds(d.scene, face, c) != (strchr(cases[i].held, "xy"[c]) != NULL))
                fail_msg("face %s, kind %s: component %c", cases[i].face, cases[i].treatment, "xy"[c]);
        from_deck_free(&d);
    }
}

/* A body turned by 90 degrees: the deck's y is the body's x. */
static void slip_is_of_the_body(void **state)
{
    (void)state;
    struct from_deck d =
        right_scene("&scene dimension=2, end_time=1 /\n&material name='rock', density=1, lambda=1, mu=1 /\n"
                    "&body material='rock', low=0,0, high=3,3, spacing=.25, rotation=0,0,90 /\n"
                    "&boundary face='x-', kind='velocity', slip=T, direction=0,1, history='step' /\n");
    assert_true(face_holds(d.scene, FACE_X_LOW, 0));
    assert_false(face_holds(d.scene, FACE_X_LOW, 1));
    from_deck_free(&d);
}

/* The displacement of a face, its velocity and acceleration: t and 1 s after a step of velocity. */
static void motions(void **state)
{
    (void)state;
    const char *const kinds[] = {"velocity", "displacement"};
    for (int k = 0; k < 2; k++) {
        char text[600];
        snprintf(text, sizeof text,
                 SQUARE
                 "&boundary face='x-', kind='%s', direction=1,0, history='gaussian', width=.2, delay=1 "
                 "/\n",
                 kinds[k]);
        struct from_deck d = right_scene(text);
        const struct boundary *boundary = &d.scene->boundary[FACE_X_LOW];
        const double step = 1e-4, t = .9;
        const double value = boundary_displacement(boundary, t, 0);
        const double after = boundary_displacement(boundary, t + step, 0),
                     before = boundary_displacement(boundary, t - step, 0);
        const double shape = exp(-(t - 1) * (t - 1) / (2 * .2 * .2));
        assert_near((after - before) / (2 * step), boundary_displacement(boundary, t, 1), 1e-6);
        assert_near((after - 2 * value + before) / (step * step), boundary_displacement(boundary, t, 2),
                    1e-5);
        assert_near(boundary_displacement(boundary, t, 1 - k), shape, 1e-12);
        assert_true(boundary_displacement(&d.scene->boundary[FACE_X_HIGH], t, 0) == 0);
        from_deck_free(&d);
    }
}

static const char *const methods[][2] = {{"smoothed-point", "consistent"},
                                         {"smoothed-point", "paper"},
                                         {"smoothed-point", "cloud"},
                                         {"sph", "total-lagrangian"},
                                         {"sph", "updated-lagrangian"}};
enum { METHODS_TESTED = sizeof methods / sizeof *methods };

/* 'c' can, '-' refuses: in the order of the methods above. */
static void methods_refuse(void **state)
{
    (void)state;
    static const struct {
        const char *treatment, *verdict, *place;
    } cases[] = {
        {"kind='fixed'", "ccccc", ""},
        {"kind='roller'", "ccccc", ""},
        {"kind='symmetry'", "ccccc", ""},
        {"kind='transmitting'", "ccccc", ""},
        {"kind='transmitting', layer='pml', always=T", "c----", "t.nml:5:43: error:"},
        {"kind='velocity'" MOTION, "cc-cc", "t.nml:5:22: error:"},
        {"kind='displacement'" MOTION, "cc-cc", "t.nml:5:22: error:"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (size_t m = 0; m < METHODS_TESTED; m++) {
            char text[600];
            snprintf(text, sizeof text,
                     SQUARE "&method name='%s', variant='%s' /\n&boundary face='x-', %s /\n", methods[m][0],
                     methods[m][1], cases[i].treatment);
            struct from_deck d = right_scene(text);
            struct model *model = NULL;
            const bool can = cases[i].verdict[m] == 'c';
            const selas_status status = model_create(d.scene, &model, &d.messages);
            if (status != (can ? SELAS_OK : SELAS_UNSUPPORTED))
                fail_msg("%s, %s: %s", methods[m][1], cases[i].treatment, selas_status_name(status));
            if (!can) {
                assert_null(model);
                assert_int_equal(strncmp(d.messages.text, cases[i].place, strlen(cases[i].place)), 0);
                assert_non_null(strstr(d.messages.text, methods[m][1]));
                assert_non_null(strstr(d.messages.text, "face 'x-'"));
            }
            model_free(&model);
            from_deck_free(&d);
        }
}

/* A method that can do nothing, as all methods can for the ability of a kind that is new, refuses all kinds
 * but the free one; and the sides that the program chose, which have no place in the deck. */
static void nothing_is_taken_as_free(void **state)
{
    (void)state;
#define WORD(symbol, word, ...) word,
    static const char *const kinds[] = {BOUNDARY_KINDS(WORD)};
    for (size_t kind = 0; kind < sizeof kinds / sizeof *kinds; kind++) {
        struct scene scene = {.dimension = 3};
        struct messages messages = {0};
        scene.boundary[FACE_Y_LOW].kind = (enum boundary_kind)kind;
        const bool can = scene_check_faces(&scene, 0, "nobody", &messages) == SELAS_OK;
        assert_int_equal(can, strcmp(kinds[kind], "free") == 0);
        assert_string_equal(boundary_meaning(&scene.boundary[FACE_Y_LOW])->name, kinds[kind]);
        if (!can) assert_non_null(strstr(messages.text, kinds[kind]));
        messages_free(&messages);
    }
}

/* The words of the list lead to their methods. */
static void names_of_methods(void **state)
{
    (void)state;
#define NO_FAMILY(word)
#define PAIR(symbol, family, word, points) {family, word},
    static const char *const list[][2] = {METHODS(NO_FAMILY, PAIR)};
    assert_int_equal(sizeof list / sizeof *list, METHODS_TESTED);
    for (size_t m = 0; m < METHODS_TESTED; m++) {
        const struct method *method = method_find(list[m][0], list[m][1]);
        assert_non_null(method);
        assert_string_equal(method->name, list[m][0]);
        assert_string_equal(method->variant, list[m][1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faces_hold),       cmocka_unit_test(slip_is_of_the_body),
        cmocka_unit_test(motions),          cmocka_unit_test(methods_refuse),
        cmocka_unit_test(names_of_methods), cmocka_unit_test(nothing_is_taken_as_free),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
