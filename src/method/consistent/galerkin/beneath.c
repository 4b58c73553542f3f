/* Moment tensors right below a free face. What pulls across the face there does nothing at it: the traction T is 0. The
 * splines' strain does not know this, but the moments of T about the hats at the knots do, as these are what balances
 * inertia. So this part acts through the hats (doc/theory/consistent-splines.md, section 15). */
#include "method/consistent/galerkin/galerkin.h"

#include "base/memory.h"
#include "method/consistent/galerkin/surface.h"
#include "method/spline/source.h"
#include "scene/ground.h"

#include <math.h>
#include <string.h>

enum { HATS = SOURCE_WIDE };

struct beneath {
    const struct consistent *c;
    double centre[3]; /* by axis, of the lattice */
    struct consistent_face face;
    int across;               /* its axis */
    double strain[3][3];      /* by slot */
    double *line[3][3], *row; /* [count] by component and direction; work */
};

void consistent_part_moment(const double n[3], double lambda, double mu, double moment[3][3],
                            double strain[3][3], double slip[3])
{
    const double bulk = lambda + 2 * mu;
    double pull[3] = {0}, along = 0, trace = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            pull[i] += moment[i][j] * n[j];
    for (int i = 0; i < 3; i++)
        along += pull[i] * n[i];
    for (int i = 0; i < 3; i++) {
        slip[i] = (pull[i] - along * n[i]) / mu;
        pull[i] = along * n[i] / bulk + slip[i];
        trace += n[i] * pull[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            strain[i][j] = (n[i] * pull[j] + n[j] * pull[i]) / 2;
            moment[i][j] -= 2 * mu * strain[i][j] + (i == j ? lambda * trace : 0);
        }
}

/* Are there hats enough along an axis, that act for a source? */
static bool served(const struct consistent *c, int axis)
{
    return c->options.degree == 2 && !c->options.mapped && c->spline[axis]->cells >= HATS;
}

/* Depth in spacings from which on dip slip errs by little more than deeper down (regress/studies/slip). */
double consistent_shallow(const struct consistent *c)
{
    static const double swept[] = {1, 1, .5, .25, 1}, exact[] = {1, 1, .5, .05, 0};
    const int degree = c->options.degree;
    bool all = true;
    for (int axis = 0; axis < c->dimension; axis++)
        all = all && served(c, axis);
    if (c->options.mapped) return degree == 2 ? 2 : 1;
    return all ? 0 : (c->options.sweeps == 0 ? exact : swept)[degree];
}

/* Is x right below a free face, so many spacings? */
static bool below(const struct consistent *c, int face, double x, double *depth)
{
    const struct spline *spline = c->spline[face / 2];
    const double spacing = (spline->high - spline->low) / (double)spline->cells;
    *depth = (face % 2 == 0 ? x - spline->low : spline->high - x) / spacing;
    return served(c, face / 2) && !spline->mirror[face % 2] &&
           boundary_is_free(&c->model.scene->boundary[face]) && *depth >= -1e-9 && *depth <= 1;
}

static void find_normal(struct consistent_face *face, const struct consistent *c, const double centre[3])
{
    const int across = face->face / 2;
    double place[3] = {centre[0], centre[1], centre[2]}, *n = face->normal;
    place[across] = face->face % 2 == 0 ? c->spline[across]->low : c->spline[across]->high;
    const struct metric metric = consistent_metric(c, place);
    n[0] = n[1] = n[2] = 0;
    n[c->slot[across]] = 1;
    if (c->slot[across] == DEPTH) metric_tilt(&metric, n);
    const double length = hypot(hypot(n[0], n[1]), n[2]);
    for (int i = 0; i < 3; i++)
        n[i] /= length;
}

struct rock consistent_rock_at(const struct consistent *c, const double place[3])
{
    double real[3] = {place[0], place[1], place[2]};
    consistent_to_ground(c, real);
    return ground_at(c->model.scene, real);
}

bool consistent_rock_differs(struct rock one, struct rock other)
{
    static const double slight = .05;
    return fabs(log(one.density / other.density)) > slight || fabs(log(one.mu / other.mu)) > slight ||
           fabs(log((one.lambda + 2 * one.mu) / (other.lambda + 2 * other.mu))) > slight;
}

/* T has kinks at interfaces, so that no hats beyond the first one count. All do where it is nearer to the face than a
 * cell or the source is nearer to it than to the face: too few hats are left. */
static int hats_above(const struct consistent *c, const double centre[3], int face, double depth)
{
    enum { SAMPLES = 8 }; /* in a cell, between them where an interface may lie on a knot */
    const struct spline *spline = c->spline[face / 2];
    const double step = (spline->high - spline->low) / (double)spline->cells / SAMPLES;
    struct rock last = {0, 0, 0};
    for (int n = 0; n < HATS * SAMPLES; n++) {
        const double away = (n + .5) * step;
        double place[3] = {centre[0], centre[1], centre[2]};
        place[face / 2] = face % 2 == 0 ? spline->low + away : spline->high - away;
        const struct rock rock = consistent_rock_at(c, place);
        if (n > 0 && consistent_rock_differs(rock, last)) {
            const int hats = (n + SAMPLES / 2) / SAMPLES;
            return n < SAMPLES || (hats < 2 && 2 * SAMPLES * depth > n) ? HATS : hats;
        }
        last = rock;
    }
    return HATS;
}

bool consistent_face_above(const struct consistent *c, const double centre[3], struct consistent_face *face)
{
    double depth;
    face->face = -1;
    for (int f = 0; f < 2 * c->dimension; f++) {
        if (!below(c, f, centre[f / 2], &depth) || (face->face >= 0 && depth >= face->depth)) continue;
        face->face = f;
        face->depth = fmax(0, depth);
    }
    if (face->face < 0) return false;
    find_normal(face, c, centre);
    face->hats = hats_above(c, centre, face->face, face->depth);
    return true;
}

/* Mean rock over some of a cell of the axis across about a place. */
static struct rock mean_rock(const struct beneath *b, const double place[3], double width)
{
    enum { SAMPLES = 8 };
    struct rock mean = {0};
    for (int n = 0; n < SAMPLES; n++) {
        double at[3] = {place[0], place[1], place[2]};
        at[b->across] += width * ((n + .5) / SAMPLES - .5);
        const struct rock rock = consistent_rock_at(b->c, at);
        mean.lambda += rock.lambda / SAMPLES;
        mean.mu += rock.mu / SAMPLES;
    }
    return mean;
}

/* Adds `share` of the stress of the strain, so many cells from the face, in the mean rock over some of a cell. */
static void add_stress(struct beneath *b, double cells, double width, double share)
{
    const struct consistent *c = b->c;
    const struct spline *spline = c->spline[b->across];
    const double trace = b->strain[0][0] + b->strain[1][1] + b->strain[2][2],
                 cell = (spline->high - spline->low) / (double)spline->cells;
    double place[3] = {b->centre[0], b->centre[1], b->centre[2]}, stress[3][3];
    place[b->across] = b->face.face % 2 == 0 ? spline->low + cells * cell : spline->high - cells * cell;
    const struct rock rock = mean_rock(b, place, width * cell);
    const struct metric metric = consistent_metric(c, place);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            stress[i][j] = 2 * rock.mu * b->strain[i][j] + (i == j ? rock.lambda * trace : 0);
        stress[i][DEPTH] = metric_pull(&metric, stress[i]);
    }
    for (int component = 0; component < c->dimension; component++)
        for (int direction = 0; direction < c->dimension; direction++) {
            const double factor = share * stress[c->slot[component]][c->slot[direction]];
            consistent_point_line(c, b->across, b->across == component, b->across == direction, false,
                                  place[b->across], b->row);
            for (size_t i = 0; i < spline->count; i++)
                b->line[component][direction][i] += factor * b->row[i];
        }
}

/* Products of these lines with those along the face. */
static void add_lines(const struct beneath *b, double *const work[3], struct dense *field)
{
    const struct consistent *c = b->c;
    for (int component = 0; component < c->dimension; component++)
        for (int direction = 0; direction < c->dimension; direction++) {
            double *line[3] = {work[0], work[1], work[2]};
            line[b->across] = b->line[component][direction];
            for (int axis = 0; axis < c->dimension; axis++)
                if (axis != b->across)
                    consistent_source_line(c, axis, axis == component, axis == direction, b->centre[axis],
                                           line[axis]);
            consistent_add_product(c, line, component, 1, field);
        }
}

/* The general operator has stresses at knots and middles, the layered one everywhere (by Simpson's rule on pieces). */
static void add_hats(struct beneath *b, const double share[HATS + 1])
{
    const int pieces = b->c->general != NULL ? 1 : 16;
    for (int n = 0; n < HATS * pieces; n++)
        for (int part = 0; part < 3; part++) {
            const int hat = n / pieces;
            const double cells = (n + part / 2.) / pieces, in = cells - hat;
            const double here = share[hat] * (1 - in) + share[hat + 1] * in;
            add_stress(b, cells, .5 / pieces, here * (part == 1 ? 4 : 1) / (6 * pieces));
        }
}

bool consistent_beneath(const struct consistent *c, const double centre[3], double moment[3][3],
                        struct dense *field)
{
    enum { ALL = 9 + 4 };
    struct beneath b = {.c = c, .centre = {centre[0], centre[1], centre[2]}};
    double share[HATS + 1] = {0}, slip[3];
    size_t most = 0;
    if (!consistent_face_above(c, centre, &b.face)) return true;
    b.across = b.face.face / 2;
    for (int axis = 0; axis < c->dimension; axis++)
        most = c->spline[axis]->count > most ? c->spline[axis]->count : most;
    double *room = array_new(ALL * most, sizeof *room);
    if (room == NULL) return false;
    for (size_t n = 0; n < 9; n++)
        b.line[n / 3][n % 3] = room + n * most;
    b.row = room + 9 * most;
    const struct rock rock = consistent_rock_at(c, centre);
    consistent_part_moment(b.face.normal, rock.lambda, rock.mu, moment, b.strain, slip);
    source_hats(b.face.depth, b.face.hats, share);
    add_hats(&b, share);
    add_lines(&b, (double *const[3]){b.row + most, b.row + 2 * most, b.row + 3 * most}, field);
    array_free(room);
    return true;
}
