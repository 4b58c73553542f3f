/* Amplitudes of loads and motions of faces: from histories, warped histories or a host. */
#include "stepping/driver.h"

#include "base/memory.h"
#include "stepping/time_dispersion.h"

#include <limits.h>
#include <string.h>

static const unsigned long NO_STEP = ULONG_MAX;

/* Histories begin at t = 0 and are 0 before; at t = 0 itself they give the mean of both sides. A body at rest
 * is driven by what comes after: twice that. */
static double after_start(double value, bool at_start)
{
    return at_start ? 2.0 * value : value;
}

static size_t row_width(const struct driver *driver)
{
    return driver->scene->loads + FACES;
}

selas_status driver_create(struct driver *driver, const struct scene *scene, double dt,
                           struct messages *messages)
{
    *driver = (struct driver){.scene = scene, .dt = dt};
    for (size_t face = 0; face < FACES; face++)
        driver->moves = driver->moves || boundary_moves(&scene->boundary[face]);
    driver->row = array_new(DRIVER_ROWS * row_width(driver), sizeof *driver->row);
    driver->last = array_new(scene->loads + 3 * FACES, sizeof *driver->last);
    if (driver->row == NULL || driver->last == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the amplitudes of %zu loads", scene->loads);
    driver_changed(driver, 0);
    return SELAS_OK;
}

void driver_free(struct driver *driver)
{
    array_free(driver->warped);
    array_free(driver->row);
    array_free(driver->last);
    *driver = (struct driver){0};
}

/* The rows that there are stay as they are: a run that goes on from a checkpoint sees the same ones. */
static void take_warped(struct driver *driver, unsigned long rows, double *warped)
{
    if (driver->warped != NULL)
        memcpy(warped, driver->warped, driver->warped_rows * row_width(driver) * sizeof *warped);
    array_free(driver->warped);
    driver->warped = warped;
    driver->warped_rows = rows;
}

selas_status driver_warp(struct driver *driver, unsigned long rows, struct messages *messages)
{
    const struct scene *scene = driver->scene;
    const size_t loads = scene->loads, width = row_width(driver);
    selas_status status = SELAS_OK;
    double *warped = array_new(rows * width, sizeof *warped);
    if (warped == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for warped histories of %lu steps", rows);
    for (size_t k = 0; k < loads && status == SELAS_OK; k++) {
        status =
            time_dispersion_warp(&scene->load[k].history, 0, driver->dt, rows, width, warped + k, messages);
        warped[k] = after_start(warped[k], true);
    }
    for (size_t face = 0; face < FACES && status == SELAS_OK; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        if (!boundary_moves(boundary)) continue;
        status = time_dispersion_warp(&boundary->history, boundary_meaning(boundary)->motion, driver->dt,
                                      rows, width, warped + loads + face, messages);
        warped[loads + face] = 0.0;
    }
    if (status == SELAS_OK)
        take_warped(driver, rows, warped);
    else
        array_free(warped);
    return status;
}

bool driver_reaches(const struct driver *driver, unsigned long step)
{
    return driver->warped == NULL || step + 1 < driver->warped_rows;
}

selas_status driver_reach(struct driver *driver, unsigned long step, struct messages *messages)
{
    selas_status status = SELAS_OK;
    while (!driver_reaches(driver, step) && status == SELAS_OK)
        status = driver_warp(driver, 2 * driver->warped_rows, messages);
    return status;
}

/* What histories and, if asked, the host give at `time`. */
static void fill(const struct driver *driver, double time, bool ask, double *row)
{
    const struct scene *scene = driver->scene;
    const size_t loads = scene->loads;
    for (size_t k = 0; k < loads; k++)
        row[k] = after_start(history_value(&scene->load[k].history, time, 0), time == 0.0);
    for (size_t face = 0; face < FACES; face++)
        row[loads + face] = time > 0.0 ? boundary_displacement(&scene->boundary[face], time, 0) : 0.0;
    if (ask && driver->host != NULL) driver->host->at(driver->host->context, time, row, row + loads);
}

/* The row of step n. Faces stand where they stand at step 0: a jump at t = 0 becomes the first step. */
static const double *row_at(struct driver *driver, unsigned long n)
{
    const size_t width = row_width(driver);
    if (driver->warped != NULL) /* the last one to steps that are only timed, beyond those reached */
        return driver->warped + (n < driver->warped_rows ? n : driver->warped_rows - 1) * width;
    double *row = driver->row + n % DRIVER_ROWS * width;
    if (driver->step[n % DRIVER_ROWS] == n) return row;
    fill(driver, (double)n * driver->dt, true, row);
    if (n == 0) memset(row + driver->scene->loads, 0, FACES * sizeof *row);
    driver->step[n % DRIVER_ROWS] = n;
    return row;
}

void driver_changed(struct driver *driver, unsigned long step)
{
    for (int i = 0; i < DRIVER_ROWS; i++)
        if (driver->step[i] >= step) driver->step[i] = NO_STEP;
}

struct drive driver_last(const struct driver *driver, double time)
{
    const double *motion = driver->last + driver->scene->loads;
    return (struct drive){.time = time,
                          .load = driver->last,
                          .displacement = motion,
                          .velocity = motion + FACES,
                          .motion = motion + 2 * FACES};
}

/* Displacement of a face, velocity and acceleration from displacements h apart. */
static void set_motion(double *motion, double before, double now, double after, double h)
{
    motion[0] = now;
    motion[FACES] = (after - before) / (2.0 * h);
    motion[2 * FACES] = (after - 2.0 * now + before) / (h * h);
}

static bool host_moves(const struct driver *driver)
{
    bool moves = false;
    for (size_t face = 0; face < FACES; face++)
        moves = moves || driver->scene->boundary[face].driven != BY_HISTORY;
    return moves;
}

/* A host's displacements have no derivatives: where there is a host, those of all faces are differences. */
struct drive driver_at(struct driver *driver, double time)
{
    const struct scene *scene = driver->scene;
    const size_t loads = scene->loads, width = row_width(driver);
    const double h = 0.5 * driver->dt;
    double *const before = driver->row, *const now = before + width, *const after = now + width;
    memset(before, 0, 3 * width * sizeof *before);
    driver_changed(driver, 0); /* no rows of steps */
    if (driver->host != NULL && time >= h) fill(driver, time - h, host_moves(driver), before);
    fill(driver, time, true, now);
    if (driver->host != NULL) fill(driver, time + h, host_moves(driver), after);
    memcpy(driver->last, now, loads * sizeof *now);
    for (size_t face = 0; face < FACES; face++) {
        double *motion = driver->last + loads + face;
        if (driver->host != NULL)
            set_motion(motion, before[loads + face], now[loads + face], after[loads + face], h);
        else
            for (int derivative = 0; derivative <= 2; derivative++)
                motion[derivative * FACES] =
                    after_start(boundary_displacement(&scene->boundary[face], time, derivative),
                                time == 0.0 && derivative > 0);
    }
    return driver_last(driver, time);
}

/* Differences at step 0 see the histories continued evenly to t < 0: the scheme's first step is u(1) = u(0) +
 * dt v(0) + dt^2/2 a(0), so a(0) = 2 g(1) / dt^2 takes a face at rest to g(1). */
struct drive driver_at_step(struct driver *driver, unsigned long n, enum driver_terms terms)
{
    const struct scene *scene = driver->scene;
    const size_t loads = scene->loads;
    const bool differences = terms != DRIVER_PLAIN || driver->moves;
    const double *before = differences && n > 0 ? row_at(driver, n - 1) : NULL; /* in the order of time */
    const double *now = row_at(driver, n);
    const double *after = differences ? row_at(driver, n + 1) : now;
    if (before == NULL) before = after;
    for (size_t k = 0; k < loads; k++) {
        driver->last[k] = terms == DRIVER_CORRECTION ? 0 : now[k];
        if (terms != DRIVER_PLAIN && scene->load[k].driven != HELD_BY_HOST)
            driver->last[k] += (after[k] - 2.0 * now[k] + before[k]) / 12.0;
    }
    for (size_t face = loads; face < loads + FACES && driver->moves; face++)
        set_motion(driver->last + face, before[face], now[face], after[face], driver->dt);
    if (terms == DRIVER_CORRECTION) memset(driver->last + loads, 0, 3 * FACES * sizeof *driver->last);
    return driver_last(driver, (double)n * driver->dt);
}
