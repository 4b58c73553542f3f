/* Slender bodies of few points across, which bend too softly (doc/theory/sph-total-lagrangian.md, Eqs 3b to 3d). */
#include "advice/parts.h"

#include "method/methods.h"
#include "scene/initial.h"
#include "scene/resolution.h"

#include <math.h>

/* From so many times as long as thick on a body is a beam or a plate. */
#define SLENDER 2.0

/* It bends along `along`, moving in the component `across`. */
struct bending {
    const struct scene *scene;
    int along, across;
};

static double edge(const struct scene *scene, int axis)
{
    return scene->body.high[axis] - scene->body.low[axis];
}

static bool holds(const struct scene *scene, int axis, int component)
{
    return face_holds(scene, (enum face)(2 * axis), component) ||
           face_holds(scene, (enum face)(2 * axis + 1), component);
}

static bool absorbs(const struct scene *scene, int axis)
{
    return boundary_absorbs(&scene->boundary[2 * axis]) || boundary_absorbs(&scene->boundary[2 * axis + 1]);
}

/* omega = root sqrt(E I / (rho A)) / L^2 of a beam whose ends are free, guided (no turning), pinned, clamped. */
static double lowest_root(const struct bending *bending)
{
    static const double root[4][4] = {{22.37, 5.593, 15.42, 3.516},
                                      {5.593, 9.870, 2.467, 5.593},
                                      {15.42, 2.467, 9.870, 15.42},
                                      {3.516, 5.593, 15.42, 22.37}};
    int end[2];
    for (int high = 0; high < 2; high++) {
        const enum face face = (enum face)(2 * bending->along + high);
        end[high] = 2 * face_holds(bending->scene, face, bending->across) +
                    face_holds(bending->scene, face, bending->along);
    }
    return root[end[0]][end[1]];
}

/* Could it bend so, and how far apart are those that hold it? */
static bool slender(const struct bending *bending)
{
    const struct scene *scene = bending->scene;
    return bending->along != bending->across &&
           edge(scene, bending->along) > SLENDER * edge(scene, bending->across) &&
           !holds(scene, bending->across, bending->across) && !absorbs(scene, bending->across) &&
           !absorbs(scene, bending->along);
}

/* What acts alike along the body bends it where it is held. */
static bool load_bends(const struct bending *bending, const struct load *load)
{
    const bool force = load->kind == LOAD_BODY_FORCE, whole = load->shape == LOAD_FACE;
    const bool on_side = !force && face_axis(load->face) == bending->across;
    double own[3];
    if (load->amplitude == 0 || load->kind == LOAD_MOMENT_TENSOR) return false;
    body_direction_from_deck(&bending->scene->body, load->direction, own);
    if (on_side && fabs(own[bending->along]) > 1e-9) return true;
    const bool alike = whole && (force || face_axis(load->face) != bending->along);
    return fabs(own[bending->across]) > 1e-9 &&
           (!alike || holds(bending->scene, bending->along, bending->across));
}

static bool face_bends(const struct bending *bending)
{
    for (int face = 2 * bending->along; face < 2 * bending->along + 2; face++) {
        const struct boundary *boundary = &bending->scene->boundary[face];
        double own[3];
        body_direction_from_deck(&bending->scene->body, boundary->direction, own);
        if (boundary_acts(boundary) && fabs(own[bending->across]) > 1e-9) return true;
    }
    return false;
}

static bool loads_bend(const struct bending *bending)
{
    for (size_t k = 0; k < bending->scene->loads; k++)
        if (load_bends(bending, &bending->scene->load[k])) return true;
    return false;
}

static bool start_bends(const struct bending *bending)
{
    const struct initial *initial = &bending->scene->initial;
    double own[3];
    body_direction_from_deck(&bending->scene->body, initial->velocity, own);
    return (initial->kind == INITIAL_BEAM_MODE && bending->across == 1) ||
           (initial->kind == INITIAL_UNIFORM_VELOCITY && fabs(own[bending->across]) > 1e-9 &&
            holds(bending->scene, bending->along, bending->across));
}

/* Square of the wave number of a frequency (3c); stiff2 = E / rho h^2 / 12 of the softest material, shear = E h^2 /
 * (12 kappa mu). */
static double number_squared(double omega, double stiff2, double shear)
{
    const double square = omega * omega;
    return (square * shear + sqrt(square * square * shear * shear + 4 * stiff2 * square)) / (2 * stiff2);
}

/* What velocities err by at end_time (3d). */
static double error_of_bending(const struct bending *bending, double softer)
{
    static const double kappa = 5. / 6, counts = 1e-3;
    const struct scene *scene = bending->scene;
    const double span = edge(scene, bending->along), thick = edge(scene, bending->across);
    double stiff2 = INFINITY, shear = 0;
    for (size_t m = 0; m < scene->materials; m++) {
        const struct material *material = &scene->material[m];
        const double ratio = pow(material->s_speed / material->p_speed, 2);
        const double square = 4 * pow(material->s_speed, 2) * (1 - ratio) * thick * thick / 12;
        if (square < stiff2) shear = (1 - ratio) * thick * thick / (3 * kappa);
        stiff2 = fmin(stiff2, square);
    }
    const double number = lowest_root(bending) / (span * span);
    const double lowest = number * sqrt(stiff2 / (1 + shear * number));
    const bool loads = loads_bend(bending), face = face_bends(bending), start = start_bends(bending);
    if (!loads && !face && !start) return 0;
    if (!start && lowest > source_cutoff_at(scene, counts))
        return loads ? 2 * softer / (1 + shear * number) : 0;
    const double omega = fmax(lowest, face    ? typical_frequency(scene)
                                      : loads ? typical_frequency(scene) / 2
                                              : 0);
    const double time = scene->end_time - (start ? 0 : sending_begins(scene));
    return omega * time * softer / (1 + shear * number_squared(omega, stiff2, shear));
}

struct found {
    double error, points;
    int axis;
};

static void tell_of_bending(struct adviser *adviser, const struct wave_law *law, struct found found)
{
    static const double quadratic = .5; /* (3b), of order 2 */
    const struct scene *scene = adviser->scene;
    const bool splines = method_takes(method_find("smoothed-point", "consistent"), scene);
    const bool gradient =
        law->bends_order == 2 && law->bends > 1 && found.error * quadratic / law->bends < WAVES_SEEN;
    advise(
        adviser,
        "bending of a body only %.3g points thick along %c%s, which is too soft: velocities may err by up to "
        "about %.2g by end_time; %s%.0f points%s would be right",
        found.points, "xyz"[found.axis], own_axes(&scene->body), fmin(1, found.error),
        gradient ? "method%gradient = 'quadratic', or " : "",
        ceil(found.points * pow(found.error / (WAVES_SEEN / 2), 1 / law->bends_order)),
        splines ? ", or method%name = 'smoothed-point', variant = 'consistent'," : "");
}

void look_at_bending(struct adviser *adviser, const struct model *model, double told)
{
    const struct scene *scene = adviser->scene;
    const struct wave_law *law = &model->waves;
    double worst = 0, points = 0;
    int axis = 0;
    if (!(law->bends > 0)) return;
    for (int across = 0; across < scene->dimension; across++)
        for (int along = 0; along < scene->dimension; along++) {
            const struct bending bending = {scene, along, across};
            if (!slender(&bending)) continue;
            const double n = edge(scene, across) / scene->body.spacing;
            const double error = error_of_bending(&bending, law->bends / pow(n, law->bends_order));
            if (!(error > worst)) continue;
            worst = error;
            points = n;
            axis = across;
        }
    if (!(fmin(1, worst) > told)) return;
    tell_of_bending(adviser, law, (struct found){worst, points, axis});
}
