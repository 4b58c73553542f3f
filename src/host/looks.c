/* What a host is told that the program tells its user: the advice on the scene, once, when it begins to step; and that
 * it looks where or when the deck looks at nothing, so that faces have no absorbing layers (scene/echo.h). */
#include "host/simulation.h"

#include "advice/advice.h"
#include "scene/echo.h"

#include <math.h>
#include <string.h>

static void take_advice(void *context, const char *key, const char *value)
{
    (void)key;
    warn(context, "%s", value);
}

void host_advise(selas_simulation *simulation)
{
    if (simulation->advised) return;
    simulation->advised = true;
    advice_tell(simulation->scene, simulation->stepper, take_advice, &simulation->messages);
}

static void look(selas_simulation *simulation, const struct extent *seen, const char *what)
{
    const struct scene *scene = simulation->scene;
    const double time = simulation->state.time;
    if (simulation->warned) return;
    const int face = echo_heard(scene, seen, time);
    if (face == FACES) return;
    simulation->warned = true;
    warn(&simulation->messages,
         "%s at t = %.4g may hold what face '%s' sends back: it has no absorbing layer, since the deck looks "
         "at "
         "nothing there by end_time = %.4g that would see it; a later end_time, a receiver or a load with a "
         "name "
         "there, or a &snapshot of the whole body, would be right",
         what, time, face_name((enum face)face), scene->end_time);
}

void host_looks_at_all(selas_simulation *simulation)
{
    const struct extent all = {.low = {-INFINITY, -INFINITY, -INFINITY},
                               .high = {INFINITY, INFINITY, INFINITY}};
    look(simulation, &all, "a whole field");
}

void host_looks_at(selas_simulation *simulation, const double position[3], const char *what)
{
    struct extent place = {.role = EXTENT_SEEN};
    body_from_deck(&simulation->scene->body, position, place.low);
    body_from_deck(&simulation->scene->body, position, place.high);
    look(simulation, &place, what);
}

static void tell_strain_error(selas_simulation *simulation, const struct receiver *receiver,
                              selas_field field)
{
    if (simulation->erring) return;
    const double error = advice_strain_error(simulation->stepper->model, receiver->position, field);
    simulation->erring = error > 0;
    if (simulation->erring)
        warn(&simulation->messages,
             "stresses and strains at receiver '%s' err by up to about %.2g; variant = 'consistent', finer "
             "points, or places farther from faces, would be right",
             receiver->name, error);
}

void host_reads(selas_simulation *simulation, const struct receiver *receiver, selas_field field)
{
    tell_strain_error(simulation, receiver, field);
    if (simulation->strained || !advice_smooth_strain(simulation->scene, receiver->position, field)) return;
    simulation->strained = true;
    warn(&simulation->messages,
         "receiver '%s' lies within a spacing of where the rock jumps, and its stress, pressure or energy "
         "mid-run are those of a strain that is smooth there, wrong by up to the ratio of the moduli; %s",
         receiver->name,
         strcmp(simulation->scene->method.variant, "consistent") == 0 ? "a &profile or a &snapshot would do"
                                                                      : "places two spacings off would do");
}
