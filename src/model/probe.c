/* Probes: point values from weights, and from them strain and stress by Hooke's law. The linear standard of
 * all methods.
 *
 *   e_ij = (u_i,j + u_j,i) / 2,   s_ij = 2 mu e_ij + lambda e_kk delta_ij   (Ding et al. 2006, Eqs 6 and 7)
 *
 * Fewer than three dimensions: plane (or uniaxial) strain has no strain across; plane stress has none of the
 * stress, so that lambda becomes plane_lambda and the strain across is -lambda / (lambda + 2 mu) times the
 * trace in the plane; in a thin bar it is -poisson times the strain along it. */
#include "base/memory.h"
#include "model/model.h"

#include <string.h>

selas_status probe_allocate(struct probe *probe, size_t count, struct messages *messages)
{
    probe->count = count;
    probe->sites = probe->strains = 0;
    probe->index = array_new(count, sizeof *probe->index);
    probe->weight = array_new(count, sizeof *probe->weight);
    probe->gradient = array_new(3 * count, sizeof *probe->gradient);
    if (probe->index != NULL && probe->weight != NULL && probe->gradient != NULL) return SELAS_OK;
    probe_free(probe);
    return fail(messages, SELAS_NO_MEMORY, "no memory for a receiver's weights");
}

void probe_free(struct probe *probe)
{
    array_free(probe->index);
    array_free(probe->weight);
    array_free(probe->gradient);
    *probe = (struct probe){0};
}

int field_components(selas_field field)
{
    switch (field) {
    case SELAS_DISPLACEMENT:
    case SELAS_VELOCITY:
    case SELAS_ACCELERATION:
        return 3;
    case SELAS_STRESS:
    case SELAS_STRAIN:
        return 6;
    case SELAS_PRESSURE:
    case SELAS_ENERGY:
        return 1;
    }
    return 0;
}

const char *field_name(selas_field field)
{
    static const char *const names[] = {FIELDS(CHOICE_NAME)};
    return names[field];
}

/* Row and column of the components xx yy zz xy yz zx. */
static const int tensor_row[6] = {0, 1, 2, 0, 1, 2}, tensor_column[6] = {0, 1, 2, 1, 2, 0};

/* Strain and stress, components xx yy zz xy yz zx, in the frame of the gradient. */
static void hooke(const struct scene *scene, const struct material *material, const double gradient[9],
                  double strain[6], double stress[6])
{
    const bool thin = scene->dimension < 3 && scene->plane == PLANE_STRESS;
    const double mu = material->mu, lambda = thin ? material->plane_lambda : material->lambda;
    for (int k = 0; k < 6; k++)
        strain[k] = (gradient[3 * tensor_row[k] + tensor_column[k]] +
                     gradient[3 * tensor_column[k] + tensor_row[k]]) /
                    2;
    const double trace = strain[0] + strain[1] + strain[2]; /* in the plane: those across are still 0 */
    for (int k = 0; k < 6; k++)
        stress[k] = 2 * mu * strain[k] + (k < 3 ? lambda * trace : 0);
    if (!thin) return;
    const double across = scene->dimension == 1 ? -material->poisson * trace
                                                : -material->lambda / (material->lambda + 2 * mu) * trace;
    for (int k = scene->dimension; k < 3; k++) {
        strain[k] = across;
        stress[k] = 0;
    }
}

static void rotate_vector(const double (*frame)[3], const double vector[3], double *value)
{
    for (int i = 0; i < 3; i++)
        value[i] = frame == NULL
                       ? vector[i]
                       : frame[i][0] * vector[0] + frame[i][1] * vector[1] + frame[i][2] * vector[2];
}

/* R t R^T for a symmetric tensor. */
static void rotate_tensor(const double (*frame)[3], const double tensor[6], double *value)
{
    if (frame == NULL) {
        memcpy(value, tensor, 6 * sizeof *value);
        return;
    }
    const double full[3][3] = {{tensor[0], tensor[3], tensor[5]},
                               {tensor[3], tensor[1], tensor[4]},
                               {tensor[5], tensor[4], tensor[2]}};
    for (int k = 0; k < 6; k++) {
        value[k] = 0;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                value[k] += frame[tensor_row[k]][i] * full[i][j] * frame[tensor_column[k]][j];
    }
}

static double energy_density(const struct material *material, const double velocity[3],
                             const double strain[6], const double stress[6])
{
    double twice = 0;
    for (int c = 0; c < 3; c++)
        twice += material->density * velocity[c] * velocity[c] + strain[c] * stress[c] +
                 2 * strain[c + 3] * stress[c + 3];
    return twice / 2;
}

void field_from_values(const struct model *model, const struct material *material,
                       const struct point_values *values, selas_field field, double *value)
{
    double strain[6] = {0}, stress[6] = {0};
    if (field == SELAS_STRESS || field == SELAS_STRAIN || field == SELAS_PRESSURE || field == SELAS_ENERGY)
        hooke(model->scene, material, values->gradient, strain, stress);
    switch (field) {
    case SELAS_DISPLACEMENT:
        rotate_vector(model->frame, values->displacement, value);
        break;
    case SELAS_VELOCITY:
        rotate_vector(model->frame, values->velocity, value);
        break;
    case SELAS_ACCELERATION:
        rotate_vector(model->frame, values->acceleration, value);
        break;
    case SELAS_STRESS:
        rotate_tensor(model->frame, stress, value);
        break;
    case SELAS_STRAIN:
        rotate_tensor(model->frame, strain, value);
        break;
    case SELAS_PRESSURE:
        value[0] = -(stress[0] + stress[1] + stress[2]) / 3;
        break;
    case SELAS_ENERGY:
        value[0] = energy_density(material, values->velocity, strain, stress);
        break;
    }
}

/* Weighted sum of a vector field, `stride` numbers from weight to weight. */
static void weighted_sum(const struct model *model, const struct probe *probe, const double *field,
                         const double *weight, size_t stride, double sum[3])
{
    for (size_t c = 0; c < (size_t)model->scene->dimension; c++) {
        double total = 0;
        for (size_t j = 0; j < probe->count; j++)
            total += weight[j * stride] *
                     field[c * model->component_stride + probe->index[j] * model->point_stride];
        sum[c] = total;
    }
}

void probe_observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                   const double *a, double *value)
{
    struct point_values values = {0};
    const double *u = y, *v = y + model->unknowns;
    switch (field) {
    case SELAS_DISPLACEMENT:
        weighted_sum(model, probe, u, probe->weight, 1, values.displacement);
        break;
    case SELAS_VELOCITY:
        weighted_sum(model, probe, v, probe->weight, 1, values.velocity);
        break;
    case SELAS_ACCELERATION:
        if (a != NULL) weighted_sum(model, probe, a, probe->weight, 1, values.acceleration);
        break;
    case SELAS_ENERGY:
        weighted_sum(model, probe, v, probe->weight, 1, values.velocity);
        __attribute__((fallthrough));
    case SELAS_STRESS:
    case SELAS_STRAIN:
    case SELAS_PRESSURE:
        for (size_t axis = 0; axis < 3; axis++) {
            double slope[3] = {0};
            weighted_sum(model, probe, u, probe->gradient + axis, 3, slope);
            for (size_t c = 0; c < 3; c++)
                values.gradient[3 * c + axis] = slope[c];
        }
        break;
    }
    field_from_values(model, probe->material, &values, field, value);
}

void model_observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                   const double *a, double *value)
{
    if (model->core->observe != NULL)
        model->core->observe(model, probe, field, y, a, value);
    else
        probe_observe(model, probe, field, y, a, value);
}

const char *const *component_names(selas_field field)
{
    static const char *const vector[] = {"x", "y", "z"};
    static const char *const tensor[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
    static const char *const scalar[] = {""};
    const int components = field_components(field);
    return components == 6 ? tensor : components == 3 ? vector : scalar;
}
