/* The map of the general operator below a surface that is not level (doc/theory/topography.md): s and f
 * as splines of the displacements, so that rotations are among these and move nothing. */
#include "method/consistent/general/general.h"

#include "base/memory.h"
#include "scene/grading.h"
#include "scene/topography.h"

#include <math.h>

/* Number of points of an axis. */
static size_t points_of(const struct consistent *c, int slot, enum at at)
{
    return c->layout[slot] == NULL ? 1 : c->general->cells[slot] + (at == AT_KNOTS ? 1 : 0);
}

/* f and its slope at the points over depth. */
static bool lay_depth(struct consistent *c, struct hill *hill)
{
    const struct topography *topography = c->model.scene->body.topography;
    const struct grading *grading = c->model.scene->body.grading;
    const double end = topography->plane + topography->depth;
    double *control = array_new(c->part.along[DEPTH].whole, sizeof *control), slope;
    struct band *lu = consistent_collocation(c->layout[DEPTH], false);
    bool good = control != NULL && lu != NULL;
    for (size_t k = 0; good && k < c->part.along[DEPTH].whole; k++)
        control[k] = topography_share(
            topography, grading_real(grading, c->layout[DEPTH]->greville[k]) - topography->plane, &slope);
    if (good) band_lu_solve(lu, control, 1);
    band_free(lu);
    for (int at = 0; good && at < 2; at++) {
        const size_t points = points_of(c, DEPTH, (enum at)at);
        hill->share[at] = array_new(points, sizeof(double));
        hill->fall[at] = array_new(points, sizeof(double));
        good = hill->share[at] != NULL && hill->fall[at] != NULL;
        for (size_t m = 0; good && m < points; m++) {
            const struct taps *taps = &c->general->taps[DEPTH][0][at][m];
            if (grading_real(grading, general_place(c, DEPTH, (enum at)at, m)) >
                end - 1e-6 * topography->depth)
                break;
            hill->level[at] = m + 1;
            for (size_t d = 0; d < taps->count; d++) {
                hill->share[at][m] += taps->value[d] * control[c->part.along[DEPTH].first + taps->first + d];
                hill->fall[at][m] += taps->slope[d] * control[c->part.along[DEPTH].first + taps->first + d];
            }
        }
    }
    array_free(control);
    return good;
}

/* s and its slopes at a point. */
static double drop_at(const struct consistent *c, const enum at at[3], size_t i, size_t j, double slope[2])
{
    const struct taps *x = &c->general->taps[0][0][at[0]][i], *y = &c->general->taps[1][0][at[1]][j];
    double drop = slope[0] = slope[1] = 0;
    for (size_t b = 0; b < y->count; b++)
        for (size_t a = 0; a < x->count; a++) {
            const double control = c->surface[(y->first + b) * c->n[0] + x->first + a];
            drop += x->value[a] * y->value[b] * control;
            slope[0] += x->slope[a] * y->value[b] * control;
            slope[1] += x->value[a] * y->slope[b] * control;
        }
    return drop;
}

/* The same at the points of a family. */
static bool lay_points(struct consistent *c, int f, struct hill *hill)
{
    const struct family *family = &c->general->family[f];
    const size_t count = family->n[0] * family->n[1];
    hill->drop[f] = array_new(count, sizeof(double));
    for (int s = 0; s < 2; s++)
        hill->slope[f][s] = array_new(count, sizeof(double));
    if (hill->drop[f] == NULL || hill->slope[f][0] == NULL || hill->slope[f][1] == NULL) return false;
    c->general->bytes += 3 * count * sizeof(double);
    for (size_t p = 0; p < count; p++) {
        double slope[2];
        hill->drop[f][p] = drop_at(c, family->at, p % family->n[0], p / family->n[0], slope);
        hill->slope[f][0][p] = slope[0];
        hill->slope[f][1][p] = slope[1];
    }
    return true;
}

bool general_lay_hill(struct consistent *c)
{
    if (c->model.scene->body.topography == NULL) return true;
    struct hill *hill = c->general->hill = array_new(1, sizeof *hill);
    if (hill == NULL) return false;
    bool good = lay_depth(c, hill);
    for (int f = 0; f < 3; f++)
        good = good && lay_points(c, f, hill);
    return good;
}

void general_free_hill(struct consistent *c)
{
    struct hill *hill = c->general->hill;
    if (hill == NULL) return;
    for (int at = 0; at < 2; at++) {
        array_free(hill->share[at]);
        array_free(hill->fall[at]);
    }
    for (int f = 0; f < 3; f++) {
        array_free(hill->drop[f]);
        for (int s = 0; s < 2; s++)
            array_free(hill->slope[f][s]);
    }
    array_free(hill);
}

struct metric general_metric_of(const struct consistent *c, const enum at at[3], const size_t place[3])
{
    const struct hill *hill = c->general->hill;
    const double stretch =
        grading_stretch(c->model.scene->body.grading, general_place(c, DEPTH, at[DEPTH], place[DEPTH]));
    if (hill == NULL || place[DEPTH] >= hill->level[at[DEPTH]])
        return (struct metric){.inverse = 1 / stretch, .jacobian = stretch};
    double slope[2];
    const double drop = drop_at(c, at, place[0], place[1], slope);
    return metric_of(stretch, drop, slope, hill->share[at[DEPTH]][place[DEPTH]],
                     hill->fall[at[DEPTH]][place[DEPTH]]);
}

struct metric general_metric_at(const struct consistent *c, const struct family *family, size_t i, size_t j,
                                size_t k)
{
    return general_metric_of(c, family->at, (const size_t[]){i, j, k});
}

bool general_hill_row(const struct consistent *c, const struct family *family, size_t j, size_t k,
                      struct hill_row *row)
{
    const struct hill *hill = c->general->hill;
    const enum at at = family->at[DEPTH];
    if (hill == NULL || k >= hill->level[at]) return false;
    const size_t f = (size_t)(family - c->general->family), from = j * family->n[0];
    *row = (struct hill_row){hill->drop[f] + from,
                             {hill->slope[f][0] + from, hill->slope[f][1] + from},
                             hill->share[at][k],
                             hill->fall[at][k]};
    return true;
}
