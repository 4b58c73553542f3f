/* Compliances of the elastic half-space under surface tractions (Lamb 1904, in the notation of Kausel 2006,
 * "Fundamental solutions in elastodynamics", ch. 8; doc/theory/lamb.md, Eqs 1-3).
 *
 * With p = sqrt(k^2 + s^2/cp^2), q = sqrt(k^2 + w), w = s^2/cs^2, kap = 2 k^2 + w, R = kap^2 - 4 k^2 p q,
 * Ep = exp(-p z), Eq = exp(-q z):
 *   vertical   = p [kap Ep - 2 k^2 Eq] / R,       horizontal = k [-kap Ep + 2 p q Eq] / R,
 *   radial     = q [-2 k^2 Ep + kap Eq] / R,      coupled    = k [-2 p q Ep + kap Eq] / R,  shear = Eq / q.
 * For k^2 >> |w| all brackets and R cancel to O(w); so w is divided out beforehand:
 *   R/w   = [16 (1-a) k^6 + (24-16 a) k^4 w + 8 k^2 w^2 + w^3] / (kap^2 + 4 k^2 p q),   a = cs^2/cp^2,
 *   c     = (kap - 2 p q)/w = 1 - 2 [k^2 (1+a) + a w] / (p q + k^2),
 *   D     = (Ep - Eq)/w with q - p = w (1-a) / (q + p),
 *   vertical = p (Ep + 2 k^2 D) / (R/w),  horizontal = -k (c Eq + kap D) / (R/w),
 *   radial   = q (Eq - 2 k^2 D) / (R/w),  coupled    =  k (c Eq - 2 p q D) / (R/w). */
#include "exact/half_space.h"

#include "exact/pair.h"

#include <math.h>

void half_space_set(struct half_space *half_space, double density, double lambda, double mu)
{
    *half_space = (struct half_space){.density = density, .mu = mu, .poisson = .5 * lambda / (lambda + mu)};
    half_space->p_speed = sqrt((lambda + 2 * mu) / density);
    half_space->s_speed = sqrt(mu / density);
    const double a = half_space->ratio = mu / (lambda + 2 * mu);
    /* y^3 - 8 y^2 + (24 - 16 a) y - 16 (1 - a) = 0 has one root in (0, 1): negative at 0, 1 at 1. */
    double low = 0, high = 1;
    for (int i = 0; i < 200 && high > low; i++) {
        const double y = .5 * (low + high);
        if (y == low || y == high) break;
        if (((y - 8) * y + 24 - 16 * a) * y - 16 * (1 - a) < 0)
            low = y;
        else
            high = y;
    }
    const double y = half_space->rayleigh = .5 * (low + high);
    half_space->rayleigh_speed = half_space->s_speed * sqrt(y);
    const double p = half_space->p_decay = sqrt(1 - a * y), q = half_space->s_decay = sqrt(1 - y);
    const double kap = 2 - y, slope = 2 * kap - 2 * (a * q / p + p / q); /* dR/dw at k = 1 */
    const double residues[4][2] = {
        {p * kap, -2 * p}, {-kap, 2 * p * q}, {-2 * q, q * kap}, {-2 * p * q, kap}};
    for (int i = 0; i < 2; i++) {
        half_space->vertical_residue[i] = residues[0][i] / slope;
        half_space->horizontal_residue[i] = residues[1][i] / slope;
        half_space->radial_residue[i] = residues[2][i] / slope;
        half_space->coupled_residue[i] = residues[3][i] / slope;
    }
}

/* What all compliances at one k share. */
struct roots {
    struct pair p, q, pq, kap;
    struct pair over_w; /* R / w */
    struct pair c;      /* (kap - 2 p q) / w */
    struct pair e_p, e_q, d;
};

static inline void find_roots(double a, struct pair w, double size, double z, double k, struct roots *roots)
{
    const double k2 = k * k;
    const struct pair one = {1, 0}, kk = {k2, 0};
    roots->p = root(plus(kk, scaled(a, w)));
    roots->q = root(plus(kk, w));
    roots->pq = times(roots->p, roots->q);
    roots->kap = plus(scaled(2, kk), w);
    const struct pair square = times(roots->kap, roots->kap), product = scaled(4 * k2, roots->pq);
    if (k2 > 2 * size) {
        struct pair sum = plus(w, (struct pair){8 * k2, 0});
        sum = plus(times(sum, w), (struct pair){(24 - 16 * a) * k2 * k2, 0});
        sum = plus(times(sum, w), (struct pair){16 * (1 - a) * k2 * k2 * k2, 0});
        roots->over_w = over(sum, plus(square, product));
        const struct pair above = plus((struct pair){(1 + a) * k2, 0}, scaled(a, w));
        roots->c = plus(one, scaled(-2, over(above, plus(roots->pq, kk))));
    } else {
        roots->over_w = over(plus(square, scaled(-1, product)), w);
        roots->c = over(plus(roots->kap, scaled(-2, roots->pq)), w);
    }
    if (z == 0) {
        roots->e_p = roots->e_q = one;
        roots->d = (struct pair){0, 0};
        return;
    }
    const struct pair difference = over(scaled(1 - a, w), plus(roots->p, roots->q)); /* q - p */
    roots->e_q = decay(roots->q, z);
    if (fabs(difference.re * z) + fabs(difference.im * z) < 1) {
        roots->d = over(times(roots->e_q, exp_minus_one(scaled(z, difference))), w);
        roots->e_p = plus(roots->e_q, times(roots->d, w));
    } else {
        roots->e_p = decay(roots->p, z);
        roots->d = over(plus(roots->e_p, scaled(-1, roots->e_q)), w);
    }
}

/* One node at the surface (z = 0, so that D = 0) under vertical loads: values[0] vertical, values[1]
 * horizontal. `large`: k^2 > 2 |w|. Without branches, so that loops over it run in vectors. */
static inline void surface_node(double a, struct pair w, double k, bool large, struct pair values[2])
{
    const double k2 = k * k;
    const struct pair one = {1, 0}, kk = {k2, 0};
    const struct pair p = root(plus(kk, scaled(a, w))), q = root(plus(kk, w)), pq = times(p, q);
    const struct pair kap = plus(scaled(2, kk), w);
    const struct pair square = times(kap, kap), product = scaled(4 * k2, pq);
    struct pair inverse, c;
    if (large) {
        struct pair sum = plus(w, (struct pair){8 * k2, 0});
        sum = plus(times(sum, w), (struct pair){(24 - 16 * a) * k2 * k2, 0});
        sum = plus(times(sum, w), (struct pair){16 * (1 - a) * k2 * k2 * k2, 0});
        inverse = over(plus(square, product), sum);
        c = plus(one, scaled(-2, over(plus(scaled(1 + a, kk), scaled(a, w)), plus(pq, kk))));
    } else {
        inverse = over(w, plus(square, scaled(-1, product)));
        c = over(plus(kap, scaled(-2, pq)), w);
    }
    values[0] = times(p, inverse);
    values[1] = times(scaled(-k, c), inverse);
}

static inline void surface_run(const struct half_space *half_space, struct pair w, size_t from, size_t until,
                               const double *k, bool large, bool without_rayleigh,
                               struct compliance *compliance)
{
    const double vertical = half_space->vertical_residue[0] + half_space->vertical_residue[1];
    const double horizontal = half_space->horizontal_residue[0] + half_space->horizontal_residue[1];
    for (size_t i = from; i < until; i++) {
        struct pair values[2];
        surface_node(half_space->ratio, w, k[i], large, values);
        if (without_rayleigh) {
            const struct pair pole =
                over((struct pair){k[i], 0}, plus(w, (struct pair){half_space->rayleigh * k[i] * k[i], 0}));
            values[0] = plus(values[0], scaled(-vertical, pole));
            values[1] = plus(values[1], scaled(-horizontal, pole));
        }
        compliance->vertical[0][i] = values[0].re;
        compliance->vertical[1][i] = values[0].im;
        compliance->horizontal[0][i] = values[1].re;
        compliance->horizontal[1][i] = values[1].im;
    }
}

/* Wavenumbers ascend: first those with k^2 <= 2 |w|, then the others. */
static void surface_compliance(const struct half_space *half_space, struct pair w, double size, size_t count,
                               const double *k, bool without_rayleigh, struct compliance *compliance)
{
    size_t small = 0;
    while (small < count && k[small] * k[small] <= 2 * size)
        small++;
    surface_run(half_space, w, 0, small, k, false, without_rayleigh, compliance);
    surface_run(half_space, w, small, count, k, true, without_rayleigh, compliance);
}

void half_space_compliance(const struct half_space *half_space, double complex s, double z, size_t count,
                           const double *k, bool horizontal_loads, bool without_rayleigh,
                           struct compliance *compliance)
{
    const double a = half_space->ratio;
    const struct pair slowness = {creal(s) / half_space->s_speed, cimag(s) / half_space->s_speed};
    const struct pair w = times(slowness, slowness);
    const double size = sqrt(w.re * w.re + w.im * w.im);
    if (z == 0 && !horizontal_loads) {
        surface_compliance(half_space, w, size, count, k, without_rayleigh, compliance);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        struct roots r;
        find_roots(a, w, size, z, k[i], &r);
        const double k2 = k[i] * k[i];
        const struct pair inverse = over((struct pair){1, 0}, r.over_w);
        const struct pair c_q = times(r.c, r.e_q);
        struct pair values[5] = {
            times(times(r.p, plus(r.e_p, scaled(2 * k2, r.d))), inverse),
            times(scaled(-k[i], plus(c_q, times(r.kap, r.d))), inverse),
        };
        if (horizontal_loads) {
            values[2] = times(times(r.q, plus(r.e_q, scaled(-2 * k2, r.d))), inverse);
            values[3] = times(scaled(k[i], plus(c_q, scaled(-2, times(r.pq, r.d)))), inverse);
            values[4] = over(r.e_q, r.q);
        }
        if (without_rayleigh) {
            const struct pair pole =
                over((struct pair){k[i], 0}, plus(w, (struct pair){half_space->rayleigh * k2, 0}));
            const double e_p = z == 0 ? 1 : exp(-half_space->p_decay * k[i] * z);
            const double e_s = z == 0 ? 1 : exp(-half_space->s_decay * k[i] * z);
            const double *const residues[4] = {half_space->vertical_residue, half_space->horizontal_residue,
                                               half_space->radial_residue, half_space->coupled_residue};
            for (int j = 0; j < (horizontal_loads ? 4 : 2); j++)
                values[j] = plus(values[j], scaled(-(residues[j][0] * e_p + residues[j][1] * e_s), pole));
        }
        double(*const parts[5])[BLOCK] = {compliance->vertical, compliance->horizontal, compliance->radial,
                                          compliance->coupled, compliance->shear};
        for (int j = 0; j < (horizontal_loads ? 5 : 2); j++) {
            parts[j][0][i] = values[j].re;
            parts[j][1][i] = values[j].im;
        }
    }
}

void half_space_static(const struct half_space *half_space, double z, double k, double value[5])
{
    const double nu = half_space->poisson, factor = exp(-k * z) / k, half = .5 * k * z;
    value[0] = (1 - nu + half) * factor;
    value[1] = (.5 - nu - half) * factor;
    value[2] = (1 - nu - half) * factor;
    value[3] = -(.5 - nu + half) * factor;
    value[4] = factor;
}

void half_space_static_rayleigh(const struct half_space *half_space, double z, double k, double value[4])
{
    const double e_p = exp(-half_space->p_decay * k * z), e_s = exp(-half_space->s_decay * k * z);
    const double *const residues[4] = {half_space->vertical_residue, half_space->horizontal_residue,
                                       half_space->radial_residue, half_space->coupled_residue};
    for (int j = 0; j < 4; j++)
        value[j] = (residues[j][0] * e_p + residues[j][1] * e_s) / (half_space->rayleigh * k);
}
