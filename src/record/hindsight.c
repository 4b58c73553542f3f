/* What only the run can tell: rotations that small-strain theory or images take for small, and energy that was given
 * and did not arrive. Told once, when end_time is reached, with what would be right (troubleshooting.md, The run).
 *
 * Rotation w and strain e at a place are the parts of grad u = e + w (nonlinear methods: Green's strain). Small-strain
 * theory gives a body that turns by the angle w edges that are w^2 / 2 too long. Strains are held against w because a
 * linear scene may have any unit of load: a bent beam turns by .8 L / W times the strain. A half-space does not turn:
 * what a few places tell of its rotations and strains is chance. */
#include "record/watch.h"

#include "base/memory.h"
#include "parallel/ranks.h"
#include "scene/resolution.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LOOKS = 100 };
static const double few_degrees = 0.05, above_strain = 3.0;
/* Of the energy that was given; springs to the ground left .35 to .71, without them it was .89 to 1. */
static const double most_of_it = 0.8;
/* Energy gained without being given, over what was given: a few per cent is usual at 15^3 (results.md). */
static const double growth_noted = 0.3;
/* Energy lost that nothing took: published SPH between rollers without viscosity loses .2 to .4 of a Gaussian. */
static const double loss_noted = 0.2;
/* How much more has to be given before what has arrived is looked at again. */
static const double more = 1.25;

/* Strains and rotations grow without bound towards a force or a moment at a point, which stand for what acts on
 * a volume: within a wavelength of one nobody looks. */
static bool beside_point(const struct scene *scene, double wavelength, const double position[3])
{
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        double away = 0.0;
        if (load->shape != LOAD_POINT) continue;
        for (int c = 0; c < scene->dimension; c++)
            away = hypot(away, position[c] - load->centre[c]);
        if (!(away > wavelength)) return true;
    }
    return false;
}

selas_status hindsight_create(struct recorder *recorder, struct messages *messages)
{
    struct model *model = recorder->model;
    if (!model_is_watched(model)) return SELAS_OK;
    const double wavelength = points_per_wavelength(recorder->scene) * recorder->scene->body.spacing;
    recorder->place = array_new(MODEL_WATCHED, sizeof *recorder->place);
    if (recorder->place == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the watch over rotations");
    for (size_t k = 0; k < MODEL_WATCHED; k++) {
        double position[3];
        struct messages unsaid = {0};
        model_position(model, model_watched(model->points, k), position);
        if (beside_point(recorder->scene, wavelength, position)) continue;
        const selas_status status =
            model->core->probe(model, position, &recorder->place[recorder->places], &unsaid);
        messages_free(&unsaid);
        if (status == SELAS_NO_MEMORY)
            return fail(messages, SELAS_NO_MEMORY, "no memory for the watch over rotations");
        if (status == SELAS_OK) recorder->places++;
    }
    return SELAS_OK;
}

void hindsight_free(struct recorder *recorder)
{
    for (size_t k = 0; k < recorder->places; k++)
        probe_free(&recorder->place[k]);
    array_free(recorder->place);
}

static void look_at_rotation(struct recorder *recorder, const double *y)
{
    const struct model *model = recorder->model;
    const size_t d = (size_t)recorder->scene->dimension;
    double turned = 0.0, strained = 0.0;
    for (size_t k = 0; k < recorder->places; k++) {
        const struct probe *probe = &recorder->place[k];
        double slope[3][3] = {{0}}, turn = 0.0, strain = 0.0;
        for (size_t j = 0; j < probe->count; j++)
            for (size_t c = 0; c < d; c++) {
                const double u = y[c * model->component_stride + probe->index[j] * model->point_stride];
                for (size_t axis = 0; axis < d; axis++)
                    slope[c][axis] += probe->gradient[3 * j + axis] * u;
            }
        for (size_t a = 0; a < d; a++)
            for (size_t b = 0; b < d; b++) {
                double green = 0.0;
                for (size_t c = 0; c < d && !model->small_strain; c++)
                    green += 0.5 * slope[c][a] * slope[c][b];
                turn += a < b ? pow(0.5 * (slope[a][b] - slope[b][a]), 2) : 0.0;
                strain += pow(0.5 * (slope[a][b] + slope[b][a]) + green, 2);
            }
        turned = fmax(turned, sqrt(turn));
        strained = fmax(strained, sqrt(strain));
    }
    recorder->watch.turn = fmax(recorder->watch.turn, turned);
    recorder->watch.strain = fmax(recorder->watch.strain, strained);
    if (turned > few_degrees && turned > above_strain * strained)
        recorder->turned = fmax(recorder->turned, turned);
}

/* Whenever clearly more has been given than at the last look: how much of it is in the body? */
static void look_at_arrival(struct recorder *recorder, const struct state *state)
{
    struct watch *watch = &recorder->watch;
    const double due = watch->initial + watch->work - watch->absorbed;
    if (!(due > more * watch->due)) return;
    struct energy energy = {0};
    recorder->model->core->energy(recorder->model, state->y, &energy);
    watch->due = due;
    watch->arrived = energy.kinetic + energy.strain;
}

typedef void teller(void *context, const char *key, const char *value);

static void tell_rotation(const struct recorder *recorder, teller *tell, void *context)
{
    const struct watch *watch = &recorder->watch;
    const struct scene *scene = recorder->scene;
    const double degrees = watch->turn * 180.0 / acos(-1.0);
    char text[512];
    if (!(watch->turn > few_degrees) || !(watch->turn > above_strain * watch->strain)) return;
    if (recorder->model->small_strain)
        snprintf(text, sizeof text,
                 "parts of the body turn by %.3g degrees, with strains of %.2g: the method's small-strain "
                 "theory takes "
                 "rotations for small%s; method%%name = 'sph', variant = 'total-lagrangian', law = "
                 "'saint-venant-kirchhoff' would be right",
                 degrees, watch->strain, scene_has_exact(scene) ? ", and so does the reference" : "");
    else if (recorder->model->level_images)
        snprintf(text, sizeof text,
                 "parts of the body turn by %.3g degrees, with strains of %.2g: variant 'updated-lagrangian' "
                 "presses "
                 "faces by images that do not turn, and stresses were wrong by twice the traction at 4 "
                 "degrees, 50 "
                 "times at 12; variant = 'total-lagrangian' would be right",
                 degrees, watch->strain);
    else
        snprintf(text, sizeof text,
                 "parts of the body turn by %.3g degrees, with strains of %.2g: reference '%s' is linear and "
                 "takes "
                 "rotations for small, so that the error is that of the reference, too; a smaller amplitude "
                 "would be "
                 "right for a comparison",
                 degrees, watch->strain, scene->reference.kind);
    tell(context, "warning", text);
}

static void tell_arrival(const struct watch *watch, teller *tell, void *context)
{
    char text[512];
    if (!(watch->arrived < most_of_it * watch->due)) return;
    snprintf(text, sizeof text,
             "of the energy that was given only %.2g %% was in the body when most was given: the operator as "
             "printed "
             "ties each point to the ground by a spring, which takes the rest, and little arrives elsewhere; "
             "method%%row_sums = 'zero', or variant = 'consistent', would be right",
             100.0 * watch->arrived / watch->due);
    tell(context, "warning", text);
}

/* Energy from nowhere that is not yet enough to stop, but too much to trust. */
static void tell_growth(const struct watch *watch, teller *tell, void *context)
{
    const double given = watch_given(watch, watch->last_time);
    char text[256];
    if (!(watch->gained > growth_noted * given)) return;
    snprintf(text, sizeof text,
             "the body ends with %.3g of energy that nobody gave it (%.3g was given): the results grow by "
             "themselves and are not to be trusted",
             watch->gained, given);
    tell(context, "warning", text);
}

/* Energy that went where the scene has nothing to take it. */
static void tell_loss(const struct recorder *recorder, teller *tell, void *context)
{
    const struct watch *watch = &recorder->watch;
    const struct model *model = recorder->model;
    const double given = watch->initial + watch->gross;
    const bool untold = model->core->loss != NULL && !recorder->scene->output.balance;
    char text[400];
    if (untold || model->layers || watch->untold != 0 || model->leaks ||
        !(-watch->gained > loss_noted * given))
        return;
    snprintf(
        text, sizeof text,
        "of the energy %.3g that was given %.2g is missing at the end, and nothing in the scene took it: "
        "artificial viscosity, a scheme that damps or the points' treatment of short waves did; finer "
        "points, less "
        "viscosity or variant = 'consistent' would be right",
        given, -watch->gained / given);
    tell(context, "warning", text);
}

void hindsight_tell(const struct recorder *recorder, teller *tell, void *context)
{
    tell_growth(&recorder->watch, tell, context);
    tell_loss(recorder, tell, context);
    tell_rotation(recorder, tell, context);
    tell_arrival(&recorder->watch, tell, context);
}

static void warn_of(void *context, const char *key, const char *value)
{
    (void)key;
    warn(context, "%s", value);
}

void hindsight_observe(struct recorder *recorder, const struct state *state, bool settled,
                       struct messages *messages)
{
    const struct stepper *stepper = recorder->stepper;
    if (settled || (!stepper->one_pass && state->step % (1 + stepper->steps / LOOKS) == 0))
        look_at_rotation(recorder, state->y);
    const bool springs =
        recorder->model->leaks && !deck_chosen(recorder->scene->method.group, "row_sums", "zero");
    if (springs && recorder->watch.by_work) look_at_arrival(recorder, state);
    if (state->step != stepper->steps || recorder->looked_back) return;
    recorder->looked_back = true;
    double largest[2] = {recorder->watch.turn, recorder->watch.strain};
    ranks_largest(recorder->scene->ranks, 2, largest);
    recorder->watch.turn = largest[0];
    recorder->watch.strain = largest[1];
    hindsight_tell(recorder, warn_of, messages);
}
