/* Steps of damped ground in one pass with two displacements (method/consistent/fused/fused.h, F1a and F1b) against
 * the parts' operators one by one: faces, masses and layers by chance, threads, planes at rest, single
 * precision. */
#include "damped_run.h"

static void drawn(size_t size, char *deck, int number, const char *words)
{
    static const char *const kind[] = {"free", "free", "fixed", "roller", "symmetry", "transmitting"};
    static const char *const face[] = {"x-", "x+", "y-", "y+", "z-", "z+"};
    int at = snprintf(deck, size,
                      "&scene dimension = 3, end_time = 3.0 /\n"
                      "&method degree = 2, mass = 'vc%d', mechanisms = 3, depth_mass = '%s' %s /\n"
                      "&material name = 'm', density = 0.7, lambda = 1.0, mu = 0.5, q_p = %d, q_s = 12, "
                      "q_frequency = 0.5 /\n"
                      "&body material = 'm', shape = 'box', low = 3*0.0, high = %.1f, %.1f, %.1f, "
                      "spacing = 0.3 /\n"
                      "&load face = 'z-', shape = 'square', centre = 1.4, 1.4, 0.0, size = 1.3, 0.9, "
                      "direction = .3, .5, 1, history = 'step' /\n",
                      1 + number % 3, number % 2 == 0 ? "exact" : "same", words, 20,
                      .3 * (double)(17 + chance(10)), .3 * (double)(17 + chance(10)),
                      .3 * (double)(25 + chance(20)));
    for (int i = 0; i < 6; i++) {
        const char *drawn = i == 4 ? "free" : kind[chance(number % 4 == 3 ? 6 : 5)];
        at += snprintf(deck + at, size - (size_t)at, "&boundary face = '%s', kind = '%s'%s /\n", face[i],
                       drawn, drawn[0] == 't' ? ", layer = 'pml', layer_points = 5, always = .true." : "");
    }
}

/* The same, drawn until its steps are one pass. */
static void draw(size_t size, char *deck, int number, const char *words)
{
    for (bool served = false; !served;) {
        drawn(size, deck, number, words);
        struct from_deck from = right_scene(deck);
        struct model *model = NULL;
        struct messages messages = {0};
        served = model_create(from.scene, &model, &messages) == SELAS_OK && model->one_pass != NULL;
        messages_free(&messages);
        if (model != NULL) model_free(&model);
        from_deck_free(&from);
    }
}

static void operators_in_one(void **unused)
{
    (void)unused;
    double worst = 0;
    const int scenes = few_of(12, 6);
    for (int i = 0; i < scenes; i++) {
        char deck[2000];
        draw(sizeof deck, deck, i, i % 5 == 4 ? ", quiet = 0.0" : "");
        struct damped_run one = run_of(deck, true), other = run_of(deck, false);
        assert_int_equal(((struct damped *)one.model)->parts, 2);
        for (int step = 0; step < 40; step++) {
            one.stepper->scheme->step(one.stepper, &one.state);
            other.stepper->scheme->step(other.stepper, &other.state);
            if (step % 8 != 5) continue;
            state_settle(one.stepper, &one.state, true);
            const size_t n = one.model->unknowns;
            worst = fmax(worst, apart(n, one.state.y, other.state.y));
            worst = fmax(worst, apart(n, one.state.y + n, other.state.y + n));
            worst = fmax(worst, apart(n, one.state.a, other.state.a));
            worst = fmax(worst, apart(3 * n, one.state.y + 2 * n, other.state.y + 2 * n));
        }
        run_free(&one);
        run_free(&other);
    }
    print_message("# one pass against part by part: %.1e\n", worst);
    assert_true(worst < 1e-12);
}

static void some_is_skipped(struct damped_run *run)
{
    const struct fused *fused = consistent_of(((struct damped *)run->model)->part[0].model)->fused;
    assert_true((run->model->single ? fused->single : fused)->skipped > 0);
}

/* Some of the body is at rest. */
static void the_same_bits(void **unused)
{
    (void)unused;
    for (int single = 0; single < 2; single++) {
        char deck[2000];
        draw(sizeof deck, deck, 2, single ? ", precision = 'single'" : "");
        assert_same_states(deck, some_is_skipped);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(operators_in_one), cmocka_unit_test(the_same_bits)};
    omp_set_num_threads(1);
    seed_begin(6);
    return cmocka_run_group_tests_name("damped steps in one pass", tests, NULL, NULL);
}
