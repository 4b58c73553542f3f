/* The half-space under surface patches: wavenumbers by Gauss panels, frequencies by FFT along Re s = eta
 * (doc/theory/lamb.md, Eqs 7-10).
 *
 * u(s) = f(s)/mu * sum over wavenumber nodes of coefficient(k) * compliance(k, s), where the coefficients
 * hold the quadrature weight, the load's direction and the direction averages of its transform at the
 * receiver. The frequencies are worked off in bands of half an octave, each with its own largest wavenumber;
 * after each band its part of the history in time is known, and the bands end when what is to come is below
 * the tolerance. */
#include "exact/lamb_fft.h"

#include "base/memory.h"
#include "exact/contour.h"
#include "exact/lamb_sum.h"

#include <math.h>
#include <string.h>

enum { SAMPLES = 200, MOST_BANDS = 64 };

/* Scales of the problem: smallest edge (0 without patches), farthest distance, highest frequency worth having
 * before convergence is judged, frequency above which nothing is left. */
struct scales {
    double edge, reach, depth, start, least, most;
    bool kinks, points;
};

struct work {
    struct scales scales;
    const struct lamb_problem *problem;
    size_t receivers;
    struct lamb_signal *signal;
    struct lamb_sum sum;
    struct contour contour;
    size_t frequencies, frequency_room;
    double complex *spectrum; /* [receivers][LAMB_COMPONENTS][frequency_room]: displacement */
    double evaluations;
};

static struct lamb_range wavenumbers(const struct work *work, double angular_frequency)
{
    const double slowest = angular_frequency / work->sum.slowest;
    const double flat = 1.15 * slowest + 240 / work->scales.edge;
    /* below the surface exp(-z sqrt(k^2 - (w/c)^2)) ends it earlier, without fading; both ends rise with the frequency,
     * so that those of a band's top hold for all of it */
    const double buried = hypot(26 / work->scales.depth, slowest);
    return (struct lamb_range){fmin(flat, buried), fmin(flat / .6, buried)};
}

static void one_frequency(const struct work *work, size_t j, double complex *sum)
{
    const double complex s = contour_frequency(&work->contour, j);
    const double mu = work->problem->ground.mu;
    lamb_sum_at(&work->sum, s, wavenumbers(work, cimag(s)), sum);
    const size_t loads = work->problem->loads;
    for (size_t p = 0; p < work->sum.paths; p++) {
        const struct lamb_path *path = &work->sum.path[p];
        const double complex f = history_laplace(path->load->history, s) / mu;
        double complex plane[LAMB_COMPONENTS];
        lamb_split_front_laplace(&work->problem->ground, work->signal[p / loads].front + 3 * (p % loads), s,
                                 path->z, plane);
        for (size_t c = 0; c < LAMB_COMPONENTS; c++) {
            double complex value = sum[p * LAMB_COMPONENTS + c] - mu * plane[c];
            value += mu * work->signal[p / loads].statics[3 * (p % loads) + c];
            work->spectrum[((p / loads) * LAMB_COMPONENTS + c) * work->frequency_room + j] += f * value;
        }
    }
}

/* Frequencies from work->frequencies up to the angular frequency `cutoff`. */
static bool add_band(struct work *work, double cutoff)
{
    const size_t until = (size_t)ceil(cutoff * work->contour.period / (2 * M_PI)) + 1;
    const double top = cimag(contour_frequency(&work->contour, until));
    if (!lamb_sum_extend(&work->sum, top, wavenumbers(work, top).end) ||

        !contour_widen(&work->spectrum, work->receivers * LAMB_COMPONENTS, work->frequencies, until,
                       &work->frequency_room))
        return false;
    bool room = true;
#pragma omp parallel
    {
        double complex *sum = array_new(work->sum.paths * LAMB_COMPONENTS, sizeof *sum);
        if (sum == NULL) {
#pragma omp atomic write
            room = false;
        }
#pragma omp for schedule(dynamic, 4)
        for (size_t j = work->frequencies; j < until; j++)
            if (sum != NULL) one_frequency(work, j, sum);
        array_free(sum);
    }
    work->evaluations +=
        (double)(until - work->frequencies) * lamb_sum_effort(&work->sum, wavenumbers(work, cutoff).end);
    work->frequencies = until;
    return room;
}

static void transform(struct work *work, size_t receiver, size_t component, size_t from, size_t until)
{
    const double complex *line =
        work->spectrum + (receiver * LAMB_COMPONENTS + component % LAMB_COMPONENTS) * work->frequency_room;
    contour_transform(&work->contour, line, from, until, component >= LAMB_COMPONENTS, 0);
}

/* Largest L2 norm over [0, end] among the velocity components of the frequencies [from, until). */
static double band_norm(struct work *work, size_t receiver, size_t from, size_t until)
{
    double largest = 0;
    for (size_t c = LAMB_COMPONENTS; c < 2 * LAMB_COMPONENTS; c++) {
        transform(work, receiver, c, from, until);
        largest = fmax(largest, contour_norm(&work->contour, work->signal[receiver].end_time));
    }
    return largest;
}

static bool keep_signal(struct work *work, size_t receiver)
{
    struct lamb_signal *signal = &work->signal[receiver];
    signal->decay = work->contour.decay;
    signal->step = work->contour.period / (double)work->contour.rows;
    signal->rows = (size_t)(signal->end_time / signal->step) + 16;
    if (signal->rows > work->contour.rows) signal->rows = work->contour.rows;
    array_free(signal->value);
    signal->value = array_new(6 * signal->rows, sizeof *signal->value);
    if (signal->value == NULL) return false;
    for (size_t c = 0; c < 6; c++) {
        transform(work, receiver, c, 0, work->frequencies);
        memcpy(signal->value + c * signal->rows, work->contour.out, signal->rows * sizeof *signal->value);
    }
    return true;
}

/* L2 norm over [0, end] of the largest velocity component, from SAMPLES times. */
static double signal_norm(const struct work *work, const struct lamb_signal *signal)
{
    double sum[LAMB_COMPONENTS] = {0, 0, 0};
    const double step = signal->end_time / SAMPLES;
    for (size_t i = 0; i < SAMPLES; i++) {
        double value[6];
        lamb_signal_value(work->problem, signal, ((double)i + .5) * step, value);
        for (size_t c = 0; c < LAMB_COMPONENTS; c++)
            sum[c] += value[3 + c] * value[3 + c] * step;
    }
    return sqrt(fmax(sum[0], fmax(sum[1], sum[2])));
}

/* A tenth of the velocity that the loads' whole histories would cause if all went slowly: the least by which an error
 * is judged, so that a time before the pulse asks for nothing. */
static double least_norm(const struct work *work, const struct lamb_signal *signal)
{
    double sum = 0;
    for (size_t l = 0; l < work->problem->loads; l++) {
        const double *rest = signal->statics + 3 * l;
        const double size = sqrt(rest[0] * rest[0] + rest[1] * rest[1] + rest[2] * rest[2]);
        sum += .1 * size * history_rate_norm(work->problem->load[l].history);
    }
    return sum;
}

static void find_scales(const struct work *work, struct scales *scales)
{
    *scales = (struct scales){.edge = INFINITY, .depth = INFINITY};
    double nearest = INFINITY;
    for (size_t p = 0; p < work->sum.paths; p++) {
        const struct lamb_path *path = &work->sum.path[p];
        const struct patch *patch = &path->load->patch;
        const struct history *history = path->load->history;
        scales->reach =
            fmax(scales->reach, hypot(fabs(path->x) + patch->half[0], fabs(path->y) + patch->half[1]));
        scales->depth = fmin(scales->depth, path->z);
        if (patch->shape == PATCH_POINT) {
            scales->points = true;
            nearest = fmin(nearest, sqrt(path->x * path->x + path->y * path->y + path->z * path->z));
        } else
            scales->edge = fmin(scales->edge, 2 * fmin(patch->half[0], patch->half[1]));
        const double most = history_cutoff(history, 1e-11), rough = history_cutoff(history, .02);
        scales->most = fmax(scales->most, most);
        if (isfinite(rough)) scales->least = fmax(scales->least, rough);
        if (history_cutoff(history, 1e-5) > 20 * history_cutoff(history, 1e-2) || isinf(most))
            scales->kinks = true;
    }
    if (isinf(scales->edge)) scales->edge = nearest;
    const double speed = work->problem->ground.s_speed;
    scales->start = fmin(10 * speed / scales->edge, scales->most);
    scales->least = fmin(fmax(scales->least, 20 * speed / scales->edge), scales->most);
}

/* Compliances that are worth evaluating once the estimated error is small, and at all. */
static const double SOME_EVALUATIONS = 4e7, MOST_EVALUATIONS = 1.2e8;

static selas_status work_off_bands(struct work *work, struct messages *messages)
{
    find_scales(work, &work->scales);
    const struct scales scales = work->scales;
    const double tolerance = work->problem->tolerance > 0 ? work->problem->tolerance
                             : scales.kinks               ? 2e-5
                                                          : 5e-7;
    double cutoff = scales.start;
    double *last = array_new(work->receivers, sizeof *last);
    if (last == NULL)
        return fail(messages, SELAS_NO_MEMORY, "not enough memory for the half-space's reference");
    for (int band = 0; band < MOST_BANDS; band++) {
        const size_t from = work->frequencies;
        const double wavenumber = wavenumbers(work, cutoff).end;
        if (!add_band(work, cutoff) || !contour_grid(&work->contour, work->frequencies)) {
            array_free(last);
            return fail(messages, SELAS_NO_MEMORY, "not enough memory for the half-space's reference");
        }
        double worst = 0;
        for (size_t r = 0; r < work->receivers; r++) {
            struct lamb_signal *signal = &work->signal[r];
            const double part = band_norm(work, r, from, work->frequencies);
            if (!keep_signal(work, r)) {
                array_free(last);
                return fail(messages, SELAS_NO_MEMORY, "not enough memory for the half-space's reference");
            }
            const double ratio = fmin(.8, fmax(.3, last[r] > 0 ? part / last[r] : .8));
            const double norm = fmax(signal_norm(work, signal), least_norm(work, signal));
            signal->effort = (struct lamb_effort){cutoff,
                                                  wavenumber,
                                                  work->contour.period,
                                                  work->contour.decay,
                                                  work->evaluations,
                                                  norm > 0 ? part * ratio / (1 - ratio) / norm : 0};
            last[r] = part;
            worst = fmax(worst, signal->effort.estimate);
        }
        if (cutoff >= scales.most || (band > 1 && cutoff >= scales.least && worst < tolerance)) break;
        const double next = fmin(cutoff * M_SQRT2, scales.most);
        const double more = (next - cutoff) * work->contour.period / (2 * M_PI) *
                            lamb_sum_effort(&work->sum, wavenumbers(work, next).end);
        const double most = worst > 3e-5 ? MOST_EVALUATIONS : SOME_EVALUATIONS;
        if (work->evaluations + more > most && cutoff >= scales.least) break;
        cutoff = next;
    }
    array_free(last);
    return SELAS_OK;
}

static bool has_kinks(const struct history *history)
{
    const double fine = history_cutoff(history, 1e-6);
    return isinf(fine) || fine > 30 * history_cutoff(history, 1e-2);
}

static selas_status prepare(struct work *work, double end_time, struct messages *messages)
{
    const struct lamb_problem *problem = work->problem;
    bool kinks = false;
    for (size_t l = 0; l < problem->loads; l++)
        kinks = kinks || has_kinks(problem->load[l].history);
    work->contour.period = (kinks ? 4 : 2.2) * end_time;
    work->contour.decay = (kinks ? 14 : 16) / work->contour.period;
    for (size_t r = 0; r < work->receivers; r++) {
        struct lamb_signal *signal = &work->signal[r];
        signal->statics = array_new(3 * problem->loads, sizeof *signal->statics);
        signal->front = array_new(3 * problem->loads, sizeof *signal->front);
        if (signal->statics == NULL || signal->front == NULL)
            return fail(messages, SELAS_NO_MEMORY, "not enough memory for the half-space's reference");
        for (size_t l = 0; l < problem->loads; l++) {
            const struct lamb_load *load = &problem->load[l];
            const double x = signal->position[0] - load->patch.centre[0];
            const double y = signal->position[1] - load->patch.centre[1];
            lamb_split_static(&problem->ground, load, x, y, signal->position[2], signal->statics + 3 * l);
            if (load->patch.shape == PATCH_DISC &&
                isnan(signal->statics[3 * l])) /* no room for the rule of its edge */
                return fail(messages, SELAS_NO_MEMORY, "not enough memory for the half-space's reference");
            lamb_split_front(&problem->ground, load, x, y, signal->position[2], signal->front + 3 * l);
        }
    }
    return lamb_sum_set(&work->sum, problem, work->receivers, work->signal, work->contour.decay, messages);
}

/* Receivers of one depth and of similar distances share a group: others neither share compliances nor need
 * the same panels and frequencies. */
static selas_status one_group(const struct lamb_problem *problem, double end_time, size_t n,
                              struct lamb_signal *signal, struct messages *messages)
{
    struct work work = {.problem = problem, .receivers = n, .signal = signal};
    selas_status status = prepare(&work, end_time, messages);
    if (status == SELAS_OK) status = work_off_bands(&work, messages);
    lamb_sum_free(&work.sum);
    array_free(work.spectrum);
    contour_free(&work.contour);
    return status;
}

/* Octave of the farthest distance from a receiver to a load's edge, measured in edges. */
static int distance_class(const struct lamb_problem *problem, const double position[3])
{
    double reach = 0, size = INFINITY;
    for (size_t l = 0; l < problem->loads; l++) {
        const struct patch *patch = &problem->load[l].patch;
        const double extent = hypot(patch->half[0], patch->half[1]);
        if (extent > 0) size = fmin(size, extent);
        reach = fmax(reach, hypot(position[0] - patch->centre[0], position[1] - patch->centre[1]) + extent);
    }
    if (isinf(size)) return ilogb(fmax(reach, 1e-300));
    return reach < 4 * size ? 0 : ilogb(reach / size);
}

selas_status lamb_fft(const struct lamb_problem *problem, double end_time, size_t n,
                      struct lamb_signal *signal, struct messages *messages)
{
    struct lamb_signal *group = array_new(n, sizeof *group);
    size_t *place = array_new(n, sizeof *place);
    bool *done = array_new(n, sizeof *done);
    selas_status status = SELAS_OK;
    const bool room = group != NULL && place != NULL && done != NULL;
    if (!room) status = fail(messages, SELAS_NO_MEMORY, "not enough memory for the half-space's reference");
    for (size_t i = 0; i < n; i++) {
        signal[i].value = signal[i].statics = signal[i].front = NULL;
        signal[i].end_time = end_time;
    }
    for (size_t first = 0; room && first < n && status == SELAS_OK; first++) {
        if (done[first]) continue;
        const int class = distance_class(problem, signal[first].position);
        size_t count = 0;
        for (size_t i = first; i < n; i++) {
            if (done[i] || signal[i].position[2] != signal[first].position[2] ||
                distance_class(problem, signal[i].position) != class)
                continue;
            done[i] = true;
            place[count] = i;
            group[count++] = signal[i];
        }
        status = one_group(problem, end_time, count, group, messages);
        for (size_t i = 0; i < count; i++)
            signal[place[i]] = group[i];
    }
    array_free(group);
    array_free(place);
    array_free(done);
    if (status != SELAS_OK)
        for (size_t i = 0; i < n; i++)
            lamb_signal_free(&signal[i]);
    return status;
}
