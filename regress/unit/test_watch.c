/* The watch over runs of every method: a number that is not finite, one that overflows, and growth from one
 * place are found within a hundred steps wherever they are put (body, border, absorbing layer and its memory,
 * density and stress of particles), and the message says when, where and why. */
#include "host/simulation.h"
#include "method/consistent/absorbing/pml.h"
#include "method/consistent/consistent.h"

#include "few.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>

enum { BEFORE = 70, WITHIN = 100 };

enum fault { NOT_FINITE, OVERFLOW, GROWTH };
static const char *const fault_name[] = {"not a number", "overflow", "growth"};

struct family {
    const char *what, *method, *boundary, *cause;
};

static const double spacing = 0.25;

static selas_simulation *begun(const struct family *family)
{
    char deck[1500];
    const bool space = strstr(family->what, "whole steps") != NULL; /* these are made in space only */
    snprintf(deck, sizeof deck,
             "&scene dimension = %d, end_time = 100.0 /\n&method %s /\n"
             "&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
             "&body material = 'rock', shape = 'box', low = 0, 0%s, high = %s, spacing = %g /\n%s"
             "&load face = 'y-', shape = 'square', centre = 3, 0%s, size = 2%s, direction = 0, 1%s\n"
             "  amplitude = 0.001, history = 'gaussian', width = 0.3, delay = 1.2 /\n"
             "&receiver name = 'r', position = 3, 1%s /\n",
             space ? 3 : 2, family->method, space ? ", 0" : "", space ? "6, 5, 3" : "8, 6", spacing,
             family->boundary, space ? ", 1" : "", space ? ", 1" : "", space ? ", 0" : "",
             space ? ", 1" : "");
    selas_simulation *simulation = NULL;
    if (selas_open_text("watch", deck, &simulation) != SELAS_OK || selas_step(simulation, BEFORE) != SELAS_OK)
        fail_msg("%s: %s", family->what, selas_message(simulation));
    return simulation;
}

static double place_of(const char *text, double x[3])
{
    const char *about = strstr(text, "about ("), *at = strstr(text, "at (");
    const char *place = about != NULL ? about + 7 : at != NULL ? at + 4 : "";
    return sscanf(place, "%lf, %lf, %lf", x, x + 1, x + 2);
}

/* Puts the fault into number `index` of the state, at `place`, and steps until it is found, at most `off`
 * spacings off. What is not finite has spread when it is found: at a border, where it spreads to one side
 * only, its middle lies further in. */
static void plant(const struct family *family, const char *where, size_t index, const double place[2],
                  double off, const char *behind, enum fault fault)
{
    selas_simulation *simulation = begun(family);
    if (behind == NULL && index == SIZE_MAX) fail_msg("%s: no such place", where);
    double *y = simulation->state.y, size = 1e-5, x[3];
    assert_true(index < simulation->model->state_size);
    if (fault == NOT_FINITE) y[index] = NAN;
    if (fault == OVERFLOW) y[index] = 1e200;
    selas_status status = SELAS_OK;
    int steps = 0;
    for (; steps < WITHIN && status == SELAS_OK; steps++) {
        if (fault == GROWTH) y[index] += size;
        size *= 1.5;
        status = selas_step(simulation, 1);
    }
    const char *said = strstr(selas_message(simulation), "error: ");
    if (status != SELAS_UNSTABLE || said == NULL)
        fail_msg("%s, %s, %s: not found in %d steps: %s", family->what, where, fault_name[fault], steps,
                 selas_message(simulation));
    double time = -1;
    assert_true(sscanf(strstr(said, "t = "), "t = %lf", &time) == 1 &&
                fabs(time - simulation->state.time) <= 1e-5 * time);
    const char *cause = strstr(said, "likely: ");
    if (cause == NULL || strstr(cause, family->cause) == NULL)
        fail_msg("%s: the cause in '%s'", family->what, said);
    if (place_of(said, x) != 3)
        fail_msg("%s, %s, %s: no place in '%s'", family->what, where, fault_name[fault], said);
    const double away = hypot(x[0] - place[0], x[1] - place[1]) / spacing;
    print_message("# %s, %s, %s: after %d steps, %.1f spacings off\n", family->what, where, fault_name[fault],
                  steps, away);
    if (!(away <= off))
        fail_msg("%s, %s, %s: %.1f spacings off: '%s'", family->what, where, fault_name[fault], away, said);
    if (behind != NULL && strstr(said, behind) == NULL)
        fail_msg("%s: not %s: '%s'", family->what, behind, said);
    selas_close(&simulation);
}

static void plant_all(const struct family *family, const char *where, size_t index, const double place[2],
                      double off, const char *behind)
{
    for (enum fault fault = (enum fault)few_of(NOT_FINITE, GROWTH); fault <= GROWTH; fault++)
        plant(family, where, index, place, off, behind, fault);
}

/* Particle or lattice point nearest to a place, and where it is. */
static size_t nearest(const struct model *model, const double place[2], double found[2])
{
    size_t best = 0;
    double least = INFINITY;
    for (size_t i = 0; i < model->points; i++) {
        double x[3];
        model_position(model, i, x);
        const double away = hypot(x[0] - place[0], x[1] - place[1]);
        if (away >= least) continue;
        least = away;
        best = i;
        found[0] = x[0];
        found[1] = x[1];
    }
    return best;
}

/* Methods whose unknowns are those of their points: velocity of a point inside, and of one at the border.
 * (In the updated form a number that is not finite at the end of a row of particles may spoil the row's other
 * end too: eight particles are summed at a time, with weights that are 0 for some. With a moved face the
 * border is that along the rows.) */
static void at_points(const struct family *family)
{
    selas_simulation *simulation = begun(family);
    const struct model *model = simulation->model;
    const bool along = strstr(family->what, "updated Lagrangian, ") != NULL;
    const double wanted[2][2] = {{5.6, 3.1}, {along ? 4.9 : 8, along ? 6 : 2.1}};
    double place[2][2];
    size_t index[2];
    for (int k = 0; k < 2; k++)
        index[k] = model->unknowns + nearest(model, wanted[k], place[k]) * model->point_stride;
    selas_close(&simulation);
    plant_all(family, "inside", index[0], place[0], 2, NULL);
    plant_all(family, "at the border", index[1], place[1], 4, NULL);
}

static void test_paper(void **state)
{
    (void)state;
    static const struct family family = {"paper", "variant = 'paper'",
                                         "&boundary face = 'x+', 'y+', kind = 'transmitting' /\n",
                                         "is not symmetric"};
    at_points(&family);
}

static void test_total_lagrangian(void **state)
{
    (void)state;
    static const struct family all[] = {
        {"total Lagrangian, linear", "name = 'sph', variant = 'total-lagrangian', gradient = 'linear'", "",
         ""},
        {"total Lagrangian, quadratic", "name = 'sph', variant = 'total-lagrangian', gradient = 'quadratic'",
         "", ""},
        {"cloud", "variant = 'cloud'", "", ""},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        at_points(&all[i]);
}

static void test_updated_lagrangian(void **state)
{
    (void)state;
    static const struct family family = {"updated Lagrangian", "name = 'sph', variant = 'updated-lagrangian'",
                                         "", "from particle to particle"};
    at_points(&family);
    selas_simulation *simulation = begun(&family);
    const struct model *model = simulation->model;
    static const double wanted[2] = {5.6, 3.1};
    double place[2];
    const size_t i = nearest(model, wanted, place);
    const size_t density = 2 * model->unknowns + i, stress = 2 * model->unknowns + model->points + 3 * i;
    assert_true(fabs(simulation->state.y[density] - 1) < .01);
    selas_close(&simulation);
    for (enum fault fault = NOT_FINITE; fault <= OVERFLOW; fault++) {
        plant(&family, "density", density, place, 2, NULL, fault);
        plant(&family, "stress", stress, place, 2, NULL, fault);
    }
    static const struct family held = {"updated Lagrangian, held",
                                       "name = 'sph', variant = 'updated-lagrangian', hourglass = .1", "",
                                       "free to turn; method%variant"};
    plant(&held, "density", density, place, 2, NULL, OVERFLOW);
}

/* The consistent method: control values of the body, of a layer, and the layer's memory. */
static void test_consistent(void **state)
{
    (void)state;
    static const struct family family = {"consistent", "symmetry = .false.",
                                         "&boundary face = 'x+', 'y+', kind = 'transmitting', layer = 'pml', "
                                         "layer_points = 8, always = .true. /\n",
                                         "absorbing face"};
    selas_simulation *simulation = begun(&family);
    const struct consistent *c = consistent_of(simulation->model);
    assert_true(c->pml != NULL && c->pml->slabs == 2 && c->plane == c->n[0]);
    const struct slab *slab = &c->pml->slab[0];
    assert_true(slab->axis == 0);
    const size_t n = simulation->model->unknowns, inside[2] = {14, 9}, deep = 3, row = 10;
    const size_t layer[2] = {slab->inside.at[c->slot[0]] + deep, row};
    const double body[2] = {c->spline[0]->greville[inside[0]], c->spline[1]->greville[inside[1]]};
    const double there[2] = {c->spline[0]->greville[layer[0]], c->spline[1]->greville[layer[1]]};
    assert_true(body[0] < 8 && there[0] > 8.2);
    assert_true(c->slot[0] == 0 && c->slot[1] == 2);
    const size_t own = (row - slab->inside.at[2]) * slab->inside.n[0] + deep;
    const size_t psi = 2 * n + slab->psi + own, phi = 2 * n + slab->phi + own;
    const double zero[2] = {c->spline[0]->greville[0], c->spline[1]->greville[0]};
    const size_t in_body = n + inside[0] + inside[1] * c->plane;
    const size_t in_layer = n + layer[0] + layer[1] * c->plane;
    selas_close(&simulation);
    plant_all(&family, "inside", in_body, body, 2, NULL);
    /* passes take four planes together, with weights that are 0 for some: what is no number spoils up to three more */
    plant(&family, "at a corner", n, zero, 7, NULL, NOT_FINITE);
    for (enum fault fault = OVERFLOW; fault <= GROWTH; fault++)
        plant(&family, "at a corner", n, zero, 6, NULL, fault);
    plant_all(&family, "in the layer", in_layer, there, 2, "behind face x+");
    plant_all(&family, "in the layer's memory of strain", psi, there, 2, "behind face x+");
    plant_all(&family, "in the layer's memory of stress", phi, there, 2, "behind face x+");
}

/* Whole steps of the fused operator keep velocities of their own: here the displacement is spoiled. */
static void test_whole_steps(void **state)
{
    (void)state;
    static const struct family family = {"consistent, whole steps", "symmetry = .false.", "",
                                         "none that is known"};
    selas_simulation *simulation = begun(&family);
    const struct consistent *c = consistent_of(simulation->model);
    assert_true(simulation->stepper->one_pass);
    const size_t inside[2] = {14, 9}, index = inside[0] + c->n[0] * inside[1] + 6 * c->plane;
    const double place[2] = {c->spline[0]->greville[inside[0]], c->spline[1]->greville[inside[1]]};
    selas_close(&simulation);
    plant_all(&family, "inside", index, place, 2, NULL);
}

/* The consistent method: velocity of a control value inside, and of one beside face x-. */
static void at_control_values(const struct family *family)
{
    selas_simulation *simulation = begun(family);
    const struct consistent *c = consistent_of(simulation->model);
    static const size_t at[2][2] = {{14, 9}, {1, 12}};
    double place[2][2];
    size_t index[2];
    for (int k = 0; k < 2; k++) {
        index[k] = simulation->model->unknowns + at[k][0] + at[k][1] * c->plane;
        for (int axis = 0; axis < 2; axis++)
            place[k][axis] = c->spline[axis]->greville[at[k][axis]];
    }
    selas_close(&simulation);
    plant_all(family, "inside", index[0], place[0], 2, NULL);
    plant_all(family, "beside the moved face", index[1], place[1], 6, NULL);
}

/* Bodies that a moved face drives, for whose energy there is no balance: a face that comes to rest, one that
 * goes on with a steady speed (the whole body follows), one that shakes to the end, and one that may slip. */
static void test_moved_faces(void **state)
{
    (void)state;
    static const char moved[] =
        "&boundary face = 'x-', kind = 'displacement', direction = 1, 0.5, history = 'gaussian',\n"
        "  width = 0.25, delay = 1.2, amplitude = 0.05 /\n";
    static const char pushed[] =
        "&boundary face = 'x-', kind = 'velocity', direction = 1, 0, history = 'step', smoothing = 0.5,\n"
        "  amplitude = 0.05 /\n";
    static const char shaken[] =
        "&boundary face = 'x-', kind = 'displacement', direction = 0, 1, history = 'sine-burst',\n"
        "  frequency = 0.2, cycles = 30, amplitude = 0.05 /\n";
    static const char slipping[] =
        "&boundary face = 'x-', kind = 'velocity', slip = .true., direction = 1, 0, history = 'step',\n"
        "  smoothing = 0.5, amplitude = 0.05 /\n";
    static const char none[] = "none that is known", any[] = "";
    static const char total[] = "name = 'sph', variant = 'total-lagrangian'";
    static const struct family all[] = {
        {"consistent, moved face", "symmetry = .false.", moved, none},
        {"consistent, pushed face", "symmetry = .false.", pushed, none},
        {"consistent, shaken face", "symmetry = .false.", shaken, none},
        {"consistent, slipping face", "degree = 2, mass = 'vc3', symmetry = .false.", slipping, none},
        {"consistent, moved face beside a layer", "symmetry = .false.",
         "&boundary face = 'x-', kind = 'displacement', direction = 1, 0.5, history = 'gaussian',\n"
         "  width = 0.25, delay = 1.2, amplitude = 0.05 /\n"
         "&boundary face = 'x+', kind = 'transmitting', layer = 'pml', layer_points = 8, always = .true. /\n",
         "absorbing face"},
        {"total Lagrangian, moved face", total, moved, any},
        {"total Lagrangian, pushed face", total, pushed, any},
        {"updated Lagrangian, pushed face", "name = 'sph', variant = 'updated-lagrangian'", pushed,
         "from particle to particle"},
        {"paper, moved face", "variant = 'paper'", moved, "is not symmetric"},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (strncmp(all[i].what, "consistent", 10) == 0)
            at_control_values(&all[i]);
        else
            at_points(&all[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_consistent),
        cmocka_unit_test(test_whole_steps),
        cmocka_unit_test(test_paper),
        cmocka_unit_test(test_total_lagrangian),
        cmocka_unit_test(test_updated_lagrangian),
        cmocka_unit_test(test_moved_faces),
    };
    omp_set_num_threads(1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
