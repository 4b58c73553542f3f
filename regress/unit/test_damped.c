/* Damped materials in runs: a plane wave against its transform, the energy of the step, its eigenvalues. */
#include "from_deck.h"
#include "step_map.h"

#include "base/memory.h"
#include "damping/ground.h"
#include "method/consistent/consistent.h"
#include "method/damped/damped.h"
#include "method/methods.h"
#include "stepping/stepping.h"

#include <math.h>
#include <stdlib.h>

/* --- A plane wave -------------------------------------------------------------------------------------- */

#define BAR                                                                                                  \
    "&scene dimension = 1, end_time = 30.0 /\n"                                                              \
    "&method degree = 4, mass = 'exact', ends = 'mapped', mechanisms = 3 /\n"                                \
    "&stepping scheme = '%s', time_step = 0.0625 /\n"                                                        \
    "&material name = 'rock', density = 1.0, p_speed = 1.0, s_speed = 0.5, q_p = %s, q_s = %s, "             \
    "q_frequency = 1.0 /\n"                                                                                  \
    "&body name = 'bar', material = 'rock', shape = 'box', low = 0.0, high = 27.6, spacing = 0.12 /\n"       \
    "&load face = 'x-', shape = 'face', direction = 1.0, history = 'sine-burst', frequency = 1.0, cycles = " \
    "6 /\n"

enum { PERIOD = 64, FREQUENCIES = 4 * PERIOD };

/* Velocity behind a pressed end, v(s) = f(s) exp(-s x sqrt(rho/M)) / sqrt(rho M), at t = i dt. */
static void exact_velocity(const struct history *history, const struct modulus *modulus, double x, double dt,
                           size_t rows, double *v)
{
    const double decay = 16. / PERIOD;
    for (size_t i = 0; i < rows; i++)
        v[i] = 0;
    for (int j = 0; j < FREQUENCIES; j++) {
        const double complex s = decay + 2 * M_PI * I * j / PERIOD, m = modulus_at(modulus, s);
        const double complex value = history_laplace(history, s) * cexp(-s * x * csqrt(1 / m)) / csqrt(m);
        for (size_t i = 0; i < rows; i++)
            v[i] += (j == 0 ? 1. : 2.) / PERIOD * creal(value * cexp(s * dt * (double)i));
    }
}

/* Velocities of a run at one place, rid of its time error. */
static size_t run_velocity(const struct scene *scene, const double place[3], double *dt, double **velocity)
{
    struct model *model = NULL;
    struct stepper *stepper = NULL;
    struct state state;
    struct probe probe = {0};
    struct messages messages = {0};
    if (model_create(scene, &model, &messages) != SELAS_OK) print_error("%s", messages.text);
    assert_non_null(model);
    if (stepper_create(model, &stepper, &messages) != SELAS_OK) print_error("%s", messages.text);
    assert_non_null(stepper);
    assert_int_equal(state_create(stepper, &state, &messages), SELAS_OK);
    assert_int_equal(model->core->probe(model, place, &probe, &messages), SELAS_OK);
    const size_t rows = stepper->steps + stepper->extra + 1, kept = stepper->steps + 1;
    double *u = calloc(9 * rows, sizeof *u), *v = u + 3 * rows, *a = v + 3 * rows;
    for (size_t i = 0; i < rows; i++) {
        if (i > 0) stepper->scheme->step(stepper, &state);
        model_observe(model, &probe, SELAS_DISPLACEMENT, state.y, state.a, u + 3 * i);
        model_observe(model, &probe, SELAS_VELOCITY, state.y, state.a, v + 3 * i);
        model_observe(model, &probe, SELAS_ACCELERATION, state.y, state.a, a + 3 * i);
    }
    assert_true(stepper->unwarp == (stepper->scheme->order == 2));
    assert_int_equal(stepper->scheme->finish(stepper, rows, u, v, a, &messages), SELAS_OK);
    for (size_t i = 0; i < kept; i++)
        u[i] = v[3 * i];
    *velocity = u;
    *dt = stepper->dt;
    probe_free(&probe);
    state_free(&state);
    stepper_free(&stepper);
    model_free(&model);
    return kept;
}

static double distance(size_t n, const double *a, const double *b)
{
    double difference = 0, size = 0;
    for (size_t i = 0; i < n; i++) {
        difference += (a[i] - b[i]) * (a[i] - b[i]);
        size += b[i] * b[i];
    }
    return sqrt(difference / size);
}

/* The same with particles, 100 a wavelength: theirs is a second-order method. */
#define PARTICLES                                                                                            \
    "&scene dimension = 1, end_time = 12.0 /\n"                                                              \
    "&method name = 'sph', variant = 'total-lagrangian', law = 'linear', mechanisms = 3 /\n"                 \
    "&stepping scheme = '%s' /\n"                                                                            \
    "&material name = 'rock', density = 1.0, p_speed = 1.0, s_speed = 0.5, q_p = %s, q_s = %s, "             \
    "q_frequency = 1.0 /\n"                                                                                  \
    "&body name = 'bar', material = 'rock', shape = 'box', low = 0.0, high = 10.0, spacing = 0.01 /\n"       \
    "&load face = 'x-', shape = 'face', direction = 1.0, history = 'sine-burst', frequency = 1.0, cycles = " \
    "6 /\n"

/* After x wavelengths, 16 steps a period or more: the scheme against its own spectrum and against constant Q. */
static void waves_in_a_bar(const char *form, const char *scheme, double x, double most)
{
    static const char *const q[] = {"1e6", "100", "20"};
    for (int i = 0; i < 3; i++) {
        char deck[1024];
        snprintf(deck, sizeof deck, form, scheme, q[i], q[i]);
        struct from_deck from = right_scene(deck);
        struct ground_damping *damping = NULL;
        assert_int_equal(ground_damping_new(from.scene, true, &damping, &from.messages), SELAS_OK);
        const double place[3] = {x, 0, 0};
        double dt, *v = NULL;
        const size_t rows = run_velocity(from.scene, place, &dt, &v);
        double *exact = calloc(rows, sizeof *exact), error[2];
        const struct modulus *moduli[2] = {&damping->fitted[0].axial, &damping->wanted[0].axial};
        for (int k = 0; k < 2; k++) {
            exact_velocity(&from.scene->load[0].history, moduli[k], place[0], dt, rows, exact);
            error[k] = distance(rows, v, exact);
        }
        print_message("Q = %s: %.5f off its own spectrum, %.5f off constant Q\n", q[i], error[0], error[1]);
        assert_true(error[0] < most && error[1] < most);
        free(exact);
        free(v);
        ground_damping_free(damping);
        from_deck_free(&from);
    }
}

static void plane_wave_in_a_bar(void **state)
{
    (void)state;
    waves_in_a_bar(BAR, "leapfrog", 20, .005);
    waves_in_a_bar(BAR, "modified-equation", 20, .005);
}

static void plane_wave_in_particles(void **state)
{
    (void)state;
    waves_in_a_bar(PARTICLES, "leapfrog", 4, .02);
}

/* --- The step as a linear map -------------------------------------------------------------------------- */

struct damped_run {
    struct from_deck from;
    struct model *model;
    double limit; /* of the step, undamped */
};

static struct damped_run run_of(const char *deck)
{
    struct damped_run run = {.from = right_scene(deck)};
    struct messages messages = {0};
    double omega = 0, error = 0;
    if (model_create(run.from.scene, &run.model, &messages) != SELAS_OK) print_error("%s", messages.text);
    assert_non_null(run.model);
    assert_int_equal(largest_frequency(run.model, &omega, &error, &messages), SELAS_OK);
    assert_true(error < 1e-3);
    run.limit = 2 / omega;
    return run;
}

static void run_end(struct damped_run *run)
{
    model_free(&run->model);
    from_deck_free(&run->from);
}

#define SQUARE                                                                                               \
    "&scene dimension = 2, end_time = 1.0 /\n&method degree = 2, mass = '%s', ends = 'open' /\n"             \
    "&body name = 'b', material = 'm', shape = 'box', low = 0.0, 0.0, high = 4.0, 4.0, spacing = 1.0 /\n"

#define PILLAR                                                                                               \
    "&scene dimension = 3, end_time = 1.0 /\n&method degree = 2, mass = '%s', mechanisms = 2 /\n"            \
    "&body name = 'b', material = 'm', low = 0.0, 0.0, 0.0, high = 1.0, 1.0, 3.0, spacing = 1.0 /\n"         \
    "&layer material = 's', top = 1.0 /\n&layer material = 'm', top = 2.3 /\n"                               \
    "&material name = 's', density = 0.7, lambda = 1.0, mu = 0.5, q_p = %g, q_s = %g, q_frequency = 0.2 /\n"
/* The general operator: blocks of the same other ground. */
#define BLOCKS                                                                                               \
    "&scene dimension = 2, end_time = 1.0 /\n&method mechanisms = 3 /\n"                                     \
    "&body name = 'b', material = 'm', low = 0.0, 0.0, high = 5.0, 4.0, spacing = 1.0 /\n"                   \
    "&block material = 's', shape = 'ellipsoid', centre = 2.1, 1.2, size = 2.4, 1.5 /\n"                     \
    "&block material = 's', shape = 'box', centre = 3.6, 3.2, size = 1.7, 1.3 /\n"                           \
    "&material name = 's', density = 0.7, lambda = 1.0, mu = 0.5, q_p = %g, q_s = %g, q_frequency = 0.2 /\n"
#define GROUND                                                                                               \
    "&material name = 'm', density = 1.0, lambda = %g, mu = 1.0, q_p = %g, q_s = %g, q_frequency = 0.1 /\n"

/* Free squares and pillars of layers: Q of P and S waves, of each layer its own, Poisson ratios to .49. The limit is
 * that of the undamped body with unrelaxed moduli, and is sharp. */
static void nothing_grows_below_the_limit(void **state)
{
    (void)state;
    static const struct {
        double poisson, q_p, q_s, other_p, other_s; /* other: of layers; 0: there are none */
    } grounds[] = {{.25, 2, 2, 0, 0},      {.25, 20, 20, 0, 0},   {.25, 40, 20, 0, 0},  {.25, 20, 40, 0, 0},
                   {.25, 1000, 500, 0, 0}, {.49, 20, 20, 0, 0},   {.49, 700, 20, 0, 0}, {.25, 40, 20, 7, 5},
                   {.25, 1000, 900, 3, 2}, {.49, 300, 10, 40, 30}};
    for (size_t i = 0; i < 2 * sizeof grounds / sizeof *grounds; i++) {
        const double nu = grounds[i / 2].poisson, lambda = 2 * nu / (1 - 2 * nu);
        const bool layers = grounds[i / 2].other_p > 0;
        const char *const mass = i % 2 == 0 ? "exact" : "vc3";
        char deck[2048];
        int at =
            layers ? snprintf(deck, sizeof deck, PILLAR, mass, grounds[i / 2].other_p, grounds[i / 2].other_s)
                   : snprintf(deck, sizeof deck, SQUARE, mass);
        snprintf(deck + at, sizeof deck - (size_t)at, GROUND, lambda, grounds[i / 2].q_p, grounds[i / 2].q_s);
        struct damped_run run = run_of(deck);
        size_t count;
        const double below = map_largest(run.model, .9999 * run.limit, NULL, &count);
        const double above = map_growth(map_step, run.model, 1.002 * run.limit);
        print_message("nu %.2f, Q %g %g, %g %g, %zu parts: 1 %+.1e below, 1 %+.1e above the limit\n", nu,
                      grounds[i / 2].q_p, grounds[i / 2].q_s, grounds[i / 2].other_p, grounds[i / 2].other_s,
                      damped_of(run.model)->parts, below - 1, above - 1);
        assert_true(below < 1 + 2e-7); /* rounding of the double eigenvalues of rigid motions */
        assert_true(above > 1 + 1e-4);
        const double longest = sqrt(3) * run.limit; /* omega dt = sqrt(12) */
        const double within = map_largest_of(map_corrected_step, run.model, .9999 * longest, NULL, &count);
        const double beyond = map_growth(map_corrected_step, run.model, 1.002 * longest);
        print_message("  modified equation: 1 %+.1e below, 1 %+.1e above its limit\n", within - 1,
                      beyond - 1);
        assert_true(within < 1 + 2e-7 && beyond > 1 + 1e-4);
        run_end(&run);
    }
}

static double noise(uint64_t *bits)
{
    *bits = *bits * 6364136223846793005u + 1442695040888963407u;
    return (double)(*bits >> 11) * 0x1p-52 - 1;
}

/* A model whose speeds, Poisson's ratio (.2 to .45) and Q_s (3 to 1000) are drawn by chance at places half a spacing
 * apart, Q_p up to the most that is passive; some values without Q. */
static void write_noise(const char *path, uint64_t bits, bool all)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "0 0 -300 100 100 0\n50 50 50\n3 3 7\n1 9000 1 9000 1 9000\n");
    for (int i = 0; i < 63; i++) {
        const double s = 1000 * (1.2 + noise(&bits)), nu = .325 + .125 * noise(&bits);
        const double ratio = sqrt((2 - 2 * nu) / (1 - 2 * nu));
        const double q_s = 3 * pow(1000. / 3, .5 + .5 * noise(&bits));
        const double q_p = q_s * .75 * ratio * ratio * (.75 + .25 * noise(&bits));
        fprintf(file, "%d %d %d %.9g %.9g %.9g %.9g %.9g\n", i % 3 * 50, i / 3 % 3 * 50, i / 9 * 50 - 300,
                ratio * s, s, 2000 + 500 * noise(&bits), q_p, !all && i % 11 == 5 ? 0 : q_s);
    }
    fclose(file);
}

static const char model_path[] = "build/test/model-noise";
#define MODEL                                                                                                \
    "&scene dimension = 3, end_time = 1.0 /\n&method mechanisms = 3 /\n"                                     \
    "&body low = 3*0.0, high = 100.0, 100.0, 300.0, spacing = 100.0 /\n"                                     \
    "&model file = 'build/test/model-noise', q_frequency = 3.0 /\n"

/* Particles, a little out of order. */
#define LATTICE                                                                                              \
    "&scene dimension = 2, end_time = 1.0 /\n"                                                               \
    "&method name = 'sph', variant = 'total-lagrangian', law = 'linear', mechanisms = 2 /\n"                 \
    "&body name = 'b', material = 'm', low = 0.0, 0.0, high = 6.0, 5.0, spacing = 1.0, jitter = 0.1 /\n"     \
    "&boundary face = 'x-', kind = 'fixed' /\n"                                                              \
    "&material name = 'm', density = 0.7, lambda = 1.0, mu = 0.5, q_p = 12, q_s = 6, q_frequency = 0.2 /\n"

/* --- Energy -------------------------------------------------------------------------------------------- */

/* x.K_p x over all parts, each with its factor. */
static double form(const struct damped *d, const double factor[], const double *x)
{
    const size_t n = d->model.unknowns;
    double sum = 0, *y = calloc(2 * n, sizeof *y);
    struct energy energy;
    memcpy(y, x, n * sizeof *x);
    for (size_t p = 0; p < d->parts; p++) {
        d->part[p].model->core->energy(d->part[p].model, y, &energy);
        sum += factor[p] * 2 * energy.strain;
    }
    free(y);
    return sum;
}

static double form_of_memory(const struct damped *d, size_t l, const double *x)
{
    double factor[1 + MOST_MECHANISMS];
    for (size_t p = 0; p < d->parts; p++)
        factor[p] = d->part[p].memory[l];
    return form(d, factor, x);
}

static void mean(size_t n, const double *one, const double *other, double *middle)
{
    for (size_t i = 0; i < n; i++)
        middle[i] = (one[i] + other[i]) / 2;
}

/* Eq 17 of the manual; y before and after the step, w in the latter. */
static double energy_of_step(struct damped *d, double dt, const double *before, const double *after)
{
    const size_t n = d->model.unknowns;
    const double whole[1 + MOST_MECHANISMS] = {1}, *w = after + n;
    double given[1 + MOST_MECHANISMS], *middle = calloc(n, sizeof *middle), sum = 0;
    for (size_t p = 0; p < d->parts; p++)
        given[p] = d->part[p].given;
    d->model.spatial->weigh(&d->model, w, middle);
    for (size_t i = 0; i < n; i++)
        sum += w[i] * middle[i];
    sum -= dt * dt / 4 * form(d, whole, w);
    mean(n, before, after, middle);
    sum += form(d, given, middle);
    for (size_t l = 0; l < d->damping->mechanisms; l++) {
        const double h = d->damping->rate[l] * dt;
        mean(n, before + (2 + l) * n, after + (2 + l) * n, middle);
        sum += (1 + h * h / 4) * form_of_memory(d, l, middle);
    }
    free(middle);
    return sum / 2;
}

/* What damping takes in half of that step (Eq 18). */
static double taken_in_half(struct damped *d, double dt, const double *before, const double *after)
{
    const size_t n = d->model.unknowns;
    double *middle = calloc(n, sizeof *middle), sum = 0;
    for (size_t l = 0; l < d->damping->mechanisms; l++) {
        mean(n, before + (2 + l) * n, after + (2 + l) * n, middle);
        sum += d->damping->rate[l] * dt / 2 * form_of_memory(d, l, middle);
    }
    free(middle);
    return sum;
}

/* The energy of the step falls by what damping takes and nothing else, at .999 of the limit. */
static void energy_falls_by_what_damping_takes(void **state)
{
    (void)state;
    static const char *const mass[] = {"exact", "vc3", "general, a model", "particles"};
    write_noise(model_path, 3, false);
    for (int i = 0; i < 4; i++) {
        char deck[1024];
        const int at = snprintf(deck, sizeof deck, PILLAR, mass[i], 8., 6.);
        snprintf(deck + at, sizeof deck - (size_t)at, GROUND, 1., 40., 20.);
        struct damped_run run = run_of(i < 2 ? deck : i == 2 ? MODEL : LATTICE);
        struct damped *d = damped_of(run.model);
        const size_t size = run.model->state_size, n = run.model->unknowns;
        const double dt = .999 * run.limit;
        double *y = calloc(size, sizeof *y), *before = calloc(size, sizeof *y), *a = calloc(n, sizeof *a);
        uint64_t bits = 7;
        for (size_t k = 0; k < size; k++) {
            bits = bits * 6364136223846793005u + 1442695040888963407u;
            y[k] = (double)(bits >> 11) * 0x1p-52 - 1;
        }
        double energy = 0, start = 0, half = 0, worst = 0;
        for (int k = 0; k < 400; k++) {
            memcpy(before, y, size * sizeof *y);
            map_step(run.model, dt, y, a);
            const double next = energy_of_step(d, dt, before, y), taken = taken_in_half(d, dt, before, y);
            if (k == 0) start = next;
            if (k > 0) worst = fmax(worst, fabs(next - energy + half + taken) / start);
            energy = next;
            half = taken;
        }
        print_message("mass %s, %zu parts: energy %.3g of the start, balance within %.1e of it\n", mass[i],
                      d->parts, energy / start, worst);
        assert_true(worst < 1e-11 && energy < .9 * start && energy > 0);
        struct energy now;
        run.model->core->energy(run.model, y, &now);
        assert_true(now.strain > 0 && run.model->core->loss(run.model, y) > 0);
        free(y);
        free(before);
        free(a);
        run_end(&run);
    }
}

/* --- Stress -------------------------------------------------------------------------------------------- */

/* Uniform strain of which each mechanism remembers a part: stress and energy by the moduli as fitted. */
static void stress_is_that_of_the_moduli(void **state)
{
    (void)state;
    static const double kept[2] = {.3, .8}, slope[3] = {.7, -.2, .4};
    char deck[1024];
    const int at = snprintf(deck, sizeof deck, PILLAR, "vc3", 8., 6.);
    snprintf(deck + at, sizeof deck - (size_t)at, GROUND, 1., 40., 20.);
    struct damped_run run = run_of(deck);
    struct damped *d = damped_of(run.model);
    const struct consistent *c = consistent_of(d->part[0].model);
    const size_t n = run.model->unknowns;
    double *y = calloc(run.model->state_size, sizeof *y), *a = calloc(n, sizeof *a);
    for (size_t i = 0; i < n; i++) {
        const size_t axis = i / c->volume, place = i % c->volume;
        const size_t index[3] = {place % c->n[0], place / c->n[0] % c->n[1], place / c->plane};
        y[i] = slope[axis] * c->spline[axis]->greville[index[axis]];
        for (size_t l = 0; l < 2; l++)
            y[(2 + l) * n + i] = kept[l] * y[i];
    }
    for (int layer = 0; layer < 2; layer++) {
        const struct damped_moduli *moduli = &d->damping->fitted[layer == 0 ? 1 : 0]; /* &material: s, m */
        const double place[3] = {.4, .6, layer == 0 ? .5 : 1.7}, trace = slope[0] + slope[1] + slope[2];
        double axial = moduli->axial.size, shear = moduli->shear.size, stress[6], pressure;
        struct probe probe = {0};
        for (size_t l = 0; l < 2; l++) {
            axial -= moduli->axial.size * moduli->axial.weight[l] * (1 - kept[l]);
            shear -= moduli->shear.size * moduli->shear.weight[l] * (1 - kept[l]);
        }
        assert_int_equal(run.model->core->probe(run.model, place, &probe, &run.from.messages), SELAS_OK);
        model_observe(run.model, &probe, SELAS_STRESS, y, a, stress);
        model_observe(run.model, &probe, SELAS_PRESSURE, y, a, &pressure);
        for (int i = 0; i < 3; i++)
            assert_near(stress[i], (axial - 2 * shear) * trace + 2 * shear * slope[i], 1e-9);
        assert_near(pressure, -(axial - 4. / 3 * shear) * trace, 1e-9);
        probe_free(&probe);
    }
    free(y);
    free(a);
    run_end(&run);
}

/* --- Ground that varies in all directions --------------------------------------------------------------- */

/* Nothing grows below the limit, which is sharp, and what mechanisms take and leave is not negative, for any
 * displacements. */
static void assert_passive(const char *what, const char *deck)
{
    struct damped_run run = run_of(deck);
    struct damped *d = damped_of(run.model);
    const size_t n = run.model->unknowns;
    double *x = calloc(n, sizeof *x), given[1 + MOST_MECHANISMS], least = INFINITY;
    uint64_t bits = 7;
    assert_non_null(consistent_of(d->part[0].model)->general);
    for (size_t p = 0; p < d->parts; p++)
        given[p] = d->part[p].given;
    for (int turn = 0; turn < 20; turn++) {
        const double whole[1 + MOST_MECHANISMS] = {1};
        for (size_t k = 0; k < n; k++)
            x[k] = noise(&bits);
        const double size = form(d, whole, x);
        least = fmin(least, form(d, given, x) / size);
        for (size_t l = 0; l < d->damping->mechanisms; l++)
            least = fmin(least, form_of_memory(d, l, x) / size);
    }
    size_t count;
    const double below = map_largest(run.model, .9999 * run.limit, NULL, &count);
    const double above = map_growth(map_step, run.model, 1.002 * run.limit);
    print_message("%s, %zu parts: 1 %+.1e below, 1 %+.1e above the limit; least %.1e\n", what, d->parts,
                  below - 1, above - 1, least);
    assert_true(below < 1 + 2e-7 && above > 1 + 1e-4 && least > 0);
    free(x);
    run_end(&run);
}

/* Particles: below the limit nothing grows. */
static void particles_are_passive(void **state)
{
    (void)state;
    struct damped_run run = run_of(LATTICE);
    size_t count;
    const double below = map_largest(run.model, .9999 * run.limit, NULL, &count);
    const double above = map_growth(map_step, run.model, 1.002 * run.limit);
    print_message("particles, %zu parts: 1 %+.1e below, 1 %+.1e above the limit\n",
                  damped_of(run.model)->parts, below - 1, above - 1);
    assert_true(below < 1 + 2e-7 && above > 1 + 1e-4);
    run_end(&run);
}

/* Blocks with a Q of their own. */
static void general_ground_is_passive(void **state)
{
    (void)state;
    static const double q[][4] = {{7, 5, 40, 20}, {40, 20, 7, 5}, {3, 2, 1000, 900}, {40, 30, 300, 10}};
    for (size_t i = 0; i < sizeof q / sizeof *q; i++) {
        char deck[2048], what[64];
        const int at = snprintf(deck, sizeof deck, BLOCKS, q[i][0], q[i][1]);
        snprintf(deck + at, sizeof deck - (size_t)at, GROUND, i == 3 ? 48. : 1., q[i][2], q[i][3]);
        snprintf(what, sizeof what, "blocks, Q %g %g, %g %g", q[i][0], q[i][1], q[i][2], q[i][3]);
        assert_passive(what, deck);
    }
}

static void ground_from_a_model_is_passive(void **state)
{
    (void)state;
    for (int seed = 0; seed < 2; seed++) {
        char what[64];
        write_noise(model_path, 11 + (uint64_t)seed, seed % 2 == 0);
        snprintf(what, sizeof what, "model %d by chance", seed);
        assert_passive(what, MODEL);
    }
    remove(model_path);
}

/* Mechanisms over the unit of time are the same in all units, a moment tensor beside a force or not. */
static void mechanisms_in_other_units(void **state)
{
    (void)state;
    static const char text[] = "&scene dimension=2, end_time=%g /\n&material name='m', density=1, "
                               "p_speed=%g, s_speed=%g, q_p=60, q_s=30 /\n"
                               "&body material='m', low=-2,0, high=2,2, spacing=.25 /\n"
                               "&load kind='moment-tensor', centre=0,1, moment=1,.3,0,.2,0,0, "
                               "history='ricker', frequency=%g, delay=%g /\n"
                               "&load kind='body-force', shape='point', centre=.5,1, direction=0,1, "
                               "history='gaussian', width=%g, delay=%g /\n";
    double rate[2][3], centroid[2];
    for (int k = 0; k < 2; k++) {
        const double unit = k == 0 ? 1 : 1e-3;
        char deck[1000];
        struct ground_damping *damping = NULL;
        snprintf(deck, sizeof deck, text, 9 * unit, 1.8 / unit, 1 / unit, .4 / unit, 3 * unit, 1.5 * unit,
                 7 * unit);
        struct from_deck from = right_scene(deck);
        assert_int_equal(ground_damping_new(from.scene, true, &damping, &from.messages), SELAS_OK);
        assert_true(damping->mechanisms <= 3);
        for (size_t l = 0; l < damping->mechanisms; l++)
            rate[k][l] = damping->rate[l] * unit;
        centroid[k] = damping->centroid * unit;
        if (k == 1) assert_near(centroid[1], centroid[0], 1e-6 * centroid[0]);
        for (size_t l = 0; k == 1 && l < damping->mechanisms; l++)
            assert_near(rate[1][l], rate[0][l], 1e-4 * rate[0][l]);
        ground_damping_free(damping);
        from_deck_free(&from);
    }
}

#define SAME                                                                                                 \
    "&scene dimension = 3, end_time = 1.0 /\n&method operator = 'general', mechanisms = 2 /\n"               \
    "&body name = 'b', material = 'm', low = 3*0.0, high = 5.0, 4.0, 4.0, spacing = 1.0 /\n"                 \
    "&boundary face = 'x+', kind = 'transmitting', layer = 'lysmer' /\n" ROCK("m")
#define ROCK(name)                                                                                           \
    "&material name = '" name                                                                                \
    "', density = 0.7, lambda = 1.0, mu = 0.5, q_p = 30, q_s = 20, q_frequency = 0.2 /\n"

/* Graded ground and blocks of one rock by several names: forces, dampers and stress of even ground. */
static void one_rock_by_many_names(void **state)
{
    (void)state;
    struct damped_run even = run_of(SAME);
    struct damped_run many =
        run_of(SAME ROCK("n") ROCK("o") "&layer material = 'm', top = 0.0, bottom = 'n' /\n"
                                        "&layer material = 'n', top = 3.0 /\n"
                                        "&block material = 'o', shape = 'ellipsoid', "
                                        "centre = 4.1, 2.2, 1.2, size = 2.4, 2.0, 1.5 /\n");
    const size_t n = even.model->unknowns;
    double *y = calloc(even.model->state_size, sizeof *y), *a = calloc(2 * n, sizeof *a);
    const double places[2][3] = {{4.4, 2.2, 1.3}, {1.2, 1.3, 1.8}};
    uint64_t bits = 7;
    assert_true(damped_of(even.model)->parts > 1 && many.model->state_size == even.model->state_size);
    for (size_t k = 0; k < even.model->state_size; k++)
        y[k] = noise(&bits);
    const struct drive drive = {.extra = y + 2 * n};
    even.model->spatial->accelerate(even.model, &drive, .1, y, y + n, a);
    many.model->spatial->accelerate(many.model, &drive, .1, y, y + n, a + n);
    for (size_t i = 0; i < n; i++)
        assert_near(a[i], a[n + i], 1e-11);
    for (int i = 0; i < 2; i++) {
        double stress[2][6] = {{0}};
        for (int which = 0; which < 2; which++) {
            struct damped_run *run = which == 0 ? &even : &many;
            struct probe probe = {0};
            assert_int_equal(run->model->core->probe(run->model, places[i], &probe, &run->from.messages),
                             SELAS_OK);
            model_observe(run->model, &probe, SELAS_STRESS, y, a, stress[which]);
            probe_free(&probe);
        }
        for (int k = 0; k < 6; k++)
            assert_near(stress[0][k], stress[1][k], 1e-11);
        assert_true(fabs(stress[0][0]) > .01);
    }
    free(y);
    free(a);
    run_end(&even);
    run_end(&many);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mechanisms_in_other_units),
        cmocka_unit_test(plane_wave_in_a_bar),
        cmocka_unit_test(plane_wave_in_particles),
        cmocka_unit_test(nothing_grows_below_the_limit),
        cmocka_unit_test(energy_falls_by_what_damping_takes),
        cmocka_unit_test(stress_is_that_of_the_moduli),
        cmocka_unit_test(general_ground_is_passive),
        cmocka_unit_test(particles_are_passive),
        cmocka_unit_test(ground_from_a_model_is_passive),
        cmocka_unit_test(one_rock_by_many_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
