/* Chooses scheme, stages and time step; all memory that stepping needs is taken here. */
#include "stepping/schemes.h"

#include "base/memory.h"
#include "parallel/ranks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Largest frequency and damping rate about the body at rest. Dampers of linear models are implicit in
 * leapfrog and count only for schemes that take them explicitly. */
static selas_status measure_spectrum(struct stepper *stepper, struct messages *messages)
{
    struct model *model = stepper->model;
    const struct model_operator *spatial = model->spatial;
    struct spectrum *spectrum = &stepper->spectrum;
    if (spatial->spectrum != NULL) return spatial->spectrum(model, spectrum, messages);
    selas_status status = largest_frequency(model, &spectrum->omega, &stepper->frequency_error, messages);
    spectrum->omega *= 1.0 + stepper->frequency_error;
    spectrum->dampers = model->damped;
    spectrum->layers = model->layers;
    const bool explicit_damping = !stepper->scheme->needs_acceleration || spatial->linearise != NULL;
    if (status == SELAS_OK && model->damped && explicit_damping)
        status = largest_damping(model, scene_fastest(model->scene), &spectrum->viscous, messages);
    spectrum->viscous += model->dissipation;
    return status;
}

/* Step that the deck asks for; 0 if it leaves the choice to the program. */
static double wanted_step(struct stepper *stepper)
{
    const struct scene *scene = stepper->model->scene;
    const struct stepping_choice *choice = &scene->stepping;
    if (choice->time_step > 0.0) {
        snprintf(stepper->dt_reason, sizeof stepper->dt_reason, "given (stepping%%time_step)");
        return choice->time_step;
    }
    if (choice->courant > 0.0) {
        snprintf(stepper->dt_reason, sizeof stepper->dt_reason, "courant number %g given", choice->courant);
        return choice->courant * scene->body.spacing / scene_fastest(scene);
    }
    return 0.0;
}

/* The reason why a step, or any step, is refused. */
static selas_status refuse(const struct stepper *stepper, struct messages *messages)
{
    const char *name = stepper->scheme->name;
    char names[SCHEME_NAMES_SIZE];
    if (stepper->limit > 0.0)
        return fail(
            messages, SELAS_BAD_SCENE,
            "the time step %.6g is beyond the stability limit %.6g of scheme '%s' (largest frequency %.6g, "
            "damping rate %.6g); take a smaller stepping%%time_step or courant, leave both out, or set "
            "stepping%%force = .true.",
            stepper->dt, stepper->limit, name, stepper->spectrum.omega, stepper->spectrum.viscous);
    return fail(
        messages, SELAS_BAD_SCENE,
        "scheme '%s' is unstable for every time step here: the largest frequency is %.6g, the damping rate "
        "only %.6g, and the scheme's stability region does not contain the imaginary axis, where undamped "
        "waves live%s; take scheme %s, or set stepping%%time_step and stepping%%force = .true.",
        name, stepper->spectrum.omega, stepper->spectrum.wave_damping,
        stepper->scheme->choose_stages != NULL ? ", whatever the number of stages" : "",
        scheme_names(stepper->model, SCHEME_WAVES, names));
}

static selas_status choose_step(struct stepper *stepper, struct messages *messages)
{
    const struct scene *scene = stepper->model->scene;
    const struct stepping_choice *choice = &scene->stepping;
    const selas_status status = measure_spectrum(stepper, messages);
    if (status != SELAS_OK) return status;
    stepper->dt = wanted_step(stepper);
    if (stepper->scheme->choose_stages != NULL)
        stepper->stages = stepper->scheme->choose_stages(stepper, stepper->dt);
    stepper->limit = scheme_limit(stepper->scheme, &stepper->spectrum, stepper->stages);
    const double limit = stepper->limit;
    if (!(stepper->dt > 0.0) && isfinite(limit) && limit > 0.0) {
        /* whole steps to end_time, so that the last row is end_time itself */
        stepper->dt = scene->end_time / fmax(1, ceil(scene->end_time / (choice->safety * limit) - 1e-9));
        snprintf(stepper->dt_reason, sizeof stepper->dt_reason,
                 "%g of the limit %.6g (largest frequency %.6g +- %.1g %%, damping rate %.6g)",
                 choice->safety, limit, stepper->spectrum.omega, 100.0 * stepper->frequency_error,
                 stepper->spectrum.viscous);
    }
    if (!isfinite(limit) && !(stepper->dt > 0.0))
        return fail(messages, SELAS_BAD_SCENE,
                    "nothing vibrates in this scene, so that the program cannot choose a time step; give "
                    "stepping%%time_step");
    if (!(stepper->dt > 0.0) || (stepper->dt > limit * (1.0 + 1e-9) && !choice->force))
        return refuse(stepper, messages);
    return SELAS_OK;
}

static selas_status take_memory(struct stepper *stepper, struct messages *messages)
{
    const struct model *model = stepper->model;
    const bool filters = model->spatial->after_step != NULL;
    stepper->vectors = filters && stepper->scheme->vectors == 0 ? 1 : stepper->scheme->vectors;
    stepper->work = array_new(stepper->vectors, sizeof *stepper->work);
    bool room = stepper->work != NULL;
    for (size_t i = 0; room && i < stepper->vectors; i++) {
        stepper->work[i] = array_new(model->state_size, sizeof **stepper->work);
        room = stepper->work[i] != NULL;
    }
    if (!room)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu work vectors of the scheme",
                    stepper->vectors);
    const selas_status status = driver_create(&stepper->driver, model->scene, stepper->dt, messages);
    if (status != SELAS_OK || !stepper->unwarp) return status;
    return driver_warp(&stepper->driver, stepper->steps + stepper->extra + 2, messages);
}

/* Steps that the record needs beyond end_time: the un-warping kernel reaches a few times (t dt^2 / 8)^(1/3)
 * (the width of the Airy function at its caustic) beyond the row it makes. */
static unsigned long steps_beyond(const struct stepper *stepper)
{
    if (!stepper->unwarp) return 1;
    const double width = cbrt(stepper->model->scene->end_time * stepper->dt * stepper->dt / 8.0);
    return 12 + (unsigned long)ceil(6.0 * width / stepper->dt);
}

static bool linear_and_symmetric(const struct model *model)
{
    return model->self_adjoint && model->spatial->linearise == NULL && model->spatial->after_step == NULL;
}

/* The transform is exact for linear models at rest at t = 0 that histories known beforehand drive at fixed
 * places. */
static bool can_unwarp(const struct stepper *stepper)
{
    const struct model *model = stepper->model;
    return (stepper->scheme->can & SCHEME_UNWARPS) != 0 && linear_and_symmetric(model) &&
           model->scene->initial.kind == INITIAL_REST && !scene_loads_move(model->scene) &&
           !scene_driven(model->scene);
}

static selas_status choose_unwarp(struct stepper *stepper, struct messages *messages)
{
    const struct stepping_choice *choice = &stepper->model->scene->stepping;
    const bool possible = can_unwarp(stepper);
    char names[SCHEME_NAMES_SIZE];
    if (choice->unwarp_given && choice->unwarp && !possible)
        return fail(
            messages, SELAS_BAD_SCENE,
            "stepping%%unwarp needs scheme %s, a linear symmetric method without filter, a body at rest at t "
            "= 0 and loads that do not move, all of them by histories known beforehand (no host drives)",
            scheme_names(stepper->model, SCHEME_UNWARPS, names));
    stepper->unwarp = choice->unwarp_given ? choice->unwarp : possible;
    return SELAS_OK;
}

/* A step is 1e-15 of end_time at the least: beyond that times are not told apart any more. */
static selas_status check_steps(const struct stepper *stepper, struct messages *messages)
{
    const double end = stepper->model->scene->end_time, steps = end / stepper->dt;
    if (steps < 1e15) return SELAS_OK;
    return fail(messages, SELAS_BAD_SCENE, "%.3g steps of %.6g to scene%%end_time = %.6g are too many", steps,
                stepper->dt, end);
}

/* What the scene and the model ask of the scheme. */
enum { NEEDS = 6 };
struct need {
    enum scheme_ability ability;
    bool needed;
    const char *what;
};

static void set_needs(const struct model *model, struct need need[NEEDS])
{
    need[0] = (struct need){SCHEME_MOVING_LOADS, scene_loads_move(model->scene), "loads that move need"};
    need[1] = (struct need){SCHEME_FILTERS, model->spatial->after_step != NULL,
                            "a filter (method%filter > 0) needs"};
    need[2] = (struct need){SCHEME_ONE_PASS, model->single, "method%precision = 'single' needs"};
    need[3] = (struct need){SCHEME_LAYERS, model->layers, "absorbing layers (boundary%layer = 'pml') need"};
    need[4] = (struct need){SCHEME_DAMPED, model->core->loss != NULL, "damped materials (material%q_p) need"};
    need[5] = (struct need){SCHEME_DAMPED_FACES, model->core->loss != NULL && model->damped,
                            "damped materials beside dampers (boundary%layer = 'lysmer') need"};
}

/* NULL, or what the scheme cannot do of what is asked. */
static const struct need *unmet(const struct scheme_class *scheme, const struct need need[NEEDS])
{
    for (size_t i = 0; i < NEEDS; i++)
        if (need[i].needed && (scheme->can & need[i].ability) == 0) return &need[i];
    return NULL;
}

bool scheme_serves(const struct scheme_class *scheme, const struct model *model)
{
    struct need need[NEEDS];
    set_needs(model, need);
    return scheme_fits(scheme, model) && unmet(scheme, need) == NULL;
}

static selas_status check_abilities(const struct stepper *stepper, struct messages *messages)
{
    const struct model *model = stepper->model;
    struct need need[NEEDS];
    char names[SCHEME_NAMES_SIZE];
    set_needs(model, need);
    const struct need *missing = unmet(stepper->scheme, need);
    if (missing != NULL)
        return fail(messages, SELAS_UNSUPPORTED, "%s scheme %s, not '%s'", missing->what,
                    scheme_names(model, missing->ability, names), stepper->scheme->name);
    if (model->single && scene_driven(model->scene))
        return fail(messages, SELAS_UNSUPPORTED,
                    "loads and faces that a host drives need method%%precision = 'double'");
    return SELAS_OK;
}

/* The scheme of a deck that names none. Motion at t = 0 keeps leapfrog's transform from running, and its time error
 * would stay: then one that has none of that order, if it can do all that is asked. */
static const struct scheme_class *choose_default(struct stepper *stepper)
{
    const struct model *model = stepper->model;
    const struct scheme_class *usual = scheme_default(model);
    const bool stays = usual != NULL && (usual->can & SCHEME_UNWARPS) != 0 && linear_and_symmetric(model) &&
                       model->scene->initial.kind != INITIAL_REST && !scene_driven(model->scene);
    if (!stays || !scheme_serves(&scheme_modified_equation, model)) return usual;
    stepper->scheme_reason = "the body moves at t = 0, where leapfrog's time error would stay";
    return &scheme_modified_equation;
}

static selas_status choose_scheme(struct stepper *stepper, struct messages *messages)
{
    const struct model *model = stepper->model;
    const char *name = model->scene->stepping.scheme;
    char names[SCHEME_NAMES_SIZE];
    stepper->scheme = name[0] == '\0' ? choose_default(stepper) : scheme_find(name);
    if (stepper->scheme == NULL) return fail(messages, SELAS_UNSUPPORTED, "there is no scheme '%s'", name);
    if (!scheme_fits(stepper->scheme, model))
        return fail(messages, SELAS_UNSUPPORTED,
                    "scheme '%s' does not fit method '%s', variant '%s'; expected %s", name,
                    model->method->name, model->method->variant, scheme_names(model, 0, names));
    return check_abilities(stepper, messages);
}

static selas_status prepare(struct stepper *stepper, struct messages *messages)
{
    selas_status status = choose_scheme(stepper, messages);
    if (status == SELAS_OK) status = choose_step(stepper, messages);
    if (status == SELAS_OK) status = choose_unwarp(stepper, messages);
    if (status == SELAS_OK) status = check_steps(stepper, messages);
    if (status == SELAS_OK) {
        stepper->steps = (unsigned long)ceil(stepper->model->scene->end_time / stepper->dt - 1e-9);
        stepper->extra = steps_beyond(stepper);
        status = take_memory(stepper, messages);
    }
    status = ranks_agree(stepper->model->scene->ranks, status, messages);
    if (status == SELAS_OK)
        status = held_create(&stepper->held, stepper->model, stepper->scheme->accelerate, stepper, messages);
    return status;
}

selas_status stepper_create(struct model *model, struct stepper **created, struct messages *messages)
{
    *created = NULL;
    struct stepper *stepper = calloc(1, sizeof *stepper);
    if (stepper == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the time stepping");
    stepper->model = model_computed(model);
    const selas_status status = prepare(stepper, messages);
    if (status != SELAS_OK) {
        stepper_free(&stepper);
        return status;
    }
    *created = stepper;
    return SELAS_OK;
}

void stepper_free(struct stepper **freed)
{
    if (freed == NULL || *freed == NULL) return;
    struct stepper *stepper = *freed;
    for (size_t i = 0; stepper->work != NULL && i < stepper->vectors; i++)
        array_free(stepper->work[i]);
    array_free(stepper->work);
    driver_free(&stepper->driver);
    held_free(&stepper->held);
    free(stepper);
    *freed = NULL;
}
