/* The two radii that limit the time step, each by power iteration about the body at rest, with the rates
 * themselves as the operator (they are linear there):
 *
 *   waves      v -> stress rate -> acceleration, viscosity and artificial stress off: eigenvalues -omega^2
 *   viscosity  v -> acceleration of the viscous term alone, beta off: eigenvalue -radius
 *
 * The viscosity acts on approaching pairs only, so that its map is not linear but keeps positive factors; the
 * growth of the norm under repeated application is what a run sees (about half of what both-sided viscosity
 * would give). */
#include "base/memory.h"
#include "method/updated_lagrangian.h"

#include <math.h>
#include <string.h>

enum { STEPS = 150, TAIL = 25 };

/* Work vectors of the iteration. */
struct iteration {
    double *vector; /* unknowns */
    double *y, *dydt;
};

static double norm(const double *x, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += x[i] * x[i];
    return sqrt(sum);
}

/* Rates of the body at rest with velocities v and stresses s (either may be NULL). */
static void evaluate(struct updated *updated, struct iteration *work, const double *v, const double *stress)
{
    struct model *model = &updated->model;
    const size_t unknowns = model->unknowns, points = updated->cloud->points;
    const struct drive quiet = {.time = 0};
    memset(work->y, 0, model->state_size * sizeof *work->y);
    if (v != NULL) memcpy(work->y + unknowns, v, unknowns * sizeof *v);
    for (size_t i = 0; i < points; i++)
        work->y[2 * unknowns + i] = updated->material->density;
    if (stress != NULL)
        memcpy(work->y + 2 * unknowns + points, stress, (size_t)updated->stresses * points * sizeof *stress);
    updated_rate(model, &quiet, work->y, work->dydt);
}

static void wave_map(struct updated *updated, struct iteration *work)
{
    const size_t extra = 2 * updated->model.unknowns + updated->cloud->points;
    evaluate(updated, work, work->vector, NULL);
    /* evaluate() clears y, so that the rates must not be read from it */
    const size_t bytes = (updated->model.state_size - extra) * sizeof(double);
    double *stress = work->vector + updated->model.unknowns;
    memcpy(stress, work->dydt + extra, bytes);
    evaluate(updated, work, NULL, stress);
}

static void viscous_map(struct updated *updated, struct iteration *work)
{
    evaluate(updated, work, work->vector, NULL);
}

/* Largest growth of the norm over the last steps. */
static double iterate(struct updated *updated, struct iteration *work,
                      void (*map)(struct updated *updated, struct iteration *work))
{
    const size_t unknowns = updated->model.unknowns;
    uint64_t seed = 2016;
    for (size_t i = 0; i < unknowns; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        work->vector[i] = (double)(seed >> 11) * 0x1p-52 - 1;
    }
    double growth = 0, before = norm(work->vector, unknowns);
    for (int k = 0; k < STEPS; k++) {
        for (size_t i = 0; i < unknowns; i++)
            work->vector[i] /= before;
        map(updated, work);
        memcpy(work->vector, work->dydt + unknowns, unknowns * sizeof *work->vector);
        before = norm(work->vector, unknowns);
        if (!(before > 0)) return 0;
        if (k >= STEPS - TAIL) growth = fmax(growth, before);
    }
    return growth;
}

selas_status updated_spectrum(struct model *model, double *omega, double *viscous, struct messages *messages)
{
    struct updated *updated = updated_of(model);
    struct iteration work = {.vector = array_new(model->state_size, sizeof(double)),
                             .y = array_new(model->state_size, sizeof(double)),
                             .dydt = array_new(model->state_size, sizeof(double))};
    const bool room = work.vector != NULL && work.y != NULL && work.dydt != NULL;
    if (room) {
        const unsigned long evaluations = model->evaluations;
        const double alpha = updated->alpha, beta = updated->beta;
        const bool repulsive = updated->repulsive;
        updated->repulsive = false;
        updated->alpha = updated->beta = 0;
        *omega = sqrt(iterate(updated, &work, wave_map));
        updated->alpha = alpha;
        *viscous = alpha > 0 ? iterate(updated, &work, viscous_map) : 0;
        updated->beta = beta;
        updated->repulsive = repulsive;
        model->evaluations = evaluations;
    }
    array_free(work.vector);
    array_free(work.y);
    array_free(work.dydt);
    return room ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory to measure the spectrum");
}
