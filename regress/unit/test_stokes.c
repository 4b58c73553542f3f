/* Point sources in an infinite solid: rest, equations of motion, far field, derivative of the force,
 * causality, refusals. */
#include "exact/stokes.h"

#include "from_deck.h"

#include <stdlib.h>

static const struct solid solid = {1.3, 1.9, 1.1};
static const struct history gaussian = {.kind = HISTORY_GAUSSIAN, .width = .3, .delay = 2};
static const double place[3] = {.7, -.4, .9};

static struct load force(int axis, struct history history)
{
    struct load load = {.kind = LOAD_BODY_FORCE, .shape = LOAD_POINT, .amplitude = 1.7, .history = history};
    load.direction[axis] = 1;
    return load;
}

static struct load moment(struct history history)
{
    return (struct load){.kind = LOAD_MOMENT_TENSOR,
                         .shape = LOAD_POINT,
                         .amplitude = 1.7,
                         .moment = {.3, -.8, .5, .2, -.6, .9},
                         .history = history};
}

static void at(const struct load *load, double x, double y, double z, double t, double value[6])
{
    const double away[3] = {x, y, z};
    for (int c = 0; c < 6; c++)
        value[c] = 0;
    stokes_add(&solid, load, away, t, value);
}

/* A force that stays: Kelvin's solution. */
static void rest_is_kelvins(void **state)
{
    (void)state;
    const double mu = solid.density * solid.s_speed * solid.s_speed;
    const double ratio = solid.s_speed * solid.s_speed / (solid.p_speed * solid.p_speed);
    const double nu = (1 - 2 * ratio) / (2 - 2 * ratio), r = sqrt(.49 + .16 + .81);
    const struct history kinds[3] = {
        {.kind = HISTORY_STEP},
        {.kind = HISTORY_STEP, .smoothing = .7},
        {.kind = HISTORY_TABLE, .rows = 2, .table_time = (double[]){0, 1}, .table_value = (double[]){0, 1}}};
    for (int kind = 0; kind < 3; kind++)
        for (int j = 0; j < 3; j++) {
            const struct load load = force(j, kinds[kind]);
            double value[6];
            at(&load, place[0], place[1], place[2], 5, value);
            for (int i = 0; i < 3; i++) {
                const double expected = 1.7 * ((3 - 4 * nu) * (i == j) + place[i] * place[j] / (r * r)) /
                                        (16 * M_PI * mu * (1 - nu) * r);
                assert_near(value[i], expected, 1e-13);
                assert_near(value[3 + i], 0, 1e-13);
            }
        }
}

/* Second derivative of displacement by differences of sixth order; axis 3 is time. */
static double second(const struct load *load, int i, int a, int b, double t)
{
    static const double weight[4] = {0, .75, -.15, 1.0 / 60};
    const double step = .02;
    double sum = 0, value[6];
    for (int m = -3; m <= 3; m++)
        for (int n = -3; n <= 3; n++) {
            double x[4] = {place[0], place[1], place[2], t};
            x[a] += step * m;
            x[b] += step * n;
            const double w = weight[abs(m)] * (m < 0 ? -1 : 1) * weight[abs(n)] * (n < 0 ? -1 : 1);
            if (w == 0) continue;
            at(load, x[0], x[1], x[2], x[3], value);
            sum += w * value[i];
        }
    return sum / (step * step);
}

/* rho u'' = (lambda + mu) grad div u + mu laplacian u away from the source. */
static void equations_of_motion_hold(void **state)
{
    (void)state;
    const double beta2 = solid.s_speed * solid.s_speed, alpha2 = solid.p_speed * solid.p_speed;
    const struct load loads[2] = {force(2, gaussian), moment(gaussian)};
    for (int l = 0; l < 2; l++)
        for (int step = 0; step < 6; step++) {
            const double t = 2.1 + .3 * step;
            double size = 0, wrong = 0;
            for (int i = 0; i < 3; i++) {
                const double inertia = second(&loads[l], i, 3, 3, t);
                double pull = 0;
                for (int j = 0; j < 3; j++)
                    pull += (alpha2 - beta2) * second(&loads[l], j, i, j, t) +
                            beta2 * second(&loads[l], i, j, j, t);
                size = fmax(size, fabs(inertia));
                wrong = fmax(wrong, fabs(pull - inertia));
            }
            assert_true(size > 1e-2);
            assert_true(wrong < 2e-5 * (size + 1));
        }
}

/* Velocity is the rate of displacement: through kinks of every sort. */
static void velocity_is_the_rate(void **state)
{
    (void)state;
    const struct history kinds[4] = {gaussian,
                                     {.kind = HISTORY_TRIANGLE, .duration = 1.1, .smoothing = .6},
                                     {.kind = HISTORY_RICKER, .frequency = 1.2, .delay = 1.4},
                                     {.kind = HISTORY_SINE_BURST, .frequency = 2, .cycles = 4}};
    for (int kind = 0; kind < 4; kind++) {
        const struct load loads[2] = {force(1, kinds[kind]), moment(kinds[kind])};
        for (int l = 0; l < 2; l++)
            for (int step = 0; step < 25; step++) {
                const double t = .7 + .137 * step, h = 1e-4;
                double before[6], now[6], after[6];
                at(&loads[l], place[0], place[1], place[2], t - h, before);
                at(&loads[l], place[0], place[1], place[2], t, now);
                at(&loads[l], place[0], place[1], place[2], t + h, after);
                for (int i = 0; i < 3; i++)
                    assert_near((after[i] - before[i]) / (2 * h), now[3 + i], 3e-5);
            }
    }
}

/* u = M_pq dG_np/d(source)_q = -M_pq dG_np/dx_q. */
static void moment_is_the_derivative_of_force(void **state)
{
    (void)state;
    static const int index[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    const struct load tensor = moment(gaussian);
    for (int step = 0; step < 10; step++) {
        const double t = 1.6 + .25 * step, h = 1e-3;
        double expected[6] = {0}, found[6];
        at(&tensor, place[0], place[1], place[2], t, found);
        for (int p = 0; p < 3; p++)
            for (int q = 0; q < 3; q++) {
                const struct load load = force(p, gaussian);
                static const double weight[2] = {8.0 / 12, -1.0 / 12};
                for (int m = 1; m <= 2; m++) {
                    double plus[6], minus[6], x[3] = {place[0], place[1], place[2]};
                    x[q] += m * h;
                    at(&load, x[0], x[1], x[2], t, plus);
                    x[q] -= 2 * m * h;
                    at(&load, x[0], x[1], x[2], t, minus);
                    for (int c = 0; c < 6; c++)
                        expected[c] -= tensor.moment[index[p][q]] * weight[m - 1] * (plus[c] - minus[c]) / h;
                }
            }
        for (int c = 0; c < 6; c++)
            assert_near(found[c], expected[c], 1e-9);
    }
}

/* Far away: P is radial, S is across, with the patterns g_i g_j and delta_ij - g_i g_j. */
static void far_field_has_its_pattern(void **state)
{
    (void)state;
    const double r = 4000, g[3] = {.48, .6, .64};
    const struct load loads[2] = {force(0, gaussian), moment(gaussian)};
    double turned[3];
    const double *m = loads[1].moment;
    turned[0] = m[0] * g[0] + m[3] * g[1] + m[5] * g[2];
    turned[1] = m[3] * g[0] + m[1] * g[1] + m[4] * g[2];
    turned[2] = m[5] * g[0] + m[4] * g[1] + m[2] * g[2];
    const double along = g[0] * turned[0] + g[1] * turned[1] + g[2] * turned[2];
    for (int wave = 0; wave < 2; wave++) {
        const double c = wave == 0 ? solid.p_speed : solid.s_speed, t = 1.8 + r / c;
        for (int i = 0; i < 3; i++) {
            double value[6];
            const double f = history_value(&gaussian, 1.8, 0), rate = history_value(&gaussian, 1.8, 1);
            const double scale = 1.7 / (4 * M_PI * solid.density * c * c * r);
            const double p = g[i] * g[0], pattern = wave == 0 ? p : (i == 0) - p;
            at(&loads[0], r * g[0], r * g[1], r * g[2], t, value);
            assert_near(value[i] / scale, pattern * f, 3e-3);
            const double pm = g[i] * along, moment_pattern = wave == 0 ? pm : turned[i] - pm;
            at(&loads[1], r * g[0], r * g[1], r * g[2], t, value);
            assert_near(value[i] / scale * c, moment_pattern * rate, 3e-3);
        }
    }
}

static void nothing_comes_before_p(void **state)
{
    (void)state;
    const struct load load = force(0, (struct history){.kind = HISTORY_TRIANGLE, .duration = .2});
    const double r = sqrt(.49 + .16 + .81);
    double value[6];
    at(&load, place[0], place[1], place[2], r / solid.p_speed - 1e-9, value);
    for (int c = 0; c < 6; c++)
        assert_near(value[c], 0, 0);
    at(&load, place[0], place[1], place[2], r / solid.s_speed + .2 + 1e-9, value);
    for (int c = 0; c < 6; c++)
        assert_near(value[c], 0, 1e-15);
}

#define GROUND                                                                                               \
    "&scene dimension=3, end_time=2 /\n&material name='m', density=1, lambda=1, mu=1 /\n"                    \
    "&body material='m', shape='box', low=0,0,0, high=4,4,4, spacing=.5 /\n&reference kind='stokes' /\n"
#define SOURCE "&load kind='body-force', shape='point', centre=2,2,2, direction=1,0,0, history='step' /\n"

static selas_status created(const char *text, const char *word)
{
    struct from_deck from = right_scene(text);
    struct exact *exact = NULL;
    const selas_status status = exact_create(from.scene, &exact, &from.messages);
    if (status == SELAS_OK) {
        /* valid until the wave reflected straight above: (2 - 0 + 1 - 0) / sqrt 3 */
        double value[6];
        const double time = 1.5, position[3] = {2, 2, 1};
        assert_int_equal(exact->class->history(exact, position, 1, &time, value, &from.messages), SELAS_OK);
        assert_true(value[0] > 0);
    } else {
        assert_non_null(strstr(from.messages.text, word));
    }
    exact_free(&exact);
    from_deck_free(&from);
    return status;
}

static void what_has_no_such_solution_is_refused(void **state)
{
    (void)state;
    assert_int_equal(created(GROUND SOURCE "&receiver name='r', position=2,2,1 /\n", ""), SELAS_OK);
    assert_int_equal(created(GROUND SOURCE "&receiver name='r', position=2,2,0 /\n", "receiver r"),
                     SELAS_BAD_SCENE);
    assert_int_equal(created(GROUND SOURCE "&receiver name='r', position=2,2,2 /\n", "infinite"),
                     SELAS_BAD_SCENE);
    assert_int_equal(created(GROUND "&load kind='body-force', direction=1,0,0, history='step' /\n", "point"),
                     SELAS_BAD_SCENE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rest_is_kelvins),
        cmocka_unit_test(equations_of_motion_hold),
        cmocka_unit_test(velocity_is_the_rate),
        cmocka_unit_test(moment_is_the_derivative_of_force),
        cmocka_unit_test(far_field_has_its_pattern),
        cmocka_unit_test(nothing_comes_before_p),
        cmocka_unit_test(what_has_no_such_solution_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
