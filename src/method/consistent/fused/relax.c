/* Factors of displacements that relax in steps in one pass (see the header). */
#include "method/consistent/fused/relax.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { MOST = FUSED_FIELDS_KEPT };

/* Which mechanisms the parts tell: those whose share in e_p besides u's, of what parts before leave, is largest. */
static void find_told(const struct relaxing *relaxing, bool told[MODEL_MECHANISMS])
{
    const struct relaxing_part *part = relaxing->part;
    double left[MOST][MODEL_MECHANISMS] = {{0}};
    bool used[MOST] = {true};
    memset(told, 0, MODEL_MECHANISMS * sizeof *told);
    for (size_t p = 1; p < relaxing->parts; p++)
        for (size_t l = 0; l < relaxing->mechanisms; l++)
            left[p][l] = part[p].weight[l] - part[p].given / part[0].given * part[0].weight[l];
    for (size_t turn = 1; turn < relaxing->parts; turn++) {
        size_t row = 0, column = 0;
        for (size_t p = 1; p < relaxing->parts; p++)
            for (size_t l = 0; l < relaxing->mechanisms && !used[p]; l++)
                if (!told[l] && (row == 0 || fabs(left[p][l]) > fabs(left[row][column]))) {
                    row = p;
                    column = l;
                }
        used[row] = told[column] = true;
        for (size_t p = 1; p < relaxing->parts; p++) {
            const double factor = used[p] ? 0 : left[p][column] / left[row][column];
            for (size_t l = 0; l < relaxing->mechanisms; l++)
                left[p][l] -= factor * left[row][l];
        }
    }
}

/* Inverse of a matrix of n rows by elimination; it is spoiled. */
static void invert(size_t n, double a[MOST][MOST], double inverse[MOST][MOST])
{
    memset(inverse, 0, MOST * sizeof *inverse);
    for (size_t i = 0; i < n; i++)
        inverse[i][i] = 1;
    for (size_t column = 0; column < n; column++) {
        size_t best = column;
        for (size_t row = column; row < n; row++)
            if (fabs(a[row][column]) > fabs(a[best][column])) best = row;
        for (size_t i = 0; i < n; i++) {
            const double pivot = a[best][i], other = inverse[best][i];
            a[best][i] = a[column][i];
            a[column][i] = pivot;
            inverse[best][i] = inverse[column][i];
            inverse[column][i] = other;
        }
        const double size = a[column][column];
        for (size_t i = 0; i < n; i++) {
            a[column][i] /= size;
            inverse[column][i] /= size;
        }
        for (size_t row = 0; row < n; row++) {
            const double factor = row == column ? 0 : a[row][column];
            for (size_t i = 0; i < n && factor != 0; i++) {
                a[row][i] -= factor * a[column][i];
                inverse[row][i] -= factor * inverse[column][i];
            }
        }
    }
}

/* With x = (u, D_1, D_2, ...), z = T x, and x += b w + B x in a step: rate = T b, by = T B T^-1. */
static struct fused_relax factors_of(const struct relaxing *relaxing, double dt)
{
    const size_t mechanisms = relaxing->mechanisms, n = 1 + mechanisms;
    struct fused_relax relax = {.parts = relaxing->parts, .fields = n, .dt = dt};
    double t[MOST][MOST] = {{0}}, spoiled[MOST][MOST], inverse[MOST][MOST];
    bool told[MODEL_MECHANISMS];
    find_told(relaxing, told);
    for (size_t p = 0; p < relaxing->parts; p++) {
        t[p][0] = relaxing->part[p].given;
        memcpy(&t[p][1], relaxing->part[p].weight, mechanisms * sizeof **t);
    }
    for (size_t l = 0, next = relaxing->parts; l < mechanisms; l++) {
        if (told[l]) continue;
        t[next][1 + l] = 1;
        relax.of[l] = next++;
    }
    memcpy(spoiled, t, sizeof t);
    invert(n, spoiled, inverse);
    memcpy(relax.displacement, inverse[0], sizeof relax.displacement);
    for (size_t l = 0; l < mechanisms; l++)
        memcpy(relax.told[l], inverse[1 + l], sizeof relax.told[l]);
    for (size_t f = 0; f < n; f++) {
        relax.rate[f] = t[f][0] * dt;
        for (size_t l = 0; l < mechanisms; l++) {
            const double half = relaxing->rate[l] * dt / 2, change = t[f][1 + l] / (1 + half);
            relax.rate[f] += change * dt;
            for (size_t g = 0; g < n; g++)
                relax.by[f][g] -= 2 * half * change * inverse[1 + l][g];
        }
    }
    return relax;
}

struct fused_relaxing *fused_relaxing_new(const struct relaxing *relaxing)
{
    struct fused_relaxing *made = array_new(1, sizeof *made);
    if (made != NULL) made->of = *relaxing;
    return made;
}

const struct fused_relax *fused_factors(struct fused_relaxing *relaxing, double dt)
{
    if (relaxing == NULL) return NULL;
    if (relaxing->factors.dt != dt) relaxing->factors = factors_of(&relaxing->of, dt);
    return &relaxing->factors;
}

double fused_effective(const struct relaxing *relaxing, size_t p, size_t n, const double *y, size_t at)
{
    double sum = 0;
    for (size_t l = 0; l < relaxing->mechanisms; l++)
        sum += relaxing->part[p].weight[l] * y[(2 + l) * n + at];
    return relaxing->part[p].given * y[at] + sum;
}

/* What is that already is not written to. */
static void set(double *to, double value)
{
    if (value != *to) *to = value;
}

void fused_tell(const struct fused_relax *relax, size_t n, size_t at, const void *const *field, size_t number,
                double *y)
{
    double z[MOST], u = 0;
    for (size_t f = 0; f < relax->fields; f++) {
        z[f] = number == sizeof(double) ? ((const double *)field[f])[at] : ((const float *)field[f])[at];
        u += relax->displacement[f] * z[f];
    }
    set(&y[at], u);
    for (size_t l = 0; l + 1 < relax->fields; l++) {
        double memory = relax->of[l] > 0 ? z[relax->of[l]] : 0;
        for (size_t f = 0; f < relax->fields && relax->of[l] == 0; f++)
            memory += relax->told[l][f] * z[f];
        set(&y[(2 + l) * n + at], memory);
    }
}

void fused_tell_all(const struct fused_relax *relax, size_t n, int threads, const void *const *field,
                    size_t number, double *y)
{
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t i = 0; i < n; i++)
        fused_tell(relax, n, i, field, number, y);
}
