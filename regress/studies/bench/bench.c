/* Speed of the lattice operator and of a step of leapfrog beside what the processor can do, measured in the
 * same run: CPU time of one thread, the best of some repetitions. Usage: bench [NX NY NZ]...; prints rows of
 * a Markdown table. `bench kinds` prints the kinds of processors that the machine has, the best first;
 * SELAS_PROCESSOR takes one of them. */
#include "base/memory.h"
#include "method/consistent/consistent.h"
#include "method/consistent/fused/fused.h"
#include "method/consistent/galerkin/hform.h"
#include "peak.h"
#include "plain_scene.h"
#include "scene/topography.h"
#include "stepping/schemes.h"

#include <math.h>
#include <omp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 200000, TRIAD = 1 << 22 };

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Cycles per ns: additions that wait for each other, one a cycle; many in a round, as a jump may take two. */
static double frequency(void)
{
    enum { TOGETHER = 16 };
    double best = INFINITY;
    for (int repeat = 0; repeat < 20; repeat++) {
        const double start = now();
        unsigned long sum = 1, more = 3;
        for (long round = 0; round < ROUNDS; round++)
#pragma GCC unroll 16
            for (int i = 0; i < TOGETHER; i++) {
                sum += more;
                __asm__ volatile("" : "+r"(sum), "+r"(more));
            }
        best = fmin(best, now() - start);
    }
    return 1e-9 * TOGETHER * ROUNDS / best;
}

/* FMA per ns. */
static double peak(void)
{
    double value[2 * 8] = {0}, best = INFINITY, count = 0;
    for (int repeat = 0; repeat < 20; repeat++) {
        const double start = now();
        count = taken_peak_loops()->multiply(ROUNDS, value);
        best = fmin(best, now() - start);
    }
    return 1e-9 * count / best;
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
        taken_peak_loops()->triad(TRIAD, a, b, c);
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
static struct timing measure(const size_t n[3], const struct consistent_options *options, bool hilly)
{
    struct plain_scene plain;
    struct topography hill = {.shape = TOPOGRAPHY_GAUSSIAN, .across = {1, 0}, .axis = 2};
    struct messages messages = {0};
    struct model *model = NULL;
    const double size[3] = {(double)n[0] - 2, (double)n[1] - 2, (double)n[2] - 2};
    plain_box(&plain, 3, size, 1);
    hill.width = size[0] / 6;
    hill.height = hill.width / 2;
    hill.depth = 2 * floor(size[2] / 2);
    hill.centre[0] = size[0] / 2;
    hill.centre[1] = size[1] / 2;
    if (hilly) plain.scene.body.topography = &hill;
    if (consistent_create_with(&plain.scene, options, &model, &messages) != SELAS_OK) {
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
    if (count == 2 && strcmp(word[1], "kinds") == 0) {
        for (enum processor kind = PROCESSORS; kind-- > PROCESSOR_PLAIN;)
            if (processor_there(kind)) puts(processor_name(kind));
        return 0;
    }
    omp_set_num_threads(1);
    const double fma = peak(), stream = bandwidth(), cycles = frequency();
    const enum processor kind = processor_taken();
    printf("%s, one thread: %.1f FMA/ns (double; %.2f vectors of %d bytes in each cycle of %.2f GHz), "
           "triad %.1f GB/s.\n\n",
           processor_name(kind), fma, fma / cycles * 8 / processor_bytes(kind), processor_bytes(kind), cycles,
           stream);
    printf("| lattice | over depth | passes | ns a call | ns a step, apart | ns a step | FMA | share of FMA "
           "peak "
           "| bytes a point |\n"
           "|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 1; i + 2 < count; i += 3) {
        const size_t n[3] = {strtoul(word[i], NULL, 10), strtoul(word[i + 1], NULL, 10),
                             strtoul(word[i + 2], NULL, 10)};
        for (int row = 0; row < 12; row++) {
            const bool general = row >= 6, hilly = general && row % 2 == 1, exact = row % 2 == 1 || general;
            const int way = row % 6 / 2; /* fused, single, one by one */
            const bool unfused = way == 2, single = way == 1;
            const struct consistent_options options = {.degree = 2,
                                                       .sweeps = 3,
                                                       .depth_exact = exact,
                                                       .unfused = unfused,
                                                       .single = single,
                                                       .general = general};
            if (n[0] * n[1] * n[2] > (general ? 3000000 : unfused ? 1000000 : SIZE_MAX)) continue;
            const struct timing t = measure(n, &options, hilly);
            printf("| %zu x %zu x %zu | %s | %s | ", n[0], n[1], n[2],
                   hilly     ? "general, a hill"
                   : general ? "general, level"
                   : exact   ? "exact"
                             : "same",
                   unfused  ? "one by one"
                   : single ? "single"
                            : "fused");
            if (single)
                printf("| | %.1f | | | %.0f |\n", t.step, t.bytes);
            else if (unfused || general)
                printf("%.1f | %.1f | %.1f | | | %.0f |\n", t.call, t.apart, t.step, t.bytes);
            else
                printf("%.1f | %.1f | %.1f | %.0f | %.0f %% | %.0f |\n", t.call, t.apart, t.step, t.fma,
                       100 * t.fma / t.call / fma, t.bytes);
            fflush(stdout);
        }
    }
    return 0;
}
