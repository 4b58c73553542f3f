/* Sums over the wavenumbers of a band of frequencies (doc/theory/seismograms.md, Eqs 19, 20): blocks of wavenumbers one
 * after the other, whose weights serve all frequencies, and responses all paths between two depths. */
#include "base/memory.h"
#include "exact/half_space.h"
#include "exact/lamb_fft.h"
#include "exact/seismogram_work.h"

#include <gsl/gsl_sort.h>
#include <math.h>
#include <string.h>

/* Index of a level; depths that differ by rounding are one. */
static size_t level_of(const struct strata *strata, double depth)
{
    size_t best = 0;
    for (size_t i = 1; i < strata->levels; i++)
        if (fabs(strata->depth[i] - depth) < fabs(strata->depth[best] - depth)) best = i;
    return best;
}

/* Sorts n depths and leaves each once. */
static size_t sort_depths(size_t n, double *depth)
{
    size_t kept = 1;
    gsl_sort(depth, 1, n);
    for (size_t i = 1; i < n; i++)
        if (depth[i] - depth[kept - 1] > 1e-12 * depth[n - 1]) depth[kept++] = depth[i];
    return kept;
}

static bool make_strata(struct sums *sums, size_t receivers, const struct seismogram *seismogram)
{
    const struct seismogram_problem *problem = sums->problem;
    struct strata *strata = &sums->strata;
    const size_t most = problem->rocks + problem->sources + receivers;
    double *depth = strata->depth = array_new(most, sizeof *depth);
    strata->rock = array_new(most, sizeof *strata->rock);
    strata->source = array_new(problem->sources, sizeof *strata->source);
    strata->moments = array_new(problem->sources, sizeof *strata->moments);
    strata->receiver = array_new(receivers, sizeof *strata->receiver);
    double *some = array_new(most, sizeof *some);
    const bool room = depth != NULL && strata->rock != NULL && strata->source != NULL &&
                      strata->moments != NULL && strata->receiver != NULL && some != NULL;
    if (room) {
        size_t n = 0;
        for (size_t i = 0; i < problem->rocks; i++)
            depth[n++] = problem->rock[i].top;
        for (size_t i = 0; i < problem->sources; i++)
            depth[n++] = problem->source[i].position[2];
        for (size_t i = 0; i < receivers; i++)
            depth[n++] = seismogram[i].position[2];
        strata->levels = sort_depths(n, depth);
        strata->rocks = problem->rocks;
        strata->stress = problem->stress;
        for (size_t i = 0, rock = 0; i < strata->levels; i++) {
            while (rock + 1 < problem->rocks && level_of(strata, problem->rock[rock + 1].top) <= i)
                rock++;
            strata->rock[i] = rock;
        }
        for (size_t i = 0; i < problem->sources; i++)
            some[i] = problem->source[i].position[2];
        strata->sources = sort_depths(problem->sources, some);
        for (size_t i = 0; i < strata->sources; i++)
            strata->source[i] = level_of(strata, some[i]);
        for (size_t i = 0; i < receivers; i++)
            some[i] = seismogram[i].position[2];
        strata->receivers = sort_depths(receivers, some);
        for (size_t i = 0; i < strata->receivers; i++)
            strata->receiver[i] = level_of(strata, some[i]);
    }
    array_free(some);
    return room;
}

/* Static displacement of a patch on a half-space times mu, linear in Poisson's ratio. */
static void set_statics(struct path *path, double z)
{
    static const struct history smooth = {.kind = HISTORY_GAUSSIAN, .width = 1};
    struct lamb_load load = {.patch = path->source->patch, .history = &smooth};
    memcpy(load.traction, path->source->force, sizeof load.traction);
    for (int i = 0; i < 2; i++) {
        struct half_space ground;
        half_space_set(&ground, 1, i, 1); /* lambda = 0: ratio 0; lambda = mu: ratio 1/4 */
        lamb_split_static(&ground, &load, path->x, path->y, z, path->statics[i]);
    }
    for (int c = 0; c < 3; c++)
        path->statics[1][c] = 4 * (path->statics[1][c] - path->statics[0][c]);
}

static size_t place_of(size_t n, const size_t *list, size_t level)
{
    size_t i = 0;
    while (i + 1 < n && list[i] != level)
        i++;
    return i;
}

static void make_path(struct sums *sums, size_t source, size_t receiver, const double position[3],
                      struct path *path)
{
    struct strata *strata = &sums->strata;
    const struct seismogram_source *from = &sums->problem->source[source];
    path_set(path, from, position);
    path->source_index = source;
    path->receiver_index = receiver;
    path->source_level = place_of(strata->sources, strata->source, level_of(strata, from->position[2]));
    path->receiver_level = place_of(strata->receivers, strata->receiver, level_of(strata, position[2]));
    for (int i = 0; i < 6; i++)
        if (from->moment[i] != 0) strata->moments[path->source_level] = true;
    sums->reach = fmax(sums->reach, path->distance + from->patch.half[0] + from->patch.half[1]);
    if (path->patch) {
        sums->patches = true;
        set_statics(path, position[2]);
    }
    path_find_lines(path, sums->problem->stress);
}

selas_status sums_set(struct sums *sums, const struct seismogram_problem *problem, size_t receivers,
                      const struct seismogram *seismogram, struct messages *messages)
{
    *sums = (struct sums){.problem = problem, .receivers = receivers, .paths = receivers * problem->sources};
    sums->path = array_new(sums->paths, sizeof *sums->path);
    if (sums->path == NULL || !make_strata(sums, receivers, seismogram))
        return fail(messages, SELAS_NO_MEMORY, "not enough memory for %zu paths of seismograms", sums->paths);
    for (size_t r = 0; r < receivers; r++)
        for (size_t i = 0; i < problem->sources; i++)
            make_path(sums, i, r, seismogram[r].position, &sums->path[r * problem->sources + i]);
    return SELAS_OK;
}

void sums_free(struct sums *sums)
{
    array_free(sums->path);
    array_free(sums->strata.depth);
    array_free(sums->strata.rock);
    array_free(sums->strata.source);
    array_free(sums->strata.moments);
    array_free(sums->strata.receiver);
}

/* --- One band ----------------------------------------------------------------------------------------- */

static struct pair pair_of(double complex z)
{
    return (struct pair){creal(z), cimag(z)};
}

/* Moduli over the first rock's shear modulus. */
static void rock_set(const struct seismogram_problem *problem, double complex s, struct rock_at *rock)
{
    const double size = problem->rock[0].shear.size;
    for (size_t i = 0; i < problem->rocks; i++) {
        const double complex axial = modulus_at(&problem->rock[i].axial, s);
        const double complex shear = modulus_at(&problem->rock[i].shear, s);
        const double complex inertia = s * s * problem->rock[i].density;
        rock[i] = (struct rock_at){pair_of(shear / size), pair_of(axial / size), pair_of(inertia / axial),
                                   pair_of(inertia / shear)};
    }
}

/* Room of one thread. */
struct bench {
    struct strata_piece *piece;
    struct rock_at *rock;
    struct pair *response; /* of one wavenumber */
    double *block;         /* [sources * receivers][COLUMNS * RESPONSES][2][NODES] */
    double *statics;       /* [receivers][STATIC_RESPONSES][2][NODES] */
};

static void bench_free(struct bench *bench)
{
    array_free(bench->piece);
    array_free(bench->rock);
    array_free(bench->response);
    array_free(bench->block);
    array_free(bench->statics);
}

static bool bench_new(const struct sums *sums, struct bench *bench)
{
    const size_t depths = sums->strata.sources * sums->strata.receivers, each = COLUMNS * RESPONSES;
    bench->piece = array_new(sums->strata.levels, sizeof *bench->piece);
    bench->rock = array_new(sums->problem->rocks, sizeof *bench->rock);
    bench->response = array_new(depths * each, sizeof *bench->response);
    bench->block = array_new(depths * each * 2 * NODES, sizeof *bench->block);
    bench->statics = array_new(sums->strata.receivers * STATIC_RESPONSES * 2 * NODES, sizeof *bench->statics);
    if (bench->piece != NULL && bench->rock != NULL && bench->response != NULL && bench->block != NULL &&
        bench->statics != NULL)
        return true;
    bench_free(bench);
    return false;
}

/* Responses of a patch at one receiver depth less those of a half-space of the first rock at rest. */
static void static_responses(const struct strata *strata, const struct rock_at *rock, size_t receiver,
                             size_t count, const double *k, struct bench *bench)
{
    static const struct {
        int column, response;
        double sign;
    } of[STATIC_RESPONSES] = {{COLUMN_VERTICAL, RESPONSE_W, 1},
                              {COLUMN_VERTICAL, RESPONSE_U, 1},
                              {COLUMN_RADIAL, RESPONSE_U, 1},
                              {COLUMN_RADIAL, RESPONSE_W, -1},
                              {COLUMN_ACROSS, RESPONSE_V, 1}};
    const double complex mu = rock->mu.re + I * rock->mu.im, axial = rock->axial.re + I * rock->axial.im;
    const double complex nu = .5 * (axial - 2 * mu) / (axial - mu);
    const double z = strata->depth[strata->receiver[receiver]];
    double *out = bench->statics + receiver * STATIC_RESPONSES * 2 * NODES;
    const double *in =
        bench->block + receiver * COLUMNS * RESPONSES * 2 * NODES; /* the surface comes first */
    for (size_t i = 0; i < count; i++) {
        const struct half_space none = {.poisson = 0}, quarter = {.poisson = .25};
        double low[STATIC_RESPONSES], high[STATIC_RESPONSES];
        half_space_static(&none, z, k[i], low);
        half_space_static(&quarter, z, k[i], high);
        for (int j = 0; j < STATIC_RESPONSES; j++) {
            const double complex rest = of[j].sign * (low[j] + 4 * nu * (high[j] - low[j])) / mu;
            const size_t from = ((size_t)of[j].column * RESPONSES + (size_t)of[j].response) * 2 * NODES;
            out[(2 * (size_t)j) * NODES + i] = in[from + i] - creal(rest);
            out[(2 * (size_t)j + 1) * NODES + i] = in[from + NODES + i] - cimag(rest);
        }
    }
}

static void fill_block(const struct sums *sums, size_t count, const double *k, struct bench *bench)
{
    const struct strata *strata = &sums->strata;
    const size_t all = strata->sources * strata->receivers * COLUMNS * RESPONSES;
    for (size_t i = 0; i < count; i++) {
        strata_responses(strata, bench->rock, k[i], bench->piece, bench->response);
        for (size_t j = 0; j < all; j++) {
            bench->block[2 * j * NODES + i] = bench->response[j].re;
            bench->block[(2 * j + 1) * NODES + i] = bench->response[j].im;
        }
    }
    for (size_t r = 0; r < strata->receivers && sums->patches; r++)
        static_responses(strata, bench->rock, r, count, k, bench);
}

/* One block of wavenumbers at one frequency, all paths. */
static void add_block(const struct sums *sums, size_t count, const double *k, const double *const *weight,
                      const double complex *factor, size_t stride, struct bench *bench, double complex *value)
{
    fill_block(sums, count, k, bench);
    for (size_t p = 0; p < sums->paths; p++) {
        const struct path *path = &sums->path[p];
        if (path->end <= k[0]) continue;
        const size_t depths = path->source_level * sums->strata.receivers + path->receiver_level;
        const double *response = path->patch
                                     ? bench->statics + path->receiver_level * STATIC_RESPONSES * 2 * NODES
                                     : bench->block + depths * COLUMNS * RESPONSES * 2 * NODES;
        double complex component[COMPONENTS] = {0};
        path_sum(path, count, weight[p], response, component);
        path_turn(path, sums->problem->stress, component);
        double complex *to = value + path->receiver_index * stride;
        const double complex f = factor[path->source_index];
        for (int c = 0; c < (sums->problem->stress ? COMPONENTS : 3); c++)
            to[c] += f * component[c];
    }
}

/* The static parts of patches, and the common modulus. */
static void finish(const struct sums *sums, double complex s, const double complex *factor, size_t stride,
                   double complex *value)
{
    const struct seismogram_rock *rock = &sums->problem->rock[0];
    const double complex mu = modulus_at(&rock->shear, s), axial = modulus_at(&rock->axial, s);
    const double complex nu = .5 * (axial - 2 * mu) / (axial - mu);
    for (size_t r = 0; r < sums->receivers; r++)
        for (int c = 0; c < 3; c++)
            value[r * stride + (size_t)c] /= rock->shear.size;
    for (size_t p = 0; p < sums->paths; p++) {
        const struct path *path = &sums->path[p];
        for (size_t c = 0; c < 3 && path->patch; c++)
            value[path->receiver_index * stride + c] +=
                factor[path->source_index] * (path->statics[0][c] + nu * path->statics[1][c]) / mu;
    }
}

/* Room for the weights of one block. */
static double **weights_new(const struct sums *sums)
{
    size_t lines = 0;
    for (size_t p = 0; p < sums->paths; p++)
        lines += sums->path[p].lines;
    double **weight = array_new(sums->paths + 1, sizeof *weight);
    double *all = array_new(lines * NODES, sizeof *all);
    if (weight == NULL || all == NULL) {
        array_free(weight);
        array_free(all);
        return NULL;
    }
    weight[sums->paths] = all; /* kept to be freed */
    for (size_t p = 0; p < sums->paths; p++) {
        weight[p] = all;
        all += sums->path[p].lines * NODES;
    }
    return weight;
}

static bool sum_blocks(struct sums *sums, const struct wavenumbers *grid, size_t n, const double complex *s,
                       const double complex *factor, double **weight, double complex *value)
{
    bool room = true;
#pragma omp parallel
    {
        struct bench bench = {0};
        const bool own = bench_new(sums, &bench);
        if (!own) {
#pragma omp atomic write
            room = false;
        }
        for (size_t from = 0; from < grid->nodes; from += NODES) {
            const size_t count = grid->nodes - from < NODES ? grid->nodes - from : NODES;
            const double *k = grid->k + from;
#pragma omp for schedule(dynamic, 4)
            for (size_t p = 0; p < sums->paths; p++)
                if (sums->path[p].end > k[0])
                    path_weights(&sums->path[p], count, k, grid->weight + from, weight[p]);
#pragma omp for schedule(dynamic, 2)
            for (size_t j = 0; j < n; j++) {
                if (!own) continue;
                rock_set(sums->problem, s[j], bench.rock);
                add_block(sums, count, k, (const double *const *)weight, factor + j * sums->problem->sources,
                          n * COMPONENTS, &bench, value + j * COMPONENTS);
            }
        }
        if (own) bench_free(&bench);
    }
    return room;
}

bool sums_at(struct sums *sums, const struct band *band, struct finesse finesse, size_t n,
             const double complex *s, bool unit, double complex *value)
{
    const size_t sources = sums->problem->sources;
    struct wavenumbers grid = {0};
    double end = 0;
    for (size_t p = 0; p < sums->paths; p++) {
        path_range(&sums->path[p], sums->problem, &sums->strata, band, finesse.digits);
        end = fmax(end, sums->path[p].end);
    }
    double **weight = weights_new(sums);
    double complex *factor = array_new(n * sources, sizeof *factor);
    bool room = weight != NULL && factor != NULL && wavenumbers_set(&grid, band, sums->reach, end, finesse);
    if (room) {
        memset(value, 0, sums->receivers * n * COMPONENTS * sizeof *value);
        for (size_t j = 0; j < n; j++)
            for (size_t i = 0; i < sources; i++)
                factor[j * sources + i] =
                    unit ? 1 : history_laplace_uncut(sums->problem->source[i].history, s[j]);
        room = sum_blocks(sums, &grid, n, s, factor, weight, value);
        for (size_t j = 0; j < n; j++)
            finish(sums, s[j], factor + j * sources, n * COMPONENTS, value + j * COMPONENTS);
        sums->evaluations += (double)n * (double)grid.nodes;
    }
    if (weight != NULL) array_free(weight[sums->paths]);
    array_free(weight);
    array_free(factor);
    wavenumbers_free(&grid);
    return room;
}
