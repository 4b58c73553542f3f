/* Kirsch 1898, as in Timoshenko & Goodier, Theory of Elasticity, art. 35 (on the ligament: the formula of He
 * & Seaid 2016 before Fig. 16), taken as quasi-static: the far stress follows the load's history. The plate
 * is infinite; numerics B5 tells how far a finite one is from it, and regress/reference/hole/ has the curves
 * of finite plates. */
#include "exact/hole.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>

struct solution {
    struct exact exact;
    int axis;   /* of the tension */
    double far; /* per unit of the history */
    const struct history *history;
    bool velocity; /* the history is that of a velocity */
};

void hole_displacement(double far, double radius, double mu, double kappa, double x, double y,
                       double displacement[2])
{
    const double angle = atan2(y, x);
    const double p = hypot(x, y) / radius;
    const double cube = 1 / (p * p * p);
    const double scale = far * radius / (8 * mu);
    displacement[0] =
        scale * (p * (kappa + 1) * cos(angle) + 2 / p * ((1 + kappa) * cos(angle) + cos(3 * angle)) -
                 2 * cube * cos(3 * angle));
    displacement[1] =
        scale * (p * (kappa - 3) * sin(angle) + 2 / p * ((1 - kappa) * sin(angle) + sin(3 * angle)) -
                 2 * cube * sin(3 * angle));
}

/* The tension: a traction along a face's normal, or a face moved along it (mean strain times the modulus). */
static bool find_tension(struct solution *solution, const struct scene *scene)
{
    const struct body *body = &scene->body;
    const struct material *material = &scene->material[body->material];
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].face == FACE_HOLE) return false;
    if (scene->loads > 0) {
        const struct load *load = &scene->load[0];
        solution->axis = face_axis(load->face);
        solution->far = load->amplitude * load->direction[solution->axis] * face_sign(load->face);
        solution->history = &load->history;
        return load->kind == LOAD_TRACTION;
    }
    for (int face = 0; face < 4; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        if (!boundary_moves(boundary)) continue;
        const int axis = face_axis((enum face)face);
        const double plane = face_plane(body, (enum face)face);
        const double modulus = scene->plane == PLANE_STRAIN
                                   ? material->young / (1 - material->poisson * material->poisson)
                                   : material->young;
        solution->axis = axis;
        solution->far =
            modulus * boundary->amplitude * boundary->direction[axis] / (plane - body->hole_centre[axis]);
        solution->history = &boundary->history;
        solution->velocity = boundary_meaning(boundary)->motion == 1;
        return true;
    }
    return false;
}

static selas_status create(const struct scene *scene, struct exact **exact, struct messages *messages)
{
    *exact = NULL;
    struct solution *solution = array_new(1, sizeof *solution);
    if (solution == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the reference");
    solution->exact = (struct exact){.class = &exact_hole, .scene = scene};
    if (scene->body.shape != BODY_PLATE_WITH_HOLE || scene->body.rotated || !find_tension(solution, scene)) {
        array_free(solution);
        return fail(messages, SELAS_BAD_SCENE,
                    "reference 'hole' needs shape = 'plate-with-hole', not turned, and a traction or a "
                    "prescribed motion "
                    "along the normal of a straight edge");
    }
    *exact = &solution->exact;
    return SELAS_OK;
}

static void destroy(struct exact *exact)
{
    array_free(exact);
}

static selas_status history(struct exact *exact, const double position[3], size_t n, const double *time,
                            double *value, struct messages *messages)
{
    (void)messages;
    const struct solution *solution = (const struct solution *)exact;
    const struct scene *scene = exact->scene;
    const struct material *material = &scene->material[scene->body.material];
    const double nu = material->poisson;
    const double kappa = scene->plane == PLANE_STRESS ? (3 - nu) / (1 + nu) : 3 - 4 * nu;
    const int along = solution->axis;
    const double x = position[along] - scene->body.hole_centre[along];
    const double y = position[1 - along] - scene->body.hole_centre[1 - along];
    double u[2];
    hole_displacement(solution->far, scene->body.hole_radius, material->mu, kappa, x, y, u);
    for (size_t i = 0; i < n; i++)
        for (int derivative = 0; derivative < 2; derivative++) {
            const double part =
                history_value(solution->history, time[i], derivative - (solution->velocity ? 1 : 0));
            double *out = value + 6 * i + 3 * (size_t)derivative;
            out[along] = u[0] * part;
            out[1 - along] = u[1] * part;
            out[2] = 0;
        }
    return SELAS_OK;
}

static void describe(const struct exact *exact,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct solution *solution = (const struct solution *)exact;
    char text[64];
    tell(context, "solution", "Kirsch, infinite plate, quasi-static");
    snprintf(text, sizeof text, "%.8g", solution->far);
    tell(context, "far stress", text);
}

const struct exact_class exact_hole = {
    .kind = "hole",
    .create = create,
    .destroy = destroy,
    .history = history,
    .describe = describe,
};
