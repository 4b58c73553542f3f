/* Leapfrog, the modified equation, the time-dispersion transform, the largest frequency and the choice of the
 * step, on chains of masses and springs whose answers are known in closed form. */
#include "stepping/schemes.h"
#include "stepping/time_dispersion.h"

#include "base/memory.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double PI = 3.14159265358979323846;

/* n unit masses in a row between two walls, springs of stiffness k, a load on the first mass, a damper c on
 * the last: eigenvalues 4 k sin^2(j pi / (2 (n + 1))). */
enum { CHAIN = 40 };
struct chain {
    struct model model;
    double stiffness, damper;
};

static void chain_accelerate(struct model *model, const struct drive *drive, double half_step,
                             const double *u, const double *v, double *a)
{
    const struct chain *chain = (const struct chain *)model;
    const size_t n = model->unknowns;
    for (size_t i = 0; i < n; i++) {
        const double left = i > 0 ? u[i - 1] : 0.0;
        const double right = i + 1 < n ? u[i + 1] : 0.0;
        a[i] = -chain->stiffness * (2.0 * u[i] - left - right);
    }
    if (drive->load != NULL) a[0] += drive->load[0];
    if (v != NULL) a[n - 1] -= chain->damper * v[n - 1];
    a[n - 1] /= 1.0 + half_step * chain->damper;
    model->evaluations++;
}

static void chain_energy(struct model *model, const double *y, struct energy *energy)
{
    const struct chain *chain = (const struct chain *)model;
    const size_t n = model->unknowns;
    *energy = (struct energy){0.0, 0.0};
    for (size_t i = 0; i <= n; i++) {
        const double stretch = (i < n ? y[i] : 0.0) - (i > 0 ? y[i - 1] : 0.0);
        energy->strain += 0.5 * chain->stiffness * stretch * stretch;
        if (i < n) energy->kinetic += 0.5 * y[n + i] * y[n + i];
    }
}

static void chain_initialise(struct model *model, double *y)
{
    (void)model;
    y[0] = 1.0;
}

static const struct method chain_method = {.name = "chain", .variant = "test"};
static const struct model_core chain_core = {.energy = chain_energy};
static const struct model_core plucked_core = {.energy = chain_energy, .initialise = chain_initialise};
static const struct model_operator chain_operator = {.accelerate = chain_accelerate};

struct fixture {
    struct scene scene;
    struct load load;
    struct material material;
    struct chain chain;
    struct messages messages;
};

static void set_up(struct fixture *f, size_t n, double stiffness, double damper, const char *scheme)
{
    memset(f, 0, sizeof *f);
    f->material.p_speed = 1.0;
    f->scene.materials = 1;
    f->scene.material = &f->material;
    f->scene.body.spacing = 1.0;
    f->scene.end_time = 10.0;
    f->scene.stepping.safety = 0.9;
    strcpy(f->scene.stepping.scheme, scheme);
    f->chain = (struct chain){.model = {.method = &chain_method,
                                        .core = &chain_core,
                                        .spatial = &chain_operator,
                                        .scene = &f->scene,
                                        .unknowns = n,
                                        .state_size = 2 * n,
                                        .damped = damper > 0.0,
                                        .self_adjoint = true},
                              .stiffness = stiffness,
                              .damper = damper};
}

static void add_load(struct fixture *f, struct history history)
{
    f->load.history = history;
    f->scene.loads = 1;
    f->scene.load = &f->load;
}

static void largest_frequency_of_a_chain(void **state)
{
    (void)state;
    struct fixture f;
    set_up(&f, CHAIN, 3.0, 0.0, "leapfrog");
    double omega = 0.0;
    double error = 0.0;
    assert_int_equal(largest_frequency(&f.chain.model, &omega, &error, &f.messages), SELAS_OK);
    const double exact = 2.0 * sqrt(3.0) * sin(CHAIN * PI / (2.0 * (CHAIN + 1)));
    assert_true(fabs(omega - exact) <= 1e-3 * exact);
    assert_true(omega <= exact * (1.0 + 1e-12)); /* a Ritz value is a lower bound */
    assert_true(error <= 1e-3);
    f.chain.model.self_adjoint = false;
    assert_int_equal(largest_frequency(&f.chain.model, &omega, &error, &f.messages), SELAS_OK);
    assert_true(fabs(omega - exact) <= 1e-2 * exact);
}

/* Free vibration of one mass: error at t = 10 for two steps gives the order. */
static double free_vibration_error(const char *scheme, double dt, double *growth)
{
    struct fixture f;
    set_up(&f, 1, 0.5, 0.0, scheme); /* 2 springs of 0.5: omega = 1 */
    f.chain.model.core = &plucked_core;
    f.scene.initial.kind = INITIAL_GAUSSIAN; /* not at rest: no unwarping */
    f.scene.stepping.time_step = dt;
    struct stepper *stepper = NULL;
    struct state state;
    assert_int_equal(stepper_create(&f.chain.model, &stepper, &f.messages), SELAS_OK);
    assert_int_equal(state_create(stepper, &state, &f.messages), SELAS_OK);
    while (state.time < 10.0 - 1e-9)
        stepper->scheme->step(stepper, &state);
    const double error = fabs(state.y[0] - cos(state.time));
    for (int i = 0; i < 20000; i++)
        stepper->scheme->step(stepper, &state);
    *growth = fabs(state.y[0]);
    state_free(&state);
    stepper_free(&stepper);
    return error;
}

static void schemes_have_their_order(void **state)
{
    (void)state;
    for (size_t i = 0; scheme_table[i] != NULL; i++) {
        const struct scheme_class *scheme = scheme_table[i];
        if (!scheme->needs_acceleration) continue;
        double growth = 0.0;
        const double coarse = free_vibration_error(scheme->name, 0.1, &growth);
        const double fine = free_vibration_error(scheme->name, 0.05, &growth);
        const double order = log2(coarse / fine);
        assert_true(fabs(order - scheme->order) < 0.15);
        assert_true(growth < 1.01);
    }
}

/* Just below the limit the motion stays bounded for 20,000 steps; just above it does not. */
static void limits_are_sharp(void **state)
{
    (void)state;
    for (size_t i = 0; scheme_table[i] != NULL; i++)
        for (int above = 0; above < 2 && scheme_table[i]->needs_acceleration; above++) {
            const struct scheme_class *scheme = scheme_table[i];
            struct fixture f;
            set_up(&f, CHAIN, 1.0, 0.0, scheme->name);
            f.chain.model.core = &plucked_core;
            f.scene.initial.kind = INITIAL_GAUSSIAN;
            const double omega = 2.0 * sin(CHAIN * PI / (2.0 * (CHAIN + 1)));
            f.scene.stepping.time_step =
                scheme_limit(scheme, &(struct spectrum){.omega = omega}, 0) * (above ? 1.002 : 0.998);
            f.scene.stepping.force = true;
            struct stepper *stepper = NULL;
            struct state s;
            assert_int_equal(stepper_create(&f.chain.model, &stepper, &f.messages), SELAS_OK);
            assert_int_equal(state_create(stepper, &s, &f.messages), SELAS_OK);
            double largest = 0.0;
            for (int step = 0; step < 20000 && largest < 1e6; step++) {
                stepper->scheme->step(stepper, &s);
                largest = fmax(largest, fabs(s.y[0]));
            }
            assert_int_equal(largest > 100.0, above);
            state_free(&s);
            stepper_free(&stepper);
        }
}

/* What the table says of the schemes: which are bounded for undamped waves, one default for each kind of model,
 * and that what acts on leapfrog's half steps is offered by schemes that have them. */
static void abilities(void **state)
{
    (void)state;
    int defaults[4] = {0};
    for (size_t i = 0; scheme_table[i] != NULL; i++) {
        const struct scheme_class *scheme = scheme_table[i];
        const unsigned halves = SCHEME_FILTERS | SCHEME_LAYERS | SCHEME_ONE_PASS | SCHEME_UNWARPS;
        const double longest = scheme_limit(scheme, &(struct spectrum){.omega = 1.0}, 5);
        assert_int_equal(longest > 0.0, (scheme->can & SCHEME_WAVES) != 0);
        if (!scheme->needs_acceleration) assert_int_equal(scheme->can & halves, 0);
        if ((scheme->can & SCHEME_UNWARPS) != 0) assert_non_null(scheme->finish);
        assert_true(scheme_find(scheme->name) == scheme);
        defaults[scheme->default_for]++;
    }
    assert_int_equal(defaults[DEFAULT_FOR_ACCELERATE], 1);
    assert_int_equal(defaults[DEFAULT_FOR_DAMPED], 1);
    assert_int_equal(defaults[DEFAULT_FOR_UNDAMPED], 1);
}

/* A message names the schemes that would do. */
static void names_of_schemes(void **state)
{
    (void)state;
    struct fixture f;
    char text[SCHEME_NAMES_SIZE];
    set_up(&f, CHAIN, 1.0, 0.0, "euler");
    assert_string_equal(scheme_names(&f.chain.model, SCHEME_DAMPED_FACES, text), "'leapfrog'");
    assert_string_equal(scheme_names(&f.chain.model, SCHEME_DAMPED, text),
                        "'leapfrog' or 'modified-equation'");
    static const struct model_operator rates = {0};
    f.chain.model.spatial = &rates;
    assert_string_equal(scheme_names(&f.chain.model, SCHEME_WAVES, text), "'rk4' or 'lsrk54'");
    assert_string_equal(scheme_names(&f.chain.model, SCHEME_FILTERS, text), "(none fits this method)");
}

static void a_step_beyond_the_limit_is_refused(void **state)
{
    (void)state;
    struct fixture f;
    set_up(&f, CHAIN, 1.0, 0.0, "leapfrog");
    f.scene.stepping.time_step = 1.1;
    struct stepper *stepper = NULL;
    assert_int_equal(stepper_create(&f.chain.model, &stepper, &f.messages), SELAS_BAD_SCENE);
    assert_null(stepper);
    assert_non_null(strstr(f.messages.text, "stability limit"));
    messages_free(&f.messages);
    f.scene.stepping.force = true;
    assert_int_equal(stepper_create(&f.chain.model, &stepper, &f.messages), SELAS_OK);
    stepper_free(&stepper);
}

/* With the half-step energy w.w/2 + u(n).K u(n+1)/2, leapfrog's energy balance with an implicit damper is
 * exact to rounding: the energy lost in a step is dt v.Cv. */
static void the_damper_takes_what_the_energy_loses(void **state)
{
    (void)state;
    struct fixture f;
    set_up(&f, CHAIN, 1.0, 0.7, "leapfrog");
    f.chain.model.core = &plucked_core;
    f.scene.initial.kind = INITIAL_GAUSSIAN;
    f.scene.stepping.time_step = 0.8;
    struct stepper *stepper = NULL;
    struct state s;
    assert_int_equal(stepper_create(&f.chain.model, &stepper, &f.messages), SELAS_OK);
    assert_int_equal(state_create(stepper, &s, &f.messages), SELAS_OK);
    const size_t n = CHAIN;
    const double dt = stepper->dt;
    double before = 0.0;
    double absorbed = 0.0;
    for (int step = 0; step < 300; step++) {
        /* half-step energy between n and n + 1 from v, a, u at n: w = v + dt a / 2, u' = u + dt w, f(u) = M a
         * + C v = -K u */
        double energy = 0.0;
        for (size_t i = 0; i < n; i++) {
            const double w = s.y[n + i] + 0.5 * dt * s.a[i];
            const double force = s.a[i] + (i == n - 1 ? f.chain.damper * s.y[n + i] : 0.0);
            energy += 0.5 * w * w - 0.5 * (s.y[i] + dt * w) * force;
        }
        if (step > 0) {
            absorbed = dt * f.chain.damper * s.y[2 * n - 1] * s.y[2 * n - 1];
            assert_true(fabs(before - energy - absorbed) < 1e-14);
        }
        before = energy;
        stepper->scheme->step(stepper, &s);
    }
    assert_true(before < 0.25); /* most has left */
    state_free(&s);
    stepper_free(&stepper);
}

/* Duhamel's integral for one mass at rest: u(t) = integral of f(tau) sin(omega (t - tau)) / omega, by the
 * Gauss rule in many panels. */
static double duhamel(const struct history *history, double omega, double t)
{
    static const double node[3] = {-0.7745966692414834, 0.0, 0.7745966692414834};
    static const double weight[3] = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
    const int panels = 4000;
    double sum = 0.0;
    for (int i = 0; i < panels; i++)
        for (int j = 0; j < 3; j++) {
            const double tau = t * (i + 0.5 + 0.5 * node[j]) / panels;
            sum += weight[j] * history_value(history, tau, 0) * sin(omega * (t - tau)) / omega;
        }
    return sum * 0.5 * t / panels;
}

/* Leapfrog with warped load and un-warped record has no time error but what the load holds beyond the
 * frequency 2/dt (here exp(-15.7) of its spectrum): at 8 steps a period of the mass, where plain leapfrog is
 * quite out of phase. The record is cut while
 * the mass still swings. */
static void unwarped_leapfrog_is_exact(void **state)
{
    (void)state;
    double error[2] = {0.0, 0.0};
    for (int unwarp = 0; unwarp < 2; unwarp++) {
        struct fixture f;
        set_up(&f, 1, 0.5, 0.0, "leapfrog");
        add_load(&f, (struct history){.kind = HISTORY_GAUSSIAN, .width = 2.2, .delay = 14.0});
        f.scene.end_time = 120.0;
        f.scene.stepping.time_step = 2.0 * PI / 8.0;
        f.scene.stepping.unwarp_given = true;
        f.scene.stepping.unwarp = unwarp == 1;
        struct stepper *stepper = NULL;
        struct state s;
        assert_int_equal(stepper_create(&f.chain.model, &stepper, &f.messages), SELAS_OK);
        assert_int_equal(state_create(stepper, &s, &f.messages), SELAS_OK);
        const size_t rows = stepper->steps + stepper->extra + 1;
        double *u = array_new(3 * rows, sizeof *u);
        double *v = array_new(3 * rows, sizeof *v);
        double *a = array_new(3 * rows, sizeof *a);
        for (size_t i = 0; i < rows; i++) {
            u[3 * i] = s.y[0];
            v[3 * i] = s.y[1];
            a[3 * i] = s.a[0];
            stepper->scheme->step(stepper, &s);
        }
        assert_int_equal(stepper->scheme->finish(stepper, rows, u, v, a, &f.messages), SELAS_OK);
        for (size_t i = 0; i <= stepper->steps; i++) {
            const double t = (double)i * stepper->dt;
            const double e = fabs(u[3 * i] - duhamel(&f.load.history, 1.0, t));
            error[unwarp] = fmax(error[unwarp], e);
            /* energy of the free vibration after the load: velocity agrees with displacement */
            if (unwarp == 1 && t > 28.0)
                assert_true(fabs(hypot(u[3 * i], v[3 * i]) - 2.2 * sqrt(2.0 * PI) * exp(-0.5 * 2.2 * 2.2)) <
                            1e-5);
        }
        array_free(u);
        array_free(v);
        array_free(a);
        state_free(&s);
        stepper_free(&stepper);
    }
    print_message("# one mass, 8 steps a period, amplitude .49: plain %.2e, un-warped %.2e\n", error[0],
                  error[1]);
    assert_true(error[0] > 0.3);
    assert_true(error[1] < 2e-6);
}

/* One mass at rest under a force that jumps to 1 at t = 0: u = (1 - cos(omega t)) / omega^2. The jump must
 * not cost an order: the schemes stay of second order at least (a history gives 1/2 at its jump; half a step
 * late would be first order). */
static double jump_error(const char *scheme, double dt, bool unwarp)
{
    struct fixture f;
    set_up(&f, 1, 0.5, 0.0, scheme);
    add_load(&f, (struct history){.kind = HISTORY_STEP});
    f.scene.stepping.time_step = dt;
    f.scene.stepping.unwarp_given = true;
    f.scene.stepping.unwarp = unwarp;
    struct stepper *stepper = NULL;
    struct state state;
    assert_int_equal(stepper_create(&f.chain.model, &stepper, &f.messages), SELAS_OK);
    assert_int_equal(state_create(stepper, &state, &f.messages), SELAS_OK);
    double error = 0.0;
    while (state.time < 10.0 - 1e-9) {
        stepper->scheme->step(stepper, &state);
        error = fmax(error, fabs(state.y[0] - (1.0 - cos(state.time))));
    }
    state_free(&state);
    stepper_free(&stepper);
    return error;
}

static void a_jump_at_the_start_costs_no_order(void **state)
{
    (void)state;
    for (size_t i = 0; scheme_table[i] != NULL; i++) {
        const struct scheme_class *scheme = scheme_table[i];
        if (!scheme->needs_acceleration) continue;
        const double coarse = jump_error(scheme->name, 0.1, false);
        const double fine = jump_error(scheme->name, 0.05, false);
        print_message("# %s under a jump: %.2e %.2e\n", scheme->name, coarse, fine);
        assert_true(log2(coarse / fine) > scheme->order - 0.15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(largest_frequency_of_a_chain),
        cmocka_unit_test(schemes_have_their_order),
        cmocka_unit_test(a_jump_at_the_start_costs_no_order),
        cmocka_unit_test(limits_are_sharp),
        cmocka_unit_test(abilities),
        cmocka_unit_test(names_of_schemes),
        cmocka_unit_test(a_step_beyond_the_limit_is_refused),
        cmocka_unit_test(the_damper_takes_what_the_energy_loses),
        cmocka_unit_test(unwarped_leapfrog_is_exact),
    };
    return cmocka_run_group_tests_name("stepping", tests, NULL, NULL);
}
