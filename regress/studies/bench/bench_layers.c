/* What absorbing layers take of a step: boxes with layers of N points behind five faces and, as many control values
 * along each axis, without; even, layered and general ground in both precisions and the exact mass, in turn, all of
 * which moves; CPU time of one thread. Usage: bench_layers [N [ROUNDS [NX NY NZ]]]. The figures are the least of all
 * rounds: ns a control value of a step; what one in layers takes, and what a layer adds for each value that lies in it
 * (edges lie in two, corners in three), in ns and in times one without; the passes of layers alone (pml_fast.h). */
#include "marched.h"
#include "method/consistent/absorbing/pml_fast.h"

#include <math.h>
#include <omp.h>

enum { BOXES = 2 }; /* with layers, without */

struct side {
    const char *what, *ground, *method;
    struct marched marched[BOXES];
    double step[BOXES], memory, pull;
};

static const struct consistent *of_box(const struct side *side, int box)
{
    return consistent_of(side->marched[box].stepper.model);
}

static void open_side(struct side *side, int points, const int cells[3])
{
    char text[2048], layers[256];
    snprintf(layers, sizeof layers,
             "&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting', layer = 'pml', "
             "layer_points = %d, always = T /\n",
             points);
    for (int box = 0; box < BOXES; box++) {
        const int more = box == 0 ? 0 : points;
        snprintf(
            text, sizeof text,
            "&scene dimension = 3, end_time = 1.0 /\n"
            "&method quiet = 0, symmetry = F, %s /\n"
            "&material name = 'rock', density = 1.0, p_speed = 1.7320508, s_speed = 1.0 /\n%s"
            "&body material = 'rock', shape = 'box', low = 3*0.0, high = %d.0, %d.0, %d.0, spacing = 1.0 "
            "/\n%s",
            side->method, side->ground, cells[0] + 2 * more, cells[1] + 2 * more, cells[2] + more,
            box == 0 ? layers : "");
        open_marched(&side->marched[box], text);
        side->step[box] = INFINITY;
    }
    if (of_box(side, 0)->volume != of_box(side, 1)->volume) stop("boxes differ\n");
    side->memory = side->pull = INFINITY;
}

/* Times a step of each box, then the layers' part of one more (on which nothing else goes on). */
static void time_side(struct side *side)
{
    for (int box = 0; box < BOXES; box++) {
        const double start = now();
        step_marched(&side->marched[box]);
        side->step[box] = fmin(side->step[box], now() - start);
    }
    const struct consistent *c = of_box(side, 0);
    if (c->pml == NULL || c->pml->fast == NULL || c->options.single) return;
    double *u = side->marched[0].state.y, *v = u + c->model.unknowns, start = now();
    pml_fast_remember_double(c, .1, -.05, 0, u, v, v + c->model.unknowns);
    side->memory = fmin(side->memory, now() - start);
    start = now();
    pml_fast_accelerate_double(c, 1e-9, v + c->model.unknowns, side->marched[0].state.a);
    side->pull = fmin(side->pull, now() - start);
}

/* Control values in each layer of so many points, added up. */
static double in_slabs(const struct consistent *c, int points)
{
    double slabs = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double across = (double)c->n[c->slot[axis]];
        slabs += (axis == 2 ? 1 : 2) * points * (double)c->volume / across;
    }
    return slabs;
}

static void print_side(const struct side *side, int points)
{
    const struct consistent *c = of_box(side, 0);
    const size_t *n = c->n;
    const double all = (double)c->volume, slabs = in_slabs(c, points), layers = (double)(2 * points);
    const double body = ((double)n[0] - layers) * ((double)n[1] - layers) * ((double)n[2] - points);
    const double step = 1e9 * side->step[0] / all, plain = 1e9 * side->step[1] / all;
    const double value = plain + (step - plain) * all / (all - body), slab = (step - plain) * all / slabs;
    printf("| %s | %.0f | %.0f | %.0f | %.1f | %.1f | %.1f | %.2f | %.1f | %.2f |", side->what, all,
           all - body, slabs, step, plain, value, value / plain, slab, slab / plain);
    if (isinf(side->memory))
        printf(" | |\n");
    else
        printf(" %.1f | %.1f |\n", 1e9 * side->memory / slabs, 1e9 * side->pull / slabs);
}

int main(int count, char **word)
{
#define SOIL "&material name = 'soil', density = .9, p_speed = 1.2, s_speed = .6 /\n"
#define SWEEPS "degree = 2, mass = 'vc3', "
#define LAYERED SOIL "&layer material = 'soil', top = 0.0 /\n&layer material = 'rock', top = 8.0 /\n"
#define BLOCK SOIL "&block material = 'soil', centre = 3*9.0, size = 3*9.0 /\n"
    static struct side side[] = {
        {.what = "even | double", .ground = "", .method = "precision = 'double'"},
        {.what = "even | single", .ground = "", .method = "precision = 'single'"},
        {.what = "layered | double", .ground = LAYERED, .method = SWEEPS "precision = 'double'"},
        {.what = "layered | single", .ground = LAYERED, .method = SWEEPS "precision = 'single'"},
        {.what = "general | double", .ground = BLOCK, .method = "precision = 'double'"},
        {.what = "general | single", .ground = BLOCK, .method = "precision = 'single'"},
        {.what = "exact mass, degree 2 | double", .ground = "", .method = "mass = 'exact'"},
        {.what = "exact mass, degree 4 | double", .ground = "", .method = "degree = 4, mass = 'exact'"},
    };
    enum { SIDES = sizeof side / sizeof side[0] };
    const int points = count > 1 ? atoi(word[1]) : 15, rounds = count > 2 ? atoi(word[2]) : 20;
    int cells[3] = {56, 72, 20};
    for (int axis = 0; axis < 3 && count > 5; axis++)
        cells[axis] = atoi(word[3 + axis]) - 1;
    omp_set_num_threads(1);
    for (int i = 0; i < SIDES; i++)
        open_side(&side[i], points, cells);
    for (int round = 0; round < rounds; round++)
        for (int i = 0; i < SIDES; i++)
            time_side(&side[i]);
    printf("| ground | precision | control values | in layers | by layers | with layers, ns | without | in "
           "layers "
           "| times | a layer adds | times | memory | forces |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < SIDES; i++)
        print_side(&side[i], points);
    return 0;
}
