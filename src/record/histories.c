/* NAME.dat and NAME.exact.dat: columns t ux uy uz vx vy vz with a header; NAME.exact.stress.dat: t sxx syy
 * szz sxy syz szx. Numbers have 17 digits: what is read back is what was written. */
#include "compare/misfit.h"
#include "record/results.h"
#include "scene/units.h"

#include "base/memory.h"
#include "base/safe_file.h"

#include <math.h>
#include <stdlib.h>

enum { ROWS_WITHOUT_STEP = 600 };

void histories_note(FILE *out, const struct recorder *recorder)
{
    if (recorder->so_far)
        fprintf(out,
                "# UNFINISHED: the run was stopped at step %lu, t = %.9g, of %lu; a restart completes it\n",
                recorder->last_step, recorder->last_time, recorder->stepper->steps);
}

enum kind { COMPUTED, EXACT, EXACT_STRESS };

/* `recorder` is NULL where nothing is run. */
static selas_status write_history(const struct scene *scene, const struct recorder *recorder, size_t receiver,
                                  enum kind kind, const struct history_rows *history,
                                  struct messages *messages)
{
    static const char *const ending[] = {".dat", ".exact.dat", ".exact.stress.dat"};
    const struct receiver *place = &scene->receiver[receiver];
    char name[NAME_SIZE + 24];
    file_name_of(place->name, ending[kind], name, sizeof name);
    struct safe_file file;
    const selas_status status =
        safe_file_open(recorder != NULL ? recorder->folder : scene->output.directory, name, &file, messages);
    if (status != SELAS_OK) return status;
    FILE *out = file.file;
    file.twice = recorder != NULL; /* run.h5 or the checkpoint */
    fprintf(out, "# %s at receiver %s, position %.17g %.17g %.17g\n",
            kind == COMPUTED ? "history" : "exact history", place->name, place->position[0],
            place->position[1], place->position[2]);
    fprintf(out, "# %s\n", scene->title);
    char units[UNIT_TEXT];
    fprintf(out, "# deck %s, selas %s; units: %s\n", scene->deck != NULL ? deck_name(scene->deck) : "(none)",
            selas_version(), units_told(&scene->output, units));
    if (kind == COMPUTED && scene->output.low_pass > 0.0)
        fprintf(out, "# low-passed: %s\n", low_pass_told(&scene->output, units));
    if (recorder != NULL) histories_note(out, recorder);
    fprintf(out, "# t %s\n", kind == EXACT_STRESS ? "sxx syy szz sxy syz szx" : "ux uy uz vx vy vz");
    for (size_t i = 0; i < history->rows; i++) {
        fprintf(out, "%.17g", history->time[i]);
        for (size_t c = 0; c < 6; c++)
            fprintf(out, " %.17g", history->value[6 * i + c]);
        fputc('\n', out);
    }
    return safe_file_close(&file, SELAS_OK, messages);
}

/* Does the deck ask for exact stresses? Then the reference has them. */
static bool with_stress(const struct scene *scene, const struct exact *exact)
{
    return scene->reference.stress && exact->class->stress != NULL;
}

selas_status histories_compare(struct recorder *recorder, struct exact *exact, struct messages *messages)
{
    const struct scene *scene = recorder->scene;
    const size_t room = scene->receivers * recorder->rows * 6;
    const bool stress = with_stress(scene, exact);
    if (recorder->exact != NULL) return SELAS_OK;
    recorder->exact = array_new(stress ? 2 * room : room, sizeof *recorder->exact);
    recorder->stress = stress && recorder->exact != NULL ? recorder->exact + room : NULL;
    if (recorder->exact == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the exact histories");
    selas_status status = SELAS_OK;
    for (size_t r = 0; r < scene->receivers && status == SELAS_OK; r++) {
        const double *place = scene->receiver[r].position;
        const size_t rows = recorder->rows;
        status = exact->class->history(exact, place, rows, recorder->time, recorder->exact + r * rows * 6,
                                       messages);
        if (status == SELAS_OK && stress)
            status = exact->class->stress(exact, place, rows, recorder->time, recorder->stress + r * rows * 6,
                                          messages);
    }
    if (status != SELAS_OK) {
        array_free(recorder->exact);
        recorder->exact = recorder->stress = NULL;
    }
    char missed[MISSED_TEXT];
    if (histories_missed(recorder, missed)) warn(messages, "%s", missed);
    return status;
}

double histories_error(const struct recorder *recorder)
{
    double worst = 0;
    for (size_t r = 0; r < recorder->scene->receivers; r++) {
        const struct misfit vector = misfit_of(recorder->rows, recorder->time, recorder->trace[r].value + 3,
                                               recorder->exact + r * recorder->rows * 6 + 3, 6, 3);
        const double error = vector.l2 == 0 ? 0 : vector.l2 / vector.l2_of;
        if (isnan(error) || error > worst) worst = error; /* NaN stays */
    }
    return worst;
}

bool histories_missed(const struct recorder *recorder, char text[MISSED_TEXT])
{
    const double wanted = recorder->scene->accuracy;
    const double reached = recorder->exact != NULL && wanted > 0 ? histories_error(recorder) : 0;
    if (reached <= wanted) return false;
    snprintf(text, MISSED_TEXT,
             "the error reached is %.2g, above scene%%accuracy = %g: what the spacing was chosen by, laws or "
             "coarser "
             "points, did not show it; scene%%accuracy = %.2g would be right",
             reached, wanted, .8 * wanted * wanted / reached);
    return true;
}

selas_status histories_write(struct recorder *recorder, struct messages *messages)
{
    selas_status status = SELAS_OK;
    for (size_t r = 0; r < recorder->scene->receivers && status == SELAS_OK; r++) {
        struct history_rows history = recorder_history(recorder, r);
        status = write_history(recorder->scene, recorder, r, COMPUTED, &history, messages);
        if (status != SELAS_OK || recorder->exact == NULL) continue;
        history.value = recorder->exact + r * recorder->rows * 6;
        status = write_history(recorder->scene, recorder, r, EXACT, &history, messages);
        if (status != SELAS_OK || recorder->stress == NULL) continue;
        history.value = recorder->stress + r * recorder->rows * 6;
        status = write_history(recorder->scene, recorder, r, EXACT_STRESS, &history, messages);
    }
    return status;
}

selas_status record_exact(const struct scene *scene, struct exact *exact, struct messages *messages)
{
    const double step =
        scene->output.history_step > 0.0 ? scene->output.history_step : scene->end_time / ROWS_WITHOUT_STEP;
    size_t rows = 0;
    selas_status status = row_count(scene->end_time, step, &rows, messages);
    if (status == SELAS_OK) status = make_folder(scene->output.directory, messages);
    if (status != SELAS_OK) return status;
    char *names = results_names(scene, NULL, true);
    status = results_claim(scene, names, messages);
    if (status == SELAS_OK) status = results_list(scene, names, messages);
    free(names);
    if (status != SELAS_OK) return status;
    double *time = array_new(rows, sizeof *time);
    double *value = array_new(6 * rows, sizeof *value);
    if (time == NULL || value == NULL) {
        array_free(time);
        array_free(value);
        return fail(messages, SELAS_NO_MEMORY, "no memory for histories of %zu rows", rows);
    }
    for (size_t i = 0; i < rows; i++)
        time[i] = (double)i * step;
    const struct history_rows history = {rows, time, value};
    for (size_t r = 0; r < scene->receivers && status == SELAS_OK; r++) {
        status = exact->class->history(exact, scene->receiver[r].position, rows, time, value, messages);
        if (status == SELAS_OK) status = write_history(scene, NULL, r, EXACT, &history, messages);
        if (status != SELAS_OK || !with_stress(scene, exact)) continue;
        status = exact->class->stress(exact, scene->receiver[r].position, rows, time, value, messages);
        if (status == SELAS_OK) status = write_history(scene, NULL, r, EXACT_STRESS, &history, messages);
    }
    array_free(time);
    array_free(value);
    return status;
}
