/* What drives a model at one instant: amplitudes of loads and accelerations of prescribed faces. */
#include "stepping/stepping.h"

static bool is_motion(const struct boundary *boundary)
{
    return boundary->kind == BOUNDARY_VELOCITY || boundary->kind == BOUNDARY_DISPLACEMENT;
}

double motion_displacement(const struct boundary *boundary, double time, int derivative)
{
    if (!is_motion(boundary)) return 0.0;
    const int integrated = boundary->kind == BOUNDARY_VELOCITY ? derivative - 1 : derivative;
    return history_value(&boundary->history, time, integrated);
}

/* stepper->motion holds displacements, velocities and accelerations of the faces, one after the other. */
static struct drive drive_of(const struct stepper *stepper, double time)
{
    return (struct drive){.time = time,
                          .load = stepper->load,
                          .motion = stepper->motion + 2 * FACES,
                          .displacement = stepper->motion,
                          .velocity = stepper->motion + FACES};
}

void drive_at(struct stepper *stepper, double time, struct drive *drive)
{
    const struct scene *scene = stepper->model->scene;
    for (size_t k = 0; k < scene->loads; k++)
        stepper->load[k] = history_value(&scene->load[k].history, time, 0);
    for (size_t face = 0; face < FACES; face++)
        for (int derivative = 0; derivative <= 2; derivative++)
            stepper->motion[(size_t)derivative * FACES + face] =
                motion_displacement(&scene->boundary[face], time, derivative);
    *drive = drive_of(stepper, time);
}

/* Row of a warped table; before the start everything is at rest. */
static double warped(const double *table, size_t columns, size_t column, unsigned long rows, long n)
{
    if (n < 0) return 0.0;
    if ((unsigned long)n >= rows) n = (long)rows - 1;
    return table[(size_t)n * columns + column];
}

static double load_amplitude(const struct stepper *stepper, size_t k, long n)
{
    const struct scene *scene = stepper->model->scene;
    if (stepper->unwarp) return warped(stepper->warped_load, scene->loads, k, stepper->warped_rows, n);
    return history_value(&scene->load[k].history, (double)n * stepper->dt, 0);
}

static double motion_amplitude(const struct stepper *stepper, size_t face, long n)
{
    if (stepper->unwarp) return warped(stepper->warped_motion, FACES, face, stepper->warped_rows, n);
    return motion_displacement(&stepper->model->scene->boundary[face], (double)n * stepper->dt, 0);
}

void drive_at_step(struct stepper *stepper, unsigned long step, bool corrected, struct drive *drive)
{
    const struct scene *scene = stepper->model->scene;
    const long n = (long)step;
    for (size_t k = 0; k < scene->loads; k++) {
        double amplitude = load_amplitude(stepper, k, n);
        if (corrected)
            amplitude +=
                (load_amplitude(stepper, k, n + 1) - 2.0 * amplitude + load_amplitude(stepper, k, n - 1)) /
                12.0;
        stepper->load[k] = amplitude;
    }
    for (size_t face = 0; face < FACES; face++) {
        if (!is_motion(&scene->boundary[face])) continue;
        const double dt = stepper->dt;
        const double before = motion_amplitude(stepper, face, n - 1);
        const double now = motion_amplitude(stepper, face, n);
        const double after = motion_amplitude(stepper, face, n + 1);
        stepper->motion[face] = now;
        stepper->motion[FACES + face] = (after - before) / (2.0 * dt);
        stepper->motion[2 * FACES + face] = (after - 2.0 * now + before) / (dt * dt);
    }
    *drive = drive_of(stepper, (double)step * stepper->dt);
}
