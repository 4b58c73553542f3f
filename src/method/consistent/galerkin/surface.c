/* A surface that is not level as a spline of the displacements, so that rotations are among these (see the header).
 */
#include "method/consistent/galerkin/surface.h"

#include "base/memory.h"
#include "scene/grading.h"
#include "scene/topography.h"

static double greville_of(const struct consistent *c, int slot, size_t i)
{
    return c->layout[slot] == NULL ? 0 : c->layout[slot]->greville[i];
}

static int axis_of(const struct consistent *c, int slot)
{
    for (int axis = 0; axis < c->dimension; axis++)
        if (c->slot[axis] == slot) return axis;
    return -1;
}

/* Control values of s, from its values at their Greville points. */
bool consistent_lay_surface(struct consistent *c)
{
    const struct topography *topography = c->model.scene->body.topography;
    if (topography == NULL) return true;
    double *control = c->surface = array_new(c->plane, sizeof *control);
    if (control == NULL) return false;
    for (size_t i = 0; i < c->plane; i++) {
        const double place[2] = {greville_of(c, 0, i % c->n[0]), greville_of(c, 1, i / c->n[0])};
        control[i] = topography_drop(topography, place);
    }
    for (int slot = 0; slot < 2; slot++) {
        if (c->layout[slot] == NULL) continue;
        struct band *lu = consistent_collocation(c->layout[slot], false);
        if (lu == NULL) return false;
        const size_t stride = slot == 0 ? 1 : c->n[0], next = slot == 0 ? c->n[0] : 1;
        for (size_t line = 0; line < c->n[1 - slot]; line++)
            band_lu_solve(lu, control + line * next, stride);
        band_free(lu);
    }
    return true;
}

struct metric metric_of(double stretch, double drop, const double slope[2], double share, double fall)
{
    const double jacobian = stretch * (1 + drop * fall);
    return (struct metric){
        {slope[0] * share / jacobian, slope[1] * share / jacobian}, 1 / jacobian, jacobian};
}

double consistent_drop(const struct consistent *c, const double place[3], double slope[2])
{
    struct spline_point at[2] = {{.value = {1}}, {.value = {1}}};
    const int level = c->surface == NULL;
    int count[2] = {!level, !level};
    double sum = 0, along[2] = {0, 0};
    for (int slot = 0; slot < 2; slot++) {
        if (level || c->layout[slot] == NULL) continue;
        spline_at(c->layout[slot], false, place[axis_of(c, slot)], &at[slot]);
        count[slot] = c->layout[slot]->degree + 1;
    }
    for (int j = 0; j < count[1]; j++)
        for (int i = 0; i < count[0]; i++) {
            const double control = c->surface[at[1].index[j] * c->n[0] + at[0].index[i]];
            sum += at[0].value[i] * at[1].value[j] * control;
            along[0] += at[0].slope[i] * at[1].value[j] * control;
            along[1] += at[0].value[i] * at[1].slope[j] * control;
        }
    for (int slot = 0; slope != NULL && slot < 2; slot++)
        slope[slot] = along[slot];
    return sum;
}

void consistent_to_ground_below(const struct consistent *c, double drop, double place[3])
{
    const struct body *body = &c->model.scene->body;
    double *down = &place[c->dimension - 1];
    *down = grading_real(body->grading, *down);
    if (body->topography != NULL) *down = topography_real(body->topography, drop, *down);
}

void consistent_to_ground(const struct consistent *c, double place[3])
{
    consistent_to_ground_below(c, consistent_drop(c, place, NULL), place);
}

struct metric consistent_metric(const struct consistent *c, const double place[3])
{
    const struct topography *topography = c->model.scene->body.topography;
    const struct grading *grading = c->model.scene->body.grading;
    const double down = place[c->dimension - 1], stretch = grading_stretch(grading, down);
    if (topography == NULL) return (struct metric){.inverse = 1 / stretch, .jacobian = stretch};
    double slope[2], fall;
    const double drop = consistent_drop(c, place, slope);
    const double share = topography_share(topography, grading_real(grading, down) - topography->plane, &fall);
    return metric_of(stretch, drop, slope, share, fall);
}
