/* The smoothed point method as published by Ding, Wu, Long & Liang (2006): Eq 23 with Eqs 25-29, 33, 35.
 *
 *   rho u''_a = f_a + sum of W_ab A_b T_b + sum of K_ab V_b u_b + sum of Gamma_ab A_b u_b - damping */
#include "method/paper/paper.h"

#include "base/memory.h"
#include "points/cloud.h"

#include <math.h>
#include <string.h>

/* Solves m x = b in place for a symmetric positive matrix of size n <= 3 (elimination without pivots). */
static void solve_small(int n, double m[9], double *b)
{
    for (int k = 0; k < n; k++)
        for (int i = k + 1; i < n; i++) {
            const double factor = m[i * n + k] / m[k * n + k];
            for (int j = k; j < n; j++)
                m[i * n + j] -= factor * m[k * n + j];
            b[i] -= factor * b[k];
        }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++)
            b[k] -= m[k * n + j] * b[j];
        b[k] /= m[k * n + k];
    }
}

/* Eq 33 at the points with dampers: (1 + half_step C) a = force / rho - C v. */
static void damp(const struct paper *paper, double half_step, const double *v, double *a)
{
    const int n = paper->dimension;
    for (size_t k = 0; k < paper->dampers; k++) {
        const struct damper *damper = &paper->damper[k];
        const size_t first = (size_t)n * damper->point;
        double left[9] = {0}, right[3];
        for (int i = 0; i < n; i++) {
            right[i] = a[first + (size_t)i];
            for (int j = 0; j < n; j++) {
                const double c = damper->matrix[i * n + j];
                left[i * n + j] = (i == j) + half_step * c;
                if (v != NULL) right[i] -= c * v[first + (size_t)j];
            }
        }
        solve_small(n, left, right);
        for (int i = 0; i < n; i++)
            a[first + (size_t)i] = right[i];
    }
}

/* Sets the components that boundaries prescribe. */
static void prescribe(const struct paper *paper, const struct drive *drive, double *a)
{
    for (size_t k = 0; k < paper->constraints; k++) {
        const struct constraint *constraint = &paper->constraint[k];
        double wanted[3] = {0};
        for (size_t c = 0; c < 3 && drive->motion != NULL; c++)
            if (constraint->held[c]) wanted[c] = constraint->factor[c] * drive->motion[constraint->face[c]];
        paper_hold(paper, constraint, wanted, a);
    }
}

/* Rows of K V + Gamma A (Eqs 21, 22) times u. `dimension` is a constant at each call so that the small loops
 * unroll. */
static inline void add_stiffness(const struct paper *paper, size_t dimension, size_t point, const double *u,
                                 double *force)
{
    double sum[3] = {0};
    for (size_t p = paper->near.start[point]; p < paper->near.start[point + 1]; p++) {
        const double *block = paper->block + dimension * dimension * p;
        const double *other = u + dimension * paper->near.index[p];
        for (size_t i = 0; i < dimension; i++)
            for (size_t k = 0; k < dimension; k++)
                sum[i] += block[i * dimension + k] * other[k];
    }
    for (size_t i = 0; i < dimension; i++)
        force[i] += sum[i];
}

/* Eq 19. */
static void add_traction(const struct paper *paper, size_t point, double *force)
{
    for (size_t row = paper->load_start[point]; row < paper->load_start[point + 1]; row++)
        for (size_t c = 0; c < (size_t)paper->dimension; c++)
            force[c] += paper->load_value[row] * paper->traction[3 * paper->load_element[row] + c];
}

static void accelerate(struct model *model, const struct drive *drive, double half_step, const double *u,
                       const double *v, double *a)
{
    struct paper *paper = (struct paper *)model;
    const size_t dimension = (size_t)paper->dimension;
    const bool loaded = paper_tractions(paper, drive);
    const double density = paper->material->density;
    memset(a, 0, model->unknowns * sizeof *a);
    paper_point_loads(paper, drive, a);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < model->points; i++) {
        double *force = a + dimension * i;
        if (dimension == 3) add_stiffness(paper, 3, i, u, force);
        if (dimension == 2) add_stiffness(paper, 2, i, u, force);
        if (dimension == 1) add_stiffness(paper, 1, i, u, force);
        if (loaded) add_traction(paper, i, force);
        for (size_t c = 0; c < dimension; c++)
            force[c] /= density;
    }
    damp(paper, half_step, v, a);
    prescribe(paper, drive, a);
    model->evaluations++;
}

/* Eq 35 at one point: mean over the neighbours (weights W_ab V_b) minus the value itself. */
static void smoothing_change(const struct paper *paper, size_t point, const double *field, double change[3])
{
    const size_t dimension = (size_t)paper->dimension;
    double sum[3] = {0}, weight = 0;
    for (size_t p = paper->near.start[point]; p < paper->near.start[point + 1]; p++) {
        const size_t b = paper->near.index[p];
        if (b == point) continue;
        weight += paper->kernel_volume[p];
        for (size_t c = 0; c < dimension; c++)
            sum[c] += paper->kernel_volume[p] * field[dimension * b + c];
    }
    for (size_t c = 0; c < dimension; c++)
        change[c] = weight > 0 ? sum[c] / weight - field[dimension * point + c] : 0;
}

/* Eq 35 after each step. With s = strength * (1 - mean over the neighbours): on the increment it is a
 * friction s v / dt; on the displacement as printed it is that and a spring s u / dt^2 besides. Both grow as
 * the step shrinks. Prescribed components stay. */
static void filter(struct model *model, double dt, const double *u_before, double *u, double *v)
{
    struct paper *paper = (struct paper *)model;
    const size_t dimension = (size_t)paper->dimension;
    const double strength = paper->options.filter;
    const bool increment = paper->options.filter_increment;
    if (strength <= 0) return;
    for (size_t k = 0; k < model->unknowns; k++)
        paper->scratch[k] = increment ? u[k] - u_before[k] : u[k];
        /* u and v are read at the point itself only: the neighbours come from the copy */
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < model->points; i++) {
        double change[3];
        smoothing_change(paper, i, paper->scratch, change);
        for (size_t c = 0; c < dimension; c++)
            u[dimension * i + c] += strength * change[c];
    }
    for (size_t k = 0; k < paper->constraints; k++) {
        /* put back what is held: the filter would pull it towards its neighbours */
        const struct constraint *constraint = &paper->constraint[k];
        const size_t first = dimension * constraint->point;
        double before[3] = {0}, own[3];
        for (size_t c = 0; c < dimension; c++)
            before[c] = paper->scratch[first + c] + (increment ? u_before[first + c] : 0);
        body_direction_from_deck(&model->scene->body, before, own);
        paper_hold(paper, constraint, own, u);
    }
    for (size_t k = 0; k < model->unknowns; k++)
        v[k] = (u[k] - u_before[k]) / dt;
}

static void destroy(struct model *model)
{
    struct paper *paper = (struct paper *)model;
    paper_free_loads(paper);
    point_set_free(&paper->set);
    neighbours_free(&paper->near);
    array_free(paper->volume);
    array_free(paper->alpha);
    array_free(paper->whole);
    array_free(paper->kernel_volume);
    array_free(paper->block);
    array_free(paper->element);
    array_free(paper->first_element);
    array_free(paper->traction);
    array_free(paper->damper);
    array_free(paper->constraint);
    array_free(paper->told);
    array_free(paper->scratch);
    array_free(paper);
}

struct paper_options paper_options_default(void)
{
    return (struct paper_options){.kernel = kernel_find("cubic"),
                                  .smoothing_length = 1,
                                  .volume_factors = true,
                                  .area_factors = true,
                                  .kernel_correction = true,
                                  .boundary_term = true,
                                  .load_distributed = true,
                                  .patch_overlap = true,
                                  .filter = .1,
                                  .filter_increment = true,
                                  .deconvolution = true};
}

static selas_status check(const struct scene *scene, const struct paper_options *options,
                          struct messages *messages)
{
    const struct body *body = &scene->body;
    if ((body->shape != BODY_BOX && body->shape != BODY_POINTS) || body->layers > 0)
        return fail(
            messages, SELAS_UNSUPPORTED,
            "method%%variant = 'paper' computes boxes of one material (body%%shape = 'box' or 'points' "
            "that fill a box, no &layer)");
    for (int face = 0; face < BOX_FACES; face++)
        if (boundary_mirrors(&scene->boundary[face]))
            warn(
                messages,
                "method%%variant = 'paper' only holds the normal component on the symmetry face %s, its sums "
                "end there; the whole body is more accurate",
                face_name((enum face)face));
    if (options->kernel == NULL || !(options->smoothing_length > 0))
        return fail(messages, SELAS_BAD_ARGUMENT, "the method needs a kernel and a smoothing length > 0");
    return SELAS_OK;
}

static size_t bytes_of(const struct paper *paper)
{
    const size_t points = paper->set.points, pairs = paper->near.start[points];
    const size_t dimension = (size_t)paper->dimension;
    return sizeof *paper + neighbours_bytes(&paper->near) +
           pairs * (1 + dimension * dimension) * sizeof(double) + points * (8 + dimension) * sizeof(double) +
           paper->elements * (sizeof *paper->element + 24) +
           paper->load_start[points] * (sizeof *paper->load_value + sizeof *paper->load_element) +
           paper->dampers * sizeof *paper->damper + paper->constraints * sizeof *paper->constraint;
}

static selas_status make_points(struct paper *paper, struct messages *messages)
{
    const struct scene *scene = paper->model.scene;
    if (scene->body.shape == BODY_BOX)
        return lattice_create(&scene->body, paper->dimension, &paper->set, messages);
    struct cloud *cloud;
    selas_status status = cloud_read(scene, &cloud, messages);
    if (status != SELAS_OK) return status;
    status = point_set_from_positions(&scene->body, paper->dimension, cloud->points, cloud->position,
                                      &paper->set, messages);
    cloud_free(&cloud);
    return status;
}

static selas_status fill(struct paper *paper, struct messages *messages)
{
    selas_status status = make_points(paper, messages);
    if (status != SELAS_OK) return status;
    double spacing = 1;
    for (int c = 0; c < paper->dimension; c++)
        spacing = c == 0 || paper->set.spacing[c] > spacing ? paper->set.spacing[c] : spacing;
    paper->h = paper->options.smoothing_length * spacing;
    paper->model.points = paper->set.points;
    paper->model.unknowns = (size_t)paper->dimension * paper->set.points;
    paper->scratch = array_new(paper->model.unknowns, sizeof *paper->scratch);
    if (paper->scratch == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the points");
    if (status == SELAS_OK) status = paper_make_elements(paper, messages);
    if (status == SELAS_OK) status = paper_make_statistics(paper, messages);
    if (status == SELAS_OK) status = paper_make_operator(paper, messages);
    if (status == SELAS_OK) status = paper_make_boundary(paper, messages);
    if (status == SELAS_OK) status = paper_make_loads(paper, messages);
    return status;
}

static const struct model_core core = {
    .destroy = destroy,
    .initialise = paper_initialise,
    .probe = paper_probe,
    .field = paper_field,
    .energy = paper_energy,
    .power = paper_power,
    .describe = paper_describe,
};
static const struct model_operator filtering = {.accelerate = accelerate, .after_step = filter};
static const struct model_operator plain = {.accelerate = accelerate}; /* every time scheme may be had */

/* 2 * second moments along x of the stencil's W_,xx and W_,yy: 2 and 0 in the limit of many neighbours. */
static void second_moments(const struct paper_options *options, int dimension, double moment[2])
{
    const double h = options->smoothing_length;
    const int reach = (int)ceil(options->kernel->support * h);
    const int y_reach = dimension > 1 ? reach : 0, z_reach = dimension > 2 ? reach : 0;
    double all = 0, sum[2] = {0};
    for (int z = -z_reach; z <= z_reach; z++)
        for (int y = -y_reach; y <= y_reach; y++)
            for (int x = -reach; x <= reach; x++) {
                const double r = sqrt(x * x + y * y + z * z);
                const double flat = kernel_derivative_over_r(options->kernel, dimension, r, h);
                const double bent = kernel_second_derivative(options->kernel, dimension, r, h) - flat;
                all += kernel_value(options->kernel, dimension, r, h);
                sum[0] += x * x * (flat + (r > 0 ? bent * x * x / (r * r) : 0));
                sum[1] += x * x * (flat + (r > 0 ? bent * y * y / (r * r) : 0));
            }
    for (int i = 0; i < 2; i++)
        moment[i] = sum[i] / all;
}

/* As printed, points hang on springs to the ground, in a bar those of its ends. Without these the smoothed
 * acceleration and the filter slow waves down, and forces of waves along an axis are 1 + e times too large, e of the
 * stencil's moments: phases are pi e off after each wavelength. */
static struct wave_law waves_of(const struct paper *paper)
{
    const double others = paper->dimension - 1, mu = paper->material->mu;
    const double ratio = (paper->material->plane_lambda + 2 * mu) / mu;
    if (!paper->options.zero_row_sums && others > 0)
        return (struct wave_law){.order = 1, .sent_order = 1, .floor = 1};
    double m[2];
    second_moments(&paper->options, paper->dimension, m);
    const double p = M_PI * fabs(m[0] / 2 + others * m[1] / 2 / ratio - 1);
    const double s = M_PI * fabs(m[0] / 2 + (others - 1 + ratio) * m[1] / 2 - 1);
    return (struct wave_law){.constant = .7,
                             .order = 1,
                             .sent = .9,
                             .sent_order = 1,
                             .floor = p,
                             .shear = others > 0 ? s - p : 0,
                             .ends = paper->options.zero_row_sums ? 0 : 1};
}

selas_status paper_create(const struct scene *scene, const struct paper_options *options,
                          struct model **model, struct messages *messages)
{
    *model = NULL;
    selas_status status = check(scene, options, messages);
    if (status != SELAS_OK) return status;
    struct paper *paper = array_new(1, sizeof *paper);
    if (paper == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the model");
    paper->options = *options;
    paper->dimension = scene->dimension;
    paper->material = &scene->material[scene->body.material];
    paper->model.method = &method_paper;
    paper->model.core = &core;
    paper->model.patch = PATCH_BY_POINTS;
    paper->model.waves = waves_of(paper);
    paper->model.spatial = options->filter > 0 ? &filtering : &plain;
    paper->model.scene = scene;
    status = fill(paper, messages);
    if (status != SELAS_OK) {
        destroy(&paper->model);
        return status;
    }
    paper->model.position = paper->set.position;
    for (int c = 0; c < 3 && scene->body.jitter <= 0; c++)
        paper->model.grid[c] = paper->set.grid[c];
    paper->model.small_strain = paper->model.leaks = true;
    paper->model.state_size = 2 * paper->model.unknowns;
    paper->model.component_stride = 1;
    paper->model.point_stride = (size_t)paper->dimension;
    paper->model.bytes = bytes_of(paper);
    *model = &paper->model;
    return SELAS_OK;
}

static selas_status create(const struct scene *scene, struct model **model, struct messages *messages)
{
    struct paper_options options;
    const selas_status status = paper_options_read(scene, &options, messages);
    return status != SELAS_OK ? status : paper_create(scene, &options, model, messages);
}

const struct method method_paper = {
    .name = "smoothed-point",
    .variant = "paper",
    .words = "kernel smoothing_length filter filter_form deconvolution row_sums volume_factors area_factors "
             "kernel_correction boundary_term load_sum patch_overlap",
    .faces = CAN_HOLD | CAN_MOVE | CAN_MIRROR | CAN_DAMP,
    .create = create,
};
