/* Ground that varies across one direction alone (see the header). */
#include "scene/ground_line.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Any directions at right angles to the last one. */
static void lay_basis(struct ground_line *line)
{
    const int m = line->dimension - 1;
    double(*basis)[3] = line->basis, square = 0;
    const double *normal = basis[m];
    if (m == 1) {
        basis[0][0] = normal[1];
        basis[0][1] = -normal[0];
        return;
    }
    int least = 0;
    for (int axis = 1; axis < 3; axis++)
        if (fabs(normal[axis]) < fabs(normal[least])) least = axis;
    for (int axis = 0; axis < 3; axis++) {
        basis[0][axis] = (axis == least) - normal[least] * normal[axis];
        square += basis[0][axis] * basis[0][axis];
    }
    for (int axis = 0; axis < 3; axis++)
        basis[0][axis] /= sqrt(square);
    for (int axis = 0; axis < 3; axis++) {
        const int next = (axis + 1) % 3, last = (axis + 2) % 3;
        basis[1][axis] = normal[next] * basis[0][last] - normal[last] * basis[0][next];
    }
}

bool ground_line_new(const struct scene *scene, const double origin[3], const double normal[3], double step,
                     double reach, struct ground_line *line)
{
    const int d = scene->dimension;
    const size_t half = (size_t)ceil(reach / step);
    *line =
        (struct ground_line){.dimension = d, .step = step, .from = -(double)half * step, .count = 2 * half};
    memcpy(line->origin, origin, (size_t)d * sizeof *origin);
    memcpy(line->basis[d - 1], normal, (size_t)d * sizeof *normal);
    lay_basis(line);
    line->here = ground_at(scene, line->origin);
    line->rock = array_new(line->count, sizeof *line->rock);
    for (size_t n = 0; line->rock != NULL && n < line->count; n++) {
        double place[3] = {0};
        for (int axis = 0; axis < d; axis++)
            place[axis] = origin[axis] + (line->from + ((double)n + .5) * step) * normal[axis];
        line->rock[n] = ground_at(scene, place);
    }
    return line->rock != NULL;
}

void ground_line_free(struct ground_line *line)
{
    array_free(line->rock);
    line->rock = NULL;
}

void ground_line_local(const struct ground_line *line, const double place[3], double local[3])
{
    for (int i = 0; i < line->dimension; i++) {
        local[i] = 0;
        for (int axis = 0; axis < line->dimension; axis++)
            local[i] += line->basis[i][axis] * (place[axis] - line->origin[axis]);
    }
}

size_t ground_line_step(const struct ground_line *line, double along, double *part)
{
    const double steps = (along - line->from) / line->step;
    const double found = fmin(fmax(floor(steps), 0), (double)line->count - 1);
    *part = steps - found;
    return (size_t)found;
}

/* An interface within half a step of the place may lie on its other side. */
const struct rock *ground_line_at(const struct ground_line *line, const double place[3])
{
    static const double here = 1e-6; /* steps */
    double local[3], part;
    ground_line_local(line, place, local);
    if (fabs(local[line->dimension - 1]) < here * line->step) return &line->here;
    return &line->rock[ground_line_step(line, local[line->dimension - 1], &part)];
}

/* Do two steps have one rock? */
static bool alike(const struct rock *one, const struct rock *other)
{
    return one->density == other->density && one->lambda == other->lambda && one->mu == other->mu;
}

size_t ground_line_jumps(const struct ground_line *line, const double place[3], int axis, double from,
                         double to, double *at)
{
    const int m = line->dimension - 1;
    const double rise = line->basis[m][axis];
    double start[3] = {place[0], place[1], place[2]}, local[3], part;
    size_t count = 0;
    if (rise == 0) return 0;
    start[axis] = from;
    ground_line_local(line, start, local);
    const double ends[2] = {local[m], local[m] + rise * (to - from)};
    const size_t first = ground_line_step(line, fmin(ends[0], ends[1]), &part),
                 last = ground_line_step(line, fmax(ends[0], ends[1]), &part);
    for (size_t n = first + 1; n <= last; n++) {
        const double x = from + (line->from + (double)n * line->step - ends[0]) / rise;
        if (!alike(&line->rock[n - 1], &line->rock[n]) && x > from && x < to) at[count++] = x;
    }
    return count;
}

size_t ground_line_jumps_at_most(const struct ground_line *line)
{
    size_t count = 0;
    for (size_t n = 1; n < line->count; n++)
        count += !alike(&line->rock[n - 1], &line->rock[n]);
    return count;
}
