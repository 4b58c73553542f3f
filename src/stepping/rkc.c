/* Runge-Kutta-Chebyshev of second order with any number of stages s >= 2 (van der Houwen & Sommeijer 1980;
 * Verwer, Hundsdorfer & Sommeijer 1990; He & Seaid 2016, Eq 25, with two misprints put right: every F carries
 * dt, and gamma_j = -(1 - b_(j-1) T_(j-1)(q0)) mu~_j with a minus sign).
 *
 * Real stability limit at least .653 (s^2 - 1); imaginary limit 0 for every s. */
#include "stepping/rkc.h"
#include "stepping/schemes.h"

#include <math.h>
#include <string.h>

static const double EPSILON = 2.0 / 13.0; /* damping of the stability polynomial */

/* Chebyshev polynomials of the first kind and two derivatives at q0, of degrees j and j - 1; they start from
 * degrees 0 and -1 (T_(-1) = T_1), so that no degree is special. */
static void chebyshev_start(struct rkc_walk *walk)
{
    walk->value[0] = 1;
    walk->value[1] = walk->q0;
    walk->slope[0] = 0;
    walk->slope[1] = 1;
    walk->bend[0] = walk->bend[1] = 0;
}

static void chebyshev_next(struct rkc_walk *walk)
{
    const double twice = 2 * walk->q0;
    const double value = twice * walk->value[0] - walk->value[1];
    const double slope = twice * walk->slope[0] + 2 * walk->value[0] - walk->slope[1];
    const double bend = twice * walk->bend[0] + 4 * walk->slope[0] - walk->bend[1];
    walk->value[1] = walk->value[0];
    walk->slope[1] = walk->slope[0];
    walk->bend[1] = walk->bend[0];
    walk->value[0] = value;
    walk->slope[0] = slope;
    walk->bend[0] = bend;
}

struct rkc_walk rkc_begin(long stages)
{
    struct rkc_walk walk = {.stages = stages, .q0 = 1 + EPSILON / ((double)stages * (double)stages)};
    chebyshev_start(&walk);
    for (long j = 1; j <= stages; j++)
        chebyshev_next(&walk);
    walk.q1 = walk.slope[0] / walk.bend[0];
    chebyshev_start(&walk);
    walk.b[0] = walk.b[1] = 1 / (4 * walk.q0 * walk.q0); /* b_0 = b_1 = b_2 = T_2''/(T_2')^2 */
    return walk;
}

struct rkc_stage rkc_next(struct rkc_walk *walk)
{
    const double value_before = walk->value[0], q0 = walk->q0, q1 = walk->q1;
    chebyshev_next(walk);
    walk->stage++;
    if (walk->stage == 1) /* c_1 = c_2 / T_2'(q0), c_2 = q1 T_2''/T_2' = q1 / q0 */
        return (struct rkc_stage){.mu_rate = walk->b[0] * q1, .time = q1 / (4 * q0 * q0)};
    const double b = walk->bend[0] / (walk->slope[0] * walk->slope[0]);
    struct rkc_stage stage = {
        .mu = 2 * q0 * b / walk->b[0],
        .nu = -b / walk->b[1],
        .mu_rate = 2 * q1 * b / walk->b[0],
        .time = walk->stage == walk->stages ? 1 : q1 * walk->bend[0] / walk->slope[0],
    };
    stage.gamma = -(1 - walk->b[0] * value_before) * stage.mu_rate;
    walk->b[1] = walk->b[0];
    walk->b[0] = b;
    return stage;
}

double complex rkc_polynomial(double complex z, long stages)
{
    struct rkc_walk walk = rkc_begin(stages);
    for (long j = 1; j <= stages; j++)
        chebyshev_next(&walk);
    const double b = walk.bend[0] / (walk.slope[0] * walk.slope[0]);
    const double complex x = walk.q0 + walk.q1 * z;
    double complex value = 1, before = x;
    for (long j = 1; j <= stages; j++) {
        const double complex next = 2 * x * value - before;
        before = value;
        value = next;
    }
    return 1 - b * walk.value[0] + b * value;
}

static long rule(double argument)
{
    const long stages = 1 + (long)floor(sqrt(1 + argument));
    return stages < 2 ? 2 : stages;
}

long rkc_paper_stages(double courant)
{
    return rule(courant / .131);
}

long rkc_radius_stages(double dt_radius)
{
    return rule(dt_radius / .653);
}

long rkc_stages_for(double dt, const struct spectrum *spectrum, long max_stages)
{
    long first =
        rkc_radius_stages(dt * spectrum->viscous); /* fewer are unstable already for the viscosity alone */
    if (first > 2) first--;
    for (long stages = first; stages <= max_stages; stages++)
        if (stability_bounded(rkc_polynomial, stages, spectrum, dt)) return stages;
    return 0;
}

long rkc_best_stages(const struct spectrum *spectrum, long max_stages, double *limit_of_best)
{
    long best = 0;
    double best_rate = 0;
    *limit_of_best = 0;
    for (long stages = 2; stages <= max_stages; stages++) {
        /* as long a step for each stage as the best one's: where that grows, its limit need not be found */
        const bool no_better =
            best > 0 && !stability_bounded(rkc_polynomial, stages, spectrum, best_rate * (double)stages);
        const double longest = no_better ? 0 : stability_limit(rkc_polynomial, stages, spectrum),
                     rate = longest / (double)stages;
        if (rate > best_rate) {
            best = stages;
            best_rate = rate;
            *limit_of_best = longest;
        } else if (stages > best + 8) {
            break; /* more stages have stopped to pay: the waves limit the step, not the viscosity */
        }
    }
    return best;
}

enum { MOST_STAGES = 50 }; /* tried if the deck does not say; more never pay */

static long choose_stages(const struct stepper *stepper, double dt)
{
    const struct scene *scene = stepper->model->scene;
    const struct stepping_choice *choice = &scene->stepping;
    if (choice->stages > 0) return choice->stages;
    const long most = choice->max_stages > 0 ? choice->max_stages : MOST_STAGES;
    if (choice->paper_rule && dt > 0) {
        const struct material *material = &scene->material[scene->body.material];
        const long stages =
            rkc_paper_stages(sqrt(material->young / material->density) * dt / scene->body.spacing);
        return stages < most ? stages : most;
    }
    const long needed = dt > 0 ? rkc_stages_for(dt, &stepper->spectrum, most) : 0;
    if (needed > 0) return needed;
    double longest;
    const long best = rkc_best_stages(&stepper->spectrum, most, &longest);
    return best > 0 ? best : 2;
}

static void step(struct stepper *stepper, struct state *state)
{
    const size_t n = stepper->model->state_size;
    const double dt = stepper->dt;
    const double *first = stepper->work[0];
    double *start = stepper->work[1], *rate = stepper->work[2], *last = stepper->work[3],
           *before = stepper->work[4];
    struct rkc_walk walk = rkc_begin(stepper->stages);
    memcpy(start, state->y, n * sizeof *start);
    memcpy(before, start, n * sizeof *before);
    struct rkc_stage stage = rkc_next(&walk);
    runge_kutta_add(n, last, start, dt * stage.mu_rate, first);
    while (walk.stage < stepper->stages) {
        runge_kutta_rate(stepper, state->time + stage.time * dt, last, rate);
        stage = rkc_next(&walk);
        const double mu = stage.mu, nu = stage.nu, rest = 1 - mu - nu;
        const double with_rate = dt * stage.mu_rate, with_first = dt * stage.gamma;
#pragma omp parallel for simd schedule(static) if (n > 20000)
        for (size_t i = 0; i < n; i++)
            before[i] =
                mu * last[i] + nu * before[i] + rest * start[i] + with_rate * rate[i] + with_first * first[i];
        double *swap = last;
        last = before;
        before = swap;
    }
    memcpy(state->y, last, n * sizeof *last);
    runge_kutta_finish(stepper, state);
}

const struct scheme_class scheme_rkc = {
    .name = "rkc",
    .order = 2,
    .can = SCHEME_MOVING_LOADS | SCHEME_STAGES,
    .default_for = DEFAULT_FOR_DAMPED,
    .evaluations = 1,
    .polynomial = rkc_polynomial,
    .choose_stages = choose_stages,
    .vectors = 5,
    RUNGE_KUTTA_STARTS,
    .step = step,
};
