/* Eigenvalues of a deck's semi-discrete equation y' = F(y) about the body at rest, or in slow uniform
 * compression, where a one-sided viscosity acts between all points: spectrum DECK SPEED [GROUP%NAME=VALUE
 * ...] prints `re im` per eigenvalue; SPEED is the velocity of that compression per length (0: at rest). The
 * Jacobian by central differences, its eigenvalues by GSL; for a few hundred unknowns. */
#include "accuracy/accuracy.h"
#include "base/memory.h"
#include "method/methods.h"
#include "model/model.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void derivative(struct model *model, const struct drive *drive, const double *y, double *result)
{
    const size_t n = model->unknowns;
    if (model->spatial->rate != NULL) {
        model->spatial->rate(model, drive, y, result);
        return;
    }
    memcpy(result, y + n, n * sizeof *y);
    model->spatial->accelerate(model, drive, 0.0, y, y + n, result + n);
}

static struct model *open_model(int count, char **words, struct deck **deck, struct scene **scene)
{
    struct messages messages = {0};
    struct model *model = NULL;
    selas_status status =
        deck_read_file(words[1], (size_t)count - 3, (const char *const *)words + 3, deck, &messages);
    if (status == SELAS_OK) status = accuracy_build(*deck, NULL, scene, &messages);
    if (status == SELAS_OK) status = model_create(*scene, &model, &messages);
    if (status != SELAS_OK) fputs(messages.text != NULL ? messages.text : "no memory\n", stderr);
    messages_free(&messages);
    return model;
}

/* Sizes that the differences take: displacements of a spacing, velocities of a spacing per transit. */
static void find_jacobian(struct model *model, const double *base, double length, double speed,
                          gsl_matrix *jacobian)
{
    const size_t n = model->state_size, unknowns = model->unknowns;
    double *y = array_new(n, sizeof *y), *up = array_new(n, sizeof *up), *down = array_new(n, sizeof *down);
    double zero[16 * FACES] = {0};
    const struct drive drive = {.load = zero, .motion = zero, .displacement = zero, .velocity = zero};
    if (y == NULL || up == NULL || down == NULL) exit(1);
    for (size_t j = 0; j < n; j++) {
        const double size = j < unknowns ? 1e-6 * length : 1e-6 * speed;
        const double step = j < 2 * unknowns ? size : 1e-6 * fmax(1.0, fabs(base[j]));
        memcpy(y, base, n * sizeof *y);
        y[j] = base[j] + step;
        derivative(model, &drive, y, up);
        y[j] = base[j] - step;
        derivative(model, &drive, y, down);
        for (size_t i = 0; i < n; i++)
            gsl_matrix_set(jacobian, i, j, (up[i] - down[i]) / (2 * step));
    }
    array_free(y);
    array_free(up);
    array_free(down);
}

int main(int count, char **words)
{
    struct deck *deck = NULL;
    struct scene *scene = NULL;
    if (count < 3) return 2;
    struct model *model = open_model(count, words, &deck, &scene);
    if (model == NULL) return 1;
    const size_t n = model->state_size, dimension = (size_t)scene->dimension;
    const double rate = strtod(words[2], NULL), fastest = scene->material[0].p_speed;
    double *base = array_new(n, sizeof *base);
    gsl_matrix *jacobian = gsl_matrix_alloc(n, n);
    gsl_vector_complex *value = gsl_vector_complex_alloc(n);
    gsl_eigen_nonsymm_workspace *work = gsl_eigen_nonsymm_alloc(n);
    if (base == NULL) return 1;
    if (model->core->initialise != NULL) model->core->initialise(model, base);
    for (size_t i = 0; rate != 0.0 && i < model->points && i * dimension < model->unknowns; i++) {
        double place[3];
        model_position(model, i, place);
        for (size_t c = 0; c < dimension; c++)
            base[model->unknowns + model->component_stride * c + model->point_stride * i] = -rate * place[c];
    }
    find_jacobian(model, base, scene->body.spacing, fastest, jacobian);
    gsl_eigen_nonsymm(jacobian, value, work);
    for (size_t i = 0; i < n; i++) /* real and imaginary parts lie side by side */
        printf("%.9g %.9g\n", value->data[2 * value->stride * i], value->data[2 * value->stride * i + 1]);
    gsl_eigen_nonsymm_free(work);
    gsl_vector_complex_free(value);
    gsl_matrix_free(jacobian);
    array_free(base);
    model_free(&model);
    scene_free(&scene);
    deck_free(&deck);
    return 0;
}
