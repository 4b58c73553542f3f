/* The largest frequency of the undamped operator, M^-1 K x = omega^2 x.
 *
 * Self-adjoint models: Lanczos iteration in the inner product of the mass (Parlett 1998, chapter 13). It
 * takes one call of the operator and one product with M a step; models that cannot tell M v give energies in
 * their place, alpha = q.Kq = 2 strain(q), beta^2 = r.Mr = 2 kinetic(r). The largest Ritz value theta is a
 * lower bound, and some eigenvalue lies within beta |last component of the Ritz vector| of it: that is the
 * error told. Other models: power iteration in the Euclidean norm. Models that have a shorter one of the same
 * operator are measured on that. Ranks iterate together. */
#include "stepping/stepping.h"

#include "base/gsl_errors.h"
#include "base/memory.h"
#include "model/spread.h"
#include "parallel/ranks.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdint.h>

enum { LANCZOS_STEPS = 120, LANCZOS_CHECK = 8, POWER_STEPS = 200, POWER_TAIL = 20 };

static const uint64_t lcg_factor = 6364136223846793005u, lcg_term = 1442695040888963407u; /* Knuth's MMIX */

/* Small reproducible numbers in [-1, 1). */
static double noise(uint64_t *seed)
{
    *seed = *seed * lcg_factor + lcg_term;
    return (double)(*seed >> 11) * 0x1p-52 - 1.0;
}

/* The seed after so many numbers. */
static uint64_t seed_after(uint64_t seed, size_t numbers)
{
    uint64_t factor = lcg_factor, term = lcg_term;
    for (; numbers > 0; numbers /= 2) {
        if (numbers % 2 == 1) seed = seed * factor + term;
        term *= factor + 1;
        factor *= factor;
    }
    return seed;
}

/* Ranks that share vectors; NULL: each has them whole. */
static struct ranks *sharing(const struct model *model)
{
    return model->core->complete == NULL ? model->scene->ranks : NULL;
}

/* Which of the unknowns of the whole body this rank has; alone, all. */
static void find_shares(struct model *model, struct spread *shares)
{
    const size_t n = model->unknowns;
    const struct spread_run all = spread_line(0, 0, n, 0, n);
    *shares = (struct spread){0};
    if (ranks_count(sharing(model)) > 1)
        model->core->share(model, ARRAY_UNKNOWNS, shares);
    else
        spread_add(shares, n, n, &all);
}

/* Random numbers, the same for any number of ranks. */
static void make_noise(const struct spread *shares, uint64_t first, double *x)
{
    for (size_t r = 0; r < shares->runs; r++) {
        const struct spread_run *run = &shares->run[r];
        for (size_t t = 0; t < run->times; t++) {
            uint64_t seed = seed_after(first, run->there + t * run->there_step);
            double *numbers = x + run->here + t * run->here_step;
            for (size_t i = 0; i < run->count; i++)
                numbers[i] = noise(&seed);
        }
    }
}

/* At rest; `a` in the whole of what a rank has. */
static void accelerate(struct model *model, const double *u, const double *v, double *a)
{
    const struct drive quiet = {.time = 0.0};
    model->spatial->accelerate(model, &quiet, 0.0, u, v, a);
    if (model->core->complete != NULL) model->core->complete(model, a);
}

/* y's u part := random, made admissible (prescribed components zero) by one call of the operator into a. */
static void first_vector(struct model *model, const struct spread *shares, double *y, double *a)
{
    make_noise(shares, 20061, y);
    accelerate(model, y, NULL, a);
}

struct tridiagonal {
    size_t n;
    double alpha[LANCZOS_STEPS], beta[LANCZOS_STEPS]; /* beta[j] couples j and j + 1 */
};

/* Largest Ritz value and the bound on its distance to an eigenvalue. (GSL's own workspace is made here: its
 * allocator loses blocks where the last ones are not to be had.) */
static bool ritz(const struct tridiagonal *t, double *theta, double *bound)
{
    const size_t n = t->n;
    double *numbers = array_new((2 * n + 5) * n, sizeof *numbers);
    if (numbers == NULL) return false;
    gsl_matrix_view matrix = gsl_matrix_view_array(numbers, n, n);
    gsl_matrix_view vectors = gsl_matrix_view_array(numbers + n * n, n, n);
    double *line = numbers + 2 * n * n;
    gsl_vector_view values = gsl_vector_view_array(line, n);
    gsl_eigen_symmv_workspace work = {n, line + n, line + 2 * n, line + 3 * n, line + 4 * n};
    for (size_t j = 0; j < n; j++) {
        numbers[n * j + j] = t->alpha[j];
        if (j + 1 < n) numbers[n * j + j + 1] = numbers[n * (j + 1) + j] = t->beta[j];
    }
    gsl_errors_returned();
    gsl_eigen_symmv(&matrix.matrix, &values.vector, &vectors.matrix, &work);
    gsl_errors_as_before();
    const size_t top = gsl_vector_max_index(&values.vector);
    *theta = gsl_vector_get(&values.vector, top);
    *bound = t->beta[n - 1] * fabs(gsl_matrix_get(&vectors.matrix, n - 1, top));
    array_free(numbers);
    return true;
}

/* The rank whose numbers come before, or behind, those that this one has of a run at one time; itself: it goes on. */
static int next_rank(struct ranks *ranks, const struct spread_run *run, size_t t, bool before)
{
    const int me = ranks_me(ranks), count = ranks_count(ranks), across = me % run->abreast;
    const bool end = before ? t == run->first : t + 1 == run->last;
    if (before ? across == 0 : across + 1 == run->abreast) {
        if (!end) return before ? me + run->abreast - 1 : me + 1 - run->abreast;
    }
    return (me + (before ? count - 1 : 1)) % count;
}

/* Together: x.y over the whole body, summed in its order from rank to rank: the same bits for any number of them. */
static double dot(struct model *model, const struct spread *shares, const double *x, const double *y)
{
    struct ranks *ranks = sharing(model);
    const int me = ranks_me(ranks), last = ranks_count(ranks) - 1;
    double sum = 0.0;
    for (size_t r = 0; r < shares->runs; r++) {
        const struct spread_run *run = &shares->run[r];
        for (size_t t = run->first; t < run->last; t++) {
            const int before = next_rank(ranks, run, t, true), behind = next_rank(ranks, run, t, false);
            const struct ranks_piece get = {before, NULL, &sum, 0, sizeof sum};
            const struct ranks_piece give = {behind, &sum, NULL, sizeof sum, 0};
            if (before != me && (me > 0 || r > 0 || t > run->first)) ranks_exchange(ranks, 1, &get);
            for (size_t at = run->here + t * run->here_step, i = at + run->from; i < at + run->end; i++)
                sum += x[i] * y[i];
            if (behind != me && (me < last || r + 1 < shares->runs || t + 1 < run->last))
                ranks_exchange(ranks, 1, &give);
        }
    }
    ranks_spread(ranks, last, &sum, sizeof sum);
    return sum;
}

/* Together: is it so on all ranks? */
static bool everywhere(const struct model *model, bool here)
{
    double missing = here ? 0 : 1;
    ranks_largest(model->scene->ranks, 1, &missing);
    return here && missing == 0;
}

/* Norm of r; the v part of y gets M r where the model can tell it. */
static double mass_norm(struct model *model, const struct spread *shares, double *y, const double *r)
{
    const size_t n = model->unknowns;
    struct energy energy;
    double *v = y + n;
    if (model->spatial->weigh != NULL) {
        model->spatial->weigh(model, r, v);
        return sqrt(fmax(0.0, dot(model, shares, r, v)));
    }
    for (size_t i = 0; i < n; i++)
        v[i] = r[i];
    model->core->energy(model, y, &energy);
    return sqrt(2.0 * energy.kinetic);
}

/* a := -M^-1 K q, q in the u part of y; gives q.Kq. `norm`: that of the vector whose M times it is in the v
 * part, and q that vector over its norm. */
static double rayleigh(struct model *model, const struct spread *shares, double *y, double norm, double *a)
{
    struct energy energy = {0};
    if (model->spatial->weigh == NULL) model->core->energy(model, y, &energy);
    accelerate(model, y, NULL, a);
    if (model->spatial->weigh == NULL) return 2.0 * energy.strain;
    return -dot(model, shares, a, y + model->unknowns) / norm;
}

static bool lanczos(struct model *model, const struct spread *shares, double *y, double *a, double *before,
                    double *theta, double *bound)
{
    const size_t n = model->unknowns;
    struct tridiagonal t = {0};
    first_vector(model, shares, y, a);
    double norm = mass_norm(model, shares, y, a), beta = 0.0;
    *theta = 0.0;
    *bound = 0.0;
    if (!(norm > 0.0)) return true; /* nothing moves: no stiffness */
    for (size_t i = 0; i < n; i++) {
        y[i] = a[i] / norm;
        before[i] = 0.0;
    }
    while (t.n < LANCZOS_STEPS) {
        const double alpha = rayleigh(model, shares, y, norm, a);
        for (size_t i = 0; i < n; i++)
            a[i] = -a[i] - alpha * y[i] - beta * before[i];
        norm = beta = mass_norm(model, shares, y, a);
        t.alpha[t.n] = alpha;
        t.beta[t.n++] = beta;
        const bool exhausted = !(beta > 1e-12 * fabs(t.alpha[0]));
        if (exhausted || t.n % LANCZOS_CHECK == 0) {
            if (!everywhere(model, ritz(&t, theta, bound))) return false;
            if (exhausted || *bound < 1e-3 * *theta) return true;
        }
        for (size_t i = 0; i < n; i++) {
            before[i] = y[i];
            y[i] = a[i] / beta;
        }
    }
    return true;
}

static double euclidean_norm(struct model *model, const struct spread *shares, const double *x)
{
    return sqrt(dot(model, shares, x, x));
}

/* Largest growth of the norm over the last steps; an eigenvalue pair that is complex only makes it larger. */
static double power_iteration(struct model *model, const struct spread *shares, double *y, double *a)
{
    const size_t n = model->unknowns;
    double theta = 0.0;
    first_vector(model, shares, y, a);
    for (int j = 0; j < POWER_STEPS; j++) {
        const double norm = euclidean_norm(model, shares, a);
        if (!(norm > 0.0)) return 0.0;
        for (size_t i = 0; i < n; i++)
            y[i] = a[i] / norm;
        accelerate(model, y, NULL, a);
        if (j >= POWER_STEPS - POWER_TAIL) theta = fmax(theta, euclidean_norm(model, shares, a));
    }
    return theta;
}

static selas_status measure(struct model *model, double *omega, double *error, struct messages *messages)
{
    const bool self_adjoint = model->self_adjoint;
    double *y = array_new(model->state_size, sizeof *y);
    double *a = array_new(model->unknowns, sizeof *a);
    double *before = self_adjoint ? array_new(model->unknowns, sizeof *before) : NULL;
    bool room = everywhere(model, y != NULL && a != NULL && (before != NULL || !self_adjoint));
    struct spread shares;
    find_shares(model, &shares);
    if (model->spatial->linearise != NULL) model->spatial->linearise(model, true);
    double theta = 0.0;
    double bound = 0.0;
    if (room && self_adjoint) room = lanczos(model, &shares, y, a, before, &theta, &bound);
    if (room && !self_adjoint) theta = power_iteration(model, &shares, y, a);
    if (model->spatial->linearise != NULL) model->spatial->linearise(model, false);
    array_free(y);
    array_free(a);
    array_free(before);
    if (!room) return fail(messages, SELAS_NO_MEMORY, "no memory to measure the largest frequency");
    *omega = sqrt(theta);
    *error = theta > 0.0 ? 0.5 * bound / theta : 0.0;
    return SELAS_OK;
}

selas_status largest_frequency(struct model *model, double *omega, double *error, struct messages *messages)
{
    struct model *shorter = NULL;
    double deficit = 0.0;
    if (model->spatial->shorten != NULL) {
        const selas_status status = model->spatial->shorten(model, &shorter, &deficit, messages);
        if (status != SELAS_OK) return status;
    }
    const selas_status status = measure(shorter != NULL ? shorter : model, omega, error, messages);
    if (shorter != NULL) *error += deficit;
    model_free(&shorter);
    return status;
}

selas_status largest_damping(struct model *model, double speed, double *rate, struct messages *messages)
{
    const size_t n = model->unknowns;
    const double scale = 1e-6 * speed; /* quadratic viscosities vanish against linear ones */
    double *u = array_new(n, sizeof *u);
    double *v = array_new(n, sizeof *v);
    double *a = array_new(n, sizeof *a);
    const bool room = everywhere(model, u != NULL && v != NULL && a != NULL);
    struct spread shares;
    find_shares(model, &shares);
    *rate = 0.0;
    if (room) {
        make_noise(&shares, 20062, a);
        for (int j = 0; j <= POWER_STEPS; j++) {
            const double norm = euclidean_norm(model, &shares, a);
            if (j > POWER_STEPS - POWER_TAIL) *rate = fmax(*rate, norm / scale);
            for (size_t i = 0; i < n; i++)
                v[i] = norm > 0.0 ? scale * a[i] / norm : 0.0;
            accelerate(model, u, v, a);
        }
    }
    array_free(u);
    array_free(v);
    array_free(a);
    if (!room) return fail(messages, SELAS_NO_MEMORY, "no memory to measure the damping");
    return SELAS_OK;
}
