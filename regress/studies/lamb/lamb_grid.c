/* Holds the half-space's FFT against the closed form on the surface (doc/theory/lamb.md, "What it was checked
 * against"): ten receivers under the load, at and near its edges and corners and far away, Poisson ratios and
 * pulses given by name. Prints the L2 error of a velocity component over the L2 of the largest component, all
 * receivers of a row computed at once, and the seconds that the FFT took.
 *
 *   lamb_grid [PULSE|all] [NU ...]       default: triangle, short, smooth for nu = .1 .25 .4 .45
 *
 * Exit status 1 if a kinked pulse is off by more than 1e-4, a smooth one by more than 1e-5. */
#include "exact/lamb_fft.h"
#include "lamb_closed.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { RECEIVERS = 10, ROWS = 160 };

static const double receivers[RECEIVERS][2] = {{0, 0},      {.25, .1},  {.49, .2}, {.5, .3}, {.5, .5},
                                               {.52, -.48}, {1.3, -.7}, {0, 1.9},  {4, 2.5}, {-6, 8}};

static double table_times[4] = {0, .4, 1.1, 2.5}, table_values[4] = {0, 1, -.5, 0};

struct pulse {
    const char *name;
    struct history history;
    double duration, most;
    bool usual;
};

static const struct pulse pulses[] = {
    {"triangle", {.kind = HISTORY_TRIANGLE, .duration = 2}, 2, 1e-4, true},
    {"short", {.kind = HISTORY_TRIANGLE, .duration = .5}, .5, 1e-4, true},
    {"smooth", {.kind = HISTORY_TRIANGLE, .duration = 2, .smoothing = 1}, 3, 1e-5, true},
    {"quick", {.kind = HISTORY_TRIANGLE, .duration = .3}, .3, 1e-4, false},
    {"slow", {.kind = HISTORY_TRIANGLE, .duration = 5}, 5, 1e-4, false},
    {"table",
     {.kind = HISTORY_TABLE, .rows = 4, .table_time = table_times, .table_value = table_values},
     2.5,
     1e-4,
     false},
    {"gaussian", {.kind = HISTORY_GAUSSIAN, .width = .3, .delay = 2}, 4, 1e-5, false},
    {"ricker", {.kind = HISTORY_RICKER, .frequency = .6, .delay = 2.8}, 5, 1e-5, false},
    {"burst", {.kind = HISTORY_SINE_BURST, .frequency = .8, .cycles = 3}, 3.75, 1e-5, false},
    {"step", {.kind = HISTORY_STEP, .smoothing = 1}, 1, 1e-5, false},
    {"little", {.kind = HISTORY_TRIANGLE, .duration = 2, .smoothing = .1}, 2.1, 1e-4, false},
};

static double seconds(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double l2_error(const double *velocity, const double *expected)
{
    double wrong[3] = {0}, size[3] = {0};
    for (size_t i = 0; i < 3 * (size_t)ROWS; i++) {
        wrong[i % 3] += (velocity[i] - expected[i]) * (velocity[i] - expected[i]);
        size[i % 3] += expected[i] * expected[i];
    }
    return sqrt(fmax(wrong[0], fmax(wrong[1], wrong[2])) / fmax(size[0], fmax(size[1], size[2])));
}

/* Worst error of one row, NAN if something failed. */
static double row(const struct pulse *pulse, double nu)
{
    const struct patch square = {PATCH_RECTANGLE, {0, 0}, {.5, .5}};
    const double lambda = 2 * nu / (1 - 2 * nu);
    const struct lamb_load load = {square, {0, 0, 1}, &pulse->history};
    struct lamb_problem problem = {.loads = 1, .load = &load};
    half_space_set(&problem.ground, 1, lambda, 1);
    struct messages messages = {0};
    struct lamb_closed closed;
    struct lamb_signal signal[RECEIVERS] = {0};
    double far = 0, worst = 0;
    for (size_t r = 0; r < RECEIVERS; r++) {
        memcpy(signal[r].position, receivers[r], sizeof receivers[r]);
        far = fmax(far, hypot(receivers[r][0], receivers[r][1]));
    }
    const double end = pulse->duration + (far + .8) / problem.ground.rayleigh_speed, start = seconds();
    if (lamb_closed_set(&closed, 1, lambda, 1, &messages) != SELAS_OK ||
        lamb_fft(&problem, end, RECEIVERS, signal, &messages) != SELAS_OK)
        return NAN;
    const double took = seconds() - start;
    printf("%-9s %5.2f ", pulse->name, nu);
    for (size_t r = 0; r < RECEIVERS; r++) {
        double time[ROWS], velocity[3 * ROWS], expected[3 * ROWS];
        for (size_t i = 0; i < ROWS; i++) {
            double value[6];
            time[i] = end * ((double)i + .37) / ROWS;
            lamb_signal_value(&problem, &signal[r], time[i], value);
            memcpy(velocity + 3 * i, value + 3, 3 * sizeof *velocity);
        }
        if (lamb_closed_velocity(&closed, &square, receivers[r][0], receivers[r][1], &pulse->history, ROWS,
                                 time, expected, &messages) != SELAS_OK)
            worst = NAN;
        const double error = l2_error(velocity, expected);
        worst = fmax(worst, error);
        printf(" %.1e", error);
        if (getenv("ESTIMATE") != NULL) printf("(%.0e)", signal[r].effort.estimate);
    }
    printf("  %5.2f s  cutoff %.0f\n", took, signal[0].effort.cutoff);
    (void)fflush(stdout);
    for (size_t r = 0; r < RECEIVERS; r++)
        lamb_signal_free(&signal[r]);
    messages_free(&messages);
    return worst;
}

int main(int arguments, char **argument)
{
    const double usual[4] = {.1, .25, .4, .45};
    const bool all = arguments > 1 && strcmp(argument[1], "all") == 0;
    bool good = true;
    printf("pulse        nu  ");
    for (size_t r = 0; r < RECEIVERS; r++)
        printf(" %3g,%-4g", receivers[r][0], receivers[r][1]);
    printf("\n");
    for (size_t p = 0; p < sizeof pulses / sizeof *pulses; p++) {
        if (!all && (arguments > 1 ? strcmp(argument[1], pulses[p].name) != 0 : !pulses[p].usual)) continue;
        for (int i = 0; i < (arguments > 2 ? arguments - 2 : 4); i++) {
            const double nu = arguments > 2 ? strtod(argument[2 + i], NULL) : usual[i];
            good = row(&pulses[p], nu) <= pulses[p].most && good;
        }
    }
    return good ? 0 : 1;
}
