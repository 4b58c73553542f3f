/* What a moment tensor beside an interface pulls at: the rock at the points about it is averaged
 * (doc/theory/general-ground.md, section 6). */
#include "method/consistent/general/glut.h"
#include "method/consistent/general/piece.h"
#include "method/spline/source.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const int pair[STRESSES][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {2, 0}, {0, 1}};

/* Does the rock change along the normal of the face above alone? */
static bool along_face(const struct glut *g)
{
    const double *n = g->normal, *m = g->face.normal;
    return fabs(n[0] * m[0] + n[1] * m[1] + n[2] * m[2]) > 1 - 1e-6;
}

enum { SEEN = 5 }; /* spacings: what farther knots have part in a strain, some 1e-3 of it, is left out */

/* (G22): first what the slope at the source is of the slopes at the knots. */
static void find_share(struct glut *g)
{
    const size_t last = g->c->spline[g->across]->cells;
    double sum = 0, *share = g->share, *upper = g->row[0];
    if (g->beneath) {
        source_hats(g->face.depth, g->face.hats, share);
        return;
    }
    consistent_source_line(g->c, g->across, true, true, g->centre[g->across], share);
    for (size_t k = 0; k <= last; k++) {
        const bool end = k == 0 || k == last;
        const double diagonal = (end ? 1. / 3 : 2. / 3) - (k > 0 ? upper[k - 1] / 6 : 0);
        sum += share[k];
        share[k] = (-sum * g->spacing / (end ? 2 : 1) - (k > 0 ? share[k - 1] / 6 : 0)) / diagonal;
        upper[k] = 1. / 6 / diagonal;
    }
    for (size_t k = last; k-- > 0;)
        share[k] -= upper[k] * share[k + 1];
    const double at = (g->centre[g->across] - g->c->spline[g->across]->low) / g->spacing;
    for (size_t k = 0; k <= last && g->seen; k++)
        if (fabs((double)k - at) > SEEN) share[k] = 0;
}

/* C of a family in its plane `number` across, between the points about the source; 0 on ranks that do not own the
 * first of these over depth. */
static void find_stiffness(const struct glut *g, const struct family *family, size_t number,
                           double stiffness[STRESSES][STRESSES])
{
    const struct consistent *c = g->c;
    size_t from[3] = {0}, count[3] = {1, 1, 1};
    double rest[3] = {0};
    for (int axis = 0; axis < c->dimension; axis++) {
        const int slot = c->slot[axis];
        const struct spline *spline = c->spline[axis];
        from[slot] = number;
        if (axis != g->across) {
            const bool knots = family->at[slot] == AT_KNOTS;
            const double t = (g->centre[axis] - spline->low) / glut_spacing(spline) - (knots ? 0 : .5);
            from[slot] = (size_t)fmin(fmax(floor(t), 0), (double)spline->cells - (knots ? 1 : 2));
            rest[slot] = fmin(fmax(t - (double)from[slot], 0), 1);
            count[slot] = 2;
        }
    }
    const size_t own = c->part.along[DEPTH].first + c->part.along[DEPTH].own,
                 end = c->part.along[DEPTH].first + c->part.along[DEPTH].end;
    if (from[DEPTH] < own || (from[DEPTH] >= end && end < c->part.along[DEPTH].whole)) return;
    from[DEPTH] -= c->general->first;
    for (size_t n = 0; n < count[0] * count[1] * count[2]; n++) {
        const size_t step[3] = {n % count[0], n / count[0] % count[1], n / (count[0] * count[1])};
        double part = 1;
        size_t at[3];
        for (int slot = 0; slot < 3; slot++) {
            part *= step[slot] == 1 ? rest[slot] : 1 - rest[slot];
            at[slot] = from[slot] + step[slot];
        }
        if (part != 0) general_add_stiffness(family, at, part / general_weight(c, family, at), stiffness);
    }
}

static void stress_of(double stiffness[STRESSES][STRESSES], double strain[3][3], double stress[3][3])
{
    for (int p = 0; p < STRESSES; p++) {
        double sum = 0;
        for (int q = 0; q < STRESSES; q++)
            sum += stiffness[p][q] * strain[pair[q][0]][pair[q][1]] * (q < 3 ? 1 : 2);
        stress[pair[p][0]][pair[p][1]] = stress[pair[p][1]][pair[p][0]] = sum;
    }
}

void glut_add_stress(struct glut *g, int set, double x, double share, double stress[3][3])
{
    const struct consistent *c = g->c;
    double place[3] = {g->centre[0], g->centre[1], g->centre[2]};
    place[g->across] = x;
    const struct metric metric = consistent_metric(c, place);
    for (int i = 0; i < 3; i++)
        stress[i][DEPTH] = metric_pull(&metric, stress[i]);
    for (int component = 0; component < c->dimension; component++)
        for (int direction = 0; direction < c->dimension; direction++) {
            const double factor = share * stress[c->slot[component]][c->slot[direction]];
            double *line = g->line[set][component][direction];
            consistent_point_line(c, g->across, g->across == component, g->across == direction, false, x,
                                  g->row[0]);
            for (size_t i = 0; factor != 0 && i < c->spline[g->across]->count; i++)
                line[i] += factor * g->row[0][i];
        }
}

/* (G25), to be differentiated along slot b. */
static void find_slow(const struct glut *g, double stiffness[STRESSES][STRESSES], int b, double stress[3][3])
{
    const double *n = g->normal, *slip = g->slip;
    double strain[3][3], normal[3][3], pressed[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            strain[i][j] = g->lag * (n[i] * g->tangent[j][b] + g->tangent[i][b] * n[j]) / 2;
            normal[i][j] = n[i] * n[j];
        }
    stress_of(stiffness, strain, stress);
    stress_of(stiffness, normal, pressed);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double shear = slip[i] * ((j == b) - normal[j][b]) + slip[j] * ((i == b) - normal[i][b]);
            stress[i][j] += g->stay[ALONG_SHEAR] * shear / 2 +
                            g->stay[ALONG_SPREAD] * slip[b] * ((i == j) - normal[i][j]) +
                            g->stay[ALONG_RATIO] * slip[b] * pressed[i][j];
        }
}

/* Share of (G22) of a family's plane `number` across. */
static double share_of(const struct glut *g, bool knots, size_t number)
{
    const double end = number == 0 || number == g->c->spline[g->across]->cells ? .5 : 1;
    return (knots ? g->share[number] * end : (g->share[number] + g->share[number + 1]) / 2) / 3;
}

/* `stiffness`: work, [STRESSES][STRESSES] for each knot across. */
static void add_points(struct glut *g, const struct family *family, double (*stiffness)[STRESSES][STRESSES])
{
    static const double least = 1e-5;
    const struct consistent *c = g->c;
    const struct spline *spline = c->spline[g->across];
    const bool knots = family->at[c->slot[g->across]] == AT_KNOTS;
    const size_t planes = spline->cells + (knots ? 1 : 0);
    memset(stiffness, 0, planes * sizeof *stiffness);
    for (size_t k = 0; k < planes; k++)
        if (fabs(share_of(g, knots, k)) >= least) find_stiffness(g, family, k, stiffness[k]);
    ranks_sum(c->part.ranks, planes * STRESSES * STRESSES, &stiffness[0][0][0]);
    for (size_t k = 0; k < planes; k++) {
        const double share = share_of(g, knots, k);
        const double x = spline->low + ((double)k + (knots ? 0 : .5)) * g->spacing;
        double stress[3][3];
        if (fabs(share) < least) continue;
        stress_of(stiffness[k], g->strain, stress);
        glut_add_stress(g, 0, x, share, stress);
        for (int axis = 0; axis < c->dimension && !g->plain; axis++) {
            if (axis == g->across) continue;
            find_slow(g, stiffness[k], c->slot[axis], stress);
            glut_add_stress(g, 1 + axis, x, share, stress);
        }
    }
}

/* Second derivative of an axis's functions at x, from slopes half a cell on either side. */
static void curvature_line(struct glut *g, int axis, bool odd, double *line)
{
    const struct spline *spline = g->c->spline[axis];
    const double h = glut_spacing(spline), x = g->centre[axis], small = 1e-9 * (spline->high - spline->low);
    double half = 1;
    memset(line, 0, spline->count * sizeof *line);
    for (int side = -1; side <= 1; side += 2) {
        const double place = x + side * h / 2;
        const bool beyond[2] = {spline->mirror[0] && place < spline->low,
                                spline->mirror[1] && place > spline->high};
        const double sign = (beyond[0] || beyond[1]) && !odd ? -1 : 1,
                     plane = beyond[0] ? spline->low : spline->high;
        if (beyond[0] || beyond[1]) half = fabs(x - plane) < 1e-9 * h ? .5 : 1;
        consistent_source_line(g->c, axis, odd, true, beyond[0] || beyond[1] ? 2 * plane - place : place,
                               g->row[1]);
        const bool on = (spline->mirror[0] && fabs(place - spline->low) <= small) ||
                        (spline->mirror[1] && fabs(place - spline->high) <= small);
        for (size_t i = 0; i < spline->count; i++)
            line[i] += side * sign * (on ? 2 : 1) * g->row[1][i] / h; /* there the line is half of it */
    }
    for (size_t i = 0; i < spline->count; i++)
        line[i] *= half;
}

void glut_add_lines(struct glut *g, int set, double *const work[3], struct dense *field)
{
    const struct consistent *c = g->c;
    for (int component = 0; component < c->dimension; component++)
        for (int direction = 0; direction < c->dimension; direction++) {
            double *line[3] = {work[0], work[1], work[2]};
            line[g->across] = g->line[set][component][direction];
            for (int axis = 0; axis < c->dimension && axis < 3; axis++) {
                const bool odd = axis == component;
                if (axis == g->across) continue;
                if (g->plain)
                    consistent_point_line(c, axis, odd, axis == direction, g->half, g->centre[axis],
                                          line[axis]);
                else if (axis == direction && set == 1 + axis)
                    curvature_line(g, axis, odd, line[axis]);
                else
                    consistent_source_line(c, axis, odd, axis == direction || set == 1 + axis,
                                           g->centre[axis], line[axis]);
            }
            consistent_add_product(c, line, component, 1, field);
        }
}

enum { SETS = 4 * 3 * 3 };

double *glut_room(struct glut *g, double *work[3])
{
    enum { ALL = SETS + 6 + STRESSES * STRESSES }; /* the last for each knot across, in add_points() */
    size_t most = 0;
    for (int axis = 0; axis < g->c->dimension; axis++)
        most = g->c->spline[axis]->count > most ? g->c->spline[axis]->count : most;
    double *room = array_new(ALL * most, sizeof *room);
    if (room == NULL) return NULL;
    for (size_t n = 0; n < SETS; n++)
        g->line[n / 9][n / 3 % 3][n % 3] = room + n * most;
    g->share = room + SETS * most;
    g->row[0] = g->share + most;
    g->row[1] = g->row[0] + most;
    for (size_t n = 0; n < 3; n++)
        work[n] = g->row[1] + (1 + n) * most;
    return room;
}

void glut_clear(struct glut *g)
{
    double *first = g->line[0][0][0];
    memset(first, 0, (size_t)(g->share - first) * sizeof *first);
}

void glut_add_points(struct glut *g, double *const work[3])
{
    double *behind = work[2] + (work[1] - work[0]);
    for (int f = 0; f < 3; f++)
        add_points(g, &g->c->general->family[f], (double(*)[STRESSES][STRESSES])behind);
}

static bool add_glut(const struct consistent *c, const struct load *load, const double centre[3], bool seen,
                     double moment[3][3], struct dense *field)
{
    struct glut g = {.c = c, .centre = {centre[0], centre[1], centre[2]}, .seen = seen};
    double *work[3];
    if (general_is_part(c->model.scene) || !general_find_normal(&g)) return true;
    const struct rock rock = consistent_rock_at(c, centre);
    g.lambda = rock.lambda;
    g.mu = rock.mu;
    const bool below = consistent_face_above(c, centre, &g.face);
    g.beneath = below && g.face.face == 2 * g.across && along_face(&g);
    double *room = glut_room(&g, work), failed = room == NULL;
    if (below && !g.beneath && !consistent_beneath(c, centre, moment, field)) failed = 1;
    ranks_largest(c->part.ranks, 1, &failed);
    if (room == NULL || failed != 0) {
        array_free(room);
        return false;
    }
    memcpy(g.tangent, moment, sizeof g.tangent);
    consistent_part_moment(g.normal, g.lambda, g.mu, g.tangent, g.strain, g.slip);
    find_share(&g);
    general_find_lag(&g);
    glut_add_points(&g, work);
    for (int set = 0; set <= c->dimension; set++)
        if (set != 1 + g.across) glut_add_lines(&g, set, work, field);
    array_free(room);
    /* six strains a place would take seconds in space */
    const bool good = (seen && c->dimension == 3) || general_settle(&g, load, moment, field);
    memcpy(moment, g.tangent, sizeof g.tangent);
    return good;
}

bool general_add_glut(const struct consistent *c, const struct load *load, const double centre[3],
                      double moment[3][3], struct dense *field)
{
    return add_glut(c, load, centre, false, moment, field);
}

bool general_add_seen(const struct consistent *c, const struct load *load, const double centre[3],
                      double moment[3][3], struct dense *field)
{
    return add_glut(c, load, centre, true, moment, field);
}
