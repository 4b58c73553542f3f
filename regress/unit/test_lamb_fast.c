/* Patches that move faster than Rayleigh, S and P waves, on the surface. With H the displacement a unit step
 * on the patch at rest leaves (closed form, Pekeris; no transform over wavenumbers or frequencies),
 *   u(x, t) = dW/dt,  W(x, t) = integral of f(tau) H(x - V tau, t - tau) dtau.
 * Velocity has logarithmic poles on the Rayleigh wave's Mach lines from the corners, whatever the history, so
 * that what is compared is the means of u over intervals, (W(t+d) - W(t))/d, and their differences over d:
 * velocity seen through a triangular window. */
#include "exact/gauss12.h"
#include "exact/lamb_moving.h"
#include "lamb_closed.h"

#include "few.h"
#include "near.h"

#include <gsl/gsl_integration.h>

static const struct history gaussian = {.kind = HISTORY_GAUSSIAN, .width = .3, .delay = 1.5};

struct push {
    const struct lamb_closed *closed;
    const struct moving_patch *patch;
    double position[2], time;
    int component;
};

static double pushed_at(double tau, void *parameters)
{
    const struct push *push = parameters;
    const struct patch *patch = &push->patch->load.patch;
    struct messages messages = {0};
    double place[2], u[3];
    for (int i = 0; i < 2; i++)
        place[i] = push->position[i] - patch->centre[i] - push->patch->velocity[i] * tau;
    assert_int_equal(
        lamb_closed_step(push->closed, patch, place[0], place[1], push->time - tau, u, &messages), SELAS_OK);
    return history_value(push->patch->load.history, tau, 0) * u[push->component];
}

/* W above. */
static double integrated(struct push *push, double time, gsl_integration_cquad_workspace *space)
{
    const gsl_function function = {pushed_at, push};
    double value = 0;
    push->time = time;
    assert_int_equal(gsl_integration_cquad(&function, 0, time, 1e-8, 1e-6, space, &value, NULL, NULL), 0);
    return value;
}

static double mean(const struct lamb_problem *problem, const struct lamb_signal *signal, double from,
                   double to, int component)
{
    enum { PANELS = 200 };
    double sum = 0;
    for (int panel = 0; panel < PANELS; panel++)
        for (int i = 0; i < 12; i++) {
            double value[6];
            const double at = from + (to - from) * (panel + .5 + .5 * gauss12_node[i]) / PANELS;
            lamb_signal_value(problem, signal, at, value);
            sum += .5 * gauss12_weight[i] / PANELS * value[component];
        }
    return sum;
}

static void compare(double nu, const double velocity[2], const double position[2], int component)
{
    enum { INTERVALS = 4 };
    const double begin = 1.6, step = .2, end = begin + INTERVALS * step, lambda = 2 * nu / (1 - 2 * nu);
    const struct moving_patch patch = {{{PATCH_RECTANGLE, {-1.5, 0}, {.5, .4}}, {0, 0, 1}, &gaussian},
                                       {velocity[0], velocity[1]}};
    struct messages messages = {0};
    struct lamb_problem problem = {.loads = 0};
    struct lamb_closed closed;
    struct lamb_signal signal = {.position = {position[0], position[1], 0}};
    half_space_set(&problem.ground, 1, lambda, 1);
    assert_int_equal(lamb_closed_set(&closed, 1, lambda, 1, &messages), SELAS_OK);
    assert_int_equal(lamb_moving(&problem, 1, &patch, end, 1, &signal, true, &messages), SELAS_OK);
    gsl_integration_cquad_workspace *space = gsl_integration_cquad_workspace_alloc(1000);
    assert_non_null(space);
    struct push push = {&closed, &patch, {position[0], position[1]}, 0, component};
    double wrong[2] = {0}, size[2] = {0}, before[2] = {0}, w = integrated(&push, begin, space);
    for (int i = 0; i < INTERVALS; i++) {
        const double next = integrated(&push, begin + (i + 1) * step, space);
        const double now[2] = {(next - w) / step,
                               mean(&problem, &signal, begin + i * step, begin + (i + 1) * step, component)};
        wrong[0] += pow(now[1] - now[0], 2);
        size[0] += pow(now[0], 2);
        if (i > 0) {
            wrong[1] += pow(now[1] - before[1] - now[0] + before[0], 2);
            size[1] += pow(now[0] - before[0], 2);
        }
        before[0] = now[0];
        before[1] = now[1];
        w = next;
    }
    const double errors[2] = {sqrt(wrong[0] / size[0]), sqrt(wrong[1] / size[1])};
    print_message("nu %g, V (%g, %g), %c at (%g, %g): displacement %.1e, velocity %.1e (norms %.3g, %.3g)\n",
                  nu, velocity[0], velocity[1], "xyz"[component], position[0], position[1], errors[0],
                  errors[1], sqrt(size[0] * step), sqrt(size[1] / step));
    assert_true(size[0] * step > 1e-6);
    assert_true(errors[0] < 5e-6);
    assert_true(errors[1] < 1e-5);
    gsl_integration_cquad_workspace_free(space);
    lamb_signal_free(&signal);
}

/* Rayleigh .919, S 1, P 1.732. The Mach line from the patch where it pushes most, at t = 1.5, passes the
 * receivers of the first two, off the path, within the time compared. */
static void faster_than_rayleigh(void **state)
{
    (void)state;
    compare(.25, (const double[2]){.96, 0}, (const double[2]){.9, -.6}, 2);
    if (few_of(1, 0)) compare(.25, (const double[2]){.9, -.1}, (const double[2]){1.2, .3}, 2);
}

static void faster_than_shear(void **state)
{
    (void)state;
    if (few_of(0, 1)) skip();
    compare(.25, (const double[2]){1.3, 0}, (const double[2]){1, -1.2}, 2);
}

/* P 1.87 */
static void faster_than_pressure(void **state)
{
    (void)state;
    if (few_of(0, 1)) skip();
    compare(.3, (const double[2]){2, .4}, (const double[2]){1.4, 1.3}, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faster_than_rayleigh),
        cmocka_unit_test(faster_than_shear),
        cmocka_unit_test(faster_than_pressure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
