/* Moment tensors in ground that varies across a direction that is not an axis of the lattice: the static fields of
 * a window of the lattice show what the forces of (G25) make of them, and the least change of these makes it right
 * (doc/theory/general-ground.md, Eqs G26 to G29). */
#include "method/consistent/consistent.h"
#include "method/consistent/general/glut.h"
#include "method/consistent/general/steady.h"

#include "base/memory.h"
#include "model/short_body.h"
#include "scene/topography.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

enum {
    NEAR = 7,  /* cells about the source whose control values are free */
    SHELL = 4, /* control values around these that have the exact field's */
    FINE = 32, /* steps of the line in a spacing */
    ROUNDS = 12
};
static const double reach = 4;                 /* spacings: so near interfaces are felt, and forces changed */
static const double right = 1e-3, wrong = .02; /* of the largest that is wanted */

struct window {
    const struct glut *glut;
    struct ground_line line;
    struct steady steady[STEADY_MOST];
    size_t states;
    struct model *model;
    struct consistent *c; /* the model's */
    size_t n;             /* unknowns */
    ptrdiff_t from[3];    /* by slot: the whole's cell that is its first */
    double *field,
        *rest; /* [states][n] control values of the exact field; what these lack in balance, where free */
    double *forces, *answer, *change, *weight; /* [n] of the moment; what they do; what was added; (G28) */
    bool *loose;                               /* [n] */
    double *work[3];                           /* [n] */
};

/* --- The window ------------------------------------------------------------------------------------------- */

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

/* Cells of an axis, beyond symmetry planes too; false: the source is too near to an end of the body. */
static bool take_cells(const struct glut *g, int axis, ptrdiff_t *from, ptrdiff_t *end)
{
    const struct spline *spline = g->c->spline[axis];
    const double at = (g->centre[axis] - spline->low) / glut_spacing(spline);
    double first = (double)g->c->layer[2 * axis],
           last = (double)spline->cells - (double)g->c->layer[2 * axis + 1];
    if (spline->mirror[0] && goes_on(g, axis, spline->low)) first = -INFINITY;
    if (spline->mirror[1] && goes_on(g, axis, spline->high)) last = INFINITY;
    if (at < first + NEAR || at > last - NEAR) return false;
    *from = (ptrdiff_t)fmax(first, floor(at) - NEAR - SHELL);
    *end = (ptrdiff_t)fmin(last, ceil(at) + NEAR + SHELL);
    return true;
}

static selas_status cut(struct window *w, const struct load *load, const ptrdiff_t end[3],
                        struct messages *messages)
{
    const struct consistent *whole = w->glut->c;
    struct consistent_options options = whole->options;
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
    body->line = &w->line;
    scene->loads = 1;
    scene->load = (struct load *)load; /* borrowed, and not changed */
    options.single = false;
    options.quiet = 0;
    options.unfused = options.window = true;
    status = consistent_create_with(scene, &options, &w->model, messages);
    if (status != SELAS_OK) {
        array_free(scene);
        return status;
    }
    w->c = consistent_of(w->model);
    w->c->own_scene = scene;
    return SELAS_OK;
}

/* Is the ground about the source as the line says, but for a twentieth of it? */
static bool varies_across_alone(const struct window *w)
{
    enum { WIDE = 3, PARTS = 2 }; /* spacings; places in one */
    static const double alike = .05, most = .05;
    const struct consistent *c = w->glut->c;
    const int far = WIDE * PARTS, beside = c->dimension == 2 ? 0 : far;
    size_t other = 0, all = 0;
    for (int k = -far; k <= far; k++)
        for (int j = -beside; j <= beside; j++)
            for (int i = -far; i <= far; i++, all++) {
                const double step[3] = {(double)i / PARTS, (double)j / PARTS, (double)k / PARTS};
                double place[3] = {0};
                for (int axis = 0; axis < c->dimension; axis++)
                    place[axis] = w->glut->centre[axis] + step[c->slot[axis]] * glut_spacing(c->spline[axis]);
                consistent_to_ground(c, place);
                const struct rock is = ground_at(c->model.scene, place),
                                  *said = ground_line_at(&w->line, place);
                other += fabs(log((is.lambda + 2 * is.mu) / (said->lambda + 2 * said->mu))) > alike ||
                         fabs(log(is.mu / said->mu)) > alike;
            }
    return (double)other <= most * (double)all;
}

static void place_of(const struct consistent *c, size_t i, double place[3], bool *within)
{
    const size_t at[3] = {i % c->n[0], i / c->n[0] % c->n[1], i / c->plane};
    *within = true;
    for (int axis = 0; axis < c->dimension; axis++) {
        const size_t k = at[c->slot[axis]];
        place[axis] = c->spline[axis]->greville[k];
        *within = *within && k >= SHELL && k + SHELL < c->n[c->slot[axis]];
    }
}

/* Control values of a field of second order and more: u - 1/8 of its second differences. */
static void control_value(const struct window *w, const struct steady *steady, const double place[3],
                          double value[3])
{
    const struct consistent *c = w->c;
    double there[3] = {place[0], place[1], place[2]}, here[3], beside[3];
    consistent_to_ground(c, there);
    steady_at(&w->line, steady, there, here);
    memcpy(value, here, sizeof here);
    for (int axis = 0; axis < c->dimension; axis++)
        for (int side = -1; side <= 1; side += 2) {
            memcpy(there, place, sizeof there);
            there[axis] += side * glut_spacing(c->spline[axis]);
            consistent_to_ground(c, there);
            steady_at(&w->line, steady, there, beside);
            for (int i = 0; i < c->dimension; i++)
                value[i] -= (beside[i] - here[i]) / 8;
        }
}

static void lay_field(struct window *w, size_t state)
{
    struct consistent *c = w->c;
    const struct steady *steady = &w->steady[state];
    double *field = w->field + state * w->n, *rest = w->rest + state * w->n, pull[3];
    steady_acceleration(&w->line, steady, pull);
    for (size_t i = 0; i < c->volume; i++) {
        double place[3] = {0}, value[3] = {0};
        bool within;
        place_of(c, i, place, &within);
        control_value(w, steady, place, value);
        for (int component = 0; component < c->dimension; component++) {
            field[(size_t)component * c->volume + i] = value[component];
            w->work[0][(size_t)component * c->volume + i] = pull[component];
        }
    }
    general_weigh(c, w->work[0], w->work[1]);
    general_forces(c, field, NULL, rest);
    for (size_t i = 0; i < w->n; i++)
        rest[i] = w->loose[i] ? rest[i] - w->work[1][i] : 0;
}

static bool lay_window(struct window *w)
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
        place_of(c, i % c->volume, place, &w->loose[i]);
        for (int axis = 0; axis < c->dimension; axis++)
            square += pow((place[axis] - w->glut->centre[axis]) / glut_spacing(c->spline[axis]), 2);
        consistent_to_ground(c, place);
        if (w->loose[i] && square < reach * reach)
            w->weight[i] = ground_line_at(&w->line, place)->mu * pow(1 - square / (reach * reach), 2);
    }
    for (size_t state = 0; state < w->states; state++)
        lay_field(w, state);
    return true;
}

/* --- The forces ------------------------------------------------------------------------------------------- */

static double product(const struct window *w, const double *one, const double *other)
{
    double sum = 0;
    for (size_t i = 0; i < w->n; i++)
        sum += one[i] * other[i];
    return sum;
}

/* What the forces do where control values are free, by conjugate gradients from what was there. */
static void find_answer(struct window *w)
{
    enum { MOST = 2000 };
    static const double still = 1e-12; /* squared */
    double *rest = w->work[0], *way = w->work[1], *pull = w->work[2], size = 0, next;
    const double all = product(w, w->forces, w->forces);
    general_forces(w->c, w->answer, NULL, rest);
    for (size_t i = 0; i < w->n; i++) {
        rest[i] = w->loose[i] ? rest[i] + w->forces[i] : 0;
        way[i] = rest[i];
        size += rest[i] * rest[i];
    }
    for (int step = 0; step < MOST && size > still * all; step++, size = next) {
        general_forces(w->c, way, NULL, pull);
        for (size_t i = 0; i < w->n; i++)
            pull[i] = w->loose[i] ? -pull[i] : 0;
        const double far = size / product(w, way, pull);
        for (size_t i = 0; i < w->n; i++) {
            w->answer[i] += far * way[i];
            rest[i] -= far * pull[i];
        }
        next = product(w, rest, rest);
        for (size_t i = 0; i < w->n; i++)
            way[i] = rest[i] + next / size * way[i];
    }
}

/* What is wanted of the work of the forces on each field less what it is; the largest of them in parts of what is
 * wanted. */
static double find_lack(const struct window *w, double moment[3][3], gsl_vector *lack)
{
    const struct consistent *c = w->c;
    double most = 0, scale = 0;
    for (size_t state = 0; state < w->states; state++) {
        double slopes[3][3], wanted = 0;
        steady_slopes(&w->line, &w->steady[state], slopes);
        for (int i = 0; i < c->dimension; i++)
            for (int j = 0; j < c->dimension; j++)
                wanted += moment[c->slot[i]][c->slot[j]] * slopes[i][j];
        const double found =
            product(w, w->forces, w->field + state * w->n) + product(w, w->answer, w->rest + state * w->n);
        gsl_vector_set(lack, state, wanted - found);
        scale = fmax(scale, fabs(wanted));
        most = fmax(most, fabs(wanted - found));
    }
    return most / scale;
}

static void lay_products(const struct window *w, gsl_matrix *products)
{
    for (size_t i = 0; i < w->states; i++)
        for (size_t j = 0; j <= i; j++) {
            const double *one = w->field + i * w->n, *other = w->field + j * w->n;
            double sum = 0;
            for (size_t k = 0; k < w->n; k++)
                sum += w->weight[k] * one[k] * other[k];
            gsl_matrix_set(products, i, j, sum);
            gsl_matrix_set(products, j, i, sum);
        }
}

/* (G28), (G29): false: it does not come near. */
static bool find_change(struct window *w, double moment[3][3], gsl_matrix *products, gsl_vector *lack,
                        gsl_vector *part)
{
    double left = 0;
    lay_products(w, products);
    if (gsl_linalg_cholesky_decomp1(products) != GSL_SUCCESS) return false;
    for (size_t i = 0; i < w->n; i++)
        w->forces[i] = 0;
    for (int component = 0; component < w->c->dimension; component++)
        for (size_t k = 0; k < w->c->n[DEPTH]; k++)
            sparse_add(w->c, &w->c->load.of[0], component, k, 1,
                       w->forces + (size_t)component * w->c->volume + k * w->c->plane);
    for (int round = 0; round <= ROUNDS; round++) {
        find_answer(w);
        left = find_lack(w, moment, lack);
        if (left < right || round == ROUNDS) break;
        gsl_linalg_cholesky_solve(products, lack, part);
        for (size_t i = 0; i < w->n; i++) {
            double sum = 0;
            for (size_t state = 0; state < w->states && w->weight[i] != 0; state++)
                sum += gsl_vector_get(part, state) * w->field[state * w->n + i];
            w->forces[i] += w->weight[i] * sum;
            w->change[i] += w->weight[i] * sum;
        }
    }
    return left < wrong;
}

/* Number of the whole's control value that one of the window's is or is the image of, and what that turns round. */
static ptrdiff_t number_in_whole(const struct window *w, int axis, ptrdiff_t number, bool odd, double *factor)
{
    const struct consistent *whole = w->glut->c;
    const struct spline *spline = whole->spline[axis];
    const ptrdiff_t cells = (ptrdiff_t)spline->cells;
    number += w->from[whole->slot[axis]];
    const bool low = spline->mirror[0] && number < 1, high = spline->mirror[1] && number > cells;
    if ((low || high) && odd) *factor = -*factor;
    if (low) number = 1 - number;
    if (high) number = 2 * cells + 1 - number;
    return number - (spline->mirror[0] ? 1 : 0) - (ptrdiff_t)whole->part.along[whole->slot[axis]].first;
}

/* The change, to the control values that the whole's part has; of a source on a symmetry plane half. */
static void add_change(const struct window *w, double *field)
{
    const struct consistent *c = w->c, *whole = w->glut->c;
    double all = 1;
    for (int axis = 0; axis < whole->dimension; axis++) {
        const struct spline *spline = whole->spline[axis];
        const double small = 1e-9 * (spline->high - spline->low), at = w->glut->centre[axis];
        if ((spline->mirror[0] && fabs(at - spline->low) < small) ||
            (spline->mirror[1] && fabs(at - spline->high) < small))
            all /= 2;
    }
    for (size_t i = 0; i < w->n; i++) {
        const size_t here = i % c->volume, component = i / c->volume;
        size_t at[3] = {here % c->n[0], here / c->n[0] % c->n[1], here / c->plane};
        double factor = all;
        bool has = w->change[i] != 0;
        for (int axis = 0; axis < whole->dimension && has; axis++) {
            const int slot = whole->slot[axis];
            const ptrdiff_t number =
                number_in_whole(w, axis, (ptrdiff_t)at[slot], (int)component == axis, &factor);
            has = number >= 0 && (size_t)number < whole->n[slot];
            at[slot] = (size_t)number;
        }
        if (has)
            field[component * whole->volume + at[2] * whole->plane + at[1] * whole->n[0] + at[0]] +=
                factor * w->change[i];
    }
}

static void window_free(struct window *w)
{
    ground_line_free(&w->line);
    steady_free(w->steady);
    if (w->model != NULL) model_free(&w->model);
    array_free(w->field);
    array_free(w->forces);
    array_free(w->loose);
}

static bool settle(struct window *w, const struct load *load, const ptrdiff_t end[3], double moment[3][3],
                   double *field)
{
    struct messages messages = {0};
    bool good = cut(w, load, end, &messages) == SELAS_OK && lay_window(w);
    messages_free(&messages);
    if (!good) return false;
    gsl_matrix *products = gsl_matrix_alloc(w->states, w->states);
    gsl_vector *lack = gsl_vector_alloc(w->states), *part = gsl_vector_alloc(w->states);
    good = products != NULL && lack != NULL && part != NULL;
    if (good && find_change(w, moment, products, lack, part)) add_change(w, field);
    gsl_vector_free(part);
    gsl_vector_free(lack);
    gsl_matrix_free(products);
    return good;
}

bool general_settle(const struct glut *glut, const struct load *load, double moment[3][3], double *field)
{
    const struct consistent *c = glut->c;
    const struct scene *scene = c->model.scene;
    const int last = c->dimension - 1;
    struct window w = {.glut = glut};
    ptrdiff_t end[3] = {1, 1, 1};
    bool aslant = scene->body.topography != NULL, room = true;
    double origin[3] = {glut->centre[0], glut->centre[1], glut->centre[2]}, normal[3] = {0}, widest = 0;
    for (int axis = 0; axis < c->dimension; axis++) {
        const int slot = c->slot[axis];
        normal[axis] = glut->normal[slot];
        aslant = aslant || (axis != glut->across && normal[axis] != 0);
        widest = fmax(widest, glut_spacing(c->spline[axis]));
        room = room && take_cells(glut, axis, &w.from[slot], &end[slot]);
    }
    if (c->options.window || !glut->surface || glut->away > reach || !aslant || !room) return true;
    const double stretch = fmax(1, consistent_metric(c, glut->centre).jacobian);
    const double far = (NEAR + SHELL + 3) * sqrt(1 + last) * widest * stretch;
    consistent_to_ground(c, origin);
    bool good = ground_line_new(scene, origin, normal, glut->spacing / FINE, far, &w.line);
    if (good && varies_across_alone(&w)) good = settle(&w, load, end, moment, field);
    window_free(&w);
    return good;
}
