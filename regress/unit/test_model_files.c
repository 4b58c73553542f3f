/* Models of the ground in each format that is read, and wrong files (doc/reference/models.md). */
#include "damping/ground.h"
#include "from_deck.h"
#include "model_writers.h"
#include "scene/topography.h"

#include "scene/ground.h"

#include <sys/stat.h>
#include <unistd.h>

static const char stored[] = "build/test/model";

#define DECK(body, words)                                                                                    \
    "&scene dimension = 3, end_time = 1 /\n"                                                                 \
    "&body low = 0, 0, 0, high = " body ", spacing = 10 /\n"                                                 \
    "&load face = 'z-', shape = 'square', centre = 10, 10, depth = 0, size = 20, 20, direction = 0, 0, 1, "  \
    "history = 'triangle', duration = 1 /\n"                                                                 \
    "&model file = 'build/test/model' " words " /\n"

/* The rock at a place of the body is that of a place in the model. */
static void assert_field(const struct scene *scene, const double body[3], double x, double y, double z,
                         double tolerance)
{
    double value[5];
    field(x, y, z, value);
    const struct rock rock = ground_at(scene, body);
    if (scene->body.model->damped) { /* Q stands where a part of damped ground has its shares */
        const struct shares quality = ground_model_shares(scene->body.model, body);
        assert_near(quality.bulk / value[3], 1, tolerance);
        assert_near(quality.shear / value[4], 1, tolerance);
    }
    assert_near(rock.density / value[0], 1, tolerance);
    assert_near(sqrt(rock.mu / rock.density) / value[2], 1, tolerance);
    assert_near(sqrt((rock.lambda + 2 * rock.mu) / rock.density) / value[1], 1, tolerance);
}

static void assert_text(const struct from_deck *made, const char *plan, const char *warning)
{
    if (plan != NULL && strstr(made->scene->body.model->text, plan) == NULL)
        fail_msg("'%s' is not in: %s", plan, made->scene->body.model->text);
    const char *text = made->messages.text != NULL ? made->messages.text : "";
    if (warning != NULL && strstr(text, warning) == NULL) fail_msg("'%s' is not in: %s", warning, text);
    if (warning == NULL) assert_int_equal(made->messages.warnings, 0);
}

/* Depths below the ground; x of the body towards 120 degrees, 90 from the model's. */
static void test_rfile(void **state)
{
    (void)state;
    for (int form = 0; form < 4; form++) {
        write_rfile(stored, form % 2, form / 2, 0);
        struct from_deck made = right_scene(DECK("800, 700, 900", "origin = 900, 50, azimuth = 120"));
        const double tolerance = form / 2 ? 1e-6 : 1e-12;
        static const double place[][3] = {{0, 0, 0}, {800, 700, 900}, {123, 456, 78}, {600, 100, 640}};
        for (int i = 0; i < 4; i++) {
            const double x = 900 - place[i][1], y = 50 + place[i][0];
            assert_field(made.scene, place[i], x, y, place[i][2] - ground_of(x, y), tolerance);
        }
        assert_field(made.scene, (double[]){-100, 3000, 100}, 200, 50, 100 - ground_of(200, 50), tolerance);
        assert_text(&made, "depth 0 is its ground", NULL);
        assert_true(made.scene->body.model->damped);
        from_deck_free(&made);
    }
    write_rfile(stored, 0, 0, 1);
    struct from_deck made = right_scene(DECK("800, 700, 900", ""));
    assert_text(&made, "values of air or water are those of the rock below", NULL);
    assert_field(made.scene, (double[]){100, 200, 300}, 100, 200, 300 - ground_of(100, 200), 1e-12);
    assert_field(made.scene, (double[]){0, 0, 0}, 0, 0, -100, 1e-12);      /* a value at the ground itself */
    assert_field(made.scene, (double[]){500, 0, 10}, 500, 0, -100, 1e-12); /* the first rock is at -100 */
    from_deck_free(&made);
}

static void test_sfile(void **state)
{
    (void)state;
    write_sfile(stored, 0);
    struct from_deck made = right_scene(DECK("800, 700, 900", "origin = 100, 200"));
    static const double place[][3] = {
        {0, 0, 0}, {800, 700, 900}, {123, 456, 78}, {600, 100, 640}, {0, 0, 300}};
    for (int i = 0; i < 5; i++) {
        const double x = 100 + place[i][0], y = 200 + place[i][1], top = -ground_of(x, y);
        assert_field(made.scene, place[i], x, y, top + place[i][2] * (1200 - top) / 1200, 1e-12);
    }
    assert_text(&made, "depths are stretched above its bottom", NULL);
    assert_true(made.scene->body.model->grid[0].n[0] == 5);
    from_deck_free(&made);
    made = right_scene(DECK("200, 200, 100", "origin = 510, 10"));
    assert_true(made.scene->body.model->grid[0].n[0] == 2 && made.scene->body.model->grid[0].n[1] == 2);
    from_deck_free(&made);
    write_sfile(stored, 0); /* grid_1 reaches farther: its values lie at its own step */
    put_other(stored, "Material_model/grid_1", "Horizontal grid size", 600);
    made = right_scene(DECK("800, 700, 900", "origin = 100, 200, depth = 'sea'"));
    for (int i = 0; i < 3; i++) {
        const double x = 100 + place[i][0], y = 200 + place[i][1], z = 800, top = sfile_surface(1, x, y);
        const double part = (z - top) / (1200 - top), from = sfile_surface(1, x / 1.2, 0);
        assert_field(made.scene, (double[]){place[i][0], place[i][1], z}, x / 1.2, y / 1.2,
                     (1 - part) * from + part * 1200, 1e-12);
    }
    from_deck_free(&made);
    put_other(stored, "Material_model/grid_1", "Horizontal grid size", 250);
    assert_refused(DECK("800, 700, 900", ""),
                   "t.nml:4:", (const char *[]){"grid_1 reaches to 500 along x", "grid_0 to 1000", NULL});
    write_sfile(stored, 800);
    assert_refused(DECK("800, 700, 900", ""),
                   "t.nml:4:", (const char *[]){"surface 1, at depth", "lies above surface 0", NULL});
}

/* With and without a sea floor; the body in the model's map, its x towards 90 degrees, 30 right of y. */
static void test_blocks(void **state)
{
    (void)state;
    static const double place[][3] = {
        {0, 0, 0}, {800, 300, 900}, {523, 56, 78}, {600, 100, 640}, {10, 10, 500}};
    for (int floor = 0; floor < 2; floor++) {
        write_blocks(stored, floor, "m/s", 0);
        struct from_deck made = right_scene(DECK("800, 300, 900", "origin = 500700, 4000250, azimuth = 90"));
        for (int i = 0; i < 5; i++) {
            const double east = 700 + place[i][0], north = 250 - place[i][1];
            const double x = east / 2 - north * sqrt(3) / 2, y = east * sqrt(3) / 2 + north / 2;
            const double ground = ground_of(x, y), top = water_of(x, y), depth = place[i][2];
            const double elevation = ground - depth * (1500 + ground) / 1500; /* squashed, min = -dim_z */
            assert_field(made.scene, place[i], x, y, floor ? 1500 * (top - elevation) / (top + 1500) : depth,
                         1e-12);
        }
        assert_text(&made, floor ? "solid ground" : "its top", NULL);
        assert_true(made.scene->body.model->damped);
        from_deck_free(&made);
    }
    write_blocks(stored, 0, "m/s", -1e20);
    struct from_deck made = right_scene(DECK("800, 300, 900", ""));
    const struct rock top = ground_at(made.scene, (double[]){400, 200, 10}),
                      rock = ground_at(made.scene, (double[]){400, 200, 50});
    assert_near(top.mu / top.density, rock.mu / rock.density, 1e-9 * top.mu / top.density);
    assert_text(&made, "6 values of air or water", NULL); /* the top of 3 x 2 columns */
    from_deck_free(&made);
    write_blocks(stored, 0, "ft/s", 0);
    assert_refused(DECK("800, 300, 900", ""), "t.nml:4:", (const char *[]){"Vp is in 'ft/s'", NULL});
    write_blocks(stored, 0, "km/s", 0);
    assert_refused(DECK("800, 300, 900", ""),
                   "t.nml:4:", (const char *[]){"p_speed 4e+06", "is no rock in m/s; are its units", NULL});
    write_blocks(stored, 0, "m/s", 1e20);
    assert_refused(DECK("800, 300, 900", "damped = .false."),
                   "t.nml:4:", (const char *[]){"s_speed 1e+20, is air, water or no data", NULL});
}

/* A crs in metres is right, in feet refused: by PROJ and by WKT. */
static void test_blocks_crs(void **state)
{
    (void)state;
    static const char *const crs[] = {"+proj=utm +zone=10 +units=m +no_defs", "EPSG:26910",
                                      "+proj=lcc +lat_1=37 +units=us-ft +no_defs",
                                      "PROJCS[\"x\",UNIT[\"US survey foot\",0.3048006096012192]]"};
    for (int k = 0; k < 4; k++) {
        write_blocks(stored, 0, "m/s", 0);
        const hid_t file = H5Fopen(stored, H5F_ACC_RDWR, H5P_DEFAULT);
        put_words(file, "crs", 1, &crs[k], 1);
        H5Fclose(file);
        if (k >= 2)
            assert_refused(DECK("800, 300, 900", ""),
                           "t.nml:4:", (const char *[]){"its crs has lengths in other units", crs[k], NULL});
        struct from_deck made = {0};
        if (k < 2) made = right_scene(DECK("800, 300, 900", ""));
        if (k < 2) from_deck_free(&made);
    }
}

/* A sea floor without a top, which is then at the sea; one above the top; blocks that end before the bottom. */
static void test_blocks_alone(void **state)
{
    (void)state;
    static const double place[][3] = {{0, 0, 0}, {800, 300, 900}, {523, 56, 78}};
    write_blocks(stored, 2, "m/s", 0);
    struct from_deck made = right_scene(DECK("800, 300, 900", ""));
    for (int i = 0; i < 3; i++) {
        const double x = place[i][1], y = place[i][0], ground = 400 - ground_of(x, y);
        assert_field(made.scene, place[i], x, y, ground + place[i][2] * (1500 - ground) / 1500, 1e-12);
    }
    assert_text(&made, "solid ground", NULL);
    from_deck_free(&made);
    write_blocks(stored, 3, "m/s", 0);
    assert_refused(
        DECK("800, 300, 900", ""), "t.nml:4:",
        (const char *[]){"topography_bathymetry has elevation 100 at (0, 0), above its top, 0 without a",
                         NULL});
    write_blocks(stored, 0, "m/s", 0);
    put_other(stored, NULL, "dim_z", 1600);
    assert_refused(DECK("800, 300, 1550", ""), "t.nml:4:", (const char *[]){"from 0 to 1500 along z", NULL});
    write_blocks(stored, 0, "m/s", 0);
    assert_refused(DECK("200, 300, 900", "origin = 499990, 4000000"),
                   "t.nml:4:", (const char *[]){"to 1000 along x", NULL});
    turn_places(stored);
    assert_refused(DECK("800, 300, 900", ""),
                   "t.nml:4:", (const char *[]){"along x coincide or go back", NULL});
}

/* Depths below an elevation of 20, whatever the ground; above the face is what lies at it. */
static void test_sea(void **state)
{
    (void)state;
    static const double place[][3] = {{0, 0, 0}, {600, 300, 900}, {523, 56, 78}, {600, 100, 0}};
    for (int form = 0; form < 3; form++) {
        if (form == 0) write_rfile(stored, 0, 0, 0);
        if (form == 1) write_sfile(stored, 0);
        if (form == 2) write_blocks(stored, 1, "m/s", 0);
        struct from_deck made =
            right_scene(form < 2 ? DECK("600, 300, 900", "depth = 'sea', origin = 300, 50, 20")
                                 : DECK("600, 300, 900", "depth = 'sea'"));
        for (int i = 0; i < 4; i++) {
            const double z = place[i][2] - (form < 2 ? 20 : 0);
            if (form < 2) assert_field(made.scene, place[i], 300 + place[i][0], 50 + place[i][1], z, 1e-12);
            const double x = place[i][1], y = place[i][0], top = water_of(x, y);
            if (form == 2) assert_field(made.scene, place[i], x, y, 1500 * (top + z) / (top + 1500), 1e-12);
        }
        assert_near(ground_at(made.scene, (double[]){600, 100, -70}).mu / ground_at(made.scene, place[3]).mu,
                    1, 1e-12);
        assert_text(&made, form < 2 ? "depth 0 is its elevation 20" : "depth 0 is its elevation 0", NULL);
        from_deck_free(&made);
    }
    write_rfile(stored, 0, 0, 0);
#define HILL " /\n&topography shape = 'gaussian', height = 30, centre = 300, 150, width = 40"
    struct from_deck hill = right_scene(DECK("600, 300, 900", "depth = 'sea', origin = 0, 0, 20" HILL));
    assert_field(hill.scene, (double[]){300, 150, -25}, 300, 150, -45, 1e-12);
    from_deck_free(&hill);
    hill = right_scene(DECK("600, 300, 900", "origin = 0, 0, 20" HILL)); /* the same */
    assert_field(hill.scene, (double[]){300, 150, -25}, 300, 150, -45, 1e-12);
    from_deck_free(&hill);
    write_text(stored, 0, 0, "", 60);
    hill = right_scene(DECK("700, 800, 300", HILL));
    assert_field(hill.scene, (double[]){300, 150, -25}, 150, 300, -25, 1e-12);
    assert_text(&hill, NULL, NULL);
    from_deck_free(&hill);
    write_plain(stored, 0);
    hill = right_scene(DECK("600, 300, 300", "origin = 0, 0, 100" HILL));
    assert_field(hill.scene, (double[]){300, 150, -25}, 300, 150, 75, 1e-12);
    assert_text(&hill, NULL, NULL);
    from_deck_free(&hill);
    hill = right_scene(DECK("600, 300, 300", "origin = 0, 0, 0" HILL));
    assert_text(&hill, NULL,
                "begins 0 below face z-; above that, up to 30 above the face, its topmost rock goes on");
    from_deck_free(&hill);
    write_text(stored, 0, 0, "", 60);
    struct from_deck made = right_scene(DECK("700, 800, 300", "depth = 'sea', origin = 1000, 2000, -100"));
    assert_field(made.scene, (double[]){100, 50, 30}, 50, 100, 130, 1e-12);
    from_deck_free(&made);
}

/* The model's own ground as surface of the body: heights above the elevation of face z-, rock at true places. */
static void test_own_surface(void **state)
{
    (void)state;
#define OWN " /\n&topography shape = 'model'"
    for (int form = 0; form < 3; form++) {
        if (form == 0) write_rfile(stored, 0, 0, 0);
        if (form == 1) write_sfile(stored, 0);
        if (form == 2) write_blocks(stored, 1, "m/s", 0);
        struct from_deck made = right_scene(form < 2 ? DECK("600, 300, 900", "origin = 300, 50, 90" OWN)
                                                     : DECK("600, 300, 900", "" OWN));
        const struct scene *scene = made.scene;
        const double e = form < 2 ? 90 : 0;
        for (int i = 0; i < 4; i++) {
            const double place[3] = {i * 200, i * 100, -5};
            const double x = form < 2 ? 300 + place[0] : place[1], y = form < 2 ? 50 + place[1] : place[0];
            const double depth = -5 - e, top = water_of(x, y);
            assert_near(topography_drop(scene->body.topography, place), e - ground_of(x, y), 1e-3);
            if (form < 2) assert_field(scene, place, x, y, depth, 1e-6);
            if (form == 2) assert_field(scene, place, x, y, 1500 * (top + depth) / (top + 1500), 1e-6);
        }
        assert_non_null(strstr(scene->body.topography->text[2], "from the model's heights"));
        from_deck_free(&made);
    }
    write_blocks(stored, 0, "m/s", 0);
    put_ridges(stored, 3, 2.5); /* a spacing from one to the next */
    struct from_deck made = right_scene(DECK("600, 300, 900", "" OWN));
    for (int i = 1; i < 6; i++)
        assert_near(topography_drop(made.scene->body.topography, (double[]){i * 100, 150, 0}), 0, .1);
    assert_near(made.scene->body.model->detail[0], 2.5, 1e-9);
    from_deck_free(&made);
    write_text(stored, 0, 0, "", 60);
    assert_refused(DECK("600, 300, 900", OWN),
                   "t.nml:", (const char *[]){"expected a &model with a surface of its own", NULL});
    write_rfile(stored, 0, 0, 0);
    assert_refused(DECK("600, 300, 900", OWN ", datum = 3"), "t.nml:", (const char *[]){"datum", NULL});
}

static void test_text(void **state)
{
    (void)state;
    write_text(stored, 0, 0, "", 60);
    struct from_deck made = right_scene(DECK("700, 800, 300", "origin = 1100, 2850, -100, azimuth = 90"));
    static const double place[][3] = {{0, 0, 0}, {700, 800, 300}, {333, 222, 111}};
    for (int i = 0; i < 3; i++)
        assert_field(made.scene, place[i], 100 + place[i][0], 850 - place[i][1], 100 + place[i][2], 1e-12);
    assert_text(&made, "depth 0 is its elevation -100", NULL);
    assert_int_equal(made.scene->body.model->grid[0].n[2], 3); /* of 5 */
    from_deck_free(&made);
    write_text(stored, 1, 0, "", 60);
    made = right_scene(DECK("700, 800, 600", "")); /* x towards north: the file's y */
    assert_field(made.scene, (double[]){600, 700, 500}, 700, 600, 500, 1e-12);
    from_deck_free(&made);
    write_text(stored, 0, 12, "2000 2900 -700 99000 2000 2000 # too fast\n", 60);
    made = right_scene(DECK("700, 800, 600", ""));
    assert_text(&made, NULL, "1 numbers lie beyond the bounds");
    from_deck_free(&made);
}

#define TEXT DECK("700, 800, 600", "")

static void test_wrong_text(void **state)
{
    (void)state;
    static const struct {
        int line;
        const char *text;
        int lines;
        const char *words[4];
    } wrong[] = {
        {0, "", 59, {"ends after 59 of 3 x 4 x 5 values", "line 66", NULL}},
        {5, "1500 2300 -700 nan 2000 2000\n", 60, {"line 11", "'nan", "numbers", NULL}},
        {5, "1500 2300 -700 -4000 2000 2000\n", 60, {"line 11", "p_speed -4000", NULL}},
        {5,
         "1500 2310 -700 4000 2000 2000\n",
         60,
         {"line 11", "value 5 lies at y = 2310; expected 2300", NULL}},
        {5, "1500 2300 -700 4000 2000\n", 60, {"line 11", "5 numbers", NULL}},
        {5, "1500 2300 -700 4000 0 2000\n", 60, {"line 11", "s_speed 0", NULL}},
        {5, "1500 2300 -700 2200 2100 2000\n", 60, {"(1500, 2300, 700)", "bulk modulus is negative", NULL}},
        {60, "2000 2900 100 4000 2000 2000\n1 1 1 4000 2000 2000\n", 60, {"more than 3 x 4 x 5", NULL}},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        write_text(stored, 0, wrong[i].line, wrong[i].text, wrong[i].lines);
        assert_refused(TEXT, "t.nml:4:", wrong[i].words);
    }
    write_text(stored, 0, 0, "", 60);
    assert_refused(DECK("700, 1010, 600", ""),
                   "t.nml:4:", (const char *[]){"1000 to 2000 along x", "1000 to 2010", NULL});
    assert_refused(DECK("700, 800, 800", ""),
                   "t.nml:4:", (const char *[]){"-100 to 700 along z", "0 to 800", NULL});
    FILE *file = fopen(stored, "w");
    fputs("0 0 0 10 10 10\n10 10 10\n2 2 2\n1 9 1 9 1 9\n0 0 0 6 3 2.7\n10 0 0 6 3 2.7\n0 10 0 6 3 2.7\n"
          "10 10 0 6 3 2.7\n0 0 10 6 3 2.7\n10 0 10 6 3 2.7\n0 10 10 6 3 2.7\n10 10 10 6 3 2.7\n",
          file);
    fclose(file);
    assert_refused(DECK("10, 10, 10", "origin = 0, 0, 10"),
                   "t.nml:4:", (const char *[]){"p_speed 6", "m/s, not km/s", NULL});
}

static void test_cut_short(void **state)
{
    (void)state;
    write_rfile(stored, 0, 1, 0);
    assert_int_equal(truncate(stored, 600), 0);
    assert_refused(DECK("800, 700, 900", ""),
                   "t.nml:4:", (const char *[]){"it has 600 bytes", "cut short", NULL});
    assert_int_equal(truncate(stored, 50), 0);
    assert_refused(DECK("800, 700, 900", ""), "t.nml:4:", (const char *[]){"its head is cut short", NULL});
    write_rfile(stored, 0, 1, 0);
    assert_refused(DECK("800, 700, 900", "origin = 0, 0, 0"),
                   "t.nml:4:", (const char *[]){"3 values; expected 2", NULL});
    assert_refused(DECK("800, 700, 1400", ""), "t.nml:4:", (const char *[]){"-200 to 1200 along z", NULL});
    write_sfile(stored, 0);
    assert_int_equal(truncate(stored, 5000), 0);
    assert_refused(DECK("800, 700, 900", ""),
                   "t.nml:4:", (const char *[]){"build/test/model", "cut short", NULL});
    write_blocks(stored, 0, "m/s", NAN);
    assert_refused(DECK("800, 300, 900", ""),
                   "t.nml:4:", (const char *[]){"(0, 0, 0)", "is not finite", NULL});
    assert_int_equal(truncate(stored, 0), 0);
    assert_refused(DECK("800, 300, 900", ""), "t.nml:4:", (const char *[]){"it is empty", NULL});
    unlink(stored);
    assert_refused(DECK("800, 300, 900", ""), "t.nml:4:", (const char *[]){"No such file", NULL});
    assert_int_equal(mkdir(stored, 0700), 0);
    assert_refused(DECK("800, 300, 900", ""), "t.nml:4:", (const char *[]){"Is a directory", NULL});
    rmdir(stored);
}

/* Q of the formats that the others leave out; Q that says there is none; the deck's words. */
static void test_quality(void **state)
{
    (void)state;
    write_plain(stored, 1);
    struct from_deck made = right_scene(DECK("800, 700, 900", "q_frequency = 2, q_power = 0.3"));
    const struct material *material = &made.scene->material[made.scene->body.material];
    assert_field(made.scene, (double[]){123, 456, 78}, 123, 456, 78, 1e-12);
    assert_true(made.scene->body.model->damped && material->q_p > 0 && material->q_frequency == 2 &&
                material->q_power == .3);
    from_deck_free(&made);
    made = right_scene(DECK("800, 700, 900", "damped = .false."));
    assert_true(!ground_is_damped(made.scene) && made.scene->body.model->grid[0].value[MODEL_VALUES] == NULL);
    from_deck_free(&made);
    write_plain(stored, -1);
    made = right_scene(DECK("800, 700, 900", ""));
    assert_text(&made, NULL, "24 of 24 values have no q_p or q_s above 0");
    assert_true(!ground_is_damped(made.scene));
    from_deck_free(&made);
    write_plain(stored, 0);
    made = right_scene(DECK("800, 700, 900", ""));
    assert_text(&made, NULL, NULL);
    assert_true(!ground_is_damped(made.scene));
    from_deck_free(&made);
    write_damped_text(stored, 0, 0, "", 60, 20);
    made = right_scene(DECK("700, 800, 600", ""));
    assert_text(&made, NULL, "1 of 60 values have no q_p or q_s above 0, the first one at (1500, 2600, 500)");
    assert_field(made.scene, (double[]){700, 800, 10}, 800, 700, 10, 1e-12);
    assert_true(made.scene->body.model->undamped == 1);
    from_deck_free(&made);
    write_damped_text(stored, 0, 5, "1500 2300 -700 4000 2000 2000 300 50\n", 60, 61);
    assert_refused(
        DECK("700, 800, 600", ""), "t.nml:4:",
        (const char *[]){"q_p = 300 is too large beside q_s = 50 at (1500, 2300, 700)", "q_s = 150", NULL});
    write_damped_text(stored, 0, 5, "1500 2300 -700 4000 2000 2000\n", 60, 61);
    assert_refused(DECK("700, 800, 600", ""), "t.nml:4:", (const char *[]){"line 11", "6 numbers", NULL});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rfile),        cmocka_unit_test(test_sfile),
        cmocka_unit_test(test_blocks),       cmocka_unit_test(test_sea),
        cmocka_unit_test(test_text),         cmocka_unit_test(test_own_surface),
        cmocka_unit_test(test_wrong_text),   cmocka_unit_test(test_cut_short),
        cmocka_unit_test(test_quality),      cmocka_unit_test(test_blocks_crs),
        cmocka_unit_test(test_blocks_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
