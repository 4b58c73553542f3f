/* Layers softer than the rock on both sides and few spacings thick, by the general operator. */
#include "advice/parts.h"

#include "base/memory.h"
#include "scene/boundary.h"
#include "scene/resolution.h"

#include <math.h>

enum { A_SPACING = 8, MOST = 4000 };                 /* samples in a spacing and of a line */
static const double thickest = 4.5, source_near = 3; /* spacings; from the layer */

struct line {
    double mu[MOST], speed[MOST];
};

/* Soft layers on lines along depth, by ln(r) / p^2: r times the shear modulus is there on both sides, p points a
 * wavelength has the layer. The worst of all, the largest within some spacings of the line's place, and that which it
 * lies in. */
struct soft {
    double size, ratio, points, place[3], beside, within, here;
};

/* The largest of so many values from `from` on. */
static double largest(const double *value, int from, int n, int count)
{
    double most = 0;
    for (int i = from < 0 ? 0 : from; i < from + n && i < count; i++)
        most = fmax(most, value[i]);
    return most;
}

static int sample(const struct scene *scene, const double place[3], double low, double length,
                  struct line *line)
{
    const int count = (int)fmin(MOST, ceil(A_SPACING * length / scene->body.spacing));
    double there[3] = {place[0], place[1], place[2]};
    for (int i = 0; i < count; i++) {
        there[scene->dimension - 1] = low + (i + .5) * length / count;
        const struct rock rock = ground_at(scene, there);
        line->mu[i] = rock.mu;
        line->speed[i] = sqrt(rock.mu / rock.density);
    }
    return count;
}

/* The middle of a layer up to `thickest` thick has stiffer rock within half of that above and below. */
static void look_through(const struct scene *scene, const double place[3], struct line *line,
                         struct soft *soft)
{
    static const double slight = 2, alike = 1.1; /* softer ones err as the lattice does */
    const int axis = scene->dimension - 1;
    const double low = ground_low(&scene->body, axis), length = scene->body.high[axis] - low;
    const int count = sample(scene, place, low, length, line);
    const double step = length / count / scene->body.spacing; /* spacings */
    const int reach = (int)(thickest / 2 / step);
    const double points = points_per_wavelength(scene) / slowest_speed(scene);
    const double own = ground_at(scene, place).mu;
    soft->beside = soft->within = soft->here = 0;
    for (int i = 0; i < count; i++) {
        const double stiff =
            fmin(largest(line->mu, i - reach, reach, count), largest(line->mu, i + 1, reach, count));
        if (!(line->mu[i] > 0) || !(stiff > slight * line->mu[i])) continue;
        const double depth = low + (i + .5) * length / count, p = points * line->speed[i],
                     size = log(stiff / line->mu[i]) / (p * p),
                     away = fabs(depth - place[axis]) / scene->body.spacing - thickest / 2;
        if (away < source_near) soft->beside = fmax(soft->beside, size);
        if (away < 0) soft->within = fmax(soft->within, size);
        if (away < 0 && line->mu[i] > own / alike && line->mu[i] < own * alike)
            soft->here = fmax(soft->here, size);
        if (size <= soft->size) continue;
        soft->size = size;
        soft->ratio = stiff / line->mu[i];
        soft->points = p;
        for (int n = 0; n < 3; n++)
            soft->place[n] = n == axis ? depth : place[n];
    }
}

/* Does the layer slope by more than 15 degrees? */
static bool leans(const struct scene *scene, const struct soft *soft, struct line *line)
{
    static const double steep = .27, aside = 4; /* spacings */
    const int depth = scene->dimension - 1;
    bool found = false;
    for (int way = 0; way < 2 * depth && !found; way++) {
        struct soft there = {.size = 0};
        double place[3] = {soft->place[0], soft->place[1], soft->place[2]};
        place[way / 2] += (way % 2 == 0 ? -1 : 1) * aside * scene->body.spacing;
        look_through(scene, place, line, &there);
        found = there.size > 0 &&
                fabs(there.place[depth] - soft->place[depth]) > steep * aside * scene->body.spacing;
    }
    return found;
}

/* What a load beside a soft layer sends errs by, or one in it by what the layer guides, in parts of ln(r) / p^2. */
static double law_of(const struct load *load, bool guided)
{
    static const double of_forces[] = {1.1, 2.3}, of_moments[] = {3, 4.7};
    if (load->kind == LOAD_MOMENT_TENSOR) return of_moments[guided];
    return load->shape == LOAD_POINT ? of_forces[guided] : 0;
}

/* Lines through loads and receivers. Measured (regress/studies/blocks, `soft`): what comes by such a layer, what is
 * sent beside it, and what is seen in it (doc/theory/general-ground.md, section 7). */
void look_at_soft_layers(struct adviser *adviser)
{
    enum { LINES = 50 };
    static const double seen = .05, of_waves = .65, in_layer = .4, seen_aslant = .08, aslant = 4.3;
    const struct scene *scene = adviser->scene;
    const size_t places = scene->loads + scene->receivers, stride = 1 + places / LINES;
    struct soft soft = {.size = 0};
    double sent = 0, guided = 0, received = 0;
    if (scene_has_exact(scene) || !by_general_operator(scene) || !(points_per_wavelength(scene) > 0)) return;
    struct line *line = array_new(1, sizeof *line);
    for (size_t n = 0; n < places && line != NULL; n += stride) {
        const bool load = n < scene->loads;
        double place[3] = {0, 0, 0};
        ground_from_deck(&scene->body,
                         load ? scene->load[n].centre : scene->receiver[n - scene->loads].position, place);
        look_through(scene, place, line, &soft);
        if (!load) {
            received = fmax(received, in_layer * soft.within);
            continue;
        }
        sent = fmax(sent, law_of(&scene->load[n], false) * soft.beside);
        guided = fmax(guided, law_of(&scene->load[n], true) * soft.here);
    }
    const bool steep = line != NULL && soft.size > 0 && leans(scene, &soft, line);
    if (received > 0) sent = fmax(sent, guided);
    const double error = steep ? aslant * soft.size : fmax(sent, of_waves * soft.size) + received;
    array_free(line);
    if (!(error > (steep ? seen_aslant : seen))) return;
    advise(adviser,
           "about %c = %.3g rock %.3g times as soft as that above and below it is less than %.2g spacings "
           "thick: at %.3g points per wavelength in it velocities err by up to about %.2g; body%%spacing = "
           "%.3g%s would be right",
           "xyz"[scene->dimension - 1], soft.place[scene->dimension - 1], soft.ratio, thickest, soft.points,
           fmin(1, error), scene->body.spacing * sqrt(seen / error),
           ground_needs_general(scene) ? "" : " or method%operator = 'layered'");
}

/* The largest jump of the shear modulus within some spacings below the free surface. */
struct cover {
    double size, ratio, depth, points; /* ln(r) / p^2; spacings; p of the softer rock */
};

static void look_below(const struct scene *scene, const double place[3], struct line *line,
                       struct cover *cover)
{
    static const double deepest = 4;
    const double length = deepest * scene->body.spacing;
    const double points = points_per_wavelength(scene) / slowest_speed(scene);
    const int count = sample(scene, place, ground_surface(scene, place), length, line);
    for (int i = 1; i < count; i++) {
        const double r = exp(fabs(log(line->mu[i] / line->mu[i - 1]))),
                     p = points * fmin(line->speed[i], line->speed[i - 1]), size = log(r) / (p * p);
        if (size > cover->size) *cover = (struct cover){size, r, (double)i / A_SPACING, p};
    }
}

/* What a load sends errs by where the rock jumps below the surface, in parts of ln(r) / p^2. */
static double law_below(const struct scene *scene, const struct load *load, double depth)
{
    static const double of_waves = 2, of_force = 2.4,
                        of_moments[] = {6.3, 2.4}; /* within a spacing of it; deeper */
    if (load->kind == LOAD_MOMENT_TENSOR) return of_moments[depth > scene->body.spacing];
    return load->shape == LOAD_POINT ? of_force : of_waves;
}

/* Lines through loads and receivers. Measured (regress/studies/blocks, `cover` and `shallow`;
 * doc/theory/general-ground.md, section 7). */
void look_at_covers(struct adviser *adviser)
{
    enum { LINES = 50 };
    static const double seen = .07, of_waves = 2;
    const struct scene *scene = adviser->scene;
    const int axis = scene->dimension - 1;
    const size_t places = scene->loads + scene->receivers, stride = 1 + places / LINES;
    struct cover worst = {.size = 0};
    double error = 0;
    if (scene_has_exact(scene) || !by_general_operator(scene) || !(points_per_wavelength(scene) > 0) ||
        !boundary_is_free(&scene->boundary[2 * axis]))
        return;
    struct line *line = array_new(1, sizeof *line);
    for (size_t n = 0; n < places && line != NULL; n += stride) {
        const bool load = n < scene->loads;
        double place[3] = {0, 0, 0};
        struct cover cover = {.size = 0};
        ground_from_deck(&scene->body,
                         load ? scene->load[n].centre : scene->receiver[n - scene->loads].position, place);
        look_below(scene, place, line, &cover);
        const double depth = place[axis] - ground_surface(scene, place);
        const double here = (load ? law_below(scene, &scene->load[n], depth) : of_waves) * cover.size;
        if (here <= error) continue;
        error = here;
        worst = cover;
    }
    array_free(line);
    if (!(error > seen)) return;
    advise(adviser,
           "%.2g spacings below the surface the shear modulus jumps %.3g times: at %.3g points per "
           "wavelength in "
           "the softer rock velocities err by up to about %.2g; body%%spacing = %.3g%s would be right",
           worst.depth, worst.ratio, worst.points, fmin(1, error), scene->body.spacing * sqrt(seen / error),
           ground_needs_general(scene) ? "" : " or method%operator = 'layered'");
}
