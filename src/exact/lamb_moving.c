/* Moving patches on the half-space. A patch X(x - V t) f(t) has the transform X(k) f^(s + i k.V), so that
 * (doc/sources.md, Eqs 8-10)
 *   u(x, s) = 1/(4 pi^2) int int G(k, s) X(k) f^(s + i k.V) exp(i k.x) k dk dphi :
 * wavenumbers by Gauss panels, directions by the trapezoidal rule, which is exact once it resolves k times
 * the farthest distance, frequencies by FFT along Re s = eta as in lamb_fft.c. Along one (k, phi) all
 * frequencies read f^ at one offset, so that one set of interpolation weights serves them all. */
#include "exact/lamb_moving.h"

#include "base/memory.h"
#include "exact/gauss12.h"

#include <fftw3.h>
#include <math.h>
#include <string.h>

enum { DENSITY = 8, POINTS = 12, BEFORE = 5, SUMS = 5, BATCH = 24 };

struct table {
    size_t half;           /* entries from -half to half, POINTS more on either side */
    double complex *value; /* f^(eta + i m 2 pi / (DENSITY T)) at value[m + half + POINTS] */
    double cutoff;
};

struct job {
    const struct lamb_problem *ground;
    const struct moving_patch *patch;
    struct table table;
    size_t receivers, frequencies;
    const struct lamb_signal *signal;
    double period, decay, reach, panel, flat, end;
    bool horizontal;
};

static double speed_of(const struct moving_patch *patch)
{
    return hypot(patch->velocity[0], patch->velocity[1]);
}

static double complex shape(const struct patch *patch, double kx, double ky, double k)
{
    if (patch->shape == PATCH_POINT) return 1;
    if (patch->shape == PATCH_DISC) return 2 * M_PI * patch->half[0] * j1(k * patch->half[0]) / k;
    const double x = kx * patch->half[0], y = ky * patch->half[1];
    return 4 * patch->half[0] * patch->half[1] * (x != 0 ? sin(x) / x : 1) * (y != 0 ? sin(y) / y : 1);
}

static bool fill_table(const struct history *history, double decay, double step, struct table *table)
{
    table->half = (size_t)ceil(table->cutoff / step);
    const size_t count = 2 * (table->half + POINTS) + 1;
    table->value = array_new(count, sizeof *table->value);
    if (table->value == NULL) return false;
    for (size_t i = 0; i < count; i++)
        table->value[i] =
            history_laplace(history, decay + I * step * ((double)i - (double)(table->half + POINTS)));
    return true;
}

/* f^ at one offset for all frequencies from *first to *last that it reaches; value[j - *first]. */
static void read_table(const struct job *job, double along, double complex factor, long *first, long *last,
                       double complex *value)
{
    const double place = along * DENSITY * job->period / (2 * M_PI), whole = floor(place);
    const long offset = (long)whole, half = (long)job->table.half;
    double weight[POINTS];
    for (int i = 0; i < POINTS; i++) {
        weight[i] = 1;
        for (int j = 0; j < POINTS; j++)
            if (j != i) weight[i] *= (place - whole + BEFORE - j) / (i - j);
    }
    *first = (long)fmax(0, ceil((double)(-half - offset) / DENSITY));
    *last = (long)fmin((double)job->frequencies - 1, floor((double)(half - offset) / DENSITY));
    for (long j = *first; j <= *last; j++) {
        const double complex *at = job->table.value + (DENSITY * j + offset + half + POINTS - BEFORE);
        double re = 0, im = 0;
        for (int i = 0; i < POINTS; i++) {
            re += weight[i] * creal(at[i]);
            im += weight[i] * cimag(at[i]);
        }
        value[j - *first] = factor * (re + I * im);
    }
}

/* Sums over the directions of X f^ exp(i k.d) times 1, n_x, n_y, n_x^2, n_x n_y, over 2 pi:
 * sum[(receiver * SUMS + s) * frequencies + j]. */
static void sum_directions(const struct job *job, double k, double complex *line, double complex *sum)
{
    const struct patch *patch = &job->patch->load.patch;
    const size_t frequencies = job->frequencies;
    const double reach = k * job->reach;
    const int directions = (int)(1.1 * reach + 12 * cbrt(reach)) + 40;
    memset(sum, 0, job->receivers * SUMS * frequencies * sizeof *sum);
    for (int d = 0; d < directions; d++) {
        const double angle = 2 * M_PI * d / directions, c = cos(angle), s = sin(angle);
        const double part[SUMS] = {1, c, s, c * c, c * s};
        long first = 0, last = -1;
        read_table(job, k * (c * job->patch->velocity[0] + s * job->patch->velocity[1]),
                   shape(patch, k * c, k * s, k) / (2 * M_PI * directions), &first, &last, line);
        for (size_t r = 0; r < job->receivers; r++) {
            const double *position = job->signal[r].position;
            const double phase =
                k * (c * (position[0] - patch->centre[0]) + s * (position[1] - patch->centre[1]));
            const double complex turn = cos(phase) + I * sin(phase);
            for (int m = 0; m < (job->horizontal ? SUMS : 3); m++) {
                const double complex factor = turn * part[m];
                double complex *to = sum + (r * SUMS + (size_t)m) * frequencies;
                for (long j = first; j <= last; j++)
                    to[j] += factor * line[j - first];
            }
        }
    }
}

/* Compliances at one wavenumber: vertical, horizontal, radial, coupled, shear. */
static void compliances(const struct job *job, double complex s, double z, double k, double complex value[5])
{
    struct compliance c;
    const struct lamb_problem *ground = job->ground;
    if (ground->layers != NULL)
        layered_compliance(ground->layers, s, z, 1, &k, job->horizontal, &c);
    else
        half_space_compliance(&ground->ground, s, z, 1, &k, job->horizontal, false, &c);
    double(*const parts[5])[BLOCK] = {c.vertical, c.horizontal, c.radial, c.coupled, c.shear};
    for (int i = 0; i < 5; i++)
        value[i] = i < 2 || job->horizontal ? parts[i][0][0] + I * parts[i][1][0] : 0;
}

/* One wavenumber's share of the spectra: share[(receiver * 3 + component) * frequencies + j]. */
static void one_wavenumber(const struct job *job, double k, double weight, double complex *line,
                           double complex *sum, double complex *share)
{
    const double *force = job->patch->load.traction;
    const size_t frequencies = job->frequencies;
    sum_directions(job, k, line, sum);
    for (size_t r = 0; r < job->receivers; r++)
        for (size_t j = 0; j < frequencies; j++) {
            const double complex *at = sum + r * SUMS * frequencies + j;
            const double complex plain = at[0], x = at[frequencies], y = at[2 * frequencies];
            const double complex xx = at[3 * frequencies], xy = at[4 * frequencies];
            double complex *to = share + r * 3 * frequencies + j;
            to[0] = to[frequencies] = to[2 * frequencies] = 0;
            if (plain == 0) continue;
            const double complex s = job->decay + I * (2 * M_PI * (double)j / job->period);
            double complex g[5];
            compliances(job, s, job->signal[r].position[2], k, g);
            const double complex radial = force[0] * xx + force[1] * xy,
                                 radial_y = force[0] * xy + force[1] * (plain - xx);
            const double scale = weight * k / job->ground->ground.mu;
            to[0] = scale * (I * g[1] * force[2] * x + g[2] * radial + g[4] * (force[0] * plain - radial));
            to[frequencies] =
                scale * (I * g[1] * force[2] * y + g[2] * radial_y + g[4] * (force[1] * plain - radial_y));
            to[2 * frequencies] =
                scale * (g[0] * force[2] * plain + I * g[3] * (force[0] * x + force[1] * y));
        }
}

static double taper(const struct job *job, double k)
{
    if (k <= job->flat) return 1;
    const double y = fmin(1, (k - job->flat) / (job->end - job->flat));
    return .5 * (1 + cos(M_PI * y * y * y * (10 - y * (15 - 6 * y))));
}

/* Adds a patch to the spectra. Batches of wavenumbers run in parallel and are added in order. */
static bool add_patch(const struct job *job, double complex *spectrum)
{
    const size_t lines = job->receivers * 3 * job->frequencies;
    const size_t panels = (size_t)ceil(job->end / job->panel);
    double complex *share = array_new(BATCH * lines, sizeof *share);
    bool room = share != NULL;
    for (size_t batch = 0; room && batch < panels * 12; batch += BATCH) {
#pragma omp parallel
        {
            double complex *line = array_new(job->frequencies, sizeof *line);
            double complex *sum = array_new(job->receivers * SUMS * job->frequencies, sizeof *sum);
            if (line == NULL || sum == NULL) {
#pragma omp atomic write
                room = false;
            }
#pragma omp for schedule(dynamic, 1)
            for (size_t i = 0; i < BATCH; i++) {
                const size_t node = batch + i;
                const size_t panel = node / 12;
                const double k = job->panel * ((double)panel + .5 + .5 * gauss12_node[node % 12]);
                if (line != NULL && sum != NULL)
                    one_wavenumber(job, k, .5 * job->panel * gauss12_weight[node % 12] * taper(job, k), line,
                                   sum, share + i * lines);
            }
            array_free(line);
            array_free(sum);
        }
        const size_t count = panels * 12 - batch < BATCH ? panels * 12 - batch : BATCH;
        for (size_t i = 0; i < count && room; i++)
            for (size_t j = 0; j < lines; j++)
                spectrum[j] += share[i * lines + j];
    }
    array_free(share);
    return room;
}

/* Ranges of wavenumbers and directions for one patch; SELAS_BAD_SCENE if it cannot be. */
static selas_status prepare(struct job *job, struct messages *messages)
{
    const struct moving_patch *patch = job->patch;
    const struct lamb_problem *ground = job->ground;
    const struct layered *layers = ground->layers;
    const struct history *history = patch->load.history;
    const double slowest = layers != NULL ? layers->slowest : ground->ground.rayleigh_speed;
    const double p_speed = layers != NULL ? layers->fastest[0] : ground->ground.p_speed;
    const double s_speed = layers != NULL ? layers->fastest[1] : ground->ground.s_speed;
    const double speed = speed_of(patch), rough = history_cutoff(history, 1e-2);
    const double lasts = fmin(history_end(history), job->period);
    /* a Gaussian whose start is cut has a faint spectrum without end */
    job->table.cutoff = fmin(history_cutoff(history, 1e-8), 3 * history_cutoff(history, 1e-4));
    if (speed > .95 * slowest)
        return fail(
            messages, SELAS_BAD_SCENE,
            "reference 'lamb': a patch moves at %.4g; expected less than the slowest Rayleigh wave, %.4g",
            speed, slowest);
    if (!(history_cutoff(history, 1e-6) <= 60 * rough))
        return fail(messages, SELAS_BAD_SCENE,
                    "reference 'lamb': a moving patch needs a history without kinks; give it smoothing");
    double nearest = INFINITY, depth = INFINITY;
    job->reach = 0;
    for (size_t r = 0; r < job->receivers; r++) {
        const double *position = job->signal[r].position;
        depth = fmin(depth, position[2]);
        for (int i = 0; i <= 100; i++) {
            const double t = lasts * i / 100,
                         x = position[0] - patch->load.patch.centre[0] - patch->velocity[0] * t,
                         y = position[1] - patch->load.patch.centre[1] - patch->velocity[1] * t;
            job->reach =
                fmax(job->reach, hypot(x, y) + hypot(patch->load.patch.half[0], patch->load.patch.half[1]));
            nearest = fmin(nearest, sqrt(x * x + y * y + position[2] * position[2]));
        }
    }
    if (patch->load.patch.shape == PATCH_POINT && nearest <= speed * lasts / 100)
        return fail(
            messages, SELAS_BAD_SCENE,
            "reference 'lamb': a receiver lies on the path of a moving point load, where displacement is "
            "infinite");
    const double edge = patch->load.patch.shape == PATCH_POINT
                            ? nearest
                            : 2 * fmin(patch->load.patch.half[0], patch->load.patch.half[1]);
    const double waves = job->table.cutoff / (slowest - speed);
    const double buried = waves + 30 / (depth * sqrt(1 - pow(speed / slowest, 2)));
    job->flat = 1.1 * waves + 60 / edge;
    job->end = job->flat / .6;
    if (buried < job->flat) job->flat = job->end = buried;
    job->panel = fmin(12 / job->reach, job->decay * fmin(2 / s_speed, 6 / p_speed));
    job->horizontal = patch->load.traction[0] != 0 || patch->load.traction[1] != 0;
    return SELAS_OK;
}

/* Histories from spectra: u = e^(eta t) (1/T) sum over all j. */
static bool to_time(const struct job *job, double end_time, const double complex *spectrum,
                    struct lamb_signal *signal)
{
    size_t rows = 256;
    while (rows < 16 * job->frequencies)
        rows *= 2;
    fftw_plan plan = NULL;
    double complex *in = fftw_malloc((rows / 2 + 1) * sizeof *in);
    double *out = fftw_malloc(rows * sizeof *out);
#pragma omp critical(selas_fftw_planner)
    if (in != NULL && out != NULL) plan = fftw_plan_dft_c2r_1d((int)rows, in, out, FFTW_ESTIMATE);
    bool room = plan != NULL;
    for (size_t r = 0; room && r < job->receivers; r++) {
        signal[r].end_time = end_time;
        signal[r].decay = job->decay;
        signal[r].step = job->period / (double)rows;
        signal[r].rows = (size_t)(end_time / signal[r].step) + 16;
        if (signal[r].rows > rows) signal[r].rows = rows;
        signal[r].value = array_new(6 * signal[r].rows, sizeof *signal[r].value);
        room = signal[r].value != NULL;
        for (size_t c = 0; room && c < 6; c++) {
            memset(in, 0, (rows / 2 + 1) * sizeof *in);
            for (size_t j = 0; j < job->frequencies; j++)
                in[j] = spectrum[(r * 3 + c % 3) * job->frequencies + j] / job->period *
                        (c < 3 ? 1 : job->decay + I * (2 * M_PI * (double)j / job->period));
            fftw_execute(plan);
            memcpy(signal[r].value + c * signal[r].rows, out, signal[r].rows * sizeof *out);
        }
    }
#pragma omp critical(selas_fftw_planner)
    if (plan != NULL) fftw_destroy_plan(plan);
    fftw_free(in);
    fftw_free(out);
    return room;
}

selas_status lamb_moving(const struct lamb_problem *ground, size_t patches, const struct moving_patch *patch,
                         double end_time, size_t n, struct lamb_signal *signal, struct messages *messages)
{
    struct job job = {.ground = ground, .receivers = n, .signal = signal, .period = 2.2 * end_time};
    selas_status status = SELAS_OK;
    double highest = 0;
    job.decay = 16 / job.period;
    for (size_t r = 0; r < n; r++)
        signal[r].value = signal[r].statics = NULL;
    for (size_t l = 0; l < patches && status == SELAS_OK; l++) {
        job.patch = &patch[l];
        status = prepare(&job, messages);
        highest = fmax(highest, job.table.cutoff + speed_of(job.patch) * job.end);
    }
    if (status != SELAS_OK) return status;
    job.frequencies = (size_t)ceil(highest * job.period / (2 * M_PI)) + 1;
    double complex *spectrum = array_new(n * 3 * job.frequencies, sizeof *spectrum);
    bool room = spectrum != NULL;
    for (size_t l = 0; l < patches && room && status == SELAS_OK; l++) {
        job.patch = &patch[l];
        status = prepare(&job, messages);
        room = fill_table(patch[l].load.history, job.decay, 2 * M_PI / (DENSITY * job.period), &job.table) &&
               add_patch(&job, spectrum);
        array_free(job.table.value);
    }
    room = room && to_time(&job, end_time, spectrum, signal);
    array_free(spectrum);
    if (room) return SELAS_OK;
    for (size_t r = 0; r < n; r++)
        lamb_signal_free(&signal[r]);
    return fail(messages, SELAS_NO_MEMORY, "not enough memory for the reference of a moving patch");
}
