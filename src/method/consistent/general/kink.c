/* What displacements of the lattice lack beside an interface, where those of the ground have a kink
 * (doc/theory/general-ground.md, section 6). */
#include "method/consistent/general/kink.h"

#include "base/memory.h"
#include "method/consistent/general/glut.h"
#include "method/consistent/general/medium.h"
#include "scene/ground.h"

#include <math.h>
#include <string.h>

/* Tractions at the place from those at the two knots beside it; at a free end they are 0. */
static void find_share(struct glut *g)
{
    const struct spline *spline = g->c->spline[g->across];
    const double cells = (double)spline->cells, at = (g->centre[g->across] - spline->low) / g->spacing;
    const double first = fmin(fmax(floor(at), 0), cells - 1), part = at - first;
    const struct boundary *end = &g->c->model.scene->boundary[2 * g->across];
    g->share[(size_t)first] = 1 - part;
    g->share[(size_t)first + 1] = part;
    if (first == 0 && boundary_is_free(&end[0])) g->share[0] = 0;
    if (first == cells - 1 && boundary_is_free(&end[1])) g->share[spline->cells] = 0;
}

/* Does the rock jump within some spacings along the axes or diagonals of the lattice? */
static bool jumps_near(const struct consistent *c, const double centre[3])
{
    enum { REACH = 3, FINE = 32 };
    for (int code = 0; code < (c->dimension == 2 ? 9 : 27); code++) {
        const double way[3] = {code % 3 - 1, code / 3 % 3 - 1, c->dimension == 2 ? 0 : code / 9 - 1};
        struct rock last = consistent_rock_at(c, centre);
        for (int n = 1; n <= REACH * FINE; n++) {
            double place[3] = {centre[0], centre[1], centre[2]};
            for (int axis = 0; axis < c->dimension && axis < 3; axis++)
                place[axis] += way[axis] * glut_spacing(c->spline[axis]) * n / FINE;
            const struct rock rock = consistent_rock_at(c, place);
            if (consistent_rock_differs(rock, last)) return true;
            last = rock;
        }
    }
    return false;
}

/* What is alike for all directions: false where nothing is lacking. */
static bool find_glut(const struct consistent *c, const double centre[3], bool half, struct glut *g)
{
    *g = (struct glut){.c = c, .centre = {centre[0], centre[1], centre[2]}, .plain = true, .half = half};
    return !general_is_part(c->model.scene) && jumps_near(c, centre) && general_find_normal(g) && g->surface;
}

/* (G30) */
static bool add_kink(struct glut *g, const double direction[3], struct dense *field)
{
    const double *n = g->normal;
    double *work[3], stress[3][3], along = 0;
    double *room = glut_room(g, work), failed = room == NULL;
    ranks_largest(g->c->part.ranks, 1, &failed);
    if (room == NULL || failed != 0) {
        array_free(room);
        return false;
    }
    find_share(g);
    general_find_lag(g);
    for (int i = 0; i < 3; i++)
        along += direction[i] * n[i];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double shear = (direction[i] - along * n[i]) * n[j] + (direction[j] - along * n[j]) * n[i];
            g->strain[i][j] = g->lag * shear / 2 + g->press * along * n[i] * n[j];
            stress[i][j] = -g->slack * along * ((i == j) - n[i] * n[j]);
        }
    glut_add_points(g, work[2] + (work[1] - work[0]));
    glut_add_stress(g, 0, g->centre[g->across], 1, stress);
    glut_add_lines(g, 0, work, field);
    array_free(room);
    return true;
}

bool general_add_kink(const struct consistent *c, const double centre[3], const double direction[3],
                      bool half, struct dense *field)
{
    struct glut glut;
    return !find_glut(c, centre, half, &glut) || add_kink(&glut, direction, field);
}

bool general_see_kink(const struct consistent *c, const double place[3], struct kinks *kinks)
{
    struct glut glut;
    if (!find_glut(c, place, false, &glut)) return true;
    struct dense field = {.value = array_new((size_t)c->dimension * c->volume, sizeof(double))};
    double failed = field.value == NULL;
    ranks_largest(c->part.ranks, 1, &failed);
    for (int component = 0; component < c->dimension && failed == 0; component++) {
        struct sparse *kink = &kinks->of[component];
        double direction[3] = {0};
        direction[c->slot[component]] = 1;
        failed = !add_kink(&glut, direction, &field) || !sparse_take(c, &field, kink);
        ranks_largest(c->part.ranks, 1, &failed);
        const size_t sites = failed != 0 ? 0 : (size_t)c->dimension * kink->start[kink->planes];
        kinks->sites = sites > kinks->sites ? sites : kinks->sites;
    }
    array_free(field.value);
    return failed == 0;
}

bool general_keep_kink(struct consistent *c, const struct kinks *kinks, struct probe *probe)
{
    probe->sites = kinks->sites;
    for (int component = 0; component < c->dimension && probe->sites > 0; component++) {
        const struct sparse *kink = &kinks->of[component];
        const size_t first = probe->count + (size_t)component * probe->sites / (size_t)c->dimension;
        for (size_t p = 0; p < kink->planes; p++)
            for (size_t e = kink->start[p]; e < kink->start[p + 1]; e++) {
                const size_t seen = kink->plane[p] % c->n[DEPTH] * c->plane + kink->index[e];
                probe->index[first + e] = kink->plane[p] / c->n[DEPTH] * c->volume + seen;
                probe->weight[first + e] = kink->value[e];
                if (c->dimension == 3 && !watch_places(c, 1, &seen)) return false;
            }
    }
    return true;
}

void kinks_free(struct kinks *kinks)
{
    for (int component = 0; component < 3; component++)
        sparse_free(&kinks->of[component]);
}
