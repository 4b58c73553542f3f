/* Reference 'stokes': a point force (Stokes 1849; Aki & Richards 2002, Eq 4.23) and a moment tensor (their Eq
 * 4.29) in an infinite solid, valid in a box until the first wave that one of its faces sends back can be at
 * the receiver (doc/theory/sources.md, Eqs 1, 3, 5).
 *
 * With a = r/c_p, b = r/c_s, g = away/r, the near field needs, for the history f and its integral f1,
 *   integral from a to b of T f(t - T) dT = a f1(t-a) - b f1(t-b) + integral from t-b to t-a of f1,
 * whose rate is a f(t-a) - b f(t-b) + f1(t-a) - f1(t-b). */
#include "exact/stokes.h"

#include "base/memory.h"
#include "exact/gauss12.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Time in which a history may be taken for a polynomial of low degree between its kinks. */
static double scale_of(const struct history *history)
{
    switch (history->kind) {
    case HISTORY_GAUSSIAN:
    case HISTORY_BRUNE:
    case HISTORY_ERROR_FUNCTION:
        return history->width;
    case HISTORY_RICKER:
    case HISTORY_SINE_BURST:
        return .25 / history->frequency;
    default:
        return INFINITY;
    }
}

static double panel(const struct history *history, double from, double to)
{
    double sum = 0;
    for (int i = 0; i < 12; i++)
        sum += gauss12_weight[i] *
               history_value(history, .5 * (from + to) + .5 * (to - from) * gauss12_node[i], -1);
    return .5 * (to - from) * sum;
}

/* Integral of f1 over [from, to], by panels between the kinks of f. */
static double integral(const struct history *history, double from, double to)
{
    enum { MOST_KINKS = 256 };
    double kinks[MOST_KINKS];
    const size_t all = history_kinks(history, kinks, MOST_KINKS), count = all < MOST_KINKS ? all : MOST_KINKS;
    double sum = 0;
    from = fmax(from, 0);
    for (size_t i = 0; from < to; i++) {
        double end = to;
        while (i < count && kinks[i] <= from)
            i++;
        if (i < count) end = fmin(end, kinks[i]);
        const int parts = 1 + (int)fmin((end - from) / scale_of(history), 1e6);
        for (int k = 0; k < parts; k++)
            sum += panel(history, from + (end - from) * k / parts, from + (end - from) * (k + 1) / parts);
        from = end;
    }
    return sum;
}

/* What both sources are made of: the near-field integral, and f and its rate at both arrivals; [0] for
 * displacement, [1] for velocity. */
struct pulses {
    double near[2], p[2], s[2], p_rate[2], s_rate[2];
};

static void find_pulses(const struct solid *solid, const struct history *history, double r, double t,
                        bool rates, struct pulses *pulses)
{
    const double a = r / solid->p_speed, b = r / solid->s_speed;
    const double since_p = t - a, since_s = t - b;
    const double p = history_value(history, since_p, -1), s = history_value(history, since_s, -1);
    pulses->near[0] = a * p - b * s + integral(history, since_s, since_p);
    pulses->near[1] = a * history_value(history, since_p, 0) - b * history_value(history, since_s, 0) + p - s;
    for (int i = 0; i < 2; i++) {
        pulses->p[i] = history_value(history, since_p, i);
        pulses->s[i] = history_value(history, since_s, i);
        pulses->p_rate[i] = rates ? history_value(history, since_p, i + 1) : 0;
        pulses->s_rate[i] = rates ? history_value(history, since_s, i + 1) : 0;
    }
}

/* Aki & Richards Eq 4.23. */
static void add_force(const struct solid *solid, const struct load *load, const double g[3], double r,
                      const struct pulses *f, double value[6])
{
    const double alpha2 = solid->p_speed * solid->p_speed, beta2 = solid->s_speed * solid->s_speed;
    const double factor = load->amplitude / (4 * M_PI * solid->density * r);
    double along = 0;
    for (int j = 0; j < 3; j++)
        along += g[j] * load->direction[j];
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 3; i++)
            value[3 * k + i] += factor * ((3 * g[i] * along - load->direction[i]) * f->near[k] / (r * r) +
                                          g[i] * along * f->p[k] / alpha2 -
                                          (g[i] * along - load->direction[i]) * f->s[k] / beta2);
}

/* Aki & Richards Eq 4.29, contracted, with m = M g, n = g.M g, tr the trace of M:
 *   4 pi rho r u = (15 n g - 3 tr g - 6 m) N/r^3 + (6 n g - tr g - 2 m) f(t-a)/(cp^2 r)
 *                - (6 n g - tr g - 3 m) f(t-b)/(cs^2 r) + n g f'(t-a)/cp^3 - (n g - m) f'(t-b)/cs^3. */
static void add_moment(const struct solid *solid, const struct load *load, const double g[3], double r,
                       const struct pulses *f, double value[6])
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    const double alpha = solid->p_speed, beta = solid->s_speed;
    const double factor = load->amplitude / (4 * M_PI * solid->density * r);
    double turned[3] = {0}, along = 0, trace = 0; /* M g, g M g, trace of M */
    for (int p = 0; p < 3; p++) {
        for (int q = 0; q < 3; q++)
            turned[p] += load->moment[place[p][q]] * g[q];
        along += g[p] * turned[p];
        trace += load->moment[p];
    }
    for (int k = 0; k < 2; k++)
        for (int n = 0; n < 3; n++) {
            const double near = 15 * g[n] * along - 3 * g[n] * trace - 6 * turned[n];
            const double p = 6 * g[n] * along - g[n] * trace - 2 * turned[n];
            value[3 * k + n] +=
                factor *
                (near * f->near[k] / (r * r * r) + p * f->p[k] / (alpha * alpha * r) -
                 (p - turned[n]) * f->s[k] / (beta * beta * r) + g[n] * along * f->p_rate[k] / pow(alpha, 3) -
                 (g[n] * along - turned[n]) * f->s_rate[k] / pow(beta, 3));
        }
}

void stokes_add(const struct solid *solid, const struct load *load, const double away[3], double t,
                double value[6])
{
    const double r = sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
    const double g[3] = {away[0] / r, away[1] / r, away[2] / r};
    const bool moment = load->kind == LOAD_MOMENT_TENSOR;
    struct pulses pulses;
    if (t <= r / solid->p_speed) return;
    find_pulses(solid, &load->history, r, t, moment, &pulses);
    if (moment)
        add_moment(solid, load, g, r, &pulses, value);
    else
        add_force(solid, load, g, r, &pulses, value);
}

/* Time at which the first wave that came by a face reaches a place; absorbing layers are taken to send none
 * back. *direct: time of the first wave straight from a source. */
static double valid_until(const struct scene *scene, const double position[3], double *direct)
{
    const double speed = scene->material[scene->body.material].p_speed;
    double until = INFINITY, own[3];
    body_from_deck(&scene->body, position, own);
    *direct = INFINITY;
    for (size_t l = 0; l < scene->loads; l++) {
        double source[3], away[3];
        body_from_deck(&scene->body, scene->load[l].centre, source);
        for (int c = 0; c < 3; c++)
            away[c] = own[c] - source[c];
        *direct = fmin(*direct, sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]) / speed);
        for (int face = 0; face < BOX_FACES; face++) {
            const struct boundary *boundary = &scene->boundary[face];
            if (boundary_has_layer(boundary)) continue;
            const int axis = face / 2;
            const double plane = face_plane(&scene->body, (enum face)face);
            const double across = own[axis] + source[axis] - 2 * plane;
            const double aside = hypot(away[(axis + 1) % 3], away[(axis + 2) % 3]);
            until = fmin(until, hypot(across, aside) / speed);
        }
    }
    return until;
}

static selas_status check_place(const struct scene *scene, const double position[3], const char *name,
                                struct messages *messages)
{
    double direct = 0;
    const double until = valid_until(scene, position, &direct);
    if (direct == 0)
        return fail(messages, SELAS_BAD_SCENE,
                    "reference 'stokes': %s lies at a source, where all is infinite", name);
    if (until > direct * (1 + 1e-9)) return SELAS_OK;
    return fail(messages, SELAS_BAD_SCENE,
                "reference 'stokes': at %s the waves sent back by a face of the box arrive as early as those "
                "from the source (t = %.4g); move it inside or use an absorbing layer, layer = 'pml'",
                name, direct);
}

static selas_status check_scene(const struct scene *scene, struct messages *messages)
{
    const char *why = NULL;
    if (scene->dimension != 3)
        why = "the solid is three-dimensional, dimension = 3";
    else if (!body_is_box(&scene->body))
        why = "the body must have shape = 'box'";
    else if (scene->body.layers > 0)
        why = "the solid must be homogeneous, without &layer";
    else if (scene->initial.kind != INITIAL_REST)
        why = "the solid must start at rest";
    else if (scene->loads == 0)
        why = "there is no &load";
    for (size_t i = 0; i < scene->loads && why == NULL; i++)
        if (scene->load[i].kind == LOAD_TRACTION || scene->load[i].shape != LOAD_POINT)
            why = "only point sources: kind = 'moment-tensor', or 'body-force' with shape = 'point'";
    if (why != NULL) return fail(messages, SELAS_BAD_SCENE, "reference 'stokes': %s", why);
    for (size_t i = 0; i < scene->receivers; i++) {
        char name[NAME_SIZE + 16];
        (void)snprintf(name, sizeof name, "receiver %s", scene->receiver[i].name);
        const selas_status status = check_place(scene, scene->receiver[i].position, name, messages);
        if (status != SELAS_OK) return status;
    }
    return SELAS_OK;
}

static selas_status create(const struct scene *scene, struct exact **exact, struct messages *messages)
{
    *exact = NULL;
    const selas_status status = check_scene(scene, messages);
    if (status != SELAS_OK) return status;
    *exact = array_new(1, sizeof **exact);
    if (*exact == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the reference 'stokes'");
    **exact = (struct exact){.class = &exact_stokes, .scene = scene};
    return SELAS_OK;
}

static void destroy(struct exact *exact)
{
    array_free(exact);
}

static selas_status history(struct exact *exact, const double position[3], size_t n, const double *time,
                            double *value, struct messages *messages)
{
    const struct scene *scene = exact->scene;
    const struct material *material = &scene->material[scene->body.material];
    const struct solid solid = {material->density, material->p_speed, material->s_speed};
    const selas_status status = check_place(scene, position, "the place", messages);
    if (status != SELAS_OK) return status;
    for (size_t i = 0; i < n; i++) {
        for (int c = 0; c < 6; c++)
            value[6 * i + (size_t)c] = 0;
        for (size_t l = 0; l < scene->loads; l++) {
            const struct load *load = &scene->load[l];
            const double away[3] = {position[0] - load->centre[0], position[1] - load->centre[1],
                                    position[2] - load->centre[2]};
            stokes_add(&solid, load, away, time[i], value + 6 * i);
        }
    }
    return SELAS_OK;
}

static void describe(const struct exact *exact,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct scene *scene = exact->scene;
    double until = INFINITY;
    size_t first = 0;
    char text[192];
    tell(context, "exact", "point sources in an infinite solid (Stokes 1849; doc/theory/sources.md)");
    for (size_t i = 0; i < scene->receivers; i++) {
        double direct = 0;
        const double here = valid_until(scene, scene->receiver[i].position, &direct);
        if (here < until) {
            until = here;
            first = i;
        }
    }
    if (isinf(until))
        (void)snprintf(text, sizeof text, "all times (absorbing layers taken as perfect)");
    else
        (void)snprintf(text, sizeof text,
                       "t = %.6g at receiver %s, when the first wave comes back from a face%s", until,
                       scene->receiver[first].name, until < scene->end_time ? " (before end_time)" : "");
    tell(context, "exact until", text);
}

const struct exact_class exact_stokes = {
    .kind = "stokes",
    .create = create,
    .destroy = destroy,
    .history = history,
    .describe = describe,
};
