/* What damping adds to a step: boxes of N^3 control values that all move, undamped and damped, steps of each
 * in turn, CPU time of one thread. Usage: bench_damped [N [ROUNDS [PRECISION]]]. A step's figure is the least of all
 * rounds; the ratio is the median over rounds of damped over undamped, side by side. */
#include "marched.h"

#include <math.h>
#include <omp.h>

enum { MOST_ROUNDS = 1000, STEPS = 2 };

struct side {
    const char *what, *damping, *method;
    struct marched marched;
    double least, taken[MOST_ROUNDS];
};

static void open_side(struct side *side, int n, const char *precision)
{
    char text[1024];
    snprintf(
        text, sizeof text,
        "&scene dimension = 3, end_time = 1.0 /\n&method degree = 2, mass = 'vc3', precision = '%s' %s /\n"
        "&material name = 'rock', density = 1.0, p_speed = 1.7320508, s_speed = 1.0 %s /\n"
        "&body material = 'rock', shape = 'box', low = 3*0.0, high = 3*%d.0, spacing = 1.0 /\n",
        precision, side->method, side->damping, n - 2);
    open_marched(&side->marched, text);
    side->least = INFINITY;
}

static int ascending(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

static void print_side(const struct side *side, const struct side *first, int rounds)
{
    const struct model *model = side->marched.stepper.model;
    const double points = (double)model->unknowns / 3;
    double ratio[MOST_ROUNDS];
    for (int round = 0; round < rounds; round++)
        ratio[round] = side->taken[round] / first->taken[round];
    qsort(ratio, (size_t)rounds, sizeof *ratio, ascending);
    printf("| %s | %s | %.1f | %.2f | %.0f |\n", side->what,
           side->marched.stepper.one_pass ? "one pass" : "pass by pass", 1e9 * side->least / points,
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
                step_marched(&side[i].marched);
            side[i].taken[round] = (now() - start) / STEPS;
            side[i].least = fmin(side[i].least, side[i].taken[round]);
        }
    printf("| %d^3 | step | ns a point | over undamped | bytes a point |\n|---|---|---|---|---|\n", n);
    for (int i = 0; i < SIDES; i++)
        print_side(&side[i], &side[0], rounds);
    return 0;
}
