/* Receivers: displacement, velocity and acceleration of every step, then the finished histories.
 *
 * Rows between steps by the cubic Hermite polynomial from u, v (displacement) and v, a (velocity): error
 * dt^4 / 384 times the fourth derivative. */
#include "record/parts.h"

#include "base/memory.h"
#include "parallel/ranks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static selas_status trace_room(struct trace *trace, size_t room, struct messages *messages)
{
    double **const part[3] = {&trace->u, &trace->v, &trace->a};
    for (size_t k = 0; k < 3; k++) {
        double *grown = array_new(3 * room, sizeof *grown);
        if (grown == NULL)
            return fail(messages, SELAS_NO_MEMORY, "no memory for a history of %zu steps", room);
        if (trace->rows > 0) memcpy(grown, *part[k], 3 * trace->rows * sizeof *grown);
        array_free(*part[k]);
        *part[k] = grown;
    }
    trace->room = room;
    return SELAS_OK;
}

selas_status trace_create(struct recorder *recorder, struct messages *messages)
{
    const struct scene *scene = recorder->scene;
    const double step = scene->output.history_step;
    size_t rows = 0; /* known to be possible before the run, not after it */
    if (step > 0.0 && row_count(scene->end_time, step, &rows, messages) != SELAS_OK) return SELAS_BAD_SCENE;
    double *finished = array_new(rows, (6 * scene->receivers + 1) * sizeof *finished);
    array_free(finished); /* taken at the end: is it to be had at all? */
    if (finished == NULL)
        return fail(messages, SELAS_NO_MEMORY,
                    "no memory for %zu rows of %zu receivers (output%%history_step = %g)", rows,
                    scene->receivers, step);
    const size_t expected = recorder->stepper->steps + recorder->stepper->extra + 2;
    recorder->trace = array_new(scene->receivers, sizeof *recorder->trace);
    if (recorder->trace == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu receivers", scene->receivers);
    for (size_t r = 0; r < scene->receivers; r++) {
        struct trace *trace = &recorder->trace[r];
        trace->probe.fields = 1U << SELAS_DISPLACEMENT | 1U << SELAS_VELOCITY | 1U << SELAS_ACCELERATION;
        selas_status status = recorder->model->core->probe(recorder->model, scene->receiver[r].position,
                                                           &trace->probe, messages);
        if (status == SELAS_OK) status = trace_room(trace, expected, messages);
        if (status != SELAS_OK) return status;
    }
    return SELAS_OK;
}

static bool three_finite(const double *value)
{
    return isfinite(value[0]) && isfinite(value[1]) && isfinite(value[2]);
}

selas_status trace_observe(struct recorder *recorder, const struct state *state, struct messages *messages)
{
    struct model *model = recorder->model;
    for (size_t r = 0; r < recorder->scene->receivers; r++) {
        struct trace *trace = &recorder->trace[r];
        if (trace->rows == trace->room) {
            const selas_status status = trace_room(trace, 2 * trace->room, messages);
            if (status != SELAS_OK) return status;
        }
        static const selas_field field[3] = {SELAS_DISPLACEMENT, SELAS_VELOCITY, SELAS_ACCELERATION};
        double *const part[3] = {trace->u, trace->v, trace->a};
        bool finite = true;
        const bool here = trace->probe.holder == ranks_me(recorder->scene->ranks);
        for (size_t k = 0; here && k < 3; k++) {
            double value[6] = {0};
            model_observe(model, &trace->probe, field[k], state->y, state->a, value);
            memcpy(part[k] + 3 * trace->rows, value, 3 * sizeof *value);
            finite = finite && three_finite(value);
        }
        trace->rows++;
        if (!finite)
            recorder->watch.next = (double)state->step; /* the watch looks at the whole state and tells */
    }
    return SELAS_OK;
}

selas_status trace_reserve(struct recorder *recorder, size_t rows, struct messages *messages)
{
    for (size_t r = 0; r < recorder->scene->receivers; r++) {
        if (recorder->trace[r].room >= rows) continue;
        const selas_status status = trace_room(&recorder->trace[r], rows, messages);
        if (status != SELAS_OK) return status;
    }
    return SELAS_OK;
}

void trace_forget(struct recorder *recorder)
{
    for (size_t r = 0; r < recorder->scene->receivers; r++)
        if (recorder->trace[r].rows > 0) recorder->trace[r].rows--;
}

selas_status row_count(double end, double step, size_t *rows, struct messages *messages)
{
    const double count = floor(end / step * (1.0 + 1e-12) + 1e-9) + 1.0;
    if (!(count <= 1e9))
        return fail(messages, SELAS_BAD_SCENE, "output%%history_step = %g asks for %.3g rows", step, count);
    *rows = (size_t)count;
    return SELAS_OK;
}

/* Times of the finished rows: 0, step, 2 step, ... up to end_time; with step 0 those of the steps. */
static selas_status make_times(struct recorder *recorder, struct messages *messages)
{
    const struct scene *scene = recorder->scene;
    const double step = scene->output.history_step > 0.0 ? scene->output.history_step : recorder->stepper->dt;
    const selas_status status =
        row_count(fmin(scene->end_time, recorder->last_time), step, &recorder->rows, messages);
    if (status != SELAS_OK) return status;
    recorder->time = array_new(recorder->rows, sizeof *recorder->time);
    if (recorder->time == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu rows", recorder->rows);
    for (size_t i = 0; i < recorder->rows; i++)
        recorder->time[i] = (double)i * step;
    return SELAS_OK;
}

/* Cubic Hermite polynomial on [0, dt] at s dt, 0 <= s <= 1, from values and slopes at both ends. */
static double hermite(double s, double dt, double value0, double slope0, double value1, double slope1)
{
    const double r = 1.0 - s;
    return r * r * (1.0 + 2.0 * s) * value0 + s * s * (1.0 + 2.0 * r) * value1 +
           s * r * dt * (r * slope0 - s * slope1);
}

static void make_rows(const struct recorder *recorder, const struct trace *trace)
{
    const double dt = recorder->stepper->dt;
    for (size_t i = 0; i < recorder->rows; i++) {
        const double place = recorder->time[i] / dt;
        size_t low = (size_t)place;
        if (trace->rows > 0 && low > trace->rows - 1) low = trace->rows - 1;
        double s = place - (double)low;
        if (s > 1.0 - 1e-9 && low + 1 < trace->rows) { /* a row on a step is the step's own value */
            low++;
            s = 0.0;
        }
        const size_t high = low + 1 < trace->rows ? low + 1 : low;
        if (s < 1e-9) s = 0.0;
        for (size_t c = 0; c < 3; c++) {
            const size_t p = 3 * low + c, q = 3 * high + c;
            trace->value[6 * i + c] =
                s > 0.0 ? hermite(s, dt, trace->u[p], trace->v[p], trace->u[q], trace->v[q]) : trace->u[p];
            trace->value[6 * i + 3 + c] =
                s > 0.0 ? hermite(s, dt, trace->v[p], trace->a[p], trace->v[q], trace->a[q]) : trace->v[p];
        }
    }
}

static selas_status filter_trace(const struct recorder *recorder, const struct trace *trace,
                                 struct messages *messages)
{
    const double cutoff = recorder->scene->output.low_pass;
    const bool from_rest = recorder->scene->initial.kind == INITIAL_REST;
    double *const part[3] = {trace->u, trace->v, trace->a};
    selas_status status = SELAS_OK;
    for (size_t k = 0; k < 3 && status == SELAS_OK; k++)
        status = low_pass(recorder->stepper->dt, cutoff, from_rest, trace->rows, 3, part[k], messages);
    return status;
}

/* A trace of the same rows as another, in memory of its own: what every step showed stays as it is, for a
 * checkpoint. */
static selas_status copy_trace(const struct trace *trace, struct trace *copy, struct messages *messages)
{
    *copy = (struct trace){.value = trace->value};
    const selas_status status = trace_room(copy, trace->rows, messages);
    if (status != SELAS_OK || copy->u == NULL || copy->v == NULL || copy->a == NULL) return status;
    copy->rows = trace->rows;
    memcpy(copy->u, trace->u, 3 * trace->rows * sizeof *copy->u);
    memcpy(copy->v, trace->v, 3 * trace->rows * sizeof *copy->v);
    memcpy(copy->a, trace->a, 3 * trace->rows * sizeof *copy->a);
    return SELAS_OK;
}

static selas_status finish_one(const struct recorder *recorder, struct trace *trace,
                               struct messages *messages)
{
    const struct stepper *stepper = recorder->stepper;
    if (trace->value == NULL) trace->value = array_new(6 * recorder->rows, sizeof *trace->value);
    if (trace->value == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu rows", recorder->rows);
    struct trace copy;
    selas_status status = copy_trace(trace, &copy, messages);
    if (status == SELAS_OK && stepper->scheme->finish != NULL)
        status = stepper->scheme->finish(stepper, copy.rows, copy.u, copy.v, copy.a, messages);
    if (status == SELAS_OK && recorder->scene->output.low_pass > 0.0)
        status = filter_trace(recorder, &copy, messages);
    if (status == SELAS_OK) make_rows(recorder, &copy);
    array_free(copy.u);
    array_free(copy.v);
    array_free(copy.a);
    return status;
}

void trace_gather(struct recorder *recorder)
{
    struct ranks *ranks = recorder->scene->ranks;
    for (size_t r = 0; r < recorder->scene->receivers; r++) {
        const struct trace *trace = &recorder->trace[r];
        double *const part[3] = {trace->u, trace->v, trace->a};
        for (size_t k = 0; k < 3; k++)
            ranks_fetch(ranks, trace->probe.holder, part[k], 3 * trace->rows * sizeof *part[k]);
    }
}

selas_status trace_finish(struct recorder *recorder, struct messages *messages)
{
    selas_status status = make_times(recorder, messages);
    for (size_t r = 0; r < recorder->scene->receivers && status == SELAS_OK; r++)
        status = finish_one(recorder, &recorder->trace[r], messages);
    return status;
}

void trace_unfinish(struct recorder *recorder)
{
    for (size_t r = 0; r < recorder->scene->receivers; r++) {
        array_free(recorder->trace[r].value);
        recorder->trace[r].value = NULL;
    }
    array_free(recorder->time);
    recorder->time = NULL;
    recorder->rows = 0;
}

void trace_free(struct recorder *recorder)
{
    for (size_t r = 0; recorder->trace != NULL && r < recorder->scene->receivers; r++) {
        struct trace *trace = &recorder->trace[r];
        probe_free(&trace->probe);
        array_free(trace->u);
        array_free(trace->v);
        array_free(trace->a);
        array_free(trace->value);
    }
    array_free(recorder->trace);
}
