/* Mechanisms by least squares on the complex modulus, weights not negative (Emmerich & Korn, Geophysics 52
 * (1987) 1252-1264, for the spectrum; Blanc et al., Geophys. J. Int. 205 (2016) 378-391, for constrained
 * fits): min sum_k W_k^2 |M_u (1 - sum_l Y_l F_l(w_k))/M_Q(i w_k) - 1|^2,  F_l = r_l/(r_l + i w), (26) linear
 * in M_u and M_u Y_l >= 0 (NNLS of Lawson & Hanson 1974); the rates by the simplex of Nelder & Mead on their
 * logarithms. Shear first; then the bulk modulus on what shear leaves of lambda + 2 mu. */
#include "damping/relaxation.h"

#include "base/gsl_errors.h"

#include <gsl/gsl_linalg.h>
#include <gsl/gsl_multimin.h>
#include <math.h>
#include <string.h>

enum { ROWS = 2 * RELAXATION_SAMPLES, COLUMNS = MOST_MECHANISMS + 1 };

/* A x = b in least squares with x >= 0. */
struct squares {
    size_t columns;
    double a[ROWS][COLUMNS], b[ROWS];
};

/* Least squares in the columns that are in use, 0 elsewhere: QR by Householder. False: singular. */
static bool solve_used(const struct squares *squares, const bool *used, double x[COLUMNS])
{
    double matrix[ROWS * COLUMNS], tau[COLUMNS], solution[COLUMNS], residual[ROWS], right[ROWS];
    size_t place[COLUMNS], n = 0;
    for (size_t j = 0; j < squares->columns; j++)
        if (used[j]) place[n++] = j;
    for (size_t i = 0; i < ROWS; i++) {
        right[i] = squares->b[i];
        for (size_t j = 0; j < n; j++)
            matrix[i * n + j] = squares->a[i][place[j]];
    }
    gsl_matrix_view qr = gsl_matrix_view_array(matrix, ROWS, n);
    gsl_vector_view t = gsl_vector_view_array(tau, n), s = gsl_vector_view_array(solution, n);
    gsl_vector_view r = gsl_vector_view_array(residual, ROWS), b = gsl_vector_view_array(right, ROWS);
    gsl_linalg_QR_decomp(&qr.matrix, &t.vector);
    if (gsl_linalg_QR_lssolve(&qr.matrix, &t.vector, &b.vector, &s.vector, &r.vector) != GSL_SUCCESS)
        return false;
    for (size_t j = 0; j < squares->columns; j++)
        x[j] = 0;
    for (size_t j = 0; j < n; j++)
        x[place[j]] = solution[j];
    return true;
}

static double residual_of(const struct squares *squares, const double *x, double gradient[COLUMNS])
{
    double sum = 0;
    for (size_t j = 0; j < squares->columns; j++)
        gradient[j] = 0;
    for (size_t i = 0; i < ROWS; i++) {
        double left = squares->b[i];
        for (size_t j = 0; j < squares->columns; j++)
            left -= squares->a[i][j] * x[j];
        for (size_t j = 0; j < squares->columns; j++)
            gradient[j] += squares->a[i][j] * left;
        sum += left * left;
    }
    return sum;
}

/* From x towards the solution s of the columns in use as far as all stay >= 0; columns that become 0 leave.
 * True: all the way. */
static bool step_towards(const struct squares *squares, const double *s, double *x, bool *used)
{
    double share = 1;
    size_t stops = COLUMNS;
    for (size_t j = 0; j < squares->columns; j++)
        if (used[j] && s[j] <= 0 && x[j] / (x[j] - s[j]) < share) {
            share = x[j] / (x[j] - s[j]);
            stops = j;
        }
    for (size_t j = 0; j < squares->columns; j++)
        x[j] += share * (s[j] - x[j]);
    if (stops == COLUMNS) return true;
    used[stops] = false;
    x[stops] = 0;
    return false;
}

/* Lawson & Hanson (1974), ch. 23; gives the sum of squares that is left. */
static double not_negative(const struct squares *squares, double x[COLUMNS])
{
    bool used[COLUMNS] = {false}, refused[COLUMNS] = {false};
    double gradient[COLUMNS], s[COLUMNS];
    memset(x, 0, COLUMNS * sizeof *x);
    for (int turn = 0; turn < 4 * COLUMNS; turn++) {
        residual_of(squares, x, gradient);
        size_t best = COLUMNS;
        for (size_t j = 0; j < squares->columns; j++)
            if (!used[j] && !refused[j] && gradient[j] > 0 &&
                (best == COLUMNS || gradient[j] > gradient[best]))
                best = j;
        if (best == COLUMNS) break;
        used[best] = true;
        for (int back = 0; back < COLUMNS; back++)
            if (!solve_used(squares, used, s) || step_towards(squares, s, x, used)) break;
        refused[best] = !used[best]; /* rounding: it would come and go for ever */
    }
    return residual_of(squares, x, gradient);
}

/* What a mechanism takes at an angular frequency; nothing above what steps carry, 2/dt un-warped, pi/dt as it is. */
static double complex taken_at(const struct relaxation_band *band, double rate, double w)
{
    const bool carried = w * band->by.dt < (band->by.corrected ? M_PI : 2);
    return carried ? mechanism_at(rate, &band->by, I * w) : 0;
}

/* Rows for a modulus that is to be fitted to target - given, counted relative to the target. */
static void set_squares(const struct relaxation_band *band, size_t mechanisms, const double *rate,
                        const double complex *target, const double complex *given, struct squares *squares)
{
    squares->columns = mechanisms + 1;
    for (size_t k = 0; k < RELAXATION_SAMPLES; k++) {
        const double w = band->angular_frequency[k], weight = sqrt(band->weight[k]);
        const double complex right = weight * (target[k] - (given != NULL ? given[k] : 0)) / target[k];
        squares->b[2 * k] = creal(right);
        squares->b[2 * k + 1] = cimag(right);
        for (size_t j = 0; j <= mechanisms; j++) {
            const double complex a = weight / target[k] * (j == 0 ? 1 : -taken_at(band, rate[j - 1], w));
            squares->a[2 * k][j] = creal(a);
            squares->a[2 * k + 1][j] = cimag(a);
        }
    }
}

void relaxation_band_set(struct relaxation_band *band, double top, relaxation_power *power,
                         const void *source)
{
    double sum = 0;
    band->by = (struct mechanism_step){.dt = 0};
    for (int k = 0; k < RELAXATION_SAMPLES; k++) {
        const double w = top * pow(10, -3. * (RELAXATION_SAMPLES - 1 - k) / (RELAXATION_SAMPLES - 1));
        band->angular_frequency[k] = w;
        band->weight[k] = power(source, w) * w;
        sum += band->weight[k];
    }
    for (int k = 0; k < RELAXATION_SAMPLES && sum > 0; k++)
        band->weight[k] /= sum;
}

double relaxation_centroid(const struct relaxation_band *band)
{
    double sum = 0, moment = 0;
    for (int k = 0; k < RELAXATION_SAMPLES; k++) {
        sum += band->weight[k];
        moment += band->weight[k] * band->angular_frequency[k];
    }
    return moment / sum;
}

double relaxation_quantile(const struct relaxation_band *band, double share)
{
    double sum = 0;
    for (size_t k = 0; k < RELAXATION_SAMPLES; k++)
        if ((sum += band->weight[k]) >= share) return band->angular_frequency[k];
    return band->angular_frequency[RELAXATION_SAMPLES - 1];
}

double relaxation_held(const struct relaxation_band *band, double angular_frequency)
{
    static const double from = .01, to = .99;
    return fmin(fmax(angular_frequency, relaxation_quantile(band, from)), relaxation_quantile(band, to));
}

/* --- Rates -------------------------------------------------------------------------------------------- */

struct search {
    const struct relaxation_band *band;
    size_t mechanisms;
    double complex target[RELAXATION_SAMPLES];
    struct squares *squares;
};

static double misfit_at(const gsl_vector *logarithms, void *data)
{
    const struct search *search = data;
    double rate[MOST_MECHANISMS], x[COLUMNS];
    double beyond = 0; /* not outside ten times the band */
    const double low = log(.1 * search->band->angular_frequency[0]);
    const double high = log(10 * search->band->angular_frequency[RELAXATION_SAMPLES - 1]);
    for (size_t l = 0; l < search->mechanisms; l++) {
        const double at = gsl_vector_get(logarithms, l), held = fmin(fmax(at, low), high);
        beyond += (at - held) * (at - held);
        rate[l] = exp(held);
    }
    set_squares(search->band, search->mechanisms, rate, search->target, NULL, search->squares);
    return log(not_negative(search->squares, x)) + beyond;
}

static void simplex(struct search *search, gsl_vector *start, gsl_vector *step,
                    gsl_multimin_fminimizer *minimizer, double rate[MOST_MECHANISMS])
{
    enum { TURNS = 4, STEPS = 400 };
    gsl_multimin_function function = {misfit_at, search->mechanisms, search};
    for (int turn = 0; turn < TURNS; turn++) { /* started again from where it ended: it may have collapsed */
        gsl_vector_set_all(step, turn == 0 ? .7 : .3);
        gsl_multimin_fminimizer_set(minimizer, &function, start, step);
        for (int i = 0; i < STEPS && gsl_multimin_fminimizer_size(minimizer) > 1e-5; i++)
            if (gsl_multimin_fminimizer_iterate(minimizer) != GSL_SUCCESS) break;
        gsl_vector_memcpy(start, minimizer->x);
    }
    for (size_t l = 0; l < search->mechanisms; l++)
        rate[l] = exp(gsl_vector_get(start, l));
}

selas_status relaxation_rates(const struct relaxation_band *band, const struct modulus *wanted,
                              size_t mechanisms, double rate[MOST_MECHANISMS], double *misfit,
                              struct messages *messages)
{
    struct squares squares;
    struct search search = {.band = band, .mechanisms = mechanisms, .squares = &squares};
    const double low = .3 * relaxation_quantile(band, .02), high = 3 * relaxation_quantile(band, .98);
    for (size_t k = 0; k < RELAXATION_SAMPLES; k++)
        search.target[k] = modulus_at(wanted, I * band->angular_frequency[k]);
    gsl_errors_returned();
    gsl_vector *start = gsl_vector_alloc(mechanisms), *step = gsl_vector_alloc(mechanisms);
    gsl_multimin_fminimizer *minimizer =
        gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, mechanisms);
    const bool room = start != NULL && step != NULL && minimizer != NULL;
    if (room) {
        for (size_t l = 0; l < mechanisms; l++)
            gsl_vector_set(start, l, log(low) + log(high / low) * ((double)l + .5) / (double)mechanisms);
        simplex(&search, start, step, minimizer, rate);
        *misfit = exp(.5 * misfit_at(start, &search)) / modulus_loss(wanted, wanted->angular_frequency);
    }
    gsl_vector_free(start);
    gsl_vector_free(step);
    if (minimizer != NULL) gsl_multimin_fminimizer_free(minimizer);
    gsl_errors_as_before();
    return room ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory to fit relaxation mechanisms");
}

/* --- Weights ------------------------------------------------------------------------------------------ */

/* Gives the modulus the phase speed of `size` at the angular frequency: size_u = size [Re m^(-1/2)]^2. */
static void keep_speed(double size, double angular_frequency, struct modulus *modulus)
{
    modulus->size = 1;
    const double slowness = creal(1 / csqrt(modulus_at(modulus, I * angular_frequency)));
    modulus->size = size * slowness * slowness;
}

/* rho c^2 at its reference frequency, of constant Q. */
static double reference_size(const struct modulus *modulus)
{
    const double cosine = cos(.25 * M_PI * modulus->power);
    return modulus->size / (cosine * cosine);
}

/* rho c^2 of what is wanted, at an angular frequency. */
static double size_at(const struct modulus *wanted, double angular_frequency)
{
    if (angular_frequency == wanted->angular_frequency) return reference_size(wanted);
    const double speed = modulus_speed(wanted, 1, angular_frequency);
    return speed * speed;
}

/* The same for lambda + 2 mu, whose weights grow where the bulk modulus, what is left of it without shear,
 * would otherwise have negative ones. False: what is left when all is relaxed is negative. */
static bool keep_passive(const struct modulus *wanted, double held, const struct modulus *shear,
                         struct modulus *axial)
{
    enum { TURNS = 60 }; /* each leaves about a tenth of what the last one changed */
    double relaxed = 0;
    for (int turn = 0; turn < TURNS; turn++) {
        keep_speed(size_at(wanted, held), held, axial);
        for (size_t l = 0; l < axial->mechanisms; l++)
            axial->weight[l] = fmax(axial->weight[l], 4. / 3 * shear->size * shear->weight[l] / axial->size);
    }
    relaxed = axial->size - 4. / 3 * shear->size;
    for (size_t l = 0; l < axial->mechanisms; l++)
        relaxed -= axial->size * axial->weight[l] - 4. / 3 * shear->size * shear->weight[l];
    return relaxed > 0;
}

static selas_status too_low(size_t mechanisms, const struct modulus *wanted, struct messages *messages)
{
    const double quality = 1 / modulus_loss(wanted, wanted->angular_frequency);
    return fail(messages, SELAS_BAD_SCENE,
                "damping: %zu relaxation mechanisms cannot stand for so low a Q over these frequencies "
                "(%.3g); expected more method%%mechanisms, up to 8, or a higher Q%s",
                mechanisms, quality, quality < 1 ? " (q_p and q_s are Q, not 1/Q)" : "");
}

selas_status relaxation_weights(const struct relaxation_band *band, size_t mechanisms,
                                const double rate[MOST_MECHANISMS], const struct modulus *wanted,
                                double weight[MOST_MECHANISMS], struct messages *messages)
{
    struct squares squares;
    double complex target[RELAXATION_SAMPLES];
    double x[COLUMNS], sum = 0;
    for (size_t k = 0; k < RELAXATION_SAMPLES; k++)
        target[k] = modulus_at(wanted, I * band->angular_frequency[k]);
    gsl_errors_returned();
    set_squares(band, mechanisms, rate, target, NULL, &squares);
    not_negative(&squares, x);
    gsl_errors_as_before();
    for (size_t l = 0; l < mechanisms; l++)
        sum += weight[l] = x[l + 1] / x[0];
    return x[0] > 0 && sum < 1 ? SELAS_OK : too_low(mechanisms, wanted, messages);
}

selas_status relaxation_fit(const struct relaxation_band *band, size_t mechanisms,
                            const double rate[MOST_MECHANISMS], struct modulus *axial, struct modulus *shear,
                            struct messages *messages)
{
    struct squares squares;
    double complex target[RELAXATION_SAMPLES], given[RELAXATION_SAMPLES];
    double s[COLUMNS], bulk[COLUMNS], sum[2] = {0, 0};
    struct modulus fitted[2] = {{.mechanisms = mechanisms, .by = band->by},
                                {.mechanisms = mechanisms, .by = band->by}};
    for (size_t k = 0; k < RELAXATION_SAMPLES; k++)
        target[k] = modulus_at(shear, I * band->angular_frequency[k]);
    gsl_errors_returned();
    set_squares(band, mechanisms, rate, target, NULL, &squares);
    not_negative(&squares, s);
    for (size_t k = 0; k < RELAXATION_SAMPLES; k++) {
        const double w = band->angular_frequency[k];
        target[k] = modulus_at(axial, I * w);
        given[k] = s[0];
        for (size_t l = 0; l < mechanisms; l++)
            given[k] -= s[l + 1] * taken_at(band, rate[l], w);
        given[k] *= 4. / 3;
    }
    set_squares(band, mechanisms, rate, target, given, &squares);
    not_negative(&squares, bulk);
    gsl_errors_as_before();
    for (size_t l = 0; l < mechanisms; l++) {
        fitted[0].rate[l] = fitted[1].rate[l] = rate[l];
        fitted[0].weight[l] = (bulk[l + 1] + 4. / 3 * s[l + 1]) / (bulk[0] + 4. / 3 * s[0]);
        fitted[1].weight[l] = s[l + 1] / s[0];
        sum[0] += fitted[0].weight[l];
        sum[1] += fitted[1].weight[l];
    }
    const double held = relaxation_held(band, shear->angular_frequency);
    keep_speed(size_at(shear, held), held, &fitted[1]);
    if (!(s[0] > 0 && bulk[0] > 0 && sum[0] < 1 && sum[1] < 1) ||
        !keep_passive(axial, held, &fitted[1], &fitted[0]))
        return too_low(mechanisms, axial, messages);
    *axial = fitted[0];
    *shear = fitted[1];
    return SELAS_OK;
}
