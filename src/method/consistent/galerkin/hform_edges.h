/* The correction where two faces meet (manual, section 8), for fields of type REAL; included by
 * fused_double.c and fused_single.c. */
#include "method/consistent/galerkin/hform.h"

/* What an edge across x passes on in plane k: the value there, or over an edge along depth N M times the
 * values. */
static double NAME(edge_value)(const struct consistent *c, const struct edge *edge, const REAL *in, size_t k)
{
    if (edge->depth == NULL) return in[k * c->plane];
    const struct band *band = edge->depth;
    double sum = 0;
    for (size_t i = k > band->half ? k - band->half : 0; i <= k + band->half && i < band->n; i++)
        sum += band->value[(i + band->half - k) * band->n + k] * in[i * c->plane];
    return sum;
}

void NAME(hform_edges)(const struct consistent *c, size_t k, double factor, const REAL *u, REAL *const *out)
{
    const struct hform *h = c->hform;
    const size_t nx = c->n[0];
    for (size_t e = 0; e < h->edges; e++) {
        const struct edge *edge = &h->edge[e];
        if (k < edge->from[2] || k >= edge->to[2]) continue;
        const REAL *in = u + (size_t)edge->in * c->volume;
        const double *const *column = edge->column;
        const double over_depth = factor * edge->factor * (column[2] == NULL ? 1 : column[2][k]);
        const size_t plane = column[2] == NULL ? k : edge->at[2];
        const bool along_depth = column[0] != NULL && column[1] != NULL;
        const double there =
            along_depth ? NAME(edge_value)(c, edge, in + edge->at[1] * nx + edge->at[0], plane) : 0;
        for (size_t j = edge->from[1]; j < edge->to[1]; j++) {
            const double weight = over_depth * (column[1] == NULL ? 1 : column[1][j]);
            const REAL *row = in + plane * c->plane + (column[1] == NULL ? j : edge->at[1]) * nx;
            REAL *sum = out[edge->out] + j * nx;
            if (column[0] == NULL) {
                for (size_t i = 0; i < nx; i++)
                    sum[i] += (REAL)weight * row[i];
                continue;
            }
            const double value = weight * (along_depth ? there : (double)row[edge->at[0]]);
            for (size_t i = edge->from[0]; i < edge->to[0]; i++)
                sum[i] += (REAL)(value * column[0][i]);
        }
    }
}
