/* How far displacements and stresses of the lattice stay behind the exact ones beside an interface
 * (doc/theory/general-ground.md, section 6). */
#include "method/consistent/general/glut.h"
#include "method/consistent/general/piece.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>

enum {
    HALF = 14,  /* knots on either side of the source */
    BEFORE = 3, /* cells, as far as kernels reach */
    MANY = 32,  /* samples a cell */
    MOST_KNOTS = 2 * HALF + 1,
    MOST_FINE = (MOST_KNOTS + 2 * BEFORE) * MANY
};
/* The axis across, from knot `first` to knot `first + knots - 1`. */
struct column {
    size_t first, knots;
    bool end[2]; /* the first or last is that of the body */
    double here; /* the source's place, in cells from the first knot */
};

static size_t samples(const struct column *column)
{
    return (column->knots - 1 + 2 * BEFORE) * MANY;
}

/* Means (G11) at knots and middles, one after the other, of samples that begin BEFORE cells before the first knot. */
static void average(const struct column *column, const double *fine, double *at)
{
    for (size_t q = 0; q + 1 < 2 * column->knots; q++) {
        double sum = 0, weights = 0;
        for (size_t m = q * MANY / 2; m < q * MANY / 2 + 2 * BEFORE * MANY; m++) {
            const double away = ((double)m + .5) / MANY - BEFORE - (double)q * .5;
            const double k = piece_kernel(q % 2 == 0 ? AT_KNOTS : AT_MIDDLES, away);
            weights += k;
            sum += k * fine[m];
        }
        at[q] = sum / weights;
    }
}

/* The integral of it from the first knot to x. */
static double integral(const double *fine, double x)
{
    double sum = 0;
    const double end = (x + BEFORE) * MANY;
    for (int m = BEFORE * MANY; m < (int)end; m++)
        sum += fine[m];
    return (sum + (end - (int)end) * fine[(int)end]) / MANY;
}

/* Displacement of the lattice under a stress of `pull`, at the control values from that of cell first - 1 on, with
 * moduli `at` and, if not NULL, strains `given` without stress. */
static void stretch(const struct column *column, const double *at, double pull, const double *given,
                    double *control)
{
    double d[MOST_KNOTS], upper[MOST_KNOTS];
    const size_t last = column->knots - 1;
    for (size_t k = 0; k <= last; k++) {
        const bool end = (k == 0 && column->end[0]) || (k == last && column->end[1]);
        const size_t low = k > 0 ? 2 * k - 1 : 1, high = k < last ? 2 * k + 1 : 2 * k - 1;
        const double left = at[low], right = at[high];
        double diagonal = (at[2 * k] / 3 + (left + right) / 6) / (end ? 2 : 1), value = end ? pull / 2 : pull;
        if (given != NULL)
            value += (at[2 * k] * given[2 * k] + left * given[low] + right * given[high]) / (end ? 6 : 3);
        if (!end && k == 0) diagonal += left / 6; /* as far as it goes on */
        if (!end && k == last) diagonal += right / 6;
        if (k > 0) {
            diagonal -= upper[k - 1] * left / 6;
            value -= d[k - 1] * left / 6;
        }
        upper[k] = right / 6 / diagonal;
        d[k] = value / diagonal;
    }
    for (size_t k = last; k-- > 0;)
        d[k] -= upper[k] * d[k + 1];
    control[0] = 0;
    for (size_t k = 0; k <= last; k++)
        control[k + 1] = control[k] + d[k];
}

/* Stress of the lattice at the knots that balances a force of 1 times what is given, twice that at an end. */
static void balance(const struct column *column, const double *at, double *stress)
{
    const size_t last = column->knots - 1;
    stress[0] = column->end[0] ? (at[0] + at[1]) / 6 : 0;
    for (size_t k = 1; k <= last; k++) {
        const double middle = at[2 * k - 1], left = k > 1 ? at[2 * k - 3] : middle,
                     right = k < last ? at[2 * k + 1] : middle;
        const bool low = k == 1 && column->end[0], high = k == last && column->end[1];
        stress[k] = stress[k - 1] + ((low ? 0 : at[2 * k - 2]) + (high ? 0 : at[2 * k])) / 6 +
                    ((low ? 0 : left) + (high ? 0 : right) + (low || high ? 5 : 6) * middle) / 12;
    }
}

/* 1 / mu, 1 / M and the stresses along the interface, MANY times a cell. */
static void sample(const struct glut *glut, const struct column *column, double soft[2][MOST_FINE],
                   double along[ALONGS][MOST_FINE])
{
    const struct spline *spline = glut->c->spline[glut->across];
    double place[3] = {glut->centre[0], glut->centre[1], glut->centre[2]};
    for (size_t n = 0; n < samples(column); n++) {
        const double cells = (double)column->first - BEFORE + ((double)n + .5) / MANY;
        const double there = spline->low + cells * glut->spacing;
        place[glut->across] = there < spline->low    ? 2 * spline->low - there
                              : there > spline->high ? 2 * spline->high - there
                                                     : there;
        const struct rock rock = consistent_rock_at(glut->c, place);
        soft[0][n] = 1 / rock.mu;
        soft[1][n] = 1 / (rock.lambda + 2 * rock.mu);
        along[ALONG_SHEAR][n] = 2 * rock.mu;
        along[ALONG_RATIO][n] = rock.lambda / (rock.lambda + 2 * rock.mu);
        along[ALONG_SPREAD][n] = 2 * rock.mu * along[ALONG_RATIO][n];
    }
}

/* (G23), for (G30) too: under a stress of 1, or with strains `given` without stress. Far from interfaces the lattice's
 * displacement runs even with the exact one: at most knots. */
static double find_lag(const struct glut *glut, const struct column *column, const double *soft,
                       const double *given)
{
    const struct spline *spline = glut->c->spline[glut->across];
    const double *exact = given != NULL ? given : soft;
    double at[2 * MOST_KNOTS] = {0}, strain[2 * MOST_KNOTS] = {0}, control[MOST_KNOTS + 1] = {0},
                  ahead[MOST_KNOTS], got = 0, parts = 0;
    average(column, soft, at);
    average(column, exact, strain);
    for (size_t q = 0; q + 1 < 2 * column->knots; q++)
        at[q] = 1 / at[q];
    stretch(column, at, given == NULL, given != NULL ? strain : NULL, control);
    for (size_t k = 0; k < column->knots; k++)
        ahead[k] = integral(exact, (double)k) - (control[k] + control[k + 1]) / 2;
    if (glut->plain)
        consistent_point_line(glut->c, glut->across, false, false, false, glut->centre[glut->across],
                              glut->row[0]);
    else
        consistent_source_line(glut->c, glut->across, false, false, glut->centre[glut->across], glut->row[0]);
    for (size_t b = column->first; b <= column->first + column->knots && b < spline->count; b++) {
        const size_t i = b - column->first;
        const double value = b == 0                   ? (control[0] + control[1]) / 2
                             : b == spline->count - 1 ? (control[i - 1] + control[i]) / 2
                                                      : control[i];
        got += glut->row[0][b] * value;
        parts += glut->row[0][b];
    }
    return (integral(exact, column->here) - gsl_stats_median(ahead, 1, column->knots) - got / parts) *
           glut->spacing;
}

/* (G24) */
static double find_stay(const struct glut *glut, const struct column *column, const double *along)
{
    double at[2 * MOST_KNOTS] = {0}, stress[MOST_KNOTS] = {0}, ahead[MOST_KNOTS], got = 0, parts = 0;
    average(column, along, at);
    balance(column, at, stress);
    for (size_t k = 0; k < column->knots; k++) {
        const bool end = (k == 0 && column->end[0]) || (k + 1 == column->knots && column->end[1]);
        const double share = glut->share[column->first + k] * (end ? .5 : 1);
        ahead[k] = integral(along, (double)k) - stress[k];
        got += share * stress[k];
        parts += share;
    }
    if (glut->beneath)
        return (got - integral(along, column->here)) * glut->spacing; /* both from 0 at the face */
    return (got / parts + gsl_stats_median(ahead, 1, column->knots) - integral(along, column->here)) *
           glut->spacing;
}

void general_find_lag(struct glut *glut)
{
    const struct spline *spline = glut->c->spline[glut->across];
    const double centre = (glut->centre[glut->across] - spline->low) / glut->spacing,
                 cells = (double)spline->cells;
    const double from = fmax(0, floor(centre + .5) - HALF), to = fmin(cells, floor(centre + .5) + HALF);
    const struct column column = {.first = (size_t)from,
                                  .knots = (size_t)(to - from) + 1,
                                  .here = centre - from,
                                  .end = {from == 0, to == cells}};
    const int slot = glut->c->slot[glut->across];
    const double cell = slot == DEPTH ? 1 / consistent_metric(glut->c, glut->centre).inverse : 1;
    const double along_normal = cell * glut->normal[slot]; /* of true lengths */
    double soft[2][MOST_FINE] = {{0}}, along[ALONGS][MOST_FINE] = {{0}};
    sample(glut, &column, soft, along);
    glut->lag = find_lag(glut, &column, soft[0], NULL) * along_normal;
    if (glut->plain) {
        glut->press = find_lag(glut, &column, soft[1], NULL) * along_normal;
        glut->slack = find_lag(glut, &column, soft[1], along[ALONG_RATIO]) * along_normal;
        return;
    }
    for (int p = 0; p < ALONGS; p++)
        glut->stay[p] = find_stay(glut, &column, along[p]) * along_normal;
}
