/* Updated-Lagrangian SPH with forces by the adjoint of the velocity gradient and with hourglass control: the
 * power of the stresses is the work of the forces, the control is symmetric, resists what alternates and lets
 * linear motions pass. */
#include "points/lattice.h"
#include "updated_run.h"

#include "near.h"

#include <stdlib.h>

static double scatter(size_t k)
{
    return 2 * random_uniform(11, k) - 1;
}

/* A jittered box, fixed at x-, symmetric at y-, else free (all free without walls). */
static void box(struct fixture *f, int dimension, bool walls)
{
    const double size[3] = {1, .8, .6};
    plain_box(&f->plain, dimension, size, .1);
    f->plain.scene.body.jitter = .1;
    if (walls) {
        f->plain.scene.boundary[FACE_X_LOW].kind = BOUNDARY_FIXED;
        f->plain.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_SYMMETRY;
    }
    f->options = updated_lagrangian_published();
    f->options.alpha = f->options.beta = f->options.artificial_stress = 0;
    f->options.jaumann = false;
}

static void evaluate(struct fixture *f)
{
    const struct drive quiet = {.time = 0};
    updated_rate(f->model, &quiet, f->y, f->rate);
}

static double energy_at(struct fixture *f, size_t first, size_t last, double step)
{
    for (size_t k = first; k < last; k++)
        f->y[k] += step * f->rate[k];
    struct energy energy;
    updated_energy(f->model, f->y, &energy);
    for (size_t k = first; k < last; k++)
        f->y[k] -= step * f->rate[k];
    return energy.kinetic + energy.strain;
}

/* d(kinetic)/dt + d(strain)/dt = 0 at rest for random velocities and stresses. The energies are quadratic, so
 * that central differences are exact. The published forces miss it by more than a tenth. */
static void power(void **unused)
{
    (void)unused;
    for (int d = 1; d <= 3; d++)
        for (int adjoint = 0; adjoint <= 1; adjoint++) {
            struct fixture f;
            box(&f, d, d > 1);
            f.options.adjoint = adjoint;
            make(&f);
            const size_t unknowns = f.model->unknowns, extra = 2 * unknowns + f.model->points,
                         size = f.model->state_size;
            for (size_t k = 0; k < unknowns; k++)
                f.y[unknowns + k] = scatter(k);
            for (size_t k = extra; k < size; k++)
                f.y[k] = scatter(k);
            evaluate(&f);
            const double kinetic =
                (energy_at(&f, unknowns, 2 * unknowns, 1) - energy_at(&f, unknowns, 2 * unknowns, -1)) / 2;
            const double strain = (energy_at(&f, extra, size, 1) - energy_at(&f, extra, size, -1)) / 2;
            const double defect = fabs(kinetic + strain) / fabs(strain);
            if (adjoint)
                assert_true(defect < 1e-10);
            else
                assert_true(defect > 1e-3);
            drop(&f);
        }
}

/* About the body at rest the control is a symmetric operator that takes energy up, walls included. */
static void symmetric(void **unused)
{
    (void)unused;
    for (int d = 1; d <= 3; d++) {
        struct fixture f;
        box(&f, d, d > 1);
        f.options.hourglass = .3;
        make(&f);
        struct updated *updated = updated_of(f.model);
        updated->velocities_displace = true;
        const size_t unknowns = f.model->unknowns;
        double *first = calloc(unknowns, sizeof *first);
        for (size_t k = 0; k < unknowns; k++)
            f.y[unknowns + k] = scatter(k);
        evaluate(&f);
        memcpy(first, f.rate + unknowns, unknowns * sizeof *first);
        for (size_t k = 0; k < unknowns; k++)
            f.y[unknowns + k] = scatter(7777 + k);
        evaluate(&f);
        double one = 0, other = 0, own = 0, total[3] = {0};
        for (size_t k = 0; k < unknowns; k++) {
            const double mass = updated->mass[k / (size_t)d];
            one += mass * first[k] * scatter(7777 + k);
            other += mass * f.rate[unknowns + k] * scatter(k);
            own += mass * first[k] * scatter(k);
            total[k % (size_t)d] += mass * first[k];
        }
        assert_true(own < 0);
        assert_true(fabs(one - other) < 1e-11 * fabs(own));
        if (d == 1) assert_true(fabs(total[0]) < 1e-11 * fabs(own)); /* free: momentum stays */
        free(first);
        drop(&f);
    }
}

/* Finite rotation and stretching leave no force; a checkerboard, which no gradient sees, is pushed back. */
static void linear_and_alternating(void **unused)
{
    (void)unused;
    for (int d = 1; d <= 3; d++) {
        struct fixture f;
        box(&f, d, false);
        f.options.hourglass = .1;
        make(&f);
        const size_t unknowns = f.model->unknowns, dim = (size_t)d;
        for (size_t k = 0; k < unknowns; k++)
            for (size_t b = 0; b < dim; b++)
                f.y[k] += .2 * scatter(3 * (k % dim) + b) * f.model->position[3 * (k / dim) + b];
        evaluate(&f);
        for (size_t k = 0; k < unknowns; k++)
            assert_near(f.rate[unknowns + k], 0, 1e-10);
        drop(&f);
    }
    struct fixture f;
    box(&f, 2, false);
    f.plain.scene.body.jitter = 0;
    f.options.hourglass = .1;
    make(&f);
    const double small = 1e-7;
    for (size_t i = 0; i < f.model->points; i++) {
        const long cell =
            lround(f.model->position[3 * i] / .1 - .5) + lround(f.model->position[3 * i + 1] / .1 - .5);
        f.y[2 * i] = cell % 2 == 0 ? small : -small;
    }
    evaluate(&f);
    const double speed = f.plain.material[0].p_speed / .1;
    for (size_t i = 0; i < f.model->points; i++)
        assert_true(f.rate[f.model->unknowns + 2 * i] * f.y[2 * i] < -.01 * speed * speed * small * small);
    drop(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(power),
        cmocka_unit_test(symmetric),
        cmocka_unit_test(linear_and_alternating),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
