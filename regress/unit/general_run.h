/* What the tests of the general operator share: random ground, energy, growth. */
#ifndef GENERAL_RUN_H
#define GENERAL_RUN_H

#include "consistent_run.h"

#include "method/consistent/general/general.h"
#include "stepping/stepping.h"

#include <math.h>
#include <string.h>

static inline struct consistent_options general(void)
{
    return (struct consistent_options){.degree = 2, .sweeps = 3, .depth_exact = true, .general = true};
}

static uint64_t bits = 11;
static inline double chance(double low, double high)
{
    bits = bits * 6364136223846793005u + 1442695040888963407u;
    return low * pow(high / low, (double)(bits >> 11) * 0x1p-53);
}

/* Multiplies the moduli at every point and the mass of every control value by numbers from low to high. */
static inline void make_random_within(struct consistent *c, double low, double high)
{
    double *mass = calloc(c->volume, sizeof *mass);
    for (int f = 0; f < 3; f++) {
        struct family *family = &c->general->family[f];
        for (size_t i = 0; i < family->n[0] * family->n[1] * family->n[2]; i++) {
            family->lambda[i] *= chance(low, high);
            family->mu[i] *= chance(low, high);
        }
    }
    for (size_t i = 0; i < c->volume; i++)
        mass[i] = chance(low, high) * pow(c->model.scene->body.spacing, c->dimension);
    assert_true(general_scale(c, mass));
    free(mass);
}

static inline void make_random(struct consistent *c)
{
    make_random_within(c, .5, 2);
}

/* Grows beyond the limit that the program finds, not below it. */
static inline bool grows(struct run *run, double dt)
{
    noise(run->n, run->y);
    memset(run->y + run->n, 0, run->n * sizeof *run->y);
    for (int step = 0; step < 3000; step++)
        leap(run, &(struct drive){0}, dt);
    double most = 0;
    for (size_t i = 0; i < run->n; i++)
        most += fabs(run->y[i]);
    return !(most < 1e4 * (double)run->n);
}

static inline double leapfrog_energy(struct run *run, double dt)
{
    struct energy now;
    run->model->core->energy(run->model, run->y, &now);
    run->model->spatial->accelerate(run->model, &(struct drive){0}, 0, run->y, NULL, run->a);
    double *product = calloc(run->n, sizeof *product);
    run->model->spatial->weigh(run->model, run->a, product);
    const double correction = dt * dt / 8 * dot(run->n, run->a, product);
    free(product);
    return now.kinetic + now.strain - correction;
}

/* v is brought half a step on for the energy, which leapfrog keeps but for (dt^2 / 8) a.Ma. */
static inline double energy_at(struct run *run, double dt)
{
    double *v = run->y + run->n;
    run->model->spatial->accelerate(run->model, &(struct drive){0}, 0, run->y, NULL, run->a);
    for (size_t i = 0; i < run->n; i++)
        v[i] += dt / 2 * run->a[i];
    const double energy = leapfrog_energy(run, dt);
    for (size_t i = 0; i < run->n; i++)
        v[i] -= dt / 2 * run->a[i];
    return energy;
}

/* Three steps of a run of some threads from noise; kept NULL: keeps the state, else it must be the same to the bit. */
static inline void assert_same_steps(struct run *run, int threads, double **kept)
{
    assert_int_equal(consistent_of(run->model)->threads, threads);
    noise(run->n, run->y);
    for (int step = 0; step < 3; step++)
        leap(run, &(struct drive){0}, .02);
    if (*kept != NULL) {
        assert_memory_equal(*kept, run->y, run->n * sizeof **kept);
        return;
    }
    *kept = calloc(run->n, sizeof **kept);
    memcpy(*kept, run->y, run->n * sizeof **kept);
}

static inline struct consistent_options quick(void) /* denormal numbers are slow */
{
    struct consistent_options options = general();
    options.quiet = 1e-12;
    return options;
}

/* With absorbing layers behind some faces. */
static inline struct run layered_run(struct plain_scene *plain, unsigned faces, long points)
{
    for (int face = 0; face < BOX_FACES; face++) {
        if ((faces >> face & 1U) == 0) continue;
        plain->scene.boundary[face] = (struct boundary){
            .kind = BOUNDARY_TRANSMITTING, .absorber = ABSORBER_PML, .layer_points = points, .always = true};
    }
    struct run run = run_new(plain, quick());
    free(run.y);
    run.y = calloc(run.model->state_size, sizeof *run.y);
    return run;
}

static inline double size_of(size_t n, const double *x)
{
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most += x[i] * x[i];
    return sqrt(most);
}

/* Noise on random ground with absorbing layers at all faces but z-: the shortest waves stay, as they do not travel, but
 * nothing grows. */
static inline void assert_layers_are_quiet(struct plain_scene *plain)
{
    struct ground_block everywhere = {.shape = BLOCK_BOX,
                                      .half = {9, 9, 9}}; /* rock that changes in the layers */
    plain->scene.body.block = &everywhere;
    plain->scene.body.blocks = 1;
    struct run run = layered_run(plain, 63 & ~(1U << FACE_Z_LOW), 6);
    struct messages messages = {0};
    double omega, error;
    make_random(consistent_of(run.model));
    assert_int_equal(largest_frequency(run.model, &omega, &error, &messages), SELAS_OK);
    noise(run.n, run.y + run.n);
    const double first = size_of(run.n, run.y + run.n);
    march(&run, .9 * 2 / omega, 500);
    const double early = size_of(run.n, run.y + run.n);
    march(&run, .9 * 2 / omega, 500);
    assert_true(early < first);
    assert_true(size_of(run.n, run.y + run.n) < early);
    run_free(&run);
}

#endif
