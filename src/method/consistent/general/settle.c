/* Moment tensors in ground that varies across a direction that is not an axis of the lattice: the static fields of
 * a window of the lattice show what the forces of (G25) make of them, and the least change of these makes it right
 * (doc/theory/general-ground.md, Eqs G26 to G29). */
#include "method/consistent/general/window.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

enum { ROUNDS = 12 };
static const double right = 1e-3, wrong = .02; /* of the largest that is wanted */

static double product(const struct glut_window *w, const double *one, const double *other)
{
    double sum = 0;
    for (size_t i = 0; i < w->n; i++)
        sum += one[i] * other[i];
    return sum;
}

/* What the forces do where control values are free, by conjugate gradients from what was there. */
static void find_answer(struct glut_window *w)
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
static double find_lack(const struct glut_window *w, double moment[3][3], gsl_vector *lack)
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

static void lay_products(const struct glut_window *w, gsl_matrix *products)
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
static bool find_change(struct glut_window *w, double moment[3][3], gsl_matrix *products, gsl_vector *lack,
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
static ptrdiff_t number_in_whole(const struct glut_window *w, int axis, ptrdiff_t number, bool odd,
                                 double *factor)
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
static void add_change(const struct glut_window *w, struct dense *field)
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
        if (!has) continue;
        field->value[component * whole->volume + at[2] * whole->plane + at[1] * whole->n[0] + at[0]] +=
            factor * w->change[i];
        dense_widen(field, (int)component,
                    &(struct footprint){{at[0], at[1], at[2]}, {at[0] + 1, at[1] + 1, at[2] + 1}});
    }
}

static bool settle(struct glut_window *w, const struct load *load, const ptrdiff_t end[3],
                   double moment[3][3], struct dense *field)
{
    if (!glut_window_lay(w, load, end)) return false;
    gsl_matrix *products = gsl_matrix_alloc(w->states, w->states);
    gsl_vector *lack = gsl_vector_alloc(w->states), *part = gsl_vector_alloc(w->states);
    const bool good = products != NULL && lack != NULL && part != NULL;
    if (good && find_change(w, moment, products, lack, part)) add_change(w, field);
    gsl_vector_free(part);
    gsl_vector_free(lack);
    gsl_matrix_free(products);
    return good;
}

bool general_settle(const struct glut *glut, const struct load *load, double moment[3][3],
                    struct dense *field)
{
    const struct consistent *c = glut->c;
    struct glut_window w = {.glut = glut};
    ptrdiff_t end[3] = {1, 1, 1};
    bool aslant = c->model.scene->body.topography != NULL, good;
    for (int axis = 0; axis < c->dimension; axis++)
        aslant = aslant || (axis != glut->across && glut->normal[c->slot[axis]] != 0);
    if (c->model.scene->body.line != NULL || !glut->surface || glut->away > GLUT_REACH || !aslant)
        return true;
    if (glut_window_fits(&w, end, &good)) good = settle(&w, load, end, moment, field);
    glut_window_free(&w);
    return good;
}
