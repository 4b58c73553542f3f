/* Where a run went wrong and what is the likely cause. Only called when it has: time and memory do not count.
 *
 * A number that is not finite infects its neighbours, some spacings a step, in all directions alike: it began
 * in the middle of what is spoiled. Growth is largest where it began: there the body moves fastest. */
#include "record/watch.h"

#include "base/memory.h"
#include "deck/deck.h"
#include "parallel/ranks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- Where --- */

struct found {
    size_t spoiled;     /* points of the body whose values are not finite or overflow */
    double position[3]; /* about where */
    double speed;       /* largest; infinite if spoiled */
};

/* Middle of the spoiled points about the one at `start`: there may be several such places (mirror images). */
static void middle_of(const struct model *model, const bool *spoiled, size_t start, double middle[3])
{
    enum { SPACINGS = 10, ROUNDS = 12 };
    const double reach = SPACINGS * model->scene->body.spacing;
    model_position(model, start, middle);
    for (int round = 0; round < ROUNDS; round++) {
        double sum[3] = {0}, count = 0.0;
        for (size_t i = 0; i < model->points; i++) {
            double x[3];
            if (!spoiled[i]) continue;
            model_position(model, i, x);
            if (!(hypot(hypot(x[0] - middle[0], x[1] - middle[1]), x[2] - middle[2]) <= reach)) continue;
            count += 1.0;
            for (int axis = 0; axis < 3; axis++)
                sum[axis] += x[axis];
        }
        if (count == 0.0) return;
        for (int axis = 0; axis < 3; axis++)
            middle[axis] = sum[axis] / count;
    }
}

static void mark_spoiled(const struct model *model, selas_field field, const double *value, bool *spoiled)
{
    const size_t components = (size_t)field_components(field);
    for (size_t i = 0; i < model->points; i++)
        for (size_t c = 0; c < components; c++) {
            const double x = value[components * i + c];
            if (!isfinite(x * x)) spoiled[i] = true;
        }
}

static void find_fastest(const struct model *model, const double *velocity, struct found *found)
{
    size_t place = 0;
    for (size_t i = 0; i < model->points; i++) {
        const double speed = hypot(hypot(velocity[3 * i], velocity[3 * i + 1]), velocity[3 * i + 2]);
        if (!(speed > found->speed)) continue;
        place = i;
        found->speed = speed;
    }
    model_position(model, place, found->position);
}

/* Points whose density or stress alone is spoiled show in the fields made of these. False without memory. */
static bool look(const struct recorder *recorder, const struct state *state, struct found *found)
{
    static const selas_field all[] = {SELAS_STRESS, SELAS_DISPLACEMENT, SELAS_VELOCITY};
    struct model *model = recorder->model;
    double *value = array_new(6 * model->points, sizeof *value);
    bool *spoiled = array_new(model->points, sizeof *spoiled);
    *found = (struct found){.speed = -1.0};
    const bool room = value != NULL && spoiled != NULL;
    for (size_t f = 0; room && f < sizeof all / sizeof *all; f++) {
        model->core->field(model, all[f], state->y, state->a, 0, model->points, value);
        mark_spoiled(model, all[f], value, spoiled);
    }
    size_t first = model->points;
    for (size_t i = model->points; room && i-- > 0;)
        if (spoiled[i]) {
            found->spoiled++;
            first = i;
        }
    if (found->spoiled > 0)
        middle_of(model, spoiled, first, found->position);
    else if (room)
        find_fastest(model, value, found); /* the last field was the velocity */
    if (found->spoiled > 0) found->speed = INFINITY;
    array_free(value);
    array_free(spoiled);
    return room;
}

/* On ranks: where one of them has most that is spoiled, or moves fastest. */
static void name_rank(const struct recorder *recorder, const struct state *state, size_t size, char *text)
{
    struct ranks *ranks = recorder->scene->ranks;
    struct unseen own = {.speed = -1.0};
    recorder->model->core->unseen(recorder->model, state->y, &own);
    double worst[2] = {(double)own.spoiled, isfinite(own.speed) ? own.speed : 0.0};
    ranks_largest(ranks, 2, worst);
    const bool mine = worst[0] > 0.0 ? worst[0] == (double)own.spoiled : worst[1] == own.speed;
    double holder = mine ? -(double)ranks_me(ranks) : -(double)ranks_count(ranks);
    ranks_largest(ranks, 1, &holder);
    ranks_spread(ranks, -(int)holder, own.place, sizeof own.place);
    if (worst[0] > 0.0)
        snprintf(text, size, "; it began %s (rank %d), by now at %.0f points of that rank", own.place,
                 -(int)holder, worst[0]);
    else
        snprintf(text, size, "; fastest %s (rank %d), speed %.3g", own.place, -(int)holder, worst[1]);
}

static void name_place(const struct recorder *recorder, const struct state *state, size_t size, char *text)
{
    const struct model *model = recorder->model;
    struct found found;
    text[0] = '\0';
    if (ranks_count(recorder->scene->ranks) > 1) {
        name_rank(recorder, state, size, text);
        return;
    }
    if (model->core->field == NULL || !look(recorder, state, &found)) return;
    if (found.spoiled > 0)
        snprintf(text, size, "; it began about (%.6g, %.6g, %.6g), by now at %zu of %zu points",
                 found.position[0], found.position[1], found.position[2], found.spoiled, model->points);
    else
        snprintf(text, size, "; fastest at (%.6g, %.6g, %.6g), speed %.3g", found.position[0],
                 found.position[1], found.position[2], found.speed);
    if (model->core->unseen == NULL) return;
    struct unseen unseen = {0};
    model->core->unseen(recorder->model, state->y, &unseen);
    if ((double)unseen.spoiled * (double)model->points > (double)found.spoiled * (double)unseen.places)
        snprintf(text, size, "; it began %s, by now at %zu points there", unseen.place, unseen.spoiled);
    else if (found.spoiled == 0 && unseen.speed > found.speed)
        snprintf(text, size, "; fastest %s, speed %.3g", unseen.place, unseen.speed);
}

/* --- Why --- */

static const struct material *least_compressible(const struct scene *scene)
{
    const struct material *found = &scene->material[0];
    for (size_t m = 1; m < scene->materials; m++)
        if (scene->material[m].poisson > found->poisson) found = &scene->material[m];
    return found;
}

static void say_step(const struct stepper *stepper, size_t size, char *text)
{
    if (stepper->limit > 0.0)
        snprintf(text, size,
                 "the time step %.3g is beyond the stability limit %.3g (CFL); leave stepping%%time_step and "
                 "courant out",
                 stepper->dt, stepper->limit);
    else
        snprintf(text, size,
                 "the time step %.3g was not held against a stability limit (CFL); try a smaller one",
                 stepper->dt);
}

static bool is_held(const struct deck_group *method)
{
    return method != NULL && deck_values(method, "hourglass") > 0 && deck_real(method, "hourglass", 0) > 0;
}

/* Is what overflows given? Nothing grows so in so few steps. */
static bool came_large(const struct recorder *recorder, const struct state *state)
{
    enum { FEW = 3 };
    static const double large = 1e100;
    const struct drive drive = driver_last(&recorder->stepper->driver, state->time);
    double most = 0.0;
    for (size_t k = 0; k < recorder->scene->loads; k++)
        most = fmax(most, fabs(recorder->scene->load[k].amplitude * drive.load[k]));
    return state->step <= FEW || most > large;
}

/* The first of what is known to make runs grow that this run has. */
static void name_cause(const struct recorder *recorder, const struct state *state, size_t size, char *text)
{
    static const double nearly_incompressible = 0.49;
    const struct stepper *stepper = recorder->stepper;
    const struct scene *scene = recorder->scene;
    const struct material *stiff = least_compressible(scene);
    const bool beyond = stepper->limit > 0.0 && stepper->dt > 0.999 * stepper->limit;
    if (!beyond && came_large(recorder, state))
        snprintf(text, size,
                 "a given number too large for double precision; look at loads, tables, the state at t = 0, "
                 "moduli and densities");
    else if (beyond || stepper->limit <= 0.0)
        say_step(stepper, size, text);
    else if (stiff->poisson > nearly_incompressible)
        snprintf(text, size, "material '%s' with nu = %.6g, near 0.5; try a smaller nu or time step",
                 stiff->name, stiff->poisson);
    else if (recorder->model->level_images && recorder->turned > 0.0)
        snprintf(
            text, size,
            "parts of the body turned by %.3g degrees, and variant 'updated-lagrangian' presses faces by "
            "images that do not turn; variant = 'total-lagrangian' would be right",
            recorder->turned * 180.0 / acos(-1.0));
    else if (strcmp(recorder->model->method->variant, "updated-lagrangian") == 0)
        snprintf(text, size,
                 "displacements that alternate from particle to particle, which gradients do not see, or "
                 "tractions "
                 "on a body free to turn; %smethod%%variant = 'total-lagrangian' held all",
                 is_held(scene->method.group) ? "" : "method%hourglass = .1 held most, ");
    else if (stepper->spectrum.viscous > 0.0 || recorder->model->spatial->linearise != NULL)
        snprintf(text, size,
                 "the body moves so fast or so far that the stability limit %.3g, measured at rest, does not "
                 "hold (the step is %.3g)%s; try smaller amplitudes, or a smaller stepping%%safety",
                 stepper->limit, stepper->dt,
                 stepper->spectrum.viscous > 0.0 ? ", or the artificial viscosity takes its part of it" : "");
    else if (!recorder->model->self_adjoint)
        snprintf(text, size,
                 "this method's operator is not symmetric and may grow by itself; try a smaller time step, "
                 "method%%variant = 'consistent', or other options of the method");
    else if ((scene_needs(scene) & (CAN_DAMP | CAN_ABSORB)) != 0)
        snprintf(text, size, "an absorbing face (nu = %.3g); try boundary%%layer = 'lysmer' or another box",
                 stiff->poisson);
    else
        snprintf(
            text, size,
            "none that is known: the step is %.0f %% of the limit (CFL), there is no viscosity, nu is %.3g; "
            "look at loads, tables and the machine",
            100.0 * stepper->dt / stepper->limit, stiff->poisson);
}

selas_status watch_tell(const struct recorder *recorder, const struct state *state, const char *what,
                        struct messages *messages)
{
    char where[300], why[400];
    name_place(recorder, state, sizeof where, where);
    name_cause(recorder, state, sizeof why, why);
    return fail(messages, SELAS_UNSTABLE, "the run went unstable at t = %.6g (step %lu): %s%s; likely: %s",
                state->time, state->step, what, where, why);
}
