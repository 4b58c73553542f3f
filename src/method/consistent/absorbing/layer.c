/* What the plan says of absorbing layers, and where they go wrong. */
#include "method/consistent/absorbing/pml_fast.h"
#include "scene/absorbing_layers.h"
#include "scene/echo.h"
#include "scene/ground.h"
#include "scene/guided.h"
#include "scene/late.h"
#include "scene/resolution.h"
#include "scene/rests.h"

#include <math.h>
#include <stdio.h>

static void tell_late(const struct scene *scene,
                      void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const double late = late_error(scene);
    char text[80];
    if (late < LATE_TOLD) return;
    snprintf(text, sizeof text, "displacements may err by %.2g of the largest by the end", late);
    tell(context, "what pulses leave", text);
}

void layers_describe(const struct consistent *c,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct scene *scene = c->model.scene;
    const double cutoff = source_cutoff(scene), two_pi = 6.283185307179586477;
    const struct guided guided = guided_waves(scene);
    const double returning = guided_error(scene, &guided);
    char key[32], text[256];
    for (int face = 0; face < 2 * c->dimension; face++) {
        snprintf(key, sizeof key, "layer %s", face_name((enum face)face));
        if (layer_left_out(scene, face))
            tell(context, key,
                 "none: no reflection can be seen by end_time (boundary%always = .true. keeps it)");
        if (c->layer[face] == 0) continue;
        const double thickness = (double)c->layer[face] * layer_spacing(scene, face);
        int used =
            snprintf(text, sizeof text, "C-PML, %zu points, thickness %.4g", c->layer[face], thickness);
        if (cutoff > 0 && isfinite(cutoff))
            used += snprintf(text + used, sizeof text - (size_t)used,
                             " = %.2g P wavelengths at the source's cutoff",
                             thickness * cutoff / (two_pi * consistent_fastest(c, face)));
        const double expected =
            fmax(echo_of_layer(scene, face, c->layer[face]), layer_expected_reflection(c->layer[face])) +
            returning;
        snprintf(text + used, sizeof text - (size_t)used,
                 ", expected reflection %.*g %% of the velocity at the worst place looked at%s%s",
                 expected < .1 ? 1 : 2, 100 * fmin(1, expected),
                 ground_is_general(scene) ? " if the ground were level" : "",
                 layer_drag(scene, face) > 0 ? ", damped against guided waves" : "");
        tell(context, key, text);
    }
    struct rest rest;
    if (worst_rest(scene, &rest)) {
        snprintf(text, sizeof text,
                 "displacements may err by %.2g of what load %zu leaves at receiver '%s' by the end",
                 rest.error, scene->load[rest.load].group + 1, scene->receiver[rest.receiver].name);
        tell(context, "what stays", text);
    }
    tell_late(scene, tell, context);
    if (c->pml == NULL || c->part.ranks != NULL) return;
    size_t variables = 0;
    for (size_t s = 0; s < c->pml->slabs; s++) {
        const size_t *n = c->pml->slab[s].inside.n;
        variables += 2 * (size_t)c->dimension * n[0] * n[1] * n[2];
    }
    if (c->general != NULL) variables = c->pml->extra;
    snprintf(text, sizeof text, "%zu in %zu slabs", variables, c->pml->slabs);
    tell(context, "memory variables of layers", text);
    if (c->general != NULL) return;
    tell(context, "passes of layers", c->pml->fast != NULL ? "shared" : "one by one");
    const struct pml_fast *used =
        c->pml->single != NULL && c->pml->single->groups > 0 ? c->pml->single : c->pml->fast;
    if (used == NULL || used->skipped == 0) return;
    snprintf(text, sizeof text, "%.1f %% of groups of rows, all steps so far",
             100 * (double)used->skipped / (double)used->groups);
    tell(context, "layers skipped", text);
}

void layers_forget(struct pml *pml)
{
    struct pml_fast *const fast[2] = {pml != NULL ? pml->fast : NULL, pml != NULL ? pml->single : NULL};
    for (int kind = 0; kind < 2; kind++)
        if (fast[kind] != NULL) fast[kind]->groups = fast[kind]->skipped = 0;
}

/* Speed of control value (i, j, k) of a slab, counted from its first; infinite if it, or what the layer keeps
 * there, is not finite or overflows. */
static double speed_at(const struct consistent *c, const struct slab *slab, const double *v,
                       const double *extra, const size_t place[3])
{
    const size_t *at = slab->inside.at, *n = slab->inside.n;
    const size_t whole = ((at[2] + place[2]) * c->n[1] + at[1] + place[1]) * c->n[0] + at[0] + place[0];
    const size_t own = (place[2] * n[1] + place[1]) * n[0] + place[0];
    double sum = 0, kept = 0;
    for (size_t component = 0; component < (size_t)c->dimension; component++) {
        const double speed = v[component * c->volume + whole];
        const double psi = extra[slab->psi + component * slab->inner + own];
        const double phi = extra[slab->phi + component * slab->inner + own];
        sum += speed * speed;
        kept += psi * psi + phi * phi;
    }
    return isfinite(sum + kept) ? sqrt(sum) : INFINITY;
}

/* Of one slab: the fastest place or the middle of the spoiled ones, body frame. */
static void look_at_slab(const struct consistent *c, const struct slab *slab, const double *v,
                         const double *extra, struct unseen *found, double position[3])
{
    const size_t *n = slab->inside.n;
    double middle[3] = {0};
    *found = (struct unseen){.speed = -1, .places = slab->inner};
    for (size_t p = 0; p < slab->inner; p++) {
        const size_t place[3] = {p % n[0], p / n[0] % n[1], p / n[0] / n[1]};
        const double speed = speed_at(c, slab, v, extra, place);
        const bool spoiled = !isfinite(speed);
        if (!spoiled && (found->spoiled > 0 || speed <= found->speed)) continue;
        found->spoiled += spoiled;
        found->speed = speed;
        for (int axis = 0; axis < c->dimension; axis++) {
            const int slot = c->slot[axis];
            position[axis] =
                c->spline[axis]->greville[slab->inside.at[slot] + place[slot] + c->part.along[slot].first];
            if (spoiled) middle[axis] += position[axis];
        }
    }
    for (int axis = 0; found->spoiled > 0 && axis < c->dimension; axis++)
        position[axis] = middle[axis] / (double)found->spoiled;
}

void layers_fastest(struct model *model, const double *y, struct unseen *found)
{
    const struct consistent *c = consistent_of(model);
    const double *v = y + model->unknowns;
    for (size_t s = 0; c->pml != NULL && s < c->pml->slabs; s++) {
        const struct slab *slab = &c->pml->slab[s];
        struct unseen one;
        double inside[3] = {0}, position[3];
        look_at_slab(c, slab, v, v + model->unknowns, &one, inside);
        if (one.spoiled <= found->spoiled && (found->spoiled > 0 || one.speed <= found->speed)) continue;
        lattice_to_deck(&model->scene->body, inside, position);
        *found = one;
        snprintf(found->place, sizeof found->place, "in the layer behind face %s, %s (%.6g, %.6g, %.6g)",
                 face_name((enum face)(2 * slab->axis + slab->end)), one.spoiled > 0 ? "about" : "at",
                 position[0], position[1], position[2]);
    }
}
