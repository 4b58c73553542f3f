/* Total-Lagrangian SPH in motion, stepped by the library's leapfrog: momentum, angular momentum, energy,
 * dampers, viscosity, waves in a bar. */
#include "base/memory.h"
#include "box_scene.h"
#include "method/total_lagrangian/total_lagrangian.h"
#include "points/lattice.h"
#include "stepping/stepping.h"

#include <stdio.h>
#include <string.h>

struct run {
    struct model *model;
    struct stepper *stepper;
    struct state state;
};

static struct tl_options options(int degree, enum elastic_law law, double hourglass)
{
    struct tl_options made = tl_default_options();
    made.degree = degree;
    made.law = law;
    made.hourglass = hourglass;
    return made;
}

static void start_with(struct run *run, struct scene *scene, const struct tl_options *choice,
                       const char *scheme)
{
    struct messages messages = {0};
    *run = (struct run){0};
    snprintf(scene->stepping.scheme, sizeof scene->stepping.scheme, "%s", scheme);
    scene->stepping.safety = .8;
    if (total_lagrangian_create(scene, choice, &run->model, &messages) != SELAS_OK ||
        stepper_create(run->model, &run->stepper, &messages) != SELAS_OK ||
        state_create(run->stepper, &run->state, &messages) != SELAS_OK)
        fail_msg("%s", messages.text);
}

static void start(struct run *run, struct scene *scene, const struct tl_options *choice)
{
    start_with(run, scene, choice, "leapfrog");
}

static void step(struct run *run, int steps)
{
    for (int k = 0; k < steps; k++)
        run->stepper->scheme->step(run->stepper, &run->state);
}

/* Sets the velocities and lets the scheme take them in. */
static void restart(struct run *run)
{
    if (run->stepper->scheme->start != NULL) run->stepper->scheme->start(run->stepper, &run->state);
}

static void finish(struct run *run)
{
    state_free(&run->state);
    stepper_free(&run->stepper);
    model_free(&run->model);
}

static double energy_of(const struct run *run)
{
    struct energy energy;
    run->model->core->energy(run->model, run->state.y, &energy);
    return energy.kinetic + energy.strain;
}

static void momenta(const struct run *run, double linear[3], double angular[3])
{
    const struct tl_model *tl = (const struct tl_model *)run->model;
    const double *u = run->state.y;
    const double *v = u + run->model->unknowns;
    memset(linear, 0, 3 * sizeof *linear);
    memset(angular, 0, 3 * sizeof *angular);
    for (size_t i = 0; i < run->model->points; i++) {
        double x[3];
        for (size_t c = 0; c < 3; c++) {
            x[c] = run->model->position[3 * i + c] + u[3 * i + c];
            linear[c] += tl->mass[i] * v[3 * i + c];
        }
        for (size_t c = 0; c < 3; c++) {
            const size_t a = (c + 1) % 3;
            const size_t b = (c + 2) % 3;
            angular[c] += tl->mass[i] * (x[a] * v[3 * i + b] - x[b] * v[3 * i + a]);
        }
    }
}

/* A small body flies, spins and vibrates for 10,000 steps. */
static void free_flight_keeps_momenta(void **state)
{
    (void)state;
    for (int law = 1; law < 3; law++) {
        struct box_scene box;
        struct run run;
        make_box(&box, 3, 1, .25);
        box.scene.end_time = 1000;
        struct tl_options choice = options(law, (enum elastic_law)law, .1); /* TL1 and TL2 */
        if (law == 2) choice.viscosity_alpha = .1;
        start(&run, &box.scene, &choice);
        double *v = run.state.y + run.model->unknowns;
        for (size_t i = 0; i < run.model->points; i++) {
            const double *x = run.model->position + 3 * i;
            v[3 * i] = .2 - .1 * x[1] + .03 * random_uniform(5, 3 * i);
            v[3 * i + 1] = -.1 + .1 * x[0] - .06 * x[2] + .03 * random_uniform(5, 3 * i + 1);
            v[3 * i + 2] = .3 + .06 * x[1] + .03 * random_uniform(5, 3 * i + 2);
        }
        restart(&run);
        double linear[3];
        double angular[3];
        double after[3];
        double spun[3];
        momenta(&run, linear, angular);
        const double before = energy_of(&run);
        step(&run, 10000);
        momenta(&run, after, spun);
        /* it has turned several times and flown far */
        assert_true(run.state.time > 100);
        double size = 0;
        double spin = 0;
        for (int c = 0; c < 3; c++) {
            size += linear[c] * linear[c];
            spin += angular[c] * angular[c];
        }
        for (int c = 0; c < 3; c++) {
            assert_near(after[c], linear[c], 1e-12 * sqrt(size));
            assert_near(spun[c], angular[c], 1e-12 * sqrt(spin));
        }
        if (law == 1) assert_near(energy_of(&run), before, 1e-3 * before);
        if (law == 2) assert_true(energy_of(&run) < before);
        finish(&run);
    }
}

/* The energy of a clamped body that vibrates freely stays within the square of the step. */
static void leapfrog_keeps_the_energy(void **state)
{
    (void)state;
    struct box_scene box;
    struct run run;
    make_box(&box, 2, 1, .1);
    box.scene.end_time = 1000;
    box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_FIXED;
    const struct tl_options choice = options(2, LAW_SAINT_VENANT_KIRCHHOFF, .1);
    start(&run, &box.scene, &choice);
    double *v = run.state.y + run.model->unknowns;
    for (size_t i = 0; i < run.model->points; i++)
        v[2 * i + 1] = .02 * run.model->position[3 * i];
    restart(&run);
    const double before = energy_of(&run);
    double most = before;
    double least = before;
    for (int k = 0; k < 4000; k++) {
        step(&run, 1);
        const double now = energy_of(&run);
        most = fmax(most, now);
        least = fmin(least, now);
    }
    assert_true(most - least < 2e-3 * before);
    assert_true(most - least > 1e-9 * before); /* and it is watched at all */
    finish(&run);
}

/* A pulse in a bar: arrives at its speed with its shape, and a transmitting end swallows it. */
static void bars_carry_and_swallow_waves(void **state)
{
    (void)state;
    struct box_scene box;
    struct run run;
    make_box(&box, 1, 10, .025);
    box.scene.end_time = 1000;
    box.scene.boundary[FACE_X_HIGH].kind = BOUNDARY_TRANSMITTING;
    const struct tl_options choice = options(2, LAW_LINEAR, .1);
    start(&run, &box.scene, &choice);
    const double speed = box.material.p_speed;
    double *u = run.state.y;
    double *v = u + run.model->unknowns;
    for (size_t i = 0; i < run.model->points; i++) {
        const double x = (run.model->position[3 * i] - 3) / .5;
        u[i] = exp(-x * x);
        v[i] = 2 * x / .5 * speed * u[i]; /* d'Alembert: moves to the right */
    }
    restart(&run);
    const double before = energy_of(&run);
    while (run.state.time < 4 / speed)
        step(&run, 1);
    double error = 0;
    double all = 0;
    for (size_t i = 0; i < run.model->points; i++) {
        const double x = (run.model->position[3 * i] - 3 - speed * run.state.time) / .5;
        error += pow(u[i] - exp(-x * x), 2);
        all += exp(-2 * x * x);
    }
    assert_true(sqrt(error / all) < .015); /* second order: .045 at twice the spacing */
    assert_near(energy_of(&run), before, 1e-3 * before);
    while (run.state.time < 10 / speed)
        step(&run, 1);
    assert_true(energy_of(&run) < 1e-5 * before);
    finish(&run);
}

/* A pulse leaves its stress, -rho c v, as it is up to a damper, which sends nothing back that is worth seeing. */
static void dampers_take_the_whole_stress(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        struct box_scene box;
        struct run run;
        make_box(&box, 2, 4, .05);
        box.scene.body.high[1] = 1;
        box.scene.end_time = 1000;
        box.scene.boundary[FACE_X_HIGH].kind = BOUNDARY_TRANSMITTING;
        box.scene.boundary[FACE_Y_LOW].kind = box.scene.boundary[FACE_Y_HIGH].kind = BOUNDARY_ROLLER;
        struct tl_options choice = options(1 + k % 2, LAW_LINEAR, .1);
        choice.central = k == 2;
        start(&run, &box.scene, &choice);
        const double speed = box.material.p_speed, impedance = box.material.density * speed;
        const size_t points = run.model->points;
        double *u = run.state.y, *v = u + run.model->unknowns;
        for (size_t i = 0; i < points; i++) {
            const double x = (run.model->position[3 * i] - 2) / .6;
            u[2 * i] = exp(-x * x);
            v[2 * i] = 2 * x / .6 * speed * u[2 * i];
        }
        restart(&run);
        const double before = energy_of(&run);
        double off = 0, largest = 0;
        while (run.state.time < 4 / speed) {
            step(&run, 1);
            for (size_t i = 0; i < points; i++) {
                double stress[6];
                if (run.model->position[3 * i] < 3.6) continue;
                run.model->core->field(run.model, SELAS_STRESS, u, run.state.a, i, i + 1, stress);
                off = fmax(off, fabs(stress[0] + impedance * v[2 * i]));
                largest = fmax(largest, fabs(impedance * v[2 * i]));
            }
        }
        assert_true(off < .1 * largest); /* more at the nearest point alone */
        assert_true(energy_of(&run) < 2e-4 * before);
        finish(&run);
    }
}

/* Dampers on faces that meet take the energy that power() says, whatever moves, with either scheme. */
static void dampers_take_energy(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        struct box_scene box;
        struct run run;
        make_box(&box, 2 + k % 2, 1, k % 2 == 0 ? .05 : .125);
        box.scene.end_time = 1000;
        for (int face = 1; face < 4 + 2 * (k % 2); face++)
            box.scene.boundary[face].kind = BOUNDARY_TRANSMITTING;
        struct tl_options choice = options(1 + k / 2 % 2, LAW_LINEAR, .1);
        choice.central = k > 3;
        start_with(&run, &box.scene, &choice, k % 4 < 2 ? "leapfrog" : "rk4");
        double *v = run.state.y + run.model->unknowns;
        for (size_t i = 0; i < run.model->unknowns; i++)
            v[i] = .01 * sin(1.7 * (double)(i * i % 1013));
        restart(&run);
        run.stepper->dt *= .2;
        const double before = energy_of(&run);
        double absorbed = 0, power[2][2];
        const struct drive quiet = {0};
        run.model->core->power(run.model, &quiet, run.state.y, &power[0][0], &power[0][1]);
        for (int n = 0; n < 400; n++) {
            step(&run, 1);
            run.model->core->power(run.model, &quiet, run.state.y, &power[n % 2 == 0][0],
                                   &power[n % 2 == 0][1]);
            absorbed += .5 * run.stepper->dt * (power[0][1] + power[1][1]);
        }
        assert_true(absorbed > .1 * before);
        assert_near(energy_of(&run) + absorbed, before, .01 * before);
        finish(&run);
    }
}

/* Viscosity takes energy from approaching points only, as much as power() says. */
static void viscosity_takes_energy(void **state)
{
    (void)state;
    struct box_scene box;
    struct run run;
    make_box(&box, 2, 1, .1);
    box.scene.end_time = 1000;
    struct tl_options choice = options(1, LAW_SAINT_VENANT_KIRCHHOFF, .1);
    choice.viscosity_alpha = .5;
    choice.viscosity_beta = .5;
    start(&run, &box.scene, &choice);
    double *v = run.state.y + run.model->unknowns;
    for (size_t i = 0; i < run.model->points; i++)
        v[2 * i] = .01 * sin(M_PI * run.model->position[3 * i]);
    restart(&run);
    const double before = energy_of(&run);
    double absorbed = 0;
    for (int k = 0; k < 400; k++) {
        double power[2][2];
        const struct drive quiet = {0};
        run.model->core->power(run.model, &quiet, run.state.y, &power[0][0], &power[0][1]);
        step(&run, 1);
        run.model->core->power(run.model, &quiet, run.state.y, &power[1][0], &power[1][1]);
        assert_true(power[1][1] >= 0);
        absorbed += .5 * run.stepper->dt * (power[0][1] + power[1][1]);
    }
    assert_true(absorbed > .1 * before);
    assert_near(energy_of(&run) + absorbed, before, .01 * before);
    finish(&run);
}

/* The modified equation begins with the third derivative of u, an operator on velocities. They are no
 * displacements to a nonlinear law: in units in which waves take thousandths of a second velocities of a
 * small motion would turn the body inside out. */
static void velocities_are_no_displacements(void **state)
{
    (void)state;
    double moved[2][3] = {{0}};
    for (int second = 0; second < 2; second++) {
        struct box_scene box;
        struct run run;
        make_box(&box, 2, 1, .1);
        box.scene.end_time = 1000;
        const double stiff = 1e6;
        box.material.lambda *= stiff;
        box.material.plane_lambda *= stiff;
        box.material.mu *= stiff;
        box.material.young *= stiff;
        box.material.p_speed *= sqrt(stiff);
        box.material.s_speed *= sqrt(stiff);
        const struct tl_options choice = options(2, LAW_NEO_HOOKEAN, .1);
        start_with(&run, &box.scene, &choice, second ? "modified-equation" : "leapfrog");
        run.stepper->dt = 1e-5;
        double *v = run.state.y + run.model->unknowns;
        for (size_t i = 0; i < run.model->points; i++)
            v[2 * i] = 5 * cos(M_PI * run.model->position[3 * i]);
        restart(&run);
        step(&run, 20);
        for (size_t i = 0; i < run.model->points; i++) {
            const double ux = run.state.y[2 * i];
            moved[second][0] += ux * ux;
            moved[second][1] += fabs(ux * run.model->position[3 * i]);
            moved[second][2] = fmax(moved[second][2], fabs(ux));
        }
        finish(&run);
    }
    assert_true(moved[0][2] > 1e-4 && moved[0][2] < 2e-3);
    for (int k = 0; k < 3; k++)
        assert_near(moved[1][k], moved[0][k], .01 * moved[0][k]);
}

/* On a face the motion is what the face prescribes. */
static void faces_move_as_they_should(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        struct box_scene box;
        struct run run;
        make_box(&box, 2 + k / 3, 1, k < 3 ? .1 : .2);
        struct boundary *moved = &box.scene.boundary[FACE_X_LOW];
        moved->kind = BOUNDARY_DISPLACEMENT;
        moved->amplitude = .01;
        moved->direction[0] = k < 3 ? .6 : 1; /* the roller is near in space */
        moved->direction[1] = k < 3 ? .8 : 0;
        moved->history = (struct history){.kind = HISTORY_GAUSSIAN, .width = .2, .delay = .7};
        box.scene.boundary[FACE_X_HIGH].kind = BOUNDARY_FIXED;
        box.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_ROLLER;
        struct tl_options choice = options(1 + k % 3 % 2, LAW_LINEAR, .1);
        choice.central = k % 3 == 2;
        start(&run, &box.scene, &choice);
        while (run.state.time < .8)
            step(&run, 1);
        const struct tl_model *tl = (const struct tl_model *)run.model;
        const double *drive[3] = {tl->displacement, tl->velocity, tl->acceleration};
        for (int place = 0; place < 3; place++) {
            const double z = k < 3 ? 0 : .31, at[3][3] = {{0, .43, z}, {1, .43, z}, {.52, 0, z}};
            struct probe probe;
            struct messages messages = {0};
            assert_int_equal(run.model->core->probe(run.model, at[place], &probe, &messages), SELAS_OK);
            for (int field = SELAS_DISPLACEMENT; field < 3; field++) {
                double value[3];
                const double *y = run.state.y;
                run.model->core->observe(run.model, &probe, (selas_field)field, y, run.state.a, value);
                for (int c = 0; c < 2; c++)
                    if (place < 2 || c == 1)
                        assert_near(value[c], place > 0 ? 0 : .01 * moved->direction[c] * drive[field][0],
                                    1e-12);
            }
            probe_free(&probe);
            messages_free(&messages);
        }
        finish(&run);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_flight_keeps_momenta),
        cmocka_unit_test(leapfrog_keeps_the_energy),
        cmocka_unit_test(bars_carry_and_swallow_waves),
        cmocka_unit_test(dampers_take_the_whole_stress),
        cmocka_unit_test(dampers_take_energy),
        cmocka_unit_test(viscosity_takes_energy),
        cmocka_unit_test(velocities_are_no_displacements),
        cmocka_unit_test(faces_move_as_they_should),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
