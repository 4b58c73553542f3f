/* Where the rock jumps, what the splines or particles carry smoothly does not: states at t = 0 that lie across it,
 * weights, walls. */
#include "advice/parts.h"

#include "base/memory.h"
#include "scene/initial.h"
#include "scene/resolution.h"
#include "scene/topography.h"

#include <math.h>
#include <string.h>

/* --- Jumps -------------------------------------------------------------------------------------------- */

bool rocks_differ(const struct rock one, const struct rock other)
{
    static const double slight = .05;
    const double axial[] = {one.lambda + 2 * one.mu, other.lambda + 2 * other.mu};
    return fabs(axial[1] - axial[0]) > slight * fmin(axial[0], axial[1]) ||
           fabs(other.mu - one.mu) > slight * fmin(one.mu, other.mu);
}

/* Do moduli differ on either side of a place? */
static bool differs(const struct scene *scene, const double place[3], int axis, double aside)
{
    double low[3] = {place[0], place[1], place[2]}, high[3] = {place[0], place[1], place[2]};
    low[axis] -= aside;
    high[axis] += aside;
    return rocks_differ(ground_at(scene, low), ground_at(scene, high));
}

bool jumps_on(const struct scene *scene, const double place[3], int axis, double from, double to,
              jump_counts *counts, const void *of)
{
    double *at = array_new(ground_jumps_at_most(scene) + 1, sizeof *at);
    bool found = false;
    if (at == NULL) return false; /* advice can be done without */
    const size_t count = ground_jumps(scene, place, axis, from, to, at);
    for (size_t i = 0; i < count && !found; i++) {
        double there[3] = {place[0], place[1], place[2]};
        there[axis] = at[i];
        found = differs(scene, there, axis, 1e-6 * scene->body.spacing) &&
                (counts == NULL || counts(scene, of, there));
    }
    array_free(at);
    return found;
}

/* A coordinate of the lattice in the column of `place`, in the ground. */
static double real(const struct scene *scene, const double place[3], int axis, double lattice)
{
    const struct topography *topography = scene->body.topography;
    if (topography == NULL || axis != topography->axis) return lattice;
    return topography_real(topography, topography_drop(topography, place), lattice);
}

/* The middle of what a box holds of a block; of an ellipsoid what lies nearest to its own. */
static bool middle_of(const struct scene *scene, const struct ground_block *block, const double low[3],
                      const double high[3], double middle[3])
{
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double centre = block->centre[axis], half = block->half[axis];
        const double from = fmax(real(scene, middle, axis, low[axis]), centre - half),
                     to = fmin(real(scene, middle, axis, high[axis]), centre + half);
        if (from >= to) return false;
        middle[axis] = block->shape == BLOCK_BOX ? (from + to) / 2 : fmin(fmax(from, centre), to);
    }
    return true;
}

bool jumps_in(const struct scene *scene, const double low[3], const double high[3], jump_counts *counts,
              const void *of)
{
    enum { LINES = 9 };
    const size_t blocks = scene->body.blocks;
    for (int axis = 0; axis < scene->dimension; axis++) {
        const int one = (axis + 1) % 3, other = (axis + 2) % 3, down = scene->dimension - 1;
        for (size_t line = 0; line < LINES * LINES + blocks; line++) {
            const size_t i = line % LINES, j = line / LINES;
            double place[3] = {low[0], low[1], low[2]};
            if (line >= LINES * LINES) {
                if (!middle_of(scene, &scene->body.block[line - LINES * LINES], low, high, place)) continue;
            } else {
                if ((one >= scene->dimension && i > 0) || (other >= scene->dimension && j > 0)) continue;
                place[axis] = (low[axis] + high[axis]) / 2;
                place[one] += (high[one] - low[one]) * ((double)i + .5) / LINES;
                place[other] += (high[other] - low[other]) * ((double)j + .5) / LINES;
                place[down] = real(scene, place, down, place[down]);
            }
            if (jumps_on(scene, place, axis, real(scene, place, axis, low[axis]),
                         real(scene, place, axis, high[axis]), counts, of))
                return true;
        }
    }
    return false;
}

/* --- States at t = 0 ------------------------------------------------------------------------------------ */

/* The worst of what a state errs by at the jumps that it lies across. */
struct crossing {
    double speed[2]; /* of its own rock */
    double *error;
};

/* The largest strain of the state so many widths from its middle and more, in parts of the largest. */
static double strain_at(const struct initial *initial, double widths)
{
    return initial->wavelength > 0 || widths < 1 ? 1 : widths * exp((1 - widths * widths) / 2);
}

/* Where moduli jump by dM a state of strain e begins with a traction of dM e that jumps, which sends a front of
 * dM e / (Z + Z') either way, beside velocities of c e: of fronts of all wavelengths (h/w)^(1/2) is wrong. */
static bool crosses(const struct scene *scene, const void *of, const double place[3])
{
    static const double front = 1.8; /* by measurement (doc/theory/initial-states.md, Eq 3b) */
    const struct crossing *crossing = of;
    const struct initial *initial = &scene->initial;
    const double width = initial->wavelength > 0 ? initial->wavelength / (2 * M_PI) : initial->width;
    const double h = scene->body.spacing;
    double centre[3] = {0}, direction[3] = {0}, along = 0, square = 0, jump = 0;
    ground_from_deck(&scene->body, initial->centre, centre);
    body_direction_from_deck(&scene->body, initial->direction, direction);
    for (int axis = 0; axis < scene->dimension; axis++) {
        along += direction[axis] * (place[axis] - centre[axis]);
        square += pow(place[axis] - centre[axis], 2);
        double there[2][3], axial[2], shear[2], impedance[2] = {0, 0};
        for (int side = 0; side < 2; side++) {
            memcpy(there[side], place, sizeof there[side]);
            there[side][axis] += (side == 0 ? -1e-6 : 1e-6) * h;
            const struct rock rock = ground_at(scene, there[side]);
            axial[side] = rock.lambda + 2 * rock.mu;
            shear[side] = rock.mu;
            impedance[0] += sqrt(axial[side] * rock.density);
            impedance[1] += sqrt(shear[side] * rock.density);
        }
        jump = fmax(jump, fabs(axial[1] - axial[0]) / (impedance[0] * crossing->speed[0]));
        jump = fmax(jump, fabs(shear[1] - shear[0]) / (impedance[1] * crossing->speed[1]));
    }
    const double away = initial->kind == INITIAL_PLANE_WAVE ? fabs(along) : sqrt(square);
    const double strain = strain_at(initial, fmax(0, away - h) / width);
    *crossing->error = fmax(*crossing->error, front * jump * sqrt(fmin(1, h / width)) * strain);
    return false; /* all count */
}

void look_at_crossed_rock(struct adviser *adviser)
{
    static const double seen = .02;
    const struct scene *scene = adviser->scene;
    const struct initial *initial = &scene->initial;
    double low[3] = {0, 0, 0}, high[3] = {0, 0, 0}, centre[3] = {0, 0, 0}, error = 0;
    struct crossing crossing = {.error = &error};
    if (initial->kind != INITIAL_PLANE_WAVE && initial->kind != INITIAL_GAUSSIAN) return;
    body_from_deck(&scene->body, initial->centre, centre);
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double reach = initial->kind == INITIAL_GAUSSIAN ? STATE_REACH * initial->width : INFINITY;
        low[axis] = fmax(scene->body.low[axis], centre[axis] - reach);
        high[axis] = fmin(scene->body.high[axis], centre[axis] + reach);
    }
    initial_speeds(scene, crossing.speed);
    jumps_in(scene, low, high, crosses, &crossing);
    if (!(error >= seen)) return;
    advise(
        adviser,
        "the initial state lies across an interface of rocks of other moduli, where it begins with a "
        "traction that jumps: velocities may err by about %.2g there, less only as the root of the spacing; "
        "%s would do",
        fmin(1, error), initial->wavelength > 0 ? "even ground" : "a state that begins 3.5 widths from it");
}

/* How many times the shear modulus differs across the middles of a block's faces, at most. */
static double modulus_jump(const struct scene *scene, const struct ground_block *block)
{
    const struct body *body = &scene->body;
    const double aside = 1e-6 * body->spacing;
    double most = 1;
    for (int face = 0; face < 6 && face < 2 * scene->dimension; face++) {
        const int axis = face / 2, way = face % 2 == 0 ? -1 : 1;
        const double edge = block->centre[axis] + way * block->half[axis];
        double mu[2] = {0, 0};
        for (int side = 0; side < 2; side++) {
            double place[3] = {block->centre[0], block->centre[1], block->centre[2]};
            place[axis] = edge + (2 * side - 1) * aside;
            if (place[axis] > ground_low(body, axis) && place[axis] < body->high[axis])
                mu[side] = ground_at(scene, place).mu;
        }
        if (mu[0] > 0 && mu[1] > 0) most = fmax(most, fmax(mu[0] / mu[1], mu[1] / mu[0]));
    }
    return most;
}

static bool is_point_force(const struct load *load)
{
    return load->kind != LOAD_MOMENT_TENSOR && load->shape == LOAD_POINT;
}

/* How many times the density differs along the axes within 1.5 spacings of a point force, at most. */
static double density_beside(const struct scene *scene)
{
    enum { STEPS = 3 };
    const double step = .5 * scene->body.spacing;
    double most = 1;
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        double centre[3] = {0, 0, 0}, low = INFINITY, high = 0;
        if (!is_point_force(load)) continue;
        ground_from_deck(&scene->body, load->centre, centre);
        for (int axis = 0; axis < scene->dimension; axis++)
            for (int n = -STEPS; n <= STEPS; n++) {
                double place[3] = {centre[0], centre[1], centre[2]};
                place[axis] += n * step;
                const double density = ground_at(scene, place).density;
                low = fmin(low, density);
                high = fmax(high, density);
            }
        most = fmax(most, high / low);
    }
    return most;
}

/* How many times the shear modulus differs across the corner of a box within .6 spacings of a place along two axes at
 * least, on whose edge it lies in space; 1: there is none. */
static double modulus_at_corner(const struct scene *scene, const struct ground_block *block,
                                const double centre[3])
{
    const double within = .6 * scene->body.spacing;
    double corner[3] = {centre[0], centre[1], centre[2]}, low = INFINITY, high = 0;
    unsigned near = 0, sides = 0;
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double away = centre[axis] - block->centre[axis];
        if (fabs(away) > block->half[axis] + within) return 1;
        if (fabs(away) < block->half[axis] - within) continue;
        corner[axis] = block->centre[axis] + copysign(block->half[axis], away);
        near |= 1U << axis;
        sides++;
    }
    if (sides < 2 || block->shape != BLOCK_BOX) return 1;
    for (unsigned quadrant = 0; quadrant < 8; quadrant++) {
        double place[3] = {corner[0], corner[1], corner[2]};
        for (unsigned axis = 0; axis < 3; axis++)
            if (near >> axis & 1U) place[axis] += quadrant >> axis & 1U ? within : -within;
        const double mu = ground_at(scene, place).mu;
        low = fmin(low, mu);
        high = fmax(high, mu);
    }
    return high / low;
}

static double modulus_at_corners(const struct scene *scene)
{
    double most = 1;
    for (size_t k = 0; k < scene->loads; k++) {
        double centre[3] = {0, 0, 0};
        if (!is_point_force(&scene->load[k])) continue;
        ground_from_deck(&scene->body, scene->load[k].centre, centre);
        for (size_t b = 0; b < scene->body.blocks; b++)
            most = fmax(most, modulus_at_corner(scene, &scene->body.block[b], centre));
    }
    return most;
}

/* Interfaces that the splines carry smoothly. Measured in the plane (regress/studies/blocks): blocks of r times the
 * ground's density, or of r times its moduli, err by so much (r - 1) / p^2 at most, p the points a wavelength; where
 * forces act within 1.5 spacings of a jump of the density by 2.4 (r - 1) / p^2 of the densities there, at corners of
 * blocks by 1.5 of the moduli. */
void look_at_weights(struct adviser *adviser)
{
    static const double seen = .1, of_densities = .85, beside = 2.4, of_moduli = .45, at_corners = 1.5;
    const struct scene *scene = adviser->scene;
    const double points = points_per_wavelength(scene);
    double least = INFINITY, most = 0, moduli = 1;
    for (size_t m = 0; m < scene->materials; m++) {
        least = fmin(least, scene->material[m].density);
        most = fmax(most, scene->material[m].density);
    }
    if (scene_has_exact(scene) || !ground_is_general(scene) || !(points > 0)) return;
    for (size_t k = 0; k < scene->body.blocks; k++)
        moduli = fmax(moduli, modulus_jump(scene, &scene->body.block[k]));
    const double near = density_beside(scene);
    const double light = fmax(of_densities * (most / least - 1), beside * (near - 1)),
                 soft = fmax(of_moduli * (moduli - 1), at_corners * (modulus_at_corners(scene) - 1)),
                 error = fmax(light, soft) / (points * points);
    if (!(error > seen)) return;
    advise(
        adviser,
        "%s differ %.3g times where the rock changes: at %.3g points per wavelength velocities err by up to "
        "about %.2g; body%%spacing = %.3g would be right",
        light > soft ? "densities" : "moduli", light > soft ? most / least : moduli, points, fmin(1, error),
        scene->body.spacing * sqrt(seen / 2 / error));
}

/* The middle of what stands between two blocks along an axis, if it is thinner than `most`. */
static bool wall_between(const struct scene *scene, const struct ground_block *one,
                         const struct ground_block *other, int along, double most, double middle[3])
{
    for (int axis = 0; axis < 3 && axis < scene->dimension; axis++) {
        const double from =
                         fmax(one->centre[axis] - one->half[axis], other->centre[axis] - other->half[axis]),
                     to = fmin(one->centre[axis] + one->half[axis], other->centre[axis] + other->half[axis]);
        const double apart = from - to, touching = 1e-9 * most;
        if (axis == along ? apart < touching || apart >= most : apart >= 0) return false;
        middle[axis] = (from + to) / 2;
    }
    return true;
}

/* Walls between soft blocks. Measured in the plane, moduli 10 : 1, at 6 points a wavelength: thinner than .9 spacings
 * .05 to .20, thicker ones .03 to .10 (doc/theory/general-ground.md, section 7). */
void look_at_walls(struct adviser *adviser)
{
    static const double thin = .9, softer = 3;
    const struct scene *scene = adviser->scene;
    const struct ground_block *block = scene->body.block;
    for (size_t i = 0; i < scene->body.blocks; i++)
        for (size_t j = 0; j < i; j++)
            for (int axis = 0; axis < 3 && axis < scene->dimension; axis++) {
                const double spacing = scene->body.spacing;
                double middle[3] = {0, 0, 0}, side[2][3], away = 0;
                if (!wall_between(scene, &block[i], &block[j], axis, thin * spacing, middle)) continue;
                for (int end = 0; end < 2; end++) {
                    memcpy(side[end], middle, sizeof middle);
                    side[end][axis] += (2 * end - 1) * thin * spacing / 2;
                }
                const double wall = ground_at(scene, middle).mu;
                if (wall < softer * fmax(ground_at(scene, side[0]).mu, ground_at(scene, side[1]).mu))
                    continue;
                away = fabs(block[i].centre[axis] - block[j].centre[axis]) - block[i].half[axis] -
                       block[j].half[axis];
                advise(
                    adviser,
                    "blocks %zu and %zu leave a wall of rock of %.3g between them, %.2g spacings: beside and "
                    "below such "
                    "walls velocities were up to .3 wrong, twice as much as beside thicker ones; "
                    "body%%spacing = %.3g would be right",
                    j + 1, i + 1, away, away / spacing, away / 1.6);
                return;
            }
}
