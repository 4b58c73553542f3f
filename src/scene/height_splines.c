/* Splines of degree 3 along one axis of a grid of heights, by least squares. */
#include "scene/height_splines.h"

#include "base/memory.h"

#include <gsl/gsl_linalg.h>

#include <math.h>

/* Values that a piece has at least. */
static const double values_a_piece = 1.5;

/* Place along an axis in its even parts. */
static double in_parts(const struct axis_map *along, double x)
{
    const double low = along->place[0], high = along->place[along->values - 1];
    return fmin(fmax((x - low) / (high - low), 0), 1) * (double)along->parts;
}

/* The knots at the ends count as many times as the order (L. Piegl, W. Tiller, The NURBS Book, 1997, A2.2). */
size_t height_splines_at(const struct axis_map *along, double x, double basis[HEIGHT_ORDER], size_t *first)
{
    basis[0] = 1;
    *first = 0;
    if (along->pieces == 0) return 1;
    const double t = in_parts(along, x);
    const size_t at = along->piece_of[(size_t)fmin(floor(t), (double)along->parts - 1)];
    double left[HEIGHT_ORDER], right[HEIGHT_ORDER];
    *first = at;
    for (size_t j = 1; j < along->order; j++) {
        left[j] = t - along->knot[at + 1 > j ? at + 1 - j : 0];
        right[j] = along->knot[at + j < along->pieces ? at + j : along->pieces] - t;
        double saved = 0;
        for (size_t r = 0; r < j; r++) {
            const double part = basis[r] / (right[r + 1] + left[j - r]);
            basis[r] = saved + right[r + 1] * part;
            saved = left[j - r] * part;
        }
        basis[j] = saved;
    }
    return along->order;
}

/* Error of the splines' worst coefficient where each value errs by 1 (at even distances up to 4); INFINITY where the
 * values leave some untold. */
static double spread(const struct axis_map *along)
{
    gsl_matrix *normal = gsl_matrix_calloc(along->count, along->order); /* the band below the diagonal */
    gsl_vector *column = gsl_vector_alloc(along->count);
    const bool room = normal != NULL && column != NULL;
    for (size_t i = 0; room && i < along->values; i++) {
        double basis[HEIGHT_ORDER];
        size_t first;
        const size_t count = height_splines_at(along, along->place[i], basis, &first);
        for (size_t n = 0; n < count; n++)
            for (size_t m = n; m < count; m++)
                *gsl_matrix_ptr(normal, first + n, m - n) += basis[n] * basis[m];
    }
    const bool good = room && gsl_linalg_cholesky_band_decomp(normal) == 0;
    double worst = good ? 0 : INFINITY;
    for (size_t j = 0; good && j < along->count; j++) {
        gsl_vector_set_basis(column, j);
        gsl_linalg_cholesky_band_svx(normal, column);
        worst = fmax(worst, sqrt(gsl_vector_get(column, j)));
    }
    gsl_matrix_free(normal);
    gsl_vector_free(column);
    return worst;
}

/* Pieces of a part each or, where gaps between the values leave splines all but untold, of two values at least. */
static void lay_knots(struct axis_map *along)
{
    static const double most = 8;
    along->pieces = along->parts;
    along->count = along->pieces + along->order - 1;
    for (size_t part = 0; part < along->parts; part++) {
        along->piece_of[part] = part;
        along->knot[part + 1] = (double)part + 1;
    }
    along->gaps = !(spread(along) < most);
    if (!along->gaps) return;
    along->pieces = 0;
    size_t next = 0, taken = 0; /* values before the part's end, before the piece */
    for (size_t part = 0; part < along->parts; part++) {
        along->piece_of[part] = along->pieces;
        while (next < along->values && in_parts(along, along->place[next]) < (double)part + 1)
            next++;
        const bool few = next < taken + 2 || along->values < next + 2;
        if (few && part + 1 < along->parts) continue;
        along->knot[++along->pieces] = (double)part + 1;
        taken = next;
    }
}

bool height_splines_lay(struct axis_map *along, double piece)
{
    along->count = 1;
    if (along->values < 2) return true; /* no such axis */
    const double low = along->place[0], high = along->place[along->values - 1];
    along->order = along->values < HEIGHT_ORDER ? along->values : HEIGHT_ORDER;
    const double most = fmin((high - low) / piece, (double)(along->values - 1) / values_a_piece);
    along->parts = most > 1 ? (size_t)most : 1;
    if (along->parts > along->values - along->order + 1) along->parts = along->values - along->order + 1;
    along->knot = array_new(along->parts + 1, sizeof *along->knot);
    along->piece_of = array_new(along->parts, sizeof *along->piece_of);
    if (along->knot == NULL || along->piece_of == NULL) return false;
    lay_knots(along);
    along->count = along->pieces + along->order - 1;
    return true;
}

bool height_splines_fit(const struct axis_map *along, size_t lines, struct lines_of in, struct lines_of out)
{
    if (along->pieces == 0) {
        for (size_t l = 0; l < lines; l++)
            out.at[l * out.skip] = in.at[l * in.skip];
        return true;
    }
    gsl_matrix *matrix = gsl_matrix_calloc(along->values, along->count);
    gsl_vector *tau = gsl_vector_alloc(along->count), *value = gsl_vector_alloc(along->values);
    gsl_vector *found = gsl_vector_alloc(along->count), *rest = gsl_vector_alloc(along->values);
    bool good = matrix != NULL && tau != NULL && value != NULL && found != NULL && rest != NULL;
    for (size_t i = 0; good && i < along->values; i++) {
        double basis[HEIGHT_ORDER];
        size_t first;
        const size_t count = height_splines_at(along, along->place[i], basis, &first);
        for (size_t n = 0; n < count; n++)
            gsl_matrix_set(matrix, i, first + n, basis[n]);
    }
    good = good && gsl_linalg_QR_decomp(matrix, tau) == 0;
    for (size_t l = 0; good && l < lines; l++) {
        for (size_t i = 0; i < along->values; i++)
            gsl_vector_set(value, i, in.at[l * in.skip + i * in.step]);
        good = gsl_linalg_QR_lssolve(matrix, tau, value, found, rest) == 0;
        for (size_t i = 0; good && i < along->count; i++)
            out.at[l * out.skip + i * out.step] = gsl_vector_get(found, i);
    }
    gsl_matrix_free(matrix);
    gsl_vector_free(tau);
    gsl_vector_free(value);
    gsl_vector_free(found);
    gsl_vector_free(rest);
    return good;
}
