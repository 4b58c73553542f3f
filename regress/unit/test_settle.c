/* Moment tensors beside interfaces aslant (doc/theory/general-ground.md, Eqs G26 to G29): the fields that they are held
 * against, and the work of a load on fields of two rocks that are known in closed form; forces and receivers beside
 * interfaces (G30) on the same fields; strains of profiles (G31) and snapshots (G34). */
#include "two_rocks.h"

#include "method/consistent/general/steady.h"
#include "method/methods.h"

#include <math.h>
#include <string.h>

/* --- The fields of the line ------------------------------------------------------------------------------ */

/* Stress at a place from differences over d to either side. */
static void stress_at(const struct ground_line *line, const struct steady *steady, const double place[3],
                      double d, double stress[3][3])
{
    const struct rock *rock = ground_line_at(line, place);
    double slope[3][3] = {{0}}, spread = 0;
    for (int axis = 0; axis < line->dimension; axis++) {
        double side[2][3];
        for (int s = 0; s < 2; s++) {
            double there[3] = {place[0], place[1], place[2]};
            there[axis] += (2 * s - 1) * d;
            steady_at(line, steady, there, side[s]);
        }
        for (int i = 0; i < line->dimension; i++)
            slope[i][axis] = (side[1][i] - side[0][i]) / (2 * d);
    }
    for (int i = 0; i < 3; i++)
        spread += slope[i][i];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            stress[i][j] = rock->mu * (slope[i][j] + slope[j][i]) + (i == j ? rock->lambda * spread : 0);
}

/* div stress - density * acceleration, the largest, times the length. */
static double lack_of_balance(const struct ground_line *line, const struct steady *steady,
                              const double place[3], double d)
{
    double pull[3] = {0}, acceleration[3], most = 0;
    steady_acceleration(line, steady, acceleration);
    for (int axis = 0; axis < line->dimension; axis++)
        for (int s = 0; s < 2; s++) {
            double there[3] = {place[0], place[1], place[2]}, stress[3][3];
            there[axis] += (2 * s - 1) * d;
            stress_at(line, steady, there, d, stress);
            for (int i = 0; i < 3; i++)
                pull[i] += (2 * s - 1) * stress[i][axis] / (2 * d);
        }
    for (int i = 0; i < line->dimension; i++)
        most = fmax(most, fabs(pull[i] - ground_line_at(line, place)->density * acceleration[i]));
    return most;
}

static void test_steady_fields_balance(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        struct from_deck deck = scene_of(dimension, 25, .03, .9, false, false);
        const double angle = 25 * M_PI / 180,
                     normal[3] = {-sin(angle), dimension == 2 ? cos(angle) : 0, cos(angle)};
        const double origin[3] = {.03, dimension == 2 ? .9 : .02, .9};
        struct ground_line line;
        struct steady list[STEADY_MOST];
        assert_true(ground_line_new(deck.scene, origin, normal, .1 / 512, 1, &line));
        const size_t count = steady_all(&line, .1, list);
        assert_int_equal(count, dimension == 2 ? 12 : 30);
        for (size_t n = 0; n < count; n++)
            for (int side = -1; side <= 1;
                 side += 2) { /* .3 to either side of the source: in soil and in rock */
                double place[3] = {.13, .07, .11}, jump[2][3] = {{0}};
                for (int axis = 0; axis < dimension; axis++)
                    place[axis] =
                        origin[axis] + side * .3 * normal[axis] + (axis < dimension - 1 ? .06 : .02);
                const double lack = lack_of_balance(&line, &list[n], place, .05) / (line.here.mu / .1);
                assert_true(lack < 1e-4); /* straight lines between the steps */
                double direct[3], pull[3], given[3][3];
                const double face[3] = {.3, dimension == 2 ? -.9 : .2, -.9};
                steady_pull(&line, &list[n], place, face, pull);
                stress_at(&line, &list[n], place, .05, given);
                for (int i = 0; i < dimension; i++) {
                    direct[i] = given[i][0] * face[0] + given[i][1] * face[1] + given[i][2] * face[2];
                    assert_true(fabs(pull[i] - direct[i]) < 1e-4 * line.here.mu);
                }
                if (side < 0) continue;
                for (int s = 0; s < 4; s++) { /* traction .01 and .02 to either side of the interface */
                    const double along =
                        (.1 + .03 * tan(angle)) * cos(angle) + (s < 2 ? -.01 : .01) * (1 + s % 2);
                    double stress[3][3], there[3] = {0};
                    for (int axis = 0; axis < dimension; axis++)
                        there[axis] = origin[axis] + along * normal[axis];
                    stress_at(&line, &list[n], there, .004, stress);
                    for (int i = 0; i < dimension; i++)
                        for (int j = 0; j < dimension; j++)
                            jump[s / 2][i] += (s % 2 == 0 ? 2 : -1) * stress[i][j] * normal[j];
                }
                for (int i = 0; i < dimension; i++) /* the line's rock changes up to half a step off */
                    assert_true(fabs(jump[1][i] - jump[0][i]) < .02 * line.here.mu);
            }
        steady_free(list);
        ground_line_free(&line);
        from_deck_free(&deck);
    }
}

/* --- The work of a load ----------------------------------------------------------------------------------- */

/* What the load's forces do on control values. */
static double work_of(const struct consistent *c, const double *u)
{
    double done = 0, *plane = calloc(c->plane, sizeof *plane);
    for (int component = 0; component < c->dimension; component++)
        for (size_t k = 0; k < c->n[2]; k++) {
            memset(plane, 0, c->plane * sizeof *plane);
            sparse_add(c, &c->load.of[0], component, k, 1, plane);
            done += dot(c->plane, plane, u + (size_t)component * c->volume + k * c->plane);
        }
    free(plane);
    return done;
}

/* Of a moment tensor in the plane x, z: the largest error of its work, in parts of what a moment as large does at
 * most. */
static double worst_work(int dimension, double dip, double x, double z, bool graded)
{
    struct from_deck deck = scene_of(dimension, dip, x, z, graded, false);
    if (graded) assert_non_null(deck.scene->body.grading);
    struct messages messages = {0};
    struct model *model = NULL;
    assert_int_equal(model_create(deck.scene, &model, &messages), SELAS_OK);
    struct consistent *c = consistent_of(model);
    const int last = dimension - 1;
    double worst = 0;
    for (int field = 0; field < FIELDS; field++) {
        double *u = field_at_rest(&deck, c, field, dip), slope[2][2], shift[2], wanted = 0, most = 0;
        two_rocks(deck.scene, field, dip * M_PI / 180, (double[]){x, z}, shift, slope);
        const double *m = deck.scene->load[0].moment,
                     tensor[2][2] = {{m[0], m[dimension == 2 ? 3 : 5]}, {m[dimension == 2 ? 3 : 5], m[last]}};
        for (int i = 0; i < 2; i++)
            for (int j = 0; j < 2; j++) {
                wanted += tensor[i][j] * slope[i][j];
                most += fabs(tensor[i][j] * slope[i][j]);
            }
        worst = fmax(worst, fabs(work_of(c, u) - wanted) / most);
        free(u);
    }
    model_free(&model);
    from_deck_free(&deck);
    return worst;
}

static void test_work_beside_interfaces_aslant(void **state)
{
    (void)state;
    static const double dip[] = {5, 20, 40}, away[] = {-.12, -.03, -.0012, .0012, .03, .08};
    double worst = 0;
    for (size_t i = 0; i < sizeof dip / sizeof *dip; i++)
        for (size_t j = 0; j < sizeof away / sizeof *away; j++) {
            const double x = .013 + .027 * (double)j, z = 1 + x * tan(dip[i] * M_PI / 180) + away[j];
            const double here = worst_work(2, dip[i], x, z, false);
            if (here > .01) print_error("dip %g, %g from the interface: %g\n", dip[i], away[j], here);
            worst = fmax(worst, here);
        }
    assert_true(worst < .01); /* without (G29) up to .5 */
    for (size_t j = 0; j < sizeof away / sizeof *away;
         j++) /* 1.3 to 6 spacings below a free face, 2.6 to 5.5 from another */
        for (int i = 0; i < 4; i++) {
            const double x = -.94 + .13 * i, z = fmax(.13, 1 + x * tan(40 * M_PI / 180) + away[j]);
            const double here = worst_work(2, 40, x, z, false);
            if (here > .03) fail_msg("%g, %g: %g", x, z, here); /* without (G29) up to .5 */
        }
    assert_true(worst_work(3, 40, -.73, .36, false) < .02);
    assert_true(worst_work(3, 20, .013, 1.05, false) < .01);
    assert_true(worst_work(2, 20, .013, 1.05, true) < .01);
}

/* Of a force and of a receiver in the same place: the largest errors of its work and of what it sees, in parts of the
 * slopes of displacement times the spacing. */
static void worst_shift(int dimension, double dip, double x, double z, bool graded, double worst[2])
{
    struct from_deck deck = scene_of(dimension, dip, x, z, graded, true);
    struct messages messages = {0};
    struct model *model = NULL;
    struct probe probe = {.fields = 1U << SELAS_DISPLACEMENT};
    assert_int_equal(model_create(deck.scene, &model, &messages), SELAS_OK);
    const int last = dimension - 1;
    const double place[3] = {x, dimension == 2 ? z : .02, z};
    assert_int_equal(model->core->probe(model, place, &probe, &messages), SELAS_OK);
    worst[0] = worst[1] = 0;
    for (int field = 0; field < (dip == 0 ? FIELDS : 2); field++) { /* bands of even strain bend aslant */
        double *u = field_at_rest(&deck, consistent_of(model), field, dip), slope[2][2], shift[2],
               seen[6] = {0};
        double *state = calloc(2 * model->unknowns, sizeof *state);
        memcpy(state, u, model->unknowns * sizeof *u);
        two_rocks(deck.scene, field, dip * M_PI / 180, (double[]){x, z}, shift, slope);
        const double scale = .1 * fmax(hypot(slope[0][0], slope[0][1]), hypot(slope[1][0], slope[1][1]));
        model_observe(model, &probe, SELAS_DISPLACEMENT, state, NULL, seen);
        worst[0] =
            fmax(worst[0], fabs(work_of(consistent_of(model), u) - .6 * shift[0] - .8 * shift[1]) / scale);
        worst[1] = fmax(worst[1], hypot(seen[0] - shift[0], seen[last] - shift[1]) / scale);
        free(state);
        free(u);
    }
    probe_free(&probe);
    model_free(&model);
    from_deck_free(&deck);
}

static void test_displacement_beside_interfaces(void **state)
{
    (void)state;
    static const double dip[] = {0, 5, 20, 40}, right[] = {.02, .05, .13, .22}, /* .39 to .45 without (G30) */
        away[] = {-.1, -.02, .02, .05, .1};
    double worst[2];
    for (size_t i = 0; i < sizeof dip / sizeof *dip; i++)
        for (size_t j = 0; j < sizeof away / sizeof *away; j++) {
            const double x = .013 + .027 * (double)j, z = 1 + x * tan(dip[i] * M_PI / 180) + away[j];
            worst_shift(2, dip[i], x, z, false, worst);
            if (worst[0] > right[i] || worst[1] > right[i])
                fail_msg("dip %g, %g from the interface: force %g, receiver %g", dip[i], away[j], worst[0],
                         worst[1]);
        }
    worst_shift(3, 20, .013, 1.02, false, worst); /* .45 */
    assert_true(fmax(worst[0], worst[1]) < .05);
    worst_shift(2, 20, .013, 1.02, true, worst); /* .45 */
    assert_true(fmax(worst[0], worst[1]) < .05);
    worst_shift(2, 0, .013, 1.02, true, worst); /* .39 */
    assert_true(fmax(worst[0], worst[1]) < .02);
}

/* What strains at a place are off, in parts of the slopes of displacement. */
static double off(const struct scene *scene, int field, double dip, const double place[3], int dimension,
                  const double strain[6])
{
    const int last = dimension - 1, cross = dimension == 2 ? 3 : 5;
    double slope[2][2], shift[2];
    two_rocks(scene, field, dip * M_PI / 180, (double[]){place[0], place[last]}, shift, slope);
    const double worst = fmax(fmax(fabs(strain[0] - slope[0][0]), fabs(strain[last] - slope[1][1])),
                              fabs(strain[cross] - (slope[0][1] + slope[1][0]) / 2));
    return worst / fmax(hypot(slope[0][0], slope[0][1]), hypot(slope[1][0], slope[1][1]));
}

/* Of the strains that a profile reads: the largest error, in parts of the slopes of displacement; without the rock's
 * jump (smooth) they would err by up to the ratio of the moduli. */
static double worst_strain(int dimension, double dip, double x, double z)
{
    struct from_deck deck = scene_of(dimension, dip, x, z, false, true);
    struct messages messages = {0};
    struct model *model = NULL;
    struct probe probe = {.fields = 1U << SELAS_STRAIN};
    assert_int_equal(model_create(deck.scene, &model, &messages), SELAS_OK);
    const double place[3] = {x, dimension == 2 ? z : .02, z};
    assert_int_equal(model->core->probe(model, place, &probe, &messages), SELAS_OK);
    assert_true(probe.strains > 0 && probe.strains == probe.sites);
    double worst = 0;
    for (int field = 0; field < FIELDS; field++) {
        double *u = field_at_rest(&deck, consistent_of(model), field, dip), seen[6] = {0};
        double *state = calloc(2 * model->unknowns, sizeof *state);
        memcpy(state, u, model->unknowns * sizeof *u);
        model_observe(model, &probe, SELAS_STRAIN, state, NULL, seen);
        worst = fmax(worst, off(deck.scene, field, dip, place, dimension, seen));
        free(state);
        free(u);
    }
    probe_free(&probe);
    model_free(&model);
    from_deck_free(&deck);
    return worst;
}

static void test_strains_beside_interfaces(void **state)
{
    (void)state;
    static const double dip[] = {0, 5, 20, 40}, away[] = {-.1, -.02, .02, .05, .1};
    for (size_t i = 0; i < sizeof dip / sizeof *dip; i++)
        for (size_t j = 0; j < sizeof away / sizeof *away; j++) {
            const double x = .013 + .027 * (double)j, z = 1 + x * tan(dip[i] * M_PI / 180) + away[j];
            const double most = worst_strain(2, dip[i], x, z);
            if (most > .02) fail_msg("dip %g, %g from the interface: %g", dip[i], away[j], most);
        }
    assert_true(worst_strain(3, 0, .013, .98) < .01);
    assert_true(worst_strain(3, 0, .013, 1.02) < .01);
}

/* Of the strains of a snapshot within 3 spacings of the interface, off the faces: the same. */
static double worst_of_snapshot(const char *rock, int dimension, double dip, bool graded)
{
    struct from_deck deck = scene_on(rock, dimension, dip, .013, .9, graded, true);
    struct messages messages = {0};
    struct model *model = NULL;
    assert_int_equal(model_create(deck.scene, &model, &messages), SELAS_OK);
    const int last = dimension - 1;
    const double angle = dip * M_PI / 180;
    double worst = 0, *value = calloc(6 * model->points, sizeof *value),
           *state = calloc(2 * model->unknowns, sizeof *state);
    size_t seen = 0;
    for (int field = 0; field < FIELDS; field++) {
        double *u = field_at_rest(&deck, consistent_of(model), field, dip), place[3];
        memcpy(state, u, model->unknowns * sizeof *u);
        model->core->field(model, SELAS_STRAIN, state, NULL, 0, model->points, value);
        for (size_t point = 0; point < model->points; point++) {
            model_position(model, point, place);
            const double depth = (place[last] - 1) * cos(angle) - place[0] * sin(angle);
            if (fabs(depth) < 1e-9 || fabs(depth) > .3 || fabs(place[0]) > .55 ||
                fabs(place[last] - 1) > .6 || (dimension == 3 && fabs(place[1]) > .35))
                continue;
            worst = fmax(worst, off(deck.scene, field, dip, place, dimension, value + 6 * point));
            seen++;
        }
        free(u);
    }
    assert_true(seen > 100);
    free(state);
    free(value);
    model_free(&model);
    from_deck_free(&deck);
    return worst;
}

static void test_strains_of_snapshots(void **state)
{
    (void)state;
    static const double dip[] = {0, 5, 20, 40}; /* .63 to .83 without (G34) */
    for (size_t i = 0; i < sizeof dip / sizeof *dip; i++) {
        const double most = worst_of_snapshot(stiffer, 2, dip[i], false);
        if (most > (dip[i] == 0 ? .01 : .07)) fail_msg("dip %g: %g", dip[i], most);
    }
    assert_true(worst_of_snapshot(stiffer, 2, 0, true) < .01);
    assert_true(worst_of_snapshot(stiffer, 2, 20, true) < .07);
    assert_true(worst_of_snapshot(stiffer, 3, 0, false) < .01);
    assert_true(worst_of_snapshot(stiffer, 3, 20, false) < .07);
    assert_true(worst_of_snapshot(wet, 2, 0, false) < .01); /* .10, .36 without (G35a) */
    assert_true(worst_of_snapshot(wet, 2, 40, false) < .08);
    assert_true(worst_of_snapshot(wet, 2, 20, true) < .07);
    assert_true(worst_of_snapshot(wet, 3, 20, false) < .07);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_steady_fields_balance),
        cmocka_unit_test(test_work_beside_interfaces_aslant),
        cmocka_unit_test(test_displacement_beside_interfaces),
        cmocka_unit_test(test_strains_beside_interfaces),
        cmocka_unit_test(test_strains_of_snapshots),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
