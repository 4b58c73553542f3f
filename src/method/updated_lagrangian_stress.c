/* Artificial stress against the tensile instability (Gray, Monaghan & Swift 2001; He & Seaid 2016, Eqs
 * 20-23): in the principal axes R = -epsilon s / rho^2 where s > 0 (tension), 0 where s <= 0. In other words
 * R is -epsilon times the positive part of the tensor s / rho^2, which needs no angle. Eight tensors at a
 * time, one in each lane of a vector. */
#include "base/machine.h"
#include "base/vectors.h"
#include "method/updated_lagrangian.h"

#include <float.h>

INLINED void positive(const vec8 *x, vec8 *result)
{
    *result = WHERE(*x > 0, *x);
}

/* Eigenvalues mean +- radius with the eigentensors (I +- D / radius) / 2, D the deviator. */
INLINED void in_the_plane(double epsilon, const vec8 *t, vec8 *r)
{
    const vec8 mean = (t[0] + t[1]) / 2, half = (t[0] - t[1]) / 2, square = half * half + t[2] * t[2];
    vec8 radius, first, second;
    vec8_root(&square, &radius);
    const vec8 high = mean + radius, low = mean - radius;
    positive(&high, &first);
    positive(&low, &second);
    const vec8 sum = -epsilon * (first + second) / 2;
    /* without a radius half and t[2] are 0 as well */
    const vec8 difference = -epsilon * (first - second) / (2 * radius + DBL_MIN);
    r[0] = sum + difference * half;
    r[1] = sum - difference * half;
    r[2] = difference * t[2];
}

/* One Jacobi rotation of a in the plane (p, q), gathered in v: t = tan of the angle is the smaller root of
 * t^2 + 2 theta t = 1, theta = (a_qq - a_pp) / (2 a_pq), here without dividing by a_pq. */
INLINED void rotate(vec8 a[3][3], vec8 v[3][3], const int p, const int q)
{
    const int k = 3 - p - q; /* the third axis */
    const vec8 none = {0}, across = 2 * a[p][q], apart = a[q][q] - a[p][p];
    const vec8 square = across * across + apart * apart;
    vec8 root, size;
    vec8_root(&square, &root);
    const vec8 magnitude = apart - 2 * WHERE(apart < 0, apart);
    const vec8 t = (across - 2 * WHERE(apart < 0, across)) / (magnitude + root + DBL_MIN);
    const vec8 secant = 1 + t * t;
    vec8_root(&secant, &size);
    const vec8 c = 1 / size, s = t * c, moved = t * a[p][q];
    a[p][p] -= moved;
    a[q][q] += moved;
    a[p][q] = a[q][p] = none;
    const vec8 kp = a[k][p], kq = a[k][q];
    a[k][p] = a[p][k] = c * kp - s * kq;
    a[k][q] = a[q][k] = s * kp + c * kq;
    for (int m = 0; m < 3; m++) {
        const vec8 mp = v[m][p], mq = v[m][q];
        v[m][p] = c * mp - s * mq;
        v[m][q] = s * mp + c * mq;
    }
}

/* What stands beside the diagonal no longer counts in any lane. */
INLINED bool is_diagonal(vec8 a[3][3])
{
    const vec8 beside = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    const vec8 along = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
    const mask8 more = (mask8)(beside > 1e-36 * along);
    long long any = 0;
    for (int n = 0; n < VEC; n++)
        any |= more[n];
    return any == 0;
}

INLINED void in_space(double epsilon, const vec8 *t, vec8 *r)
{
    enum { SWEEPS = 6 }; /* convergence is quadratic: 4 reach rounding */
    const vec8 none = {0}, one = none + 1;
    vec8 a[3][3] = {{t[0], t[3], t[5]}, {t[3], t[1], t[4]}, {t[5], t[4], t[2]}};
    vec8 v[3][3] = {{one, none, none}, {none, one, none}, {none, none, one}};
    for (int sweep = 0; sweep < SWEEPS && !is_diagonal(a); sweep++) {
        rotate(a, v, 0, 1);
        rotate(a, v, 0, 2);
        rotate(a, v, 1, 2);
    }
    static const int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    vec8 value[3];
    for (int k = 0; k < 3; k++) {
        positive(&a[k][k], &value[k]);
        value[k] *= -epsilon;
    }
    for (int s = 0; s < 6; s++)
        r[s] = value[0] * v[row[s]][0] * v[column[s]][0] + value[1] * v[row[s]][1] * v[column[s]][1] +
               value[2] * v[row[s]][2] * v[column[s]][2];
}

EACH_MACHINE void updated_artificial_stress(int dimension, double epsilon, size_t stride,
                                            const double *tension, double *repulsion)
{
    const size_t stresses = (size_t)(dimension * (dimension + 1) / 2);
    vec8 t[6], r[6];
    for (size_t s = 0; s < stresses; s++)
        t[s] = VEC8(tension + stride * s);
    if (dimension == 1) {
        positive(&t[0], &r[0]);
        r[0] *= -epsilon;
    } else if (dimension == 2) {
        in_the_plane(epsilon, t, r);
    } else {
        in_space(epsilon, t, r);
    }
    for (size_t s = 0; s < stresses; s++)
        memcpy(repulsion + stride * s, &r[s], sizeof r[s]);
}
