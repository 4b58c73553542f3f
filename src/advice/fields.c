/* Stresses, pressures and energies where the rock jumps. */
#include "advice/parts.h"

#include "scene/resolution.h"
#include "scene/topography.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool by_law(unsigned fields)
{
    return (fields & (1U << SELAS_STRESS | 1U << SELAS_PRESSURE | 1U << SELAS_ENERGY)) != 0;
}

/* Within a spacing of a jump. */
static bool at_jump(const struct scene *scene, const double position[3])
{
    double place[3] = {0, 0, 0};
    ground_from_deck(&scene->body, position, place);
    const double spacing = spacing_at(scene, position);
    for (int axis = 0; axis < scene->dimension; axis++)
        if (jumps_on(scene, place, axis, place[axis] - spacing, place[axis] + spacing, NULL, NULL))
            return true;
    return false;
}

/* Is the material's law that of the place, and the strain smooth across the rock's jumps but where that is mended? */
static bool has_places_law(const struct scene *scene)
{
    return strcmp(scene->method.variant, "consistent") == 0
               ? by_general_operator(scene)
               : strcmp(scene->method.variant, "total-lagrangian") == 0;
}

bool advice_smooth_strain(const struct scene *scene, const double position[3], selas_field field)
{
    return by_law(1U << field) && has_places_law(scene) && at_jump(scene, position);
}

enum { WIDE = 3, PARTS = 2, FAR = WIDE * PARTS }; /* spacings; places in one */

/* Is the rock about a place that of the line along `normal` through it, but for a twentieth? */
static bool varies_along(const struct scene *scene, const double centre[3], double spacing,
                         const double normal[3])
{
    static const double most = .05;
    const int beside = scene->dimension == 2 ? 0 : FAR;
    size_t other = 0, all = 0;
    for (int k = -beside; k <= beside; k++)
        for (int j = -FAR; j <= FAR; j++)
            for (int i = -FAR; i <= FAR; i++, all++) {
                const double step[3] = {i * spacing / PARTS, j * spacing / PARTS, k * spacing / PARTS};
                const double along = step[0] * normal[0] + step[1] * normal[1] + step[2] * normal[2];
                double place[3], line[3];
                for (int axis = 0; axis < 3; axis++) {
                    place[axis] = centre[axis] + step[axis];
                    line[axis] = centre[axis] + along * normal[axis];
                }
                other += rocks_differ(ground_at(scene, place), ground_at(scene, line));
            }
    return (double)other <= most * (double)all;
}

/* Does a symmetry plane across the axis lie within twelve spacings? */
static bool mirror_near(const struct scene *scene, const double centre[3], double spacing, int axis)
{
    const double near = 12 * spacing;
    return (boundary_mirrors(&scene->boundary[2 * axis]) && centre[axis] - scene->body.low[axis] < near) ||
           (boundary_mirrors(&scene->boundary[2 * axis + 1]) && scene->body.high[axis] - centre[axis] < near);
}

/* Where log M rises to about a place, from its first moment in a ball of WIDE spacings; false: nowhere. */
static bool rises(const struct scene *scene, const double centre[3], double spacing, double normal[3])
{
    static const double slight = 1e-9;
    double sum[3] = {0, 0, 0};
    for (int k = -FAR; k <= FAR; k++)
        for (int j = -FAR; j <= FAR; j++)
            for (int i = -FAR; i <= FAR; i++) {
                const double step[3] = {i, j, k};
                double place[3];
                if (i * i + j * j + k * k > FAR * FAR) continue;
                for (int axis = 0; axis < 3; axis++)
                    place[axis] = centre[axis] + step[axis] * spacing / PARTS;
                const struct rock rock = ground_at(scene, place);
                for (int axis = 0; axis < 3; axis++)
                    sum[axis] += step[axis] * log(rock.lambda + 2 * rock.mu);
            }
    const double length = hypot(hypot(sum[0], sum[1]), sum[2]);
    for (int axis = 0; axis < 3; axis++)
        normal[axis] = length > slight ? sum[axis] / length : 0;
    return length > slight;
}

/* Are strains read as the moment tensors of (G25) act there: across one surface about the place (general/kink.c)? */
enum reading { SMOOTH, ACROSS, ASLANT }; /* in space: not along the lattice, without (G29) */
static enum reading read_across(const struct scene *scene, const double position[3])
{
    enum { DIRECTIONS = 90 };
    const double spacing = spacing_at(scene, position);
    double centre[3] = {0, 0, 0}, rise[3] = {0, 0, 0};
    ground_from_deck(&scene->body, position, centre);
    const bool plane = scene->dimension == 2;
    if (!plane && scene->body.topography != NULL) return SMOOTH;
    for (int n = 0; n < (plane ? DIRECTIONS : 4); n++) {
        const double angle = n * M_PI / DIRECTIONS;
        double normal[3] = {plane ? cos(angle) : n == 0, plane ? sin(angle) : n == 1, !plane && n == 2};
        const bool aslant = !plane && n == 3;
        if (aslant && !rises(scene, centre, spacing, rise)) break;
        if (aslant) memcpy(normal, rise, sizeof normal);
        int axis = 0;
        for (int other = 1; other < 3 && other < scene->dimension; other++)
            if (fabs(normal[other]) >= fabs(normal[axis])) axis = other;
        if (varies_along(scene, centre, spacing, normal) && !mirror_near(scene, centre, spacing, axis))
            return aslant ? ASLANT : ACROSS;
    }
    return SMOOTH;
}

/* How many times the shear modulus differs from that of a place within a spacing along the axes, at most. */
static double jump_about(const struct scene *scene, const double centre[3], double spacing)
{
    enum { STEPS = 4 };
    const double step = spacing / STEPS, here = ground_at(scene, centre).mu;
    double most = 1;
    for (int axis = 0; axis < scene->dimension; axis++)
        for (int n = -STEPS; n <= STEPS; n++) {
            double place[3] = {centre[0], centre[1], centre[2]};
            place[axis] += n * step;
            const double mu = ground_at(scene, place).mu;
            most = fmax(most, fmax(mu / here, here / mu));
        }
    return most;
}

/* How many times it does where a profile reads strains across jumps, and what these err by in parts of 1/p^2; INFINITY:
 * it has smooth ones at some of them. In the plane they erred by at most 1.24 (r - 1) / p^2 (regress/studies/blocks
 * BUILD stresses), aslant in space by 2.9 (space). */
static double jump_of(const struct scene *scene, const struct profile *profile, bool reads, double *law)
{
    static const double of_one = 1.3, of_aslant = 3.3;
    double most = 1;
    for (size_t i = 0; i < profile->points && by_law(profile->fields); i++) {
        double position[3], centre[3] = {0, 0, 0};
        profile_position(profile, i, position);
        if (!at_jump(scene, position)) continue;
        const enum reading reading = reads ? read_across(scene, position) : SMOOTH;
        if (reading == SMOOTH) return INFINITY;
        ground_from_deck(&scene->body, position, centre);
        const double times = jump_about(scene, centre, spacing_at(scene, position));
        most = fmax(most, times);
        *law = fmax(*law, (reading == ASLANT ? of_aslant : of_one) * (times - 1));
    }
    return most;
}

/* A box of the lattice, as a snapshot's region is, and the most that the shear modulus jumps by in it. */
struct part {
    double low[3], high[3], *most;
};

/* Goes on to the next jump. */
static bool part_sees(const struct scene *scene, const void *of, const double place[3])
{
    const struct part *part = of;
    double lattice[3] = {place[0], place[1], place[2]};
    if (scene->body.topography != NULL) topography_to_lattice(scene->body.topography, lattice);
    for (int axis = 0; axis < 3 && axis < scene->dimension; axis++)
        if (lattice[axis] < part->low[axis] || lattice[axis] > part->high[axis]) return false;
    *part->most = fmax(*part->most, jump_about(scene, place, scene->body.spacing));
    return false;
}

void snapshot_box(const struct scene *scene, const struct snapshot *snapshot, double low[3], double high[3])
{
    double one[3], other[3];
    ground_from_deck(&scene->body, snapshot->region_low, one);
    ground_from_deck(&scene->body, snapshot->region_high, other);
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double least = fmin(one[axis], other[axis]) - scene->body.spacing,
                     most = fmax(one[axis], other[axis]) + scene->body.spacing;
        low[axis] = snapshot->whole ? scene->body.low[axis] : fmax(least, scene->body.low[axis]);
        high[axis] = snapshot->whole ? scene->body.high[axis] : fmin(most, scene->body.high[axis]);
    }
}

/* How many times the shear modulus differs where the rock jumps within a spacing of its places, at most; 0: it does
 * not. */
static double jump_in(const struct scene *scene, const struct snapshot *snapshot)
{
    double most = 0;
    struct part part = {.most = &most};
    snapshot_box(scene, snapshot, part.low, part.high);
    if (by_law(snapshot->fields)) jumps_in(scene, part.low, part.high, part_sees, &part);
    return most;
}

/* What stresses read across rocks that differ so many times err by, in parts of `law` over p^2. */
static bool told_of_contrast(struct adviser *adviser, const char *what, double law, double times)
{
    static const double seen = .1;
    const struct scene *scene = adviser->scene;
    const double points = points_per_wavelength(scene), error = law / (points * points);
    if (!(points > 0) || isinf(times) || !(error > seen)) return false;
    advise(adviser,
           "%s has stress, pressure or energy across rocks of %.3g times the shear modulus: at "
           "%.3g points per wavelength they err by up to about %.2g within three spacings of that; "
           "body%%spacing = %.3g would be right",
           what, times, points, fmin(1, error), scene->body.spacing * sqrt(seen / 2 / error));
    return true;
}

/* In the plane snapshots err by at most 6.1 ln(r) / p^2, at corners of blocks by 10.4 (regress/studies/blocks BUILD
 * snapshots). */
static double law_of_snapshot(const struct scene *scene, double times)
{
    return (scene->body.blocks > 0 || scene->body.model != NULL ? 11 : 6.2) * log(fmax(times, 1));
}

/* A place's rock, where pressures err more than elsewhere: by M / mu over the square of its points a wavelength. */
static void look_there(const struct scene *scene, const double place[3], struct rock *worst)
{
    const struct rock rock = ground_at(scene, place);
    const double here = (rock.lambda + 2 * rock.mu) / (rock.mu * rock.mu) * rock.density,
                 there = (worst->lambda + 2 * worst->mu) / (worst->mu * worst->mu) * worst->density;
    if (worst->mu == 0 || here > there) *worst = rock;
}

static struct rock worst_on(const struct scene *scene, const struct profile *profile)
{
    struct rock worst = {0};
    for (size_t i = 0; i < profile->points; i++) {
        double position[3], place[3] = {0, 0, 0};
        profile_position(profile, i, position);
        ground_from_deck(&scene->body, position, place);
        look_there(scene, place, &worst);
    }
    return worst;
}

static struct rock worst_in(const struct scene *scene, const struct snapshot *snapshot)
{
    enum { LOOKS = 33, BESIDE = 9 };
    const struct topography *topography = scene->body.topography;
    const int down = scene->dimension - 1;
    struct rock worst = {0};
    double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    snapshot_box(scene, snapshot, low, high);
    for (int n = 0; n < LOOKS * BESIDE * BESIDE; n++) {
        const int step[2] = {n / LOOKS % BESIDE, n / LOOKS / BESIDE};
        double place[3] = {0, 0, 0};
        for (int axis = 0; axis < 2 && axis < down; axis++)
            place[axis] = low[axis] + step[axis] * (high[axis] - low[axis]) / (BESIDE - 1);
        place[down] = low[down] + n % LOOKS * (high[down] - low[down]) / (LOOKS - 1);
        if (topography != NULL)
            place[down] = topography_real(topography, topography_drop(topography, place), place[down]);
        look_there(scene, place, &worst);
    }
    return worst;
}

/* A pressure is M tr(strain): errors of the strain stand in it times M / mu. Measured in the plane, in even ground
 * (regress/studies/blocks BUILD pressures). */
static bool told_of_pressure(struct adviser *adviser, const char *what, const struct rock rock)
{
    static const double seen = .1, law = .45;
    const struct scene *scene = adviser->scene;
    const double lambda = rock.lambda, mu = rock.mu;
    const double points = points_per_wavelength(scene) * sqrt(mu / rock.density) / slowest_speed(scene),
                 error = law * (lambda + 2 * mu) / mu / (points * points);
    if (!(lambda > 2 * mu) || !(points > 0) || !(error > seen)) return false;
    advise(adviser,
           "%s has stress or pressure in rock of nu = %.3g, which resists changes of volume so much that "
           "what strains "
           "err by, %.3g points a wavelength, makes stresses err by up to about %.2g; body%%spacing = %.3g "
           "would be "
           "right",
           what, lambda / (2 * (lambda + mu)), points, fmin(1, error),
           scene->body.spacing * sqrt(seen / 2 / error));
    return true;
}

/* Stresses of the splines in rock that is nearly incompressible. */
void look_at_pressures(struct adviser *adviser)
{
    static const unsigned asked = 1U << SELAS_STRESS | 1U << SELAS_PRESSURE;
    const struct scene *scene = adviser->scene;
    bool told = strcmp(scene->method.variant, "consistent") != 0 || scene->dimension == 1 ||
                (scene->dimension == 2 && scene->plane == PLANE_STRESS);
    char what[NAME_SIZE + 16];
    for (size_t i = 0; i < scene->profiles && !told; i++) {
        snprintf(what, sizeof what, "profile '%s'", scene->profile[i].name);
        told = (scene->profile[i].fields & asked) != 0 &&
               told_of_pressure(adviser, what, worst_on(scene, &scene->profile[i]));
    }
    for (size_t i = 0; i < scene->snapshots && !told; i++) {
        snprintf(what, sizeof what, "&snapshot %zu", i + 1);
        told = (scene->snapshot[i].fields & asked) != 0 &&
               told_of_pressure(adviser, what, worst_in(scene, &scene->snapshot[i]));
    }
}

/* Strains of particles, and of profiles in the general operator's ground but across one surface, are smooth where the
 * rock jumps, so that moduli of the place make of them stresses that are not there (doc/theory/general-ground.md). */
void look_at_fields(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    const bool consistent = strcmp(scene->method.variant, "consistent") == 0;
    bool told = false, shown = false;
    char what[NAME_SIZE + 16] = "", name[sizeof what];
    if (!has_places_law(scene)) return;
    for (size_t i = 0; i < scene->profiles; i++) {
        double law = 0;
        const double times = jump_of(scene, &scene->profile[i], consistent, &law);
        snprintf(name, sizeof name, "profile '%s'", scene->profile[i].name);
        if (isinf(times) && what[0] == '\0') memcpy(what, name, sizeof what);
        told = told || told_of_contrast(adviser, name, law, times);
    }
    for (size_t i = 0; i < scene->snapshots; i++) {
        const double times = jump_in(scene, &scene->snapshot[i]);
        snprintf(name, sizeof name, "&snapshot %zu", i + 1);
        if (!consistent && times > 0 && what[0] == '\0') memcpy(what, name, sizeof what);
        shown =
            shown || (consistent && told_of_contrast(adviser, name, law_of_snapshot(scene, times), times));
    }
    if (what[0] == '\0') return;
    advise(adviser,
           "%s has stress, pressure or energy within a spacing of where the rock jumps: they are those of a "
           "strain that is smooth there, and wrong by up to the ratio of the moduli, whatever the spacing; "
           "places two spacings off%s would do",
           what, consistent && !ground_needs_general(scene) ? ", or method%operator = 'layered'," : "");
}
