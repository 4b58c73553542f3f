/* `selas check --echo`: what the faces of the box send back, measured. The scene is run twice with coarse
 * points, in its own box and in one twice as large (doc/theory/absorbing-faces.md, section 7), and what the receivers
 * record is compared: displacements and velocities. Where a load stays the points are the deck's: layers give way to it
 * by their thickness. */
#include "program/commands.h"

#include "host/simulation.h"
#include "scene/absorbing_layers.h"
#include "scene/build.h"
#include "scene/echo.h"
#include "scene/grading.h"
#include "scene/ground.h"
#include "scene/guided.h"
#include "scene/resolution.h"
#include "scene/rests.h"
#include "scene/topography.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Spacing against the deck's, at most; points that a wave keeps, and the width of an initial state; points of
 * the larger box's layers. */
static const double coarsest = 2, fewest = 4, initial_points = 2;
enum { SURE_POINTS = 20, MORE_POINTS = 8, COMPONENTS = 3, CHANNELS = 2 * COMPONENTS };
static const selas_field recorded[] = {SELAS_DISPLACEMENT, SELAS_VELOCITY};

/* Layers as they are with the deck's points, whatever the spacing. */
static void keep_layers(struct scene *scene)
{
    size_t points[BOX_FACES];
    for (int face = 0; face < 2 * scene->dimension; face++)
        points[face] = layer_points(scene, face);
    for (int face = 0; face < 2 * scene->dimension; face++) {
        struct boundary *boundary = &scene->boundary[face];
        if (!boundary_has_layer(boundary)) continue;
        boundary->layer_points = (long)points[face];
        boundary->always = points[face] > 0;
        if (points[face] == 0) boundary->kind = BOUNDARY_FREE;
    }
}

/* Faces that stand for what lies beyond them move away by half the length of the box. */
static void enlarge(struct scene *scene)
{
    struct body *body = &scene->body;
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double cells = round((body->high[axis] - body->low[axis]) / body->spacing);
        for (int face = 2 * axis; face < 2 * axis + 2; face++) {
            struct boundary *boundary = &scene->boundary[face];
            const bool opened = body->chosen && !boundary->given && boundary_is_free(boundary);
            const bool far = axis < scene->dimension - 1 || face % 2 == 1;
            if (!boundary_absorbs(boundary) && !(opened && far)) continue;
            const bool both = boundary_absorbs(&scene->boundary[face ^ 1]) || axis < scene->dimension - 1;
            const double further = ceil(both ? cells / 2 : cells) * body->spacing;
            if (face % 2 == 0)
                body->low[axis] -= further;
            else
                body->high[axis] += further;
            if (!boundary_has_layer(boundary)) continue;
            const long more = boundary->layer_points + MORE_POINTS;
            boundary->layer_points = more > SURE_POINTS ? more : SURE_POINTS;
        }
    }
    topography_draw_out(scene);
}

/* Steps the scene to its end; *rows of displacements and velocities of all receivers, free() them. */
static selas_status run(selas_simulation *simulation, double step, double **values, size_t *rows)
{
    const size_t receivers = simulation->scene->receivers;
    if (step > 0) {
        simulation->scene->stepping.time_step = step;
        simulation->scene->stepping.courant = simulation->scene->stepping.safety = 0;
    }
    simulation->advised = true;
    selas_status status = selas_step(simulation, 0);
    if (status != SELAS_OK) return status;
    *rows = simulation->stepper->steps;
    *values = calloc(*rows * receivers * CHANNELS + 1, sizeof **values);
    if (*values == NULL) return SELAS_NO_MEMORY;
    for (size_t i = 0; i < *rows && status == SELAS_OK; i++) {
        status = selas_step(simulation, 1);
        for (size_t n = 0; n < 2 * receivers && status == SELAS_OK; n++)
            status = selas_receiver(simulation, simulation->scene->receiver[n / 2].name, recorded[n % 2],
                                    *values + (2 * i * receivers + n) * COMPONENTS);
    }
    return status;
}

static double expected_at_worst(const struct scene *scene)
{
    double worst = 0;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const size_t points = layer_points(scene, face);
        if (points > 0) worst = fmax(worst, echo_of_layer(scene, face, points));
    }
    const struct guided guided = guided_waves(scene);
    return worst + guided_error(scene, &guided);
}

/* What one run records, or differences of two (other not NULL). */
struct records {
    const double *values, *other;
    size_t rows, receivers;
};

/* Square of a receiver's vector `what`, 0 displacement, 1 velocity, in a row. */
static double square(const struct records *records, size_t row, size_t r, int what)
{
    const size_t at = ((row * records->receivers + r) * 2 + (size_t)what) * COMPONENTS;
    double sum = 0;
    for (size_t c = at; c < at + COMPONENTS; c++)
        sum += pow(records->values[c] - (records->other != NULL ? records->other[c] : 0), 2);
    return sum;
}

static double squares(const struct records *records, size_t r, int what)
{
    double sum = 0;
    for (size_t i = 0; i < records->rows; i++)
        sum += square(records, i, r, what);
    return sum;
}

/* Relative L2 difference of what is recorded there, over a hundredth of the largest where hardly anything arrives. */
static double apart(const struct records *large, const struct records *off, size_t r, int what)
{
    static const double hardly = 0.01;
    double largest = 0;
    for (size_t i = 0; i < large->receivers; i++)
        largest = fmax(largest, squares(large, i, what));
    const double whole = fmax(squares(large, r, what), hardly * hardly * largest);
    return whole > 0 ? sqrt(squares(off, r, what) / whole) : 0;
}

/* Difference of the last displacements over the largest there. */
static double left(const struct records *large, const struct records *off, size_t r)
{
    double largest = 0;
    for (size_t i = 0; i < large->rows; i++)
        largest = fmax(largest, square(large, i, r, 0));
    return largest > 0 && large->rows > 0 ? sqrt(square(off, large->rows - 1, r, 0) / largest) : 0;
}

static void tell(const struct scene *scene, const double *small, const double *values, size_t rows)
{
    const struct records large = {values, NULL, rows, scene->receivers},
                         off = {small, values, rows, scene->receivers};
    for (size_t r = 0; r < scene->receivers; r++)
        printf(
            "echo %s: %.2e (of the velocity, L2, spacing %g); of the displacement %.2e, at the end %.2e of "
            "the largest\n",
            scene->receiver[r].name, apart(&large, &off, r, 1), scene->body.spacing,
            apart(&large, &off, r, 0), left(&large, &off, r));
}

/* The deck, its splines not tuned: how far tuned ones reach hangs on the size of the box (consistent-splines.md,
 * section 14), which is no echo. */
static selas_status open_plain(const struct echo_deck *deck, selas_simulation **simulation)
{
    selas_status status = selas_open_deck_with(deck->path, deck->overrides, deck->override, simulation);
    if (status != SELAS_OK) return status;
    const struct scene *scene = (*simulation)->scene;
    const bool chosen = deck_given(deck_get(scene->deck, "scene", 0), "accuracy");
    if (chosen || !body_is_layered(&scene->body) || strcmp(scene->method.variant, "consistent") != 0)
        return SELAS_OK;
    const char **more = calloc(deck->overrides + 1, sizeof *more);
    if (more == NULL) return SELAS_NO_MEMORY;
    for (size_t i = 0; i < deck->overrides; i++)
        more[i] = deck->override[i];
    more[deck->overrides] = "method%tuned=.false.";
    selas_close(simulation);
    status = selas_open_deck_with(deck->path, deck->overrides + 1, more, simulation);
    free(more);
    return status;
}

/* How much coarser the points may be: what moves must stay waves. */
static double coarsening(const struct scene *scene)
{
    double coarser = coarsest;
    struct rest rest;
    if (worst_rest(scene, &rest)) return 1;
    const double resolved = points_per_wavelength(scene) / fewest;
    if (resolved > 0) coarser = fmin(coarser, resolved);
    if (scene->initial.width > 0)
        coarser = fmin(coarser, scene->initial.width / (initial_points * scene->body.spacing));
    return fmax(1, coarser);
}

/* The same deck once more, its points coarse, its box larger or not. */
static selas_status open_coarse(const struct echo_deck *deck, bool larger, selas_simulation **simulation)
{
    selas_status status = open_plain(deck, simulation);
    if (status != SELAS_OK) return status;
    struct scene *scene = (*simulation)->scene;
    const double coarser = coarsening(scene);
    const double spacing = dividing_spacing(&scene->body, scene->dimension, coarser * scene->body.spacing);
    keep_layers(scene);
    if (spacing > scene->body.spacing) scene->body.spacing = spacing;
    scene->stepping.unwarp = false;
    scene->stepping.unwarp_given = true;
    if (larger) enlarge(scene);
    return scene_grade(scene);
}

/* The shorter one of the steps that the two choose, which then are open anew. */
static selas_status common_step(const struct echo_deck *deck, selas_simulation **one,
                                selas_simulation **other, double *step)
{
    selas_status status = selas_step(*one, 0);
    if (status == SELAS_OK) status = selas_step(*other, 0);
    if (status != SELAS_OK) return status;
    *step = fmin(selas_time_step(*one), selas_time_step(*other));
    selas_close(one);
    selas_close(other);
    status = open_coarse(deck, false, one);
    if (status == SELAS_OK) status = open_coarse(deck, true, other);
    return status;
}

static void tell_expected(const struct scene *scene)
{
    struct rest rest;
    if ((scene_needs(scene) & CAN_DAMP) != 0) {
        printf("echo expected: not known (dampers)\n");
        return;
    }
    printf("echo expected: %.2e (at the worst of them, this spacing%s)\n", expected_at_worst(scene),
           ground_is_general(scene) ? "; a law of level ground, which this is not" : "");
    if (worst_rest(scene, &rest))
        printf("expected of what stays: %.2e of the displacement at %s at the end\n", rest.error,
               scene->receiver[rest.receiver].name);
}

selas_status check_echo(const struct echo_deck *deck)
{
    selas_simulation *one = NULL, *other = NULL;
    double *small = NULL, *large = NULL, step = 0;
    size_t rows = 0;
    selas_status status = open_coarse(deck, false, &one);
    if (status == SELAS_OK && (!body_is_box(&one->scene->body) || one->scene->receivers == 0)) {
        fprintf(stderr, "error: --echo needs a box or a half-space with receivers\n");
        status = SELAS_UNSUPPORTED;
    }
    if (status == SELAS_OK) status = open_coarse(deck, true, &other);
    if (status == SELAS_OK) status = common_step(deck, &one, &other, &step);
    if (status == SELAS_OK) status = run(one, step, &small, &rows);
    if (status == SELAS_OK) status = run(other, step, &large, &rows);
    if (status == SELAS_OK) {
        tell(one->scene, small, large, rows);
        tell_expected(one->scene);
    } else {
        fputs(selas_message(other != NULL ? other : one), stderr);
    }
    free(small);
    free(large);
    selas_close(&one);
    selas_close(&other);
    return status;
}
