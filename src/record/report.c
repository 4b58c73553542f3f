/* report.txt: the run in figures, one `key: value` a line; ends with speed against error. */
#include "compare/misfit.h"
#include "record/kept.h"
#include "record/watch.h"

#include "base/memory.h"
#include "base/safe_file.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

static void tell_line(void *context, const char *key, const char *value)
{
    fprintf(context, "%s: %s\n", key, value);
}

static double per(double amount, double whole)
{
    return whole == 0.0 ? 0.0 : amount / whole; /* what is not finite has to show */
}

/* Of this program since it began: what getrusage() tells is that of the process that started it, if that was
 * larger. */
static double peak_memory(void)
{
    char line[256];
    double kibibytes = 0.0;
    FILE *status = fopen("/proc/self/status", "r");
    while (status != NULL && kibibytes == 0.0 && fgets(line, sizeof line, status) != NULL)
        if (strncmp(line, "VmHWM:", 6) == 0) kibibytes = strtod(line + 6, NULL);
    if (status != NULL) fclose(status);
    struct rusage usage;
    if (kibibytes == 0.0 && getrusage(RUSAGE_SELF, &usage) == 0) kibibytes = (double)usage.ru_maxrss;
    return 1024.0 * kibibytes;
}

static void write_energy(FILE *out, const struct recorder *recorder)
{
    const struct watch *watch = &recorder->watch;
    if (recorder->model->core->energy == NULL) return;
    fprintf(out, "energy at time: %.9g\n", watch->last_time);
    fprintf(out, "energy kinetic: %.6e\nenergy strain: %.6e\n", watch->last.kinetic, watch->last.strain);
    fprintf(out, "energy at start: %.6e\nenergy largest: %.6e\n", watch->initial, watch->largest);
    if (!watch->by_work) return;
    fprintf(out, "work of loads: %.6e\n", watch->worked);
    const bool losing = recorder->model->core->loss != NULL, told = losing && recorder->scene->output.balance;
    if (told) fprintf(out, "energy taken by damping: %.6e\n", watch->taken);
    if (recorder->model->layers || watch->untold != 0) return; /* not all is measured: there is no balance */
    if (losing && !told) {
        fprintf(out, "energy taken by damping: %.6e (work less what is left; output%%balance measures it)\n",
                watch->initial + watch->worked - watch->let_out - watch->last.kinetic - watch->last.strain);
        return;
    }
    fprintf(out, "energy absorbed: %.6e\n", watch->let_out);
    fprintf(out, "energy balance defect: %.3e (largest |E - E0 - work + absorbed%s|, relative to %.3e)\n",
            per(watch->largest_defect, watch->initial + watch->gross), told ? " + damped" : "",
            watch->initial + watch->gross);
}

static void write_cost(FILE *out, const struct recorder *recorder, const struct run_figures *figures)
{
    const struct model *model = recorder->model;
    if (figures != NULL) {
        fprintf(out, "threads: %d\n", figures->threads);
        fprintf(out, "set-up wall seconds: %.4g\nset-up CPU seconds: %.4g\n", figures->setup_wall_seconds,
                figures->setup_cpu_seconds);
        if (recorder->exact != NULL) fprintf(out, "exact CPU seconds: %.4g\n", figures->exact_cpu_seconds);
        fprintf(out, "stepping wall seconds: %.4g\n", figures->wall_seconds);
    }
    if (figures != NULL && figures->ground[1] > 0)
        fprintf(out, "ground values read for the lattice: %.0f of %.0f bytes\n", figures->ground[0],
                figures->ground[1]);
    if (figures != NULL && figures->halo_bytes > 0)
        fprintf(out, "halo bytes sent in the last step: %.0f\n", figures->halo_bytes);
    if (figures != NULL && figures->longest.worked > 0) {
        fprintf(out, "load balance: %.3f (mean over longest time at work in steps, %.4g s)\n",
                figures->mean.worked / figures->longest.worked, figures->longest.worked);
        fprintf(out, "waiting in exchanges: %.4g s (mean of the ranks; longest %.4g s)\n",
                figures->mean.waited, figures->longest.waited);
    }
    fprintf(out, "operator calls: %lu\n", recorder->stepper->model->evaluations);
    const double memory = peak_memory();
    fprintf(out, "peak memory bytes: %.0f\nbytes per point: %.1f\n", memory,
            per(memory, (double)model->points));
    fprintf(out, "model memory bytes: %zu\n", model->bytes);
}

static void write_misfit(FILE *out, const char *receiver, const char *component, const struct misfit *misfit,
                         const struct misfit *largest)
{
    if (!misfit_is_small(misfit, largest))
        fprintf(out, "error %s %s: L2 %.4e Linf %.4e", receiver, component, per(misfit->l2, misfit->l2_of),
                per(misfit->linf, misfit->linf_of));
    else
        fprintf(out, "error %s %s: L2 - Linf - (the component is nearly zero)", receiver, component);
    fprintf(out, "; of the largest component: L2 %.4e Linf %.4e\n", per(misfit->l2, largest->l2_of),
            per(misfit->linf, largest->linf_of));
}

/* Of all components, or (`brief`) of vz; and of both vectors, or of the velocity. */
static void write_errors_at(FILE *out, const struct recorder *recorder, size_t r, bool brief)
{
    static const char *const name[6] = {"ux", "uy", "uz", "vx", "vy", "vz"};
    const double *value = recorder->trace[r].value;
    const double *exact = recorder->exact + r * recorder->rows * 6;
    const char *receiver = recorder->scene->receiver[r].name;
    for (size_t kind = brief ? 1 : 0; kind < 2; kind++) { /* displacement, velocity */
        struct misfit misfit[3], largest;
        misfits_of(recorder->rows, recorder->time, value + 3 * kind, exact + 3 * kind, misfit, &largest);
        for (size_t c = brief ? 2 : 0; c < (size_t)recorder->scene->dimension; c++)
            write_misfit(out, receiver, name[3 * kind + c], &misfit[c], &largest);
        const struct misfit vector =
            misfit_of(recorder->rows, recorder->time, value + 3 * kind, exact + 3 * kind, 6, 3);
        fprintf(out, "error %s %s: L2 %.4e Linf %.4e\n", receiver, kind == 0 ? "displacement" : "velocity",
                per(vector.l2, vector.l2_of), per(vector.linf, vector.linf_of));
    }
}

/* Stresses see the rounding of displacements from point to point (F3a), however little these differ. */
static double noise_of_stress(const struct recorder *recorder, double largest)
{
    const struct scene *scene = recorder->scene;
    double stiffest = 0.0;
    for (size_t m = 0; m < scene->materials; m++)
        stiffest = fmax(stiffest, scene->material[m].density * pow(scene->material[m].p_speed, 2.0));
    largest = fmax(largest, profiles_largest(recorder, SELAS_DISPLACEMENT));
    return 1.5 * 0x1p-24 * sqrt((double)recorder->last_step) * stiffest * largest / scene->body.spacing;
}

static void write_noise(FILE *out, const struct recorder *recorder, double noise, struct messages *messages)
{
    static const double noted = 0.05;
    const double shown = profiles_largest(recorder, SELAS_STRESS);
    char text[256];
    fprintf(out, "single precision adds to stresses: up to about %.1e (estimated)\n", noise);
    if (!(noise > noted * shown) || !(shown > 0.0)) return;
    snprintf(
        text, sizeof text,
        "rounding in single precision may be up to %.2g of the stresses in the profiles, for displacements "
        "are large beside their differences from point to point; precision = 'double' would be right",
        noise / shown);
    tell_line(out, "warning", text);
    warn(messages, "%s", text);
}

static void tell_beyond(FILE *out, const char *what, const char *right, struct messages *messages)
{
    char text[200];
    snprintf(text, sizeof text,
             "%s lie beyond what single precision holds (1e-38 to 3e38): %s would be right", what, right);
    tell_line(out, "warning", text);
    warn(messages, "%s", text);
}

/* Numbers that run.h5 cannot hold; and a state in single precision whose energy, spread over the whole body, is that of
 * velocities (or of their way in a step) to which the least number, FLT_MIN, is more than its rounding is. */
static void write_beyond(FILE *out, const struct recorder *recorder, struct messages *messages)
{
    const struct scene *scene = recorder->scene;
    char what[80];
    double density = 0.0, amplitude = 0.0;
    for (int field = 0; field <= SELAS_ENERGY; field++) {
        const double shown = recorder->shown[field];
        snprintf(what, sizeof what, "numbers of the snapshots' field '%s'", field_name((selas_field)field));
        if (shown > (double)FLT_MAX || (shown > 0.0 && shown < (double)FLT_MIN))
            tell_beyond(out, what, "units in which they are nearer to 1", messages);
    }
    for (size_t m = 0; m < scene->materials; m++)
        density = fmax(density, scene->material[m].density);
    for (size_t k = 0; k < scene->loads; k++)
        amplitude = fmax(amplitude, fabs(scene->load[k].amplitude));
    const double mass =
                     density * (double)recorder->model->points * pow(scene->body.spacing, scene->dimension),
                 velocity = sqrt(2.0 * recorder->watch.largest / mass);
    if (recorder->model->single && amplitude > 0.0 &&
        velocity * fmin(1.0, recorder->stepper->dt) < (double)FLT_MIN * 0x1p24)
        tell_beyond(out, "numbers of the run", "precision = 'double' or other units", messages);
}

/* Of the displacement (from = 0) or velocity (3) of a receiver: its largest component, and the mean of its square over
 * the largest: by how much of all steps rounding, which is a part of what is rounded, adds. */
struct shown {
    double largest, share;
};
static struct shown shown_of(const struct recorder *recorder, size_t r, size_t from)
{
    struct shown shown = {0};
    double sum = 0.0, most = 0.0;
    for (size_t i = 0; i < recorder->rows; i++) {
        const double *value = recorder->trace[r].value + 6 * i + from;
        const double square = value[0] * value[0] + value[1] * value[1] + value[2] * value[2];
        for (size_t c = 0; c < 3; c++)
            shown.largest = fmax(shown.largest, fabs(value[c]));
        sum += square;
        most = fmax(most, square);
    }
    if (most > 0.0) shown.share = sum / (most * (double)recorder->rows);
    return shown;
}

/* What rounding of the state adds (doc/developers/performance.md, F3); each operator of damped ground adds as much.
 * Of moment tensors, that move the ground beside them far more than receivers, twice as much is told. */
static void write_precision(FILE *out, const struct recorder *recorder, struct messages *messages)
{
    const double steps = (double)recorder->last_step;
    const unsigned parts = recorder->model->parts;
    double worst = 0.0, largest = 0.0, nearby = 1.0;
    for (size_t k = 0; k < recorder->scene->loads; k++)
        if (recorder->scene->load[k].kind == LOAD_MOMENT_TENSOR) nearby = 2.0;
    for (size_t r = 0; r < recorder->scene->receivers; r++) {
        const struct shown u = shown_of(recorder, r, 0), v = shown_of(recorder, r, 3);
        largest = fmax(largest, u.largest);
        if (!(u.share > 0.0) || !(v.share > 0.0)) continue;
        const double turned = recorder->stepper->dt * v.largest / u.largest;
        worst = fmax(worst, 0x1p-24 * ((4.5 + 2.25 / turned) * sqrt(steps * u.share) +
                                       3.0 * steps * turned * sqrt(v.share)));
    }
    if (recorder->model->single && worst > 0.0)
        fprintf(out, "single precision adds: about %.1e of the largest value at a receiver (estimated)\n",
                nearby * worst * (parts > 1 ? parts : 1));
    if (recorder->model->single) write_noise(out, recorder, noise_of_stress(recorder, largest), messages);
}

/* What the low-pass alone takes off the exact velocity: no method comes below that. */
static void write_floor(FILE *out, const struct recorder *recorder)
{
    const size_t rows = recorder->rows, count = recorder->scene->receivers;
    const double cutoff = recorder->scene->output.low_pass;
    const bool from_rest = recorder->scene->initial.kind == INITIAL_REST;
    struct messages unsaid = {0};
    double *filtered = cutoff > 0 && rows > 1 ? array_new(6 * rows, sizeof *filtered) : NULL;
    if (filtered == NULL) return;
    fprintf(out, "error floor:");
    for (size_t r = 0; r < count; r++) {
        const double *exact = recorder->exact + r * rows * 6;
        memcpy(filtered, exact, 6 * rows * sizeof *filtered);
        if (low_pass(recorder->time[1] - recorder->time[0], cutoff, from_rest, rows, 6, filtered, &unsaid) !=
            SELAS_OK)
            break;
        const struct misfit misfit = misfit_of(rows, recorder->time, filtered + 3, exact + 3, 6, 3);
        fprintf(out, " %.4e", per(misfit.l2, misfit.l2_of));
    }
    fprintf(out, " (what the low-pass alone takes off the exact velocity of each receiver)\n");
    messages_free(&unsaid);
    array_free(filtered);
}

static void write_speed_against_error(FILE *out, const struct recorder *recorder,
                                      const struct run_figures *figures, bool brief)
{
    if (figures != NULL) {
        const double work = (double)recorder->model->points * (double)recorder->last_step;
        fprintf(out, "point-steps per second: %.4e\nstepping CPU seconds: %.4g\n",
                per(work, figures->wall_seconds), figures->cpu_seconds);
    }
    if (recorder->exact == NULL) return;
    if (recorder->rows > 0 && !brief)
        fprintf(out, "error window: 0 to %.9g, %zu rows\n", recorder->time[recorder->rows - 1],
                recorder->rows);
    for (size_t r = 0; r < recorder->scene->receivers; r++)
        write_errors_at(out, recorder, r, brief);
    write_floor(out, recorder);
    fprintf(out, "error largest: %.4e (L2 of the velocity vector, worst receiver)\n",
            histories_error(recorder));
}

/* The files of a reference are read when the run is over. */
static void write_changed(FILE *out, const struct recorder *recorder, struct messages *messages)
{
    static const char text[] =
        "a file that the deck names has changed since the run began: errors are those against "
        "reference 'file' as it is now";
    if (strcmp(recorder->scene->reference.kind, "file") != 0 || recorder->scene->deck == NULL) return;
    char *now = kept_files(recorder->scene);
    const bool same = now == NULL || recorder->files == NULL || strcmp(now, recorder->files) == 0;
    free(now);
    if (same) return;
    tell_line(out, "warning", text);
    warn(messages, "%s", text);
}

/* What the deck's reader warned of, with the place in the deck; all else that is warned of is told in its turn. */
static void write_reader(FILE *out, const struct messages *messages)
{
    static const char mark[] = ": warning: ";
    const char *end;
    for (const char *line = messages->text; line != NULL && (end = strchr(line, '\n')) != NULL;
         line = end + 1) {
        const char *text = strstr(line, mark);
        if (text == NULL || text > end) continue;
        const char *rest = text + strlen(mark);
        fprintf(out, "warning: %.*s: %.*s\n", (int)(text - line), line, (int)(end - rest), rest);
    }
}

void recorder_summary(const struct recorder *recorder, const struct run_figures *figures, FILE *out)
{
    write_speed_against_error(out, recorder, figures, true);
}

selas_status report_write(struct recorder *recorder, struct exact *exact, const struct run_figures *figures,
                          struct messages *messages)
{
    struct safe_file file;
    const selas_status status =
        safe_file_open(recorder->scene->output.directory, "report.txt", &file, messages);
    if (status != SELAS_OK) return status;
    FILE *out = file.file;
    provenance_tell(tell_line, out);
    write_reader(out, messages);
    plan_tell(recorder, tell_line, out);
    hindsight_tell(recorder, tell_line, out);
    fprintf(out, "steps done: %lu\ntime reached: %.9g\n", recorder->last_step, recorder->last_time);
    if (exact != NULL) {
        fprintf(out, "reference: %s\n", exact->class->kind);
        if (exact->class->describe != NULL) exact->class->describe(exact, tell_line, out);
        for (size_t r = 0; exact->class->judge != NULL && r < recorder->scene->receivers; r++)
            exact->class->judge(exact, &recorder->scene->receiver[r], recorder->rows, recorder->time,
                                recorder->trace[r].value, tell_line, out);
        write_changed(out, recorder, messages);
    }
    char missed[MISSED_TEXT];
    if (histories_missed(recorder, missed)) tell_line(out, "warning", missed);
    write_energy(out, recorder);
    write_precision(out, recorder, messages);
    write_beyond(out, recorder, messages);
    write_cost(out, recorder, figures);
    write_speed_against_error(out, recorder, figures, false);
    return safe_file_close(&file, SELAS_OK, messages);
}
