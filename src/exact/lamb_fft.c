/* The half-space under surface patches: wavenumbers by Gauss panels, frequencies by FFT along Re s = eta
 * (doc/lamb.md, Eqs 10-40).
 *
 * u(s) = f(s)/mu * sum over wavenumber nodes of coefficient(k) * compliance(k, s), where the coefficients
 * hold the quadrature weight, the load's direction and the direction averages of its transform at the
 * receiver. The frequencies are worked off in bands of half an octave, each with its own largest wavenumber;
 * after each band its part of the history in time is known, and the bands end when what is to come is below
 * the tolerance. */
#include "exact/lamb_fft.h"

#include "base/memory.h"
#include "exact/gauss12.h"

#include <fftw3.h>
#include <math.h>
#include <string.h>

enum { COMPONENTS = 3, KERNELS = 5, SAMPLES = 200, MOST_BANDS = 64 };

/* One load seen from one receiver. */
struct path {
    const struct lamb_load *load;
    double x, y, z;
    bool without_rayleigh, horizontal;
    double share;    /* patch_share */
    double *weight;  /* [COMPONENTS * KERNELS * room]: coefficients by component and compliance */
    double *statics; /* [COMPONENTS * room]: sum of coefficients times static compliances */
};

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
    size_t paths;
    struct path *path; /* [receivers * loads] */
    double period, decay, panel;
    size_t nodes, room; /* wavenumbers so far, room for them */
    double *k, *k_weight;
    size_t frequencies, frequency_room;
    double complex *spectrum; /* [receivers][COMPONENTS][frequency_room]: displacement */
    size_t rows;              /* of the time grid over the whole period */
    fftw_plan plan;
    double complex *fft_in;
    double *fft_out;
    double evaluations;
};

static double complex frequency(const struct work *work, size_t j)
{
    return work->decay + I * (2 * M_PI * (double)j / work->period);
}

/* The wavenumbers that count at one frequency: all up to `flat`, fading out until `end`. */
struct range {
    double flat, end;
};

static struct range wavenumbers(const struct work *work, double angular_frequency)
{
    const struct lamb_problem *problem = work->problem;
    const double slowest = angular_frequency / (problem->layers != NULL ? problem->layers->slowest
                                                                        : problem->ground.rayleigh_speed);
    const double flat = 1.15 * slowest + (work->scales.kinks ? 48 : 160) / work->scales.edge;
    /* below the surface exp(-z sqrt(k^2 - (w/c)^2)) ends it earlier, without fading */
    const double buried = hypot(26 / work->scales.depth, slowest);
    return buried < flat ? (struct range){buried, buried} : (struct range){flat, flat / .6};
}

/* Coefficients of the compliances (order of struct compliance) for each component. */
static void coefficients(const struct path *path, double k, double weight, double value[COMPONENTS][KERNELS])
{
    double a[AVERAGES];
    patch_averages(&path->load->patch, path->x, path->y, k, a);
    const double scale = weight * k;
    for (int i = 0; i < AVERAGES; i++)
        a[i] *= scale;
    const double fx = path->load->traction[0], fy = path->load->traction[1], fz = path->load->traction[2];
    const double yy = a[AVERAGE] - a[AVERAGE_XX];
    const double along_x = fx * a[AVERAGE_XX] + fy * a[AVERAGE_XY], along_y = fx * a[AVERAGE_XY] + fy * yy;
    const double table[COMPONENTS][KERNELS] = {
        {0, fz * a[AVERAGE_X], along_x, 0, fx * a[AVERAGE] - along_x},
        {0, fz * a[AVERAGE_Y], along_y, 0, fy * a[AVERAGE] - along_y},
        {fz * a[AVERAGE], 0, 0, fx * a[AVERAGE_X] + fy * a[AVERAGE_Y], 0},
    };
    memcpy(value, table, sizeof table);
}

/* Appends panels until the wavenumbers reach `largest`; coefficients of all paths and their static sums. */
static bool extend_nodes(struct work *work, double largest)
{
    const size_t panels = (size_t)ceil(largest / work->panel), until = panels * 12;
    if (until <= work->nodes) return true;
    if (until > work->room) {
        const size_t room = until + until / 2;
        double *k = array_new(room, sizeof *k), *k_weight = array_new(room, sizeof *k_weight);
        if (k == NULL || k_weight == NULL) return false;
        if (work->nodes > 0) {
            memcpy(k, work->k, work->nodes * sizeof *k);
            memcpy(k_weight, work->k_weight, work->nodes * sizeof *k);
        }
        array_free(work->k);
        array_free(work->k_weight);
        work->k = k;
        work->k_weight = k_weight;
        for (size_t p = 0; p < work->paths; p++) {
            double *weight = array_new(COMPONENTS * KERNELS * room, sizeof *weight);
            if (weight == NULL) return false;
            for (size_t c = 0; c < COMPONENTS * KERNELS && work->nodes > 0; c++)
                memcpy(weight + c * room, work->path[p].weight + c * work->room,
                       work->nodes * sizeof *weight);
            double *statics = array_new(COMPONENTS * room, sizeof *statics);
            for (size_t c = 0; statics != NULL && work->nodes > 0 && c < COMPONENTS; c++)
                memcpy(statics + c * room, work->path[p].statics + c * work->room,
                       work->nodes * sizeof *statics);
            array_free(work->path[p].weight);
            array_free(work->path[p].statics);
            work->path[p].weight = weight;
            work->path[p].statics = statics;
            if (statics == NULL) return false;
        }
        work->room = room;
    }
    for (size_t i = work->nodes; i < until; i++) {
        const size_t in_panel = i % 12, panel = i / 12;
        work->k[i] = work->panel * ((double)panel + .5 + .5 * gauss12_node[in_panel]);
        work->k_weight[i] = .5 * work->panel * gauss12_weight[in_panel];
    }
    for (size_t p = 0; p < work->paths; p++) {
        struct path *path = &work->path[p];
        const size_t from = work->nodes, room = work->room;
#pragma omp parallel for schedule(dynamic, 64)
        for (size_t i = from; i < until; i++) {
            double value[COMPONENTS][KERNELS];
            coefficients(path, work->k[i], work->k_weight[i], value);
            for (size_t c = 0; c < COMPONENTS; c++)
                for (size_t g = 0; g < KERNELS; g++)
                    path->weight[(c * KERNELS + g) * room + i] = value[c][g];
        }
        for (size_t i = from; i < until; i++) {
            double value[KERNELS], pole[4] = {0};
            half_space_static(&work->problem->ground, path->z, work->k[i], value);
            if (path->without_rayleigh)
                half_space_static_rayleigh(&work->problem->ground, path->z, work->k[i], pole);
            for (size_t c = 0; c < COMPONENTS; c++) {
                double *statics = &path->statics[c * room + i];
                *statics = 0;
                for (size_t g = 0; g < KERNELS; g++)
                    *statics +=
                        path->weight[(c * KERNELS + g) * room + i] * (value[g] - (g < 4 ? pole[g] : 0));
            }
        }
    }
    work->nodes = until;
    return true;
}

/* sum of a[i] b[i] in a fixed order */
static inline double dot(const double *a, const double *b, size_t n)
{
    double sum[4] = {0, 0, 0, 0};
    size_t i = 0;
    for (; i + 4 <= n; i += 4)
        for (size_t j = 0; j < 4; j++)
            sum[j] += a[i + j] * b[i + j];
    for (; i < n; i++)
        sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* Sum over the wavenumbers for one path on one block of them. */
static void add_block(const struct path *path, size_t room, size_t from, size_t count,
                      const struct compliance *compliance, double complex sum[COMPONENTS])
{
    static const int used[COMPONENTS][3] = {{1, 2, 4}, {1, 2, 4}, {0, 3, -1}};
    const double(*const parts[KERNELS])[BLOCK] = {compliance->vertical, compliance->horizontal,
                                                  compliance->radial, compliance->coupled, compliance->shear};
    for (size_t c = 0; c < COMPONENTS; c++)
        for (int i = 0; i < (path->horizontal ? 3 : 1); i++) {
            const int g = used[c][i];
            if (g < 0) continue;
            const double *weight = path->weight + (c * KERNELS + (size_t)g) * room + from;
            sum[c] += dot(weight, parts[g][0], count) + I * dot(weight, parts[g][1], count);
        }
}

/* 1 up to range.flat, then smoothly to 0 at range.end with three continuous derivatives. */
static double roll_off(struct range range, double k)
{
    if (k <= range.flat) return 1;
    if (k >= range.end) return 0;
    const double y = (k - range.flat) / (range.end - range.flat);
    return .5 * (1 + cos(M_PI * y * y * y * (10 - y * (15 - 6 * y))));
}

static void multiply(double factor, size_t i, bool horizontal, struct compliance *compliance)
{
    for (int part = 0; part < 2; part++) {
        compliance->vertical[part][i] *= factor;
        compliance->horizontal[part][i] *= factor;
        if (!horizontal) continue;
        compliance->radial[part][i] *= factor;
        compliance->coupled[part][i] *= factor;
        compliance->shear[part][i] *= factor;
    }
}

/* Sums of all paths at one s over the wavenumbers of a range: [paths][COMPONENTS], before the history's
 * transform. */
static void sum_wavenumbers(const struct work *work, double complex s, struct range range,
                            double complex *sum)
{
    for (size_t i = 0; i < work->paths * COMPONENTS; i++)
        sum[i] = 0;
    for (size_t from = 0; from < work->nodes && work->k[from] < range.end; from += BLOCK) {
        const size_t count = work->nodes - from < BLOCK ? work->nodes - from : BLOCK;
        struct compliance compliance;
        double taper[BLOCK];
        for (size_t i = 0; i < count; i++)
            taper[i] = roll_off(range, work->k[from + i]);
        for (size_t p = 0; p < work->paths; p++) {
            const struct path *path = &work->path[p];
            const struct path *before = p > 0 ? path - 1 : NULL;
            if (before == NULL || before->z != path->z || before->horizontal != path->horizontal ||
                before->without_rayleigh != path->without_rayleigh) {
                half_space_compliance(&work->problem->ground, s, path->z, count, work->k + from,
                                      path->horizontal, path->without_rayleigh, &compliance);
                if (work->problem->layers != NULL)
                    layered_add_difference(work->problem->layers, &work->problem->ground, s, path->z, count,
                                           work->k + from, path->horizontal, &compliance);
                for (size_t i = 0; i < count && taper[count - 1] < 1; i++)
                    multiply(taper[i], i, path->horizontal, &compliance);
            }
            add_block(path, work->room, from, count, &compliance, sum + p * COMPONENTS);
            for (size_t c = 0; c < COMPONENTS; c++)
                sum[p * COMPONENTS + c] -= dot(path->statics + c * work->room + from, taper, count);
        }
    }
}

static void one_frequency(const struct work *work, size_t j, double complex *sum)
{
    const double complex s = frequency(work, j);
    const double mu = work->problem->ground.mu;
    sum_wavenumbers(work, s, wavenumbers(work, cimag(s)), sum);
    const size_t loads = work->problem->loads;
    for (size_t p = 0; p < work->paths; p++) {
        const struct path *path = &work->path[p];
        const double complex f = history_laplace(path->load->history, s) / mu;
        double complex plane[COMPONENTS];
        lamb_split_plane(&work->problem->ground, s, path->z, plane);
        for (size_t c = 0; c < COMPONENTS; c++) {
            double complex value = sum[p * COMPONENTS + c];
            value += mu * work->signal[p / loads].statics[3 * (p % loads) + c];
            value -= path->share * path->load->traction[c] * plane[c];
            work->spectrum[((p / loads) * COMPONENTS + c) * work->frequency_room + j] += f * value;
        }
    }
}

static bool make_room_for_frequencies(struct work *work, size_t until)
{
    if (until <= work->frequency_room) return true;
    const size_t room = 2 * until, lines = work->receivers * COMPONENTS;
    double complex *spectrum = array_new(lines * room, sizeof *spectrum);
    if (spectrum == NULL) return false;
    for (size_t i = 0; i < lines && work->frequencies > 0; i++)
        memcpy(spectrum + i * room, work->spectrum + i * work->frequency_room,
               work->frequencies * sizeof *spectrum);
    array_free(work->spectrum);
    work->spectrum = spectrum;
    work->frequency_room = room;
    return true;
}

/* Frequencies from work->frequencies up to the angular frequency `cutoff`. */
static bool add_band(struct work *work, double cutoff, double largest_wavenumber)
{
    const size_t until = (size_t)ceil(cutoff * work->period / (2 * M_PI)) + 1;
    if (!extend_nodes(work, largest_wavenumber) || !make_room_for_frequencies(work, until)) return false;
    bool room = true;
#pragma omp parallel
    {
        double complex *sum = array_new(work->paths * COMPONENTS, sizeof *sum);
        if (sum == NULL) {
#pragma omp atomic write
            room = false;
        }
#pragma omp for schedule(dynamic, 4)
        for (size_t j = work->frequencies; j < until; j++)
            if (sum != NULL) one_frequency(work, j, sum);
        array_free(sum);
    }
    work->evaluations += (double)(until - work->frequencies) * (double)work->nodes;
    work->frequencies = until;
    return room;
}

/* Time grid over one period, eight samples in the shortest one. */
static bool make_plan(struct work *work)
{
    size_t rows = 256;
    while (rows < 16 * work->frequencies)
        rows *= 2;
    if (rows == work->rows) return true;
    bool room = false;
#pragma omp critical(selas_fftw_planner)
    {
        if (work->plan != NULL) fftw_destroy_plan(work->plan);
        fftw_free(work->fft_in);
        fftw_free(work->fft_out);
        work->plan = NULL;
        work->fft_in = fftw_malloc((rows / 2 + 1) * sizeof *work->fft_in);
        work->fft_out = fftw_malloc(rows * sizeof *work->fft_out);
        if (work->fft_in != NULL && work->fft_out != NULL)
            work->plan = fftw_plan_dft_c2r_1d((int)rows, work->fft_in, work->fft_out, FFTW_ESTIMATE);
        room = work->plan != NULL;
    }
    work->rows = rows;
    return room;
}

/* Inverse transform of the frequencies [from, until) of one line, without exp(decay t), to fft_out:
 * (1/T) sum over j of U_j exp(2 pi i j t/T), negative j by conjugation. */
static void transform(struct work *work, size_t receiver, size_t component, size_t from, size_t until)
{
    const double complex *line =
        work->spectrum + (receiver * COMPONENTS + component % COMPONENTS) * work->frequency_room;
    memset(work->fft_in, 0, (work->rows / 2 + 1) * sizeof *work->fft_in);
    for (size_t j = from; j < until; j++)
        work->fft_in[j] = line[j] * (component >= COMPONENTS ? frequency(work, j) : 1) / work->period;
    fftw_execute(work->plan);
}

/* Largest L2 norm over [0, end] among the velocity components of the frequencies [from, until). */
static double band_norm(struct work *work, size_t receiver, size_t from, size_t until)
{
    const double step = work->period / (double)work->rows, end = work->signal[receiver].end_time;
    double largest = 0;
    for (size_t c = COMPONENTS; c < 2 * COMPONENTS; c++) {
        transform(work, receiver, c, from, until);
        double sum = 0;
        for (size_t i = 0; i < work->rows && (double)i * step <= end; i++) {
            const double value = work->fft_out[i] * exp(work->decay * (double)i * step);
            sum += value * value;
        }
        largest = fmax(largest, sqrt(sum * step));
    }
    return largest;
}

static bool keep_signal(struct work *work, size_t receiver)
{
    struct lamb_signal *signal = &work->signal[receiver];
    signal->decay = work->decay;
    signal->step = work->period / (double)work->rows;
    signal->rows = (size_t)(signal->end_time / signal->step) + 16;
    if (signal->rows > work->rows) signal->rows = work->rows;
    array_free(signal->value);
    signal->value = array_new(6 * signal->rows, sizeof *signal->value);
    if (signal->value == NULL) return false;
    for (size_t c = 0; c < 6; c++) {
        transform(work, receiver, c, 0, work->frequencies);
        memcpy(signal->value + c * signal->rows, work->fft_out, signal->rows * sizeof *signal->value);
    }
    return true;
}

/* L2 norm over [0, end] of the largest velocity component, from SAMPLES times. */
static double signal_norm(const struct work *work, const struct lamb_signal *signal)
{
    double sum[COMPONENTS] = {0, 0, 0};
    const double step = signal->end_time / SAMPLES;
    for (size_t i = 0; i < SAMPLES; i++) {
        double value[6];
        lamb_signal_value(work->problem, signal, ((double)i + .5) * step, value);
        for (size_t c = 0; c < COMPONENTS; c++)
            sum[c] += value[3 + c] * value[3 + c] * step;
    }
    return sqrt(fmax(sum[0], fmax(sum[1], sum[2])));
}

static void find_scales(const struct work *work, struct scales *scales)
{
    *scales = (struct scales){.edge = INFINITY, .depth = INFINITY};
    double nearest = INFINITY;
    for (size_t p = 0; p < work->paths; p++) {
        const struct path *path = &work->path[p];
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
        if (!add_band(work, cutoff, wavenumber) || !make_plan(work)) {
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
            const double norm = signal_norm(work, signal);
            signal->effort = (struct lamb_effort){
                cutoff,      wavenumber,        work->period,
                work->decay, work->evaluations, norm > 0 ? part * ratio / (1 - ratio) / norm : 0};
            last[r] = part;
            worst = fmax(worst, signal->effort.estimate);
        }
        if (cutoff >= scales.most || (band > 1 && cutoff >= scales.least && worst < tolerance)) break;
        const double next = fmin(cutoff * M_SQRT2, scales.most);
        const double more =
            (next - cutoff) * work->period / (2 * M_PI) * 12 * wavenumbers(work, next).end / work->panel;
        const double most = worst > 3e-5 ? MOST_EVALUATIONS : SOME_EVALUATIONS;
        if (work->evaluations + more > most && cutoff >= scales.least) break;
        cutoff = next;
    }
    array_free(last);
    return SELAS_OK;
}

static selas_status prepare(struct work *work, double end_time, struct messages *messages)
{
    const struct lamb_problem *problem = work->problem;
    work->paths = work->receivers * problem->loads;
    work->path = array_new(work->paths, sizeof *work->path);
    if (work->path == NULL)
        return fail(messages, SELAS_NO_MEMORY, "not enough memory for the half-space's reference");
    bool kinks = false;
    double reach = 0;
    for (size_t r = 0; r < work->receivers; r++) {
        struct lamb_signal *signal = &work->signal[r];
        signal->statics = array_new(3 * problem->loads, sizeof *signal->statics);
        if (signal->statics == NULL)
            return fail(messages, SELAS_NO_MEMORY, "not enough memory for the half-space's reference");
        for (size_t l = 0; l < problem->loads; l++) {
            const struct lamb_load *load = &problem->load[l];
            struct path *path = &work->path[r * problem->loads + l];
            path->load = load;
            path->x = signal->position[0] - load->patch.centre[0];
            path->y = signal->position[1] - load->patch.centre[1];
            path->z = signal->position[2];
            path->without_rayleigh = lamb_split_rayleigh(load);
            path->horizontal = load->traction[0] != 0 || load->traction[1] != 0;
            path->share = patch_share(&load->patch, path->x, path->y);
            lamb_split_static(&problem->ground, load, path->x, path->y, path->z, signal->statics + 3 * l);
            reach = fmax(reach, fabs(path->x) + fabs(path->y) + load->patch.half[0] + load->patch.half[1]);
            kinks = kinks || history_cutoff(load->history, 1e-6) > 30 * history_cutoff(load->history, 1e-2) ||
                    isinf(history_cutoff(load->history, 1e-6));
        }
    }
    work->period = (kinks ? 4 : 2.2) * end_time;
    work->decay = (kinks ? 14 : 16) / work->period;
    /* poles and branch points lie decay/speed off the real axis of k */
    const struct layered *layers = problem->layers;
    const double p_speed = layers != NULL ? layers->fastest[0] : problem->ground.p_speed;
    const double s_speed = layers != NULL ? layers->fastest[1] : problem->ground.s_speed;
    work->panel = fmin(12 / reach, work->decay * fmin(2 / s_speed, 6 / p_speed));
    return SELAS_OK;
}

selas_status lamb_fft(const struct lamb_problem *problem, double end_time, size_t n,
                      struct lamb_signal *signal, struct messages *messages)
{
    struct work work = {.problem = problem, .receivers = n, .signal = signal};
    for (size_t i = 0; i < n; i++) {
        signal[i].value = signal[i].statics = NULL;
        signal[i].end_time = end_time;
    }
    selas_status status = prepare(&work, end_time, messages);
    if (status == SELAS_OK) status = work_off_bands(&work, messages);
    for (size_t p = 0; work.path != NULL && p < work.paths; p++) {
        array_free(work.path[p].weight);
        array_free(work.path[p].statics);
    }
    array_free(work.path);
    array_free(work.k);
    array_free(work.k_weight);
    array_free(work.spectrum);
#pragma omp critical(selas_fftw_planner)
    {
        if (work.plan != NULL) fftw_destroy_plan(work.plan);
        fftw_free(work.fft_in);
        fftw_free(work.fft_out);
    }
    if (status != SELAS_OK)
        for (size_t i = 0; i < n; i++)
            lamb_signal_free(&signal[i]);
    return status;
}
