/* Profiles: fields along a line at given times.
 *
 * A time between steps is interpolated by Lagrange's cubic through the four nearest steps (all of a run that has
 * fewer), for every field alike: error of the order dt^4 where the field is smooth in time. */
#include "record/parts.h"
#include "scene/units.h"

#include "base/memory.h"
#include "base/safe_file.h"
#include "parallel/ranks.h"

#include <math.h>
#include <stdlib.h>

enum { NODES = 4, LAST_FIELD = SELAS_ENERGY };

static size_t columns_of(unsigned fields)
{
    size_t columns = 0;
    for (int field = 0; field <= LAST_FIELD; field++)
        if ((fields >> field & 1U) != 0) columns += (size_t)field_components((selas_field)field);
    return columns;
}

static unsigned long last_step(const struct recorder *recorder)
{
    return recorder->stepper->steps + recorder->stepper->extra;
}

/* How many steps a time is interpolated from. */
static unsigned long nodes_of(const struct recorder *recorder)
{
    return last_step(recorder) < NODES ? last_step(recorder) + 1 : NODES;
}

/* Weights of the `nodes` steps from `first` on for time x (in steps). */
static void lagrange(double x, unsigned long first, unsigned long nodes, double *weight)
{
    for (unsigned long j = 0; j < nodes; j++) {
        weight[j] = 1.0;
        for (unsigned long k = 0; k < nodes; k++)
            if (k != j) weight[j] *= (x - (double)(first + k)) / ((double)j - (double)k);
    }
}

static void choose_steps(const struct recorder *recorder, struct profile_record *record)
{
    const unsigned long nodes = nodes_of(recorder), last_first = last_step(recorder) + 1 - nodes;
    for (size_t k = 0; k < record->profile->times; k++) {
        const double x = record->profile->time[k] / recorder->stepper->dt;
        const double first = fmax(floor(x + 1e-9) - 1.0, 0.0);
        record->first[k] = first < (double)last_first ? (unsigned long)first : last_first;
        lagrange(x, record->first[k], nodes, record->weight + NODES * k);
    }
}

static selas_status create_one(struct recorder *recorder, const struct profile *profile,
                               struct profile_record *record, struct messages *messages)
{
    const bool rounded = recorder->model->single && (profile->fields >> SELAS_STRESS & 1U) != 0;
    const unsigned fields = profile->fields | (rounded ? 1U << SELAS_DISPLACEMENT : 0);
    *record = (struct profile_record){.profile = profile, .fields = fields, .columns = columns_of(fields)};
    record->probe = array_new(profile->points, sizeof *record->probe);
    record->first = array_new(profile->times, sizeof *record->first);
    record->weight = array_new(NODES * profile->times, sizeof *record->weight);
    record->value = array_new(profile->times, profile->points * record->columns * sizeof *record->value);
    record->seen = array_new(profile->times, sizeof *record->seen);
    if (record->probe == NULL || record->first == NULL || record->weight == NULL || record->value == NULL ||
        record->seen == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the profile '%s'", profile->name);
    selas_status status = SELAS_OK;
    for (size_t i = 0; i < profile->points && status == SELAS_OK; i++) {
        double position[3];
        profile_position(profile, i, position);
        record->probe[i].fields = fields;
        status = recorder->model->core->probe(recorder->model, position, &record->probe[i], messages);
    }
    if (status == SELAS_OK) choose_steps(recorder, record);
    return status;
}

selas_status profile_create(struct recorder *recorder, struct messages *messages)
{
    const struct scene *scene = recorder->scene;
    recorder->profile = array_new(scene->profiles, sizeof *recorder->profile);
    if (recorder->profile == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu profiles", scene->profiles);
    selas_status status = SELAS_OK;
    for (size_t p = 0; p < scene->profiles && status == SELAS_OK; p++)
        status = create_one(recorder, &scene->profile[p], &recorder->profile[p], messages);
    return status;
}

static void add_point(struct model *model, const struct state *state, const struct profile_record *record,
                      size_t point, double weight, double *sum)
{
    for (int field = 0; field <= LAST_FIELD; field++) {
        if ((record->fields >> field & 1U) == 0) continue;
        double value[6] = {0};
        model_observe(model, &record->probe[point], (selas_field)field, state->y, state->a, value);
        const int components = field_components((selas_field)field);
        for (int c = 0; c < components; c++)
            sum[c] += weight * value[c];
        sum += components;
    }
}

static bool is_node(const struct recorder *recorder, const struct profile_record *record, size_t time,
                    unsigned long step)
{
    return step >= record->first[time] && step < record->first[time] + nodes_of(recorder);
}

bool profile_due(const struct recorder *recorder, unsigned long step)
{
    for (size_t p = 0; p < recorder->scene->profiles; p++)
        for (size_t k = 0; k < recorder->profile[p].profile->times; k++)
            if (is_node(recorder, &recorder->profile[p], k, step)) return true;
    return false;
}

/* Adds the state to the times that its step is one of, `sign` times: -1 takes away what was seen of it. */
static void add_state(struct recorder *recorder, const struct state *state, int sign)
{
    for (size_t p = 0; p < recorder->scene->profiles; p++) {
        struct profile_record *record = &recorder->profile[p];
        const size_t points = record->profile->points;
        for (size_t k = 0; k < record->profile->times; k++) {
            if (!is_node(recorder, record, k, state->step)) continue;
            const double weight = sign * record->weight[NODES * k + (state->step - record->first[k])];
            double *value = record->value + k * points * record->columns;
            const int me = ranks_me(recorder->scene->ranks);
            for (size_t i = 0; i < points && weight != 0.0; i++)
                if (record->probe[i].holder == me)
                    add_point(recorder->model, state, record, i, weight, value + i * record->columns);
            record->seen[k] = (unsigned char)(record->seen[k] + sign);
        }
    }
}

void profile_observe(struct recorder *recorder, const struct state *state)
{
    add_state(recorder, state, 1);
}

void profile_forget(struct recorder *recorder, const struct state *state)
{
    add_state(recorder, state, -1);
}

double profiles_largest(const struct recorder *recorder, selas_field field)
{
    double largest = 0.0;
    for (size_t p = 0; p < recorder->scene->profiles; p++) {
        const struct profile_record *record = &recorder->profile[p];
        const unsigned fields = record->fields, bit = 1U << field;
        const size_t before = columns_of(fields & (bit - 1)), past = before + columns_of(fields & bit);
        for (size_t i = 0; i < record->profile->points * record->profile->times; i++)
            for (size_t c = before; c < past; c++)
                largest = fmax(largest, fabs(record->value[i * record->columns + c]));
    }
    return largest;
}

void profile_gather(struct recorder *recorder)
{
    for (size_t p = 0; p < recorder->scene->profiles; p++) {
        const struct profile_record *record = &recorder->profile[p];
        const size_t points = record->profile->points, columns = record->columns;
        for (size_t i = 0; i < points * record->profile->times; i++)
            ranks_fetch(recorder->scene->ranks, record->probe[i % points].holder, record->value + i * columns,
                        columns * sizeof *record->value);
    }
}

static void write_header(FILE *out, const struct recorder *recorder, const struct profile *profile)
{
    const struct scene *scene = recorder->scene;
    fprintf(out, "# profile %s from %.17g %.17g %.17g to %.17g %.17g %.17g\n", profile->name,
            profile->from[0], profile->from[1], profile->from[2], profile->to[0], profile->to[1],
            profile->to[2]);
    char units[UNIT_TEXT];
    fprintf(out, "# %s\n# deck %s, selas %s; units: %s\n", scene->title,
            scene->deck != NULL ? deck_name(scene->deck) : "(none)", selas_version(),
            units_told(&scene->output, units));
    if (recorder->stepper->unwarp)
        fprintf(out, "# mid-run values: they keep the time error of the scheme, which only receivers lose\n");
    histories_note(out, recorder);
    fprintf(out, "# s x y z");
    for (int field = 0; field <= LAST_FIELD; field++) {
        if ((profile->fields >> field & 1U) == 0) continue;
        const char *const *component = component_names((selas_field)field);
        for (int c = 0; c < field_components((selas_field)field); c++)
            fprintf(out, " %s%s%s", field_name((selas_field)field), component[c][0] != '\0' ? "_" : "",
                    component[c]);
    }
    fprintf(out, "\n");
}

static selas_status write_one(const struct recorder *recorder, const struct profile_record *record,
                              struct messages *messages)
{
    const struct profile *profile = record->profile;
    char name[NAME_SIZE + 16];
    file_name_of(profile->name, ".dat", name, sizeof name);
    struct safe_file file;
    const selas_status status = safe_file_open(recorder->folder, name, &file, messages);
    if (status != SELAS_OK) return status;
    FILE *out = file.file;
    write_header(out, recorder, profile);
    for (size_t k = 0; k < profile->times; k++) {
        if (record->seen[k] < nodes_of(recorder)) { /* the run ended before */
            if (!recorder->so_far)
                warn(messages, "profile '%s' has no values at t = %g: the run ended before", profile->name,
                     profile->time[k]);
            continue;
        }
        fprintf(out, "%s# t = %.17g\n", k > 0 ? "\n\n" : "", profile->time[k]);
        for (size_t i = 0; i < profile->points; i++) {
            const double *x = record->probe[i].position;
            const double s =
                hypot(hypot(x[0] - profile->from[0], x[1] - profile->from[1]), x[2] - profile->from[2]);
            fprintf(out, "%.17g %.17g %.17g %.17g", s, x[0], x[1], x[2]);
            for (size_t c = record->columns - columns_of(profile->fields); c < record->columns; c++)
                fprintf(out, " %.17g", record->value[(k * profile->points + i) * record->columns + c]);
            fputc('\n', out);
        }
    }
    return safe_file_close(&file, SELAS_OK, messages);
}

selas_status profile_write(struct recorder *recorder, struct messages *messages)
{
    selas_status status = SELAS_OK;
    for (size_t p = 0; p < recorder->scene->profiles && status == SELAS_OK; p++)
        status = write_one(recorder, &recorder->profile[p], messages);
    return status;
}

void profile_free(struct recorder *recorder)
{
    for (size_t p = 0; recorder->profile != NULL && p < recorder->scene->profiles; p++) {
        struct profile_record *record = &recorder->profile[p];
        for (size_t i = 0; record->probe != NULL && i < record->profile->points; i++)
            probe_free(&record->probe[i]);
        array_free(record->probe);
        array_free(record->first);
        array_free(record->weight);
        array_free(record->value);
        array_free(record->seen);
    }
    array_free(recorder->profile);
}
