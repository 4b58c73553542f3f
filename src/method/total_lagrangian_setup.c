/* Set-up of total-Lagrangian SPH: gradient weights by weighted least squares in the reference configuration,
 * their transposed rows, and the pairs of hourglass control and viscosity. */
#include "method/total_lagrangian.h"

#include "base/memory.h"
#include "method/cloud_method.h"
#include "points/least_squares.h"

#include <math.h>
#include <string.h>

selas_status tl_rows_allocate(struct tl_rows *rows, size_t count, size_t entries, size_t width)
{
    rows->start = array_new(count + 1, sizeof *rows->start);
    rows->index = array_new(entries, sizeof *rows->index);
    rows->weight = width > 0 ? array_new(entries * width, sizeof *rows->weight) : NULL;
    const bool room = rows->start != NULL && rows->index != NULL && (rows->weight != NULL || width == 0);
    return room ? SELAS_OK : SELAS_NO_MEMORY;
}

void tl_rows_free(struct tl_rows *rows)
{
    array_free(rows->start);
    array_free(rows->index);
    array_free(rows->weight);
    *rows = (struct tl_rows){0};
}

double tl_radius(const struct tl_model *tl)
{
    double length = tl->options.smoothing_length;
    if (!(length > 0)) length = tl->options.central ? 0.8 : tl->options.degree == 2 ? 1.3 : 1.5;
    return length * tl->options.kernel->support * tl->cloud->spacing;
}

struct work {
    size_t room;
    uint32_t *index;
    double *offset, *weight, *gradient, *fit;
};

static void work_free(struct work *work)
{
    array_free(work->index);
    array_free(work->offset);
    array_free(work->weight);
    array_free(work->gradient);
    array_free(work->fit);
}

static bool work_allocate(struct work *work, size_t room)
{
    work->room = room;
    work->index = array_new(room, sizeof *work->index);
    work->offset = array_new(3 * room, sizeof *work->offset);
    work->weight = array_new(room, sizeof *work->weight);
    work->gradient = array_new(3 * room, sizeof *work->gradient);
    work->fit = array_new(FIT_TERMS * room, sizeof *work->fit);
    return work->index != NULL && work->offset != NULL && work->weight != NULL && work->gradient != NULL &&
           work->fit != NULL;
}

static double site_volume(const struct tl_model *tl, size_t s)
{
    return s < tl->cloud->points ? tl->cloud->volume[s] : tl->ghost[s - tl->cloud->points].volume;
}

/* Exponent of the kernel in the weights of quadratic gradients, and what it does (measured, see the manual).
 * On a lattice, where the stencil is whole: sharp weights, for they disperse waves least (error of a pulse
 * .012 instead of .030 with exponent 1/2); where faces cut it: flat ones, for the largest gradient weights
 * are there and limit the time step (courant limit .97 instead of .66 with exponent 1). On scattered points
 * the same smooth weights everywhere, since jumps from point to point make noise in the stress. */
static double weight_exponent(const struct tl_model *tl, bool cut)
{
    const bool lattice = tl->cloud->grid[0] > 0;
    if (!lattice) return 0.5;
    return cut ? 0.2 : 2;
}

/* Sites within `radius` of point i with their weights; returns how many. Linear: V |W'| / r, the corrected
 * kernel gradient. Quadratic: V W^exponent. */
static size_t collect(const struct tl_model *tl, const struct neighbours *near, size_t i, double radius,
                      double exponent, struct work *work)
{
    const struct kernel *kernel = tl->options.kernel;
    const double *x = tl->site_position + 3 * i;
    const double h = radius / kernel->support;
    const bool quadratic = tl->options.degree == 2;
    size_t count = 0;
    for (size_t k = near->start[i]; k < near->start[i + 1] && count < work->room; k++) {
        const size_t j = near->index[k];
        double square = 0;
        if (j == i && !quadratic) continue;
        for (size_t c = 0; c < 3; c++) {
            work->offset[3 * count + c] = tl->site_position[3 * j + c] - x[c];
            square += work->offset[3 * count + c] * work->offset[3 * count + c];
        }
        const double r = sqrt(square);
        if (r >= radius * (1 - 1e-9)) continue;
        double weight = quadratic ? pow(kernel_value(kernel, tl->cloud->dimension, r, h), exponent)
                                  : -kernel_derivative_over_r(kernel, tl->cloud->dimension, r, h);
        weight *= site_volume(tl, j);
        if (!(weight > 0)) continue;
        work->weight[count] = weight;
        work->index[count++] = (uint32_t)j;
    }
    return count;
}

/* Neighbours within `reach` spacings of a point inside a lattice. */
static size_t lattice_neighbours(int dimension, double reach)
{
    const int most = (int)ceil(reach);
    const int m[3] = {most, dimension > 1 ? most : 0, dimension > 2 ? most : 0};
    size_t count = 0;
    for (int x = -m[0]; x <= m[0]; x++)
        for (int y = -m[1]; y <= m[1]; y++)
            for (int z = -m[2]; z <= m[2]; z++)
                count += x * x + y * y + z * z < reach * reach * (1 - 1e-9);
    return count - 1;
}

size_t tl_wanted(const struct tl_model *tl)
{
    if (tl->options.degree == 1) return 0;
    return lattice_neighbours(tl->cloud->dimension, tl_radius(tl) / tl->cloud->spacing);
}

/* Gradient weights of point i into work->gradient; returns how many sites they take, 0 if no radius will do.
 * Quadratic gradients at faces and corners grow their radius until they have as many neighbours as inside: a
 * one-sided fit over few points has large weights, which would limit the time step. */
static size_t fit_point(const struct tl_model *tl, const struct neighbours *near, size_t i, struct work *work)
{
    if (tl->options.central) return tl_central_row(tl, near, i, work->index, work->gradient);
    const double reach = tl_radius(tl) / tl->cloud->spacing;
    const bool quadratic = tl->options.degree == 2;
    const size_t wanted = tl_wanted(tl);
    double radius = reach * tl->spacing[i];
    size_t count = 0;
    bool done = false;
    bool cut = false;
    for (; !done && radius <= near->radius * (1 + 1e-12); radius *= 1.03) {
        count = collect(tl, near, i, radius, weight_exponent(tl, cut), work);
        cut = cut || count < wanted;
        if (count < wanted && radius * 1.03 < near->radius) continue;
        const struct fit fit = {tl->cloud->dimension, tl->options.degree, radius,   count,
                                work->offset,         work->weight,       work->fit};
        done = quadratic ? fit_free(&fit, NULL, work->gradient) : fit_through_centre(&fit, work->gradient);
    }
    return done ? count : 0;
}

static selas_status fill_gradient(struct tl_model *tl, const struct neighbours *near, struct work *work,
                                  struct messages *messages)
{
    const size_t d = (size_t)tl->cloud->dimension;
    const size_t n = tl->cloud->points;
    size_t entries = 0;
    for (size_t i = 0; i < n; i++) {
        const size_t count = fit_point(tl, near, i, work);
        if (count == 0)
            return fail(
                messages, SELAS_BAD_SCENE,
                "point %zu at (%g, %g, %g) has too few neighbours for a gradient of degree %d: the body is "
                "too thin for its spacing",
                i, tl->cloud->position[3 * i], tl->cloud->position[3 * i + 1], tl->cloud->position[3 * i + 2],
                tl->options.degree);
        for (size_t k = 0; k < count; k++) {
            if (work->index[k] == i) continue;
            tl->gradient.index[entries] = work->index[k];
            for (size_t a = 0; a < d; a++)
                tl->gradient.weight[d * entries + a] = work->gradient[3 * k + a];
            entries++;
        }
        tl->gradient.start[i + 1] = entries;
    }
    return SELAS_OK;
}

/* G_ii = minus the sum over j of G_ij; false if that is 0 but for rounding, as inside a lattice. */
static bool own_weight(const struct tl_model *tl, size_t i, double own[3])
{
    const size_t d = (size_t)tl->cloud->dimension;
    double size = 0;
    own[0] = own[1] = own[2] = 0;
    for (size_t k = tl->gradient.start[i]; k < tl->gradient.start[i + 1]; k++)
        for (size_t a = 0; a < d && a < 3; a++) {
            own[a] -= tl->gradient.weight[d * k + a];
            size += fabs(tl->gradient.weight[d * k + a]);
        }
    return fabs(own[0]) + fabs(own[1]) + fabs(own[2]) > 1e-13 * size;
}

/* Entries of each site, to start[site + 1]. */
static void count_entries(const struct tl_model *tl, size_t *start)
{
    double own[3];
    for (size_t k = 0; k < tl->gradient.start[tl->cloud->points]; k++)
        start[tl->gradient.index[k] + 1]++;
    for (size_t i = 0; i < tl->cloud->points; i++)
        start[i + 1] += own_weight(tl, i, own);
    for (size_t s = 0; s < tl->sites; s++)
        start[s + 1] += start[s];
}

static selas_status transpose(struct tl_model *tl, struct messages *messages)
{
    const size_t d = (size_t)tl->cloud->dimension;
    const size_t n = tl->cloud->points;
    const size_t entries = tl->gradient.start[n] + n;
    struct tl_rows *rows = &tl->transposed;
    size_t *next = array_new(tl->sites + 1, sizeof *next);
    if (next == NULL || tl_rows_allocate(rows, tl->sites, entries, d) != SELAS_OK || rows->weight == NULL) {
        array_free(next);
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu pairs", entries);
    }
    count_entries(tl, rows->start);
    memcpy(next, rows->start, tl->sites * sizeof *next);
    for (size_t i = 0; i < n; i++) {
        double own[3];
        if (own_weight(tl, i, own)) {
            const size_t place = next[i]++;
            rows->index[place] = (uint32_t)i;
            memcpy(rows->weight + d * place, own, d * sizeof(double));
        }
        for (size_t k = tl->gradient.start[i]; k < tl->gradient.start[i + 1]; k++) {
            const size_t place = next[tl->gradient.index[k]]++;
            rows->index[place] = (uint32_t)i;
            memcpy(rows->weight + d * place, tl->gradient.weight + d * k, d * sizeof(double));
        }
    }
    array_free(next);
    return SELAS_OK;
}

/* Ghosts of each point. */
static selas_status return_rows(struct tl_model *tl, struct messages *messages)
{
    const size_t n = tl->cloud->points;
    struct tl_rows *rows = &tl->returned;
    size_t *next = array_new(n + 1, sizeof *next);
    if (next == NULL || tl_rows_allocate(rows, n, tl->ghosts, 0) != SELAS_OK) {
        array_free(next);
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu ghosts", tl->ghosts);
    }
    for (size_t g = 0; g < tl->ghosts; g++)
        rows->start[tl->ghost[g].source + 1]++;
    for (size_t i = 0; i < n; i++)
        rows->start[i + 1] += rows->start[i];
    memcpy(next, rows->start, n * sizeof *next);
    for (size_t g = 0; g < tl->ghosts; g++)
        rows->index[next[tl->ghost[g].source]++] = (uint32_t)g;
    array_free(next);
    tl->source = array_new(tl->ghosts, sizeof *tl->source);
    if (tl->source == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for %zu ghosts", tl->ghosts);
    for (size_t i = 0; i < n; i++)
        if (rows->start[i + 1] > rows->start[i]) tl->source[tl->sources++] = i;
    return SELAS_OK;
}

static double distance(const double *a, const double *b)
{
    double square = 0;
    for (int c = 0; c < 3; c++)
        square += (a[c] - b[c]) * (a[c] - b[c]);
    return sqrt(square);
}

/* Pairs of nearest points (8 in a plane lattice, 18 in space): k_ij = hourglass * (lambda + 2 mu) * volume /
 * (2 dimension |X_ij|^2), so that what the gradients miss of the strain e_ij / |X_ij| counts as a strain with
 * about `hourglass` times the modulus. */
static selas_status hourglass_pairs(struct tl_model *tl, const struct neighbours *near,
                                    struct messages *messages)
{
    const size_t n = tl->cloud->points;
    const double usual = 2 * tl->cloud->dimension;
    tl->extra = array_new((size_t)tl->cloud->dimension * n, sizeof(double));
    if (tl->extra == NULL || tl_rows_allocate(&tl->pair, n, near->start[n], 1) != SELAS_OK)
        return fail(messages, SELAS_NO_MEMORY, "no memory for hourglass pairs");
    size_t entries = 0;
    for (size_t i = 0; i < n; i++) {
        for (size_t k = near->start[i]; k < near->start[i + 1]; k++) {
            const size_t j = near->index[k];
            if (j == i || (j >= n && tl->ghost[j - n].curved)) continue;
            const size_t source = j < n ? j : tl->ghost[j - n].source;
            const double r = distance(tl->site_position + 3 * i, tl->site_position + 3 * j);
            if (r > 1.6 * fmax(tl->spacing[i], tl->spacing[source])) continue;
            double stiffness = 0;
            const size_t both[2] = {i, source};
            for (int e = 0; e < 2; e++) {
                const struct elastic *elastic = &tl->elastic[both[e]];
                stiffness += 0.5 * (elastic->plane_lambda + 2 * elastic->mu) * tl->cloud->volume[both[e]];
            }
            tl->pair.index[entries] = (uint32_t)j;
            tl->pair.weight[entries++] = tl->options.hourglass * stiffness / (usual * r * r);
        }
        tl->pair.start[i + 1] = entries;
    }
    return SELAS_OK;
}

static selas_status viscosity_pairs(struct tl_model *tl, const struct neighbours *near,
                                    struct messages *messages)
{
    const size_t n = tl->cloud->points;
    const struct kernel *kernel = tl->options.kernel;
    const double per_spacing = tl_radius(tl) / (kernel->support * tl->cloud->spacing);
    tl->site_v = array_new((size_t)tl->cloud->dimension * tl->sites, sizeof(double));
    if (tl->site_v == NULL || tl_rows_allocate(&tl->viscous, n, near->start[n], 2) != SELAS_OK)
        return fail(messages, SELAS_NO_MEMORY, "no memory for viscosity pairs");
    size_t entries = 0;
    for (size_t i = 0; i < n; i++) {
        for (size_t k = near->start[i]; k < near->start[i + 1]; k++) {
            const size_t j = near->index[k];
            const double r = distance(tl->site_position + 3 * i, tl->site_position + 3 * j);
            const size_t source = j < n ? j : tl->ghost[j - n].source;
            const double h = 0.5 * per_spacing * (tl->spacing[i] + tl->spacing[source]);
            const double slope = -kernel_derivative(kernel, tl->cloud->dimension, r, h);
            if (j == i || !(slope > 0)) continue;
            tl->viscous.index[entries] = (uint32_t)j;
            tl->viscous.weight[2 * entries] = tl->mass[i] * tl->mass[source] * slope;
            tl->viscous.weight[2 * entries++ + 1] = h;
        }
        tl->viscous.start[i + 1] = entries;
    }
    return SELAS_OK;
}

static size_t longest_row(const struct neighbours *near, size_t n)
{
    size_t longest = 0;
    for (size_t i = 0; i < n; i++)
        if (near->start[i + 1] - near->start[i] > longest) longest = near->start[i + 1] - near->start[i];
    return longest;
}

double tl_search_radius(const struct tl_model *tl)
{
    double largest = 0;
    for (size_t i = 0; i < tl->cloud->points; i++)
        largest = fmax(largest, tl->spacing[i]);
    return 1.5 * tl_radius(tl) / tl->cloud->spacing * largest;
}

selas_status tl_make_rows(struct tl_model *tl, struct messages *messages)
{
    const size_t n = tl->cloud->points;
    const size_t d = (size_t)tl->cloud->dimension;
    struct neighbours near = {0};
    struct work work = {0};
    selas_status status = tl_make_ghosts(tl, tl_search_radius(tl), messages);
    if (status == SELAS_OK)
        status = neighbours_find(&near, (int)d, tl->sites, tl->site_position, tl_search_radius(tl), true,
                                 messages);
    if (status == SELAS_OK) {
        if (!work_allocate(&work, longest_row(&near, n)) ||
            tl_rows_allocate(&tl->gradient, n, near.start[n], d) != SELAS_OK)
            status = fail(messages, SELAS_NO_MEMORY, "no memory for %zu pairs", near.start[n]);
    }
    if (status == SELAS_OK)
        status = tl->options.cloud ? cloud_gradients(tl, &near, messages)
                                   : fill_gradient(tl, &near, &work, messages);
    if (status == SELAS_OK) status = transpose(tl, messages);
    if (status == SELAS_OK) status = return_rows(tl, messages);
    if (status == SELAS_OK && tl->options.hourglass > 0) status = hourglass_pairs(tl, &near, messages);
    if (status == SELAS_OK && (tl->options.viscosity_alpha > 0 || tl->options.viscosity_beta > 0))
        status = viscosity_pairs(tl, &near, messages);
    if (status == SELAS_OK) status = tl_find_runs(tl, messages);
    neighbours_free(&near);
    work_free(&work);
    return status;
}
