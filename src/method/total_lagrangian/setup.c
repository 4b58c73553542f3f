/* Set-up of total-Lagrangian SPH: gradient weights by weighted least squares in the reference configuration,
 * and their transposed rows. */
#include "method/total_lagrangian/setup.h"

#include "base/memory.h"
#include "points/disorder.h"
#include "points/least_squares.h"

#include <math.h>
#include <string.h>

double tl_reach(const struct tl_options *options)
{
    double length = options->smoothing_length;
    if (!(length > 0)) length = options->central ? 0.8 : options->degree == 2 ? 1.3 : 1.5;
    return length * options->kernel->support;
}

double tl_radius(const struct tl_model *tl)
{
    return tl_reach(&tl->options) * tl->cloud->spacing;
}

void tl_work_free(struct tl_work *work)
{
    array_free(work->near);
    array_free(work->index);
    array_free(work->offset);
    array_free(work->weight);
    array_free(work->gradient);
    array_free(work->fit);
    *work = (struct tl_work){0};
}

bool tl_work_allocate(struct tl_work *work, size_t room)
{
    tl_work_free(work);
    work->room = room;
    work->near = array_new(room, sizeof *work->near);
    work->index = array_new(room, sizeof *work->index);
    work->offset = array_new(3 * room, sizeof *work->offset);
    work->weight = array_new(room, sizeof *work->weight);
    work->gradient = array_new(3 * room, sizeof *work->gradient);
    work->fit = array_new(FIT_TERMS * room, sizeof *work->fit);
    return work->near != NULL && work->index != NULL && work->offset != NULL && work->weight != NULL &&
           work->gradient != NULL && work->fit != NULL;
}

bool tl_find_near(const struct tl_model *tl, const struct neighbours *near, size_t i, double radius,
                  struct tl_work *work)
{
    const double *x = tl->site_position + 3 * i;
    work->found = neighbours_within(near, x, radius, work->room, work->near);
    if (work->found <= work->room) return true;
    if (!tl_work_allocate(work, 2 * work->found)) return false;
    work->found = neighbours_within(near, x, radius, work->room, work->near);
    return true;
}

double tl_distance(const double *a, const double *b)
{
    double square = 0;
    for (int c = 0; c < 3; c++)
        square += (a[c] - b[c]) * (a[c] - b[c]);
    return sqrt(square);
}

static double site_volume(const struct tl_model *tl, size_t s)
{
    return s < tl->cloud->points ? tl->cloud->volume[s] : tl->ghost[s - tl->cloud->points].volume;
}

/* Exponent of the kernel in the weights of quadratic gradients, and what it does (measured).
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

static double dispersion(const struct tl_model *tl)
{
    const struct kernel *kernel = tl->options.kernel;
    const double power = tl->options.degree == 2 ? weight_exponent(tl, false) : 0;
    return kernel_dispersion(kernel, tl->cloud->dimension, tl_reach(&tl->options) / kernel->support, power);
}

/* Of the sites near point i those within `radius`, with their weights; returns how many. Linear: V |W'| / r,
 * the corrected kernel gradient. Quadratic: V W^exponent. */
static size_t collect(const struct tl_model *tl, size_t i, double radius, double exponent,
                      struct tl_work *work)
{
    const struct kernel *kernel = tl->options.kernel;
    const double *x = tl->site_position + 3 * i;
    const double h = radius / kernel->support;
    const bool quadratic = tl->options.degree == 2;
    size_t count = 0;
    for (size_t k = 0; k < work->found; k++) {
        const size_t j = work->near[k];
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

bool tl_has_gaps(const struct tl_model *tl)
{
    return tl->model.scene->body.shape == BODY_POINTS && tl->options.form == NULL;
}

static double spacing_of(const void *of, size_t site)
{
    const struct tl_model *tl = of;
    return tl->spacing[tl_source(tl, site)];
}

size_t tl_connected(const struct tl_model *tl, size_t first, size_t count, uint32_t *site)
{
    return points_connected(tl->site_position, spacing_of, tl, first, count, site);
}

/* Gradient weights of point i into work->gradient; returns how many sites they take, 0 if no radius up to
 * `most` will do, SIZE_MAX if there is no memory. Quadratic gradients at faces and corners grow their radius
 * until they have as many neighbours as inside: a one-sided fit over few points has large weights, which
 * would limit the time step. With `apart` sites across gaps are left out. */
static size_t fit_point(const struct tl_model *tl, const struct neighbours *near, size_t i, double most,
                        bool apart, struct tl_work *work)
{
    const double reach = tl_radius(tl) / tl->cloud->spacing;
    const bool quadratic = tl->options.degree == 2;
    const size_t wanted = tl_wanted(tl);
    double radius = reach * tl->spacing[i], found = tl->options.central ? most : radius;
    size_t count = 0;
    bool done = false;
    bool cut = false;
    if (!tl_find_near(tl, near, i, found, work)) return SIZE_MAX;
    if (apart) work->found = tl_connected(tl, i, work->found, work->near);
    if (tl->options.central)
        return tl_central_row(tl, work->near, work->found, i, work->index, work->gradient);
    for (; !done && radius <= most * (1 + 1e-12); radius *= 1.03) {
        if (radius > found) {
            if (!tl_find_near(tl, near, i, found = fmin(most, 1.5 * radius), work)) return SIZE_MAX;
            if (apart) work->found = tl_connected(tl, i, work->found, work->near);
        }
        count = collect(tl, i, radius, weight_exponent(tl, cut), work);
        cut = cut || count < wanted;
        if (count < wanted && radius * 1.03 < most) continue;
        const struct fit fit = {tl->cloud->dimension, tl->options.degree, radius,   count,
                                work->offset,         work->weight,       work->fit};
        done = quadratic ? fit_free(&fit, NULL, work->gradient) : fit_through_centre(&fit, work->gradient);
    }
    return done ? count : 0;
}

selas_status tl_no_memory(const struct tl_model *tl, struct messages *messages)
{
    return fail(messages, SELAS_NO_MEMORY, "no memory for the neighbours of %zu points", tl->cloud->points);
}

size_t tl_layers_within(const struct scene *scene, const size_t grid[3], double radius)
{
    double least = radius;
    for (size_t c = 0; c < (size_t)scene->dimension && grid[0] > 0; c++) {
        const struct body *body = &scene->body;
        least = fmin(least, (body->high[c] - body->low[c]) / (double)grid[c]);
    }
    return (size_t)ceil(radius / least) + 1;
}

selas_status tl_fill_gradient(struct tl_making *making, struct messages *messages)
{
    struct tl_model *tl = making->tl;
    struct tl_work *work = &making->work;
    const double most = tl_search_radius(tl);
    const size_t layers = tl_layers_within(tl->model.scene, tl->cloud->grid, most);
    struct tl_rows *rows = &tl->gradient;
    for (size_t i = tl->part.gradient.from; i < tl->part.gradient.end; i++) {
        struct tl_like like;
        tl_likes(tl, i, layers, &like);
        if (tl_rows_share(tl, rows, i, &like, false)) continue;
        size_t count = fit_point(tl, &making->near, i, most, tl_has_gaps(tl), work);
        if (count == 0 && tl_has_gaps(tl)) /* points far apart along one axis */
            count = fit_point(tl, &making->near, i, most, false, work);
        if (count == 0)
            return fail(
                messages, SELAS_BAD_SCENE,
                "point %zu at (%g, %g, %g) has too few neighbours for a gradient of degree %d: the body is "
                "too thin for its spacing",
                cloud_number(tl->cloud, i), tl->cloud->position[3 * i], tl->cloud->position[3 * i + 1],
                tl->cloud->position[3 * i + 2], tl->options.degree);
        bool room = count < SIZE_MAX;
        for (size_t k = 0; room && k < count; k++)
            if (work->index[k] != i) room = tl_rows_add(rows, i, work->index[k], work->gradient + 3 * k);
        if (!room || !tl_rows_close(rows, i, &like, NULL, 0)) return tl_no_memory(tl, messages);
    }
    return tl_rows_end(rows) ? SELAS_OK : tl_no_memory(tl, messages);
}

/* G_ii = minus the sum over j of G_ij; false if that is 0 but for rounding, as inside a lattice. */
static bool own_weight(const struct tl_model *tl, size_t i, double own[3])
{
    const struct tl_rows *rows = &tl->gradient;
    double size = 0;
    own[0] = own[1] = own[2] = 0;
    for (size_t k = tl_first(rows, i); k < tl_last(rows, i); k++)
        for (size_t a = 0; a < rows->width && a < 3; a++) {
            own[a] -= rows->weight[rows->width * k + a];
            size += fabs(rows->weight[rows->width * k + a]);
        }
    return fabs(own[0]) + fabs(own[1]) + fabs(own[2]) > 1e-13 * size;
}

/* Largest distance of the neighbours in the gradients. */
double tl_reach_of_rows(const struct tl_model *tl)
{
    const struct tl_rows *rows = &tl->gradient;
    double most = 0;
    for (size_t r = 0; r < rows->rows; r++)
        for (size_t k = rows->start[r]; k < rows->start[r + 1]; k++) {
            const size_t i = rows->example[r];
            most = fmax(most, tl_distance(tl->site_position + 3 * i,
                                          tl->site_position + 3 * tl_neighbour(rows, i, k)));
        }
    return most * (1 + 1e-9);
}

/* Adds what stands for site s in the row of point i to the open transposed row. */
static bool add_transposed(struct tl_model *tl, size_t s, size_t i)
{
    const struct tl_rows *rows = &tl->gradient;
    double own[3];
    if (i == s && own_weight(tl, i, own)) return tl_rows_add(&tl->transposed, s, i, own);
    if (i == s) return true;
    const ptrdiff_t shift = rows->dimension * ((ptrdiff_t)s - (ptrdiff_t)i);
    for (size_t k = tl_first(rows, i); k < tl_last(rows, i); k++)
        if (rows->shift[k] == shift)
            return tl_rows_add(&tl->transposed, s, i, rows->weight + rows->width * k);
    return true;
}

/* Rows of the sites over the points whose gradients they enter. */
selas_status tl_transpose(struct tl_making *making, struct messages *messages)
{
    struct tl_model *tl = making->tl;
    struct tl_work *work = &making->work;
    const size_t n = tl->cloud->points, *grid = tl->cloud->grid;
    const struct tl_range *made = &tl->part.transposed;
    const size_t layers = tl_layers_within(tl->model.scene, grid, making->reach) +
                          tl_layers_within(tl->model.scene, grid, tl_search_radius(tl));
    for (size_t s = made->from; s < tl->sites; s++) {
        struct tl_like like;
        const size_t source = tl_source(tl, s);
        if (source < made->from || source >= made->end) continue;
        tl_likes(tl, s, layers, &like);
        if (tl_rows_share(tl, &tl->transposed, s, &like, false)) continue;
        bool room = tl_find_near(tl, &making->near, s, making->reach, work);
        for (size_t k = 0; room && k < work->found && work->near[k] < n; k++)
            room = add_transposed(tl, s, work->near[k]);
        if (!room || !tl_rows_close(&tl->transposed, s, &like, NULL, 0)) return tl_no_memory(tl, messages);
    }
    return tl_rows_end(&tl->transposed) ? SELAS_OK : tl_no_memory(tl, messages);
}

/* Mean square of the forces of a uniform unit stress. */
static double disorder(const struct tl_model *tl)
{
    const struct tl_rows *rows = &tl->transposed;
    const struct tl_range range = tl_summed(tl);
    const size_t dimension = (size_t)tl->cloud->dimension;
    double sums[2] = {0};
    for (size_t i = range.from; i < range.end; i++) {
        const double each = tl->spacing[i] / tl->cloud->volume[i];
        double force[3] = {0};
        for (size_t k = tl_first(rows, i); k < tl_last(rows, i); k++)
            for (size_t a = 0; a < dimension; a++)
                force[a] +=
                    each * rows->weight[rows->width * k + a] * tl->cloud->volume[tl_neighbour(rows, i, k)];
        disorder_add(sums, tl->cloud, &tl->model.scene->body, tl_radius(tl), i, force);
    }
    if (tl->part.shared) ranks_sum(tl->part.ranks, 2, sums);
    return disorder_mean(sums, tl->cloud->dimension);
}

/* What quadratic gradients at faces err by, over 20 neighbours in the plane (doc/theory/sph-total-lagrangian.md, Eq
 * 1b). */
static double at_faces(const struct tl_model *tl)
{
    return pow((double)tl_wanted(tl), 2.0 / tl->cloud->dimension) / 20;
}

/* By gradients (the cloud's err as differences of nearest points, whatever its kernel). On scattered points a uniform
 * stress pushes each one aside, against hourglass control: waves are slower, whatever the spacing (measured:
 * regress/studies/bodies/pulse). */
struct wave_law tl_waves(const struct tl_model *tl)
{
    const struct tl_options *options = &tl->options;
    if (options->central)
        return (struct wave_law){
            .constant = 400, .order = 4, .sent = 400, .sent_order = 4, .bends = .3, .bends_order = 2};
    if (options->form != NULL)
        return (struct wave_law){
            .constant = 44, .order = 2, .sent = 35, .sent_order = 2, .bends = .4, .bends_order = 2};
    const double loose = 1 + 0.55 / fmax(1e-3, options->hourglass);
    const bool lattice = tl->cloud->grid[0] > 0;
    const double scatter = lattice ? 0 : loose * disorder(tl);
    const double coarser = lattice ? 1 : cloud_mean_power(tl->cloud, 2);
    const double lost = dispersion(tl) * coarser, beside = fmax(lost, at_faces(tl) * coarser);
    return (struct wave_law){.constant = 44 * lost,
                             .order = 2,
                             .sent = 48 * beside,
                             .sent_order = 2,
                             .floor = scatter,
                             .scatter = scatter,
                             .bends = options->degree == 2 ? .5 : 4,
                             .bends_order = 2};
}

double tl_largest_spacing(const struct tl_model *tl)
{
    double largest = 0;
    if (tl->part.spacing > 0) return tl->part.spacing;
    for (size_t i = 0; i < tl->cloud->points; i++)
        largest = fmax(largest, tl->spacing[i]);
    return largest;
}

double tl_search_radius(const struct tl_model *tl)
{
    return 1.5 * tl_radius(tl) / tl->cloud->spacing * tl_largest_spacing(tl);
}
