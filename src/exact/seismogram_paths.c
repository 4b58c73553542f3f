/* From responses to motions at a receiver: sources and motions are sums over azimuthal orders, and the integral
 * over the direction phi of the wavenumber makes Bessel functions of them (doc/theory/seismograms.md, Eqs 14-16):
 *   1/(2 pi) int exp(i k r cos phi) cos(n phi) dphi = i^n J_n(k r) = C_n.                            (16)
 * A source of cos(m phi) seen through cos(n phi) gives (C_(m-n) + C_(m+n))/2, sines (C_(m-n) - C_(m+n))/2. */
#include "exact/seismogram_work.h"

#include "base/sums.h"

#include <math.h>
#include <string.h>

enum { ORDERS = 5, HARMONICS = 3 };

/* What a motion's response is seen through: component, response, order, factor; `sine`: through sin(order phi).
 */
struct view {
    unsigned char component, response, order;
    bool sine;
    double complex factor;
};

enum { RADIAL, TRANSVERSE, DOWN, S_RR, S_TT, S_ZZ, S_RT, S_TZ, S_ZR };

static const struct view in_plane[] = {
    {RADIAL, RESPONSE_U, 1, false, I},         {TRANSVERSE, RESPONSE_U, 1, true, I},
    {DOWN, RESPONSE_W, 0, false, 1},           {S_RR, RESPONSE_MEAN, 0, false, 1},
    {S_RR, RESPONSE_DIFFERENCE, 2, false, 1},  {S_TT, RESPONSE_MEAN, 0, false, 1},
    {S_TT, RESPONSE_DIFFERENCE, 2, false, -1}, {S_ZZ, RESPONSE_Z, 0, false, -1},
    {S_RT, RESPONSE_DIFFERENCE, 2, true, 1},   {S_TZ, RESPONSE_Q, 1, true, -I},
    {S_ZR, RESPONSE_Q, 1, false, -I},
};
static const struct view across[] = {
    {RADIAL, RESPONSE_V, 1, true, -1}, {TRANSVERSE, RESPONSE_V, 1, false, 1},
    {S_RR, RESPONSE_X, 2, true, -I},   {S_TT, RESPONSE_X, 2, true, I},
    {S_RT, RESPONSE_X, 2, false, I},   {S_TZ, RESPONSE_Y, 1, false, -1},
    {S_ZR, RESPONSE_Y, 1, true, 1},
};
enum { IN_PLANE = sizeof in_plane / sizeof *in_plane, ACROSS = sizeof across / sizeof *across };

/* A line is a column and a view. */
static const struct view *view_of(size_t line, enum strata_column *column)
{
    if (line < 4 * IN_PLANE) {
        *column = (enum strata_column)(line / IN_PLANE);
        return &in_plane[line % IN_PLANE];
    }
    *column = (enum strata_column)(COLUMN_ACROSS + (line - 4 * IN_PLANE) / ACROSS);
    return &across[(line - 4 * IN_PLANE) % ACROSS];
}

/* The jump of a column: sum over m of even[m] cos(m phi) + odd[m] sin(m phi) (Eq 12). */
struct jump {
    double complex even[HARMONICS], odd[HARMONICS];
};

static struct jump jump_of(const struct path *path, enum strata_column column, double k)
{
    const double *f = path->force, *m = path->moment;
    const double mean = .5 * (m[0] + m[1]), difference = .5 * (m[0] - m[1]);
    switch (column) {
    case COLUMN_VERTICAL:
        return (struct jump){{f[2], 0, 0}, {0, 0, 0}};
    case COLUMN_AXIAL:
        return (struct jump){{m[2], 0, 0}, {0, 0, 0}};
    case COLUMN_RADIAL:
        return (struct jump){{-k * mean, -I * f[0], -k * difference}, {0, -I * f[1], -k * m[3]}};
    case COLUMN_DIP:
        return (struct jump){{0, -I * m[5], 0}, {0, -I * m[4], 0}};
    case COLUMN_ACROSS:
        return (struct jump){{0, f[1], -I * k * m[3]}, {0, -f[0], I * k * difference}};
    default: /* COLUMN_TWIST */
        return (struct jump){{0, m[4], 0}, {0, -m[5], 0}};
    }
}

/* C_0 .. C_4 (Eq 16) at x = k r. */
static void bessel(double x, double complex c[ORDERS])
{
    double j[ORDERS];
    j[0] = j0(x);
    j[1] = j1(x);
    for (int n = 2; n < ORDERS; n++) /* upwards where that loses nothing */
        j[n] = x > 2 * n ? 2 * (n - 1) / x * j[n - 1] - j[n - 2] : jn(n, x);
    c[0] = j[0];
    c[1] = I * j[1];
    c[2] = -j[2];
    c[3] = -I * j[3];
    c[4] = j[4];
}

static double complex seen(const struct jump *jump, const struct view *view, const double complex c[ORDERS])
{
    double complex sum = 0;
    const int n = view->order;
    for (int m = 0; m < HARMONICS; m++) {
        const double complex near = c[m > n ? m - n : n - m], far = c[m + n];
        sum += view->sine ? jump->odd[m] * (near - far) : jump->even[m] * (near + far);
    }
    return .5 * view->factor * sum;
}

/* --- Paths -------------------------------------------------------------------------------------------- */

void path_set(struct path *path, const struct seismogram_source *source, const double position[3])
{
    const double *m = source->moment;
    *path = (struct path){.source = source};
    path->x = position[0] - source->position[0];
    path->y = position[1] - source->position[1];
    path->distance = hypot(path->x, path->y);
    path->patch = source->patch.shape != PATCH_POINT;
    path->cosine = 1;
    if (path->distance > 0 && !path->patch) {
        path->cosine = path->x / path->distance;
        path->sine = path->y / path->distance;
    }
    const double c = path->cosine, s = path->sine;
    path->force[0] = c * source->force[0] + s * source->force[1];
    path->force[1] = c * source->force[1] - s * source->force[0];
    path->force[2] = source->force[2];
    path->moment[0] = c * c * m[0] + s * s * m[1] + 2 * c * s * m[3];
    path->moment[1] = s * s * m[0] + c * c * m[1] - 2 * c * s * m[3];
    path->moment[2] = m[2];
    path->moment[3] = c * s * (m[1] - m[0]) + (c * c - s * s) * m[3];
    path->moment[4] = c * m[4] - s * m[5];
    path->moment[5] = c * m[5] + s * m[4];
}

/* Lines of a patch: component and static response. */
static const struct {
    unsigned char component, statics;
} of_patch[] = {{RADIAL, 1}, {TRANSVERSE, 1}, {RADIAL, 2}, {TRANSVERSE, 2},
                {RADIAL, 4}, {TRANSVERSE, 4}, {DOWN, 0},   {DOWN, 3}};
enum { OF_PATCH = sizeof of_patch / sizeof *of_patch };

static void patch_coefficients(const struct path *path, double k, double value[OF_PATCH])
{
    double a[AVERAGES];
    patch_averages(&path->source->patch, path->x, path->y, k, a);
    const double *f = path->source->force;
    const double along_x = f[0] * a[AVERAGE_XX] + f[1] * a[AVERAGE_XY];
    const double along_y = f[0] * a[AVERAGE_XY] + f[1] * (a[AVERAGE] - a[AVERAGE_XX]);
    const double table[OF_PATCH] = {f[2] * a[AVERAGE_X],
                                    f[2] * a[AVERAGE_Y],
                                    along_x,
                                    along_y,
                                    f[0] * a[AVERAGE] - along_x,
                                    f[1] * a[AVERAGE] - along_y,
                                    f[2] * a[AVERAGE],
                                    -(f[0] * a[AVERAGE_X] + f[1] * a[AVERAGE_Y])};
    memcpy(value, table, sizeof table);
}

void path_find_lines(struct path *path, bool stress)
{
    path->lines = 0;
    if (path->patch) {
        const bool vertical = path->source->force[2] != 0;
        const bool horizontal = path->source->force[0] != 0 || path->source->force[1] != 0;
        for (int l = 0; l < OF_PATCH; l++)
            if (of_patch[l].statics < 2 ? vertical : horizontal) path->line[path->lines++] = (unsigned char)l;
        return;
    }
    for (int l = 0; l < MOST_LINES; l++) {
        enum strata_column column = COLUMN_VERTICAL;
        const struct view *view = view_of((size_t)l, &column);
        if (!stress && view->component > DOWN) continue;
        const struct jump jump = jump_of(path, column, 1);
        double size = 0;
        for (int m = 0; m < HARMONICS; m++)
            size += view->sine ? cabs(jump.odd[m]) : cabs(jump.even[m]);
        if (size > 0) path->line[path->lines++] = (unsigned char)l;
    }
}

static double taper(const struct path *path, double k)
{
    return path->width > 0 ? .5 * erfc((k - path->centre) / path->width) : k <= path->end ? 1 : 0;
}

void path_weights(const struct path *path, size_t count, const double *k, const double *quadrature,
                  double *weight)
{
    for (size_t i = 0; i < count; i++) {
        const double scale = quadrature[i] * k[i] * taper(path, k[i]);
        if (path->patch) {
            double value[OF_PATCH];
            patch_coefficients(path, k[i], value);
            for (size_t l = 0; l < path->lines; l++)
                weight[l * NODES + i] = scale * value[path->line[l]];
            continue;
        }
        double complex c[ORDERS];
        bessel(k[i] * path->distance, c);
        for (size_t l = 0; l < path->lines; l++) {
            enum strata_column column = COLUMN_VERTICAL;
            const struct view *view = view_of(path->line[l], &column);
            const struct jump jump = jump_of(path, column, k[i]);
            weight[l * NODES + i] = scale / (2 * M_PI) * creal(seen(&jump, view, c));
        }
    }
}

void path_sum(const struct path *path, size_t count, const double *weight, const double *response,
              double complex component[COMPONENTS])
{
    for (size_t l = 0; l < path->lines; l++, weight += NODES) {
        size_t to = 0, from = 0;
        if (path->patch) {
            to = of_patch[path->line[l]].component;
            from = of_patch[path->line[l]].statics;
        } else {
            enum strata_column column = COLUMN_VERTICAL;
            const struct view *view = view_of(path->line[l], &column);
            to = view->component;
            from = (size_t)column * RESPONSES + view->response;
        }
        const double *line = response + 2 * NODES * from;
        component[to] += short_sum_of_products(weight, line, count) +
                         I * short_sum_of_products(weight, line + NODES, count);
    }
}

void path_turn(const struct path *path, bool stress, double complex component[COMPONENTS])
{
    const double c = path->cosine, s = path->sine;
    const double complex r = component[RADIAL], t = component[TRANSVERSE];
    component[0] = c * r - s * t;
    component[1] = s * r + c * t;
    if (!stress) return;
    const double complex rr = component[S_RR], tt = component[S_TT], rt = component[S_RT];
    const double complex tz = component[S_TZ], zr = component[S_ZR];
    component[3] = c * c * rr + s * s * tt - 2 * c * s * rt;
    component[4] = s * s * rr + c * c * tt + 2 * c * s * rt;
    component[6] = c * s * (rr - tt) + (c * c - s * s) * rt;
    component[7] = s * zr + c * tz;
    component[8] = c * zr - s * tz;
}
