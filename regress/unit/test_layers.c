/* Layered ground by the consistent method, exact mass and H-form: interfaces at their depth, energy,
 * reflection and transmission at normal incidence. */
#include "consistent_run.h"

#include <math.h>
#include <omp.h>
#include <string.h>

/* Second material below `top`. */
static void layered_box(struct plain_scene *plain, int dimension, const double size[3], double spacing,
                        double top)
{
    plain_box(plain, dimension, size, spacing);
    plain->scene.body.layers = 2;
    plain->layer[0] = (struct layer){.material = 0, .top = 0};
    plain->layer[1] = (struct layer){.material = 1, .top = top};
}

/* Vertical load on a layered block whose sides slide: u_z is linear in each layer with one stress; the spline
 * with its kink at the interface, which is no multiple of the spacing, is in balance to rounding. */
static void test_kink(void **state)
{
    (void)state;
    const double top = .83, depth = 1.8, pressure = .7;
    for (int dimension = 1; dimension <= 3; dimension++)
        for (int sweeps = 0; sweeps <= 3; sweeps += 3)
            for (int p = 1; p <= 3; p++) {
                struct plain_scene plain;
                const double size[3] = {dimension == 1 ? depth : 1.2, dimension == 2 ? depth : 1.2, depth};
                layered_box(&plain, dimension, size, .3, top);
                const int last = dimension - 1;
                for (int face = 0; face < 2 * last; face++)
                    plain.scene.boundary[face].kind = BOUNDARY_ROLLER;
                double push[3] = {0}, pull[3] = {0};
                push[last] = pressure;
                pull[last] = -pressure;
                plain_face_load(&plain, (enum face)(2 * last), push);
                plain_face_load(&plain, (enum face)(2 * last + 1), pull);
                struct run run = run_new(&plain, (struct consistent_options){.degree = p, .sweeps = sweeps});
                struct consistent *c = consistent_of(run.model);
                const struct material *m = plain.material;
                for (size_t i = 0; i < c->volume; i++) {
                    const double z = c->spline[last]->greville[i / c->plane];
                    const double stretch[2] = {-pressure / (m[0].lambda + 2 * m[0].mu),
                                               -pressure / (m[1].lambda + 2 * m[1].mu)};
                    run.y[(size_t)last * c->volume + i] =
                        z < top ? stretch[0] * (z - top) : stretch[1] * (z - top);
                }
                const double ones[PLAIN_LOADS] = {1, 1};
                run.model->spatial->accelerate(run.model, &(struct drive){.load = ones}, 0, run.y, NULL,
                                               run.a);
                for (size_t i = 0; i < run.n; i++)
                    assert_near(run.a[i], 0, 1e-9);
                run_free(&run);
            }
}

static double cross_energy(struct model *model, const double *u, const double *w)
{
    const size_t n = model->unknowns;
    double *y = calloc(2 * n, sizeof *y);
    struct energy plus, minus;
    for (size_t i = 0; i < n; i++)
        y[i] = u[i] + w[i];
    model->core->energy(model, y, &plus);
    for (size_t i = 0; i < n; i++)
        y[i] = u[i] - w[i];
    model->core->energy(model, y, &minus);
    free(y);
    return (plus.strain - minus.strain) / 4;
}

/* Leapfrog's energy is kept, and falls by what one damped face takes; with all faces damped the motion dies.
 */
static void test_energy(void **state)
{
    (void)state;
    for (int kind = 0; kind < 14; kind++) {
        const int face = kind % 7;
        struct plain_scene plain;
        layered_box(&plain, 3, (double[]){1.8, 1.5, 1.8}, .3, .83);
        if (face < 6) plain.scene.boundary[face].kind = BOUNDARY_TRANSMITTING;
        if (face != 2) plain.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_ROLLER;
        struct run run =
            run_new(&plain, (struct consistent_options){.degree = 2 + kind % 2, .sweeps = kind < 7 ? 0 : 3});
        double *before = calloc(2 * run.n, sizeof *before), *v = run.y + run.n, energy = 0;
        const double dt = .01;
        noise(run.n, run.y);
        run.model->spatial->accelerate(run.model, &(struct drive){0}, 0, run.y, NULL, v);
        memset(run.y, 0, run.n * sizeof *run.y);
        for (int step = 0; step < 60; step++) {
            memcpy(before, run.y, 2 * run.n * sizeof *before);
            leap(&run, &(struct drive){0}, dt);
            struct energy parts;
            run.model->core->energy(run.model, run.y, &parts);
            const double now = parts.kinetic + cross_energy(run.model, before, run.y);
            for (size_t i = 0; i < run.n; i++)
                before[run.n + i] = (before[run.n + i] + v[i]) / 2;
            double input, loss;
            run.model->core->power(run.model, &(struct drive){0}, before, &input, &loss);
            assert_true(face < 6 ? loss > 0 : loss == 0);
            if (step > 0) assert_near((energy - now - dt * loss) / energy, 0, 5e-12);
            energy = now;
        }
        free(before);
        run_free(&run);
    }
    for (int sweeps = 0; sweeps <= 3; sweeps += 3) {
        struct plain_scene plain;
        layered_box(&plain, 3, (double[]){1.8, 1.5, 1.8}, .3, .83);
        for (int face = 0; face < 6; face++)
            if (face != FACE_Z_LOW) plain.scene.boundary[face].kind = BOUNDARY_TRANSMITTING;
        struct run run = run_new(&plain, (struct consistent_options){.degree = 2, .sweeps = sweeps});
        noise(run.n, run.y + run.n);
        const double first = dot(run.n, run.y + run.n, run.y + run.n);
        for (int step = 0; step < 2500; step++)
            leap(&run, &(struct drive){0}, .02);
        assert_true(dot(run.n, run.y + run.n, run.y + run.n) <
                    1e-4 * first); /* the free face traps a little */
        run_free(&run);
    }
}

/* A pulse of stress f sent into a layered bar: v = f / Z1 comes to the interface, (Z1 - Z2) / (Z1 + Z2) of it
 * goes back, 2 Z1 / (Z1 + Z2) of it goes on, Z = rho c. Largest error of v at t = 2.5 over the largest v. */
static double bar_error(int degree, int sweeps, double spacing)
{
    struct plain_scene plain;
    layered_box(&plain, 1, (double[]){6, 0, 0}, spacing, 2.03);
    plain_face_load(&plain, FACE_X_LOW, (double[]){1, 0, 0});
    plain.scene.boundary[FACE_X_HIGH].kind = BOUNDARY_TRANSMITTING;
    struct run run = run_new(&plain, (struct consistent_options){.degree = degree, .sweeps = sweeps});
    const struct material *m = plain.material;
    const double z[2] = {m[0].density * m[0].p_speed, m[1].density * m[1].p_speed}, dt = .001, end = 2.5;
    for (int step = 0; step < 2500; step++) {
        const double s = (step * dt - .8) / .15, amplitude = exp(-s * s / 2);
        leap(&run, &(struct drive){.load = &amplitude}, dt);
    }
    double worst = 0;
    for (int i = 1; i < 110; i++) {
        const double x = .04 * i, now = end - dt / 2; /* v stands half a step back */
        const double there = x < 2.03 ? x / m[0].p_speed : 2.03 / m[0].p_speed + (x - 2.03) / m[1].p_speed;
        const double s = (now - there - .8) / .15, r = (now - (4.06 - x) / m[0].p_speed - .8) / .15;
        const double expected =
            x < 2.03 ? (exp(-s * s / 2) + (z[0] - z[1]) / (z[0] + z[1]) * exp(-r * r / 2)) / z[0]
                     : 2 / (z[0] + z[1]) * exp(-s * s / 2);
        double value[3];
        struct probe probe = {0};
        struct messages messages = {0};
        run.model->core->probe(run.model, (double[]){x, 0, 0}, &probe, &messages);
        run.model->core->observe(run.model, &probe, SELAS_VELOCITY, run.y, run.a, value);
        probe_free(&probe);
        worst = fmax(worst, fabs(value[0] - expected) * z[0]);
    }
    run_free(&run);
    return worst;
}

static void test_reflection(void **state)
{
    (void)state;
    for (int p = 1; p <= 3; p++)
        for (int sweeps = 0; sweeps <= 3; sweeps += 3) {
            const double coarse = bar_error(p, sweeps, .1), fine = bar_error(p, sweeps, .05);
            print_message("# degree %d, %d sweeps: %.3g -> %.3g\n", p, sweeps, coarse, fine);
            assert_true(fine < coarse / 3.5);
            assert_true(fine < (p == 1 ? .03 : 5e-4));
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kink),
        cmocka_unit_test(test_energy),
        cmocka_unit_test(test_reflection),
    };
    omp_set_num_threads(1); /* small models */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
