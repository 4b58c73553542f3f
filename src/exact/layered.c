/* Layers over a half-space by stiffness matrices (Kausel & Roesset, Bull. Seismol. Soc. Am. 71 (1981)
 * 1743-1761), written with exponentials that only decay, so that nothing overflows however thick a layer is
 * (doc/layered.md, Eqs 1-12).
 *
 * In (k, s) space with u_r = i U, u_z = W and T_r = i Q, T_z = Z, motion and traction (Q, Z) on the upper
 * side of a waves going down with amplitudes a are (U, W) = D a, (Q, Z) = mu F a,
 *   D = [k q; -p -k],   F = [2kp kap; -kap -2kq],   p^2 = k^2 + s^2/cp^2, q^2 = k^2 + w, w = s^2/cs^2,
 *   kap = 2k^2 + w,
 * and waves going up are their mirror images. With M = diag(1, -1), E = diag(exp(-p h), exp(-q h)), sums
 * (sigma = 1) and differences (sigma = -1) of both faces decouple:
 *   t_top + sigma M t_bottom = K_sigma (u_top + sigma M u_bottom),
 *   K_sigma = mu (F - sigma M F E) (D + sigma M D E)^-1,
 * so that the layer's stiffness is K11 = (K+ + K-)/2, K12 = (K+ - K-) M/2, K22 = M K11 M. Upwards from the
 * half-space, S = mu F D^-1, the ground below a face has the stiffness S = K11 - K12 (K22 + S_below)^-1 K21.
 */
#include "exact/layered.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { MOST_STRATA = 64 };

struct matrix {
    double complex a, b, c, d; /* a b; c d */
};

static struct matrix product(struct matrix x, struct matrix y)
{
    return (struct matrix){x.a * y.a + x.b * y.c, x.a * y.b + x.b * y.d, x.c * y.a + x.d * y.c,
                           x.c * y.b + x.d * y.d};
}
static struct matrix inverse(struct matrix x)
{
    const double complex factor = 1 / (x.a * x.d - x.b * x.c);
    return (struct matrix){x.d * factor, -x.b * factor, -x.c * factor, x.a * factor};
}
/* x + factor y */
static struct matrix sum(struct matrix x, double factor, struct matrix y)
{
    return (struct matrix){x.a + factor * y.a, x.b + factor * y.b, x.c + factor * y.c, x.d + factor * y.d};
}
static struct matrix mirrored(struct matrix x)
{
    return (struct matrix){x.a, -x.b, -x.c, x.d};
}

/* Stiffness of one stratum: K11, K12 (in plane) and the same across the plane; of the half-space only near.
 */
struct stiffness {
    struct matrix near, far;
    double complex shear_near, shear_far;
};

static void stiffness_of(const struct stratum *stratum, double thickness, double complex s, double k,
                         bool shear, struct stiffness *stiffness)
{
    const double complex w = s * s / (stratum->s_speed * stratum->s_speed), kap = 2 * k * k + w;
    const double complex p = csqrt(k * k + s * s / (stratum->p_speed * stratum->p_speed)),
                         q = csqrt(k * k + w);
    const struct matrix down = {k, q, -p, -k};
    const double mu = stratum->mu;
    const struct matrix force = {2 * mu * k * p, mu * kap, -mu * kap, -2 * mu * k * q};
    if (isinf(thickness)) {
        stiffness->near = product(force, inverse(down));
        stiffness->shear_near = mu * q;
        return;
    }
    const double complex e_p = cexp(-p * thickness), e_q = cexp(-q * thickness);
    const struct matrix motion_up = {down.a * e_p, down.b * e_q, -down.c * e_p, -down.d * e_q};
    const struct matrix force_up = {force.a * e_p, force.b * e_q, -force.c * e_p, -force.d * e_q};
    const struct matrix even = product(sum(force, -1, force_up), inverse(sum(down, 1, motion_up)));
    const struct matrix odd = product(sum(force, 1, force_up), inverse(sum(down, -1, motion_up)));
    stiffness->near = (struct matrix){.5 * (even.a + odd.a), .5 * (even.b + odd.b), .5 * (even.c + odd.c),
                                      .5 * (even.d + odd.d)};
    stiffness->far = (struct matrix){.5 * (even.a - odd.a), -.5 * (even.b - odd.b), .5 * (even.c - odd.c),
                                     -.5 * (even.d - odd.d)};
    if (!shear) return;
    const double complex factor = mu * q / (1 - e_q * e_q);
    stiffness->shear_near = factor * (1 + e_q * e_q);
    stiffness->shear_far = -2 * factor * e_q;
}

/* The strata with a face put in at depth z; returns how many, *face: which of them begins at z. */
static size_t cut_at(const struct layered *layered, double z, struct stratum *cut, double *thickness,
                     size_t *face)
{
    size_t count = 0;
    *face = 0;
    for (size_t i = 0; i < layered->strata; i++) {
        const double bottom = i + 1 < layered->strata ? layered->stratum[i + 1].top : INFINITY;
        cut[count++] = layered->stratum[i];
        if (z > layered->stratum[i].top && z < bottom) {
            *face = count;
            cut[count] = layered->stratum[i];
            cut[count++].top = z;
        } else if (z == layered->stratum[i].top)
            *face = count - 1;
    }
    for (size_t i = 0; i < count; i++)
        thickness[i] = i + 1 < count ? cut[i + 1].top - cut[i].top : INFINITY;
    return count;
}

/* Motion at face `face` of the strata per traction on the surface: in plane, and across. */
static void solve(size_t count, const struct stratum *stratum, const double *thickness, size_t face,
                  double complex s, double k, bool shear, struct matrix *plane, double complex *across)
{
    struct stiffness layer = {.shear_near = 1};
    struct matrix passed[MOST_STRATA], ground;
    double complex shear_passed[MOST_STRATA], shear_ground;
    stiffness_of(&stratum[count - 1], INFINITY, s, k, shear, &layer);
    ground = layer.near;
    shear_ground = layer.shear_near;
    for (size_t i = count - 1; i-- > 0;) {
        stiffness_of(&stratum[i], thickness[i], s, k, shear, &layer);
        /* K21 is the transpose of K12 */
        const struct matrix back = {layer.far.a, layer.far.c, layer.far.b, layer.far.d};
        passed[i] = product(inverse(sum(mirrored(layer.near), 1, ground)), back);
        ground = sum(layer.near, -1, product(layer.far, passed[i]));
        if (!shear) continue;
        shear_passed[i] = layer.shear_far / (layer.shear_near + shear_ground);
        shear_ground = layer.shear_near - layer.shear_far * shear_passed[i];
    }
    *plane = inverse(ground);
    *across = 1 / shear_ground;
    for (size_t i = 0; i < face; i++) {
        const struct matrix next = product(passed[i], *plane);
        *plane = (struct matrix){-next.a, -next.b, -next.c, -next.d};
        if (shear) *across *= -shear_passed[i];
    }
}

void layered_compliance(const struct layered *layered, double complex s, double z, size_t count,
                        const double *k, bool horizontal_loads, struct compliance *compliance)
{
    struct stratum cut[MOST_STRATA];
    double thickness[MOST_STRATA];
    size_t face = 0;
    const size_t strata = cut_at(layered, z, cut, thickness, &face);
    const double mu = layered->stratum[0].mu;
    for (size_t i = 0; i < count; i++) {
        struct matrix plane;
        double complex across = 0;
        solve(strata, cut, thickness, face, s, k[i], horizontal_loads, &plane, &across);
        const double complex values[5] = {mu * plane.d, mu * plane.b, mu * plane.a, -mu * plane.c,
                                          mu * across};
        double(*const parts[5])[BLOCK] = {compliance->vertical, compliance->horizontal, compliance->radial,
                                          compliance->coupled, compliance->shear};
        for (int j = 0; j < (horizontal_loads ? 5 : 2); j++) {
            parts[j][0][i] = creal(values[j]);
            parts[j][1][i] = cimag(values[j]);
        }
    }
}

void layered_add_difference(const struct layered *layered, const struct half_space *top, double complex s,
                            double z, size_t count, const double *k, bool horizontal_loads,
                            struct compliance *compliance)
{
    if (layered->strata < 2) return;
    /* the way down to the first interface and to the receiver: exp(-36) is below rounding */
    const double way = fmax(z, 2 * layered->stratum[1].top - z);
    const double most = hypot(36 / way, cimag(s) / layered->slowest);
    while (count > 0 && k[count - 1] > most)
        count--;
    if (count == 0) return;
    struct compliance with, without;
    layered_compliance(layered, s, z, count, k, horizontal_loads, &with);
    half_space_compliance(top, s, z, count, k, horizontal_loads, false, &without);
    double(*const to[5])[BLOCK] = {compliance->vertical, compliance->horizontal, compliance->radial,
                                   compliance->coupled, compliance->shear};
    double(*const plus[5])[BLOCK] = {with.vertical, with.horizontal, with.radial, with.coupled, with.shear};
    double(*const minus[5])[BLOCK] = {without.vertical, without.horizontal, without.radial, without.coupled,
                                      without.shear};
    for (int j = 0; j < (horizontal_loads ? 5 : 2); j++)
        for (int part = 0; part < 2; part++)
            for (size_t i = 0; i < count; i++)
                to[j][part][i] += plus[j][part][i] - minus[j][part][i];
}

selas_status layered_from(size_t strata, const struct stratum *stratum, struct layered **created,
                          struct messages *messages)
{
    *created = NULL;
    if (strata == 0 || strata > MOST_STRATA - 2)
        return fail(messages, SELAS_BAD_SCENE, "reference 'lamb': %zu layers; expected 1 to %d", strata,
                    MOST_STRATA - 2);
    struct layered *layered = array_new(1, sizeof *layered);
    struct stratum *copy = array_new(strata, sizeof *copy);
    if (layered == NULL || copy == NULL) {
        array_free(layered);
        array_free(copy);
        return fail(messages, SELAS_NO_MEMORY, "not enough memory for the layers of the reference 'lamb'");
    }
    memcpy(copy, stratum, strata * sizeof *copy);
    layered->strata = strata;
    layered->stratum = copy;
    layered->slowest = INFINITY;
    for (size_t i = 0; i < strata; i++) {
        struct half_space alone;
        const double mu = copy[i].mu, speed = copy[i].p_speed;
        half_space_set(&alone, copy[i].density, copy[i].density * speed * speed - 2 * mu, mu);
        layered->slowest = fmin(layered->slowest, alone.rayleigh_speed);
        layered->fastest[0] = fmax(layered->fastest[0], copy[i].p_speed);
        layered->fastest[1] = fmax(layered->fastest[1], copy[i].s_speed);
    }
    *created = layered;
    return SELAS_OK;
}

static struct stratum stratum_of(const struct material *material, double top)
{
    return (struct stratum){top, material->density, material->mu, material->p_speed, material->s_speed};
}

selas_status layered_create(const struct scene *scene, struct layered **created, struct messages *messages)
{
    const struct body *body = &scene->body;
    struct stratum stratum[MOST_STRATA];
    size_t strata = 0;
    if (body->layers == 0 || body->layer[0].top > 0)
        stratum[strata++] = stratum_of(&scene->material[body->material], 0);
    for (size_t i = 0; i < body->layers && strata < MOST_STRATA; i++)
        stratum[strata++] = stratum_of(&scene->material[body->layer[i].material], body->layer[i].top);
    return layered_from(strata, stratum, created, messages);
}

void layered_free(struct layered **layered)
{
    if (layered == NULL || *layered == NULL) return;
    array_free((*layered)->stratum);
    array_free(*layered);
    *layered = NULL;
}
