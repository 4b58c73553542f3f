/* Steps of damped general ground in one pass (method/consistent/general/sweep.h), the stresses of all parts together,
 * against the parts' operators one by one: rocks, hills, faces and layers by chance, one to four parts; threads, single
 * precision, what is kept; that every part and every mechanism counts. */
#include "damped_run.h"

#include "method/consistent/absorbing/pml.h"
#include "method/consistent/general/sweep.h"

/* 1 + number % 3 mechanisms; rocks of one Q with q_p = q_s, of one Q, or of three; a hill, layers. */
static void drawn(size_t size, char *deck, int number, bool hilly, bool layers, const char *words)
{
    static const char *const kind[] = {"free", "fixed", "roller", "symmetry"};
    static const char *const face[] = {"x-", "x+", "y-", "y+", "z-", "z+"};
    static const int quality[3][3][2] = {
        {{20, 20}, {20, 20}, {20, 20}}, {{30, 16}, {30, 16}, {30, 16}}, {{30, 16}, {8, 6}, {160, 90}}};
    const int(*q)[2] = quality[number / 3 % 3];
    const size_t sure = chance(3);
    int at = snprintf(deck, size,
                      "&scene dimension = 3, end_time = 3.0 /\n"
                      "&method operator = 'general', mechanisms = %d %s /\n"
                      "&body material = 'm', shape = 'box', low = 3*0.0, high = %.1f, %.1f, %.1f, "
                      "spacing = 0.3 /\n"
                      "&material name = 'm', density = 0.7, lambda = 1.0, mu = 0.5, q_p = %d, q_s = %d, "
                      "q_frequency = 0.5 /\n"
                      "&load face = 'z-', shape = 'square', centre = 1.4, 1.4, depth = 0.0, size = 1.3, 0.9, "
                      "direction = .3, .5, 1, history = 'step' /\n",
                      1 + number % 3, words, .3 * (double)(17 + chance(6)), .3 * (double)(17 + chance(6)),
                      .3 * (double)(17 + chance(6)), q[0][0], q[0][1]);
    if (number % 4 != 3)
        at += snprintf(deck + at, size - (size_t)at,
                       "&material name = 'n', density = 1.2, lambda = 3.0, mu = 1.5, q_p = %d, q_s = %d, "
                       "q_frequency = 0.5 /\n"
                       "&material name = 'o', density = 1.0, lambda = 1.0, mu = 2.0, q_p = %d, q_s = %d, "
                       "q_frequency = 0.5 /\n"
                       "&layer material = 'm', top = 0.0 /\n"
                       "&layer material = 'n', top = 2.0, dip = 15.0, strike = 40.0 /\n"
                       "&block material = 'o', shape = 'ellipsoid', centre = 2.0, 2.2, 1.6, size = 2.4, 1.9, "
                       "1.5 /\n",
                       q[1][0], q[1][1], q[2][0], q[2][1]);
    if (hilly)
        at += snprintf(deck + at, size - (size_t)at,
                       "&topography shape = 'gaussian', height = 0.4, centre = 1.6, 1.7, width = 0.8 /\n");
    for (size_t i = 0; i < 6; i++) {
        const bool outside = layers && i != 4 && (i == 2 * sure + 1 || chance(2) == 0);
        at += snprintf(deck + at, size - (size_t)at, "&boundary face = '%s', kind = '%s'%s /\n", face[i],
                       outside  ? "transmitting"
                       : i == 4 ? "free"
                                : kind[chance(4)],
                       outside ? ", layer = 'pml', layer_points = 5, always = .true." : "");
    }
}

/* The worst of u, v, a, memory of mechanisms, and of layers: of slopes part by part, of forces in all parts. */
static double difference(const struct damped_run *one, const struct damped_run *other)
{
    const struct damped *d = (const struct damped *)one->model;
    const struct consistent *c = consistent_of(d->part[0].model);
    const size_t n = one->model->unknowns, behind = d->damping->mechanisms * n;
    const size_t all = one->model->state_size - 2 * n, own = c->pml != NULL ? c->pml->extra : 0;
    const size_t slopes = own - (c->pml != NULL ? 2 * c->general->moments : 0);
    const double *y = one->state.y, *z = other->state.y;
    double worst = fmax(apart(n, y, z), apart(n, y + n, z + n));
    worst = fmax(worst, apart(n, one->state.a, other->state.a));
    worst = fmax(worst, apart(behind, y + 2 * n, z + 2 * n));
    assert_int_equal(all, behind + d->parts * own);
    if (own == 0) return worst;
    double *sums = array_new(2 * (own - slopes), sizeof *sums);
    for (size_t p = 0; p < d->parts; p++) {
        const size_t from = 2 * n + d->part[p].extra;
        worst = fmax(worst, apart(slopes, y + from, z + from));
        for (size_t i = 0; i < own - slopes; i++) {
            sums[i] += y[from + slopes + i];
            sums[own - slopes + i] += z[from + slopes + i];
        }
    }
    worst = fmax(worst, apart(own - slopes, sums, sums + own - slopes));
    array_free(sums);
    return worst;
}

static void march(struct damped_run *run, int steps)
{
    for (int step = 0; step < steps; step++)
        run->stepper->scheme->step(run->stepper, &run->state);
}

static void operators_in_one(void **unused)
{
    (void)unused;
    double worst = 0;
    size_t most = 0;
    const int scenes = few_of(9, 3);
    for (int i = 9 - scenes; i < 9; i++) {
        char deck[4000];
        drawn(sizeof deck, deck, i, i % 2 == 1, i / 2 % 2 == 0, ", quiet = 0.0");
        struct damped_run one = run_of(deck, true), other = run_of(deck, false);
        if (((struct damped *)one.model)->parts > most) most = ((struct damped *)one.model)->parts;
        for (int turn = 0; turn < 4; turn++) {
            march(&one, 9);
            march(&other, 9);
            state_settle(one.stepper, &one.state, true);
            worst = fmax(worst, difference(&one, &other));
        }
        run_free(&one);
        run_free(&other);
    }
    print_message("# %d scenes, up to %zu parts, one pass against part by part: %.1e\n", scenes, most, worst);
    assert_true(most >= 3);
    assert_true(worst < 1e-12);
}

/* Numbers of a model that are left out: up to two arrays. */
struct left_out {
    size_t n;
    double *of[2], *kept;
};

static struct left_out leave_out(const struct damped *d, size_t number)
{
    const struct general *general = consistent_of(d->part[0].model)->general;
    const struct sweep *sweep = general->sweep;
    const size_t p = number / 2;
    struct left_out out = {.n = 1};
    if (p >= d->parts) {
        out.of[0] = &sweep->relaxing->of.rate[number - 2 * d->parts];
    } else if (number % 2 == 0) {
        out.n = general->family[1].n[1] * general->family[1].n[2] * sweep->width;
        out.of[0] = sweep->moduli[p].lambda[1];
        out.of[1] = sweep->moduli[p].mu[1];
    } else {
        const struct family *family = &consistent_of(d->part[p].model)->general->family[1];
        out.n = family->run[family->runs - 1].at;
        out.of[0] = family->stiffness;
    }
    out.kept = array_new(2 * out.n, sizeof *out.kept);
    for (size_t i = 0; i < 2 && out.of[i] != NULL; i++) {
        memcpy(out.kept + i * out.n, out.of[i], out.n * sizeof(double));
        memset(out.of[i], 0, out.n * sizeof(double));
    }
    return out;
}

static void bring_back(struct left_out *out)
{
    for (size_t i = 0; i < 2 && out->of[i] != NULL; i++)
        memcpy(out->of[i], out->kept + i * out->n, out->n * sizeof(double));
    array_free(out->kept);
}

/* From the start, with the factors of the rates as they are. */
static void march_anew(struct damped_run *run)
{
    struct messages messages = {0};
    const struct damped *d = (const struct damped *)run->model;
    consistent_of(d->part[0].model)->general->sweep->relaxing->factors.dt = 0;
    state_free(&run->state);
    assert_int_equal(state_create(run->stepper, &run->state, &messages), SELAS_OK);
    march(run, 24);
    state_settle(run->stepper, &run->state, true);
}

/* What is left out of a part, or of a mechanism, shows; and it alone does. */
static void each_counts(void **unused)
{
    (void)unused;
    char deck[4000];
    drawn(sizeof deck, deck, 8, true, true, ", quiet = 0.0");
    struct damped_run whole = run_of(deck, true), less = run_of(deck, true);
    const struct damped *d = (const struct damped *)less.model;
    march_anew(&whole);
    for (size_t number = 0; number < 2 * d->parts + d->damping->mechanisms; number++) {
        struct left_out out = leave_out(d, number);
        march_anew(&less);
        const double change = difference(&less, &whole);
        print_message("# without %zu: %.1e\n", number, change);
        assert_true(change > 1e-6);
        bring_back(&out);
    }
    march_anew(&less);
    assert_true(difference(&less, &whole) == 0);
    run_free(&less);
    run_free(&whole);
}

static void nothing_more(struct damped_run *run)
{
    assert_non_null(run->model->one_pass);
}

/* Some of the body is at rest. */
static void the_same_bits(void **unused)
{
    (void)unused;
    for (int kind = 0; kind < 4; kind++) {
        char deck[4000];
        drawn(sizeof deck, deck, 8, true, kind / 2 > 0, kind % 2 == 1 ? ", precision = 'single'" : "");
        assert_same_states(deck, nothing_more);
    }
}

static void single_precision(void **unused)
{
    (void)unused;
    double worst = 0;
    for (int i = 0; i < few_of(3, 2); i++) {
        char deck[2][4000];
        const uint64_t drawn_from = seed;
        for (int single = 0; single < 2; single++) {
            seed = drawn_from;
            drawn(sizeof deck[0], deck[single], i + 6, i % 2 == 1, i % 3 > 0,
                  single ? ", precision = 'single'" : "");
        }
        struct damped_run exact = run_of(deck[0], true), single = run_of(deck[1], true);
        assert_true(single.model->single);
        march(&exact, 60);
        march(&single, 60);
        state_settle(exact.stepper, &exact.state, true);
        state_settle(single.stepper, &single.state, true);
        const double off = difference(&single, &exact);
        assert_true(off > 1e-8);
        worst = fmax(worst, off);
        run_free(&exact);
        run_free(&single);
    }
    print_message("# single precision against double, 60 steps: %.1e\n", worst);
    assert_true(worst < 3e-5);
}

/* A state and what is kept beside it go on with the same bits. */
static void goes_on(void **unused)
{
    (void)unused;
    for (int kind = 0; kind < 2; kind++) {
        char deck[4000];
        drawn(sizeof deck, deck, 5, true, true, kind == 1 ? ", precision = 'single'" : "");
        struct damped_run one = run_of(deck, true), other = run_of(deck, true);
        size_t bytes, room;
        march(&one, 17);
        state_settle(one.stepper, &one.state, true);
        const void *from = one.model->one_pass->kept(one.model, &bytes);
        void *to = other.model->one_pass->kept(other.model, &room);
        assert_int_equal(bytes, room);
        memcpy(to, from, bytes);
        memcpy(other.state.y, one.state.y, one.model->state_size * sizeof(double));
        other.state.step = one.state.step;
        march(&one, 17);
        march(&other, 17);
        state_settle(one.stepper, &one.state, true);
        state_settle(other.stepper, &other.state, true);
        assert_memory_equal(one.state.y, other.state.y, one.model->state_size * sizeof(double));
        run_free(&one);
        run_free(&other);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(operators_in_one), cmocka_unit_test(each_counts), cmocka_unit_test(the_same_bits),
        cmocka_unit_test(single_precision), cmocka_unit_test(goes_on),
    };
    omp_set_num_threads(1);
    seed_begin(9);
    return cmocka_run_group_tests_name("steps of damped general ground", tests, NULL, NULL);
}
