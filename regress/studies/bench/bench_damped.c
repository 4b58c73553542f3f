/* What damping adds to a step: boxes of N^3 control values that all move, undamped and damped, steps of each
 * in turn, CPU time of one thread. Usage: bench_damped [N [ROUNDS [PRECISION]]]. A step's figure is the least of all
 * rounds; the ratio is the median over rounds of damped over undamped, side by side. */
#include "base/memory.h"
#include "from_deck.h"
#include "method/methods.h"
#include "stepping/schemes.h"

#include <math.h>
#include <omp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { MOST_ROUNDS = 1000, STEPS = 2 };

struct side {
    const char *what, *damping, *method;
    struct from_deck from;
    struct stepper stepper;
    struct state state;
    double least, taken[MOST_ROUNDS];
};

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void stop(const char *text)
{
    fputs(text != NULL ? text : "no memory\n", stderr);
    exit(1);
}

static void open_side(struct side *side, int n, const char *precision)
{
    char text[1024];
    struct messages messages = {0};
    struct model *model = NULL;
    snprintf(
        text, sizeof text,
        "&scene dimension = 3, end_time = 1.0 /\n&method degree = 2, mass = 'vc3', precision = '%s' %s /\n"
        "&material name = 'rock', density = 1.0, p_speed = 1.7320508, s_speed = 1.0 %s /\n"
        "&body material = 'rock', shape = 'box', low = 3*0.0, high = 3*%d.0, spacing = 1.0 /\n",
        precision, side->method, side->damping, n - 2);
    side->from = from_text(text, 0, NULL);
    if (side->from.scene == NULL) stop(side->from.messages.text);
    if (model_create(side->from.scene, &model, &messages) != SELAS_OK) stop(messages.text);
    model = model_computed(model); /* the part below mirror planes */
    side->stepper = (struct stepper){.scheme = &scheme_leapfrog, .model = model, .dt = .1};
    side->state = (struct state){.y = array_new(model->state_size, sizeof(double)),
                                 .a = array_new(model->unknowns, sizeof(double))};
    if (side->state.y == NULL || side->state.a == NULL) stop(NULL);
    if (driver_create(&side->stepper.driver, side->from.scene, side->stepper.dt, &messages) != SELAS_OK)
        stop(messages.text);
    uint64_t seed = 7;
    for (size_t i = 0; i < model->unknowns; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        side->state.y[i] = (double)(seed >> 11) * 0x1p-52 - 1;
    }
    scheme_leapfrog.start(&side->stepper, &side->state);
    side->least = INFINITY;
}

static int ascending(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

static void print_side(const struct side *side, const struct side *first, int rounds)
{
    const struct model *model = side->stepper.model;
    const double points = (double)model->unknowns / 3;
    double ratio[MOST_ROUNDS];
    for (int round = 0; round < rounds; round++)
        ratio[round] = side->taken[round] / first->taken[round];
    qsort(ratio, (size_t)rounds, sizeof *ratio, ascending);
    printf("| %s | %s | %.1f | %.2f | %.0f |\n", side->what,
           side->stepper.one_pass ? "one pass" : "pass by pass", 1e9 * side->least / points,
           ratio[rounds / 2],
           ((double)model->bytes + (double)(model->state_size + model->unknowns) * sizeof(double)) / points);
}

int main(int count, char **word)
{
    static struct side side[] = {
        {.what = "undamped", .damping = "", .method = ""},
        {.what = "Q_p = Q_s, n = 1",
         .damping = ", q_p = 20.0, q_s = 20.0, q_frequency = 0.05",
         .method = ", mechanisms = 1"},
        {.what = "Q_p = Q_s, n = 3",
         .damping = ", q_p = 20.0, q_s = 20.0, q_frequency = 0.05",
         .method = ", mechanisms = 3"},
        {.what = "Q_p = 2 Q_s, n = 3",
         .damping = ", q_p = 40.0, q_s = 20.0, q_frequency = 0.05",
         .method = ", mechanisms = 3"},
    };
    enum { SIDES = sizeof side / sizeof side[0] };
    const int n = count > 1 ? atoi(word[1]) : 49;
    const int rounds = count > 2 && atoi(word[2]) < MOST_ROUNDS ? atoi(word[2]) : 40;
    omp_set_num_threads(1);
    for (int i = 0; i < SIDES; i++)
        open_side(&side[i], n, count > 3 ? word[3] : "double");
    for (int round = 0; round < rounds; round++)
        for (int i = 0; i < SIDES; i++) {
            const double start = now();
            for (int step = 0; step < STEPS; step++)
                scheme_leapfrog.step(&side[i].stepper, &side[i].state);
            side[i].taken[round] = (now() - start) / STEPS;
            side[i].least = fmin(side[i].least, side[i].taken[round]);
        }
    printf("| %d^3 | step | ns a point | over undamped | bytes a point |\n|---|---|---|---|---|\n", n);
    for (int i = 0; i < SIDES; i++)
        print_side(&side[i], &side[0], rounds);
    return 0;
}
