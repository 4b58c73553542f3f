/* Sum over the wavenumbers k at one complex frequency s = eta + i w (doc/theory/lamb.md, Eq 7):
 *   u = sum over the nodes of coefficient(k) * (compliance(k, s) - static compliance(k)),
 * where the coefficients hold the quadrature weight, the load's direction and the direction averages of its
 * transform at the receiver. Poles and branch points lie eta/c off the real axis at k = w/c: there panels are
 * no wider than that distance asks, elsewhere only as narrow as the oscillation over the distance asks. */
#include "exact/lamb_sum.h"

#include "base/memory.h"
#include "base/sums.h"
#include "exact/gauss12.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { KERNELS = 5, PANEL = 12, LINES = LAMB_COMPONENTS * KERNELS };

static const double NEAR = .4; /* of a wide panel: what is farther from a pole needs no narrow panels */

selas_status lamb_sum_set(struct lamb_sum *sum, const struct lamb_problem *problem, size_t receivers,
                          const struct lamb_signal *signal, double decay, struct messages *messages)
{
    const struct layered *layers = problem->layers;
    *sum = (struct lamb_sum){.ground = &problem->ground, .layers = layers};
    sum->slowest = layers != NULL ? layers->slowest : problem->ground.rayleigh_speed;
    sum->fastest = layers != NULL ? layers->fastest[0] : problem->ground.p_speed;
    sum->paths = receivers * problem->loads;
    sum->path = array_new(sum->paths, sizeof *sum->path);
    if (sum->path == NULL)
        return fail(messages, SELAS_NO_MEMORY, "not enough memory for the half-space's reference");
    double reach = 0; /* echoes between layers oscillate with their depth */
    const double echo = layers != NULL ? 2 * layers->stratum[layers->strata - 1].top : 0;
    for (size_t p = 0; p < sum->paths; p++) {
        const struct lamb_load *load = &problem->load[p % problem->loads];
        const double *position = signal[p / problem->loads].position;
        struct lamb_path *path = &sum->path[p];
        path->load = load;
        path->x = position[0] - load->patch.centre[0];
        path->y = position[1] - load->patch.centre[1];
        path->z = position[2];
        path->without_rayleigh = lamb_split_rayleigh(load);
        path->horizontal = load->traction[0] != 0 || load->traction[1] != 0;
        reach = fmax(reach, fabs(path->x) + fabs(path->y) + load->patch.half[0] + load->patch.half[1] +
                                2 * path->z + echo);
    }
    const double s_speed = layers != NULL ? layers->fastest[1] : problem->ground.s_speed;
    const double narrow = fmin(12 / reach, decay * fmin(2 / s_speed, 2.4 / sum->fastest));
    sum->refine = (size_t)fmax(1, floor(12 / (reach * narrow)));
    sum->narrow.panel = narrow;
    sum->wide.panel = narrow * (double)sum->refine;
    return SELAS_OK;
}

static void grid_free(struct lamb_grid *grid)
{
    array_free(grid->k);
    array_free(grid->weight);
    array_free(grid->statics);
}

void lamb_sum_free(struct lamb_sum *sum)
{
    array_free(sum->path);
    grid_free(&sum->wide);
    grid_free(&sum->narrow);
}

/* Coefficients of the compliances (order of struct compliance) for each component. */
static void coefficients(const struct lamb_path *path, double k, double weight,
                         double value[LAMB_COMPONENTS][KERNELS])
{
    double a[AVERAGES];
    patch_averages(&path->load->patch, path->x, path->y, k, a);
    const double scale = weight * k;
    for (int i = 0; i < AVERAGES; i++)
        a[i] *= scale;
    const double fx = path->load->traction[0], fy = path->load->traction[1], fz = path->load->traction[2];
    const double yy = a[AVERAGE] - a[AVERAGE_XX];
    const double along_x = fx * a[AVERAGE_XX] + fy * a[AVERAGE_XY], along_y = fx * a[AVERAGE_XY] + fy * yy;
    const double table[LAMB_COMPONENTS][KERNELS] = {
        {0, fz * a[AVERAGE_X], along_x, 0, fx * a[AVERAGE] - along_x},
        {0, fz * a[AVERAGE_Y], along_y, 0, fy * a[AVERAGE] - along_y},
        {fz * a[AVERAGE], 0, 0, fx * a[AVERAGE_X] + fy * a[AVERAGE_Y], 0},
    };
    memcpy(value, table, sizeof table);
}

/* Gives `lines` lines of an array more room. */
static bool widen(double **array, size_t lines, size_t used, size_t old_room, size_t room)
{
    double *wider = array_new(lines * room, sizeof *wider);
    if (wider == NULL) return false;
    for (size_t i = 0; i < lines && used > 0; i++)
        memcpy(wider + i * room, *array + i * old_room, used * sizeof *wider);
    array_free(*array);
    *array = wider;
    return true;
}

/* Paths that follow each other and have the same compliances form a group. */
static bool starts_group(const struct lamb_sum *sum, size_t p)
{
    const struct lamb_path *path = &sum->path[p];
    return p == 0 || path[-1].z != path->z || path[-1].horizontal != path->horizontal ||
           path[-1].without_rayleigh != path->without_rayleigh;
}

static void fill_node(const struct lamb_sum *sum, struct lamb_grid *grid, size_t i)
{
    const size_t panel = i / PANEL;
    const double k = grid->panel * ((double)panel + .5 + .5 * gauss12_node[i % PANEL]);
    const double k_weight = .5 * grid->panel * gauss12_weight[i % PANEL];
    grid->k[i] = k;
    for (size_t p = 0; p < sum->paths; p++) {
        const struct lamb_path *path = &sum->path[p];
        double coefficient[LAMB_COMPONENTS][KERNELS];
        coefficients(path, k, k_weight, coefficient);
        for (size_t c = 0; c < LAMB_COMPONENTS; c++)
            for (size_t g = 0; g < KERNELS; g++)
                grid->weight[(p * LINES + c * KERNELS + g) * grid->room + i] = coefficient[c][g];
        if (!starts_group(sum, p)) continue;
        double value[KERNELS], pole[4] = {0};
        half_space_static(sum->ground, path->z, k, value);
        if (path->without_rayleigh) half_space_static_rayleigh(sum->ground, path->z, k, pole);
        for (size_t g = 0; g < KERNELS; g++)
            grid->statics[(p * KERNELS + g) * grid->room + i] = value[g] - (g < 4 ? pole[g] : 0);
    }
}

/* Appends panels until the wavenumbers reach `largest`. */
static bool extend(const struct lamb_sum *sum, struct lamb_grid *grid, double largest)
{
    const size_t until = (size_t)ceil(largest / grid->panel) * PANEL, used = grid->nodes;
    if (until <= used) return true;
    if (until > grid->room) {
        const size_t room = until + until / 2;
        if (!widen(&grid->k, 1, used, grid->room, room) ||
            !widen(&grid->weight, sum->paths * LINES, used, grid->room, room) ||
            !widen(&grid->statics, sum->paths * KERNELS, used, grid->room, room))
            return false;
        grid->room = room;
    }
#pragma omp parallel for schedule(dynamic, 16)
    for (size_t i = used; i < until; i++)
        fill_node(sum, grid, i);
    grid->nodes = until;
    return true;
}

bool lamb_sum_extend(struct lamb_sum *sum, double cutoff, double largest)
{
    const double wide = sum->wide.panel;
    const double panels = ceil(fmin(largest, cutoff / sum->slowest + 2 * wide) / wide);
    return extend(sum, &sum->wide, largest) && extend(sum, &sum->narrow, panels * wide);
}

double lamb_sum_effort(const struct lamb_sum *sum, double end)
{
    if (sum->layers != NULL) return PANEL * end / sum->narrow.panel;
    const double near = fmin(end, 3 * (1 + 2 * NEAR) * sum->wide.panel);
    return PANEL * ((end - near) / sum->wide.panel + near / sum->narrow.panel);
}

/* Sum over one block of wavenumbers for one path; `weight`: its coefficients from the block on. */
static void add_block(bool horizontal, const double *weight, size_t room, size_t count,
                      const struct compliance *compliance, double complex value[LAMB_COMPONENTS])
{
    static const int used[LAMB_COMPONENTS][3] = {{1, 2, 4}, {1, 2, 4}, {0, 3, -1}};
    const double(*const parts[KERNELS])[BLOCK] = {compliance->vertical, compliance->horizontal,
                                                  compliance->radial, compliance->coupled, compliance->shear};
    for (size_t c = 0; c < LAMB_COMPONENTS; c++)
        for (int i = 0; i < (horizontal ? 3 : 1); i++) {
            const int g = used[c][i];
            if (g < 0) continue;
            const double *line = weight + (c * KERNELS + (size_t)g) * room;
            value[c] += short_sum_of_products(line, parts[g][0], count) +
                        I * short_sum_of_products(line, parts[g][1], count);
        }
}

/* 1 up to range.flat, then smoothly to 0 at range.end with three continuous derivatives. */
static double roll_off(struct lamb_range range, double k)
{
    if (k <= range.flat) return 1;
    if (k >= range.end) return 0;
    const double y = (k - range.flat) / (range.end - range.flat);
    return .5 * (1 + cos(M_PI * y * y * y * (10 - y * (15 - 6 * y))));
}

/* compliance -> (compliance - static) * taper; `statics`: its lines from the block on. */
static void finish_block(const double *taper, const double *statics, size_t room, size_t count,
                         bool horizontal, struct compliance *compliance)
{
    double(*const parts[KERNELS])[BLOCK] = {compliance->vertical, compliance->horizontal, compliance->radial,
                                            compliance->coupled, compliance->shear};
    for (size_t g = 0; g < (horizontal ? KERNELS : 2); g++)
        for (size_t i = 0; i < count; i++) {
            parts[g][0][i] = (parts[g][0][i] - statics[g * room + i]) * taper[i];
            parts[g][1][i] *= taper[i];
        }
}

/* Nodes [from, from + count) of a grid, all paths; count <= BLOCK. */
static void sum_block(const struct lamb_sum *sum, const struct lamb_grid *grid, double complex s,
                      struct lamb_range range, size_t from, size_t count, double complex *value)
{
    struct compliance compliance;
    double taper[BLOCK];
    for (size_t i = 0; i < count; i++)
        taper[i] = roll_off(range, grid->k[from + i]);
    for (size_t p = 0; p < sum->paths; p++) {
        const struct lamb_path *path = &sum->path[p];
        if (starts_group(sum, p)) {
            half_space_compliance(sum->ground, s, path->z, count, grid->k + from, path->horizontal,
                                  path->without_rayleigh, &compliance);
            if (sum->layers != NULL)
                layered_add_difference(sum->layers, sum->ground, s, path->z, count, grid->k + from,
                                       path->horizontal, &compliance);
            finish_block(taper, grid->statics + p * KERNELS * grid->room + from, grid->room, count,
                         path->horizontal, &compliance);
        }
        add_block(path->horizontal, grid->weight + p * LINES * grid->room + from, grid->room, count,
                  &compliance, value + p * LAMB_COMPONENTS);
    }
}

/* With layers the poles lie anywhere between the slowest and the fastest wave. */
static bool near_singularity(const struct lamb_sum *sum, double angular_frequency, double from, double to)
{
    const double speeds[3] = {sum->ground->p_speed, sum->ground->s_speed, sum->ground->rayleigh_speed};
    const double margin = NEAR * sum->wide.panel;
    if (sum->layers != NULL)
        return angular_frequency / sum->slowest > from - margin &&
               angular_frequency / sum->fastest < to + margin;
    for (int i = 0; i < 3; i++) {
        const double k = angular_frequency / speeds[i];
        if (k > from - margin && k < to + margin) return true;
    }
    return false;
}

void lamb_sum_at(const struct lamb_sum *sum, double complex s, struct lamb_range range, double complex *value)
{
    for (size_t i = 0; i < sum->paths * LAMB_COMPONENTS; i++)
        value[i] = 0;
    const double wide = sum->wide.panel;
    const size_t panels = (size_t)ceil(range.end / wide);
    for (size_t panel = 0; panel < panels;) {
        const bool near = near_singularity(sum, cimag(s), (double)panel * wide, (double)(panel + 1) * wide);
        size_t next = panel + 1;
        while (next < panels && (double)next * wide < range.end &&
               near_singularity(sum, cimag(s), (double)next * wide, (double)(next + 1) * wide) == near)
            next++;
        const struct lamb_grid *grid = near ? &sum->narrow : &sum->wide;
        const size_t nodes = PANEL * (near ? sum->refine : 1);
        for (size_t from = panel * nodes; from < next * nodes && grid->k[from] < range.end; from += BLOCK) {
            const size_t count = next * nodes - from < BLOCK ? next * nodes - from : BLOCK;
            assert(from + count <= grid->nodes);
            sum_block(sum, grid, s, range, from, count, value);
        }
        panel = next;
    }
}
