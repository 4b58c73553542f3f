/* The speed that plane waves have on the lattice of the consistent method and in its schemes in time
 * (doc/theory/consistent-splines.md, section 11, Eqs T1 to T3), for scene%accuracy. */
#include "accuracy/lattice.h"

#include <math.h>

const struct accuracy_setting accuracy_settings[ACCURACY_SETTINGS] = {
    {2, 3, "leapfrog", 2, true, {.48, .38, .31}, 15},
    {2, 3, "modified-equation", 4, false, {.83, .66, .54}, 30},
    {3, 0, "modified-equation", 4, false, {.44, .33, .27}, 40},
    {4, 0, "modified-equation", 4, false, {.32, .24, .2}, 50},
};

/* Centred B-spline of degree n with knots one apart. */
static double bspline(int n, double x)
{
    double sum = 0, binomial = 1, factorial = 1;
    for (int j = 0; j <= n + 1; j++) {
        const double from = x + .5 * (n + 1) - j;
        if (from > 0) sum += binomial * pow(from, n);
        binomial *= -(double)(n + 1 - j) / (j + 1);
    }
    for (int j = 2; j <= n; j++)
        factorial *= j;
    return sum / factorial;
}

void lattice_wave_set(struct lattice_wave *wave, const struct accuracy_setting *setting)
{
    const int degree = setting->degree;
    wave->setting = setting;
    wave->transformed = setting->transforms && wave->scene->initial.kind == INITIAL_REST;
    for (int j = 0; j < LATTICE_OFFSETS; j++) {
        wave->mass[j] = bspline(2 * degree + 1, j);
        wave->stiffness[j] =
            2 * bspline(2 * degree - 1, j) - bspline(2 * degree - 1, j - 1) - bspline(2 * degree - 1, j + 1);
        wave->gradient[j] = bspline(2 * degree, j - .5) - bspline(2 * degree, j + .5);
    }
}

/* Frequency of exp(ik.x) in the interior, squared (Eqs T1 of the manual), along the motion that the wave
 * should have: right to second order in the other motion. */
static double square_frequency(const struct lattice_wave *wave, double spacing, double wavenumber)
{
    const struct material *material = &wave->scene->material[wave->scene->body.material];
    const double lambda = material->plane_lambda, mu = material->mu;
    double a[3] = {0}, c[3] = {0}, bare = 1, all = 0, sum = 0;
    for (int i = 0; i < wave->scene->dimension; i++) {
        const double angle = wavenumber * wave->direction[i] * spacing;
        double mass = wave->mass[0], stiffness = wave->stiffness[0], gradient = 0;
        for (int j = 1; j < LATTICE_OFFSETS; j++) {
            const double even = 2 * cos(j * angle);
            mass += even * wave->mass[j];
            stiffness += even * wave->stiffness[j];
            gradient += 2 * sin(j * angle) * wave->gradient[j];
        }
        const int sweeps = wave->setting->sweeps;
        const double inverse = (sweeps > 0 ? 1 - pow(1 - mass, sweeps + 1) : 1) / mass;
        if (i == wave->scene->dimension - 1 && sweeps > 0) bare = inverse * mass;
        a[i] = inverse * stiffness / (spacing * spacing);
        c[i] = inverse * gradient / spacing;
    }
    const int depth = wave->scene->dimension - 1;
    for (int i = 0; i < 3; i++) {
        if (i != depth) a[i] *= bare;
        all += a[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double mixed = (lambda + mu) * c[i] * c[j] * (i == depth || j == depth ? 1 : bare);
            const double same = (lambda + mu) * a[i] + mu * all;
            sum += wave->motion[i] * wave->motion[j] * (i == j ? same : mixed);
        }
    return sum / material->density;
}

/* Errors of lattice and scheme of opposite sign cancel at some spacing; what is left there is not what a run
 * finds, so that no more than this share of the larger one is taken as gone. */
static const double LEAST_LEFT = .1;
/* The modified equation's recorded velocity errs so many (omega dt)^4; dampers send back so many (omega
 * dt)^2; a wave reflected at a held end is so many (omega h/c)^3 off with sweeps in the place of the mass
 * (measured: regress/studies/accuracy/ends.sh; doc/verification/accuracy.md, section 5). */
static const double MODIFIED = .042, PLAIN_DAMPER = .0625, MODIFIED_DAMPER = .0833, HELD = .0165;

/* omega dt */
static double step_angle(const struct lattice_wave *wave, double spacing, double omega)
{
    const struct material *material = &wave->scene->material[wave->scene->body.material];
    return omega * wave->setting->courant[wave->scene->dimension - 1] * spacing / material->p_speed;
}

double lattice_speed_error(const struct lattice_wave *wave, double spacing, double omega)
{
    const double wavenumber = omega / wave->speed;
    if (wavenumber * spacing > M_PI) return 1;
    const double square = square_frequency(wave, spacing, wavenumber);
    const double space = sqrt(square) / omega - 1;
    if (wave->transformed) return space;
    const double angle = step_angle(wave, spacing, omega), x = angle * angle * square / (omega * omega);
    const double sine = wave->setting->order == 2 ? x : x * (1 - x / 12);
    const double both = 2 * asin(sqrt(fmin(1, sine / 4))) / angle - 1;
    return copysign(fmax(fabs(both), LEAST_LEFT * fabs(space)), both);
}

/* A spline wave exp(ik.x) has in it exp(i(k + 2 pi m / h).x), m = -1 and 1, by (theta / (theta + 2 pi
 * m))^(p+1) as much; an initial wave is right where it was interpolated, at lattice points for odd p, between
 * them for even p. */
static double reading_error(const struct lattice_wave *wave, double angle, double place)
{
    const int degree = wave->setting->degree;
    const double part = pow(angle / (2 * M_PI - angle), degree + 1);
    if (degree % 2 == 0) return 2 * part * sin(2 * M_PI * place);
    const double there = wave->scene->initial.kind == INITIAL_REST ? 0 : 1;
    return 2 * part * (there - cos(2 * M_PI * place));
}

double lattice_local_error(const struct lattice_wave *wave, double spacing, double omega,
                           const double position[3])
{
    const double square = pow(step_angle(wave, spacing, omega), 2);
    const double time = wave->transformed           ? 0
                        : wave->setting->order == 2 ? square / 6
                                                    : MODIFIED * square * square;
    double sum = time * time;
    for (int c = 0; c < wave->scene->dimension; c++) {
        const double angle = fabs(omega / wave->speed * spacing * wave->direction[c]);
        const double place = (position[c] - wave->scene->body.low[c]) / spacing;
        sum += pow(reading_error(wave, fmin(angle, M_PI), place), 2);
    }
    return fmin(1, sqrt(sum));
}

double lattice_damper_error(const struct lattice_wave *wave, double spacing, double omega)
{
    const double square = pow(step_angle(wave, spacing, omega), 2);
    return fmin(1, (wave->setting->order == 2 ? PLAIN_DAMPER : MODIFIED_DAMPER) * square);
}

double lattice_held_error(const struct lattice_wave *wave, double spacing, double omega)
{
    return wave->setting->sweeps > 0 ? HELD * pow(omega / wave->speed * spacing, 3) : 0;
}
