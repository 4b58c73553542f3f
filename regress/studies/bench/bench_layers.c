/* What absorbing layers take of a step: boxes with layers of N points behind five faces, all of which moves, even ground
 * and layered ground in turn, CPU time of one thread. Usage: bench_layers [N [ROUNDS [NX NY NZ]]]. The figures are the
 * least of all rounds: a step by control value, what the layers take by control value of their slabs. */
#include "marched.h"
#include "method/consistent/absorbing/pml_fast.h"

#include <math.h>
#include <omp.h>

struct side {
    const char *what, *ground;
    struct marched marched;
    double step, memory, pull;
};

static void open_side(struct side *side, int points, const int size[3])
{
    char text[1024];
    snprintf(text, sizeof text,
             "&scene dimension = 3, end_time = 1.0 /\n&method degree = 2, mass = 'vc3', quiet = 0, symmetry "
             "= F /\n"
             "&material name = 'rock', density = 1.0, p_speed = 1.7320508, s_speed = 1.0 /\n%s"
             "&body material = 'rock', shape = 'box', low = 3*0.0, high = %d.0, %d.0, %d.0, spacing = 1.0 /\n"
             "&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting', layer = 'pml', "
             "layer_points = %d,"
             " always = T /\n",
             side->ground, size[0], size[1], size[2], points);
    open_marched(&side->marched, text);
    side->step = side->memory = side->pull = INFINITY;
}

/* Times a step, then the layers' part of one more (on which nothing else goes on). */
static void time_side(struct side *side)
{
    struct model *model = side->marched.stepper.model;
    const struct consistent *c = consistent_of(model);
    double *u = side->marched.state.y, *v = u + model->unknowns, start = now();
    step_marched(&side->marched);
    side->step = fmin(side->step, now() - start);
    start = now();
    pml_fast_remember_double(c, .1, -.05, 0, u, v, v + model->unknowns);
    side->memory = fmin(side->memory, now() - start);
    start = now();
    pml_fast_accelerate_double(c, 1e-9, v + model->unknowns, side->marched.state.a);
    side->pull = fmin(side->pull, now() - start);
}

static void print_side(const struct side *side)
{
    const struct consistent *c = consistent_of(side->marched.stepper.model);
    double points = 0;
    for (size_t s = 0; s < c->pml->slabs; s++) {
        const struct block *inside = &c->pml->slab[s].inside;
        points += (double)(inside->n[0] * inside->n[1] * inside->n[2]);
    }
    printf("| %s | %zu | %.0f | %.1f | %.1f | %.1f | %.1f |\n", side->what, c->volume, points,
           1e9 * side->step / (double)c->volume, 1e9 * side->memory / points, 1e9 * side->pull / points,
           1e9 * (side->memory + side->pull) / points);
}

int main(int count, char **word)
{
    static struct side side[] = {
        {.what = "even", .ground = ""},
        {.what = "layered",
         .ground = "&material name = 'soil', density = .9, p_speed = 1.2, s_speed = .6 /\n"
                   "&layer material = 'soil', top = 0.0 /\n&layer material = 'rock', top = 8.0 /\n"},
    };
    enum { SIDES = sizeof side / sizeof side[0] };
    const int points = count > 1 ? atoi(word[1]) : 15, rounds = count > 2 ? atoi(word[2]) : 20;
    int size[3] = {56, 72, 20};
    for (int axis = 0; axis < 3 && count > 5; axis++)
        size[axis] = atoi(word[3 + axis]) - 1;
    omp_set_num_threads(1);
    for (int i = 0; i < SIDES; i++)
        open_side(&side[i], points, size);
    for (int round = 0; round < rounds; round++)
        for (int i = 0; i < SIDES; i++)
            time_side(&side[i]);
    printf("| ground | control values | in slabs | ns a step | ns of memory | of forces | both |\n"
           "|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < SIDES; i++)
        print_side(&side[i]);
    return 0;
}
