/* Whether a graded spacing pays (see the header). */
#include "accuracy/grade.h"

#include "scene/absorbing_layers.h"
#include "scene/build.h"
#include "scene/grading.h"
#include "scene/ground.h"

#include <math.h>
#include <stdio.h>

static bool asks_general(const struct scene *scene)
{
    const struct deck_group *group = scene->method.group;
    return ground_needs_general(scene) || scene->body.topography != NULL ||
           (group != NULL && deck_given(group, "operator") && deck_chosen(group, "operator", "general"));
}

double accuracy_work(const struct scene *scene)
{
    static const double damped = 4; /* a step of damped ground over one without, general operator: measured */
    const double step = ground_is_damped(scene) && asks_general(scene) ? damped : 1;
    return step * scene_work(scene) * scene_fastest(scene) * scene->end_time / (.35 * scene->body.spacing);
}

long accuracy_layer_points(double accuracy)
{
    return accuracy >= .02 ? 8 : accuracy >= .005 ? 10 : 12;
}

/* Work of the choice, and whether its lattice is graded; INFINITY: there is no such scene. */
static double work_of(const struct trial *trial, const struct scene_choice *choice, bool *graded)
{
    struct messages unsaid = {0};
    struct scene *scene = NULL;
    double work = INFINITY;
    if (scene_build(trial->deck, choice, &scene, &unsaid) == SELAS_OK) {
        work = accuracy_work(scene);
        *graded = scene->body.grading != NULL;
    }
    scene_free(&scene);
    messages_free(&unsaid);
    return work;
}

double accuracy_work_of(const struct trial *trial, const struct scene_choice *choice)
{
    bool graded;
    return work_of(trial, choice, &graded);
}

void accuracy_grade(const struct scene *scene, const struct trial *trial, struct scene_choice *choice,
                    char text[GRADE_TEXT])
{
    const struct deck_group *body = deck_get(trial->deck, "body", 0);
    choice->grading = 0;
    text[0] = '\0';
    if (deck_given(body, "grading") || !asks_general(scene)) return;
    bool graded = false;
    const double even = accuracy_work_of(trial, choice);
    choice->grading = GRADING_MEASURED;
    const double saved = 1 - work_of(trial, choice, &graded) / even;
    if (!graded || !(saved >= GRADING_WORTH)) choice->grading = 0;
    if (choice->grading > 0)
        snprintf(text, GRADE_TEXT, ", grading %g (%.0f %% of the work less than an even spacing)",
                 GRADING_MEASURED, 100 * saved);
}
