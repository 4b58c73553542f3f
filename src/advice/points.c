/* Patches on points: as published the smoothed point method and updated-Lagrangian SPH press points one by
 * one and see a patch only as wide as the points in it; least-squares gradients hardly see the short surface
 * waves that a narrow patch makes (doc/theory/sph-total-lagrangian.md, section 10). */
#include "advice/parts.h"

#include "scene/boundary.h"

#include <math.h>
#include <stdio.h>

/* A square whose edges lie on lattice planes is seen as it is. */
static void look_at_edges(struct adviser *adviser, size_t k, const char *why)
{
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    const struct body *body = &scene->body;
    double centre[3];
    body_from_deck(body, load->centre, centre);
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double half = half_size(load, axis);
        const double low = round((centre[axis] - half - body->low[axis]) / body->spacing);
        const double high = round((centre[axis] + half - body->low[axis]) / body->spacing);
        const double from = body->low[axis] + body->spacing * low,
                     to = body->low[axis] + body->spacing * high;
        const double off = fmax(fabs(centre[axis] - half - from), fabs(centre[axis] + half - to));
        if (half <= 0.0 || off < 1e-6 * body->spacing) continue;
        advise(adviser, "the edges of load %zu along %c lie between %s; %.6g to %.6g would lie on them",
               scene->load[k].group + 1, "xyz"[axis], why, from, to);
    }
}

/* Share of the part of a patch that lies on the body: its particles' area over its own, both counted on the
 * face. */
static double pressed_share(const struct scene *scene, const struct load *load)
{
    enum { FINE = 50 };
    const struct body *body = &scene->body;
    double centre[3], counted[2] = {0};
    long cells[2] = {1, 1};
    int axis[2] = {0}, axes = 0;
    body_from_deck(body, load->centre, centre);
    for (int a = 0; a < scene->dimension && axes < 2; a++)
        if (a != face_axis(load->face)) axis[axes++] = a;
    for (int fine = 0; fine < 2; fine++) { /* particles, and small pieces between them */
        const double step = body->spacing / (fine ? FINE : 1);
        double first[2] = {0};
        for (int k = 0; k < axes && k < 2; k++) {
            const double low = fmax(body->low[axis[k]], centre[axis[k]] - half_size(load, axis[k]));
            const double high = fmin(body->high[axis[k]], centre[axis[k]] + half_size(load, axis[k]));
            first[k] = floor((low - body->low[axis[k]]) / step);
            cells[k] = (long)fmin(4096.0, ceil((high - body->low[axis[k]]) / step) - first[k]);
        }
        for (long i = 0; i < cells[0]; i++)
            for (long j = 0; j < cells[1]; j++) {
                const long cell[2] = {i, j};
                double square = 0.0;
                bool within = true;
                for (int k = 0; k < axes && k < 2; k++) {
                    const double x = body->low[axis[k]] + (first[k] + (double)cell[k] + 0.5) * step;
                    square += (x - centre[axis[k]]) * (x - centre[axis[k]]);
                    within = within && fabs(x - centre[axis[k]]) <= half_size(load, axis[k]);
                }
                if (within && (load->shape != LOAD_DISC || square <= 0.25 * load->size[0] * load->size[0]))
                    counted[fine] += pow(step, axes);
            }
    }
    return counted[1] > 0.0 ? counted[0] / counted[1] : 1.0;
}

/* The same of points of a file, each of which counts as an even part of the face that it lies next to. */
static double counted_share(const struct scene *scene, const struct model *model, const struct load *load)
{
    const struct body *body = &scene->body;
    const int normal = face_axis(load->face);
    double centre[3], whole = 1.0, own = 1.0;
    size_t next = 0, pressed = 0;
    body_from_deck(body, load->centre, centre);
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double half = half_size(load, axis);
        if (axis == normal) continue;
        whole *= body->high[axis] - body->low[axis];
        own *= fmin(body->high[axis], centre[axis] + half) - fmax(body->low[axis], centre[axis] - half);
    }
    if (load->shape == LOAD_DISC && scene->dimension == 3) own *= M_PI / 4;
    for (size_t i = 0; i < model->points; i++) {
        double deck[3], place[3], square = 0.0;
        bool within = true;
        model_position(model, i, deck);
        body_from_deck(body, deck, place);
        if (fabs(place[normal] - face_plane(body, load->face)) > 0.75 * body->spacing) continue;
        for (int axis = 0; axis < scene->dimension; axis++) {
            const double away = axis == normal ? 0.0 : fabs(place[axis] - centre[axis]);
            square += away * away;
            within = within && (axis == normal || away <= half_size(load, axis));
        }
        next++;
        pressed += within && (load->shape != LOAD_DISC || square <= 0.25 * load->size[0] * load->size[0]);
    }
    return next > 0 && own > 0.0 ? (double)pressed / (double)next * whole / own : 1.0;
}

static void look_at_particles(struct adviser *adviser, const struct model *model, size_t k)
{
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    const bool box = body_is_box(&scene->body);
    const double noticed = box ? 0.02 : 0.05; /* of a file the face is counted, too */
    const double share = box ? pressed_share(scene, load) : counted_share(scene, model, load);
    if (fabs(share - 1.0) < noticed || scene->body.jitter > 0.0) return;
    if (box && load->shape == LOAD_SQUARE)
        look_at_edges(adviser, k, "the particles' cells, which are pressed whole or not at all");
    else
        advise(adviser,
               "the particles in load %zu have %.3g of its area, so the force is that much of what is meant; "
               "amplitude = %.6g would be right, or a finer spacing",
               scene->load[k].group + 1, share, share > 0.0 ? load->amplitude / share : load->amplitude);
}

/* Least-squares gradients under a patch of few points. */
static void look_at_ringing(struct adviser *adviser, const struct model *model, size_t k)
{
    enum { FEW = 10 };
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    double width = INFINITY;
    bool whole = true;
    for (int axis = 0; axis < scene->dimension; axis++) {
        if (axis == face_axis(load->face)) continue;
        const double size = 2.0 * half_size(load, axis);
        width = fmin(width, size);
        whole = whole && size >= 0.999 * (scene->body.high[axis] - scene->body.low[axis]);
    }
    if (whole || width > FEW * scene->body.spacing) return;
    const bool box = body_is_box(&scene->body), even = box && !(scene->body.jitter > 0);
    char right[80] = "method%gradient = 'central', or method%name = 'smoothed-point',";
    if (!even && cloud_would_run(adviser, model))
        snprintf(right, sizeof right, "method%%variant = 'cloud'");
    else if (!even)
        snprintf(right, sizeof right, box ? "method%%variant = 'consistent'" : "points %.3g apart",
                 width / FEW);
    advise(
        adviser,
        "load %zu is only %.3g points wide, and with least-squares gradients the surface under it rings on; "
        "%s would be right",
        scene->load[k].group + 1, width / scene->body.spacing, right);
}

void look_at_points(struct adviser *adviser, const struct model *model, size_t k)
{
    const enum patch_sight sight = model->patch;
    const bool box = body_is_box(&adviser->scene->body);
    if (sight == PATCH_BY_POINTS && box && adviser->scene->load[k].shape == LOAD_SQUARE)
        look_at_edges(adviser, k, "points");
    if (sight == PATCH_BY_CELLS && (box || adviser->scene->body.shape == BODY_POINTS))
        look_at_particles(adviser, model, k);
    if (sight == PATCH_RINGS) look_at_ringing(adviser, model, k);
}

/* Between the rim of a hole and an edge: velocities were .24 to .39 wrong at 5 points, .06 to .12 at 10, .04 to .08 at
 * 12.5; updated-Lagrangian .6 to .8, .4, .35 (the deck of regress/checks/faces.sh against spacing 1/60). */
void look_at_ligament(struct adviser *adviser)
{
    enum { ENOUGH = 12 };
    const struct body *body = &adviser->scene->body;
    double least = INFINITY;
    if (body->shape != BODY_PLATE_WITH_HOLE) return;
    for (int axis = 0; axis < 2; axis++)
        for (int end = 0; end < 2; end++) {
            const double edge = end == 0 ? body->low[axis] : body->high[axis];
            if (!boundary_mirrors(&adviser->scene->boundary[2 * axis + end]))
                least = fmin(least, fabs(edge - body->hole_centre[axis]) - body->hole_radius);
        }
    if (!isfinite(least) || least >= 0.999 * ENOUGH * body->spacing) return;
    advise(
        adviser,
        "%.1f points lie between the hole's rim and the edge: motions beside it may be a twentieth to a half "
        "wrong; %d, body%%spacing = %.3g, would do",
        least / body->spacing, ENOUGH, least / ENOUGH);
}
