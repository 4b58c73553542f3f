/* Dissipation of the shortest waves (method%dissipation): what it leaves alone, how fast waves die, its sign,
 * the bound on its rate. */
#include "consistent_run.h"

#include <math.h>
#include <omp.h>

static struct consistent_options dissipative(int degree, double dissipation)
{
    return (struct consistent_options){.degree = degree, .sweeps = 3, .dissipation = dissipation};
}

/* -rate P v of the velocities in run->y. */
static void damp(struct run *run)
{
    run->model->spatial->accelerate(run->model, &(struct drive){0}, 0, run->y, run->y + run->n, run->a);
}

/* Cubic motions feel nothing, also at faces, where noise does. */
static void test_cubics(void **state)
{
    (void)state;
    for (int p = 1; p <= 4; p++)
        for (int mapped = 0; mapped < 2; mapped++) {
            struct plain_scene plain;
            plain_box(&plain, 3, (double[]){4.2, 3.9, 4.8}, .3);
            struct consistent_options options = dissipative(p, .5);
            options.mapped = mapped;
            struct run run = run_new(&plain, options);
            struct consistent *c = consistent_of(run.model);
            double largest = 0;
            noise(run.n, run.y + run.n);
            damp(&run);
            for (size_t i = 0; i < run.n; i++)
                largest = fmax(largest, fabs(run.a[i]));
            assert_true(largest > .01);
            for (size_t q = 0; q < c->volume; q++) {
                const double x = c->spline[0]->greville[q % c->n[0]] - 2;
                const double y = c->spline[1]->greville[q / c->n[0] % c->n[1]] - 2;
                const double z = c->spline[2]->greville[q / c->plane] - 2;
                run.y[run.n + q] = x * x * x + x * y * z - 2 * y * y * z;
                run.y[run.n + c->volume + q] = 3 - y * y * y + x * z;
                run.y[run.n + 2 * c->volume + q] = x * x * z + y - z * z * z;
            }
            damp(&run);
            for (size_t i = 0; i < run.n; i++)
                assert_near(run.a[i], 0, 1e-11 * largest);
            run_free(&run);
        }
}

/* Rate of a plane wave along x with angle theta a point: N^ (2 sin(theta/2))^8 / (256 (sweeps + 1)) rate, N^
 * = (1 - (1 - M^)^4) / M^, M^ = (66 + 52 cos + 2 cos 2) / 120; of order theta^8 for long waves. */
static void test_rate(void **state)
{
    (void)state;
    static const double points[] = {2, 4, 6, 10};
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){9, 6, 6}, .3);
    struct run run = run_new(&plain, dissipative(2, .5));
    struct consistent *c = consistent_of(run.model);
    const size_t middle = c->n[0] / 2 + c->n[0] * (c->n[1] / 2) + c->plane * (c->n[2] / 2);
    for (int i = 0; i < 4; i++) {
        const double theta = 2 * M_PI / points[i], mass = (66 + 52 * cos(theta) + 2 * cos(2 * theta)) / 120;
        const double inverse = (1 - pow(1 - mass, 4)) / mass;
        const double expected =
            .5 * plain.material[0].p_speed / .3 * inverse * pow(2 * sin(theta / 2), 8) / 1024;
        for (size_t q = 0; q < c->volume; q++) {
            const double phase = theta * ((double)(q % c->n[0]) - (double)(c->n[0] / 2));
            for (size_t component = 0; component < 3; component++)
                run.y[run.n + component * c->volume + q] = cos(phase);
        }
        damp(&run);
        for (size_t component = 0; component < 3; component++)
            assert_near(-run.a[component * c->volume + middle] / expected, 1, 1e-9);
    }
    run_free(&run);
}

/* The rate's bound is one, and not a wild one. */
static void test_bound(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){4.2, 3.9, 4.8}, .3);
    struct run run = run_new(&plain, dissipative(2, .5));
    double rate = 0;
    noise(run.n, run.y + run.n);
    for (int iteration = 0; iteration < 300; iteration++) {
        damp(&run);
        rate = sqrt(dot(run.n, run.a, run.a) / dot(run.n, run.y + run.n, run.y + run.n));
        for (size_t i = 0; i < run.n; i++)
            run.y[run.n + i] = -run.a[i] / rate;
    }
    assert_true(rate <= run.model->dissipation);
    assert_true(rate >= .4 * run.model->dissipation);
    run_free(&run);
}

static double taken(struct run *run, const double *v)
{
    double load, absorbed;
    double *y = calloc(2 * run->n, sizeof *y);
    memcpy(y + run->n, v, run->n * sizeof *y);
    run->model->core->power(run->model, &(struct drive){0}, y, &load, &absorbed);
    free(y);
    return absorbed;
}

/* M P is symmetric and not negative: with free faces, held ones, mirrors and layers. v.MPw from powers
 * against the same from accelerations: symmetric or the two differ. */
static void test_sign(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        struct plain_scene plain;
        plain_box(&plain, 3, (double[]){4.2, 3.9, 4.8}, .3);
        if (kind == 1) plain.scene.boundary[FACE_X_LOW].kind = BOUNDARY_FIXED;
        if (kind == 1) plain.scene.boundary[FACE_Z_HIGH].kind = BOUNDARY_ROLLER;
        if (kind == 2) plain.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_SYMMETRY;
        if (kind == 3) plain.scene.body.layers = 2;
        plain.layer[1] = (struct layer){.material = 1, .top = 1.5};
        struct run run = run_new(&plain, dissipative(kind == 2 ? 3 : 2, .5));
        double *mixed = calloc(run.n, sizeof *mixed), *v = run.y + run.n, *w = calloc(run.n, sizeof *w);
        noise(run.n, v);
        damp(&run); /* admissible: 0 where held */
        memcpy(v, run.a, run.n * sizeof *v);
        damp(&run);
        memcpy(w, run.a, run.n * sizeof *w); /* w = -rate P v */
        const double of_v = taken(&run, v), of_w = taken(&run, w);
        assert_true(of_v > 0 && of_w > 0);
        struct energy parts;
        run.model->core->energy(run.model, run.y, &parts);
        const double kinetic_v = parts.kinetic;
        memcpy(v, w, run.n * sizeof *v);
        run.model->core->energy(run.model, run.y, &parts);
        const double kinetic_w = parts.kinetic; /* (rate P v).M (rate P v) / 2 */
        damp(&run);
        memcpy(v, run.a, run.n * sizeof *v); /* (rate P)^2 v0, v0 = the first v */
        for (size_t i = 0; i < run.n; i++)
            mixed[i] = w[i] + v[i];
        const double cross = (taken(&run, mixed) - taken(&run, w) - taken(&run, v)) / 2;
        assert_true(kinetic_v > 0);
        /* Cauchy-Schwarz for the form, and P being its own adjoint: w.MP(Pw) = Pw.M(Pw) */
        assert_true(cross * cross <= taken(&run, w) * taken(&run, v) * (1 + 1e-9));
        run.model->core->energy(run.model, run.y, &parts);
        assert_near(-cross / (2 * parts.kinetic), 1, 1e-9);
        assert_true(kinetic_w > 0);
        free(mixed);
        free(w);
        run_free(&run);
    }
}

/* Leapfrog at .9 of the limit omega^2 dt^2 + 2 rate dt = 4, free faces, from noise: the energy never exceeds
 * its first value and falls. */
static void test_energy(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){3.0, 2.7, 3.3}, .3);
    struct run run = run_new(&plain, dissipative(2, .5));
    const double omega = 4.65 * 1.3 * plain.material[0].p_speed / .3, rate = run.model->dissipation;
    const double dt = .9 * (sqrt(rate * rate + 4 * omega * omega) - rate) / (omega * omega);
    double first = 0, last = 0;
    noise(run.n, run.y);
    for (int step = 0; step < 2000; step++) {
        leap(&run, &(struct drive){0}, dt);
        if (step % 20 != 0) continue;
        struct energy parts;
        run.model->core->energy(run.model, run.y, &parts);
        if (step == 0) first = parts.kinetic + parts.strain;
        last = parts.kinetic + parts.strain;
        assert_true(last <= first * 1.001);
    }
    assert_true(last < .3 * first);
    run_free(&run);
}

/* What is off takes no memory: no state beyond u and v, no plan, no bytes. */
static void test_off(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){3.0, 2.7, 3.3}, .3);
    struct run off = run_new(&plain, dissipative(2, 0)), on = run_new(&plain, dissipative(2, .5));
    assert_int_equal(off.model->state_size, 2 * off.n);
    assert_null(consistent_of(off.model)->hform->dissipation);
    assert_null(consistent_of(off.model)->hform->smoother[0][0]);
    assert_null(consistent_of(off.model)->pml);
    assert_true(off.model->dissipation == 0);
    assert_true(on.model->dissipation > 0);
    assert_int_equal(on.model->state_size, off.model->state_size);
    assert_int_equal(on.model->bytes - off.model->bytes,
                     tensor_plan_bytes(consistent_of(on.model)->hform->dissipation));
    run_free(&off);
    run_free(&on);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_off),   cmocka_unit_test(test_cubics), cmocka_unit_test(test_rate),
        cmocka_unit_test(test_bound), cmocka_unit_test(test_sign),   cmocka_unit_test(test_energy),
    };
    (void)plain_face_load;
    omp_set_num_threads(1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
