/* Receivers and spectra (see the header). */
#include "accuracy/ground_task.h"

#include "base/fft_room.h"
#include "base/memory.h"
#include "compare/misfit.h"
#include "damping/ground.h"

#include <fftw3.h>
#include <math.h>
#include <stdio.h>

enum { ROWS = SURFACE_ROWS };

/* Distance from the edge of a patch, a place `away` from its centre in the body's frame. */
static double rim_distance(const struct load *load, const double away[3])
{
    double outside[2], beyond = 0;
    if (load->shape == LOAD_POINT) return INFINITY;
    if (load->shape == LOAD_DISC) return hypot(hypot(away[0], away[1]) - load->size[0] / 2, away[2]);
    for (int c = 0; c < 2; c++) {
        outside[c] = fabs(away[c]) - load->size[c] / 2;
        beyond = hypot(beyond, fmax(0, outside[c]));
    }
    return hypot(beyond > 0 ? beyond : fmax(outside[0], outside[1]), away[2]);
}

static void set_place(const struct scene *scene, const double position[3], struct surface_place *place)
{
    place->distance = place->rim = INFINITY;
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        double away[3];
        for (int c = 0; c < 3; c++)
            away[c] = position[c] - load->centre[c];
        body_direction_from_deck(&scene->body, away, away);
        place->rim = fmin(place->rim, rim_distance(load, away));
        const double across = hypot(away[0], away[1]), distance = hypot(across, away[2]);
        if (distance >= place->distance) continue;
        place->distance = distance;
        place->depth = away[2];
        place->factor = 1;
        place->size = load->shape == LOAD_POINT  ? distance
                      : load->shape == LOAD_DISC ? load->size[0]
                                                 : fmin(load->size[0], load->size[1]);
        place->diagonal = across > 0 ? .5 - .5 * cos(4 * atan2(away[1], away[0])) : 0;
    }
}

/* |V|^2 of three components; the history goes on for a quarter of its length, fading out, so that its end
 * makes no frequencies. */
static selas_status find_power(struct exact *exact, double end_time, const struct receiver *receiver,
                               double *power, struct messages *messages)
{
    double *time = array_new(ROWS, sizeof *time);
    double *value = array_new((size_t)6 * ROWS, sizeof *value);
    double *in = fftw_malloc(ROWS * sizeof *in);
    fftw_complex *out = fftw_malloc((ROWS / 2 + 1) * sizeof *out);
    selas_status status = SELAS_NO_MEMORY;
    fftw_plan plan = NULL;
    if (time != NULL && value != NULL && in != NULL && out != NULL && fft_room(ROWS)) {
        for (int i = 0; i < ROWS; i++)
            time[i] = 1.25 * end_time / ROWS * i;
        status = exact->class->history(exact, receiver->position, ROWS, time, value, messages);
#pragma omp critical(selas_fftw_planner)
        plan = fftw_plan_dft_r2c_1d(ROWS, in, out, FFTW_ESTIMATE);
    } else {
        fail(messages, status, "no memory for the spectrum of a receiver");
    }
    for (int c = 3; c < 6 && plan != NULL && status == SELAS_OK; c++) {
        for (int i = 0; i < ROWS; i++) {
            const double late = fmax(0, time[i] / end_time - 1) * 4;
            in[i] = value[6 * i + c] * .5 * (1 + cos(M_PI * late));
        }
        fftw_execute(plan);
        for (int j = 0; j <= ROWS / 2; j++)
            power[j] += creal(out[j] * conj(out[j]));
    }
#pragma omp critical(selas_fftw_planner)
    if (plan != NULL) fftw_destroy_plan(plan);
    fftw_free(in);
    fftw_free(out);
    array_free(time);
    array_free(value);
    return status;
}

void end_task(struct task *task)
{
    exact_free(&task->exact);
    array_free(task->place);
    array_free(task->power);
}

const char *exact_of_ground(const struct scene *scene)
{
    return points_act(scene) || ground_is_damped(scene) ? "layered" : "lamb";
}

bool points_act(const struct scene *scene)
{
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].shape == LOAD_POINT) return true;
    return false;
}

selas_status begin_task(const struct scene *scene, struct task *task, struct messages *messages)
{
    *task = (struct task){.scene = scene, .longer = *scene};
    task->longer.end_time *= 1.25;
    task->longer.reference.tolerance = 1e-3;
    task->longer.reference.scheme = false;
    task->place = array_new(scene->receivers, sizeof *task->place);
    task->power = array_new(scene->receivers * (ROWS / 2 + 1), sizeof *task->power);
    if (task->place == NULL || task->power == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the spectra at receivers");
    selas_status status = exact_find(exact_of_ground(scene))->create(&task->longer, &task->exact, messages);
    if (status == SELAS_OK) status = exact_compute(task->exact, messages);
    for (size_t i = 0; i < scene->receivers && status == SELAS_OK; i++) {
        struct surface_place *place = &task->place[i];
        place->power = task->power + i * (ROWS / 2 + 1);
        set_place(scene, scene->receiver[i].position, place);
        status = find_power(task->exact, scene->end_time, &scene->receiver[i], place->power, messages);
    }
    return status;
}

/* What so many mechanisms are off at the worst receiver; `room`: [2][6 * ROWS]. */
static selas_status mechanisms_off(const struct task *task, size_t mechanisms, const double *time,
                                   double *room, double *off, struct messages *messages)
{
    struct scene scene = task->longer;
    struct exact *exact = NULL;
    double *value = room, *constant = room + (size_t)6 * ROWS;
    scene.method.mechanisms = mechanisms;
    scene.reference.scheme = true;
    selas_status status = exact_find("layered")->create(&scene, &exact, messages);
    if (status == SELAS_OK) status = exact_compute(exact, messages);
    *off = 0;
    for (size_t i = 0; i < scene.receivers && status == SELAS_OK; i++) {
        const double *place = scene.receiver[i].position;
        status = exact->class->history(exact, place, ROWS, time, value, messages);
        if (status == SELAS_OK)
            status = task->exact->class->history(task->exact, place, ROWS, time, constant, messages);
        const struct misfit velocity = misfit_of(ROWS, time, value + 3, constant + 3, 6, 3);
        if (status == SELAS_OK && velocity.l2_of > 0) *off = fmax(*off, velocity.l2 / velocity.l2_of);
    }
    exact_free(&exact);
    return status;
}

selas_status enough_mechanisms(const struct task *task, struct scene_choice *choice, char text[DAMPING_TEXT],
                               struct messages *messages)
{
    static const double share = .3; /* of the wanted error */
    if (!ground_is_damped(task->scene)) return SELAS_OK;
    double *time = array_new(ROWS, sizeof *time), *room = array_new((size_t)12 * ROWS, sizeof *room);
    double off = INFINITY;
    selas_status status = SELAS_OK;
    if (time == NULL || room == NULL)
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the mechanisms of a trial");
    for (int i = 0; time != NULL && i < ROWS; i++)
        time[i] = task->scene->end_time / ROWS * i;
    while (status == SELAS_OK && off > share * task->accuracy && choice->mechanisms < MOST_MECHANISMS)
        status = mechanisms_off(task, ++choice->mechanisms, time, room, &off, messages);
    if (status == SELAS_OK && off > share * task->accuracy)
        status = fail(
            messages, SELAS_BAD_SCENE,
            "scene%%accuracy = %g is out of reach here: %d relaxation mechanisms are %.2g off constant Q",
            task->accuracy, MOST_MECHANISMS, off);
    snprintf(text, DAMPING_TEXT, "; %zu mechanisms, %.2g off constant Q", choice->mechanisms, off);
    array_free(time);
    array_free(room);
    return status;
}
