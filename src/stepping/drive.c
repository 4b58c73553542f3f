/* What drives a model at one instant: amplitudes of loads and accelerations of prescribed faces. */
#include "stepping/stepping.h"

#include "base/memory.h"

#include <string.h>

/* Histories begin at t = 0 and are 0 before; at t = 0 itself they give the mean of both sides. A body at rest
 * is driven by what comes after: twice that. */
static double after_start(double value, bool at_start)
{
    return at_start ? 2.0 * value : value;
}

/* stepper->motion holds displacements, velocities and accelerations of the faces, one after the other. */
struct drive drive_last(const struct stepper *stepper, double time)
{
    return (struct drive){.time = time,
                          .load = stepper->load,
                          .motion = stepper->motion + 2 * FACES,
                          .displacement = stepper->motion,
                          .velocity = stepper->motion + FACES};
}

/* --- A host in the histories' place --- */

static void deck_row(const struct stepper *stepper, double time, double *load, double *displacement)
{
    const struct scene *scene = stepper->model->scene;
    for (size_t k = 0; k < scene->loads; k++)
        load[k] = after_start(history_value(&scene->load[k].history, time, 0), time == 0.0);
    for (size_t face = 0; face < FACES; face++)
        displacement[face] = time > 0.0 ? boundary_displacement(&scene->boundary[face], time, 0) : 0.0;
}

/* Amplitudes at step n: loads, then displacements of the faces; before the start everything is at rest. */
static const double *host_row(struct stepper *stepper, long n)
{
    const size_t loads = stepper->model->scene->loads, width = loads + FACES;
    double *row = stepper->host_row + (size_t)(n & (HOST_ROWS - 1)) * width;
    if (stepper->host_step[n & (HOST_ROWS - 1)] == n) return row;
    memset(row, 0, width * sizeof *row);
    if (n >= 0) {
        const double time = (double)n * stepper->dt;
        deck_row(stepper, time, row, row + loads);
        stepper->host->at(stepper->host->context, time, row, row + loads);
    }
    stepper->host_step[n & (HOST_ROWS - 1)] = n;
    return row;
}

selas_status drive_by_host(struct stepper *stepper, const struct host_drive *host, struct messages *messages)
{
    if (stepper->model->single)
        return fail(messages, SELAS_UNSUPPORTED,
                    "loads and faces that a host drives need method%%precision = 'double'");
    stepper->host = host;
    stepper->host_row =
        array_new(HOST_ROWS * (stepper->model->scene->loads + FACES), sizeof *stepper->host_row);
    if (stepper->host_row == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the host's loads");
    for (int i = 0; i < HOST_ROWS; i++)
        stepper->host_step[i] = -2;
    return SELAS_OK;
}

void drive_changed(struct stepper *stepper, unsigned long step)
{
    for (int i = 0; i < HOST_ROWS; i++)
        if (stepper->host_step[i] >= (long)step) stepper->host_step[i] = -2;
}

void drive_again(struct stepper *stepper, struct state *state)
{
    drive_changed(stepper, state->step);
    if (stepper->scheme->again != NULL) stepper->scheme->again(stepper, state);
}

/* A host's displacements have no derivatives of their own: differences over half a step. */
static void host_at(struct stepper *stepper, double time)
{
    const size_t loads = stepper->model->scene->loads;
    const double h = 0.5 * stepper->dt;
    double *row = stepper->host_row;
    double *const at[3] = {row, row + loads + FACES, row + 2 * (loads + FACES)};
    for (int i = 0; i < 3; i++) {
        const double when = time + (double)(i - 1) * h;
        memset(at[i], 0, (loads + FACES) * sizeof *at[i]);
        if (when < 0.0) continue;
        deck_row(stepper, when, at[i], at[i] + loads);
        if (i == 1 || stepper->host->moves)
            stepper->host->at(stepper->host->context, when, at[i], at[i] + loads);
    }
    memcpy(stepper->load, at[1], loads * sizeof *stepper->load);
    for (size_t face = 0; face < FACES; face++) {
        const double before = at[0][loads + face], now = at[1][loads + face], after = at[2][loads + face];
        stepper->motion[face] = now;
        stepper->motion[FACES + face] = (after - before) / (2.0 * h);
        stepper->motion[2 * FACES + face] = (after - 2.0 * now + before) / (h * h);
    }
}

void drive_at(struct stepper *stepper, double time, struct drive *drive)
{
    const struct scene *scene = stepper->model->scene;
    for (size_t k = 0; k < scene->loads; k++)
        stepper->load[k] = after_start(history_value(&scene->load[k].history, time, 0), time == 0.0);
    for (size_t face = 0; face < FACES; face++)
        for (int derivative = 0; derivative <= 2; derivative++)
            stepper->motion[(size_t)derivative * FACES + face] =
                after_start(boundary_displacement(&scene->boundary[face], time, derivative),
                            time == 0.0 && derivative > 0);
    if (stepper->host != NULL) host_at(stepper, time);
    *drive = drive_last(stepper, time);
}

/* Row of a warped table; before the start everything is at rest. */
static double warped(const double *table, size_t columns, size_t column, unsigned long rows, long n)
{
    if (n < 0) return 0.0;
    if ((unsigned long)n >= rows) n = (long)rows - 1;
    return table[(size_t)n * columns + column];
}

static double load_amplitude(struct stepper *stepper, size_t k, long n)
{
    const struct scene *scene = stepper->model->scene;
    if (stepper->host != NULL) return host_row(stepper, n)[k];
    if (stepper->unwarp)
        return after_start(warped(stepper->warped_load, scene->loads, k, stepper->warped_rows, n), n == 0);
    return after_start(history_value(&scene->load[k].history, (double)n * stepper->dt, 0), n == 0);
}

static double motion_amplitude(struct stepper *stepper, size_t face, long n)
{
    if (n <= 0) return 0.0; /* the body stands where it stands: a jump at t = 0 becomes the first step */
    if (stepper->host != NULL) return host_row(stepper, n)[stepper->model->scene->loads + face];
    if (stepper->unwarp) return warped(stepper->warped_motion, FACES, face, stepper->warped_rows, n);
    return boundary_displacement(&stepper->model->scene->boundary[face], (double)n * stepper->dt, 0);
}

/* Differences at step 0 see the histories continued evenly to t < 0: the scheme's first step is u(1) = u(0) +
 * dt v(0) + dt^2/2 a(0), so a(0) = 2 g(1) / dt^2 takes a face at rest to g(1). */
void drive_at_step(struct stepper *stepper, unsigned long step, bool corrected, struct drive *drive)
{
    const struct scene *scene = stepper->model->scene;
    const long n = (long)step;
    for (size_t k = 0; k < scene->loads; k++) {
        double amplitude = load_amplitude(stepper, k, n);
        if (corrected && !(stepper->host != NULL && stepper->host->held[k]))
            amplitude += (load_amplitude(stepper, k, n + 1) - 2.0 * amplitude +
                          load_amplitude(stepper, k, n > 0 ? n - 1 : 1)) /
                         12.0;
        stepper->load[k] = amplitude;
    }
    for (size_t face = 0; face < FACES; face++) {
        if (!boundary_moves(&scene->boundary[face])) continue;
        const double dt = stepper->dt;
        const double before = motion_amplitude(stepper, face, n > 0 ? n - 1 : 1);
        const double now = motion_amplitude(stepper, face, n);
        const double after = motion_amplitude(stepper, face, n + 1);
        stepper->motion[face] = now;
        stepper->motion[FACES + face] = (after - before) / (2.0 * dt);
        stepper->motion[2 * FACES + face] = (after - 2.0 * now + before) / (dt * dt);
    }
    *drive = drive_last(stepper, (double)step * stepper->dt);
}
