/* Strains at points of the lattice beside interfaces: what pulls there goes on where they jump
 * (doc/theory/general-ground.md, section 6). */
#include "method/consistent/general/glut.h"
#include "method/consistent/general/kink.h"
#include "method/consistent/general/medium.h"

#include "scene/grading.h"
#include "scene/ground.h"

#include <math.h>
#include <string.h>

/* Means over the points about a knot, by slot; the squares of what their waves' stiffness has of directions, and of its
 * mean. */
struct pull {
    double weight, stress[3][3], slope[3][3], turn[3][3], stiff;
};

/* Points of a family about a knot: from .. end - 1 along each slot, each with the share of the hat. */
struct about {
    size_t from[3], end[3];
    double share;
};

static struct about about_knot(const struct consistent *c, const struct family *family, const size_t knot[3])
{
    struct about about = {.share = 1};
    for (int slot = 0; slot < 3; slot++) {
        const size_t at = knot[slot] - (slot == DEPTH ? c->general->first : 0);
        const bool middles = c->layout[slot] != NULL && family->at[slot] == AT_MIDDLES;
        about.from[slot] = middles && at > 0 ? at - 1 : at;
        about.end[slot] = at < family->n[slot] ? at + 1 : family->n[slot];
        about.share /= middles ? 2 : 1;
    }
    return about;
}

/* The first of them, the next; false: there is none. */
static bool first_about(const struct about *about, size_t at[3])
{
    memcpy(at, about->from, sizeof about->from);
    return at[0] < about->end[0] && at[1] < about->end[1] && at[2] < about->end[2];
}

static bool next_about(const struct about *about, size_t at[3])
{
    for (int slot = 0; slot < 3; slot++) {
        if (++at[slot] < about->end[slot]) return true;
        at[slot] = about->from[slot];
    }
    return false;
}

/* lambda over mu of a point, of one that is not isotropic trace for trace. */
static double ratio_at(const struct family *family, const size_t at[3])
{
    const size_t point = (at[2] * family->n[1] + at[1]) * family->n[0] + at[0];
    if (family->mu[point] > 0) return family->lambda[point] / family->mu[point];
    double C[STRESSES][STRESSES] = {{0}}, spread = 0, all = 0;
    general_add_stiffness(family, at, 1, C);
    for (int p = 0; p < 3; p++) {
        spread += C[p][0] + C[p][1] + C[p][2];
        all += C[p][p] + 2 * C[p + 3][p + 3];
    }
    return (4 * spread - 2 * all) / (3 * all - spread); /* 9 lambda + 6 mu, 3 lambda + 12 mu */
}

/* Is the rock about a knot not even? */
static bool varies_about(const struct consistent *c, const size_t knot[3])
{
    static const double slight = 1e-3;
    double least = INFINITY, most = -INFINITY;
    for (int f = 0; f < 3; f++) {
        const struct family *family = &c->general->family[f];
        const struct about about = about_knot(c, family, knot);
        size_t at[3];
        for (bool more = first_about(&about, at); more; more = next_about(&about, at)) {
            if (general_is_turned(family, at)) return true;
            const double ratio = ratio_at(family, at);
            if (ratio < least) least = ratio;
            if (ratio > most) most = ratio;
        }
    }
    return most - least > slight * (1 + fabs(least));
}

/* Slopes of u at a point, [component][slot], along the axes. */
static void slopes_at(const struct consistent *c, const struct family *family, const size_t at[3],
                      const double *u, double slope[3][3])
{
    const struct metric metric = general_metric_at(c, family, at[0], at[1], at[2]);
    const double stretch =
        grading_stretch(c->model.scene->body.grading, general_place(c, DEPTH, family->at[DEPTH], at[DEPTH]));
    memset(slope, 0, 9 * sizeof slope[0][0]);
    for (int component = 0; component < c->dimension; component++) {
        const struct taps *t[3];
        double *sum = slope[c->slot[component]];
        for (int slot = 0; slot < 3; slot++)
            t[slot] = &c->general->taps[slot][c->slot[component] == slot][family->at[slot]][at[slot]];
        for (size_t k = 0; k < t[2]->count; k++)
            for (size_t j = 0; j < t[1]->count; j++) {
                const double *row = u + (size_t)component * c->volume + (t[2]->first + k) * c->plane +
                                    (t[1]->first + j) * c->n[0] + t[0]->first;
                double value = 0, along = 0;
                for (size_t i = 0; i < t[0]->count; i++) {
                    value += t[0]->value[i] * row[i];
                    along += t[0]->slope[i] * row[i];
                }
                sum[0] += along * t[1]->value[j] * t[2]->value[k];
                sum[1] += value * t[1]->slope[j] * t[2]->value[k];
                sum[2] += value * t[1]->value[j] * t[2]->slope[k];
            }
        sum[2] *= stretch; /* taps have it already (G19) */
        metric_tilt(&metric, sum);
    }
}

/* (G35) */
static void add_turn(double C[STRESSES][STRESSES], double turn[3][3], double *stiff)
{
    const double s[3] = {C[0][0] + C[5][5] + C[4][4], C[1][1] + C[5][5] + C[3][3],
                         C[2][2] + C[4][4] + C[3][3]};
    const double mean = (s[0] + s[1] + s[2]) / 3, xy = C[0][5] + C[1][5] + C[3][4],
                 yz = C[4][5] + C[1][3] + C[2][3], zx = C[0][4] + C[3][5] + C[2][4];
    const double d[3][3] = {{s[0] - mean, xy, zx}, {xy, s[1] - mean, yz}, {zx, yz, s[2] - mean}};
    for (int n = 0; n < 27; n++)
        turn[n / 9][n / 3 % 3] += d[n / 9][n % 3] * d[n % 3][n / 3 % 3];
    *stiff += mean * mean;
}

static void add_point(const struct consistent *c, const struct family *family, const size_t at[3],
                      double share, const double *u, struct pull *pull)
{
    static const int pair[STRESSES][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {2, 0}, {0, 1}};
    const double weight = share * general_weight(c, family, at);
    double slope[3][3], stiffness[STRESSES][STRESSES] = {{0}};
    slopes_at(c, family, at, u, slope);
    general_add_stiffness(family, at, share, stiffness);
    add_turn(stiffness, pull->turn, &pull->stiff);
    pull->weight += weight;
    for (int n = 0; n < 9; n++)
        pull->slope[n / 3][n % 3] += weight * slope[n / 3][n % 3];
    for (int p = 0; p < STRESSES; p++) {
        const int i = pair[p][0], j = pair[p][1];
        double sum = 0;
        for (int q = 0; q < STRESSES; q++)
            sum += stiffness[p][q] *
                   (slope[pair[q][0]][pair[q][1]] + (q < 3 ? 0 : slope[pair[q][1]][pair[q][0]]));
        pull->stress[i][j] += sum;
        if (i != j) pull->stress[j][i] += sum;
    }
}

static bool mirrors(const struct consistent *c, const size_t knot[3], int slot)
{
    const struct spline *spline = c->layout[slot];
    return spline != NULL &&
           ((spline->mirror[0] && knot[slot] == 0) || (spline->mirror[1] && knot[slot] == spline->cells));
}

/* (G32), on symmetry planes with the points' images. */
static void find_means(const struct consistent *c, const size_t knot[3], const double *u, struct pull *pull)
{
    memset(pull, 0, sizeof *pull);
    for (int f = 0; f < 3; f++) {
        const struct family *family = &c->general->family[f];
        const struct about about = about_knot(c, family, knot);
        size_t at[3];
        for (bool more = first_about(&about, at); more; more = next_about(&about, at))
            add_point(c, family, at, about.share, u, pull);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const bool odd = i != j && (mirrors(c, knot, i) || mirrors(c, knot, j));
            pull->stress[i][j] = odd ? 0 : pull->stress[i][j] / pull->weight;
            pull->slope[i][j] = odd ? 0 : pull->slope[i][j] / pull->weight;
            if (odd) pull->turn[i][j] = 0;
        }
}

/* Adds so many of what the next knot has more; of what is odd across an image's plane there is none there. */
static void add_means(double factor, const struct pull *means, const struct pull *next, int plane,
                      struct pull *pull)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            if (i != j && (i == plane || j == plane)) continue;
            pull->stress[i][j] += factor * (next->stress[i][j] - means->stress[i][j]);
            pull->slope[i][j] += factor * (next->slope[i][j] - means->slope[i][j]);
        }
}

/* (G33) */
static void find_pull(const struct consistent *c, const size_t knot[3], const double *u, struct pull *pull)
{
    struct pull means, next;
    find_means(c, knot, u, &means);
    *pull = means;
    for (int slot = 0; slot < 3; slot++) {
        const size_t last = c->layout[slot] != NULL ? c->layout[slot]->cells : 0;
        const bool image = mirrors(c, knot, slot), inner = knot[slot] > 0 && knot[slot] < last;
        for (int side = 0; side < 2; side++) {
            size_t beside[3] = {knot[0], knot[1], knot[2]};
            if (beside[slot] == (side == 0 ? 0 : last)) continue;
            beside[slot] += side == 0 ? (size_t)-1 : 1;
            find_means(c, beside, u, &next);
            add_means(inner ? -1. / 12 : image ? -1. / 6 : -.5, &means, &next, image ? slot : -1, pull);
        }
    }
}

bool general_steepest(double turn[3][3], double normal[3])
{
    enum { SQUARES = 6 };
    int most = 0;
    for (int round = 0; round < SQUARES; round++) {
        double square[3][3] = {{0}};
        const double size = turn[0][0] + turn[1][1] + turn[2][2];
        if (!(size > 0)) return false;
        for (int n = 0; n < 27; n++)
            square[n / 9][n / 3 % 3] += turn[n / 9][n % 3] / size * (turn[n % 3][n / 3 % 3] / size);
        memcpy(turn, square, sizeof square);
    }
    for (int s = 1; s < 3; s++)
        if (turn[s][s] > turn[most][most]) most = s;
    const double length =
        sqrt(turn[most][0] * turn[most][0] + turn[most][1] * turn[most][1] + turn[most][2] * turn[most][2]);
    for (int s = 0; s < 3; s++)
        normal[s] = turn[most][s] / length;
    return true;
}

/* Sums over points about a knot, x by slot in cells from it, m lambda over mu. */
struct sums {
    double weight, m, x[3], square[3], mx[3];
};

static void add_ratio(const struct consistent *c, const struct family *family, const size_t knot[3],
                      const size_t at[3], double share, struct sums *sums)
{
    const double weight = share * general_weight(c, family, at), m = ratio_at(family, at);
    sums->weight += weight;
    sums->m += weight * m;
    for (int slot = 0; slot < 3; slot++) {
        const double first = (double)knot[slot] - (slot == DEPTH ? (double)c->general->first : 0);
        const double x = (double)at[slot] + (family->at[slot] == AT_MIDDLES ? .5 : 0) - first;
        sums->x[slot] += weight * x;
        sums->square[slot] += weight * x * x;
        sums->mx[slot] += weight * m * x;
    }
}

/* Slope of lambda over mu at a knot along the slots, in cells; none across a symmetry plane. */
static void find_slope(const struct consistent *c, const size_t knot[3], double slope[3])
{
    struct sums sums = {0};
    for (int f = 0; f < 3; f++) {
        const struct family *family = &c->general->family[f];
        const struct about about = about_knot(c, family, knot);
        size_t at[3];
        for (bool more = first_about(&about, at); more; more = next_about(&about, at))
            add_ratio(c, family, knot, at, about.share, &sums);
    }
    for (int slot = 0; slot < 3; slot++) {
        const double middle = sums.x[slot] / sums.weight;
        slope[slot] = c->layout[slot] == NULL || mirrors(c, knot, slot)
                          ? 0
                          : (sums.mx[slot] - sums.m * middle) / (sums.square[slot] - sums.x[slot] * middle);
    }
}

/* (G35a): where points are isotropic all about a knot, the direction in which lambda over mu changes most. False: it
 * does not. */
static bool find_rise(const struct consistent *c, const size_t knot[3], const double place[3],
                      double normal[3])
{
    static const double slight = 1e-9;
    const struct metric metric = consistent_metric(c, place);
    double slope[4][3] = {{0}}, turn[3][3] = {{0}};
    find_slope(c, knot, slope[0]);
    for (int slot = 0; slot < 3; slot++)
        for (int side = 0; side < 2 && c->layout[slot] != NULL; side++) {
            size_t beside[3] = {knot[0], knot[1], knot[2]};
            double there[3];
            if (beside[slot] != (side == 0 ? 0 : c->layout[slot]->cells))
                beside[slot] += side == 0 ? (size_t)-1 : 1;
            find_slope(c, beside, there);
            for (int t = 0; t < 3; t++)
                slope[1 + slot][t] += (side == 0 ? -.5 : .5) * there[t];
        }
    for (int n = 0; n < 36; n++)
        turn[n / 3 % 3][n % 3] += slope[n / 9][n / 3 % 3] * slope[n / 9][n % 3];
    if (!(turn[0][0] + turn[1][1] + turn[2][2] > slight * slight) || !general_steepest(turn, normal))
        return false;
    for (int slot = 0; slot < 3; slot++)
        normal[slot] /= c->layout[slot] != NULL ? glut_spacing(c->layout[slot]) : 1;
    metric_tilt(&metric, normal);
    const double length = hypot(hypot(normal[0], normal[1]), normal[2]);
    for (int slot = 0; slot < 3; slot++)
        normal[slot] /= length;
    return true;
}

/* (G35): false: the rock about the knot has no direction. */
static bool find_normal(const struct consistent *c, const size_t knot[3], const double place[3],
                        struct pull *pull, double normal[3])
{
    static const double rounding = 1e-9;
    const double turn = pull->turn[0][0] + pull->turn[1][1] + pull->turn[2][2];
    return turn > rounding * rounding * pull->stiff ? general_steepest(pull->turn, normal)
                                                    : find_rise(c, knot, place, normal);
}

void general_mend(const struct consistent *c, const size_t point[3], const double place[3], const double *u,
                  double gradient[9])
{
    size_t knot[3] = {0};
    struct pull pull;
    double n[3] = {0}, lack[3] = {0}, across = 0, spread = 0;
    for (int axis = 0; axis < c->dimension; axis++)
        knot[c->slot[axis]] = point[axis] + c->layer[2 * axis];
    if (!varies_about(c, knot)) return;
    find_pull(c, knot, u, &pull);
    if (!find_normal(c, knot, place, &pull, n)) return;
    const struct rock rock = consistent_rock_at(c, place); /* (G34) */
    double(*slope)[3] = pull.slope;
    for (int s = 0; s < 3; s++)
        spread += rock.lambda * slope[s][s];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            lack[i] +=
                (pull.stress[i][j] - rock.mu * (slope[i][j] + slope[j][i]) - (i == j ? spread : 0)) * n[j];
        across += lack[i] * n[i];
    }
    for (int i = 0; i < c->dimension; i++)
        for (int j = 0; j < c->dimension; j++) {
            const int to = c->slot[i], by = c->slot[j];
            const double jump =
                (lack[to] - across * n[to]) / rock.mu + across * n[to] / (rock.lambda + 2 * rock.mu);
            gradient[3 * i + j] = slope[to][by] + jump * n[by];
        }
}
