/* Moving patches on the half-space. A patch X(x - V t) f(t) has the transform X(k) f^(s + i k.V), so that
 * (doc/theory/sources.md, Eqs 8-10)
 *   u(x, s) = 1/(4 pi^2) int int G(k, s) X(k) f^(s + i k.V) exp(i k.x) k dk dphi :
 * wavenumbers by Gauss panels, directions by the trapezoidal rule, which is exact once it resolves k times
 * the farthest distance, frequencies by FFT along Re s = eta as in lamb_fft.c. Along one (k, phi) all
 * frequencies read f^ at one offset, so that one set of interpolation weights serves them all.
 *
 * A direction n rings with the Rayleigh wave while |c_R + V.n| k lies within the spectrum of f: for a patch
 * faster than that wave up to the shortest waves of the patch where it meets the wave (its Mach lines), not
 * far beyond the spectrum elsewhere. So each direction has an end of its own. */
#include "exact/lamb_moving.h"

#include "base/fft_room.h"
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
    double period, decay, reach, panel;
    double slowest, s_speed; /* Rayleigh and S waves */
    /* wavenumbers: faded out from `near` without resonance, `far` later beyond the S speed, from `sharp` with
     * resonance; `end`: the largest */
    double near, far, sharp, end;
    bool horizontal;
};

static const double FLAT = .6; /* share of the wavenumbers that is not faded out */
/* Wavenumbers, times the patch's edge, from which directions are faded out. */
static const double RESTING = 60, FORCED = 120, RADIATING = 240, RINGING = 400;

/* Frequencies that one wavenumber reaches: none if last < first. */
struct span {
    long first, last;
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

/* Lagrange's weights of the entries -BEFORE .. POINTS - 1 - BEFORE at x in [0, 1). */
static void lagrange(double x, double weight[POINTS])
{
    /* (-1)^(11 - i) i! (11 - i)! */
    static const double denominator[POINTS] = {-39916800, 3628800, -725760, 241920, -120960,  86400,
                                               -86400,    120960,  -241920, 725760, -3628800, 39916800};
    double below = 1, above = 1;
    for (int i = 0; i < POINTS; i++) {
        weight[i] = below / denominator[i];
        below *= x + BEFORE - i;
    }
    for (int i = POINTS - 1; i >= 0; i--) {
        weight[i] *= above;
        above *= x + BEFORE - i;
    }
}

/* f^ at one offset for all frequencies of *span that it reaches; value[j - span->first]. */
static void read_table(const struct job *job, double along, struct span *span, double complex *value)
{
    const double place = along * DENSITY * job->period / (2 * M_PI), whole = floor(place);
    const long offset = (long)whole, half = (long)job->table.half;
    double weight[POINTS];
    span->first = (long)fmax(0, ceil((double)(-half - offset) / DENSITY));
    span->last = (long)fmin((double)job->frequencies - 1, floor((double)(half - offset) / DENSITY));
    if (span->last < span->first) return;
    lagrange(place - whole, weight);
    for (long j = span->first; j <= span->last; j++) {
        const double complex *at = job->table.value + (DENSITY * j + offset + half + POINTS - BEFORE);
        double re = 0, im = 0;
        for (int i = 0; i < POINTS; i++) {
            re += weight[i] * creal(at[i]);
            im += weight[i] * cimag(at[i]);
        }
        value[j - span->first] = re + I * im;
    }
}

/* to += factor * line over the span, by parts: the compiler's complex product tests for NaN. */
static void add_line(struct span span, const double complex *line, double complex factor, double complex *to)
{
    const double re = creal(factor), im = cimag(factor);
    for (long j = span.first; j <= span.last; j++) {
        const double complex value = line[j - span.first];
        to[j] += re * creal(value) - im * cimag(value) + I * (re * cimag(value) + im * creal(value));
    }
}

/* Fades a direction out, `along` = V.n (doc/theory/sources.md, Eq 10). */
static double taper(const struct job *job, double k, double along)
{
    const double gap = fabs(job->slowest + along);
    /* where the patch is faster than S waves, these leave into the ground from its edges */
    const double radiates = fmin(1, fmax(0, (-along / job->s_speed - .7) / .3));
    const double near = job->near + radiates * radiates * (3 - 2 * radiates) * job->far;
    const double flat = fmin(job->sharp, near + 1.1 * job->table.cutoff / gap);
    const double y = (k / flat - 1) / (1 / FLAT - 1);
    if (y <= 0 || y >= 1) return y <= 0 ? 1 : 0;
    return .5 * (1 + cos(M_PI * y * y * y * (10 - y * (15 - 6 * y))));
}

/* Adds up over the directions X f^ exp(i k.d) times 1, n_x, n_y, n_x^2, n_x n_y, over 2 pi:
 * sum[(receiver * SUMS + s) * frequencies + j]. Returns the frequencies that were added to. */
static struct span sum_directions(const struct job *job, double k, double complex *line, double complex *sum)
{
    const struct patch *patch = &job->patch->load.patch;
    const size_t frequencies = job->frequencies;
    const double reach = k * job->reach;
    const int directions = (int)(1.1 * reach + 12 * cbrt(reach)) + 40;
    struct span all = {(long)frequencies, -1};
    for (int d = 0; d < directions; d++) {
        const double angle = 2 * M_PI * d / directions, c = cos(angle), s = sin(angle);
        const double along = c * job->patch->velocity[0] + s * job->patch->velocity[1];
        const double part[SUMS] = {1, c, s, c * c, c * s}, faded = taper(job, k, along);
        struct span span;
        if (faded <= 0) continue;
        read_table(job, k * along, &span, line);
        if (span.last < span.first) continue;
        all.first = span.first < all.first ? span.first : all.first;
        all.last = span.last > all.last ? span.last : all.last;
        const double complex whole = faded * shape(patch, k * c, k * s, k) / (2 * M_PI * directions);
        for (size_t r = 0; r < job->receivers; r++) {
            const double *position = job->signal[r].position;
            const double phase =
                k * (c * (position[0] - patch->centre[0]) + s * (position[1] - patch->centre[1]));
            const double complex turn = whole * (cos(phase) + I * sin(phase));
            for (int m = 0; m < (job->horizontal ? SUMS : 3); m++) {
                add_line(span, line, turn * part[m], sum + (r * SUMS + (size_t)m) * frequencies);
            }
        }
    }
    return all;
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

/* One wavenumber's share of the spectra: share[(receiver * 3 + component) * frequencies + j] for the j
 * returned. `sum` is 0 before and after. */
static struct span one_wavenumber(const struct job *job, double k, double weight, double complex *line,
                                  double complex *sum, double complex *share)
{
    const double *force = job->patch->load.traction;
    const size_t frequencies = job->frequencies;
    const struct span span = sum_directions(job, k, line, sum);
    for (size_t r = 0; r < job->receivers; r++)
        for (long j = span.first; j <= span.last; j++) {
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
    for (size_t i = 0; i < job->receivers * SUMS && span.first <= span.last; i++)
        memset(sum + i * frequencies + span.first, 0, (size_t)(span.last - span.first + 1) * sizeof *sum);
    return span;
}

/* Adds a patch to the spectra. Batches of wavenumbers run in parallel and are added in order. */
static bool add_patch(const struct job *job, double complex *spectrum)
{
    const size_t lines = job->receivers * 3 * job->frequencies;
    const size_t panels = (size_t)ceil(job->end / job->panel);
    double complex *share = array_new(BATCH * lines, sizeof *share);
    bool room = share != NULL;
    for (size_t batch = 0; room && batch < panels * 12; batch += BATCH) {
        struct span span[BATCH];
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
                    span[i] = one_wavenumber(job, k, .5 * job->panel * gauss12_weight[node % 12], line, sum,
                                             share + i * lines);
            }
            array_free(line);
            array_free(sum);
        }
        const size_t count = panels * 12 - batch < BATCH ? panels * 12 - batch : BATCH;
        for (size_t i = 0; i < count && room; i++)
            for (size_t r = 0; r < job->receivers * 3; r++)
                for (long j = span[i].first; j <= span[i].last; j++)
                    spectrum[r * job->frequencies + (size_t)j] +=
                        share[i * lines + r * job->frequencies + (size_t)j];
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
    const double slowest = job->slowest = layers != NULL ? layers->slowest : ground->ground.rayleigh_speed;
    const double p_speed = layers != NULL ? layers->fastest[0] : ground->ground.p_speed;
    const double s_speed = job->s_speed = layers != NULL ? layers->fastest[1] : ground->ground.s_speed;
    const double speed = speed_of(patch), rough = history_cutoff(history, 1e-2);
    const double lasts = fmin(history_end(history), job->period);
    /* a Gaussian whose start is cut has a faint spectrum without end */
    job->table.cutoff = fmin(history_cutoff(history, 1e-8), 3 * history_cutoff(history, 1e-4));
    const bool fast = speed > .95 * slowest, point = patch->load.patch.shape == PATCH_POINT;
    if (fast && (layers != NULL || point))
        return fail(messages, SELAS_BAD_SCENE,
                    "reference 'lamb': %s moves at %.4g; expected less than the slowest Rayleigh wave, %.4g",
                    point ? "a point load" : "a load on layers", speed, slowest);
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
    if (point && nearest <= speed * lasts / 100)
        return fail(
            messages, SELAS_BAD_SCENE,
            "reference 'lamb': a receiver lies on the path of a moving point load, where displacement is "
            "infinite");
    const double edge = point ? nearest : 2 * fmin(patch->load.patch.half[0], patch->load.patch.half[1]);
    const double waves = fast ? INFINITY : job->table.cutoff / (slowest - speed);
    const double buried = fast ? INFINITY : waves + 30 / (depth * sqrt(1 - pow(speed / slowest, 2)));
    job->near = (fast ? FORCED : RESTING) / edge;
    job->far = fast ? (RADIATING - FORCED) / edge : 0;
    job->sharp = fast ? RINGING / edge : INFINITY;
    job->end = fmin(job->near + 1.1 * waves, job->sharp) / FLAT;
    if (buried < FLAT * job->end) job->near = job->end = buried;
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
    if (in != NULL && out != NULL && fft_room(rows))
        plan = fftw_plan_dft_c2r_1d((int)rows, in, out, FFTW_ESTIMATE);
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

/* Receivers that share their compliances and the memory for them; without `compute` what is refused is all. */
static selas_status one_group(const struct lamb_problem *ground, size_t patches,
                              const struct moving_patch *patch, double end_time, size_t n,
                              struct lamb_signal *signal, bool compute, struct messages *messages)
{
    struct job job = {.ground = ground, .receivers = n, .signal = signal, .period = 2.2 * end_time};
    selas_status status = SELAS_OK;
    double highest = 0;
    job.decay = 16 / job.period;
    for (size_t l = 0; l < patches && status == SELAS_OK; l++) {
        job.patch = &patch[l];
        status = prepare(&job, messages);
        highest = fmax(highest, job.table.cutoff + speed_of(job.patch) * job.end);
    }
    if (status != SELAS_OK || !compute) return status;
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
    return fail(messages, SELAS_NO_MEMORY, "not enough memory for the reference of a moving patch");
}

selas_status lamb_moving(const struct lamb_problem *ground, size_t patches, const struct moving_patch *patch,
                         double end_time, size_t n, struct lamb_signal *signal, bool compute,
                         struct messages *messages)
{
    enum { GROUP = 16 };
    selas_status status = SELAS_OK;
    for (size_t r = 0; r < n; r++)
        signal[r].value = signal[r].statics = signal[r].front = NULL;
    for (size_t r = 0; r < n && status == SELAS_OK; r += GROUP)
        status = one_group(ground, patches, patch, end_time, n - r < GROUP ? n - r : GROUP, signal + r,
                           compute, messages);
    for (size_t r = 0; r < n && status != SELAS_OK; r++)
        lamb_signal_free(&signal[r]);
    return status;
}
