/* Plane waves as they arrive at receivers, exact, and what a lattice makes of them
 * (doc/verification/accuracy.md, section 5). */
#include "accuracy/arrivals.h"
#include "base/fft_room.h"
#include "base/memory.h"
#include "exact/plane_wave.h"

#include <fftw3.h>
#include <math.h>

enum { ROWS = ARRIVAL_ROWS };
static const double LONGER = 1.25; /* of the end time: the rest fades out */

/* Velocities of all receivers (component that moves most: the same for all) with all speeds times `factor` at
 * the same impedances. */
static selas_status find_velocities(const struct scene *scene, double factor, double *velocity,
                                    struct messages *messages)
{
    struct scene changed = *scene;
    struct exact *exact = NULL;
    changed.end_time *= LONGER;
    changed.material = array_new(scene->materials, sizeof *changed.material);
    double *time = array_new(ROWS, sizeof *time), *value = array_new((size_t)6 * ROWS, sizeof *value);
    selas_status status = SELAS_NO_MEMORY;
    if (changed.material == NULL || time == NULL || value == NULL) {
        fail(messages, status, "no memory for scene%%accuracy");
    } else {
        for (size_t m = 0; m < scene->materials; m++) {
            changed.material[m] = scene->material[m];
            changed.material[m].p_speed *= factor;
            changed.material[m].s_speed *= factor;
            changed.material[m].density /= factor;
        }
        for (int i = 0; i < ROWS; i++)
            time[i] = changed.end_time * (i + 1) / (ROWS + 1);
        status = exact_plane_wave.create(&changed, &exact, messages);
    }
    for (size_t k = 0; k < scene->receivers && status == SELAS_OK; k++)
        if (plane_wave_until(exact, scene->receiver[k].position) < .99 * scene->end_time)
            status =
                fail(messages, SELAS_BAD_SCENE,
                     "scene%%accuracy: faces beside the wave disturb it at receiver '%s' before end_time; "
                     "give them a kind that lets it pass (rollers beside a P wave), or give body%%spacing",
                     scene->receiver[k].name);
    for (size_t k = 0; k < scene->receivers && status == SELAS_OK; k++) {
        status = exact_plane_wave.history(exact, scene->receiver[k].position, ROWS, time, value, messages);
        double most[3] = {0};
        for (int i = 0; i < 3 * ROWS; i++)
            most[i % 3] += value[6 * (i / 3) + 3 + i % 3] * value[6 * (i / 3) + 3 + i % 3];
        const int c = most[0] >= most[1] && most[0] >= most[2] ? 0 : most[1] >= most[2] ? 1 : 2;
        for (int i = 0; i < ROWS; i++)
            velocity[k * ROWS + (size_t)i] = value[6 * i + 3 + c];
    }
    exact_free(&exact);
    array_free(changed.material);
    array_free(time);
    array_free(value);
    return status;
}

/* Sine transform in place; twice it is 2 (ROWS + 1) times the identity. */
static bool transform(double *value)
{
    fftw_plan plan = NULL;
    if (!fft_room(ROWS)) return false;
#pragma omp critical(selas_fftw_planner)
    plan = fftw_plan_r2r_1d(ROWS, value, value, FFTW_RODFT00, FFTW_ESTIMATE);
    if (plan == NULL) return false;
    fftw_execute(plan);
#pragma omp critical(selas_fftw_planner)
    fftw_destroy_plan(plan);
    return true;
}

/* The last row of the scene's own time. */
static int last_row(void)
{
    return (int)((ROWS + 1) / LONGER) - 1;
}

static void fade(double *value)
{
    const int last = last_row();
    for (int i = last + 1; i < ROWS; i++)
        value[i] *= .5 * (1 + cos(M_PI * (double)(i - last) / (ROWS - last)));
}

/* From velocities at c (1 - STEP), c and c (1 + STEP): q, mean times, spectra. STEP moves an arrival by some
 * rows, so that a jump of v becomes a pulse of q of the right area. */
static const double STEP = 1e-3;
static void set_arrivals(const struct scene *scene, const double *slower, const double *faster,
                         struct arrivals *place)
{
    double moved = 0, rate = 0;
    const enum initial_kind kind = scene->initial.kind; /* these velocities are proportional to c as such */
    const double amplitude = kind == INITIAL_PLANE_WAVE || kind == INITIAL_GAUSSIAN ? 1 : 0;
    const double step = place->time_step = LONGER * scene->end_time / (ROWS + 1);
    const double *velocity = place->velocity;
    for (int i = 0; i < ROWS; i++) {
        place->change[i] = (faster[i] - slower[i]) / (2 * STEP) - amplitude * velocity[i];
        place->spectrum[i] = velocity[i];
        place->largest = fmax(place->largest, fabs(velocity[i]));
        if (i > last_row() || i + 1 == ROWS) continue;
        const double square = velocity[i] * velocity[i], slope = (velocity[i + 1] - velocity[i]) / step;
        place->whole += square;
        place->middle += square * (i + 1) * step;
        moved += place->change[i] * place->change[i];
        rate += slope * slope;
    }
    place->travel = rate > 0 ? sqrt(moved / rate) : 0;
    if (place->whole > 0) place->middle /= place->whole;
    fade(place->change);
    fade(place->spectrum);
    transform(place->change);
    transform(place->spectrum);
}

selas_status arrivals_create(const struct scene *scene, struct arrivals **arrivals, struct messages *messages)
{
    enum { HISTORIES = 5 };
    const size_t n = scene->receivers * ROWS;
    double *velocity = array_new(HISTORIES * n, sizeof *velocity);
    struct arrivals *place = *arrivals = array_new(scene->receivers, sizeof *place);
    if (velocity == NULL || place == NULL) {
        array_free(velocity);
        return fail(messages, SELAS_NO_MEMORY, "no memory for scene%%accuracy");
    }
    double *slower = velocity + n, *faster = velocity + 2 * n;
    place->velocity = velocity;
    selas_status status = find_velocities(scene, 1, velocity, messages);
    if (status == SELAS_OK) status = find_velocities(scene, 1 - STEP, slower, messages);
    if (status == SELAS_OK) status = find_velocities(scene, 1 + STEP, faster, messages);
    for (size_t k = 0; k < scene->receivers && status == SELAS_OK; k++) {
        place[k].velocity = velocity + k * ROWS;
        place[k].change = velocity + 3 * n + k * ROWS;
        place[k].spectrum = velocity + 4 * n + k * ROWS;
        body_from_deck(&scene->body, scene->receiver[k].position, place[k].position);
        set_arrivals(scene, slower + k * ROWS, faster + k * ROWS, &place[k]);
    }
    return status;
}

void arrivals_free(struct arrivals **arrivals)
{
    if (*arrivals != NULL) array_free((*arrivals)->velocity);
    array_free(*arrivals);
    *arrivals = NULL;
}

double arrivals_error(const struct lattice_wave *wave, const struct arrivals *place, double spacing,
                      const double *speed, double *work)
{
    double *local = work + ROWS, error = 0;
    if (!(place->whole > 0)) return 0;
    for (int j = 0; j < ROWS; j++) {
        const double omega = M_PI * (j + 1) / ((ROWS + 1) * place->time_step);
        const double most = place->travel > 0 ? M_SQRT2 / (omega * place->travel) : 1;
        const double here = lattice_local_error(wave, spacing, omega, place->position);
        const double back = (place->damped ? lattice_damper_error(wave, spacing, omega) : 0) +
                            place->held * lattice_held_error(wave, spacing, omega);
        work[j] = place->change[j] * fmin(fmax(speed[j], -most), most) / (2 * (ROWS + 1));
        local[j] = place->spectrum[j] * fmin(1, hypot(here, back)) / (2 * (ROWS + 1));
    }
    transform(work);
    transform(local);
    for (int i = 0; i <= last_row(); i++)
        error += work[i] * work[i] + local[i] * local[i];
    return sqrt(error / place->whole);
}
