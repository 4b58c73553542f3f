/* What scene%accuracy serves on ground, and how far its laws were measured (doc/verification/accuracy.md). */
#include "accuracy/ground_range.h"
#include "accuracy/ground_task.h"
#include "damping/ground.h"
#include "scene/absorbing_layers.h"
#include "scene/echo.h"
#include "scene/ground.h"

#include <math.h>

static const double LAW_RATIO = .4; /* Poisson's, up to which the law was measured */

/* The faces of a box that stands for a half-space: the loaded one free, the others mirrors, absorbing layers
 * or so far away that what they send back is too late. */
static const char *faces_refusal(const struct scene *scene)
{
    struct scene seen = *scene;
    seen.snapshots = 0; /* the error is that at the receivers */
    if (!boundary_is_free(&scene->boundary[FACE_Z_LOW])) return "half-spaces with a free surface";
    for (int face = 0; face < FACE_Z_HIGH + 1; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        if (face == FACE_Z_LOW || boundary_mirrors(boundary) || boundary_has_layer(boundary)) continue;
        if (scene->body.absorbing && !boundary->given) continue;
        if (!scene->body.chosen && echo_seen(&seen, face, 0))
            return "boxes with faces that absorb by layers (layer = 'pml'), are symmetry planes, or stand so "
                   "far away that nothing comes back before end_time";
    }
    return NULL;
}

/* The general operator misplaces moment tensors beside an interface, the more the coarser the trial's lattice is. */
static bool moment_in_general(const struct scene *scene, const struct load *load)
{
    const struct deck_group *group = scene->method.group;
    const bool asked =
        group != NULL && deck_given(group, "operator") && deck_chosen(group, "operator", "general");
    return load->kind == LOAD_MOMENT_TENSOR && body_is_layered(&scene->body) &&
           (asked || scene->body.most_stretch > 1);
}

const char *ground_refusal(const struct scene *scene)
{
    if (!body_is_box(&scene->body)) return "half-spaces and boxes";
    if (ground_is_general(scene)) return "level layers of one material each, without &model and &block";
    if (scene->receivers == 0) return "scenes with receivers, where the error is taken";
    for (size_t k = 0; k < scene->loads; k++) {
        if (scene->load[k].shape == LOAD_FACE) return "loads on a square or a disc or at points";
        if (load_moves(&scene->load[k])) return "loads that do not move";
        if (moment_in_general(scene, &scene->load[k]))
            return "moment tensors in layered ground without body%grading and method%operator = 'general'";
    }
    return faces_refusal(scene);
}

/* Is Poisson's ratio of all materials between these? */
static bool ratios_within(const struct scene *scene, double low, double high)
{
    for (size_t m = 0; m < scene->materials; m++) {
        const double ratio = pow(scene->material[m].p_speed / scene->material[m].s_speed, 2);
        const double nu = (ratio - 2) / (2 * ratio - 2);
        if (nu < low - 1e-6 || nu > high + 1e-6) return false;
    }
    return true;
}

/* What the law was measured for (section 3): beyond, only a trial can tell. NULL, or what lies outside. */
const char *ground_range_refusal(const struct scene *scene)
{
    if (ground_is_damped(scene)) return "materials without q_p and q_s";
    if (scene->body.most_stretch > 1) return "an even spacing, without body%grading";
    if (!ratios_within(scene, .1, LAW_RATIO)) return "Poisson's ratios of .1 to .4";
    return points_act(scene) ? "loads on a square or a disc" : NULL;
}

selas_status ground_in_range(const struct scene *scene, double h, struct messages *messages)
{
    const char *why = ground_range_refusal(scene);
    if (why == NULL) return SELAS_OK;
    return fail(
        messages, SELAS_BAD_SCENE,
        "scene%%accuracy: a spacing near %.2g is needed, which is too much for a trial run, and without one "
        "errors are known only for %s; a larger accuracy, receivers farther from the rim of a patch, or "
        "body%%spacing in place of accuracy would do",
        h, why);
}

double ground_order(const struct scene *scene)
{
    if (!ratios_within(scene, -1, .45)) return 3; /* 2.8 at .495, 3.2 at .49; points 3.5 and less */
    const bool steep = ratios_within(scene, -1, LAW_RATIO) && !body_is_layered(&scene->body);
    return points_act(scene) || !steep ? 4 : INFINITY; /* 3.8 at .45, points 3.5, below an interface 2.8 */
}
