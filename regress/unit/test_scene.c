/* The scene: what a right deck becomes, and that overrides reach it. */
#include "accuracy/accuracy.h"
#include "from_deck.h"
#include "scene/units.h"

#include <glob.h>
#include <stdlib.h>
#include <unistd.h>

#define ROCK "&material name='rock', density=2, lambda=3, mu=5 /\n"
#define BOX                                                                                                  \
    "&scene dimension=3, end_time=6 /\n" ROCK "&body material='rock', low=0,0,0, high=7,7,7, spacing=.5 /\n"

static void defaults(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene(BOX);
    const struct scene *scene = d.scene;
    assert_string_equal(scene->method.name, "smoothed-point");
    assert_string_equal(scene->method.variant, "consistent");
    assert_string_equal(scene->output.directory, "output/t");
    assert_string_equal(scene->stepping.scheme, "");
    assert_near(scene->stepping.safety, .9, 0);
    assert_near(scene->stepping.time_step + scene->stepping.courant, 0, 0);
    assert_false(scene->stepping.unwarp_given);
    assert_int_equal(scene->initial.kind, INITIAL_REST);
    assert_string_equal(scene->reference.kind, "");
    assert_int_equal(scene->body.shape, BODY_BOX);
    assert_false(scene->body.rotated);
    for (int face = 0; face < FACES; face++) {
        assert_int_equal(scene->boundary[face].kind, BOUNDARY_FREE);
        assert_false(scene->boundary[face].given);
    }
    assert_int_equal(scene->loads + scene->receivers + scene->profiles + scene->snapshots, 0);
    from_deck_free(&d);
    d = right_scene("&scene dimension=2, end_time=6 /\n" ROCK
                    "&body material='rock', low=0,0, high=7,7, spacing=.5 /\n&method name='sph' /\n");
    assert_string_equal(d.scene->method.variant, "total-lagrangian");
    from_deck_free(&d);
}

/* Four ways to say the same solid: lambda = 3, mu = 5, density = 2. By hand: E = mu (3 lambda + 2 mu) /
 * (lambda + mu) = 95/8, nu = 3/16, c_p = sqrt(13/2), c_s = sqrt(5/2), K = 19/3. */
static void pairs_of_constants_agree(void **unused)
{
    (void)unused;
    static const char *const pairs[] = {"lambda=3, mu=5", "young=11.875, poisson=.1875",
                                        "p_speed=2.549509756796392415, s_speed=1.581138830084189666",
                                        "bulk=6.3333333333333333333, shear=5"};
    for (size_t i = 0; i < 4; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "&scene dimension=3, end_time=6 /\n&material name='rock', density=2, %s /\n"
                 "&body material='rock', low=0,0,0, high=7,7,7, spacing=.5 /\n",
                 pairs[i]);
        struct from_deck d = right_scene(text);
        const struct material *m = d.scene->material;
        assert_near(m->lambda, 3, 1e-13);
        assert_near(m->mu, 5, 1e-13);
        assert_near(m->young, 11.875, 1e-13);
        assert_near(m->poisson, .1875, 1e-14);
        assert_near(m->plane_lambda, 3, 1e-13);
        assert_near(m->p_speed, sqrt(6.5), 1e-14);
        assert_near(m->s_speed, sqrt(2.5), 1e-14);
        from_deck_free(&d);
    }
}

/* Plane stress: c_p = c0 / sqrt(1 - nu^2) (numerics.md, B1); thin bar: c_p = c0 = sqrt(E / rho). */
static void planes(void **unused)
{
    (void)unused;
    const double c0 = sqrt(11.875 / 2);
    struct from_deck d = right_scene("&scene dimension=2, end_time=6, plane='stress' /\n" ROCK
                                     "&body material='rock', low=0,0, high=7,7, spacing=.5 /\n");
    assert_near(d.scene->material->p_speed, c0 / sqrt(1 - .1875 * .1875), 1e-14);
    assert_near(d.scene->material->lambda, 3, 1e-14);
    from_deck_free(&d);
    d = right_scene("&scene dimension=1, end_time=6, plane='stress' /\n" ROCK
                    "&body material='rock', low=0, high=7, spacing=.5 /\n");
    assert_near(d.scene->material->p_speed, c0, 1e-14);
    from_deck_free(&d);
    d = right_scene("&scene dimension=1, end_time=6, plane='strain' /\n" ROCK
                    "&body material='rock', low=0, high=7, spacing=.5 /\n");
    assert_near(d.scene->material->p_speed, sqrt(6.5), 1e-14);
    from_deck_free(&d);
}

/* R is orthonormal and right-handed, turns about x first and z last, and leaves the centre of the box. */
static void rotation(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene("&scene dimension=3, end_time=6 /\n" ROCK
                                     "&body material='rock', low=0,0,0, high=2,4,6, spacing=.5, "
                                     "rotation=20,-50,110 /\n");
    const struct body *body = &d.scene->body;
    double(*r)[3] = d.scene->body.frame;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            assert_near(r[0][i] * r[0][j] + r[1][i] * r[1][j] + r[2][i] * r[2][j], i == j, 1e-15);
    const double determinant = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) -
                               r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0]) +
                               r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    assert_near(determinant, 1, 1e-15);
    const double centre[3] = {1, 2, 3}, corner[3] = {2, 0, 6};
    double there[3], back[3];
    body_to_deck(body, centre, there);
    for (int c = 0; c < 3; c++)
        assert_near(there[c], centre[c], 1e-15);
    body_to_deck(body, corner, there);
    body_from_deck(body, there, back);
    for (int c = 0; c < 3; c++)
        assert_near(back[c], corner[c], 1e-14);
    assert_near(hypot(hypot(there[0] - 1, there[1] - 2), there[2] - 3), sqrt(14), 1e-14);
    from_deck_free(&d);
    /* 90 degrees about x takes y to z; then 90 about z leaves z and takes x to y: exactly */
    d = right_scene("&scene dimension=3, end_time=6 /\n" ROCK
                    "&body material='rock', low=0,0,0, high=2,4,6, spacing=.5, rotation=90,0,90 /\n");
    const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double turned[3][3] = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    for (int i = 0; i < 3; i++) {
        body_direction_to_deck(&d.scene->body, axes[i], there);
        body_direction_from_deck(&d.scene->body, there, back);
        for (int c = 0; c < 3; c++) {
            assert_near(there[c], turned[i][c], 0);
            assert_near(back[c], axes[i][c], 0);
        }
    }
    from_deck_free(&d);
}

static void faces(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene(
        BOX "&boundary face='z-', kind='free' /\n"
            "&boundary face='x-','x+','y-', kind='transmitting', normal_factor=1.2, shear_factor=.8 /\n"
            "&boundary face='z+', kind='transmitting', layer='pml', layer_points=8 /\n"
            "&boundary face='y+', kind='velocity', direction=0,3,4, amplitude=7, history='step' /\n");
    const struct boundary *b = d.scene->boundary;
    assert_true(b[FACE_Z_LOW].given && b[FACE_Z_LOW].kind == BOUNDARY_FREE);
    assert_int_equal(b[FACE_X_HIGH].absorber, ABSORBER_LYSMER);
    assert_near(b[FACE_Y_LOW].normal_factor, 1.2, 0);
    assert_near(b[FACE_Y_LOW].shear_factor, .8, 0);
    assert_int_equal(b[FACE_Z_HIGH].absorber, ABSORBER_PML);
    assert_int_equal(b[FACE_Z_HIGH].layer_points, 8);
    assert_int_equal(b[FACE_Y_HIGH].kind, BOUNDARY_VELOCITY);
    assert_int_equal(b[FACE_Y_HIGH].group, 3);
    assert_near(b[FACE_Y_HIGH].direction[1], .6, 1e-15);
    assert_near(b[FACE_Y_HIGH].direction[2], .8, 1e-15);
    assert_near(b[FACE_Y_HIGH].amplitude, 7, 0);
    from_deck_free(&d);
    d = right_scene(BOX "&boundary face='all', kind='fixed' /\n");
    for (int face = 0; face < BOX_FACES; face++)
        assert_int_equal(d.scene->boundary[face].kind, BOUNDARY_FIXED);
    assert_false(d.scene->boundary[FACE_HOLE].given);
    from_deck_free(&d);
    d = right_scene("&scene dimension=2, end_time=6 /\n" ROCK
                    "&body material='rock', low=0,0, high=7,7, spacing=.5 /\n"
                    "&boundary face='all', kind='symmetry' /\n");
    assert_int_equal(d.scene->boundary[FACE_Y_HIGH].kind, BOUNDARY_SYMMETRY);
    assert_false(d.scene->boundary[FACE_Z_LOW].given);
    from_deck_free(&d);
}

/* One table for two faces: each has its own rows (freeing twice would show under valgrind). */
static void tables_of_faces(void **unused)
{
    (void)unused;
    char path[] = "/tmp/selas-test-XXXXXX", text[1024];
    const int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, "0 0\n1 2\n2 0\n", 12), 12);
    close(file);
    snprintf(text, sizeof text,
             BOX "&boundary face='x-','x+', kind='displacement', direction=1,0,0, history='table', file='%s' "
                 "/\n",
             path);
    struct from_deck d = right_scene(text);
    assert_int_equal(d.scene->boundary[FACE_X_LOW].history.rows, 3);
    assert_int_equal(d.scene->boundary[FACE_X_HIGH].history.rows, 3);
    assert_ptr_not_equal(d.scene->boundary[FACE_X_LOW].history.table_time,
                         d.scene->boundary[FACE_X_HIGH].history.table_time);
    assert_near(history_value(&d.scene->boundary[FACE_X_HIGH].history, .5, 0), 1, 1e-15);
    from_deck_free(&d);
    unlink(path);
}

static void loads(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene(
        BOX "&load face='z-', shape='square', centre=3.5,3,1d-8, size=1,2, direction=0,0,2, amplitude=3, "
            "history='triangle', duration=2, smoothing=1 /\n"
            "&load face='x+', shape='disc', centre=7,0,0, size=1, direction=3,4,0, history='gaussian', "
            "delay=2, width=.3 /\n"
            "&load kind='body-force', direction=0,0,-1, amplitude=9.81, history='step' /\n"
            "&load kind='moment-tensor', centre=3,3,3, moment=1,2,3,4,5,6, history='ricker', frequency=2, "
            "delay=1 /\n"
            "&load face='y-', shape='face', direction=0,1,0, history='sine-burst', frequency=2 /\n"
            "&load face='z-', shape='point', centre=0,0,0, direction=0,0,1, velocity=2,0,0, history='step' "
            "/\n");
    const struct load *l = d.scene->load;
    assert_int_equal(d.scene->loads, 6);
    assert_near(l[0].centre[2], 0, 0); /* put on the face exactly */
    assert_near(l[0].size[1], 2, 0);
    assert_near(l[0].direction[2], 1, 0);
    assert_near(l[0].history.duration, 2, 0);
    assert_near(l[0].history.smoothing, 1, 0);
    assert_int_equal(l[1].shape, LOAD_DISC);
    assert_int_equal(l[1].face, FACE_X_HIGH);
    assert_near(l[1].direction[0], .6, 1e-15);
    assert_near(l[1].history.width, .3, 0);
    assert_near(l[1].amplitude, 1, 0);
    assert_int_equal(l[2].kind, LOAD_BODY_FORCE);
    assert_int_equal(l[2].shape, LOAD_FACE);
    assert_int_equal(l[3].kind, LOAD_MOMENT_TENSOR);
    assert_near(l[3].moment[5], 6, 0);
    assert_near(l[4].history.cycles, 5, 0);
    assert_int_equal(l[5].shape, LOAD_POINT);
    assert_near(l[5].velocity[0], 2, 0);
    from_deck_free(&d);
}

/* A mechanism is the double couple of its fault's normal and slip (Aki & Richards 2002, Eqs 4.88 and 4.89); right angles are
 * exact. */
static void mechanisms(void **unused)
{
    (void)unused;
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    const double strike = 130 * M_PI / 180, dip = 35 * M_PI / 180, rake = -60 * M_PI / 180;
    const double normal[3] = {-sin(dip) * sin(strike), sin(dip) * cos(strike), -cos(dip)};
    const double slip[3] = {cos(rake) * cos(strike) + cos(dip) * sin(rake) * sin(strike),
                            cos(rake) * sin(strike) - cos(dip) * sin(rake) * cos(strike),
                            -sin(rake) * sin(dip)};
    struct from_deck d = right_scene(
        BOX "&load kind='moment-tensor', centre=3,3,3, mechanism=130,35,-60, history='step' /\n"
            "&load kind='moment-tensor', centre=3,3,3, mechanism=0,90,0, amplitude=2, history='step' /\n"
            "&load kind='moment-tensor', centre=3,3,3, mechanism=90,45,90, history='step' /\n");
    const struct load *l = d.scene->load;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            assert_near(l[0].moment[place[i][j]], normal[i] * slip[j] + normal[j] * slip[i], 1e-15);
    for (int n = 0; n < 6; n++) {
        assert_true(l[1].moment[n] == (n == 3 ? 1 : 0));
        assert_true(l[2].moment[n] == (n == 0 ? -1 : n == 2 ? 1 : 0));
    }
    from_deck_free(&d);
}

/* A turned body: the centre of the load is given in the deck's coordinates. */
static void load_on_a_turned_face(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene(
        "&scene dimension=3, end_time=6 /\n" ROCK
        "&body material='rock', low=-1,-1,-1, high=1,1,1, spacing=.5, rotation=0,90,0 /\n"
        "&load face='x+', shape='square', centre=0,0,-1, size=1,1, direction=0,0,1, history='step' /\n"
        "&receiver name='a', position=0,0,-1 /\n");
    assert_near(d.scene->load[0].centre[2], -1, 1e-15);
    from_deck_free(&d);
}

static void receivers_and_outputs(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene(
        BOX "&receiver name='a-1.5', position=0,7,7.0000000001 /\n&receiver name='b', position=1,2,3 /\n"
            "&profile name='line', from=0,0,0, to=7,0,0, points=11, times=3,1, fields='stress','velocity' /\n"
            "&profile name='last', from=0,0,0, to=7,0,0 /\n"
            "&snapshot every=.5, fields='displacement' /\n"
            "&snapshot times=6,2, region=0,0,0,7,7,1 /\n"
            "&output directory='here', plots=F, history_step=.1, low_pass=9, checkpoint_every=7 /\n"
            "&stepping scheme='rkc', courant=.5, stages=7, unwarp=F /\n&reference kind='lamb' /\n");
    const struct scene *s = d.scene;
    assert_int_equal(s->receivers, 2);
    assert_string_equal(s->receiver[0].name, "a-1.5");
    assert_near(s->receiver[1].position[2], 3, 0);
    assert_int_equal(s->profile[0].times, 2);
    assert_near(s->profile[0].time[0], 1, 0); /* ascending */
    assert_int_equal(s->profile[0].fields, 1U << SELAS_STRESS | 1U << SELAS_VELOCITY);
    assert_int_equal(s->profile[0].points, 11);
    assert_int_equal(s->profile[1].times, 1);
    assert_near(s->profile[1].time[0], 6, 0); /* the end */
    assert_near(s->snapshot[0].every, .5, 0);
    assert_true(s->snapshot[0].whole);
    assert_int_equal(s->snapshot[0].fields, 1U << SELAS_DISPLACEMENT);
    assert_near(s->snapshot[1].every, 0, 0);
    assert_near(s->snapshot[1].time[1], 6, 0);
    assert_false(s->snapshot[1].whole);
    assert_near(s->snapshot[1].region_high[2], 1, 0);
    assert_string_equal(s->output.directory, "here");
    assert_false(s->output.plots);
    assert_near(s->output.low_pass, 9, 0);
    assert_int_equal(s->output.checkpoint_every, 7);
    assert_string_equal(s->stepping.scheme, "rkc");
    assert_near(s->stepping.courant, .5, 0);
    assert_near(s->stepping.safety, 0, 0);
    assert_int_equal(s->stepping.stages, 7);
    assert_true(s->stepping.unwarp_given && !s->stepping.unwarp);
    assert_string_equal(s->reference.kind, "lamb");
    from_deck_free(&d);
}

static void layers(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene(
        "&scene dimension=3, end_time=6 /\n" ROCK "&material name='mud', density=1, lambda=1, mu=1 /\n"
        "&material name='sand', density=1, lambda=1, mu=1 /\n"
        "&body name='g', low=0,0,0, high=7,7,7, spacing=.5 /\n"
        "&layer material='rock', top=3.5 /\n&layer body='g', material='mud', top=0 /\n"
        "&layer body='g', material='sand', top=1 /\n");
    assert_int_equal(d.scene->body.layers, 3);
    assert_string_equal(scene_material_at(d.scene, 0)->name, "mud");
    assert_string_equal(scene_material_at(d.scene, .999)->name, "mud");
    assert_string_equal(scene_material_at(d.scene, 1)->name, "sand");
    assert_string_equal(scene_material_at(d.scene, 7)->name, "rock");
    from_deck_free(&d);
    d = right_scene(BOX);
    assert_string_equal(scene_material_at(d.scene, 3)->name, "rock");
    from_deck_free(&d);
}

/* The choices of the deck stand in the order of the enums of scene.h and selas.h. */
static void choices_are_the_enums(void **unused)
{
    (void)unused;
    static const char *const kinds[] = {"free", "fixed", "roller", "symmetry", "transmitting"};
    static const char *const fields[] = {"displacement", "velocity", "acceleration", "stress",
                                         "strain",       "pressure", "energy"};
    char text[1024];
    for (int i = 0; i < 5; i++) {
        snprintf(text, sizeof text, BOX "&boundary face='y+', kind='%s' /\n", kinds[i]);
        struct from_deck d = right_scene(text);
        assert_int_equal(d.scene->boundary[FACE_Y_HIGH].kind, BOUNDARY_FREE + i);
        from_deck_free(&d);
    }
    for (int i = 0; i < 7; i++) {
        snprintf(text, sizeof text, BOX "&snapshot every=1, fields='%s' /\n", fields[i]);
        struct from_deck d = right_scene(text);
        assert_int_equal(d.scene->snapshot[0].fields, 1U << (SELAS_DISPLACEMENT + i));
        from_deck_free(&d);
    }
    static const char *const shapes[] = {"lattice", "radial", "equally-radial", "conformal"};
    for (int i = 0; i < 4; i++) {
        snprintf(text, sizeof text,
                 "&scene dimension=2, end_time=6 /\n" ROCK
                 "&body material='rock', shape='plate-with-hole', low=0,0, high=1,1, spacing=.1, "
                 "hole_centre=0,0, hole_radius=.3, arrangement='%s' /\n",
                 shapes[i]);
        struct from_deck d = right_scene(text);
        assert_int_equal(d.scene->body.arrangement, ARRANGEMENT_LATTICE + i);
        assert_int_equal(d.scene->body.shape, BODY_PLATE_WITH_HOLE);
        from_deck_free(&d);
    }
    for (int face = 0; face < BOX_FACES; face++) {
        snprintf(text, sizeof text, BOX "&boundary face='%s', kind='fixed' /\n", face_name((enum face)face));
        struct from_deck d = right_scene(text);
        for (int other = 0; other < BOX_FACES; other++)
            assert_int_equal(d.scene->boundary[other].kind, other == face ? BOUNDARY_FIXED : BOUNDARY_FREE);
        from_deck_free(&d);
    }
}

/* Warnings do not stop a scene: SPH fits its spacing, loads on held faces, cut pulses. */
static void warnings(void **unused)
{
    (void)unused;
    static const struct {
        const char *deck, *word;
    } cases[] = {
        {"&scene dimension=1, end_time=6 /\n" ROCK "&body material='rock', low=0, high=.5, spacing=.0033 /\n"
         "&method name='sph' /\n",
         "t.nml:3:40: warning: spacing = 0.0033 does not divide"},
        {BOX "&boundary face='z-', kind='fixed' /\n&load face='z-', shape='face', direction=0,0,1, "
             "history='step' /\n",
         "t.nml:5:7: warning: the load acts on the face 'z-', whose motion &boundary 1 prescribes"},
        {BOX "&load face='z-', shape='face', direction=0,0,1, history='gaussian', delay=.1, width=.3 /\n",
         "warning: the time function is cut at t = 0"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct from_deck d = right_scene(cases[i].deck);
        assert_int_equal(d.messages.errors, 0);
        assert_int_equal(d.messages.warnings, 1);
        if (strstr(d.messages.text, cases[i].word) == NULL) {
            print_error("expected \"%s\" in %s", cases[i].word, d.messages.text);
            assert_true(false);
        }
        from_deck_free(&d);
    }
}

/* From an override to the scene; a wrong one is named as such. */
static void overrides_reach_the_scene(void **unused)
{
    (void)unused;
    const char *text = BOX "&receiver name='a', position=1,1,1 /\n&receiver name='b', position=1,1,1 /\n";
    static const char *const right[] = {
        "body%spacing=.25",    "material%lambda=1",       "receiver(2)%position=0,3,7",
        "stepping%courant=.3", "initial%kind='gaussian'", "initial%centre=1,2,3",
        "initial%width=.5",    "initial%amplitude=2",     "initial%direction=0,0,5"};
    struct from_deck d = from_text(text, sizeof right / sizeof right[0], right);
    assert_int_equal(d.status, SELAS_OK);
    assert_near(d.scene->body.spacing, .25, 0);
    assert_near(d.scene->material->lambda, 1, 0);
    assert_near(d.scene->receiver[1].position[2], 7, 0);
    assert_near(d.scene->stepping.courant, .3, 0);
    assert_int_equal(d.scene->initial.kind, INITIAL_GAUSSIAN);
    assert_near(d.scene->initial.direction[2], 1, 0);
    from_deck_free(&d);
    static const char *const wrong[] = {"body%spacing=.3"};
    d = from_text(text, 1, wrong);
    assert_int_equal(d.status, SELAS_BAD_DECK);
    assert_non_null(strstr(d.messages.text, "override: error: spacing = 0.3 does not divide the edge of 7"));
    from_deck_free(&d);
}

static void names_of_units(void **unused)
{
    (void)unused;
    char text[UNIT_TEXT];
    struct from_deck d = right_scene(BOX "&output length_unit='km', time_unit='s' /\n");
    const struct output_choice *output = &d.scene->output;
    assert_string_equal(unit_text(output, 1, 0, "", text), " (km)");
    assert_string_equal(unit_text(output, 0, 1, "", text), " (s)");
    assert_string_equal(unit_text(output, 0, -1, "", text), " (1/s)");
    assert_string_equal(unit_text(output, 1, -1, "", text), " (km/s)");
    assert_string_equal(unit_text(output, 1, -2, "", text), " (km/s^2)");
    assert_string_equal(units_told(output, text), "lengths in km, times in s");
    from_deck_free(&d);
    d = right_scene(BOX "&output time_unit='ms' /\n");
    assert_string_equal(unit_text(&d.scene->output, 1, -1, UNITS_OF_DECK, text), UNITS_OF_DECK);
    assert_string_equal(unit_text(&d.scene->output, 0, 1, UNITS_OF_DECK, text), " (ms)");
    assert_string_equal(units_told(&d.scene->output, text), "times in ms");
    from_deck_free(&d);
    d = right_scene(BOX);
    assert_string_equal(units_told(&d.scene->output, text), "the deck's own");
    from_deck_free(&d);
    static const char *const wrong[] = {"length_unit=\"m'\"", "length_unit=''", "time_unit='{s}'",
                                        "time_unit='microseconds of the clock'"};
    for (size_t i = 0; i < 4; i++) {
        char deck[512];
        snprintf(deck, sizeof deck, BOX "&output %s /\n", wrong[i]);
        d = from_text(deck, 0, NULL);
        assert_int_equal(d.status, SELAS_BAD_DECK);
        assert_non_null(strstr(d.messages.text, "is no name of a unit"));
        from_deck_free(&d);
    }
}

/* The decks of input/ are right, and so are their echoes, which have every default written out. */
static void decks_and_their_echoes(void **unused)
{
    (void)unused;
    glob_t found;
    assert_int_equal(glob("input/*.nml", 0, NULL, &found), 0);
    for (size_t i = 0; i < found.gl_pathc; i++) {
        struct from_deck d = {0}, echo = {0};
        char *text = NULL;
        size_t length = 0;
        FILE *file = open_memstream(&text, &length);
        assert_non_null(file);
        d.status = deck_read_file(found.gl_pathv[i], 0, NULL, &d.deck, &d.messages);
        if (d.status == SELAS_OK) d.status = accuracy_build(d.deck, NULL, &d.scene, &d.messages);
        if (d.scene == NULL) print_error("%s", d.messages.text);
        assert_non_null(d.scene);
        assert_int_equal(deck_write(d.deck, file, &d.messages), SELAS_OK);
        assert_int_equal(fclose(file), 0);
        echo = right_scene(text);
        assert_int_equal(echo.scene->loads, d.scene->loads);
        assert_int_equal(echo.scene->receivers, d.scene->receivers);
        assert_memory_equal(echo.scene->material, d.scene->material,
                            d.scene->materials * sizeof *d.scene->material);
        assert_memory_equal(&echo.scene->initial, &d.scene->initial, sizeof d.scene->initial);
        for (int face = 0; face < FACES; face++)
            assert_int_equal(echo.scene->boundary[face].kind, d.scene->boundary[face].kind);
        from_deck_free(&d);
        from_deck_free(&echo);
        free(text);
    }
    assert_true(found.gl_pathc >= 4);
    globfree(&found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults),
        cmocka_unit_test(pairs_of_constants_agree),
        cmocka_unit_test(planes),
        cmocka_unit_test(rotation),
        cmocka_unit_test(faces),
        cmocka_unit_test(tables_of_faces),
        cmocka_unit_test(loads),
        cmocka_unit_test(mechanisms),
        cmocka_unit_test(load_on_a_turned_face),
        cmocka_unit_test(receivers_and_outputs),
        cmocka_unit_test(layers),
        cmocka_unit_test(choices_are_the_enums),
        cmocka_unit_test(warnings),
        cmocka_unit_test(overrides_reach_the_scene),
        cmocka_unit_test(names_of_units),
        cmocka_unit_test(decks_and_their_echoes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
