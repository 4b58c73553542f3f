/* The two radii that limit the time step, each by power iteration about the body at rest, with the rates
 * themselves as the operator (they are linear there):
 *
 *   waves      v -> stress rate -> acceleration, viscosity and artificial stress off, and v -> acceleration
 *              by hourglass control: eigenvalues -omega^2
 *   viscosity  v -> acceleration of the viscous term alone, beta off, between all pairs: eigenvalue -radius
 *
 * Between all pairs: the viscosity acts on approaching pairs only, but at a compressive front all pairs
 * approach, and there its whole matrix rules small disturbances. (Half that radius keeps a run finite,
 * because a disturbance that grows soon makes pairs recede, but leaves noise behind the front.) A wave, on
 * the other hand, finds its pairs approaching half of the time: its mean damping is half of the quotient of
 * the full matrix. */
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
    evaluate(updated, work, work->vector, stress);
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

/* Damping rate of the motion in work->vector: v.Dv / v.v. */
static double quotient(struct updated *updated, struct iteration *work)
{
    const size_t unknowns = updated->model.unknowns;
    viscous_map(updated, work);
    double product = 0, square = 0;
    for (size_t i = 0; i < unknowns; i++) {
        product -= work->vector[i] * work->dydt[unknowns + i];
        square += work->vector[i] * work->vector[i];
    }
    return square > 0 ? product / square : 0;
}

static void measure(struct updated *updated, struct iteration *work, struct spectrum *spectrum)
{
    const double alpha = updated->alpha, beta = updated->beta;
    const bool repulsive = updated->repulsive;
    const unsigned long evaluations = updated->model.evaluations;
    updated->repulsive = false;
    updated->both_sides = true;
    updated->alpha = updated->beta = 0;
    updated->hourglass_of_velocity = true;
    spectrum->omega = sqrt(iterate(updated, work, wave_map));
    updated->hourglass_of_velocity = false;
    updated->alpha = alpha;
    if (alpha > 0) {
        spectrum->wave_damping = quotient(updated, work) / 2;
        spectrum->viscous = iterate(updated, work, viscous_map);
    }
    updated->beta = beta;
    updated->both_sides = false;
    updated->repulsive = repulsive;
    updated->model.evaluations = evaluations;
}

selas_status updated_spectrum(struct model *model, struct spectrum *spectrum, struct messages *messages)
{
    struct iteration work = {.vector = array_new(model->state_size, sizeof(double)),
                             .y = array_new(model->state_size, sizeof(double)),
                             .dydt = array_new(model->state_size, sizeof(double))};
    const bool room = work.vector != NULL && work.y != NULL && work.dydt != NULL;
    *spectrum = (struct spectrum){0};
    if (room) measure(updated_of(model), &work, spectrum);
    array_free(work.vector);
    array_free(work.y);
    array_free(work.dydt);
    return room ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory to measure the spectrum");
}
