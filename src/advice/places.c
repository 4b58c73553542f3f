/* Places that the lattice or the absorbing layers do not do justice: receivers in the midst of a source, and a
 * surface that layers make level. */
#include "advice/parts.h"
#include "scene/absorbing_layers.h"
#include "scene/ground.h"
#include "scene/resolution.h"
#include "scene/topography.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

bool by_general_operator(const struct scene *scene)
{
    const struct deck_group *group = scene->method.group;
    return (group != NULL && deck_given(group, "operator") && deck_chosen(group, "operator", "general")) ||
           ground_needs_general(scene);
}

/* Less than three spacings below a free surface. */
static bool shallow(const struct scene *scene, const double position[3])
{
    double place[3] = {0.0, 0.0, 0.0};
    const int axis = scene->dimension - 1;
    lattice_from_deck(&scene->body, position, place);
    return boundary_is_free(&scene->boundary[2 * axis]) &&
           place[axis] - scene->body.low[axis] < 3.0 * scene->body.spacing;
}

/* Beside the exact mass velocities on the axes of the lattice were .02 to .67 wrong as near as this
 * (doc/theory/sources.md, "The method"). */
bool by_exact_mass(const struct scene *scene)
{
    const struct deck_group *group = scene->method.group;
    if (group != NULL && deck_given(group, "mass")) return deck_chosen(group, "mass", "exact");
    if (scene->method.degree > 0) return scene->method.sweeps == 0;
    const bool sweeps =
        group != NULL && (deck_given(group, "depth_mass") || deck_given(group, "dissipation"));
    return body_is_layered(&scene->body) && !by_general_operator(scene) && !layer_anywhere(scene) &&
           !sweeps; /* the default there */
}

static bool along_an_axis(const struct scene *scene, const double from[3], const double to[3])
{
    double one[3] = {0.0, 0.0, 0.0}, other[3] = {0.0, 0.0, 0.0};
    int apart = 0;
    lattice_from_deck(&scene->body, from, one);
    lattice_from_deck(&scene->body, to, other);
    for (int axis = 0; axis < scene->dimension; axis++)
        apart += fabs(one[axis] - other[axis]) > 2.0 * scene->body.spacing;
    return apart <= 1;
}

/* Spacings from a force and a moment tensor within which velocities were .01 to .09 and .02 to .3 wrong; where both
 * lie near a free surface of the general operator .01 to .24 (doc/theory/sources.md, table 1). */
static double near(const struct scene *scene, bool exact_mass, const struct load *load,
                   const double receiver[3])
{
    if (load->kind != LOAD_MOMENT_TENSOR && load->shape != LOAD_POINT) return 0.0;
    if (exact_mass && along_an_axis(scene, load->centre, receiver)) return 10.0;
    if (load->kind != LOAD_MOMENT_TENSOR) return 2.0;
    return by_general_operator(scene) && shallow(scene, load->centre) && shallow(scene, receiver) ? 10.0
                                                                                                  : 6.0;
}

double spacing_at(const struct scene *scene, const double position[3])
{
    double place[3];
    body_from_deck(&scene->body, position, place);
    return body_spacing_at(&scene->body, place);
}

void look_at_nearness(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    double least = INFINITY, wanted = 0.0, spacings = 0.0;
    size_t load = 0, receiver = 0;
    if (strcmp(scene->method.variant, "consistent") != 0 || scene->receivers == 0) return;
    const bool exact_mass = by_exact_mass(scene);
    for (size_t k = 0; k < scene->loads; k++)
        for (size_t r = 0; r < scene->receivers; r++) {
            const double *from = scene->load[k].centre, *to = scene->receiver[r].position;
            const double way = hypot(hypot(to[0] - from[0], to[1] - from[1]), to[2] - from[2]),
                         width = near(scene, exact_mass, &scene->load[k], to),
                         enough = width * spacing_at(scene, from);
            if (way >= 0.999 * enough || way / enough >= least) continue;
            least = way / enough;
            wanted = enough;
            spacings = width;
            load = k;
            receiver = r;
        }
    if (wanted == 0.0) return;
    char finer[80] = "";
    if (least > 0.01)
        snprintf(finer, sizeof finer, ", or body%%spacing = %.3g,", least * scene->body.spacing);
    advise(adviser,
           "receiver '%s' is %.3g from load %zu, which is a point that the lattice spreads: nearer than "
           "%.0f spacings (%.3g) velocities may be some per cent%s wrong; a receiver farther off%s would do",
           scene->receiver[receiver].name, least * wanted, scene->load[load].group + 1, spacings, wanted,
           spacings > 6.0 ? " or tenths" : "", finer);
}

/* Difference of a modulus from the mean of those on either side along a direction, over it: 0 where the rock is even or
 * changes evenly. */
static double bend(const struct scene *scene, const double place[3], const double direction[3], double away)
{
    double sides[2] = {0.0, 0.0};
    const struct rock here = ground_at(scene, place);
    for (int side = -1; side <= 1; side += 2) {
        double there[3];
        for (int c = 0; c < 3; c++)
            there[c] = place[c] + side * away * direction[c];
        const struct rock rock = ground_at(scene, there);
        sides[0] += 0.5 * (rock.lambda + 2.0 * rock.mu);
        sides[1] += 0.5 * rock.mu;
    }
    const double worst = fabs(sides[0] / (here.lambda + 2.0 * here.mu) - 1.0);
    return here.mu > 0.0 ? fmax(worst, fabs(sides[1] / here.mu - 1.0)) : worst;
}

/* Unit vectors along axes and diagonals of the lattice: of each two that are opposite one. How many. */
enum { MOST_DIRECTIONS = 13 };
static size_t lay_directions(int dimension, double direction[MOST_DIRECTIONS][3])
{
    const int all = dimension == 1 ? 3 : dimension == 2 ? 9 : 27;
    size_t count = 0;
    for (int code = all / 2 + 1; code < all; code++) {
        const double step[3] = {code % 3 - 1, dimension > 1 ? code / 3 % 3 - 1 : 0,
                                dimension > 2 ? code / 9 - 1 : 0};
        for (int c = 0; c < 3; c++)
            direction[count][c] = step[c] / hypot(hypot(step[0], step[1]), step[2]);
        count++;
    }
    return count;
}

/* The greater of the shear moduli at the ends over the lesser, along depth. */
static double contrast(const struct scene *scene, const double place[3], double away)
{
    double modulus[2];
    for (int side = 0; side < 2; side++) {
        double there[3] = {place[0], place[1], place[2]};
        there[scene->dimension - 1] += side == 0 ? -away : away;
        modulus[side] = ground_at(scene, there).mu;
    }
    return fmax(modulus[0], modulus[1]) / fmin(modulus[0], modulus[1]);
}

/* What (G21) to (G29) leave beside interfaces that slope or end, or of strong contrast (doc/theory/general-ground.md,
 * section 7). */
void look_at_interfaces(struct adviser *adviser)
{
    enum { STEPS = 10 }; /* in a spacing */
    static const double reach = 3.0, slight = 0.05, strong = 5.0;
    const struct scene *scene = adviser->scene;
    double least = reach, direction[MOST_DIRECTIONS][3];
    const size_t directions = lay_directions(scene->dimension, direction);
    size_t load = 0;
    if (strcmp(scene->method.variant, "consistent") != 0 || !by_general_operator(scene)) return;
    for (size_t k = 0; k < scene->loads; k++) {
        if (scene->load[k].kind != LOAD_MOMENT_TENSOR) continue;
        double place[3] = {0.0, 0.0, 0.0};
        ground_from_deck(&scene->body, scene->load[k].centre, place);
        const double spacing = spacing_at(scene, scene->load[k].centre);
        if (!ground_is_general(scene) && contrast(scene, place, reach * spacing) <= strong) continue;
        for (size_t i = 0; i < directions; i++)
            for (int n = 1; n < least * STEPS; n++) {
                if (bend(scene, place, direction[i], n * spacing / STEPS) <= slight) continue;
                least = (double)n / STEPS;
                load = k;
            }
    }
    if (least == reach) return;
    advise(adviser,
           "load %zu is a moment tensor about %.1f spacings from where the rock changes: nearer than %.1f "
           "velocities by the general operator may be wrong by %s; body%%spacing = %.3g or a source "
           "farther off would do%s",
           scene->load[load].group + 1, least, reach,
           ground_is_general(scene)
               ? "a tenth, several tenths beside corners of the rock, within a "
                 "spacing of a free face or 7 of another one"
               : "a twentieth where shear moduli are 1 : 5, a tenth where they are 1 : 10",
           scene->body.spacing * least / reach,
           ground_is_general(scene) ? "" : ", or method%operator = 'layered'");
}

/* Slope of a layer's upper face at the sides of the box, along x and y; one from a file over two spacings, of which its
 * splines make the least. */
static double slope_at_sides(const struct scene *scene, const struct layer *layer)
{
    enum { LOOKS = 8 };
    static const double least = .01;
    const struct body *body = &scene->body;
    const double step = 2 * body->spacing;
    double slope = hypot(layer->slope[0], layer->slope[1]);
    for (int face = 0; layer->map != NULL && face < 2 * scene->dimension - 2; face++)
        for (int look = 0; look <= LOOKS; look++) {
            const int axis = face / 2, other = 1 - axis;
            double edge[3] = {0}, within[3] = {0};
            edge[other] = within[other] =
                body->low[other] + (body->high[other] - body->low[other]) * look / LOOKS;
            edge[axis] = face_plane(body, (enum face)face);
            within[axis] = edge[axis] - face_sign((enum face)face) * step;
            const double rise = layer_top_at(layer, edge) - layer_top_at(layer, within);
            if (fabs(rise) > least * step) slope = fmax(slope, fabs(rise) / step);
        }
    return slope;
}

/* Rays up a dip come back down it, also from the sides (a soil of half the speed, 1.5 thick, box of 3.6 x 2.4:
 * regress/checks/fitted.sh): what is beyond the box is not there. */
void look_at_tilted(struct adviser *adviser)
{
    const struct body *body = &adviser->scene->body;
    double slope = 0.0;
    for (size_t i = 0; i < body->layers; i++)
        slope = fmax(slope, slope_at_sides(adviser->scene, &body->layer[i]));
    if (slope == 0.0 || (body->chosen ? !body->absorbing : !layer_anywhere(adviser->scene))) return;
    advise(
        adviser,
        "tilted layers send waves back from beyond the box, which are lost in its absorbing layers: "
        "velocities "
        "differed by up to .11 at dips of 5 to 35 degrees; body%%low and body%%high farther from source and "
        "receivers would be right (selas check --echo measures it)");
}

void look_at_levelled(struct adviser *adviser)
{
    const struct topography *topography = adviser->scene->body.topography;
    if (topography == NULL) return;
    const double levelled = topography_levelled(adviser->scene, topography->changed);
    if (levelled <= TOPOGRAPHY_LEVELLED) return;
    advise(
        adviser,
        "before the absorbing layers the surface is made level, which changes its heights by up to %.3g, "
        "%.2g of the slowest wave's length at the source's cutoff, and what rises beyond them is not there: "
        "velocities may differ by as much or more; body%%low and body%%high where the ground is level, or "
        "farther from source and receivers, would be right",
        topography->changed, levelled);
}

/* Measured: doc/theory/graded-spacing.md, section 4. */
void look_at_grading(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    const struct deck_group *group = scene->method.group;
    const bool meant = group != NULL && deck_given(group, "operator");
    if (scene->body.grading == NULL || ground_is_general(scene) || meant) return;
    advise(adviser, "body%%grading brings the general operator, which errs 1.5 to 10 times as much on level "
                    "layers as the "
                    "layered one on an even lattice of this spacing, for .5 to .7 of its time; without "
                    "grading errors are "
                    "less for the same time (method%%operator = 'general' says that it is meant)");
}

/* Does a moving patch come within so many spacings of a receiver? */
static bool passes(const struct scene *scene, const struct load *load, const double position[3],
                   double spacings)
{
    double from[3], velocity[3], place[3], first = 0.0, last = scene->end_time;
    body_from_deck(&scene->body, load->centre, from);
    body_direction_from_deck(&scene->body, load->velocity, velocity);
    body_from_deck(&scene->body, position, place);
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double half = half_size(load, axis) + spacings * scene->body.spacing,
                     way = place[axis] - from[axis];
        if (velocity[axis] == 0.0 && fabs(way) > half) return false;
        if (velocity[axis] == 0.0) continue;
        const double one = (way - half) / velocity[axis], other = (way + half) / velocity[axis];
        first = fmax(first, fmin(one, other));
        last = fmin(last, fmax(one, other));
    }
    return first < last;
}

/* By how many spacings it misses the receiver, or `most`. */
static double missed_by(const struct scene *scene, const struct load *load, const double position[3],
                        double most)
{
    double hit = most, missed = 0.0;
    for (int i = 0; i < 20; i++) {
        const double middle = .5 * (hit + missed);
        if (passes(scene, load, position, middle))
            hit = middle;
        else
            missed = middle;
    }
    return hit;
}

/* Errors of a receiver on the path or beside it, (7b) and (7c) of doc/theory/sources.md; factors by measurement
 * (regress/studies/passed-receivers). */
void look_at_passed(struct adviser *adviser, size_t k)
{
    static const double jump = 1.5, kink = .27, seen = .03, far = 12;
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    const bool square = load->shape == LOAD_SQUARE && scene->dimension == 3;
    double speed = 0.0;
    for (int axis = 0; axis < 3; axis++)
        speed = hypot(speed, load->velocity[axis]);
    if (!has_patch(load) || speed == 0.0 || scene_has_exact(scene)) return;
    const double edge = square ? fmin(load->size[0], load->size[1]) : load->size[0],
                 part = fmin(1.0, scene->body.spacing / edge), mach = speed / slowest_speed(scene),
                 flat = sqrt(fmax(.1, 1 - mach * mach / (.92 * .92)));
    double worst = 0.0;
    size_t which = 0;
    for (size_t r = 0; r < scene->receivers; r++) {
        const double beside = missed_by(scene, load, scene->receiver[r].position, far),
                     here = beside < far ? fmin(1.0, 3 * exp(-1.6 * flat * beside)) : 0.0;
        if (here > worst) which = r;
        worst = fmax(worst, here);
    }
    const double error = fmin(1.0, jump * mach * sqrt(part / flat)) * worst;
    if (!(error >= seen)) return;
    advise(adviser,
           "load %zu comes by receiver '%s': its edges pass as jumps of the velocity, which may err by about "
           "%.2g there, less only by the root of the spacing (displacements by %.1g); a receiver farther "
           "beside the path would do",
           scene->load[k].group + 1, scene->receiver[which].name, error, kink * part * worst);
}

/* Does M pull across a face of the body? */
static bool pulls_across(const struct scene *scene, const struct load *load, int axis)
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    const struct body *body = &scene->body;
    bool pulls = false;
    for (int i = 0; i < 3; i++) {
        double pull = 0;
        for (int j = 0; j < 3; j++)
            pull += load->moment[place[i][j]] * (body->rotated ? body->frame[j][axis] : j == axis);
        pulls = pulls || fabs(pull) > 1e-9;
    }
    return pulls;
}

/* Moment tensors right below free faces, whose tractions the hats of degree 2 alone know. */
void look_at_shallow(struct adviser *adviser, const struct model *model)
{
    const struct scene *scene = adviser->scene;
    const struct body *body = &scene->body;
    if (!(model->shallow > 0) || body->topography != NULL) return;
    for (size_t k = 0; k < scene->loads; k++)
        for (int face = 0; face < 2 * scene->dimension; face++) {
            const struct load *load = &scene->load[k];
            const int axis = face / 2;
            double own[3];
            body_from_deck(body, load->centre, own);
            const double depth = face % 2 == 0 ? own[axis] - body->low[axis] : body->high[axis] - own[axis];
            if (load->kind != LOAD_MOMENT_TENSOR || !(depth < model->shallow * body->spacing) ||
                !boundary_is_free(&scene->boundary[face]) || !pulls_across(scene, load, axis))
                continue;
            advise(
                adviser,
                "the moment tensor of load %zu pulls across the free face %s, %.2g spacings from it, where "
                "these splines do not know the face: velocities were .1 to 20 wrong; degree = 2 with open "
                "ends would be right",
                load->group + 1, face_name((enum face)face), depth / body->spacing);
            return;
        }
}
