/* What many ask of a scene. */
#include "scene/scene.h"

#include "scene/resolution.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const struct boundary_meaning *boundary_meaning(const struct boundary *boundary)
{
    static const struct boundary_meaning meanings[] = {
#define MEANING(symbol, word, holds, motion, needs) [symbol] = {word, holds, motion, needs},
        BOUNDARY_KINDS(MEANING)
#undef MEANING
    };
    return &meanings[boundary->kind];
}

unsigned boundary_needs(const struct boundary *boundary)
{
    const unsigned needs = boundary_meaning(boundary)->needs;
    if ((needs & CAN_DAMP) == 0 || boundary->absorber == ABSORBER_LYSMER) return needs;
    return (needs & ~(unsigned)CAN_DAMP) | CAN_ABSORB;
}

double boundary_displacement(const struct boundary *boundary, double time, int derivative)
{
    if (!boundary_moves(boundary)) return 0;
    return history_value(&boundary->history, time, derivative - boundary_meaning(boundary)->motion);
}

bool face_holds(const struct scene *scene, enum face face, int component)
{
    const struct boundary *boundary = &scene->boundary[face];
    const enum face_holds holds = boundary_meaning(boundary)->holds;
    double own[3];
    if (holds == HOLDS_NORMAL) return component == face_axis(face);
    if (holds == HOLDS_NOTHING || !boundary_moves(boundary) || !boundary->slip) return holds == HOLDS_ALL;
    body_direction_from_deck(&scene->body, boundary->direction, own);
    return fabs(own[component]) > .5; /* slip has a direction along an axis of the body */
}

unsigned scene_needs(const struct scene *scene)
{
    unsigned needs = 0;
    for (int face = 0; face < FACES; face++)
        needs |= boundary_needs(&scene->boundary[face]);
    return needs;
}

selas_status scene_check_faces(const struct scene *scene, unsigned can, const char *who,
                               struct messages *messages)
{
    for (int face = 0; face < FACES; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        const unsigned missing = boundary_needs(boundary) & ~can;
        if (missing == 0) continue;
        char text[256];
        snprintf(text, sizeof text, "%s takes no face of kind '%s'%s: face '%s'", who,
                 boundary_meaning(boundary)->name,
                 missing != CAN_ABSORB   ? ""
                 : (can & CAN_DAMP) != 0 ? " with layer = 'pml', only with 'lysmer'"
                                         : " with layer = 'pml'",
                 face_name((enum face)face));
        if (scene->deck == NULL || !boundary->given) return fail(messages, SELAS_UNSUPPORTED, "%s", text);
        deck_error(scene->deck, deck_get(scene->deck, "boundary", boundary->group),
                   missing == CAN_ABSORB ? "layer" : "kind", messages, "%s", text);
        return SELAS_UNSUPPORTED;
    }
    return SELAS_OK;
}

bool scene_has_exact(const struct scene *scene)
{
    return scene->reference.kind[0] != '\0' && strcmp(scene->reference.kind, "file") != 0;
}

bool scene_loads_move(const struct scene *scene)
{
    for (size_t k = 0; k < scene->loads; k++)
        if (load_moves(&scene->load[k])) return true;
    return false;
}

double scene_carries(const struct scene *scene, const double place[3])
{
    double part = 1;
    for (enum face face = FACE_X_LOW; (int)face < 2 * scene->dimension; face++)
        if (boundary_mirrors(&scene->boundary[face]) &&
            fabs(place[face_axis(face)] - face_plane(&scene->body, face)) < 1e-6 * scene->body.spacing)
            part /= 2;
    return part;
}

double scene_fastest(const struct scene *scene)
{
    double speed = 0;
    for (size_t i = 0; i < scene->materials; i++)
        speed = fmax(speed, scene->material[i].p_speed);
    return speed;
}

double scene_first(const struct scene *scene)
{
    double speed = 0, cutoff = -1;
    for (size_t i = 0; i < scene->materials; i++) {
        const struct material *material = &scene->material[i];
        double faster = 1;
        if (material->q_p > 0 && material->q_frequency > 0) {
            if (cutoff < 0) cutoff = source_cutoff(scene);
            const double above = cutoff / (2 * M_PI * material->q_frequency);
            if (isfinite(above) && above > 1) faster += log(above) / (M_PI * material->q_p);
        }
        speed = fmax(speed, material->p_speed * faster);
    }
    return speed;
}

size_t scene_deck_loads(const struct scene *scene)
{
    size_t first = 0, past = scene->loads;
    while (first < past) {
        const size_t middle = first + (past - first) / 2;
        if (scene->load[middle].driven != BY_HOST)
            first = middle + 1;
        else
            past = middle;
    }
    return first;
}

bool scene_driven(const struct scene *scene)
{
    bool driven = false;
    for (size_t k = 0; k < scene->loads; k++)
        driven = driven || scene->load[k].driven != BY_HISTORY;
    for (size_t face = 0; face < FACES; face++)
        driven = driven || scene->boundary[face].driven != BY_HISTORY;
    return driven;
}
