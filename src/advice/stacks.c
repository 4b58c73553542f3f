/* Ground that goes to and fro within few spacings: stacks of thin layers, models finer than the lattice. */
#include "advice/parts.h"

#include "scene/ground.h"
#include "scene/resolution.h"

#include <math.h>
#include <string.h>

enum { STACK = 3 }; /* so many swings are more than a layer between two others */

/* What is met along a line: the logarithm of a modulus or density, where it turned last, how far it has come since, and
 * the largest swings that few spacings hold, in parts of (r - 1), r the ratio across a swing. */
struct swings {
    double turn[2], reached[2]; /* place in spacings, value */
    bool turned;
    double largest[STACK];
};

static void swing_ends(struct swings *swings)
{
    static const double few = 4, whole = .8; /* measured: thinner ones average out */
    const double length = swings->reached[0] - swings->turn[0];
    double size = expm1(fabs(swings->reached[1] - swings->turn[1])) * fmin(1, pow(length / whole, 2));
    if (!swings->turned || length > few) return;
    for (int i = 0; i < STACK; i++)
        if (size > swings->largest[i]) {
            const double less = swings->largest[i];
            swings->largest[i] = size;
            size = less;
        }
}

static void swing_on(struct swings *swings, double place, double value)
{
    static const double slight = .05;
    const double so_far = swings->reached[1] - swings->turn[1], more = value - swings->reached[1];
    const bool turns = so_far * more < 0;
    if (more == 0 || (turns && fabs(more) < slight)) return;
    if (turns) {
        swing_ends(swings);
        swings->turned = true;
        memcpy(swings->turn, swings->reached, sizeof swings->turn);
    }
    swings->reached[0] = place;
    swings->reached[1] = value;
}

/* The largest such swing that STACK have along a line through a place, of moduli and of densities. */
static void look_along(const struct scene *scene, const double through[3], int axis, double size[2])
{
    enum { MOST = 20000, A_SPACING = 8 };
    const struct body *body = &scene->body;
    const double low = ground_low(body, axis), length = body->high[axis] - low;
    const int steps = (int)fmin(MOST, ceil(A_SPACING * length / body->spacing));
    struct swings swings[2];
    memset(swings, 0, sizeof swings);
    for (int i = 0; i < steps; i++) {
        double place[3] = {through[0], through[1], through[2]};
        const double part = (i + .5) / steps;
        place[axis] = low + part * length;
        const struct rock rock = ground_at(scene, place);
        const double value[2] = {log(rock.mu), log(rock.density)};
        for (int what = 0; what < 2; what++) {
            if (i == 0) swings[what].turn[1] = swings[what].reached[1] = value[what];
            swing_on(&swings[what], part * length / body->spacing, value[what]);
        }
    }
    for (int what = 0; what < 2; what++) {
        swing_ends(&swings[what]);
        size[what] = fmax(size[what], swings[what].largest[STACK - 1]);
    }
}

/* Lines through sources and receivers. Measured in the plane (regress/studies/blocks, `stacks` and `voxels`). */
void look_at_stacks(struct adviser *adviser)
{
    enum { LINES = 50 };
    static const double seen = .1, of_moduli = 1.5, of_densities = 3;
    const struct scene *scene = adviser->scene;
    const double points = points_per_wavelength(scene);
    const size_t places = scene->loads + scene->receivers, stride = 1 + places / LINES;
    double size[2] = {0, 0};
    if (scene_has_exact(scene) || !by_general_operator(scene) || !(points > 0)) return;
    for (size_t n = 0; n < places; n += stride)
        for (int axis = 0; axis < scene->dimension; axis++) {
            double place[3] = {0, 0, 0};
            ground_from_deck(
                &scene->body,
                n < scene->loads ? scene->load[n].centre : scene->receiver[n - scene->loads].position, place);
            if (ground_varies(scene, axis)) look_along(scene, place, axis, size);
        }
    const double soft = of_moduli * size[0], light = of_densities * size[1],
                 error = fmax(soft, light) / (points * points);
    if (!(error > seen)) return;
    advise(
        adviser,
        "%s go to and fro by %.3g times within few spacings, again and again: at %.3g points per wavelength "
        "velocities err by up to about %.2g; body%%spacing = %.3g would be right",
        light > soft ? "densities" : "moduli", 1 + (light > soft ? size[1] : size[0]), points, fmin(1, error),
        scene->body.spacing * sqrt(seen / 2 / error));
}

/* 1/Q_s of the rocks on both sides of an interface, where they differ most. */
struct losses {
    double low, high;
};

static void look_across(const struct scene *scene, size_t one, size_t other, struct losses *most)
{
    const double q[2] = {scene->material[one].q_s, scene->material[other].q_s};
    const double loss[2] = {q[0] > 0 ? 1 / q[0] : 0, q[1] > 0 ? 1 / q[1] : 0};
    const struct losses here = {fmin(loss[0], loss[1]), fmax(loss[0], loss[1])};
    if (here.high - here.low > most->high - most->low) *most = here;
}

/* Between layers, and between blocks and whatever else there is. */
static struct losses most_unlike(const struct scene *scene)
{
    const struct body *body = &scene->body;
    const bool covered = body->layers > 0 && layer_covers(&body->layer[0]);
    struct losses most = {0, 0};
    if (body->layers > 0 && !covered) look_across(scene, body->material, body->layer[0].material, &most);
    for (size_t i = 0; i + 1 < body->layers; i++)
        look_across(scene, body->layer[i].graded ? body->layer[i].bottom : body->layer[i].material,
                    body->layer[i + 1].material, &most);
    for (size_t k = 0; k < body->blocks; k++) {
        const size_t own = body->block[k].material;
        if (!covered) look_across(scene, own, body->material, &most);
        for (size_t i = 0; i < body->layers; i++)
            look_across(scene, own, body->layer[i].material, &most);
        for (size_t other = 0; other < k; other++)
            look_across(scene, own, body->block[other].material, &most);
    }
    return most;
}

/* Rock of low Q beside other rock in a cell, whose moduli are right in the first order of 1/Q. Measured in space:
 * layers of low Q in rock of Q_s 100, 6 and 12 points a wavelength (regress/studies/q-layers): velocities err by
 * so much over points Q^2 more than without damping. */
void look_at_damped_cells(struct adviser *adviser)
{
    static const double seen = .01, of_loss = 1.3;
    const struct scene *scene = adviser->scene;
    const double points = points_per_wavelength(scene);
    if (!by_general_operator(scene) || scene->body.model != NULL || !(points > 0)) return;
    const struct losses most = most_unlike(scene);
    const double error = of_loss * pow(most.high - most.low, 2) / points;
    if (!(error > seen)) return;
    advise(
        adviser,
        "rock of Q = %.3g and rock of other Q share cells, whose moduli are right in the first order of 1/Q: "
        "velocities err by up to about %.2g more than undamped ones; %sbody%%spacing = %.3g would be right",
        1 / most.high, fmin(1, error), ground_needs_general(scene) ? "" : "method%operator = 'layered' or ",
        scene->body.spacing * seen / 2 / error);
}
