/* The consistent method: its operators alone. Symmetry and null space, patch tests, dispersion against
 * theory, discrete energy, faces, loads, symmetry planes, rotation, threads. */
#include "near.h"

#include "consistent_run.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_sort_vector.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* K is symmetric, has no negative eigenvalue, and its null space is exactly the rigid motions. */
static void test_stiffness_spectrum(void **state)
{
    (void)state;
    static const int rigid[] = {1, 3, 6};
    for (int dimension = 1; dimension <= 3; dimension++)
        for (int kind = 0; kind < 2; kind++) {
            struct plain_scene plain;
            plain_box(&plain, dimension, kind ? (double[]){1.5, 1.5, 1.5} : (double[]){.6, .9, .6}, .3);
            struct model *model = make(&plain, plain_options(kind ? 2 : 3, kind));
            struct consistent *c = consistent_of(model);
            const size_t n = model->unknowns;
            gsl_matrix *k = gsl_matrix_alloc(n, n);
            gsl_vector *values = gsl_vector_alloc(n);
            gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(n);
            double *unit = calloc(n, sizeof *unit), *column = calloc(n, sizeof *column), skew = 0;
            for (size_t j = 0; j < n; j++) {
                unit[j] = 1;
                apply(c, c->stiffness, unit, column);
                unit[j] = 0;
                for (size_t i = 0; i < n; i++)
                    gsl_matrix_set(k, i, j, column[i]);
            }
            for (size_t i = 0; i < n; i++)
                for (size_t j = 0; j < i; j++)
                    skew = fmax(skew, fabs(gsl_matrix_get(k, i, j) - gsl_matrix_get(k, j, i)));
            assert_true(skew < 1e-14);
            gsl_eigen_symm(k, values, work);
            const double largest = gsl_vector_max(values);
            int zero = 0;
            for (size_t i = 0; i < n; i++) {
                assert_true(gsl_vector_get(values, i) > -1e-13 * largest);
                zero += gsl_vector_get(values, i) < 1e-9 * largest;
            }
            assert_int_equal(zero, rigid[dimension - 1]);
            gsl_matrix_free(k);
            gsl_vector_free(values);
            gsl_eigen_symm_free(work);
            free(unit);
            free(column);
            model_free(&model);
        }
}

/* A linear displacement under the tractions of its stress is in balance; a rigid motion needs none. */
static void test_patch(void **state)
{
    (void)state;
    static const double strain[3][3] = {{.3, .1, -.2}, {.4, -.5, .25}, {-.1, .7, .2}}; /* du_i/dx_j */
    for (int dimension = 1; dimension <= 3; dimension++)
        for (int kind = 0; kind < 4; kind++) {
            struct plain_scene plain;
            plain_box(&plain, dimension, (double[]){1.2, 1.5, 1.8}, .15);
            const struct material *m = &plain.material[0];
            double trace = 0;
            for (int i = 0; i < dimension; i++)
                trace += strain[i][i];
            for (int face = 0; face < 2 * dimension; face++) {
                double traction[3] = {0};
                for (int i = 0; i < dimension; i++)
                    traction[i] =
                        face_sign((enum face)face) * (m->mu * (strain[i][face / 2] + strain[face / 2][i]) +
                                                      (i == face / 2 ? m->lambda * trace : 0));
                plain_face_load(&plain, (enum face)face, traction);
            }
            struct model *model = make(&plain, plain_options(kind % 2 ? 3 : 2, kind / 2));
            struct consistent *c = consistent_of(model);
            double *y = calloc(2 * model->unknowns, sizeof *y), *a = calloc(model->unknowns, sizeof *a);
            for (size_t p = 0; p < c->volume; p++) {
                const size_t at[3] = {p % c->n[0], p / c->n[0] % c->n[1], p / c->plane};
                for (int i = 0; i < dimension; i++)
                    for (int j = 0; j < dimension; j++)
                        y[(size_t)i * c->volume + p] += strain[i][j] * c->spline[j]->greville[at[c->slot[j]]];
            }
            const double ones[PLAIN_LOADS] = {1, 1, 1, 1, 1, 1};
            const struct drive drive = {.load = ones};
            model->spatial->accelerate(model, &drive, 0, y, NULL, a);
            for (size_t i = 0; i < model->unknowns; i++)
                assert_near(a[i], 0, 2e-9); /* K is of order 1/dx, its inverse mass of order 1/dx^3 */
            struct probe probe = {0};
            struct messages messages = {0};
            assert_int_equal(model->core->probe(model, (double[]){.31, .77, 1.03}, &probe, &messages),
                             SELAS_OK);
            double stress[6];
            model->core->observe(model, &probe, SELAS_STRESS, y, a, stress);
            assert_near(stress[0], 2 * m->mu * strain[0][0] + m->lambda * trace, 1e-12);
            if (dimension == 3) assert_near(stress[4], m->mu * (strain[1][2] + strain[2][1]), 1e-12);
            probe_free(&probe);
            for (size_t i = 0; i < model->unknowns; i++)
                y[i] = i / c->volume == 0 ? 1 : -2;
            model->spatial->accelerate(model, &(struct drive){0}, 0, y, NULL, a);
            for (size_t i = 0; i < model->unknowns; i++)
                assert_near(a[i], 0, 1e-8);
            free(y);
            free(a);
            model_free(&model);
        }
}

/* Largest frequency (times spacing over speed) of a free bar: what each kind of ends costs in time step. The
 * figure for open knots of degree 2 was found again by a dense assembly from the recursive definition. */
static void test_largest_frequency(void **state)
{
    (void)state;
    static const struct {
        int degree;
        bool mapped;
        double expected;
    } cases[] = {{2, false, 4.645}, {3, false, 6.871}, {2, true, 3.2416}, {3, true, 3.2944}};
    for (size_t i = 0; i < 4; i++) {
        struct plain_scene plain;
        plain_box(&plain, 1, (double[]){40, 0, 0}, 1);
        plain_material(&plain.material[0], 1, 0, .5);
        struct model *model = make(&plain, plain_options(cases[i].degree, cases[i].mapped));
        const size_t n = model->unknowns;
        double *y = calloc(2 * n, sizeof *y), *a = calloc(n, sizeof *a), omega = 0;
        noise(n, y);
        for (int iteration = 0; iteration < 3000; iteration++) {
            model->spatial->accelerate(model, &(struct drive){0}, 0, y, NULL, a);
            omega = sqrt(sqrt(dot(n, a, a) / dot(n, y, y)));
            for (size_t j = 0; j < n; j++)
                y[j] = -a[j] / (omega * omega);
        }
        assert_near(omega, cases[i].expected, .002);
        free(y);
        free(a);
        model_free(&model);
    }
}

/* Theory: 1-D waves of degree p with exact mass are off by c_p (k dx)^(2p); in the design's table (lambda =
 * mu) 1.2e-4, 1.0e-3, 6.6e-3 for p = 2 and 1.2e-6, 3.5e-5, 6.5e-4 for p = 3 at 10, 6, 4 points per
 * wavelength. */
static void test_dispersion(void **state)
{
    (void)state;
    static const double points[] = {10, 6, 4};
    static const double expected[2][3] = {{1.2e-4, 1.0e-3, 6.6e-3}, {1.2e-6, 3.5e-5, 6.5e-4}};
    for (int p = 2; p <= 3; p++) {
        struct plain_scene plain;
        plain_box(&plain, 3, (double[]){3, 3, 3}, .25);
        plain_material(&plain.material[0], 1, 1, 1);
        struct model *model = make(&plain, plain_options(p, false));
        for (int i = 0; i < 3; i++)
            print_message("# p = %d, %g points: %.3g\n", p, points[i],
                          worst_dispersion(model, 3, points[i], .25));
        for (int i = 0; i < 3; i++)
            assert_near(worst_dispersion(model, 3, points[i], .25) / expected[p - 2][i], 1, .1);
        model_free(&model);
    }
}

/* Leapfrog's own energy, v(n+1/2).M v(n+1/2)/2 + u(n).K u(n+1)/2, stays to rounding with free faces. */
static void test_energy(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){1.2, .9, 1.5}, .3);
    for (int face = 0; face < 2; face++) /* what holds values takes no energy */
        plain.scene.boundary[face].kind = face ? BOUNDARY_FIXED : BOUNDARY_ROLLER;
    struct model *model = make(&plain, plain_options(3, false));
    struct consistent *c = consistent_of(model);
    const size_t n = model->unknowns;
    double *y = calloc(2 * n, sizeof *y), *a = calloc(n, sizeof *a), *before = calloc(n, sizeof *before);
    double *v = y + n, first = 0;
    const double dt = .01;
    noise(n, y);
    model->spatial->accelerate(model, &(struct drive){0}, 0, y, NULL, v); /* admissible: 0 where held */
    memset(y, 0, n * sizeof *y);
    for (int step = 0; step < 400; step++) {
        memcpy(before, y, n * sizeof *y);
        for (size_t i = 0; i < n; i++)
            y[i] += dt * v[i];
        const double total = (tensor_form(c->mass, v, v) + tensor_form(c->stiffness, before, y)) / 2;
        if (step == 0) first = total;
        assert_near(total / first, 1, 1e-11);
        model->spatial->accelerate(model, &(struct drive){0}, dt / 2, y, v, a);
        for (size_t i = 0; i < n; i++)
            v[i] += dt * a[i];
    }
    free(y);
    free(a);
    free(before);
    model_free(&model);
}

/* One transmitting face: what the dampers take, dt v.C v with the mean velocity, is what the energy loses, to
 * rounding. All six: the energy of M + (edge terms) never grows and falls to nothing. */
static void test_dampers(void **state)
{
    (void)state;
    for (int face = 0; face < 6; face++) {
        struct plain_scene plain;
        plain_box(&plain, 3, (double[]){1.8, 1.5, 2.1}, .3);
        plain.scene.boundary[face].kind = BOUNDARY_TRANSMITTING;
        struct run run = run_new(&plain, plain_options(2, face % 2));
        struct consistent *c = consistent_of(run.model);
        double *v = run.y + run.n, *before = calloc(2 * run.n, sizeof *before), energy = 0;
        const double dt = .02;
        noise(run.n, v);
        for (int step = 0; step < 50; step++) {
            memcpy(before, run.y, 2 * run.n * sizeof *before);
            leap(&run, &(struct drive){0}, dt);
            const double now = (tensor_form(c->mass, v, v) + tensor_form(c->stiffness, before, run.y)) / 2;
            for (size_t i = 0; i < run.n; i++)
                before[run.n + i] = (before[run.n + i] + v[i]) / 2;
            const double loss = dt * dampers_power(c, before + run.n);
            assert_true(loss >= 0);
            if (step > 0) assert_near((energy - now - loss) / energy, 0, 1e-12);
            energy = now;
        }
        free(before);
        run_free(&run);
    }
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){1.5, 1.5, 1.5}, .3);
    for (int face = 0; face < 6; face++)
        plain.scene.boundary[face].kind = BOUNDARY_TRANSMITTING;
    struct run run = run_new(&plain, plain_options(3, false));
    noise(run.n, run.y + run.n);
    const double first = dot(run.n, run.y + run.n, run.y + run.n);
    for (int step = 0; step < 2000; step++)
        leap(&run, &(struct drive){0}, .04);
    assert_true(dot(run.n, run.y + run.n, run.y + run.n) < 1e-8 * first);
    run_free(&run);
}

/* A plane wave along the face's normal leaves a bar: less than 1e-4 of the energy stays. */
static void test_transmits(void **state)
{
    (void)state;
    for (int face = 0; face < 2; face++) {
        struct plain_scene plain;
        plain_box(&plain, 1, (double[]){10, 0, 0}, .1);
        plain.scene.boundary[face].kind = BOUNDARY_TRANSMITTING;
        plain.scene.boundary[1 - face].kind = BOUNDARY_TRANSMITTING;
        plain.scene.initial = (struct initial){
            .kind = INITIAL_GAUSSIAN, .amplitude = 1, .direction = {1, 0, 0}, .centre = {5}, .width = .5};
        struct run run = run_new(&plain, plain_options(3, false));
        struct energy start, end;
        run.model->core->initialise(run.model, run.y);
        run.model->core->energy(run.model, run.y, &start);
        for (int step = 0; step < 1500; step++) /* 30 % of the limit; 9 wavelengths long beyond the ends */
            leap(&run, &(struct drive){0}, .005);
        run.model->core->energy(run.model, run.y, &end);
        assert_true(end.kinetic + end.strain < 1e-4 * start.strain);
        run_free(&run);
    }
}

/* A body whose faces x- and x+ move as given follows them: with all of u'' = 1 prescribed at one end of a bar
 * the equation M_II a_I = -M_IB a_B - K u holds row by row. */
static void test_prescribed(void **state)
{
    (void)state;
    for (int slip = 0; slip < 2; slip++) {
        struct plain_scene plain;
        plain_box(&plain, 2, (double[]){1.5, .9, 0}, .3);
        struct boundary *boundary = &plain.scene.boundary[FACE_X_HIGH];
        *boundary = (struct boundary){
            .kind = BOUNDARY_DISPLACEMENT, .direction = {1, 0, 0}, .amplitude = .7, .slip = slip};
        plain.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_FIXED;
        struct run run = run_new(&plain, plain_options(3, false));
        struct consistent *c = consistent_of(run.model);
        const double motion[FACES] = {0, 1.9, 0};
        double *force = calloc(run.n, sizeof *force), *inertia = calloc(run.n, sizeof *inertia);
        noise(run.n, run.y);
        run.model->spatial->accelerate(run.model, &(struct drive){.motion = motion}, 0, run.y, NULL, run.a);
        apply(c, c->stiffness, run.y, force);
        apply(c, c->mass, run.a, inertia);
        for (size_t i = 0; i < run.n; i++) {
            const size_t x = i % c->n[0], y = i / c->n[0] % c->n[2];
            const bool moving = x == c->n[0] - 1 && (!slip || i < c->volume);
            if (y == 0)
                assert_near(run.a[i], 0, 0);
            else if (moving)
                assert_near(run.a[i], i < c->volume ? .7 * 1.9 : 0, 1e-15);
            else
                assert_near(force[i] + inertia[i], 0, 1e-12);
        }
        free(force);
        free(inertia);
        run_free(&run);
    }
}

static double total_force(const struct plain_scene *plain, int component, struct consistent_options options)
{
    struct model *model = make(plain, options);
    struct consistent *c = consistent_of(model);
    double *ones = calloc(model->unknowns, sizeof *ones);
    for (size_t i = 0; i < c->volume; i++)
        ones[(size_t)component * c->volume + i] = 1;
    const double force = sparse_dot(c, &c->load.of[0], ones);
    free(ones);
    model_free(&model);
    return force;
}

/* Loads carry their whole area, off the lattice too; half of it with a symmetry plane through the middle. */
static void test_load_totals(void **state)
{
    (void)state;
    for (int mapped = 0; mapped < 2; mapped++) {
        struct plain_scene plain;
        plain_box(&plain, 3, (double[]){3, 3.6, 3}, .3);
        struct load *load = plain_face_load(&plain, FACE_Z_LOW, (double[]){.6, 0, .8});
        load->shape = LOAD_SQUARE;
        load->centre[0] = 1.43;
        load->centre[1] = 1.07;
        load->size[0] = 1.1;
        load->size[1] = .7;
        assert_near(total_force(&plain, 2, plain_options(3, mapped)), .8 * .77, 1e-13);
        assert_near(total_force(&plain, 0, plain_options(3, mapped)), .6 * .77, 1e-13);
        load->shape = LOAD_DISC;
        assert_near(total_force(&plain, 2, plain_options(2, mapped)), .8 * M_PI * 1.21 / 4, 1e-12);
        load->shape = LOAD_POINT;
        assert_near(total_force(&plain, 2, plain_options(2, mapped)), .8, 1e-13);
        plain.scene.boundary[FACE_X_LOW].kind = BOUNDARY_SYMMETRY;
        load->centre[0] = 0;
        assert_near(total_force(&plain, 2, plain_options(2, mapped)), .4, 1e-13);
        load->shape = LOAD_SQUARE;
        assert_near(total_force(&plain, 2, plain_options(3, mapped)), .4 * .77, 1e-13);
        load->kind = LOAD_BODY_FORCE;
        load->shape = LOAD_FACE;
        assert_near(total_force(&plain, 2, plain_options(2, mapped)), .8 * 3 * 3.6 * 3, 1e-12);
    }
}

/* A moment tensor does the work M : grad u on any linear field. */
static void test_moment_tensor(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){3, 3.6, 3}, .3);
    struct load *load = plain_face_load(&plain, FACE_Z_LOW, (double[]){0, 0, 1});
    *load = (struct load){.kind = LOAD_MOMENT_TENSOR,
                          .amplitude = 1,
                          .centre = {1.1, 1.7, .93},
                          .moment = {1, 2, 3, .4, .5, .6}}; /* xx yy zz xy yz zx */
    static const double full[3][3] = {{1, .4, .6}, {.4, 2, .5}, {.6, .5, 3}};
    struct model *model = make(&plain, plain_options(2, false));
    struct consistent *c = consistent_of(model);
    double *field = calloc(model->unknowns, sizeof *field);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            for (size_t p = 0; p < model->unknowns; p++) {
                const size_t q = p % c->volume, at[3] = {q % c->n[0], q / c->n[0] % c->n[1], q / c->plane};
                field[p] = p / c->volume == (size_t)i ? c->spline[j]->greville[at[j]] : 0;
            }
            assert_near(sparse_dot(c, &c->load.of[0], field), full[i][j], 1e-12);
        }
    free(field);
    model_free(&model);
}

/* A quarter with symmetry planes does what the whole box does, to rounding. */
static void test_symmetry_planes(void **state)
{
    (void)state;
    for (int p = 2; p <= 3; p++) {
        struct plain_scene whole, quarter;
        plain_box(&whole, 3, (double[]){4.8, 4.8, 1.2}, .3);
        plain_box(&quarter, 3, (double[]){4.8, 4.8, 1.2}, .3);
        quarter.scene.body.low[0] = quarter.scene.body.low[1] = 2.4;
        quarter.scene.boundary[FACE_X_LOW].kind = quarter.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_SYMMETRY;
        struct run run[2];
        for (int i = 0; i < 2; i++) {
            struct plain_scene *plain = i == 0 ? &whole : &quarter;
            plain->scene.boundary[FACE_Z_HIGH].kind = BOUNDARY_TRANSMITTING;
            plain->scene.boundary[FACE_X_HIGH].kind = BOUNDARY_TRANSMITTING;
            if (i == 0) plain->scene.boundary[FACE_X_LOW].kind = BOUNDARY_TRANSMITTING;
            struct load *load = plain_face_load(plain, FACE_Z_LOW, (double[]){0, 0, 1});
            load->shape = LOAD_SQUARE;
            load->centre[0] = load->centre[1] = 2.4;
            load->size[0] = 1.3;
            load->size[1] = .9;
            run[i] = run_new(plain, plain_options(p, false));
            for (int step = 0; step < 60; step++) {
                const double amplitude = sin(.2 * step);
                leap(&run[i], &(struct drive){.load = &amplitude}, .02);
            }
        }
        static const double places[3][3] = {{2.4, 2.4, 0}, {3.3, 2.5, .4}, {4.1, 4.7, 1.2}};
        for (int place = 0; place < 3; place++) {
            double value[2][3], stress[2][6];
            for (int i = 0; i < 2; i++) {
                struct probe probe = {0};
                struct messages messages = {0};
                run[i].model->core->probe(run[i].model, places[place], &probe, &messages);
                run[i].model->core->observe(run[i].model, &probe, SELAS_VELOCITY, run[i].y, run[i].a,
                                            value[i]);
                run[i].model->core->observe(run[i].model, &probe, SELAS_STRESS, run[i].y, run[i].a,
                                            stress[i]);
                probe_free(&probe);
            }
            if (place < 2) assert_true(fabs(value[0][2]) > .05);
            for (int component = 0; component < 3; component++)
                assert_near(value[1][component], value[0][component], 1e-12);
            for (int component = 0; component < 6; component++)
                assert_near(stress[1][component], stress[0][component], 1e-11);
        }
        run_free(&run[0]);
        run_free(&run[1]);
    }
}

/* A turned body under turned loads does what the straight one does, turned. */
static void test_rotation(void **state)
{
    (void)state;
    const double angle = .6;
    struct run run[2];
    struct plain_scene plain[2];
    for (int i = 0; i < 2; i++) {
        plain_box(&plain[i], 3, (double[]){1.5, 1.2, 1.8}, .3);
        struct body *body = &plain[i].scene.body;
        const double direction[3] = {.6, 0, .8};
        struct load *load = plain_face_load(&plain[i], FACE_Z_LOW, direction);
        load->shape = LOAD_SQUARE;
        load->size[0] = load->size[1] = .5;
        load->centre[0] = .7;
        load->centre[1] = .6;
        plain[i].scene.boundary[FACE_Z_HIGH].kind = BOUNDARY_TRANSMITTING;
        if (i == 1) {
            body->rotated = true;
            const double turn[3][3] = {{cos(angle), -sin(angle), 0}, {sin(angle), cos(angle), 0}, {0, 0, 1}};
            memcpy(body->frame, turn, sizeof turn);
            for (int axis = 0; axis < 3; axis++)
                body->pivot[axis] = body->high[axis] / 2;
            body_direction_to_deck(body, load->direction, load->direction);
            body_to_deck(body, load->centre, load->centre);
        }
        run[i] = run_new(&plain[i], plain_options(2, false));
        for (int step = 0; step < 40; step++) {
            const double amplitude = sin(.2 * step);
            leap(&run[i], &(struct drive){.load = &amplitude}, .02);
        }
    }
    double place[3] = {.3, .9, .4}, value[2][3], expected[3];
    for (int i = 0; i < 2; i++) {
        struct probe probe = {0};
        struct messages messages = {0};
        if (i == 1) body_to_deck(&plain[1].scene.body, place, place);
        run[i].model->core->probe(run[i].model, place, &probe, &messages);
        run[i].model->core->observe(run[i].model, &probe, SELAS_VELOCITY, run[i].y, run[i].a, value[i]);
        probe_free(&probe);
    }
    body_direction_to_deck(&plain[1].scene.body, value[0], expected);
    for (int component = 0; component < 3; component++)
        assert_near(value[1][component], expected[component], 1e-13);
    run_free(&run[0]);
    run_free(&run[1]);
}

/* One thread or three: the same bits. */
static void test_threads(void **state)
{
    (void)state;
    const int most = omp_get_max_threads();
    double *result[2];
    size_t n = 0;
    for (int i = 0; i < 2; i++) {
        omp_set_num_threads(i == 0 ? 1 : 3);
        struct plain_scene plain;
        plain_box(&plain, 3, (double[]){1.5, 1.8, 2.1}, .3);
        for (int face = 0; face < 5; face++)
            plain.scene.boundary[face].kind = BOUNDARY_TRANSMITTING;
        struct run run = run_new(&plain, plain_options(3, false));
        noise(2 * run.n, run.y);
        leap(&run, &(struct drive){0}, .01);
        n = run.n;
        result[i] = calloc(n, sizeof(double));
        memcpy(result[i], run.a, n * sizeof(double));
        run_free(&run);
    }
    omp_set_num_threads(most);
    assert_memory_equal(result[0], result[1], n * sizeof(double));
    free(result[0]);
    free(result[1]);
}

/* The largest error of the acceleration of u = exp(-r^2 / 2 w^2) p at points of a box's middle falls at least
 * with order p + 1, that of the splines themselves. */
static double gaussian_error(int p, double spacing)
{
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){4, 4, 4}, spacing);
    plain.scene.initial = (struct initial){
        .kind = INITIAL_GAUSSIAN, .amplitude = 1, .direction = {0, 0, 1}, .centre = {2, 2, 2}, .width = .5};
    struct run run = run_new(&plain, plain_options(p, false));
    const struct material *m = &plain.material[0];
    run.model->core->initialise(run.model, run.y);
    run.model->spatial->accelerate(run.model, &(struct drive){0}, 0, run.y, NULL, run.a);
    double worst = 0;
    for (int i = 0; i < 27; i++) {
        const double place[3] = {1.6 + .4 * (i % 3), 1.6 + .4 * (i / 3 % 3), 1.6 + .4 * (i / 9)};
        double value[3], r[3], square = 0;
        struct probe probe = {0};
        struct messages messages = {0};
        run.model->core->probe(run.model, place, &probe, &messages);
        run.model->core->observe(run.model, &probe, SELAS_ACCELERATION, run.y, run.a, value);
        probe_free(&probe);
        for (int axis = 0; axis < 3; axis++) {
            r[axis] = (place[axis] - 2) / .25; /* over the square of the width */
            square += (place[axis] - 2) * (place[axis] - 2);
        }
        const double u = exp(-square / .5);
        for (int axis = 0; axis < 3; axis++) { /* (lambda + mu) grad div u + mu laplacian u */
            const double second = axis == 2 ? r[2] * r[2] - 4 : r[2] * r[axis];
            const double laplacian = axis == 2 ? square * 16 - 12 : 0;
            const double exact = u * ((m->lambda + m->mu) * second + m->mu * laplacian) / m->density;
            worst = fmax(worst, fabs(value[axis] - exact));
        }
    }
    run_free(&run);
    return worst;
}

static void test_manufactured(void **state)
{
    (void)state;
    for (int p = 2; p <= 3; p++) {
        const double coarse = gaussian_error(p, .25), fine = gaussian_error(p, .125);
        print_message("# degree %d: %.3g -> %.3g, order %.2f\n", p, coarse, fine, log2(coarse / fine));
        assert_true(log2(coarse / fine) > p + .8);
        assert_true(fine < (p == 2 ? .02 : .001)); /* of 8.3 at the centre */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stiffness_spectrum),
        cmocka_unit_test(test_patch),
        cmocka_unit_test(test_largest_frequency),
        cmocka_unit_test(test_dispersion),
        cmocka_unit_test(test_energy),
        cmocka_unit_test(test_dampers),
        cmocka_unit_test(test_transmits),
        cmocka_unit_test(test_prescribed),
        cmocka_unit_test(test_load_totals),
        cmocka_unit_test(test_moment_tensor),
        cmocka_unit_test(test_symmetry_planes),
        cmocka_unit_test(test_rotation),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_manufactured),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
