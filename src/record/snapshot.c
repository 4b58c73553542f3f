/* Snapshots: which points, at which steps. A snapshot shows the step nearest to its time, as computed, and
 * says that step's time. */
#include "record/parts.h"

#include "base/memory.h"
#include "parallel/ranks.h"
#include "scene/topography.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

static bool in_region(const struct snapshot *snapshot, const double *x)
{
    for (int axis = 0; axis < 3; axis++) {
        const double slack =
            1e-9 * (fabs(snapshot->region_low[axis]) + fabs(snapshot->region_high[axis]) + 1e-30);
        if (x[axis] < snapshot->region_low[axis] - slack || x[axis] > snapshot->region_high[axis] + slack)
            return false;
    }
    return true;
}

/* Points per axis of the lattice, 1 where it has no extent. */
static void lattice_of(const struct model *model, size_t grid[3])
{
    for (int axis = 0; axis < 3; axis++)
        grid[axis] = model->grid[axis] > 0 ? model->grid[axis] : 1;
    if (model->grid[0] == 0 || grid[0] * grid[1] * grid[2] != model->points) grid[0] = grid[1] = grid[2] = 0;
}

size_t snapshot_point(const struct model *model, const struct snapshot_record *record, size_t k)
{
    if (record->snapshot->whole) return k;
    if (record->index != NULL) return record->index[k];
    const size_t *grid = record->grid, *corner = record->corner, row = k / grid[0];
    const size_t plane = corner[2] + row / grid[1], line = corner[1] + row % grid[1];
    return (plane * model->grid[1] + line) * model->grid[0] + corner[0] + k % grid[0];
}

/* Where the k-th point of a record is. */
static void place_of(const struct model *model, const struct snapshot_record *record, size_t k,
                     double position[3])
{
    model_position(model, snapshot_point(model, record, k), position);
}

/* A lattice along the deck's axes with equal spacings can be told by origin and spacings alone. */
static void look_regular(const struct model *model, struct snapshot_record *record)
{
    const size_t *grid = record->grid;
    if (grid[0] == 0) return;
    const size_t stride[3] = {1, grid[0], grid[0] * grid[1]};
    double size = 0.0;
    place_of(model, record, 0, record->origin);
    for (int axis = 0; axis < 3; axis++) {
        record->step[axis] = 0.0;
        if (grid[axis] < 2) continue;
        double last[3];
        place_of(model, record, (grid[axis] - 1) * stride[axis], last);
        record->step[axis] = (last[axis] - record->origin[axis]) / (double)(grid[axis] - 1);
        size = fmax(size, fabs(record->step[axis]));
    }
    record->regular = true;
    for (size_t k = 0; k < record->points && record->regular; k++) {
        double x[3];
        place_of(model, record, k, x);
        const size_t at[3] = {k % grid[0], k / grid[0] % grid[1], k / stride[2]};
        for (size_t axis = 0; axis < 3; axis++)
            if (!(fabs(x[axis] - record->origin[axis] - (double)at[axis] * record->step[axis]) <=
                  1e-6 * size))
                record->regular = false;
    }
}

/* Has one rank all of these points, rows over the first axis? */
static bool of_one_rank(const struct model *model, size_t from, size_t points, size_t row)
{
    const int holder = model->core->holder(model, from);
    for (size_t at = from + row; at < from + points; at += row)
        if (model->core->holder(model, at) != holder) return false;
    return true;
}

/* Any rank can show all points. */
static size_t even_piece(const struct model *model, size_t from, int *holder)
{
    const size_t ranks = (size_t)ranks_count(model->scene->ranks), share = model->points / ranks + 1;
    *holder = (int)(from / share);
    return from + share < model->points ? from + share : model->points;
}

size_t snapshot_piece(const struct model *model, size_t from, int *holder)
{
    enum { LEAST = 1 << 17, PIECES = 16 };
    if (model->core->holder == NULL) return even_piece(model, from, holder);
    const int ranks = ranks_count(model->scene->ranks), dimension = model->scene->dimension;
    const size_t share = model->points / (size_t)ranks / PIECES, most = share > LEAST ? share : LEAST;
    const size_t layers = model->grid[dimension - 1];
    const size_t plane = model->points / (layers > 0 ? layers : model->points);
    const size_t row = ranks > 1 && dimension == 3 && layers > 0 ? model->grid[0] : plane;
    const bool whole = from % plane == 0 && of_one_rank(model, from, plane, row);
    const size_t piece = whole ? plane : row, stop = whole ? model->points : (from / plane + 1) * plane;
    size_t end = from + piece;
    *holder = model->core->holder(model, from);
    while (end < stop && end + piece - from <= most && of_one_rank(model, end, piece, row) &&
           model->core->holder(model, end) == *holder)
        end += piece;
    return end;
}

/* The points in a region: how many, and the box of a lattice about them. */
struct found {
    size_t points, low[3], high[3];
};

/* Into `index` too if it is not NULL. */
static struct found look_region(const struct model *model, const struct snapshot *snapshot, size_t *index)
{
    struct found found = {.low = {SIZE_MAX, SIZE_MAX, SIZE_MAX}};
    const size_t nx = model->grid[0] > 0 ? model->grid[0] : 1, ny = model->grid[1] > 0 ? model->grid[1] : 1;
    for (size_t i = 0; i < model->points; i++) {
        const size_t at[3] = {i % nx, i / nx % ny, i / (nx * ny)};
        double x[3];
        model_position(model, i, x);
        if (model->scene->body.topography != NULL) topography_to_lattice(model->scene->body.topography, x);
        if (!in_region(snapshot, x)) continue;
        if (index != NULL) index[found.points] = i;
        found.points++;
        for (int axis = 0; axis < 3; axis++) {
            found.low[axis] = at[axis] < found.low[axis] ? at[axis] : found.low[axis];
            found.high[axis] = at[axis] > found.high[axis] ? at[axis] : found.high[axis];
        }
    }
    return found;
}

/* Points of a lattice that are again a box of it need no list. */
static bool is_box(struct snapshot_record *record, const struct found *found)
{
    size_t part[3];
    for (int axis = 0; axis < 3; axis++)
        part[axis] = found->high[axis] - found->low[axis] + 1;
    const bool box = record->grid[0] > 0 && part[0] * part[1] * part[2] == found->points;
    for (int axis = 0; axis < 3; axis++) {
        record->grid[axis] = box ? part[axis] : 0;
        record->corner[axis] = found->low[axis];
    }
    return box;
}

static selas_status no_memory(const struct snapshot_record *record, struct messages *messages)
{
    return fail(messages, SELAS_NO_MEMORY, "no memory for snapshots of %zu points", record->points);
}

static selas_status choose(const struct model *model, size_t number, struct snapshot_record *record,
                           struct messages *messages)
{
    const struct found found = look_region(model, record->snapshot, NULL);
    record->points = found.points;
    if (record->points == 0)
        return fail(messages, SELAS_BAD_SCENE, "the region of snapshot group %zu holds no points",
                    number + 1);
    snprintf(record->position, sizeof record->position, "/points/region_%zu/position", number + 1);
    if (is_box(record, &found)) return SELAS_OK;
    record->index = array_new(record->points, sizeof *record->index);
    if (record->index == NULL) return no_memory(record, messages);
    look_region(model, record->snapshot, record->index);
    return SELAS_OK;
}

static selas_status create_one(const struct model *model, size_t number, struct snapshot_record *record,
                               struct messages *messages)
{
    const bool whole = record->snapshot->whole;
    record->points = model->points;
    snprintf(record->position, sizeof record->position, "/points/position");
    lattice_of(model, record->grid);
    const selas_status status = whole ? SELAS_OK : choose(model, number, record, messages);
    if (status != SELAS_OK) return status;
    int holder;
    for (size_t from = 0, end; from < model->points; from = end) {
        end = snapshot_piece(model, from, &holder);
        record->room = end - from > record->room ? end - from : record->room;
    }
    record->buffer = array_new(6 * record->room, sizeof *record->buffer);
    if (record->buffer == NULL) return no_memory(record, messages);
    look_regular(model, record);
    return SELAS_OK;
}

selas_status snapshot_create(struct recorder *recorder, struct messages *messages)
{
    const struct scene *scene = recorder->scene;
    recorder->snapshot = array_new(scene->snapshots, sizeof *recorder->snapshot);
    if (recorder->snapshot == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu groups of snapshots", scene->snapshots);
    selas_status status = SELAS_OK;
    for (size_t s = 0; s < scene->snapshots && status == SELAS_OK; s++) {
        recorder->snapshot[s].snapshot = &scene->snapshot[s];
        status = create_one(recorder->model, s, &recorder->snapshot[s], messages);
    }
    return status;
}

/* Time of the next snapshot of a group; INFINITY when there is none any more. */
static double next_time(const struct scene *scene, const struct snapshot_record *record)
{
    const struct snapshot *snapshot = record->snapshot;
    if (snapshot->every > 0.0) {
        const double time = (double)record->due * snapshot->every;
        return time <= scene->end_time * (1.0 + 1e-9) ? time : INFINITY;
    }
    return record->due < snapshot->times ? snapshot->time[record->due] : INFINITY;
}

/* Half a step later. */
static double until(const struct recorder *recorder, const struct state *state)
{
    return state->time + 0.5 * recorder->stepper->dt;
}

bool snapshot_due(const struct recorder *recorder, const struct state *state)
{
    for (size_t s = 0; recorder->recording && s < recorder->scene->snapshots; s++)
        if (next_time(recorder->scene, &recorder->snapshot[s]) < until(recorder, state)) return true;
    return recorder->entries > 0 && recorder->entry[recorder->entries - 1].time == state->time;
}

static selas_status keep_entry(struct recorder *recorder, size_t group, const struct state *state,
                               struct messages *messages)
{
    if (recorder->entries == recorder->entry_room) {
        const size_t room = 2 * recorder->entry_room + 16;
        struct snapshot_entry *grown = realloc(recorder->entry, room * sizeof *grown);
        if (grown == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the list of snapshots");
        recorder->entry = grown;
        recorder->entry_room = room;
    }
    recorder->entry[recorder->entries] = (struct snapshot_entry){group, recorder->entries, state->time};
    recorder->entries++;
    return SELAS_OK;
}

selas_status snapshot_observe(struct recorder *recorder, const struct state *state, struct messages *messages)
{
    selas_status status = SELAS_OK;
    for (size_t s = 0; s < recorder->scene->snapshots && status == SELAS_OK; s++) {
        struct snapshot_record *record = &recorder->snapshot[s];
        const double end = until(recorder, state);
        const size_t due = record->due;
        if (!(next_time(recorder->scene, record) < end)) continue;
        if (record->snapshot->every > 0.0) /* one snapshot a step, however many times fall into it */
            record->due = (size_t)fmin(floor(end / record->snapshot->every) + 1.0, 1e15);
        else
            while (next_time(recorder->scene, record) < end)
                record->due++;
        status = keep_entry(recorder, s, state, messages);
        if (status != SELAS_OK) break;
        status = run_file_snapshot(recorder, record, state, recorder->entries - 1, messages);
        if (status == SELAS_OK) continue;
        recorder->entries--; /* still due: a restart makes it */
        record->due = due;
    }
    return status;
}

selas_status snapshot_observe_again(struct recorder *recorder, const struct state *state,
                                    struct messages *messages)
{
    selas_status status = SELAS_OK;
    for (size_t k = recorder->entries;
         status == SELAS_OK && k-- > 0 && recorder->entry[k].time == state->time;)
        status =
            run_file_snapshot(recorder, &recorder->snapshot[recorder->entry[k].group], state, k, messages);
    return status;
}

void snapshot_free(struct recorder *recorder)
{
    for (size_t s = 0; recorder->snapshot != NULL && s < recorder->scene->snapshots; s++) {
        array_free(recorder->snapshot[s].index);
        array_free(recorder->snapshot[s].buffer);
    }
    array_free(recorder->snapshot);
}
