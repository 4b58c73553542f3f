/* Seismograms by FFT over frequencies s = eta + 2 pi i j / T (doc/theory/seismograms.md, Eqs 29-36). Frequencies are
 * worked off in bands of half an octave, each with its own wavenumbers. Some frequencies of every band are
 * computed once more with narrower panels and a larger range: what differs bounds the error of the sums, and
 * where it is too large the band is made anew. The bands end when what is to come is below the tolerance. */
#include "exact/seismogram.h"

#include "base/memory.h"
#include "exact/contour.h"
#include "exact/rows.h"
#include "exact/seismogram_work.h"

#include <math.h>
#include <string.h>

enum { SAMPLES = 3, MOST_BANDS = 64, ATTEMPTS = 4 };

/* Wavenumbers times levels: what is spent once the histories' main frequencies are in. */
static const double MOST_EVALUATIONS = 5e7;

/* Waves after the period may be so much louder than those before its end. */
static const double LOUDER = 10;

/* What was found of a receiver's velocity with one kind of edge: its norm, that of what the last band added, and what
 * is missing of it, estimated. */
struct edge {
    double norm, last, missing;
};

struct work {
    const struct seismogram_problem *problem;
    struct sums sums;
    size_t receivers;
    struct seismogram *seismogram;
    struct contour contour;
    double tolerance, growth; /* growth: of errors by exp(decay t), in L2 over [0, end] */
    struct finesse finesse;
    size_t components, frequencies, room;
    double complex *spectrum; /* [receivers * components][room]: displacement (and stress) */
    double *missed;           /* [receivers]: squares of the sums' errors of velocity */
    double *least;            /* [receivers]: norm of velocity below which nothing is judged */
    struct edge *edge;        /* [receivers][2]: cut off at the last frequency; faded out */
    bool faded;               /* which of the two leaves less */
};

static selas_status no_memory(struct messages *messages)
{
    return fail(messages, SELAS_NO_MEMORY, "not enough memory for seismograms");
}

/* --- Bands -------------------------------------------------------------------------------------------- */

/* Sum over receivers' velocity components of |s|^2 |difference|^2, the mean of the samples. */
static void add_missed(const struct work *work, size_t n, const size_t *sample, size_t count,
                       const double complex *coarse, const double complex *fine, double *missed)
{
    for (size_t r = 0; r < work->receivers; r++) {
        double largest = 0;
        for (size_t c = 0; c < 3; c++) {
            double sum = 0;
            for (size_t i = 0; i < SAMPLES; i++) {
                const size_t j = sample[i];
                const double complex rough = coarse[(r * n + j - work->frequencies) * COMPONENTS + c];
                const double part = cabs(contour_frequency(&work->contour, j) *
                                         (rough - fine[(r * SAMPLES + i) * COMPONENTS + c]));
                sum += part * part;
            }
            largest = fmax(largest, sum / SAMPLES);
        }
        missed[r] = largest * (double)count * 2 / work->contour.period;
    }
}

/* Square of the norm, exp(-decay t) times velocity over the period, of the largest component. */
static double damped_norm(const struct work *work, size_t receiver, size_t n, const double complex *value)
{
    double largest = 0;
    for (size_t c = 0; c < 3; c++) {
        double sum = 0;
        for (size_t j = 0; j < work->frequencies; j++) {
            const double part = cabs(contour_frequency(&work->contour, j) *
                                     work->spectrum[(receiver * work->components + c) * work->room + j]);
            sum += part * part;
        }
        for (size_t j = 0; j < n; j++) {
            const double part = cabs(contour_frequency(&work->contour, work->frequencies + j) *
                                     value[(receiver * n + j) * COMPONENTS + c]);
            sum += part * part;
        }
        largest = fmax(largest, sum);
    }
    return largest * 2 / work->contour.period;
}

/* Whether the sums of a band are right enough, as far as can be known before all bands are in. */
static bool right_enough(const struct work *work, size_t n, const double complex *value, const double *missed)
{
    for (size_t r = 0; r < work->receivers; r++) {
        const double norm = fmax(sqrt(damped_norm(work, r, n, value)), work->least[r]);
        if (work->growth * sqrt(missed[r]) > .2 * work->tolerance * norm) return false;
    }
    return true;
}

/* Frequencies [work->frequencies, until) into value; *missed: errors. */
static bool sum_band(struct work *work, size_t until, double complex *value, double *missed)
{
    const size_t from = work->frequencies, n = until - from;
    const size_t sample[SAMPLES] = {from, from + (n - 1) / 2, until - 1};
    double complex *s = array_new(n, sizeof *s), few[SAMPLES];
    double complex *fine = array_new(work->receivers * SAMPLES * COMPONENTS, sizeof *fine);
    bool room = s != NULL && fine != NULL;
    struct band band;
    band_set(&band, work->problem, contour_frequency(&work->contour, from),
             contour_frequency(&work->contour, until - 1));
    for (size_t j = 0; j < n && room; j++)
        s[j] = contour_frequency(&work->contour, from + j);
    for (int i = 0; i < SAMPLES; i++)
        few[i] = contour_frequency(&work->contour, sample[i]);
    for (int attempt = 0; room; attempt++) {
        const struct finesse finer = {work->finesse.digits + 5, 1.35 * work->finesse.finer};
        room = sums_at(&work->sums, &band, work->finesse, n, s, false, value) &&
               sums_at(&work->sums, &band, finer, SAMPLES, few, false, fine);
        if (!room) break;
        add_missed(work, n, sample, n, value, fine, missed);
        if (attempt + 1 == ATTEMPTS || right_enough(work, n, value, missed)) break;
        work->finesse = finer;
    }
    array_free(s);
    array_free(fine);
    return room;
}

static bool add_band(struct work *work, double cutoff)
{
    const size_t until = (size_t)ceil(cutoff * work->contour.period / (2 * M_PI)) + 1,
                 n = until - work->frequencies;
    if (until <= work->frequencies) return true;
    double complex *value = array_new(work->receivers * n * COMPONENTS, sizeof *value);
    double *missed = array_new(work->receivers, sizeof *missed);
    const bool right = value != NULL && missed != NULL &&
                       contour_widen(&work->spectrum, work->receivers * work->components, work->frequencies,
                                     until, &work->room) &&
                       sum_band(work, until, value, missed);
    for (size_t r = 0; r < work->receivers && right; r++) {
        work->missed[r] += missed[r];
        for (size_t c = 0; c < work->components; c++)
            for (size_t j = 0; j < n; j++)
                work->spectrum[(r * work->components + c) * work->room + work->frequencies + j] =
                    value[(r * n + j) * COMPONENTS + c];
    }
    if (right) work->frequencies = until;
    array_free(value);
    array_free(missed);
    return right;
}

/* --- To time ------------------------------------------------------------------------------------------ */

/* Share of the frequencies that is faded out where histories go on above the last one: an edge rings, and what
 * rings grows by exp(decay t). */
static const double FADED = 1.0 / 3;

/* Frequencies [from, end) of one line of a receiver. */
static void transform(struct work *work, size_t receiver, size_t line, size_t from, bool faded)
{
    const size_t component = line < SEISMOGRAM_VELOCITY ? line : line - 3;
    contour_transform(&work->contour, work->spectrum + (receiver * work->components + component) * work->room,
                      from, work->frequencies, line >= SEISMOGRAM_VELOCITY && line < SEISMOGRAM_STRESS,
                      faded ? FADED : 0);
}

/* Largest L2 norm over [0, end] among the velocity components of the frequencies from `from` on. */
static double norm_from(struct work *work, size_t receiver, size_t from, bool faded)
{
    double largest = 0;
    for (size_t c = 0; c < 3; c++) {
        transform(work, receiver, SEISMOGRAM_VELOCITY + c, from, faded);
        largest = fmax(largest, contour_norm(&work->contour, work->problem->end_time));
    }
    return largest;
}

/* What is above the band from `from` on falls as the bands fell, or is less than an eighth of the last band where
 * the histories end there. */
static void look_above(struct work *work, size_t receiver, size_t from, bool end, bool faded)
{
    const size_t tail = work->frequencies - (work->frequencies - from) / 8;
    struct edge *edge = &work->edge[2 * receiver + faded];
    const double part = norm_from(work, receiver, from, faded);
    const double ratio = fmin(.8, fmax(.3, edge->last > 0 ? part / edge->last : .8));
    const double left = end ? norm_from(work, receiver, tail, false) : part * ratio / (1 - ratio);
    edge->last = part;
    edge->norm = fmax(norm_from(work, receiver, 0, faded), work->least[receiver]);
    edge->missing = edge->norm > 0 ? left / edge->norm : 0;
}

/* Notes what was reached with the band from `from` on, by the kind of edge that leaves less; the worst of the
 * receivers. */
static double judge(struct work *work, size_t from, double cutoff, bool end)
{
    double worst[2] = {0, INFINITY};
    for (int faded = 0; faded < (end ? 1 : 2); faded++) {
        worst[faded] = 0;
        for (size_t r = 0; r < work->receivers; r++) {
            look_above(work, r, from, end, faded == 1);
            worst[faded] = fmax(worst[faded], work->edge[2 * r + (size_t)faded].missing);
        }
    }
    work->faded = worst[1] < worst[0];
    for (size_t r = 0; r < work->receivers; r++) {
        struct seismogram_effort *effort = &work->seismogram[r].effort;
        const struct edge *edge = &work->edge[2 * r + work->faded];
        effort->cutoff = cutoff;
        effort->period = work->contour.period;
        effort->decay = work->contour.decay;
        effort->evaluations = work->sums.evaluations;
        effort->of_wavenumbers = edge->norm > 0 ? work->growth * sqrt(work->missed[r]) / edge->norm : 0;
        effort->of_frequencies = edge->missing;
        effort->of_period = LOUDER * exp(-work->contour.decay * work->contour.period);
        effort->reached = effort->of_wavenumbers + effort->of_frequencies + effort->of_period;
    }
    return worst[work->faded];
}

static bool keep(struct work *work)
{
    for (size_t r = 0; r < work->receivers; r++) {
        struct seismogram *seismogram = &work->seismogram[r];
        seismogram->end_time = work->problem->end_time;
        seismogram->decay = work->contour.decay;
        seismogram->step = work->contour.period / (double)work->contour.rows;
        seismogram->rows = (size_t)(seismogram->end_time / seismogram->step) + 16;
        if (seismogram->rows > work->contour.rows) seismogram->rows = work->contour.rows;
        seismogram->lines = work->problem->stress ? SEISMOGRAM_LINES : SEISMOGRAM_STRESS;
        seismogram->value = array_new(seismogram->lines * seismogram->rows, sizeof *seismogram->value);
        if (seismogram->value == NULL) return false;
        for (size_t line = 0; line < seismogram->lines; line++) {
            transform(work, r, line, 0, work->faded);
            memcpy(seismogram->value + line * seismogram->rows, work->contour.out,
                   seismogram->rows * sizeof *seismogram->value);
        }
    }
    return true;
}

/* --- The whole ---------------------------------------------------------------------------------------- */

/* What the whole histories of the sources would move each receiver by if all went slowly: a tenth of that is
 * the least that an error is measured by, so that a time before the waves come asks for nothing. */
static bool find_least(struct work *work)
{
    const struct seismogram_problem *problem = work->problem;
    double deepest = problem->rock[problem->rocks - 1].top, rate = 0;
    for (size_t i = 0; i < problem->sources; i++) {
        deepest = fmax(deepest, problem->source[i].position[2]);
        rate = fmax(rate, history_rate_norm(problem->source[i].history));
    }
    for (size_t r = 0; r < work->receivers; r++)
        deepest = fmax(deepest, work->seismogram[r].position[2]);
    const double speed = sqrt(problem->rock[0].shear.size / problem->rock[0].density);
    const double complex s = 1e-3 * speed / (deepest + work->sums.reach);
    double complex *value = array_new(work->receivers * COMPONENTS, sizeof *value);
    if (value == NULL) return false;
    struct band band;
    band_set(&band, problem, s, s);
    const bool room = sums_at(&work->sums, &band, (struct finesse){9, 1}, 1, &s, true, value);
    for (size_t r = 0; r < work->receivers && room; r++)
        for (size_t c = 0; c < 3; c++)
            work->least[r] = fmax(work->least[r], .1 * cabs(value[r * COMPONENTS + c]) * rate);
    array_free(value);
    return room;
}

static bool work_off_bands(struct work *work)
{
    double least = 0, most = 0;
    for (size_t i = 0; i < work->problem->sources; i++) {
        const struct history *history = work->problem->source[i].history;
        const double rough = history_cutoff(history, .02);
        if (isfinite(rough)) least = fmax(least, rough);
        most = fmax(most, history_cutoff(history, 1e-12));
    }
    double cutoff = fmin(most, fmax(8 * work->contour.decay, least / 16));
    for (int band = 0; band < MOST_BANDS; band++) {
        const size_t from = work->frequencies;
        if (!add_band(work, cutoff) || !contour_grid(&work->contour, work->frequencies)) return false;
        const double worst = judge(work, from, cutoff, cutoff >= most),
                     spent = work->sums.evaluations * (double)work->sums.strata.levels;
        const bool enough = (band > 1 && worst < .3 * work->tolerance) || spent > .5 * MOST_EVALUATIONS;
        if (cutoff >= most || (cutoff >= least && enough)) break;
        cutoff = fmin(cutoff * M_SQRT2, most);
    }
    return keep(work);
}

selas_status seismograms_check(const struct seismogram_problem *problem, size_t n,
                               const struct seismogram *seismogram, struct messages *messages)
{
    for (size_t r = 0; r < n; r++) {
        const double *place = seismogram[r].position;
        if (place[2] < 0) return fail(messages, SELAS_BAD_SCENE, "a receiver lies above the ground");
        for (size_t i = 0; i < problem->sources; i++) {
            const struct seismogram_source *source = &problem->source[i];
            if (source->patch.shape == PATCH_POINT && place[0] == source->position[0] &&
                place[1] == source->position[1] && place[2] == source->position[2])
                return fail(messages, SELAS_BAD_SCENE,
                            "a receiver lies at a point source, where all is infinite");
        }
    }
    return SELAS_OK;
}

static selas_status prepare(struct work *work, struct messages *messages)
{
    const struct seismogram_problem *problem = work->problem;
    const selas_status status = sums_set(&work->sums, problem, work->receivers, work->seismogram, messages);
    if (status != SELAS_OK) return status;
    work->tolerance = problem->tolerance > 0 ? problem->tolerance : 1e-6;
    const double digits = -log(work->tolerance);
    work->contour.period = (problem->stretch > 0 ? problem->stretch : 1.5) * problem->end_time;
    work->contour.decay = (digits + 2 + log(LOUDER)) / work->contour.period;
    const double exponent = 2 * work->contour.decay * problem->end_time;
    work->growth = sqrt(expm1(exponent) / exponent);
    work->finesse = (struct finesse){.5 * exponent + digits + 2, 1};
    work->components = problem->stress ? COMPONENTS : 3;
    work->missed = array_new(work->receivers, sizeof *work->missed);
    work->least = array_new(work->receivers, sizeof *work->least);
    work->edge = array_new(2 * work->receivers, sizeof *work->edge);
    if (work->missed == NULL || work->least == NULL || work->edge == NULL) return no_memory(messages);
    return seismograms_check(problem, work->receivers, work->seismogram, messages);
}

static void work_free(struct work *work)
{
    sums_free(&work->sums);
    array_free(work->spectrum);
    array_free(work->missed);
    array_free(work->least);
    array_free(work->edge);
    contour_free(&work->contour);
}

selas_status seismograms(const struct seismogram_problem *problem, size_t n, struct seismogram *seismogram,
                         struct messages *messages)
{
    struct work work = {.problem = problem, .receivers = n, .seismogram = seismogram};
    for (size_t r = 0; r < n; r++)
        seismogram[r].value = NULL;
    if (n == 0) return SELAS_OK;
    selas_status status = prepare(&work, messages);
    if (status == SELAS_OK && !(find_least(&work) && work_off_bands(&work))) status = no_memory(messages);
    work_free(&work);
    for (size_t r = 0; r < n && status != SELAS_OK; r++)
        seismogram_free(&seismogram[r]);
    return status;
}

void seismogram_free(struct seismogram *seismogram)
{
    array_free(seismogram->value);
    seismogram->value = NULL;
}

void seismogram_at(const struct seismogram *seismogram, double t, double value[SEISMOGRAM_LINES])
{
    const double growth = t > 0 ? exp(seismogram->decay * t) : 0;
    for (size_t line = 0; line < seismogram->lines; line++)
        value[line] = t > 0 ? growth * rows_between(seismogram->value + line * seismogram->rows,
                                                    seismogram->rows, t / seismogram->step)
                            : 0;
}
