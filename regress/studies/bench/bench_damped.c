/* What damping adds to a step: boxes of N^3 control values that all move, undamped and damped, steps of each
 * in turn, CPU time of one thread. Usage: bench_damped [N [ROUNDS [PRECISION [GROUND]]]], GROUND even, level (even by
 * the general operator), general (three rocks, a tilted interface and a block), hill or layers (the same below a hill, with
 * absorbing layers at the sides and below). A step's figure is the least of all rounds; the ratio is the median over
 * rounds of damped over undamped, side by side. */
#include "marched.h"

#include <math.h>
#include <omp.h>
#include <string.h>

enum { MOST_ROUNDS = 1000, STEPS = 2 };

struct side {
    const char *what, *damping[3], *method; /* damping of each rock */
    bool general;                           /* a side for that ground alone */
    struct marched marched;
    double least, taken[MOST_ROUNDS];
};

/* Three rocks in a box, whose side is that of the lattice. */
static int put_ground(char *text, size_t size, const struct side *side, int n, const char *ground)
{
    const double width = n - 2;
    int at = snprintf(text, size,
                      "&material name = 'clay', density = 0.9, p_speed = 1.5, s_speed = 0.8 %s /\n"
                      "&material name = 'sand', density = 0.8, p_speed = 1.3, s_speed = 0.7 %s /\n"
                      "&layer material = 'clay', top = 0.0 /\n&layer material = 'rock', top = %g, dip = "
                      "15.0, strike = 30.0 /\n"
                      "&block material = 'sand', shape = 'ellipsoid', centre = 2*%g, %g, size = 2*%g, %g /\n",
                      side->damping[1], side->damping[2], .4 * width, .5 * width, .3 * width, .5 * width,
                      .3 * width);
    if (strcmp(ground, "general") == 0) return at;
    at += snprintf(text + at, size - (size_t)at,
                   "&topography shape = 'gaussian', height = %g, centre = 2*%g, width = %g /\n", .1 * width,
                   .5 * width, .2 * width);
    if (strcmp(ground, "layers") == 0)
        at += snprintf(text + at, size - (size_t)at,
                       "&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting', layer = 'pml', "
                       "layer_points = 8, always = .true. /\n");
    return at;
}

static void open_side(struct side *side, int n, const char *precision, const char *ground)
{
    char text[2048];
    const bool general = strcmp(ground, "even") != 0;
    const int at = snprintf(
        text, sizeof text,
        "&scene dimension = 3, end_time = 1.0 /\n&method degree = 2, mass = 'vc3', precision = '%s' %s %s /\n"
        "&material name = 'rock', density = 1.0, p_speed = 1.7320508, s_speed = 1.0 %s /\n"
        "&body material = 'rock', shape = 'box', low = 3*0.0, high = 3*%d.0, spacing = 1.0 /\n",
        precision, general ? ", operator = 'general'" : "", side->method, side->damping[0], n - 2);
    if (general && strcmp(ground, "level") != 0)
        put_ground(text + at, sizeof text - (size_t)at, side, n, ground);
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
#define ONE ", q_p = 20.0, q_s = 20.0, q_frequency = 0.05"
#define TWO ", q_p = 40.0, q_s = 20.0, q_frequency = 0.05"
#define SOFT ", q_p = 16.0, q_s = 10.0, q_frequency = 0.05"
#define HARD ", q_p = 90.0, q_s = 60.0, q_frequency = 0.05"
    static struct side side[] = {
        {.what = "undamped", .damping = {"", "", ""}, .method = ""},
        {.what = "Q_p = Q_s, n = 1", .damping = {ONE, ONE, ONE}, .method = ", mechanisms = 1"},
        {.what = "Q_p = Q_s, n = 3", .damping = {ONE, ONE, ONE}, .method = ", mechanisms = 3"},
        {.what = "Q_p = 2 Q_s, n = 3", .damping = {TWO, TWO, TWO}, .method = ", mechanisms = 3"},
        {.what = "three Q, n = 3",
         .damping = {HARD, TWO, SOFT},
         .method = ", mechanisms = 3",
         .general = true},
        {.what = "Q_p = Q_s, n = 3",
         .damping = {ONE, ONE, ONE},
         .method = ", mechanisms = 3, fused = .false.",
         .general = true},
        {.what = "Q_p = 2 Q_s, n = 3",
         .damping = {TWO, TWO, TWO},
         .method = ", mechanisms = 3, fused = .false.",
         .general = true},
        {.what = "three Q, n = 3",
         .damping = {HARD, TWO, SOFT},
         .method = ", mechanisms = 3, fused = .false.",
         .general = true},
    };
    const char *ground = count > 4 ? word[4] : "even";
    int sides = 0;
    for (size_t i = 0; i < sizeof side / sizeof side[0]; i++)
        sides += !side[i].general || strcmp(ground, "even") != 0;
    const int n = count > 1 ? atoi(word[1]) : 49;
    const int rounds = count > 2 && atoi(word[2]) < MOST_ROUNDS ? atoi(word[2]) : 40;
    omp_set_num_threads(1);
    for (int i = 0; i < sides; i++)
        open_side(&side[i], n, count > 3 ? word[3] : "double", ground);
    for (int round = 0; round < rounds; round++)
        for (int i = 0; i < sides; i++) {
            const double start = now();
            for (int step = 0; step < STEPS; step++)
                step_marched(&side[i].marched);
            side[i].taken[round] = (now() - start) / STEPS;
            side[i].least = fmin(side[i].least, side[i].taken[round]);
        }
    printf("| %d^3 | step | ns a point | over undamped | bytes a point |\n|---|---|---|---|---|\n", n);
    for (int i = 0; i < sides; i++)
        print_side(&side[i], &side[0], rounds);
    return 0;
}
