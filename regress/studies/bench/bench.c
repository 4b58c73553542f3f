/* Speed of the lattice operator and of a step of leapfrog beside what the machine can do, measured in the
 * same run: CPU time of one thread, the best of some repetitions. Usage: bench [NX NY NZ]...; prints rows of
 * a Markdown table. */
#include "../unit/plain_scene.h"
#include "base/machine.h"
#include "base/memory.h"
#include "method/consistent/fused/fused.h"
#include "method/consistent/galerkin/hform.h"
#include "stepping/schemes.h"

#include <math.h>
#include <omp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef double lanes __attribute__((vector_size(64)));
enum { CHAINS = 16, ROUNDS = 200000, TRIAD = 1 << 22 };

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Multiplications with addition, 8 numbers each, on independent registers. */
void fma_rounds(long rounds, lanes *value);
EACH_MACHINE void fma_rounds(long rounds, lanes *value)
{
    lanes sum[CHAINS];
    const lanes factor = value[0], term = value[1];
    for (int i = 0; i < CHAINS; i++)
        sum[i] = value[i];
    for (long round = 0; round < rounds; round++)
        for (int i = 0; i < CHAINS; i++)
            sum[i] = sum[i] * factor + term;
    for (int i = 0; i < CHAINS; i++)
        value[i] = sum[i];
}

/* FMA per ns. */
static double peak(void)
{
    lanes value[CHAINS] = {{0}};
    double best = INFINITY;
    for (int repeat = 0; repeat < 20; repeat++) {
        const double start = now();
        fma_rounds(ROUNDS, value);
        best = fmin(best, now() - start);
    }
    return 1e-9 * 8.0 * CHAINS * ROUNDS / best;
}

void triad(size_t n, const double *a, const double *b, double *c);
EACH_MACHINE void triad(size_t n, const double *restrict a, const double *restrict b, double *restrict c)
{
    for (size_t i = 0; i < n; i++)
        c[i] = a[i] + 3.0 * b[i];
}

/* Bytes per ns of c = a + 3 b over 100 MB, 24 bytes a number counted. */
static double bandwidth(void)
{
    double *a = array_new(TRIAD, sizeof *a), *b = array_new(TRIAD, sizeof *b),
           *c = array_new(TRIAD, sizeof *c);
    double best = INFINITY;
    if (a == NULL || b == NULL || c == NULL) exit(1);
    for (int repeat = 0; repeat < 12; repeat++) {
        const double start = now();
        triad(TRIAD, a, b, c);
        best = fmin(best, now() - start);
    }
    array_free(a);
    array_free(b);
    array_free(c);
    return 1e-9 * 24.0 * TRIAD / best;
}

/* FMA a point and call (fused.h, F1): S, G: 6 passes of 5 taps a side, N: 4 of 13; over depth 2 or 3 of 17 a
 * component. */
static double fma_of(const struct fused *f)
{
    return 12.0 * f->narrow + 8.0 * f->wide + (f->bare ? 6.0 : 9.0) * f->deep;
}

struct timing {
    double call, apart, step, fma, bytes; /* ns and FMA a point; bytes a point of model and state */
};

/* `apart`: updates and operator one after the other; `step`: as the program does it. */
static struct timing measure(const size_t n[3], bool exact, bool unfused, bool single)
{
    struct plain_scene plain;
    struct messages messages = {0};
    struct model *model = NULL;
    const double size[3] = {(double)n[0] - 2, (double)n[1] - 2, (double)n[2] - 2};
    plain_box(&plain, 3, size, 1);
    const struct consistent_options options = {
        .degree = 2, .sweeps = 3, .depth_exact = exact, .unfused = unfused, .single = single};
    if (consistent_create_with(&plain.scene, &options, &model, &messages) != SELAS_OK) {
        fputs(messages.text, stderr);
        exit(1);
    }
    const size_t points = model->unknowns / 3;
    struct stepper stepper = {.scheme = &scheme_leapfrog, .model = model, .dt = 1e-3};
    struct state state = {.y = array_new(model->state_size, sizeof(double)),
                          .a = array_new(model->unknowns, sizeof(double))};
    if (state.y == NULL || state.a == NULL ||
        driver_create(&stepper.driver, &plain.scene, stepper.dt, &messages) != SELAS_OK)
        exit(1);
    uint64_t seed = 7;
    for (size_t i = 0; i < model->unknowns; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        state.y[i] = (double)(seed >> 11) * 0x1p-52 - 1;
    }
    struct timing timing = {INFINITY, INFINITY, INFINITY, 0, 0};
    scheme_leapfrog.start(&stepper, &state);
    const bool one_pass = stepper.one_pass;
    const int repeats = points > 1000000 ? 3 : 3 + (int)(3000000 / points);
    for (int repeat = 0; repeat < repeats; repeat++) {
        double start = now();
        model->spatial->accelerate(model, &(struct drive){0}, 0, state.y, NULL, state.a);
        timing.call = fmin(timing.call, now() - start);
        for (int way = 0; way < 2; way++) {
            double *least = way == 0 ? &timing.apart : &timing.step;
            stepper.one_pass = one_pass && way == 1;
            start = now();
            scheme_leapfrog.step(&stepper, &state);
            *least = fmin(*least, now() - start);
        }
    }
    timing.call *= 1e9 / (double)points;
    timing.apart *= 1e9 / (double)points;
    timing.step *= 1e9 / (double)points;
    const struct fused *fused = consistent_of(model)->fused;
    timing.fma = fused != NULL ? fma_of(fused) : NAN;
    timing.bytes =
        (double)(model->bytes + (model->state_size + model->unknowns) * sizeof(double)) / (double)points;
    model_free(&model);
    array_free(state.y);
    array_free(state.a);
    return timing;
}

int main(int count, char **word)
{
    omp_set_num_threads(1);
    const double fma = peak(), stream = bandwidth();
    printf("Machine, one thread: %.1f FMA/ns (double), triad %.1f GB/s.\n\n", fma, stream);
    printf("| lattice | over depth | passes | ns a call | ns a step, apart | ns a step | FMA | share of FMA "
           "peak "
           "| bytes a point |\n"
           "|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 1; i + 2 < count; i += 3) {
        const size_t n[3] = {strtoul(word[i], NULL, 10), strtoul(word[i + 1], NULL, 10),
                             strtoul(word[i + 2], NULL, 10)};
        for (int kind = 0; kind < 6; kind++) {
            const bool exact = kind % 2 == 1, unfused = kind >= 4, single = kind / 2 == 1;
            if (unfused && n[0] * n[1] * n[2] > 1000000) continue;
            const struct timing t = measure(n, exact, unfused, single);
            printf("| %zu x %zu x %zu | %s | %s | ", n[0], n[1], n[2], exact ? "exact" : "same",
                   unfused  ? "one by one"
                   : single ? "single"
                            : "fused");
            if (single)
                printf("| | %.1f | %.0f | | %.0f |\n", t.step, t.fma, t.bytes);
            else if (unfused)
                printf("%.1f | %.1f | %.1f | | | %.0f |\n", t.call, t.apart, t.step, t.bytes);
            else
                printf("%.1f | %.1f | %.1f | %.0f | %.0f %% | %.0f |\n", t.call, t.apart, t.step, t.fma,
                       100 * t.fma / t.call / fma, t.bytes);
            fflush(stdout);
        }
    }
    return 0;
}
