/* Fields of two rocks that meet aslant, known in closed form, and control values of them at rest. */
#ifndef TWO_ROCKS_H
#define TWO_ROCKS_H

#include "consistent_run.h"
#include "from_deck.h"

#include "method/consistent/general/general.h"
#include "scene/grading.h"

#include <math.h>

static const char aslant[] =
    "&scene dimension = %d, end_time = 4 /\n"
    "&material name = 'soil', density = .9, p_speed = 2, s_speed = 1 /\n"
    "&material name = 'rock', %s /\n"
    "&body low = %s, high = %s, spacing = .1%s /\n"
    "&method operator = 'general' /\n"
    "&layer material = 'soil', top = 0 /\n"
    "&layer material = 'rock', top = 1, dip = %g, strike = -90 /\n"
    "&load kind = %s, centre = %s, amplitude = 1, history = 'gaussian', width = .4, delay = 2 /\n";

static const char stiffer[] = "density = 1.3, p_speed = 4, s_speed = 2",
                  wet[] = "density = .9, p_speed = 3, s_speed = 1"; /* the soil's shear modulus */

static inline struct from_deck scene_on(const char *rock, int dimension, double dip, double x, double z,
                                        bool graded, bool force)
{
    static const char *const load[2][2] = {{"'moment-tensor', moment = 1, .3, 0, -.6, 0, 0",
                                            "'moment-tensor', moment = 1, -.5, .3, .7, .4, -.6"},
                                           {"'body-force', shape = 'point', direction = .6, .8",
                                            "'body-force', shape = 'point', direction = .6, 0, .8"}};
    char text[2000], place[100];
    snprintf(place, sizeof place, dimension == 2 ? "%g, %g" : "%g, .02, %g", x, z);
    snprintf(text, sizeof text, aslant, dimension, rock, dimension == 2 ? "-1.2, 0" : "-1, -1, 0",
             dimension == 2 ? (graded ? "1.2, 4" : "1.2, 2") : "1, 1, 2", graded ? ", grading = 2" : "", dip,
             load[force][dimension - 2], place);
    return right_scene(text);
}

static inline struct from_deck scene_of(int dimension, double dip, double x, double z, bool graded,
                                        bool force)
{
    return scene_on(stiffer, dimension, dip, x, z, graded, force);
}

enum { FIELDS = 3 };

/* Under an even traction across the interface, one along it, or an even strain along it: displacement and its slopes
 * by x and z. */
static inline void two_rocks(const struct scene *scene, int field, double dip, const double place[2],
                             double shift[2], double slope[2][2])
{
    const double normal[2] = {-sin(dip), cos(dip)}, along[2] = {cos(dip), sin(dip)};
    const double depth = place[0] * normal[0] + (place[1] - 1) * normal[1];
    const double far = place[0] * along[0] + (place[1] - 1) * along[1];
    const struct material *rock = &scene->material[depth > 0];
    const double strain = field == 2,
                 across = ((field == 0) - rock->lambda * strain) / (rock->lambda + 2 * rock->mu);
    const double shear = (field == 1) / rock->mu;
    for (int i = 0; i < 2; i++) {
        shift[i] = across * depth * normal[i] + (strain * far + shear * depth) * along[i];
        for (int j = 0; j < 2; j++)
            slope[i][j] = across * normal[i] * normal[j] + (strain * along[j] + shear * normal[j]) * along[i];
    }
}

/* Control values between others that are kept, at rest. */
static inline void relax(struct consistent *c, double *u)
{
    const size_t n = c->model.unknowns;
    double *rest = calloc(n, sizeof *rest), *way = calloc(n, sizeof *way), *pull = calloc(n, sizeof *pull);
    bool *loose = calloc(n, sizeof *loose);
    double size = 0, first = 0;
    for (size_t i = 0; i < n; i++) {
        const size_t k = i % c->volume, at[3] = {k % c->n[0], k / c->n[0] % c->n[1], k / c->plane};
        loose[i] = true;
        for (int axis = 0; axis < c->dimension; axis++)
            loose[i] = loose[i] && at[c->slot[axis]] > 2 && at[c->slot[axis]] + 3 < c->n[c->slot[axis]];
    }
    general_forces(c, u, NULL, rest);
    for (size_t i = 0; i < n; i++) {
        way[i] = rest[i] = loose[i] ? rest[i] : 0;
        size += rest[i] * rest[i];
    }
    first = size;
    for (int step = 0; step < 2000 && size > 1e-16 * first; step++) {
        general_forces(c, way, NULL, pull);
        for (size_t i = 0; i < n; i++)
            pull[i] = loose[i] ? -pull[i] : 0;
        const double far = size / dot(n, way, pull);
        for (size_t i = 0; i < n; i++) {
            u[i] += far * way[i];
            rest[i] -= far * pull[i];
        }
        const double next = dot(n, rest, rest);
        for (size_t i = 0; i < n; i++)
            way[i] = rest[i] + next / size * way[i];
        size = next;
    }
    free(rest);
    free(way);
    free(pull);
    free(loose);
}

/* Control values of a field of two rocks, at rest; less an eighth of second differences of a graded lattice. */
static inline double *field_at_rest(const struct from_deck *deck, struct consistent *c, int field, double dip)
{
    const struct spline *depth = c->spline[c->dimension - 1];
    const double spacing = (depth->high - depth->low) / (double)depth->cells;
    double *u = calloc(c->model.unknowns, sizeof *u), shift[2], slope[2][2];
    for (size_t i = 0; i < c->volume; i++)
        for (int side = -1; side <= 1; side++) {
            const double zeta = depth->greville[i / c->plane] + side * spacing;
            const double place[2] = {c->spline[0]->greville[i % c->n[0]],
                                     grading_real(deck->scene->body.grading, zeta)};
            two_rocks(deck->scene, field, dip * M_PI / 180, place, shift, slope);
            u[i] += (side == 0 ? 1.25 : -.125) * shift[0];
            u[(size_t)(c->dimension - 1) * c->volume + i] += (side == 0 ? 1.25 : -.125) * shift[1];
        }
    relax(c, u);
    return u;
}

#endif
