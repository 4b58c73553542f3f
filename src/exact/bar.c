/* Reference 'bar': longitudinal waves between the two ends of a one-dimensional body at rest at t = 0, by
 * d'Alembert's solution u = f(t - x/c) + g(t - (L - x)/c):
 *
 *   traction p at the low end     f'(t) = g'(t - L/c) + p(t) / (rho c)
 *   low end moved with v0(t)      f'(t) = v0(t) - g'(t - L/c)
 *   transmitting low end          f'(t) = p(t) / (2 rho c)
 *
 * and the same for g at the high end. Every reflection goes back by L/c in time, where nothing was before t =
 * 0: the sums are finite and exact. He & Seaid (2016), section 4.1, is the step traction on one end, the
 * other fixed. */
#include "exact/bar.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>

struct bar {
    struct exact exact;
    double length, speed, impedance; /* L, c, rho c */
};

static selas_status refuse(struct messages *messages, const char *why)
{
    return fail(messages, SELAS_BAD_SCENE, "reference 'bar': %s", why);
}

static selas_status create(const struct scene *scene, struct exact **exact, struct messages *messages)
{
    *exact = NULL;
    if (scene->dimension != 1) return refuse(messages, "the bar is one-dimensional, scene%dimension = 1");
    if (scene->body.shape != BODY_BOX) return refuse(messages, "the body must have shape = 'box'");
    if (scene->body.layers > 0) return refuse(messages, "the bar must be of one material, without &layer");
    if (scene->initial.kind != INITIAL_REST) return refuse(messages, "the bar must start at rest");
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].kind != LOAD_TRACTION || scene->load[k].shape != LOAD_FACE)
            return refuse(messages, "only tractions with shape = 'face' on the ends x- and x+");
    if (scene_check_faces(scene, CAN_HOLD | CAN_MOVE | CAN_MIRROR | CAN_DAMP | CAN_ABSORB, "reference 'bar'",
                          messages) != SELAS_OK)
        return SELAS_BAD_SCENE;
    struct bar *bar = array_new(1, sizeof *bar);
    if (bar == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the reference 'bar'");
    const struct material *material = &scene->material[scene->body.material];
    bar->exact = (struct exact){.class = &exact_bar, .scene = scene};
    bar->length = scene->body.high[0] - scene->body.low[0];
    bar->speed = material->p_speed;
    bar->impedance = material->density * material->p_speed;
    *exact = &bar->exact;
    return SELAS_OK;
}

static void destroy(struct exact *exact)
{
    array_free(exact);
}

/* Traction along x on an end: its history (derivative 0) or that integrated over time (-1). */
static double traction(const struct scene *scene, enum face face, double t, int derivative)
{
    double sum = 0;
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].face == face)
            sum += scene->load[k].amplitude * scene->load[k].direction[0] *
                   history_value(&scene->load[k].history, t, derivative);
    return sum;
}

/* Velocity (derivative 0) or displacement (-1) that a fixed or driven end has. */
static double motion(const struct boundary *boundary, double t, int derivative)
{
    return boundary->amplitude * boundary->direction[0] * boundary_displacement(boundary, t, derivative + 1);
}

/* f' (face x-) or g' (face x+) at time t, or f and g themselves (derivative -1). */
static double wave(const struct bar *bar, enum face face, double t, int derivative)
{
    const struct scene *scene = bar->exact.scene;
    const double passage = bar->length / bar->speed;
    const long passages = t < 0 ? 0 : 1 + (long)floor(t / passage);
    const double first = t;
    double sum = 0, sign = 1;
    for (long k = 0; k < passages; k++) {
        t = first - (double)k * passage;
        const struct boundary *boundary = &scene->boundary[face];
        const double pushed = traction(scene, face, t, derivative) / bar->impedance;
        if (boundary_absorbs(boundary)) return sum + sign * pushed / 2;
        if (boundary_is_free(boundary)) {
            sum += sign * pushed;
        } else {
            sum += sign * motion(boundary, t, derivative);
            sign = -sign;
        }
        face = face == FACE_X_LOW ? FACE_X_HIGH : FACE_X_LOW;
    }
    return sum;
}

static selas_status history(struct exact *exact, const double position[3], size_t n, const double *time,
                            double *value, struct messages *messages)
{
    (void)messages;
    const struct bar *bar = (const struct bar *)exact;
    double place[3];
    body_from_deck(&exact->scene->body, position, place);
    const double to_low = (place[0] - exact->scene->body.low[0]) / bar->speed;
    const double to_high = bar->length / bar->speed - to_low;
    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < 6; c++) {
            const int derivative = c < 3 ? -1 : 0;
            value[6 * i + (size_t)c] = c % 3 != 0 ? 0
                                                  : wave(bar, FACE_X_LOW, time[i] - to_low, derivative) +
                                                        wave(bar, FACE_X_HIGH, time[i] - to_high, derivative);
        }
    return SELAS_OK;
}

static void describe(const struct exact *exact,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct bar *bar = (const struct bar *)exact;
    char text[80];
    tell(context, "reference", "bar: d'Alembert, exact");
    snprintf(text, sizeof text, "%.9g", bar->speed);
    tell(context, "reference wave speed", text);
}

const struct exact_class exact_bar = {
    .kind = "bar",
    .create = create,
    .destroy = destroy,
    .history = history,
    .describe = describe,
};
