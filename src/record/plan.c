/* The plan of a run: what `selas check` prints and report.txt begins with. */
#include "advice/advice.h"
#include "record/parts.h"

#include "base/processor.h"
#include "parallel/ranks.h"
#include "scene/absorbing_layers.h"
#include "scene/grading.h"
#include "scene/ground.h"
#include "scene/resolution.h"
#include "scene/topography.h"
#include "scene/units.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

struct teller {
    void (*tell)(void *context, const char *key, const char *value);
    void *context;
};

__attribute__((format(printf, 3, 4))) static void say(const struct teller *teller, const char *key,
                                                      const char *format, ...)
{
    char value[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(value, sizeof value, format, arguments);
    va_end(arguments);
    teller->tell(teller->context, key, value);
}

static void say_resolution(const struct teller *teller, const struct scene *scene)
{
    const double points = points_per_wavelength(scene);
    if (!(points > 0.0)) return;
    if (!scene_driven(scene))
        say(teller, "source cutoff", "%.4g (angular frequency above which the spectrum is below %g %%)",
            source_cutoff(scene), 100.0 * SOURCE_COUNTS);
    say(teller, "points per wavelength", "%.3g (slowest wave at the source's cutoff%s)", points,
        scene_loads_move(scene) ? ", ahead of what moves" : "");
}

static double operator_calls(const struct stepper *stepper)
{
    return stepper->scheme->evaluations * (stepper->stages > 0 ? (double)stepper->stages : 1.0);
}

static void say_step(const struct teller *teller, const struct stepper *stepper)
{
    say(teller, "scheme", "%s", stepper->scheme->name);
    if (stepper->scheme_reason != NULL) say(teller, "scheme chosen", "%s", stepper->scheme_reason);
    say(teller, "order in time", "%d", stepper->scheme->order);
    if (stepper->stages > 0) say(teller, "stages", "%ld", stepper->stages);
    say(teller, "time step", "%.9g", stepper->dt);
    say(teller, "time step chosen", "%s", stepper->dt_reason);
    if (stepper->limit > 0.0) say(teller, "time step limit", "%.9g", stepper->limit);
    if (stepper->spectrum.omega > 0.0) say(teller, "largest frequency", "%.9g", stepper->spectrum.omega);
    if (stepper->spectrum.viscous > 0.0) {
        say(teller, "largest damping rate", "%.6g", stepper->spectrum.viscous);
        say(teller, "damping rate of the fastest waves", "%.6g", stepper->spectrum.wave_damping);
    }
    say(teller, "time-dispersion transform", "%s", stepper->unwarp ? "yes" : "no");
    say(teller, "steps", "%lu", stepper->steps);
    if (stepper->extra > 0) say(teller, "steps beyond end_time", "%lu", stepper->extra);
}

static double memory_of(const struct recorder *recorder)
{
    const struct stepper *stepper = recorder->stepper;
    const struct model *model = recorder->model;
    const double vectors = 1.0 + (double)stepper->vectors; /* the state, and what the scheme works in */
    const double rows = (double)(stepper->steps + stepper->extra + 2);
    double bytes = (double)model->bytes +
                   8.0 * (vectors * (double)model->state_size + (double)model->unknowns) +
                   72.0 * rows * (double)recorder->scene->receivers;
    for (size_t s = 0; s < recorder->scene->snapshots;
         s++) { /* 6 numbers a point of a piece; a region's list */
        const struct snapshot_record *record = &recorder->snapshot[s];
        bytes += 48.0 * (double)record->room + (record->index != NULL ? 8.0 * (double)record->points : 0.0);
    }
    return fmax(bytes, (double)model->setup_bytes);
}

void recorder_weigh(struct recorder *recorder)
{
    double memory = memory_of(recorder);
    ranks_largest(recorder->scene->ranks, 1, &memory);
    recorder->memory = memory;
}

static void say_surface(const struct teller *teller, const struct topography *topography)
{
    static const char *const keys[TOPOGRAPHY_LINES] = {"surface", "lattice below the surface",
                                                       "surface smoothed", "surface at the sides"};
    for (int line = 0; topography != NULL && line < TOPOGRAPHY_LINES; line++)
        if (topography->text[line][0] != '\0') say(teller, keys[line], "%s", topography->text[line]);
}

/* Where the deck leaves it open and the general operator runs anyway. */
static void say_saving(const struct teller *teller, const struct scene *scene)
{
    const struct deck_group *group = scene->deck != NULL ? deck_get(scene->deck, "body", 0) : NULL;
    const bool general = ground_is_general(scene) || scene->body.topography != NULL;
    if (group == NULL || deck_given(group, "grading") || scene->dimension < 2 || !general ||
        !body_is_box(&scene->body) || scene->body.rotated || scene->body.accuracy[0] != '\0')
        return;
    const double saved = grading_saves(scene);
    if (saved >= GRADING_WORTH)
        say(teller, "spacing over depth",
            "even; rock below is faster: body%%grading = %g would leave out %.0f %% of the points at about "
            "the same error",
            GRADING_MEASURED, 100 * saved);
}

static void say_grading(const struct teller *teller, const struct scene *scene)
{
    const struct body *body = &scene->body;
    const struct grading *grading = body->grading;
    if (grading == NULL) {
        say_saving(teller, scene);
        return;
    }
    say(teller, "spacing over depth",
        "%.4g down to a depth of %.4g, then growing to %.4g, by no more than the slowest wave there and "
        "below is "
        "longer; %zu cells, an even lattice has %.0f",
        body->spacing, grading->from, grading->largest, grading->cells,
        (body->high[grading->axis] - body->low[grading->axis]) / body->spacing);
}

static void say_interfaces(const struct teller *teller, const struct body *body)
{
    size_t below = 0;
    for (size_t i = 0; i < body->layers; i++)
        below += layer_is_below(body, &body->layer[i]);
    if (body->chosen && below > 0)
        say(teller, "layers below the box", "%zu, from which no wave comes back before end_time", below);
    for (size_t i = 0; i < body->layers; i++) {
        const struct height_map *map = body->layer[i].map;
        if (map == NULL) continue;
        say(teller, "interface",
            "heights from a file: mean depth %.4g, up to %.3g off it; splines differ by up to %.3g",
            body->layer[i].top, height_map_most(map), height_map_smoothed(map));
    }
}

/* What the deck alone does not tell; a patch under a function is many loads of one group. */
static void say_driven(const struct teller *teller, const struct scene *scene)
{
    const struct load *load = scene->load;
    for (size_t k = 0; k < scene->loads; k++)
        if (load[k].driven != BY_HISTORY && (k == 0 || load[k].group != load[k - 1].group))
            say(teller, "driven by the host", "load %zu", load[k].group + 1);
    for (size_t face = 0; face < FACES; face++)
        if (scene->boundary[face].driven != BY_HISTORY)
            say(teller, "driven by the host", "face %s", face_name((enum face)face));
}

static void say_parts(const struct teller *teller, const struct scene *scene)
{
    if (scene->body.accuracy[0] != '\0') say(teller, "accuracy", "%s", scene->body.accuracy);
    if (scene->body.chosen) say(teller, "box chosen", "%s", scene->body.choice);
    if (scene->body.model != NULL) say(teller, "ground", "%s", scene->body.model->text);
    say_surface(teller, scene->body.topography);
    say_grading(teller, scene);
    say_interfaces(teller, &scene->body);
    say(teller, "loads", "%zu", scene->loads);
    say_driven(teller, scene);
    say(teller, "receivers", "%zu", scene->receivers);
    if (scene->profiles > 0) say(teller, "profiles", "%zu", scene->profiles);
    if (scene->snapshots > 0) say(teller, "snapshot groups", "%zu", scene->snapshots);
    for (size_t face = 0; face < FACES; face++)
        if (scene->boundary[face].given || boundary_damps(&scene->boundary[face])) {
            char key[32];
            snprintf(key, sizeof key, "face %s", face_name((enum face)face));
            const char *name = boundary_meaning(&scene->boundary[face])->name;
            const char *why = layers_refusal(scene);
            if (boundary_has_layer(&scene->boundary[face]))
                say(teller, key, "%s, absorbing layer (C-PML)", name);
            else if (boundary_damps(&scene->boundary[face]))
                say(teller, key,
                    "%s, dampers (Lysmer-Kuhlemeyer), which send back part of what meets them askew%s%s",
                    name, why != NULL ? ": " : "", why != NULL ? why : "");
            else
                say(teller, key, "%s", name);
        }
    if (scene->output.low_pass > 0.0)
        say(teller, "low-pass", "exp(-(omega/%.9g)^4), zero phase, on computed histories",
            scene->output.low_pass);
}

static void say_table(const struct teller *teller, const char *what, size_t number,
                      const struct history *history)
{
    if (history->kind != HISTORY_TABLE || history->rows == 0) return;
    const size_t last = history->rows - 1;
    char key[48];
    snprintf(key, sizeof key, "table of &%s %zu", what, number);
    say(teller, key, "0 before t = %.6g, straight lines between %zu rows, %.6g held from t = %.6g on",
        history->table_time[0], history->rows, history->table_value[last], history->table_time[last]);
}

static void say_tables(const struct teller *teller, const struct scene *scene)
{
    for (size_t k = 0; k < scene->loads; k++)
        say_table(teller, "load", scene->load[k].group + 1, &scene->load[k].history);
    for (size_t face = 0; face < FACES; face++)
        say_table(teller, "boundary", scene->boundary[face].group + 1, &scene->boundary[face].history);
}

/* What a method says of itself; steps in one pass are leapfrog's alone. */
struct method_teller {
    struct teller to;
    bool one_pass;
};

static void say_of_method(void *context, const char *key, const char *value)
{
    const struct method_teller *teller = context;
    const bool apart = strcmp(key, "step") == 0 && !teller->one_pass;
    teller->to.tell(teller->to.context, key, apart ? "apart from the operator" : value);
}

void plan_tell(const struct recorder *recorder,
               void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct teller teller = {tell, context};
    const struct scene *scene = recorder->scene;
    const struct model *model = recorder->model;
    if (scene->title[0] != '\0') say(&teller, "title", "%s", scene->title);
    if (scene->deck != NULL) say(&teller, "deck", "%s", deck_name(scene->deck));
    say(&teller, "dimension", "%d", scene->dimension);
    char units[UNIT_TEXT];
    if (scene->output.length_unit[0] != '\0' || scene->output.time_unit[0] != '\0')
        say(&teller, "units", "%s", units_told(&scene->output, units));
    say(&teller, "method", "%s", model->method->name);
    say(&teller, "variant", "%s", model->method->variant);
    say(&teller, "processor", "%s (vectors of %d bytes)", processor_name(processor_taken()),
        processor_bytes(processor_taken()));
    say(&teller, "points", "%zu", model->points);
    say(&teller, "unknowns", "%zu", model->whole_unknowns > 0 ? model->whole_unknowns : model->unknowns);
    if (model->grid[0] > 0)
        say(&teller, "lattice", "%zu x %zu x %zu", model->grid[0], model->grid[1] > 0 ? model->grid[1] : 1,
            model->grid[2] > 0 ? model->grid[2] : 1);
    struct method_teller own = {teller, (recorder->stepper->scheme->can & SCHEME_ONE_PASS) != 0};
    if (model->core->describe != NULL) model->core->describe(model, say_of_method, &own);
    say_step(&teller, recorder->stepper);
    say_resolution(&teller, scene);
    say_parts(&teller, scene);
    say_tables(&teller, scene);
    const bool shared = ranks_count(scene->ranks) > 1;
    const double memory = shared ? recorder->memory : memory_of(recorder);
    say(&teller, shared ? "planned memory bytes of the largest rank" : "planned memory bytes", "%.0f",
        memory);
    if (!shared)
        say(&teller, "planned bytes per point", "%.1f",
            memory / (double)(model->points > 0 ? model->points : 1));
    advice_tell(scene, recorder->stepper, tell, context);
}

void recorder_plan(struct recorder *recorder, struct stepper *stepper,
                   void (*tell)(void *context, const char *key, const char *value), void *context)
{
    plan_tell(recorder, tell, context);
    if (stepper == NULL) return;
    const double seconds = estimate_step(recorder, stepper),
                 steps = (double)(stepper->steps + stepper->extra);
    const struct teller teller = {tell, context};
    say(&teller, "estimated operator calls", "%.0f", operator_calls(stepper) * steps);
    if (seconds >= 0.0) say(&teller, "estimated stepping seconds", "%.3g", seconds * steps);
}
