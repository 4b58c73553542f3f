/* Across which direction the rock changes about a moment tensor (doc/theory/general-ground.md, section 6). */
#include "method/consistent/galerkin/surface.h"
#include "method/consistent/general/glut.h"
#include "method/consistent/general/piece.h"
#include "scene/ground.h"

#include <math.h>
#include <string.h>

static double level_of(const struct rock *rock)
{
    return log(rock->lambda + 2 * rock->mu);
}

enum { REACH = 6, FINE = 3, FAR = REACH * FINE }; /* spacings; places in one */

/* Place i, j, k of those about the source, by axis of the lattice; its steps by slot, in spacings. */
static void place_beside(const struct glut *g, int i, int j, int k, double step[3], double place[3])
{
    const struct consistent *c = g->c;
    step[0] = (double)i / FINE;
    step[1] = (double)j / FINE;
    step[2] = (double)k / FINE;
    for (int axis = 0; axis < c->dimension; axis++)
        place[axis] = g->centre[axis] + step[c->slot[axis]] * glut_spacing(c->spline[axis]);
}

/* Slopes of log M about the source along the lattice, first and second ones in turn as in (G10a), under a Gaussian of
 * variance 4: about the middle of a layer it rises to neither side. */
static void sum_slopes(const struct glut *g, double slope[4][3])
{
    const struct consistent *c = g->c;
    const int beside = c->dimension == 2 ? 0 : FAR;
    const struct rock own = consistent_rock_at(c, g->centre);
    double drop[2 * FAR + 1][2 * FAR + 1], step[3], place[3] = {0};
    for (int j = -beside; j <= beside; j++)
        for (int i = -FAR; i <= FAR; i++) {
            place_beside(g, i, j, 0, step, place);
            drop[j + beside][i + FAR] = consistent_drop(c, place, NULL);
        }
    for (int k = -FAR; k <= FAR; k++)
        for (int j = -beside; j <= beside; j++)
            for (int i = -FAR; i <= FAR; i++) {
                place_beside(g, i, j, k, step, place);
                consistent_to_ground_below(c, drop[j + beside][i + FAR], place);
                const struct rock rock = ground_at(c->model.scene, place);
                if (rock.lambda + 2 * rock.mu == own.lambda + 2 * own.mu) continue;
                const double away = step[0] * step[0] + step[1] * step[1] + step[2] * step[2];
                const double level = (level_of(&rock) - level_of(&own)) * exp(-away / 8);
                for (int one = 0; one < c->dimension; one++) {
                    const int s = c->slot[one];
                    slope[0][s] += step[s] * level;
                    for (int other = 0; other < c->dimension; other++) {
                        const int t = c->slot[other];
                        slope[1 + s][t] += (step[s] * step[t] / 2 - (s == t ? 2 : 0)) * level;
                    }
                }
            }
}

/* The same, once for all that is asked for at one place in turn. */
static void find_slopes(const struct glut *g, double slope[4][3])
{
    struct slopes_about *last = &g->c->general->slopes;
    const double *at = last->place, *now = g->centre;
    if (!last->known || at[0] != now[0] || at[1] != now[1] || at[2] != now[2]) {
        *last = (struct slopes_about){.known = true, .place = {g->centre[0], g->centre[1], g->centre[2]}};
        sum_slopes(g, last->slope);
    }
    memcpy(slope, last->slope, sizeof last->slope);
}

/* The direction in which log M changes most about the source, from slopes along the lattice; the axis across is that of
 * the steepest of these. False: in none, or across a symmetry plane nearby. */
static bool find_rise(struct glut *g)
{
    static const double slight = 1e-9, clear = 12; /* spacings from a symmetry plane */
    const struct consistent *c = g->c;
    const struct metric metric = consistent_metric(c, g->centre);
    double slope[4][3], turn[3][3] = {{0}}, rise[3];
    find_slopes(g, slope);
    for (int n = 0; n < 36; n++)
        turn[n / 3 % 3][n % 3] += slope[n / 9][n / 3 % 3] * slope[n / 9][n % 3];
    if (!(turn[0][0] + turn[1][1] + turn[2][2] > slight * slight) || !general_steepest(turn, rise))
        return false;
    const double up = rise[0] * slope[0][0] + rise[1] * slope[0][1] + rise[2] * slope[0][2];
    for (int axis = 0; axis < c->dimension; axis++)
        if (fabs(rise[c->slot[axis]]) >= fabs(rise[c->slot[g->across]])) g->across = axis;
    const struct spline *spline = c->spline[g->across];
    for (int axis = 0; axis < c->dimension; axis++) /* rises a cell */
        rise[c->slot[axis]] *= glut_spacing(spline) / glut_spacing(c->spline[axis]);
    metric_tilt(&metric, rise);
    const double steepest = sqrt(rise[0] * rise[0] + rise[1] * rise[1] + rise[2] * rise[2]);
    for (int slot = 0; slot < 3; slot++)
        g->normal[slot] = copysign(1, up) * rise[slot] / steepest;
    const double near = clear * glut_spacing(spline), at = g->centre[g->across];
    return !(spline->mirror[0] && at - spline->low < near) &&
           !(spline->mirror[1] && spline->high - at < near);
}

/* log M on the line through the source along the axis across, shifted along another one, all in true lengths. */
struct column {
    const struct glut *glut;
    double origin[3], spacing; /* the source; of the lattice along the axis there */
    int shifted;
    double shift;
};
enum { REACH_UP = 6, FINE_UP = 16, ROUNDS = 40 }; /* spacings; places in one; halvings of one of these */

static double level_at(const struct column *column, double along)
{
    double place[3] = {column->origin[0], column->origin[1], column->origin[2]};
    place[column->shifted] += column->shift;
    place[column->glut->across] += along;
    const struct rock rock = ground_at(column->glut->c->model.scene, place);
    return level_of(&rock);
}

/* Where the column passes the level on the way up or down, nearest to `near`; false: nowhere. */
static bool passes(const struct column *column, double level, double sign, double near, double *at)
{
    const double step = column->spacing / FINE_UP;
    bool found = false;
    for (int n = -REACH_UP * FINE_UP; n < REACH_UP * FINE_UP; n++) {
        double from = near + n * step, to = from + step;
        if (sign * (level_at(column, from) - level) > 0 || sign * (level_at(column, to) - level) <= 0)
            continue;
        for (int round = 0; round < ROUNDS; round++) {
            const double middle = (from + to) / 2;
            *(sign * (level_at(column, middle) - level) > 0 ? &to : &from) = middle;
        }
        if (!found || fabs(from - near) < fabs(*at - near)) *at = from;
        found = true;
    }
    return found;
}

/* The normal of the surface on which log M has the value of its steepest rise beside the source, from where columns
 * some spacings to either side pass it: what slopes along the lattice make of it is a mean over some spacings. False:
 * some of them do not. */
static bool refine(struct glut *g, double aside)
{
    const struct consistent *c = g->c;
    const double stretch = c->slot[g->across] == DEPTH ? consistent_metric(c, g->centre).jacobian : 1;
    struct column column = {
        g, {g->centre[0], g->centre[1], g->centre[2]}, g->spacing * stretch, g->across, 0};
    const double step = column.spacing / FINE_UP;
    double most = 0, near = 0, rise[3] = {0};
    consistent_to_ground(c, column.origin);
    for (int n = -REACH_UP * FINE_UP; n < REACH_UP * FINE_UP; n++) {
        const double middle = (n + .5) * step, away = middle / column.spacing;
        const double jump = level_at(&column, middle + step / 2) - level_at(&column, middle - step / 2);
        const double weighed = jump * exp(-away * away / 8);
        if (fabs(weighed) <= fabs(most)) continue;
        most = weighed;
        near = middle;
    }
    const double level = (level_at(&column, near + step / 2) + level_at(&column, near - step / 2)) / 2;
    double length = 1;
    rise[c->slot[g->across]] = most > 0 ? 1 : -1;
    for (int axis = 0; axis < c->dimension; axis++) {
        double side[2];
        if (axis == g->across) continue;
        column.shifted = axis;
        for (int s = 0; s < 2; s++) {
            column.shift = (2 * s - 1) * aside * glut_spacing(c->spline[axis]);
            if (most == 0 || !passes(&column, level, most, near, &side[s])) return false;
        }
        const double slope = (side[1] - side[0]) / (2 * column.shift);
        rise[c->slot[axis]] = -slope * rise[c->slot[g->across]];
        length = hypot(length, slope);
    }
    for (int slot = 0; slot < 3; slot++)
        g->normal[slot] = rise[slot] / length;
    g->away = fabs(near) / column.spacing / length;
    return true;
}

bool general_find_normal(struct glut *g)
{
    if (!find_rise(g)) return false;
    g->spacing = glut_spacing(g->c->spline[g->across]);
    g->surface = refine(g, 2) || (g->plain && refine(g, .5));
    return true;
}
