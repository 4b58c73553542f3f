/* Runs a deck as the program does and writes its energy over time: energy OUT DECK [GROUP%NAME=VALUE ...].
 * OUT gets some 400 rows `time kinetic strain`. Printed: the plan's frequency, limit and step, how the run
 * ended, and the growth rate of the amplitude over the second half, half the slope of log(kinetic + strain),
 * by least squares. Exit status: 0 however the run ended, 2 for wrong usage. */
#include "selas.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct plan {
    char omega[40], limit[40], step[40];
};

static void keep(void *context, const char *key, const char *value)
{
    struct plan *plan = context;
    if (strcmp(key, "largest frequency") == 0) snprintf(plan->omega, sizeof plan->omega, "%.39s", value);
    if (strcmp(key, "time step limit") == 0) snprintf(plan->limit, sizeof plan->limit, "%.39s", value);
    if (strcmp(key, "time step") == 0) snprintf(plan->step, sizeof plan->step, "%.39s", value);
}

struct fit {
    double n, t, tt, y, ty;
};

static void add(struct fit *fit, double t, double y)
{
    fit->n += 1;
    fit->t += t;
    fit->tt += t * t;
    fit->y += y;
    fit->ty += t * y;
}

static double slope(const struct fit *fit)
{
    const double spread = fit->n * fit->tt - fit->t * fit->t;
    return spread > 0 ? (fit->n * fit->ty - fit->t * fit->y) / spread : 0;
}

int main(int count, char **words)
{
    enum { ROWS = 400 };
    selas_simulation *simulation = NULL;
    struct plan plan = {"-", "-", "-"};
    struct fit fit = {0};
    double largest = 0, last = 0;
    if (count < 3) return 2;
    FILE *out = fopen(words[1], "w");
    if (out == NULL) return 2;
    selas_status status =
        selas_open_deck_with(words[2], (size_t)count - 3, (const char *const *)words + 3, &simulation);
    if (status == SELAS_OK) status = selas_plan(simulation, keep, &plan);
    if (status == SELAS_OK) status = selas_record(simulation);
    const double end = status == SELAS_OK ? selas_end_time(simulation) : 0;
    const unsigned long steps = status == SELAS_OK ? selas_steps_needed(simulation) : 0;
    const unsigned long every = steps / ROWS + 1;
    while (status == SELAS_OK && selas_steps(simulation) < steps) {
        double kinetic = 0, strain = 0;
        status = selas_step(
            simulation, every < steps - selas_steps(simulation) ? every : steps - selas_steps(simulation));
        if (status == SELAS_OK) status = selas_energy(simulation, &kinetic, &strain);
        if (status != SELAS_OK) break;
        last = kinetic + strain;
        largest = fmax(largest, last);
        fprintf(out, "%.9g %.9g %.9g\n", selas_time(simulation), kinetic, strain);
        if (selas_time(simulation) > .5 * end && last > 0) add(&fit, selas_time(simulation), .5 * log(last));
    }
    fclose(out);
    printf("omega: %s\nlimit: %s\nstep: %s\n", plan.omega, plan.limit, plan.step);
    printf("status: %s\n", selas_status_name(status));
    printf("time: %.6g\nenergy: %.4g\nlargest: %.4g\ngrowth: %.3g\n", selas_time(simulation), last, largest,
           slope(&fit));
    const char *message = selas_message(simulation);
    const char *error = strstr(message, status == SELAS_OK ? "warning: the body ends" : "error:");
    printf("message: %.300s\n", error != NULL ? error : "");
    selas_close(&simulation);
    return 0;
}
