/* What layers make of displacements long after a pulse (see the header).
 *
 * At the frequency s of a Laplace transform a layer of thickness L is one of L + c ln(1/R) / (2 (alpha + s)), (9). Of a
 * pulse's field comes back what goes by the factor exp(-s T - l s / (alpha + s)), T = (d + 2 L) / c, d the way over the
 * face, l = ln(1/R); in time, but for the pulse itself, exp(-l - alpha (t - T)) (l alpha / (t - T))^(1/2)
 * I_1(2 (l a)^(1/2)), a = alpha (t - T), of which
 *   G = l alpha exp(-(l^(1/2) - a^(1/2))^2) / (1 + 4 pi (l a)^(3/2))^(1/2),     a up to l,                   (18a)
 * is a bound: the saddle is s = alpha ((l / a)^(1/2) - 1), at least 1 / t. Of a pulse of duration D, its integral over
 * its largest value, whose field is spread as K_0(z), z = s T + l s / (alpha + s), in the plane, as 1 / X, X = c (T +
 * l / (alpha + s)), in space, comes back, of the largest displacement at the distance r, the sum over faces of
 *   3 D G (pi / (2 z))^(1/2) / arcosh(1 + c D / r) in the plane, D G r / (X^2 + r^2)^(1/2) in space,       (18b)
 * of moment tensors s r / (3 c) times as much, without the arcosh; 3 by measurement. In space the lattice of spacing h
 * sends back more, since where c / s is many cells it knows little of a stretched coordinate: of n points
 *   D (c / h)^2 n^-4 tau exp(-alpha tau) (h / Y) r / (Y^2 + r^2)^(1/2),   tau = t - d / c_s, up to 1 / alpha, (18c)
 * Y = c T, of moment tensors min(r, .3 c D) / Y times as much; as 1 / (alpha + s)^2, the rest by measurement
 * (regress/studies/late). */
#include "scene/late.h"

#include "scene/absorbing_layers.h"
#include "scene/echo.h"
#include "scene/ground.h"
#include "scene/guided.h"

#include <math.h>

static const double in_plane = 3, of_moments = 1. / 3;
static const double lattice_power = 4, of_near = .3;

/* From what acts, in the root mean square, to the farthest of what is looked at. */
static double apart(const struct scene *scene, const struct extent *acts, const struct extent *seen)
{
    double square = pow(scene->body.spacing, 2);
    for (int c = 0; c < scene->dimension; c++) {
        const double middle = (acts->low[c] + acts->high[c]) / 2, half = (acts->high[c] - acts->low[c]) / 2;
        square += pow(fmax(seen->high[c] - middle, middle - seen->low[c]), 2) + half * half / 3;
    }
    return sqrt(square);
}

/* How much farther from a face the mirror image of what is looked at lies; 0: no symmetry plane lies opposite. */
static double beyond(const struct scene *scene, int face, const struct extent *seen)
{
    const int axis = face / 2;
    const double mirror = face % 2 == 0 ? scene->body.high[axis] : scene->body.low[axis];
    const bool mirrors = boundary_mirrors(&scene->boundary[face ^ 1]);
    return mirrors ? fabs(seen->low[axis] + seen->high[axis] - 2 * mirror) : 0;
}

/* Of one rock, not damped (all that was measured), and not between faces that guide, where no field is that of a point.
 */
static bool is_open(const struct scene *scene)
{
    const struct body *body = &scene->body;
    const bool model = scene->deck != NULL && deck_count(scene->deck, "model") > 0;
    bool open = scene->dimension > 1 && body_is_box(body) && body->layers == 0 && body->blocks == 0 &&
                !model && body->topography == NULL && body->line == NULL && !ground_is_damped(scene);
    for (int axis = 0; axis < scene->dimension; axis++)
        open = open && !faces_guide(scene, axis);
    return open;
}

struct lates late_worst(const struct scene *scene, int face)
{
    const bool open = is_open(scene);
    struct extent acts, seen;
    struct lates lates = {0};
    for (size_t k = 0; open && scene_extent(scene, k, &acts); k++) {
        if (acts.role != EXTENT_ACTS || !(acts.lasts > 0) || isinf(acts.low[0])) continue;
        struct late *worst = acts.dipole ? &lates.of_dipole : &lates.of_force;
        for (size_t i = 0; scene_extent(scene, i, &seen); i++) {
            if (seen.role != EXTENT_SEEN || isinf(seen.low[0])) continue;
            const double way = echo_way(scene, face, &acts, &seen), image = way + beyond(scene, face, &seen);
            worst->image = worst->lasts > 0 ? fmin(worst->image, image) : image;
            worst->way = worst->lasts > 0 ? fmin(worst->way, way) : way;
            worst->lasts = fmax(worst->lasts, acts.lasts);
            worst->time = fmax(worst->time, fmin(seen.until, scene->end_time) - acts.middle);
            worst->apart = fmax(worst->apart, apart(scene, &acts, &seen));
        }
    }
    return lates;
}

/* A layer as what is late sees it: l, alpha and T. */
struct seen_late {
    double stretch, alpha, first;
};

/* What an image at this distance is beside what acts, in space. */
static double of_image(const struct late *late, double distance)
{
    return late->apart / hypot(distance, late->apart);
}

/* (18b) at the time alpha (t - T) = a. */
static double at_time(const struct scene *scene, const struct late *late, bool dipole,
                      const struct seen_late *layer, double a)
{
    const double c = scene_fastest(scene), l = layer->stretch, alpha = layer->alpha, first = layer->first;
    const double s = fmax(alpha * (sqrt(l / fmax(a, 1 / l)) - 1), 1 / (first + a / alpha));
    const double g = l * alpha * exp(-pow(sqrt(l) - sqrt(a), 2)) / sqrt(1 + 4 * M_PI * pow(l * a, 1.5));
    const double part = late->lasts * g * (dipole ? of_moments * s * late->apart / c : 1);
    if (scene->dimension == 3) return part * of_image(late, c * (first + l / (alpha + s)));
    const double z = s * first + l * s / (alpha + s);
    return in_plane * part * sqrt(M_PI / (2 * z)) / (dipole ? 1 : acosh(1 + c * late->lasts / late->apart));
}

/* (18c) of so many points. */
static double by_lattice(const struct scene *scene, int face, const struct late *late, bool dipole,
                         const struct seen_late *layer, double points)
{
    const double c = scene_fastest(scene), way = c * layer->first, h = layer_spacing(scene, face);
    const double tau =
        fmin(1 / layer->alpha, late->time - late->way / scene->material[scene->body.material].s_speed);
    if (scene->dimension < 3 || tau <= 0) return 0;
    return late->lasts * pow(c, 2) / (h * way) * pow(points, -lattice_power) * tau *
           exp(-layer->alpha * tau) * of_image(late, way) *
           (dipole ? fmin(late->apart, of_near * c * late->lasts) / way : 1);
}

/* At the end, since it grows; what comes back early is that of (15). (18c) where the lattice is asked for. */
static double of_worst(const struct scene *scene, int face, const struct late *late, bool dipole,
                       size_t points, bool lattice)
{
    const double n = fmax(1, (double)points), c = scene_fastest(scene),
                 thick = n * layer_spacing(scene, face);
    const struct seen_late layer = {layer_stretch(scene, face, points), LAYER_RELAXATION * c / thick,
                                    (late->way + 2 * thick) / c};
    const double last = fmin(layer.stretch, layer.alpha * (late->time - layer.first));
    if (!(late->lasts > 0)) return 0;
    return (last > 0 ? at_time(scene, late, dipole, &layer, last) : 0) +
           (lattice ? by_lattice(scene, face, late, dipole, &layer, n) : 0);
}

static double of_face(const struct scene *scene, int face, const struct lates *lates, size_t points,
                      bool lattice)
{
    const struct late *force = &lates->of_force, *dipole = &lates->of_dipole;
    double sum = of_worst(scene, face, force, false, points, lattice) +
                 of_worst(scene, face, dipole, true, points, lattice);
    if (boundary_mirrors(&scene->boundary[face ^ 1])) {
        struct late force_image = *force, dipole_image = *dipole;
        force_image.way = force->image, dipole_image.way = dipole->image;
        sum += of_worst(scene, face, &force_image, false, points, lattice) +
               of_worst(scene, face, &dipole_image, true, points, lattice);
    }
    return sum;
}

double late_of_points(const struct scene *scene, int face, const struct lates *lates, size_t points)
{
    return of_face(scene, face, lates, points, false);
}

/* Of layers as they are, or of at least so many points each. */
static double of_all(const struct scene *scene, size_t least)
{
    double sum = 0;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const size_t points = layer_points(scene, face);
        const struct lates lates = late_worst(scene, face);
        if (points > 0) sum += of_face(scene, face, &lates, points > least ? points : least, true);
    }
    return fmin(1, sum);
}

double late_error(const struct scene *scene)
{
    return of_all(scene, 0);
}

long late_points(const struct scene *scene)
{
    for (size_t points = LEAST_POINTS; points <= MOST_POINTS; points++)
        if (of_all(scene, points) < LATE_TOLD) return (long)points;
    return 0;
}
