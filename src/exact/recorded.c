/* Reference 'file' (see the header): NAME.dat of each receiver in a folder, or one history for the only
 * receiver; rows t ux uy uz vx vy vz. Between its rows a history is a cubic by four values
 * (compare/diff_pair.c). */
#include "exact/recorded.h"

#include "base/memory.h"
#include "compare/diff.h"
#include "scene/units.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct recorded {
    struct exact exact;
    struct history_file *receiver; /* [scene->receivers] */
};

static void destroy(struct exact *exact)
{
    struct recorded *recorded = (struct recorded *)exact;
    for (size_t i = 0; recorded->receiver != NULL && i < exact->scene->receivers; i++)
        history_file_free(&recorded->receiver[i]);
    array_free(recorded->receiver);
    array_free(recorded);
}

static bool is_folder(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

static selas_status read_one(struct recorded *recorded, size_t i, struct messages *messages)
{
    const struct scene *scene = recorded->exact.scene;
    const char *path = scene->reference.file, *name = scene->receiver[i].name;
    if (!is_folder(path)) return history_file_read(path, &recorded->receiver[i], messages);
    const size_t size = strlen(path) + strlen(name) + sizeof "/.dat";
    char *inside = array_new(size, 1);
    if (inside == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for a name");
    snprintf(inside, size, "%s/%s.dat", path, name);
    const selas_status status = history_file_read(inside, &recorded->receiver[i], messages);
    array_free(inside);
    return status;
}

/* Does the recorded history say that it is of another place, in other units or low-passed otherwise than the run? */
static void look_at_head(const struct recorded *recorded, size_t i, bool *told, struct messages *messages)
{
    static const char *const label[2] = {"reference 'file'", "the run"};
    const struct scene *scene = recorded->exact.scene;
    const struct receiver *receiver = &scene->receiver[i];
    const double *place = receiver->position;
    struct history_file here = {0};
    char text[UNIT_TEXT];
    snprintf(here.head[HISTORY_PLACE], HEAD_SIZE, "%.17g %.17g %.17g", place[0], place[1], place[2]);
    snprintf(here.head[HISTORY_UNITS], HEAD_SIZE, "%s", units_told(&scene->output, text));
    snprintf(here.head[HISTORY_LOW_PASS], HEAD_SIZE, "%s", low_pass_told(&scene->output, text));
    tell_heads(receiver->name, label, &recorded->receiver[i], &here, told, messages);
}

/* What is recorded at receiver i covers the times wanted. */
static selas_status covers(const struct recorded *recorded, size_t i, double from, double to,
                           struct messages *messages)
{
    const struct history_file *here = &recorded->receiver[i];
    if (recorded->receiver == NULL || here->time == NULL || here->rows == 0)
        return fail(messages, SELAS_BAD_SCENE, "reference 'file' of receiver '%s' has no rows",
                    recorded->exact.scene->receiver[i].name);
    const double begin = here->time[0], end = here->time[here->rows - 1], room = 1e-9 * fabs(to);
    if (from >= begin - room && to <= end + room) return SELAS_OK;
    return fail(messages, SELAS_BAD_SCENE,
                "reference 'file' of receiver '%s' goes from t = %.6g to %.6g, the run from %.6g to %.6g",
                recorded->exact.scene->receiver[i].name, begin, end, from, to);
}

/* Time of the last row that a run makes, as far as it is known beforehand. */
static double last_row(const struct scene *scene)
{
    const double step =
        scene->output.history_step > 0 ? scene->output.history_step : scene->stepping.time_step;
    if (step > 0) return floor(scene->end_time / step * (1 + 1e-12) + 1e-9) * step;
    return scene->stepping.courant > 0 ? 0 : scene->end_time;
}

static selas_status create(const struct scene *scene, struct exact **exact, struct messages *messages)
{
    if (scene->reference.file == NULL || (scene->receivers != 1 && !is_folder(scene->reference.file)))
        return fail(
            messages, SELAS_BAD_SCENE,
            "reference 'file' is one history, for one receiver; expected a folder with NAME.dat of each of "
            "the %zu receivers",
            scene->receivers);
    struct recorded *recorded = array_new(1, sizeof *recorded);
    if (recorded == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for histories");
    recorded->exact = (struct exact){.class = &exact_recorded, .scene = scene};
    recorded->receiver = array_new(scene->receivers, sizeof *recorded->receiver);
    selas_status status = SELAS_OK;
    bool told = false;
    if (recorded->receiver == NULL) status = fail(messages, SELAS_NO_MEMORY, "no memory for histories");
    for (size_t i = 0; i < scene->receivers && status == SELAS_OK; i++)
        status = read_one(recorded, i, messages);
    for (size_t i = 0; i < scene->receivers && status == SELAS_OK; i++)
        status = covers(recorded, i, 0, last_row(scene), messages);
    for (size_t i = 0; i < scene->receivers && status == SELAS_OK; i++)
        look_at_head(recorded, i, &told, messages);
    if (status == SELAS_FILE_ERROR) status = SELAS_BAD_SCENE; /* the results can be written all the same */
    if (status == SELAS_OK)
        *exact = &recorded->exact;
    else
        destroy(&recorded->exact);
    return status;
}

static bool same_place(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static selas_status history(struct exact *exact, const double position[3], size_t n, const double *time,
                            double *value, struct messages *messages)
{
    const struct recorded *recorded = (const struct recorded *)exact;
    const struct scene *scene = exact->scene;
    size_t i = 0, row = 0;
    while (i < scene->receivers && !same_place(scene->receiver[i].position, position))
        i++;
    if (i == scene->receivers || n == 0)
        return fail(messages, SELAS_BAD_SCENE, "reference 'file' has histories at receivers only");
    const struct history_file *here = &recorded->receiver[i];
    if (recorded->receiver == NULL || here->time == NULL || here->rows == 0)
        return fail(messages, SELAS_BAD_SCENE, "reference 'file' of receiver '%s' has no rows",
                    recorded->exact.scene->receiver[i].name);
    const double begin = here->time[0], end = here->time[here->rows - 1];
    const selas_status status = covers(recorded, i, time[0], time[n - 1], messages);
    for (size_t k = 0; k < n && status == SELAS_OK; k++)
        history_at(here, fmin(fmax(time[k], begin), end), &row, value + 6 * k);
    return status;
}

static void describe(const struct exact *exact,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    tell(context, "histories", exact->scene->reference.file);
}

const struct exact_class exact_recorded = {
    .kind = "file",
    .any_ground = true,
    .damped = true,
    .create = create,
    .destroy = destroy,
    .history = history,
    .describe = describe,
};
