/* Weights of mechanisms by parts (doc/theory/damping.md, section 3). A modulus of a material, kappa or mu, is a
 * column of weights Y; with a reference column Y_0, and y_1, y_2, ... an orthonormal basis of all Y - Y_0,
 *
 *   Y = Y_0 + sum over p of b_p y_p:   moduli of part p: b_p times the unrelaxed ones,
 *   e_0 = u - sum over l of Y_0l (u - D_l),   e_p = -sum over l of y_pl (u - D_l). */
#include "method/damped/damped.h"

#include "base/memory.h"
#include "damping/directions.h"

#include <math.h>
#include <string.h>

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* What parts 0 to `parts` - 1 leave of a column. */
static void left_of(const struct damped *d, const struct damping_column *column, double left[MOST_MECHANISMS])
{
    const size_t n = d->damping->mechanisms;
    for (size_t l = 0; l < n; l++)
        left[l] = column->weight[l] - d->part[0].memory[l];
    for (size_t p = 1; p < d->parts; p++) {
        const double share = dot(n, left, d->part[p].memory);
        for (size_t l = 0; l < n; l++)
            left[l] -= share * d->part[p].memory[l];
    }
}

/* Adds the direction that is most of what is left. False: nothing is left but rounding. */
static bool add_part(struct damped *d, const struct damping_column *columns)
{
    const double rounding = 1e-9;
    const size_t n = d->damping->mechanisms;
    double best[MOST_MECHANISMS] = {0}, left[MOST_MECHANISMS], largest = 0;
    for (size_t i = 0; i < 2 * d->damping->materials; i++) {
        left_of(d, &columns[i], left);
        if (dot(n, left, left) <= largest) continue;
        largest = dot(n, left, left);
        memcpy(best, left, sizeof best);
    }
    if (sqrt(largest) <= rounding || d->parts == 1 + n) return false;
    struct damped_part *part = &d->part[d->parts++];
    for (size_t l = 0; l < n; l++) {
        part->memory[l] = best[l] / sqrt(largest);
        part->given -= part->memory[l];
    }
    return true;
}

/* The material of a part: its moduli; speeds are those of the scene's at the centroid of the source's spectrum,
 * so that all parts have the same dampers and layers. */
static void set_material(const struct damped *d, const struct damped_part *part, const struct scene *scene,
                         size_t index, const struct damping_column column[2])
{
    const struct material *given = &scene->material[index];
    const struct damped_moduli *fitted = &d->damping->fitted[index];
    const size_t n = d->damping->mechanisms;
    struct material *material = &part->material[index];
    double share[2] = {1, 1};
    for (int i = 0; i < 2 && part > d->part; i++) {
        double off[MOST_MECHANISMS];
        for (size_t l = 0; l < n; l++)
            off[l] = column[i].weight[l] - d->part[0].memory[l];
        share[i] = dot(n, off, part->memory);
    }
    *material = *given;
    material->q_p = material->q_s = 0;
    material->mu = share[1] * column[1].size;
    material->lambda = share[0] * column[0].size - 2. / 3 * material->mu;
    material->plane_lambda = material->lambda;
    if (part == d->part) material_complete(scene, material);
    material->p_speed = given->p_speed * modulus_speed(&fitted->axial, given->density, d->damping->centroid) /
                        sqrt((given->lambda + 2 * given->mu) / given->density);
    material->s_speed = modulus_speed(&fitted->shear, given->density, d->damping->centroid);
}

static selas_status set_part(const struct damped *d, struct damped_part *part, const struct scene *scene,
                             const struct damping_column *columns, struct messages *messages)
{
    part->material = array_new(scene->materials, sizeof *part->material);
    if (part->material == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for damped materials");
    for (size_t i = 0; i < scene->materials; i++)
        set_material(d, part, scene, i, &columns[2 * i]);
    part->scene = *scene;
    part->scene.material = part->material;
    part->scene.whole = d->part[0].material;
    if (d->field != NULL) part->scene.body.model = &d->field[part - d->part];
    return SELAS_OK;
}

selas_status damped_split(struct damped *d, const struct scene *scene, struct messages *messages)
{
    const struct ground_damping *damping = d->damping;
    struct damping_column *columns = array_new(2 * damping->materials, sizeof *columns);
    selas_status status = SELAS_OK;
    if (columns == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for damped materials");
    d->parts = 1;
    d->part[0].given = 1;
    for (size_t i = 0; i < damping->materials; i++)
        damping_columns(damping->mechanisms, &damping->fitted[i], &columns[2 * i]);
    for (size_t i = 0; i < damping->materials && d->part[0].given == 1; i++)
        for (size_t l = 0; l < damping->mechanisms; l++) {
            d->part[0].memory[l] = columns[2 * i + 1].weight[l];
            d->part[0].given -= columns[2 * i + 1].weight[l];
        }
    while (add_part(d, columns))
        if (scene->plane == PLANE_STRESS && scene->dimension < 3)
            status = fail(messages, SELAS_UNSUPPORTED,
                          "in plane stress damped materials need q_p = q_s and one Q for all");
    if (scene->body.model != NULL && status == SELAS_OK) status = damped_field(d, scene, messages);
    for (size_t p = 0; p < d->parts && status == SELAS_OK; p++)
        status = set_part(d, &d->part[p], scene, columns, messages);
    array_free(columns);
    return status;
}
