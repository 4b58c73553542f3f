/* A piece of the lattice about a moment tensor (see the header). */
#include "method/consistent/general/window.h"

#include "base/memory.h"
#include "method/consistent/galerkin/surface.h"
#include "model/short_body.h"
#include "scene/boundary.h"
#include "scene/topography.h"

#include <math.h>
#include <string.h>

enum {
    NEAR = 7,  /* cells about the source whose control values are free */
    CLOSE = 1, /* to a free face, where the window ends */
    SHELL = 4, /* control values around these that have the exact field's */
    FINE = 32, /* steps of the line in a spacing */
    PLACES = 8 /* in a cell of a free face, along an axis */
};

/* Does the ground go on beyond a symmetry plane across the axis as the plane's image of it? */
static bool goes_on(const struct glut *g, int axis, double plane)
{
    const struct scene *scene = g->c->model.scene;
    const struct topography *surface = scene->body.topography;
    const double spacing = glut_spacing(g->c->spline[axis]);
    bool even = !ground_varies(scene, axis);
    for (int n = 1; surface != NULL && n <= 2 * (NEAR + SHELL); n++) {
        double place[2][2] = {{g->centre[0], g->centre[1]}, {g->centre[0], g->centre[1]}};
        place[0][axis] = plane - n * spacing;
        place[1][axis] = plane + n * spacing;
        even = even &&
               fabs(topography_drop(surface, place[0]) - topography_drop(surface, place[1])) < 1e-9 * spacing;
    }
    return even;
}

/* Cells of an axis, beyond symmetry planes too, and whether they end at free faces; false: the source is too near to
 * another end of the body. */
static bool take_cells(struct glut_window *w, int axis, ptrdiff_t *from, ptrdiff_t *end)
{
    const struct glut *g = w->glut;
    const struct spline *spline = g->c->spline[axis];
    const struct boundary *boundary = &g->c->model.scene->boundary[2 * axis];
    const double at = (g->centre[axis] - spline->low) / glut_spacing(spline);
    double first = (double)g->c->layer[2 * axis],
           last = (double)spline->cells - (double)g->c->layer[2 * axis + 1];
    const bool graded = g->c->model.scene->body.grading != NULL && g->c->slot[axis] == DEPTH;
    if (!graded && spline->mirror[0] && goes_on(g, axis, spline->low)) first = -INFINITY;
    if (!graded && spline->mirror[1] && goes_on(g, axis, spline->high)) last = INFINITY;
    const bool bare[2] = {first == 0 && boundary_is_free(&boundary[0]),
                          last == (double)spline->cells && boundary_is_free(&boundary[1])};
    if (at < first + (bare[0] ? CLOSE : NEAR) || at > last - (bare[1] ? CLOSE : NEAR)) return false;
    w->bare[axis][0] = bare[0] && at < first + NEAR + SHELL;
    w->bare[axis][1] = bare[1] && at > last - NEAR - SHELL;
    *from = (ptrdiff_t)fmax(first, floor(at) - NEAR - SHELL);
    *end = (ptrdiff_t)fmin(last, ceil(at) + NEAR + SHELL);
    return true;
}

/* Part of the map over depth, which no symmetry plane is across. */
static void cut_grading(struct glut_window *w, const ptrdiff_t end[3], struct body *body)
{
    w->grading = *body->grading;
    w->grading.cells = (size_t)(end[DEPTH] - w->from[DEPTH]);
    w->grading.low += (double)w->from[DEPTH] * w->grading.step;
    w->grading.place += w->from[DEPTH];
    w->grading.stretch += w->from[DEPTH];
    body->grading = &w->grading;
}

static selas_status cut(struct glut_window *w, const struct load *load, const ptrdiff_t end[3],
                        struct messages *messages)
{
    const struct consistent *whole = w->glut->c;
    struct scene *scene = NULL;
    selas_status status = short_body_scene(whole->model.scene, &scene, messages);
    if (status != SELAS_OK) return status;
    struct body *body = &scene->body;
    for (int axis = 0; axis < whole->dimension; axis++) {
        const struct spline *spline = whole->spline[axis];
        const double low = spline->low + (double)w->from[whole->slot[axis]] * glut_spacing(spline);
        body->low[axis] = low;
        body->high[axis] = spline->low + (double)end[whole->slot[axis]] * glut_spacing(spline);
        scene->boundary[2 * axis].kind = scene->boundary[2 * axis + 1].kind = BOUNDARY_FREE;
    }
    if (body->grading != NULL) cut_grading(w, end, body);
    body->line = &w->line;
    scene->loads = 1;
    scene->load = (struct load *)load; /* borrowed, and not changed */
    status = whole->model.method->create(scene, &w->model, messages);
    if (status != SELAS_OK) {
        array_free(scene);
        return status;
    }
    w->c = consistent_of(w->model);
    w->c->own_scene = scene;
    return SELAS_OK;
}

/* Is the ground about the source as the line says, but for a twentieth of it? */
static bool varies_across_alone(const struct glut_window *w)
{
    enum { WIDE = 3, PARTS = 2 }; /* spacings; places in one */
    static const double alike = .05, most = .05;
    const struct consistent *c = w->glut->c;
    const int far = WIDE * PARTS, beside = c->dimension == 2 ? 0 : far;
    size_t other = 0, all = 0;
    for (int k = -far; k <= far; k++)
        for (int j = -beside; j <= beside; j++)
            for (int i = -far; i <= far; i++) {
                const double step[3] = {(double)i / PARTS, (double)j / PARTS, (double)k / PARTS};
                double place[3] = {0};
                bool within = true;
                for (int axis = 0; axis < c->dimension; axis++) {
                    place[axis] = w->glut->centre[axis] + step[c->slot[axis]] * glut_spacing(c->spline[axis]);
                    within = within && (!w->bare[axis][0] || place[axis] >= c->spline[axis]->low) &&
                             (!w->bare[axis][1] || place[axis] <= c->spline[axis]->high);
                }
                if (!within) continue;
                all++;
                consistent_to_ground(c, place);
                const struct rock is = ground_at(c->model.scene, place),
                                  *said = ground_line_at(&w->line, place);
                other += fabs(log((is.lambda + 2 * is.mu) / (said->lambda + 2 * said->mu))) > alike ||
                         fabs(log(is.mu / said->mu)) > alike;
            }
    return (double)other <= most * (double)all;
}

static void place_of(const struct glut_window *w, size_t i, double place[3], bool *within)
{
    const struct consistent *c = w->c;
    const size_t at[3] = {i % c->n[0], i / c->n[0] % c->n[1], i / c->plane};
    *within = true;
    for (int axis = 0; axis < c->dimension; axis++) {
        const size_t k = at[c->slot[axis]];
        place[axis] = c->spline[axis]->greville[k];
        *within = *within && (w->bare[axis][0] || k >= SHELL) &&
                  (w->bare[axis][1] || k + SHELL < c->n[c->slot[axis]]);
    }
}

/* A control value's place in the ground, and then those a spacing away along each axis, but at an end of it. */
enum { ABOUT = 7 };
static size_t find_places(const struct glut_window *w, const double place[3], double there[ABOUT][3])
{
    const struct consistent *c = w->c;
    size_t count = 0;
    memcpy(there[count++], place, 3 * sizeof *place);
    for (int axis = 0; axis < c->dimension; axis++) {
        const struct spline *spline = c->spline[axis];
        const double spacing = glut_spacing(spline);
        if (fmin(place[axis] - spline->low, spline->high - place[axis]) < .25 * spacing) continue;
        for (int side = -1; side <= 1; side += 2) {
            memcpy(there[count], place, 3 * sizeof *place);
            there[count++][axis] += side * spacing;
        }
    }
    for (size_t n = 0; n < count; n++)
        consistent_to_ground(c, there[n]);
    return count;
}

/* Control values of the fields, of second order and more: u - 1/8 of its second differences, none at an end. */
static void lay_values(struct glut_window *w)
{
    const struct consistent *c = w->c;
    for (size_t i = 0; i < c->volume; i++) {
        double place[3] = {0}, there[ABOUT][3];
        bool within;
        place_of(w, i, place, &within);
        const size_t places = find_places(w, place, there);
        for (size_t state = 0; state < w->states; state++) {
            double here[3], beside[3], *value = w->field + state * w->n + i;
            steady_at(&w->line, &w->steady[state], there[0], here);
            for (int a = 0; a < c->dimension; a++)
                value[(size_t)a * c->volume] = here[a];
            for (size_t n = 1; n < places; n++) {
                steady_at(&w->line, &w->steady[state], there[n], beside);
                for (int a = 0; a < c->dimension; a++)
                    value[(size_t)a * c->volume] -= (beside[a] - here[a]) / 8;
            }
        }
    }
}

/* Adds what the fields pull at the ground through a free face: they have their stress there, and the face has none. */
static void add_pulls(struct glut_window *w, int axis, int side)
{
    enum { MOST = SPLINE_MAX_LOCAL * SPLINE_MAX_LOCAL };
    const struct consistent *c = w->c;
    const int along[2] = {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2}, faces = c->dimension - 1;
    const struct spline *first = c->spline[along[0]], *second = faces == 2 ? c->spline[along[1]] : NULL;
    const double step[2] = {glut_spacing(first) / PLACES, faces == 2 ? glut_spacing(second) / PLACES : 1};
    const size_t count[2] = {PLACES * first->cells, faces == 2 ? PLACES * second->cells : 1};
    const size_t stride[3] = {1, c->n[0], c->plane}, end = side == 0 ? 0 : c->n[c->slot[axis]] - 1;
    const size_t local = (size_t)first->degree + 1, shares = faces == 2 ? local * local : local;
    struct spline_point at[2] = {{.value = {1}}, {.value = {1}}};
    for (size_t n = 0; n < count[0] * count[1]; n++) {
        double place[3] = {0}, normal[3] = {0}, face[3] = {0}, pull[3], share[MOST];
        size_t number[MOST];
        place[axis] = side == 0 ? c->spline[axis]->low : c->spline[axis]->high;
        place[along[0]] = first->low + ((double)(n % count[0]) + .5) * step[0];
        const size_t row = n / count[0];
        if (faces == 2) place[along[1]] = second->low + ((double)row + .5) * step[1];
        const struct metric metric = consistent_metric(c, place);
        for (int f = 0; f < faces && f < 2; f++)
            spline_at(c->spline[along[f]], false, place[along[f]], &at[f]);
        for (size_t i = 0; i < shares; i++) {
            const size_t one = i % local, other = i / local;
            share[i] = at[0].value[one] * at[1].value[other];
            number[i] = end * stride[c->slot[axis]] + at[0].index[one] * stride[c->slot[along[0]]] +
                        (faces == 2 ? at[1].index[other] * stride[c->slot[along[1]]] : 0);
        }
        face[c->slot[axis]] = (side == 0 ? -1 : 1) * step[0] * step[1] * metric.jacobian;
        metric_tilt(&metric, face);
        for (int a = 0; a < c->dimension; a++)
            normal[a] = face[c->slot[a]];
        consistent_to_ground(c, place);
        for (size_t state = 0; state < w->states; state++) {
            steady_pull(&w->line, &w->steady[state], place, normal, pull);
            for (int a = 0; a < c->dimension; a++) {
                double *rest = w->rest + state * w->n + (size_t)a * c->volume;
                for (size_t i = 0; i < shares; i++)
                    rest[number[i]] += share[i] * pull[a];
            }
        }
    }
}

/* What is left of the forces of each field where control values are free. */
static void lay_rests(struct glut_window *w)
{
    struct consistent *c = w->c;
    for (size_t state = 0; state < w->states; state++)
        general_forces(c, w->field + state * w->n, NULL, w->rest + state * w->n);
    for (int end = 0; end < 2 * c->dimension; end++)
        if (w->bare[end / 2][end % 2]) add_pulls(w, end / 2, end % 2);
    for (size_t state = 0; state < w->states; state++) {
        double *rest = w->rest + state * w->n, pull[3];
        steady_acceleration(&w->line, &w->steady[state], pull);
        for (size_t i = 0; i < w->n; i++)
            w->work[0][i] = pull[i / c->volume];
        general_weigh(c, w->work[0], w->work[1]);
        for (size_t i = 0; i < w->n; i++)
            rest[i] = w->loose[i] ? rest[i] - w->work[1][i] : 0;
    }
}

static bool lay_fields(struct glut_window *w)
{
    struct consistent *c = w->c;
    const struct spline *depth = c->spline[c->dimension - 1];
    const double spacing = glut_spacing(depth) * consistent_metric(w->glut->c, w->glut->centre).jacobian;
    w->n = c->model.unknowns;
    w->states = steady_all(&w->line, spacing, w->steady);
    w->field = array_new(2 * STEADY_MOST * w->n, sizeof *w->field);
    w->forces = array_new(7 * w->n, sizeof *w->forces);
    w->loose = array_new(w->n, sizeof *w->loose);
    if (w->states == 0 || w->field == NULL || w->forces == NULL || w->loose == NULL) return false;
    w->rest = w->field + STEADY_MOST * w->n;
    w->answer = w->forces + w->n;
    w->change = w->answer + w->n;
    w->weight = w->change + w->n;
    for (int i = 0; i < 3; i++)
        w->work[i] = w->weight + (size_t)(1 + i) * w->n;
    for (size_t i = 0; i < w->n; i++) {
        double place[3] = {0}, square = 0;
        place_of(w, i % c->volume, place, &w->loose[i]);
        for (int axis = 0; axis < c->dimension; axis++)
            square += pow((place[axis] - w->glut->centre[axis]) / glut_spacing(c->spline[axis]), 2);
        consistent_to_ground(c, place);
        if (w->loose[i] && square < GLUT_REACH * GLUT_REACH)
            w->weight[i] =
                ground_line_at(&w->line, place)->mu * pow(1 - square / (GLUT_REACH * GLUT_REACH), 2);
    }
    lay_values(w);
    lay_rests(w);
    return true;
}

bool glut_window_fits(struct glut_window *w, ptrdiff_t end[3], bool *good)
{
    const struct glut *glut = w->glut;
    const struct consistent *c = glut->c;
    double origin[3] = {glut->centre[0], glut->centre[1], glut->centre[2]}, normal[3] = {0}, widest = 0;
    *good = true;
    for (int axis = 0; axis < c->dimension; axis++) {
        const int slot = c->slot[axis];
        if (!take_cells(w, axis, &w->from[slot], &end[slot])) return false;
        normal[axis] = glut->normal[slot];
        widest = fmax(widest, glut_spacing(c->spline[axis]));
    }
    const double stretch = fmax(1, consistent_metric(c, glut->centre).jacobian);
    const double far = (NEAR + SHELL + 3) * sqrt(c->dimension) * widest * stretch;
    consistent_to_ground(c, origin);
    *good = ground_line_new(c->model.scene, origin, normal, glut->spacing / FINE, far, &w->line);
    return *good && varies_across_alone(w);
}

bool glut_window_lay(struct glut_window *w, const struct load *load, const ptrdiff_t end[3])
{
    struct messages messages = {0};
    const bool good = cut(w, load, end, &messages) == SELAS_OK && lay_fields(w);
    messages_free(&messages);
    return good;
}

void glut_window_free(struct glut_window *w)
{
    ground_line_free(&w->line);
    steady_free(w->steady);
    if (w->model != NULL) model_free(&w->model);
    array_free(w->field);
    array_free(w->forces);
    array_free(w->loose);
}
