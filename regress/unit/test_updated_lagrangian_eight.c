/* Updated-Lagrangian sums of eight particles at a time: the rates are those of particles one by one, for
 * every dimension, arrangement, wall and switch, and no number of threads changes a bit. */
#include "from_deck.h"
#include "method/methods.h"

#include "base/memory.h"
#include "method/updated_lagrangian/updated_lagrangian.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

static const char head[] = "&method name = 'sph', variant = 'updated-lagrangian' %s /\n"
                           "&material name = 'm', density = 1738, young = 45e9, poisson = .35 /\n";

static const char *const body[] = {
    "&scene dimension = 1, end_time = 1 /\n&body material = 'm', shape = 'box', low = 0, high = 1, spacing = "
    ".01 /\n&boundary face = 'x+', kind = 'fixed' /\n&load face = 'x-', shape = 'face', direction = 1, "
    "amplitude = 1e9, history = 'step' /\n",
    "&scene dimension = 2, end_time = 1 /\n&body material = 'm', shape = 'box', low = 0, 0, high = 1, .7, "
    "spacing = .03 /\n&boundary face = 'x-', kind = 'fixed' /\n&boundary face = 'y-', kind = 'symmetry' /\n",
    "&scene dimension = 2, end_time = 1 /\n&body material = 'm', shape = 'box', low = 0, 0, high = 1, .7, "
    "spacing = .03, jitter = .25 /\n&boundary face = 'x-', kind = 'transmitting' /\n",
    "&scene dimension = 3, end_time = 1 /\n&body material = 'm', shape = 'box', low = 0, 0, 0, high = 1, .6, "
    ".5, spacing = .1 /\n&boundary face = 'z-', kind = 'fixed' /\n&boundary face = 'x+', kind = "
    "'transmitting' /\n",
    "&scene dimension = 2, end_time = 1 /\n&body material = 'm', shape = 'plate-with-hole', low = 0, 0, high "
    "= 1, 1, spacing = .05, hole_centre = 0, 0, hole_radius = .3, arrangement = 'conformal' /\n&boundary "
    "face = 'x-', 'y-', kind = 'symmetry' /\n",
    "&scene dimension = 2, end_time = 1 /\n&body material = 'm', shape = 'plate-with-hole', low = 0, 0, high "
    "= 1, 1, spacing = .05, hole_centre = 0, 0, hole_radius = .3, arrangement = 'radial' /\n&boundary face = "
    "'x-', 'y-', kind = 'symmetry' /\n",
};
enum { BODIES = sizeof body / sizeof body[0] };

static const char *const switches[] = {
    "", ", viscosity_alpha = 0, viscosity_beta = 0", ", artificial_stress = 0",
    ", viscosity_alpha = 0, viscosity_beta = 0, artificial_stress = 0, gradient_correction = .false."};
enum { SWITCHES = sizeof switches / sizeof switches[0] };

struct fixture {
    struct from_deck deck;
    struct model *model;
    double *y;
};

/* A body in smooth motion, stretched here and pressed there. */
static void make(struct fixture *f, int which, int of_switches)
{
    char text[2000], method[400];
    snprintf(method, sizeof method, head, switches[of_switches]);
    snprintf(text, sizeof text, "%s%s", body[which], method);
    f->deck = right_scene(text);
    if (model_create(f->deck.scene, &f->model, &f->deck.messages) != SELAS_OK)
        fail_msg("%s", f->deck.messages.text);
    const struct updated *updated = updated_of(f->model);
    const size_t d = (size_t)updated->dimension, n = f->model->points, unknowns = f->model->unknowns;
    f->y = array_new(f->model->state_size, sizeof *f->y);
    updated_initialise(f->model, f->y);
    for (size_t i = 0; i < n; i++) {
        const double *x = f->model->position + 3 * i;
        for (size_t a = 0; a < d; a++) {
            const double phase = 4 * x[0] - 3 * x[1] + 2 * x[2] + (double)a;
            f->y[d * i + a] = 1e-3 * sin(phase);
            f->y[unknowns + d * i + a] = 100 * sin(2 * phase);
        }
        f->y[2 * unknowns + i] *= 1 + .01 * sin(9 * x[0] + x[1]);
        for (size_t s = 0; s < (size_t)updated->stresses; s++)
            f->y[2 * unknowns + n + (size_t)updated->stresses * i + s] =
                1e8 * cos(5 * x[0] + 2 * x[1] + (double)s);
    }
}

static void drop(struct fixture *f)
{
    array_free(f->y);
    model_free(&f->model);
    from_deck_free(&f->deck);
}

static double *rates(struct fixture *f)
{
    const double load[1] = {1}, none[FACES] = {0};
    const struct drive drive = {.load = load, .motion = none, .displacement = none, .velocity = none};
    double *rate = array_new(f->model->state_size, sizeof *rate);
    f->model->spatial->rate(f->model, &drive, f->y, rate);
    return rate;
}

/* Largest difference in a part of the state against its largest number. */
static double part(const double *a, const double *b, size_t begin, size_t end)
{
    double largest = 1e-300, difference = 0;
    for (size_t k = begin; k < end; k++) {
        largest = fmax(largest, fabs(b[k]));
        difference = fmax(difference, fabs(a[k] - b[k]));
    }
    return difference / largest;
}

static void eight_are_one_by_one(void **state)
{
    (void)state;
    for (int which = 0; which < BODIES; which++)
        for (int k = 0; k < SWITCHES; k++) {
            struct fixture f;
            make(&f, which, k);
            struct updated *updated = updated_of(f.model);
            if (!updated->ordered) fail_msg("body %d is not summed eight at a time", which);
            double *fast = rates(&f);
            assert_int_equal(updated_one_by_one(updated, &f.deck.messages), SELAS_OK);
            double *slow = rates(&f);
            const size_t u = f.model->unknowns, n = f.model->points;
            const double v = part(fast, slow, u, 2 * u), density = part(fast, slow, 2 * u, 2 * u + n),
                         stress = part(fast, slow, 2 * u + n, f.model->state_size);
            if (!(fmax(v, fmax(density, stress)) < 1e-12))
                fail_msg("body %d, switches %d: %g %g %g", which, k, v, density, stress);
            array_free(fast);
            array_free(slow);
            drop(&f);
        }
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    for (int one_by_one = 0; one_by_one < 2; one_by_one++) {
        struct fixture f;
        f.deck = from_text("&scene dimension = 2, end_time = 1 /\n&method name = 'sph', variant = "
                           "'updated-lagrangian' /\n&material name = 'm', density = 1, young = 1, poisson = "
                           ".3 /\n&body material = 'm', shape = 'box', low = 0, 0, high = 1, 1, spacing = "
                           ".029, jitter = .1 /\n",
                           0, NULL);
        assert_int_equal(model_create(f.deck.scene, &f.model, &f.deck.messages), SELAS_OK);
        assert_true(f.model->points > UPDATED_PARALLEL);
        if (one_by_one != 0)
            assert_int_equal(updated_one_by_one(updated_of(f.model), &f.deck.messages), SELAS_OK);
        f.y = array_new(f.model->state_size, sizeof *f.y);
        updated_initialise(f.model, f.y);
        for (size_t k = 0; k < 2 * f.model->unknowns; k++)
            f.y[k] = 1e-3 * sin(.37 * (double)k);
        double *one = rates(&f);
        omp_set_num_threads(2);
        double *two = rates(&f);
        omp_set_num_threads(1);
        assert_memory_equal(one, two, f.model->state_size * sizeof *one);
        array_free(one);
        array_free(two);
        drop(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eight_are_one_by_one),
        cmocka_unit_test(threads_do_not_matter),
    };
    omp_set_num_threads(1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
