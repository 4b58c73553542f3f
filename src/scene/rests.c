/* What layers make of loads that stay (see the header).
 *
 * In stretched coordinates a layer of thickness L is one of L + c ln(1/R) / (2 (alpha + s)) for what changes as
 * exp(s t), (9). At its outer end u = 0, as if an image of the load stood at twice the distance,
 *   X = 2 (d + L) + c ln(1/R) t / (1 + alpha t),                                                          (17)
 * d from the load to the layer, s = 1 / t (E. L. Post's inversion of the Laplace transform, its first member) for what
 * has come t after the load. The image's field is that of a point, exp(-X / (c t)) / X in space, K_0(X / (c t)) in the
 * plane, of moment tensors its slope; over what the load leaves at the distance r of, the sum over the faces
 *   force:  2.5 sum r exp(-x) / X,            K_0(x) / ln(1 + c t / r) in the plane,     x = X / (c t),
 *   moment: 2.5 sum r^2 exp(-x) (1 + x) / X^2,    r K_1(x) / (c t) in the plane;                            (18)
 * factors by measurement (regress/studies/rests). Near a layer of few points the stretched field of a moment tensor is
 * not resolved besides, m cells from it, n its points:
 *   .02 (4 / m)^2.7 (8 / n)^1.85 (1 - exp(-(c t / 200 h)^1.5)).                                           (19)
 * Splines of degree 1 do not resolve it either: 8 / n^2 in the plane, 1.2 / n^2 in space. */
#include "scene/rests.h"

#include "scene/absorbing_layers.h"

#include <math.h>

static const double in_space = 2.5, in_plane = 1, near_part = .02, near_cells = 4;
static const double linear_in_plane = 8, linear_in_space = 1.2;

/* A load as rests see it. */
struct stay {
    double place[3]; /* of the body */
    double half[3];  /* of a patch */
    double since;    /* the time from its middle to the end of the run */
    bool dipole;
};

static double to_face(const struct scene *scene, const struct stay *stay, int face)
{
    const int axis = face / 2;
    const double away =
        fabs(face_plane(&scene->body, (enum face)face) - stay->place[axis]) - stay->half[axis];
    return fmax(away, layer_spacing(scene, face));
}

/* The layers of a scene's faces. */
struct layers {
    double points[FACES], stretch[FACES];
};

/* As they are, or with so many points each where that is more. */
static struct layers layers_of(const struct scene *scene, size_t points)
{
    struct layers layers = {0};
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const size_t own = layer_points(scene, face), n = points > own ? points : own;
        if (own == 0) continue;
        layers.points[face] = (double)n;
        layers.stretch[face] = layer_stretch(scene, face, n);
    }
    return layers;
}

/* (18) and (19) of a face, without the factors of (18). */
static double of_face(const struct scene *scene, const struct stay *stay, int face,
                      const struct layers *layers, double way)
{
    const double thick = layers->points[face] * layer_spacing(scene, face), away = to_face(scene, stay, face);
    const double speed = scene_fastest(scene), t = stay->since, gone = speed * t;
    const double stretch = layers->stretch[face] * gone / (1 + LAYER_RELAXATION * gone / thick);
    const double image = 2 * (away + thick) + stretch, x = image / gone, fades = exp(-x);
    const double plane = sqrt(M_PI / (2 * x)) * fades; /* K_0(x), and K_1(x) but for 1 + 3 / (8 x) */
    if (scene->dimension == 3)
        return stay->dipole ? pow(way / image, 2) * fades * (1 + x) : way / image * fades;
    return stay->dipole ? way / gone * plane * (1 + .375 / x) : plane / log1p(gone / way);
}

static double near_face(const struct scene *scene, const struct stay *stay, int face, double points)
{
    const double h = layer_spacing(scene, face), cells = to_face(scene, stay, face) / h;
    const double grown = 1 - exp(-pow(scene_fastest(scene) * stay->since / (200 * h), 1.5));
    return stay->dipole ? near_part * pow(near_cells / cells, 2.7) * pow(LAYER_POINTS / points, 1.85) * grown
                        : 0;
}

static double of_all(const struct scene *scene, const struct stay *stay, const struct layers *layers,
                     double way)
{
    const double factor = scene->dimension == 3 ? in_space : in_plane;
    const double linear = layer_degree(scene) != 1 ? 0
                          : scene->dimension == 3  ? linear_in_space
                                                   : linear_in_plane;
    double sum = 0, unresolved = 0;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const double n = layers->points[face];
        if (!(n > 0)) continue;
        const double faces =
            boundary_mirrors(&scene->boundary[face ^ 1]) ? 2 : 1; /* that of the mirror image */
        sum += faces * (factor * of_face(scene, stay, face, layers, way) + near_face(scene, stay, face, n));
        unresolved = fmax(unresolved, linear / (n * n));
    }
    return fmin(1, sum + unresolved);
}

/* False for a load that does not stay. */
static bool take_stay(const struct scene *scene, const struct load *load, struct stay *stay)
{
    enum { SAMPLES = 100 };
    static const double slight = .05;
    const double end = fmin(history_end(&load->history), scene->end_time);
    double most = 0;
    if (load_moves(load) || load->shape == LOAD_FACE || load->amplitude == 0) return false;
    for (int i = 1; i <= SAMPLES; i++)
        most = fmax(most, fabs(history_value(&load->history, end * i / SAMPLES, 0)));
    if (!(fabs(history_value(&load->history, scene->end_time, 0)) > slight * most)) return false;
    *stay = (struct stay){.since = scene->end_time - end / 2, .dipole = load->kind == LOAD_MOMENT_TENSOR};
    body_from_deck(&scene->body, load->centre, stay->place);
    for (int axis = 0, along = 0; load->kind == LOAD_TRACTION && axis < scene->dimension; axis++)
        if (axis != face_axis(load->face) && load->shape != LOAD_POINT)
            stay->half[axis] = load->size[load->shape == LOAD_DISC ? 0 : along++] / 2;
    return true;
}

/* The least points with which (18) and (19) leave too little to be told. */
static long enough_points(const struct scene *scene, const struct stay *stay, double way)
{
    for (size_t points = LAYER_POINTS; points <= MOST_POINTS; points++) {
        const struct layers layers = layers_of(scene, points);
        if (of_all(scene, stay, &layers, way) < REST_SEEN) return (long)points;
    }
    return 0;
}

bool worst_rest(const struct scene *scene, struct rest *rest)
{
    struct stay worst = {0};
    double far = 0;
    bool found = false;
    *rest = (struct rest){0};
    if (scene->dimension < 2 || !body_is_box(&scene->body) || !layer_anywhere(scene)) return false;
    const struct layers layers = layers_of(scene, 0);
    for (size_t k = 0; k < scene->loads; k++) {
        const double *from = scene->load[k].centre;
        struct stay stay;
        if (!take_stay(scene, &scene->load[k], &stay)) continue;
        found = true;
        double way = -1;
        size_t farthest = 0; /* (18) grows with the distance */
        for (size_t r = 0; r < scene->receivers; r++) {
            const double *to = scene->receiver[r].position;
            const double away = hypot(hypot(to[0] - from[0], to[1] - from[1]), to[2] - from[2]);
            if (away <= way) continue;
            way = away;
            farthest = r;
        }
        if (way < 0) continue;
        const double error = of_all(scene, &stay, &layers, fmax(way, scene->body.spacing));
        if (error <= rest->error) continue;
        *rest = (struct rest){k, farthest, error, 0};
        worst = stay;
        far = way;
    }
    if (rest->error >= REST_SEEN) rest->points = enough_points(scene, &worst, far);
    return found;
}
