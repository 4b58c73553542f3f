/* The operator of updated-Lagrangian SPH: patch tests of velocity gradient, Jaumann rate and stress
 * divergence, ghosts of every wall, viscosity, artificial stress, spectrum, and that neither threads nor
 * lists change a bit. */
#include "points/lattice.h"
#include "updated_run.h"

#include "near.h"

#include <omp.h>
#include <stdlib.h>

static double scatter(size_t k)
{
    return 2 * random_uniform(7, k) - 1;
}

/* Switches: correction and Jaumann only. */
static void box(struct fixture *f, int dimension, double spacing)
{
    const double size[3] = {1, .8, .6};
    plain_box(&f->plain, dimension, size, spacing);
    f->options = updated_lagrangian_published();
    f->options.alpha = f->options.beta = f->options.artificial_stress = 0;
}

static size_t components(const struct fixture *f)
{
    return (size_t)updated_of(f->model)->stresses;
}

/* Parts of the state or of the rates. */
static double *velocity(const struct fixture *f, double *y)
{
    return y + f->model->unknowns;
}
static double *density(const struct fixture *f, double *y)
{
    return y + 2 * f->model->unknowns;
}
static double *stress(const struct fixture *f, double *y)
{
    return density(f, y) + f->model->points;
}

static void evaluate(struct fixture *f, const struct drive *drive)
{
    const struct drive quiet = {.time = 0};
    updated_rate(f->model, drive != NULL ? drive : &quiet, f->y, f->rate);
}

/* v = g x, uniform stress: ds/dt = lambda tr(e) I + 2 mu e + w s - s w and d rho/dt = -rho tr(g) at every
 * particle of a jittered body without walls, with every kernel. */
static void gradient_and_jaumann(void **unused)
{
    (void)unused;
    const char *const kernels[] = {"cubic", "wendland", "quintic"};
    for (int d = 1; d <= 3; d++)
        for (int k = 0; k < 3; k++) {
            struct fixture f;
            box(&f, d, .09);
            f.plain.scene.body.jitter = .1;
            f.options.kernel = kernel_find(kernels[k]);
            f.options.smoothing_length = k == 2 ? 1 : 1.5;
            make(&f);
            double g[3][3] = {{0}}, s[3][3] = {{0}};
            for (int a = 0; a < d; a++)
                for (int b = 0; b < d; b++) {
                    g[a][b] = scatter((size_t)(3 * a + b));
                    s[a][b] = scatter((size_t)(20 + (a < b ? 3 * a + b : 3 * b + a)));
                }
            for (size_t i = 0; i < f.model->points; i++)
                for (int a = 0; a < d; a++) {
                    for (int b = 0; b < d; b++) {
                        velocity(&f, f.y)[(size_t)d * i + (size_t)a] +=
                            g[a][b] * f.model->position[3 * i + (size_t)b];
                        stress(&f, f.y)[components(&f) * i + (size_t)updated_component[d][a][b]] = s[a][b];
                    }
                }
            evaluate(&f, NULL);
            const struct material *material = &f.plain.material[0];
            double trace = 0;
            for (int a = 0; a < d; a++)
                trace += g[a][a];
            for (size_t i = 0; i < f.model->points; i++) {
                assert_near(density(&f, f.rate)[i], -material->density * trace, 1e-11);
                for (int a = 0; a < d; a++)
                    for (int b = a; b < d; b++) {
                        double expected = material->mu * (g[a][b] + g[b][a]);
                        if (a == b) expected += material->plane_lambda * trace;
                        for (int c = 0; c < d; c++)
                            expected += (g[a][c] - g[c][a]) / 2 * s[c][b] - s[a][c] * (g[c][b] - g[b][c]) / 2;
                        assert_near(
                            stress(&f, f.rate)[components(&f) * i + (size_t)updated_component[d][a][b]],
                            expected, 1e-11);
                    }
            }
            drop(&f);
        }
}

/* A uniform stress is in balance with the tractions it makes on all faces, corners included; a body that turns as
 * one has no viscosity, not behind such faces either: no particle is accelerated. */
static void tractions_balance(void **unused)
{
    (void)unused;
    for (int d = 1; d <= 3; d++) {
        struct fixture f;
        box(&f, d, .1);
        f.options.alpha = f.options.beta = 1;
        double s[3][3] = {{0}}, amplitude[PLAIN_LOADS];
        for (int a = 0; a < d; a++)
            for (int b = 0; b < d; b++)
                s[a][b] = scatter((size_t)(a < b ? 3 * a + b : 3 * b + a));
        for (int face = 0; face < 2 * d; face++) {
            const int axis = face_axis((enum face)face), sign = face_sign((enum face)face);
            const double traction[3] = {sign * s[0][axis], sign * s[1][axis], sign * s[2][axis]};
            plain_face_load(&f.plain, (enum face)face, traction);
            amplitude[face] = 1;
        }
        make(&f);
        for (size_t i = 0; i < f.model->points; i++)
            for (int a = 0; a < d; a++)
                for (int b = 0; b < d; b++) {
                    stress(&f, f.y)[components(&f) * i + (size_t)updated_component[d][a][b]] = s[a][b];
                    velocity(&f, f.y)[(size_t)d * i + (size_t)a] +=
                        (s[a][b] + 1) * ((a > b) - (a < b)) * f.model->position[3 * i + (size_t)b];
                }
        const struct drive drive = {.load = amplitude};
        evaluate(&f, &drive);
        for (size_t i = 0; i < f.model->unknowns; i++)
            assert_near(velocity(&f, f.rate)[i], 0, 1e-11);
        drop(&f);
    }
}

/* A linear stress gives its divergence over rho where the lattice is complete. */
static void divergence_inside(void **unused)
{
    (void)unused;
    for (int d = 1; d <= 3; d++) {
        struct fixture f;
        box(&f, d, .1);
        make(&f);
        for (size_t i = 0; i < f.model->points; i++)
            for (size_t s = 0; s < components(&f); s++)
                for (size_t b = 0; b < (size_t)d; b++)
                    stress(&f, f.y)[components(&f) * i + s] +=
                        scatter(3 * s + b) * f.model->position[3 * i + b];
        evaluate(&f, NULL);
        int inside = 0;
        for (size_t i = 0; i < f.model->points; i++) {
            bool far = true;
            for (int a = 0; a < d; a++) {
                const double x = f.model->position[3 * i + (size_t)a];
                far = far && x > .3 && x < f.plain.scene.body.high[a] - .3;
            }
            if (!far) continue;
            inside++;
            for (int a = 0; a < d; a++) {
                double expected = 0;
                for (int b = 0; b < d; b++)
                    expected += scatter((size_t)(3 * updated_component[d][a][b] + b));
                assert_near(velocity(&f, f.rate)[(size_t)d * i + (size_t)a],
                            expected / f.plain.material[0].density, 1e-11);
            }
        }
        assert_true(d == 3 || inside > 0);
        drop(&f);
    }
}

/* Walls: shear between a fixed and a driven wall (no slip), stretching between a symmetry plane and a driven
 * wall that lets slip: the velocity gradient is exact up to the walls; a uniform pressure between rollers
 * moves nothing. */
static void walls(void **unused)
{
    (void)unused;
    for (int slip = 0; slip <= 1; slip++) {
        struct fixture f;
        box(&f, 2, .1);
        struct boundary *low = &f.plain.scene.boundary[FACE_Y_LOW],
                        *high = &f.plain.scene.boundary[FACE_Y_HIGH];
        low->kind = slip ? BOUNDARY_SYMMETRY : BOUNDARY_FIXED;
        high->kind = BOUNDARY_VELOCITY;
        high->slip = slip;
        high->amplitude = 3 * .8;
        high->direction[slip] = 1;
        make(&f);
        for (size_t i = 0; i < f.model->points; i++)
            velocity(&f, f.y)[2 * i + (size_t)slip] = 3 * f.model->position[3 * i + 1];
        double wall[FACES] = {0};
        wall[FACE_Y_HIGH] = 1;
        const struct drive drive = {.velocity = wall};
        evaluate(&f, &drive);
        const struct material *material = &f.plain.material[0];
        for (size_t i = 0; i < f.model->points; i++) {
            const double *rate = stress(&f, f.rate) + 3 * i;
            assert_near(rate[0], slip ? 3 * material->lambda : 0, 1e-11);
            assert_near(rate[1], slip ? 3 * (material->lambda + 2 * material->mu) : 0, 1e-11);
            assert_near(rate[2], slip ? 0 : 3 * material->mu, 1e-11);
        }
        drop(&f);
    }
    struct fixture f;
    box(&f, 3, .1);
    for (int face = 0; face < 6; face++)
        f.plain.scene.boundary[face].kind = BOUNDARY_ROLLER;
    make(&f);
    for (size_t i = 0; i < f.model->points; i++)
        for (size_t s = 0; s < 3; s++)
            stress(&f, f.y)[6 * i + s] = -2;
    evaluate(&f, NULL);
    for (size_t i = 0; i < f.model->unknowns; i++)
        assert_near(velocity(&f, f.rate)[i], 0, 1e-11);
    drop(&f);
}

/* One pair of particles that approach, then recede: Eq 17 by hand, without L. */
static void viscosity_of_a_pair(void **unused)
{
    (void)unused;
    for (int sign = -1; sign <= 1; sign += 2) {
        struct fixture f;
        box(&f, 1, .5); /* particles at .25 and .75 */
        f.options.alpha = 1.5;
        f.options.beta = 2;
        f.options.correction = false;
        make(&f);
        const double speed = .3;
        velocity(&f, f.y)[0] = -sign * speed;
        velocity(&f, f.y)[1] = sign * speed;
        evaluate(&f, NULL);
        const struct material *material = &f.plain.material[0];
        const double h = .75, c = sqrt(material->young / material->density);
        const double phi = h * (-2 * speed * .5) / (.25 + .01 * h * h);
        const double pi = (-1.5 * c * phi + 2 * phi * phi) / material->density;
        const double slope = kernel_derivative(kernel_find("cubic"), 1, .5, h);
        const double expected = sign < 0 ? .5 * material->density * pi * slope : 0;
        assert_near(velocity(&f, f.rate)[0], expected, 1e-12);
        assert_near(velocity(&f, f.rate)[1], -expected, 1e-12);
        drop(&f);
    }
}

/* R of one tensor, in every lane and with other tensors beside it. */
static void repulsion_of(int dimension, const double *t, double *r)
{
    const int stresses = dimension * (dimension + 1) / 2;
    for (size_t lane = 0; lane < UPDATED_TENSORS; lane++) {
        double tension[6 * UPDATED_TENSORS], repulsion[6 * UPDATED_TENSORS];
        for (size_t k = 0; k < sizeof tension / sizeof *tension; k++)
            tension[k] = scatter(k);
        for (int s = 0; s < stresses; s++)
            tension[UPDATED_TENSORS * (size_t)s + lane] = t[s];
        taken_updated_stresses()->artificial(dimension, .3, UPDATED_TENSORS, tension, repulsion);
        for (int s = 0; s < stresses; s++) {
            const double found = repulsion[UPDATED_TENSORS * (size_t)s + lane];
            if (lane > 0) assert_near(found, r[s], 1e-14);
            r[s] = found;
        }
    }
}

/* Eqs 20-23 with the angle as printed; in space: a rotated diagonal tensor. */
static void artificial_stress(void **unused)
{
    (void)unused;
    for (size_t k = 0; k < 50; k++) {
        const double t[3] = {scatter(3 * k), scatter(3 * k + 1), scatter(3 * k + 2)};
        const double angle = atan2(2 * t[2], t[0] - t[1]) / 2, c = cos(angle), s = sin(angle);
        const double first = c * c * t[0] + 2 * s * c * t[2] + s * s * t[1];
        const double second = s * s * t[0] - 2 * s * c * t[2] + c * c * t[1];
        const double r1 = first > 0 ? -.3 * first : 0, r2 = second > 0 ? -.3 * second : 0;
        double r[6] = {0};
        repulsion_of(2, t, r);
        assert_near(r[0], r1 * c * c + r2 * s * s, 1e-14);
        assert_near(r[1], r1 * s * s + r2 * c * c, 1e-14);
        assert_near(r[2], (r1 - r2) * s * c, 1e-14);
    }
    const double c = cos(.7), s = sin(.7), n[3][3] = {{c, s, 0}, {-s * c, c * c, s}, {s * s, -c * s, c}};
    const double value[3] = {2, -1, .5};
    static const int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    double t[6] = {0}, expected[6] = {0}, r[6] = {0};
    for (int k = 0; k < 6; k++)
        for (int e = 0; e < 3; e++) {
            t[k] += value[e] * n[e][row[k]] * n[e][column[k]];
            if (value[e] > 0) expected[k] -= .3 * value[e] * n[e][row[k]] * n[e][column[k]];
        }
    repulsion_of(3, t, r);
    for (int k = 0; k < 6; k++)
        assert_near(r[k], expected[k], 1e-14);
}

/* A long lattice in one dimension: omega(k) = c sum g_j sin(j k), damping(k) = 2 sum d_j (1 - cos(j k)) from
 * the kernel. */
static void spectrum_of_a_lattice(void **unused)
{
    (void)unused;
    struct fixture f;
    box(&f, 1, .005);
    f.options.alpha = 2;
    for (int face = 0; face < 2; face++) /* bare ends have a faster mode of their own */
        f.plain.scene.boundary[face].kind = BOUNDARY_ROLLER;
    make(&f);
    struct spectrum spectrum;
    struct messages messages = {0};
    assert_int_equal(updated_spectrum(f.model, &spectrum, &messages), SELAS_OK);
    const struct material *material = &f.plain.material[0];
    const double dx = .005, h = 1.5 * dx, c = sqrt(material->young / material->density);
    double slope[3], moment = 0, omega = 0, viscous = 0;
    for (int j = 1; j <= 2; j++) {
        slope[j] = -dx * kernel_derivative(kernel_find("cubic"), 1, j * dx, h);
        moment += 2 * slope[j] * j * dx;
    }
    for (double k = 0; k <= M_PI; k += 1e-3) {
        double w = 0, damping = 0;
        for (int j = 1; j <= 2; j++) {
            const double r = j * dx;
            w += 2 * material->p_speed * slope[j] / moment * sin(j * k);
            damping += 2 * 2 * c * h * r / (r * r + .01 * h * h) * slope[j] / moment * (1 - cos(j * k));
        }
        omega = fmax(omega, w);
        viscous = fmax(viscous, damping);
    }
    assert_near(spectrum.omega / omega, 1, 3e-3);
    assert_near(spectrum.viscous / viscous, 1, 3e-3);
    assert_true(spectrum.wave_damping > .1 * viscous && spectrum.wave_damping < .5 * viscous);
    drop(&f);
}

/* Waves a thousand times slower (stiffness 2^-20) have frequencies a thousand times lower and dampers as much
 * less to do, beside transmitting faces too. */
static void spectrum_beside_dampers(void **unused)
{
    (void)unused;
    struct spectrum spectrum[2];
    struct messages messages = {0};
    for (int slow = 0; slow < 2; slow++) {
        struct fixture f;
        const double stiffness = slow ? 0x1p-20 : 1;
        box(&f, 2, .1);
        plain_material(&f.plain.material[0], 1.1, 2 * stiffness, stiffness);
        f.options.alpha = 2;
        f.plain.scene.boundary[FACE_X_HIGH].kind = f.plain.scene.boundary[FACE_Y_LOW].kind =
            BOUNDARY_TRANSMITTING;
        f.plain.scene.boundary[FACE_X_HIGH].absorber = f.plain.scene.boundary[FACE_Y_LOW].absorber =
            ABSORBER_LYSMER;
        for (int face = 0; face < 4; face++)
            f.plain.scene.boundary[face].normal_factor = f.plain.scene.boundary[face].shear_factor = 1;
        make(&f);
        assert_int_equal(updated_spectrum(f.model, &spectrum[slow], &messages), SELAS_OK);
        drop(&f);
    }
    assert_near(spectrum[1].omega / spectrum[0].omega * 1024, 1, 1e-9);
    assert_near(spectrum[1].viscous / spectrum[0].viscous * 1024, 1, 1e-9);
    assert_near(spectrum[1].wave_damping / spectrum[0].wave_damping * 1024, 1, 1e-6);
}

/* Threads do not change a bit, nor does it matter when the lists were made. */
static void same_bits(void **unused)
{
    (void)unused;
    struct fixture f;
    box(&f, 2, .02);
    f.plain.scene.boundary[FACE_X_LOW].kind = BOUNDARY_FIXED;
    f.options.alpha = 1;
    f.options.artificial_stress = .3;
    make(&f);
    assert_true(f.model->points > UPDATED_PARALLEL);
    for (size_t i = 0; i < f.model->state_size; i++)
        if (i < 2 * f.model->unknowns || i >= 2 * f.model->unknowns + f.model->points)
            f.y[i] = scatter(i) * (i < f.model->unknowns ? .0008 : 1); /* less than half the skin */
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    evaluate(&f, NULL);
    double *first = malloc(f.model->state_size * sizeof *first);
    memcpy(first, f.rate, f.model->state_size * sizeof *first);
    omp_set_num_threads(3);
    evaluate(&f, NULL);
    assert_memory_equal(first, f.rate, f.model->state_size * sizeof *first);
    for (size_t i = 0; i < f.model->points; i++)
        f.y[2 * i] += 10; /* far away: new lists */
    evaluate(&f, NULL);
    for (size_t i = 0; i < f.model->points; i++)
        f.y[2 * i] = scatter(2 * i) * .0008;
    evaluate(&f, NULL); /* and back: lists of this place */
    assert_memory_equal(first, f.rate, f.model->state_size * sizeof *first);
    omp_set_num_threads(threads);
    free(first);
    drop(&f);
}

/* Probes reproduce quadratics on the cloud; stress and strain go together by Hooke's law; energy of a uniform
 * state. */
static void point_values(void **unused)
{
    (void)unused;
    struct fixture f;
    box(&f, 2, .08);
    f.plain.scene.body.jitter = .1;
    make(&f);
    const struct material *material = &f.plain.material[0];
    for (size_t i = 0; i < f.model->points; i++) {
        const double *x = f.model->position + 3 * i;
        f.y[2 * i] = 1 + x[0] - 2 * x[1] + x[0] * x[1];
        f.y[2 * i + 1] = x[1] * x[1];
        velocity(&f, f.y)[2 * i] = .5;
        stress(&f, f.y)[3 * i] = 2;
    }
    struct messages messages = {0};
    struct probe probe;
    const double place[3] = {.97, .8, 0};
    assert_int_equal(updated_probe(f.model, place, &probe, &messages), SELAS_OK);
    double value[6];
    updated_observe(f.model, &probe, SELAS_DISPLACEMENT, f.y, NULL, value);
    assert_near(value[0], 1 + .97 - 1.6 + .97 * .8, 1e-10);
    assert_near(value[1], .64, 1e-10);
    updated_observe(f.model, &probe, SELAS_STRESS, f.y, NULL, value);
    assert_near(value[0], 2, 1e-10);
    assert_near(value[1], 0, 1e-10);
    assert_near(value[2], 2 * material->poisson, 1e-10); /* plane strain */
    struct energy energy;
    updated_energy(f.model, f.y, &energy);
    assert_near(energy.kinetic, .5 * material->density * .8 * .25, 1e-10);
    const double modulus = material->young / (1 - material->poisson * material->poisson);
    assert_near(energy.strain, .5 * .8 * 4 / modulus, 1e-10);
    probe_free(&probe);
    drop(&f);
}

/* On walls motions are what these prescribe, wherever the particles are and however they move. */
static void motions_on_walls(void **state)
{
    (void)state;
    for (int dimension = 1; dimension <= 3; dimension++) {
        const double size[3] = {1, .8, .6};
        struct fixture f;
        plain_box(&f.plain, dimension, size, .1);
        f.plain.scene.body.jitter = .1;
        struct boundary *moved = &f.plain.scene.boundary[FACE_X_LOW];
        moved->kind = BOUNDARY_DISPLACEMENT;
        moved->amplitude = .01;
        moved->direction[0] = dimension > 1 ? .6 : 1;
        moved->direction[1] = dimension > 1 ? .8 : 0;
        f.plain.scene.boundary[FACE_X_HIGH].kind = BOUNDARY_FIXED;
        if (dimension > 1) f.plain.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_ROLLER;
        f.options = updated_lagrangian_published();
        make(&f);
        const size_t unknowns = f.model->unknowns;
        for (size_t k = 0; k < 2 * unknowns; k++)
            f.y[k] = random_uniform(5, k);
        const double motion[3][FACES] = {{2}, {3}, {5}};
        const struct drive drive = {.displacement = motion[0], .velocity = motion[1], .motion = motion[2]};
        updated_rate(f.model, &drive, f.y, f.rate);
        const double at[3][3] = {{0, .43, .31}, {1, .43, .31}, {.52, 0, .31}};
        for (int place = 0; place < (dimension > 1 ? 3 : 2); place++) {
            double position[3] = {0}, value[3];
            struct probe probe;
            struct messages messages = {0};
            memcpy(position, at[place], (size_t)dimension * sizeof *position);
            assert_int_equal(updated_probe(f.model, position, &probe, &messages), SELAS_OK);
            for (int field = SELAS_DISPLACEMENT; field <= SELAS_ACCELERATION; field++) {
                updated_observe(f.model, &probe, (selas_field)field, f.y, f.rate + unknowns, value);
                for (int c = 0; c < dimension; c++)
                    if (place < 2 || c == 1)
                        assert_near(value[c], place > 0 ? 0 : .01 * moved->direction[c] * motion[field][0],
                                    1e-10);
            }
            probe_free(&probe);
        }
        drop(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradient_and_jaumann),
        cmocka_unit_test(tractions_balance),
        cmocka_unit_test(divergence_inside),
        cmocka_unit_test(walls),
        cmocka_unit_test(viscosity_of_a_pair),
        cmocka_unit_test(artificial_stress),
        cmocka_unit_test(spectrum_of_a_lattice),
        cmocka_unit_test(spectrum_beside_dampers),
        cmocka_unit_test(same_bits),
        cmocka_unit_test(point_values),
        cmocka_unit_test(motions_on_walls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
