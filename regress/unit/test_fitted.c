/* What the program finds out about a scene by itself: the box of a half-space and mirror planes. */
#include "deck/words.h"
#include "scene/absorbing_layers.h"
#include "scene/echo.h"
#include "scene/extent.h"
#include "scene/symmetry.h"

#include "from_deck.h"

#define ROCK "&material name='rock', density=1, lambda=1, mu=1 /\n"
#define GROUND(end, spacing)                                                                                 \
    "&scene dimension=3, end_time=" end " /\n" ROCK                                                          \
    "&body material='rock', shape='half-space', spacing=" spacing " /\n"
#define PATCH                                                                                                \
    "&load face='z-', shape='square', centre=3, 2, 0, size=1, 1, direction=0, 0, 1, history='triangle', "    \
    "duration=2 /\n"
#define PULSE                                                                                                \
    "&load face='z-', shape='square', centre=3, 2, 0, size=1, 1, direction=0, 0, 1, history='gaussian', "    \
    "width=.6, delay=3 /\n"
#define RECEIVER "&receiver name='far', position=5, 2, 0 /\n"

/* Late end: layers. The box ends four points beyond load and receiver, is even about the load, twelve points
 * deep at least. */
static void small_box_with_layers(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene(GROUND("60", ".125") PATCH RECEIVER);
    const struct body *body = &d.scene->body;
    assert_true(body->chosen && body->absorbing);
    assert_near(body->high[0], 5.5, 1e-12);
    assert_near(body->low[0], 0.5, 1e-12);
    assert_near(body->low[1], 1.0, 1e-12);
    assert_near(body->high[1], 3.0, 1e-12);
    assert_near(body->low[2], 0.0, 0);
    assert_near(body->high[2], 1.5, 1e-12);
    for (int face = 0; face < BOX_FACES; face++)
        assert_int_equal(d.scene->boundary[face].kind,
                         face == FACE_Z_LOW ? BOUNDARY_FREE : BOUNDARY_TRANSMITTING);
    assert_int_equal(scene_mirror_axes(d.scene), 3);
    assert_non_null(strstr(body->choice, "absorbing layers"));
    from_deck_free(&d);
}

/* All on one line: the narrowest box would have too few cells across it for a mirror plane. A wider one costs half. */
static void wide_enough_for_mirrors(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene(GROUND(
        "60", ".125") "&load face='z-', shape='point', centre=3,0,0, direction=0,0,1, history='gaussian', "
                      "width=.3, delay=1.5 /\n&receiver name='far', position=5, 0, 0 /\n");
    assert_true(d.scene->body.absorbing);
    assert_int_equal(scene_mirror_axes(d.scene), 3);
    from_deck_free(&d);
}

/* Early end: a box from which nothing returns: every path load - face - receiver takes at least end_time at
 * c_p. */
static void large_box_without_layers(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene(GROUND("1", ".5") PATCH RECEIVER);
    const struct body *body = &d.scene->body;
    assert_true(body->chosen && !body->absorbing);
    const double reach = sqrt(3.0) * 1.0;
    assert_true((body->high[0] - 3.5) + (body->high[0] - 5.0) >= reach);
    assert_true((2.5 - body->low[0]) + (5.0 - body->low[0]) >= reach);
    assert_true((body->high[1] - 2.5) + (body->high[1] - 2.0) >= reach);
    assert_true(2.0 * body->high[2] >= reach);
    for (int face = 0; face < BOX_FACES; face++)
        assert_int_equal(d.scene->boundary[face].kind, BOUNDARY_FREE);
    from_deck_free(&d);
}

/* What the deck says of a side stays. */
static void named_sides_are_kept(void **unused)
{
    (void)unused;
    struct from_deck d =
        right_scene(GROUND("60", ".125") PATCH RECEIVER "&boundary face='z+', kind='transmitting', "
                                                        "layer_thickness=.7 /\n");
    assert_int_equal(layer_points(d.scene, FACE_Z_HIGH), 6);
    assert_true(d.scene->boundary[FACE_Z_HIGH].given && !d.scene->boundary[FACE_X_LOW].given);
    assert_int_equal(d.scene->boundary[FACE_X_LOW].absorber, ABSORBER_PML);
    from_deck_free(&d);
}

#define BOX                                                                                                  \
    "&scene dimension=3, end_time=6 /\n" ROCK "&body material='rock', low=0,0,0, high=8,6,5, spacing=.5 /\n"
#define LOAD(words) "&load face='z-', history='triangle', duration=2, " words " /\n"

static void mirror_planes(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        unsigned axes;
    } cases[] = {
        {BOX, 7}, /* nothing acts: everything is symmetric */
        {BOX LOAD("shape='square', centre=4,3,0, size=1,1, direction=0,0,1"), 3},
        {BOX LOAD("shape='square', centre=4,3,0, size=1,1, direction=0,0,1, amplitude=-2"), 3},
        {BOX LOAD("shape='disc', centre=4,2.5,0, size=1, direction=0,0,1"), 1},
        {BOX LOAD("shape='square', centre=4,3,0, size=1,1, direction=1,0,0"), 2}, /* odd across x */
        {BOX LOAD("shape='square', centre=4,3,0, size=1,1, direction=1,0,1"), 2},
        /* a pair of loads is symmetric if the images match in place, direction, size and history */
        {BOX LOAD("shape='square', centre=3,3,0, size=1,1, direction=0,0,1")
             LOAD("shape='square', centre=5,3,0, size=1,1, direction=0,0,1"),
         3},
        {BOX LOAD("shape='square', centre=3,3,0, size=1,1, direction=1,0,0")
             LOAD("shape='square', centre=5,3,0, size=1,1, direction=-1,0,0"),
         3},
        {BOX LOAD("shape='square', centre=3,3,0, size=1,1, direction=1,0,0")
             LOAD("shape='square', centre=5,3,0, size=1,1, direction=1,0,0"),
         2},
        {BOX LOAD("shape='square', centre=3,3,0, size=1,1, direction=0,0,1")
             LOAD("shape='square', centre=5,3,0, size=1,1, direction=0,0,1, amplitude=2"),
         2},
        {BOX LOAD("shape='square', centre=3,3,0, size=1,1, direction=0,0,1")
             LOAD("shape='square', centre=5,3,0, size=1,2, direction=0,0,1"),
         2},
        {BOX LOAD("shape='square', centre=3,3,0, size=1,1, direction=0,0,1") "&load face='z-', "
                                                                             "shape='square', centre=5,3,0, "
                                                                             "size=1,1, direction=0,0,1, "
                                                                             "history='triangle', "
                                                                             "duration=1 /\n",
         2},
        /* two equal loads in one place do not make up for one on the other side */
        {BOX LOAD("shape='square', centre=3,3,0, size=1,1, direction=0,0,1")
             LOAD("shape='square', centre=3,3,0, size=1,1, direction=0,0,1")
                 LOAD("shape='square', centre=5,3,0, size=1,1, direction=0,0,1"),
         2},
        /* faces */
        {BOX "&boundary face='x-', kind='fixed' /\n", 6},
        {BOX "&boundary face='x-', 'x+', kind='fixed' /\n", 7},
        {BOX "&boundary face='x-', kind='transmitting' /\n&boundary face='x+', kind='transmitting', "
             "shear_factor=.8 /\n",
         6},
        {BOX "&boundary face='z+', kind='velocity', direction=0,1,0, history='step' /\n", 1},
        /* too thin for a part with mirrors: of degree 3 depth and width are */
        {BOX "&method degree=3 /\n", 1},
        /* a moment tensor on two planes, and off them */
        {BOX "&load kind='moment-tensor', centre=4,3,2, moment=1,2,3,0,0,0, history='step' /\n", 3},
        {BOX "&load kind='moment-tensor', centre=4,3,2, moment=0,0,0,1,0,0, history='step' /\n", 0},
        {BOX "&initial kind='uniform-velocity', velocity=1,0,0 /\n", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct from_deck d = right_scene(cases[i].text);
        if (scene_mirror_axes(d.scene) != cases[i].axes) print_error("case %zu\n", i);
        assert_int_equal(scene_mirror_axes(d.scene), cases[i].axes);
        from_deck_free(&d);
    }
}

/* A plane between points is none that the lattice could be cut at. */
static void odd_numbers_of_cells_have_no_mirror(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene("&scene dimension=3, end_time=6 /\n" ROCK
                                     "&body material='rock', low=0,0,0, high=11,12,13, spacing=1 /\n");
    assert_int_equal(scene_mirror_axes(d.scene), 2);
    from_deck_free(&d);
}

/* The load turns with nothing: in a turned body it must be symmetric about the body's own planes. */
static void turned_bodies(void **unused)
{
    (void)unused;
    struct from_deck d =
        right_scene("&scene dimension=3, end_time=6 /\n" ROCK
                    "&body material='rock', low=0,0,0, high=8,6,5, spacing=.5, rotation=0,0,30 /\n" LOAD(
                        "shape='square', centre=4,3,0, size=1,1, direction=0,0,1"));
    assert_int_equal(scene_mirror_axes(d.scene), 3);
    from_deck_free(&d);
    d = right_scene("&scene dimension=3, end_time=6 /\n" ROCK
                    "&body material='rock', low=0,0,0, high=8,6,5, spacing=.5, rotation=0,0,30 /\n" LOAD(
                        "shape='square', centre=4,3,0, size=1,1, direction=1,0,0"));
    assert_int_equal(scene_mirror_axes(d.scene), 0);
    from_deck_free(&d);
    /* M is symmetric about the deck's planes, not about the body's: turned by 90 degrees it would be */
    static const struct {
        const char *rotation;
        unsigned axes;
    } turned[] = {{"rotation=0,0,90", 3}, {"rotation=0,0,30", 0}};
    for (size_t i = 0; i < 2; i++) {
        char text[600];
        snprintf(text, sizeof text,
                 "&scene dimension=3, end_time=6 /\n" ROCK
                 "&body material='rock', low=0,0,0, high=8,6,5, spacing=.5, %s /\n"
                 "&load kind='moment-tensor', centre=4,3,2, moment=1,2,3,0,0,0, "
                 "history='step' /\n",
                 turned[i].rotation);
        d = right_scene(text);
        assert_int_equal(scene_mirror_axes(d.scene), turned[i].axes);
        from_deck_free(&d);
    }
}

/* Every group of the deck states what it acts on or looks at, or that it does neither. */
static void all_groups_are_stated(void **unused)
{
    (void)unused;
    const struct word_table *table = deck_words();
    assert_true(table->groups > 10);
    for (size_t g = 0; g < table->groups; g++) {
        if (!extent_stated(table->group[g].name)) print_error("no extent: &%s\n", table->group[g].name);
        assert_true(extent_stated(table->group[g].name));
    }
    assert_false(extent_stated("nobody"));
}

/* Places, times and wavelengths of what acts and what is looked at. */
static void extents(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene(GROUND(
        "4", ".5") "&load face='z-', shape='disc', centre=1,2,0, size=2, direction=1,0,0, velocity=2,0,0, "
                   "history='gaussian', width=.3, delay=1.5 /\n"
                   "&load kind='body-force', shape='point', centre=0,0,3, direction=0,0,1, history='step' /\n"
                   "&initial kind='gaussian', amplitude=1, width=.2, centre=0,1,2, direction=0,0,1 /\n"
                   "&profile name='p', from=0,0,0, to=1,0,2, times=3,1 /\n"
                   "&snapshot times=2, region=0,0,0,1,2,3 /\n");
    struct extent found[16];
    size_t count = 0;
    for (size_t i = 0; scene_extent(d.scene, i, &found[count]); i++)
        if (found[count].role != EXTENT_IDLE) count++;
    assert_int_equal(count, 5);
    assert_near(found[0].low[0], 0, 1e-12);
    assert_near(found[0].high[0], 10, 1e-12); /* 1 + 2 * 4 + 1 */
    assert_near(found[0].high[2], 0, 0);
    /* of exp(-t^2 / (2 w^2)): rms frequency of the slope sqrt(3/2) / w */
    assert_near(found[0].wavelength, 2 * M_PI * sqrt(3.) * .3 / sqrt(1.5), 1e-3);
    assert_true(isinf(found[1].wavelength));
    assert_near(found[2].low[1], 0, 1e-12);
    assert_near(found[3].high[2], 2, 0);
    assert_near(found[3].until, 3, 0);
    assert_near(found[4].high[1], 2, 0);
    assert_near(found[4].until, 2, 0);
    from_deck_free(&d);
}

/* Pieces of a load that a host drives stand behind all loads, with the group of their own: each load is an extent still. */
static void extents_of_driven_loads(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene(GROUND("4", ".5") PATCH PULSE PATCH RECEIVER);
    struct extent found;
    size_t loads = 0;
    d.scene->load[2].group = 0;
    d.scene->load[2].driven = BY_HOST;
    for (size_t i = 0; scene_extent(d.scene, i, &found); i++)
        loads += found.role == EXTENT_ACTS;
    assert_int_equal(loads, 2);
    from_deck_free(&d);
}

/* Half the spacing: a layer has more points, however far the receiver, and is expected to send back less. */
static void layers_follow_the_spacing(void **unused)
{
    (void)unused;
    static const char *const spacings[] = {"body%spacing=.2", "body%spacing=.1", "body%spacing=.05"};
    double before = 1;
    for (size_t i = 0; i < 3; i++) {
        struct from_deck d =
            from_text(GROUND("14", ".2") PULSE "&receiver name='far', position=13,2,0 /\n", 1, &spacings[i]);
        assert_non_null(d.scene);
        assert_true(d.scene->body.absorbing);
        double worst = 0;
        for (int face = 0; face < BOX_FACES; face++) {
            const size_t points = layer_points(d.scene, face);
            if (points > 0) worst = fmax(worst, echo_of_layer(d.scene, face, points));
        }
        assert_true(worst > 0 && worst < before && worst <= 1e-3);
        before = worst;
        from_deck_free(&d);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_box_with_layers),
        cmocka_unit_test(wide_enough_for_mirrors),
        cmocka_unit_test(large_box_without_layers),
        cmocka_unit_test(named_sides_are_kept),
        cmocka_unit_test(all_groups_are_stated),
        cmocka_unit_test(extents),
        cmocka_unit_test(extents_of_driven_loads),
        cmocka_unit_test(layers_follow_the_spacing),
        cmocka_unit_test(mirror_planes),
        cmocka_unit_test(odd_numbers_of_cells_have_no_mirror),
        cmocka_unit_test(turned_bodies),
    };
    return cmocka_run_group_tests_name("fitted", tests, NULL, NULL);
}
